"""Hostile cases of skies, suns, textures, normal maps and lenses.

Their tame siblings have the same features: time is what the extreme costs.
"""

import math

import numpy as np

from lab import (
    BOX,
    Lab,
    Scene,
    Verdict,
    against_path,
    case,
    changed,
    off,
    percent,
    plus,
    rectangle,
    same_means,
    sphere,
    without,
)

OPEN = without(BOX, "light", "ceiling", "left", "right")
WALLS = ("white", "red", "green")  # the box's materials that are diffuse


def under(environment: dict | None, *lights: dict, scene: Scene = OPEN) -> Scene:
    """The box without a lamp, under a sky and suns."""
    return changed(scene, lights=list(lights), **({"environment": environment} if environment else {}))


def refused(lab: Lab, scene: Scene, *words: str) -> Verdict:
    """Exit 2, and one line with these words."""
    render = lab.render(scene)
    found = next((line for line in render.messages.splitlines() if line.startswith("vkpm: ")), "nothing said")
    found = found.replace(str(lab.folder) + "/", "").replace(render.file.stem, "scene")
    right = render.code == 2 and all(word in found for word in words)
    render.problems = []
    return Verdict(render, None, found, right)


def sun_like_texel(row: int, column: int, height: int) -> dict:
    """A sun where a sky of twice as many columns has a texel, as wide as that, of an irradiance of 20."""
    angle, turn = math.pi * (row + 0.5) / height, math.pi * ((column + 0.5) / height - 1)
    towards = [math.sin(angle) * math.sin(turn), math.cos(angle), -math.sin(angle) * math.cos(turn)]
    return {"type": "sun", "direction": towards, "irradiance": 20, "angle": 180 / height}


# Skies and suns.


@case("sky", "a sky of one bright texel, 1024 x 512", "each layer as of a sun there, within 1 %")
def one_texel(lab: Lab) -> Verdict:
    row, column, height = 140, 430, 512
    texels = np.zeros((height, 2 * height, 3), np.float32)
    angle = math.pi / height
    texels[row, column] = 20 / (angle * (math.cos(row * angle) - math.cos((row + 1) * angle)))
    tame = lab.render(under(None, sun_like_texel(row, column, height)), "--passes", "16")
    render = lab.render(under({"image": lab.image("one_texel.exr", texels)}), "--passes", "16")
    return Verdict(render, tame, *same_means(render, tame, 0.01, ("direct", "caustic", "indirect")))


def sky_of(width: int, height: int) -> None:
    """A constant in few texels."""
    @case("sky", f"a constant sky of {width} x {height} texels", "each layer as of its radiance, within 0.5 %")
    def judge(lab: Lab) -> Verdict:
        image = lab.image(f"sky{width}x{height}.exr", np.full((height, width, 3), 0.7, np.float32))
        tame = lab.render(under({"radiance": 0.7}), "--passes", "16")
        render = lab.render(under({"image": image, "rotation": 77}), "--passes", "16")
        return Verdict(render, tame, *same_means(render, tame, 0.005))


for size in ((1, 1), (2, 1), (333, 7)):
    sky_of(*size)


def strength(factor: float) -> None:
    """A radiance near the ends of what floats hold."""
    @case("sky", f"a sky of radiance {factor:g}", "means of radiance 1 times that, within 0.01 %")
    def judge(lab: Lab) -> Verdict:
        tame, render = lab.render(under({"radiance": 1})), lab.render(under({"radiance": factor}))
        return Verdict(render, tame, *same_means(render, tame, 1e-4, factor=factor))


for times in (1e-12, 1e12):
    strength(times)


@case("sky", "a black ball that the camera does not see, and a sky", "the sky in every pixel, to the bit; nothing else")
def nothing(lab: Lab) -> Verdict:
    scene = changed(under({"radiance": [0.5, 1, 2]}), materials={"black": {"type": "diffuse", "albedo": 0}},
                    shapes=[sphere([0, 0, 99], 0.1, material="black")])
    render = lab.render(scene)
    right = bool((render.layer() == [0.5, 1, 2]).all() and (render.layer("emission") == render.layer()).all())
    return Verdict(render, lab.render(under({"radiance": 1})), "the sky" if right else "others", right)


@case("sky", "a sky of black texels, no other light", "refused: exit 2, that there is no light")
def black(lab: Lab) -> Verdict:
    image = lab.image("black.exr", np.zeros((2, 4, 3), np.float32))
    return refused(lab, under({"image": image}), "there is no light")


