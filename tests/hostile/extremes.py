"""Hostile scenes: renders each, checks what must hold, and writes a table and one HTML page with pictures.

What must hold for all: an end within minutes and without an error, no value in any layer that is not finite, no photon
lost, photons that add up, and no more than three times the time of a tame sibling. Each case has a check of its own
besides.
"""

import argparse
import glob
import html
import json
import os
import random
import shutil
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import places  # isort: skip: the order of the table
import gloss
import light
import photons
import shapes
import world
from lab import CASES, TRUTHS, Case, Lab, Refused, Verdict
from studies.page import STYLE, developed, picture, table

MODULES = (places, light, gloss, world, shapes, photons)  # each registers its cases
WHOLE_KERNELS = ("gloss", "sky", "texture", "normal map", "lens")  # groups whose scenes are not for plain kernels
TIMES = 3  # as long as the tame sibling, at most
NOISE = 0.15  # seconds that a render may take more for no reason: other work on the machine, kernels compiled anew


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="tools/extremes",
                                     description="Renders hostile scenes and says what came of them.")
    parser.add_argument("--vkpm", required=True, help=argparse.SUPPRESS)
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER",
                        help="keeps the scenes and renders, and writes index.html and table.md")
    parser.add_argument("--only", default="", metavar="WORDS", help="cases whose group and name have these words")
    parser.add_argument("--heavy", action="store_true", help="also those that take gigabytes or minutes")
    parser.add_argument("--driver", choices=("lanes4", "swiftshader"),
                        help="on lavapipe with four lanes in place of eight, or on SwiftShader")
    parser.add_argument("--draw", type=int, metavar="N",
                        help="N of these cases, drawn by the number VKPM_DRAW_SEED (default 1)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N",
                        help="renders N cases at a time; slow ones are timed again alone (default 1)")
    parser.add_argument("--truths", action="store_true",
                        help="renders what these cases are judged by anew, into tests/data/hostile_truths.json")
    return parser.parse_args()


def environment(driver: str | None) -> dict[str, str]:
    """The environment variables that choose a driver."""
    if driver == "lanes4":
        return {"LP_NATIVE_VECTOR_WIDTH": "128"}
    if driver == "swiftshader":
        found = sorted(glob.glob("/usr/lib*/chromium*/vk_swiftshader_icd.json"))
        if not found:
            sys.exit("tools/extremes: SwiftShader is not installed; tools/setup installs it (chromium-common)")
        return {"VK_DRIVER_FILES": found[0], "VK_ICD_FILENAMES": found[0]}
    return {}


def ratio(verdict: Verdict) -> float:
    """Time in units of the tame sibling's, by the work there is."""
    if not verdict.tame:
        return 0
    return max(verdict.render.seconds - NOISE, 0) / (verdict.tame.seconds * verdict.work)


def judged(lab: Lab, case: Case) -> Verdict | list[str]:
    """A case's verdict, or why there is none."""
    try:
        return case.judge(lab)
    except Refused as refusal:
        return refusal.args[0]


def checked(lab: Lab, verdict: Verdict | list[str]) -> tuple[Verdict | None, list[str]]:
    """A verdict, and all that is wrong."""
    if isinstance(verdict, list):
        return None, verdict
    for _ in range(2):  # what else the machine did counts for nothing
        if ratio(verdict) <= TIMES:
            break
        for render in (verdict.render, verdict.tame):
            lab.time_again(render)
    wrong = list(verdict.render.problems)
    if not verdict.holds:
        wrong.append("not as expected")
    if ratio(verdict) > TIMES:
        wrong.append(f"takes {ratio(verdict):.1f} times as long as its sibling")
    return verdict, wrong


def row(case: Case, verdict: Verdict | None, wrong: list[str]) -> list[str]:
    """Of the table."""
    if not verdict:
        return [case.group, case.name, case.expected, "no picture", "–", "; ".join(wrong)]
    time = f"{verdict.render.seconds / (verdict.tame.seconds * verdict.work):.1f}" if ratio(verdict) else ""
    return [case.group, case.name, case.expected, verdict.measured, time or "–", "; ".join(wrong) or "holds"]


