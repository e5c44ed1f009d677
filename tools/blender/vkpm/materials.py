"""Blender's materials as vkpm's, where glTF has no word for them: solid glass, metal without a diffuse part, mixes,
what absorbs, and light. Others are as Blender's exporter writes them."""

import math
from dataclasses import dataclass, field

import bpy

from . import nodes
from .space import colour, times


@dataclass
class Surface:
    """What a shader node comes to: a material of vkpm, None for glTF's, and what it emits (W/(m^2 sr))."""

    material: dict | None = None
    emission: list | None = None
    lost: list = field(default_factory=list)


BLACK = {"type": "diffuse", "albedo": 0}


def _colour(node, *names):
    value = nodes.constant(node, *names)
    return None if value is None else colour(value)


def _clamped(values):
    return [min(value, 1.0) for value in values]


def _roughness(node):
    if getattr(node, "distribution", "") == "SHARP":
        return 0.0
    value = nodes.constant(node, "Roughness")
    return None if value is None else min(max(value, 0.0), 1.0)


def _is_compensated(node):
    return getattr(node, "distribution", "").startswith("MULTI")


def _complete(material, node):
    """As the exporter wrote it, if a texture decides on a value; of nodes but Principled it takes no notice."""
    if None not in material.values():
        return Surface(material)
    if node.type == "BSDF_PRINCIPLED":
        return Surface()
    return Surface(lost=[f"what its {node.bl_label} has of textures is left out; take a Principled BSDF"])


def _glass(node):
    surface = _complete(
        {
            "type": "glass",
            "ior": nodes.constant(node, "IOR"),
            "tint": _colour(node, "Color"),
            "roughness": _roughness(node),
        },
        node,
    )
    if surface.material:
        surface.material["tint"] = _clamped(surface.material["tint"])
    if node.type == "BSDF_REFRACTION":
        surface.lost.append("a Refraction BSDF reflects nothing; vkpm's glass reflects as glass does")
    return surface


def _glossy(node):
    """Reflects the same from all sides: a mirror. What is rough is metal, which is brighter at the rim."""
    shade, roughness = _colour(node, "Color"), _roughness(node)
    if shade is None or roughness is None:
        return _complete({"": None}, node)
    if roughness * roughness < 1e-3:
        return Surface({"type": "mirror", "reflectance": _clamped(shade)})
    metal = {"type": "metal", "reflectance": _clamped(shade), "roughness": roughness}
    if not _is_compensated(node):
        metal["multiscatter"] = False
    surface = Surface(metal)
    if nodes.constant(node, "Anisotropy"):
        surface.lost.append("anisotropy is left out")
    return surface


def _metallic(node):
    """Of the F82 kind: metal whose edge is as Schlick has it. Measured indices are left to the exporter."""
    if getattr(node, "fresnel_type", "") != "F82":
        return Surface(lost=["a Metallic BSDF by measured indices is left out; choose F82 Tint"])
    return _complete({"type": "metal", "reflectance": _colour(node, "Base Color"), "roughness": _roughness(node)}, node)


def _diffuse(node):
    return _complete({"type": "diffuse", "albedo": _colour(node, "Color")}, node)


def _principled(node):
    """Glass if most of it transmits, else the exporter's; what it emits in any case."""
    shade, strength = _colour(node, "Emission Color", "Emission"), nodes.constant(node, "Emission Strength")
    emission = times(shade, strength) if shade is not None and strength is not None else None
    transmission, metallic = (
        nodes.constant(node, "Transmission Weight", "Transmission"),
        nodes.constant(node, "Metallic"),
    )
    if not transmission or transmission < 0.5 or metallic is None or metallic >= 0.5:
        return Surface(emission=emission)
    tint, alpha = _colour(node, "Base Color"), nodes.constant(node, "Alpha")
    if tint is not None and bpy.app.version >= (4, 0, 0):
        tint = [math.sqrt(value) for value in tint]  # the colour is that of both faces together
    surface = _complete(
        {
            "type": "glass",
            "ior": nodes.constant(node, "IOR"),
            "tint": tint,
            "roughness": _roughness(node),
            "opacity": alpha,
        },
        node,
    )
    if surface.material:
        surface.material["tint"] = _clamped(surface.material["tint"])
        if alpha == 1:
            del surface.material["opacity"]
        if transmission < 1:
            surface.lost.append("glass that transmits in part is taken for glass")
    return surface


def _emission(node):
    shade, strength = _colour(node, "Color"), nodes.constant(node, "Strength")
    if shade is None or strength is None:
        return Surface()
    return Surface(dict(BLACK), times(shade, strength))


def _is_rays(node):
    """Whether a mix depends on the kind of ray: a trick that lets light through glass, of which vkpm has no need."""
    return node is not None and (
        node.type == "LIGHT_PATH" or (node.type == "MATH" and any(_is_rays(nodes.source(i)) for i in node.inputs))
    )


