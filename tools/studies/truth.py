"""Whether the error that vkpm states is there: renders of many seeds against a long one, scene by scene.

The long render has four times the photons, so that its discs are half as wide, and a seed of its own; its noise, which
it states, is taken off. All renders go on from what the folder holds: the program itself refuses what was rendered from
another scene or with other settings, and such a picture is rendered anew. Pictures of an older program stay, and a new
program states their errors: a changed estimate is judged in minutes.
"""

import argparse
import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import OpenEXR
from matplotlib import pyplot
from tqdm import tqdm

from studies.vkpm import LIGHT, Failure, Vkpm, say

SEED = 1000003  # of references
KEPT = 0.98  # of the values, as in host/render/error_estimate.h
LUMINANCE = (0.2126, 0.7152, 0.0722)

erf = np.vectorize(math.erf)


@dataclass
class Picture:
    """A render's layers and what it states: arrays of height, width and three colours."""

    layers: dict[str, np.ndarray]
    normal: np.ndarray
    depth: np.ndarray
    bias_noise: np.ndarray  # of the bias of the luminance
    error: dict  # as --stats has it

    def interval(self) -> np.ndarray:
        """Squares of standard errors, bias among them, as halfInterval() in host/render/error_estimate.cpp has them."""
        luminance = self.layers["beauty"] @ LUMINANCE
        share = self.layers["beauty"] / np.where(luminance > 0, luminance, 1)[..., None]
        share[luminance <= 0] = 1
        square = np.maximum((self.layers["bias"] @ LUMINANCE) ** 2 - self.bias_noise**2, 0)
        return self.layers["noise"] ** 2 + share**2 * square[..., None]


def read_picture(path: Path, error: dict) -> Picture:
    """A render that vkpm wrote with its sums."""
    channels = OpenEXR.File(str(path), separate_channels=True).channels()

    def values(name: str) -> np.ndarray:
        return channels[name].pixels.astype(np.float64)

    names = {"beauty": ""} | {name: name + "." for name in (*LIGHT, "noise", "bias", "albedo")}
    layers = {layer: np.stack([values(prefix + c) for c in "RGB"], -1) for layer, prefix in names.items()}
    passes = int(OpenEXR.File(str(path), separate_channels=True, header_only=True).header()["vkpm/passes"])
    squares = sum(values(name) for name in channels if name.startswith("state") and name.endswith(".square.Y"))
    deviation = np.maximum(squares / passes - (layers["bias"] @ LUMINANCE) ** 2, 0)
    normal = np.stack([values(f"normal.{c}") for c in "XYZ"], -1)
    return Picture(layers, normal, values("depth.Z"), np.sqrt(deviation / max(passes - 1, 1)), error)


class Renders:
    """A scene's renders, in a folder of its own."""

    def __init__(self, vkpm: Vkpm, scene: Path, args: argparse.Namespace, options: list[str]):
        self.vkpm, self.scene, self.args, self.options = vkpm, scene, args, options
        self.folder = args.output / f"{scene.stem}-{args.size}"
        self.folder.mkdir(parents=True, exist_ok=True)

    def render(self, name: str, seed: int, passes: int, more: list[str]) -> Picture:
        """Goes on with a picture, or begins it."""
        file, stats = self.folder / f"{name}.exr", self.folder / f"{name}.json"
        words = ["--scene", str(self.scene), "--size", self.args.size, "--passes", str(passes), "--seed", str(seed),
                 "--resume", "-o", str(file), "--stats", str(stats), *more, *self.options]
        try:
            self.vkpm.run(words)
        except Failure as failure:
            if failure.code != 2 or not file.exists():
                raise
            say(f"tools/study: {file} is of another state of the scene, and rendered anew")
            file.unlink()
            self.vkpm.run(words)
        error = json.loads(stats.read_text())["error"]
        if error is None:
            raise Failure(f"tools/study: {self.scene}: vkpm states no error after {passes} passes, see its warnings; "
                          "allowed: a scene whose light arrives, and 2 passes or more", 2)
        return read_picture(file, error)

    def reference(self) -> Picture:
        """A long render."""
        given = {word.split("=")[0] for word in self.options}
        more = [word for name in ("--photons", "--caustic-photons") if name not in given for word in (name, "200000")]
        return self.render("reference", SEED, self.args.reference_passes, more)

    def picture(self, seed: int, passes: int) -> Picture:
        """One of the seeds; it goes on from fewer passes, if these are there."""
        file = self.folder / f"{seed}-{passes}.exr"
        fewer = [p for p in self.args.passes if p < passes and (self.folder / f"{seed}-{p}.exr").exists()]
        if fewer and not file.exists():
            file.write_bytes((self.folder / f"{seed}-{max(fewer)}.exr").read_bytes())
        return self.render(f"{seed}-{passes}", seed, passes, [])


# Measures.


def squares(picture: Picture, truth: Picture) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Squared relative errors of pixels and colours, what noise lets one expect, and what is the truth's own."""
    right = truth.layers["beauty"]
    weight = 1 / (right**2 + 0.01)
    own = truth.layers["noise"] ** 2 * weight
    return (picture.layers["beauty"] - right) ** 2 * weight, picture.layers["noise"] ** 2 * weight + own, own


