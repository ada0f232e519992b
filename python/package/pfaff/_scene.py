"""A scene: its text, and the results that are computed from it."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments as arguments
from . import _pfaff
from . import _toml as toml
from ._answer import Answer, Common
from ._choices import Bounds, Choice, as_bounds, dropped, of_run
from ._errors import wrong, wrong_type
from ._functions import BodyForce, DriveLaw, of_bodies, of_drives
from ._questions import Questions
from ._run import Event, Run
from ._state import Controller, StartArgument, State, of_controller, of_start
from .cluster import SweepResult, Vary, sweep

Array = NDArray[np.float64]
Bodies = Sequence[str] | str


class Matrices(NamedTuple):
    """The equations ``M·a + Cᵀ·λ = Q``, ``C·a = Γ``, ``C·v = b``, ``Φ = 0`` at one state."""

    C: Array
    """The constraint matrix: a row for each constraint, a column for each velocity."""
    M: Array
    """The mass matrix, square and diagonal."""
    Gamma: Array
    """The right-hand side of the accelerations."""
    Q: Array
    """Applied forces and torques."""
    b: Array
    """The right-hand side of the velocities."""
    Phi: Array
    """Violations of the holonomic rows."""


class Scene(Questions):
    """A mechanism as a text in the format of scenes. The object is immutable.

    Methods that add a table return a new scene with the arguments in its text. The reader of scenes
    validates the text at the first use of the scene, or in :meth:`check`.
    """

    __slots__ = ("_of",)

    def __init__(self, name: str = "scene", *, space: str = "plane", **keys: Any) -> None:
        """Creates a scene without bodies.

        ``keys`` are the keys of the table ``[scene]``, such as ``gravity`` and ``tolerance``.
        """
        name = arguments.text("name", name)
        entries = {"name": name, "space": arguments.text("space", space), **keys}
        self._of = _pfaff.Scene(f"{name}.toml", toml.table("[scene]", entries))

    @classmethod
    def _made(cls, of: _pfaff.Scene) -> Scene:
        made = cls.__new__(cls)
        made._of = of
        return made

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Scene:
        """Reads a file in the format of scenes."""
        return cls._made(_pfaff.Scene.from_file(arguments.path("path", path)))

    @classmethod
    def new(cls, template: str) -> Scene:
        """Returns the scene of a template, given by its name; see :func:`pfaff.templates`."""
        return cls._made(_pfaff.Scene.of_template(arguments.text("template", template)))

    @classmethod
    def from_string(cls, text: str, name: str = "scene.toml") -> Scene:
        """Creates a scene from a text; ``name`` is the file name in messages."""
        return cls._made(_pfaff.Scene(arguments.text("name", name), arguments.text("text", text)))

    @classmethod
    def from_mjcf(cls, path: str | os.PathLike[str] | None = None, **options: Any) -> Scene:
        """Imports a MuJoCo model; see :meth:`imported` for the options."""
        return cls.imported("MJCF", path, **options)[0]

    @classmethod
    def from_urdf(cls, path: str | os.PathLike[str] | None = None, **options: Any) -> Scene:
        """Imports a URDF file; see :meth:`imported` for the options."""
        return cls.imported("URDF", path, **options)[0]

    @classmethod
    def from_sdf(cls, path: str | os.PathLike[str] | None = None, **options: Any) -> Scene:
        """Imports an SDF file; see :meth:`imported` for the options."""
        return cls.imported("SDF", path, **options)[0]

    @classmethod
    def imported(
        cls,
        format: str,
        path: str | os.PathLike[str] | None = None,
        *,
        text: str | None = None,
        base: str = "fixed",
        keep_fixed: bool = False,
        snap: bool = False,
        keyframe: str | None = None,
        model: str | None = None,
        drives: str = "none",
        pose: Mapping[str, float] | None = None,
        loops: str | os.PathLike[str] | None = None,
    ) -> tuple[Scene, list[str], list[tuple[str, str, int]]]:
        """Imports a robot model; returns a scene, remarks, and the omitted elements.

        Each omitted element has kind, subject and line. ``format`` is ``"MJCF"``, ``"URDF"`` or
        ``"SDF"``. The other arguments are the options of ``pfaff import``: ``base`` (``"fixed"`` or
        ``"free"``), ``keep_fixed``, ``snap``, ``keyframe``, ``model`` (the only model of an SDF
        file that is read), ``drives`` (``"torque"`` or ``"position"``: drives from actuators, with a
        torque of zero or locked), ``pose`` (values of joints near which loops are closed) and
        ``loops`` (a file of loop closures of a URDF). If ``text`` replaces a file, no other file is
        included.
        """
        if path is None and text is None:
            raise wrong("need a path or a text")
        given = {} if pose is None else pose
        joints = arguments.named("pose", given, arguments.number, "values of joints by name")
        of, remarks, omissions = _pfaff.Scene.imported(
            arguments.text("format", format),
            "text.xml" if path is None else arguments.path("path", path),
            arguments.maybe(arguments.text, "text", text),
            arguments.text("base", base),
            arguments.flag("keep_fixed", keep_fixed),
            arguments.flag("snap", snap),
            arguments.maybe(arguments.text, "keyframe", keyframe),
            arguments.maybe(arguments.text, "model", model),
            arguments.text("drives", drives),
            list(joints.items()),
            arguments.maybe(arguments.path, "loops", loops),
        )
        return cls._made(of), remarks, omissions

    # Text of the scene.

    @property
    def text(self) -> str:
        """The text, as in a file."""
        return self._of.text

    @property
    def file(self) -> str:
        """The name of the text in messages."""
        return self._of.name

    @property
    def name(self) -> str:
        """The name that the scene states."""
        return self._of.names()[0]

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies."""
        return self._of.names()[1][0]

    @property
    def joints(self) -> list[str]:
        """Names of joints and drives, in the order of their rows."""
        return self._of.names()[1][1]

    @property
    def cases(self) -> list[str]:
        """The names of the load cases.

        >>> {name: scene.case(name).simulate() for name in scene.cases}  # doctest: +SKIP
        """
        return self._of.names()[1][2]

    def __repr__(self) -> str:
        return f"<pfaff.Scene {self.file!r}, {self.text.count(chr(10))} lines>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return (self.file, self.text) == (other.file, other.text)

    def __hash__(self) -> int:
        return hash((self.file, self.text))

    def __reduce__(self) -> tuple[Callable[[str, str], Scene], tuple[str, str]]:
        return (Scene.from_string, (self.text, self.file))

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the text into a file, for the command."""
        with open(arguments.path("path", path), "w", encoding="utf-8", newline="\n") as file:
            file.write(self.text)

    # Methods that add tables.

    def add(self, table: str, **keys: Any) -> Scene:
        """Returns the scene with one more ``[[table]]``, as ``[[body]]``; ``None`` omits a key."""
        return self._with_table(f"[[{arguments.text('table', table)}]]", keys)

    def set(self, table: str, **keys: Any) -> Scene:
        """Returns the scene with a unique table, such as ``[simulate]`` or ``[start]``."""
        return self._with_table(f"[{arguments.text('table', table)}]", keys)

    def _with_table(self, header: str, keys: Mapping[str, Any]) -> Scene:
        text = self.text if self.text.endswith("\n") or not self.text else f"{self.text}\n"
        more = toml.table(header, keys)
        return Scene._made(_pfaff.Scene(self.file, f"{text}\n{more}"))

    def body(self, name: str, **keys: Any) -> Scene:
        """Returns the scene with another body: ``mass``, ``inertia``, ``position`` and so on."""
        return self.add("body", name=name, **keys)

    def joint(self, name: str, type: str, bodies: Bodies, **keys: Any) -> Scene:
        """Returns the scene with another joint: ``at``, ``axis`` and so on, according to its type.

        ``bodies`` is a list, or a single body for a joint with only one body, such as a knife edge.
        """
        return self.add("joint", name=name, type=type, **_between(bodies), **keys)

    def drive(self, name: str, **keys: Any) -> Scene:
        """Returns the scene with another drive."""
        return self.add("drive", name=name, **keys)

    def force(self, name: str, type: str, bodies: Bodies | None = None, **keys: Any) -> Scene:
        """Returns the scene with another applied force."""
        return self.add("force", name=name, type=type, **_between(bodies), **keys)

    def marker(self, name: str, **keys: Any) -> Scene:
        """Returns the scene with another marker."""
        return self.add("marker", name=name, **keys)

    def measure(self, name: str, **keys: Any) -> Scene:
        """Returns the scene with another measured joint coordinate."""
        return self.add("measure", name=name, **keys)

    def group(self, name: str, **keys: Any) -> Scene:
        """Returns the scene with another group of reactions."""
        return self.add("group", name=name, **keys)

    def parameters(self, **values: Any) -> Scene:
        """Returns the scene with parameters for its expressions (``format=2``)."""
        return self.set("parameters", **values)

    def with_(self, **settings: Any) -> Scene:
        """Returns the scene with other values at these keys, like ``--set`` of the command.

        >>> scene.with_(**{"joint.H.axis": [0, 1, 0], "L": 0.4})  # doctest: +SKIP

        Values are numbers or expressions. A list sets its entries, ``axis[0]`` and so on.
        """
        pairs = [pair for key, item in settings.items() for pair in _entries(key, item)]
        keys, expressions = [key for key, _ in pairs], [text for _, text in pairs]
        return Scene._made(self._of.with_settings(keys, expressions))

    def case(self, name: str) -> Scene:
        """Returns the scene with the values of one of its load cases, like ``--case``."""
        return Scene._made(self._of.case(arguments.text("name", name)))

    # Methods that compute results.

    def simulate(
        self,
        t_end: float | None = None,
        *,
        rtol: float | None = None,
        atol: float | None = None,
        max_step: float | None = None,
        max_steps: int | None = None,
        output_step: float | None = None,
        method: str | None = None,
        threads: int | None = None,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        max_memory: int | str | None = None,
        reactions: bool | Iterable[str] = True,
        choose: Choice | Sequence[Choice] | None = None,
        bounds: bool | Bounds = False,
        drives: Mapping[str, DriveLaw] | None = None,
        forces: Mapping[str, BodyForce] | None = None,
        controller: Controller | None = None,
        start: StartArgument | None = None,
        on_event: Callable[[Event], object] | None = None,
        on_row: Callable[[float], object] | None = None,
    ) -> Run:
        """Runs the scene; an option that is ``None`` has the value in the scene.

        ``reactions`` selects all reactions, no reaction, or the reactions with these names. Values
        that are not unique in the interval between two events are NaN, unless ``choose`` gives a
        choice: ``"kept-rows"`` for the independent rows of the run, a list of rows to delete
        (1-based), or a choice of :meth:`Analysis.reactions`. Such a choice is ``"minimum-norm"``,
        ``"minimum-norm:length=0.5"`` (m), or compliances by name, such as ``{"left": 1e-6, "right":
        (2e-6, 1e-3)}`` (m/N, and rad/(N·m)). With a list of these choices ``run.choices`` contains
        the values for each choice, and NaN remains in ``run.reactions``.

        With ``bounds`` the attributes ``run.lowest`` and ``run.highest`` contain the bounds of all
        reactions for joints of any stiffness. A dictionary with the keys ``rigid``, ``within`` and
        ``compliance`` selects the elastic joints.

        ``on_event`` receives each :class:`Event` at the first row after the event, and ``on_row``
        receives the time of each row. The run ends if one of the two functions returns ``True``.
        Ctrl-C works only on the main thread.

        ``drives`` are functions ``f(t, measure, rate)`` that replace the laws of these drives.
        These functions return the force (N) or torque (N·m). ``forces`` are functions ``f(t,
        body)`` of a :class:`BodyState`. These functions return force and torque on this body.
        Functions are called at stages of steps, not in the order of time, and must return the same
        value for the same state. Methods that need derivatives reject them. An exception in a
        function ends the run and is raised.

        ``controller`` is a function ``f(t, state)`` of the whole :class:`State`. It returns a
        dictionary with forces and torques of drives, and with forces and torques on bodies.
        ``start`` is a state, or time, coordinates and velocities, at which the run starts.
        Prescribed motions continue at this time.
        """
        options = _options(
            t_end=t_end,
            rtol=rtol,
            atol=atol,
            max_step=max_step,
            max_steps=max_steps,
            output_step=output_step,
            method=method,
            threads=threads,
            tolerance=tolerance,
            angle_tolerance=angle_tolerance,
            max_memory=max_memory,
            drop=dropped(choose),
            reactions=_wanted(reactions),
            bounds=bounds,
        )
        kept, choices = of_run(choose)
        if on_row is not None:
            arguments.function("on_row", on_row, "the time")
        if on_event is not None:
            arguments.function("on_event", on_event, "an event")
        told = None if on_event is None else lambda text: on_event(Event(**json.loads(text)))
        laws, pushes = of_drives(drives), of_bodies(forces)
        whole = of_controller(controller, self._of.kinematics)
        begun = of_start(start)
        of = self._of.simulate(
            _native(options), kept, choices, told, on_row, laws, pushes, whole, begun
        )
        again = {key: x for key, x in options.items() if key != "reactions"}
        again = {**again, "choices": choices, "drives": drives, "forces": forces}
        again = {**again, "controller": controller, "start": begun}
        run = Run(of, self, again, isinstance(choose, (str, Mapping)) and not kept)
        stopped = of.stopped()
        if stopped is not None:
            stopped.run = run
            raise stopped
        return run

    def simulate_into(self, directory: str | os.PathLike[str], **options: Any) -> dict[str, Any]:
        """Runs the scene and writes the files of ``pfaff simulate`` into a directory.

        Returns the summary. The options are the options of :meth:`simulate` except ``on_event`` and
        ``on_row``.
        """
        _choose(options)
        _known(options)
        return self._into(directory, options, None)

    def _into(
        self, directory: str | os.PathLike[str], options: Mapping[str, Any], until: float | None
    ) -> dict[str, Any]:
        own = dict(options)
        laws, pushes = of_drives(own.pop("drives", None)), of_bodies(own.pop("forces", None))
        whole = of_controller(own.pop("controller", None), self._of.kinematics)
        begun = of_start(own.pop("start", None))
        choices = own.pop("choices", [])
        place = arguments.path("directory", directory)
        summary = self._of.simulate_into(
            place, _native(_options(**own)), choices, until, laws, pushes, whole, begun
        )
        document: dict[str, Any] = json.loads(summary)
        return document

    def report(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Runs the scene and writes its page for any browser, even if the run stops."""
        _choose(options)
        _known(options)
        self._page(path, options, None)

    def _page(
        self, path: str | os.PathLike[str], options: Mapping[str, Any], until: float | None
    ) -> None:
        # These modules are imported here, because their import takes long.
        from shutil import move
        from tempfile import TemporaryDirectory

        with TemporaryDirectory() as folder:
            page = os.path.join(folder, "report.html")
            try:
                self._into(folder, options, until)
                if not os.path.exists(page):
                    raise wrong("the scene wants no report: `output.report` is false")
            finally:
                # The page of a run that stops shows its results up to that time.
                if os.path.exists(page):
                    move(page, path)

    def sweep(
        self,
        vary: Vary,
        out: str | os.PathLike[str] | None = None,
        threads: int | None = None,
        **options: Any,
    ) -> SweepResult:
        """Runs the scene with every combination of values, on this machine.

        See :func:`pfaff.cluster.sweep`, which also accepts the other options.
        """
        return sweep(self, vary, None, out=out, threads=threads, **options)

    def view(
        self,
        path: str | os.PathLike[str],
        *,
        scale: float | None = None,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        max_memory: int | str | None = None,
    ) -> None:
        """Writes the assembled start as a page or picture, with joints marked by their verdicts.

        A name that ends with ``.html`` gives a page, ``.svg`` a picture, and ``.png`` also a
        picture, if the package was built with the feature ``png``. ``scale`` is the number of PNG
        pixels for each px of the picture.
        """
        common = Common(tolerance, angle_tolerance, None, max_memory)
        name = arguments.path("path", path)
        pixels = arguments.maybe(arguments.number, "scale", scale)
        content, boxes = self._of.view(name, pixels, common.checked())
        with open(name, "wb") as file:
            file.write(content)
        if boxes:
            warnings.warn(f"no font has these characters: {boxes}", stacklevel=2)

    def state(self, at_time: float | None = None) -> State:
        """Returns the state at the start, or at a time (s) of the motion."""
        kinematics = self._of.kinematics()
        t = kinematics.start_time if at_time is None else arguments.finite("at_time", at_time)
        q, v = self._of.state(t, Common().checked(), None)
        return State(kinematics, t, np.asarray(q), np.asarray(v))

    def starting_at(self, start: StartArgument) -> Scene:
        """Returns the scene that starts at a state and time.

        The text contains the poses and velocities of the bodies, and the time. Prescribed motions
        continue at this time.
        """
        given = of_start(start)
        assert given is not None
        return Scene._made(self._of.started_text(*given))

    def matrices(
        self,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        t: float = 0.0,
        *,
        max_memory: int | str | None = None,
    ) -> Matrices:
        """Returns C, M, Γ, Q, b and Φ at coordinates and velocities, by default at the start.

        C and M are dense: matrices that need more than ``max_memory`` are rejected.
        """
        c, mass, gamma, q_applied, b, phi = self._of.matrices(
            _numbers("q", q),
            _numbers("v", v),
            arguments.number("t", t, "a time (s)"),
            arguments.maybe(arguments.size, "max_memory", max_memory),
        )
        return Matrices(c, np.diag(mass), gamma, q_applied, b, phi)

    def _asked(
        self,
        question: str,
        options: dict[str, Any],
        common: Common,
        others: Iterable[Questions] = (),
        files: bool = False,
    ) -> Answer:
        about = [arguments.instance("other", other, Scene)._of for other in others]
        words = json.dumps(options)
        document, made = self._of.ask(question, words, about, common.checked(), files)
        return Answer(self, options, common, json.loads(document), dict(made))

    def _repr_html_(self) -> str:
        return self.analyze()._repr_html_()


