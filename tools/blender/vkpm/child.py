"""Exports a scene in a Blender of its own, since the one that renders must not change while it does. Arguments: the
file that holds the scene, its name, its view layer, the frame, the part of a frame, and the scene file to write. Beside
it export.json says how that went: {"warnings": [...]} or {"error": ...}."""

import json
import sys
import traceback
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from vkpm.export import write_scene


def show_as_rendered(scene, layer):
    """What the exporter sees is what viewports show: makes that what renders show."""
    for collection in bpy.data.collections:
        collection.hide_viewport = collection.hide_render
    for thing in layer.objects:
        thing.hide_viewport = thing.hide_render
        thing.hide_set(False, view_layer=layer)
        for modifier in thing.modifiers:
            modifier.show_viewport = modifier.show_render
            if modifier.type in ("SUBSURF", "MULTIRES"):
                modifier.levels = modifier.render_levels
        if thing.type == "META":
            thing.data.resolution = thing.data.render_resolution
    scene.render.simplify_subdivision = scene.render.simplify_subdivision_render


def export(blend, name, layer, frame, part, file):
    bpy.ops.wm.open_mainfile(filepath=blend, load_ui=False, use_scripts=False)
    scene = bpy.data.scenes[name]
    window = bpy.context.window_manager.windows[0]
    window.scene = scene
    if layer in scene.view_layers:
        window.view_layer = scene.view_layers[layer]
    show_as_rendered(scene, window.view_layer)
    scene.frame_set(int(frame), subframe=float(part))
    with bpy.context.temp_override(window=window, scene=scene, view_layer=window.view_layer):
        return write_scene(scene, bpy.context.evaluated_depsgraph_get(), file)


def main(arguments):
    answer = Path(arguments[-1]).with_name("export.json")
    try:
        result = {"warnings": export(*arguments)}
    except Exception as error:  # whatever it is, the Blender that waits has to say it
        traceback.print_exc()
        result = {"error": str(error)}
    answer.write_text(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :])
