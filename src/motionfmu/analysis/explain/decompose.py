"""A run's contour error taken apart: one cause switched off at a time."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.error import LAGS, WINDOW_MIN
from motionfmu.analysis.explain import cause_switches, theory
from motionfmu.analysis.explain.ballbar import Signature, signature
from motionfmu.analysis.explain.cause_switches import Cause, CauseOff
from motionfmu.analysis.explain.effects import Effects
from motionfmu.analysis.explain.servo_formulas import Array
from motionfmu.base.errors import InputError
from motionfmu.run import Scenario, load
from motionfmu.scenarios import recording
from motionfmu.scenarios.contour_signals import library_of

if TYPE_CHECKING:
    from motionfmu.analysis.contour import ContourResult
    from motionfmu.analysis.contour.track import Track
    from motionfmu.run import Result

# Number of points along the path at which runs are compared.
PLACES = 20_000
# A smaller effect comes from rounding in the runs and not from a cause [mm].
NOTHING = 1e-6
# If a tool goes back by more than this, only its first pass of the place counts [mm].
STANDS = 1e-6
# A rest takes so many servo lags at least; points within a servo window after it do not count.
RESTS = 3.0
# Two motions are the same if their times differ by this share at most, as by delays.
SAME = 0.01
PATH, SERVO = "path", "servo"
TITLES = {PATH: "Path the card was given (blending)", SERVO: "Servo lag"}


@dataclass(frozen=True)
class Effect:
    """What one cause does to the contour error."""

    name: str
    title: str
    how: str  # how it was switched off, or why not
    size: float  # largest change of the contour error at any place of the path [mm]
    usual: float  # 99 % of the path see a smaller change [mm]
    rms: float  # root mean square of the change [mm]
    where: int  # line of the program at which the change is largest; 0 if there is none
    without: float | None  # largest contour error of the run without the cause [mm]
    judged: bool  # the cause could be switched off, or was absent; else `how` says why not
    theory: "theory.Theory"
    change: Array  # (n,) contour error with the cause minus without, along the path [mm]

    def numbers(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        names = ("name", "title", "how", "size", "usual", "rms", "where", "without", "judged")
        out = {k: getattr(self, k) for k in names}
        return out | {"theory": self.theory.value, "formula": self.theory.formula}


@dataclass(frozen=True)
class Explanation(Effects[Effect]):
    """The contour error of a run, explained.

    Attributes
    ----------
    result : Result
        The whole run.
    ideal : ContourResult
        The run with every cause switched off at once.
    effects : tuple of Effect
        The largest first.
    along : ndarray, shape (n,)
        Places on the path [mm].
    whole, together : ndarray, shape (n,)
        Contour error there, and the sum of all effects [mm].
    counts : ndarray of bool, shape (n,)
        Places that count: cut, and not the first ones after a rest.
    corners : tuple of CornerRow
    signatures : tuple of Signature
        Of the circles run both ways round.
    """

    result: "Result"
    ideal: "ContourResult"
    effects: tuple[Effect, ...]
    along: Array
    whole: Array
    together: Array
    counts: NDArray[np.bool_]
    corners: "tuple[theory.CornerRow, ...]"
    signatures: tuple[Signature, ...]

    def numbers(self) -> dict[str, Any]:
        """Every number, ready for JSON; mm, rad."""
        # The whole error is taken over time where the tool cuts, all other numbers along the path.
        error = self.result.contour().error
        sizes = {"contour_error": {"max": error.max, "rms": error.rms}} | {
            name: {"max": _top(values[self.counts]), "rms": _rms(values[self.counts])}
            for name, values in (
                ("contour_error_along", self.whole),
                ("sum_of_effects", self.together),
                ("residual", self.residual),
            )
        }
        return sizes | {
            "effects": [e.numbers() for e in self.effects],
            "corners": [vars(c) for c in self.corners],
            "circles": [s.numbers() for s in self.signatures],
        }


def explain(
    path: "str | Path | Scenario",
    set: Mapping[str, Any] | None = None,
    stop: float | None = None,
    progress: Callable[[str, float], None] = lambda what, share: None,
) -> Explanation:
    """Explain the contour error of a scenario.

    The scenario runs as it is, once without each cause that acts in it, and once without all of
    them. What that last run leaves is the servo lag and, where the commands themselves leave the
    path, blending. All changes are taken at the same places of the path.

    Parameters
    ----------
    path : str, Path or Scenario
        A scenario with a [contour] table.
    set : mapping, optional
        Value by ``component.variable``, stronger than the scenario's.
    stop : float, optional
        Instead of the scenario's [s].
    progress : callable
        Called with what is under way and the share of all work that is done.

    Raises
    ------
    InputError
        The scenario or a setting is wrong, or has no contour; one message.
    """
    # The scenario is loaded anew, because more signals are recorded.
    scenario = path.changed() if isinstance(path, Scenario) else load(path)
    if scenario.document.body.contour is None:
        raise InputError(f"{scenario.document.file}: the scenario has no [contour] table")
    given = dict(set or {})
    known = cause_switches.causes(scenario)
    watch(scenario, [f"{library_of(scenario.resolver)}.error", *cause_switches.watched(known)])
    progress(scenario.name, 0.0)
    result = scenario.run(set=given, stop=stop)
    result.contour()
    states = {c.name: cause_switches.off(c, result, {}) for c in known}
    acting = [c for c in known if states[c.name].set]
    runs: dict[str, ContourResult] = {}
    count = len(acting) + 2
    for i, cause in enumerate(acting, 1):
        progress(f"without {cause.title.lower()}", i / count)
        before = states[cause.after].set if cause.after in states else {}
        try:
            changed = cause_switches.off(cause, result, before).set
            run = _run(scenario, {**given, **before, **changed}, stop)
            runs[cause.name] = _same_motion(run, result.contour())
        except InputError as error:
            states[cause.name] = CauseOff({}, f"not comparable without it: {error}")
    progress("without all of them", (count - 1) / count)
    everything: dict[str, Any] = {}
    for cause in acting:
        if cause.name in runs:
            everything |= cause_switches.off(cause, result, everything).set
    ideal = _run(scenario, given | everything, stop) if everything else result.contour()
    progress("done", 1.0)
    return _put_together(result, (known, states), (runs, ideal))


def watch(scenario: "Scenario", names: list[str]) -> None:
    """Add outputs to those that a scenario records, without showing them in a figure."""
    have = {e.name for e in scenario.ends}
    if new := [n for n in names if n not in have]:
        ends = recording.chosen(scenario.resolver, new)
        scenario.ends = [*scenario.ends, *ends]
        scenario.only_drawn |= {e.name for e in ends}


def _run(scenario: "Scenario", given: Mapping[str, Any], stop: float | None) -> "ContourResult":
    """Contour of a run without some causes; refuses a run in which the library has an error."""
    library = library_of(scenario.resolver)
    result = scenario.run(set=given, stop=stop)
    if code := int(np.max(result[f"{library}.error"])):
        raise InputError(f"{library}.error = {code}")
    return result.contour()


def _same_motion(run: "ContourResult", whole: "ContourResult") -> "ContourResult":
    """Refuse a run whose commands take another time for the same path."""
    times = []
    for each in (run, whole):
        moves = np.flatnonzero(np.diff(each.command_track.along) > 0.0)
        times.append(float(each.run.time[moves[-1]] - each.run.time[moves[0]]))
    if abs(times[0] - times[1]) > SAME * times[1] + 2.0 * whole.run.dda_time:
        raise InputError(f"the motion takes {times[0]:.3g} s instead of {times[1]:.3g} s")
    return run


def _put_together(
    result: "Result",
    known: tuple[list[Cause], dict[str, CauseOff]],
    runs: "tuple[dict[str, ContourResult], ContourResult]",
) -> Explanation:
    whole_run, ideal = result.contour(), runs[1]
    along = np.linspace(0.0, float(whole_run.run.path.offsets[-1]), PLACES)
    whole = _tool(whole_run, along)
    counts = _counted(whole_run, along)
    book = theory.RunTheory(result, ideal)
    effects = []
    for cause in known[0]:
        state, run = known[1][cause.name], runs[0].get(cause.name)
        change = np.zeros_like(whole)
        if run is not None:
            other = runs[0].get(cause.after)
            change = (whole if other is None else _tool(other, along)) - _tool(run, along)
        how = ", ".join(f"{k} = {short(v)}" for k, v in state.set.items()) or state.why_not
        said = theory.NONE if state.absent else book.of(cause.name)
        without = None if run is None else run.error.max
        judged = run is not None or state.absent
        effects.append(
            _effect(
                (cause.name, cause.title, how), (whole_run, counts), change, (without, judged, said)
            )
        )
    path = _along((ideal.command_track, _blended(ideal)), ideal, along)
    left = _tool(ideal, along) - path
    how = "pulses against path, without all causes above"
    effects.append(
        _effect((PATH, TITLES[PATH], how), (ideal, counts), path, (None, True, book.of(PATH)))
    )
    how = "table against pulses, without all causes above"
    effects.append(
        _effect((SERVO, TITLES[SERVO], how), (ideal, counts), left, (None, True, book.of(SERVO)))
    )
    together = np.sum([e.change for e in effects], axis=0)
    both_ways = [c for c in whole_run.circles if c.ccw and c.cw]
    return Explanation(
        result,
        ideal,
        tuple(sorted(effects, key=lambda e: -e.size)),
        along,
        whole,
        together,
        counts,
        theory.corner_rows(result, ideal, book),
        tuple(signature(c, whole_run.lag) for c in both_ways),
    )


def _effect(
    names: tuple[str, str, str],
    where: "tuple[ContourResult, NDArray[np.bool_]]",
    change: Array,
    rest: "tuple[float | None, bool, theory.Theory]",
) -> Effect:
    path, counts = where[0].run.path, where[1]
    size = _top(change[counts])
    worst = int(np.argmax(np.where(counts, np.abs(change), -1.0)))
    place = float(path.offsets[-1]) * worst / (len(change) - 1)
    owner = int(np.searchsorted(path.offsets, place, side="right")) - 1
    line = int(path.lines[min(owner, len(path.segments) - 1)]) if size else 0
    usual = float(np.percentile(np.abs(change[counts]), 99.0))
    return Effect(*names, size, usual, _rms(change[counts]), line, *rest, change)


def _counted(run: "ContourResult", along: Array) -> NDArray[np.bool_]:
    """Places on lines and arcs, but for the first ones after a rest.

    By friction the place where the tool rests, and its start from there, depend on all motion
    before.
    """
    time, path, way = run.run.time, run.run.path, run.command_track.along
    owner = np.searchsorted(path.offsets, along, side="right") - 1
    counts = path.cut[np.clip(owner, 0, len(path.segments) - 1)]
    span = RESTS * max(run.lag, WINDOW_MIN / LAGS)
    moves = np.flatnonzero(np.diff(way) > 0.0)
    for before, after in zip([0, *moves[:-1].tolist()], moves.tolist(), strict=True):
        if time[after] - time[before] >= span or after == moves[0]:
            until = min(int(np.searchsorted(time, time[after] + run.window)), len(time) - 1)
            counts &= (along < way[after] - STANDS) | (along > run.track.along[until])
    return counts


def _top(values: Array) -> float:
    size = float(np.abs(values).max())
    return size if size >= NOTHING else 0.0


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def short(value: Any) -> str:
    """Short text of a setting."""
    if not isinstance(value, list):
        return f"{value:g}"
    return (
        f"{value[0]:g}" if len({*value}) == 1 else "[{}]".format(", ".join(f"{x:g}" for x in value))
    )


def _tool(run: "ContourResult", along: Array) -> Array:
    track = run.track
    return _along((track, track.distance if track.signed is None else track.signed), run, along)


def _blended(run: "ContourResult") -> Array:
    """Contour error of the pulses; where they blend two moves, that from the nearer one."""
    track, segments = run.command_track, run.run.path.segments
    after = np.minimum(track.segment + 1, len(segments) - 1)
    there = segments.distances(run.run.commanded[:, :3], after)
    distance = np.minimum(track.distance, there)
    return distance if track.signed is None else np.copysign(distance, track.signed)


def _along(errors: "tuple[Track, Array]", run: "ContourResult", along: Array) -> Array:
    """Contour error at points of the path, at the first pass of a run."""
    track, values = errors
    place, error = track.along[run.cutting], values[run.cutting]
    first = place >= np.maximum.accumulate(place) - STANDS
    place, error = place[first], error[first]
    # A tool that rests has many samples at one place: the largest of them counts.
    order = np.lexsort((np.abs(error), place))
    place, error = place[order], error[order]
    last = np.concatenate([np.diff(place) > 0.0, [True]])
    return np.interp(along, place[last], error[last])
