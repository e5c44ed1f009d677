"""The window for real: on a display without a screen, with keys, mouse and sizes from outside, pictures against files.

window_test.py VKPM runs all tests, window_test.py VKPM --short those of one window, for builds in which kernels take
long; window_test.py VKPM --measure prints how fast the window opens, how smoothly the camera moves, and how long input
may wait.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

from waiting import PATIENCE, eventually
from window_driver import VKPM, display, render, window

ROOT = Path(__file__).resolve().parent.parent
BOX = ROOT / "scenes/box.json"
SMALL = ["--size", "160x120", "--photons", "3000", "--caustic-photons", "3000"]


def png_of(exr: Path) -> np.ndarray:
    """The PNG beside a render."""
    return np.asarray(Image.open(exr.with_suffix(".png"))).astype(int)


def expect_same_files(a: Path, b: Path) -> None:
    """Both EXR and both PNG are the same, byte by byte."""
    for suffix in (".exr", ".png"):
        own, other = a.with_suffix(suffix), b.with_suffix(suffix)
        assert own.read_bytes() == other.read_bytes(), f"{own} differs from {b}"


def srgb(linear: np.ndarray) -> np.ndarray:
    """Linear values as bytes (IEC 61966-2-1)."""
    c = np.clip(linear, 0, 1)
    return np.rint(255 * np.where(c > 0.0031308, 1.055 * c ** (1 / 2.4) - 0.055, 12.92 * c)).astype(int)


def layers_of(exr: Path) -> list[np.ndarray]:
    """The ten layers of a render as the window is to show them, developed from the file."""
    with OpenEXR.File(str(exr), separate_channels=True) as file:
        channels = {name: channel.pixels for name, channel in file.channels().items()}

    def layer(name: str, letters: str = "RGB") -> np.ndarray:
        return np.stack([channels[name + letter] for letter in letters], axis=-1)

    light = [srgb(layer(name))
             for name in ("", "emission.", "direct.", "specular.", "caustic.", "indirect.", "albedo.")]
    normal = np.rint(255 * (0.5 * layer("normal.", "XYZ") + 0.5)).astype(int)
    return [*light, normal, srgb(8 * layer("noise.")), srgb(8 * np.abs(layer("bias.")))]


def with_camera(scene: Path, camera: str, folder: Path) -> Path:
    """A copy of a scene, of the same name, into which a camera was pasted."""
    text = scene.read_text()
    begin = text.index("{", text.index('"camera"'))
    (folder / "pasted").mkdir(exist_ok=True)
    copy = folder / "pasted" / scene.name
    copy.write_text(text[:begin] + camera + text[text.index("}", begin) + 1 :])
    return copy


def shows_layers_and_saves(environment: dict[str, str], folder: Path) -> None:
    """All layers by their keys; saving and closing write the headless files."""
    expected = render(BOX, folder, *SMALL, "--passes", "4")
    with window(environment, folder, BOX, *SMALL, "--passes", "4") as shown:
        corner = shown.place((160, 120))
        shown.shows(png_of(expected), corner)
        pictures = layers_of(expected)
        for number, picture in enumerate(pictures[1:], 2):
            shown.key(str(number % 10))
            shown.shows(picture, corner, 1)
        shown.key("1")
        shown.shows(png_of(expected), corner)
        shown.key("ctrl+s")
        shown.await_event("save")
        expect_same_files(shown.output, expected)
        shown.output.unlink()
        shown.close()
        expect_same_files(shown.output, expected)


def moves_the_camera(environment: dict[str, str], folder: Path) -> None:
    """Drags, wheel, keys and double clicks move the camera; at rest picture and file are a headless render's."""
    with window(environment, folder, BOX, *SMALL, "--passes", "3") as shown:
        corner = shown.place((160, 120))
        middle = (corner[0] + 80, corner[1] + 60)
        cameras = [shown.camera()]

        def expect_moved(what: str) -> None:
            eventually(what, lambda: shown.camera() not in cameras)
            cameras.append(shown.camera())

        shown.drag(middle, 20, (2, 1))
        expect_moved("an orbit")
        shown.drag(middle, 5, (-2, 1), button=3)
        expect_moved("a pan")
        shown.xdotool("click", "--repeat", 2, 4)
        expect_moved("the wheel")
        for key in ("w", "Right", "shift+Up", "minus"):
            shown.key(key)
            expect_moved(key)
        shown.await_passes(3)
        target = json.loads(cameras[-1])["target"]
        shown.xdotool("mousemove", middle[0] + 30, middle[1] + 20, "click", "--repeat", 2, "--delay", 60, 1)
        expect_moved("the focus")
        assert json.loads(cameras[-1])["target"] != target
        assert json.loads(cameras[-1])["origin"] == json.loads(cameras[-2])["origin"]
        drafts = [event for event in shown.events("moved") if event["frames"] > 2]
        assert drafts, "no draft was shown"
        assert all(event["width"] <= 80 for event in drafts), drafts

        expected = render(with_camera(BOX, cameras[-1], folder), folder, *SMALL, "--passes", "3")
        shown.shows(png_of(expected), corner)
        shown.close()
        expect_same_files(shown.output, expected)

    with window(environment, folder, BOX, *SMALL, "--passes", "2") as shown:
        shown.drag(middle, 10, (3, 1))
        shown.key("Home")
        shown.await_passes(2)
        expected = render(BOX, folder, *SMALL, "--passes", "2")
        shown.shows(png_of(expected), corner)
        shown.close()
        expect_same_files(shown.output, expected)


