"""Curves of error against time: their rows in files, means over seeds, slopes, and times to an error."""

import csv
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

NAN = float("nan")
TARGETS = (1e-2, 1e-3, 1e-4)  # relative mean square errors
LEFT_OUT = 2  # first points that slopes leave out, if enough remain
TRUST = 2  # errors below so many times the reference's own are not shown


@dataclass
class Row:
    """A line of error.csv: one layer after some passes, compared with the reference."""

    passes: int  # named pass in the file
    seconds: float
    rays: float
    photons: float
    layer: str
    rmse: float
    relmse: float
    mean_error: float
    flip: float = NAN
    noise: float = NAN
    bias: float = NAN
    error: float = NAN


COLUMNS = ["pass", *(field.name for field in fields(Row)[1:])]


def read_rows(path: Path) -> list[Row]:
    """Reads error.csv; empty numbers are unknown."""
    with path.open(newline="") as file:
        lines = list(csv.DictReader(file))
    numbers = [name for name in COLUMNS[1:] if name != "layer"]
    return [Row(int(line["pass"]), layer=line["layer"], **{name: float(line.get(name) or NAN) for name in numbers})
            for line in lines]


def write_rows(path: Path, rows: list[Row]) -> None:
    """Writes error.csv as vkpm does."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        writer.writerows(["" if value != value else value for value in vars(row).values()] for row in rows)


@dataclass
class Curve:
    """Relative mean square errors by seconds of rendering, both rising in time."""

    seconds: np.ndarray
    errors: np.ndarray

    def slope(self) -> float:
        """Of the line through the logarithms, without the first points if three others are there; NaN for one point."""
        first = LEFT_OUT if len(self.seconds) >= LEFT_OUT + 3 else 0
        if len(self.seconds) - first < 2:
            return NAN
        return float(np.polyfit(np.log(self.seconds[first:]), np.log(self.errors[first:]), 1)[0])

    def time_to(self, target: float) -> float:
        """Seconds from which on the error stays so small, between points by their logarithms; NaN if it does not."""
        # Not from the first small error: renders that have not met rare bright paths yet look better than they are.
        after = np.flatnonzero(np.append(True, self.errors > target))[-1]
        if after == len(self.errors):
            return NAN
        if after == 0:
            return float(self.seconds[0])
        x, y = np.log(self.seconds[after - 1:after + 1]), np.log(self.errors[after - 1:after + 1])
        return float(np.exp(x[0] + (np.log(target) - y[0]) / (y[1] - y[0]) * (x[1] - x[0])))

    def starts_below(self, target: float) -> bool:
        """Whether all points were so good that the time to it is a bound."""
        return len(self.errors) > 0 and bool(np.all(self.errors <= target))


def layer_curve(rows: list[Row], layer: str) -> Curve:
    """The curve of one layer in rows of one render; errors of zero are left out, as of layers that nothing is in."""
    points = sorted((row.seconds, row.relmse) for row in rows
                    if row.layer == layer and row.relmse > 0 and row.seconds > 0)
    return Curve(*np.array(points or np.empty((0, 2))).T)


def mean_curve(curves: list[Curve]) -> Curve:
    """The mean error of several seeds, at the times of the one that ended first."""
    if any(not len(curve.seconds) for curve in curves):
        return Curve(np.empty(0), np.empty(0))
    grid = min(curves, key=lambda curve: curve.seconds[-1]).seconds
    errors = [np.exp(np.interp(np.log(grid), np.log(curve.seconds), np.log(curve.errors))) for curve in curves]
    return Curve(grid, np.mean(errors, axis=0))


def without_reference(curve: Curve, own: float) -> Curve:
    """The curve less the reference's own relative mean square error, without points that it would dominate."""
    trusted = curve.errors >= TRUST * own
    return Curve(curve.seconds[trusted], curve.errors[trusted] - own)
