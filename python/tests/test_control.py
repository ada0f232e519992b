"""Functions of the whole state, runs that are advanced step by step, and restarts."""

from __future__ import annotations

import math
import multiprocessing
import os
import pickle
import resource
import signal
import sys
import threading
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]
from scipy.linalg import solve_continuous_are  # type: ignore[import-untyped]

import pfaff

CART, BOB, LENGTH, GRAVITY = 1.5, 0.4, 0.8, 9.81


def cart_pole(angle: float = 0.0) -> pfaff.Scene:
    """A cart on a guide, with a point mass on a pole; the angle is counted from the upright."""
    x, y = -LENGTH * math.sin(angle), LENGTH * math.cos(angle)
    return (
        pfaff.Scene("cart-pole", gravity=[0.0, -GRAVITY])
        .body("cart", mass=CART, inertia=1.0)
        .body("pole", mass=BOB, inertia=0.0, position=[x, y], angle=angle)
        .joint("guide", "translational", ["ground", "cart"], at=[0.0, 0.0], axis=[1.0, 0.0])
        .joint("pin", "revolute", ["cart", "pole"], at=[0.0, 0.0])
        .drive("motor", joint="guide", type="displacement", force=0)
        .drive("sensor", joint="pin", type="angle", torque=0)
    )


def right_hand_side(y: Any, force: float) -> list[float]:
    """The equations of a cart with a point mass on a pole, derived by hand (Lagrange)."""
    _, angle, v, omega = y
    sin, cos = math.sin(angle), math.cos(angle)
    # (M + m) ẍ - m l cos θ θ̈ + m l sin θ θ̇² = F,  l θ̈ - cos θ ẍ - g sin θ = 0
    a = (force - BOB * LENGTH * omega**2 * sin + BOB * GRAVITY * sin * cos) / (
        CART + BOB * (1.0 - cos * cos)
    )
    return [v, omega, a, (cos * a + GRAVITY * sin) / LENGTH]


def gains() -> Any:
    """The gains of a linear-quadratic regulator for unit weights, from the matrices by hand."""
    a = np.zeros((4, 4))
    a[0, 2] = a[1, 3] = 1.0
    a[2, 1] = BOB * GRAVITY / CART
    a[3, 1] = (CART + BOB) * GRAVITY / (CART * LENGTH)
    b = np.array([[0.0], [0.0], [1.0 / CART], [1.0 / (CART * LENGTH)]])
    p = solve_continuous_are(a, b, np.eye(4), np.eye(1))
    return (b.T @ p)[0]


def test_a_regulated_cart_pole_agrees_with_its_equations() -> None:
    k = gains()

    def controller(t: float, state: pfaff.State) -> dict[str, float]:
        x, v = state.coordinates, state.rates
        y = [x["motor"], x["sensor"], v["motor"], v["sensor"]]
        return {"motor": -float(k @ y)}

    run = cart_pole(0.3).simulate(
        t_end=4.0, rtol=1e-12, atol=1e-13, controller=controller, reactions=False
    )

    def by_hand(t: float, y: Any) -> list[float]:
        return right_hand_side(y, -float(k @ y))

    found = solve_ivp(
        by_hand, (0.0, 4.0), [0.0, 0.3, 0.0, 0.0], "DOP853", run.t, rtol=1e-13, atol=1e-14
    )
    x, angle = run.body("cart").position[:, 0], run.body("pole").angle
    assert abs(x - found.y[0]).max() < 1e-10
    assert abs(angle - found.y[1]).max() < 1e-10
    assert abs(angle[-1]) < 0.02


def test_a_controller_is_called_once_an_evaluation() -> None:
    calls = 0

    def controller(t: float, state: pfaff.State) -> dict[str, Any]:
        nonlocal calls
        calls += 1
        a, b = state.bodies["a"], state.bodies["b"]
        pull = 30.0 * (a.position - b.position) + 0.8 * (a.velocity - b.velocity)
        return {"a": [*-pull, 0.0], "b": [*pull, 0.0]}

    scene = (
        pfaff.Scene("two masses")
        .body("a", mass=2.0, inertia=1.0, position=[0.4, 0.0])
        .body("b", mass=2.0, inertia=1.0)
    )
    run = scene.simulate(t_end=1.5, rtol=1e-11, atol=1e-13, output_step=1.5, controller=controller)
    # The difference u solves ü + 2·(c/m)·u̇ + 2·(k/m)·u = 0.
    decay, omega = 0.4, math.sqrt(30.0 - 0.16)
    u = 0.4 * np.exp(-decay * run.t) * (np.cos(omega * run.t) + decay / omega * np.sin(omega * run.t))
    difference = run.body("a").position[:, 0] - run.body("b").position[:, 0]
    np.testing.assert_allclose(difference, u, atol=1e-9)
    # One more call at the start names the loads, and each row needs a few more.
    assert calls <= run.document["evaluations"] + 1 + 4 * len(run.t)


