"""Plots how the error of a scene's layers falls with passes, against a long render of the same scene and size."""

import argparse
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib
import numpy as np
import OpenEXR

matplotlib.use("Agg")
from matplotlib import pyplot

ROOT = Path(__file__).resolve().parent.parent
VKPM = ROOT / "build/release/vkpm"


@dataclass
class Curve:
    """One layer of one kind of render: mean squares of its error over pixels, by passes, and for each seed."""

    layer: str
    label: str
    options: list[str]
    passes: list[int] = field(default_factory=list)
    squares: list[list[float]] = field(default_factory=list)

    def errors(self) -> np.ndarray:
        """Returns roots of the mean squares over pixels and seeds, by passes."""
        return np.sqrt(np.mean(self.squares, axis=0))

    def slope(self) -> float:
        """Of the line through the logarithms, from four passes on."""
        return float(np.polyfit(np.log(self.passes[2:]), np.log(self.errors()[2:]), 1)[0])


def parse_arguments() -> argparse.Namespace:
    """Reads the command line."""
    parser = argparse.ArgumentParser(prog="tools/convergence", description=__doc__)
    parser.add_argument("--scene", type=Path, default=ROOT / "scenes/box.json", help="default: the box")
    parser.add_argument("--reference", type=Path, default=ROOT / "tests/data/box_reference.exr",
                        help="an EXR file of it with the same layers")
    parser.add_argument("--passes", type=int, default=128, help="most passes (default 128)")
    parser.add_argument("--seeds", type=int, default=4, help="renders to average over (default 4)")
    parser.add_argument("--photons", default="20000", help="emitted per pass into each map (default 20000)")
    parser.add_argument("--fixed-radius", default="0.08",
                        help="of the caustic discs that do not shrink, world units (default 0.08)")
    parser.add_argument("-o", "--output", type=Path, default=Path("convergence.png"),
                        help="the plot (default convergence.png)")
    return parser.parse_args()


def read_layers(path: Path) -> dict[str, np.ndarray]:
    """Returns the layers of an EXR file as arrays of height, width and channel."""
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    names = {name.rsplit(".", 1)[0] for name in channels if name.endswith(".R")}
    return {name: np.stack([channels[f"{name}.{c}"].pixels for c in "RGB"], -1).astype(np.float64) for name in names}


def render(scene: Path, options: list[str], passes: int, output: Path) -> dict[str, np.ndarray]:
    """Goes on with a render until it has so many passes."""
    command = [str(VKPM), "--scene", str(scene), "--quiet", "--resume", "--passes", str(passes), "-o", str(output),
               *options]
    if code := subprocess.run(command, check=False).returncode:
        sys.exit(code)
    return read_layers(output)


def measure(curves: list[Curve], arguments: argparse.Namespace, reference: dict[str, np.ndarray], seed: int,
            folder: Path) -> None:
    """Adds a seed to curves whose options are the same, after 1, 2, 4 ... passes."""
    height, width = reference["direct"].shape[:2]
    options = ["--size", f"{width}x{height}", "--photons", arguments.photons, "--caustic-photons", arguments.photons,
               "--seed", str(seed), *curves[0].options]
    for curve in curves:
        curve.passes = []
        curve.squares.append([])
    passes = 1
    while passes <= arguments.passes:
        layers = render(arguments.scene, options, passes, folder / "render.exr")
        for curve in curves:
            curve.passes.append(passes)
            curve.squares[-1].append(float(np.mean((layers[curve.layer] - reference[curve.layer]) ** 2)))
        passes *= 2


def plot(curves: list[Curve], output: Path) -> None:
    """Draws the curves on logarithmic axes, with the slopes that theory predicts."""
    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for curve in curves:
        axes.loglog(curve.passes, curve.errors(), marker="o", markersize=3,
                    label=f"{curve.label}: slope {curve.slope():+.2f}")
    for slope, style, label in ((-1 / 2, ":", "-1/2"), (-1 / 3, "--", "-1/3")):
        x = np.array(curves[0].passes, float)
        axes.loglog(x, 0.02 * x**slope, "k" + style, linewidth=0.8, label=label)
    axes.set_xlabel("passes")
    axes.set_ylabel("RMS error, W/(m² sr)")
    axes.legend(fontsize=8)
    figure.savefig(output, dpi=110)


def main() -> None:
    """Measures and plots."""
    arguments = parse_arguments()
    reference = read_layers(arguments.reference)
    shrinking = [Curve("direct", "direct, path traced", []), Curve("indirect", "indirect, final gather", []),
                 Curve("caustic", "caustic, shrinking discs", [])]
    fixed = [Curve("caustic", "caustic, fixed discs", ["--alpha", "1", "--caustic-radius", arguments.fixed_radius])]
    for curves in (shrinking, fixed):
        for seed in range(arguments.seeds):
            with tempfile.TemporaryDirectory() as folder:
                measure(curves, arguments, reference, seed, Path(folder))
    plot(shrinking + fixed, arguments.output)
    for curve in shrinking + fixed:
        print(f"{curve.label}: slope {curve.slope():+.2f}")


if __name__ == "__main__":
    main()
