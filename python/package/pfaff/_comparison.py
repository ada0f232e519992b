"""Measured error and run time of the methods on one scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._errors import unknown

if TYPE_CHECKING:
    from ._answer import Answer

Array = NDArray[np.float64]

_ERRORS = ("error_position", "error_velocity", "error_acceleration", "error_reaction")


class Curve(NamedTuple):
    """The runs of one method that reached their end, sorted from loose to tight tolerances."""

    tolerance: Array
    """Relative and absolute tolerance."""
    seconds: Array
    """Shortest time of a run (s)."""
    error: Array
    """The larger error of position and velocity, relative to the size of the mechanism."""
    evaluations: Array
    """Evaluations of accelerations."""


class WorkPrecision:
    """The runs of one scene with every method at many tolerances."""

    def __init__(self, answer: Answer) -> None:
        self.document = answer.document
        """The document of ``pfaff work-precision --json``."""
        (self._scene,) = self.document["scenes"]
        rows: list[dict[str, Any]] = [_flat(row) for row in self._scene["rows"]]
        self.table: dict[str, NDArray[Any]] = {
            name: _column([row[name] for row in rows]) for name in rows[0]
        }
        """One row for each run, with the columns of ``work_precision.csv``."""

    @property
    def methods(self) -> list[str]:
        """Names of the methods."""
        return list(dict.fromkeys(self.table["method"].tolist()))

    @property
    def automatic(self) -> str:
        """The method that runs of the scene use by default."""
        method: str = self._scene["automatic"]
        return method

    @property
    def reference_limit(self) -> float:
        """Accuracy of the reference; NaN if there is no reference."""
        limits = [np.nan if x is None else x for x in self._scene["reference"]["limits"][:2]]
        return float(np.max(limits))

    @property
    def summary(self) -> list[str]:
        """The fastest methods, as sentences."""
        summary: list[str] = self._scene["summary"]
        return summary

    def curve(self, method: str, stabilisation: str = "projection") -> Curve:
        """Returns the runs of a method that reached their end."""
        for name, word in (("method", method), ("stabilisation", stabilisation)):
            known = dict.fromkeys(self.table[name].tolist())
            if word not in known:
                raise unknown(name, word, known)
        table = self.table
        error = np.maximum(table["error_position"], table["error_velocity"])
        own = (table["method"] == method) & (table["stabilisation"] == stabilisation)
        own &= np.isfinite(error) & np.isfinite(table["seconds"])
        numbers = (table["tolerance"], table["seconds"], error, table["evaluations"])
        return Curve(*(column[own].astype(np.float64) for column in numbers))

    def plot(self, *methods: str, ax: Any = None) -> Any:
        """Draws the error of methods, all by default, against their run time; returns the axes."""
        curves = [(method, self.curve(method)) for method in methods or self.methods]
        if ax is None:
            from matplotlib import pyplot

            _, ax = pyplot.subplots()
        for method, curve in curves:
            if len(curve.error):
                ax.loglog(curve.error, curve.seconds, "o-", label=method)
        ax.set_xlabel("error")
        ax.set_ylabel("run time (s)")
        ax.legend()
        return ax

    def __repr__(self) -> str:
        runs, done = len(self.table["status"]), int((self.table["status"] == "done").sum())
        return f"<pfaff.WorkPrecision: {runs} runs, {done} of them to the end>"


def _flat(row: dict[str, Any]) -> dict[str, Any]:
    """Returns a run with its four errors as separate entries."""
    errors = row["errors"]
    rest = {name: value for name, value in row.items() if name != "errors"}
    return {**rest, **dict(zip(_ERRORS, errors, strict=True))}


def _column(values: list[Any]) -> NDArray[Any]:
    return np.array([np.nan if value is None else value for value in values])
