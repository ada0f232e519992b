"""Small motions about a state."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._answer import Answer

Array = NDArray[np.float64]


class Linearisation:
    """The linearised motion ``ẋ = A·x + B·u`` about a state."""

    def __init__(self, answer: Answer) -> None:
        self.document = answer.document
        """The document of ``pfaff linearise --json``."""
        self.states: list[str] = [state["name"] for state in self.document["states"]]
        """Names of the states x: positions, then velocities."""
        self.inputs: list[str] = [f"{u['name']}.{u['what']}" for u in self.document["inputs"]]
        """Names of the inputs u."""
        self.A: Array = _matrix(self.document["a"], len(self.states))
        """The matrix of the states."""
        self.B: Array = _matrix(self.document["b"], len(self.inputs))
        """The matrix of the inputs."""

    @property
    def stability(self) -> str | None:
        """``stable``, ``unstable``, or ``undecided`` at first order."""
        word: str | None = self.document["stability"]
        return word

    @property
    def eigenvalues(self) -> NDArray[np.complex128]:
        """Eigenvalues (1/s) by decreasing growth rate; a conjugate pair is listed once."""
        modes = self.document["modes"] or []
        return np.array([complex(m["real"], m["imaginary"]) for m in modes], dtype=np.complex128)

    @property
    def second_order(self) -> tuple[Array, Array, Array] | None:
        """The matrices M, D and K of ``M·ÿ + D·ẏ + K·y``, if they exist."""
        of = self.document["second_order"]
        if of is None:
            return None
        n = self.document["positions"]
        return (_matrix(of["mass"], n), _matrix(of["damping"], n), _matrix(of["stiffness"], n))

    def __repr__(self) -> str:
        return f"<pfaff.Linearisation: {len(self.states)} states, {self.stability}>"


def _matrix(rows: list[list[float]], columns: int) -> Array:
    return np.array(rows, dtype=np.float64).reshape(len(rows), columns)
