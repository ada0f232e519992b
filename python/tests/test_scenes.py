"""Scenes: the builder, changed values, errors; invalid input raises exceptions of named classes."""

from __future__ import annotations

import pickle
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import EXAMPLES, PENDULUM, ROOT, SLEIGH

import pfaff
from pfaff import _pfaff


def door() -> pfaff.Scene:
    return (
        pfaff.Scene("door", space="plane")
        .body("leaf", mass=20.0, inertia=5.0)
        .joint("upper", "revolute", ["ground", "leaf"], at=[0.0, 1.0])
        .joint("lower", "revolute", ["ground", "leaf"], at=(0.0, -1.0))
    )


def test_a_door_on_two_hinges() -> None:
    analysis = door().analyze()
    assert (analysis.rank, analysis.redundancy, analysis.mobility) == (3, 1, 0)
    upper = analysis.verdicts["upper"]
    assert not upper.unique and upper.verdict == "not_unique"
    assert list(analysis.verdicts) == ["upper", "lower"]
    # The hinges share the load along the line through both; across it, each load is determined.
    assert upper.components["Fx"].unique and not upper.components["Fy"].unique
    assert upper.directions is not None
    np.testing.assert_allclose(np.abs(upper.directions), [[1.0, 0.0]], atol=1e-12)
    assert not upper.fragile and upper.type == "revolute" and upper.rows == [1, 2]
    assert analysis.combine("upper.Fy + lower.Fy").unique
    assert not analysis.combine("upper.Fy - lower.Fy").unique
    assert analysis.eliminations()["count"] == 2
    assert "upper" in analysis.explain()[0] and "lower" in upper.explain()
    ways = upper.make_unique()["ways"]
    assert ways and all(way["rows"] for way in ways)
    numbers = analysis.reactions()
    assert np.isnan(numbers["upper"]["Fy"]) and numbers["upper"]["Fx"] == pytest.approx(0.0)
    assert np.isfinite(analysis.reactions([2])["lower"]["Fy"])
    assert np.isfinite(analysis.reactions({"upper": 1e-6, "lower": 2e-6})["lower"]["Fy"])


SWING = """
scene = { name = "swing", space = "plane", gravity = [0.0, -10.0] }
body = [
    { name = "arm", mass = 1.0, inertia = 0.1, position = [0.0, -0.5] },
    { name = "seat", mass = 3.0, inertia = 0.2, position = [0.25, -1.0] },
]
joint = [
    { name = "pivot", type = "revolute", bodies = ["ground", "arm"], at = [0.0, 0.0] },
    { name = "hinge", type = "revolute", bodies = ["arm", "seat"], at = [0.0, -1.0] },
    { name = "level", type = "coupling", measures = ["pivot.angle", "hinge.angle"], ratio = -1.0 },
%s]
"""
AGAIN = (
    '    { name = "again", type = "coupling", measures = ["pivot.angle", "hinge.angle"], ratio = -1.0 },\n'
)


def test_couplings_have_their_own_force() -> None:
    """An arm at rest below its pivot; a seat of 3 kg at 0.25 m from its hinge does not rotate."""
    swing = pfaff.Scene.from_string(SWING % "").analyze()
    verdict = swing.verdicts["level"]
    assert verdict.unique and not verdict.fragile
    assert swing.combine("level.load").value == pytest.approx(-7.5)
    doubled = pfaff.Scene.from_string(SWING % AGAIN)
    verdict = doubled.analyze().verdicts["level"]
    assert {name: c.verdict for name, c in verdict.components.items()} == {
        "T": "not_unique",
        "load": "not_unique",
    }
    assert doubled.analyze().combine("level.load + again.load").unique
    run = doubled.simulate(0.1)
    for name in ("T", "load"):
        assert np.isnan(run.reaction("level")[name]).all()


TURNED = """
scene = { name = "turned", space = "plane", format = 2, units = { length = "mm", angle = "deg" } }
body = [{ name = "disc", mass = 1.0, inertia = 1e3 }]
joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "disc"], at = [0, 0] }]
drive = [{ name = "motor", joint = "pivot", type = "angle", motion = { type = "constant-rate", rate = 90 } }]
"""


