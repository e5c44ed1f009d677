"""Hostile cases of materials with lobes, and of media.

Their tame siblings are of the same kind: time is what the extreme costs, not what a driver takes to compile a lobe.
"""

from lab import (
    BALL,
    BOX,
    Lab,
    Scene,
    Verdict,
    against_path,
    case,
    changed,
    plus,
    rectangle,
    same_means,
    sphere,
    without,
)

EMPTY = without(BOX, "glass ball", "mirror ball")


def with_ball(**material: object) -> Scene:
    """The box with one ball of a material."""
    return plus(EMPTY, sphere(BALL, 0.35, material="matter"), matter=material)


def block(corner: list[float], sides: list[float], material: str) -> list[dict]:
    """Six faces, outward."""
    x, y, z = ([side if j == i else 0 for j in range(3)] for i, side in enumerate(sides))
    far = [[a + b for a, b in zip(corner, edge, strict=True)] for edge in (x, y, z)]
    faces = ((corner, x, z), (far[1], z, x), (corner, y, x), (far[2], x, y), (corner, z, y), (far[0], y, z))
    return [rectangle(*face, material=material) for face in faces]


def nested(*radii: float, **material: object) -> Scene:
    """Balls in a ball, all of one material."""
    return plus(EMPTY, *(sphere(BALL, radius, material="matter") for radius in radii), matter=material)


TAME = with_ball(type="glass", ior=1.5, abbe=60, priority=1)


def by_alpha(alpha: float, **material: object) -> None:
    """Facets from hardly to fully rough."""
    @case("gloss", f"a ball of {material['type']} with alpha {alpha:g}", "mean of the path tracer within 2 %")
    def judge(lab: Lab) -> Verdict:
        # On the same side of the threshold between narrow lobes, at which photons are aimed, and wide ones.
        tame = with_ball(**material, roughness=0.5 if alpha >= 0.25 else 0.4)
        return against_path(lab, with_ball(**material, roughness=alpha**0.5), 0.02, tame, "256")


for width in (1e-3, 0.03, 1):
    by_alpha(width, type="metal", reflectance=0.95)
    by_alpha(width, type="glass", ior=1.5)
by_alpha(1e-3, type="plastic", albedo=0.9)


def by_index(ior: float) -> None:
    """Rough glass that hardly differs from air."""
    @case("gloss", f"a rough ball of index 1 {ior - 1:+.0e}", "the empty box's mean within 1 %")
    def judge(lab: Lab) -> Verdict:
        empty = lab.render(EMPTY, "--passes", "16")
        tame = lab.render(with_ball(type="glass", ior=1.5, roughness=0.5), "--passes", "16")
        render = lab.render(with_ball(type="glass", ior=ior, roughness=0.7), "--passes", "16")
        return Verdict(render, tame, *same_means(render, empty, 0.01, ("beauty",)))


for index in (1 - 1e-6, 1 + 1e-6):
    by_index(index)


def by_thickness(thickness: float) -> Scene:
    """A frosted pane below a clear ball, whose caustic falls on it."""
    return plus(EMPTY, sphere([0.45, -0.45, 0.25], 0.35, material="glass"),
                *block([0.05, -0.95, -0.15], [0.8, thickness, 0.8], "frosted"),
                frosted={"type": "glass", "ior": 1.5, "roughness": 0.7})


@case("gloss", "a frosted pane of a ten-thousandth of the box, in a caustic", "mean of the path tracer within 2 %")
def thin(lab: Lab) -> Verdict:
    return against_path(lab, by_thickness(1e-4), 0.02, by_thickness(0.1), "256")


@case("gloss", "glass whose colours are half its index apart", "mean of the path tracer within 2 %")
def abbe(lab: Lab) -> Verdict:
    return against_path(lab, with_ball(type="glass", ior=1.5, abbe=1), 0.02, TAME, "256")


