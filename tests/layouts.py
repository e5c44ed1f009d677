"""Writes C++ that asserts that structs of shared_*.h have the layout in C++ that they have in the kernels.

Usage: layouts.py OUTPUT.cpp KERNEL.spv...

Read off the debug names and decorations of SPIR-V (specification, sections 3.52.2 and 3.52.3).
"""

import struct
import sys
from pathlib import Path

OP_NAME, OP_MEMBER_NAME, OP_TYPE_RUNTIME_ARRAY, OP_TYPE_STRUCT, OP_DECORATE, OP_MEMBER_DECORATE = 5, 6, 29, 30, 71, 72
ARRAY_STRIDE, OFFSET = 6, 35


def text(words: list[int]) -> str:
    """A literal string."""
    return struct.pack(f"<{len(words)}I", *words).split(b"\0")[0].decode()


def layouts(kernel: Path) -> tuple[dict[tuple[str, str], int], dict[str, int]]:
    """Offsets by struct and member, and strides of arrays by struct."""
    data = kernel.read_bytes()
    words = struct.unpack(f"<{len(data) // 4}I", data)
    names, members, offsets, strides, arrays, structs = {}, {}, {}, {}, {}, set()
    at = 5
    while at < len(words):
        length, op = words[at] >> 16, words[at] & 0xFFFF
        rest = list(words[at + 1:at + length])
        if op == OP_NAME:
            names[rest[0]] = text(rest[1:])
        elif op == OP_MEMBER_NAME:
            members[rest[0], rest[1]] = text(rest[2:])
        elif op == OP_MEMBER_DECORATE and rest[2] == OFFSET:
            offsets[rest[0], rest[1]] = rest[3]
        elif op == OP_DECORATE and rest[1] == ARRAY_STRIDE:
            strides[rest[0]] = rest[2]
        elif op == OP_TYPE_RUNTIME_ARRAY:
            arrays[rest[0]] = rest[1]
        elif op == OP_TYPE_STRUCT:
            structs.add(rest[0])
        at += length
    found = {(names[kind], members[kind, i]): offset for (kind, i), offset in offsets.items()}
    return found, {names[arrays[array]]: stride for array, stride in strides.items() if arrays.get(array) in structs}


def main() -> None:
    """The command line."""
    output, *kernels = map(Path, sys.argv[1:])
    asserts = set()
    for kernel in kernels:
        offsets, strides = layouts(kernel)
        # Blocks that stand for pointers have one member, "at"; those of push constants hold a struct "args".
        asserts |= {f"static_assert(offsetof(vkpm::{kind}, {member}) == {offset});"
                    for (kind, member), offset in offsets.items()
                    if member not in ("at", "args")}
        asserts |= {f"static_assert(sizeof(vkpm::{kind}) == {stride});" for kind, stride in strides.items()}
    if len(asserts) < 100:
        sys.exit(f"layouts.py: found {len(asserts)} layouts; kernels were compiled without names")
    headers = sorted((Path(__file__).parent.parent / "shaders").glob("shared_*.h"))
    includes = [f'#include "{header.name}"' for header in headers]
    lines = ["// Made by layouts.py.", *includes, "#include <cstddef>", *sorted(asserts)]
    output.write_text("\n".join(lines) + "\n")


main()
