"""Position error of one axis on the move of a scenario, as a cost of a tuning."""

from collections.abc import Mapping

import numpy as np

from motionfmu.base import units
from motionfmu.base.errors import InputError
from motionfmu.run import Options, Result
from motionfmu.study.tune.path_error import PathError, RunPath
from motionfmu.study.tune.steps import Array

# The axis counts as standing from this time after the end of its command's motion on [s].
SETTLED = 0.1


def driven(result: Result, name: str) -> Array:
    """A driven input at the samples of a run: what the step takes that begins there, from 0."""
    options = {k: result.options[k] for k in ("set", "stop", "step") if k in result.options}
    system = result.scenario.resolved(Options(**options))
    acts = [s for s in system.stimuli if s.end.name == name]
    if not acts:
        raise InputError(f"{result.scenario.document.file}: nothing drives {name} in this run")
    steps = np.rint(result.time * 1e9 / system.step_ns).astype(np.int64)
    at = np.searchsorted([s.step for s in acts], steps, side="right") - 1
    values = np.array([float(s.values[0]) for s in acts])
    return np.where(at < 0, values[0], values[at.clip(min=0)]) - values[0]


class MoveCost:
    """The move of one axis, taken from a run of its FMUs.

    Names are those of command and position. The period [s] is that of the linear model. `shown` is
    the ratio of position to command, and the delay in periods after which the FMU shows a command.
    """

    what = "position error"
    periods = 1  # of the model, from one sample to the next

    def __init__(
        self, base: Result, names: tuple[str, str], period: float, shown: tuple[float, int]
    ) -> None:
        self._names, (self._scale, late) = names, shown
        time, command = base.time, self._command(base)
        self._stride = max(1, round(period / (time[1] - time[0])))
        self.time = time[:: self._stride]
        self._shown = command[:: self._stride]
        # command at the samples, from 0
        self.pulses = {1: np.append(self._shown[late:], np.full(late, self._shown[-1]))}
        if not np.ptp(command) > 0.0:
            raise InputError(f"{base.scenario.document.file}: {names[0]} does not move")
        port = base.scenario.resolver.end(names[1], "position", names[1]).port
        self.factor = units.parse(port.unit or "1").factor / units.parse("mm").factor
        moving = np.flatnonzero(np.diff(command))
        self.speed = (
            abs(self._scale)
            * float(np.abs(np.diff(command)).sum())
            / (len(moving) * float(time[1] - time[0]))
        )

    def _command(self, result: Result) -> Array:
        name = self._names[0]
        if name in result.scenario.document.body.driven:
            return driven(result, name)
        found: Array = np.asarray(result[name], dtype=float).reshape(len(result.time), -1)
        return found[:, 0] - found[0, 0]

    def error(self, positions: Mapping[int, Array]) -> PathError:
        """Position error of positions (count,) by axis, which begin at 0."""
        gap = np.zeros((len(self.time), 3))
        gap[:, 0] = (positions[1] - self._scale * self._shown) * self.factor
        return PathError(np.abs(gap[:, 0]), gap)

    def chain(self, slope: Array, axis: int, changes: Array) -> Array:
        """Derivatives of a cost to the gains, from those of the position."""
        found: Array = changes @ slope[:, axis - 1] * self.factor
        return found

    def measured(self, result: Result) -> RunPath:
        """Position error of a run where the controller samples, as between them a command holds."""
        error = self._error(result)[:: self._stride]
        rms = float(np.sqrt(np.mean(error**2)))
        return RunPath(rms, float(np.abs(error).max()), result.time[:: self._stride], error)

    def _error(self, result: Result) -> Array:
        position = np.asarray(result[self._names[1]], dtype=float).reshape(len(result.time), -1)
        way = position[:, 0] - position[0, 0] - self._scale * self._command(result)
        found: Array = way * self.factor
        return found

    def beyond(self, result: Result) -> float:
        """Largest overshoot past the ends of the command [mm]; 0 without one."""
        way = self._scale * self.factor * self._command(result)
        place = way + self._error(result)
        return max(float(place.max() - way.max()), float(way.min() - place.min()), 0.0)

    def standing(self, result: Result) -> float:
        """RMS error [mm] while the axis should stand still, after its first motion."""
        command, time = self._command(result), result.time
        moves = np.flatnonzero(np.diff(command))
        latest = moves[np.maximum(np.searchsorted(moves, np.arange(len(time))) - 1, 0)]
        rest = (np.arange(len(time)) > moves[0]) & (time - time[latest] > SETTLED)
        if not rest.any():
            file = result.scenario.document.file
            raise InputError(f"{file}: {self._names[0]} never rests, so nothing can be tried")
        return float(np.sqrt(np.mean(self._error(result)[rest] ** 2)))
