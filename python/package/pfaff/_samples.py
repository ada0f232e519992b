"""Samples of data within their tolerances, and their combined results."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._errors import unknown

if TYPE_CHECKING:
    from ._answer import Answer

Values = NDArray[Any]


class Samples:
    """Samples of a scene; the data of each sample vary within their tolerances."""

    def __init__(self, answer: Answer) -> None:
        self.scene = answer.scene
        """The scene of the samples."""
        self.document = answer.document
        """The document of ``pfaff tolerance --json``."""
        self.table: dict[str, Values] = {}
        """The columns of ``tolerance.csv``: numeric, or texts for ``status`` and verdicts.

        Values that do not exist in a sample are NaN.
        """
        rows = csv.reader(io.StringIO(answer.files["tolerance.csv"].decode()))
        headings = next(rows)
        for name, column in zip(headings, zip(*rows), strict=False):
            self.table.setdefault(name, _values(column))
        self.table["sample"] = self.table["sample"].astype(np.int64)
        self._seal()

    def _seal(self) -> None:
        for array in self.table.values():
            array.flags.writeable = False

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._seal()

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return list(self.table)

    @property
    def reactions(self) -> Mapping[str, dict[str, Any]]:
        """Ranges and verdicts of joints and drives by name, the largest relative range first."""
        return {r["name"]: r for r in self.document["reactions"]}

    def __getitem__(self, column: str) -> Values:
        """Returns the values of a column, one for each sample."""
        if column not in self.table:
            raise unknown("column", column, self.table)
        return self.table[column]

    def to_pandas(self) -> Any:
        """Returns the table as a ``pandas.DataFrame`` with the sample numbers as its index."""
        import pandas

        return pandas.DataFrame(self.table).set_index("sample")

    def to_polars(self) -> Any:
        """Returns the table as a ``polars.DataFrame``."""
        import polars

        return polars.DataFrame(self.table)

    def plot(self, *columns: str, bins: int = 24, ax: Any = None) -> Any:
        """Draws histograms of columns; returns the axes. This method needs matplotlib."""
        values = [(column, self[column].astype(np.float64)) for column in columns]
        if ax is None:
            from matplotlib import pyplot

            _, ax = pyplot.subplots()
        for column, numbers in values:
            ax.hist(numbers[np.isfinite(numbers)], bins=bins, alpha=0.6, label=column)
        ax.set_ylabel("samples")
        ax.legend()
        return ax

    def __len__(self) -> int:
        return len(self.table["sample"])

    def __repr__(self) -> str:
        assembled = self.document["assembled"]
        return f"<pfaff.Samples: {len(self)}, of which {assembled} could be assembled>"


def _values(column: tuple[str, ...]) -> Values:
    """Returns values as numbers, or as texts if a value is not a number."""
    try:
        return np.array([float(cell) for cell in column], dtype=np.float64)
    except ValueError:
        return np.array(column)
