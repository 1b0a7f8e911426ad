"""Position gains in 1/s, computed once and kept on the disk with all that they depend on."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import Any

from motionfmu.base import disk_cache
from motionfmu.base.extras import needed
from motionfmu.run import Scenario, load
from motionfmu.scenarios import fmus
from motionfmu.scenarios.document import plain

FILE = "gains.json"
PACKAGE = Path(__file__).resolve().parents[2]
# Parts of the package that compute gains: these modules, those they import, readers of FMUs.
MADE_BY = ("*.py", "fmu/**/*.py", "scenarios/*.py", "run/*.py", "linear/*.py")


@dataclass(frozen=True)
class LoopGain:
    """A parameter that sets the position gain of a loop.

    Attributes
    ----------
    name : str
        Parameter, ``component.variable``.
    axis : int
        From 1; 0 for a parameter that is no array.
    value : float or int
        Of the parameter, in its own units.
    kp : float
        Position gain Kp: speed that the loop asks for over the position error [1/s].
    loop : str
        The input at which the loop can be opened, ``component.variable``.
    """

    name: str
    axis: int
    value: float
    kp: float
    loop: str

    def at(self, value: float) -> "LoopGain":
        """The same with another value of the parameter.

        Parameters
        ----------
        value : float

        Returns
        -------
        LoopGain
        """
        return replace(self, value=value, kp=self.kp * value / self.value)

    def __str__(self) -> str:
        return in_lines([self])[0]


def _told(gain: LoopGain) -> str:
    return f"{gain.value:.6g} (Kp {in_words(gain.kp)})"


def in_words(kp: float) -> str:
    """A position gain [1/s] with three digits and its unit."""
    # Three digits of what rounds to 100 would end in a bare point.
    return f"{kp:.0f} 1/s" if kp >= 99.95 else f"{kp:#.3g} 1/s"


def gain_of(
    scenario: Scenario | str | Path,
    set: Mapping[str, Any] | None = None,
    axis: int | None = None,
    at: Mapping[str, float] | None = None,
) -> tuple[LoopGain, ...]:
    """Position gains of a scenario in 1/s, of any registers.

    Parameters
    ----------
    scenario : Scenario, str or Path
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.
    axis : int, optional
        From 1; else all.
    at : mapping, optional
        Operating point as in `model`; else a slow motion, 10 rad/s of a motor or 10 mm/s.

    Returns
    -------
    tuple of LoopGain
        By parameter, then axis; empty if no loop of the scenario has such a gain.
    """
    loaded = scenario if isinstance(scenario, Scenario) else load(scenario)

    def make(folder: Path) -> None:
        needed("tune")
        from motionfmu.analysis.linear.position_gain import (
            found,
        )  # its import brings all that makes linear models

        listed = list(found(loaded, set or {}, axis, at))
        (folder / FILE).write_text(json.dumps(listed), encoding="utf-8")

    place = disk_cache.kept("position_gains", _key(loaded, set or {}, axis, at or {}), make)
    return tuple(LoopGain(*row) for row in json.loads((place / FILE).read_bytes()))


def _key(
    scenario: Scenario, set_: Mapping[str, Any], axis: int | None, at: Mapping[str, float]
) -> str:
    """A hash of all on which gains depend: scenario, values, FMUs, and the package's text."""
    # All of the scenario's tables: a law may ask for any value.
    told = repr((scenario.document.tables, plain(set_), axis, plain(at)))
    archives = map(fmus.digest, scenario.document.body.component.values())
    return disk_cache.key(_text(), told, *archives)


@cache
def _text() -> str:
    """A hash of the package's own text, as far as it computes gains."""
    files = (file for pattern in MADE_BY for file in sorted(PACKAGE.glob(pattern)))
    return disk_cache.key(*(file.read_bytes() for file in files))


def in_lines(gains: Iterable[LoopGain]) -> list[str]:
    """Gains in words, one line each; equal gains of one parameter share a line."""
    found = []
    for (name, told), group in groupby(gains, key=lambda g: (g.name, _told(g))):
        axes = ",".join(str(g.axis) for g in group if g.axis)
        found.append(f"{name}[{axes}] = {told}" if axes else f"{name} = {told}")
    return found
