"""What a farm hands out and gets back: the files of a scene, ranges of passes, and the folder of finished parts."""

import hashlib
import json
import os
import shutil
import subprocess
from collections.abc import Collection
from itertools import pairwise
from pathlib import Path

DEFAULT_PASSES = 16  # of vkpm, where neither option nor scene say how many

Span = tuple[int, int]  # passes from the first to before the second


def digest(content: bytes) -> str:
    """A hash of a file's content."""
    return hashlib.sha256(content).hexdigest()


class Scene:
    """A scene's files by their names below one folder; what cannot be read is left out, and vkpm will say so."""

    def __init__(self, path: Path):
        path = Path(os.path.abspath(path))
        try:
            scene = json.loads(path.read_bytes())
            meshes = [shape["file"] for shape in scene["shapes"] if "file" in shape]
            passes = scene.get("settings", {}).get("passes", DEFAULT_PASSES)
        except (OSError, ValueError, LookupError, TypeError, AttributeError):
            meshes, passes = [], DEFAULT_PASSES
        files = [path, *(Path(os.path.abspath(path.parent / mesh)) for mesh in meshes if isinstance(mesh, str))]
        root = os.path.commonpath([file.parent for file in files])
        self.name = os.path.relpath(path, root)
        self.files = {os.path.relpath(file, root): file.read_bytes() for file in files if file.is_file()}
        self.passes: int = passes if isinstance(passes, int) and passes > 0 else DEFAULT_PASSES


def chunk_size(passes: int, workers: int) -> int:
    """A power of four, as sums of passes form a tree of fours: 4, or more if each worker still gets four chunks."""
    size = 4
    while size * 4 * 4 * workers <= passes:
        size *= 4
    return size


def missing_spans(passes: int, chunk: int, there: Collection[Span]) -> list[Span]:
    """The chunks of all passes, less the passes that are there."""
    edges = sorted({*range(0, passes, chunk), passes, *(edge for span in there for edge in span)})
    held = {number for span in there for number in range(*span)}
    return [(begin, end) for begin, end in pairwise(edges) if begin not in held]


class Parts:
    """The folder of finished parts of one render, named by a hash of everything that their bits depend on."""

    def __init__(self, output: Path, identity: object):
        self.folder = output.with_suffix(".parts") / digest(repr(identity).encode())[:16]

    def spans(self) -> list[Span]:
        """The passes of the parts that are there, in order."""
        names = [file.stem.split("-") for file in self.folder.glob("*-*.exr")]
        return sorted((int(begin), int(end)) for begin, end in names)

    def add(self, span: Span, content: bytes) -> None:
        """Writes a part, which takes its name when it is whole."""
        self.folder.mkdir(parents=True, exist_ok=True)
        file = self.folder / f"{span[0]}-{span[1]}.exr"
        file.with_suffix(".new").write_bytes(content)
        file.with_suffix(".new").rename(file)

    def merge(self, vkpm: Path, output: Path) -> int:
        """Merges all parts, removes them, and returns vkpm's exit code."""
        names = [f"{begin}-{end}.exr" for begin, end in self.spans()]
        code = subprocess.run([vkpm, "merge", "whole.exr", *names], cwd=self.folder, check=False).returncode
        if code == 0:
            for whole, target in ((self.folder / "whole.exr", output),
                                  (self.folder / "whole.png", output.with_suffix(".png"))):
                whole.replace(target.resolve())
            shutil.rmtree(self.folder)
            if not any(self.folder.parent.iterdir()):
                self.folder.parent.rmdir()
        return code
