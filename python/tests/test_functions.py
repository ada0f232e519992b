"""Python functions as laws of drives and as forces on bodies: closed forms and rejected input."""

from __future__ import annotations

import gc
import math
import os
import re
import signal
import sys
import threading
import time
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pfaff

MASS, STIFFNESS, DAMPING, SPEED = 2.0, 50.0, 1.2, 1.5

OSCILLATOR = """
scene = { name = "oscillator", space = "plane" }
body = [{ name = "mass", mass = 2.0, inertia = 0.1, velocity = [1.5, 0.0] }]
joint = [{ name = "guide", type = "translational", bodies = ["ground", "mass"], at = [0.0, 0.0], axis = [1.0, 0.0] }]
drive = [{ name = "motor", joint = "guide", type = "displacement", force = 0 }]
simulate = { t_end = 2.0, rtol = 1e-11, atol = 1e-13 }
"""

WHEEL = """
scene = { name = "wheel", space = "plane", gravity = [0.0, -9.81] }
body = [{ name = "wheel", mass = 1.0, inertia = 0.4 }]
joint = [{ name = "shaft", type = "revolute", bodies = ["ground", "wheel"], at = [0.0, 0.0] }]
drive = [{ name = "motor", joint = "shaft", type = "angle", torque = 0 }]
simulate = { t_end = 1.0, rtol = 1e-11, atol = 1e-13 }
"""


def spring(t: float, x: float, v: float) -> float:
    return -STIFFNESS * x - DAMPING * v


def oscillator() -> pfaff.Scene:
    return pfaff.Scene.from_string(OSCILLATOR)


def wheel() -> pfaff.Scene:
    return pfaff.Scene.from_string(WHEEL)


@pytest.mark.parametrize("method", [None, "dop853", "dopri5", "tsit5"])
def test_a_controlled_slider_is_a_linear_oscillator(method: str | None) -> None:
    run = oscillator().simulate(method=method, drives={"motor": spring})
    decay = DAMPING / (2.0 * MASS)
    omega = math.sqrt(STIFFNESS / MASS - decay**2)
    x = SPEED / omega * np.exp(-decay * run.t) * np.sin(omega * run.t)
    np.testing.assert_allclose(run.body("mass").position[:, 0], x, atol=1e-8)
    v = run.body("mass").velocity[:, 0]
    np.testing.assert_allclose(run.measure("motor"), -STIFFNESS * x - DAMPING * v, atol=1e-6)


def test_a_controlled_pendulum_is_held() -> None:
    """The motor cancels gravity; a critically damped PD controller ends at 0.5 rad."""
    inertia, arm, mass, g, aim = 0.1 + 1.0, 1.0, 1.0, 9.81, 0.5
    gain = 44.0
    damping = 2.0 * math.sqrt(gain * inertia)
    scene = (
        pfaff.Scene("arm", gravity=[0.0, -g])
        .body("arm", mass=mass, inertia=0.1, position=[1.0, 0.0])
        .joint("shoulder", "revolute", ["ground", "arm"], at=[0.0, 0.0])
        .drive("motor", joint="shoulder", type="angle", torque=0)
    )

    def motor(t: float, angle: float, rate: float) -> float:
        return gain * (aim - angle) - damping * rate + mass * g * arm * math.cos(angle)

    run = scene.simulate(3.0, rtol=1e-11, atol=1e-13, drives={"motor": motor})
    p = math.sqrt(gain / inertia)
    angle = aim - aim * (1.0 + p * run.t) * np.exp(-p * run.t)
    np.testing.assert_allclose(run.body("arm").angle, angle, atol=1e-8)


def test_a_function_moves_as_the_same_text() -> None:
    text = OSCILLATOR.replace("force = 0", 'force = "-50*measure - 1.2*rate"')
    written = pfaff.Scene.from_string(text).simulate(method="dop853")
    called = oscillator().simulate(method="dop853", drives={"motor": spring})
    np.testing.assert_allclose(called.trajectory, written.trajectory, rtol=0, atol=1e-13)
    np.testing.assert_allclose(called.reactions, written.reactions, rtol=0, atol=1e-13)
    again = oscillator().simulate(method="dop853", drives={"motor": spring})
    np.testing.assert_array_equal(again.trajectory, called.trajectory)
    # The scene has not changed.
    still = oscillator().simulate()
    np.testing.assert_allclose(still.body("mass").velocity[:, 0], SPEED)


