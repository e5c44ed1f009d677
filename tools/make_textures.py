#!/usr/bin/env python3
"""Writes the images of the shipped scenes, each from a formula, the same texels every time.

Usage: tools/make_textures.py [FOLDER]    default: scenes/ of this repository
"""

import math
import pathlib
import struct
import sys
import zlib


def lattice(x, y):
    """A number in [0, 1) for each pair of whole numbers."""
    h = (x * 374761393 + y * 668265263) & 0xFFFFFFFF
    h = ((h ^ h >> 13) * 1274126177) & 0xFFFFFFFF
    return (h ^ h >> 16) / 2**32


def noise(x, y, period_x, period_y):
    """Smooth noise that repeats."""
    i, j = math.floor(x), math.floor(y)
    s, t = x - i, y - j
    s, t = s * s * (3 - 2 * s), t * t * (3 - 2 * t)
    corner = [[lattice((i + a) % period_x, (j + b) % period_y) for a in (0, 1)] for b in (0, 1)]
    low, high = (row[0] + s * (row[1] - row[0]) for row in corner)
    return low + t * (high - low)


def wood(x, y, size):
    """Four planks along x, each with its own grain."""
    plank = 4 * y // size
    across = 4 * y / size - plank
    u, v = 4 * x / size, 24 * y / size
    rings = noise(u, v, 4, 24) * 5 + 0.6 * noise(8 * u, 4 * v, 32, 96)
    grain = 0.5 + 0.5 * math.sin(2 * math.pi * rings)
    tone = 0.75 + 0.35 * lattice(plank, 7) - 0.18 * grain - 0.1 * noise(16 * u, 8 * v, 64, 192)
    gap = 0.35 if across < 4 / size * 1.5 else 1
    return [*(gap * tone * c for c in (0.72, 0.49, 0.30)), 1]


def leaf(x, y, size):
    """A leaf with its veins, and nothing around it."""
    u, v = 2 * (x + 0.5) / size - 1, 1 - (y + 0.5) / size
    half = 0.55 * math.sin(math.pi * v**0.8) ** 0.75 if 0 < v < 1 else 0
    stalk = abs(u) < 0.03 and v < 0.2
    inside = abs(u) < half * 0.95 or stalk
    vein = abs(u) < 0.025 or abs((v - 0.7 * abs(u)) * 8 % 1 - 0.5) > 0.46
    green = (0.42, 0.55, 0.18) if vein else (0.2, 0.36 + 0.08 * noise(8 * u + 8, 8 * v, 99, 99), 0.07)
    return [*green, 1 if inside else 0]


def brick_height(x, y, size):
    """Of a wall of painted bricks, four rows of two: how far out it is, in parts of the picture's width."""
    row = math.floor(4 * y / size)
    u, v = (2 * x / size + (row % 2) / 2) % 1 - 0.5, (4 * y / size) % 1 - 0.5
    edge = min((0.5 - abs(u)) / 2, (0.5 - abs(v)) / 4)  # to the middle of the mortar, in parts of the width
    step = min(1, max(0, (edge - 0.006) / 0.012))
    rough = noise(16 * x / size, 16 * y / size, 16, 16) + 0.5 * noise(40 * x / size, 40 * y / size, 40, 40)
    return 0.012 * step * step * (3 - 2 * step) + 0.003 * rough


def bricks(x, y, size):
    """The normals of these bricks: twice the colour less 1, green up."""
    right = size * (brick_height(x + 1, y, size) - brick_height(x - 1, y, size)) / 2
    down = size * (brick_height(x, y + 1, size) - brick_height(x, y - 1, size)) / 2
    length = math.sqrt(1 + right * right + down * down)
    return [0.5 - 0.5 * right / length, 0.5 + 0.5 * down / length, 0.5 + 0.5 / length, 1]


