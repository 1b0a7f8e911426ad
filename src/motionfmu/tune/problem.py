"""What a tuning is asked for: gains, cost, limits, family of plants."""

import itertools
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.errors import InputError, suggestion
from motionfmu.toml_lines import Lines, shown, tables_of, text_of

_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)
# More ranges than this have more corners than a tuning can look at.
RANGES_MAX = 4
Cost = Literal["contour_rms", "contour_max", "error_rms", "error_max", "ise", "iae", "itae"]
CONTOUR = ("contour_rms", "contour_max")
# On the scenario's own way; the others after a step.
ON_PATH = (*CONTOUR, "error_rms", "error_max")


class Margins(BaseModel):
    """Least margins of a loop; what is not given is not asked for."""

    model_config = _STRICT
    sensitivity: float | None = Field(default=None, gt=1.0)  # largest |1/(1 + L)|
    # Factor by which the loop may be larger, and smaller, before it rings.
    gain: float | None = Field(default=None, gt=1.0)
    phase: float | None = Field(default=None, gt=0.0, lt=180.0)  # lag that it bears [deg]


class Limits(BaseModel):
    """What the gains must keep."""

    model_config = _STRICT
    margins: Margins = Margins(sensitivity=1.5, gain=3.0, phase=45.0)  # of every loop
    loop: dict[str, Margins] = Field(default_factory=dict)  # of one loop instead, by its input
    overshoot: float | None = Field(default=0.05, ge=0.0)  # after a step, share of it
    # Slowest time constant of the closed loop [s]: with it the effect of a load dies away.
    recovery: float | None = Field(default=0.05, gt=0.0)
    # Largest way past the ends of the scenario's own move while a `trial` is made [mm].
    beyond: float | None = Field(default=None, gt=0.0)
    peak: dict[str, float] = Field(default_factory=dict)  # largest magnitude on the path, by output


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
        For a scenario without [contour]: the output that says where the axis is to be, and the one
        that says where it is, ``component.variable``.
    trial : dict
        Least and largest value of a parameter that no linear model knows: looked for by running the
        FMUs with the gains found.
    bounds : dict
        Least and largest value by gain; else a 20th and 20 times the present one.
    limits : Limits
    family : dict
        Least and largest value of plant parameters: all corners are held.
    at : dict
        Operating point of the plants; else the mean feed.
    starts : int
        Points from which the NLP begins: the present gains, what the global search found, then
        points spread over the range.
    check : int
        Evaluations of the global search; 0 for none.
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
    limits: Limits = Limits()
    family: dict[str, tuple[float, float]] = Field(default_factory=dict)
    at: dict[str, float] = Field(default_factory=dict)
    starts: int = Field(default=2, ge=1, le=50)
    check: int = Field(default=40, ge=0, le=100_000)

    def plants(self) -> list[dict[str, float]]:
        """The nominal plant, then every corner of the family.

        Returns
        -------
        list of dict
            Changed values by ``component.variable``.
        """
        corners = itertools.product(*([(n, v) for v in ends] for n, ends in self.family.items()))
        return [{}, *(dict(corner) for corner in corners)] if self.family else [{}]


def problem(values: Mapping[str, Any], lines: Lines | None = None, file: str = "") -> Problem:
    """Make a problem of the tables of a tune.toml.

    Parameters
    ----------
    values : mapping
        As in the file; what is missing has its default.
    lines : Lines, optional
        For messages.
    file : str
        For messages.

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        One message with file, line, key and value.
    """
    try:
        found = Problem.model_validate(_pairs(dict(values)))
    except ValidationError as error:
        first = error.errors()[0]
        keys = [str(k) for k in first["loc"]]
        given = "" if isinstance(first["input"], dict) else f" = {shown(first['input'])}"
        told = first["msg"].lower()
        if first["type"] == "extra_forbidden":
            holders: dict[str, type[BaseModel]] = {"limits": Limits, "margins": Margins}
            holder = holders.get(keys[-2], Problem) if keys[1:] else Problem
            told = "unknown key" + suggestion(keys[-1], holder.model_fields)
        text = f"{'.'.join(keys)}{given}: {told}"
        raise _located(text, keys, lines, file) from None
    for table in ("bounds", "family", "trial"):
        for name, (low, high) in getattr(found, table).items():
            if not low < high:
                text = f"{table}.{name} = [{low!r}, {high!r}]: the first must be less"
                raise _located(text, [table, name], lines, file)
    if len(found.trial) > 1:
        text = f"trial: {', '.join(found.trial)}: one parameter only"
        raise _located(text, ["trial"], lines, file)
    if (found.command is None) != (found.position is None):
        key = "command" if found.position is None else "position"
        raise _located(f"{key}: command and position go together", [key], lines, file)
    if len(found.family) > RANGES_MAX:
        text = f"family: {len(found.family)} ranges, not more than {RANGES_MAX}"
        raise _located(text, ["family"], lines, file)
    return found


def _pairs(values: dict[str, Any]) -> dict[str, Any]:
    """TOML has lists where tuples of two numbers are meant."""
    for table in ("bounds", "family", "trial"):
        if isinstance(values.get(table), dict):
            values[table] = {
                k: tuple(v) if isinstance(v, list) else v for k, v in values[table].items()
            }
    return values


def _located(text: str, keys: list[str], lines: Lines | None, file: str) -> InputError:
    if lines is None:
        return InputError(f"{file}: {text}" if file else text)
    table = ".".join(keys[:-1])
    return InputError(f"{file}:{lines.of(table, keys[-1])}: {text}")


def read(file: str | Path) -> dict[str, Any]:
    """Read the tables of a tune.toml and check them.

    Parameters
    ----------
    file : str or Path

    Returns
    -------
    dict
        As in the file.

    Raises
    ------
    InputError
        The file is missing or wrong.
    """
    text = text_of(file)
    values = tables_of(text, file)
    problem(values, Lines(text), str(file))
    return values
