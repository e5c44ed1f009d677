"""tools/from_mitsuba: small scenes, each about a group of features, rendered by Mitsuba and by vkpm; what is lost and
what is refused. Skipped (exit code 77) where Python's module mitsuba is not installed.

mitsuba_test.py VKPM renders some; mitsuba_test.py VKPM --table [NAME ...] all, and prints the table of tools/README.md,
with pictures of both in the folder mitsuba-pictures."""

import importlib.util
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

SKIPPED = 77
SIZE = 96, 72
REGIONS = 4, 3
SAMPLES = 64, 32  # of Mitsuba by pixel, and passes; four times as many for the table
MOST = 0.02  # difference of means, beside four standard errors

if importlib.util.find_spec("mitsuba") is None:
    print("skipped: mitsuba is not installed; tools/environment --with mitsuba installs it")
    sys.exit(SKIPPED)

import mitsuba as mi  # noqa: E402

mi.set_variant("scalar_rgb")

# Scenes.

SKY = '<emitter type="constant"><rgb name="radiance" value="0.8, 0.9, 1"/></emitter>'
FLOOR = """<shape type="rectangle"><transform name="to_world"><scale value="4"/><rotate x="1" angle="-90"/></transform>
  <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.45, 0.4"/></bsdf></bsdf></shape>"""
LAMP = """<shape type="rectangle"><transform name="to_world"><scale value="1.5"/><rotate x="1" angle="90"/>
  <translate y="4"/></transform><emitter type="area"><rgb name="radiance" value="6, 5, 4"/></emitter></shape>"""


def sensor(kind: str = "perspective", more: str = "") -> str:
    return f"""<sensor type="{kind}"><float name="fov" value="45"/>{more}
  <transform name="to_world"><lookat origin="0, 2.2, 5.5" target="0, 0.7, 0" up="0, 1, 0"/></transform>
  <film type="hdrfilm"><integer name="width" value="{SIZE[0]}"/><integer name="height" value="{SIZE[1]}"/>
    <rfilter type="box"/></film>
  <sampler type="independent"><integer name="sample_count" value="{SAMPLES[0]}"/></sampler></sensor>"""


def scene(*parts: str, view: str | None = None) -> str:
    return "\n".join(['<scene version="3.0.0"><integrator type="path"/>', view or sensor(), *parts, "</scene>"])


def diffuse(color: str) -> str:
    return f'<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="{color}"/></bsdf></bsdf>'


def shape(kind: str, bsdf: str, place: str = "", more: str = "") -> str:
    return f'<shape type="{kind}">{more}{bsdf}<transform name="to_world">{place}</transform></shape>'


def balls(*bsdfs: str) -> list[str]:
    """A row of balls on the floor."""
    step = 5 / (len(bsdfs) + 0.5)
    return [shape("sphere", bsdf, f'<scale value="{0.45 * step:.3f}"/>'
                  f'<translate x="{step * (i - (len(bsdfs) - 1) / 2):.3f}" y="{0.45 * step:.3f}"/>')
            for i, bsdf in enumerate(bsdfs)]


def image(folder: Path, name: str, values: np.ndarray) -> str:
    """Writes an image, with sRGB in formats of 8 bits."""
    bitmap = mi.Bitmap(np.ascontiguousarray(values, np.float32))
    if not name.endswith(".exr"):
        bitmap = bitmap.convert(component_format=mi.Struct.Type.UInt8, srgb_gamma=True)
    bitmap.write(str(folder / name))
    return name


def letter(height: int = 12, width: int = 16) -> np.ndarray:
    """An image without symmetry."""
    values = np.full((height, width, 3), 0.7)
    values[1:-1, 2:5], values[-4:-1, 2:12], values[2:4, 8:14] = (0.8, 0.1, 0.1), (0.1, 0.6, 0.2), (0.1, 0.2, 0.8)
    return values


