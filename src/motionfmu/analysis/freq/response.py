"""Frequency responses measured on the running FMUs."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import control
import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.freq.bench import Bench, Setup
from motionfmu.analysis.freq.excitation import Excitation, sine
from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.block import Sampled
from motionfmu.analysis.linear.plant import Point
from motionfmu.analysis.linear.stability import moving
from motionfmu.base.errors import InputError

Array = NDArray[np.float64]
# An input is moved with this share of the speed that it can follow.
_FOLLOWED = 0.8


@dataclass(frozen=True)
class Response:
    """A measured frequency response.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        [rad/s].
    values : ndarray of complex, shape (n, n_outputs)
        Output per input, in their units.
    period : float
        Sampling period [s]; the response repeats beyond pi/period.
    spread : ndarray, shape (n, n_outputs)
        Standard error of the mean over the periods, as a share of the value: rounding, what does
        not repeat. NaN from one period.
    most : ndarray, shape (n_outputs,)
        Largest magnitude of each output while it was measured.
    """

    omega: Array
    values: NDArray[np.complex128]
    period: float
    spread: Array
    most: Array


def ramp(bench: Bench, name: str) -> float:
    """Rate to add [input's unit/s] so that the axis moves as stated.

    A loop that follows its feedback moves the axis by what is added there, the other way round.
    0 at rest, or if its wire comes from no plant.
    """
    return -_rate(bench.axis, name)


def _rate(axis: AxisModel, name: str) -> float:
    """Speed of an input at the operating point."""
    component, _, variable = name.partition(".")
    source = axis.wires.get((component, variable))
    point: Point | None = axis.points.get(source[0]) if source else None
    return 0.0 if point is None or source is None else point.rates.get(source[1], 0.0)


def gentle(rate: float, lead: int, steps: int) -> Array:
    """A position whose rate per step rises smoothly within the lead."""
    time = np.arange(steps, dtype=float)
    soft = max(0.6 * lead, 1.0)
    rising = 0.5 * (time - soft / np.pi * np.sin(np.minimum(time / soft, 1.0) * np.pi))
    found: Array = rate * np.where(time < soft, rising, time - 0.5 * soft)
    return found


def room(axis: AxisModel, name: str, factor: float = 1.0) -> float:
    """Speed that an input can follow beside that of the operating point [its unit/s]."""
    # Below 0 if the operating point alone is too fast.
    return fastest(axis, name) - abs(factor * _rate(axis, name))


def fastest(axis: AxisModel, name: str) -> float:
    """Usable share of the speed that an input can follow; infinite if unlimited."""
    component, _, variable = name.partition(".")
    block = axis.blocks[component]
    found = block.speed.get(variable, math.inf) if isinstance(block, Sampled) else math.inf
    return _FOLLOWED * found


def _held(signal: Array, hold: int, fastest: float) -> Array:
    """A signal held from sample to sample.

    If an input cannot follow jumps, it goes straight from sample to sample, reduced to what the
    input follows.
    """
    if not fastest < math.inf:
        return np.repeat(signal, hold)
    way = float(np.abs(np.diff(signal, prepend=signal[-1])).max()) / hold
    factor = min(1.0, fastest / way) if way > 0.0 else 1.0
    place = np.arange(len(signal) * hold) / hold
    known = np.arange(len(signal) + 1.0), np.append(signal, signal[0])
    return factor * np.interp(place, *known)


def measure(setup: Setup, excitation: Excitation) -> Response:
    """Excite the first input and compare the outputs with it.

    An input that cannot follow jumps is moved on straight lines from sample to sample, and less far
    where that is too fast.

    Where the operating point has a speed and the input's wire comes from the plant, a ramp is
    added too, so that the FMUs move at that speed. Where more than one period is measured, straight
    drifts are taken off the outputs.

    Parameters
    ----------
    setup : Setup
    excitation : Excitation
        Its samples are held over the common period of all grids between input and outputs.

    Returns
    -------
    Response

    Raises
    ------
    InputError
        A name is unknown, or an FMU refused something.
    """
    bench = Bench(setup)
    linear = setup.axis.system(setup.inputs, setup.outputs, setup.cut, setup.delays)
    period_ns = round(linear.dt * 1e9)
    hold = period_ns // bench.step_ns
    n = len(excitation.signal)
    repeats = excitation.settle + excitation.measure
    speed = fastest(setup.axis, setup.inputs[0]) * bench.step_ns * 1e-9
    one = _held(np.tile(excitation.signal, repeats), hold, speed)
    added = np.zeros((len(one), len(setup.inputs)))
    added[:, 0] = one
    slope = ramp(bench, setup.inputs[0]) * bench.step_ns * 1e-9
    way = gentle(slope, n * hold * excitation.settle, len(one))
    added[:, 0] += way
    shown, used = bench.run(added)
    shown, excited = shown[::hold], (used[:, 0] - way)[::hold]
    first = n * excitation.settle
    e, _ = _lines(excited[first:], n, excitation.lines)
    found = [_lines(y[first:], n, excitation.lines) for y in shown.T]
    values = np.column_stack([y / e for y, _ in found])
    with np.errstate(divide="ignore", invalid="ignore"):  # an output that does not move
        spread = np.column_stack([error / np.abs(y) for y, error in found])
    omega = 2.0 * np.pi * excitation.lines / (n * period_ns * 1e-9)
    most = np.abs(shown[first:]).max(axis=0, initial=0.0)
    return Response(omega, values, period_ns * 1e-9, spread, most)


def _lines(x: Array, n: int, lines: NDArray[np.int64]) -> tuple[NDArray[np.complex128], Array]:
    """Spectrum of the mean period, without a straight drift, and its standard error."""
    periods = len(x) // n
    if periods > 1:
        drift = (x[(periods - 1) * n :].mean() - x[:n].mean()) / ((periods - 1) * n)
        x = x - drift * np.arange(len(x))
    each = x.reshape(periods, n)
    found: NDArray[np.complex128] = np.fft.rfft(each.mean(axis=0))[lines]
    if periods == 1:
        return found, np.full(len(lines), math.nan)
    apart = np.abs(np.fft.rfft(each - each.mean(axis=0))[:, lines]) ** 2
    return found, np.sqrt(apart.sum(axis=0) / (periods * (periods - 1)))


def measured_loop(setup: Setup, excitation: Excitation) -> Response:
    """The open loop at an input, measured with the loop closed.

    With e added to what the wire brings, y, the FMU reads u = y + e; L = -y/u.

    Parameters
    ----------
    setup : Setup
        One wired input; outputs are only watched.
    excitation : Excitation

    Returns
    -------
    Response
        One column; `Response.most` is that of the outputs of the setup.

    Raises
    ------
    InputError
        The input is not wired, a name is unknown, or an FMU refused something.
    """
    component, _, name = setup.inputs[0].partition(".")
    source = setup.axis.wires.get((component, name))
    if source is None:
        raise InputError(f"{setup.inputs[0]} has no wire: no loop is closed there")
    closed = measure(replace(setup, outputs=(".".join(source), *setup.outputs)), excitation)
    share = closed.values[:, :1]
    spread = closed.spread[:, :1] / np.abs(1.0 + share)  # dL/L = ds/(s (1 + s))
    loop = -share / (1.0 + share)
    return Response(closed.omega, loop, closed.period, spread, closed.most[1:])


def settling(system: control.StateSpace) -> float:
    """Samples until a transient has died away to a thousandth."""
    # Poles at 1 only hold a position and do not count. An unstable system: as one which nearly is.
    slow = np.abs(moving(system.poles())).max(initial=1e-3)
    return 7.0 / -math.log(min(float(slow), 1.0 - 1e-4))


def slowest(system: control.StateSpace) -> float:
    """Frequency of the slowest ringing [rad/s]; infinite if nothing rings."""
    poles = system.poles()
    roots = np.log(poles[np.abs(poles) > 1e-9]) / system.dt
    ringing = np.abs(roots[roots.imag > np.abs(roots.real)])
    return float(ringing.min(initial=math.inf))


def sweep(
    setup: Setup,
    omegas: Iterable[float],
    peak: float,
    cycles: int = 6,
    progress: Callable[[float], None] = lambda share: None,
) -> Response:
    """One sine after the other, each in a run of its own.

    Parameters
    ----------
    setup : Setup
    omegas : iterable of float
        [rad/s]; each is moved to the nearest with a whole number of samples in some cycles.
    peak : float
        In the unit of the input.
    cycles : int
        Cycles measured; as many before them, or more, let the start die away.
    progress : callable
        Called with the share done, 0 to 1.

    Returns
    -------
    Response

    Raises
    ------
    InputError
        A name is unknown, or an FMU refused something.
    """
    linear = setup.axis.system(setup.inputs, setup.outputs, setup.cut, setup.delays)
    wanted = list(omegas)
    found = []
    for k, omega in enumerate(wanted):
        samples = 2.0 * np.pi / (omega * linear.dt)
        n = max(round(cycles * samples), 2 * cycles)
        before = max(1, math.ceil(settling(linear) / n))
        found.append(measure(setup, sine(n, cycles, peak, settle=before, measure=1)))
        progress((k + 1) / len(wanted))
    return Response(
        np.concatenate([r.omega for r in found]),
        np.vstack([r.values for r in found]),
        float(linear.dt),
        np.vstack([r.spread for r in found]),
        np.max([r.most for r in found], axis=0),
    )
