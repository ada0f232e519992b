"""Runs: closed forms, arrays, reactions that are not unique, callbacks, Ctrl-C."""

from __future__ import annotations

import gc
import math
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PENDULUM, ROOT, SLEIGH

import pfaff
from pfaff._choices import Choice


def test_a_stone_falls() -> None:
    stone = pfaff.Scene("stone", gravity=[0.0, -10.0]).body(
        "stone", mass=2.0, inertia=1.0, velocity=[3.0, 5.0], angular_velocity=0.5
    )
    run = stone.simulate(1.0, output_step=0.25)
    body = run.body("stone")
    np.testing.assert_array_equal(run.t, [0.0, 0.25, 0.5, 0.75, 1.0])
    height = 5.0 * run.t - 5.0 * run.t**2
    np.testing.assert_allclose(body.position, np.column_stack((3.0 * run.t, height)), atol=1e-9)
    np.testing.assert_allclose(body.velocity[:, 1], 5.0 - 10.0 * run.t, atol=1e-9)
    np.testing.assert_allclose(body.angle, 0.5 * run.t, atol=1e-12)
    np.testing.assert_allclose(body.angular_velocity, 0.5, atol=1e-12)


def test_a_pendulum_hangs_on_its_pivot() -> None:
    """From rest at the horizontal: the pull is m·g·3·sin(angle)·(m·l²/(m·l²+J)) + the rest."""
    run = pfaff.Scene.from_string(PENDULUM).simulate(rtol=1e-10)
    mass, inertia, g = 1.0, 0.1, 9.81
    angle = run.body("bob").angle
    rate2 = 2.0 * mass * g * -np.sin(angle) / (mass + inertia)
    np.testing.assert_allclose(run.body("bob").angular_velocity**2, rate2, atol=1e-7)
    acceleration = -mass * g * np.cos(angle) / (mass + inertia)
    radial, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    pull = mass * (across * acceleration - radial * rate2) + np.array([[0.0], [mass * g]])
    # The reaction acts on the first body, the ground.
    np.testing.assert_allclose(run.reaction("pivot").force, -pull.T, atol=1e-6)
    np.testing.assert_allclose(run.reaction("pivot").torque, 0.0, atol=1e-12)


def test_a_body_in_space_turns() -> None:
    top = pfaff.Scene("block", space="spatial").body(
        "block", mass=1.0, inertia=[1.0, 1.0, 2.0], angular_velocity=[0.0, 0.0, 2.0]
    )
    run = top.simulate(1.0)
    body = run.body("block")
    assert body.position.shape == (len(run), 3)
    half = np.zeros((len(run), 4))
    half[:, 0], half[:, 3] = np.cos(run.t), np.sin(run.t)
    np.testing.assert_allclose(body.orientation, half, atol=1e-8)
    np.testing.assert_allclose(body.angular_velocity, [[0.0, 0.0, 2.0]] * len(run), atol=1e-9)


def test_accelerations_and_rates_of_measures_are_columns() -> None:
    """A pendulum: the pen at its radius r has r·ω² inwards and r·α across."""
    pendulum = (
        pfaff.Scene.from_string(PENDULUM)
        .add("marker", name="pen", body="bob", point=[0.0, 0.0])
        .measure("height", type="component", markers=["pen"], axis=[0.0, 1.0])
        .set("output", accelerations=True)
    )
    run = pendulum.simulate(rtol=1e-10)
    bob, pen = run.body("bob"), run.marker("pen")
    angle, omega, alpha = bob.angle, bob.angular_velocity, bob.angular_acceleration
    np.testing.assert_allclose(alpha, -9.81 * np.cos(angle) / 1.1, atol=1e-8)
    radial = np.column_stack((np.cos(angle), np.sin(angle)))
    across = np.column_stack((-np.sin(angle), np.cos(angle)))
    expected = across * alpha[:, None] - radial * omega[:, None] ** 2
    np.testing.assert_allclose(pen.acceleration, expected, atol=1e-7)
    np.testing.assert_allclose(run.measure("height"), np.sin(angle), atol=1e-8)
    np.testing.assert_allclose(run.measure("height", "rate"), np.cos(angle) * omega, atol=1e-8)
    np.testing.assert_allclose(run.measure("height", "acceleration"), expected[:, 1], atol=1e-7)
    without = pfaff.Scene.from_string(PENDULUM).simulate().body("bob")
    with pytest.raises(pfaff.InputError, match="`ax`"):
        without.acceleration  # noqa: B018