def test_messages_have_the_units_of_the_scene() -> None:
    turned = pfaff.Scene.from_string(TURNED)
    # The second answer uses the stored start of the first.
    for _ in range(2):
        with pytest.raises(pfaff.Error, match="`motor` prescribes 90 deg/s"):
            turned.equilibrium()
    radians = pfaff.Scene.from_string(TURNED.replace('angle = "deg"', 'angle = "rad"'))
    with pytest.raises(pfaff.Error, match="`motor` prescribes 90 rad/s"):
        radians.equilibrium()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_directions_are_rows(path: Path) -> None:
    """Arrays have as many columns as components (six in space), even without a row."""
    analysis = pfaff.Scene.from_file(path).analyze()
    is_spatial = analysis.document["velocities"] == 6 * analysis.document["bodies"]
    for verdict in analysis.verdicts.values():
        directions, components = verdict.directions, verdict.components
        if directions is None:
            assert verdict.document["unique_directions"] is None
            continue
        columns = 6 if is_spatial else len(components)
        assert directions.shape == (len(verdict.document["unique_directions"]), columns)
        # The rows are independent; there is one for each row of a joint with a unique reaction.
        assert len(directions) == 0 or np.linalg.matrix_rank(directions) == len(directions)
        assert len(directions) <= len(verdict.rows)
        if verdict.unique:
            assert len(directions) == len(verdict.rows)


def test_no_direction_is_unique() -> None:
    left = pfaff.Scene.from_string(SLEIGH).analyze().verdicts["left"].directions
    assert left is not None and left.shape == (0, 2)
    table = pfaff.Scene.from_file(ROOT / "examples" / "table.toml").analyze()
    leg = table.verdicts["A"].directions
    assert leg is not None and leg.shape == (0, 6)


def test_documents_are_copies() -> None:
    scene = pfaff.Scene.from_string(SLEIGH)
    analysis = scene.analyze()
    left = analysis.verdicts["left"]
    whole, own = analysis.document, left.document
    whole["reactions"][0]["components"].clear()
    whole["rank"] = 7
    own["unique_directions"].append([1.0, 0.0])
    own["components"][0]["verdict"] = "undecided"
    assert analysis.document["rank"] == analysis.rank == 1
    assert left.document == analysis.document["reactions"][0] == scene.analyze().document["reactions"][0]
    assert left.document["components"] and left.document["unique_directions"] == []
    assert left.components["Fx"].verdict != "undecided"


def test_scenes_do_not_change() -> None:
    one = pfaff.Scene("one")
    two = one.body("a", mass=1.0, inertia=1.0)
    assert "body" not in one.text and "[[body]]" in two.text
    assert two.bodies == ["a"] and two.name == "one"
    heavy = two.with_(**{"body.a.mass": np.float64(3.0)})
    assert heavy.matrices().M[0, 0] == 3.0 and two.matrices().M[0, 0] == 1.0
    with pytest.raises(AttributeError):
        two.text = ""  # type: ignore[misc]
    assert two == pfaff.Scene.from_string(two.text, two.file) and hash(two) != hash(one)
    assert pickle.loads(pickle.dumps(two)) == two


def test_the_builder_has_the_errors_of_the_reader() -> None:
    scene = pfaff.Scene("s").body("bar", mass=1.0, inertia=1.0)
    for wrong, hint in (
        (scene.joint("A", "revolut", ["ground", "bar"], at=[0, 0]), "revolute"),
        (scene.joint("A", "revolute", ["ground", "barr"], at=[0, 0]), "bar"),
        (scene.joint("A", "revolute", ["ground", "bar"], att=[0, 0]), "at"),
        (scene.body("bar", mass=1.0, inertia=1.0), ""),
        (scene.body("b", mas=1.0, inertia=1.0), "mass"),
    ):
        with pytest.raises(pfaff.SceneError) as raised:
            wrong.check()
        error = raised.value
        assert error.code is not None and error.place is not None
        assert error.place.file == "s.toml" and error.place.line > 4
        assert hint in str(error)
        assert isinstance(error, ValueError)


def test_parameters_and_expressions() -> None:
    scene = (
        pfaff.Scene("bar", format=2)
        .parameters(L=0.3)
        .body("bar", mass="2 kg", inertia=1.0, position=["L", 0.0])
        .joint("A", "revolute", ["ground", "bar"], at=[0.0, 0.0])
    )
    assert scene.matrices().M[0, 0] == 2.0
    np.testing.assert_allclose(scene.analyze().q[:1], 0.3)
    np.testing.assert_allclose(scene.with_(L="200 mm + 0.25 m").analyze().q[:1], 0.45)