@case("sky", "a sky with one texel that is no number", "refused: exit 2, the place, count and texel")
def no_number(lab: Lab) -> Verdict:
    texels = np.ones((8, 16, 3), np.float32)
    texels[5, 9, 1] = np.nan
    return refused(lab, under({"image": lab.image("nan.exr", texels)}), "/environment/image", "1 texel", "row 5",
                   "column 9")


@case("sky", "a bright sky about a closed room with a lamp", "each layer as of the room alone, within 1 %")
def closed(lab: Lab) -> Verdict:
    front = rectangle([1, -1, 3.9], [-2, 0, 0], [0, 2, 0], material="white")
    sides = [rectangle([x, -1, 0.99], [0, 0, 2.92], [0, 2, 0], material="white") for x in (-1, 1)]
    ends = [rectangle([-1, y, 0.99], [2, 0, 0], [0, 0, 2.92], material="white") for y in (-1, 1)]
    room = plus(BOX, front, *sides, *ends)
    room["camera"] = BOX["camera"] | {"origin": [0, 0, 3.8]}
    tame = lab.render(room, "--passes", "64")
    render = lab.render(changed(room, environment={"radiance": 1}), "--passes", "64")
    return Verdict(render, tame, *same_means(render, tame, 0.01))


@case("sky", "a sun below the floor of the open box", "the mean of the path tracer within 2 %")
def below(lab: Lab) -> Verdict:
    def sun(height: float) -> Scene:
        return under(None, {"type": "sun", "direction": [0.3, height, 0.6], "irradiance": 5})
    return against_path(lab, sun(-1), 0.02, sun(1), "256")


# Textures.


def textured(lab: Lab, factor: float) -> Scene:
    """The box whose floor has 3 x 5 texels, so many times along each edge."""
    texels = np.array([[[30 * x + 20 * y + 9 * c for c in range(3)] for x in range(3)] for y in range(5)], np.uint8)
    albedo = {"texture": lab.image("odd.png", texels), "space": "linear", "transform": {"scale": [factor, factor]}}
    scene = plus(without(BOX, "glass ball", "mirror ball"), tiled={"type": "diffuse", "albedo": albedo})
    for shape in scene["shapes"]:
        if shape["name"] == "floor":
            shape["material"] = "tiled"
    return scene


@case("texture", "3 x 5 texels a million times along each edge", "direct light of seven times, within 1 %")
def far_coordinates(lab: Lab) -> Verdict:
    tame, render = (lab.render(textured(lab, factor), "--passes", "64") for factor in (7, 1e6))
    return Verdict(render, tame, *same_means(render, tame, 0.01, ("direct",)))


def sheets(count: int, opacity: float) -> Scene:
    """A black floor below a lamp, sheets between them."""
    black = {"type": "diffuse", "albedo": 0}
    scene = changed(BOX, materials={"white": {"type": "diffuse", "albedo": 0.8}, "sheet": black | {"opacity": opacity}},
                    camera={"origin": [0, 0.9, 1], "target": [0, 0, 0], "fieldOfView": 60})
    scene["shapes"] = [rectangle([-2, 0, 2], [4, 0, 0], [0, 0, -4], material="white"),
                       rectangle([-0.5, 3, -0.5], [1, 0, 0], [0, 0, 1], emission=9)]
    scene["shapes"] += [rectangle([-3, 1 + 0.01 * i, 3], [6, 0, 0], [0, 0, -6], material="sheet") for i in range(count)]
    return scene


def through(count: int, opacity: float) -> None:
    """Light through sheets."""
    left = (1 - opacity)**count
    @case("texture", f"{count} black sheets of opacity {opacity:g} below the lamp",
          f"{left:.3g} of the light, within 2 %")
    def judge(lab: Lab) -> Verdict:
        bare = lab.render(sheets(0, 0.5), "--passes", "16")
        tame = lab.render(sheets(10, 0.05), "--passes", "16")
        render = lab.render(sheets(count, opacity), "--passes", "16")
        part = render.mean("direct") / bare.mean("direct")
        return Verdict(render, tame, f"{part:.4g}", abs(part - left) <= 0.02 * left + 1e-6, work=max(1, count / 10))


through(100, 0.5)
through(100, 0.01)


