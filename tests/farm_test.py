"""tools/farm with a scheduler and two workers: interrupted, then one worker killed, it has the bits of one run."""

import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil
from distributed import Client

from waiting import eventually

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from farming.parts import Scene  # noqa: E402

SCENE = ROOT / "scenes/glass.json"
OPTIONS = ["--scene", str(SCENE), "--passes", "24", "--size", "64x48", "--photons", "2000", "--quiet"]
LOOPBACK = ["--host", "127.0.0.1", "--dashboard-address", "127.0.0.1:0"]
DASK = [sys.executable, "-E", "-m", "dask"]  # as elsewhere, where the modules of the farm are not found


@contextmanager
def running(*command: object, **options: Any) -> Iterator[subprocess.Popen]:
    """A process that ends with the block at the latest."""
    process = subprocess.Popen([str(word) for word in command], **options)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


@contextmanager
def scheduler(folder: Path) -> Iterator[str]:
    """The address of a scheduler on the loopback."""
    file = folder / "scheduler.json"
    with running(*DASK, "scheduler", *LOOPBACK, "--port", 0, "--scheduler-file", file):
        eventually("the scheduler", file.exists)
        with Client(scheduler_file=file) as client:
            yield client.scheduler.address


def worker(address: str, folder: Path) -> AbstractContextManager[subprocess.Popen]:
    """A worker that stays dead when it is killed."""
    return running(*DASK, "worker", address, *LOOPBACK, "--no-nanny", "--nthreads", 1, "--local-directory", folder)


def stopped_render(process: subprocess.Popen) -> bool:
    """Stops the vkpm that a worker runs, and tells whether one stands still."""
    for child in psutil.Process(process.pid).children():
        with suppress(psutil.NoSuchProcess):
            if child.name() == "vkpm":
                child.suspend()
                return child.status() == psutil.STATUS_STOPPED
    return False


def processes_naming(*words: object) -> list[psutil.Process]:
    """All processes that have each of the words in their command line."""
    lines = ((process, " ".join(process.info["cmdline"] or [])) for process in psutil.process_iter(["cmdline"]))
    return [process for process, line in lines if all(str(word) in line for word in words)]


def parts_in(folder: Path) -> list[Path]:
    """The parts that a farm has got back."""
    return list(folder.glob("farm.parts/*/*.exr"))


def interrupt_farm(farm: list[str], folder: Path) -> None:
    """Interrupts a farm when it has a part, and expects that the part stays and no vkpm does."""
    with running(*farm, "--chunk", 2) as process:
        eventually("a first part", lambda: parts_in(folder))
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 130
    eventually("the end of all renders", lambda: not processes_naming(folder, "--pass-range"))
    assert parts_in(folder)


def kill_worker(farm: list[str], folder: Path, victim: subprocess.Popen) -> None:
    """Kills a worker in the middle of a chunk, and expects the farm to finish."""
    before = len(parts_in(folder))
    with running(*farm, "--chunk", 4, stderr=subprocess.PIPE, text=True) as process:
        eventually("a render on the worker, which shall not end", lambda: stopped_render(victim))
        eventually("another part", lambda: len(parts_in(folder)) > before)
        victim.kill()
        messages = process.communicate(timeout=120)[1]
    assert process.returncode == 0, messages
    assert "died; its passes go to another" in messages, messages
    assert not (folder / "farm.parts").exists()


def refuse_option(farm: list[str]) -> None:
    """Expects vkpm's own message on a wrong option, and its exit code."""
    refused = subprocess.run([*farm, "--photon", "1"], stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    assert refused.returncode == 2
    assert "\nvkpm: --photon: unknown option" in "\n" + refused.stderr, refused.stderr  # after what a build may say
    for option in ("--target-error=20%", "--report=rep", "--reference=r.exr", "--no-resume", "--time=3"):
        refused = subprocess.run([*farm, option], stderr=subprocess.PIPE, text=True, timeout=60, check=False)
        assert refused.returncode == 2, (option, refused)
        assert f"{option.split('=')[0]} is for one run of vkpm" in refused.stderr, (option, refused.stderr)


def files_that_travel(folder: Path) -> None:
    """Expects meshes, textures and skies among a scene's files, and what its models name."""
    assert set(Scene(ROOT / "scenes/open_pool.json").files) >= {"open_pool.json", "water.obj", "evening.hdr"}
    assert set(Scene(ROOT / "scenes/screen.json").files) >= {"screen.json", "wood.png", "leaf.png", "sunset.png"}
    for name in ("a picture.png", "a.bin", "other.png"):
        (folder / name).touch()
    images = '[{"uri": "a%20picture.png"}, {"uri": "data:,"}]'
    (folder / "m.gltf").write_text(f'{{"buffers": [{{"uri": "a.bin"}}], "images": {images}}}')
    shapes = '[{"emission": {"texture": "other.png"}}]'
    (folder / "scene.json").write_text(f'{{"import": {{"file": "m.gltf"}}, "shapes": {shapes}}}')
    assert set(Scene(folder / "scene.json").files) == {"scene.json", "m.gltf", "a.bin", "a picture.png", "other.png"}


def main() -> None:
    """Runs the test for the vkpm that is named by the first argument."""
    vkpm = sys.argv[1]
    with tempfile.TemporaryDirectory(prefix="vkpm-farm-test-") as name:
        folder = Path(name)
        files_that_travel(folder)
        single, output = folder / "single.exr", folder / "farm.exr"
        subprocess.run([vkpm, *OPTIONS, "-o", single], check=True)
        with scheduler(folder) as address, worker(address, folder) as victim, worker(address, folder):
            farm = [str(ROOT / "tools/farm"), *OPTIONS, "-o", str(output), "--scheduler", address, "--vkpm", vkpm]
            refuse_option(farm)
            interrupt_farm(farm, folder)
            kill_worker(farm, folder, victim)
            (folder / "blocked.parts").write_text("a file where the farm wants a folder")
            blocked = subprocess.run([*farm, "-o", str(folder / "blocked.exr")], stderr=subprocess.PIPE, text=True,
                                     timeout=120, check=False)
            assert blocked.returncode == 1, blocked
            assert "Traceback" not in blocked.stderr, blocked.stderr
            assert "tools/farm: " in blocked.stderr and "blocked.parts" in blocked.stderr, blocked.stderr
        assert output.read_bytes() == single.read_bytes()
        assert not processes_naming(folder)
        assert output.with_suffix(".png").read_bytes() == single.with_suffix(".png").read_bytes()


if __name__ == "__main__":
    main()