def reloads_the_scene(environment: dict[str, str], folder: Path) -> None:
    """An edited scene is shown, from where the camera is; a broken one leaves the picture."""
    scene = folder / "edited.json"
    text = BOX.read_text()
    scene.write_text(text)
    with window(environment, folder, scene, *SMALL, "--passes", "2") as shown:
        corner = shown.place((160, 120))
        before = png_of(render(scene, folder, *SMALL, "--passes", "2"))
        shown.shows(before, corner)
        plain = shown.screen()
        scene.write_text(text.replace("0.725", '"white"'))
        broken = shown.await_event("broken scene")
        assert "edited.json: /materials/white/albedo" in broken["cause"], broken
        eventually("the error in the panel", lambda: np.abs(shown.screen() - plain).max() > 50)
        shown.shows(before, corner)
        scene.write_text(text.replace("[0.63, 0.065, 0.05]", "[0.05, 0.065, 0.63]"))
        shown.await_event("reload")
        expected = render(scene, folder, *SMALL, "--passes", "2")
        assert np.abs(png_of(expected) - before).max() > 50
        shown.shows(png_of(expected), corner)

        shown.drag((corner[0] + 80, corner[1] + 60), 10, (2, 1))
        shown.await_passes(2)
        camera = shown.camera()
        scene.write_text(text)
        shown.await_event("reload", 2)
        shown.await_passes(2)
        expected = render(with_camera(scene, camera, folder), folder, *SMALL, "--passes", "2")
        shown.shows(png_of(expected), corner)
        shown.close()
        expect_same_files(shown.output, expected)


def keeps_passes_of_what_cannot_be_rendered(environment: dict[str, str], folder: Path) -> None:
    """A scene that cannot be rendered, and a film that no report fits: said, and the passes that are there go on."""
    scene = folder / "refused.json"
    text = BOX.read_text()
    scene.write_text(text)
    reference = render(scene, folder, *SMALL, "--passes", "2").rename(folder / "reference.exr")
    with window(environment, folder, scene, *SMALL, "--report", str(folder / "report"),
                "--reference", str(reference)) as shown:
        shown.await_passes(2)
        scene.write_text(text.replace('"camera"', '"settings": {"radius": 1e-20}, "camera"'))
        assert "radius" in shown.await_event("broken scene")["cause"]
        passes = len(shown.events("pass"))
        shown.resize(500 + shown.panel, 400)
        shown.key("g")
        eventually("passes after what was refused", lambda: len(shown.events("pass")) > passes + 2)
        assert len(shown.events("start")) == 1, shown.events("start")
        shown.process.send_signal(signal.SIGHUP)
        shown.close(130)
        done = str(shown.events("end")[-1]["passes"])
    scene.write_text(text)
    expect_same_files(shown.output, render(scene, folder, *SMALL, "--passes", done))


