"""What a farm hands out and gets back: the files of a scene, ranges of passes, and the folder of finished parts."""

import hashlib
import json
import os
import shutil
import subprocess
from collections.abc import Collection
from itertools import pairwise
from pathlib import Path
from urllib.parse import unquote

MODELS = (".gltf", ".glb")  # which name files of their own
DEFAULT_PASSES = 16  # of vkpm, where neither option nor scene say how many

Span = tuple[int, int]  # passes from the first to before the second


def digest(content: bytes) -> str:
    """A hash of a file's content."""
    return hashlib.sha256(content).hexdigest()


def content_of(file: Path) -> dict:
    """The JSON of a scene, a .gltf or a .glb; empty where it cannot be read."""
    try:
        data = file.read_bytes()
        if data[:4] == b"glTF":
            data = data[20 : 20 + int.from_bytes(data[12:16], "little")]
        content = json.loads(data)
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def names_in(content: object, keys: Collection[str]) -> list[str]:
    """The texts under these keys, at any depth."""
    if isinstance(content, list):
        return [name for value in content for name in names_in(value, keys)]
    if not isinstance(content, dict):
        return []
    own = [value for key, value in content.items() if key in keys and isinstance(value, str)]
    return own + [name for value in content.values() for name in names_in(value, keys)]


def named_files(file: Path) -> list[Path]:
    """The files that a scene or a model names, and those that these name: meshes, imports, buffers and images."""
    is_model = file.suffix.lower() in MODELS
    files = []
    for name in names_in(content_of(file), {"uri"} if is_model else {"file", "import", "texture", "image"}):
        if not name.startswith("data:"):
            named = Path(os.path.abspath(file.parent / (unquote(name) if is_model else name)))
            models = named.suffix.lower() in MODELS and not is_model
            files += [named, *(named_files(named) if models else [])]
    return [named for named in files if named.is_file()]


class Scene:
    """A scene's files by their names below one folder; what cannot be read is left out, and vkpm will say so."""

    def __init__(self, path: Path):
        path = Path(os.path.abspath(path))
        settings = content_of(path).get("settings")
        passes = settings.get("passes") if isinstance(settings, dict) else None
        files = [path, *named_files(path)]
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