def test_what_is_not_unique_is_not_a_number() -> None:
    scene = pfaff.Scene.from_string(SLEIGH)
    run = scene.simulate()
    for name in ("left", "right"):
        # Along the blade there is no force under any load, but the direction of the blade changes.
        assert scene.analyze().verdicts[name].components["Fx"].unique
        assert np.isnan(run.reaction(name).force).all()
        assert np.isnan(run.reaction(name)["N"]).all()
        np.testing.assert_array_equal(run.reaction(name).torque, 0.0)
    kept = scene.simulate(choose="kept-rows")
    dropped = scene.simulate(choose=[1])
    for run in (kept, dropped):
        assert np.isfinite(run.reactions).all()
    # The sideways acceleration of a body that moves straight ahead and rotates is v·omega.
    sides = [run.reaction("left")["N"] + run.reaction("right")["N"] for run in (kept, dropped)]
    for side in sides:
        np.testing.assert_allclose(np.abs(side), 3.0 * 1.0 * 0.5, rtol=1e-6)
    np.testing.assert_array_equal(dropped.reaction("left")["N"], 0.0)
    none = scene.simulate(reactions=False)
    assert np.isnan(none.reactions).all()
    one = scene.simulate(reactions=["right"], choose="kept-rows")
    assert np.isnan(one.reaction("left").force).all()
    assert np.isfinite(one.reaction("right").force).all()


def test_choices_of_a_run(tmp_path: Path) -> None:
    scene = pfaff.Scene.from_string(SLEIGH)
    soft: Choice = {"left": 1e-6, "right": (3e-6, 1e-3)}
    asked: list[Choice] = ["minimum-norm", soft, [1], "minimum-norm:length=0.5"]
    run = scene.simulate(choose=asked)
    assert np.isnan(run.reaction("left")["N"]).all()
    names = [choice.name for choice in run.choices]
    assert names == [entry["name"] for entry in run.document["choice"]]
    assert names[0].startswith("minimum norm") and "`right` 3e-6 m/N" in names[1]
    left, right = (
        [choice.reaction(name)["N"] for choice in run.choices] for name in ("left", "right")
    )
    # Parallel springs share v·omega·m in proportion to their stiffness.
    for k, share in enumerate([1 / 2, 3 / 4, 0.0, 1 / 2]):
        np.testing.assert_allclose(np.abs(left[k]), share * 1.5, rtol=1e-6)
        np.testing.assert_allclose(np.abs(left[k] + right[k]), 1.5, rtol=1e-6)
        torque = run.choices[k].reaction("left").torque
        np.testing.assert_array_equal(torque, run.reaction("left").torque)
    at_end = scene.analyze(float(run.t[-1])).reactions({"left": 1e-6, "right": 3e-6})
    for name in ("Fx", "Fy"):
        own = run.choices[1].reaction("left")[name][-1]
        assert abs(own - at_end["left"][name]) < 1e-7
    # A single choice also determines the arrays of the run.
    alone = scene.simulate(choose=soft)
    np.testing.assert_array_equal(alone.reactions, run.choices[1].reactions)
    written = scene.simulate_into(tmp_path, choose=asked[:2])
    assert {"choice.csv", "choice_2.csv"} <= set(written["files"])
    table = np.genfromtxt(tmp_path / "choice_2.csv", delimiter=",", skip_header=1)
    np.testing.assert_array_equal(table[:, 1:], alone.reactions)
    wrong: list[Choice | Sequence[Choice]] = ["least", [soft, "kept-rows"], [[9]], {"lift": 1e-6}]
    for choose in wrong:
        with pytest.raises(pfaff.Error):
            scene.simulate(choose=choose)


