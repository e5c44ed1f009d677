"""Hostile cases of lights and materials."""

from lab import (
    BALL,
    BOX,
    LIGHT,
    Lab,
    Scene,
    Verdict,
    against_path,
    brighter,
    case,
    changed,
    off,
    percent,
    plus,
    rectangle,
    same_bits,
    same_means,
    sphere,
    without,
)

LAMP = "light"


def by_power(exponent: int) -> None:
    """A flux that only changes exponents."""
    @case("light", f"flux × 2^{exponent}", "the same bits, times the factor")
    def judge(lab: Lab) -> Verdict:
        tame, render = lab.render(BOX), lab.render(brighter(BOX, 2.0**exponent))
        return Verdict(render, tame, *same_bits(render, tame, 2.0**exponent))


def by_factor(factor: float) -> None:
    """A flux that rounds."""
    @case("light", f"flux × {factor:g}", "means within 0.01 %")
    def judge(lab: Lab) -> Verdict:
        tame, render = lab.render(BOX), lab.render(brighter(BOX, factor))
        return Verdict(render, tame, *same_means(render, tame, 1e-4, factor=factor))


for power in (-40, 40):
    by_power(power)
for times in (1e-12, 1e12):
    by_factor(times)


@case("light", "a lamp of 10^-4 of the room, same flux", "direct and indirect light of a lamp of 10^-2, within 2 %")
def tiny_lamp(lab: Lab) -> Verdict:
    def lamp(side: float) -> Scene:
        emission = [x * (0.5 / side)**2 for x in (17, 12, 4)]
        return plus(without(BOX, LAMP),
                    rectangle([-side / 2, 0.99, -side / 2], [side, 0, 0], [0, 0, side], emission=emission))
    tame, render = lab.render(lamp(0.02), "--passes", "16"), lab.render(lamp(2e-4), "--passes", "16")
    return Verdict(render, tame, *same_means(render, tame, 0.02, ("direct", "indirect", "caustic")))


@case("light", "a lamp of the size and distance of the sun over the open room",
      "direct and indirect light of the path tracer, within 2 %")
def sun(lab: Lab) -> Verdict:
    room = without(BOX, LAMP, "ceiling", "mirror ball", "glass ball")
    lamp = sphere([200, 1000, 400], 5, emission=[17000, 12000, 4000])
    return against_path(lab, plus(room, lamp), 0.02, layers=("direct", "indirect"))


def far_sun(room: Scene, distance: float) -> Scene:
    """The room below a sun of the usual angle, at so many sizes of the room."""
    lamp = sphere([0.18 * distance, 0.9 * distance, 0.36 * distance], 0.0046 * distance, emission=[17000, 12000, 4000])
    return plus(without(room, LAMP, "ceiling"), lamp)


def by_far_sun(distance: float) -> None:
    """A sun as far as is allowed, whose photons a float at its place could not aim."""
    @case("light", f"a sun at {distance:g} of the open room",
          "each layer as of a sun of the same angle at 1000, within 0.5 %")
    def judge(lab: Lab) -> Verdict:
        tame, render = (lab.render(far_sun(BOX, far), "--passes", "16") for far in (1000, distance))
        return Verdict(render, tame, *same_means(render, tame, 0.005))


for far_away in (1e6, 9e11):
    by_far_sun(far_away)


@case("light", "a far rectangle in place of the sun, and a second far lamp that hides half of it",
      "direct and indirect light of the path tracer, within 2 %")
def far_eclipse(lab: Lab) -> Verdict:
    def at(far: float, side: float, x: float, **rest: object) -> dict:
        return rectangle([x * side, far, -side / 2], [side, 0, 0], [0, 0, side], **rest)
    sun, moon = at(1e9, 2e7, -0.5, emission=[17000, 12000, 4000]), at(5e8, 1e7, 0, emission=[1, 1, 1])
    room = without(BOX, LAMP, "ceiling", "mirror ball", "glass ball")
    return against_path(lab, plus(room, sun, moon), 0.02, layers=("direct", "indirect"))