def test_texts_are_written_as_they_are() -> None:
    odd = 'a "b" \\ \u00e4\n\t\u2028 \x7f \x00 [x]'
    scene = pfaff.Scene("s").body(odd, mass=1, inertia=np.int64(2))
    try:
        assert scene.bodies == [odd]
    except pfaff.SceneError as e:
        # The reader rejects some characters; the text remains valid otherwise.
        assert e.code is not None and "TOML" not in str(e)
    tidy = 'a "b" \\ \u00e4'
    assert pfaff.Scene("s").body(tidy, mass=1, inertia=1).bodies == [tidy]


HOSTILE: list[tuple[str, Any]] = [
    ("q is too short", lambda s: s.matrices(q=[1.0])),
    ("q is too long", lambda s: s.matrices(q=np.zeros(1000))),
    ("q has two dimensions", lambda s: s.matrices(q=np.zeros((3, 1)))),
    ("q is NaN", lambda s: s.matrices(q=[np.nan, 0.0, 0.0])),
    ("v is infinite", lambda s: s.matrices(v=[0.0, np.inf, 0.0])),
    ("v is text", lambda s: s.matrices(v=["a", "b", "c"])),
    ("v is an object", lambda s: s.matrices(v=[object()] * 3)),
    ("t is NaN", lambda s: s.matrices(t=float("nan"))),
    ("time is NaN", lambda s: s.analyze(float("nan"))),
    ("time is negative", lambda s: s.analyze(-1.0)),
    ("tolerance is zero", lambda s: s.analyze(tolerance=0.0)),
    ("tolerance is NaN", lambda s: s.analyze(angle_tolerance=float("nan"))),
    ("row 0", lambda s: s.analyze(drop=[0])),
    ("row too large", lambda s: s.analyze(drop=[10**9])),
    ("rtol is NaN", lambda s: s.simulate(rtol=float("nan"))),
    ("rtol is negative", lambda s: s.simulate(rtol=-1.0)),
    ("t_end is infinite", lambda s: s.simulate(float("inf"))),
    ("t_end is negative", lambda s: s.simulate(-1.0)),
    ("output step is zero", lambda s: s.simulate(output_step=0.0)),
    ("output step is NaN", lambda s: s.simulate(output_step=float("nan"))),
    ("no method", lambda s: s.simulate(method="dopri")),
    ("empty method", lambda s: s.simulate(method="")),
    ("no threads", lambda s: s.simulate(threads=0)),
    ("less than no steps", lambda s: s.simulate(max_steps=-1)),
    ("more steps than can be counted", lambda s: s.simulate(max_steps=2**63)),
    ("seed", lambda s: s.tolerance(seed=-1, tolerance=1e-3)),
    ("less than no sets", lambda s: s.analyze().eliminations(-1)),
    ("an integer that is no float", lambda s: s.simulate(10**400)),
    ("no such reaction", lambda s: s.simulate(reactions=["pivott"])),
    ("no such choice", lambda s: s.simulate(choose="minimum")),
    ("rows to drop", lambda s: s.simulate(choose=[1, 1])),
    ("empty name", lambda s: s.analyze().verdicts[""]),
    ("empty sum", lambda s: s.analyze().combine("")),
    ("long sum", lambda s: s.analyze().combine("pivot.Fx + " * 10_000)),
    ("no marker", lambda s: s.analyze().moment("pivot", "here")),
    ("point of one number", lambda s: s.analyze().moment("pivot", [1.0])),
    ("point that is NaN", lambda s: s.analyze().moment("pivot", [np.nan, 0.0])),
    ("permission", lambda s: s.analyze().make_unique("pivot", "all")),
    ("no such arm", lambda s: s.analyze().reactions("minimum-norm", length=-1.0)),
    ("compliance", lambda s: s.analyze().reactions({"pivot": float("nan")})),
    ("choice", lambda s: s.analyze().reactions("least")),
    ("along to zero", lambda s: s.analyze().along(0.0)),
    ("key", lambda s: s.with_(**{"": 1.0})),
    ("value", lambda s: s.with_(**{"body.bob.mass": object()})),
    ("nan in a scene", lambda s: s.with_(**{"body.bob.mass": float("nan")}).check()),
    ("huge number", lambda s: s.with_(**{"body.bob.mass": 1e300}).check()),
    ("huge integer", lambda s: s.body("b", mass=10**400, inertia=1).check()),
    ("object in a table", lambda s: s.body("b", mass=object())),
    ("lone surrogate", lambda s: s.body("\ud800", mass=1, inertia=1, foo=1).check()),
    ("no text", lambda s: pfaff.Scene.from_string("").check()),
    ("null characters", lambda s: pfaff.Scene.from_string("\0" * 100).check()),
    ("deep", lambda s: pfaff.Scene.from_string("a = " + "[" * 100_000).check()),
    ("no file", lambda s: pfaff.Scene.from_file("")),
    ("nothing to import", lambda s: pfaff.Scene.from_urdf()),
    ("empty model", lambda s: pfaff.Scene.from_sdf(text="")),
    ("base", lambda s: pfaff.Scene.from_urdf(text="<robot/>", base="loose")),
    ("drives", lambda s: pfaff.Scene.from_urdf(text="<robot/>", drives="some")),
    ("no model", lambda s: pfaff.Scene.from_sdf(text="<sdf version='1.9'/>", model="arm")),
    ("no coordinate", lambda s: s.linearise(coordinates=["bob.z"])),
    ("nothing varies", lambda s: s.tolerance()),
    ("no samples", lambda s: s.tolerance(0, tolerance=1e-3)),
    ("too many samples", lambda s: s.tolerance(10**9, tolerance=1e-3)),
    ("tolerance of samples", lambda s: s.tolerance(tolerance=float("nan"))),
    ("time of samples", lambda s: s.tolerance(tolerance=1e-3, at_time=float("nan"))),
    ("threads of samples", lambda s: s.tolerance(tolerance=1e-3, threads=0)),
    ("no sign", lambda s: s.tolerance(vary={"body.bob.mass": "2%"})),
    ("varies by NaN", lambda s: s.tolerance(vary={"body.bob.mass": "±nan"})),
    ("no key", lambda s: s.tolerance(vary=["body.bob.mass"])),
    ("varies by less than nothing", lambda s: s.tolerance(vary={"body.bob.mass": "±-1"})),
    ("varies too much", lambda s: s.tolerance(vary={"body.bob.mass": "±200%"})),
    ("nothing is called so", lambda s: s.tolerance(vary={"": "±1"})),
    ("both plans", lambda s: s.work_precision(quick=True, all=True)),
    ("no end", lambda s: pfaff.Scene("s").body("b", mass=1, inertia=1).work_precision()),
    ("time of a linearisation", lambda s: s.linearise(float("inf"))),
]


