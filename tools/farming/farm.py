"""Renders a scene on a Dask cluster: hands out ranges of passes, retries those whose worker died, merges the parts."""

import argparse
import asyncio
import logging
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import dask
from distributed import Client, Future, KilledWorker, LocalCluster, as_completed, get_worker
from distributed.comm import get_address_host_port
from tqdm import tqdm

from farming.parts import Parts, Scene, Span, chunk_size, digest, missing_spans

ROOT = Path(__file__).resolve().parents[2]
VKPM = ROOT / "build/release/vkpm"
OF_ONE_RUN = {"--time", "--target-error", "--pass-range", "--stats", "--log", "--report", "--reference", "--resume",
              "--no-resume", "--half", "--checkpoint"}


class Failure(Exception):
    """What ends the farm, with a message and an exit code."""

    def __init__(self, message: str, code: int = 1):
        super().__init__(message)
        self.code = code


def say(message: str) -> None:
    """Prints a line, above the progress bar if there is one."""
    tqdm.write(message, file=sys.stderr)


# The command line.


def count(text: str) -> int:
    """Reads a count as vkpm does, 2000 or 2e3."""
    number = float(text)
    if not (number.is_integer() and number >= 1):
        raise ValueError
    return int(number)


def address(text: str) -> str:
    """Checks the form of a scheduler's address."""
    get_address_host_port(text, strict=False)
    return text


def parse_arguments() -> tuple[argparse.Namespace, list[str]]:
    """Returns the farm's own arguments, and those that go to vkpm."""
    parser = argparse.ArgumentParser(
        prog="tools/farm", allow_abbrev=False, usage="tools/farm --scene FILE [options] [options of vkpm]",
        description="Render a scene on a Dask cluster; the result has the bits of a single run.",
        epilog="Other options go to vkpm: --size, --photons, --seed, ... (tools/run --help).")
    add = parser.add_argument
    add("--scene", type=Path, required=True, metavar="FILE", help="scene to render")
    add("-o", "--output", type=Path, metavar="FILE.exr", help="image (default: the scene's name, here)")
    add("--passes", type=count, metavar="N", help="passes (default: the scene's)")
    add("--scheduler", type=address, metavar="ADDRESS",
        help="of a running scheduler, as tcp://host:8786 (default: one of its own, with workers on this machine)")
    add("--workers", type=count, default=2, metavar="N", help="workers on this machine (default 2)")
    add("--chunk", type=count, metavar="PASSES", help="passes that a worker takes at a time (default: by their number)")
    add("--vkpm", default=str(VKPM), metavar="PATH", help="the program on the workers (default: %(default)s)")
    add("--quiet", action="store_true", help="no progress on stderr")
    args, options = parser.parse_known_args()
    args.output = (args.output or Path(args.scene.stem + ".exr")).absolute()
    if args.output.suffix != ".exr":
        parser.error(f"--output: found {args.output.name}; allowed: a file name that ends in .exr")
    if not os.access(args.output.parent, os.W_OK):
        parser.error(f"--output: found {args.output}; allowed: a file in a folder that can be written to")
    for name in (option.split("=")[0] for option in options):
        if name in OF_ONE_RUN:
            parser.error(f"{name} is for one run of vkpm, not for a farm")
    return args, options


# What runs on a worker.


async def finish(process: asyncio.subprocess.Process, wanted: Callable[[], bool]) -> str:
    """Waits for a vkpm, kills it when its part is not wanted any more, and returns what it said."""
    said = asyncio.create_task(process.communicate())
    try:
        while not (await asyncio.wait({said}, timeout=0.3))[0]:
            if not wanted():
                raise RuntimeError("cancelled")
        return said.result()[1].decode(errors="replace")
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()


