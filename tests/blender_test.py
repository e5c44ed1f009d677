"""The add-on for Blender: what it exports, and its pictures against those of Cycles. Runs in the Blender that is
installed, or with Python's module bpy; without either it says so and is skipped (exit code 77). Argument: the program
vkpm."""

import importlib.util
import json
import math
import os
import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SKIPPED = 77
SIZE = 96, 72


def become_blender() -> None:
    """Goes on within Blender."""
    program = shutil.which("blender")
    if program is None:
        print("skipped: neither Blender (the program blender in PATH) nor Python's module bpy is installed")
        sys.exit(SKIPPED)
    # Blender's Python looks for its packages beside the python3 of PATH.
    command = [program, "-b", "--factory-startup", "--python-exit-code", "1", "--python", __file__, "--", *sys.argv[1:]]
    os.execve(program, command, {**os.environ, "PATH": os.defpath})


if importlib.util.find_spec("bpy") is None:
    become_blender()

import bpy  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, str(ROOT / "tools/blender"))
import vkpm  # noqa: E402
from vkpm import export, exr  # noqa: E402

# Scenes.


def empty(folder: Path):
    """An empty scene with a camera that looks along +y, a little down."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if not hasattr(bpy.types.Scene, "vkpm"):
        vkpm.register()
    scene = bpy.context.scene
    data = bpy.data.cameras.new("camera")
    scene.camera = bpy.data.objects.new("camera", data)
    scene.camera.location, scene.camera.rotation_euler = (0, -6, 2.6), (math.radians(72), 0, 0)
    scene.collection.objects.link(scene.camera)
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
    if hasattr(settings, "use_exr_interleave"):
        settings.use_exr_interleave = True
    scene.vkpm.folder = str(folder / "files")
    return scene


def shader(name: str, kind: str, **inputs):
    """A material of one shader node."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, node = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new(kind)
    for key, value in inputs.items():
        node.inputs[key].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return material


def absorb(material, color, density: float) -> None:
    """Fills a material with a volume."""
    tree = material.node_tree
    volume = tree.nodes.new("ShaderNodeVolumeAbsorption")
    volume.inputs["Color"].default_value, volume.inputs["Density"].default_value = (*color, 1), density
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(volume.outputs[0], output.inputs["Volume"])


def lamp(kind: str, place, turned=(0, 0, 0), **values):
    light = bpy.data.lights.new(kind, kind)
    for key, value in values.items():
        setattr(light, key, value)
    thing = bpy.data.objects.new(kind, light)
    thing.location, thing.rotation_euler = place, turned
    bpy.context.collection.objects.link(thing)
    return thing


def made_of(material):
    bpy.context.object.data.materials.append(material)


def ball(place, radius: float, material) -> None:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=place)
    bpy.ops.object.shade_smooth()
    made_of(material)


def sky(scene, file: Path) -> None:
    """An image that differs to all sides, turned and dimmed."""
    u, v = (np.arange(256) + 0.5) / 256, (np.arange(128) + 0.5) / 128
    texels = np.full((128, 256, 4), 0.2, np.float32)
    high = ((v > 0.6) & (v < 0.9))[:, None]
    texels[..., 0] += 2 * high * ((u > 0.1) & (u < 0.3))
    texels[..., 1] += 3 * high * ((u > 0.4) & (u < 0.5))
    texels[..., 2] += np.maximum(v - 0.5, 0)[:, None]
    image = bpy.data.images.new("sky", 256, 128, float_buffer=True)
    image.pixels.foreach_set(texels.ravel())
    image.filepath_raw, image.file_format = str(file), "OPEN_EXR"
    image.save()
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    names = ("ShaderNodeTexCoord", "ShaderNodeMapping", "ShaderNodeTexEnvironment")
    coordinates, mapping, texture = (tree.nodes.new(name) for name in names)
    texture.image = bpy.data.images.load(str(file))
    mapping.inputs["Rotation"].default_value = (0, 0, 0.7)
    background.inputs["Strength"].default_value = 2
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs[0], background.inputs["Color"])


