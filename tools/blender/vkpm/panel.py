"""The settings of a render, and which of Blender's panels show beside them."""

from typing import ClassVar

import bpy

INTEGRATORS = [
    ("photon", "Photon mapping", "Photons from the lights, gathered by paths from the eye"),
    ("path", "Path tracing", "The reference: slow where light comes through glass"),
    ("light", "Light tracing", "Caustics alone, without a radius"),
    ("direct", "Direct light", "Light that comes straight from lamps, alone"),
]
# Blender's panels of lights, worlds, cameras and materials that are not marked as everybody's.
SHARED_PANELS = (
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_MATERIAL_PT_volume",
    "EEVEE_WORLD_PT_surface",
    "WORLD_PT_context_world",
    "DATA_PT_light",
    "DATA_PT_EEVEE_light",
    "DATA_PT_spot",
    "DATA_PT_camera",
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "DATA_PT_lens",
    "RENDER_PT_color_management",
)
SAVE_EVERY = 3  # seconds between pictures on the way
NOT_OURS = ("RENDER_PT_gpencil", "VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_simplify")


class Settings(bpy.types.PropertyGroup):
    """Of one scene."""

    program: bpy.props.StringProperty(
        name="Program",
        subtype="FILE_PATH",
        description="The program vkpm; empty: vkpm in PATH, or that of the source tree",
    )
    integrator: bpy.props.EnumProperty(name="Integrator", items=INTEGRATORS, description="How light is found")
    passes: bpy.props.IntProperty(name="Passes", min=1, max=1_000_000, default=64, description="Over the whole image")
    time: bpy.props.FloatProperty(
        name="Time", min=0, subtype="TIME", unit="TIME_ABSOLUTE", description="Seconds after which it ends; 0: no limit"
    )
    target_error: bpy.props.FloatProperty(
        name="Target error",
        min=0,
        max=10,
        precision=3,
        description="Relative error at which it ends, 0.05 for 5 %; 0: none",
    )
    photons: bpy.props.IntProperty(
        name="Photons", min=0, max=100_000_000, default=50_000, description="Emitted in each pass"
    )
    caustic_photons: bpy.props.IntProperty(
        name="Caustic photons",
        min=0,
        max=100_000_000,
        default=50_000,
        description="Aimed at glass and metal in each pass",
    )
    seed: bpy.props.IntProperty(name="Seed", min=0, description="Of the random numbers")
    folder: bpy.props.StringProperty(
        name="Keep files in", subtype="DIR_PATH", description="Where scene, model and picture stay; empty: nowhere"
    )

    def arguments(self):
        """Of the command line."""
        result = [
            "--integrator", self.integrator, "--passes", self.passes, "--photons", self.photons,
            "--caustic-photons", self.caustic_photons, "--seed", self.seed, "--checkpoint", SAVE_EVERY,
        ]  # fmt: skip
        if self.time > 0:
            result += ["--time", self.time]
        if self.target_error > 0:
            result += ["--target-error", self.target_error]
        return [str(argument) for argument in result]

    def fraction(self, passes, seconds):
        """How much of a render is done, at least: by its limit that comes first."""
        return min(1.0, max(passes / self.passes, seconds / self.time if self.time > 0 else 0))


class VKPM_PT_settings(bpy.types.Panel):
    bl_label = "vkpm"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES: ClassVar = {"VKPM"}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def draw(self, context):
        layout, settings = self.layout, context.scene.vkpm
        layout.use_property_split = True
        layout.use_property_decorate = False
        for group in (("integrator",), ("passes", "time", "target_error"), ("photons", "caustic_photons", "seed"),
                      ("program", "folder")):  # fmt: skip
            column = layout.column(align=True)
            for name in group:
                column.prop(settings, name)


def _panels():
    """Blender's panels that concern vkpm."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        name = panel.__name__
        if engines is not None and (name in SHARED_PANELS or "BLENDER_RENDER" in engines) and name not in NOT_OURS:
            yield panel


def register():
    bpy.utils.register_class(Settings)
    bpy.utils.register_class(VKPM_PT_settings)
    bpy.types.Scene.vkpm = bpy.props.PointerProperty(type=Settings)
    for panel in _panels():
        panel.COMPAT_ENGINES.add("VKPM")


def unregister():
    for panel in _panels():
        panel.COMPAT_ENGINES.discard("VKPM")
    del bpy.types.Scene.vkpm
    bpy.utils.unregister_class(VKPM_PT_settings)
    bpy.utils.unregister_class(Settings)
