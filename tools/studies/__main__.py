"""Studies of error against time: references by long renders, and matrices of renders with a page of results."""

import argparse
import re
import signal
import sys
from collections.abc import Callable
from pathlib import Path

from studies.reference import make_references
from studies.run import run_study
from studies.specks import study_specks
from studies.truth import study_truth
from studies.vkpm import VKPM, Failure, say

OF_THE_STUDY = {"-o", "--output", "--scene", "--size", "--integrator", "--layers", "--seed", "--passes", "--pass-range",
                "--time", "--reference", "--report", "--resume", "--checkpoint", "--stats", "--log", "--quiet",
                "--help", "--version"}


# Types of options; what they raise, argparse reports.


def number(text: str) -> float:
    """A number above zero."""
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"found {text}; allowed: a number above 0")
    return value


def count(text: str) -> int:
    """Reads a count as vkpm does, 2000 or 2e3."""
    value = number(text)
    if not value.is_integer():
        raise argparse.ArgumentTypeError(f"found {text}; allowed: a whole number above 0")
    return int(value)


def size(text: str) -> str:
    """Checks a size in pixels."""
    if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", text):
        raise argparse.ArgumentTypeError(f"found {text}; allowed: WxH, as 128x128")
    return text


def scene(text: str) -> Path:
    """A scene file, which exists."""
    if not Path(text).is_file():
        raise argparse.ArgumentTypeError(f"found {text}; allowed: a scene file that exists")
    return Path(text)


def list_of(kind: Callable) -> Callable:
    """Reads values with commas between."""

    def items(text: str) -> list:
        found = [kind(word) for word in text.split(",") if word]
        if not found:
            raise argparse.ArgumentTypeError("found nothing; allowed: values with commas between")
        return found

    return items


def axis(text: str) -> tuple[str, list[str]]:
    """Reads an axis, NAME=VALUE,VALUE."""
    name, _, values = text.removeprefix("--").partition("=")
    words = [word for word in values.split(",") if word]
    if not name or not words:
        raise argparse.ArgumentTypeError(f"found {text}; allowed: NAME=VALUE,VALUE, as photons=50000,200000")
    if f"--{name}" in OF_THE_STUDY:
        raise argparse.ArgumentTypeError(f"found {name}, which the study sets itself; allowed: other options of vkpm")
    return name, words


# The command line.


def add_common(parser: argparse.ArgumentParser, output: str) -> None:
    """Adds what both commands take."""
    add = parser.add_argument
    add("--size", type=size, default="128x128", metavar="WxH", help="pixels (default 128x128)")
    add("-o", "--output", type=Path, default=Path(output), metavar="FOLDER",
        help="for what is made (default: %(default)s, here)")
    add("--vkpm", default=str(VKPM), metavar="PATH", help="the program under study (default: %(default)s)")
    add("--quiet", action="store_true", help="no progress on stderr")