def test_verdicts_of_a_run_are_those_of_its_stretch() -> None:
    """The cart of the book: y is across it at the start; later the force has x and y components."""
    cart = (
        pfaff.Scene("cart", space="plane")
        .body("cart", mass=10.0, inertia=1.0, velocity=[1.0, 0.0], angular_velocity=1.0)
        .joint("left", "knife-edge", "cart", at=[0.0, 0.5], normal=[0.0, 1.0])
        .joint("right", "knife-edge", "cart", at=[0.0, -0.5], normal=[0.0, 1.0])
        .group("both", combine="left + right")
        .group("side", combine="left.N + right.N")
        .group("wheels", members=["left", "right"])
    )
    analysis = cart.analyze()
    left = analysis.verdicts["left"]
    assert left.components["Fx"].unique
    assert left.components["Fx"].generic_verdict == "not_unique"
    assert left.generic_verdict == "not_unique"
    assert analysis.combine("left + right").components["Fx"].generic_verdict is None
    run = cart.simulate(3.0)
    for name in ("left", "right"):
        assert np.isnan(run.reaction(name).force).all()
        assert run.document["reactions"][name]["components"]["Fx"]["verdict"] == "not_unique"
        assert run.document["reactions"][name]["at_start"]["verdict"] == "not_unique"
    along = analysis.along(3.0)
    for name, found in along["reactions"].items():
        of_run = run.document["reactions"][name]
        assert found["verdict"] == of_run["verdict"] == "not_unique"
        for component, own in found["components"].items():
            assert own == {"verdict": of_run["components"][component]["verdict"]}
        assert found["components"]["Fx"]["verdict"] == "not_unique"
    for document in (run.document, along):
        special = {(s["time"], s["name"], s["component"], s["verdict"]) for s in document["special"]}
        assert {(0.0, "left", "Fx", "unique"), (0.0, "right", "Fx", "unique")} <= special
    # After a quarter turn, x is across the cart, so the force along y is zero.
    quarter = [s for s in along["special"] if (s["name"], s["component"]) == ("left", "Fy")]
    np.testing.assert_allclose([s["time"] for s in quarter], [math.pi / 2.0], atol=1e-6)
    # The sum is m·v·omega, to the left of the cart; it acts on the first body.
    both, angle = run.group("both"), run.body("cart").angle
    across = np.column_stack((-np.sin(angle), np.cos(angle)))
    force = np.column_stack((both["Fx"], both["Fy"]))
    sign = np.sign(force[0, 1])
    np.testing.assert_allclose(force, sign * 10.0 * across, atol=1e-5)
    side = run.group("side")
    np.testing.assert_allclose(np.abs(side[side.columns[0]]), 10.0, atol=1e-5)
    assert run.reaction_columns[-4:] == ["both.Fx", "both.Fy", "both.T", "side"]
    assert not run.document["groups"]["side"]["fragile"]
    assert run.document["groups"]["side"]["sensitivity"] < 0.1
    # A verdict on several joints has no value.
    assert run.document["groups"]["wheels"]["verdict"] == "not_unique"
    with pytest.raises(pfaff.InputError, match="there is no group with numbers `wheels`"):
        run.group("wheels")


def upright_cranks() -> pfaff.Scene:
    """Three upright equal cranks carry a coupler; one pivot is written as two guides."""
    scene = pfaff.Scene("three cranks", space="plane", gravity=[0.0, -10.0])
    names = ("one", "two", "three")
    for x, name in enumerate(names):
        scene = scene.body(
            f"crank {name}",
            mass=1.0,
            inertia=0.02,
            position=[float(x), 0.25],
            angle=math.pi / 2.0,
            velocity=[-0.5, 0.0],
            angular_velocity=2.0,
        )
    scene = scene.body("coupler", mass=3.0, inertia=1.0, position=[1.0, 0.5], velocity=[-1.0, 0.0])
    for x, name in enumerate(names):
        crank = f"crank {name}"
        scene = scene.joint(f"tip {name}", "revolute", [crank, "coupler"], at=[float(x), 0.5])
        if name != "two":
            scene = scene.joint(f"pivot {name}", "revolute", ["ground", crank], at=[float(x), 0.0])
    for name, line in (("x", [[1.0, -1.0], [1.0, 1.0]]), ("y", [[0.0, 0.0], [2.0, 0.0]])):
        guide = {"at": [1.0, 0.0], "line": line}
        scene = scene.joint(f"guide-{name}", "point-on-line", "crank two", **guide)
    return scene


