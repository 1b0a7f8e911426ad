"""The result of a tuning."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from motionfmu.analysis.linear import LoopGain, gain_of
from motionfmu.analysis.linear.gains import in_lines
from motionfmu.base.memo import Memo
from motionfmu.base.shown_by import drawn
from motionfmu.run import Result
from motionfmu.study.tune.curve import margin
from motionfmu.study.tune.path_error import PathError, RunPath
from motionfmu.study.tune.solve import TOLERANCE, Found
from motionfmu.study.tune.steps import Array
from motionfmu.study.tune.trial import Trial
from motionfmu.study.tune.tuning_functions import CostAndLimits, TuningFunctions
from motionfmu.study.tune.tuning_words import assumptions, plant_text

# Number of points whose margins are kept: the present gains and the found ones.
_KEPT = 2


@dataclass(frozen=True)
class TuningRun:
    """A run of the FMUs with some gains and a plant, beside the model's."""

    plant: dict[str, float]  # changed values; empty for the nominal one
    result: Result
    model: PathError  # error by the tuning's model
    fmus: RunPath  # error in the run


@dataclass(frozen=True)
class LoopMargins:
    """Margins of a loop of an axis, the least of a family."""

    axis: int
    loop: str
    sensitivity: float  # largest |1/(1 + L)|
    gain: float  # factor up or down, the smaller one; infinite beyond 1000
    phase: float  # [deg]


@dataclass(frozen=True)
class RegionCheck:
    """The gains with plants on the surface of the regions that records leave possible."""

    names: tuple[str, ...]  # of the records
    level: float  # probability of each region
    added: tuple[dict[str, float], ...]  # plants held to in the search, because they missed a limit
    room: tuple[float, ...]  # least relative distance to a limit, of each plant
    before: tuple[float, ...]  # the same with gains for the nominal plant alone

    @property
    def text(self) -> str:
        """In words."""
        where = f"the {100 * self.level:g} % region of {', '.join(self.names)}"
        return (
            f"{kept_of(self.room)} of {len(self.room)} plants on {where} keep all limits of loops"
            f" and steps, the worst has {room_text(self.room)} of room; with gains for the nominal"
            f" plant {kept_of(self.before)}, {room_text(self.before)}"
        )


def room_text(room: Sequence[float]) -> str:
    """The least room of several plants, in per cent."""
    return f"{100.0 * min(room):z.2f} %".replace("-", "\N{MINUS SIGN}")


def kept_of(room: Sequence[float]) -> int:
    """How many plants of so much room keep all limits."""
    return sum(r > -TOLERANCE for r in room)


