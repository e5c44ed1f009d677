"""The part of compare_gltf.py that runs within Blender. Arguments behind --: a model, the EXR file to write, and its
size, samples, sky and sun as JSON."""

import json
import math
import sys
from pathlib import Path

import bpy
import numpy
from mathutils import Vector

ANGLE = 40.0  # of the camera, degrees


def bounds() -> tuple[list[float], float]:
    """The middle and the radius of all points of the scene's meshes, y up as in glTF."""
    points = []
    graph = bpy.context.evaluated_depsgraph_get()
    for instance in graph.object_instances:
        if instance.object.type == "MESH":
            for vertex in instance.object.data.vertices:
                x, y, z = instance.matrix_world @ vertex.co
                points.append((x, z, -y))
    middle = [(min(p[i] for p in points) + max(p[i] for p in points)) / 2 for i in range(3)]
    return middle, max(math.dist(p, middle) for p in points)


def import_model(file: str) -> None:
    """A scene with the model and its lamps, without cameras and animations."""
    numpy.bool = bool  # which the importer of Blender 3.4 names, and numpy 1.24 has no more
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    for thing in list(bpy.data.objects):
        thing.animation_data_clear()
        if thing.type == "CAMERA":
            bpy.data.objects.remove(thing)
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.node_tree else ():
            if node.type == "BSDF_PRINCIPLED":
                node.distribution = "MULTI_GGX"
    bpy.context.view_layer.update()


def set_stage(middle: list[float], radius: float, stage: dict) -> dict:
    """Camera, sky and sun; returns the camera as vkpm's scene files have it."""
    scene = bpy.context.scene
    away = radius / math.sin(math.radians(ANGLE / 2))
    length = math.hypot(0.35, 1)
    origin = [middle[0], middle[1] + away * 0.35 / length, middle[2] + away / length]
    forward = Vector((0, away / length, -away * 0.35 / length))  # z up
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle, data.clip_start, data.clip_end = "VERTICAL", math.radians(ANGLE), away / 1e3, away * 10
    scene.camera = bpy.data.objects.new("camera", data)
    scene.camera.location = origin[0], -origin[2], origin[1]
    scene.camera.rotation_euler = forward.to_track_quat("-Z", "Y").to_euler()
    lamp = bpy.data.lights.new("sun", "SUN")
    lamp.energy, lamp.angle = stage["sun"], math.radians(stage["angle"])
    sun = bpy.data.objects.new("sun", lamp)
    x, y, z = stage["towards"]
    sun.rotation_euler = Vector((-x, z, -y)).to_track_quat("-Z", "Y").to_euler()
    for thing in (scene.camera, sun):
        scene.collection.objects.link(thing)
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (1, 1, 1, 1), stage["sky"]
    return {"origin": origin, "target": middle, "fieldOfView": ANGLE}


def render(file: str, output: str, stage: dict) -> None:
    """Writes the picture of a model, and beside it its camera."""
    import_model(file)
    camera = set_stage(*bounds(), stage)
    scene = bpy.context.scene
    scene.render.engine, scene.render.filepath = "CYCLES", output
    scene.render.resolution_x = scene.render.resolution_y = stage["size"]
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR", "32", "ZIP"
    cycles = scene.cycles
    cycles.pixel_filter_type, cycles.samples = "BOX", stage["samples"]
    cycles.use_denoising, cycles.use_adaptive_sampling, cycles.blur_glossy = False, False, 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 24
    cycles.transparent_max_bounces = 64
    Path(output).with_suffix(".camera.json").write_text(json.dumps(camera))
    bpy.ops.render.render(write_still=True)


model, picture, values = sys.argv[sys.argv.index("--") + 1 :]
render(model, picture, json.loads(values))
