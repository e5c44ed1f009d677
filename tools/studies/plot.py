"""Plots of error against time as inline SVG, in the text colour of the page around them."""

import io
import re
from dataclasses import dataclass

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.curves import Curve

# Of Okabe and Ito (2008), told apart by colour-blind people, and legible on light and dark ground.
COLOURS = ("#e69f00", "#0088d1", "#009e73", "#d55e00", "#cc79a7", "#56b4e9", "#8c8c8c")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
DASHES = ("-", "--", ":", "-.")
INK = "#010203"  # stands for the page's text colour


@dataclass
class Line:
    """A way to render, with its curve of each layer."""

    label: str
    layers: dict[str, Curve]


def inline(figure: Figure) -> str:
    """The SVG of a figure, without its XML header, and closes it."""
    file = io.StringIO()
    figure.savefig(file, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    text = re.sub(r"<metadata>.*?</metadata>", "", file.getvalue(), flags=re.DOTALL)
    return text[text.index("<svg"):].replace(INK, "currentColor")


def draw(axes: Axes, lines: list[Line], layer: str, with_labels: bool) -> None:
    """One layer of all lines."""
    for index, line in enumerate(lines):
        curve, turn = line.layers[layer], index // len(COLOURS)
        label = f"{line.label}: {curve.slope():+.2f}".replace("nan", "–").replace("+–", "–") if with_labels else None
        axes.plot(curve.seconds, curve.errors, label=label, color=COLOURS[index % len(COLOURS)], linewidth=1.6,
                  marker=MARKERS[index % len(MARKERS)], markersize=4, linestyle=DASHES[turn % len(DASHES)])
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(alpha=0.25, linewidth=0.6, color=INK)


def style() -> dict:
    """Settings of matplotlib for all plots."""
    ink = ("text.color", "axes.edgecolor", "axes.labelcolor", "axes.titlecolor", "xtick.color", "ytick.color")
    return {"svg.fonttype": "none", "font.family": "sans-serif", "font.size": 9, "axes.spines.top": False,
            "axes.spines.right": False, **dict.fromkeys(ink, INK)}


def plot_one(lines: list[Line]) -> str:
    """Beauty, with names and slopes of the lines."""
    with pyplot.rc_context(style() | {"svg.hashsalt": "beauty" + repr(lines)}):
        figure, axes = pyplot.subplots(figsize=(10, 4 + 0.15 * max(0, len(lines) - 12)), layout="constrained")
        draw(axes, lines, "beauty", True)
        axes.set_xlabel("seconds of rendering")
        axes.set_ylabel("relMSE of beauty")
        figure.legend(loc="outside right upper", title="slope", frameon=False, alignment="left")
        return inline(figure)


@dataclass
class Axis:
    """An option with its values, and the errors at the end of equal time by scene and layer, NaN where unknown."""

    name: str
    values: list[str]
    errors: dict[tuple[str, str], list[float]]  # of a scene and a layer, one for each value


def plot_axes(axes_studied: list[Axis], scenes: list[str], layers: list[str], seconds: float) -> Figure:
    """A panel for each option and layer; `layers` are rows."""
    figure, grid = pyplot.subplots(len(layers), len(axes_studied), figsize=(2.4 * len(axes_studied), 2.3 * len(layers)),
                                   layout="constrained", squeeze=False, sharey="row")
    for row, layer in zip(grid, layers, strict=True):
        for axes, axis in zip(row, axes_studied, strict=True):
            for index, scene in enumerate(scenes):
                axes.plot(range(len(axis.values)), axis.errors[scene, layer], color=COLOURS[index],
                          marker=MARKERS[index], markersize=4, linewidth=1.6, label=scene)
            axes.set_yscale("log")
            axes.set_xticks(range(len(axis.values)), axis.values, rotation=30, ha="right")
            axes.set_title(axis.name, loc="left")
            axes.grid(alpha=0.25, linewidth=0.6, color=INK)
        row[0].set_ylabel(f"relMSE of {layer}\nafter {seconds:g} s")
    figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=len(scenes), frameon=False)
    return figure


def plot_layers(lines: list[Line], layers: list[str]) -> str:
    """Small plots of the layers, side by side."""
    if not layers:
        return ""
    columns = 3
    rows = -(-len(layers) // columns)
    with pyplot.rc_context(style() | {"svg.hashsalt": "layers" + repr(lines)}):
        figure, grid = pyplot.subplots(rows, columns, figsize=(10, 2.7 * rows), layout="constrained", squeeze=False)
        for axes, layer in zip(grid.flat, layers, strict=False):
            draw(axes, lines, layer, False)
            axes.set_title(layer, loc="left")
        for axes in grid.flat[len(layers):]:
            axes.set_visible(False)
        figure.supxlabel("seconds of rendering", fontsize=9)
        figure.supylabel("relMSE", fontsize=9)
        return inline(figure)
