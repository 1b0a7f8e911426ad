"""The problem of a tuning: gains, cost, limits, family of plants."""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.base.toml_lines import Lines, ordered, shown, tables_of, text_of
from motionfmu.run import Scenario
from motionfmu.scenarios.values import texts

_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)
# Tables with a least and a largest value for each name.
TABLES = ("bounds", "family", "trial")
# A family of more ranges has too many corners for a tuning.
RANGES_MAX = 4
Cost = Literal["contour_rms", "contour_max", "error_rms", "error_max", "ise", "iae", "itae"]
CONTOUR = ("contour_rms", "contour_max")
# Costs on the scenario's own motion; the others are taken after a step.
ON_PATH = (*CONTOUR, "error_rms", "error_max")


class MarginLimits(BaseModel):
    """Least margins of a loop; a margin that is None is not limited."""

    model_config = _STRICT
    sensitivity: float | None = Field(default=None, gt=1.0)  # largest |1/(1 + L)|
    # Factor by which the loop may be larger, and smaller, before it rings.
    gain: float | None = Field(default=None, gt=1.0)
    phase: float | None = Field(default=None, gt=0.0, lt=180.0)  # lag that it bears [deg]


class TuningLimits(BaseModel):
    """Limits that the gains must keep."""

    model_config = _STRICT
    margins: MarginLimits = MarginLimits(sensitivity=1.5, gain=3.0, phase=45.0)  # of every loop
    loop: dict[str, MarginLimits] = Field(default_factory=dict)  # of one loop instead, by its input
    overshoot: float | None = Field(default=0.05, ge=0.0)  # after a step, share of it
    # Slowest time constant of the closed loop [s]: with it the effect of a load dies away.
    recovery: float | None = Field(default=0.05, gt=0.0)
    # Largest way past the ends of the scenario's own move while a `trial` is made [mm].
    beyond: float | None = Field(default=None, gt=0.0)
    peak: dict[str, float] = Field(default_factory=dict)  # largest magnitude on the path, by output
    # Largest |link/command| of an arm's joint at any frequency, without feed-forward.
    swing: float = Field(default=1.3, gt=1.0)


class Problem(BaseModel):
    """A tuning problem.

    Attributes
    ----------
    gains : list of str or None
        Parameters to be found, ``component.variable``; None: the position gain in use.
    velocity, feed_forward : bool
        Also the velocity loop's gain and integral time; also the feed-forward.
    axes : str
        ``each`` axis its own gains, or ``equal`` gains.
    cost : str
        ``contour_rms`` or ``contour_max`` on the scenario's path, ``error_rms`` or ``error_max`` on
        its move; ``ise``, ``iae`` or ``itae`` after a step, the sum over the axes.
    command, position : str or None
        For a scenario without [contour]: the output, or the input that [[drive]] or a record
        drives, that says where the axis is to be, and the output that says where it is,
        ``component.variable``.
    trial : dict
        Least and largest value of a parameter that no linear model knows: looked for by running the
        FMUs with the gains found.
    bounds : dict
        Least and largest value by gain; else a 20th and 20 times the present one.
    limits : TuningLimits
    family : dict
        Least and largest value of plant parameters: all corners are held.
    identified : list of str
        Results of ``motionfmu identify``, of an axis each: their values are set, all plants that
        their records leave possible are held.
    level : float
        Probability of each region of possible plants.
    at : dict
        Operating point of the plants; else the mean feed.
    judged : float
        Seconds of a path with a [contour] by which gains are judged: of a longer one half where the
        error is largest, half spread evenly. The FMUs run the whole.
    starts : int
        Points from which the NLP begins: the present gains, what the global search found, then
        points spread over the range.
    check : int
        Evaluations of the global search; 0 for none.
    poses : int
        Of an arm: poses between the ends of its joints from which the worst are looked for.
    """

    model_config = _STRICT
    gains: list[str] | None = None
    velocity: bool = False
    feed_forward: bool = False
    axes: Literal["each", "equal"] = "each"
    cost: Cost = "contour_rms"
    command: str | None = None
    position: str | None = None
    trial: dict[str, tuple[float, float]] = Field(default_factory=dict)
    bounds: dict[str, tuple[float, float]] = Field(default_factory=dict)
    limits: TuningLimits = TuningLimits()
    family: dict[str, tuple[float, float]] = Field(default_factory=dict)
    identified: list[str] = Field(default_factory=list)
    level: float = Field(default=0.95, gt=0.0, lt=1.0)
    at: dict[str, float] = Field(default_factory=dict)
    judged: float = Field(default=60.0, ge=1.0)
    starts: int = Field(default=2, ge=1, le=50)
    check: int = Field(default=40, ge=0, le=100_000)
    poses: int = Field(default=170, ge=20, le=10_000)

    def plants(self) -> list[dict[str, float]]:
        """The nominal plant, then every corner of the family.

        Returns
        -------
        list of dict
            Changed values by ``component.variable``.
        """
        corners = itertools.product(*([(n, v) for v in ends] for n, ends in self.family.items()))
        return [{}, *(dict(corner) for corner in corners)] if self.family else [{}]


