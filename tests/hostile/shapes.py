"""Hostile cases of shapes."""

import math

from lab import (
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
    same_pixels,
    sphere,
    without,
)


def floor_mesh(file: str) -> Scene:
    """The box whose floor is a mesh."""
    return plus(without(BOX, "floor"), {"name": "floor", "type": "mesh", "file": file, "material": "white"})


def grid_points(n: int) -> list:
    """Of a floor of n x n squares."""
    return [(-1 + 2 * x / n, -1, 1 - 2 * z / n) for z in range(n + 1) for x in range(n + 1)]


def grid_triangles(n: int) -> list:
    """Two for each square."""
    corners = [(z * (n + 1) + x) for z in range(n) for x in range(n)]
    return [t for c in corners for t in ((c, c + 1, c + n + 2), (c, c + n + 2, c + n + 1))]


@case("shape", "a floor of slivers 2 x 10^-4, zero-area triangles between them",
      "the box's means within 0.5 %, a warning")
def slivers(lab: Lab) -> Verdict:
    n = 20000
    points = [(-1 + 2 * i / n, -1, z) for i in range(n + 1) for z in (1, -1)]
    triangles = [t for i in range(0, 2 * n, 2) for t in ((i, i + 2, i + 3), (i, i + 3, i + 1), (i, i, i + 1))]
    render = lab.render(floor_mesh(lab.mesh("slivers.obj", points, triangles)), "--passes", "16")
    tame = lab.render(floor_mesh(lab.mesh("even.obj", grid_points(141), grid_triangles(141))), "--passes", "16")
    text, holds = same_means(render, tame, 0.005)
    warned = f"{n} of {3 * n} triangles have no area" in render.messages
    return Verdict(render, tame, f"{text}, {'warned' if warned else 'no warning'}", holds and warned)


@case("shape", "every triangle of the floor four times", "the box's means within 0.5 %")
def duplicates(lab: Lab) -> Verdict:
    render = lab.render(floor_mesh(lab.mesh("four.obj", grid_points(64), 4 * grid_triangles(64))), "--passes", "16")
    tame = lab.render(floor_mesh(lab.mesh("one.obj", grid_points(64), grid_triangles(64))), "--passes", "16")
    return Verdict(render, tame, *same_means(render, tame, 0.005))


@case("shape", "a second floor in the plane of the first", "the box's means within 0.5 %")
def coplanar(lab: Lab) -> Verdict:
    second = rectangle([-1.3, -1, 1.1], [2.9, 0, 0], [0, 0, -2.7], material="white")
    render = lab.render(plus(BOX, second), "--passes", "16")
    tame = lab.render(plus(without(BOX, "floor"), second), "--passes", "16")
    return Verdict(render, tame, *same_means(render, tame, 0.005))


@case("shape", "a needle of aspect 10^6 across the room", "the box's means within 0.5 %")
def needle(lab: Lab) -> Verdict:
    points = [(-0.9, -0.9, -0.9), (0.9, 0.9, 0.9), (0.9, 0.9 + 3e-6, 0.9)]
    scene = plus(BOX, {"name": "needle", "type": "mesh", "file": lab.mesh("needle.obj", points, [(0, 1, 2)]),
                       "material": "white"})
    render, tame = lab.render(scene, "--passes", "16"), lab.render(BOX, "--passes", "16")
    return Verdict(render, tame, *same_means(render, tame, 0.005))


@case("shape", "spheres of radius 10^-6 and 10^6", "mean of the path tracer within 2 %")
def spheres(lab: Lab) -> Verdict:
    scene = plus(without(BOX, "floor"), sphere([0, -1 - 1e6, 0], 1e6, material="white"),
                 sphere([0, 0, 0], 1e-6, material="mirror"), sphere([0.3, 0.2, 0], 1e-6, material="glass"))
    return against_path(lab, scene, 0.02)


def marble(radius: float, room: float) -> Scene:
    """A glass ball on the floor of a room, seen from nearby, under a lamp by the ceiling."""
    def wall(corner: list, u: list, v: list, **rest: object) -> Scene:
        return rectangle([room * x for x in corner], [room * x for x in u], [room * x for x in v], **rest)
    walls = [wall([-0.5, 0, 0.5], [1, 0, 0], [0, 0, -1], material="white"),
             wall([-0.5, 0, -0.5], [1, 0, 0], [0, 0.6, 0], material="white"),
             wall([-0.5, 0, 0.5], [0, 0, -1], [0, 0.6, 0], material="white"),
             wall([0.5, 0, -0.5], [0, 0, 1], [0, 0.6, 0], material="white"),
             wall([-0.5, 0.6, -0.5], [1, 0, 0], [0, 0, 1], material="white"),
             wall([-0.2, 0.58, -0.03], [0.06, 0, 0], [0, 0, 0.06], emission=[50, 50, 50])]
    camera = {"origin": [6 * radius, 7 * radius, 14 * radius], "target": [radius, 0, 0], "fieldOfView": 30}
    return changed(BOX, camera=camera, shapes=[*walls, sphere([0, radius, 0], radius, material="glass")])