def shapes(folder: Path) -> str:
    return scene(
        FLOOR, LAMP, shape("cube", diffuse("0.7, 0.2, 0.2"), '<scale value="0.5"/><rotate y="1" angle="30"/>'
                           '<translate x="-1.6" y="0.5"/>'),
        shape("sphere", diffuse("0.2, 0.7, 0.2"), "", '<point name="center" value="0, 0.5, 0"/>'
              '<float name="radius" value="0.5"/>'),
        shape("cylinder", diffuse("0.2, 0.3, 0.8"), '<rotate x="1" angle="-90"/><translate x="1.5"/>',
              '<point name="p0" value="0, 0, 0"/><point name="p1" value="0, 0, 1.2"/>'
              '<float name="radius" value="0.4"/>'),
        shape("disk", diffuse("0.8, 0.8, 0.2"), '<scale value="0.8"/><rotate y="1" angle="-20"/>'
              '<translate x="0.4" y="1.6" z="-1"/>'))


def meshes(folder: Path) -> str:
    """An OBJ file with an image, a PLY file with normals and colours of vertices, one with colours of faces, instances,
    one of them mirrored."""
    folder.joinpath("roof.obj").write_text(
        "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.5 1\n"
        "f 4/1 3/2 5/3\nf 3/1 2/2 5/3\nf 2/1 1/2 5/3\nf 1/1 4/2 5/3\n")
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 33), np.linspace(0, np.pi, 17))
    points = np.stack([np.sin(v) * np.cos(u), 0.6 * np.cos(v), 0.8 * np.sin(v) * np.sin(u)], -1).reshape(-1, 3)
    normals = points / np.array((1, 0.36, 0.64))
    colours = 0.5 + 0.4 * points / (1, 0.6, 0.8)
    lines = [" ".join(f"{x:.6f}" for x in (*p, *n / np.linalg.norm(n), *c))
             for p, n, c in zip(points, normals, colours, strict=True)]
    faces = [f"3 {a} {b} {c}" for j in range(16) for i in range(32) for k in (33 * j + i,)
             for a, b, c in ((k, k + 1, k + 34), (k, k + 34, k + 33))[not j:2 - (j == 15)]]
    folder.joinpath("egg.ply").write_text(
        "ply\nformat ascii 1.0\n" + f"element vertex {len(lines)}\n"
        + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "r", "g", "b"))
        + f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        + "\n".join(lines + faces) + "\n")
    folder.joinpath("tiles.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nproperty float r\nproperty float g\n"
        "property float b\nend_header\n-1 0 0\n1 0 0\n1 1 0\n-1 1 0\n3 0 1 2 0.8 0.2 0.1\n3 0 2 3 0.1 0.3 0.7\n")
    name = image(folder, "letter.png", letter())
    coloured = ('<bsdf type="twosided"><bsdf type="{}"><texture type="mesh_attribute" name="{}">'
                '<string name="name" value="{}"/></texture></bsdf></bsdf>')
    group = ('<shape type="shapegroup" id="group">'
             + shape("cube", diffuse("0.7, 0.3, 0.2"), '<scale x="0.2" y="0.6" z="0.2"/><translate x="0.3" y="0.6"/>')
             + shape("sphere", diffuse("0.2, 0.5, 0.7"), '<scale value="0.25"/><translate x="-0.1" y="0.25"/>')
             + "</shape>")
    textured = (f'<bsdf type="twosided"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">'
                f'<string name="filename" value="{name}"/></texture></bsdf></bsdf>')
    file = '<string name="filename" value="{}"/>'
    return scene(
        FLOOR, SKY, group, shape("obj", textured, '<scale value="0.9"/><translate x="-1.5"/>', file.format("roof.obj")
                          + '<boolean name="face_normals" value="true"/>'),
        shape("ply", coloured.format("diffuse", "reflectance", "vertex_color"),
              '<scale value="0.8"/><translate y="0.5" z="0.6"/>', file.format("egg.ply")),
        shape("ply", coloured.format("conductor", "specular_reflectance", "face_color"),
              '<translate x="0.2" y="0.6" z="-1.5"/>', file.format("tiles.ply")),
        *(shape("instance", '<ref id="group"/>', place) for place in
          ('<translate x="1.3"/>', '<scale x="-1"/><rotate y="1" angle="40"/><translate x="2.2" z="-0.8"/>')))


