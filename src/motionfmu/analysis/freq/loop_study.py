"""Study of one loop: margins, largest gains by model and simulation, measured response."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import control
import numpy as np

from motionfmu.analysis.freq.bench import Setup
from motionfmu.analysis.freq.limit import RingingTest, simulated_gain, small_signal_gain, usual_kick
from motionfmu.analysis.freq.response import Response, measured_loop, room, settling, slowest
from motionfmu.analysis.freq.shape import WORTH, Loop, limits, small
from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.loops import Limit, feedbacks, largest_gain
from motionfmu.analysis.linear.stability import Margins, margins
from motionfmu.analysis.linear.stability import response as gains
from motionfmu.analysis.linear.tuning_parts import worst
from motionfmu.analysis.linear.wiring import Port
from motionfmu.base.errors import InputError

# Frequencies measured, samples of a period, periods until the start has died away, and measured.
_LINES, _SAMPLES_MAX, _SETTLE_MAX, _PERIODS = 60, 10_000, 8, 4
# A frequency whose standard error is a larger share of its value is left out.
_SPREAD = 0.05
# Differences from the model of so many %, degrees or more are told.
_APART = 5.0, 5.0
# Peak of the multisine, in kicks: it is spread over all lines.
_PEAK = 4.0
# A joint of an arm whose loop has a larger gain than this moves too little to be measured.
_HELD = 20.0
# A ringing of so many grains must be followed, or edges are lost and not rounded.
_GRAINS = 20.0


@dataclass(frozen=True)
class LoopStudy:
    """The results of a study of a loop."""

    at: str  # the input at which it is opened
    cut: tuple[str, ...]  # inputs of other loops that are cut
    loop: control.StateSpace  # open
    margins: Margins
    gain: str | None  # parameter whose limit is given; None: a factor on the wire
    linear: Limit  # largest stable gain by the poles
    simulated: Limit | None  # the same by simulation; None if not asked for
    measured: Response | None  # open loop of the running FMUs
    kick: float  # step with which they were made to ring, in the unit of the input
    silent: str = ""  # why the FMUs did not run; empty if they did, or were not asked for
    notes: tuple[str, ...] = ()  # what the response leaves out, and where it is not the model's

    @property
    def difference(self) -> tuple[float, float] | None:
        """How far the FMUs are from the model [%], [deg]."""
        # Where |L| is above -20 dB and something was measured; else None.
        return None if self.measured is None else _difference(self.loop, self.measured)


@dataclass(frozen=True)
class LoopStudyOptions:
    """Options of a study of loops."""

    loop: str | None = None  # one input; None: every input through which a plant is fed back
    gains: Mapping[str, str] | None = None  # parameter whose limit is wanted, by its loop's input
    simulate: bool = True  # run the FMUs too, where they do what the model does
    # Step for ringing, in the unit of the input; None: so small that its size does not matter.
    kick: float | None = None
    progress: Callable[[float], None] = lambda share: None  # share done, 0 to 1


def study(axis: AxisModel, asked: LoopStudyOptions) -> list[LoopStudy]:
    """Study the loops of an axis."""
    if asked.kick is not None and not 0.0 < asked.kick < math.inf:
        raise InputError(f"kick = {asked.kick!r}: a number above 0 wanted")
    every = feedbacks(axis)
    if asked.loop is None:
        chosen = every
        if not chosen:
            raise InputError(
                f"{axis.scenario.document.file}: nothing feeds axis {axis.axis} back: no loop"
            )
    else:
        chosen = {asked.loop: every.get(asked.loop, ())}
    found = []
    for k, (at, cut) in enumerate(chosen.items()):

        def part(share: float, done: int = k) -> None:
            asked.progress((done + share) / len(chosen))

        found.append(_one(axis, (at, cut), asked, part))
    asked.progress(1.0)
    return found


def _one(
    axis: AxisModel,
    which: tuple[str, tuple[str, ...]],
    asked: LoopStudyOptions,
    progress: Callable[[float], None],
) -> LoopStudy:
    at, cut = which
    loop = axis.loop(at, cut)
    gain = (asked.gains or {}).get(at)
    limit = largest_gain(axis, at, cut, gain)
    kick = usual_kick(axis, at, cut) if asked.kick is None else asked.kick
    found = margins(loop)
    ringing, measured = None, None
    notes: tuple[str, ...] = ()
    silent = _silent(axis, at, limit, gain) if asked.simulate else ""
    if asked.simulate and not silent and not worst(axis):
        if found.stable:
            measured, notes = _measured(axis, which, found, asked.kick)
        progress(0.4)

        def tried(runs: int) -> None:
            progress(0.4 + 0.6 * runs / (runs + 3.0))

        if asked.kick is None:
            ringing, kick = small_signal_gain(axis, which, gain, tried)
        else:
            ringing = simulated_gain(axis, which, RingingTest(kick), gain, tried)
    progress(1.0)
    parts = at, cut, loop, found, gain, limit, ringing, measured, kick, silent, notes
    return LoopStudy(*parts)


def _silent(axis: AxisModel, at: str, limit: Limit, gain: str | None) -> str:
    """Why the FMUs would differ from the model; empty if they would not."""
    component, _, variable = at.partition(".")
    grain = getattr(axis.blocks[component], "grain", {}).get(variable, 0.0)
    factor = limit.gain if gain is None and math.isfinite(limit.gain) else 1.0
    needed = _GRAINS * grain * limit.omega
    if not room(axis, at, factor) < needed:
        return ""
    times = "" if factor == 1.0 else f" with {factor:.4g} on its wire"
    return (
        f"{at}{times} would move and ring faster than its FMU follows: name a gain, or state a"
        " slower operating point"
    )


def _measured(
    axis: AxisModel, which: Loop, found: Margins, kick: float | None
) -> tuple[Response | None, tuple[str, ...]]:
    """The measured loop of the FMUs, if it can be measured, and notes about it."""
    at, cut = which
    loop = axis.loop(at, cut)
    low = found.omega_phase if math.isfinite(found.omega_phase) else math.pi / (50.0 * loop.dt)
    closed = axis.system(at, ".".join(axis.wires[_port(at)]), cut)
    if axis.others:  # modes of what they move together lie far below a joint's own loop
        low = min(low, slowest(closed))
    n = min(_SAMPLES_MAX, max(200, 2 * round(10.0 * math.pi / (low * loop.dt))))
    lines = np.unique(np.round(np.geomspace(1, n // 2 - 1, _LINES)).astype(np.int64))
    settle = min(_SETTLE_MAX, max(1, math.ceil(settling(closed) / n)))
    limited = limits(axis, which)
    peak = None if kick is None else _PEAK * kick
    signal = replace(small(axis, which, (n, lines), peak), settle=settle, measure=_PERIODS)
    response = measured_loop(Setup(axis, (at,), tuple(limited), cut), signal)
    for (name, most), reached in zip(limited.items(), response.most, strict=True):
        if reached >= most:
            told = f"{name} reached its limit of {most:g}: the response would not be that of a loop"
            return None, (f"{at}: not measured, {told}",)
    clear = response.spread[:, 0] < _SPREAD
    notes = []
    if axis.others and (held := np.abs(response.values[:, 0]) > _HELD).any():
        clear &= ~held
        notes.append(f"{at}: not looked at where |L| is above {_HELD:g}: nothing moves there")
    elif not clear.all():
        kept = f"{np.count_nonzero(~clear)} of {len(clear)} frequencies left out"
        why = "they stand too little above the rounding, or the start has not died away"
        notes.append(f"{at}: {kept}: {why}")
    if not clear.any():
        return None, tuple(notes)
    response = replace(
        response,
        omega=response.omega[clear],
        values=response.values[clear],
        spread=response.spread[clear],
    )
    apart = _difference(loop, response)
    if apart is not None and (apart[0] > _APART[0] or apart[1] > _APART[1]):
        notes.append(
            f"{at}: that is no linear loop: a part sticks, a gap opens, a limit acts or counts are"
            " too coarse"
        )
    return response, tuple(notes)


def _difference(loop: control.StateSpace, measured: Response) -> tuple[float, float] | None:
    expected = gains(loop, measured.omega)
    worth = np.abs(expected) > WORTH
    if not worth.any():
        return None
    ratio = measured.values[worth, 0] / expected[worth]
    size = 100.0 * float(np.abs(np.abs(ratio) - 1.0).max())
    return size, float(np.degrees(np.abs(np.angle(ratio))).max())


def _port(name: str) -> Port:
    component, _, variable = name.partition(".")
    return component, variable
