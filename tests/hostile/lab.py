"""Renders of hostile scenes: what vkpm said, wrote and took, and the checks that hold for all of them."""

import copy
import hashlib
import json
import os
import subprocess
import threading
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
LIGHT = ("emission", "direct", "specular", "caustic", "indirect")  # the layers that sum to beauty
TRUTHS = ROOT / "tests" / "data" / "hostile_truths.json"  # means by path tracing, see Lab.truth
HANG = 300  # seconds after which a render hangs

Scene = dict
OPTIONS = {"--passes": "4", "--photons": "20000", "--caustic-photons": "20000"}


class Refused(Exception):
    """A render that gave no picture was asked for one."""


@dataclass
class Render:
    """One run of the program."""

    file: Path
    command: list[str]
    code: int = -1
    messages: str = ""
    problems: list[str] = field(default_factory=list)  # of those that no render may have

    @cached_property
    def channels(self) -> dict[str, np.ndarray]:
        """All channels of the EXR file by name, without the state that a render goes on from."""
        if self.code:
            raise Refused(self.problems)
        channels = OpenEXR.File(str(self.file), separate_channels=True).channels()
        return {name: channel.pixels for name, channel in channels.items()}

    @cached_property
    def stats(self) -> dict:
        """What --stats wrote."""
        if self.code:
            raise Refused(self.problems)
        return json.loads(self.file.with_suffix(".json").read_bytes())

    def layer(self, name: str = "beauty") -> np.ndarray:
        """Height x width x 3 in doubles; black if the scene has no such layer."""
        prefix = "" if name == "beauty" else name + "."
        black = np.zeros_like(self.channels["R"])
        return np.stack([self.channels.get(prefix + c, black) for c in "RGB"], -1).astype(np.float64)

    def mean(self, name: str = "beauty") -> float:
        """Of a layer, over pixels and colours."""
        return float(self.layer(name).mean())

    @property
    def seconds(self) -> float:
        """Of rendering, without starting up."""
        return self.stats["seconds"]["render"]

    def photons(self, kind: str) -> dict[str, int]:
        """The ledger of a map."""
        return self.stats["photons"][kind]


@dataclass
class Truth:
    """Means of layers by another integrator, by name and colour."""

    means: dict[str, list[float]]

    def mean(self, name: str = "beauty") -> float:
        """Of a layer, over pixels and colours."""
        return float(np.mean(self.means[name]))


@dataclass
class Verdict:
    """What a case came to: the hostile render, its tame sibling, and the check of its own."""

    render: Render
    tame: Render | None
    measured: str
    holds: bool
    work: float = 1  # how much more than its sibling it has to do