@case("texture", "a ball of opacity 0 in the box", "the box's means within 0.5 %")
def unseen(lab: Lab) -> Verdict:
    ghost = {"type": "diffuse", "albedo": 0.5, "opacity": 0}
    tame = lab.render(plus(BOX, sphere([-0.1, 0.3, 0.2], 0.3, material="ghost"), ghost=ghost | {"opacity": 0.5}),
                      "--passes", "16")
    render = lab.render(plus(BOX, sphere([-0.1, 0.3, 0.2], 0.3, material="ghost"), ghost=ghost), "--passes", "16")
    return Verdict(render, tame, *same_means(render, lab.render(BOX, "--passes", "16"), 0.005))


@case("texture", "a texture on a mesh without coordinates", "a warning; the corners of its picture everywhere")
def no_coordinates(lab: Lab) -> Verdict:
    def floor(albedo: object) -> Scene:
        mesh = lab.mesh("floor.obj", [(-1, -1, 1), (1, -1, 1), (1, -1, -1), (-1, -1, -1)], [(0, 1, 2), (0, 2, 3)])
        return plus(without(BOX, "floor"), {"name": "added", "type": "mesh", "file": mesh, "material": "matter"},
                    matter={"type": "diffuse", "albedo": albedo})
    texels = np.full((4, 4, 3), 200, np.uint8)
    texels[::3, ::3] = 51
    image = {"texture": lab.image("corner.png", texels), "space": "linear"}
    render, tame = lab.render(floor(image), "--passes", "16"), lab.render(floor(0.2), "--passes", "16")
    text, holds = same_means(render, tame, 0.001)
    warned = any("coordinates" in warning for warning in render.stats["warnings"])
    return Verdict(render, tame, f"{text}, {'warned' if warned else 'silent'}", holds and warned)


# Normal maps.


def mapped(lab: Lab, color: tuple[int, int, int], strength: float) -> Scene:
    """The box whose diffuse surfaces have a normal map of two kinds of stripes, or of one colour."""
    texels = np.full((4, 4, 3), color, np.uint8)
    texels[:, 2:, 0] = 255 - texels[:, 2:, 0] + (color == (128, 128, 255))  # flat stays flat
    normals = {"texture": lab.image(f"normals{color[0]}.png", texels), "strength": strength}
    scene = changed(BOX)
    for name in WALLS:
        scene["materials"][name]["normalMap"] = normals
    return scene


@case("normal map", "a flat map, 128, 128, 255, on all walls", "the box's means within 0.5 %")
def flat(lab: Lab) -> Verdict:
    tame, render = (lab.render(scene, "--passes", "32") for scene in (BOX, mapped(lab, (128, 128, 255), 1)))
    return Verdict(render, tame, *same_means(render, tame, 0.005))


@case("normal map", "a map of strength 1000 on all walls", "mean of the path tracer within 2 %")
def steep(lab: Lab) -> Verdict:
    return against_path(lab, mapped(lab, (230, 90, 200), 1000), 0.02, mapped(lab, (230, 90, 200), 0.1), "256")


# Lenses.


def lens(aperture: float, focus: float) -> Scene:
    """The box through a lens."""
    return changed(BOX, camera=BOX["camera"] | {"aperture": aperture, "focusDistance": focus})


def by_lens(aperture: float, focus: float, *layers: str) -> None:
    """Far off what photographers have."""
    expected = " and ".join(layers) + " of the path tracer within 2 %"
    @case("lens", f"radius {aperture:g}, focus at {focus:g}", expected)
    def judge(lab: Lab) -> Verdict:
        return against_path(lab, lens(aperture, focus), 0.02, lens(0.05, 4), "256", layers)


by_lens(10, 4, "direct", "indirect")
by_lens(0.3, 0.3, "direct", "indirect")
by_lens(1e-6, 1e9, "beauty")


@case("lens", "a large lens focused on a lamp that fills the picture", "the lamp in every pixel, to the bit")
def on_plane(lab: Lab) -> Verdict:
    def wall(aperture: float) -> Scene:
        scene = changed(lens(aperture, 3), shapes=[rectangle([-2, -2, 0], [4, 0, 0], [0, 4, 0], emission=[3, 2, 1])])
        scene["camera"] |= {"origin": [0, 0, 3], "target": [0, 0, 0], "fieldOfView": 40}
        return scene
    render, tame = lab.render(wall(1.5)), lab.render(wall(0.01))
    right = bool((render.layer("emission") == [3, 2, 1]).all())
    shift = off(render.mean(), tame.mean())
    return Verdict(render, tame, f"{percent(shift)}, {'' if right else 'not '}in every pixel", right)