def saves_when_the_display_goes(folder: Path) -> None:
    """The server of the display is killed: exit code 1, and all passes are in the file."""
    with display() as environment, window(environment, folder, BOX, *SMALL) as shown:
        shown.await_passes(2)
        os.kill(int(environment["DISPLAY_SERVER"]), signal.SIGKILL)
        messages = shown.process.communicate(timeout=PATIENCE)[1]
        assert shown.process.returncode == 1, (shown.process.returncode, messages)
        assert "the display is gone" in messages, messages
        passes = str(shown.events("end")[-1]["passes"])
    assert int(passes) >= 2
    expect_same_files(shown.output, render(BOX, folder, *SMALL, "--passes", passes))


def resizes(environment: dict[str, str], folder: Path) -> None:
    """A larger window shows the film larger, or gives it its own size; a hidden panel gives it all."""
    with window(environment, folder, BOX, *SMALL, "--passes", "2") as shown:
        small = png_of(render(BOX, folder, *SMALL, "--passes", "2"))
        shown.shows(small, shown.place((160, 120)))
        shown.resize(320 + shown.panel, 700)
        large = Image.fromarray(small.astype(np.uint8)).resize((320, 240), Image.Resampling.BILINEAR)
        shown.shows(np.asarray(large).astype(int), shown.place((320, 240)), 2)
        for width, height in ((700, 300), (340, 100), (331, 5), (1200, 1100), (320 + shown.panel, 240)):
            shown.resize(width, height)
        shown.key("g")
        expected = render(BOX, folder, *SMALL[2:], "--size", "320x240", "--passes", "2")
        shown.shows(png_of(expected), (0, 0))
        shown.key("Tab")
        shown.resize(320, 240)
        shown.await_passes(2)
        shown.shows(png_of(expected), (0, 0))
        shown.xdotool("windowunmap", "--sync", shown.id)
        shown.xdotool("windowmap", "--sync", shown.id, "windowfocus", "--sync", shown.id)
        shown.shows(png_of(expected), (0, 0))
        shown.close()
        expect_same_files(shown.output, expected)


def pauses_by_mouse(environment: dict[str, str], folder: Path) -> None:
    """The panel's first button and Space hold the render; an interrupt saves."""
    with window(environment, folder, BOX, *SMALL) as shown:
        shown.await_passes(2)
        shown.xdotool("mousemove", shown.size[0] - shown.panel + 40, 18, "click", 1)

        def count() -> int:
            return len(shown.events("pass"))

        def rests() -> bool:
            before = count()
            time.sleep(1)
            return count() == before

        eventually("a pause", rests)
        before = count()
        shown.key("space")
        eventually("passes after the pause", lambda: count() > before + 1)
        shown.process.terminate()
        shown.close(130)
        passes = str(shown.events("end")[-1]["passes"])
        expect_same_files(shown.output, render(BOX, folder, *SMALL, "--passes", passes))


