"""Renders models of glTF by vkpm and by Cycles, with Blender's own importer, and writes a page with the pairs, those
that differ most first. Both see a model from its front, below a sky of radiance 0.5 and a sun."""

import argparse
import html
import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
SKY, SUN, SUN_ANGLE, TOWARDS_SUN = 0.5, 2.0, 5.0, (0.5, 1.0, 0.7)  # radiance, W/m^2, degrees, y up

def parse_arguments() -> argparse.Namespace:
    """Reads the command line."""
    parser = argparse.ArgumentParser(prog="tools/compare_gltf", description=__doc__)
    parser.add_argument("models", type=Path, nargs="+", help=".gltf and .glb files, and folders of these")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "build/compare_gltf",
                        help="a folder for pictures and index.html (default build/compare_gltf)")  # fmt: skip
    parser.add_argument("--size", type=int, default=96, help="of a picture, pixels (default 96)")
    parser.add_argument("--passes", type=int, default=48, help="of vkpm (default 48)")
    parser.add_argument("--samples", type=int, default=192, help="of a pixel of Cycles (default 192)")
    parser.add_argument("--again", action="store_true", help="render what is there already")
    parser.add_argument("--vkpm", type=Path, default=ROOT / "build/release/vkpm", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if shutil.which("blender") is None:
        parser.error("no program blender in PATH: install it, as by apt-get install blender")
    return arguments


def models_of(paths: list[Path]) -> dict[str, Path]:
    """Files by names that are files' names, too."""
    found = {}
    for path in paths:
        inside = sorted(p for p in path.rglob("*") if p.suffix in (".gltf", ".glb")) if path.is_dir() else [path]
        for file in inside:
            name = str(file.relative_to(path.parent).with_suffix("")).replace("/", " ")
            found[name] = file.resolve()
    return found


def quiet(command: list[str], log: Path, **options) -> None:
    """Runs a program, which may fail; its words go to a file."""
    with log.open("w") as words:
        try:
            subprocess.run(command, stdout=words, stderr=subprocess.STDOUT, timeout=300, check=False, **options)
        except subprocess.TimeoutExpired:
            words.write("it took too long\n")


def render(name: str, file: Path, arguments: argparse.Namespace) -> str:
    """Both pictures of a model; returns what went wrong."""
    stem = arguments.output / name
    theirs, ours, camera = (stem.with_name(name + end) for end in (".cycles.exr", ".vkpm.exr", ".cycles.camera.json"))
    if arguments.again or not theirs.exists():
        command = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
        command += ["--python", str(ROOT / "tools/compare_gltf_cycles.py"), "--", str(file), str(theirs)]
        stage = {"size": arguments.size, "samples": arguments.samples, "sky": SKY, "sun": SUN, "angle": SUN_ANGLE,
                 "towards": TOWARDS_SUN}  # fmt: skip
        command.append(json.dumps(stage))
        # Blender's Python looks for its packages beside the python3 of PATH.
        quiet(command, stem.with_name(name + ".cycles.txt"), env={**os.environ, "PATH": os.defpath})
    if not theirs.exists():
        return "Blender does not import it"
    if arguments.again or not ours.exists():
        direction = {"type": "sun", "direction": TOWARDS_SUN, "irradiance": SUN, "angle": SUN_ANGLE}
        scene = {"camera": json.loads(camera.read_text()), "import": {"file": str(file), "glass": "solid"},
                 "environment": {"radiance": SKY}, "lights": [direction]}  # fmt: skip
        text = stem.with_name(name + ".json")
        text.write_text(json.dumps(scene))
        command = [str(arguments.vkpm), "--scene", str(text), "-o", str(ours), "--passes", str(arguments.passes)]
        command += ["--size", f"{arguments.size}x{arguments.size}", "--no-resume"]
        quiet(command, stem.with_name(name + ".vkpm.txt"))
    return "" if ours.exists() else "vkpm refuses it"


def colours(file: Path) -> np.ndarray:
    """Beauty of a picture."""
    channels = OpenEXR.File(str(file), separate_channels=True).channels()
    return np.stack([channels[c].pixels for c in "RGB"], -1).astype(float)


def differences(ours: np.ndarray, theirs: np.ndarray) -> tuple[np.ndarray, float]:
    """The mean of vkpm by that of Cycles, less 1, for each colour, and relMSE, where either sees a model."""
    seen = (np.abs(ours - SKY) > 1e-4).any(-1) | (np.abs(theirs - SKY) > 1e-4).any(-1)
    if not seen.any():
        return np.zeros(3), 0.0
    a, b = ours[seen], theirs[seen]
    return (a.mean(0) + 1e-4) / (b.mean(0) + 1e-4) - 1, float(np.mean((a - b) ** 2 / (b**2 + 0.01)))


def picture(values: np.ndarray) -> Image.Image:
    """A picture of 8 bits by the curve of sRGB."""
    x = np.clip(values, 0, 1)
    x = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return Image.fromarray((255 * x + 0.5).astype(np.uint8))


def warnings_of(log: Path) -> list[str]:
    """What vkpm said is left out."""
    return [line.split(": ", 3)[-1] for line in log.read_text().splitlines() if "vkpm: warning" in line]


def main() -> None:
    """Renders, compares and writes the page."""
    arguments = parse_arguments()
    arguments.output.mkdir(parents=True, exist_ok=True)
    rows, failed = [], []
    models = models_of(arguments.models)
    for i, (name, file) in enumerate(models.items()):
        print(f"{i + 1}/{len(models)} {name}", flush=True)
        if wrong := render(name, file, arguments):
            failed.append((name, wrong))
            continue
        ours, theirs = (colours(arguments.output / f"{name}.{who}.exr") for who in ("vkpm", "cycles"))
        for who, values in (("vkpm", ours), ("cycles", theirs)):
            picture(values).save(arguments.output / f"{name}.{who}.png")
        mean, square = differences(ours, theirs)
        rows.append((name, mean, square, warnings_of(arguments.output / f"{name}.vkpm.txt")))
    rows.sort(key=lambda row: -abs(row[1]).max())
    for name, mean, square, _ in rows:
        print(f"{name:<50} {100 * mean[0]:+6.1f} {100 * mean[1]:+6.1f} {100 * mean[2]:+6.1f} %   relMSE {square:.4f}")
    for name, wrong in failed:
        print(f"{name:<50} {wrong}")
    write_page(arguments.output, rows, failed)
    print(f"{len(rows)} models, {sum(abs(row[1]).max() > 0.05 for row in rows)} of them differ by more than 5 %: "
          f"{arguments.output / 'index.html'}")  # fmt: skip


def write_page(folder: Path, rows: list, failed: list) -> None:
    """A page of pairs, vkpm on the left."""
    lines = ["<!DOCTYPE html><meta charset='utf-8'><title>glTF by vkpm and by Cycles</title>",
             "<style>body {font: 14px sans-serif} img {image-rendering: pixelated; width: 192px}</style>",
             "<p>vkpm on the left, Cycles with Blender's importer on the right; the mean of vkpm by that of Cycles, "
             "less 1, of red, green and blue.<table>"]  # fmt: skip
    for name, mean, square, lost in rows:
        quoted = html.escape(name, quote=True)
        pair = "".join(f"<img src='{quoted}.{who}.png'>" for who in ("vkpm", "cycles"))
        numbers = ", ".join(f"{100 * x:+.1f} %" for x in mean)
        said = "".join(f"<br>{html.escape(line)}" for line in lost)
        lines.append(f"<tr><td>{pair}<td><b>{quoted}</b><br>{numbers}<br>relMSE {square:.4f}{said}")
    lines += ["</table>"] + [f"<p>{html.escape(name)}: {wrong}" for name, wrong in failed]
    (folder / "index.html").write_text("\n".join(lines))


if __name__ == "__main__":
    main()