def _mix(node):
    first, second = (nodes.source(socket) for socket in node.inputs[1:3])
    by = nodes.source(node.inputs[0])
    clear = [n is not None and n.type == "BSDF_TRANSPARENT" for n in (first, second)]
    if _is_rays(by) and any(clear):
        return _of(second if clear[0] else first)
    if by is not None and by.type in ("FRESNEL", "LAYER_WEIGHT"):
        return _coated(by, first, second)
    part = nodes.constant(node, "Fac", "Factor")
    if part is None:
        return Surface(lost=["a mix by a texture is left out"])
    if part <= 0 or part >= 1:
        return _of(first if part <= 0 else second)
    if any(clear):
        surface = _of(second if clear[0] else first)
        if surface.material:
            surface.material["opacity"] = surface.material.get("opacity", 1) * (part if clear[0] else 1 - part)
        return surface
    heavier = _of(second if part > 0.5 else first)
    heavier.lost.append("of a mix of two shaders the greater part is taken for the whole")
    return heavier


def _coated(by, below, above):
    """A gloss over something diffuse: plastic."""
    if below is None or above is None or below.type != "BSDF_DIFFUSE" or "GLOSSY" not in above.type:
        return Surface(lost=["a mix by an angle is left out, but for a Diffuse BSDF below a Glossy BSDF"])
    ior = nodes.constant(by, "IOR") if by.type == "FRESNEL" else 1.5
    plastic = {"type": "plastic", "albedo": _colour(below, "Color"), "ior": ior, "roughness": _roughness(above)}
    return _complete(plastic, above)


def _add(node):
    first, second = (_of(nodes.source(socket)) for socket in node.inputs[:2])
    lights = [surface.emission for surface in (first, second) if surface.emission]
    bodies = [surface for surface in (first, second) if surface.material != BLACK]
    if len(bodies) == 2:
        bodies[0].lost.append("of a sum of two shaders the first is taken for the whole")
    result = bodies[0] if bodies else first
    result.emission = [sum(values) for values in zip(*lights, strict=True)] if lights else None
    return result


def _transparent(node):
    return Surface({**BLACK, "opacity": 0.0})


KINDS = {
    "BSDF_GLASS": _glass,
    "BSDF_REFRACTION": _glass,
    "BSDF_GLOSSY": _glossy,
    "BSDF_ANISOTROPIC": _glossy,
    "BSDF_METALLIC": _metallic,
    "BSDF_DIFFUSE": _diffuse,
    "BSDF_PRINCIPLED": _principled,
    "EMISSION": _emission,
    "MIX_SHADER": _mix,
    "ADD_SHADER": _add,
    "BSDF_TRANSPARENT": _transparent,
}


def _of(node):
    if node is None:
        return Surface(dict(BLACK))
    if node.type not in KINDS:
        return Surface(lost=[f"vkpm has no equal for the node {node.bl_label}"])
    return KINDS[node.type](node)


def _attenuation(node, lost):
    """Of a volume that absorbs: exp(-density (1 - colour) way)."""
    if node.type != "VOLUME_ABSORPTION":
        lost.append(f"the volume is left out: vkpm has Volume Absorption alone, found {node.bl_label}")
        return None
    shade, density = _colour(node, "Color"), nodes.constant(node, "Density")
    if shade is None or density is None:
        lost.append("the volume is left out: vkpm's are the same all over")
        return None
    if density <= 0:
        return None
    return {"color": [math.exp(-max(1 - value, 0)) for value in shade], "distance": 1 / density}


def read_material(material, is_closed, warnings):
    """A material's entry of "materials", None if glTF's is good, and what it emits, None likewise."""
    output = nodes.output(material.node_tree, "OUTPUT_MATERIAL") if material.node_tree and material.use_nodes else None
    if output is None:
        return None, None
    volume = nodes.source(output.inputs["Volume"])
    shader = nodes.source(output.inputs["Surface"])
    is_volume = shader is None and volume is not None
    surface = Surface({"type": "glass", "ior": 1.0}) if is_volume else _of(shader)
    if surface.material and surface.material["type"] == "glass":
        if not is_closed:
            surface.material["thin"] = True
            surface.lost.append("its mesh is open: it is taken for a thin sheet of glass")
        elif volume is not None:
            attenuation = _attenuation(volume, surface.lost)
            if attenuation:
                surface.material["attenuation"] = attenuation
    elif volume is not None:
        surface.lost.append("the volume is left out: only glass has one")
    if surface.emission and any(surface.emission) and surface.material and surface.material["type"] != "diffuse":
        surface.lost.append("what it emits is left out: what emits is diffuse, plastic or standard")
    warnings.extend(f'material "{material.name}": {what}' for what in surface.lost)
    return surface.material, surface.emission