def test_a_controller_may_only_command_what_there_is() -> None:
    scene = cart_pole()
    with pytest.raises(pfaff.InputError, match="did you mean `motor`"):
        scene.simulate(t_end=0.1, controller=lambda t, state: {"mottor": 1.0})
    with pytest.raises(TypeError, match="the result of the controller is `float`"):
        scene.simulate(t_end=0.1, controller=lambda t, state: 1.0)  # type: ignore[arg-type, return-value]
    with pytest.raises(TypeError, match="controller"):
        scene.simulate(t_end=0.1, controller=3.0)  # type: ignore[arg-type]

    def forgets(t: float, state: pfaff.State) -> dict[str, float]:
        return {"motor": 0.0} if t < 0.05 else {}

    with pytest.raises(pfaff.ComputationError, match=r"returned values for \[\]") as stopped:
        scene.simulate(t_end=0.1, controller=forgets)
    assert stopped.value.code == "P0426"
    run = stopped.value.run
    assert run is not None and run.t[-1] <= 0.05
    with pytest.raises(pfaff.ComputationError, match="the controller") as stopped:
        scene.simulate(t_end=0.1, controller=lambda t, state: {"motor": math.nan})
    assert stopped.value.code == "P0426"

    def fails(t: float, state: pfaff.State) -> dict[str, float]:
        raise ZeroDivisionError("no sensor")

    with pytest.raises(ZeroDivisionError, match="no sensor"):
        scene.simulate(t_end=0.1, controller=fails)
    with pytest.raises(pfaff.InputError, match="radau5"):
        scene.simulate(t_end=0.1, method="radau5", controller=lambda t, state: {"motor": 0.0})