@dataclass
class Tuned:
    """What a tuning found.

    Attributes
    ----------
    study : TuningFunctions
    found : Found
        With the gains as the solver has them.
    z : ndarray
        The same, rounded to the registers.
    values : CostAndLimits
        With the rounded gains.
    before, after : list of TuningRun
        FMUs with the present and the found gains: nominal plant, then, with a family, its worst.
    seconds : float
        Of everything.
    trial : Trial or None
        The parameter that was looked for by running the FMUs.
    region : RegionCheck or None
        The gains on plants that were not searched with, if the plant was identified.
    """

    study: TuningFunctions
    found: Found
    z: Array
    values: CostAndLimits
    before: list[TuningRun] = field(default_factory=list)
    after: list[TuningRun] = field(default_factory=list)
    seconds: float = 0.0
    trial: Trial | None = None
    region: RegionCheck | None = None
    # It is computed once for the gains file, the page and the numbers.
    _margins: Memo[list[LoopMargins]] = field(default_factory=lambda: Memo(_KEPT), repr=False)
    _position_gains: Memo[list[LoopGain]] = field(default_factory=lambda: Memo(_KEPT), repr=False)

    def __repr__(self) -> str:
        name, what = self.study.scenario.name, self.study.path.what
        before = self.present
        lines = [
            f"{n} = {_shown(v)} (before {_shown(before[n])})" for n, v in self.settings.items()
        ]
        for had, has in zip(self.before, self.after, strict=True):
            both = (
                f"{r.fmus.rms * 1e3:.4g} µm, largest {r.fmus.max * 1e3:.4g} µm" for r in (had, has)
            )
            lines.append(f"{what}, {self.plant_name(has.plant)}: RMS {' → '.join(both)}")
        lines += [f"stopped by {text}" for text in self.stopped_by]
        return f"Tuned gains of {name}\n" + "\n".join(f"  {t}" for t in lines)

    def _repr_html_(self) -> str:
        return str(drawn("loop_pages.loop_views").tuned_html(self))

    def plant_name(self, plant: Mapping[str, float]) -> str:
        """A plant in words; by its number if it was added.

        Parameters
        ----------
        plant : mapping

        Returns
        -------
        str
        """
        added = self.region.added if self.region else ()
        if plant in added:
            return f"possible plant {added.index(dict(plant)) + 1}"
        return plant_text(plant)

    @property
    def present(self) -> dict[str, Any]:
        """The settings before the tuning, by the same names."""
        found = settings(self.study, self.study.present)
        if self.trial:
            value = self.study.base.parameter(self.trial.name)
            found[self.trial.name] = value[0] if len(value) == 1 else list(value)
        return found

    @property
    def settings(self) -> dict[str, Any]:
        """Gains as the scenario takes them, and what was tried.

        A value, or one for each axis.
        """
        found = settings(self.study, self.z)
        return found | ({self.trial.name: self.trial.value} if self.trial else {})

    @property
    def stopped_by(self) -> list[str]:
        """What the gains are stopped by, in words."""
        found = []
        for what in dict.fromkeys(x.what for x in self.found.stopped_by):
            same = [x for x in self.found.stopped_by if x.what == what]
            axes = sorted({x.axis for x in same})
            text = f"{what}, {'axes' if len(axes) > 1 else 'axis'} {', '.join(map(str, axes))}"
            plants = sorted({x.plant for x in same})
            if self.study.problem.family:
                text += f", {self.plant_name(self.study.plants[plants[0]])}"
                text += f" and {len(plants) - 1} more" if len(plants) > 1 else ""
            found.append(text)
        found += self.found.ends
        found = found or [f"no limit: {self.study.problem.cost} has its minimum here"]
        return found + ([self.trial.stopped_by] if self.trial else [])

    def cost(self, z: Array) -> Array:
        """Cost of every plant with some gains, from the model.

        Parameters
        ----------
        z : ndarray

        Returns
        -------
        ndarray, shape (plants,)
            [mm], or [s] and [s^2] after a step.
        """
        return self.study.values(z, False).costs

    def margins(self, z: Array) -> list[LoopMargins]:
        """Least margins of the family with some gains.

        Parameters
        ----------
        z : ndarray

        Returns
        -------
        list of LoopMargins
            One for each axis and loop.
        """
        return self._margins(z.tobytes(), lambda: least_margins(self.study, z))

    def lags(self, z: Array) -> dict[int, float]:
        """Following error over speed of each axis, nominal plant.

        Parameters
        ----------
        z : ndarray

        Returns
        -------
        dict
            [s] by axis.
        """
        gains = self.study.gains(z)
        return {k: part.lag(gains[k]) for k, part in self.study.parts[0].items()}

    def position_gains(self, z: Array) -> list[LoopGain]:
        """Position gains in 1/s of the axes tuned, nominal plant.

        Parameters
        ----------
        z : ndarray
            Rounded to the registers.

        Returns
        -------
        list of LoopGain
        """
        return self._position_gains(z.tobytes(), lambda: _position_gains(self.study, z))

    def toml(self) -> str:
        """The gains file, for ``motionfmu run SCENARIO --set FILE``.

        Returns
        -------
        str
        """
        lines = [
            f"# Gains of {self.study.scenario.name}, found by motionfmu tune.",
            *(f"# {text}" for text in assumptions(self.study)),
            *(f"# Stopped by: {text}" for text in self.stopped_by),
            *([f"# {self.region.text}."] if self.region else []),
            *(f"# Lag of axis {k}: {v * 1e3:.4g} ms" for k, v in self.lags(self.z).items()),
            *(f"# {text}" for text in in_lines(self.position_gains(self.z))),
        ]
        for name, value in self.settings.items():
            shown = f"[{', '.join(map(repr, value))}]" if isinstance(value, list) else repr(value)
            lines.append(f'"{name}" = {shown}')
        return "\n".join(lines) + "\n"

    def numbers(self) -> dict[str, Any]:
        """Everything as numbers, ready for JSON.

        Returns
        -------
        dict
        """
        study, found = self.study, self.found
        return {
            "scenario": study.scenario.name,
            "problem": study.problem.model_dump(),
            "assumed": assumptions(study),
            "gains": self.settings,
            "lag": {"before": self.lags(study.present), "after": self.lags(self.z)},
            "position_gains": {
                "before": [asdict(g) for g in self.position_gains(study.present)],
                "after": [asdict(g) for g in self.position_gains(self.z)],
            },
            "stopped_by": self.stopped_by,
            "cost": {
                "name": study.problem.cost,
                "plants": study.plants,
                "before": _finite(self.cost(study.present)),
                "after": _finite(self.values.costs),
                "unrounded": _finite(found.values.costs),
                "from_each_start": _finite(np.array(found.starts)),
                "global_search": _finite(np.array([found.check]))[0],
            },
            "tried": {str(v): asdict(x) for v, x in self.trial.tried.items()}
            if self.trial
            else None,
            "region": asdict(self.region) if self.region else None,
            "seconds": {
                "nlp": found.seconds[0],
                "global_search": found.seconds[1],
                "all": self.seconds,
            },
            "evaluations": dict(zip(("nlp", "global_search"), found.evaluations, strict=True)),
            "margins": {
                "before": [_row(m) for m in self.margins(study.present)],
                "after": [_row(m) for m in self.margins(self.z)],
            },
            "fmus": {
                side: [
                    {
                        "plant": r.plant,
                        "rms": r.fmus.rms,
                        "max": r.fmus.max,
                        "model_rms": r.model.rms,
                        "model_max": r.model.max,
                    }
                    for r in runs
                ]
                for side, runs in (("before", self.before), ("after", self.after))
            },
        }


