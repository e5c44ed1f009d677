"""vkpm for Blender: a render engine with photon mapping, and an exporter of scenes for it."""

from . import engine, export, panel

bl_info = {
    "name": "vkpm",
    "description": "Renders with vkpm, a photon mapper: caustics of glass, water and metal",
    "author": "vkpm",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "Render Properties > Render Engine; File > Export > vkpm",
    "category": "Render",
}

MODULES = (panel, export, engine)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