def test_what_is_unique_at_the_start_only_has_no_number() -> None:
    scene = upright_cranks()
    start = scene.analyze().verdicts["guide-x"]
    assert start.unique and start.components["Fx"].unique
    run = scene.simulate(0.4)
    assert np.isnan(run.reaction("guide-x")["Fx"]).all()
    assert run.document["reactions"]["guide-x"]["verdict"] == "not_unique"
    assert run.document["reactions"]["guide-x"]["at_start"]["verdict"] == "unique"
    special = [s for s in run.document["special"] if s["name"] == "guide-x"]
    assert [(s["time"], s["verdict"]) for s in special if s["component"] == "Fx"] == [(0.0, "unique")]
    # The motion is the same for two choices, but the value differs: it depends on the choice.
    runs = [scene.simulate(0.4, choose=rows) for rows in scene.analyze().eliminations()["sets"]]
    ends = [run.reaction("guide-x")["Fx"][-1] for run in runs]
    assert len(runs) > 1 and np.ptp(ends) > 10.0
    for other in runs:
        np.testing.assert_allclose(other.trajectory, runs[0].trajectory, atol=1e-6)
        np.testing.assert_array_equal(np.isnan(other.reaction("guide-x")["Fx"]), False)


def test_an_impulse_has_verdicts() -> None:
    """A wheel of 2 kg and 0.3 kg·m², 0.5 m off its pin, at 2 rad/s and from 1 s on at -1 rad/s."""
    both: dict[str, Any] = {"bodies": ["ground", "wheel"], "at": [0.0, 0.0]}
    motion = {"type": "linear-table", "times": [0.0, 1.0, 3.0], "values": [0.0, 2.0, 0.0]}
    wheel = (
        pfaff.Scene("wheel", space="plane")
        .body("wheel", mass=2.0, inertia=0.3, position=[0.5, 0.0])
        .joint("pin", "revolute", **both)
        .drive("motor", joint="pin", type="angle", motion=motion)
    )
    told: list[pfaff.Event] = []
    run = wheel.simulate(2.0, on_event=told.append)
    assert told == run.events
    [impulses] = [event.impulses for event in run.events if event.kind == "impulse"]
    pin, motor = (impulses[name]["components"] for name in ("pin", "motor"))
    np.testing.assert_allclose(pin["Fx"]["value"], -3.0 * math.sin(2.0))
    np.testing.assert_allclose(pin["Fy"]["value"], 3.0 * math.cos(2.0))
    assert motor["drive"]["verdict"] == "unique"
    np.testing.assert_allclose(motor["drive"]["value"], 3.0 * (0.3 + 2.0 * 0.5**2))
    # Two coincident pins share the impulse in an undetermined way.
    run = wheel.joint("other", "revolute", **both).simulate(2.0)
    [impulses] = [event.impulses for event in run.events if event.kind == "impulse"]
    for name in ("pin", "other"):
        for component in impulses[name]["components"].values():
            assert (component["value"], component["verdict"]) == (None, "not_unique")
    assert impulses["motor"]["components"]["T"]["verdict"] == "unique"


def test_arrays_are_made_once_and_stay() -> None:
    run = pfaff.Scene.from_string(PENDULUM).simulate()
    body = run.body("bob")
    assert run.body("bob").position.base is not None
    assert np.shares_memory(body.position, run.trajectory)
    assert np.shares_memory(run.reaction("pivot").force, run.reactions)
    assert np.shares_memory(body.position, run.body("bob").position)
    position, force, t = body.position, run.reaction("pivot").force, run.t
    copies = [array.copy() for array in (position, force, t)]
    del run, body
    gc.collect()
    waste = [np.full(10_000, float(k)) for k in range(100)]
    for array, copy in zip((position, force, t), copies, strict=True):
        np.testing.assert_array_equal(array, copy)
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
    assert len(waste) == 100


def test_events_are_told_on_the_way() -> None:
    scene = pfaff.Scene.from_file(ROOT / "examples" / "slider-crank.toml")
    told: list[pfaff.Event] = []
    run = scene.simulate(on_event=told.append)
    assert told == run.events
    many = pfaff.Scene.from_file(ROOT / "crates" / "robot-trolley" / "robot-trolley.toml")
    told.clear()
    whole = many.simulate(on_event=told.append)
    assert told == whole.events