async def render_part(key: str, vkpm: str, options: list[str], span: Span, scene: str,
                      files: dict[str, bytes]) -> tuple[int, str, bytes]:
    """Renders some passes, and returns vkpm's exit code, its messages and the part; raises what is worth a retry."""
    worker = get_worker()
    program = shutil.which(vkpm)
    if program is None:
        raise RuntimeError(f"there is no program {vkpm}; --vkpm says where it is on the workers")

    def wanted() -> bool:
        return key in worker.state.tasks and worker.state.tasks[key].state != "cancelled"

    with tempfile.TemporaryDirectory(prefix="vkpm-", dir=worker.local_directory) as folder:
        place = Path(folder, "scene", scene)
        place.parent.mkdir(parents=True)
        for name, content in files.items():
            file = Path(folder, "scene", name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
        part = Path(folder, "part.exr")

        # One at a time on a worker. A session of its own keeps the terminal's Ctrl-C from it; it dies with its worker.
        async with vars(worker).setdefault("vkpm_lock", asyncio.Lock()):
            process = await asyncio.create_subprocess_exec(
                "setpriv", "--pdeathsig", "KILL", os.path.abspath(program), "--scene", place.name, "-o", part,
                "--pass-range", f"{span[0]}:{span[1]}", "--quiet", *options, cwd=place.parent, start_new_session=True,
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            messages = await finish(process, wanted)
        if process.returncode not in (0, 2):
            raise RuntimeError(f"vkpm ended with code {process.returncode}\n{messages}".rstrip())
        return process.returncode, messages, part.read_bytes() if process.returncode == 0 else b""


def same(files: dict[str, bytes]) -> dict[str, bytes]:
    """Returns the files: what a task returns is made again if the worker that holds it dies."""
    return files


# What runs here.


@contextmanager
def cluster(args: argparse.Namespace) -> Iterator[str]:
    """The address of the scheduler that was given, or of one with workers on this machine."""
    if args.scheduler:
        yield args.scheduler
        return
    with LocalCluster(n_workers=args.workers, threads_per_worker=1, dashboard_address=None,
                      silence_logs=logging.CRITICAL) as local:
        yield local.scheduler_address


def connect(address: str) -> Client:
    """A client of the scheduler at an address."""
    dask.config.set({"distributed.admin.large-graph-warning-threshold": "1 TiB"})  # meshes are large
    try:
        client = Client(address, timeout=10)
    except OSError as error:
        raise Failure(f"tools/farm: no scheduler answers at {address} ({error})") from error
    if not client.nthreads():
        say(f"tools/farm: the scheduler at {address} has no workers yet; waiting for some")
    return client


@contextmanager
def deaths_told(client: Client, spans: dict[str, Span]) -> Iterator[None]:
    """Says so when a worker dies that had some of the passes."""

    def tell(event: tuple[float, dict]) -> None:
        lost = spans.keys() & set(event[1].get("processing-tasks", ()))
        if lost and not event[1]["expected"]:
            say(f"tools/farm: worker {event[1]['worker']} died; its passes go to another")

    client.subscribe_topic("all", tell)
    try:
        yield
    finally:
        client.unsubscribe_topic("all")


def result_of(future: Future, span: Span) -> tuple[int, str, bytes]:
    """What a task returned; what it raised, the farm ends with."""
    passes = f"tools/farm: passes {span[0]} to {span[1] - 1}"
    try:
        return future.result()
    except KilledWorker as error:
        times = error.allowed_failures + 1
        raise Failure(f"{passes}: workers died of them {times} times, last {error.last_worker.address}") from error
    except Exception as error:  # a worker may raise anything
        raise Failure(f"{passes}: {error}") from error


def render_parts(client: Client, args: argparse.Namespace, options: list[str], scene: Scene, parts: Parts) -> None:
    """Has the workers render what is missing of the parts."""
    there = parts.spans()
    chunk = args.chunk or chunk_size(args.passes, max(1, len(client.nthreads())))
    run = uuid.uuid4().hex
    spans = {f"vkpm-{run}-{span[0]}": span for span in missing_spans(args.passes, chunk, there)}
    done = sum(end - begin for begin, end in there)
    said = set()
    progress = tqdm(total=args.passes, initial=done, unit="pass", disable=args.quiet or None)
    with progress, deaths_told(client, spans):
        files = client.submit(same, scene.files, pure=False)
        futures = [client.submit(render_part, key, args.vkpm, options, span, scene.name, files, key=key, retries=2)
                   for key, span in spans.items()]
        for future in as_completed(futures):
            span = spans[future.key]
            code, messages, part = result_of(future, span)
            for line in messages.splitlines():
                if line not in said:
                    say(line)
                said.add(line)
            if code:
                raise Failure("", code)
            parts.add(span, part)
            future.release()
            progress.update(span[1] - span[0])


def farm(args: argparse.Namespace, options: list[str]) -> int:
    """Renders and merges, and returns an exit code."""
    if subprocess.run([ROOT / "tools/build", "release", "vkpm"], check=False).returncode:
        return 1
    scene = Scene(args.scene)
    args.passes = args.passes or scene.passes
    parts = Parts(args.output, [options, args.passes, args.vkpm, digest(VKPM.read_bytes()), scene.name,
                                [(name, digest(content)) for name, content in scene.files.items()]])
    if missing_spans(args.passes, args.passes, parts.spans()):
        with cluster(args) as address, connect(address) as client:
            try:
                render_parts(client, args, options, scene, parts)
            finally:
                signal.signal(signal.SIGINT, signal.SIG_IGN)  # until the workers have stopped
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return parts.merge(VKPM, args.output)


def main() -> int:
    """Runs the farm, and tells how it failed."""
    args, options = parse_arguments()
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)
    try:
        return farm(args, options)
    except Failure as failure:
        if str(failure):
            say(str(failure))
        return failure.code
    except OSError as error:
        say(f"tools/farm: {error.filename or args.output}: {error.strerror or error}; finished parts are "
            "kept, and the same command goes on with them")
        return 1
    except KeyboardInterrupt:
        say("tools/farm: interrupted; finished parts are kept, and the same command goes on with them")
        return 130


if __name__ == "__mp_main__":  # a worker on this machine: Ctrl-C is for the farm
    signal.signal(signal.SIGINT, signal.SIG_IGN)
if __name__ == "__main__":
    sys.exit(main())
