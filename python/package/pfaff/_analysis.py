"""Verdicts: the unique reactions, and changes that make other reactions unique."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _arguments as arguments
from ._choices import as_misfits, as_words
from ._errors import wrong

if TYPE_CHECKING:
    from ._answer import Answer

Array = NDArray[np.float64]
Point = Sequence[float] | str
"""Coordinates (m, ground axes), or the name of a marker."""
Allow = str | Sequence[int]
"""``"sensible"``, ``"whole"``, ``"rows"``, or rows that may be deleted (1-based)."""


@dataclass(frozen=True)
class ComponentVerdict:
    """The verdict on one component."""

    name: str
    verdict: str
    """``unique``, ``not_unique`` or ``undecided``."""
    margin: float
    """Distance of the component from uniqueness; a rounding error if the component is unique."""
    within_tolerance: bool
    """Whether the component is unique only within the stated tolerance."""
    sensitivity: float | None = None
    """Largest relative change if one point moves; ``None`` if not unique or not known."""
    fragile: bool = False
    """Whether the component is unique, but sensitive to the last digits of the data."""
    generic_verdict: str | None = None
    """The verdict at other configurations; ``None`` if no other configuration was reached.

    Components in other frames, components of moments and components of sums have no such verdict.
    """
    permitted: tuple[float, float] | None = None
    """The lowest and the highest value that one-sided joints and grip permit (N, N·m).

    The value is ``None`` for a unique component. It is also ``None`` if the scene has neither
    one-sided joints nor grip, and if the one-sided joints cannot all stay closed. An end without
    limit is infinite.
    """

    @property
    def unique(self) -> bool:
        """Whether the component is unique."""
        return self.verdict == "unique"


def _permitted(of: Mapping[str, Any] | None) -> tuple[float, float] | None:
    if of is None or of["kind"] == "empty":
        return None
    lowest, highest = of["lowest"], of["highest"]
    return (
        -np.inf if lowest is None else lowest,
        np.inf if highest is None else highest,
    )


def _components(of: Iterable[Mapping[str, Any]]) -> dict[str, ComponentVerdict]:
    return {
        c["name"]: ComponentVerdict(
            c["name"],
            c["verdict"],
            c["margin"],
            c["within_tolerance"],
            c["sensitivity"],
            c["fragile"],
            c.get("generic_verdict"),
            _permitted(c.get("range")),
        )
        for c in of
    }


class Verdict:
    """The verdict on the reaction of a joint or drive."""

    __slots__ = ("_analysis", "name")

    def __init__(self, analysis: Analysis, name: str) -> None:
        self._analysis = analysis
        self.name = name
        """Name of the joint or drive."""

    @property
    def verdict(self) -> str:
        """``unique``, ``not_unique`` or ``undecided``."""
        word: str = self._entry["verdict"]
        return word

    @property
    def generic_verdict(self) -> str | None:
        """The verdict at nearly all other configurations that were compared.

        The value is ``None`` if no other configuration was reached. The verdict along a motion is
        in :meth:`Analysis.along`.
        """
        word: str | None = self._entry["generic_verdict"]
        return word

    @property
    def unique(self) -> bool:
        """Whether the mechanism determines the whole reaction."""
        return self.verdict == "unique"

    @property
    def document(self) -> dict[str, Any]:
        """All results for the reaction: a copy of its entry of ``pfaff analyze --json``."""
        return deepcopy(self._entry)

    @property
    def _entry(self) -> dict[str, Any]:
        return self._analysis._reactions[self.name]

    @property
    def type(self) -> str:
        """The type of the joint, as in scenes."""
        kind: str = self._entry["type"]
        return kind

    @property
    def rows(self) -> list[int]:
        """Rows of the joint or drive (1-based)."""
        rows: list[int] = self._entry["rows"]
        return rows

    @property
    def margin(self) -> float:
        """Distance of the reaction from uniqueness; a rounding error if the reaction is unique."""
        margin: float = self._entry["margin"]
        return margin

    @property
    def components(self) -> dict[str, ComponentVerdict]:
        """The verdicts on components of the reaction that are not zero under every load."""
        return _components(self._entry["components"])

    @property
    def directions(self) -> Array | None:
        """A basis of the directions in which the reaction is unique; each row is one direction.

        The columns are the components: in the plane the components of the joint, in space all six
        components. The array has no row if no direction is unique. The value is ``None`` if the
        number of directions is undecided.
        """
        directions = self._entry["unique_directions"]
        if directions is None:
            return None
        columns = self._analysis._direction_columns(self._entry)
        return np.array(directions, dtype=np.float64).reshape(len(directions), columns)

    @property
    def fragile(self) -> bool:
        """Whether the reaction is unique, but sensitive to the last digits of the data."""
        fragile: bool = self._entry["fragile"]
        return fragile

    def explain(self) -> str:
        """The reason why the reaction is not unique; empty if the reaction is unique."""
        words: str | None = self._entry.get("explanation")
        return words or ""

    def moment(self, about: Point) -> dict[str, ComponentVerdict]:
        """Returns the verdicts on the moment about a point."""
        return self._analysis.moment(self.name, about)

    def make_unique(self, allow: Allow = "sensible") -> dict[str, Any]:
        """Returns deletions that make the reaction unique; see :meth:`Analysis.make_unique`."""
        return self._analysis.make_unique(self.name, allow)

    def __repr__(self) -> str:
        return f"<pfaff.Verdict {self.name!r}: {self.verdict}>"


class _Verdicts(Mapping[str, Verdict]):
    """Verdicts by name; an unknown name raises an exception with the most similar name."""

    __slots__ = ("_analysis", "_of")

    def __init__(self, analysis: Analysis, names: Iterable[str]) -> None:
        self._analysis = analysis
        self._of = {name: Verdict(analysis, name) for name in names}

    def __getitem__(self, name: str) -> Verdict:
        if name not in self._of:
            # The library rejects the name with an error.
            self._analysis._again(make_unique=[arguments.text("name", name)])
        return self._of[name]

    def __contains__(self, name: object) -> bool:
        return name in self._of

    def __iter__(self) -> Iterator[str]:
        return iter(self._of)

    def __len__(self) -> int:
        return len(self._of)

    def __repr__(self) -> str:
        words = ", ".join(f"{name!r}: {verdict.verdict}" for name, verdict in self._of.items())
        return f"{{{words}}}"


@dataclass(frozen=True)
class GroupVerdict:
    """The verdict on a sum of reactions, or of their components."""

    name: str
    verdict: str
    margin: float
    components: dict[str, ComponentVerdict]
    """Verdicts on the components, for a sum of wrenches."""
    values: dict[str, float]
    """Values of the sum; NaN for values that are not unique."""
    sensitivity: float | None = None
    """Largest relative change of a unique value if one point moves; ``None`` if no value is unique."""
    fragile: bool = False
    """Whether a value of the sum is unique, but sensitive to the last digits of the data."""

    @property
    def unique(self) -> bool:
        """Whether the mechanism determines the sum."""
        return self.verdict == "unique"

    @property
    def value(self) -> float:
        """The value of a sum of components; NaN if the sum is not unique."""
        return self.values.get("sum", float("nan"))


def _number(value: float | None) -> float:
    """Returns a value of a document; NaN if no finite reaction exists."""
    return float("nan") if value is None else value


class Analysis:
    """The verdicts at one configuration. The object is immutable, so a copy is the object itself.

    Results that are not in the document need a new analysis of the configuration.
    """

    def __init__(self, answer: Answer) -> None:
        self._asked = answer._replace(document={})
        self._own = answer.document
        self._reactions: dict[str, dict[str, Any]] = {r["name"]: r for r in self._own["reactions"]}
        self._verdicts = _Verdicts(self, self._reactions)

    def _again(self, **options: Any) -> dict[str, Any]:
        """Returns the document of the same configuration with other options."""
        scene, own, common, *_ = self._asked
        return scene._asked("analyze", {**own, **options}, common).document

    def __copy__(self) -> Analysis:
        return self

    def __deepcopy__(self, memo: object) -> Analysis:
        return self

    @property
    def verdicts(self) -> Mapping[str, Verdict]:
        """The verdict on each joint and drive, in the order of the rows."""
        return self._verdicts

    @property
    def document(self) -> dict[str, Any]:
        """A copy of the document of ``pfaff analyze --json``; you may change the copy."""
        return deepcopy(self._own)

    def _direction_columns(self, reaction: Mapping[str, Any]) -> int:
        """Returns the number of columns of the directions of a reaction."""
        is_spatial = self._own["velocities"] == 6 * self._own["bodies"]
        if is_spatial:
            return 6
        # The load of a coupling is excluded: it is not a direction of force and torque.
        return sum(c["name"] in ("Fx", "Fy", "T") for c in reaction["components"])

    @property
    def rank(self) -> int:
        """Number of independent rows."""
        rank: int = self._own["rank"]
        return rank

    @property
    def redundancy(self) -> int:
        """Number of redundant rows."""
        redundancy: int = self._own["redundancy"]
        return redundancy

    @property
    def mobility(self) -> int:
        """Degrees of freedom."""
        mobility: int = self._own["mobility"]
        return mobility

    @property
    def q(self) -> Array:
        """Coordinates."""
        return self._state()[0]

    @property
    def v(self) -> Array:
        """Velocities that satisfy the constraints; empty if such velocities are not known."""
        return self._state()[1]

    def _state(self) -> tuple[Array, Array]:
        scene, options, common, *_ = self._asked
        time, drop = options["at_time"], options["drop"]
        q, v = scene._of.state(time, common.checked(), drop)
        return np.array(q), np.array(v)

    @property
    def warnings(self) -> list[str]:
        """Further warnings about the analysis."""
        warnings: list[str] = self._own["warnings"]
        return warnings

    def combine(self, sum: str) -> GroupVerdict:
        """Returns the verdict on a sum of components, or on a sum of wrenches.

        Examples are ``"W3.N + W4.N"`` for components and ``"W3 + W4"`` for wrenches.
        """
        found = self._again(combine=[arguments.text("sum", sum)])["groups"][-1]
        values = {value["name"]: _number(value["value"]) for value in found.get("values", [])}
        components = _components(found.get("components", []))
        data = (found["sensitivity"], found["fragile"])
        return GroupVerdict(sum, found["verdict"], found["margin"], components, values, *data)

    def moment(self, name: str, about: Point) -> dict[str, ComponentVerdict]:
        """Returns the verdicts on the moment of a reaction about a point."""
        needed = "coordinates (m), or the name of a marker"
        if not isinstance(about, str):
            numbers = arguments.listed("about", about, arguments.number, needed)
            about = ",".join(map(repr, numbers))
        verdict = self.verdicts[arguments.text("name", name)]
        found = self._again(about=about)["reactions"]
        return _components(found[list(self.verdicts).index(verdict.name)]["moment"]["components"])

    def make_unique(self, name: str, allow: Allow = "sensible") -> dict[str, Any]:
        """Returns the smallest deletions that make a reaction unique and do not change the motion.

        The result is the entry of ``pfaff analyze --make-unique --json``: ``ways`` with ``rows``
        and ``text``, and ``complete``, which states whether all ways were found.
        """
        name = arguments.text("name", name)
        if not isinstance(allow, str):
            allow = "rows:" + ",".join(map(str, arguments.rows("allow", allow)))
        (found,) = self._again(make_unique=[name], allow=allow)["make_unique"]
        of_reaction: dict[str, Any] = found
        return of_reaction

    def eliminations(self, limit: int = 100) -> dict[str, Any]:
        """Returns sets of rows that can be deleted without a change of motion.

        The keys of the result are ``count`` and ``sets``.
        """
        limit = arguments.count("limit", limit)
        found: dict[str, Any] = self._again(eliminations=limit)["eliminations"]
        return found

    def along(self, t_end: float | None = None) -> dict[str, Any]:
        """Returns the verdicts along the motion: ``along`` of ``pfaff analyze --along --json``.

        ``reactions`` contains, by name, the verdict over the motion on each joint and drive and on
        its ``components``. If a component is determined only on a part of the motion,
        ``determined`` contains the intervals. ``special`` contains the instants with other
        verdicts, as in the ``document`` of a run. ``passages`` contains the singular
        configurations.
        """
        end = arguments.maybe(arguments.finite, "t_end", t_end)
        found: dict[str, Any] = self._again(along="stated" if end is None else end)["along"]
        return found

    def explain(self) -> list[str]:
        """The reasons why reactions are not unique: one sentence for each dependency of rows."""
        return [dependency["text"] for dependency in self._own["dependencies"]]

    def reactions(
        self,
        choose: str | Sequence[int] | Mapping[str, float] | None = None,
        *,
        length: float | None = None,
        misfits: Mapping[str, Sequence[float]] | None = None,
    ) -> dict[str, dict[str, float]]:
        """Returns the values of the reactions by name and component.

        Components that are not unique are NaN, unless a choice is given. A choice is one of three
        values: ``"minimum-norm"``, rows to delete (1-based), or compliances (m/N) of joints by
        name. For the minimum norm, the arm ``length`` (m) converts torques to forces. With
        compliances, ``misfits`` are displacements along the axes of the scene (m) and rotations
        (rad). A displacement belongs to the second body of a joint, or to the ground.
        """
        length = arguments.maybe(arguments.number, "length", length)
        arm = "" if length is None else f":length={length!r}"
        if choose is None or choose == "minimum-norm":
            words = f"minimum-norm{arm}"
        elif isinstance(choose, str):
            raise wrong(
                f"choose is `{choose}`, need `minimum-norm`, rows to drop, or compliances by name"
            )
        else:
            words = as_words(choose)
        words += as_misfits(misfits)
        hidden = choose is None
        return {
            r["name"]: {
                c["name"]: float("nan") if hidden and "choice" in c else _number(c["value"])
                for c in r["components"]
            }
            for r in self._again(choose=[words])["choices"][0]["reactions"]
        }

    def __repr__(self) -> str:
        words = f"rank {self.rank}, redundancy {self.redundancy}, mobility {self.mobility}"
        return f"<pfaff.Analysis: {words}>"

    def _repr_html_(self) -> str:
        from html import escape

        rows = [_row("th", ["reaction", "type", "rows", "verdict", "components"])]
        for name, verdict in self.verdicts.items():
            word = verdict.verdict.replace("_", " ") + (", fragile" if verdict.fragile else "")
            parts = verdict.components.values()
            open_ = "" if verdict.unique else ", ".join(f"{c.name} {c.verdict}" for c in parts)
            numbers = ", ".join(map(str, verdict.rows))
            cells = [name, verdict.type, numbers, word, open_.replace("_", " ")]
            rows.append(_row("td", cells))
        heading = escape(
            f"{self.document['scene']} at t = {self.document['time']} s: rank {self.rank}, "
            f"redundancy {self.redundancy}, mobility {self.mobility}"
        )
        return f"<p>{heading}</p><table>{''.join(rows)}</table>"


def _row(tag: str, cells: Iterable[str]) -> str:
    from html import escape

    return f"<tr>{''.join(f'<{tag}>{escape(cell)}</{tag}>' for cell in cells)}</tr>"