def test_a_function_of_time_and_numbers_of_numpy() -> None:
    found: set[type] = set()

    def torque(t: float, angle: float, rate: float) -> Any:
        found.update(type(x) for x in (t, angle, rate))
        kinds: list[Callable[[float], object]] = [float, np.float64, np.float32, np.asarray]
        return kinds[int(1e9 * t) % 4](0.75)

    run = wheel().simulate(drives={"motor": torque})
    np.testing.assert_allclose(run.body("wheel").angular_velocity, 0.75 / 0.4 * run.t, atol=1e-9)
    assert found == {float}
    whole = wheel().simulate(drives={"motor": lambda t, angle, rate: 2})
    np.testing.assert_allclose(whole.body("wheel").angular_velocity, 5.0 * whole.t, atol=1e-9)


def test_the_measure_is_that_of_the_drive() -> None:
    """The function receives the angle of the bodies, not the change since the start."""
    scene = (
        pfaff.Scene("wheel")
        .body("wheel", mass=1.0, inertia=0.4, angle=0.7, angular_velocity=2.0)
        .joint("shaft", "revolute", ["ground", "wheel"], at=[0.0, 0.0])
        .drive("motor", joint="shaft", type="angle", torque=0)
    )
    angles: list[float] = []

    def torque(t: float, angle: float, rate: float) -> float:
        angles.append(angle)
        return 0.0

    scene.simulate(0.1, drives={"motor": torque})
    assert angles[0] == pytest.approx(0.7)


def test_a_body_is_pushed_in_the_plane() -> None:
    """Wind acts on a puck, and a torque acts against its rotation."""
    drag, wind, mass, inertia, spin = 0.5, 3.0, 2.0, 0.1, 4.0
    scene = pfaff.Scene("puck").body("puck", mass=mass, inertia=inertia, angular_velocity=spin)
    seen: list[pfaff.BodyState] = []

    def push(t: float, body: pfaff.BodyState) -> list[float]:
        seen.append(body)
        vx, vy = body.velocity
        return [drag * (wind - vx), -drag * vy, -0.02 * body.angular_velocity]

    run = scene.simulate(2.0, rtol=1e-11, atol=1e-13, forces={"puck": push})
    body = run.body("puck")
    np.testing.assert_allclose(
        body.velocity[:, 0], wind * (1.0 - np.exp(-drag / mass * run.t)), atol=1e-8
    )
    np.testing.assert_allclose(body.velocity[:, 1], 0.0, atol=1e-12)
    turn = np.exp(-0.02 / inertia * run.t)
    np.testing.assert_allclose(body.angular_velocity, spin * turn, atol=1e-8)
    state = seen[-1]
    assert state.position.shape == (2,) and state.rotation.shape == (2, 2)
    cos, sin = math.cos(state.angle), math.sin(state.angle)
    np.testing.assert_allclose(state.rotation, [[cos, -sin], [sin, cos]], atol=1e-12)


def test_a_body_is_pushed_in_space() -> None:
    """A force and a torque along one axis act on a block that is rotated by 90° about x."""
    half = math.sqrt(0.5)
    scene = pfaff.Scene("block", space="spatial").body(
        "block", mass=2.0, inertia=[0.5, 0.8, 0.6], orientation={"quaternion": [half, half, 0.0, 0.0]}
    )

    def push(t: float, body: pfaff.BodyState) -> np.ndarray:
        assert body.position.shape == body.velocity.shape == body.angular_velocity.shape == (3,)
        # The y-axis of the block points upwards.
        np.testing.assert_allclose(body.rotation[:, 1], [0.0, 0.0, 1.0], atol=1e-9)
        assert math.isnan(body.angle)
        return np.array([1.0, 0.0, -3.0, 0.0, 0.0, 0.4])

    run = scene.simulate(1.5, rtol=1e-11, atol=1e-13, forces={"block": push})
    body = run.body("block")
    square = 0.5 * run.t**2
    np.testing.assert_allclose(body.position, np.outer(square, [0.5, 0.0, -1.5]), atol=1e-9)
    spin = np.outer(run.t, [0.0, 0.0, 0.4 / 0.8])
    np.testing.assert_allclose(body.angular_velocity, spin, atol=1e-9)