class Lab:
    """Renders scenes, each once, in a folder; threads may share it."""

    def __init__(self, vkpm: str, folder: Path, environment: dict[str, str]):
        self.vkpm = str(Path(vkpm).resolve())
        self.folder = folder
        self.environment = os.environ | environment
        self.known: dict[str, Render] = {}
        self.locks: dict[str, threading.Lock] = defaultdict(threading.Lock)
        self.meshes: dict[str, str] = {}
        self.truths = json.loads(TRUTHS.read_bytes())
        self.traced: dict[str, dict] = {}  # truths of this run
        self.traces_all = False
        self.retraces = not environment  # other drivers take other paths here and there: they are judged by the file

    def render(self, scene: Scene, *options: str) -> Render:
        """A render of a scene, with pairs of options that win over those of OPTIONS."""
        text = json.dumps(scene)
        pairs = OPTIONS | dict(zip(options[::2], options[1::2], strict=True))
        words = [word for pair in pairs.items() for word in pair]
        key = hashlib.sha256(repr((text, words)).encode()).hexdigest()[:16]
        with self.locks[key]:
            if key not in self.known:
                file = self.folder / f"{key}.exr"
                file.with_suffix(".scene.json").write_text(text)
                self.known[key] = self.run(file, words)
            return self.known[key]

    def mesh(self, name: str, points: list, triangles: list) -> str:
        """Writes an OBJ file beside the scenes; triangles are indices of points."""
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points]
        lines += ["f " + " ".join(str(i + 1) for i in corners) for corners in triangles]
        self.meshes[name] = "\n".join(lines) + "\n"
        (self.folder / name).write_text(self.meshes[name])
        return name

    def image(self, name: str, texels: np.ndarray) -> str:
        """Writes an image beside the scenes: an OpenEXR file of floats, or a PNG of bytes; height x width x 3."""
        file = self.folder / name
        if file.suffix == ".exr":
            channels = {"RGB": OpenEXR.Channel(np.ascontiguousarray(texels))}
            OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION}, channels).write(str(file))
        else:
            Image.fromarray(texels).save(file)
        return name

    def truth(self, scene: Scene, *options: str) -> Truth:
        """Means of a render that others are judged by: those in TRUTHS of this scene, its meshes and these options.

        One of sixteen, by the number VKPM_DRAW_SEED, is rendered anew, and held against them where the device is
        lavapipe, which rendered them."""
        meshes = [self.meshes.get(shape.get("file"), "") for shape in scene["shapes"]]
        key = hashlib.sha256(repr((json.dumps(scene), options, meshes)).encode()).hexdigest()[:16]
        drawn = self.retraces and (int(key, 16) + int(os.environ.get("VKPM_DRAW_SEED", "1"))) % 16 == 0
        known = self.truths.get(key)
        if known and not drawn and not self.traces_all:
            return Truth(known)
        render = self.render(scene, *options)
        means = {name: render.layer(name).mean((0, 1)).tolist() for name in ("beauty", *LIGHT)}
        self.traced[key] = means
        if known and not self.traces_all and "llvmpipe" in render.stats["device"]:
            for name, mean in means.items():
                if not np.allclose(mean, known[name], rtol=0, atol=0.002 * np.mean(known["beauty"])):
                    raise Refused([f"{TRUTHS.name} has {known[name]} for {name}, and {mean} is rendered; "
                                   "tools/extremes --truths renders all anew"])
        return Truth(means)

    def run(self, file: Path, words: list[str]) -> Render:
        """Runs the program on the scene beside a file."""
        command = [self.vkpm, "--scene", str(file.with_suffix(".scene.json")), "-o", str(file), "--quiet",
                   "--stats", str(file.with_suffix(".json")), *words]
        render = Render(file, command)
        try:
            process = subprocess.run(command, capture_output=True, text=True, timeout=HANG, check=False,
                                     env=self.environment)
        except subprocess.TimeoutExpired:
            render.problems = [f"hangs: no end after {HANG} s"]
            return render
        render.code, render.messages = process.returncode, process.stderr.strip()
        render.problems = problems(render)
        return render

    def time_again(self, render: Render) -> None:
        """Runs the same once more, and keeps the better time."""
        before = render.seconds
        subprocess.run(render.command, capture_output=True, timeout=HANG, check=True, env=self.environment)
        del render.stats
        render.stats["seconds"]["render"] = min(before, render.seconds)


def problems(render: Render) -> list[str]:
    """What is wrong with a render whatever its scene is."""
    if render.code:
        return [f"ends with code {render.code}: {render.messages}"]
    found = [f"{name} has values that are not finite" for name, pixels in render.channels.items()
             if not np.isfinite(pixels).all()]
    if render.stats["nonfinite"]:
        found.append(f"{render.stats['nonfinite']} samples were not finite")
    for kind, count in render.stats["photons"].items():
        if count["emitted"] != count["absorbed"] + count["escaped"] + count["lost"]:
            found.append(f"the ledger of {kind} photons does not add up")
        if count["lost"]:
            found.append(f"{count['lost']} {kind} photons were lost")
    return found


# Cases.


@dataclass
class Case:
    """A hostile scene, or several."""

    group: str
    name: str
    expected: str
    judge: Callable[[Lab], Verdict]
    heavy: bool = False  # gigabytes or minutes


CASES: list[Case] = []


def case(group: str, name: str, expected: str, heavy: bool = False) -> Callable:
    """Registers what renders and judges a case."""
    def register(judge: Callable[[Lab], Verdict]) -> Callable[[Lab], Verdict]:
        CASES.append(Case(group, name, expected, judge, heavy))
        return judge
    return register


# Scenes.


def shipped(name: str) -> Scene:
    """A shipped scene, small."""
    scene = json.loads((ROOT / "scenes" / f"{name}.json").read_bytes())
    scene["film"] = {"size": [64, 64]}
    scene.pop("settings", None)
    return scene