def templates() -> dict[str, str]:
    """Returns the templates by name, with descriptions; :meth:`Scene.new` uses them."""
    return dict(_pfaff.templates())


def _between(bodies: Bodies | None) -> dict[str, Any]:
    return {"body" if isinstance(bodies, str) else "bodies": bodies}


_CHECKS: dict[str, Callable[[str, Any], Any]] = {
    "t_end": arguments.finite,
    "rtol": arguments.finite,
    "atol": arguments.finite,
    "max_step": arguments.finite,
    "max_steps": arguments.count,
    "method": arguments.text,
    "threads": arguments.count,
    "drop": arguments.rows,
    "output_step": arguments.number,
    "tolerance": arguments.number,
    "angle_tolerance": arguments.number,
    "reactions": arguments.texts,
    "max_memory": arguments.size,
    "bounds": as_bounds,
}
"""Options of a run with their checks."""


def _options(**options: Any) -> dict[str, Any]:
    return {
        name: arguments.maybe(check, name, options.get(name)) for name, check in _CHECKS.items()
    }


_OF_RUN = ("t_end", "rtol", "atol", "max_step", "max_steps", "method", "drop")
"""Options of a run that replace options of the scene."""


def _native(options: Mapping[str, Any]) -> dict[str, Any]:
    """Converts the options of a run to the format of the library."""
    run = json.dumps({name: options[name] for name in _OF_RUN})
    common = Common(*(options.get(name) for name in Common._fields))._asdict()
    rest = {name: options[name] for name in ("output_step", "reactions", "bounds")}
    return {"run": run, "common": common, **rest}