def textures(folder: Path) -> str:
    """Images and checkerboards on all shapes, turned, repeated, and with all kinds of numbers."""
    name, floats = image(folder, "letter.png", letter()), image(folder, "letter.exr", letter(24, 32) * 0.8)

    def textured(file: str, more: str = "") -> str:
        return ('<bsdf type="twosided"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">'
                f'<string name="filename" value="{file}"/>{more}</texture></bsdf></bsdf>')

    board = ('<bsdf type="twosided"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">'
             '<rgb name="color0" value="0.8, 0.3, 0.2"/><rgb name="color1" value="0.2, 0.3, 0.6"/>'
             '<transform name="to_uv"><scale x="5" y="3"/><translate x="0.1" y="0.3"/></transform>'
             '</texture></bsdf></bsdf>')
    turned = '<transform name="to_uv"><scale x="2" y="3"/><rotate z="1" angle="30"/><translate x="0.2"/></transform>'
    return scene(
        shape("rectangle", board, '<scale value="4"/><rotate x="1" angle="-90"/>'), SKY,
        shape("rectangle", textured(name), '<scale x="0.9" y="0.7"/><translate x="-1.5" y="0.8" z="-0.5"/>'),
        shape("rectangle", textured(floats, turned + '<string name="wrap_mode" value="mirror"/>'
                                    '<string name="filter_type" value="nearest"/>'),
              '<scale x="0.7" y="0.7"/><translate x="0.3" y="0.8" z="-0.6"/>'),
        shape("sphere", textured(name, '<boolean name="raw" value="true"/>'),
              '<rotate x="1" angle="-90"/><rotate y="1" angle="-60"/><scale value="0.5"/>'
              '<translate x="1.5" y="0.5"/>'),
        shape("cylinder", textured(name), '<scale x="0.3" y="0.3"/><rotate x="1" angle="-90"/>'
              '<translate x="2.4" z="-0.5"/>'),
        shape("disk", textured(floats), '<scale value="0.4"/><rotate x="1" angle="-20"/>'
              '<translate y="0.4" z="1"/>'))


def plastics(folder: Path) -> str:
    def plastic(kind: str, more: str) -> str:
        return (f'<bsdf type="{kind}"><rgb name="diffuse_reflectance" value="0.8, 0.3, 0.1"/>'
                f'<float name="int_ior" value="1.5"/>{more}</bsdf>')

    ggx = '<string name="distribution" value="ggx"/><float name="alpha" value="{}"/>'
    return scene(FLOOR, SKY, LAMP, *balls(
        plastic("plastic", ""), plastic("plastic", '<boolean name="nonlinear" value="true"/>'),
        plastic("roughplastic", ggx.format(0.1)), plastic("roughplastic", ggx.format(0.3))))


def metals(folder: Path) -> str:
    def rough(name: str, alpha: float) -> str:
        return (f'<bsdf type="roughconductor"><string name="material" value="{name}"/>'
                f'<string name="distribution" value="ggx"/><float name="alpha" value="{alpha}"/></bsdf>')

    mirror = '<bsdf type="conductor"><rgb name="specular_reflectance" value="0.9, 0.8, 0.7"/></bsdf>'
    return scene(FLOOR, SKY, LAMP, *balls(
        mirror, '<bsdf type="conductor"><string name="material" value="Au"/></bsdf>', rough("Cu", 0.1),
        rough("Al", 0.4)))


def glass(folder: Path) -> str:
    pane = shape("rectangle", '<bsdf type="thindielectric"/>', '<scale value="0.7"/><rotate y="1" angle="30"/>'
                 '<translate x="0.2" y="0.8" z="1.2"/>')
    clear = '<bsdf type="dielectric"><string name="int_ior" value="{}"/><string name="ext_ior" value="{}"/></bsdf>'
    within = shape("sphere", clear.format("water", "bk7"), '<scale value="0.4"/><translate y="0.75"/>')
    return scene(FLOOR, SKY, pane, within, *balls(
        '<bsdf type="dielectric"><string name="int_ior" value="bk7"/></bsdf>', clear.format("bk7", "air"),
        '<bsdf type="roughdielectric"><float name="int_ior" value="1.5"/><string name="distribution" value="ggx"/>'
        '<float name="alpha" value="0.2"/></bsdf>'))


