"""The world as vkpm's "environment": a colour, an image, or whatever Cycles makes of its nodes, as an image."""

import math
import shutil
from pathlib import Path

import bpy

from . import nodes
from .space import beside, colour, times

BAKED_HEIGHT = 1024  # of what Cycles renders in longitude and latitude


def _background(world):
    """The Background node that is all of a world; None if there is more to it."""
    if world.node_tree is None:
        return None
    output = nodes.output(world.node_tree, "OUTPUT_WORLD")
    node = nodes.source(output.inputs["Surface"]) if output else None
    return node if node is not None and node.type == "BACKGROUND" else None


def _turn(image):
    """By which angle about z its Mapping node turns an image, in degrees; None if it does anything else."""
    mapping = nodes.source(image.inputs["Vector"])
    if mapping is None:
        return 0.0
    angle = 0.0
    if mapping.type == "MAPPING":
        location, rotation, scale = (nodes.constant(mapping, key) for key in ("Location", "Rotation", "Scale"))
        sign = {"POINT": -1, "VECTOR": -1, "TEXTURE": 1}.get(mapping.vector_type)
        if None in (location, rotation, scale, sign) or any(rotation[:2]) or any(location) or list(scale) != [1, 1, 1]:
            return None
        angle = sign * math.degrees(rotation[2])
        mapping = nodes.source(mapping.inputs["Vector"])
    if mapping is None:
        return angle
    return angle if mapping.type == "TEX_COORD" else None


def _image_file(image):
    """The file of an image that vkpm reads as it is, linear floats; None otherwise."""
    if image is None or image.source != "FILE" or image.packed_file:
        return None
    path = Path(bpy.path.abspath(image.filepath, library=image.library))
    is_linear = image.colorspace_settings.name in ("Linear", "Linear Rec.709", "Non-Color", "scene_linear")
    return path if is_linear and path.suffix.lower() in (".exr", ".hdr") and path.is_file() else None


def _from_image(node, strength, scene_file):
    """An environment of an Environment Texture; None if Cycles has to look."""
    if node.projection != "EQUIRECTANGULAR":
        return None
    file, angle = _image_file(node.image), _turn(node)
    if file is None or angle is None:
        return None
    copy = beside(scene_file, "world" + file.suffix.lower())
    if not (copy.exists() and copy.samefile(file)):
        shutil.copyfile(file, copy)
    # The middle of the image is Blender's +x, and vkpm's -z, which is Blender's +y.
    return {"image": copy.name, "strength": strength, "rotation": angle - 90}


def _baked(world, scene_file, warnings):
    """An environment that Cycles renders, from all around."""
    if "CYCLES" not in {
        kind.bl_idname for kind in bpy.types.RenderEngine.__subclasses__() if hasattr(kind, "bl_idname")
    }:
        warnings.append(
            "the world's nodes are left out: they take Cycles, which is not enabled (Preferences > Add-ons)"
        )
        return {"radiance": colour(world.color)}
    baked = beside(scene_file, "world.exr")
    scene, data = bpy.data.scenes.new("vkpm world"), bpy.data.cameras.new("vkpm world")
    camera = bpy.data.objects.new("vkpm world", data)
    try:
        scene.collection.objects.link(camera)
        scene.camera, scene.world = camera, world
        camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)  # looks along +x
        data.type = "PANO"
        holder = data if hasattr(data, "panorama_type") else data.cycles
        holder.panorama_type = "EQUIRECTANGULAR"
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.pixel_filter_type = 64, False, "BOX"
        scene.cycles.filter_width = 1
        scene.cycles.use_adaptive_sampling = False
        scene.render.resolution_x, scene.render.resolution_y = 2 * BAKED_HEIGHT, BAKED_HEIGHT
        scene.render.resolution_percentage = 100
        scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
        scene.render.filepath = str(baked)
        bpy.ops.render.render(write_still=True, scene=scene.name)
    finally:
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(data)
        bpy.data.scenes.remove(scene)
    return {"image": baked.name, "rotation": -90}


def write_world(scene, scene_file, warnings):
    """The value of "environment"; None if the world is black."""
    world = scene.world
    if world is None:
        return None
    result = _from_nodes(world, scene_file, warnings) if world.use_nodes else {"radiance": colour(world.color)}
    if result is None:
        return None
    if scene.render.film_transparent:
        result["visible"] = False
    return result


def _from_nodes(world, scene_file, warnings):
    background = _background(world)
    if background is not None:
        strength, shade = nodes.constant(background, "Strength"), nodes.constant(background, "Color")
        if strength is not None and shade is not None:
            radiance = times(colour(shade), strength)
            return {"radiance": radiance} if any(radiance) else None
        linked = nodes.source(background.inputs["Color"])
        if strength is not None and linked is not None and linked.type == "TEX_ENVIRONMENT":
            result = _from_image(linked, strength, scene_file)
            if result:
                return result
    return _baked(world, scene_file, warnings)