@pytest.mark.parametrize("call", [call for _, call in HOSTILE], ids=[name for name, _ in HOSTILE])
def test_hostile_input(call: Any) -> None:
    with pytest.raises(pfaff.Error) as raised:
        call(pfaff.Scene.from_string(PENDULUM))
    error = raised.value
    assert not isinstance(error, pfaff.InternalError)
    assert error.code is not None and error.code.startswith("P0")
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.code) == (type(error), str(error), error.code)


WRONG_TYPES: list[tuple[Any, str]] = [
    (lambda s: s.analyze("now"), "at_time is `str`, need a number"),
    (lambda s: s.analyze(tolerance=[1e-3]), "tolerance is `list`, need a number"),
    (lambda s: s.analyze(drop=["a"]), r"drop\[0\] is `str`, need a whole number"),
    (lambda s: s.analyze(drop=3), "drop is `int`, need a list of rows"),
    (lambda s: s.simulate(threads=1.5), "threads is `float`, need a whole number"),
    (lambda s: s.simulate("1"), "t_end is `str`, need a number"),
    (lambda s: s.simulate(rtol=1j), "rtol is `complex`, need a number"),
    (lambda s: s.simulate(method=3), "method is `int`, need a text"),
    (lambda s: s.simulate(output_step=np.zeros(1)), "output_step is `ndarray`, need a number"),
    (lambda s: s.simulate(reactions=3), "reactions is `int`, need True, False, a name or names"),
    (lambda s: s.simulate(reactions=[3]), r"reactions\[0\] is `int`, need a text"),
    (lambda s: s.simulate(choose=3), "choose is `int`, need a choice, or a list of choices"),
    (lambda s: s.simulate(choose={"pivot": "soft"}), r"choose\['pivot'\] is `str`, need a compliance"),
    (lambda s: s.simulate(choose={"pivot": (1e-6,)}), r"choose\['pivot'\] is `tuple`, need a compliance"),
    (lambda s: s.simulate(drives=3), "drives is `int`, need functions by name"),
    (lambda s: s.simulate(on_row=3), "on_row is `int`, need a function of the time"),
    (lambda s: s.simulate(on_event="stop"), "on_event is `str`, need a function of an event"),
    (lambda s: s.simulate(max_memory=1e9), "max_memory is `float`, need a number of bytes"),
    (lambda s: s.simulate_into(3), "directory is `int`, need a path"),
    (lambda s: s.simulate_into(".", t_end="1"), "t_end is `str`, need a number"),
    (lambda s: s.tolerance(1.5, tolerance=1e-3), "runs is `float`, need a whole number"),
    (lambda s: s.tolerance(seed="a", tolerance=1e-3), "seed is `str`, need a whole number"),
    (lambda s: s.tolerance(vary={"body.bob.mass": None}), r"vary\['body.bob.mass'\] is None, need a text"),
    (lambda s: s.tolerance(vary="body.bob.mass=±1"), "vary is `str`, need texts as KEY=VALUE"),
    (lambda s: s.diff("other.toml"), "other is `str`, need a Scene"),
    (lambda s: s.linearise(coordinates="bob.x"), "coordinates is `str`, need a list of texts"),
    (lambda s: s.linearise(follow=[None]), r"follow\[0\] is None, need a text"),
    (lambda s: s.matrices(q="abc"), "q is `str`, need a list or an array of numbers"),
    (lambda s: s.matrices(t=None), r"t is None, need a time \(s\)"),
    (lambda s: s.work_precision(quick="no"), "quick is `str`, need True or False"),
    (lambda s: s.sweep(3), "vary is `int`, need a list of texts"),
    (lambda s: s.sweep({"body.bob.mass": [None]}), "a value of `body.bob.mass` is None, need a number"),
    (lambda s: s.sweep("body.bob.mass=1,2", threads="all"), "threads is `str`, need a whole number"),
    (lambda s: s.sweep("body.bob.mass=1,2", 3), "out is `int`, need a path"),
    (lambda s: s.from_string(3), "text is `int`, need a text"),
    (lambda s: s.from_file(None), "path is None, need a path"),
    (lambda s: s.from_urdf(text=b"<robot/>"), "text is `bytes`, need a text"),
    (lambda s: s.from_mjcf(text="<mujoco/>", pose={"hip": "up"}), r"pose\['hip'\] is `str`, need a number"),
    (lambda s: s.from_mjcf(text="<mujoco/>", snap=1), "snap is `int`, need True or False"),
    (lambda s: s.with_(**{"body.bob.mass": object()}), "`body.bob.mass` is `object`, need a number"),
    (lambda s: s.body("b", mass=object()), "a value is `object`, need a number"),
    (lambda s: s.add(3), "table is `int`, need a text"),
    (lambda s: s.analyze().eliminations(1.5), "limit is `float`, need a whole number"),
    (lambda s: s.analyze().combine(3), "sum is `int`, need a text"),
    (lambda s: s.analyze().moment("pivot", 3), r"about is `int`, need coordinates \(m\)"),
    (lambda s: s.analyze().moment("pivot", [0.0, "a"]), r"about\[1\] is `str`, need a number"),
    (lambda s: s.analyze().make_unique(3), "name is `int`, need a text"),
    (lambda s: s.analyze().make_unique("pivot", 3), "allow is `int`, need a list of rows"),
    (lambda s: s.analyze().along("1"), "t_end is `str`, need a number"),
    (lambda s: s.analyze().reactions(3), "choose is `int`, need a list of rows"),
    (lambda s: s.analyze().reactions({"pivot": None}), r"choose\['pivot'\] is None, need a compliance"),
]