def sky(folder: Path) -> str:
    """An image that differs to all sides, turned and tilted."""
    u, v = np.meshgrid((np.arange(128) + 0.5) / 128, (np.arange(64) + 0.5) / 64)
    texels = np.full((64, 128, 3), 0.2)
    texels[..., 0] += 2 * ((u > 0.1) & (u < 0.3) & (v < 0.5))
    texels[..., 1] += 3 * ((u > 0.4) & (u < 0.5) & (v < 0.6))
    texels[..., 2] += 2 * np.maximum(0.6 - v, 0) * (u > 0.7)
    name = image(folder, "texels.exr", texels)
    environment = (f'<emitter type="envmap"><string name="filename" value="{name}"/><float name="scale" value="0.7"/>'
                   '<transform name="to_world"><rotate x="1" angle="25"/><rotate y="1" angle="70"/></transform>'
                   '</emitter>')
    return scene(FLOOR, environment, *balls(diffuse("0.7, 0.7, 0.7"), '<bsdf type="conductor"/>'))


def lamps(folder: Path) -> str:
    spot = ('<emitter type="spot"><rgb name="intensity" value="30, 25, 20"/><float name="cutoff_angle" value="25"/>'
            '<float name="beam_width" value="{}"/><transform name="to_world">'
            '<lookat origin="{}, 4, 1" target="{}, 0, 0" up="0, 0, 1"/></transform></emitter>')
    return scene(
        FLOOR, *balls(diffuse("0.7, 0.2, 0.2"), diffuse("0.7, 0.7, 0.7"), diffuse("0.2, 0.3, 0.7")),
        '<emitter type="point"><point name="position" value="-1, 3, 2"/>'
        '<rgb name="intensity" value="6, 8, 9"/></emitter>',
        spot.format(25, 1.5, 1.2),
        '<emitter type="directional"><vector name="direction" value="0.5, -1, -0.4"/>'
        '<rgb name="irradiance" value="1, 1, 0.8"/></emitter>')


def lens(folder: Path) -> str:
    view = sensor("thinlens", '<string name="fov_axis" value="y"/><float name="aperture_radius" value="0.25"/>'
                  '<float name="focus_distance" value="4.5"/>').replace('value="45"', 'value="38"')
    rows = [shape("sphere", diffuse(color), f'<scale value="0.5"/><translate x="{x}" y="0.5" z="{z}"/>')
            for color, x, z in (("0.8, 0.2, 0.2", -1, 2), ("0.2, 0.8, 0.2", 0, 0), ("0.2, 0.2, 0.8", 1.6, -3))]
    return scene(FLOOR, SKY, *rows, view=view)


def leaves(folder: Path) -> str:
    """What is cut out, what is half there, and a screen whose light is an image."""
    name = image(folder, "letter.png", letter())
    holes = np.where(letter() > 0.5, 1.0, 0.0)
    cut = image(folder, "cut.exr", np.repeat(holes[..., :1], 3, -1))
    masked = ('<bsdf type="mask">{}' + diffuse("0.3, 0.7, 0.2") + "</bsdf>")
    screen = (f'<emitter type="area"><texture type="bitmap" name="radiance"><string name="filename" value="{name}"/>'
              "</texture></emitter>")
    return scene(
        FLOOR, SKY, shape("rectangle", masked.format(
            f'<texture type="bitmap" name="opacity"><string name="filename" value="{cut}"/>'
            '<string name="filter_type" value="nearest"/></texture>'),
            '<scale value="0.8"/><translate x="-1.3" y="0.9"/>'),
        shape("sphere", masked.format('<float name="opacity" value="0.4"/>'),
              '<scale value="0.6"/><translate y="0.6"/>'),
        shape("rectangle", screen, '<scale value="0.6"/><rotate y="1" angle="-30"/><translate x="1.6" y="0.8"/>'))