@case("light", "the whole ceiling shines", "each layer's mean of the path tracer within 2 %")
def whole_ceiling(lab: Lab) -> Verdict:
    ceiling = rectangle([-1, 1, -1], [2, 0, 0], [0, 0, 2], emission=[1, 1, 1], material="white")
    return against_path(lab, plus(without(BOX, LAMP, "ceiling"), ceiling), 0.02, layers=LIGHT)


@case("light", "a lamp inside the glass ball", "mean of the path tracer within 2 %")
def lamp_in_glass(lab: Lab) -> Verdict:
    return against_path(lab, plus(without(BOX, LAMP), sphere(BALL, 0.15, emission=[17, 12, 4])), 0.02,
                        passes="512")


@case("light", "two lamps, flux 10^9 : 1", "the brighter one's picture: means within 0.1 %")
def two_lamps(lab: Lab) -> Verdict:
    weak = rectangle([-0.9, 0.98, -0.9], [0.01, 0, 0], [0, 0, 0.01], emission=[17e-9 * 2500, 12e-9 * 2500, 4e-9 * 2500])
    tame, render = lab.render(BOX), lab.render(plus(BOX, weak))
    return Verdict(render, tame, *same_means(render, tame, 1e-3))


@case("light", "two lamps, the weak one first", "the brighter one's picture: means within 0.5 %")
def weak_lamp_first(lab: Lab) -> Verdict:
    weak = rectangle([-0.9, 0.98, -0.9], [0.01, 0, 0], [0, 0, 0.01], emission=[17e-9 * 2500, 12e-9 * 2500, 4e-9 * 2500])
    render = lab.render(changed(BOX, shapes=[weak, *BOX["shapes"]]))
    tame = lab.render(BOX)
    return Verdict(render, tame, *same_means(render, tame, 5e-3))