def by_marble(radius: float, room: float) -> None:
    """Caustics of small things in large rooms."""
    @case("shape", f"a marble of radius {radius:g} in a room of {room:g}",
          "the caustic of light tracing, relMSE below 10^-3")
    def judge(lab: Lab) -> Verdict:
        options = "--layers", "caustic", "--caustic-photons", "50000", "--passes"
        render = lab.render(marble(radius, room), *options, "16")
        truth = lab.render(marble(radius, room), "--integrator", "light", *options, "120")
        return Verdict(render, lab.render(marble(room / 50, room), *options, "16"),
                       *same_pixels(render, truth, "caustic", 1e-3), work=1.5)


for case_of in ((0.02, 5), (0.0005, 0.5), (0.01, 50)):
    by_marble(*case_of)


@case("shape", "a mesh of one triangle", "mean of the path tracer within 2 %")
def one_triangle(lab: Lab) -> Verdict:
    file = lab.mesh("triangle.obj", [(-0.8, -0.9, 0.2), (0.8, -0.9, 0), (0, 0.3, -0.3)], [(0, 1, 2)])
    scene = plus(without(BOX, "mirror ball", "glass ball"),
                 {"name": "one", "type": "mesh", "file": file, "material": "red"})
    return against_path(lab, scene, 0.02)


@case("shape", "a bumpy mesh of 5,000,000 triangles", "mean of the path tracer within 2 %", heavy=True)
def many_triangles(lab: Lab) -> Verdict:
    n = 1582
    points = [(x, y + 1e-4 * math.sin(7 * i), z) for i, (x, y, z) in enumerate(grid_points(n))]
    scene = floor_mesh(lab.mesh("many.obj", points, grid_triangles(n)))
    return against_path(lab, scene, 0.02, floor_mesh(lab.mesh("even128.obj", grid_points(128), grid_triangles(128))))


def dark_room(thickness: float) -> Scene:
    """Two closed rooms, a lamp in the far one, the camera in the other."""
    wall = 0.0
    shapes = [rectangle([-1, -1, 1], [2, 0, 0], [0, 0, -2], material="white"),
              rectangle([-1, 1, -1], [2, 0, 0], [0, 0, 2], material="white"),
              rectangle([-1, -1, -1], [2, 0, 0], [0, 2, 0], material="white"),
              rectangle([1, -1, 1], [-2, 0, 0], [0, 2, 0], material="white"),
              rectangle([-1, -1, 1], [0, 0, -2], [0, 2, 0], material="white"),
              rectangle([1, -1, -1], [0, 0, 2], [0, 2, 0], material="white"),
              rectangle([-1, -1, wall], [2, 0, 0], [0, 2, 0], material="white"),
              rectangle([-1, -1, wall - thickness], [0, 2, 0], [2, 0, 0], material="white"),
              rectangle([-0.25, 0.99, -0.75], [0.5, 0, 0], [0, 0, 0.5], emission=[17, 12, 4])]
    return {"camera": {"origin": [0, 0, 0.95], "target": [0, 0, 0], "fieldOfView": 90}, "film": {"size": [64, 64]},
            "materials": {"white": {"type": "diffuse", "albedo": 0.7}}, "shapes": shapes}


@case("shape", "a wall of 10^-4 between a lit and a dark room",
      "no direct light leaks; of the light gathered in discs 10^-3 at most, less with more passes, as discs shrink")
def thin_wall(lab: Lab) -> Verdict:
    dark = dark_room(1e-4)
    lit = changed(dark, camera={"origin": [0, 0, -0.95], "target": [0, 0, -0.1], "fieldOfView": 90})
    render, longer = lab.render(dark, "--passes", "16"), lab.render(dark, "--passes", "64")
    tame = lab.render(lit, "--passes", "16")
    leak, later = render.mean() / tame.mean(), longer.mean() / tame.mean()
    return Verdict(render, tame, f"direct {render.mean('direct'):g}; in all {leak:.1e}, after 64 passes {later:.1e}",
                   render.mean("direct") == 0 and later < 0.9 * leak <= 0.9e-3)


@case("shape", "a smooth ball of 20 triangles, of glass", "mean of the path tracer within 2 %")
def coarse_glass(lab: Lab) -> Verdict:
    golden = (1 + math.sqrt(5)) / 2
    points = [p for a in (-1, 1) for b in (-golden, golden) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    edge = 2.0
    near = {i: [j for j, q in enumerate(points) if 0 < math.dist(p, q) <= edge * 1.01] for i, p in enumerate(points)}
    triangles = [(i, j, k) for i in near for j in near[i] for k in near[i] if i < j < k and k in near[j]]
    def outward(corners: tuple) -> tuple:
        a, b, c = (points[i] for i in corners)
        u, v = [y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, c, strict=True)]
        cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        facing = sum(x * y for x, y in zip(cross, a, strict=True))
        return corners if facing > 0 else (corners[0], corners[2], corners[1])
    ball = {"name": "ball", "type": "mesh", "file": lab.mesh("ball.obj", points, [outward(t) for t in triangles]),
            "smooth": True,
            "material": "glass", "transform": [{"scale": 0.18}, {"translate": [0.45, -0.6, 0.25]}]}
    flat = plus(without(BOX, "glass ball"), ball | {"smooth": False})
    return against_path(lab, plus(without(BOX, "glass ball"), ball), 0.02, flat)


