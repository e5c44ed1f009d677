"""Which paths make the pixels that are off most: each pass of a picture is rendered again, by itself, with labels.

A path is written from the light to the eye: L the light, E the eye, D a diffuse surface, S a mirror or smooth glass
that reflects, s one that light goes through, G a glossy lobe; ... stands for all that photons and gather rays did
before, and for events beyond the first ten from the eye.
"""

import argparse
from collections import defaultdict
from dataclasses import dataclass

import numpy as np
import OpenEXR

from studies.truth import LUMINANCE, Picture, Renders, percent
from studies.vkpm import LIGHT, Vkpm, say

EVENTS = "SsG"  # as in shaders/labels.glsl
FOUND = ("L", "LD", "L...D", "L...DD")
MOST_EVENTS = 1 << 20


def path_of(code: int) -> str:
    """A path by its number, as shaders/labels.glsl makes it."""
    if code == 0:
        return "none"
    events, found = code >> 2, FOUND[code & 3]
    more = "..." if events >= MOST_EVENTS else ""
    seen = ""
    while events > 1:
        seen += EVENTS[events & 3]
        events >>= 2
    return found + more + seen + "E"


@dataclass
class Pass:
    """One pass: its layers, and the numbers of the brightest paths."""

    layers: dict[str, np.ndarray]
    codes: np.ndarray


def read_pass(path: str) -> Pass:
    """A pass that was rendered with labels."""
    channels = OpenEXR.File(path, separate_channels=True).channels()
    layers = {name: np.stack([channels[f"{name}.{c}"].pixels.astype(np.float64) for c in "RGB"], -1) for name in LIGHT}
    return Pass(layers, channels["albedo.B"].pixels.astype(np.int64))


def label_passes(renders: Renders, seed: int, passes: int) -> list[Pass]:
    """Each pass of a picture by itself."""
    found = []
    for i in range(passes):
        file = renders.folder / f"labels-{seed}-{i}.exr"
        renders.vkpm.run(["--scene", str(renders.scene), "--size", renders.args.size, "--seed", str(seed),
                          "--pass-range", f"{i}:{i + 1}", "--labels", "-o", str(file), *renders.options])
        found.append(read_pass(str(file)))
        file.unlink()
        file.with_suffix(".png").unlink()
    return found


def name_pixel(passes: list[Pass], picture: Picture, truth: Picture, y: int, x: int) -> tuple[int, str, str]:
    """The pass that is off most in the layer that is off most, that layer, and the path."""
    layer = max(LIGHT, key=lambda name: np.sum((picture.layers[name][y, x] - truth.layers[name][y, x]) ** 2))
    off = [np.sum((each.layers[layer][y, x] - truth.layers[layer][y, x]) ** 2) for each in passes]
    index = int(np.argmax(off))
    return index, layer, path_of(int(passes[index].codes[y, x]))


def study_specks(args: argparse.Namespace, options: list[str]) -> int:
    """Prints the pixels that are off most with their paths, and what each path brings to the squared error of the
    worst part of the pixels."""
    vkpm = Vkpm(args.vkpm)
    for scene in args.scenes:
        renders = Renders(vkpm, scene, args, options)
        truth, total = renders.reference(), args.passes[0]
        classes: dict[tuple[str, str], float] = defaultdict(float)
        rows, everything, worst = [], 0.0, 0.0
        for seed in range(1, args.seeds + 1):
            picture = renders.picture(seed, total)
            say(f"tools/study: {scene.stem}, seed {seed}: {total} passes with labels")
            passes = label_passes(renders, seed, total)
            apart = np.mean((picture.layers["beauty"] - truth.layers["beauty"]) ** 2 /
                            (truth.layers["beauty"] ** 2 + 0.01), -1)
            everything += np.sum(apart)
            for index in np.argsort(-apart, axis=None)[: max(round(args.part * apart.size), 1)]:
                y, x = (int(i) for i in np.unravel_index(index, apart.shape))
                number, layer, path = name_pixel(passes, picture, truth, y, x)
                worst += apart[y, x]
                classes[layer, path] += apart[y, x]
                light, right = (p.layers["beauty"][y, x] @ LUMINANCE for p in (picture, truth))
                row = f"| {seed} | {x}, {y} | {number} | {layer} | {light - right:+.3g} | {path} |"
                rows.append((apart[y, x], row))
        print(f"\n# {scene.stem}, {total} passes\n\n| seed | column, row | pass | layer | off by | path |\n"
              + "| --- " * 6 + "|")
        print("\n".join(row for _, row in sorted(rows, key=lambda row: -row[0])[: args.count]))
        print(f"\nThe worst {100 * args.part:g} % of the pixels have {percent(worst / everything)} of the squared "
              "error. Of that:\n\n| layer | path | part |\n| --- | --- | --- |")
        for (layer, path), square in sorted(classes.items(), key=lambda item: -item[1])[: args.count]:
            print(f"| {layer} | {path} | {percent(square / worst)} |")
    return 0