def test_a_callback_ends_the_run() -> None:
    scene = pfaff.Scene.from_string(PENDULUM)
    whole = scene.simulate()
    run = scene.simulate(on_row=lambda t: t >= 0.5)
    assert run.partial and not whole.partial
    assert run.t[-1] == 0.5
    np.testing.assert_array_equal(run.trajectory, whole.trajectory[: len(run)])


def test_an_exception_of_a_callback_is_raised() -> None:
    class Own(Exception):
        pass

    def fails(_: float) -> None:
        raise Own("here")

    with pytest.raises(Own, match="here"):
        pfaff.Scene.from_string(PENDULUM).simulate(on_row=fails)


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_ends_a_long_run() -> None:
    scene = pfaff.Scene.from_string(PENDULUM)
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        scene.simulate(1e6, rtol=1e-12, output_step=1e5)
    assert time.monotonic() - begun < 5.0
    assert len(scene.simulate()) > 1


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_ctrl_c_ends_a_run_of_several_components() -> None:
    two = pfaff.Scene("two", gravity=[0.0, -9.81])
    for k in range(2):
        name = f"bob{k}"
        two = two.body(name, mass=1.0, inertia=0.1, position=[1.0 + k, 0.0])
        two = two.joint(f"pivot{k}", "revolute", ["ground", name], at=[0.0, 0.0])
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        two.simulate(1e6, rtol=1e-12, output_step=1.0)
    assert time.monotonic() - begun < 5.0


LONG: dict[str, Callable[[pfaff.Scene], object]] = {
    "samples": lambda scene: scene.tolerance(100_000, tolerance=1e-3),
    "samples by one thread": lambda scene: scene.tolerance(100_000, tolerance=1e-3, threads=1),
    "work and precision": lambda scene: scene.work_precision(all=True),
    "a late time": lambda scene: scene.analyze(1e7),
    "small motions at a late time": lambda scene: scene.linearise(1e7),
    "verdicts along a long motion": lambda scene: scene.analyze().along(1e7),
}


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
@pytest.mark.parametrize("call", LONG.values(), ids=LONG.keys())
def test_ctrl_c_ends_other_long_work(call: Callable[[pfaff.Scene], object]) -> None:
    robot = pfaff.Scene.from_file(ROOT / "crates" / "robot-trolley" / "robot-trolley.toml")
    assert len(robot.joints) == 14
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        call(robot)
    assert time.monotonic() - begun < 5.0
    # No computation continues: the processors are soon idle.
    time.sleep(1.0)
    used = time.process_time()
    time.sleep(0.5)
    assert time.process_time() - used < 0.25


def test_samples_of_a_beam() -> None:
    """A beam on a hinge and a roller: the roller carries m·g·a/l; a and l have tolerances."""
    beam = (
        pfaff.Scene("beam", gravity=[0.0, -10.0], tolerance=1e-3)
        .body("beam", mass=2.0, inertia=1.0, position=[1.0, 0.0])
        .joint("hinge", "revolute", ["ground", "beam"], at=[0.0, 0.0])
        .joint("roller", "pin-in-slot", ["ground", "beam"], at=[2.0, 0.0], axis=[1, 0])
        .add("marker", name="tip", body="beam", point=[1.0, 0.0])
    )
    samples = beam.tolerance(200, seed=3)
    assert len(samples) == 200 and "200" in repr(samples)
    load = samples["roller.Fy"]
    # The force on the ground acts downwards. The hinge may be 2 mm nearer, and so may the slot.
    assert np.isfinite(load).all() and 0.0 < np.ptp(load) < 10.0 * 4.0 * 2e-3
    np.testing.assert_allclose(load, -10.0, atol=4e-2)
    np.testing.assert_allclose(load + samples["hinge.Fy"], -20.0, rtol=1e-9)
    assert np.hypot(samples["tip.x"] - 2.0, samples["tip.y"]).max() < 5e-3
    assert set(samples["status"]) == {"done"} and samples["sample"].tolist() == list(range(1, 201))
    range_ = samples.reactions["roller"]["values"][0]["range"]
    assert range_["described"] == pytest.approx(10.0) and range_["samples"] == 200
    again = beam.tolerance(200, seed=3, threads=1)
    np.testing.assert_array_equal(again["roller.Fy"], load)
    assert (beam.tolerance(200, seed=4)["roller.Fy"] != load).all()
    with pytest.raises(pfaff.InputError, match="did you mean `roller.Fy`"):
        _ = samples["roler.Fy"]
    with pytest.raises(ValueError, match="read-only"):
        load[0] = 1.0
    varied = beam.tolerance(200, vary={"body.beam.mass": "±0.5"})
    mass = 2.0 + 0.5 * varied["varied.body.beam.mass"]
    np.testing.assert_allclose(varied["roller.Fy"] + varied["hinge.Fy"], -10.0 * mass, rtol=1e-9)
    frame, table = samples.to_polars(), samples.to_pandas()
    assert frame.columns == samples.columns and list(table.columns) == samples.columns[1:]
    np.testing.assert_array_equal(table["roller.Fy"], load)


