"""The largest gain with which a loop of running FMUs does not ring."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.freq.bench import Bench, Setup
from motionfmu.analysis.freq.response import fastest, gentle, ramp
from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.block import Sampled
from motionfmu.analysis.linear.loops import (
    Limit,
    begin,
    boundary,
    is_whole,
    largest_gain,
    with_gain,
)
from motionfmu.base.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RingingTest:
    """The test by which a loop is made to ring."""

    kick: float  # step, in the unit of the input: many of its grains, far from every limit
    cycles: int = 30  # of the ringing that are watched, after half as many
    tolerance: float = 0.01  # relative width at which the search ends; the rest is interpolated


# The amplitude of ringing is used between these multiples of the first ringing and of the grain:
# above, a limit may act; below, there is rounding.
_CAP, _FLOOR = 4.0, 1.0
# A run ends as unstable at a deviation of so many kicks.
_RUNAWAY = 300.0
_CYCLES_PER_WINDOW = 2
# The usual kick is so many grains, with the largest response within so many samples.
_GRAINS, _LOOK = 200.0, 200
# The next smaller kick is this share of the last; so many are tried, until two gains differ by less
# than this.
_SMALLER, _SMALLEST, _SAME = 0.2, 2, 0.01


def usual_kick(axis: AxisModel, at: str, cut: tuple[str, ...] = ()) -> float:
    """A step, in the input's unit, of 200 grains where a port rounds."""
    # 1 if nothing rounds. An input that follows no faster than some speed gets less, so that it
    # follows the ringing too.
    component, _, variable = at.partition(".")
    grains = {
        f"{c}.{p}": b.grain[p]
        for c, b in axis.blocks.items()
        if isinstance(b, Sampled)
        for p in (*b.outputs, *b.early)
        if b.grain.get(p, 0.0) > 0.0
    }
    own = axis.blocks[component]
    wanted = [_GRAINS * own.grain.get(variable, 0.0)] if isinstance(own, Sampled) else []
    for name, grain in grains.items():
        system = axis.system(at, name, cut)
        x, top = np.zeros((system.nstates, 1)), 0.0
        for _ in range(_LOOK):
            top = max(top, abs(float((system.C @ x + system.D)[0, 0])))
            x = system.A @ x + system.B
        if 0.0 < top < math.inf:
            wanted.append(_GRAINS * grain / top)
    kick, omega = max(wanted, default=0.0) or 1.0, math.nan
    if fastest(axis, at) < math.inf:
        omega = largest_gain(axis, at, cut).omega
    return min(kick, fastest(axis, at) / (_CAP * omega)) if omega > 0.0 else kick


def ringing(setup: Setup, trial: RingingTest, omega: float) -> tuple[float, float]:
    """Growth [1/s] and pitch [rad/s] of a ringing of the running FMUs.

    The root of the mean square in windows, on a straight line over time in its logarithm. The pitch
    `omega` expected [rad/s] sets the length of the run only. A refusal of an FMU is an InputError.
    """
    name = setup.inputs[0]
    component, _, variable = name.partition(".")
    source = setup.axis.wires[component, variable]
    bench = Bench(replace(setup, outputs=(".".join(source),)))
    step = bench.step_ns * 1e-9
    cycle = max(4, round(2.0 * math.pi / (omega * step)))
    lead = cycle * trial.cycles // 2
    way = gentle(ramp(bench, name) * step, lead, lead + cycle * trial.cycles)
    added = setup.gains.get(name, 1.0) * way[:, None]
    rise = math.ceil(abs(trial.kick) / (fastest(setup.axis, name) * step))
    added[lead:, 0] += trial.kick * np.minimum(
        np.arange(1, len(added) - lead + 1) / max(rise, 1), 1.0
    )
    far = _RUNAWAY * abs(trial.kick) + abs(way[-1] - way[-2]) / step

    def away(shown: Array) -> int | None:
        beyond = np.abs(shown[:, 0] - shown[0, 0] + way[: len(shown)]) > far
        return int(np.argmax(beyond)) + 1 if beyond.any() else None

    shown, _ = bench.run(added, away)
    factor = setup.gains.get(name, 1.0)
    deviation = factor * (shown[:, 0] - shown[0, 0] + way[: len(shown)])
    grain = getattr(setup.axis.blocks[component], "grain", {}).get(variable, 0.0)
    part = deviation[lead + cycle :]
    if len(part) < 2 * _CYCLES_PER_WINDOW * cycle:  # it ran away before it was looked at
        return math.log(_RUNAWAY) / (len(deviation) * step), omega
    return _growth(part, (step, cycle), abs(trial.kick), grain)


