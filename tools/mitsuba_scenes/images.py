"""Textures: images that are copied beside the scene, or written anew where their values or format have to change."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np

from mitsuba_scenes.source import Failure, Node, colour, mi, number, numbers

READ = (".png", ".jpg", ".jpeg", ".exr", ".hdr")  # formats of vkpm
SPECTRA = ("uniform", "srgb", "regular", "irregular", "d65", "blackbody", "rawconstant")  # the same at all places
Change = Callable[[np.ndarray], np.ndarray]  # of linear values


def rgb(image: "mi.Bitmap", raw: bool = False) -> np.ndarray:
    """The linear colours of an image: height, width, 3."""
    if raw:
        image.set_srgb_gamma(False)
    return np.array(image.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))


def decomposed(matrix: np.ndarray) -> dict | None:
    """A map of texture coordinates, in those of vkpm, which go up, as scale, rotation and offset; none with shear."""
    flip = np.diag((1, -1, 1.0))
    flip[1, 2] = 1
    matrix = flip @ matrix @ flip
    (a, b), (c, d) = matrix[:2, :2]
    if abs(a * b + c * d) > 1e-5 * max(np.hypot(a, c) * np.hypot(b, d), 1e-30):
        return None
    angle = np.arctan2(c, a)
    scale = np.hypot(a, c), d * np.cos(angle) - b * np.sin(angle)
    found = {}
    if not np.allclose(scale, 1):
        found["scale"] = numbers(scale)
    if abs(angle) > 1e-7:
        found["rotation"] = number(np.degrees(angle))
    if not np.allclose(matrix[:2, 2], 0, atol=1e-7):
        found["offset"] = numbers(matrix[:2, 2])
    return found


class Images:
    """The images of a scene, in its folder."""

    def __init__(self, folder: Path, stem: str):
        self.folder, self.stem = folder, stem
        self.copies: dict[Path, str] = {}
        self.written = 0

    def name(self, suffix: str) -> str:
        """A new file's, relative to the scene."""
        self.written += 1
        self.folder.joinpath(f"{self.stem}-files").mkdir(exist_ok=True)
        return f"{self.stem}-files/image{self.written}{suffix}"

    def write(self, values: np.ndarray) -> str:
        """Writes linear values as an EXR file."""
        name = self.name(".exr")
        mi.Bitmap(np.ascontiguousarray(values, np.float32)).write(str(self.folder / name))
        return name

    def copy(self, file: Path) -> str:
        """Copies a file, once."""
        if file not in self.copies:
            self.copies[file] = self.name(file.suffix.lower())
            shutil.copyfile(file, self.folder / self.copies[file])
        return self.copies[file]

    def texture(self, node: Node, change: Change | None, grey: bool) -> dict | float | list:
        """A texture of vkpm; 0.5 if vkpm has no equal. `change` is applied to its linear values."""
        made = {"bitmap": self.bitmap, "checkerboard": self.checkerboard}.get(node.plugin)
        if made is None:
            if node.plugin not in SPECTRA:
                node.lose(f"textures of type {node.plugin}; 0.5 stands for them")
                values = np.full(3, 0.5)
            else:
                values = node.spectrum()
            values = change(values) if change else values
            return number(np.mean(values)) if grey else colour(values)
        result = made(node, change, grey)
        transform = decomposed(np.array(node.values["to_uv"].matrix, float))
        if transform is None:
            node.lose("shear of texture coordinates")
        elif transform:
            result["transform"] = transform
        return result

    def bitmap(self, node: Node, change: Change | None, grey: bool) -> dict:
        """An image file, as it is where that says the same."""
        raw = node.get("raw", False)
        file = Path(str(mi.file_resolver().resolve(node.get("filename", ""))))
        if file.is_file():
            image = mi.Bitmap(str(file))
        else:
            image = node.get("bitmap") or node.get("data")
            if image is None:
                raise Failure(f"{node.place}: there is no image {file}")
        single = image.pixel_format() in (mi.Bitmap.PixelFormat.Y, mi.Bitmap.PixelFormat.YA)
        linear = raw or not image.srgb_gamma()
        if change is None and (single or not grey) and file.suffix.lower() in READ:
            result = {"texture": self.copy(file), "space": "linear" if linear else "srgb"}
        else:
            values = rgb(image, raw)
            if grey:
                values = values @ np.float32((0.212671, 0.71516, 0.072169))
                values = values[..., None]
            result = {"texture": self.write(change(values) if change else values), "space": "linear"}
        wrap = node.get("wrap_mode", "repeat")
        if wrap != "repeat":
            result["wrap"] = wrap
        if node.get("filter_type", "bilinear") == "nearest":
            result["filter"] = "nearest"
        return result

    def checkerboard(self, node: Node, change: Change | None, grey: bool) -> dict:
        """Two by two texels."""
        fields = []
        for name, default in (("color0", 0.4), ("color1", 0.2)):
            child = node.child(name)
            if child is not None and child.plugin not in SPECTRA:
                child.lose("textures within checkerboards; 0.5 stands for them")
                values = np.full(3, 0.5)
            elif child is not None:
                values = child.spectrum()
            else:
                values = np.broadcast_to(node.value(name, default), 3)
            fields.append(change(values) if change else values)
        texels = np.array([[fields[0], fields[1]], [fields[1], fields[0]]])
        return {"texture": self.write(texels.mean(-1, keepdims=True) if grey else texels), "filter": "nearest"}