def error_of(found: np.ndarray, expected: np.ndarray, own: np.ndarray, kept: float) -> float:
    """The root of the mean over the part of the values that are off least, less what the truth is off itself there."""
    count = found.size - round(found.size * (1 - kept))
    greatest = np.partition(found, count - 1, axis=None)[count - 1]
    total = np.sum(np.minimum(found, greatest)) - greatest * (found.size - count)
    reach = np.sqrt(greatest / np.maximum(expected, 1e-30))
    share = np.ones_like(own)  # of each square, where it is kept, if errors are normally distributed
    if kept < 1:
        share = erf(reach / np.sqrt(2)) - reach * np.sqrt(2 / np.pi) * np.exp(-(reach**2) / 2)
    return float(np.sqrt(max(total - np.sum(own * share), 0) / count))


def regions(truth: Picture) -> dict[str, np.ndarray]:
    """Parts of the picture, by name."""
    light = truth.layers["beauty"] @ LUMINANCE
    shares = {layer: truth.layers[layer] @ LUMINANCE for layer in LIGHT}
    strongest = np.argmax(np.stack([shares[layer] for layer in LIGHT]), 0)
    found = {f"most {layer}": strongest == i for i, layer in enumerate(LIGHT)}
    found["caustics"] = shares["caustic"] > 0.3 * light
    found["dark"] = light <= np.quantile(light, 0.2)
    found["bright"] = light >= np.quantile(light, 0.9)
    edge = np.zeros_like(light, bool)
    for axis in (0, 1):
        for value, step in ((truth.normal, 0.3), (truth.layers["albedo"], 0.1),
                            (np.log(np.maximum(truth.depth, 1e-9))[..., None], 0.1)):
            jump = np.max(np.abs(np.diff(value, axis=axis)), -1) > step
            pad = [(0, 0), (0, 0)]
            pad[axis] = (0, 1)
            edge |= np.pad(jump, pad)
            pad[axis] = (1, 0)
            edge |= np.pad(jump, pad)
    found["edges"] = edge
    return found


def inside(picture: Picture, truth: Picture) -> np.ndarray:
    """Whether intervals hold the truth, 0 to 1 by pixel over its noisy colours; NaN where nothing is random."""
    square = picture.interval() + truth.layers["noise"] ** 2
    apart = np.abs(picture.layers["beauty"] - truth.layers["beauty"])
    holds = np.where(picture.layers["noise"] > 0, apart <= picture.error["quantile"] * np.sqrt(square), np.nan)
    noisy = np.sum(~np.isnan(holds), -1)
    return np.where(noisy > 0, np.nansum(holds, -1) / np.maximum(noisy, 1), np.nan)


def layer_squares(pictures: list[Picture], truth: Picture) -> dict[str, np.ndarray]:
    """Squared noise of each layer by pixel, relative to beauty: how seeds differ, which needs no truth."""
    weight = 1 / (truth.layers["beauty"] ** 2 + 0.01)
    return {layer: np.mean(np.var([p.layers[layer] for p in pictures], axis=0, ddof=1) * weight, -1)
            for layer in LIGHT}


# Tables.


def percent(value: float) -> str:
    """Of an error or a part, for people."""
    return f"{100 * value:{'.0f' if value > 0.1 else '.2g'}} %" if np.isfinite(value) else "–"


def span(values: list[float]) -> str:
    """The median and the extremes."""
    return f"{percent(float(np.median(values)))} ({percent(min(values))} to {percent(max(values))})"


def row_of(name: str, passes: int, pictures: list[Picture], truth: Picture) -> tuple[str, bool]:
    """A line of the table of errors, and whether it keeps what is promised."""
    found = [squares(picture, truth) for picture in pictures]
    true = [error_of(*each, KEPT) for each in found]
    whole = [error_of(*each, 1) for each in found]
    stated = [picture.error["relative"] for picture in pictures]
    covered = float(np.mean([a <= b for a, b in zip(true, stated, strict=True)]))
    ratio = float(np.median(stated) / np.median(true)) if np.median(true) > 0 else np.inf
    parts = ", ".join(percent(float(np.median([p.error[key] for p in pictures]))) for key in ("noise", "bias"))
    specks = [float(np.sum(np.mean(each[0], -1) > 1)) for each in found]
    said = [picture.error["specks"] for picture in pictures]
    cells = [name, str(passes), span(true), span(stated), parts, percent(covered), f"{ratio:.2f}",
             f"{np.median(specks):.0f}; {np.median(said):.0f}", span(whole)]
    return "| " + " | ".join(cells) + " |", covered >= 0.9 - 1e-9 and ratio <= 1.3


HEAD = ("| scene | passes | true error | stated error | noise, bias | as good as stated | stated / true | "
        "specks: true; stated | all pixels |\n" + "| --- " * 9 + "|")


