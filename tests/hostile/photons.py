"""Hostile cases of photons and gathers."""

from lab import (
    BOX,
    Lab,
    Scene,
    Verdict,
    against_path,
    case,
    changed,
    off,
    percent,
    plus,
    rectangle,
    same_means,
    sphere,
    without,
)


def no_photons(lab: Lab) -> Verdict:
    """Both maps are left out."""
    render, tame = lab.render(BOX, "--photons", "0", "--caustic-photons", "0"), lab.render(BOX)
    dark = render.mean("indirect") + render.mean("caustic")
    text, holds = same_means(render, tame, 1e-3, ("emission", "direct"))
    return Verdict(render, tame, f"indirect and caustic {dark:g}; direct {text}", holds and dark == 0)


case("photons", "0 photons", "no indirect light, no caustics; emission and direct light as ever")(no_photons)


def few(count: int) -> None:
    """Fewer than a disc holds."""
    @case("photons", f"{count} photon{'s' if count > 1 else ''} a pass",
          "the mean of many within 25 %: the noise of 128 passes")
    def judge(lab: Lab) -> Verdict:
        def discs(photons: int) -> tuple[str, ...]:
            return ("--size", "8x8", "--passes", "128", "--radius", "0.5", "--caustic-radius", "0.5", "--alpha", "1",
                    "--gather-rays", "4",
                    "--photons", str(photons), "--caustic-photons", str(photons))
        tame, render = lab.render(BOX, *discs(64)), lab.render(BOX, *discs(count))
        difference = off(render.mean(), tame.mean())
        return Verdict(render, tame, percent(difference), abs(difference) <= 0.25)


few(1)
few(2)


@case("photons", "20,000,000 photons a pass", "the mean of few within 1 %; time as photons", heavy=True)
def many_photons(lab: Lab) -> Verdict:
    tame = lab.render(BOX, "--photons", "1000000", "--caustic-photons", "1000000", "--passes", "1")
    render = lab.render(BOX, "--photons", "20000000", "--caustic-photons", "20000000", "--passes", "1")
    return Verdict(render, tame, *same_means(render, tame, 0.01), work=20)


def refused(radius: str) -> None:
    """A radius without a disc."""
    @case("photons", f"radius {radius}", "refused: exit 2, the option, what is allowed")
    def judge(lab: Lab) -> Verdict:
        render = lab.render(BOX, "--radius", radius)
        found = next((line for line in render.messages.splitlines() if line.startswith("vkpm: ")), "nothing said")
        right = render.code == 2 and "radius" in found and "allowed" in found
        render.problems = []
        return Verdict(render, None, found, right)


for tiny in ("0", "1e-20", "1e-45"):
    refused(tiny)


@case("photons", "both radii larger than the scene: all photons in one slot of the hash",
      "all gather rays count as near, and are path traced: mean and time of the path tracer, within 2 %; "
      "caustics spread over the disc")
def wide_radius(lab: Lab) -> Verdict:
    balls = lab.render(BOX, "--radius", "1000", "--caustic-radius", "1000")
    plain = without(BOX, "mirror ball", "glass ball")
    tame = lab.render(plain, "--passes", "64", "--integrator", "path")
    render = lab.render(plain, "--passes", "16", "--radius", "1000")
    difference, caustic = off(render.mean(), tame.mean()), balls.mean("caustic")
    render.problems += balls.problems
    return Verdict(render, tame, f"{percent(difference)}, caustic {caustic:.1e}",
                   abs(difference) < 0.02 and 0 < caustic < 1e-5)


def lens(caustic_photons: str, field_of_view: float) -> tuple[Scene, tuple[str, ...]]:
    """A small far lamp, which a ball lens gathers half a radius behind it: on the floor."""
    ball = sphere([0, -0.5, 0], 1 / 3, material="glass")
    lamp = rectangle([-0.005, 20, -0.005], [0.01, 0, 0], [0, 0, 0.01], emission=[1e6, 1e6, 1e6])
    floor = rectangle([-2, -1, 2], [4, 0, 0], [0, 0, -4], material="white")
    scene = {"camera": {"origin": [0, 0.3, 3], "target": [0, -1, 0], "fieldOfView": field_of_view},
             "film": {"size": [64, 64]},
             "materials": BOX["materials"], "shapes": [floor, ball, lamp]}
    return scene, ("--caustic-photons", caustic_photons, "--passes", "8")


@case("photons", "a ball lens brings 1,000,000 photons a pass into one spot",
      "the caustic's mean by light tracing within 3 %")
def focus(lab: Lab) -> Verdict:
    scene, options = lens("1000000", 1)
    render = lab.render(scene, *options)
    truth = lab.truth(scene, "--integrator", "light", "--caustic-photons", "1000000", "--passes", "4")
    spread = changed(scene,
                     shapes=[scene["shapes"][0], sphere([0, 0.6, 0], 1 / 3, material="glass"), scene["shapes"][2]])
    difference = off(render.mean("caustic"), truth.mean("caustic"))
    return Verdict(render, lab.render(spread, *options), percent(difference), abs(difference) <= 0.03)


@case("photons", "the same with a radius by hand that holds all of them",
      "the flux of the caustic by light tracing within 5 %")
def focus_by_hand(lab: Lab) -> Verdict:
    scene, options = lens("1000000", 3)
    render = lab.render(scene, *options, "--caustic-radius", "0.05")
    truth = lab.truth(scene, "--integrator", "light", "--caustic-photons", "1000000", "--passes", "4")
    difference = off(render.mean("caustic"), truth.mean("caustic"))
    return Verdict(render, lab.render(scene, *options), percent(difference), abs(difference) <= 0.05)


@case("photons", "a caustic seen only through glass, by way of a mirror", "mean of the path tracer within 3 %")
def hidden_caustic(lab: Lab) -> Verdict:
    # A pane of glass before the camera; the floor below the glass ball is behind a screen, and seen in a mirror.
    pane = [rectangle([-1, -1, 1.5], [2, 0, 0], [0, 2, 0], material="glass"),
            rectangle([-1, -1, 1.45], [0, 2, 0], [2, 0, 0], material="glass")]
    screen = rectangle([-0.2, -1, 0.8], [1.2, 0, 0], [0, 0.7, 0], material="white")
    back = rectangle([-1, -1, -1], [2, 0, 0], [0, 2, 0], material="mirror")
    scene = plus(without(BOX, "back"), back, screen, *pane)
    return against_path(lab, scene, 0.03, passes="512")


