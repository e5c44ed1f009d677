"""A window of vkpm on a display without a screen, seen and used from outside."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageGrab

from waiting import PATIENCE, eventually

VKPM = str(Path(sys.argv[1]).resolve())
Box = tuple[int, int, int, int]


@contextmanager
def display(density: int = 1) -> Iterator[dict[str, str]]:
    """The environment of a display of its own, on a number that is free."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1600x1200x24", "-nolisten", "tcp", "-noreset"]
    with subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        try:
            number = os.fdopen(read).readline().strip()
            environment = {**os.environ, "DISPLAY": f":{number}", "DISPLAY_SERVER": str(server.pid)}
            if density != 1:
                resource = ["-f", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER", f"Xft.dpi: {96 * density}\n"]
                subprocess.run(["xprop", "-root", *resource], env=environment, check=True)
            yield environment
        finally:
            server.terminate()


class Window:
    """A vkpm view that runs, seen and used from outside."""

    def __init__(self, environment: dict[str, str], folder: Path, scene: Path, *options: str) -> None:
        self.environment = environment
        self.output, self.log = folder / "window.exr", folder / "window.jsonl"
        self.log.unlink(missing_ok=True)
        command = [VKPM, "view", "--scene", str(scene), "-o", str(self.output), "--log", str(self.log), "--quiet",
                   *options]
        self.process = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True)
        self.size = self.await_event("window")["size"]
        self.panel = self.events("window")[0]["panel"]
        search = ["search", "--all", "--pid", str(self.process.pid), "--name", "vkpm"]
        self.id = eventually("the window", lambda: self.xdotool(*search, check=False).split())[0]
        self.await_event("first draft")

    def xdotool(self, *words: object, check: bool = True) -> str:
        """Runs xdotool on the display."""
        command = ["xdotool", *[str(word) for word in words]]
        return subprocess.run(command, env=self.environment, check=check, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True, timeout=PATIENCE).stdout

    def events(self, name: str) -> list[dict[str, Any]]:
        """What the log has of an event."""
        lines = self.log.read_text().splitlines() if self.log.exists() else []
        return [event for event in map(json.loads, lines) if event["event"] == name]

    def await_event(self, name: str, count: int = 1) -> dict[str, Any]:
        """Waits for so many events of a name, and returns the last."""

        def look() -> dict[str, Any] | None:
            if self.process.poll() is not None:
                raise AssertionError(f"vkpm ended with {self.process.returncode}: {self.process.stderr.read()}")
            found = self.events(name)
            return found[-1] if len(found) >= count else None

        return eventually(f"{count} times {name}", look)

    def await_passes(self, passes: int) -> None:
        """Waits until so many passes are there since the last start, and no other start follows for a second."""

        def look() -> bool:
            text = self.log.read_text()
            return f'"pass":{passes - 1},' in text[text.rfind('"event":"start"') :]

        def rests() -> bool:
            starts = len(self.events("start"))
            eventually(f"{passes} passes", look)
            time.sleep(1)
            return look() and starts == len(self.events("start"))

        eventually("a rest", rests)

    def key(self, *keys: str) -> None:
        """Presses keys, one after another, in this window."""
        self.xdotool("windowfocus", "--sync", self.id, "key", *keys)

    def drag(self, begin: tuple[int, int], steps: int, step: tuple[int, int], button: int = 1,
             pause: float = 0.02) -> None:
        """Drags with a button in small steps."""
        self.xdotool("mousemove", *begin, "mousedown", button)
        for _ in range(steps):
            self.xdotool("mousemove_relative", "--", *step)
            time.sleep(pause)
        self.xdotool("mouseup", button)

    def screen(self) -> np.ndarray:
        """The whole display."""
        return np.asarray(ImageGrab.grab(xdisplay=self.environment["DISPLAY"]).convert("RGB")).astype(int)

    def shows(self, picture: np.ndarray, corner: tuple[int, int], tolerance: int = 0) -> None:
        """Waits until a picture is on the display, with its corner there; values may be off by a tolerance."""
        height, width = picture.shape[:2]
        x, y = corner

        def off() -> int:
            return int(np.abs(self.screen()[y : y + height, x : x + width] - picture).max())

        try:
            eventually("a picture on the display", lambda: off() <= tolerance, 60)
        except AssertionError as error:
            Image.fromarray(self.screen().astype(np.uint8)).save(tempfile.gettempdir() + "/vkpm-window-test.png")
            where = f"the display is in {tempfile.gettempdir()}/vkpm-window-test.png"
            raise AssertionError(f"{error}: off by {off()}, {where}") from None

    def place(self, film: tuple[int, int]) -> tuple[int, int]:
        """The corner of a film that fits beside the panel as it is."""
        return (self.size[0] - self.panel - film[0]) // 2, (self.size[1] - film[1]) // 2

    def resize(self, width: int, height: int) -> None:
        """Gives the window another size."""
        self.xdotool("windowsize", "--sync", self.id, width, height)
        self.size = [width, height]

    def camera(self) -> str:
        """What C copies to the clipboard."""
        self.key("c")
        command = ["xclip", "-out", "-selection", "clipboard"]

        def look() -> str:
            found = subprocess.run(command, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                   text=True, timeout=PATIENCE, check=False).stdout
            return found if found.startswith('{"origin"') else ""

        return eventually("the camera", look)

    def close(self, code: int = 0) -> None:
        """Closes the window as the desktop does, and expects an exit code and nothing to complain about."""
        if code == 0:
            self.key("ctrl+q")
        messages = self.process.communicate(timeout=PATIENCE)[1]
        assert self.process.returncode == code, (self.process.returncode, messages)
        assert code or messages == "", messages


@contextmanager
def window(environment: dict[str, str], folder: Path, scene: Path, *options: str) -> Iterator[Window]:
    """A window that ends with the block at the latest."""
    opened = Window(environment, folder, scene, *options)
    try:
        yield opened
    finally:
        opened.process.kill()
        opened.process.communicate()


def render(scene: Path, folder: Path, *options: str) -> Path:
    """The file of the same render without a window."""
    output = folder / "headless.exr"
    plain = {name: value for name, value in os.environ.items() if name != "VKPM_VALIDATION"}
    subprocess.run([VKPM, "--scene", str(scene), "-o", str(output), "--quiet", *options], env=plain, check=True)
    return output
