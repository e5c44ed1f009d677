"""Blender's lights as vkpm's "lights" and "shapes", in watts as Cycles has them."""

import math

import bpy

from . import nodes
from .space import axis, beside, colour, degrees, place, product, times

DISC_CORNERS = 64


def _power(light, matrix, warnings, name):
    """Colour times power: watts, or of a sun W/m^2."""
    result = times(colour(light.color), light.energy * 2 ** getattr(light, "exposure", 0.0))
    if getattr(light, "use_temperature", False):
        result = product(result, colour(light.temperature_color))
    if not getattr(light, "normalize", True):
        result = times(result, light.area(matrix_world=matrix))
    if light.use_nodes and light.node_tree:
        result = product(result, _node_factor(light, warnings, name))
    return result


def _node_factor(light, warnings, name):
    """What the light's nodes multiply by: those of one Emission node."""
    output = nodes.output(light.node_tree, "OUTPUT_LIGHT")
    emission = nodes.source(output.inputs["Surface"]) if output else None
    if emission is None:
        return [0.0, 0.0, 0.0]
    strength = nodes.constant(emission, "Strength") if emission.type == "EMISSION" else None
    tint = nodes.constant(emission, "Color") if strength is not None else None
    if tint is None:
        warnings.append(f'the nodes of the light "{name}" are left out: vkpm takes one Emission node with constants')
        return [1.0, 1.0, 1.0]
    return times(colour(tint), strength)


def _sun(light, matrix, power):
    return {
        "type": "sun",
        "direction": place(axis(matrix, 2).normalized()),
        "irradiance": power,
        "angle": min(max(degrees(light.angle), 0.001), 180.0),
    }


def _point(light, matrix, power):
    """Intensity is power over 4 pi, of spots too, whose cone concentrates nothing."""
    result = {
        "type": "point",
        "position": place(matrix.translation),
        "intensity": times(power, 1 / (4 * math.pi)),
        "radius": light.shadow_soft_size,
    }
    if light.type == "SPOT":
        result.update(type="spot", direction=place(-axis(matrix, 2).normalized()), **_cones(light))
    return result


def _cones(light):
    """Half angles. Cycles' rim is a smooth step of the cosine, vkpm's the square of a line: of three quarters of its
    width both lose the same flux."""
    outer = min(light.spot_size / 2, math.pi / 2)
    rim = 0.75 * light.spot_blend * (1 - math.cos(outer))
    return {"outer": degrees(outer), "inner": min(degrees(math.acos(math.cos(outer) + rim)), degrees(outer))}


def _sides(light, matrix):
    """The vectors along an area light's sides, in world units; their cross product points where it shines."""
    across, along = axis(matrix, 0) * light.size, axis(matrix, 1) * _height(light)
    if along.cross(across).dot(-axis(matrix, 2)) < 0:
        across, along = along, across
    return along, across


def _height(light):
    return light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size


def _area(light, matrix, power, name, file):
    """L = P / (pi A) on one side; before Blender 4.0 Cycles has P / (4 A)."""
    first, second = _sides(light, matrix)
    is_round = light.shape in ("DISK", "ELLIPSE")
    area = first.cross(second).length * (math.pi / 4 if is_round else 1)
    if area == 0:
        return None
    shape = {"name": name, "emission": times(power, 1 / ((math.pi if bpy.app.version >= (4, 0, 0) else 4) * area))}
    if not is_round:
        shape.update(
            type="rectangle",
            corner=place(matrix.translation - (first + second) / 2),
            edges=[place(first), place(second)],
        )
        return shape
    file.write_text(_disc(matrix.translation, first / 2, second / 2))
    shape.update(type="mesh", file=file.name, smooth=False)
    return shape


def _disc(center, first, second):
    """An OBJ file of a polygon with the area of the ellipse."""
    step = 2 * math.pi / DISC_CORNERS
    scale = math.sqrt(step / math.sin(step))
    lines = []
    for i in range(DISC_CORNERS):
        corner = center + scale * (math.cos(i * step) * first + math.sin(i * step) * second)
        lines.append("v {} {} {}".format(*place(corner)))
    lines.append("f " + " ".join(str(i + 1) for i in range(DISC_CORNERS)))
    return "\n".join(lines) + "\n"


def write_lights(instances, scene_file, warnings):
    """The keys "lights" and "shapes" of lamps, objects with matrices; round ones are files beside the scene file."""
    lights, shapes = [], []
    for thing, matrix in instances:
        light, name = thing.data, thing.name
        power = _power(light, matrix, warnings, name)
        if not any(power):
            continue
        if light.type == "SUN":
            lights.append(_sun(light, matrix, power))
        elif light.type == "AREA":
            if light.spread < math.pi - 1e-3:
                warnings.append(f'the spread of the light "{name}" is left out: it shines to all of its side')
            shape = _area(light, matrix, power, name, beside(scene_file, f"lamp_{len(shapes)}.obj"))
            if shape:
                shapes.append(shape)
        else:
            lights.append(_point(light, matrix, power))
    return lights, shapes