def _shown(value: float | Sequence[float]) -> str:
    """A value, or those of the axes."""
    if isinstance(value, Sequence):
        return f"[{', '.join(f'{x:.6g}' for x in value)}]"
    return f"{value:.6g}"


def _finite(values: Array) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]


def _row(m: LoopMargins) -> dict[str, Any]:
    gain = m.gain if np.isfinite(m.gain) else None
    return {
        "axis": m.axis,
        "loop": m.loop,
        "sensitivity": m.sensitivity,
        "gain": gain,
        "phase": m.phase,
    }


def least_margins(study: TuningFunctions, z: Array) -> list[LoopMargins]:
    """Least margins of the family for each axis and loop."""
    gains, rows = study.gains(z), []
    for k, nominal in study.parts[0].items():
        for loop in nominal.loops:
            every = [margin(parts[k].loop(loop, gains[k])).values for parts in study.parts]
            least = np.min(every, axis=0)
            wide = float(np.exp(min(least[1], least[2])))
            rows.append(
                LoopMargins(
                    k,
                    loop,
                    float(1.0 / max(least[0], 1e-12)),
                    wide if wide < 999.0 else np.inf,
                    float(np.degrees(least[3])),
                )
            )
    return rows


def _position_gains(study: TuningFunctions, z: Array) -> list[LoopGain]:
    given = {**study.set, **settings(study, z)}
    found = [gain_of(study.scenario, given, k, study.at) for k in study.axes]
    return list(dict.fromkeys(sorted(sum(found, ()), key=lambda g: (g.name, g.axis))))


def settings(study: TuningFunctions, z: Array) -> dict[str, Any]:
    """Gains as a scenario takes them: one value, or one for each axis."""
    # Axes that are not tuned keep theirs.
    found: dict[str, Any] = {}
    for variable, share in zip(study.variables, z, strict=True):
        value: float | int = variable.value(float(share))
        value = round(value) if variable.whole else float(f"{value:.6g}")
        port = study.scenario.resolver.end(variable.name, "set", variable.name).port
        if not port.shape:
            found[variable.name] = value
            continue
        listed = found.setdefault(variable.name, list(study.base.parameter(variable.name)))
        for k in variable.axes:
            listed[k - 1] = value
    return found