def test_what_is_no_drive_or_body_is_refused_by_name() -> None:
    scene = wheel()
    with pytest.raises(pfaff.InputError, match="no drive by a law `moter`.*did you mean `motor`") as raised:
        scene.simulate(drives={"moter": spring})
    assert raised.value.code is not None
    free = pfaff.Scene("puck").body("puck", mass=1.0, inertia=0.1)
    with pytest.raises(pfaff.InputError, match="`motor`: the scene has no drive by a law; add one"):
        free.simulate(1.0, drives={"motor": spring})
    with pytest.raises(pfaff.InputError, match="no body `weel`.*did you mean `wheel`"):
        scene.simulate(forces={"weel": lambda t, body: [0.0, 0.0, 0.0]})
    given: Any = 3.0
    with pytest.raises(pfaff.InputError, match=r"drives\['motor'\] is `float`, need a function"):
        scene.simulate(drives={"motor": given})
    with pytest.raises(pfaff.InputError, match=r"forces\['wheel'\] is `float`, need a function"):
        scene.simulate(forces={"wheel": given})
    moved = pfaff.Scene.from_string(WHEEL.replace("torque = 0", 'motion = { type = "polynomial", coefficients = [0.0, 1.0] }'))
    message = "drive `motor` prescribes a motion.*write `torque = 0` in place of its `motion`"
    with pytest.raises(pfaff.InputError, match=message):
        moved.simulate(drives={"motor": spring})


def test_methods_with_derivatives_refuse_by_name() -> None:
    with pytest.raises(pfaff.InputError, match="radau5.*drive `motor` calls a function.*dop853") as raised:
        oscillator().simulate(method="radau5", drives={"motor": spring})
    assert raised.value.code == "P0427"
    document = oscillator().simulate(drives={"motor": spring}).document
    assert document["method"] == "dop853"


@pytest.mark.parametrize(
    ("returned", "words"),
    [
        (math.nan, "returned NaN"),
        (-math.inf, "returned -inf"),
        (None, "returned None, need one number"),
        ("1.0", "returned `str`, need one number"),
        ([1.0], "returned `list`, need one number"),
        (np.array([1.0]), r"returned an array of shape \(1,\), need one number"),
        (np.zeros((2, 3)), r"returned an array of shape \(2, 3\), need one number"),
        (1j, "returned `complex`, need one number"),
    ],
)
def test_what_is_no_number_stops_the_run_by_name(returned: Any, words: str) -> None:
    with pytest.raises(pfaff.ComputationError, match=words) as raised:
        wheel().simulate(drives={"motor": lambda t, x, v: 1.0 if t <= 0.5 else returned})
    error = raised.value
    text = str(error)
    assert error.code == "P0426" and "drive `motor`" in text
    at = re.search(r"at t = ([0-9.]+) s", text)
    assert at is not None and 0.5 <= float(at[1]) < 1.0, text
    assert "measure = " in text and "rate = " in text
    # The rows before this time exist.
    assert error.run is not None and error.run.partial
    assert 0.0 < error.run.t[-1] <= 0.5
    np.testing.assert_allclose(error.run.body("wheel").angular_velocity, 2.5 * error.run.t, atol=1e-9)


@pytest.mark.parametrize(
    ("returned", "words"),
    [
        ([1.0, 2.0], r"an array of shape \(2,\), need 3 numbers: a force, 2, and a torque"),
        (np.zeros((3, 1)), r"an array of shape \(3, 1\)"),
        (1.0, r"an array of shape \(\)"),
        (None, "None, need 3 numbers|an array of shape"),
        ([0.0, math.nan, 0.0], "the force .*NaN"),
        ("abc", "need 3 numbers"),
    ],
)
def test_what_is_no_force_stops_the_run_by_name(returned: Any, words: str) -> None:
    with pytest.raises(pfaff.ComputationError, match=words) as raised:
        wheel().simulate(forces={"wheel": lambda t, body: [0.0, 0.0, 1.0] if t <= 0.5 else returned})
    assert raised.value.code == "P0426" and "push on wheel" in str(raised.value)


class Own(Exception):
    """An exception of the caller."""


def test_an_exception_ends_the_run_and_is_raised() -> None:
    calls = 0

    def fails(t: float, x: float, v: float) -> float:
        nonlocal calls
        if t > 0.5:
            calls += 1
            raise Own("no sensor")
        return 1.0

    with pytest.raises(Own, match="no sensor") as raised:
        wheel().simulate(drives={"motor": fails})
    assert calls == 1
    if sys.version_info >= (3, 11):
        (note,) = raised.value.__notes__
        assert note.startswith("in the function of drive `motor` at t = 0.")
    traceback = raised.traceback[-1]
    assert traceback.name == "fails"

    def also(t: float, body: pfaff.BodyState) -> list[float]:
        raise Own("at once")

    with pytest.raises(Own, match="at once"):
        wheel().simulate(forces={"wheel": also})
    with pytest.raises(TypeError, match="positional argument"):
        wheel().simulate(drives={"motor": lambda t: 1.0})  # type: ignore[dict-item, misc]


