"""A study: the cells of its matrix, each rendered once, and what they leave in their folders."""

import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from pathlib import Path

import numpy as np
from tqdm import tqdm

from farm_parts import digest
from study_curves import Row, layer_curve, read_rows, write_rows
from study_page import write_page
from study_reference import reference_file, scene_digest
from study_vkpm import LIGHT, ROOT, Failure, Image, Vkpm, flip, read_image, relative_square, say

ABOUT_PHOTONS = {"photons", "caustic-photons", "radius", "caustic-radius", "nearest", "alpha", "kernel", "gather-rays"}
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


# What is rendered.


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

    def render(self) -> None:
        """Renders from the beginning; a cell that was interrupted has used its time unevenly."""
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        commands = measure_by_vkpm(self) if self.study.vkpm.has_report else measure_by_steps(self)
        image = self.image()
        facts = {"name": self.name, "identity": self.identity(), "commands": commands, "commit": self.study.commit,
                 "version": self.study.vkpm.version, "device": image.attributes["vkpm/device"],
                 "passes": int(image.attributes["vkpm/passes"]),
                 "flip": flip(image.layers["beauty"], self.truth.image.layers["beauty"])[1]}
        new = self.folder / "cell.new"
        new.write_text(json.dumps(facts, indent=2) + "\n")
        new.rename(self.folder / "cell.json")


def curve(cell: Cell) -> list[Row]:
    """Error against time of a cell, which is rendered if it is not finished."""
    if cell.facts() is None:
        cell.render()
    return read_rows(cell.folder / "error.csv")


def measure_by_vkpm(cell: Cell) -> list[str]:
    """Has vkpm compare while it renders; returns the command lines."""
    words = ["--time", f"{cell.study.args.time:g}", "--reference", str(cell.truth.file), "--report", str(cell.folder),
             "--stats", str(cell.folder / "stats.json"), "-o", str(cell.folder / "final.exr")]
    return [cell.study.vkpm.run([*cell.options(cell.study.args.size), *words])]


def measure_by_steps(cell: Cell) -> list[str]:
    """Stops after 1, 2, 4 ... passes until the time is over, and compares; returns the command lines."""
    output, stats, rows, commands = cell.folder / "final.exr", cell.folder / "stats.json", [], []
    passes, seconds, rays, photons = 0, 0.0, 0, 0
    left = cell.study.args.time
    while left > 0:
        wanted = max(1, 2 * passes)
        words = ["--passes", str(wanted), "--time", f"{left:.3f}", "--resume", "--stats", str(stats), "-o", str(output)]
        commands.append(cell.study.vkpm.run([*cell.options(cell.study.args.size), *words]))
        facts = json.loads(stats.read_text())
        passes = facts["passes"]
        seconds += facts["seconds"]["render"]  # of this run alone, as are the others
        rays += facts["rays"]
        photons += sum(chart["emitted"] for chart in facts["photons"].values())
        rows += compare(cell, passes, seconds, rays, photons)
        left = cell.study.args.time - seconds if passes == wanted else 0
        if 0 < left < 0.5 * seconds / passes:  # less than half a pass, as vkpm rounds
            left = 0
    write_rows(cell.folder / "error.csv", rows)
    return commands


def compare(cell: Cell, passes: int, seconds: float, rays: int, photons: int) -> list[Row]:
    """Rows of what a cell has rendered by now."""
    image, truth, rows = cell.image().layers, cell.truth.image.layers, []
    for layer in ("beauty", *LIGHT):
        apart = image[layer] - truth[layer]
        row = Row(passes, seconds, rays, photons, layer, rmse=float(np.sqrt(np.mean(apart**2))),
                  relmse=relative_square(apart, truth[layer]), mean_error=float(np.mean(apart)))
        if layer == "beauty":
            row.flip = flip(image[layer], truth[layer])[1]
            row.noise = float(np.sqrt(np.mean(image["noise"] ** 2))) if "noise" in image else row.noise
        rows.append(row)
    return rows


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

    def render(self) -> None:
        """Renders the cells that are not finished."""
        todo = [cell for cell in self.cells if cell.facts() is None]
        for cell in todo:
            cell.check()
        done = len(self.cells) - len(todo)
        with tqdm(total=len(self.cells), initial=done, unit="cell", disable=self.args.quiet or None) as progress:
            for cell in todo:
                progress.set_description_str(cell.name)
                beauty = layer_curve(curve(cell), "beauty")
                if len(beauty.errors):
                    say(f"{cell.name}: relMSE {beauty.errors[-1]:.3g} after {beauty.seconds[-1]:.3g} s")
                progress.update()


def run_study(args: argparse.Namespace, options: list[str]) -> int:
    """Renders and writes the page, and returns an exit code."""
    if len({scene.stem for scene in args.scenes}) < len(args.scenes):
        raise Failure("tools/study: --scenes: found two of one file name; allowed: different file names", 2)
    study = Study(args, options)
    study.render()
    say(f"tools/study: wrote {write_page(study)}")
    return 0
