"""Verdicts, motions and messages: the documents equal those of the command."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from conftest import EXAMPLES, PENDULUM, ROOT, Command, with_keywords

import pfaff

# Properties that differ between the runs of two programs.
OWN = {"wall_seconds", "files", "rows", "version"}


def _names(path: Path) -> str:
    return path.stem


@pytest.fixture(autouse=True)
def _here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)


@pytest.mark.parametrize("path", EXAMPLES, ids=_names)
def test_verdicts(path: Path, command: Command) -> None:
    expected = command.document("analyze", path)
    assert pfaff.Scene.from_file(path).analyze().document == expected


def test_templates(command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    templates = [template["name"] for template in command.document("new")["templates"]]
    assert len(templates) >= 30
    for name in templates:
        command.run("new", name)
        path = f"{name}.toml"
        expected = command.document("analyze", path)
        assert pfaff.Scene.from_file(path).analyze().document == expected, name


def test_verdicts_with_options(command: Command) -> None:
    path = ROOT / "examples" / "sleigh.toml"
    scene = pfaff.Scene.from_file(path)
    asked = ["--make-unique", "left", "--eliminations", "5", "--combine", "left.N + right.N"]
    asked += ["--about", "0.1,0.2", "--along", "1.0", "--choose", "minimum-norm", "--allow", "whole"]
    expected = command.document("analyze", path, *asked)
    analysis = scene.analyze()
    assert analysis.make_unique("left", "whole") == expected["make_unique"][0]
    assert analysis.eliminations(5) == expected["eliminations"]
    assert analysis.along(1.0) == expected["along"]
    (group,) = [g for g in expected["groups"] if g["name"] == "left.N + right.N"]
    found = analysis.combine("left.N + right.N")
    assert (found.verdict, found.margin) == (group["verdict"], group["margin"])
    assert found.value == group["values"][0]["value"]
    for reaction in expected["reactions"]:
        moment = analysis.moment(reaction["name"], (0.1, 0.2))
        verdicts = {c["name"]: c["verdict"] for c in reaction["moment"]["components"]}
        assert {name: c.verdict for name, c in moment.items()} == verdicts
    (choice,) = expected["choices"]
    chosen = analysis.reactions("minimum-norm")
    for reaction in choice["reactions"]:
        numbers = {c["name"]: c["value"] for c in reaction["components"]}
        assert chosen[reaction["name"]] == numbers


def test_a_later_time_and_a_tolerance(command: Command) -> None:
    path = ROOT / "examples" / "four-bar.toml"
    expected = command.document("analyze", path, "--at-time", "0.3", "--tolerance", "1e-3")
    assert pfaff.Scene.from_file(path).analyze(0.3, tolerance=1e-3).document == expected


def _table(path: Path) -> tuple[list[str], np.ndarray[Any, Any]]:
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    # The cell of a component that is not determined is empty.
    return header, np.array([[float(x or "nan") for x in row] for row in rows])


@pytest.mark.parametrize("path", EXAMPLES, ids=_names)
def test_motions(path: Path, command: Command, tmp_path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    if "simulate" not in text:
        pytest.skip("the scene has no run")
    # Writing the files for readers takes longer than the run.
    done = command.run("simulate", path, "--out", tmp_path / "run", "--json")
    assert done.returncode == 0, done.stderr
    scene = pfaff.Scene.from_file(path)
    run, chosen = scene.simulate(), scene.simulate(choose="kept-rows")
    assert chosen.reaction_columns == run.reaction_columns
    for file, columns, table in (
        ("trajectory.csv", run.columns, run.trajectory),
        ("reactions.csv", run.reaction_columns, run.reactions),
        ("choice.csv", run.reaction_columns, chosen.reactions),
        ("loads.csv", run.load_columns, run.loads),
    ):
        if not (tmp_path / "run" / file).exists():
            continue
        header, expected = _table(tmp_path / "run" / file)
        known = [column for column in columns if column in header]
        assert header == ["t", *known]
        own = table[:, [columns.index(column) for column in known]]
        np.testing.assert_array_equal(run.t, expected[:, 0])
        np.testing.assert_array_equal(own, expected[:, 1:])
    # A determined component has the same value for every choice.
    determined = np.isfinite(run.reactions)
    np.testing.assert_array_equal(run.reactions[determined], chosen.reactions[determined])
    has_choice = (tmp_path / "run" / "choice.csv").exists()
    if (tmp_path / "run" / "reactions.csv").exists():
        header, expected = _table(tmp_path / "run" / "reactions.csv")
        assert has_choice == bool(np.isnan(expected).any())


@pytest.mark.parametrize("name", ["slider-crank", "sleigh"])
def test_summary(name: str, command: Command, tmp_path: Path) -> None:
    path = ROOT / "examples" / f"{name}.toml"
    expected = command.document("simulate", path, "--out", tmp_path / "run")
    scene = pfaff.Scene.from_file(path)
    run = scene.simulate()
    for key in expected.keys() - OWN - {"plan"}:
        assert run.document[key] == expected[key], key
    written = scene.simulate_into(tmp_path / "own")
    for key in expected.keys() - {"wall_seconds"}:
        assert written[key] == expected[key], key
    tables = {file.name: file.read_bytes() for file in (tmp_path / "run").glob("*.csv")}
    assert {"trajectory.csv", "reactions.csv"} <= set(tables)
    assert ("choice.csv" in tables) == bool(expected["choice"]) == (name == "sleigh")
    for file, content in tables.items():
        assert (tmp_path / "own" / file).read_bytes() == content, file
    assert {file.name for file in (tmp_path / "own").glob("*.csv")} == set(tables)


def test_linearisation(command: Command) -> None:
    hanging = PENDULUM.replace("position = [1.0, 0.0]", "position = [0.0, -1.0]")
    expected = command.document("linearise", "-", stdin=hanging)
    found = pfaff.Scene.from_string(hanging, "<stdin>").linearise()
    assert found.document == expected


def test_questions(command: Command) -> None:
    door, hinges = (ROOT / "examples" / f"{name}.toml" for name in ("door", "hinges"))
    scene, other = map(pfaff.Scene.from_file, (door, hinges))
    assert scene.equilibrium(stable=True) == command.document("equilibrium", door, "--stable")
    assert scene.check() == command.document("check", door)
    assert scene.diff(other) == command.document("diff", door, hinges)
    options = ["--method", "radau5", "--t-end", "2", "--vary", "body.leaf.mass=1:2:3"]
    found = scene.plan(method="radau5", t_end=2.0, vary=["body.leaf.mass=1:2:3"])
    expected = command.document("plan", door, *options)
    assert {**found, "memory": 0} == {**expected, "memory": 0}
    with pytest.raises(pfaff.InputError, match="`euler` is not one of"):
        scene.plan(method="euler")


FAULTS = {
    "no TOML": "[scene\nname = 3",
    "empty": "",
    "unknown key": PENDULUM.replace("mass", "mas"),
    "unknown body": PENDULUM.replace('"bob"]', '"bobb"]'),
    "unknown type": PENDULUM.replace("revolute", "revolut"),
    "negative mass": PENDULUM.replace("mass = 1.0", "mass = -1.0"),
    "two faults": PENDULUM.replace("mass = 1.0", "mass = nan").replace("at =", "att ="),
    "terminal codes": PENDULUM.replace("bob", "b\\u001b[31mb"),
    "bad velocity": PENDULUM.replace("position", "velocity = [1.0, 3.0], position"),
    "wrong end": PENDULUM.replace("t_end = 1.0", "t_end = -1.0"),
    "long line": PENDULUM + f'# {"x" * 4000}\nfoo = {"[" * 300}',
}


@pytest.mark.parametrize("text", FAULTS.values(), ids=FAULTS.keys())
def test_refusals(text: str, command: Command, scene_file: Callable[[str], Path]) -> None:
    path = scene_file(text)
    words = command.run("analyze", path)
    expected = command.document("analyze", path)
    if words.returncode == 0:
        assert pfaff.Scene.from_file(path).analyze().document == expected
        return
    with pytest.raises(pfaff.Error) as raised:
        pfaff.Scene.from_file(path).analyze()
    error = raised.value
    assert str(error) == words.stderr.rstrip()
    assert error.document == expected
    assert error.code == expected["code"]
    assert isinstance(error, pfaff.SceneError) == bool(expected["problems"])
    if expected["problems"]:
        first = expected["problems"][0]
        assert error.hint == first["help"]
        place = (str(path), first["primary"]["line"], first["primary"]["column"])
        assert error.place == pfaff.Place(*place)


def test_other_refusals(command: Command, scene_file: Callable[[str], Path]) -> None:
    path = scene_file(PENDULUM)
    missing = path.with_name("scen.toml")

    def same(call: Callable[[], object], *arguments: str | Path) -> None:
        with pytest.raises(pfaff.Error) as raised:
            call()
        assert str(raised.value) == with_keywords(command.run(*arguments).stderr.rstrip())
        document = with_keywords(json.dumps(command.document(*arguments)))
        assert raised.value.document == json.loads(document)

    scene = pfaff.Scene.from_file(path)
    same(lambda: pfaff.Scene.from_file(missing), "analyze", missing)
    same(lambda: pfaff.Scene.from_file(path.parent), "analyze", path.parent)
    analysis = scene.analyze()
    same(lambda: analysis.verdicts["pivo"], "analyze", path, "--make-unique", "pivo")
    same(lambda: analysis.combine("pivot.Q"), "analyze", path, "--combine", "pivot.Q")
    with pytest.raises(pfaff.InputError, match="row 0 does not exist: rows are counted from 1"):
        scene.analyze(drop=[0])
    same(lambda: scene.analyze(drop=[7]), "analyze", path, "--drop", "7")
    out = path.with_name("out")
    same(lambda: scene.simulate(rtol=-1.0), "simulate", path, "--out", out, "--rtol=-1")
    same(lambda: scene.simulate(t_end=-1.0), "simulate", path, "--out", out, "--t-end=-1")


SCHEMAS = {
    path.parent.name: Draft202012Validator(json.loads(path.read_text(encoding="utf-8")))
    for path in ROOT.glob("crates/pfaff/src/questions/*/answer.schema.json")
}


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_documents_have_the_keys_of_their_schemas(path: Path, tmp_path: Path) -> None:
    scene = pfaff.Scene.from_file(path)
    asked: dict[str, Callable[[], dict[str, Any]]] = {
        "analyze": lambda: scene.analyze(
            frames=True, eliminations=3, choose=["minimum-norm"], make_unique=scene.joints[:2]
        ).document,
        "check": scene.check,
        "diff": lambda: scene.diff(scene.with_(**{"scene.gravity[1]": -1.0})),
        "equilibrium": scene.equilibrium,
        "linearise": lambda: scene.linearise().document,
        "plan": scene.plan,
        "simulate": lambda: scene.simulate_into(tmp_path, t_end=0.1),
        "tolerance": lambda: scene.tolerance(3, tolerance=1e-4).document,
    }
    assert SCHEMAS.keys() - asked.keys() == {"cases", "sweep", "work_precision"}
    for name, ask in asked.items():
        try:
            document = ask()
        except pfaff.Error:
            # Some scenes have no equilibrium, no motion, or no such value.
            continue
        _has_keys_of(name, document)


def _has_keys_of(name: str, document: dict[str, Any]) -> None:
    SCHEMAS[name].validate(document)
    # A schema that permits any other key would be useless.
    assert set(document) <= set(SCHEMAS[name].schema["properties"])


def test_documents_of_many_runs_have_the_keys_of_their_schemas() -> None:
    scene = pfaff.Scene.from_string(PENDULUM)
    _has_keys_of("work_precision", scene.work_precision(quick=True).document)
    # The second mass is rejected.
    _has_keys_of("sweep", scene.sweep("body.bob.mass=1,-1").document)


def test_not_utf8(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "latin.toml"
    path.write_bytes(b"[scene]\nname = \"\xe4\"\n")
    with pytest.raises(pfaff.InputError) as raised:
        pfaff.Scene.from_file(path)
    assert str(raised.value) == command.run("analyze", path).stderr.rstrip()
    assert os.fspath(path) in str(raised.value)


def test_other_numbers(command: Command, scene_file: Callable[[str], Path]) -> None:
    path = scene_file(PENDULUM)
    scene = pfaff.Scene.from_file(path)
    other = scene.with_(**{"body.bob.mass": 2.5, "joint.pivot.at": [0.0, 0.25]})
    settings = ["body.bob.mass=2.5", "joint.pivot.at[0]=0", "joint.pivot.at[1]=0.25"]
    words = [word for setting in settings for word in ("--set", setting)]
    assert other.analyze().document == command.document("analyze", path, *words)
    with pytest.raises(pfaff.InputError) as raised:
        scene.with_(**{"body.bop.mass": 2.0})
    refused = command.run("analyze", path, "--set", "body.bop.mass=2").stderr.rstrip()
    assert str(raised.value) == refused.replace("--set: ", "")


def test_imports(command: Command, tmp_path: Path) -> None:
    model = """<mujoco model="pendulum"><worldbody><body name="rod">
      <joint name="hinge" axis="0 1 0"/>
      <inertial pos="0 0 -0.5" mass="2" diaginertia="0.17 0.17 0.001"/>
    </body></worldbody></mujoco>"""
    path = tmp_path / "pendulum.xml"
    path.write_text(model, encoding="utf-8")
    command.run("import", path, "--out", tmp_path / "out.toml")
    scene = pfaff.Scene.from_mjcf(path)
    assert scene.text == (tmp_path / "out.toml").read_text(encoding="utf-8")
    assert scene.analyze().mobility == 1
    with pytest.raises(pfaff.InputError, match="is MJCF, not URDF"):
        pfaff.Scene.from_urdf(path)
    path.write_text(model.replace('mass="2"', 'mass="-2"'), encoding="utf-8")
    with pytest.raises(pfaff.SceneError) as raised:
        pfaff.Scene.from_mjcf(path)
    expected = command.run("import", path, "--out", tmp_path / "out.toml", "--force")
    assert str(raised.value) == expected.stderr.rstrip()


def test_imports_of_models_and_drives(command: Command, tmp_path: Path) -> None:
    models = [
        f"""<model name="{name}"><link name="rod"/><joint name="pin" type="revolute">
        <parent>world</parent><child>rod</child></joint></model>"""
        for name in ("left", "right")
    ]
    path, out = tmp_path / "two.sdf", tmp_path / "out.toml"
    path.write_text(f"""<sdf version="1.9">{"".join(models)}</sdf>""", encoding="utf-8")
    command.run("import", path, "--out", out, "--model", "right", "--drives", "torque")
    scene = pfaff.Scene.from_sdf(path, model="right", drives="torque")
    assert scene.text == out.read_text(encoding="utf-8")
    run = scene.simulate(t_end=1.0, drives={"pin drive": lambda t, angle, rate: 2.0})
    # The joint is at the centre of mass, and the moment of inertia is 1 kg·m².
    assert abs(run.body("rod").angular_velocity[-1][2] - 2.0) < 1e-8


TOLERANCES: list[tuple[str, dict[str, Any], list[str]]] = [
    ("car", {"tolerance": 1e-3}, ["--tolerance", "1e-3"]),
    ("four-bar", {"tolerance": 1e-4, "angle_tolerance": 1e-3, "seed": 7}, ["--tolerance", "1e-4", "--angle-tolerance", "1e-3", "--seed", "7"]),
    ("table", {"tolerance": 1e-3}, ["--tolerance", "1e-3"]),
    ("slider-crank", {"tolerance": 1e-4, "at_time": 0.02, "threads": 1}, ["--tolerance", "1e-4", "--at-time", "0.02"]),
    ("sleigh", {"vary": {"body.sleigh.mass": "±2%", "body.sleigh.inertia": "±0.125"}}, ["--vary", "body.sleigh.mass=±2%", "--vary", "body.sleigh.inertia=±0.125"]),
]


@pytest.mark.parametrize(("name", "options", "words"), TOLERANCES, ids=[name for name, *_ in TOLERANCES])
def test_samples(name: str, options: dict[str, Any], words: list[str], command: Command, tmp_path: Path) -> None:
    path = ROOT / "examples" / f"{name}.toml"
    expected = command.document("tolerance", path, "--runs", "40", "--out", tmp_path, *words)
    samples = pfaff.Scene.from_file(path).tolerance(40, **options)
    assert samples.document == expected
    with (tmp_path / "tolerance.csv").open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    assert samples.columns == header and len(samples) == len(rows) == 40
    for column, cells in zip(header, zip(*rows, strict=True), strict=True):
        values = samples[column]
        if values.dtype.kind == "U":
            assert values.tolist() == list(cells), column
        else:
            np.testing.assert_array_equal(values, [float(cell) for cell in cells], column)


def test_work_precision(command: Command, tmp_path: Path) -> None:
    path = ROOT / "examples" / "sleigh.toml"
    expected = command.document("work-precision", path, "--quick", "--out", tmp_path)
    found = pfaff.Scene.from_file(path).work_precision(quick=True)
    (own,), (other,) = found.document["scenes"], expected["scenes"]
    assert found.document.keys() == expected.keys() and own.keys() == other.keys()
    for key in ("name", "title", "reference", "automatic"):
        assert own[key] == other[key], key
    # Run times differ, and so do the sentences about them.
    measured = ("seconds", "repetitions")
    for rows in (own["rows"], other["rows"]):
        for row in rows:
            assert row["status"] == "done" and row["seconds"] > 0.0
            for key in measured:
                del row[key]
    assert own["rows"] == other["rows"]
    with (tmp_path / "work_precision.csv").open(encoding="utf-8", newline="") as file:
        header, *lines = csv.reader(file)
    assert set(found.table) == set(header) and len(lines) == len(own["rows"])
    for column, cells in zip(header, zip(*lines, strict=True), strict=True):
        values = found.table[column]
        if values.dtype.kind == "U":
            assert values.tolist() == list(cells), column
        elif column not in measured:
            np.testing.assert_array_equal(values, [float(cell) for cell in cells], column)


def test_other_refusals_of_samples(command: Command, scene_file: Callable[[str], Path]) -> None:
    path = scene_file(PENDULUM)
    scene = pfaff.Scene.from_file(path)
    known = ["--tolerance", "1e-3"]
    for options, words in (
        ({}, []),
        ({"runs": 0, "tolerance": 1e-3}, ["--runs", "0", *known]),
        ({"vary": {"body.bob.mass": "±200%"}}, ["--vary", "body.bob.mass=±200%"]),
        ({"vary": {"body.bop.mass": "±2%"}}, ["--vary", "body.bop.mass=±2%"]),
    ):
        with pytest.raises(pfaff.Error) as raised:
            scene.tolerance(**options)
        refused = command.run("tolerance", path, *words).stderr.rstrip()
        assert str(raised.value) == with_keywords(refused)
        assert raised.value.code == command.document("tolerance", path, *words)["code"]
    still = scene_file(PENDULUM.replace("simulate = { t_end = 1.0 }", ""))
    with pytest.raises(pfaff.Error) as raised:
        pfaff.Scene.from_file(still).work_precision()
    refused = command.run("work-precision", still).stderr.rstrip()
    assert str(raised.value) == with_keywords(refused)