def native_options(**options: Any) -> dict[str, Any]:
    """Checks options of a run, and converts them to the format of the library."""
    return _native(_options(**options))


def _known(options: Mapping[str, Any]) -> None:
    """Rejects an unknown option with the same error as an unknown keyword."""
    known = [*_CHECKS, "choices", "drives", "forces", "controller", "start"]
    for name in options:
        if name not in known:
            near = _pfaff.nearest(name, known)
            advice = f"; did you mean `{near}`?" if near else ""
            raise TypeError(f"there is no option `{name}`{advice}")


def _choose(options: dict[str, Any]) -> None:
    """Replaces ``choose`` by the rows to delete and the other choices."""
    if "choose" in options:
        choose = options.pop("choose")
        options["drop"] = dropped(choose)
        options["choices"] = of_run(choose)[1]


def _wanted(reactions: bool | Iterable[str]) -> list[str] | None:
    if isinstance(reactions, bool):
        return None if reactions else []
    if isinstance(reactions, str):
        return [reactions]
    needed = "True, False, a name or names"
    return arguments.listed("reactions", reactions, arguments.text, needed)


def _entries(key: str, item: Any) -> list[tuple[str, str]]:
    """Returns a key with its text, or a key and a text for each entry of a list."""
    if isinstance(item, str):
        return [(key, item)]
    if isinstance(item, (bool, np.bool_)):
        return [(key, str(int(item)))]
    if isinstance(item, Iterable):
        return [pair for k, x in enumerate(item) for pair in _entries(f"{key}[{k}]", x)]
    try:
        return [(key, toml.number(float(item)))]
    except (TypeError, ValueError):
        raise wrong_type(f"`{key}`", item, "a number, an expression or a list") from None


def _numbers(name: str, of: ArrayLike | None) -> list[float] | None:
    if of is None:
        return None
    try:
        array = np.asarray(of, dtype=np.float64)
    except (TypeError, ValueError):
        raise wrong_type(name, of, "a list or an array of numbers") from None
    if array.ndim != 1:
        raise wrong(f"{name} has {array.ndim} dimensions, need 1")
    numbers: list[float] = array.tolist()
    return numbers
