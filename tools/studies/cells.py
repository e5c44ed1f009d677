"""The matrix of a study: variants of scenes, integrators and settings, and its cells, one for each variant and seed."""

import argparse
import json
import os
import platform
import re
import subprocess
import tempfile
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from pathlib import Path

from farming.parts import digest
from studies.reference import reference_file, scene_digest
from studies.vkpm import LIGHT, ROOT, Failure, Image, Vkpm, read_image, relative_square

ABOUT_PHOTONS = {"photons", "caustic-photons", "radius", "caustic-radius", "nearest", "alpha", "kernel", "gather-rays",
                 "pixel-samples"}
WITHOUT_PHOTONS = {"path", "direct"}


# What is studied.


@dataclass(frozen=True)
class Variant:
    """A cell of the matrix: an integrator and values of options, for one scene; each seed is a render."""

    scene: Path
    integrator: str
    values: tuple[tuple[str, str], ...]

    def label(self) -> str:
        """Its name within the scene."""
        return " ".join((self.integrator, *(f"{name}={value}" for name, value in self.values)))

    def name(self) -> str:
        """As in: box photon photons=50000."""
        return f"{self.scene.stem} {self.label()}"

    def options(self) -> list[str]:
        """What makes it, for vkpm."""
        words = (word for name, value in self.values for word in (f"--{name}", value))
        return ["--integrator", self.integrator, *words]


def matrix(args: argparse.Namespace) -> list[Variant]:
    """All variants, each once: options about photons do not multiply integrators without photons."""
    variants = {}
    axes = [[(name, value) for value in values] for name, values in args.axis]
    combined = [(pair,) for axis in axes for pair in axis] if args.alone else list(product(*axes))
    for scene, integrator, values in product(args.scenes, args.integrators, combined):
        kept = tuple(pair for pair in values if integrator not in WITHOUT_PHOTONS or pair[0] not in ABOUT_PHOTONS)
        variants[Variant(scene, integrator, kept)] = None
    return list(variants)


class Truth:
    """A scene's reference, and its own relative mean square error."""

    def __init__(self, scene: Path, args: argparse.Namespace):
        self.file = reference_file(args.references, scene, args.size)
        make = f"tools/study reference --scene {scene} --size {args.size} -o {args.references}"
        if not self.file.is_file():
            raise Failure(f"tools/study: there is no reference {self.file}; make it by\n    {make}", 2)
        self.image = read_image(self.file)
        self.facts = json.loads(facts.read_text()) if (facts := self.file.with_suffix(".json")).is_file() else {}
        if missing := {"beauty", *LIGHT} - self.image.layers.keys():
            names = ", ".join(sorted(missing))
            raise Failure(f"tools/study: {self.file}: found no {names}; make it anew by\n    {make}", 2)
        if self.image.size() != args.size:
            raise Failure(f"tools/study: {self.file}: found {self.image.size()} pixels; allowed: {args.size}", 2)
        self.scene_hash = scene_digest(scene)
        if self.facts and self.facts["scene_digest"] != self.scene_hash:
            raise Failure(f"tools/study: {self.file} was made of another state of {scene}; remove it and its .state, "
                          f"and make it anew by\n    {make}", 2)
        self.hash = digest(self.file.read_bytes())

    @cached_property
    def own_error(self) -> float:
        """The expected relative mean square error of its beauty; zero if it does not say."""
        noise = self.image.layers.get("noise")
        return 0.0 if noise is None else relative_square(noise, self.image.layers["beauty"])


def machine() -> dict:
    """The processor, its cores that may be used, and the system."""
    info = Path("/proc/cpuinfo")
    model = re.search(r"^model name\s*:\s*(.*)$", info.read_text(), re.MULTILINE) if info.exists() else None
    return {"cpu": model[1] if model else platform.processor() or platform.machine(),
            "cores": len(os.sched_getaffinity(0)), "system": f"{platform.system()} {platform.release()}"}


def commit() -> str:
    """The commit of the source, and whether it was changed since."""
    words = ["git", "-C", str(ROOT), "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]
    process = subprocess.run(words, capture_output=True, text=True, check=False)
    return process.stdout.strip().replace("-dirty", " with changes") or "unknown"


def chosen_device(devices: list[dict], options: list[str]) -> dict:
    """The one that --device names, else all: vkpm takes the best."""
    words = [word for option in options for word in option.split("=", 1)]
    if "--device" in words[:-1]:
        wanted = words[words.index("--device") + 1]
        named = [device for device in devices if wanted in (str(device["index"]), device["name"])]
        devices = named or [device for device in devices if wanted in device["name"]] or devices
    return {"devices": [f"{device['name']}, {device['driver']}" for device in devices]}


# The cells.


class Cell:
    """One variant and seed, and its folder: error.csv, final.exr, and cell.json once it is finished."""

    def __init__(self, study: "Study", variant: Variant, seed: int):
        self.study, self.variant, self.seed = study, variant, seed
        self.name = f"{variant.name()} seed={seed}"
        self.truth = study.truths[variant.scene]
        self.folder = study.args.output / "cells" / re.sub(r"[^\w.=-]+", "-", self.name)

    def options(self, size: str) -> list[str]:
        """Everything for vkpm but how long and where to."""
        return ["--scene", str(self.variant.scene), "--size", size, *self.variant.options(), "--seed", str(self.seed),
                *self.study.options]

    def identity(self) -> dict:
        """What its numbers depend on."""
        args, study = self.study.args, self.study
        return {"options": self.options(args.size)[2:], "scene": self.truth.scene_hash, "time": args.time,
                "reference": self.truth.hash, "vkpm": study.vkpm.hash, "machine": study.machine, **study.device}

    def facts(self) -> dict | None:
        """What cell.json says, if it is finished and nothing has changed since."""
        try:
            facts = json.loads((self.folder / "cell.json").read_text())
        except (OSError, ValueError):
            return None
        return facts if facts.get("identity") == json.loads(json.dumps(self.identity())) else None

    def image(self) -> Image:
        """What was rendered in the time."""
        return read_image(self.folder / "final.exr")

    def check(self) -> None:
        """Has vkpm look at its options, by a pass of a few pixels."""
        with tempfile.TemporaryDirectory(prefix="vkpm-study-") as folder:
            self.study.vkpm.run([*self.options("8x8"), "--passes", "1", "-o", str(Path(folder, "check.exr"))])


class Study:
    """The matrix with what all cells share."""

    def __init__(self, args: argparse.Namespace, options: list[str]):
        self.args, self.options = args, options
        self.truths = {scene: Truth(scene, args) for scene in args.scenes}
        self.vkpm = Vkpm(args.vkpm)
        self.machine, self.commit = machine(), commit()
        self.device = chosen_device(json.loads(self.vkpm.output("devices", "--json")), options)
        self.variants = matrix(args)
        # All cells get their first seed before any gets its second.
        self.cells = [Cell(self, variant, seed) for seed in range(args.repeat) for variant in self.variants]
