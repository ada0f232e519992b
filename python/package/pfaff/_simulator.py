"""A run that is advanced step by step."""

from __future__ import annotations

import json
from collections.abc import Iterator, MutableMapping
from typing import TYPE_CHECKING, Any

from . import _arguments as arguments
from . import _pfaff
from ._errors import unknown
from ._run import Event
from ._state import ReactionNumber, StartArgument, State, of_start

if TYPE_CHECKING:
    from ._scene import Scene


class Simulator:
    """A run that is advanced step by step.

    Between two steps, the forces and torques of drives by laws can be changed, and keep their
    values within a step. The integrator continues from step to step.

    >>> import pfaff
    >>> wheel = (
    ...     pfaff.Scene("wheel")
    ...     .body("wheel", mass=1.0, inertia=0.5)
    ...     .joint("shaft", "revolute", ["ground", "wheel"], at=[0.0, 0.0])
    ...     .drive("motor", joint="shaft", type="angle", torque=0)
    ... )
    >>> simulator = pfaff.Simulator(wheel)
    >>> simulator.drives["motor"] = 1.0
    >>> simulator.step(2.0)
    []
    >>> round(simulator.state.coordinates["motor"], 9)
    4.0
    """

    def __init__(
        self,
        scene: Scene,
        *,
        start: StartArgument | None = None,
        rtol: float | None = None,
        atol: float | None = None,
        max_step: float | None = None,
        max_steps: int | None = None,
        method: str | None = None,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        max_memory: int | str | None = None,
    ) -> None:
        """Starts a run at the start of a scene, or at another state and time.

        The options are those of :meth:`Scene.simulate`.
        """
        from ._scene import Scene, native_options

        self.scene: Scene = arguments.instance("scene", scene, Scene)
        """The scene."""
        options = native_options(
            rtol=rtol,
            atol=atol,
            max_step=max_step,
            max_steps=max_steps,
            method=method,
            tolerance=tolerance,
            angle_tolerance=angle_tolerance,
            max_memory=max_memory,
        )
        self._of = _pfaff.Simulator(scene._of, options, of_start(start))
        self._kinematics = scene._of.kinematics()
        self.drives: MutableMapping[str, float] = _Drives(self._of, self._kinematics)
        """The commanded forces (N) and torques (N·m) of drives by laws, by their names.

        A drive that has no value follows the law of the scene.
        """

    def step(self, dt: float) -> list[Event]:
        """Advances the run by a time (s); returns the events of this step.

        If the step cannot be completed, an exception is raised. The state is then the last state
        that was reached.
        """
        to = self._of.state()[0] + arguments.finite("dt", dt)
        return [Event(**json.loads(event)) for event in self._of.step(to)]

    @property
    def t(self) -> float:
        """Time (s)."""
        t: float = self._of.state()[0]
        return t

    @property
    def state(self) -> State:
        """The current state."""
        return State(self._kinematics, *self._of.state())

    def reset(self, start: StartArgument | None = None) -> None:
        """Continues at another state and time, or at the start of the scene.

        Prescribed motions continue at this time. Commanded values of drives do not change.
        """
        given = of_start(self.scene.state() if start is None else start)
        assert given is not None
        self._of.reset(*given)

    def reactions(self) -> dict[str, dict[str, ReactionNumber]]:
        """Returns the reactions of all joints and drives at the current state.

        A component has a value if the model determines it here and at the other configurations that
        were compared.
        """
        text, numbers = self._of.reactions()
        found = {}
        for reaction, values in zip(json.loads(text)["reactions"], numbers, strict=True):
            components = {}
            of = dict(values)
            for component in reaction["components"]:
                verdict = component.get("generic_verdict") or component["verdict"]
                both = {verdict, component["verdict"]}
                number = of[component["name"]] if both == {"unique"} else float("nan")
                components[component["name"]] = ReactionNumber(number, verdict)
            found[reaction["name"]] = components
        return found

    def __repr__(self) -> str:
        return f"<pfaff.Simulator of {self.scene.file!r} at t = {self.t} s>"


class _Drives(MutableMapping[str, float]):
    """Commanded values of drives."""

    __slots__ = ("_kinematics", "_of")

    def __init__(self, of: _pfaff.Simulator, kinematics: _pfaff.Kinematics) -> None:
        self._of, self._kinematics = of, kinematics

    def __getitem__(self, name: str) -> float:
        known = dict(self._of.commands())
        if name not in known:
            raise unknown("commanded drive", name, known)
        value: float = known[name]
        return value

    def __setitem__(self, name: str, value: Any) -> None:
        self._of.command(arguments.text("drive", name), arguments.number(f"drives[{name!r}]", value))

    def __delitem__(self, name: str) -> None:
        raise TypeError(f"drive {name!r} keeps its value: create another Simulator for its law")

    def __iter__(self) -> Iterator[str]:
        return iter(dict(self._of.commands()))

    def __len__(self) -> int:
        return len(self._of.commands())