def test_error_against_run_time() -> None:
    found = pfaff.Scene.from_string(PENDULUM).work_precision(quick=True)
    assert found.automatic in found.methods and len(found.methods) >= 4
    assert found.document["provenance"]["command"] == "called from Python" and found.summary
    for method in found.methods:
        curve = found.curve(method)
        np.testing.assert_array_equal(curve.tolerance, [1e-4, 1e-7, 1e-10])
        assert (curve.seconds > 0.0).all() and (np.diff(curve.error) < 0.0).all()
        assert (np.diff(curve.evaluations) > 0.0).all() and curve.error[-1] < 1e-7
    assert 0.0 <= found.reference_limit < 1e-9
    for stabilisation in set(found.table["stabilisation"]):
        assert len(found.curve("dop853", stabilisation).error) == 3
    with pytest.raises(pfaff.InputError, match="did you mean `radau5`"):
        found.curve("radau")


def test_other_threads_go_on() -> None:
    """During two runs and a counter, the interpreter is not blocked."""
    scene = pfaff.Scene.from_string(PENDULUM)
    found: list[np.ndarray] = []
    ends = threading.Event()

    def go() -> None:
        found.append(scene.simulate(300.0, rtol=1e-9).trajectory)

    threads = [threading.Thread(target=go) for _ in range(2)]
    counted = 0

    def count() -> None:
        nonlocal counted
        while not ends.is_set():
            counted += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    for thread in (*threads, counter):
        thread.start()
    for thread in threads:
        thread.join()
    ends.set()
    counter.join()
    assert counted > 5
    np.testing.assert_array_equal(found[0], found[1])


def test_a_run_that_stops_keeps_its_rows() -> None:
    with pytest.raises(pfaff.ComputationError) as raised:
        pfaff.Scene.from_string(PENDULUM).simulate(10.0, max_steps=20)
    error = raised.value
    assert error.code is not None and error.run is not None
    assert error.run.partial
    assert 1 < len(error.run) < 2001
    assert error.run.document["code"] == error.code


def test_tables() -> None:
    run = pfaff.Scene.from_file(ROOT / "examples" / "slider-crank.toml").simulate()
    table = run.to_pandas()
    assert list(table.columns) == run.columns + run.reaction_columns
    np.testing.assert_array_equal(table.index, run.t)
    frame = run.to_polars()
    assert frame.columns == ["t", *run.columns, *run.reaction_columns]
    assert frame.shape[0] == len(run)