def _growth(
    part: Array, times: tuple[float, int], kick: float, grain: float
) -> tuple[float, float]:
    step, cycle = times
    size = _CYCLES_PER_WINDOW * cycle
    windows = part[: len(part) // size * size].reshape(-1, size)
    index = np.arange(size)
    flat = np.array([w - np.polyval(np.polyfit(index, w, 1), index) for w in windows])
    rms = np.sqrt(np.mean(flat * flat, axis=1))
    good = (rms > _FLOOR * grain) & (rms > 1e-9 * kick) & (rms < _CAP * max(rms[0], 0.1 * kick))
    first = int(np.argmin(good)) if not good.all() else len(good)
    if first < 2:
        up = rms[min(1, len(rms) - 1)] > rms[0]
        return (1.0 if up else -1.0) * math.log(_RUNAWAY) / (size * step), _pitch(
            flat[:1], cycle
        ) / step
    slope = np.polyfit(np.arange(first) * size * step, np.log(rms[:first]), 1)[0]
    return float(slope), _pitch(flat[:first], cycle) / step


def _pitch(windows: Array, cycle: int) -> float:
    """Frequency [rad/sample]: x(k + m) + x(k - m) = 2 cos(m w) x(k), m a quarter cycle."""
    m = max(1, cycle // 4)
    middle = windows[:, m:-m]
    both = windows[:, 2 * m :] + windows[:, : -2 * m]
    cosine = float(np.sum(both * middle) / (2.0 * max(np.sum(middle * middle), 1e-300)))
    return math.acos(max(-1.0, min(1.0, cosine))) / m


def simulated_gain(
    axis: AxisModel,
    loop: tuple[str, tuple[str, ...]],
    trial: RingingTest,
    gain: str | None = None,
    progress: Callable[[int], None] = lambda runs: None,
) -> Limit:
    """The largest gain of a loop, by running its FMUs until they ring.

    The loop is an input and the inputs of other loops that are cut; without a parameter the gain is
    a factor on the wire. The search begins at the linear model's limit, and finds its own.
    """
    at, cut = loop
    expected = largest_gain(axis, at, cut, gain)
    start = expected.gain if 0.0 < expected.gain < math.inf else begin(axis, gain)
    omega = expected.omega if expected.omega > 0.0 else math.pi / (20.0 * axis.loop(at, cut).dt)
    heard: dict[float, float] = {}

    def growth(value: float) -> float:
        if gain is None:
            setup = Setup(axis, (at,), (), cut, gains={at: value})
        else:
            setup = Setup(with_gain(axis, gain, value), (at,), (), cut)
        rate, heard[value] = ringing(setup, trial, omega)
        progress(len(heard))
        return rate

    if at not in (".".join(t) for t in axis.wires):
        raise InputError(f"{at} has no wire: no loop is closed there")
    found, tried = bracketed(growth, start, trial.tolerance, is_whole(axis, gain))
    if not math.isfinite(found) or not heard:
        return Limit(found, math.nan, tried)
    nearest = min(heard, key=lambda v: abs(v - found))
    return Limit(found, heard[nearest], tried)


def small_signal_gain(
    axis: AxisModel,
    loop: tuple[str, tuple[str, ...]],
    gain: str | None = None,
    progress: Callable[[int], None] = lambda runs: None,
) -> tuple[Limit, float]:
    """As `simulated_gain`, with a step so small that its size does not matter.

    It begins with `usual_kick` and takes a fifth of it until two steps, or a step and the linear
    model, give the same gain within 1 %; a limit that acts, such as that of a torque, would show.
    The last step tried, in the unit of the input, is given too.
    """
    usual, runs = usual_kick(axis, *loop), 0
    before = largest_gain(axis, *loop, gain).gain
    for part in range(_SMALLEST + 1):
        kick = usual * _SMALLER**part

        def count(n: int, done: int = runs) -> None:
            progress(done + n)

        found = simulated_gain(axis, loop, RingingTest(kick), gain, count)
        runs += found.evaluations
        if math.isclose(found.gain, before, rel_tol=_SAME):
            break
        before = found.gain
    return replace(found, evaluations=runs), kick


def bracketed(
    growth: Callable[[float], float], start: float, tolerance: float, whole: bool
) -> tuple[float, int]:
    """As `boundary`, with few calls where the start is near."""
    known: dict[float, float] = {}

    def rate(value: float) -> float:
        if value not in known:
            known[value] = growth(value)
        return known[value]

    spread = 2.0 * tolerance
    low, high = start * (1.0 - spread), start * (1.0 + spread)
    if whole:
        low, high = float(math.floor(low)), float(math.ceil(high))
    if low >= 1.0 or not whole:
        below, above = rate(low), rate(high)
        if below < 0.0 <= above:
            start = low
        else:
            start = high if below < 0.0 else low
        if below < 0.0 <= above and not whole:
            while high - low > tolerance * high:
                middle = 0.5 * (low + high)
                low, high = (middle, high) if rate(middle) < 0.0 else (low, middle)
            below, above = rate(low), rate(high)
            return low - below * (high - low) / (above - below), len(known)
    found, _ = boundary(rate, start, tolerance, whole)
    return found, len(known)
