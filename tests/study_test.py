"""tools/study on tiny pictures: curves, references that go on, an interrupted matrix and its page, what is refused."""

import argparse
import json
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from unittest.mock import patch

import numpy as np

from studies.cells import matrix
from studies.curves import Curve, Row, layer_curve, mean_curve, read_rows, without_reference, write_rows
from studies.page import time_cell
from studies.reference import Part, Reference, refine
from studies.specks import path_of, read_pass
from studies.truth import error_of
from studies.vkpm import LIGHT, Vkpm, read_image

ROOT = Path(__file__).resolve().parent.parent
STUDY = [sys.executable, "-P", "-m", "studies"]
SCENE = ROOT / "scenes/box.json"

# Stands in for a vkpm with --report, and for an environment that fails at the first render of each size.
STAND_IN = """#!{python}
import pathlib, subprocess, sys
words = sys.argv[1:]
if "--help" in words:
    print("  --report FOLDER")
    sys.exit()
if "--scene" not in words:
    sys.exit(subprocess.run(["{vkpm}", *words]).returncode)
failed = pathlib.Path("{folder}", "failed-" + words[words.index("--size") + 1])
if not failed.exists():
    failed.touch()
    sys.exit(1)
if "--report" in words:
    at = words.index("--reference")
    reported = pathlib.Path(words[at + 3])
    assert words[at + 2] == "--report" and pathlib.Path(words[at + 1]).exists()
    del words[at:at + 4]
    lines = ["pass,seconds,rays,photons,layer,rmse,relmse,mean_error,flip,noise,bias,error"]
    for n in (1, 2, 4, 8):
        lines += [f"{{n}},{{n / 100}},{{n}},{{n}},{{layer}},0.1,{{0.8 / n}},0,,,," for layer in ("beauty", "direct")]
    (reported / "error.csv").write_text("\\n".join(lines))
sys.exit(subprocess.run(["{vkpm}", *words]).returncode)
"""


def close(value: float, expected: float) -> bool:
    """Whether two numbers are the same but for rounding."""
    return abs(value - expected) <= 1e-9 * abs(expected)


def eventually(what: str, look: Callable[[], object]) -> None:
    """Waits until a look finds something."""
    deadline = time.monotonic() + 60
    while not look():
        assert time.monotonic() < deadline, f"waited in vain for {what}"
        time.sleep(0.01)


def study(*words: object, code: int = 0) -> str:
    """Runs the study to its end, and returns what it says."""
    process = subprocess.run([*STUDY, *map(str, words)], stderr=subprocess.PIPE, text=True, timeout=120, check=False)
    assert process.returncode == code, (process.returncode, process.stderr)
    return process.stderr


def interrupted(what: str, look: Callable[[], object], *words: object) -> None:
    """Runs the study until a look finds something, and expects it to end as interrupted."""
    process = subprocess.Popen([*STUDY, *map(str, words)], stderr=subprocess.PIPE, text=True)
    try:
        eventually(what, look)
        process.send_signal(signal.SIGINT)
        messages = process.communicate(timeout=60)[1]
    finally:
        process.kill()
        process.wait()
    assert process.returncode == 130, (process.returncode, messages)
    assert "interrupted" in messages, messages


# Curves.


def test_slopes_and_times() -> None:
    """Powers of time have their exponents as slopes, and reach errors when they do in closed form."""
    seconds = np.geomspace(0.1, 100, 11)
    power = Curve(seconds, 0.05 * seconds**-0.7)
    assert close(power.slope(), -0.7)
    assert close(power.time_to(1e-2), 5 ** (1 / 0.7))
    assert np.isnan(power.time_to(1e-3))
    assert time_cell(power, 1e-3).startswith("&gt; 100 s") and "reached 2.0e-03" in time_cell(power, 1e-3)
    assert time_cell(Curve(seconds, 1e-3 / seconds), 1e-2) == "≤ 0.1 s"

    # A dip before the bright paths come does not count.
    dip = Curve(seconds, np.where(np.arange(11) == 1, 1e-3, power.errors))
    assert close(dip.time_to(1e-2), power.time_to(1e-2)) and np.isnan(dip.time_to(1e-3))

    # The first points, where a line has not begun yet, do not count; a single point has no slope.
    bent = Curve(seconds, np.where(seconds < seconds[2] * 0.99, 1.0, power.errors))
    assert close(bent.slope(), -0.7)
    assert np.isnan(Curve(seconds[:1], seconds[:1]).slope())