def test_pages(tmp_path: Path) -> None:
    scene = pfaff.Scene.from_string(SLEIGH)
    run = scene.simulate(1.0)
    run.report(tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert page.lower().startswith("<!doctype html>") and "sleigh" in page
    assert "t = 1" in page or "1 s" in page
    assert "interrupted" not in page
    # The repeated run ends at the same time as the run, which a callback or an error has ended.
    scene.simulate(1.0, on_row=lambda t: t >= 0.5).report(tmp_path / "part.html")
    part = (tmp_path / "part.html").read_text(encoding="utf-8")
    assert "interrupted" in part and len(part) < len(page)
    with pytest.raises(pfaff.ComputationError) as raised:
        scene.simulate(10.0, max_steps=3)
    assert raised.value.run is not None and raised.value.code is not None
    raised.value.run.report(tmp_path / "stopped.html")
    assert "3 steps ended" in (tmp_path / "stopped.html").read_text(encoding="utf-8")
    with pytest.raises(pfaff.ComputationError):
        scene.report(tmp_path / "own.html", t_end=10.0, max_steps=3)
    assert (tmp_path / "own.html").exists()
    table = scene.analyze()._repr_html_()
    assert "<td>left</td>" in table and "not unique" in table


def test_names_that_do_not_exist() -> None:
    run = pfaff.Scene.from_string(PENDULUM).simulate()
    with pytest.raises(pfaff.InputError, match="no body `bop`.*did you mean `bob`"):
        run.body("bop")
    with pytest.raises(pfaff.InputError, match="did you mean `pivot`"):
        run.reaction("pivott")
    with pytest.raises(pfaff.InputError, match="no number of `bob` `z`|no number of `bob` `qw`"):
        _ = run.body("bob").orientation
    with pytest.raises(pfaff.InputError, match="no column"):
        run.plot("bob.xx")


def test_matrices_of_a_pendulum() -> None:
    scene = pfaff.Scene.from_string(PENDULUM)
    matrices = scene.matrices()
    # The pivot is at (−1, 0) of the body: its velocity is (vx, vy − ω), whatever the sign of the
    # rows.
    rows = matrices.C * np.sign(matrices.C[:, :2].sum(axis=1))[:, None]
    np.testing.assert_allclose(rows, [[1.0, 0.0, 0.0], [0.0, 1.0, -1.0]], atol=1e-15)
    np.testing.assert_array_equal(matrices.M, np.diag([1.0, 1.0, 0.1]))
    np.testing.assert_allclose(matrices.Q, [0.0, -9.81, 0.0])
    np.testing.assert_array_equal(matrices.b, 0.0)
    np.testing.assert_allclose(matrices.Phi, 0.0, atol=1e-15)
    np.testing.assert_array_equal(matrices.Gamma, 0.0)
    turning = scene.matrices(q=[1.0, 0.0, 0.0], v=[0.0, 2.0, 2.0])
    # The force points towards the pivot, with ω²·l.
    assert abs(turning.Gamma).max() == pytest.approx(4.0)
    saddle = np.block([[turning.M, turning.C.T], [turning.C, np.zeros((2, 2))]])
    a = np.linalg.solve(saddle, np.concatenate((turning.Q, turning.Gamma)))[:3]
    np.testing.assert_allclose(a, [-4.0, -9.81 / 1.1, -9.81 / 1.1])


def test_small_motions_of_a_pendulum() -> None:
    hanging = PENDULUM.replace("position = [1.0, 0.0]", "position = [0.0, -1.0]")
    found = pfaff.Scene.from_string(hanging).linearise()
    rate = math.sqrt(9.81 / 1.1)
    assert found.A.shape == (2, 2) and found.B.shape == (2, len(found.inputs))
    np.testing.assert_allclose(np.sort(np.linalg.eigvals(found.A).imag), [-rate, rate], rtol=1e-7)
    assert abs(found.eigenvalues[0].imag) == pytest.approx(rate, rel=1e-7)
    assert found.second_order is not None


def test_a_run_in_a_child_process() -> None:
    """The process starts after a run in the parent, whose threads do not exist in the child."""
    pfaff.Scene.from_string(PENDULUM).simulate()
    code = "import pickle, sys, pfaff; scene = pickle.loads(sys.stdin.buffer.read()); print(len(scene.simulate()))"
    text = pickle.dumps(pfaff.Scene.from_string(PENDULUM))
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], input=text, capture_output=True, check=True)
    assert int(done.stdout) == 201


def test_plots() -> None:
    import matplotlib
    from matplotlib import pyplot

    matplotlib.use("agg")
    run = pfaff.Scene.from_string(PENDULUM).simulate()
    axes = run.plot()
    assert [line.get_label() for line in axes.lines] == ["bob.x", "bob.y"]
    axes = run.plot("pivot.Fx")
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), run.reaction("pivot").force[:, 0])
    samples = pfaff.Scene.from_string(PENDULUM).tolerance(50, tolerance=1e-3)
    axes = samples.plot("pivot.Fy", bins=10)
    assert sum(bar.get_height() for bar in axes.patches) == 50
    axes = pfaff.Scene.from_string(PENDULUM).work_precision(quick=True).plot("dop853", "radau5")
    assert [line.get_label() for line in axes.lines] == ["dop853", "radau5"]
    pyplot.close("all")


