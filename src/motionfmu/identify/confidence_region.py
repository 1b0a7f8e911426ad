"""The plants that a record leaves possible: the confidence region of an identification."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, ValidationError

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import text_of

if TYPE_CHECKING:
    from motionfmu.identify.identification import Identified

Array = NDArray[np.float64]
KEY = "region"  # in result.json
# Directions on the region's surface are the same ones each time.
_SEED = 1


class _RegionSetting(BaseModel):
    """A setting as it follows the free quantities: `at` where all are 0, and its slopes."""

    model_config = ConfigDict(extra="forbid")
    at: float
    by: list[float]


class _RegionNumbers(BaseModel):
    """The region as result.json has it."""

    model_config = ConfigDict(extra="forbid")
    free: list[str]
    values: list[float]
    low: list[float | None]
    high: list[float | None]
    covariance: list[list[float]]
    moved: dict[str, _RegionSetting]


@dataclass(frozen=True)
class ConfidenceRegion:
    """What was found, and how far from it the truth may be.

    The surface at a level is the ellipsoid of free quantities q with (q - found)' covariance^-1
    (q - found) = the quantile of chi-squared with as many degrees of freedom as there are
    quantities. Plants of it are settings by ``component.variable[axis]``.

    Attributes
    ----------
    name : str
        Where it comes from.
    settings : mapping
        All that was found, the controller's gains too.
    free : tuple of str
        Names of the n quantities.
    values : ndarray, shape (n,)
    covariance : ndarray, shape (n, n)
    bounds : tuple of ndarray
        Least and largest value of each, which no plant passes; infinite where there is none.
    moved : mapping
        The plant's settings: their value where all quantities are 0, and slopes of shape (n,).
    """

    name: str
    settings: Mapping[str, Any]
    free: tuple[str, ...]
    values: Array
    covariance: Array
    bounds: tuple[Array, Array]
    moved: Mapping[str, tuple[float, Array]]

    def principal(self, level: float) -> list[dict[str, float]]:
        """The ends of the region's principal axes, two of each quantity.

        The axes are those of the correlation, so units do not count.

        Parameters
        ----------
        level : float
            Probability of the region, 0 to 1.

        Returns
        -------
        list of dict
        """
        ends = np.eye(len(self.free))
        return [self._plant(side * x, level) for x in ends for side in (-1.0, 1.0)]

    def surface(self, level: float, count: int) -> list[dict[str, float]]:
        """Plants on the region's surface, each time the same ones.

        Parameters
        ----------
        level : float
            Probability of the region, 0 to 1.
        count : int

        Returns
        -------
        list of dict
        """
        drawn = np.random.default_rng(_SEED).normal(size=(count, len(self.free)))
        return [self._plant(x / np.linalg.norm(x), level) for x in drawn]

    def _plant(self, direction: Array, level: float) -> dict[str, float]:
        """The plant on the surface in a direction of the scaled principal axes."""
        from scipy.special import gammaincinv

        scale = np.sqrt(np.diag(self.covariance))
        sizes, axes = np.linalg.eigh(self.covariance / np.outer(scale, scale))
        reach = np.sqrt(2.0 * gammaincinv(0.5 * len(self.free), level))
        there = self.values + reach * scale * (axes @ (np.sqrt(sizes.clip(min=0.0)) * direction))
        there = np.clip(there, *self.bounds)
        return {n: float(at + by @ there) for n, (at, by) in self.moved.items()}

    def numbers(self) -> dict[str, Any]:
        """The region as result.json has it.

        Returns
        -------
        dict
        """

        def ends(values: Array) -> list[float | None]:
            return [float(v) if np.isfinite(v) else None for v in values]

        return {
            "free": list(self.free),
            "values": self.values.tolist(),
            "low": ends(self.bounds[0]),
            "high": ends(self.bounds[1]),
            "covariance": self.covariance.tolist(),
            "moved": {n: {"at": at, "by": by.tolist()} for n, (at, by) in self.moved.items()},
        }


def region_of(found: "Identified") -> ConfidenceRegion | None:
    """The region of an identification; None if it tells nothing.

    Parameters
    ----------
    found : Identified

    Returns
    -------
    ConfidenceRegion or None
    """
    known, own = found.spread, found.ground
    if known is None or not found.free:
        return None
    free = own.free(found.free)
    now = {p.name.partition(".")[2]: p.value for p in found.parameters}
    names = [d.name for d in own.loop.ode.parameters]
    inputs = [d.name for d in own.loop.ode.inputs]
    rows = {
        n: (float(free.p[names.index(n)]), row)
        for n, row in zip(free.moved, free.of_parameters, strict=True)
    }
    rows |= {n: (float(u), row) for n, u, row in zip(inputs, free.u, free.of_inputs, strict=True)}
    # a quantity that is limited by another one from below is told by how far it is above it
    under = {n: now.get(s, own.value(s)) for n, s in free.above.items()}
    values = [now[n] - under.get(n, 0.0) for n in free.names]
    moved = {}
    for name in found.settings:
        component, _, variable = name.partition("[")[0].partition(".")
        if component == own.loop.component and variable in rows and rows[variable][1].any():
            moved[name] = rows[variable]
    return ConfidenceRegion(
        found.record.name,
        dict(found.settings),
        tuple(free.names),
        np.array(values),
        known.correlation * np.outer(known.deviations, known.deviations),
        (free.low, free.high),
        moved,
    )


def read_region(place: str | Path) -> ConfidenceRegion:
    """The region in a result of ``motionfmu identify``.

    Parameters
    ----------
    place : str or Path
        Its folder, or the result.json in it.

    Returns
    -------
    ConfidenceRegion

    Raises
    ------
    InputError
        The file is missing, it is no identification's, or its record told nothing.
    """
    file = Path(place) / "result.json" if Path(place).is_dir() else Path(place)
    own, settings = _numbers(file)
    count = len(own.free)
    covariance = np.array(own.covariance, dtype=np.float64)
    rows: list[list[Any]] = [own.values, own.low, own.high, *(m.by for m in own.moved.values())]
    if covariance.shape != (count, count) or any(len(r) != count for r in rows):
        raise InputError(f"{file}: {KEY}: not all of it has {count} quantities")
    low = np.array([-np.inf if v is None else v for v in own.low])
    high = np.array([np.inf if v is None else v for v in own.high])
    moved = {n: (m.at, np.array(m.by)) for n, m in own.moved.items()}
    return ConfidenceRegion(
        file.parent.name or str(place),
        settings,
        tuple(own.free),
        np.array(own.values),
        covariance,
        (low, high),
        moved,
    )


def _numbers(file: Path) -> tuple[_RegionNumbers, dict[str, Any]]:
    """The region in a result.json, of the right types, and the settings beside it."""
    text = text_of(file)
    try:
        every = json.loads(text)
    except ValueError as error:
        raise InputError(f"{file}: no JSON: {error}") from None
    if isinstance(every, dict) and "two_masses" in every:
        raise InputError(
            f"{file}: two masses by --frf, which have no region: its found.toml goes to --set; a"
            " region is found in a record of a motion"
        )
    if not isinstance(every, dict) or KEY not in every or "settings" not in every:
        raise InputError(f"{file}: not the result of motionfmu identify: it has no {KEY!r}")
    if every[KEY] is None:
        raise InputError(f"{file}: this record told nothing, so it leaves every plant possible")
    try:
        own = _RegionNumbers.model_validate(every[KEY])
    except ValidationError as error:
        first = error.errors()[0]
        at = ".".join(map(str, first["loc"]))
        raise InputError(f"{file}: {KEY}.{at}: {first['msg'].lower()}") from None
    return own, every["settings"]
