"""vkpm as a render engine of Blender: exports, runs the program, shows what it saves."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

from . import exr, program

# Name of the pass, its letters, Blender's kind of it, and the channels of vkpm's file.
PASSES = [
    *((name.capitalize(), "RGB", "COLOR", [f"{name}.{c}" for c in "RGB"])
      for name in ("emission", "direct", "specular", "caustic", "indirect", "albedo", "noise")),
    ("Normal", "XYZ", "VECTOR", ["normal.X", "normal.Y", "normal.Z"]),
    ("Depth", "Z", "VALUE", ["depth.Z"]),
]  # fmt: skip


class Failed(Exception):
    """Says why there is no picture."""


def _child_command(blend, depsgraph, scene_file):
    script = str(Path(__file__).with_name("child.py"))
    scene = depsgraph.scene
    frame = scene.frame_current, scene.frame_subframe
    arguments = [str(value) for value in (blend, scene.name, depsgraph.view_layer.name, *frame, scene_file)]
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--background", "--factory-startup", "--python", script, "--", *arguments]
    return [sys.executable, script, "--", *arguments]  # Blender as a module of Python


def export(depsgraph, folder):
    """Writes scene.json into the folder; returns it and warnings. Raises Failed."""
    blend, scene_file = folder / "scene.blend", folder / "scene.json"
    bpy.data.libraries.write(str(blend), {depsgraph.scene.original}, path_remap="ABSOLUTE", fake_user=True)
    answer = folder / "export.json"
    answer.unlink(missing_ok=True)
    done = subprocess.run(
        _child_command(blend, depsgraph, scene_file),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
        text=True,
        errors="replace",
    )
    if not answer.exists():
        raise Failed(f"the export ended with {done.returncode}: {(done.stderr or done.stdout).strip()[-400:]}")
    result = json.loads(answer.read_text())
    if "error" in result:
        raise Failed(result["error"])
    return scene_file, result["warnings"]


def pixels(image, channels):
    """Rows from below, a pixel a line, as Blender wants them."""
    return np.stack([image[name][::-1].ravel() for name in channels], axis=1)


def combined(image):
    """Beauty with its opacity, 1 where the file has none."""
    opaque = np.ones_like(image["R"])
    return pixels({**image, "A": image.get("A", opaque)}, ["R", "G", "B", "A"])


def in_blender(normals):
    """From y up to z up."""
    return np.stack([normals[:, 0], -normals[:, 2], normals[:, 1]], axis=1)


class VKPM_engine(bpy.types.RenderEngine):
    bl_idname = "VKPM"
    bl_label = "vkpm"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for name, letters, kind, _ in PASSES:
            self.register_pass(scene, renderlayer, name, len(letters), letters, kind)

    def render(self, depsgraph):
        settings = depsgraph.scene.vkpm
        try:
            if settings.folder:
                folder = Path(bpy.path.abspath(settings.folder))
                folder.mkdir(parents=True, exist_ok=True)
                self.render_in(depsgraph, folder)
            else:
                with tempfile.TemporaryDirectory(prefix="vkpm-") as name:
                    self.render_in(depsgraph, Path(name))
        except (Failed, exr.BadExr, OSError) as error:
            self.report({"ERROR"}, f"vkpm: {error}")
            self.error_set(f"vkpm: {error}")

    def render_in(self, depsgraph, folder):
        settings = depsgraph.scene.vkpm
        path = program.find(bpy.path.abspath(settings.program) if settings.program else "")
        if path is None:
            raise Failed(
                f"no program {settings.program or 'vkpm in PATH'}; give its path in Render Properties > vkpm > Program"
            )
        self.update_stats("", "Exporting")
        scene_file, warnings = export(depsgraph, folder)
        for warning in warnings:
            self.report({"WARNING"}, f"vkpm: {warning}")
        if self.test_break():
            return
        self.update_stats("", "Starting")
        self.follow(program.Render(path, scene_file, settings.arguments()), settings)

    def follow(self, render, settings):
        """Until the program ends; Esc interrupts it, once."""
        self.result = None
        interrupted = False
        try:
            while not render.wait(0.1):
                self.tell(render, settings)
                if self.test_break() and not interrupted:
                    interrupted = True
                    self.update_stats("", "Ends after this pass")
                    render.interrupt()
            self.tell(render, settings)
            code = render.process.returncode
            if code not in (0, 130):
                raise Failed(render.message() or f"the program ended with {code}")
            if render.picture.exists():
                self.show(render.picture)
        finally:
            if render.process.poll() is None:
                render.process.kill()
            if self.result is not None:
                self.end_result(self.result)

    def tell(self, render, settings):
        for event in render.events():
            if event["event"] == "warning":
                self.report({"WARNING"}, f"vkpm: {event['text']}")
            elif event["event"] == "pass":
                self.update_stats("", f"Pass {event['pass'] + 1}, {event['seconds']:.0f} s")
                self.update_progress(settings.fraction(event["pass"] + 1, event["seconds"]))
            elif event["event"] == "checkpoint":
                self.show(render.picture)

    def show(self, file):
        """Fills the result from a file."""
        image = exr.read(file)
        height, width = image["R"].shape
        if self.result is None:
            self.result = self.begin_result(0, 0, width, height)
            present = {layer_pass.name for layer_pass in self.result.layers[0].passes}
            for name, letters, _, _ in PASSES:
                if name not in present:
                    self.add_pass(name, len(letters), letters)
        passes = self.result.layers[0].passes
        _fill(passes["Combined"], combined(image))
        for name, _, _, channels in PASSES:
            if channels[0] in image and name in passes:
                values = pixels(image, channels)
                _fill(passes[name], in_blender(values) if name == "Normal" else values)
        self.update_result(self.result)


def _fill(layer_pass, values):
    values = np.ascontiguousarray(values, np.float32)
    try:
        layer_pass.rect.foreach_set(values)
    except TypeError:  # newer Blenders want numbers, older ones pixels
        layer_pass.rect.foreach_set(values.ravel())


def register():
    bpy.utils.register_class(VKPM_engine)


def unregister():
    bpy.utils.unregister_class(VKPM_engine)