def test_means_and_references() -> None:
    """Means over seeds are of errors at equal times; a reference's own error is taken off."""
    short, long = np.geomspace(1, 16, 5), np.geomspace(1, 64, 7)
    mean = mean_curve([Curve(short, 1 / short), Curve(long, 3 / long)])
    assert np.allclose(mean.seconds, short) and np.allclose(mean.errors, 2 / short)
    cleaned = without_reference(Curve(long, 1 / long + 0.05), 0.05)
    assert np.allclose(cleaned.errors, 1 / cleaned.seconds) and cleaned.seconds[-1] == 16


def test_files(folder: Path) -> None:
    """What error.csv says is read back, unknown numbers and all."""
    rows = [Row(1, 0.5, 10.0, 20.0, "beauty", 0.1, 0.2, -0.3, flip=0.4),
            Row(1, 0.5, 10.0, 20.0, "direct", 0.1, 0.0, 0.0)]
    write_rows(folder / "error.csv", rows)
    back = read_rows(folder / "error.csv")
    assert repr(back) == repr(rows), back
    assert list(layer_curve(back, "beauty").errors) == [0.2] and not len(layer_curve(back, "direct").errors)


# References.


def test_reference(folder: Path) -> None:
    """An interrupted reference goes on, to an error that its own noise bears out, and writes a small file."""
    words = ["reference", "--scene", SCENE, "--size", "32x32", "-o", folder, "--vkpm", sys.argv[1], "--quiet"]
    facts_file = folder / "box-32x32.json"
    interrupted("a first step", facts_file.exists, *words, "--error", 1e-6)
    before = json.loads(facts_file.read_text())
    assert not before["reached"] and before["parts"][0]["passes"] >= 64

    stated = 0.8 * before["error"]
    messages = study(*words, "--error", stated, "--small")
    after = json.loads(facts_file.read_text())
    assert after["reached"] and after["error"] <= stated == after["stated_error"], (after, messages)
    assert before["parts"][0]["passes"] < after["parts"][0]["passes"]
    assert before["parts"][0]["seconds"] < after["parts"][0]["seconds"]

    image = read_image(folder / "box-32x32.exr").layers
    own = np.sqrt(np.mean(image["noise"] ** 2 / (image["beauty"] ** 2 + 0.01)))
    assert np.isclose(own, after["error"], rtol=1e-5), (own, after)
    assert np.allclose(image["beauty"], sum(image[layer] for layer in LIGHT), rtol=1e-5)

    small = folder / "box-32x32.small.exr"
    assert set(read_image(small).layers) == {"beauty", *LIGHT} and small.stat().st_size < 40_000
    assert np.allclose(read_image(small).layers["indirect"], image["indirect"], rtol=1e-3, atol=1e-6)

    # Nothing is left to do; and a target that time does not allow is told.
    part = folder / "box-32x32.state/0-path.exr"
    written = part.stat().st_mtime_ns
    study(*words, "--error", stated)
    assert part.stat().st_mtime_ns == written
    assert "the time is over" in study(*words, "--error", 1e-6, "--time", 0.2)
    assert part.stat().st_mtime_ns > written

    # It says what it was made of, and is not gone on with otherwise.
    assert [part["integrator"] for part in after["parts"]] == ["path", "light"]
    facts_file.write_text(json.dumps(after | {"parts": after["parts"][:1]}))
    assert "of other parts" in study(*words, "--error", stated, code=2)
    facts_file.write_text(json.dumps(after))

    # A changed scene is not what the reference shows.
    changed = folder / "box.json"
    changed.write_text(SCENE.read_text().replace("0.725", "0.5"))
    other = [changed if word == SCENE else word for word in words]
    assert "another state" in study(*other, "--error", stated, code=2)
    assert "with options" in study(*words, "--error", stated, "--fresnel", "schlick", code=2)


