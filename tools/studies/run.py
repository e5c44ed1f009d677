"""A study's run: each cell is rendered once, and the page is written of what they leave in their folders."""

import argparse
import json
import shutil

import numpy as np
from tqdm import tqdm

from studies.cells import Cell, Study
from studies.curves import Row, layer_curve, read_rows, write_rows
from studies.page import write_page
from studies.vkpm import LIGHT, Failure, flip, relative_square, say


def render(cell: Cell) -> None:
    """Renders from the beginning; a cell that was interrupted has used its time unevenly."""
    shutil.rmtree(cell.folder, ignore_errors=True)
    cell.folder.mkdir(parents=True)
    commands = measure_by_vkpm(cell) if cell.study.vkpm.has_report else measure_by_steps(cell)
    image = cell.image()
    facts = {"name": cell.name, "identity": cell.identity(), "commands": commands, "commit": cell.study.commit,
             "version": cell.study.vkpm.version, "device": image.attributes["vkpm/device"],
             "passes": int(image.attributes["vkpm/passes"]),
             "flip": flip(image.layers["beauty"], cell.truth.image.layers["beauty"])[1]}
    new = cell.folder / "cell.new"
    new.write_text(json.dumps(facts, indent=2) + "\n")
    new.rename(cell.folder / "cell.json")


def curve(cell: Cell) -> list[Row]:
    """Error against time of a cell, which is rendered if it is not finished."""
    if cell.facts() is None:
        render(cell)
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


def render_all(study: Study) -> None:
    """Renders the cells that are not finished."""
    todo = [cell for cell in study.cells if cell.facts() is None]
    for cell in todo:
        cell.check()
    done = len(study.cells) - len(todo)
    with tqdm(total=len(study.cells), initial=done, unit="cell", disable=study.args.quiet or None) as progress:
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
    render_all(study)
    say(f"tools/study: wrote {write_page(study)}")
    return 0
