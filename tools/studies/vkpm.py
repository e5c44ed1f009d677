"""Runs vkpm for the studies, and reads and writes the images that they work with."""

import os
import re
import shlex
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import flip_evaluator
import numpy as np
import OpenEXR
from tqdm import tqdm

from farming.parts import digest

ROOT = Path(__file__).resolve().parents[2]
VKPM = ROOT / "build/release/vkpm"
LIGHT = ("emission", "direct", "specular", "caustic", "indirect")  # the layers that sum to beauty

Layers = dict[str, np.ndarray]  # each of height, width and three channels


class Failure(Exception):
    """What ends a study, with a message and an exit code: 2 for wrong input, 1 for the environment."""

    def __init__(self, message: str, code: int = 1):
        super().__init__(message)
        self.code = code


def say(message: str) -> None:
    """Prints a line, above the progress bar if there is one."""
    tqdm.write(message, file=sys.stderr)


# The program.


class Vkpm:
    """The program under study: what it is, and runs of it."""

    def __init__(self, path: str):
        self.path = os.path.abspath(path)
        if not os.access(self.path, os.X_OK):
            raise Failure(f"tools/study: --vkpm: found {path}; allowed: the program vkpm", 2)
        self.hash = digest(Path(self.path).read_bytes())
        self.version = self.output("--version").splitlines()[0]
        self.has_report = re.search(r"^ *--report\b", self.output("--help"), re.MULTILINE) is not None

    def output(self, *words: str) -> str:
        """What a command of it prints."""
        process = subprocess.run([self.path, *words], capture_output=True, text=True, check=False)
        if process.returncode:
            raise failure([self.path, *words], process.returncode, process.stderr)
        return process.stdout

    def run(self, words: list[str]) -> str:
        """Runs a render to its end, a second time if the environment failed, and returns the command line."""
        command = [self.path, *words, "--quiet"]
        code, messages = finish(command)
        if code == 1:
            say(f"tools/study: vkpm ended with code 1, and is tried once more\n{messages}".rstrip())
            code, messages = finish(command)
        if code == 130:
            raise KeyboardInterrupt
        if code:
            raise failure(command, code, messages)
        if messages:
            say(messages.rstrip())
        return shlex.join(command)


def finish(command: list[str]) -> tuple[int, str]:
    """Waits for a vkpm, and returns its exit code and messages; Ctrl-C lets it save first."""
    # A session of its own keeps the terminal's Ctrl-C from it; if the study is killed, it saves and ends.
    process = subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *command], start_new_session=True, text=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    try:
        return process.wait(), process.communicate()[1]
    except KeyboardInterrupt:
        process.send_signal(signal.SIGINT)
        process.communicate()
        raise


def failure(command: list[str], code: int, messages: str) -> Failure:
    """What a vkpm said that failed, with its command line."""
    text = f"tools/study: vkpm ended with code {code}\n    {shlex.join(command)}\n{messages}"
    return Failure(text.rstrip(), 2 if code == 2 else 1)


# Images.


@dataclass
class Image:
    """Layers by their names, beauty among them, and the attributes that vkpm gave."""

    layers: Layers
    attributes: dict[str, str]

    def size(self) -> str:
        """As vkpm's option has it."""
        height, width = self.layers["beauty"].shape[:2]
        return f"{width}x{height}"


def read_image(path: Path) -> Image:
    """Reads an EXR file's layers of three colours, but not the state that --resume goes on from."""
    try:
        file = OpenEXR.File(str(path), separate_channels=True)
    except RuntimeError as error:
        raise Failure(f"tools/study: {path}: found no whole EXR file ({error}); remove it and go on", 2) from error
    channels = file.channels()
    names = [name.removesuffix(".R") for name in channels
             if name.endswith(".R") and not name.startswith(("state", "residue"))]
    prefixes = {"beauty": ""} | {name: name + "." for name in names}
    layers = {layer: np.stack([channels[prefix + c].pixels for c in "RGB"], -1).astype(np.float64)
              for layer, prefix in prefixes.items()}
    return Image(layers, {name: value for name, value in file.header().items() if name.startswith("vkpm/")})


def write_image(path: Path, image: Image, depth: type = np.float32) -> None:
    """Writes an EXR file, replacing it as a whole."""
    prefixes = {layer: "" if layer == "beauty" else layer + "." for layer in image.layers}
    channels = {prefixes[layer] + c: np.ascontiguousarray(pixels[..., i].astype(depth))
                for layer, pixels in image.layers.items() for i, c in enumerate("RGB")}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage} | image.attributes
    new = path.with_suffix(".new")
    OpenEXR.File(header, channels).write(str(new))
    new.rename(path)


# Measures.


def relative_square(error: np.ndarray, reference: np.ndarray) -> float:
    """The mean of error^2 / (reference^2 + 0.01) over pixels and colours."""
    return float(np.mean(error**2 / (reference**2 + 0.01)))


def flip(image: np.ndarray, reference: np.ndarray) -> tuple[np.ndarray, float]:
    """HDR-FLIP (Andersson et al. 2021): its map in the colours of magma, and its mean; black if it is not defined."""
    luminance = reference @ (0.2126, 0.7152, 0.0722)
    if not 0 < np.median(luminance) < np.max(luminance):  # it finds no exposures
        return np.zeros_like(reference), float("nan")
    pair = [np.maximum(pixels, 0).astype(np.float32) for pixels in (reference, image)]
    errors, mean, _ = flip_evaluator.evaluate(*pair, "HDR")
    return errors, float(mean)
