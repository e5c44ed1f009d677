#!/usr/bin/env python3
"""Writes the meshes of the shipped scenes, each from a formula, the same bytes every time.

Usage: tools/make_meshes.py [FOLDER]    default: scenes/ of this repository
"""

import math
import pathlib
import sys

TURN = 2 * math.pi


def knot(turns=320, sides=24, ring=1.0, swing=0.45, thickness=0.24):
    """A tube around the trefoil knot (2, 3) on a torus about the y axis; positions and outward normals on a grid."""

    def centre(t):
        distance = ring + swing * math.cos(3 * t)
        return (distance * math.cos(2 * t), swing * math.sin(3 * t), -distance * math.sin(2 * t))

    def grid_point(i, j):
        t, angle = TURN * i / turns, TURN * j / sides
        point, ahead, behind = centre(t), centre(t + 1e-5), centre(t - 1e-5)
        tangent = unit(difference(ahead, behind))

        # The knot lies in the torus, so the torus' normal is across it and comes back to itself after one round.
        across = (math.cos(3 * t) * math.cos(2 * t), math.sin(3 * t), -math.cos(3 * t) * math.sin(2 * t))
        normal = unit(combine(across, tangent, 1.0, -dot(across, tangent)))
        binormal = cross(tangent, normal)
        outward = combine(normal, binormal, math.cos(angle), math.sin(angle))
        return combine(point, outward, 1.0, thickness), outward

    return grid(grid_point, turns, sides, closed=True)


def ring(segments=160, inner=0.92, outer=1.0, height=0.5, rounding=0.035, steps=6):
    """A band about the y axis with rounded rims, its lower rim at y = 0."""
    # Quarter circles at the corners of the cross-section, clockwise: distance from the axis, height, and their normal.
    near, far, low, high = inner + rounding, outer - rounding, rounding, height - rounding
    profile = []
    for x, y, first in [(near, high, 180), (far, high, 90), (far, low, 0), (near, low, -90)]:
        for step in range(steps + 1):
            angle = math.radians(first - 90 * step / steps)
            normal = (math.cos(angle), math.sin(angle))
            profile.append((x + rounding * normal[0], y + rounding * normal[1], *normal))

    def grid_point(i, j):
        angle = TURN * i / segments
        x, y, normal_x, normal_y = profile[j % len(profile)]
        around = (math.cos(angle), -math.sin(angle))
        return (x * around[0], y, x * around[1]), (normal_x * around[0], normal_y, normal_x * around[1])

    return grid(grid_point, segments, len(profile), closed=True)


# Amplitude, waves along x and z per unit of length, phase: wavelengths of about 0.3 to 0.7.
WAVES = [
    (0.0200, 1.35, 0.55, 0.3),
    (0.0130, -0.90, 1.75, 1.9),
    (0.0090, 2.45, -0.80, 4.0),
    (0.0068, 1.60, 2.60, 5.1),
    (0.0045, -3.10, 1.20, 2.6),
]


def water(columns=120, rows=80, width=3.02, depth=2.02):
    """Waves about y = 0, the normals upward: a sum of sines over a rectangle about the y axis."""

    def grid_point(i, j):
        x, z = width * (i / columns - 0.5), depth * (j / rows - 0.5)
        height = slope_x = slope_z = 0.0
        for amplitude, across, along, phase in WAVES:
            angle = TURN * (across * x + along * z) + phase
            height += amplitude * math.sin(angle)
            slope_x += amplitude * TURN * across * math.cos(angle)
            slope_z += amplitude * TURN * along * math.cos(angle)
        return (x, height, z), unit((-slope_x, 1.0, -slope_z))

    return grid(grid_point, columns, rows, closed=False)


def grid(grid_point, columns, rows, closed):
    """Vertices, normals and quadrilaterals of a grid, which closes upon itself both ways or ends at its borders."""
    extra = 0 if closed else 1
    points = [grid_point(i, j) for i in range(columns + extra) for j in range(rows + extra)]
    stride = rows + extra

    def index(i, j):
        return (i % (columns + extra)) * stride + j % stride + 1

    faces = [
        (index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j))
        for i in range(columns)
        for j in range(rows)
    ]
    return points, faces


def difference(a, b):
    return tuple(x - y for x, y in zip(a, b, strict=True))


def combine(a, b, weight_a, weight_b):
    return tuple(weight_a * x + weight_b * y for x, y in zip(a, b, strict=True))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


def number(value):
    """Four decimals without what they do not need."""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write(path, title, mesh):
    points, faces = mesh
    lines = [f"# {title}", "# Written by tools/make_meshes.py; change it there."]
    lines += ["v " + " ".join(map(number, position)) for position, _ in points]
    lines += ["vn " + " ".join(map(number, normal)) for _, normal in points]
    lines += ["f " + " ".join(f"{i}//{i}" for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n", newline="\n")


def main():
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1].startswith("-")):
        sys.exit(__doc__)
    default = pathlib.Path(__file__).resolve().parent.parent / "scenes"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) == 2 else default
    write(folder / "knot.obj", "A tube around a trefoil knot, closed, normals outward.", knot())
    write(folder / "ring.obj", "A metal band with rounded rims, closed, normals outward.", ring())
    write(folder / "water.obj", "A water surface with waves, normals upward.", water())


if __name__ == "__main__":
    main()