@case("gloss", "balls of glass in a ball of the same glass", "the means of the largest alone, within 1 %")
def shells(lab: Lab) -> Verdict:
    tame = lab.render(nested(0.35, type="glass", ior=1.5, priority=1), "--passes", "16")
    render = lab.render(nested(0.35, 0.3, 0.2, type="glass", ior=1.5), "--passes", "16")
    return Verdict(render, tame, *same_means(render, tame, 0.01))


@case("gloss", "a hundred balls of glass in each other", "a warning, no hang")
def hundred(lab: Lab) -> Verdict:
    render = lab.render(nested(*(0.35 - 0.003 * i for i in range(100)), type="glass", ior=1.5), "--passes", "4")
    warned = any("fifth medium" in warning for warning in render.stats["warnings"])
    return Verdict(render, lab.render(TAME, "--passes", "16"), "warned" if warned else "silent", warned, work=4)


@case("gloss", "two blocks of glass that overlap, no priority", "mean of the path tracer within 2 %")
def overlap(lab: Lab) -> Verdict:
    scene = plus(EMPTY, sphere(BALL, 0.35, material="water"), sphere([0.2, -0.6, 0.1], 0.3, material="heavy"),
                 water={"type": "glass", "ior": 1.33}, heavy={"type": "glass", "ior": 1.8})
    return against_path(lab, scene, 0.02, TAME, "256")


@case("gloss", "the camera and the lamp within red water", "mean of the path tracer within 2 %")
def within(lab: Lab) -> Verdict:
    water = {"type": "glass", "ior": 1.33, "attenuation": {"color": [0.9, 0.4, 0.3], "distance": 1}}
    return against_path(lab, plus(BOX, sphere([0, 0, 0], 40, material="water"), water=water), 0.02, TAME, "256")


@case("gloss", "red water up to the ceiling of the box", "mean of the path tracer within 2 %")
def full(lab: Lab) -> Verdict:
    water = {"type": "glass", "ior": 1.33, "attenuation": {"color": [0.9, 0.4, 0.3], "distance": 1}}
    low, high = [-0.99, -0.99, -0.99], 1.6
    faces = [(low, [1.98, 0, 0], [0, 0, 1.98]), ([-0.99, low[1] + high, 0.99], [1.98, 0, 0], [0, 0, -1.98]),
             (low, [0, high, 0], [1.98, 0, 0]), ([-0.99, -0.99, 0.99], [1.98, 0, 0], [0, high, 0]),
             (low, [0, 0, 1.98], [0, high, 0]), ([0.99, -0.99, -0.99], [0, high, 0], [0, 0, 1.98])]
    scene = plus(EMPTY, *(rectangle(*face, material="water") for face in faces), water=water)
    verdict = against_path(lab, scene, 0.02, TAME, "256")
    verdict.work = 2  # all paths are in water
    return verdict


@case("gloss", "a room of metal that loses a tenth at each wall", "E / (1 - 0.9), as the path tracer, within 2 %")
def metal_room(lab: Lab) -> Verdict:
    metal = {"type": "metal", "reflectance": 0.9, "roughness": 0.7}
    scene = changed(EMPTY, materials=dict.fromkeys(BOX["materials"], metal))
    tame = with_ball(type="metal", reflectance=0.9, roughness=0.7)
    verdict = against_path(lab, scene, 0.02, tame, "512")
    verdict.work = 2  # nothing ends a path soon
    return verdict


@case("gloss", "glass in glass, touching at a point; two blocks that share a face",
      "mean of the path tracer within 2 %")
def touching(lab: Lab) -> Verdict:
    x, y, z = BALL
    inner = sphere([x, y - 0.1, z], 0.25, material="inner")  # touches the outer ball from inside
    blocks = [face for left in (-0.5, -0.25) for face in block([left, -0.99, -0.3], [0.25] * 3, "glass")]
    scene = plus(without(BOX, "mirror ball"), inner, *blocks,
                 inner={"type": "glass", "ior": 1.0, "exteriorIor": 1.5})
    return against_path(lab, scene, 0.02, TAME, "512")
