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
    """Questions about a scene: methods of :class:`Scene`.

    All methods accept the same final keywords. ``tolerance`` (m) and ``angle_tolerance`` (rad)
    state the accuracy of the numbers of the scene and replace the tolerances of the scene.
    ``max_memory`` (bytes, or as ``"4GB"``) rejects computations that need more; ``threads`` is the
    number of threads, by default one for each core. ``out`` is a directory for the files of the
    command of the same name.
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
        remedies: bool = False,
        bounds: bool = False,
        rigid: Iterable[str] = (),
        within: float | None = None,
        compliance: str | None = None,
        matrices: bool = False,
        along: float | str | None = None,
        choose: Iterable[str] = (),
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
        out: str | os.PathLike[str] | None = None,
    ) -> Analysis:
        """Compute rank, redundancy and a verdict for every reaction.

        As ``pfaff analyze --json``.

        - ``at_time``: Analyse the motion at this time (s)
        - ``drop``: Rows to treat as dependent (1-based)
        - ``combine``: Analyse a sum of components, e.g. "W3.N + W4.N"
        - ``make_unique``: Find the fewest rows to delete for a unique reaction
        - ``allow``: Rows that ``make_unique`` may delete: sensible (a joint of several rows keeps
          one), whole (whole joints and drives), rows (any), rows:4,6,21 (only these)
        - ``eliminations``: List up to N sets of rows that can be eliminated without changing the
          motion
        - ``frames``: Also analyse components in the frames of body, edge and joint
        - ``about``: Also analyse moments about a point X,Y or X,Y,Z (m) or a marker
        - ``remedies``: Propose other types of joints that make reactions unique, also in JSON and
          Python; the text always does so for small mechanisms
        - ``bounds``: Also bound reactions for joints of any stiffness
        - ``rigid``: Joints and drives that count as rigid in ``bounds``; ``drives`` names all
          drives
        - ``within``: Limit the compliances in ``bounds`` to a range from the nominal ones to K
          times these
        - ``compliance``: Nominal compliances for ``within``, as W3=1e-6,W4=2e-6 (m/N; NAME=M/R adds
          rad/(N·m)); others do not give way. Default: all equal
        - ``matrices``: Print Φq, Ψ and Γ with names of rows and columns; ``out`` writes them as CSV
        - ``along``: Analyse along the motion to T_END (s): the generic verdict and the intervals
          where it differs
        - ``choose``: Compute reactions for a choice: minimum-norm, minimum-norm:length=L (L: arm
          that converts torques to forces), compliance:W3=1e-6,W4=2e-6 (m/N; NAME=M/R adds
          rad/(N·m)), the same with ;misfit:W3=DX,DY (m, then rad: the second body, or the ground,
          is displaced), drop:6,21
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
            "remedies": arguments.flag("remedies", remedies),
            "elastic": {
                "bounds": arguments.flag("bounds", bounds),
                "rigid": arguments.texts("rigid", rigid),
                "within": arguments.maybe(arguments.finite, "within", within),
                "compliance": arguments.maybe(arguments.text, "compliance", compliance),
            },
            "matrices": arguments.flag("matrices", matrices),
            "along": arguments.maybe(arguments.finite_or_word, "along", along),
            "choose": arguments.texts("choose", choose),
        }
        common = Common(tolerance, angle_tolerance, threads, max_memory, out)
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
        """Report what a run computes and omits, with reasons.

        As ``pfaff plan --json``.

        - ``vary``: Also report how a sweep with these values evaluates its runs
        - ``t_end``: End time (s)
        - ``rtol``: Relative tolerance
        - ``atol``: Absolute tolerance
        - ``max_step``: Maximum step size (s)
        - ``max_steps``: Maximum number of steps (accepted + rejected)
        - ``method``: Integrator
        - ``stabilisation``: Method against constraint drift
        - ``drop``: Rows to eliminate (1-based)
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
        """Read and assemble the scene; report all errors.

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
        """Find a static equilibrium near the start.

        As ``pfaff equilibrium --json``.

        - ``stable``: Skip unstable equilibria: perturb and continue
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
        """Linearise at rest or in steady motion: eigenvalues, modes.

        As ``pfaff linearise --json``.

        - ``at_time``: Linearise the motion at this time (s)
        - ``coordinates``: Independent coordinates to use, e.g. crank.angle, rod.x, rod.rz (space);
          others are chosen automatically
        - ``follow``: Cyclic coordinates of a steady motion, e.g. frame.x,frame.y,frame.wz; they are
          eliminated, and the axes rotate with frame.wz
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
        bounds: bool = False,
        rigid: Iterable[str] = (),
        within: float | None = None,
        compliance: str | None = None,
        tolerance: float | None = None,
        angle_tolerance: float | None = None,
        threads: int | None = None,
        max_memory: int | str | None = None,
        out: str | os.PathLike[str] | None = None,
    ) -> Samples:
        """Run a Monte-Carlo analysis of the tolerances.

        As ``pfaff tolerance --json``.

        - ``runs``: Number of samples
        - ``vary``: Also vary a parameter or number: KEY=±VALUE or KEY=±P%
        - ``seed``: Random seed
        - ``at_time``: Analyse the samples at this time (s)
        - ``bounds``: Also bound reactions for joints of any stiffness
        - ``rigid``: Joints and drives that count as rigid in ``bounds``; ``drives`` names all
          drives
        - ``within``: Limit the compliances in ``bounds`` to a range from the nominal ones to K
          times these
        - ``compliance``: Nominal compliances for ``within``, as W3=1e-6,W4=2e-6 (m/N; NAME=M/R adds
          rad/(N·m)); others do not give way. Default: all equal
        """
        options: dict[str, Any] = {
            "runs": arguments.count("runs", runs),
            "vary": arguments.settings("vary", vary),
            "seed": arguments.count("seed", seed),
            "at_time": arguments.finite("at_time", at_time),
            "elastic": {
                "bounds": arguments.flag("bounds", bounds),
                "rigid": arguments.texts("rigid", rigid),
                "within": arguments.maybe(arguments.finite, "within", within),
                "compliance": arguments.maybe(arguments.text, "compliance", compliance),
            },
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
        """Compare ranks, verdicts, dependencies and motion of two scenes.

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
        """Measure error against run time of all methods.

        As ``pfaff work-precision --json``.

        - ``quick``: Use only three tolerances
        - ``all``: Measure every method with every stabilisation
        - ``png``: Also write the figure as PNG (feature ``png``)
        """
        options: dict[str, Any] = {
            "quick": arguments.flag("quick", quick),
            "all": arguments.flag("all", all),
            "png": arguments.flag("png", png),
        }
        common = Common(tolerance, angle_tolerance, threads, max_memory, out)
        answer = self._asked("work-precision", options, common)
        return WorkPrecision(answer)