def rug(x, y, size):
    """Stripes and diamonds of wool, a border around them."""
    u, v = abs(2 * (x + 0.5) / size - 1), abs(2 * (y + 0.5) / size - 1)
    wool = 0.85 + 0.3 * lattice(x, y)
    if max(u, v) > 0.92 or 0.8 > max(u, v) > 0.76:
        return [wool * c for c in (0.78, 0.70, 0.55)]
    if max(u, v) > 0.76:
        return [wool * c for c in ((0.55, 0.16, 0.12) if (x + y) // 4 % 2 else (0.15, 0.2, 0.33))]
    colors = (0.55, 0.16, 0.12), (0.72, 0.62, 0.45), (0.15, 0.2, 0.33), (0.62, 0.34, 0.16)
    return [wool * c for c in colors[int(4 * (u + v)) % 4]]


def label(x, y, width, height):
    """Of a bottle: a sun over a hill, lines in place of a text, a double frame."""
    u, v = (x + 0.5) / width, 1 - (y + 0.5) / height
    edge = min(u, 1 - u) * width, min(v, 1 - v) * height
    paper, ink, red = (0.93, 0.89, 0.78), (0.16, 0.14, 0.13), (0.66, 0.15, 0.10)
    if 3 <= min(edge) < 5 or 6 <= min(edge) < 7:
        return red
    if math.hypot((u - 0.5) * width, (v - 0.72) * height) < 0.13 * height:
        return (0.86, 0.56, 0.14)
    hills = 0.16 * math.exp(-(((u - 0.38) / 0.13) ** 2)) + 0.1 * math.exp(-(((u - 0.66) / 0.1) ** 2))
    if min(edge) > 9 and 0.5 < v < 0.52 + hills:
        return (0.25, 0.38, 0.2)
    line = int((0.46 - v) / 0.09)
    if 0 <= line < 4 and v < 0.46 and (0.46 - v) / 0.09 % 1 < (0.62 if line == 0 else 0.3):
        half = (0.34, 0.24, 0.28, 0.14)[line]
        letters = lattice(x // (4 if line == 0 else 2), line) > 0.25
        if abs(u - 0.5) < half and letters:
            return red if line == 0 else ink
    return paper


def sunset(x, y, width, height):
    """A sun above water."""
    u, v = (x + 0.5) / width * 4 / 3, 1 - (y + 0.5) / height
    sun = math.hypot(u - 0.67, v - 0.55)
    if v > 0.4:
        sky = [0.95 - 0.75 * (v - 0.4), 0.45 - 0.35 * (v - 0.4), 0.18 + 0.5 * (v - 0.4)]
        return [1, 0.9, 0.5, 1] if sun < 0.11 else [*sky, 1]
    glitter = abs(u - 0.67) < 0.06 + 0.2 * (0.4 - v) and math.sin(90 * v + 3 * math.sin(40 * u)) > 0.2
    return [1, 0.6, 0.25, 1] if glitter else [0.05, 0.1 + 0.2 * v, 0.25 + 0.2 * v, 1]


def png(width, height, texel, alpha):
    """Bytes of an image whose colours are those of sRGB."""
    rows = b""
    for y in range(height):
        row = [round(255 * min(1, max(0, c))) for x in range(width) for c in texel(x, y)[: 4 if alpha else 3]]
        rows += b"\0" + bytes(row)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 6 if alpha else 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    )


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent / "scenes"
    (folder / "wood.png").write_bytes(png(128, 128, lambda x, y: wood(x, y, 128), False))
    (folder / "leaf.png").write_bytes(png(64, 64, lambda x, y: leaf(x, y, 64), True))
    (folder / "bricks.png").write_bytes(png(128, 128, lambda x, y: bricks(x, y, 128), False))
    (folder / "rug.png").write_bytes(png(64, 64, lambda x, y: rug(x, y, 64), False))
    (folder / "label.png").write_bytes(png(192, 128, lambda x, y: label(x, y, 192, 128), False))
    (folder / "sunset.png").write_bytes(png(64, 48, lambda x, y: sunset(x, y, 64, 48), False))


if __name__ == "__main__":
    main()