def coverage_rows(name: str, passes: int, held: np.ndarray, parts: dict[str, np.ndarray]) -> list[str]:
    """Lines of the table of intervals."""
    rows = []
    for part, mask in ({"all": np.ones_like(held, bool)} | parts).items():
        if np.sum(mask & np.isfinite(held)) >= 0.01 * held.size:
            rows.append(f"| {name} | {passes} | {part} | {percent(float(np.mean(mask)))} | "
                        f"{percent(float(np.nanmean(held[mask])))} |")
    return rows


def layer_rows(name: str, passes: int, found: dict[str, np.ndarray]) -> list[str]:
    """Lines of the table of layers: what each brings to the squares of all pixels, and of the worst fiftieth."""
    total = sum(found.values())
    worst = total >= np.quantile(total, KEPT)
    rest = ~worst
    cells = [f"{percent(float(np.sum(v[worst]) / np.sum(total)))}; {percent(float(np.sum(v[rest]) / np.sum(total)))}"
             for v in found.values()]
    return [f"| {name} | {passes} | " + " | ".join(cells) + " |"]


def worst_rows(name: str, passes: int, pictures: list[Picture], truth: Picture, count: int = 3) -> list[str]:
    """Lines of the pixels that are off most, in all pictures, with the layer that is off most there."""
    weight = 1 / (truth.layers["beauty"] ** 2 + 0.01)
    apart = {layer: np.stack([np.mean((p.layers[layer] - truth.layers[layer]) ** 2 * weight, -1) for p in pictures])
             for layer in ("beauty", *LIGHT)}
    rows = []
    for index in np.argsort(-apart["beauty"], axis=None)[:count]:
        seed, y, x = (int(i) for i in np.unravel_index(index, apart["beauty"].shape))
        layer = max(LIGHT, key=lambda name: apart[name][seed, y, x])
        value, right = (float(p.layers["beauty"][y, x] @ LUMINANCE) for p in (pictures[seed], truth))
        part = float(apart["beauty"][seed, y, x] / np.sum(apart["beauty"][seed]))
        rows.append(f"| {name} | {passes} | {seed + 1} | {x}, {y} | {layer} | {value:.3g} | {right:.3g} | "
                    f"{percent(part)} |")
    return rows


def draw(path: Path, held: np.ndarray, truth: Picture) -> None:
    """The picture, and where intervals hold the truth too seldom (red) or too often (blue)."""
    figure, axes = pyplot.subplots(1, 2, figsize=(9, 4.4), layout="constrained")
    beauty = np.clip(truth.layers["beauty"], 0, 1) ** (1 / 2.2)
    axes[0].imshow(beauty)
    shown = axes[1].imshow(held, cmap="RdBu", vmin=0.6, vmax=1.2)
    figure.colorbar(shown, ax=axes[1], label="part of the intervals that hold the truth (90 % is meant)", shrink=0.8)
    for axis in axes:
        axis.set_axis_off()
    figure.savefig(path, dpi=100)
    pyplot.close(figure)


def study_truth(args: argparse.Namespace, options: list[str]) -> int:
    """Renders what is missing and writes the tables; 1 if a scene does not keep what is promised."""
    if len({scene.stem for scene in args.scenes}) < len(args.scenes):
        raise Failure("tools/study: --scenes: found two of one file name; allowed: different file names", 2)
    vkpm = Vkpm(args.vkpm)
    errors, intervals, layers, worst, kept = [HEAD], [], [], [], True
    total = len(args.scenes) * (1 + args.seeds * len(args.passes))
    with tqdm(total=total, unit="picture", disable=args.quiet or None) as progress:
        for scene in args.scenes:
            renders = Renders(vkpm, scene, args, options)
            progress.set_description_str(scene.stem)
            truth = renders.reference()
            progress.update()
            parts = regions(truth)
            for passes in sorted(args.passes):
                pictures = []
                for seed in range(1, args.seeds + 1):
                    pictures.append(renders.picture(seed, passes))
                    progress.update()
                row, good = row_of(scene.stem, passes, pictures, truth)
                kept &= good
                errors.append(row)
                say(row)
                held = np.mean([inside(picture, truth) for picture in pictures], 0)
                intervals += coverage_rows(scene.stem, passes, held, parts)
                layers += layer_rows(scene.stem, passes, layer_squares(pictures, truth)) if args.seeds > 1 else []
                worst += worst_rows(scene.stem, passes, pictures, truth)
                draw(args.output / f"{scene.stem}-{passes}.png", held, truth)
    text = "\n".join([
        "# Errors", "", *errors, "", "# Intervals of pixels", "",
        "| scene | passes | where | part of the picture | intervals that hold the truth |", "| --- " * 5 + "|",
        *intervals, "", "# Squared noise by layer: in the worst fiftieth of the pixels; in the others", "",
        "| scene | passes | " + " | ".join(LIGHT) + " |", "| --- " * (2 + len(LIGHT)) + "|", *layers, "",
        "# The pixels that are off most", "",
        "| scene | passes | seed | column, row | layer | luminance | true | part of the picture's squared error |",
        "| --- " * 8 + "|", *worst, ""])
    (args.output / "truth.md").write_text(text)
    print(text)
    say(f"tools/study: wrote {args.output / 'truth.md'} and pictures of where intervals fail beside it")
    return 0 if kept else 1
