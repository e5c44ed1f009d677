"""The page of a study: one HTML file with plots, tables and pictures in it."""

import base64
import html
import io
import json
from datetime import UTC, datetime
from pathlib import Path

import matplotlib.image
import numpy as np
from matplotlib import pyplot

from studies.cells import Cell, Study, Truth, Variant
from studies.curves import LEFT_OUT, TARGETS, TRUST, Curve, layer_curve, mean_curve, read_rows, without_reference
from studies.plot import COLOURS, Axis, Line, inline, plot_axes, plot_layers, plot_one, style
from studies.vkpm import LIGHT, flip

escape = html.escape

STYLE = """
:root { color-scheme: light dark; --ground: #fff; --text: #1c1f23; --faint: #60666e; --line: #d5d9de; --box: #f4f5f7; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #15181c; --text: #e4e7eb; --faint: #9aa2ac; --line: #3a4048; --box: #1f2329; }
}
body { background: var(--ground); color: var(--text); font: 16px/1.5 system-ui, sans-serif; max-width: 70rem;
  margin: 2rem auto; padding: 0 1rem; }
h2 { margin-top: 3rem; border-top: 1px solid var(--line); padding-top: 1.5rem; }
.faint, figcaption { color: var(--faint); font-size: 0.85rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: 0.25rem 0.6rem; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
svg { max-width: 100%; height: auto; color: var(--text); }
td .faint { display: block; }
.facts td { text-align: left; white-space: normal; }
.key { display: inline-block; width: 0.8rem; height: 0.8rem; border-radius: 50%; margin-right: 0.5rem; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; }
.pictures figure { margin: 0; width: 15rem; }
.pictures img { display: block; width: 100%; image-rendering: pixelated; margin-bottom: 0.25rem; }
.pictures .render { cursor: pointer; }
.blank { background: var(--box); }
pre { background: var(--box); padding: 0.75rem; overflow-x: auto; font-size: 0.8rem; }
"""

SCRIPT = """
// While a picture is pressed, its reference is shown in its place.
for (const picture of document.querySelectorAll('img.render')) {
  const own = picture.src, reference = picture.closest('.pictures').querySelector('img.reference').src;
  picture.draggable = false;
  picture.addEventListener('pointerdown', () => { picture.src = reference; });
  for (const end of ['pointerup', 'pointerleave', 'pointercancel'])
    picture.addEventListener(end, () => { picture.src = own; });
}
"""


# Figures in words and numbers.


def number(value: float, digits: int = 3) -> str:
    """A number for people; a dash if unknown."""
    return f"{value:.{digits}g}" if np.isfinite(value) else "–"


def time_cell(curve: Curve, target: float) -> str:
    """The time to a target, or how far it came."""
    if not len(curve.seconds):
        return "–"
    if curve.starts_below(target):
        return f"≤ {number(curve.seconds[0])} s"
    seconds = curve.time_to(target)
    if np.isfinite(seconds):
        return f"{number(seconds)} s"
    return f'&gt; {number(curve.seconds[-1])} s <span class="faint">(reached {curve.errors[-1]:.1e})</span>'


def table(head: list[str], rows: list[list[str]]) -> str:
    """A table of texts that are HTML already."""
    lines = [("th", head), *(("td", row) for row in rows)]
    cells = ("".join(f"<{tag}>{word}</{tag}>" for word in words) for tag, words in lines)
    return '<div class="wide"><table>' + "".join(f"<tr>{line}</tr>" for line in cells) + "</table></div>"


# Pictures.


def picture(pixels: np.ndarray) -> str:
    """A data URI of a PNG."""
    file = io.BytesIO()
    matplotlib.image.imsave(file, np.clip(pixels, 0, 1), format="png")
    return "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()


