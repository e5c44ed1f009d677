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


# A goblet's outline, distance from the axis and height: outside from the middle of the foot to the rim, then inside.
GOBLET_OUTSIDE = [(0, 0), (0.3, 0), (0.355, 0.01), (0.355, 0.03), (0.2, 0.06), (0.07, 0.14), (0.045, 0.3)]
GOBLET_OUTSIDE += [(0.045, 0.75), (0.08, 0.86), (0.22, 0.96), (0.37, 1.13), (0.42, 1.33), (0.385, 1.6), (0.325, 1.9)]
RIM = [(0.322, 1.906), (0.316, 1.906)]
GOBLET_INSIDE = [(0.313, 1.9), (0.373, 1.6), (0.408, 1.33), (0.358, 1.14), (0.21, 0.98), (0.08, 0.91), (0, 0.9)]


def goblet():
    """A glass for wine about the y axis, closed, its walls 0.012 thick."""
    return lathe(spline(GOBLET_OUTSIDE + RIM + GOBLET_INSIDE, 4))


def wine(vessel, level, overlap, steps, segments):
    """What a vessel holds: to the middle of its walls, so that both overlap, and flat at the top."""
    inside = [(x + overlap * nx, y + overlap * ny, nx, ny) for x, y, nx, ny in spline(vessel[::-1], steps)]
    inside[0] = (0.0, *inside[0][1:])
    below = [point for point in inside if point[1] < level]
    last, above = below[-1], next(point for point in inside if point[1] >= level)
    part = (level - last[1]) / (above[1] - last[1])
    edge = last[0] + part * (above[0] - last[0])
    return lathe([*below, (edge, level, last[2], last[3]), (edge, level, 0.0, 1.0), (0.0, level, 0.0, 1.0)], segments)


# A bottle's outline, likewise: outside from the middle of the bottom to the lip, then inside.
BOTTLE_OUTSIDE = [(0, 0.12), (0.2, 0.05), (0.3, 0), (0.36, 0.03), (0.37, 0.1), (0.37, 0.9), (0.37, 1.7), (0.355, 1.88)]
BOTTLE_OUTSIDE += [(0.26, 2.1), (0.165, 2.3), (0.142, 2.5), (0.138, 2.85), (0.155, 2.87), (0.155, 2.97), (0.145, 3.0)]
BOTTLE_INSIDE = [(0.112, 3.0), (0.105, 2.95), (0.11, 2.5), (0.135, 2.31), (0.23, 2.09), (0.32, 1.87), (0.337, 1.7)]
BOTTLE_INSIDE += [(0.337, 0.9), (0.337, 0.15), (0.3, 0.06), (0.2, 0.09), (0, 0.16)]


def bottle():
    """A bottle for wine about the y axis, closed, its walls 0.033 thick, without normals."""
    points, faces = lathe(spline(BOTTLE_OUTSIDE + BOTTLE_INSIDE, 2), 36)
    return [(position, None) for position, _ in points], faces


def label(radius=0.3715, low=0.45, high=1.45, angle=200, columns=32):
    """What sticks on the bottle: a part of a cylinder about the y axis, its middle towards +z."""

    def grid_point(i, j):
        turn = math.radians(angle) * (i / columns - 0.5)
        normal = (math.sin(turn), 0.0, math.cos(turn))
        return (radius * normal[0], low + j * (high - low), radius * normal[2]), normal, (i / columns, float(j))

    points, faces = grid(grid_point, columns, 1, closed=False)
    return points, [face[::-1] for face in faces]


def cube():
    """A cube from 0 to 1 in all axes; each face has the whole of a texture."""
    points, faces = [], []
    for axis in range(3):
        for side in (0.0, 1.0):
            for u, v in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)):
                corner = [0.0, 0.0, 0.0]
                corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3] = side, u, v
                points.append((tuple(corner), None, (u, v)))
            face = tuple(range(len(points) - 3, len(points) + 1))
            faces.append(face if side else face[::-1])
    return points, faces