def test_a_state_describes_its_numbers() -> None:
    tensor = [[0.5, 0.0, 0.2], [0.0, 0.8, 0.0], [0.2, 0.0, 0.6]]
    scene = (
        pfaff.Scene("block", space="spatial")
        .body("block", mass=2.0, inertia=tensor, angular_velocity=[0.0, 0.3, 0.0])
        .marker("tip", body="block", point=[1.0, 0.0, 0.0])
        .measure("height", type="z", markers=["tip"])
    )
    state = scene.state()
    q, v = state.words()
    assert len(q) == 7 and len(v) == 6 and q[0] == "block: x"
    block = state.bodies["block"]
    # The quaternion in q is that of the principal axes, the rotation that of the frame.
    np.testing.assert_allclose(block.rotation, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(block.angular_velocity, [0.0, 0.3, 0.0], atol=1e-15)
    assert list(state.measures) == ["height"] and abs(state.measures["height"]) < 1e-15
    assert abs(state.measure_rates["height"] + 0.3) < 1e-15
    with pytest.raises(pfaff.InputError, match="did you mean `block`"):
        state.bodies["blok"]


def test_steps_move_as_one_run() -> None:
    scene = cart_pole(0.4)
    run = scene.simulate(t_end=1.0, output_step=0.1, rtol=1e-11, atol=1e-13, reactions=False)
    simulator = pfaff.Simulator(scene, rtol=1e-11, atol=1e-13)
    for row in range(1, len(run.t)):
        assert simulator.step(0.1) == []
        assert abs(simulator.t - run.t[row]) < 1e-12
        np.testing.assert_allclose(simulator.state.q, run.q[row], atol=1e-9)
    again = pfaff.Simulator(scene, rtol=1e-11, atol=1e-13)
    for _ in range(1, len(run.t)):
        again.step(0.1)
    assert again.state.q.tobytes() == simulator.state.q.tobytes()


def test_commands_hold_within_a_step() -> None:
    wheel = (
        pfaff.Scene("wheel")
        .body("wheel", mass=1.0, inertia=0.5)
        .joint("shaft", "revolute", ["ground", "wheel"], at=[0.0, 0.0])
        .drive("motor", joint="shaft", type="angle", torque="-0.1*rate")
    )
    simulator = pfaff.Simulator(wheel)
    simulator.drives["motor"] = 1.0
    simulator.step(2.0)
    simulator.drives["motor"] = -1.0
    simulator.step(2.0)
    assert dict(simulator.drives) == {"motor": -1.0}
    assert abs(simulator.state.coordinates["motor"] - 8.0) < 1e-8
    assert abs(simulator.state.rates["motor"]) < 1e-8
    with pytest.raises(pfaff.InputError, match="did you mean `motor`"):
        simulator.drives["moter"] = 1.0
    with pytest.raises(pfaff.InputError, match="finite"):
        simulator.drives["motor"] = math.inf
    with pytest.raises(TypeError, match="keeps its value"):
        del simulator.drives["motor"]
    with pytest.raises(pfaff.InputError, match="after the time of the simulator"):
        simulator.step(-1.0)
    assert simulator.t == 4.0


def test_resets_need_no_more_memory_and_give_the_same_bits() -> None:
    simulator = pfaff.Simulator(cart_pole(0.4))
    simulator.step(0.2)
    first = simulator.state.q.tobytes()
    for _ in range(50):
        simulator.reset()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(1000):
        simulator.reset()
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert after - before < 8 * (1024 if sys.platform == "linux" else 1 << 20)
    assert simulator.t == 0.0
    simulator.step(0.2)
    assert simulator.state.q.tobytes() == first


def test_a_reset_continues_at_a_later_state() -> None:
    simulator = pfaff.Simulator(cart_pole(0.4))
    simulator.step(0.2)
    there = simulator.state
    simulator.step(0.2)
    whole = simulator.state.q
    simulator.reset(there)
    assert simulator.t == there.t
    simulator.step(0.2)
    # Each step has an error of about the relative tolerance 1e-8.
    np.testing.assert_allclose(simulator.state.q, whole, rtol=0.0, atol=1e-7)


def test_a_reset_checks_the_state() -> None:
    simulator = pfaff.Simulator(cart_pole())
    simulator.step(0.1)
    there = simulator.state
    with pytest.raises(pfaff.Error, match="2 coordinates, need 6"):
        simulator.reset((0.0, [1.0, 2.0], [3.0]))
    with pytest.raises(pfaff.InputError, match="corrected by"):
        simulator.reset((0.0, [1.0] * 6, [0.0] * 6))
    with pytest.raises(TypeError, match="a State, or"):
        simulator.reset(3)  # type: ignore[arg-type]
    np.testing.assert_array_equal(simulator.state.q, there.q)
    simulator.step(0.1)
    assert abs(simulator.t - 0.2) < 1e-15


def test_reactions_have_their_verdicts() -> None:
    door = (
        pfaff.Scene("door on two hinges", gravity=[0.0, -9.81])
        .body("leaf", mass=20.0, inertia=5.0)
        .joint("upper", "revolute", ["ground", "leaf"], at=[0.0, 1.0])
        .joint("lower", "revolute", ["ground", "leaf"], at=[0.0, -1.0])
    )
    upper = pfaff.Simulator(door).reactions()["upper"]
    assert upper["Fy"].verdict == "not_unique" and math.isnan(upper["Fy"].value)
    # A joint with only a torque: 3 N·m on the body, and the same on the ground.
    level = (
        pfaff.Scene("level")
        .body("crate", mass=1.0, inertia=1.0)
        .joint("level", "angle", ["ground", "crate"])
        .force("turn", "torque", "crate", torque=3.0)
    )
    assert pfaff.Simulator(level).reactions() == {"level": {"T": (3.0, "unique")}}
    hanging = pfaff.Simulator(cart_pole()).reactions()["guide"]
    assert hanging["Fy"].verdict == "unique"
    # On the ground: the weight of cart and bob.
    assert abs(hanging["Fy"].value + (CART + BOB) * GRAVITY) < 1e-9


def crank() -> pfaff.Scene:
    """A crank with a prescribed motion, and a spring-driven pendulum on it."""
    return (
        pfaff.Scene("crank", gravity=[0.0, -9.81], format=2)
        .body("crank", mass=1.0, inertia=0.2)
        .body("bob", mass=0.5, inertia=0.01, position=[0.5, -0.3])
        .joint("pin", "revolute", ["ground", "crank"], at=[0.0, 0.0])
        .joint("hook", "revolute", ["crank", "bob"], at=[0.5, 0.0])
        .drive("motor", joint="pin", type="angle", motion="1.5*t + 0.2*sin(3*t)")
        .set("simulate", t_end=2.0, rtol=1e-11, atol=1e-13)
    )


def test_a_restarted_run_is_the_rest_of_the_motion(tmp_path: Any) -> None:
    scene = crank()
    run = scene.simulate(output_step=0.25)
    there = run.scene_at(1.0)
    there.write(tmp_path / "there.toml")
    for rest in (
        there.simulate(output_step=0.25),
        scene.simulate(output_step=0.25, start=run.state(4)),
        pfaff.Scene.from_file(tmp_path / "there.toml").simulate(output_step=0.25),
    ):
        np.testing.assert_allclose(rest.t, run.t[4:], atol=1e-12)
        np.testing.assert_allclose(rest.q, run.q[4:], atol=1e-8)
        np.testing.assert_allclose(
            rest.reaction("pin").force, run.reaction("pin").force[4:], atol=1e-6
        )
    assert there.analyze().document["time"] == 1.0
    assert there.check()["mobility"] == 1
    with pytest.raises(pfaff.InputError, match="the nearest row is at 1"):
        run.scene_at(1.01)
    with pytest.raises(pfaff.InputError, match="before the start"):
        there.simulate(t_end=0.5)


def test_a_text_cannot_state_revolutions() -> None:
    screw = (
        pfaff.Scene("screw", space="spatial")
        .body("nut", mass=1.0, inertia=[0.1, 0.1, 0.1], angular_velocity=[0.0, 0.0, 20.0])
        .joint("screw", "screw", ["ground", "nut"], at=[0, 0, 0], axis=[0, 0, 1], pitch=0.01)
    )
    run = screw.simulate(t_end=1.0, output_step=0.5)
    with pytest.raises(pfaff.InputError, match="angle with its turns"):
        run.scene_at(0.5)
    rest = screw.simulate(t_end=1.0, output_step=0.5, start=run.state(1))
    np.testing.assert_allclose(rest.q[-1], run.q[-1], atol=1e-9)


def test_states_of_laws_belong_to_the_state() -> None:
    scene = (
        pfaff.Scene("servo")
        .body("arm", mass=1.0, inertia=1.0, angle=0.2)
        .joint("hinge", "revolute", ["ground", "arm"], at=[0.0, 0.0])
        .drive(
            "motor",
            joint="hinge",
            type="angle",
            torque="-9*(measure - 0.5) - 4*lag(rate, 0.05) - 6*integral(measure - 0.5)",
        )
    )

    def rates(_: float, y: Any) -> list[float]:
        angle, omega, filtered, integral = y
        error = angle - 0.5
        torque = -9.0 * error - 4.0 * filtered - 6.0 * integral
        return [omega, torque, (omega - filtered) / 0.05, error]

    expected = solve_ivp(rates, (0.0, 2.0), [0.2, 0.0, 0.0, 0.0], rtol=1e-12, atol=1e-13).y[:, -1]
    state = scene.state()
    assert state.words()[0][3:] == ["motor: state of the law"] * 2
    simulator = pfaff.Simulator(scene, rtol=1e-10, atol=1e-12)
    for _ in range(10):
        simulator.step(0.2)
    found = simulator.state
    order = [found.q[2], found.v[2], found.q[3], found.q[4]]
    np.testing.assert_allclose(order, expected, rtol=0.0, atol=1e-8)
    run = scene.simulate(2.0, rtol=1e-10, atol=1e-12)
    with pytest.raises(pfaff.InputError, match="state of the law of `motor`"):
        run.scene_at(1.0)


def test_a_simulator_hears_ctrl_c_and_lets_threads_go_on() -> None:
    simulator = pfaff.Simulator(crank(), rtol=1e-13, atol=1e-15, max_step=1e-6)
    timer = threading.Timer(0.3, signal.raise_signal, (signal.SIGINT,))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulator.step(100.0)
    timer.join()
    reached = simulator.t
    assert 0.0 < reached < 100.0
    simulator.step(1e-5)
    assert simulator.t > reached


def _step(simulator: pfaff.Simulator, out: Any) -> None:
    try:
        simulator.step(0.1)
    except pfaff.Error as error:
        out.put(str(error))


@pytest.mark.skipif(sys.platform == "win32", reason="no fork")
def test_a_simulator_belongs_to_its_process() -> None:
    simulator = pfaff.Simulator(cart_pole())
    context = multiprocessing.get_context("fork")
    out = context.Queue()
    child = context.Process(target=_step, args=(simulator, out))
    child.start()
    assert "belongs to the process" in out.get(timeout=60)
    child.join()


def _many(out: Any) -> None:
    simulators = [pfaff.Simulator(cart_pole()) for _ in range((os.cpu_count() or 1) + 1)]
    for simulator in simulators:
        simulator.step(0.1)
        simulator.reset()
    out.put([simulator.t for simulator in simulators])


@pytest.mark.skipif(sys.platform == "win32", reason="no fork")
def test_a_forked_process_has_more_simulators_than_cores() -> None:
    pfaff.Simulator(cart_pole()).step(0.1)
    context = multiprocessing.get_context("fork")
    out = context.Queue()
    child = context.Process(target=_many, args=(out,), daemon=True)
    child.start()
    assert set(out.get(timeout=60)) == {0.0}
    child.join()


def test_what_cannot_be_pickled_is_named() -> None:
    scene = cart_pole()
    run = scene.simulate(t_end=0.1, controller=lambda t, state: {"motor": 0.0})
    copy = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(copy.q, run.q)
    with pytest.raises(pfaff.InputError, match="`controller` could not be pickled"):
        copy.report("run.html")
    with pytest.raises(TypeError, match="Simulator"):
        pickle.dumps(pfaff.Simulator(scene))