def problem(
    values: Mapping[str, Any],
    lines: Lines | None = None,
    file: str = "",
    scenario: Scenario | None = None,
) -> Problem:
    """Make a problem of the tables of a tune.toml.

    Parameters
    ----------
    values : mapping
        As in the file; what is missing has its default.
    lines : Lines, optional
        For messages.
    file : str
        For messages.
    scenario : Scenario, optional
        Whose variables are named; they are looked up.

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        All that is wrong at once, each with file, line, key and value.
    """
    place = _Place(lines, file)
    faults = Faults()
    given = _pairs(dict(values))
    try:
        found = Problem.model_validate(given)
    except ValidationError as error:
        wrong = error.errors()
        faults.lines += _told(wrong, place)
        damaged = {one["loc"][0] for one in wrong}
        found = Problem.model_validate({k: v for k, v in given.items() if k not in damaged})
    for table in TABLES:
        for name, (low, high) in getattr(found, table).items():
            if not low < high:
                text = f"{table}.{name} = [{low!r}, {high!r}]: the first must be less"
                faults.lines.append(place.line(text, table, name))
    if len(found.trial) > 1:
        text = f"trial: {', '.join(found.trial)}: one parameter only"
        faults.lines.append(place.line(text, "trial"))
    if (given.get("command") is None) != (given.get("position") is None):
        key = "command" if given.get("position") is None else "position"
        faults.lines.append(place.line(f"{key}: command and position go together", key))
    if len(found.family) > RANGES_MAX:
        text = f"family: {len(found.family)} ranges, not more than {RANGES_MAX}"
        faults.lines.append(place.line(text, "family"))
    if scenario is not None:
        faults.lines += wrong_names(found, scenario, place)
    place.refuse(faults)
    return found


@dataclass(frozen=True)
class _Place:
    """Where a problem's keys are written, for messages."""

    lines: Lines | None
    file: str

    def line(self, text: str, *keys: str) -> str:
        """A message about a key with its line."""
        if self.lines is None:
            return f"{self.file}: {text}" if self.file else text
        return f"{self.file}:{self.lines.of('.'.join(keys[:-1]), keys[-1])}: {text}"

    def refuse(self, faults: Faults) -> None:
        """Raise an InputError with all faults in the order of their lines, if there are any."""
        Faults(ordered(faults.lines, [self.file])).tell()


def _told(wrong: Sequence[Any], place: _Place) -> list[str]:
    """A line for each key in which pydantic found a fault."""
    found: dict[tuple[str, ...], str] = {}
    for one in wrong:
        keys = [str(k) for k in one["loc"]]
        if keys[0] in TABLES:
            keys = keys[:2]  # what follows is the place in the pair
        text = ".".join(keys)
        if one["type"] == "extra_forbidden":
            # [limits.margins] and each table of [limits.loop] have the same keys.
            holders: list[type[BaseModel]] = [Problem, TuningLimits, MarginLimits]
            known = holders[min(len(keys), 3) - 1].model_fields
            what = "table" if isinstance(one["input"], dict) else "key"
            told = f"unknown {what}{suggestion(keys[-1], known)}"
        else:
            told = one["msg"].lower()
        if not isinstance(one["input"], dict):
            text += f" = {shown(one['input'])}"
        found.setdefault(tuple(keys), place.line(f"{text}: {told}", *keys))
    return list(found.values())


def check_names(problem: Problem, scenario: Scenario) -> None:
    """Refuse names of a problem that the scenario's FMUs do not have, all in one message."""
    Faults(wrong_names(problem, scenario, _Place(None, ""))).tell()


def wrong_names(problem: Problem, scenario: Scenario, place: _Place) -> list[str]:
    """A line for each name of a problem that the scenario's FMUs do not have."""
    lines: list[str] = []
    for keys, name in _named(problem):
        try:
            scenario.resolver.end(name, "", "")
        except InputError as error:
            what = ".".join(k for k in keys if k != name)
            told = (f"{what}: {text}" for text in texts(scenario.document, error))
            lines += (place.line(text, *keys) for text in told)
    gains = problem.gains or [*problem.bounds]
    for name in problem.bounds:
        if name not in gains and not any(f"bounds: {name}:" in line for line in lines):
            text = f"bounds.{name}: it is not among the gains: {', '.join(gains)}"
            text += suggestion(name, gains)
            lines.append(place.line(text, "bounds", name))
    return lines


def _named(problem: Problem) -> Iterator[tuple[tuple[str, ...], str]]:
    """Every name of a variable in a problem, behind the keys under which it stands."""
    for key in ("command", "position"):
        if name := getattr(problem, key):
            yield (key,), name
    yield from ((("gains",), name) for name in problem.gains or ())
    for key in (*TABLES, "at"):
        yield from (((key, name), name) for name in getattr(problem, key))
    for key in ("peak", "loop"):
        yield from ((("limits", key, name), name) for name in getattr(problem.limits, key))


def _pairs(values: dict[str, Any]) -> dict[str, Any]:
    """Values in which TOML's lists of two numbers are tuples."""
    for table in TABLES:
        if isinstance(values.get(table), dict):
            values[table] = {
                k: tuple(v) if isinstance(v, list) else v for k, v in values[table].items()
            }
    return values


def read(file: str | Path, scenario: Scenario | None = None) -> dict[str, Any]:
    """Read the tables of a tune.toml and check them.

    Parameters
    ----------
    file : str or Path
    scenario : Scenario, optional
        Whose variables the file names; they are looked up.

    Returns
    -------
    dict
        As in the file.

    Raises
    ------
    InputError
        The file is missing or wrong: all of it at once, with lines.
    """
    text = text_of(file)
    values = tables_of(text, file)
    problem(values, Lines(text), str(file), scenario)
    if "identified" in values:
        values["identified"] = [str(Path(file).parent / name) for name in values["identified"]]
    return values
