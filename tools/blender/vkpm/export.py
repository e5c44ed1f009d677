"""Scenes for vkpm: meshes and textures as Blender's glTF exporter writes them, and a scene file with what it loses."""

import json
import struct
from pathlib import Path

import bpy
import numpy as np
from bpy_extras.io_utils import ExportHelper

from .camera import Unsupported, write_camera
from .lights import write_lights
from .materials import read_material
from .world import write_world

GLB, JSON_CHUNK = 0x46546C67, 0x4E4F534A
SURFACES = ("MESH", "CURVE", "SURFACE", "FONT", "META")
EMISSION = "KHR_materials_emissive_strength"


def _export_gltf(file):
    """Meshes, materials and textures of the scene; cameras and lights come by the scene file."""
    bpy.ops.export_scene.gltf(
        filepath=str(file),
        export_format="GLB",
        use_active_scene=True,
        use_renderable=True,
        export_apply=True,
        export_animations=False,
        export_current_frame=True,
        export_cameras=False,
        export_lights=False,
        export_skins=False,
        export_morph=False,
        export_yup=True,
    )


def read_glb(file):
    """The JSON of a .glb file, and the bytes after it."""
    data = Path(file).read_bytes()
    magic, _, _, size, kind = struct.unpack_from("<5I", data)
    if magic != GLB or kind != JSON_CHUNK:
        raise ValueError(f"{file}: is no .glb file")
    return json.loads(data[20 : 20 + size]), data[20 + size :]


def write_glb(file, document, rest):
    """Replaces the JSON of a .glb file."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<5I", GLB, 2, 20 + len(text) + len(rest), len(text), JSON_CHUNK)
    Path(file).write_bytes(head + text + rest)


def set_emission(material, emission):
    """Writes a radiance into a material of glTF, from both sides as Blender's is."""
    for key in ("emissiveTexture", "emissiveFactor"):
        material.pop(key, None)
    strength = max(emission)
    if strength > 0:
        material["emissiveFactor"] = [value / strength for value in emission]
        material.setdefault("extensions", {})[EMISSION] = {"emissiveStrength": strength}
        material["doubleSided"] = True


def _is_closed(mesh):
    """Whether each edge has two faces."""
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    return len(mesh.edges) > 0 and bool(np.all(np.bincount(edges, minlength=len(mesh.edges)) == 2))


def _left_out(depsgraph):
    """What the exporter takes no notice of."""
    lost = {}
    for instance in depsgraph.object_instances:
        thing = instance.object
        if instance.is_instance and instance.parent.type not in ("EMPTY", "FONT") and thing.type in SURFACES:
            lost[f'what "{instance.parent.name}" scatters is left out; make it real (Object > Apply)'] = None
        elif thing.type not in (*SURFACES, "LIGHT", "CAMERA", "EMPTY", "ARMATURE", "LATTICE", "SPEAKER"):
            lost[f'"{thing.name}" is left out: vkpm has no equal for the kind {thing.type}'] = None
    return list(lost)


def _used_materials(depsgraph):
    """The materials of what is rendered, with whether all meshes that have them are closed."""
    found, meshes = {}, {}
    for instance in depsgraph.object_instances:
        thing = instance.object
        if thing.type not in SURFACES or thing.original.hide_render:
            continue
        for slot in thing.material_slots:
            if slot.material is None:
                continue
            if thing.data not in meshes:
                meshes[thing.data] = _is_closed(thing.data) if thing.type == "MESH" else True
            name = slot.material.name
            found[name] = (slot.material.original, meshes[thing.data] and found.get(name, (None, True))[1])
    return found


def _lamps(depsgraph):
    return [
        (instance.object.original, instance.matrix_world.copy())
        for instance in depsgraph.object_instances
        if instance.object.type == "LIGHT" and instance.show_self and not instance.object.original.hide_render
    ]


def write_scene(scene, depsgraph, file):
    """Writes a scene into a .json file, with what it needs beside it; returns warnings. Raises Unsupported, OSError."""
    file, warnings = Path(file), []
    model = file.with_suffix(".glb")
    document = write_camera(scene, scene.camera, warnings)
    warnings += _left_out(depsgraph)
    materials, emissions = {}, {}
    for name, (material, is_closed) in _used_materials(depsgraph).items():
        its, emission = read_material(material, is_closed, warnings)
        if its:
            materials[name] = its
        if emission is not None:
            emissions[name] = emission
    lights, shapes = write_lights(_lamps(depsgraph), file, warnings)
    environment = write_world(scene, file, warnings)
    _export_gltf(model)
    _patch(model, emissions)
    document = {
        "about": f"{scene.name}, exported from Blender",
        **document,
        "import": {"file": model.name, "lights": "unitless"},
    }
    for key, value in (("environment", environment), ("materials", materials), ("lights", lights), ("shapes", shapes)):
        if value:
            document[key] = value
    file.write_text(json.dumps(document, indent=1) + "\n")
    return warnings


def _patch(model, emissions):
    """Emission as Blender has it: exporters differ in what they take for it."""
    document, rest = read_glb(model)
    if not document.get("meshes"):
        raise Unsupported("nothing to render: the scene has no mesh that is shown in renders")
    for material in document.get("materials", []):
        emission = emissions.get(material.get("name"))
        if emission is not None:
            set_emission(material, emission)
    if any(map(any, emissions.values())):
        document["extensionsUsed"] = sorted({*document.get("extensionsUsed", []), EMISSION})
    write_glb(model, document, rest)


class VKPM_OT_export(bpy.types.Operator, ExportHelper):
    """Write the scene for vkpm: a scene file, and its meshes, textures and sky beside it"""

    bl_idname = "export_scene.vkpm"
    bl_label = "Export vkpm"
    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context):
        try:
            warnings = write_scene(context.scene, context.evaluated_depsgraph_get(), self.filepath)
        except (Unsupported, OSError, RuntimeError) as error:
            self.report({"ERROR"}, f"vkpm: {error}")
            return {"CANCELLED"}
        for warning in warnings:
            self.report({"WARNING"}, f"vkpm: {warning}")
        return {"FINISHED"}


def _menu(self, _):
    self.layout.operator(VKPM_OT_export.bl_idname, text="vkpm (.json)")


def register():
    bpy.utils.register_class(VKPM_OT_export)
    bpy.types.TOPBAR_MT_file_export.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(_menu)
    bpy.utils.unregister_class(VKPM_OT_export)
