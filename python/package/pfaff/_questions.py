"""Questions about a scene. Written by `cargo xtask questions`."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

from . import _arguments as arguments
from ._answer import Answer, Common
from ._analysis import Analysis
from ._linearisation import Linearisation
from ._samples import Samples
from ._comparison import WorkPrecision


class Questions:
    """The questions that are asked of a scene: methods of :class:`Scene`.

    All take the same last keywords. ``tolerance`` (m) and ``angle_tolerance`` (rad) say what the
    numbers of the scene are known to, in place of those of the scene. ``max_memory`` (bytes, or as
    ``"4GB"``) refuses what needs more; ``threads`` is the number of threads, by default one for
    each core. ``out`` is a directory for the files of the command of the same name.
    """

    __slots__ = ()

    def _asked(
        self,
        question: str,
        options: dict[str, Any],
        common: Common,
        others: Iterable[Questions] = (),
        files: bool = False,
    ) -> Answer:
        raise NotImplementedError

    def analyze(
        self,
        at_time: float = 0.0,
        *,
        drop: Iterable[int] | None = None,
        combine: Iterable[str] = (),
        make_unique: Iterable[str] = (),
        allow: str = "sensible",
        eliminations: int | None = None,
        frames: bool = False,
        about: str | None = None,
        along: float | str | None = None,
        choose: Iterable[str] = (),
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
    ) -> Analysis:
        """Rank, redundancy, and the verdict of every reaction.

        As ``pfaff analyze --json``.

        - ``at_time``: Time of the motion at which the mechanism is analysed (s)
        - ``drop``: Rows to take as the dependent ones, counted from 1
        - ``combine``: A sum of components to judge, as "W3.N + W4.N"
        - ``make_unique``: Find the smallest sets of rows to delete so that this reaction becomes
          unique
        - ``allow``: What may be deleted for ``make_unique``: sensible (no joint of several rows
          loses all of them), whole (joints and drives as a whole), rows (any), or rows:4,6,21
          (these)
        - ``eliminations``: List at most N sets of rows that can be eliminated without a change of
          the motion
        - ``frames``: Also judge the components in the frames of the first body, of the edge and of
          the joint
        - ``about``: Also judge moments about this point: X,Y in the plane, X,Y,Z in space (m,
          ground axes), or the name of a marker
        - ``along``: Run the motion, for the duration that the scene states or to T_END (s): the
          verdict that holds along it, and the intervals with other verdicts
        - ``choose``: Compute the reactions for a choice: minimum-norm, minimum-norm:length=L (a
          torque counts as a force on an arm of length L), compliance:W3=1e-6,W4=2e-6 (m/N; NAME=M/R
          adds rad/(N·m)), drop:6,21
        """
        options: dict[str, Any] = {
            "at_time": arguments.finite("at_time", at_time),
            "drop": arguments.maybe(arguments.rows, "drop", drop),
            "combine": arguments.texts("combine", combine),
            "make_unique": arguments.texts("make_unique", make_unique),
            "allow": arguments.text("allow", allow),
            "eliminations": arguments.maybe(arguments.count, "eliminations", eliminations),
            "frames": arguments.flag("frames", frames),
            "about": arguments.maybe(arguments.text, "about", about),
            "along": arguments.maybe(arguments.finite_or_word, "along", along),
            "choose": arguments.texts("choose", choose),
        }
        common = Common(tolerance, angle_tolerance, threads, max_memory)
        answer = self._asked("analyze", options, common)
        return Analysis(answer)

    def plan(
        self,
        vary: Mapping[str, str] | Iterable[str] = (),
        *,
        t_end: float | None = None,
        rtol: float | None = None,
        atol: float | None = None,
        max_step: float | None = None,
        max_steps: int | None = None,
        method: str | None = None,
        stabilisation: str | None = None,
        drop: Iterable[int] | None = None,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
    ) -> dict[str, Any]:
        """What a run of the scene computes and omits, and why.

        As ``pfaff plan --json``.

        - ``vary``: Also say how the runs of a sweep with these values are evaluated: as of
          ``sweep``
        - ``t_end``: Last time (s)
        - ``rtol``: Relative tolerance
        - ``atol``: Absolute tolerance
        - ``max_step``: Largest step (s)
        - ``max_steps``: Most steps, accepted and rejected, after which the run stops
        - ``method``: Integrator
        - ``stabilisation``: Treatment of drift
        - ``drop``: Rows to eliminate, counted from 1
        """
        options: dict[str, Any] = {
            "vary": arguments.settings("vary", vary),
            "run": {
                "t_end": arguments.maybe(arguments.finite, "t_end", t_end),
                "rtol": arguments.maybe(arguments.finite, "rtol", rtol),
                "atol": arguments.maybe(arguments.finite, "atol", atol),
                "max_step": arguments.maybe(arguments.finite, "max_step", max_step),
                "max_steps": arguments.maybe(arguments.count, "max_steps", max_steps),
                "method": arguments.maybe(arguments.text, "method", method),
                "stabilisation": arguments.maybe(arguments.text, "stabilisation", stabilisation),
                "drop": arguments.maybe(arguments.rows, "drop", drop),
            },
        }
        common = Common(tolerance, angle_tolerance, threads, max_memory)
        answer = self._asked("plan", options, common)
        return answer.document

    def check(
        self,
        *,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
    ) -> dict[str, Any]:
        """Read and assemble only: report every error of the file, with its place.

        As ``pfaff check --json``.
        """
        options: dict[str, Any] = {}
        common = Common(tolerance, angle_tolerance, threads, max_memory)
        answer = self._asked("check", options, common)
        return answer.document

    def equilibrium(
        self,
        stable: bool = False,
        *,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
        out: str | os.PathLike[str] | None = None,
    ) -> dict[str, Any]:
        """A start at rest: where forces balance near the described start.

        As ``pfaff equilibrium --json``.

        - ``stable``: Leave places that are not stable by a small push, and search on
        """
        options: dict[str, Any] = {
            "stable": arguments.flag("stable", stable),
        }
        common = Common(tolerance, angle_tolerance, threads, max_memory, out)
        answer = self._asked("equilibrium", options, common)
        return answer.document

    def linearise(
        self,
        at_time: float = 0.0,
        *,
        coordinates: Iterable[str] = (),
        follow: Iterable[str] = (),
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
        out: str | os.PathLike[str] | None = None,
    ) -> Linearisation:
        """Small motions about a state at rest or a steady one: matrices, eigenvalues, modes.

        As ``pfaff linearise --json``.

        - ``at_time``: Time of the motion at which it is linearised (s)
        - ``coordinates``: Independent coordinates to use, such as crank.angle or rod.x, in space
          also rod.rz; the others are chosen
        - ``follow``: Coordinates in which a steady motion goes on, such as
          frame.x,frame.y,frame.wz: they are left out, and the axes turn with the latter
        """
        options: dict[str, Any] = {
            "at_time": arguments.finite("at_time", at_time),
            "coordinates": arguments.texts("coordinates", coordinates),
            "follow": arguments.texts("follow", follow),
        }
        common = Common(tolerance, angle_tolerance, threads, max_memory, out)
        answer = self._asked("linearise", options, common)
        return Linearisation(answer)

    def tolerance(
        self,
        runs: int = 1000,
        *,
        vary: Mapping[str, str] | Iterable[str] = (),
        seed: int = 1,
        at_time: float = 0.0,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
        out: str | os.PathLike[str] | None = None,
    ) -> Samples:
        """Data within their tolerances: how far verdicts, reactions and places hold.

        As ``pfaff tolerance --json``.

        - ``runs``: Number of samples
        - ``vary``: A parameter or number of the scene that varies besides, and by how much:
          KEY=±VALUE or KEY=±P%
        - ``seed``: Another seed gives other samples
        - ``at_time``: Time of the motion at which the samples are analysed (s)
        """
        options: dict[str, Any] = {
            "runs": arguments.count("runs", runs),
            "vary": arguments.settings("vary", vary),
            "seed": arguments.count("seed", seed),
            "at_time": arguments.finite("at_time", at_time),
        }
        common = Common(tolerance, angle_tolerance, threads, max_memory, out)
        answer = self._asked("tolerance", options, common, files=True)
        return Samples(answer)

    def diff(
        self,
        other: Questions,
        *,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
    ) -> dict[str, Any]:
        """Compare two scenes: ranks, verdicts, dependencies, motion.

        As ``pfaff diff --json``.
        """
        options: dict[str, Any] = {}
        common = Common(tolerance, angle_tolerance, threads, max_memory)
        answer = self._asked("diff", options, common, [other])
        return answer.document

    def work_precision(
        self,
        quick: bool = False,
        *,
        all: bool = False,
        png: bool = False,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
        out: str | os.PathLike[str] | None = None,
    ) -> WorkPrecision:
        """Error versus run time, for every method and tolerance.

        As ``pfaff work-precision --json``.

        - ``quick``: Three tolerances, for a quick overview
        - ``all``: Every method with every stabilisation
        - ``png``: Also the figure as PNG (feature ``png``)
        """
        options: dict[str, Any] = {
            "quick": arguments.flag("quick", quick),
            "all": arguments.flag("all", all),
            "png": arguments.flag("png", png),
        }
        common = Common(tolerance, angle_tolerance, threads, max_memory, out)
        answer = self._asked("work-precision", options, common)
        return WorkPrecision(answer)