def relief(folder: Path) -> str:
    """Normal maps on shapes whose coordinates are laid both ways; green is another way in Mitsuba on some of them. Bump
    maps, one of them turned and stretched."""
    u, v = np.meshgrid(np.arange(64) / 64, np.arange(64) / 64)
    slopes = np.stack([0.1 * np.sin(12 * np.pi * u) + 0.1, 0.15 * np.cos(4 * np.pi * v) + 0.15, np.ones_like(u)], -1)
    normals = slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)
    name = image(folder, "normals.exr", 0.5 + 0.5 * normals)
    mapped = (f'<bsdf type="twosided"><bsdf type="normalmap"><texture type="bitmap" name="normalmap">'
              f'<boolean name="raw" value="true"/><string name="filename" value="{name}"/></texture>'
              '<bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.6, 0.5"/></bsdf></bsdf></bsdf>')
    waves = image(folder, "waves.exr", np.repeat((np.sin(6 * np.pi * u) * np.cos(2 * np.pi * v))[..., None], 3, -1))
    bumps = ('<bsdf type="twosided"><bsdf type="bumpmap"><float name="scale" value="0.04"/><texture type="bitmap">'
             f'<boolean name="raw" value="true"/><string name="filename" value="{waves}"/>{{}}</texture>'
             '<bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.6, 0.7"/></bsdf></bsdf></bsdf>')
    turned = '<transform name="to_uv"><scale x="1.5" y="2"/><rotate z="1" angle="30"/></transform>'
    return scene(
        FLOOR, LAMP, shape("rectangle", mapped, '<scale value="0.8"/><rotate x="1" angle="-40"/>'
                           '<translate x="-1.5" y="0.8"/>'),
        shape("rectangle", bumps.format(""), '<scale value="0.5"/><rotate x="1" angle="-60"/>'
              '<translate x="-0.6" y="0.4" z="1.6"/>'),
        shape("rectangle", bumps.format(turned), '<scale x="0.8" y="0.4"/><rotate x="1" angle="-60"/>'
              '<translate x="0.9" y="0.3" z="1.6"/>'),
        shape("sphere", mapped, '<rotate x="1" angle="-90"/><scale value="0.6"/><translate y="0.6"/>'),
        shape("cylinder", mapped, '<scale x="0.5" y="0.5"/><rotate x="1" angle="-90"/><translate x="1.6"/>'),
        shape("disk", diffuse("0.5, 0.5, 0.5"), '<scale value="0.5"/><rotate x="1" angle="-90"/>'
              '<translate x="1.6" y="1"/>'))


SCENES = {made.__name__: made for made in
          (shapes, meshes, textures, plastics, metals, glass, sky, lamps, lens, leaves, relief)}
TESTED = ("textures", "meshes", "sky")  # by far the most conventions


# Pictures of both.


def convert(*words: object, code: int = 0) -> str:
    """Runs tools/from_mitsuba in this environment, and returns what it says."""
    process = subprocess.run([sys.executable, "-P", "-m", "mitsuba_scenes", *map(str, words)], stderr=subprocess.PIPE,
                             text=True, timeout=120, check=False)
    assert process.returncode == code, (process.returncode, process.stderr)
    return process.stderr


def read(file: Path, layer: str = "") -> np.ndarray:
    channels = OpenEXR.File(str(file), separate_channels=True).channels()
    return np.stack([channels[layer + letter].pixels for letter in "RGB"], -1).astype(float)