def branch(leaves=90, length=1.6):
    """Leaves along a twig that hangs about the x axis: squares with the whole of a texture, each turned its own way."""
    points, faces = [], []
    random = fractions(11)
    for _ in range(leaves):
        x, swing, reach = length * next(random), TURN * next(random), 0.02 + 0.2 * next(random)
        stem = (x, reach * math.sin(swing) - 0.25 * x * x / length, 1.2 * reach * math.cos(swing))
        tip = unit((0.9 * next(random) - 0.2, -0.25 - 0.6 * next(random), 1.6 * next(random) - 0.8))
        across = unit(cross(tip, unit((next(random) - 0.5, 1.0, next(random) - 0.5))))
        size = 0.09 + 0.05 * next(random)
        for u, v in ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)):
            points.append((combine(combine(stem, across, 1.0, size * (u - 0.5)), tip, 1.0, size * v), None, (u, v)))
        faces.append(tuple(range(len(points) - 3, len(points) + 1)))
    return points, faces


def fractions(state):
    """Numbers in [0, 1), the same every time (Park and Miller 1988)."""
    while True:
        state = 48271 * state % 2147483647
        yield state / 2147483647


def spline(points, steps):
    """Points of a Catmull-Rom curve through an outline, each with the normal on the right of its way."""
    ends = [(-points[1][0], points[1][1]), *points, (-points[-2][0], points[-2][1])]
    curve = []
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:], strict=False):
        for step in range(steps + (c is points[-1])):
            t = step / steps
            place, ahead = [], []
            for k in (0, 1):
                first, second = (c[k] - a[k]) / 2, a[k] - 2.5 * b[k] + 2 * c[k] - d[k] / 2
                third = (3 * (b[k] - c[k]) + d[k] - a[k]) / 2
                place.append(b[k] + t * (first + t * (second + t * third)))
                ahead.append(first + t * (2 * second + 3 * t * third))
            length = math.hypot(*ahead)
            curve.append((place[0], place[1], ahead[1] / length, -ahead[0] / length))
    return curve


def lathe(profile, segments=56):
    """An outline turned about the y axis, of distance, height and normal; where a place has two normals is an edge."""
    points, rows = [], []
    for x, y, normal_x, normal_y in profile:
        rows.append([])
        for i in range(segments if x > 1e-9 else 1):
            around = (math.cos(TURN * i / segments), -math.sin(TURN * i / segments))
            rows[-1].append(len(points) + 1)
            points.append(((x * around[0], y, x * around[1]), (normal_x * around[0], normal_y, normal_x * around[1])))
    faces = []
    for k in range(len(profile) - 1):
        for i in range(segments if profile[k][:2] != profile[k + 1][:2] else 0):
            one, other, j = rows[k], rows[k + 1], (i + 1) % segments
            corners = [one[i % len(one)], one[j % len(one)], other[j % len(other)], other[i % len(other)]]
            faces.append(tuple(dict.fromkeys(corners)))
    return points, faces


def brilliant(table=0.56, crown=34.5, pavilion=40.75, girdle=0.015):
    """A round brilliant about the y axis of radius 1, its girdle about y = 0; angles of its main facets in degrees."""
    height = girdle + (1 - table) * math.tan(math.radians(crown))
    planes = [((0.0, 1.0, 0.0), height)]

    def ring(count, turned, tilt, through):
        # Facets that lean by an angle and go through a point at a distance from the axis and a height.
        for k in range(count):
            angle, lean = TURN * (k + turned) / count, math.radians(tilt)
            normal = (math.sin(lean) * math.cos(angle), math.cos(lean), -math.sin(lean) * math.sin(angle))
            planes.append((normal, math.sin(lean) * through[0] + math.cos(lean) * through[1]))

    ring(8, 0.5, 21, (table * 1.06, height))  # stars
    ring(8, 0, crown, (1, girdle))
    ring(16, 0.5, crown + 6, (0.99, girdle))
    ring(64, 0.5, 90, (1, 0))
    ring(16, 0.5, 180 - pavilion - 1.2, (0.99, -girdle))
    ring(8, 0, 180 - pavilion, (1, -girdle))
    return polyhedron(planes)


