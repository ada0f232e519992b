"""Compares the exact motions with digits from other sources.

usage: python tests/peers/engines/check_references.py

The motions of the top and of the n-four-bar are closed forms, evaluated with at least 20 digits.
The motion of Bricard's linkage is derived again with other coordinates. Every difference must be
below 1e-10.
"""

from __future__ import annotations

import numpy as np

import scenes
from mechanism import Array
from reference import pendulum_of_bars

TOP = {
    0.5: [-0.70246829705658558934, -0.02116518470192332658, -0.71140025765173740555],
    1.0: [0.17334396409838604259, 0.64008859206857078286, -0.74849079113358130948],
}
TWO_FOUR_BARS = {
    1.0: [-0.1950203019494350936, -0.9807992056621738326],
    5.0: [-0.8113104610051074122, -0.5846155453489755477],
    10.0: [0.3284581115408153787, 0.9445185381786009612],
}
BRICARD_ANGLE = -1.035028459518


def differences() -> dict[str, float]:
    """Returns the largest difference for each known motion."""
    top = scenes.make("top", 1).reference(np.array(list(TOP)))[:, 0]
    angles = pendulum_of_bars(2, 1.0)(np.array(list(TWO_FOUR_BARS)))
    tops: Array = np.stack([np.sin(angles), np.cos(angles)], axis=1)
    rod = scenes.make("bricard", 1).reference(np.array([0.5, 1.0]))[1, 0]
    return {
        "top": float(np.abs(top - np.array(list(TOP.values()))).max()),
        "n-four-bar, n = 2": float(np.abs(tops - np.array(list(TWO_FOUR_BARS.values()))).max()),
        "bricard": abs(float(np.arctan2(rod[2], rod[0])) - BRICARD_ANGLE),
    }


if __name__ == "__main__":
    for name, difference in differences().items():
        print(f"{name}: {difference:.1e}")
        assert difference < 1e-10, name