def test_parts(folder: Path) -> None:
    """Layers may come from several integrators: noise adds up, and the noisiest part is rendered on."""
    folder.mkdir()
    parts = (Part(("emission", "direct", "specular", "indirect"), "path"), Part(("caustic",), "path"))
    args = argparse.Namespace(output=folder, size="32x32", error=0.15, time=None, small=False, quiet=True)
    with patch("studies.reference.PARTS", parts):
        reference = Reference(Vkpm(sys.argv[1]), SCENE, args, [])
        refine(reference)
    image, own = read_image(reference.file).layers, [part.image.layers for part in reference.parts]
    assert np.allclose(image["caustic"], own[1]["beauty"]) and "caustic" not in own[0]
    assert np.allclose(image["beauty"], own[0]["beauty"] + own[1]["beauty"], rtol=1e-4, atol=1e-6)
    assert np.allclose(image["noise"], np.hypot(own[0]["noise"], own[1]["noise"]), rtol=1e-4)
    facts = json.loads((folder / "box-32x32.json").read_text())
    assert facts["reached"] and facts["error"] <= 0.15
    assert [part["layers"] for part in facts["parts"]] == [list(part.layers) for part in parts]
    assert len({part["seed"] for part in facts["parts"]}) == 2
    for noisy, factor in ((0, 1e4), (1, 1e8)):
        own[noisy]["noise"] *= factor
        assert reference.worst() is reference.parts[noisy]


# The stated error and the true one.


def test_errors_of_known_noise() -> None:
    """The error of normal errors is their deviation where all count, and less where the worst do not, by as much as
    normal errors have there; what the truth is off itself is taken off."""
    random = np.random.default_rng(1)
    deviation = np.geomspace(0.01, 0.1, 60000).reshape(100, 200, 3)
    own = np.full_like(deviation, 0.03)
    found = (random.normal(0, deviation) - random.normal(0, own)) ** 2
    expected = deviation**2 + own**2
    assert np.isclose(error_of(found, expected, own**2, 1), np.sqrt(np.mean(deviation**2)), rtol=0.02)
    alone = error_of(random.normal(0, deviation) ** 2, deviation**2, 0 * own, 0.98)
    assert np.isclose(error_of(found, expected, own**2, 0.98), alone, rtol=0.05), alone
    assert alone < 0.95 * np.sqrt(np.mean(deviation**2))
    # A speck is no error of what is kept.
    found[50, 100] = 1e6
    assert np.isclose(error_of(found, expected, own**2, 0.98), alone, rtol=0.05)


def test_truth(output: Path) -> None:
    """Tables have all scenes and passes; nothing is rendered twice, and a changed scene anew."""
    scene = output / "box.json"
    output.mkdir()
    scene.write_text(SCENE.read_text())
    words = ["truth", "--scenes", scene, "--size", "24x24", "--passes", "8,16", "--seeds", 2, "--reference-passes", 32,
             "--photons", 2000, "--caustic-photons", 2000, "-o", output, "--vkpm", sys.argv[1], "--quiet"]
    process = subprocess.run([*STUDY, *map(str, words)], capture_output=True, text=True, timeout=120, check=False)
    assert process.returncode in (0, 1), process.stderr  # few pixels and seeds prove nothing
    text = (output / "truth.md").read_text()
    assert text.strip() == process.stdout.strip()
    for passes in (8, 16):
        assert sum(line.startswith(f"| box | {passes} |") for line in text.splitlines()) >= 4, text
        assert (output / f"box-{passes}.png").stat().st_size > 1000
    picture = output / "box-24x24/2-16.exr"
    layers = read_image(picture).layers
    subprocess.run([*STUDY, *map(str, words)], capture_output=True, timeout=120, check=False)
    assert (output / "truth.md").read_text() == text
    scene.write_text(SCENE.read_text().replace("0.725", "0.5"))
    process = subprocess.run([*STUDY, *map(str, words)], capture_output=True, text=True, timeout=120, check=False)
    assert "another state" in process.stderr, process.stderr
    assert not np.allclose(read_image(picture).layers["beauty"], layers["beauty"])