def polyhedron(planes):
    """The faces of what lies within all planes (unit normal, distance), each by cutting a square with all others."""
    points, faces = [], []
    for normal, distance in planes:
        side = unit(cross(normal, (0.0, 0.0, 1.0) if abs(normal[2]) < 0.9 else (1.0, 0.0, 0.0)))
        up = cross(normal, side)
        square = [(9, 9), (-9, 9), (-9, -9), (9, -9)]
        polygon = [combine(combine(side, up, x, y), normal, 1.0, distance) for x, y in square]
        for other, limit in planes:
            if other is not normal:
                polygon = cut(polygon, other, limit)
        face = []
        for corner in polygon:
            near = [i for i, (point, _) in enumerate(points) if math.dist(point, corner) < 1e-4]
            if not near:
                points.append((corner, None))
            face.append(near[0] if near else len(points) - 1)
        face = [i + 1 for i, following in zip(face, face[1:] + face[:1], strict=True) if i != following]
        if len(face) > 2:
            faces.append(tuple(face))
    return points, faces


def cut(polygon, normal, distance):
    """What of a polygon lies within a plane."""
    result = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        beyond_a, beyond_b = dot(a, normal) - distance, dot(b, normal) - distance
        if beyond_a <= 0:
            result.append(a)
        if beyond_a * beyond_b < 0:
            part = beyond_a / (beyond_a - beyond_b)
            result.append(combine(a, b, 1 - part, part))
    return result


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
    has_normals, has_coordinates = points[0][1] is not None, len(points[0]) > 2
    lines = [f"# {title}", "# Written by tools/make_meshes.py; change it there."]
    lines += ["v " + " ".join(map(number, point[0])) for point in points]
    lines += ["vt " + " ".join(map(number, point[2])) for point in points if has_coordinates]
    lines += ["vn " + " ".join(map(number, point[1])) for point in points if has_normals]

    def corner(i):
        return f"{i}/{i if has_coordinates else ''}/{i if has_normals else ''}".rstrip("/")

    lines += ["f " + " ".join(map(corner, face)) for face in faces]
    path.write_text("\n".join(lines) + "\n", newline="\n")


def main():
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1].startswith("-")):
        sys.exit(__doc__)
    default = pathlib.Path(__file__).resolve().parent.parent / "scenes"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) == 2 else default
    write(folder / "knot.obj", "A tube around a trefoil knot, closed, normals outward.", knot())
    write(folder / "ring.obj", "A metal band with rounded rims, closed, normals outward.", ring())
    write(folder / "goblet.obj", "A glass for wine, closed, normals outward.", goblet())
    content = "closed, normals outward, overlapping its walls."
    write(folder / "wine.obj", f"The wine in the goblet, {content}", wine(GOBLET_INSIDE, 1.38, 0.006, 6, 56))
    write(folder / "bottle.obj", "A bottle, closed.", bottle())
    write(folder / "bottle_wine.obj", f"The wine in the bottle, {content}", wine(BOTTLE_INSIDE, 1.95, 0.016, 2, 36))
    write(folder / "label.obj", "The label of the bottle, normals outward.", label())
    write(folder / "cube.obj", "A cube from 0 to 1.", cube())
    write(folder / "branch.obj", "Leaves of a hanging twig, one square each.", branch())
    write(folder / "brilliant.obj", "A cut stone, closed, flat facets.", brilliant())
    write(folder / "water.obj", "A water surface with waves, normals upward.", water())


if __name__ == "__main__":
    main()