def shows_several_sizes(environment: dict[str, str], folder: Path) -> None:
    """Two windows at a time, each with a film of its own size; one on a dense display."""
    (folder / "other").mkdir()
    with window(environment, folder, BOX, *SMALL, "--passes", "1") as first:
        first.xdotool("windowmove", "--sync", first.id, 800, 0)
        with window(environment, folder / "other", BOX, *SMALL[2:], "--size", "200x60", "--passes", "1") as second:
            for shown, left, size in ((first, 800, (160, 120)), (second, 0, (200, 60))):
                expected = png_of(render(BOX, folder, *SMALL[2:], "--size", f"{size[0]}x{size[1]}", "--passes", "1"))
                x, y = shown.place(size)
                shown.shows(expected, (left + x, y))
            second.close()
        first.close()
    with display(density=2) as dense, window(dense, folder, BOX, *SMALL, "--passes", "1") as shown:
        assert shown.panel == 660, shown.panel
        assert shown.size[0] == 2 * (160 + 330), shown.size
        large = Image.open(render(BOX, folder, *SMALL, "--passes", "1").with_suffix(".png"))
        large = large.resize((320, 240), Image.Resampling.BILINEAR)
        shown.shows(np.asarray(large).astype(int), shown.place((320, 240)), 2)
        shown.close()


def needs_a_display(folder: Path) -> None:
    """Without a display: exit code 1, and what to do."""
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    refused = subprocess.run([VKPM, "view", "--scene", str(BOX)], env=environment, cwd=folder, stderr=subprocess.PIPE,
                             text=True, timeout=PATIENCE, check=False)
    assert refused.returncode == 1, refused
    assert "vkpm --scene FILE" in refused.stderr, refused.stderr


def answers_during_long_passes(environment: dict[str, str], folder: Path) -> float:
    """Layers and camera while a pass takes long; returns the longest time that input waited, in seconds."""
    with window(environment, folder, ROOT / "scenes/pool.json", "--size", "640x480", "--photons", "1000000",
                "--gather-rays", "8") as shown:
        for _ in range(3):
            shown.key("3", "7", "1")
            shown.drag((300, 300), 10, (3, 1))
            time.sleep(0.5)
        shown.close()
        return shown.events("window closes")[0]["longestWait"]


def measure(environment: dict[str, str], folder: Path) -> None:
    """Prints medians of five windows of the box."""
    rows = []
    for _ in range(5):
        with window(environment, folder, BOX) as shown:
            first = shown.await_event("first pass")["start"]
            shown.drag((250, 300), 80, (2, 1), pause=0.02)
            moved = shown.await_event("moved")
            time.sleep(1)
            shown.close()
            wait = shown.events("window closes")[0]["longestWait"]
            opened, draft = shown.events("window")[0]["start"], shown.events("first draft")[0]["start"]
            rows.append((opened, draft, first, moved["frames"] / moved["seconds"], moved["width"], wait))
    names = ("open, s", "first draft, s", "first pass, s", "frames/s moving", "at a width of", "longest wait, s")
    for name, values in zip(names, zip(*rows, strict=True), strict=True):
        print(f"{name:16} {np.median(values):8.3f}   {min(values):8.3f} to {max(values):.3f}")
    print(f"{'long passes, s':16} {answers_during_long_passes(environment, folder):8.3f}")


def main() -> None:
    """Runs the tests for the vkpm that is named by the first argument."""
    with tempfile.TemporaryDirectory(prefix="vkpm-window-test-") as name, display() as environment:
        folder = Path(name)
        if "--measure" in sys.argv:
            return measure(environment, folder)
        shows_layers_and_saves(environment, folder)
        if "--short" in sys.argv:
            return None
        needs_a_display(folder)
        moves_the_camera(environment, folder)
        reloads_the_scene(environment, folder)
        keeps_passes_of_what_cannot_be_rendered(environment, folder)
        saves_when_the_display_goes(folder)
        resizes(environment, folder)
        pauses_by_mouse(environment, folder)
        shows_several_sizes(environment, folder)
        waits: list[float] = []  # other programs may hold one up
        while len(waits) < 3 and not any(wait < 0.1 for wait in waits):
            waits.append(answers_during_long_passes(environment, folder))
        assert min(waits) < 0.1, waits
    return None


if __name__ == "__main__":
    main()