@case("light", "1,000 lamps in place of one", "means within 1 %")
def many_lamps(lab: Lab) -> Verdict:
    side = 0.5 / 32
    lamps = [rectangle([-0.25 + side * (i % 32), 0.99, -0.25 + side * (i // 32)], [side, 0, 0], [0, 0, side],
                       emission=[17, 12, 4])
             for i in range(1024)]
    tame, render = lab.render(BOX, "--passes", "16"), lab.render(plus(without(BOX, LAMP), *lamps), "--passes", "16")
    return Verdict(render, tame, *same_means(render, tame, 0.01))


@case("light", "a lamp that shines away from everything", "every photon escapes; black but for the lamp")
def lamp_outward(lab: Lab) -> Verdict:
    away = rectangle([-0.25, 1.5, -0.25], [0, 0, 0.5], [0.5, 0, 0], emission=[17, 12, 4])
    render = lab.render(plus(without(BOX, LAMP), away))
    escaped = all(ledger["escaped"] == ledger["emitted"] for ledger in render.stats["photons"].values())
    dark = sum(render.mean(name) for name in LIGHT)
    return Verdict(render, lab.render(BOX), f"light {dark:g}, {'all' if escaped else 'not all'} escape",
                   escaped and dark == 0)


# Matter.


def diffuse(albedo: float) -> dict:
    """A grey material."""
    return {"type": "diffuse", "albedo": albedo}


@case("matter", "all albedos 0", "nothing is reflected; the lamp is seen")
def black(lab: Lab) -> Verdict:
    names = ("white", "red", "green")
    scene = changed(without(BOX, "mirror ball", "glass ball"),
                    materials=BOX["materials"] | {name: diffuse(0) for name in names})
    render = lab.render(scene)
    rest = sum(render.mean(name) for name in ("direct", "indirect", "caustic", "specular"))
    return Verdict(render, lab.render(BOX), f"reflected {rest:g}, emission {render.mean('emission'):.3g}",
                   rest == 0 and render.mean("emission") > 0)


def furnace(albedo: float, tolerance: float) -> None:
    """A closed sphere whose wall shines and reflects: L = E / (1 - a) everywhere."""
    @case("matter", f"closed furnace of albedo {albedo:g}",
          f"E / (1 - a) = {1 / (1 - albedo):.6g} within {tolerance:.1%}")
    def judge(lab: Lab) -> Verdict:
        def wall(a: float) -> Scene:
            corners = [([-1, -1, 1], [2, 0, 0], [0, 0, -2]), ([-1, 1, -1], [2, 0, 0], [0, 0, 2]),
                       ([-1, -1, -1], [2, 0, 0], [0, 2, 0]), ([-1, -1, 1], [0, 0, -2], [0, 2, 0]),
                       ([1, -1, -1], [0, 0, 2], [0, 2, 0]), ([1, -1, 1], [-2, 0, 0], [0, 2, 0])]
            return {"camera": {"origin": [0, 0, 0.5], "target": [0, 0, -1], "fieldOfView": 90},
                    "film": {"size": [32, 32]},
                    "materials": {"wall": diffuse(a)},
                    "shapes": [rectangle(*corner, emission=[1, 1, 1], material="wall") for corner in corners]}
        tame = lab.render(wall(0.5), "--photons", "2000", "--passes", "8")
        render = lab.render(wall(albedo), "--photons", "2000", "--passes", "8")
        ratio = off(render.mean(), 1 / (1 - albedo))
        return Verdict(render, tame, percent(ratio), abs(ratio) <= tolerance, work=0.5 / (1 - albedo))


furnace(0.9, 0.01)
furnace(0.999, 0.02)


@case("matter", "closed room of albedo 1", "paths of hundreds of bounces; mean of the path tracer within 3 %")
def white_room(lab: Lab) -> Verdict:
    front = rectangle([1, -1, 1], [-2, 0, 0], [0, 2, 0], material="white")
    scene = plus(changed(BOX, camera=BOX["camera"] | {"origin": [0, 0, 0.99]}), front)
    bright = changed(scene, materials=scene["materials"] | {name: diffuse(1) for name in ("white", "red", "green")})
    options = ("--photons", "1000", "--caustic-photons", "1000", "--passes", "16", "--size", "24x24")
    render, tame = lab.render(bright, *options), lab.render(scene, *options)
    truth = lab.truth(bright, "--integrator", "path", "--passes", "128", "--size", "24x24")
    difference = off(render.mean(), truth.mean())
    return Verdict(render, tame, percent(difference), abs(difference) < 0.03, work=16)


@case("matter", "closed room of albedo 1, lamp and all", "ends after 10,000 bounces, and says how many photons it left")
def nothing_absorbs(lab: Lab) -> Verdict:
    front = rectangle([1, -1, 1], [-2, 0, 0], [0, 2, 0], material="white")
    lamp = BOX["shapes"][-1] | {"material": "white"}
    scene = plus(without(BOX, LAMP, "mirror ball", "glass ball"), front, lamp)
    scene = changed(scene, camera=BOX["camera"] | {"origin": [0, 0, 0.99]},
                    materials=BOX["materials"] | {name: diffuse(1) for name in ("white", "red", "green")})
    render = lab.render(scene, "--photons", "200", "--passes", "1", "--size", "8x8")
    lost = render.photons("global")["lost"]
    told = "200 photons were still under way after 10000 bounces" in render.messages
    render.problems = [problem for problem in render.problems if "were lost" not in problem]
    return Verdict(render, None, f"{lost} of 200 photons left, {'and says so' if told else 'in silence'}",
                   lost == 200 and told)


def by_index(ior: float, other: float, tolerance: float, expected: str) -> None:
    """A ball of an index that is hardly one."""
    @case("matter", f"index of refraction {ior!r}", expected)
    def judge(lab: Lab) -> Verdict:
        def ball(index: float) -> Scene:
            return changed(BOX, materials=BOX["materials"] | {"glass": {"type": "glass", "ior": index}})
        tame = lab.render(ball(other), "--passes", "16")
        render = lab.render(ball(ior), "--passes", "16")
        return Verdict(render, tame, *same_means(render, tame, tolerance))


def clear(lab: Lab) -> Verdict:
    """A ball of index 1 against no ball."""
    scene = changed(BOX, materials=BOX["materials"] | {"glass": {"type": "glass", "ior": 1}})
    render, tame = lab.render(scene, "--passes", "16"), lab.render(without(BOX, "glass ball"), "--passes", "16")
    return Verdict(render, lab.render(BOX, "--passes", "16"), *same_means(render, tame, 0.01, ("beauty",)))


case("matter", "index of refraction 1 exactly", "the mean of no ball at all within 1 %")(clear)
for index in (1 - 1e-6, 1 + 1e-6, 1.001):
    by_index(index, 1, 0.01, "layers as of index 1, within 1 %")


@case("matter", "index of refraction 3", "mean of the path tracer within 2 %")
def dense(lab: Lab) -> Verdict:
    return against_path(lab, changed(BOX, materials=BOX["materials"] | {"glass": {"type": "glass", "ior": 3}}), 0.02)


@case("matter", "a light guide of 40 total reflections", "mean of the path tracer within 2 %")
def guide(lab: Lab) -> Verdict:
    # A thin bar of glass from the lamp to near the floor.
    side, low, high = 0.05, -0.9, 0.985
    a, b = [-side / 2, low, -side / 2], [side / 2, high, side / 2]
    ex, ey, ez = [side, 0, 0], [0, high - low, 0], [0, 0, side]
    walls = [(a, ex, ez), ([a[0], high, b[2]], ex, [0, 0, -side]), (a, ey, ex), ([a[0], low, b[2]], ex, ey),
             ([a[0], low, a[2]], ez, ey), ([b[0], low, a[2]], ey, ez)]
    bar = [rectangle(*wall, material="glass") for wall in walls]
    scene = plus(without(BOX, "glass ball", "mirror ball"), *bar)
    return against_path(lab, scene, 0.02, passes="512")


def plate_on_floor(gap: float, first: bool) -> Scene:
    """A glass plate over most of the box's floor, before or after all other shapes."""
    low, high, side = -1 + gap, -0.8, 0.9
    a, ex, ez, ey = [-side, low, -side], [2 * side, 0, 0], [0, 0, 2 * side], [0, high - low, 0]
    faces = [(a, ex, ez), ([-side, high, side], ex, [0, 0, -2 * side]), (a, ey, ex), ([-side, low, side], ex, ey),
             (a, ez, ey), ([side, low, -side], ey, ez)]
    plate = [rectangle(*face, material="glass") for face in faces]
    rest = without(BOX, "glass ball", "mirror ball")
    return changed(rest, shapes=[*plate, *rest["shapes"]] if first else [*rest["shapes"], *plate])


def by_contact(first: bool, gap: float) -> None:
    """One face in common, or nearly, in either order."""
    where = f"{gap:g} above the floor" if gap else "on the floor"
    @case("matter", f"a glass plate {where}, {'first' if first else 'last'} of the shapes",
          "each layer as of one sunk by 10^-3, within 0.5 %")
    def judge(lab: Lab) -> Verdict:
        tame = lab.render(plate_on_floor(-1e-3, False), "--passes", "16")
        render = lab.render(plate_on_floor(gap, first), "--passes", "16")
        return Verdict(render, tame, *same_means(render, tame, 0.005))


for is_first, above in ((True, 0), (False, 0), (False, 1e-7)):
    by_contact(is_first, above)


@case("matter", "mirrors of reflectance 1 face each other", "mean of the path tracer within 2 %, no hang")
def mirrors(lab: Lab) -> Verdict:
    perfect = {"type": "mirror", "reflectance": 1}
    scene = without(BOX, "left", "right", "mirror ball")
    scene = plus(scene, rectangle([-1, -1, 1], [0, 0, -2], [0, 2, 0], material="perfect"),
                 rectangle([1, -1, -1], [0, 0, 2], [0, 2, 0], material="perfect"), perfect=perfect)
    return against_path(lab, scene, 0.02, passes="512")


@case("matter", "glass tint of 10^-6", "mean of the path tracer within 2 %")
def tinted(lab: Lab) -> Verdict:
    black = {"glass": {"type": "glass", "ior": 1.5, "tint": 1e-6}}
    return against_path(lab, changed(BOX, materials=BOX["materials"] | black), 0.02)


