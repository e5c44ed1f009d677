"""References: long renders by unbiased integrators, in growing steps until their error is small enough.

Caustics come from light tracing, which finds those of small lights as well; everything else comes from the path tracer.
What neither reaches are caustics of small lights that are seen through mirrors and glass, or by way of another diffuse
surface: these stay with the path tracer, in the layers specular and indirect.
"""

import argparse
import json
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tqdm import tqdm

from farming.parts import Scene, digest
from studies.vkpm import LIGHT, Failure, Image, Vkpm, read_image, relative_square, say, write_image

FIRST_PASSES = 64  # fewer say little about their noise
SEED = 1000003  # of the first part; unlike those of the cells, whose errors shall not be the reference's
CHECKPOINT = 60  # seconds between saves


@dataclass(frozen=True)
class Part:
    """Layers of a reference, and the unbiased integrator that they come from."""

    layers: tuple[str, ...]
    integrator: str


PARTS = (Part(tuple(layer for layer in LIGHT if layer != "caustic"), "path"), Part(("caustic",), "light"))


def scene_digest(path: Path) -> str:
    """A hash of a scene's file and meshes."""
    return digest(repr(sorted((name, digest(content)) for name, content in Scene(path).files.items())).encode())


def reference_file(folder: Path, scene: Path, size: str) -> Path:
    """Where the reference of a scene lies."""
    return folder / f"{scene.stem}-{size}.exr"


class PartRender:
    """A part's own file, which vkpm goes on with."""

    def __init__(self, part: Part, index: int, folder: Path):
        self.part = part
        self.seed = SEED + index
        self.file = folder / f"{index}-{part.integrator}.exr"
        self.image = read_image(self.file) if self.file.exists() else None

    def passes(self) -> int:
        """How many are there."""
        return int(self.image.attributes["vkpm/passes"]) if self.image else 0

    def seconds(self) -> float:
        """Of rendering, over all runs."""
        return float(self.image.attributes.get("vkpm/seconds", 0)) if self.image else 0

    def facts(self) -> dict:
        """What made it."""
        return {"layers": self.part.layers, "integrator": self.part.integrator, "passes": self.passes(),
                "seconds": self.seconds(), "seed": self.seed, "device": self.image.attributes.get("vkpm/device")}

    def error(self, beauty: np.ndarray) -> float:
        """Its share in the squared relative error of the whole; too few passes do not know it."""
        known = self.image and self.passes() >= FIRST_PASSES
        return relative_square(self.image.layers["noise"], beauty) if known else np.inf

    def grow(self, vkpm: Vkpm, options: list[str], seconds: float | None) -> None:
        """Doubles its passes, as far as time allows; Ctrl-C keeps what was rendered."""
        passes = max(FIRST_PASSES, 2 * self.passes())
        limit = [] if seconds is None else ["--time", f"{seconds:.3f}"]
        layers, stats = ",".join((*self.part.layers, "noise")), str(self.file.with_suffix(".json"))
        try:
            vkpm.run([*options, "--integrator", self.part.integrator, "--layers", layers, "--seed", str(self.seed),
                      "--passes", str(passes), *limit, "--resume", "--checkpoint", str(CHECKPOINT),
                      "--stats", stats, "-o", str(self.file)])
        finally:
            self.image = read_image(self.file) if self.file.exists() else None