@pytest.mark.parametrize(("call", "words"), WRONG_TYPES, ids=[words for _, words in WRONG_TYPES])
def test_wrong_types(call: Any, words: str) -> None:
    """The exception names the argument, the given type and the required type."""
    with pytest.raises(TypeError, match=words) as raised:
        call(pfaff.Scene.from_string(PENDULUM))
    error = raised.value
    assert isinstance(error, pfaff.ArgumentError) and error.code == "P0001"
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again)) == (type(error), str(error))


def test_unknown_options_are_refused_as_unknown_keywords() -> None:
    scene = pfaff.Scene.from_string(PENDULUM)
    calls: list[Any] = [scene.simulate, lambda **options: scene.simulate_into(".", **options)]
    for call in calls:
        with pytest.raises(TypeError, match="rtl"):
            call(rtl=1e-3)


def test_no_panic_leaves_the_package(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(pfaff.InternalError, match="as the test wants") as raised:
        _pfaff._panics()
    assert isinstance(raised.value, RuntimeError)
    assert "as the test wants" in capfd.readouterr().err


def test_two_analyses_at_once() -> None:
    """Each thread uses separate scenes and one scene that all threads share."""
    texts = [PENDULUM, SLEIGH]
    shared = [pfaff.Scene.from_string(text) for text in texts]
    expected = [scene.analyze().document for scene in shared]
    failures: list[object] = []

    def go() -> None:
        for _ in range(10):
            for text, scene, document in zip(texts, shared, expected, strict=True):
                for found in (scene.analyze(), pfaff.Scene.from_string(text, scene.file).analyze()):
                    if found.document != document:
                        failures.append(found)

    threads = [threading.Thread(target=go) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures


def test_a_mechanism_that_cannot_move() -> None:
    """Two pivots 1e-9 m apart can be analysed, but not moved."""
    bar = (
        pfaff.Scene("bar")
        .body("bar", mass=1.0, inertia=1.0, position=[1.0, 0.0])
        .joint("pivot", "revolute", ["ground", "bar"], at=[0.0, 0.0])
        .joint("twin", "revolute", ["ground", "bar"], at=[1e-9, 0.0])
    )
    analysis = bar.analyze()
    assert (analysis.rank, analysis.redundancy) == (3, 1)
    assert "cannot be simulated" in analysis.document["warnings"][0]
    for call in (lambda: bar.simulate(1.0), lambda: bar.analyze(0.5), lambda: analysis.along(1.0)):
        with pytest.raises(pfaff.Error) as raised:
            call()
        assert raised.value.code is not None


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_read(path: Any) -> None:
    scene = pfaff.Scene.from_file(path)
    assert len(scene.bodies) == scene.check()["bodies"] > 0
    assert list(scene.analyze().verdicts) == scene.joints


def test_templates_begin_scenes(tmp_path: Path) -> None:
    known = pfaff.templates()
    assert len(known) > 30 and "hinges" in known["door"]
    door = pfaff.Scene.new("door")
    assert door.analyze().redundancy == 1
    assert pfaff.Scene.from_string(door.text, door.file) == door
    with pytest.raises(pfaff.InputError, match="did you mean `door`"):
        pfaff.Scene.new("doors")
    for name, begins in (("door.html", b"<!DOCTYPE html>"), ("door.svg", b"<svg ")):
        door.view(tmp_path / name)
        assert (tmp_path / name).read_bytes().startswith(begins)
    for wrong in ("door.pdf", "door"):
        with pytest.raises(pfaff.InputError, match=r"\.html, \.svg or \.png"):
            door.view(tmp_path / wrong)
    with pytest.raises(pfaff.InputError, match="scale requires a file name"):
        door.view(tmp_path / "door.svg", scale=2.0)


def test_codes_are_explained() -> None:
    assert pfaff.explain("P0102").startswith("P0102: ")
    with pytest.raises(pfaff.InputError, match="there is no code `P9999`"):
        pfaff.explain("P9999")


def test_the_package_imports_nothing_large() -> None:
    code = "import sys, pfaff; print(*sorted(sys.modules))"
    words = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    modules = set(done.stdout.split())
    assert modules.isdisjoint({"matplotlib", "pandas", "polars", "scipy"})


def test_the_example_of_the_package() -> None:
    import doctest

    failed, tried = doctest.testmod(pfaff)
    assert tried > 0 and failed == 0


BOOK = ROOT / "docs" / "book"
WITH_BLOCKS = [page for page in sorted(BOOK.glob("*.md")) if "```python\n" in page.read_text(encoding="utf-8")]
# The other pages may read the files that the first page writes.
PAGES = {page.stem: [BOOK / "python.md", page] for page in [*WITH_BLOCKS, ROOT / "README.md"]}


@pytest.mark.parametrize("pages", PAGES.values(), ids=PAGES.keys())
def test_pages_of_the_book(pages: list[Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The code blocks of a page run one after the other."""
    monkeypatch.chdir(tmp_path)
    for page in pages:
        text = page.read_text(encoding="utf-8")
        blocks = [piece.split("```")[0] for piece in text.split("```python\n")[1:]]
        assert blocks
        names: dict[str, Any] = {}
        for block in blocks:
            exec(compile(block, page.name, "exec"), names)


def test_a_load_case_replaces_values() -> None:
    scene = pfaff.Scene("stone", gravity=[0.0, -10.0]).body("stone", mass=2.0, inertia=1.0)
    scene = scene.add("case", name="heavy", set=["body.stone.mass = 5"])
    assert scene.cases == ["heavy"]
    assert "mass = 5" in scene.case("heavy").text
    with pytest.raises(pfaff.InputError, match="did you mean `heavy`"):
        scene.case("heavi")