def thumbnail(verdict: Verdict | None) -> str:
    """The picture, brought to a middle grey."""
    if not verdict or verdict.render.code:
        return ""
    beauty = verdict.render.layer()
    grey = beauty.mean() or 1
    return f'<img width="96" style="image-rendering: pixelated" src="{picture(developed(beauty / grey * 0.25, 0))}">'


HEAD = ["", "case", "expected", "measured", "time", ""]


def page(rows: list[tuple[list[str], str]], device: str) -> str:
    """One HTML file."""
    body = [[html.escape(words[0]), image, *map(html.escape, words[1:])] for words, image in rows]
    style = STYLE + "th, td { white-space: normal; text-align: left; }"
    return (f'<!doctype html><meta charset="utf-8"><title>vkpm: extremes</title><style>{style}</style>'
            "<h1>Stress tests</h1>"
            f"<p>{html.escape(device)}. Time is that of rendering, in units of a tame sibling's.</p>"
            + table(["", "picture", *HEAD[1:]], body))


def markdown(rows: list[list[str]]) -> str:
    """The table for tests/README.md, between its markers."""
    lines = [HEAD[:-1], ["---"] * 5, *(words[:-1] for words in rows)]
    return "".join("| " + " | ".join(words) + " |\n" for words in lines)


def main() -> int:
    """Renders, says, writes."""
    args = arguments()
    folder = args.output or Path(tempfile.mkdtemp(prefix="vkpm-extremes-"))
    folder.mkdir(parents=True, exist_ok=True)
    lab = Lab(args.vkpm, folder.resolve(), environment(args.driver))
    lab.traces_all = args.truths
    cases = [case for case in CASES if (args.heavy or not case.heavy) and args.only in f"{case.group} {case.name}"]
    if not cases:
        sys.exit(f"tools/extremes: --only: no case has the words {args.only!r}; without it all are rendered")
    if args.draw and args.draw < len(cases) and "VKPM_NIGHTLY" not in os.environ:
        if args.driver == "swiftshader":  # which takes minutes to compile a whole kernel
            cases = [case for case in cases if case.group not in WHOLE_KERNELS]
        drawn = random.Random(int(os.environ.get("VKPM_DRAW_SEED", "1"))).sample(range(len(cases)), args.draw)
        cases = [cases[index] for index in sorted(drawn)]
    if args.jobs == 1:
        verdicts = map(partial(judged, lab), cases)
    else:
        with ThreadPoolExecutor(args.jobs) as pool:  # all, so that nothing else runs when times are taken again
            verdicts = list(pool.map(partial(judged, lab), cases))
    rows, failed = [], 0
    for case, found in zip(cases, verdicts, strict=True):
        verdict, wrong = checked(lab, found)
        words = row(case, verdict, wrong)
        rows.append((words, thumbnail(verdict)))
        failed += bool(wrong)
        print(f"{'FAILS' if wrong else 'holds'}  {words[0]}: {words[1]}\n       expected {words[2]}\n"
              f"       measured {words[3]}; time {words[4]}"
              + "".join(f"\n       {line}" for line in wrong), flush=True)
    device = next((render.stats["device"] for render in lab.known.values() if not render.code), "no device")
    print(f"{len(rows)} cases on {device}; {failed} fail")
    if args.truths:
        kept = lab.traced if not args.only and args.heavy else lab.truths | lab.traced
        TRUTHS.write_text(json.dumps(dict(sorted(kept.items())), indent=1) + "\n")
    if args.output:
        (folder / "index.html").write_text(page(rows, device))
        (folder / "table.md").write_text(markdown([words for words, _ in rows]))
        (folder / "table.json").write_text(json.dumps([words for words, _ in rows], indent=1))
    else:
        shutil.rmtree(folder)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