def glass_under_lamps(folder: Path):
    """Balls of clear and coloured glass below two area lights and the sky. Lights of Cycles have no back and stop no
    light, so that each hangs below a black plate, which does."""
    scene = empty(folder)
    sky(scene, folder / "sky.exr")
    bpy.ops.mesh.primitive_plane_add(size=12)
    made_of(shader("floor", "ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.5, 1)))
    ball((-0.9, 0, 0.71), 0.7, shader("clear", "ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0, IOR=1.5))
    amber = shader("amber", "ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0, IOR=1.45)
    absorb(amber, (0.9, 0.5, 0.2), 1.5)
    ball((0.9, 0.3, 0.71), 0.7, amber)
    black = shader("plate", "ShaderNodeBsdfDiffuse", Color=(0, 0, 0, 1))
    lamp("AREA", (-0.9, 0, 4), shape="RECTANGLE", size=2, size_y=1.2, energy=120, color=(1, 0.9, 0.8))
    bpy.ops.mesh.primitive_plane_add(size=1, location=(-0.9, 0, 4.001))
    bpy.context.object.scale = (2, 1.2, 1)
    made_of(black)
    tilt = (0.2, 0.3, 0)
    lamp("AREA", (1.5, 0.5, 4), tilt, shape="DISK", size=1.5, energy=80, color=(0.7, 0.8, 1))
    bpy.ops.mesh.primitive_circle_add(
        vertices=64, radius=0.75, fill_type="NGON", location=(1.5, 0.5, 4.001), rotation=tilt
    )
    made_of(black)
    return scene


# Pictures.


def render(scene, engine: str, file: Path) -> dict[str, np.ndarray]:
    """The channels of a picture, by their names without that of the view layer."""
    scene.render.engine = engine
    scene.render.filepath = str(file)
    bpy.ops.render.render(write_still=True)
    return {name.removeprefix("ViewLayer."): values for name, values in exr.read(file).items()}


def colours(picture: dict[str, np.ndarray], layer: str) -> np.ndarray:
    return np.stack([picture[f"{layer}.{letter}"] for letter in "RGB"], axis=2)


def by_cycles(scene, file: Path, samples: int) -> np.ndarray:
    """All light, without the shortcuts that Cycles takes unless it is told otherwise."""
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = samples, False, False
    cycles.blur_glossy, cycles.sample_clamp_direct, cycles.sample_clamp_indirect = 0, 0, 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 24
    return colours(render(scene, "CYCLES", file), "Combined")


def check_means(scene, folder: Path) -> None:
    """Within 1 % of Cycles, in the whole picture and in its halves."""
    scene.vkpm.passes = 64
    ours = render(scene, "VKPM", folder / "vkpm.exr")
    beauty = colours(ours, "Combined")
    layers = [colours(ours, name) for name in ("Emission", "Direct", "Specular", "Caustic", "Indirect")]
    assert np.allclose(sum(layers), beauty, rtol=1e-4, atol=1e-5), "the passes are not the parts of Combined"
    assert layers[3].mean() > 0.01, "there is no caustic"
    assert np.all(ours["Normal.Z"][-1] > 0.99), "the floor's normals are not Blender's +z"
    assert np.all(ours["Combined.A"] == 1), "a picture with a sky is opaque"
    theirs = by_cycles(scene, folder / "cycles.exr", 768)
    middle = SIZE[0] // 2, SIZE[1] // 2
    parts = {
        "whole": np.s_[:], "upper": np.s_[: middle[1]], "lower": np.s_[middle[1] :],
        "left": np.s_[:, : middle[0]], "right": np.s_[:, middle[0] :],
    }  # fmt: skip
    ratios = {name: beauty[part].mean((0, 1)) / theirs[part].mean((0, 1)) for name, part in parts.items()}
    for name, ratio in ratios.items():
        print(f"mean of vkpm by that of Cycles, {name}: {ratio.round(4)}")
    assert all(np.all(abs(ratio - 1) < 0.01) for ratio in ratios.values()), "means are not those of Cycles"


def check_opacity(scene, folder: Path) -> None:
    """The sky is clear, the floor is not, which viewports do not show."""
    bpy.data.objects["Plane"].hide_viewport = True
    scene.render.film_transparent, scene.vkpm.passes = True, 1
    picture = render(scene, "VKPM", folder / "transparent.exr")
    assert np.all(picture["Combined.A"][0] == 0), "the sky is not transparent"
    assert np.all(picture["Combined.A"][-1] == 1), "the floor is not opaque"


def check_animation(scene, folder: Path) -> None:
    """A frame is exported as it is then, and not as the scene is now."""
    ball = bpy.data.objects["Sphere"]
    for frame, place in ((1, (0, 0, 2)), (2, (5, 0, 2))):
        ball.location = place
        ball.keyframe_insert("location", frame=frame)
    scene.frame_set(2)
    scene.frame_start = scene.frame_end = 1
    scene.render.engine, scene.render.filepath = "VKPM", str(folder / "frame")
    bpy.ops.render.render(animation=True)
    model, _ = export.read_glb(folder / "files/scene.glb")
    close(next(node for node in model["nodes"] if node["name"] == "Sphere")["translation"], [0, 2, 0])


def check_refusal(scene) -> None:
    scene.vkpm.program, good = "/nowhere/vkpm", scene.vkpm.program
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        assert "/nowhere/vkpm" in str(error) and "Program" in str(error), error
    else:
        raise AssertionError("a program that is not there was not missed")
    scene.vkpm.program = good


# Scene files.


def exported(scene, folder: Path) -> tuple[dict, dict, list[str]]:
    """The scene file, the model and the warnings."""
    file = folder / "exported.json"
    bpy.context.view_layer.update()
    warnings = export.write_scene(scene, bpy.context.evaluated_depsgraph_get(), file)
    return json.loads(file.read_text()), export.read_glb(file.with_suffix(".glb"))[0], warnings


def close(found, expected) -> None:
    assert np.allclose(found, expected, rtol=1e-5, atol=1e-6), f"found {found}, expected {expected}"


def check_lights(folder: Path) -> None:
    """Watts as Cycles has them: 10 W are 0.796 W/sr of a point; an area's are spread over pi A, and 4 A before 4.0."""
    scene = empty(folder)
    bpy.ops.mesh.primitive_plane_add()
    lamp("POINT", (1, 2, 3), energy=10, shadow_soft_size=0.1)
    lamp("SUN", (0, 0, 0), (math.radians(90), 0, 0), energy=3, angle=math.radians(2))
    lamp("SPOT", (0, 0, 1), energy=10, spot_size=math.radians(60), spot_blend=0, shadow_soft_size=0)
    lamp("AREA", (0, 0, 2), shape="RECTANGLE", size=2, size_y=0.5, energy=7).scale = (3, 1, 1)
    document, _, _ = exported(scene, folder)
    point, sun, spot = document["lights"]
    close(point["intensity"], [10 / (4 * math.pi)] * 3)
    close(point["position"], [1, 3, -2])
    close(point["radius"], 0.1)
    close(sun["direction"], [0, 0, 1])  # Blender's -y
    close([*sun["irradiance"], sun["angle"]], [3, 3, 3, 2])
    close([spot["outer"], spot["inner"], *spot["direction"]], [30, 30, 0, -1, 0])
    (area,) = document["shapes"]
    close(area["emission"], [7 / ((math.pi if bpy.app.version >= (4, 0, 0) else 4) * 3)] * 3)
    close(np.cross(*area["edges"]), [0, -3, 0])  # shines down
    again = folder / "again.json"
    assert bpy.ops.export_scene.vkpm(filepath=str(again)) == {"FINISHED"}
    assert json.loads(again.read_text())["lights"] == document["lights"]


def check_materials(folder: Path) -> None:
    """Solid glass is closed, thin glass is not; light is that of Blender; tricks for shadows are seen through."""
    scene = empty(folder)
    data = scene.camera.data
    data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop, data.lens = True, 4, 2, 50
    principled = "ShaderNodeBsdfPrincipled"
    transmission = "Transmission Weight" if bpy.app.version >= (4, 0, 0) else "Transmission"
    solid = shader(
        "solid", principled, **{transmission: 1, "Base Color": (0.25, 1, 1, 1), "IOR": 1.3, "Roughness": 0.5}
    )
    absorb(solid, (1, 0.5, 0), 4)
    ball((0, 0, 1), 0.5, solid)
    bpy.ops.mesh.primitive_plane_add()
    made_of(shader("pane", "ShaderNodeBsdfGlass", IOR=1.5, Roughness=0))
    bpy.ops.mesh.primitive_plane_add()
    made_of(shader("shine", "ShaderNodeEmission", Color=(1, 0.5, 0, 1), Strength=8))
    trick = shader("trick", "ShaderNodeBsdfGlass", IOR=1.4, Roughness=0)
    tree = trick.node_tree
    mix, path, clear = (tree.nodes.new(f"ShaderNode{name}") for name in ("MixShader", "LightPath", "BsdfTransparent"))
    tree.links.new(path.outputs["Is Shadow Ray"], mix.inputs[0])
    tree.links.new(next(node for node in tree.nodes if node.type == "BSDF_GLASS").outputs[0], mix.inputs[1])
    tree.links.new(clear.outputs[0], mix.inputs[2])
    tree.links.new(
        mix.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs["Surface"]
    )
    ball((2, 0, 1), 0.5, trick)
    document, model, warnings = exported(scene, folder)
    made = document["materials"]
    close([made["solid"]["ior"], made["solid"]["roughness"]], [1.3, 0.5])
    close(made["solid"]["tint"], [0.5 if bpy.app.version >= (4, 0, 0) else 0.25, 1, 1])
    assert "KHR_materials_emissive_strength" in model["extensionsUsed"]
    filled = made["solid"]["attenuation"]
    close(np.log(filled["color"]) / filled["distance"], [0, -2, -4])
    assert made["pane"]["thin"] and any("pane" in warning and "open" in warning for warning in warnings)
    assert "thin" not in made["solid"] and made["trick"]["type"] == "glass"
    shine = next(material for material in model["materials"] if material["name"] == "shine")
    strength = shine["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
    close(np.multiply(strength, shine["emissiveFactor"]), [8, 4, 0])
    close([document["camera"]["aperture"], document["camera"]["focusDistance"]], [0.0125, 4])


def main(program: str) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        check_lights(folder)
        check_materials(folder)
        scene = glass_under_lamps(folder)
        scene.vkpm.program = program
        check_means(scene, folder)
        check_opacity(scene, folder)
        check_animation(scene, folder)
        check_refusal(scene)
    print(f"Blender {bpy.app.version_string}: the add-on does what it should")


if __name__ == "__main__":
    main(sys.argv[-1])
    sys.exit(0)  # Blender remembers the render that was refused
