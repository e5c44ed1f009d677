"""tools/denoise on a tiny render: less error, nothing else changed, converged pixels kept, and what is refused. Skipped
(exit code 77) where Open Image Denoise is not installed.

denoise_test.py VKPM tests; denoise_test.py VKPM --table FOLDER prints the table of tools/README.md, from renders in the
folder (box-16.exr, ref-box.exr and so on), which are made if they are not there."""

import importlib.util
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
SKIPPED = 77
SIZE = 64, 48

if importlib.util.find_spec("pyoidn") is None:
    print("skipped: pyoidn is not installed; tools/environment --with denoise installs it")
    sys.exit(SKIPPED)

import denoise  # noqa: E402


def command(*words: object, code: int = 0) -> str:
    """Runs tools/denoise in this environment, and returns what it says."""
    words = [sys.executable, "-P", "-m", "denoise", *map(str, words)]
    process = subprocess.run(words, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    assert process.returncode == code, (process.returncode, process.stderr)
    return process.stderr


def render(vkpm: str, file: Path, passes: int, *options: str) -> None:
    words = [vkpm, "--scene", ROOT / "scenes/box.json", "--size", "{}x{}".format(*SIZE), "--passes", passes, "-o", file]
    subprocess.run([*map(str, words), "--quiet", *options], check=True)


def measures(vkpm: str, image: Path, reference: Path) -> dict[str, float]:
    """The errors of beauty, as vkpm compare has them."""
    process = subprocess.run([vkpm, "compare", image, reference, "--json"], capture_output=True, text=True, check=True)
    return json.loads(process.stdout)["layers"]["beauty"]


def relmse(vkpm: str, image: Path, reference: Path) -> float:
    return measures(vkpm, image, reference)["relmse"]


def write(file: Path, **layers: np.ndarray) -> Path:
    """An EXR file of layers; beauty is named so."""
    letters = {"normal": "XYZ"}
    channels = {("" if layer == "beauty" else layer + ".") + letter: np.ascontiguousarray(values[..., i])
                for layer, values in layers.items() for i, letter in enumerate(letters.get(layer, "RGB"))}
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(str(file))
    return file


def test_renders(vkpm: str, folder: Path) -> None:
    """Error falls by more than half; all but beauty stays; the sums over passes go; the input stays."""
    noisy, reference, clean = folder / "noisy.exr", folder / "reference.exr", folder / "clean.exr"
    render(vkpm, noisy, 4)
    render(vkpm, reference, 48, "--seed", "9", "--no-resume")
    before = noisy.read_bytes()
    assert command(noisy, "-o", clean) == ""
    assert noisy.read_bytes() == before
    assert relmse(vkpm, clean, reference) < 0.5 * relmse(vkpm, noisy, reference)

    (channels, header), (kept, attributes) = denoise.read(noisy), denoise.read(clean)
    assert channels.keys() == kept.keys() and "vkpm/runs" not in attributes and "vkpm/denoised" in attributes
    assert all(np.array_equal(channels[name], kept[name]) for name in channels if name not in "RGB")
    assert {name for name in header if name.startswith("vkpm/")} < attributes.keys()

    # The picture beside it is developed as vkpm does, but for roundings.
    with Image.open(noisy.with_suffix(".png")) as picture:
        differ = np.asarray(picture, int) - np.asarray(denoise.developed(channels, 0), int)
    assert np.abs(differ).max() <= 1 and np.abs(differ).mean() < 0.01
    with Image.open(clean.with_suffix(".png")) as picture:
        assert picture.size == SIZE and np.array_equal(picture, denoise.developed(kept, 0))

    # Layers sum to beauty, if each is denoised.
    layered = folder / "layered.exr"
    command(noisy, "-o", layered, "--by-layer")
    assert relmse(vkpm, layered, reference) < 0.5 * relmse(vkpm, noisy, reference)
    kept, _ = denoise.read(layered)
    total = sum(denoise.vector(kept, layer) for layer in ("emission", *denoise.NOISY))
    assert np.allclose(total, denoise.vector(kept, ""), rtol=1e-4, atol=1e-5)
    assert not np.array_equal(kept["indirect.R"], channels["indirect.R"])

    said = command(clean, "-o", layered, code=2)
    assert "denoised before" in said, said


def test_converged(folder: Path) -> None:
    """What has no noise stays, to the bit, and what is all noise is smoothed; without the layer it is said."""
    random = np.random.default_rng(1)
    color = (1 + 0.3 * random.standard_normal((48, 64, 3))).astype(np.float32)
    flat, clean = np.ones_like(color), folder / "clean.exr"
    for noise, least, most in ((0, 0, 0), (0.3, 0.25, 0.35)):
        file = write(folder / "in.exr", beauty=color, albedo=flat, normal=flat, noise=flat * np.float32(noise))
        command(file, "-o", clean)
        change = np.std(denoise.vector(denoise.read(clean)[0], "") - color)
        assert least <= change <= most, (noise, change)
        command(file, "-o", clean, "--everywhere")
        assert np.std(denoise.vector(denoise.read(clean)[0], "") - color) > 0.2

    # Beyond two standard errors changes fall as they grow.
    file = write(folder / "in.exr", beauty=color, albedo=flat, normal=flat, noise=flat * np.float32(0.001))
    command(file, "-o", clean, "--everywhere")
    full = np.linalg.norm(denoise.vector(denoise.read(clean)[0], "") - color, axis=-1)
    command(file, "-o", clean)
    part = np.linalg.norm(denoise.vector(denoise.read(clean)[0], "") - color, axis=-1)
    large = full > 0.01
    assert large.any() and np.allclose(part[large], 4 * 3 * 0.001**2 / full[large], rtol=0.02)

    file = write(folder / "in.exr", beauty=color.astype(np.float16))
    said = command(file, "-o", clean)
    assert "no albedo and no normal" in said and "no layer noise" in said, said
    assert denoise.read(clean)[0]["R"].dtype == np.float16


def test_refused(folder: Path) -> None:
    """Wrong input ends with exit code 2, what was found and what is allowed, and writes nothing."""
    color = np.ones((4, 4, 3), np.float32)
    good, out = write(folder / "good.exr", beauty=color), folder / "out.exr"
    part = write(folder / "part.exr", albedo=color)
    color[1, 2, 0] = np.nan
    bad = write(folder / "bad.exr", beauty=color)
    text = folder / "text.exr"
    text.write_text("no picture")
    for words, expected in (
        ((folder / "none.exr", "-o", out), "no such file"),
        ((text, "-o", out), "no whole EXR file"),
        ((bad, "-o", out), "channel R: found 1 values that are not finite, the first at pixel (2, 1)"),
        ((part, "-o", out), "allowed: with R, G and B"),
        ((good, "-o", good), "is the picture itself"),
        ((good, "-o", folder / "out.png"), "ends in .exr"),
        ((good, "-o", folder / "none/out.exr"), "is no folder"),
        ((good, "-o", out, "--by-layer"), "none of the layers"),
    ):
        said = command(*words, code=2)
        assert expected in said, said
        assert not out.exists()


def print_table(vkpm: str, folder: Path) -> None:
    """Errors of the shipped scenes as rendered, denoised everywhere, mixed by noise, and by layer as well."""
    folder.mkdir(exist_ok=True)
    ways = ((), (), ("--by-layer",), ("--everywhere",))
    print("| scene | passes | as rendered | denoised | `--by-layer` | `--everywhere` |\n" + "|---" * 6 + "|")
    for scene in ("box", "glass", "ring", "pool"):
        words = [vkpm, "--scene", ROOT / f"scenes/{scene}.json", "--size", "160x120", "--quiet", "-o"]
        reference = folder / f"ref-{scene}.exr"
        if not reference.exists():
            long = [reference, "--seed", "77", "--time", "600", "--passes", "100000", "--no-resume"]
            subprocess.run([*map(str, words + long)], check=True)
        for passes in (4, 16, 64):
            noisy, clean = folder / f"{scene}-{passes}.exr", folder / "clean.exr"
            if not noisy.exists():
                subprocess.run([*map(str, [*words, noisy, "--passes", passes])], check=True)
            cells = []
            for i, options in enumerate(ways):
                if i:
                    command(noisy, "-o", clean, *options)
                found = measures(vkpm, clean if i else noisy, reference)
                cells.append(f"{found['relmse']:.2g}, {found['flip']:.3f}")
            print(f"| {scene} | {passes} | {' | '.join(cells)} |", flush=True)


def main() -> None:
    if sys.argv[2:3] == ["--table"]:
        print_table(sys.argv[1], Path(sys.argv[3]))
        return
    with tempfile.TemporaryDirectory(prefix="vkpm-denoise-") as folder:
        test_converged(Path(folder))
        test_renders(sys.argv[1], Path(folder))
    with tempfile.TemporaryDirectory(prefix="vkpm-denoise-") as folder:
        test_refused(Path(folder))
    print("passed")


main()
