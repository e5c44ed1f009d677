"""vkpm compare has the FLIP of the package flip-evaluator, on images that a hash makes and on renders.

flip_test.py VKPM compares; flip_test.py --print prints mean and greatest for the table of flip_test.cpp.
"""

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import flip_evaluator
import numpy as np
import OpenEXR

ROOT = Path(__file__).resolve().parent.parent
FLOAT = np.float32
Value = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def noise(x: np.ndarray, y: np.ndarray, channel: np.ndarray, seed: int) -> np.ndarray:
    """Numbers from 0 to 1, the same as in flip_test.cpp."""
    i = (x + 1000 * y + 1000000 * channel + 10000000 * seed).astype(np.uint32)
    i = (i ^ i >> 16) * np.uint32(0x7FEB352D)
    i = (i ^ i >> 15) * np.uint32(0x846CA68B)
    return ((i ^ i >> 16) >> 8).astype(FLOAT) * FLOAT(2**-24)


def noises(seed: int) -> Value:
    """Each pixel has a colour of its own."""
    return lambda x, y, c: noise(x, y, c, seed)


def wide(seed: int) -> Value:
    """Few bright pixels among many dark ones."""
    return lambda x, y, c: FLOAT(5000) * ((noise(x, y, c, seed) ** 2) ** 2) ** 2


def squares(x: np.ndarray, y: np.ndarray, channel: np.ndarray) -> np.ndarray:
    """Squares of eight pixels, each of a colour of its own."""
    return noise(x // 8, y // 8, channel, 3)


def corner(width: int) -> Value:
    """Black but for a corner."""
    return lambda x, y, c: np.where((x < width) & (y < 10), noise(x, y, c, 7), FLOAT(0))


def hazy_corner(x: np.ndarray, y: np.ndarray, channel: np.ndarray) -> np.ndarray:
    """The same with faint light all over."""
    return corner(18)(x, y, channel) + FLOAT(2**-28)


def even(*colour: float) -> Value:
    """One colour, or one grey, all over."""
    return lambda x, y, c: np.array(colour, FLOAT)[c % len(colour)]


def noisy_squares(x: np.ndarray, y: np.ndarray, channel: np.ndarray) -> np.ndarray:
    """Squares with noise over them."""
    return squares(x, y, channel) + FLOAT(0.25) * noise(x, y, channel, 4)


def brighter_squares(x: np.ndarray, y: np.ndarray, channel: np.ndarray) -> np.ndarray:
    """Squares, a little too bright."""
    return FLOAT(1.0078125) * squares(x, y, channel)


# Name, size, image, reference.
CASES: list[tuple[str, tuple[int, int], Value, Value]] = [
    ("noise", (37, 23), noises(1), noises(2)),
    ("noise over squares, several tiles", (131, 70), noisy_squares, squares),
    ("nearly alike", (65, 64), brighter_squares, squares),
    ("a wide range", (50, 41), wide(5), wide(6)),
    ("a reference that is black but for a corner", (40, 30), corner(20), corner(18)),
    ("the same under a faint haze", (40, 30), hazy_corner, corner(18)),
    ("a row", (90, 1), noises(8), squares),
    ("a column", (1, 90), noises(9), squares),
    ("a pixel", (1, 1), even(0.75, 0.25, 0.25), even(0.5)),
    ("constant", (9, 8), even(0.75), even(0.5)),
    ("a black image", (20, 20), even(0), squares),
]


def picture(size: tuple[int, int], value: Value) -> np.ndarray:
    """The image that a function makes of x, y and channel."""
    y, x, c = np.indices((size[1], size[0], 3))
    return np.ascontiguousarray(value(x, y, c), FLOAT)


def flip(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """The package's map; it adds up the mean in single precision, so that is left to others."""
    return flip_evaluator.evaluate(reference, image, "HDR", applyMagma=False)[0]


def compare(vkpm: str, image: Path, reference: Path) -> dict:
    """What vkpm compare finds, by layer."""
    command = [vkpm, "compare", str(image), str(reference), "--json"]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["layers"]


def write(file: Path, pixels: np.ndarray) -> Path:
    """Writes an image as EXR."""
    channels = {name: np.ascontiguousarray(pixels[..., c]) for c, name in enumerate("RGB")}
    OpenEXR.File({}, channels).write(str(file))
    return file


def layer(file: Path, name: str) -> np.ndarray:
    """A layer of an EXR file."""
    channels = OpenEXR.File(str(file), separate_channels=True).channels()
    prefix = "" if name == "beauty" else name + "."
    return np.ascontiguousarray(np.stack([channels[prefix + c].pixels for c in "RGB"], -1), FLOAT)


def expect(what: str, found: float, map_of_package: np.ndarray) -> None:
    """Expects the package's mean, but for its roundings, which are larger where nothing but them is under a root."""
    mean = float(map_of_package.mean(dtype=np.float64))
    print(f"{what}: {found:.7f}, {found - mean:+.1e} off")
    assert abs(found - mean) < 3e-5, f"{what}: vkpm {found}, flip-evaluator {mean}"


def test_pictures(vkpm: str, folder: Path) -> None:
    """Images that are functions of pixel and channel."""
    for name, size, image, reference in CASES:
        x, r = picture(size, image), picture(size, reference)
        errors = compare(vkpm, write(folder / "x.exr", x), write(folder / "r.exr", r))
        expect(name, errors["beauty"]["flip"], flip(x, r))


def test_renders(vkpm: str, folder: Path) -> None:
    """Renders of few passes against more."""
    x, r = folder / "x.exr", folder / "r.exr"
    for passes, file in (2, x), (8, r):
        options = ["--size", "96x70", "--photons", "5000", "--passes", str(passes), "--quiet", "-o", str(file)]
        subprocess.run([vkpm, "--scene", str(ROOT / "scenes/box.json"), *options], check=True)
    errors = compare(vkpm, x, r)
    for name in "beauty", "direct", "caustic", "indirect", "specular", "emission", "albedo":
        expect(name, errors[name]["flip"], flip(layer(x, name), layer(r, name)))


def main() -> None:
    """Runs the test for the vkpm that is named by the first argument, or prints the package's values."""
    if sys.argv[1] == "--print":
        for name, size, image, reference in CASES:
            values = flip(picture(size, image), picture(size, reference))
            print(f"{name}: {values.mean(dtype=np.float64):.7f}, {values.max():.6f}")
        return
    with tempfile.TemporaryDirectory(prefix="vkpm-flip-test-") as name:
        test_pictures(sys.argv[1], Path(name))
        test_renders(sys.argv[1], Path(name))


if __name__ == "__main__":
    main()