def test_labels(output: Path) -> None:
    """Lamps, what is seen in mirrors and glass, and what is not, have the paths that their layers have."""
    assert path_of((0b1010001 << 2) | 1) == "LDsSsE"
    assert path_of((1 << 20 << 2) | 2) == "L...D..." + 10 * "S" + "E"
    output.mkdir()
    words = [sys.argv[1], "--scene", SCENE, "--size", "64x64", "--passes", 1, "--photons", 2000, "--labels",
             "--pixel-samples", 1, "-o", output / "labels.exr", "--quiet"]
    subprocess.run([*map(str, words)], timeout=120, check=True)
    found = read_pass(str(output / "labels.exr"))
    light = {layer: np.sum(value, -1) for layer, value in found.layers.items()}
    names = np.vectorize(path_of)(found.codes)
    assert set(names[light["emission"] > 0]) == {"LE"}
    mirrored = set(names[light["specular"] > 0])
    assert {"LDSE", "LDssE"} <= mirrored and all(re.fullmatch(r"L[D.]*[Ss]+E", name) for name in mirrored), mirrored
    plain = set(names[(light["emission"] == 0) & (light["specular"] == 0) & (sum(light.values()) > 0)])
    assert "LDE" in plain and plain <= {"LDE", "L...DE", "L...DDE"}, plain
    words[words.index("--passes") + 1] = 2
    refused = subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=60, check=False)
    assert refused.returncode == 2 and "--labels: found with 2 passes" in refused.stderr, refused.stderr


def test_specks(output: Path) -> None:
    """The tables name paths, and leave no pass behind."""
    words = ["specks", "--scenes", SCENE, "--size", "24x24", "--passes", 4, "--seeds", 1, "--reference-passes", 16,
             "--part", 0.02, "--photons", 2000, "--caustic-photons", 2000, "-o", output, "--vkpm", sys.argv[1],
             "--quiet"]
    process = subprocess.run([*STUDY, *map(str, words)], capture_output=True, text=True, timeout=120, check=False)
    assert process.returncode == 0, process.stderr
    text = process.stdout
    rows = [line for line in text.splitlines() if re.fullmatch(r"\| 1 \| \d+, \d+ \| [0-3] \| \w+ \| [-+.\de]+ \| "
                                                               r"(L[DGSs.]*E|none) \|", line)]
    assert len(rows) == 10, text
    assert not list(output.glob("*/labels-*"))


# Matrices.


def finished(output: Path) -> dict[str, int]:
    """Finished cells, and when they were."""
    return {file.parent.name: file.stat().st_mtime_ns for file in output.glob("cells/*/cell.json")}


def test_axes_alone() -> None:
    """Each option takes its values by itself; options about photons do not repeat integrators without any."""
    axes = [("photons", ["1000", "2000"]), ("fresnel", ["schlick"])]
    args = argparse.Namespace(scenes=[SCENE], integrators=["photon", "path"], axis=axes, alone=True)
    assert [variant.label() for variant in matrix(args)] == [
        "photon photons=1000", "photon photons=2000", "photon fresnel=schlick", "path", "path fresnel=schlick"]
    args.alone = False
    assert [variant.label() for variant in matrix(args)] == [
        "photon photons=1000 fresnel=schlick", "photon photons=2000 fresnel=schlick", "path fresnel=schlick"]


def test_matrix(references: Path, output: Path) -> None:
    """An interrupted matrix goes on without what is finished, and its page has all parts."""
    words = ["run", "--scenes", SCENE, "--size", "32x32", "--axis", "photons=1000,4000", "--caustic-photons", 1000,
             "--time", 1, "--references", references, "-o", output, "--vkpm", sys.argv[1], "--quiet"]
    interrupted("a finished cell", lambda: finished(output), *words)
    before = finished(output)
    assert 1 <= len(before) < 3 and not (output / "index.html").exists()

    study(*words)
    after = finished(output)
    assert len(after) == 3 and before.items() <= after.items(), (before, after)
    check_page((output / "index.html").read_text())
    check_cells(output)

    # Again, nothing is rendered; with another time, everything.
    study(*words)
    assert finished(output) == after
    study(*words, "--alone")  # of one axis, the same cells
    assert finished(output) == after
    assert (output / "axes.png").stat().st_size > 1000
    assert "Each option by itself" in (output / "index.html").read_text()
    study(*words, "--time", 0.2)
    changed = finished(output)
    assert changed.keys() == after.keys() and not changed.items() & after.items()


