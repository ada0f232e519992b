"""Figures of error against run time (s), on the same axes for all engines, including failures."""

from __future__ import annotations

import math
from pathlib import Path

import matplotlib as mpl
from matplotlib import pyplot as plt

import report

mpl.use("svg")
mpl.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "engines", "font.size": 9})

COLOURS = {
    "pfaff": "#000000",
    "exudyn": "#d55e00",
    "mujoco": "#0072b2",
    "drake": "#009e73",
    "pinocchio": "#aa4499",
}
MARKERS = {"pfaff": "o", "exudyn": "s", "mujoco": "^", "drake": "D", "pinocchio": "v"}
LARGEST = 30.0
"""Largest drawn error (m); failed runs are drawn at this value."""


def panel(axes: plt.Axes, problem: report.Problem, listed: list[report.Line]) -> None:
    """Draws one scene."""
    axes.set(xscale="log", yscale="log", xlim=(5e-5, 60.0), ylim=(1e-11, 100.0))
    axes.set_title(f"{problem[0]}" + (f", N = {problem[1]}" if "bar" in problem[0] else ""))
    axes.axhline(1e-5, color="#999999", linewidth=0.8, linestyle=":")
    axes.minorticks_off()
    axes.grid(visible=True, which="major", color="#eeeeee")
    for engine in report.ENGINES:
        of_engine = [line for line in listed if line.engine == engine]
        main = (
            report.fastest(of_engine, engine, True)
            or report.fastest(of_engine, engine, False)
            or min(of_engine, key=least_error, default=None)
        )
        for line in of_engine:
            curve(axes, line, is_main=line is main)


def least_error(line: report.Line) -> float:
    """Returns the smallest error of a line."""
    best = line.best()
    return best.error if best else math.inf


def curve(axes: plt.Axes, line: report.Line, is_main: bool) -> None:
    """Draws one setting: a line through the finished runs, and crosses for the others."""
    colour = COLOURS[line.engine]
    style = {"color": colour, "alpha": 1.0 if is_main else 0.3}
    done = line.done()
    axes.plot(
        [point.median for point in done],
        [min(point.error, LARGEST) for point in done],
        marker=MARKERS[line.engine],
        markersize=3.5 if is_main else 2.5,
        linewidth=1.4 if is_main else 0.7,
        label=report.TITLES[line.engine] if is_main else None,
        **style,
    )
    failed = [point for point in line.points if not point.is_done and point.seconds]
    axes.plot(
        [point.median for point in failed],
        [LARGEST] * len(failed),
        "x",
        markersize=5,
        clip_on=False,
        **style,
    )


def sheet(path: Path, problems: list[report.Problem], listed: list[list[report.Line]]) -> None:
    """Returns a figure with a panel for each scene."""
    columns = min(4, len(problems))
    rows = math.ceil(len(problems) / columns)
    size = (3.1 * columns, 2.8 * rows + 0.4)
    figure, grid = plt.subplots(rows, columns, figsize=size, squeeze=False, sharey=True)
    panels = list(grid.flat)
    for axes, problem, lines in zip(panels, problems, listed, strict=False):
        panel(axes, problem, lines)
    for axes in panels[len(problems) :]:
        axes.axis("off")
    for axes in grid[-1]:
        axes.set_xlabel("seconds")
    for axes in grid[:, 0]:
        axes.set_ylabel("largest error (m)")
    handles = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    figure.legend(handles.values(), handles.keys(), loc="upper center", ncol=5, frameon=False)
    high = size[1]
    figure.subplots_adjust(
        left=0.06, right=0.99, bottom=0.5 / high, top=1.0 - 0.65 / high, wspace=0.08, hspace=0.3
    )
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)
    # The sheet is white, and lines have no blanks at their ends.
    text = "\n".join(line.rstrip() for line in path.read_text().splitlines()) + "\n"
    path.write_text(text)


def draw(out: Path, lines: dict, problems: list[report.Problem]) -> None:
    """Draws both figures."""
    loops = [problem for problem in problems if problem[0].startswith("n-four-bar")]
    loops.sort(key=lambda problem: (problem[0], problem[1]))
    others = [problem for problem in problems if problem not in loops]
    for name, chosen in (("loops", loops), ("scenes", others)):
        if chosen:
            listed = [report.with_models_of_space(lines, problem) for problem in chosen]
            sheet(out / f"{name}.svg", chosen, listed)