class Reference:
    """One scene's reference: its parts, and the image and the facts that are made of them."""

    def __init__(self, vkpm: Vkpm, scene: Path, args: argparse.Namespace, options: list[str]):
        self.vkpm, self.scene, self.args, self.extra = vkpm, scene, args, options
        self.file = reference_file(args.output, scene, args.size)
        self.require_same()
        folder = self.file.with_suffix(".state")
        folder.mkdir(parents=True, exist_ok=True)
        self.parts = [PartRender(part, index, folder) for index, part in enumerate(PARTS)]

    def require_same(self) -> None:
        """Refuses to go on with a reference of another scene, other options or other parts."""
        facts_file = self.file.with_suffix(".json")
        if not facts_file.exists():
            return
        facts = json.loads(facts_file.read_text())
        parts = [(tuple(part["layers"]), part["integrator"]) for part in facts["parts"]]
        for same, what in ((facts["scene_digest"] == scene_digest(self.scene), "of another state of the scene"),
                           (facts["options"] == self.extra, f"with options {facts['options']}"),
                           (parts == [(part.layers, part.integrator) for part in PARTS], f"of other parts, {parts},")):
            if not same:
                raise Failure(f"tools/study: {self.file} was made {what}; remove it and what lies beside it, or choose "
                              "another folder by -o", 2)

    def combined(self) -> Image | None:
        """The image of all parts: noise adds up by its squares, as the parts are independent."""
        if not all(part.image for part in self.parts):
            return None
        layers = {name: render.image.layers[name] for render in self.parts for name in render.part.layers}
        layers["beauty"] = sum(layers[name] for name in LIGHT)
        layers["noise"] = np.sqrt(sum(render.image.layers["noise"] ** 2 for render in self.parts))
        attributes = self.parts[0].image.attributes
        kept = {name: value for name, value in attributes.items() if name not in ("vkpm/runs", "vkpm/passRange")}
        return Image(layers, kept)

    def error(self) -> float:
        """The relative standard error of the whole, as root of the mean square."""
        image = self.combined()
        return float(np.sqrt(sum(part.error(image.layers["beauty"]) for part in self.parts))) if image else np.inf

    def worst(self) -> PartRender:
        """The part that most of the error comes from."""
        if (image := self.combined()) is None:
            return next(part for part in self.parts if part.image is None)
        return max(self.parts, key=lambda part: part.error(image.layers["beauty"]))

    def grow(self, seconds: float | None) -> None:
        """Renders one step further."""
        options = ["--scene", str(self.scene), "--size", self.args.size, *self.extra]
        self.worst().grow(self.vkpm, options, seconds)

    def facts(self) -> dict:
        """What is kept beside the image."""
        error = self.error()
        return {"scene": self.scene.name, "scene_digest": scene_digest(self.scene), "size": self.args.size,
                "stated_error": self.args.error, "error": error if np.isfinite(error) else None,
                "reached": error <= self.args.error,
                "measure": "sqrt(mean(noise^2 / (beauty^2 + 0.01))), noise: standard error of the mean",
                "parts": [render.facts() for render in self.parts if render.image],
                "options": self.extra, "vkpm": self.vkpm.version}

    def save(self) -> None:
        """Writes the image, with --small a small one as well, and the facts."""
        if (image := self.combined()) is None:
            return
        write_image(self.file, image)
        if self.args.small:
            light = {name: image.layers[name] for name in ("beauty", *LIGHT)}
            write_image(self.small_file(), Image(light, image.attributes), np.float16)
        new = self.file.with_suffix(".json.new")
        new.write_text(json.dumps(self.facts(), indent=2) + "\n")
        new.rename(self.file.with_suffix(".json"))

    def small_file(self) -> Path:
        """The one for tests."""
        return self.file.with_suffix(".small.exr")


def refine(reference: Reference) -> None:
    """Renders until the error is small enough or the time is over."""
    args, begin = reference.args, time.monotonic()
    form = "{desc} |{bar}| {percentage:3.0f} %, {elapsed}"
    with tqdm(total=100, disable=args.quiet or None, bar_format=form) as progress:
        while True:
            error, passes = reference.error(), sum(part.passes() for part in reference.parts)
            progress.set_description_str(f"{reference.file.stem}: {passes} passes, error {error:.3g}")
            progress.n = 100 * min(1, (args.error / error) ** 2)  # passes are as one over the error's square
            progress.refresh()
            left = None if args.time is None else args.time - (time.monotonic() - begin)
            if error <= args.error or (left is not None and left <= 0):
                return
            reference.grow(left)
            reference.save()


def make_reference(reference: Reference) -> None:
    """Makes one reference and says what came of it."""
    try:
        refine(reference)
    finally:
        reference.save()
    facts = reference.facts()
    passes = ", ".join(f"{part['passes']} passes by {part['integrator']} in {part['seconds']:.0f} s"
                       for part in facts["parts"]) or "no passes"
    error = "unknown (too few passes)" if facts["error"] is None else f"{facts['error']:.3g}"
    asked = f"{reference.args.error:g} was asked for"
    if facts["reached"]:
        say(f"{reference.file}: error {error}, {asked}; {passes}")
    else:
        say(f"{reference.file}: the time is over at an error of {error}, {asked}; {passes}; the same command goes on")
    if reference.args.small and reference.small_file().exists():
        say(f"{reference.small_file()}: {reference.small_file().stat().st_size / 1024:.0f} KiB")


def make_references(args: argparse.Namespace, options: list[str]) -> int:
    """Makes all references that were asked for, and returns an exit code."""
    files = [reference_file(args.output, scene, args.size) for scene in args.scene]
    for file in files:
        if files.count(file) > 1:
            raise Failure(f"tools/study: --scene: found two for {file.name}; allowed: different file names", 2)
    vkpm = Vkpm(args.vkpm)
    for scene in args.scene:
        make_reference(Reference(vkpm, scene, args, options))
    return 0