def test_bounds_contain_every_sharing() -> None:
    """Each of two wheels carries up to the whole force; within a factor of 3, a quarter of it."""
    cart = pfaff.Scene.from_string(
        """
        scene = { name = "cart", space = "plane" }
        body = [{ name = "cart", mass = 10.0, inertia = 1.0, velocity = [1.0, 0.0], angular_velocity = 0.5 }]
        joint = [
            { name = "left", type = "knife-edge", body = "cart", at = [0.0, 0.5], normal = [0.0, 1.0] },
            { name = "right", type = "knife-edge", body = "cart", at = [0.0, -0.5], normal = [0.0, 1.0] },
        ]
        simulate = { t_end = 1.0 }
        """
    )
    assert cart.simulate().lowest is None
    for bounds, ends in (
        (True, (0.0, 5.0)),
        ({"within": 3}, (1.25, 3.75)),
        ({"within": 3, "compliance": {"left": 1e-6, "right": 3e-6}}, (0.5 * 5.0, 0.9 * 5.0)),
        ({"rigid": ["left"]}, (5.0, 5.0)),
    ):
        run = cart.simulate(bounds=bounds)
        assert run.lowest is not None and run.highest is not None
        for of, end in zip((run.lowest, run.highest), ends, strict=True):
            np.testing.assert_allclose(of.reaction("left")["N"], end, atol=1e-7)
        most = run.document["reactions"]["left"].get("magnitude_at_most")
        assert most is None or math.isclose(most["force"]["value"], ends[1], abs_tol=1e-7)
    wrong: Any
    for wrong, words in (
        (3, "a dictionary"),
        ({"rigit": []}, "did you mean `rigid`?"),
        ({"within": 0.5}, "need a ratio"),
        ({"rigid": ["lefd"]}, "`lefd`"),
    ):
        with pytest.raises((pfaff.InputError, TypeError), match=words):
            cart.simulate(bounds=wrong)


def test_a_misfit_is_a_preload() -> None:
    """A leg that is too long by h: legs of equal compliance c have the self-stress h/(4·c)."""
    table = pfaff.Scene.from_file(ROOT / "examples" / "table.toml")
    soft = dict.fromkeys("ABCD", 1e-6)
    fits = table.analyze().reactions(soft)
    long = table.analyze().reactions(soft, misfits={"C": [0.0, 0.0, -1e-5]})
    for name, sign in zip("ABCD", (-1.0, 1.0, -1.0, 1.0), strict=True):
        assert math.isclose(long[name]["Fz"] - fits[name]["Fz"], sign * 2.5, abs_tol=1e-9)


def test_loads_of_springs_are_those_by_hand() -> None:
    """A mass on a spring: the tension is k·(l − l0) at the length that the run has."""
    scene = pfaff.Scene("hanging", gravity=[0.0, -10.0])
    scene = scene.body("bob", mass=2.0, inertia=1.0, position=[0.0, -1.0])
    scene = scene.force(
        "spring",
        "spring-damper",
        bodies=["bob", "ground"],
        points={"bob": [0.0, 0.0], "ground": [0.0, 0.0]},
        stiffness=50.0,
        damping=0.0,
        free_length=0.8,
    )
    run = scene.simulate(t_end=1.0)
    assert run.forces == ["spring"]
    load = run.load("spring")
    y = run.body("bob").position[:, 1]
    np.testing.assert_allclose(load.length, -y, atol=1e-12)
    np.testing.assert_allclose(load.force[:, 1], 50.0 * (-y - 0.8), atol=1e-9)
    np.testing.assert_allclose(load.rate, -run.body("bob").velocity[:, 1], atol=1e-12)
    assert not load.torque.any()
    assert not run.loads.flags.writeable
    assert "spring.Fy" in run.to_pandas().columns
    peak = run.document["loads"]["spring"]["peak"]["force"]
    assert peak["value"] == np.abs(load.force[:, 1]).max()
    with pytest.raises(pfaff.InputError, match="did you mean `spring`"):
        run.load("sprung")