def parse_arguments() -> tuple[argparse.Namespace, list[str]]:
    """Returns the study's own arguments, and those that go to vkpm."""
    epilog = "Other options go to vkpm: --device, --fresnel, ... (tools/run --help)."
    parser = argparse.ArgumentParser(prog="tools/study", allow_abbrev=False, description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    reference = commands.add_parser(
        "reference", allow_abbrev=False, epilog=epilog, help="make references of scenes to a stated error",
        description="Render scenes by unbiased integrators until their error is small enough. Ctrl-C ends it, and "
                    "the same command goes on.")
    add = reference.add_argument
    add("--scene", type=scene, nargs="+", required=True, action="extend", metavar="FILE", help="scenes to render")
    add("--error", type=number, default=0.01, metavar="E",
        help="relative standard error to reach: sqrt(mean(noise^2 / (beauty^2 + 0.01))) (default %(default)s)")
    add("--time", type=number, metavar="SECONDS", help="for each scene, at most (default: none)")
    add("--small", action="store_true",
        help="also write a small file of the layers of light alone, in half precision, for tests")
    add_common(reference, "references")

    run = commands.add_parser(
        "run", allow_abbrev=False, epilog=epilog, help="render a matrix at equal time, and write a page",
        description="Render scenes x integrators x settings at equal time, compare with references, and write one page "
                    "of curves, times and pictures. What is finished is kept; the same command goes on.")
    add = run.add_argument
    add("--scenes", type=list_of(scene), required=True, metavar="FILE,FILE", help="scenes to render")
    add("--integrators", type=list_of(str), default=["photon", "path"], metavar="A,B",
        help="integrators (default photon,path)")
    add("--axis", type=axis, action="append", default=[], metavar="NAME=A,B",
        help="an option of vkpm and its values, as photons=50000,200000; several are multiplied, those about photons "
             "only with integrators that have photons")
    add("--alone", action="store_true",
        help="do not multiply axes: each option takes its values while all others have their defaults; also writes "
             "axes.png, the errors at the end by value")
    add("--time", type=number, default=60, metavar="SECONDS", help="of rendering, for each cell and seed (default 60)")
    add("--repeat", type=count, default=1, metavar="N", help="seeds; errors are averaged over them (default 1)")
    add("--references", type=Path, default=Path("references"), metavar="FOLDER",
        help="of tools/study reference (default: %(default)s, here)")
    add_common(run, "study")

    truth = commands.add_parser(
        "truth", allow_abbrev=False, epilog=epilog, help="compare the stated error with the true one",
        description="Render scenes with many seeds and once for long, and write tables of stated and true errors, by "
                    "layer and region, with pictures of where intervals fail. What is rendered is kept; the same "
                    "command goes on. Exit code 1 if the stated error of a scene is below the true one more often than "
                    "once in ten, or its median above 1.3 times the true one's.")
    add = truth.add_argument
    add("--scenes", type=list_of(scene), required=True, metavar="FILE,FILE", help="scenes to render")
    add("--passes", type=list_of(count), default=[16, 64], metavar="N,N", help="numbers of passes (default 16,64)")
    add("--seeds", type=count, default=20, metavar="N", help="renders of each (default 20)")
    add("--reference-passes", type=count, default=256, metavar="N",
        help="of the long render, which has 200000 photons of each kind in a pass, and states its own error "
             "(default 256)")
    add_common(truth, "truth")

    specks = commands.add_parser(
        "specks", allow_abbrev=False, epilog=epilog, help="find the paths that make the pixels that are off most",
        description="Render scenes with some seeds and once for long, then each pass again by itself with labels of "
                    "its paths, and print the pixels that are off most, with pass, layer and path, and the part of the "
                    "squared error that each path brings. What tools/study truth has rendered is used.")
    add = specks.add_argument
    add("--scenes", type=list_of(scene), required=True, metavar="FILE,FILE", help="scenes to render")
    add("--passes", type=lambda text: [count(text)], default=[16], metavar="N", help="of each picture (default 16)")
    add("--seeds", type=count, default=2, metavar="N", help="renders of each (default 2)")
    add("--part", type=float, default=0.001, metavar="P", help="of the pixels, those off most (default 0.001)")
    add("--count", type=count, default=10, metavar="N", help="lines of each table (default 10)")
    add("--reference-passes", type=count, default=256, metavar="N", help="as of tools/study truth (default 256)")
    add_common(specks, "truth")

    args, options = parser.parse_known_args()
    if args.command == "run" and args.alone and not args.axis:
        parser.error("--alone: there is no axis; allowed: with at least one --axis")
    for name in (option.split("=")[0] for option in options):
        if name in OF_THE_STUDY:
            parser.error(f"{name} is set by the study itself; allowed: other options of vkpm")
    return args, options


def main() -> int:
    """Runs a command, and tells how it failed."""
    args, options = parse_arguments()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    try:
        commands = {"reference": make_references, "run": run_study, "truth": study_truth, "specks": study_specks}
        return commands[args.command](args, options)
    except Failure as failure:
        say(str(failure))
        return failure.code
    except OSError as error:
        say(f"tools/study: {error}")
        return 1
    except KeyboardInterrupt:
        say("tools/study: interrupted; what is finished is kept, and the same command goes on with it")
        return 130


if __name__ == "__main__":
    sys.exit(main())
