"""Hostile cases of scale and place."""

import numpy as np

from lab import (
    BALL,
    BOX,
    Lab,
    Render,
    Verdict,
    against_path,
    case,
    changed,
    moved,
    percent,
    plus,
    rectangle,
    same_bits,
    same_means,
    scaled,
)


def median_difference(found: Render, expected: Render) -> float:
    """Of beauty, over pixels, in parts of its mean: paths that a rounding sends elsewhere do not count."""
    return float(np.median(np.abs(found.layer() - expected.layer()))) / expected.mean()


def by_power(exponent: int) -> None:
    """A scale that only changes exponents."""
    @case("scale", f"box × 2^{exponent}", "the same bits")
    def judge(lab: Lab) -> Verdict:
        tame, render = lab.render(BOX), lab.render(scaled(BOX, 2.0**exponent))
        return Verdict(render, tame, *same_bits(render, tame))


def by_factor(factor: float) -> None:
    """A scale that rounds."""
    @case("scale", f"box × {factor:g}", "means within 0.5 %, half of all pixels within 0.01 %")
    def judge(lab: Lab) -> Verdict:
        tame, render = lab.render(BOX), lab.render(scaled(BOX, factor))
        text, holds = same_means(render, tame, 0.005)
        median = median_difference(render, tame)
        return Verdict(render, tame, f"{text}, median {percent(median)}", holds and median < 1e-4)


for power in (-29, -13, 17, 38):  # all that is allowed, 1e-9 to 1e12
    by_power(power)
for scale in (6e-10, 1e-3, 1e3, 4e11):
    by_factor(scale)


def by_distance(distance: float) -> None:
    """A place far from the origin, by a number that is not a power of two."""
    @case("place", f"box moved by {distance:g} of its sizes", "means within 0.5 %, half of all pixels within 0.01 %")
    def judge(lab: Lab) -> Verdict:
        tame = lab.render(BOX)
        render = lab.render(moved(BOX, (2 * distance, -2 * distance, 1.4 * distance)))
        text, holds = same_means(render, tame, 0.005)
        median = median_difference(render, tame)
        return Verdict(render, tame, f"{text}, median {percent(median)}", holds and median < 1e-4)


for boxes in (1e4, 1e6):
    by_distance(boxes)


@case("place", "box moved by 2^20 of its sizes", "the same bits")
def far_by_power(lab: Lab) -> Verdict:
    tame, render = lab.render(BOX), lab.render(moved(BOX, (2.0**21, 0, -(2.0**21))))
    return Verdict(render, tame, *same_bits(render, tame))


def seen_from(lab: Lab, camera: dict) -> Verdict:
    """From another camera, against the path tracer there."""
    return against_path(lab, changed(BOX, camera=camera), 0.02)


@case("place", "camera inside the glass ball", "mean of the path tracer within 2 %")
def camera_in_glass(lab: Lab) -> Verdict:
    camera = {"origin": BALL, "target": [0.2, -0.4, -1], "up": [0, 1, 0], "fieldOfView": 60}
    return seen_from(lab, camera)


@case("place", "camera on the floor, to the bit", "mean of the path tracer within 2 %")
def camera_on_floor(lab: Lab) -> Verdict:
    camera = {"origin": [0, -1, 0.9], "target": [0, -0.5, 0], "up": [0, 1, 0], "fieldOfView": 60}
    return seen_from(lab, camera)


@case("place", "camera looks along a wall, at 89.99 degrees", "mean of the path tracer within 2 %")
def camera_grazing(lab: Lab) -> Verdict:
    camera = {"origin": [-0.9999, 0, 0.9], "target": [-0.9999 - 1.745e-4, 0, -0.1], "up": [0, 1, 0],
              "fieldOfView": 0.01}
    return seen_from(lab, camera)


@case("place", "a wall of 10^6 room sizes behind an opening", "mean of the path tracer within 2 %")
def horizon(lab: Lab) -> Verdict:
    scene = plus(BOX, rectangle([-1e6, -1.5, 1e6], [2e6, 0, 0], [0, 0, -2e6], material="white"))
    return against_path(lab, scene, 0.02)