def regions(values: np.ndarray) -> np.ndarray:
    """Means over parts of the picture: rows, columns, channels."""
    height, width = values.shape[:2]
    columns, rows = REGIONS
    return values.reshape(rows, height // rows, columns, width // columns, 3).mean((1, 3))


def pictures(vkpm: str, name: str, folder: Path, times: int = 1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A scene by Mitsuba, by vkpm, and the standard error of the latter."""
    file = folder / f"{name}.xml"
    file.write_text(SCENES[name](folder))
    said = convert(file, "-o", folder / f"{name}.json")
    assert "lost" not in said, said
    output = folder / f"{name}.exr"
    words = [vkpm, "--scene", folder / f"{name}.json", "--passes", times * SAMPLES[1], "-o", output, "--quiet",
             "--no-resume"]
    subprocess.run([*map(str, words)], check=True)
    truth = np.array(mi.render(mi.load_file(str(file)), spp=times * SAMPLES[0]))[..., :3].astype(float)
    return truth, read(output), read(output, "noise.")


def differences(truth: np.ndarray, found: np.ndarray, noise: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of the means of regions, and four standard errors of these, both relative."""
    expected = regions(truth)
    scale = np.maximum(expected, 0.01 * truth.mean())  # not of what is black
    pixels = truth.shape[0] * truth.shape[1] / (REGIONS[0] * REGIONS[1])
    errors = 4 * np.sqrt(2 * regions(noise**2) / pixels)  # Mitsuba's are taken for as large
    return np.abs(regions(found) - expected) / scale, errors / scale


def save_pair(file: Path, truth: np.ndarray, found: np.ndarray) -> None:
    """Mitsuba's picture, vkpm's, and twenty times their difference around a grey, side by side."""
    both = np.hstack([truth, found, 0.2 + 20 * (found - truth) / 10]).clip(0, 1)
    mi.Bitmap(both.astype(np.float32)).convert(component_format=mi.Struct.Type.UInt8, srgb_gamma=True).write(str(file))


# Tests.


def test_pictures(vkpm: str, folder: Path) -> None:
    """Means of regions are those of Mitsuba, but for noise."""
    for name in TESTED:
        differ, errors = differences(*pictures(vkpm, name, folder))
        print(f"{name}: {differ.max():.2%} at most, four standard errors {errors.flat[differ.argmax()]:.2%}")
        assert (differ < MOST + errors).all(), name


def test_lost(folder: Path) -> None:
    """What has no equal is named once, with the place where it came first, on stderr and in the scene."""
    hair = '<bsdf type="hair"/>'
    file, output = folder / "lost.xml", folder / "lost.json"
    file.write_text(scene(FLOOR, SKY, *balls(hair, hair, '<bsdf type="roughconductor"/>')))
    said = convert(file, "-o", output)
    assert said.count("BSDFs of type hair") == 1 and "lost.xml (line 10, col" in said, said
    assert "Beckmann" in said, said
    written = json.loads(output.read_text())
    assert "BSDFs of type hair" in written["about"] and "Beckmann" in written["about"]
    metal = next(one for one in written["materials"].values() if one["type"] == "metal")
    assert metal["multiscatter"] is False and abs(metal["roughness"] - 0.1**0.5) < 1e-6, metal


def test_refused(folder: Path) -> None:
    """Wrong input ends with exit code 2, its place, and no output."""
    broken, output = folder / "broken.xml", folder / "out.json"
    for text, expected in (
        ('<scene version="3.0.0"><shape type="cube"></scene>', "broken.xml"),
        (scene('<shape type="obj"><string name="filename" value="none.obj"/></shape>'), "none.obj"),
        (scene(FLOOR, SKY, view=" "), "the scene has no sensor"),
        (scene(FLOOR, view='<sensor type="orthographic"/>'), "allowed: perspective or thinlens"),
        (scene(SKY), "no shape is left"),
    ):
        broken.write_text(text)
        said = convert(broken, "-o", output, code=2)
        assert expected in said, (expected, said)
        assert not output.exists() and not (folder / "out-files").exists()
    folder.joinpath("mine-files").mkdir()
    folder.joinpath("mine-files/letter.txt").touch()
    assert "holds other files" in convert(broken, "-o", folder / "mine.json", code=2)
    assert folder.joinpath("mine-files/letter.txt").exists()
    assert "no such file" in convert(folder / "none.xml", "-o", output, code=2)
    assert "ends in .json" in convert(broken, "-o", folder / "out.xml", code=2)


def print_table(vkpm: str, names: list[str]) -> None:
    """The table of tools/README.md."""
    folder = Path("mitsuba-pictures")
    folder.mkdir(exist_ok=True)
    print("| scene | mean | worst of 12 regions | four standard errors there |\n|---|---|---|---|")
    for name in names or SCENES:
        truth, found, noise = pictures(vkpm, name, folder, 4)
        differ, errors = differences(truth, found, noise)
        cells = f"{found.mean() / truth.mean() - 1:+.2%} | {differ.max():.2%} | {errors.flat[differ.argmax()]:.2%}"
        print(f"| {name} | {cells.replace('%', ' %')} |", flush=True)
        save_pair(folder / f"{name}-both.png", truth, found)


def main() -> None:
    if "--table" in sys.argv:
        print_table(sys.argv[1], sys.argv[3:])
        return
    with tempfile.TemporaryDirectory(prefix="vkpm-mitsuba-") as folder:
        test_refused(Path(folder))
        test_lost(Path(folder))
        test_pictures(sys.argv[1], Path(folder))
    print("passed")


main()
