"""The options of each engine that are measured on each scene, with their steps."""

from __future__ import annotations

from dataclasses import dataclass, field

LARGE = (1, 16, 64, 256)
"""Numbers of loops of the n-four-bar."""

TARGET = 1e-5
"""The error at which costs are compared (m)."""

FINE = 1e-9
"""No step is refined below this error (m)."""

LOOPS = ("n-four-bar-plane", "n-four-bar-space")
THIN = "n-four-bar-thin"
"""The n-four-bar in space with thin rods, for pfaff and MuJoCo only."""
HINGED = ("bennett", "bricard")
OPEN = ("top", "free-body", "spherical-pendulum")


@dataclass(frozen=True)
class Family:
    """An engine with one setting and its steps, from coarse to fine.

    `steps` are numbers of steps between two instants of comparison, or tolerances if `is_tolerance`
    is set.
    """

    engine: str
    name: str
    options: dict = field(default_factory=dict)
    steps: tuple[float, ...] = ()
    is_tolerance: bool = False


def doubled(first: int, last: int) -> tuple[float, ...]:
    """Returns the powers of two from `first` to `last`."""
    steps = [float(first)]
    while steps[-1] < last:
        steps.append(2.0 * steps[-1])
    return tuple(steps)


def powers(first: int, last: int) -> tuple[float, ...]:
    """Returns the tolerances 10^-first … 10^-last, and values half-way between on a log scale."""
    return tuple(10.0 ** (-0.5 * k) for k in range(2 * first, 2 * last + 1))


def pfaff() -> list[Family]:
    """Returns the program with its defaults; only the tolerance varies."""
    return [Family("pfaff", "default", {}, powers(3, 12), True)]


def mujoco(scene: str, count: int) -> list[Family]:
    """Returns semi-implicit steps and Runge-Kutta, with closing hinges at one or two points.

    Runge-Kutta is three times slower on small n-four-bars and omitted for large ones.
    """
    families = []
    places = (2,) if scene in HINGED else (1, 2) if scene in (*LOOPS, THIN) else (1,)
    steps = doubled(128 if count >= 64 else 32 if places == (1, 2) else 4, 16384)
    for integrator in ("implicitfast", "RK4") if count < 64 else ("implicitfast",):
        for points in places:
            options = {"integrator": integrator, "points": points}
            held = f", {points} points" if places != (1,) else ""
            families.append(Family("mujoco", integrator + held, options, steps))
    return families


def drake(scene: str, count: int) -> list[Family]:
    """Returns discrete steps with constraints, and error control with bushings or without loops."""
    if scene in OPEN:
        names = ("runge_kutta3", "runge_kutta5", "radau3")
        return [
            Family("drake", name, {"scheme": name, "largest": 0.1}, powers(3, 11), True)
            for name in names
        ]
    points = 2 if scene in HINGED else 1
    discrete = {"scheme": "sap", "points": points}
    families = [Family("drake", "SAP, ball constraints", discrete, doubled(16, 4096))]
    for stiffness in (1e7, 1e9) if count < 64 else (1e7,):
        options = {"scheme": "runge_kutta3", "closure": "bushing", "stiffness": stiffness}
        name = f"runge_kutta3, bushings {stiffness:.0e} N/m"
        families.append(Family("drake", name, options, powers(3, 7), True))
    return families


def exudyn(scene: str, count: int) -> list[Family]:
    """Returns generalised-alpha with all rows, or with the rows that a user keeps."""
    steps = doubled(16 if scene in LOOPS else 4, 8192)
    if scene == "n-four-bar-plane":
        return [
            Family(
                "exudyn",
                f"planar, sparse, {newton} Newton",
                {"rows": "kept", "solver": "sparse", "newton": newton},
                steps,
            )
            for newton in ("modified", "full")
        ]
    families = []
    if count <= 16:
        options = {"rows": "all", "solver": "dense", "newton": "modified"}
        families.append(Family("exudyn", "all rows, dense", options, steps))
    if scene not in OPEN and scene not in ("slider-crank", "hexapod"):
        options = {"rows": "kept", "solver": "sparse", "newton": "modified"}
        families.append(Family("exudyn", "kept rows, sparse", options, steps))
    if scene in HINGED or (scene == "n-four-bar-space" and count <= 16):
        options = {
            "rows": "kept",
            "solver": "dense" if count == 1 else "sparse",
            "newton": "modified",
            "coordinates": "trees",
        }
        families.append(Family("exudyn", "kinematic trees, kept rows", options, steps))
    if scene in (*OPEN, *HINGED, "slider-crank", "hexapod"):
        for rotation in ("quaternion", "vector"):
            options = {"rows": "all", "solver": "dense", "newton": "modified", "rotation": rotation}
            families.append(Family("exudyn", f"all rows, dense, {rotation}", options, steps))
    return families


def pinocchio(scene: str) -> list[Family]:
    """Returns Runge-Kutta methods of order 4 and 8, with gains of Baumgarte's correction."""
    points = 2 if scene in HINGED else 1
    gains = (0.0,) if scene in OPEN else (10.0, 30.0)
    families = []
    for method, steps in (("rk4", doubled(2, 2048)), ("rk8", doubled(1, 512))):
        for gain in gains:
            options = {"method": method, "points": points, "gain": gain}
            name = method + (f", gain {gain:.0f}/s" if gain else "")
            families.append(Family("pinocchio", name, options, steps))
    return families


def families(scene: str, count: int) -> list[Family]:
    """Returns all families that are measured on a scene.

    In the plane only pfaff and Exudyn have separate models. The other engines use the models in
    space, whose runs are not repeated.
    """
    if scene == THIN:
        return pfaff() + mujoco(scene, 64)
    listed = pfaff()
    listed += exudyn(scene, count)
    if scene != "n-four-bar-plane":
        listed += mujoco(scene, count) + drake(scene, count) + pinocchio(scene)
    return listed


def problems(quick: bool) -> list[tuple[str, int]]:
    """Returns the scenes with their sizes, in the order of measurement."""
    sizes = LARGE[:2] if quick else LARGE
    others = ("three-cranks", "slider-crank", "bennett", "bricard", *OPEN, "hexapod")
    listed = [(scene, 1) for scene in others]
    listed += [(scene, count) for count in sizes for scene in LOOPS]
    return [*listed, (THIN, 16)]