def check_cells(output: Path) -> None:
    """Expects that each cell says what it was, and that its errors fall over several points."""
    for file in output.glob("cells/*/cell.json"):
        facts = json.loads(file.read_text())
        assert facts["commit"] and facts["device"] and shlex.split(facts["commands"][0])[0] == sys.argv[1]
        errors = layer_curve(read_rows(file.parent / "error.csv"), "beauty").errors
        assert len(errors) >= 2 and errors[-1] < errors[0], errors
        assert read_image(file.parent / "final.exr").size() == "32x32"


def check_page(page: str) -> None:
    """Expects plots, tables, pictures, circumstances and command lines, and nothing from elsewhere."""
    assert page.count("<svg") == 2 and page.count("</svg>") == 2
    assert page.count('src="data:image/png;base64,') == 1 + 2 * 3  # reference; renders with FLIP maps
    assert not re.search(r'(src|href)="(?!data:|#)|url\((?!#)', page)
    for word in ("photon photons=1000", "photon photons=4000", "path", "to 1e-2", "to 1e-3", "to 1e-4", "slope",
                 "caustic", "indirect", "cores", "commit", "vkpm 0.", "is subtracted", "--caustic-photons 1000"):
        assert word in page, word
    assert page.count("box path seed=0") == 1  # options about photons do not multiply it


def test_report(references: Path, output: Path) -> None:
    """Of a vkpm that compares by itself, its curves are taken; a failing environment is tried once more."""
    output.mkdir()
    stand_in = output / "vkpm"
    stand_in.write_text(STAND_IN.format(python=sys.executable, vkpm=sys.argv[1], folder=output))
    stand_in.chmod(0o755)
    messages = study("run", "--scenes", SCENE, "--size", "32x32", "--integrators", "path", "--time", 0.2,
                     "--references", references, "-o", output, "--vkpm", stand_in, "--quiet")
    assert messages.count("tried once more") == 2, messages  # sizes: of the check, and of the render
    page = (output / "index.html").read_text()
    assert "relMSE 0.1 after 0.08 s" in messages, messages
    assert "<td>-1 &nbsp; 1.0e-01</td>" in page, page[page.index("<h3>Layers"):]


def test_refused(references: Path, output: Path) -> None:
    """What is wrong is told with the command line, exits with 2, and leaves no cell."""
    words = ["run", "--scenes", SCENE, "--size", "32x32", "--references", references, "-o", output,
             "--vkpm", sys.argv[1], "--quiet"]
    messages = study(*words, "--axis", "kernel=constant,round", code=2)
    assert "--kernel round" in messages and "allowed" in messages, messages
    assert not finished(output)
    assert "tools/study reference --scene" in study(*words, "--size", "16x16", code=2)
    assert "which the study sets itself" in study(*words, "--axis", "seed=1,2", code=2)


def main() -> None:
    """Runs the tests for the vkpm that is named by the first argument."""
    test_slopes_and_times()
    test_means_and_references()
    with tempfile.TemporaryDirectory(prefix="vkpm-study-test-") as name:
        folder = Path(name)
        test_files(folder)
        test_reference(folder / "references")
        test_parts(folder / "parts")
        test_errors_of_known_noise()
        test_truth(folder / "truth")
        test_labels(folder / "labels")
        test_specks(folder / "specks")
        test_axes_alone()
        test_matrix(folder / "references", folder / "matrix")
        test_report(folder / "references", folder / "report")
        test_refused(folder / "references", folder / "refused")


if __name__ == "__main__":
    main()