def changed(scene: Scene, **members: object) -> Scene:
    """A copy with other members."""
    return copy.deepcopy(scene) | copy.deepcopy(members)


def scaled(scene: Scene, factor: float) -> Scene:
    """All lengths times a factor."""
    def times(value: object) -> object:
        return [times(x) for x in value] if isinstance(value, list) else value * factor
    scene = copy.deepcopy(scene)
    for holder in (scene["camera"], *scene["shapes"]):
        for key in ("origin", "target", "corner", "edges", "center", "radius"):
            if key in holder:
                holder[key] = times(holder[key])
    return scene


def moved(scene: Scene, by: tuple[float, float, float]) -> Scene:
    """All places moved."""
    scene = copy.deepcopy(scene)
    for holder in (scene["camera"], *scene["shapes"]):
        for key in ("origin", "target", "corner", "center"):
            if key in holder:
                holder[key] = [x + d for x, d in zip(holder[key], by, strict=True)]
    return scene


def brighter(scene: Scene, factor: float) -> Scene:
    """All emission times a factor."""
    scene = copy.deepcopy(scene)
    for shape in scene["shapes"]:
        if "emission" in shape:
            shape["emission"] = [x * factor for x in shape["emission"]]
    return scene


def without(scene: Scene, *names: str) -> Scene:
    """Some shapes left out."""
    return changed(scene, shapes=[shape for shape in scene["shapes"] if shape["name"] not in names])


def plus(scene: Scene, *shapes: dict, **materials: dict) -> Scene:
    """More shapes and materials."""
    return changed(scene, shapes=scene["shapes"] + list(shapes), materials=scene["materials"] | materials)


BOX = shipped("box")
BALL = [0.45, -0.65, 0.25]  # the centre of its glass ball, 0.35 wide


def rectangle(corner: list, u: list, v: list, **rest: object) -> dict:
    """A shape."""
    return {"name": "added", "type": "rectangle", "corner": corner, "edges": [u, v], **rest}


def sphere(center: list, radius: float, **rest: object) -> dict:
    """A shape."""
    return {"name": "added", "type": "sphere", "center": center, "radius": radius, **rest}


# Checks.


def off(found: float, expected: float) -> float:
    """Relative difference."""
    return found / expected - 1 if expected else np.inf


def percent(x: float) -> str:
    """With its sign."""
    if x == 0:
        return "0"
    return f"{100 * x:+.2g} %" if abs(x) >= 1e-5 else f"{x:+.0e}"


def same_bits(found: Render, expected: Render, factor: float = 1) -> tuple[str, bool]:
    """Whether all light is the same to the bit, up to a factor."""
    differing = sum(int((found.layer(name) != expected.layer(name) * factor).any(-1).sum()) for name in LIGHT)
    return ("the same bits" if differing == 0 else f"{differing} pixels of layers differ"), differing == 0


def same_means(found: Render, expected: Render | Truth, tolerance: float, layers: tuple = LIGHT,
               factor: float = 1) -> tuple[str, bool]:
    """Whether means of layers are the same within a part of the mean of beauty."""
    whole = expected.mean() * factor
    differences = {name: (found.mean(name) - factor * expected.mean(name)) / whole for name in layers}
    worst = max(differences, key=lambda name: abs(differences[name]))
    return f"{percent(differences[worst])} ({worst})", abs(differences[worst]) <= tolerance


def same_pixels(found: Render, expected: Render, layer: str, tolerance: float) -> tuple[str, bool]:
    """Whether a layer's relative mean square error is below a tolerance."""
    truth = expected.layer(layer)
    error = float(((found.layer(layer) - truth) ** 2 / (truth ** 2 + 0.01)).mean())
    return f"relMSE {error:.1g}", error <= tolerance


def against_path(lab: Lab, scene: Scene, tolerance: float, tame: Scene = BOX, passes: str = "128",
                 layers: tuple = ("beauty",)) -> Verdict:
    """The photon mapper's means against the path tracer's, as parts of the whole."""
    render = lab.render(scene, "--passes", "16")
    truth = lab.truth(scene, "--integrator", "path", "--passes", passes)
    text, holds = same_means(render, truth, tolerance, layers)
    return Verdict(render, lab.render(tame, "--passes", "16"), text, holds)