def test_functions_are_not_called_after_the_run() -> None:
    calls = 0

    class Motor:
        def __call__(self, t: float, x: float, v: float) -> float:
            nonlocal calls
            calls += 1
            return 1.0

    motor = Motor()
    threads = {threading.get_ident()}

    def push(t: float, body: pfaff.BodyState) -> list[float]:
        threads.add(threading.get_ident())
        return [0.0, 0.0, 0.0]

    run = wheel().simulate(drives={"motor": motor}, forces={"wheel": push})
    made = calls
    assert made > 10 and threads == {threading.get_ident()}
    run.to_pandas()
    _ = (run.body("wheel").position, run.reaction("shaft").force, run.document, repr(run))
    gc.collect()
    assert calls == made
    # Only the run refers to its functions, because its page needs them.
    known = weakref.ref(motor)
    del run, motor
    gc.collect()
    assert known() is None
    # A callback ends the run without an error.
    part = wheel().simulate(drives={"motor": lambda t, x, v: 1.0}, on_row=lambda t: t >= 0.5)
    assert part.partial and part.t[-1] == 0.5


def test_several_functions_have_one_clock() -> None:
    """Two wheels without connection are moved together: one thread calls their functions."""
    scene = pfaff.Scene("two")
    for k in range(2):
        scene = scene.body(f"wheel{k}", mass=1.0, inertia=0.4, position=[float(k), 0.0])
        scene = scene.joint(f"shaft{k}", "revolute", ["ground", f"wheel{k}"], at=[float(k), 0.0])
        scene = scene.drive(f"motor{k}", joint=f"shaft{k}", type="angle", torque=0)
    log: list[tuple[str, float]] = []

    def motor(name: str) -> Callable[[float, float, float], float]:
        def torque(t: float, angle: float, rate: float) -> float:
            log.append((name, t))
            return math.sin(t) - rate

        return torque

    runs = []
    for _ in range(2):
        log.clear()
        runs.append(scene.simulate(1.0, drives={f"motor{k}": motor(f"motor{k}") for k in range(2)}))
        runs[-1].document.setdefault("log", list(log))
    assert runs[0].document["log"] == runs[1].document["log"]
    times = [t for name, t in runs[0].document["log"] if name == "motor0"]
    assert times == [t for name, t in runs[0].document["log"] if name == "motor1"]
    np.testing.assert_array_equal(runs[0].trajectory, runs[1].trajectory)


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
@pytest.mark.parametrize("seconds", [0.0, 0.3], ids=["in a short call", "in a long call"])
def test_ctrl_c_is_heard(seconds: float) -> None:
    def motor(t: float, angle: float, rate: float) -> float:
        if seconds:
            time.sleep(seconds)
        return math.sin(t)

    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        wheel().simulate(1e6, output_step=1e5, drives={"motor": motor})
    assert time.monotonic() - begun < 5.0


def test_other_threads_go_on() -> None:
    """During a run with a function, another run and a counter make progress."""
    found: list[np.ndarray] = []

    def go() -> None:
        found.append(wheel().simulate(20.0, drives={"motor": lambda t, x, v: math.sin(t) - v}).q)

    threads = [threading.Thread(target=go) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    np.testing.assert_array_equal(found[0], found[1])


def test_pages_and_tables_call_the_functions_again(tmp_path: Path) -> None:
    calls = 0

    def motor(t: float, angle: float, rate: float) -> float:
        nonlocal calls
        calls += 1
        return 1.0 - rate

    run = wheel().simulate(drives={"motor": motor})
    made = calls
    run.report(tmp_path / "run.html")
    assert calls > made
    assert "motor" in (tmp_path / "run.html").read_text(encoding="utf-8")
    summary = wheel().simulate_into(tmp_path / "run", drives={"motor": motor})
    assert summary["partial"] is False
    table = np.genfromtxt(tmp_path / "run" / "trajectory.csv", delimiter=",", names=True)
    np.testing.assert_allclose(table["wheelomega"], run.body("wheel").angular_velocity, atol=1e-12)
    wheel().report(tmp_path / "own.html", drives={"motor": motor})
    assert (tmp_path / "own.html").exists()
    with pytest.raises(pfaff.ComputationError) as raised:
        wheel().simulate(drives={"motor": lambda t, x, v: 1.0 if t < 0.5 else math.nan})
    assert raised.value.run is not None
    raised.value.run.report(tmp_path / "stopped.html")
    assert "motor" in (tmp_path / "stopped.html").read_text(encoding="utf-8")
    with pytest.raises(TypeError, match="did you mean `drives`"):
        wheel().simulate_into(tmp_path / "other", drive={"motor": motor})
    with pytest.raises(Own):

        def fails(t: float, x: float, v: float) -> float:
            raise Own

        wheel().simulate_into(tmp_path / "other", drives={"motor": fails})
