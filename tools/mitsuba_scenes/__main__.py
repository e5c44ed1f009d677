"""Writes a Mitsuba 3 scene as a scene of vkpm, with its meshes and images beside it."""

import argparse
import json
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path

from mitsuba_scenes.images import Images
from mitsuba_scenes.lights import Lights, camera
from mitsuba_scenes.materials import Materials
from mitsuba_scenes.shapes import Shapes
from mitsuba_scenes.source import Failure, Source, mi

ROOT = 0


def say(message: str) -> None:
    print(f"tools/from_mitsuba: {message}", file=sys.stderr)


def define(text: str) -> tuple[str, str]:
    name, sign, value = text.partition("=")
    if not name or not sign:
        raise argparse.ArgumentTypeError(f'found "{text}"; allowed: NAME=VALUE')
    return name, value


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/from_mitsuba", allow_abbrev=False, description=__doc__)
    add = parser.add_argument
    add("scene", type=Path, metavar="SCENE.xml", help="a scene of Mitsuba 3, or of an older one, which it upgrades")
    add("-o", "--output", type=Path, required=True, metavar="SCENE.json",
        help="the scene for vkpm; its meshes and images go into SCENE-files beside it")
    add("-D", "--define", type=define, action="append", default=[], metavar="NAME=VALUE",
        help="a parameter of the scene ($NAME), as of the program mitsuba")
    return parser.parse_args()


def converted(source: Source, images: Images, name: str) -> dict:
    """The scene."""
    kinds = mi.ObjectType
    root = source.node(ROOT)
    if root.plugin != "scene":
        raise Failure(f"{root.place}: found {root.plugin}; allowed: a scene")
    sensors = root.children(kinds.Sensor)
    if not sensors:
        raise Failure(f"{name}: the scene has no sensor; allowed: a perspective or thinlens one")
    if len(sensors) > 1:
        sensors[1].lose("all sensors but the first")
    for integrator in root.children(kinds.Integrator):
        if integrator.get("max_depth", -1) != -1:
            integrator.lose("the greatest length of paths (max_depth); light goes on to its end")
        if integrator.get("hide_emitters", False):
            integrator.lose("hidden emitters (hide_emitters)")
    view, size = camera(sensors[0])

    materials, lights = Materials(images), Lights(images)
    shapes = Shapes(images, materials)
    for shape in root.children(kinds.Shape):
        shapes.add(shape)
    for emitter in root.children(kinds.Emitter):
        lights.add(emitter)
    if not shapes.found:
        raise Failure(f"{name}: no shape is left; lost are: {'; '.join(source.losses) or 'none'}")

    lost = "; ".join(source.losses)
    scene = {"about": f"{name}, a scene of Mitsuba." + (f" Lost: {lost}." if lost else ""), "camera": view,
             "film": {"size": size, "exposure": "auto"}, "materials": materials.found}
    if lights.environment is not None:
        scene["environment"] = lights.environment
    if lights.found:
        scene["lights"] = lights.found
    return scene | {"shapes": shapes.found}


def text_of(scene: dict) -> str:
    """JSON with a line for each material, light and shape."""
    def item(key: str, value) -> str:
        if key == "materials" and value:
            lines = ",\n".join(f"    {json.dumps(name)}: {json.dumps(one)}" for name, one in value.items())
            return f"{{\n{lines}\n  }}"
        if key in ("lights", "shapes"):
            return "[\n" + ",\n".join(f"    {json.dumps(one)}" for one in value) + "\n  ]"
        return json.dumps(value)

    return "{\n" + ",\n".join(f"  {json.dumps(key)}: {item(key, value)}" for key, value in scene.items()) + "\n}\n"


def run(args: argparse.Namespace) -> None:
    """Converts into a folder beside, which is put in place when all went well."""
    if not args.scene.is_file():
        raise Failure(f"{args.scene}: there is no such file; allowed: a scene of Mitsuba")
    if args.output.suffix.lower() != ".json":
        raise Failure(f"--output: found {args.output}; allowed: a name that ends in .json")
    folder = args.output.absolute().parent
    if not folder.is_dir():
        raise Failure(f"--output: {folder} is no folder; make it, or choose another")
    stem = args.output.stem
    files = folder / f"{stem}-files"
    if files.exists() and not all(re.fullmatch(r"(image|mesh)\d+\.\w+", file.name) for file in files.iterdir()):
        raise Failure(f"--output: {files} holds other files than those of a scene; move it, or choose another name")
    source = Source(args.scene, dict(args.define))
    with tempfile.TemporaryDirectory(dir=folder, prefix=f".{stem}-") as beside:
        scene = converted(source, Images(Path(beside), stem), args.scene.name)
        for what, place in source.losses.items():
            say(f"{place}: lost: {what}")
        Path(beside, args.output.name).write_text(text_of(scene))
        shutil.rmtree(files, ignore_errors=True)
        if Path(beside, files.name).is_dir():
            os.replace(Path(beside, files.name), files)
        os.replace(Path(beside, args.output.name), args.output)


def main() -> int:
    """Runs the command, and tells how it failed."""
    args = parse_arguments()
    try:
        run(args)
    except Failure as failure:
        say(str(failure))
        return failure.code
    except OSError as error:
        say(str(error))
        return 1
    except KeyboardInterrupt:
        say("interrupted; nothing was written")
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