def developed(radiance: np.ndarray, exposure: float) -> np.ndarray:
    """In sRGB, with an exposure in stops."""
    linear = np.clip(radiance * 2**exposure, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def pictures(truth: Truth, cells: list[Cell]) -> str:
    """The reference, then renders and their FLIP maps."""
    exposure = float(truth.image.attributes.get("vkpm/exposure", 0))
    beauty = truth.image.layers["beauty"]
    figures = [f'<figure><img class="reference" alt="reference" src="{picture(developed(beauty, exposure))}">'
               "<figcaption>reference</figcaption></figure>"]
    for cell in cells:
        passes = cell.facts()["passes"]
        image = cell.image().layers["beauty"]
        errors, mean = flip(image, beauty)
        name = escape(cell.variant.label())
        figures.append(f'<figure><img class="render" alt="{name}" src="{picture(developed(image, exposure))}">'
                       f'<img alt="FLIP map of {name}" src="{picture(errors)}">'
                       f"<figcaption>{name}: {passes} passes, FLIP {number(mean)}</figcaption></figure>")
    return f'<div class="pictures">{"".join(figures)}</div>'


# A scene.


class Result:
    """What the seeds of one variant came to."""

    def __init__(self, study: Study, variant: Variant):
        self.variant = variant
        self.cells = [cell for cell in study.cells if cell.variant == variant]
        self.facts = [cell.facts() for cell in self.cells]
        rows = [read_rows(cell.folder / "error.csv") for cell in self.cells]
        self.layers = {layer: mean_curve([layer_curve(own, layer) for own in rows]) for layer in ("beauty", *LIGHT)}
        self.layers["beauty"] = without_reference(self.layers["beauty"], self.cells[0].truth.own_error)

    def name(self, index: int) -> str:
        """With its colour in the plots, as HTML."""
        colour = COLOURS[index % len(COLOURS)]
        return f'<span class="key" style="background: {colour}"></span>{escape(self.variant.label())}'

    def mean(self, key: str) -> float:
        """Over seeds, of a number in cell.json."""
        return float(np.mean([facts[key] for facts in self.facts]))


def times_table(results: list[Result]) -> str:
    """Times to errors, and what was there at the end."""
    targets = (f"to {target:.0e}".replace("e-0", "e-") for target in TARGETS)
    head = ["relMSE of beauty", *targets, "slope", "reached", "FLIP", "passes"]
    rows = []
    for index, result in enumerate(results):
        beauty = result.layers["beauty"]
        last = f"{beauty.errors[-1]:.2e}" if len(beauty.errors) else "–"
        times = (time_cell(beauty, target) for target in TARGETS)
        rows.append([result.name(index), *times, number(beauty.slope(), 2), last, number(result.mean("flip"), 3),
                     number(result.mean("passes"), 4)])
    return table(head, rows)


def slope_cell(curve: Curve) -> str:
    """The slope and the last error."""
    return f"{number(curve.slope(), 2)} &nbsp; {curve.errors[-1]:.1e}" if len(curve.errors) else "–"


def slopes_table(results: list[Result], layers: list[str]) -> str:
    """Slope and last error of each layer."""
    rows = []
    for index, result in enumerate(results):
        rows.append([result.name(index), *(slope_cell(result.layers[layer]) for layer in layers)])
    return table(["slope, relMSE reached", *layers], rows)


def about_reference(truth: Truth) -> str:
    """How good the reference is."""
    facts = truth.facts
    made = "; ".join(
        f"{', '.join(part['layers'])} by {part['passes']} passes of {part['integrator']} in {part['seconds']:.0f} s"
        for part in facts.get("parts", ()))
    error = facts.get("error")
    stated = f" Its relative standard error is {error:.2g}, {facts['stated_error']:g} was asked for." if error else ""
    own = (f" Its own relMSE, {truth.own_error:.1e}, is subtracted from that of beauty, of which nothing below "
           f"{TRUST * truth.own_error:.1e} is shown." if truth.own_error else " Its own error is not known.")
    name = truth.file.name + (f": {made}" if made else "")
    return f'<p class="faint">Reference: {escape(name)}.{stated}{own}</p>'


def scene_section(study: Study, scene: Path) -> str:
    """All about one scene."""
    truth = study.truths[scene]
    results = [Result(study, variant) for variant in study.variants if variant.scene == scene]
    lines = [Line(result.variant.label(), result.layers) for result in results]
    layers = [layer for layer in LIGHT if any(len(result.layers[layer].seconds) for result in results)]
    about = json.loads(scene.read_bytes()).get("about", "")
    return "".join([
        f'<section><h2>{escape(scene.stem)}</h2><p>{escape(about)}</p>', about_reference(truth),
        "<h3>Beauty</h3>", plot_one(lines), times_table(results),
        "<h3>Layers</h3>", plot_layers(lines, layers), slopes_table(results, layers),
        f"<h3>Pictures after {study.args.time:g} s</h3>", pictures(truth, [result.cells[0] for result in results]),
        "</section>"])


# Each axis by itself.


def last_error(study: Study, scene: Path, pair: tuple[str, str], layer: str) -> float:
    """The error at the end of an option's value, of the first integrator; NaN if the reference is too noisy to tell."""
    variants = [variant for variant in study.variants if variant.scene == scene and variant.values == (pair,)]
    errors = Result(study, variants[0]).layers[layer].errors if variants else []
    return float(errors[-1]) if len(errors) else float("nan")


def axes_section(study: Study) -> str:
    """The errors at the end of equal time by the values of each option; also written as axes.png."""
    layers = ["beauty", "caustic"]
    scenes = {scene.stem: scene for scene in study.args.scenes}
    axes = [Axis(name, values, {(stem, layer): [last_error(study, scene, (name, value), layer) for value in values]
                                for stem, scene in scenes.items() for layer in layers})
            for name, values in study.args.axis]
    with pyplot.rc_context(style()):
        figure = plot_axes(axes, list(scenes), layers, study.args.time)
        figure.savefig(study.args.output / "axes.png", dpi=110)
        return f"<section><h2>Each option by itself</h2>{inline(figure)}</section>"


# The page.


def introduction(study: Study) -> str:
    """What is shown and how to read it."""
    seeds = f"{study.args.repeat} seeds, whose errors are averaged" if study.args.repeat > 1 else "one seed"
    how = ("vkpm compared the images with the reference itself while it rendered" if study.vkpm.has_report
           else "renders were stopped after 1, 2, 4, … passes, compared, and went on")
    return f"""<h1>Error against time</h1>
<p>Each line is a way to render a scene at {study.args.size} pixels: an integrator with settings. Each had
{study.args.time:g} s of rendering (without starting up and saving) for each of {seeds}; {how}. Error is relMSE, the
mean over pixels and colours of (image − reference)² / (reference² + 0.01). Lower is better, and further left is
sooner.</p>
<p>Both axes are logarithmic, so a straight line is a power of time. Its slope is fitted through all points but the
first {LEFT_OUT}: −1 is pure noise averaged away, as in path tracing, and steeper while samples complement each other;
−2/3 is a photon map whose discs shrink; a line that flattens has a bias left, or has met the error of the reference.
The expected error of the reference is subtracted from that of beauty, and points below {TRUST} times it are left out;
layers are as measured. Times to an error say from when on it stays so small, read off the lines between points; “&gt;”
means it was not reached. FLIP maps show what an eye would notice, dark for nothing; press on a picture to see the
reference in its place.</p>"""


def circumstances(study: Study) -> str:
    """Machine, driver, program."""
    commits = ", ".join(sorted({cell.facts()["commit"] for cell in study.cells}))
    facts = {"processor": f"{study.machine['cpu']}, {study.machine['cores']} cores", "system": study.machine["system"],
             "device and driver": "; ".join(study.device["devices"]),
             "program": f"{study.vkpm.version}, commit {commits}",
             "rendered by": ", ".join(sorted({cell.facts()["device"] for cell in study.cells})),
             "page written": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")}
    rows = "".join(f"<tr><td>{name}</td><td>{escape(text)}</td></tr>" for name, text in facts.items())
    return f'<table class="facts">{rows}</table>'


def command_lines(study: Study) -> str:
    """Everything that was run, by cells."""
    commands = ((cell.name, "\n".join(cell.facts()["commands"])) for cell in study.cells)
    blocks = "".join(f"<h3>{escape(name)}</h3><pre>{escape(lines)}</pre>" for name, lines in commands)
    return f"<h2>Command lines</h2><details><summary>{len(study.cells)} renders</summary>{blocks}</details>"


def write_page(study: Study) -> Path:
    """Writes the page of a study whose cells are all finished, and returns its path."""
    sections = axes_section(study) if study.args.alone else ""
    sections += "".join(scene_section(study, scene) for scene in study.args.scenes)
    page = f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>vkpm: error against time</title><style>{STYLE}</style></head><body>
{introduction(study)}{circumstances(study)}{sections}{command_lines(study)}
<script>{SCRIPT}</script></body></html>
"""
    file = study.args.output / "index.html"
    file.with_suffix(".new").write_text(page)
    file.with_suffix(".new").rename(file)
    return file
