"""A multisine for one axis, as large as its limits allow, about a steady speed."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.block import Plant, Sampled
from motionfmu.analysis.linear.law import Law, carried
from motionfmu.analysis.measured_response.mass_names import PlantMasses
from motionfmu.analysis.measured_response.plant_response import axis_of, source_of
from motionfmu.base.errors import InputError
from motionfmu.excite.crest_factor import crest, low_peaks, waves
from motionfmu.run import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
# Highest frequency without being asked [Hz], and as a share of the sampling rate; the most of it.
_HIGH, _OF_RATE, _MOST = 500.0, 0.2, 0.4
# The motor's mean speed over the peak of what is added to it: it never turns back.
_STEADY = 1.3
_AMPLE = 2.0  # the same where there is room
# Share of a limit that mean and peak take together at most, when the mean is chosen.
_SHARE = _STEADY / (1.0 + _STEADY)
# [rad/s] of the motor that friction is slid at, if the limits allow it.
_SLIDING = 10.0
# [rad/s] at which a motion is slow.
_SLOW = 0.5
# Least duration of a start [s], and the share of a torque limit that it may take.
_LEAD, _LEAD_TORQUE = 0.2, 0.3
# Grains of a whole-number input that a signal should have from peak to peak.
_GRAINS = 20


@dataclass(frozen=True)
class ExciteOptions:
    """What is asked of an excitation.

    Parameters
    ----------
    axis : int
        From 1.
    input : str, optional
        Where it is put, ``component.variable``; by default the command of what moves the plant.
    low, high : float, optional
        [Hz] of the band; by default from 2 Hz to 500 Hz, or to what the sampling allows.
    period : float
        [s]; lines are 1/period apart.
    periods : int
        That are measured; one more comes before them.
    speed : float, optional
        [rad/s] of the motor, about which it is excited; by default one at which it does not turn
        back.
    margin : float
        Share of every limit that is used.
    seed : int, optional
        Of random phases; by default those with a low peak.
    """

    axis: int = 1
    input: str | None = None
    low: float = 2.0
    high: float | None = None
    period: float = 1.0
    periods: int = 6
    speed: float | None = None
    margin: float = 0.8
    seed: int | None = None


@dataclass(frozen=True)
class LimitedMove:
    """A signal that the excitation moves, and what limits it."""

    signal: str
    unit: str
    mean: float  # magnitude about which it moves
    peak: float  # of what is added
    limit: float
    continuous: float | None = None  # of the RMS
    rms: float = 0.0  # with the mean

    @property
    def share(self) -> float:
        """Of the limit that is used."""
        share = (self.mean + self.peak) / self.limit
        return max(share, self.rms / self.continuous) if self.continuous else share


@dataclass(frozen=True)
class AxisExcitation:
    """A command over time that excites an axis.

    Attributes
    ----------
    axis : AxisModel
    masses : PlantMasses
    input : str
        ``component.variable`` that it drives.
    unit : str
        Of that, in FMI's spelling.
    is_rate : bool
        Whether the input commands a speed; else it commands a position.
    interval : float
        [s] between two samples.
    time, command : ndarray, shape (n,)
        [s], and the input's unit.
    one : ndarray, shape (m,)
        One period of the multisine.
    hertz, amplitudes : ndarray, shape (lines,)
        Of the input.
    speed : float
        [rad/s] of the motor, mean.
    way : float
        Of the load [its unit], from beginning to end; negative downwards.
    lead : float
        [s] of start and end.
    moves : tuple of LimitedMove
        Signals that have limits.
    crests : dict
        Crest factor by signal.
    options : ExciteOptions
    given : dict
        Values that were set.
    notes : tuple of str
    """

    axis: AxisModel
    masses: PlantMasses
    input: str
    unit: str
    is_rate: bool
    interval: float
    time: Array
    command: Array
    one: Array
    hertz: Array
    amplitudes: Array
    speed: float
    way: float
    lead: float
    moves: tuple[LimitedMove, ...]
    crests: Mapping[str, float]
    options: ExciteOptions
    given: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def moves_source(self) -> str:
        """The signal that moves the plant."""
        return source_of(self.axis, self.masses, self.masses.signal(self.masses.names.drive))


@dataclass(frozen=True)
class MoveLimit:
    """What limits a signal of an axis: its response to the input, its mean, its limit."""

    signal: str
    unit: str
    response: Complex  # at the lines
    per_speed: float  # mean value per speed of the motor
    still: float  # mean value beside that: what friction takes
    limit: float
    continuous: float | None = None


@dataclass(frozen=True)
class TravelRoom:
    """How far the load may go from where it stands, upwards and downwards."""

    signal: str
    up: float
    down: float
    per_speed: float  # rate of the signal per speed of the motor


class ExcitedAxis:
    """What an input moves: responses, limits, and the kind of the input."""

    def __init__(
        self,
        scenario: Scenario,
        given: Mapping[str, Any],
        options: ExciteOptions,
        inside: bool = False,
    ) -> None:
        self.options = options
        self.axis, self.masses = axis_of(scenario, options.axis, given)
        self.given = dict(given)
        self.source = source_of(self.axis, self.masses, self.masses.signal(self.masses.names.drive))
        self.position = self.masses.signal(self.masses.names.motor.position)
        self.input = options.input or self._usual()
        self.port = self.axis.port(self.input, self.axis.inputs, "input")
        block = self.axis.blocks[self.port[0]]
        if isinstance(block, Sampled) and self.port[1] in block.commands and not inside:
            raise InputError(f"{self.input} arises inside: nothing can be driven there")
        if self.port[0] == self.masses.component:
            raise InputError(f"{self.input} is the plant's own: no loop would hold the axis")
        self.slow = np.array([_SLOW, 2.0 * _SLOW])
        angle = self.of(self.position, self.slow)
        if not np.abs(angle).min() > 0.0:
            raise InputError(f"{self.input} does not move the axis")
        growth = abs(angle[0] / angle[1])
        if abs(growth - 1.0) < 0.1:
            self.is_rate, self.per = False, float((angle[0]).real)
        elif abs(growth - 2.0) < 0.2:
            self.is_rate, self.per = True, float((angle[0] * 1j * self.slow[0]).real)
        else:
            raise InputError(
                f"{self.input} commands neither a position nor a speed: no loop would hold the axis"
            )
        torque = self.axis.system(self.input, self.source, cut=self.input)
        net = self.axis.net(self.input, {})
        ends = [
            self.axis.port(n, self.axis.outputs, "output") for n in (self.source, self.position)
        ]
        self.used = net.used([self.port], ends) | {c for c, _ in (self.port, *ends)}
        self.interval = float(torque.dt)

    def _usual(self) -> str:
        """The input of what moves the plant that is no feedback of it and has an effect."""
        component = self.source.partition(".")[0]
        if component == self.masses.component:
            raise InputError(
                f"{self.axis.scenario.document.file}: no drive moves {self.masses.component}: say"
                " --input"
            )
        block = self.axis.blocks[component]
        fed = {t for t, s in self.axis.wires.items() if isinstance(self.axis.blocks[s[0]], Plant)}
        names = block.inputs if isinstance(block, Sampled) else ()
        for name in names:
            if (component, name) in fed:
                continue
            self.input = f"{component}.{name}"
            if np.abs(self.of(self.position, np.array([_SLOW]))).max() > 0.0:
                return self.input
        told = ", ".join(n for n in self.axis.inputs if not n.startswith(self.masses.component))
        raise InputError(f"{component} takes no command: say --input, one of {told}")

    def of(self, output: str, omega: Array) -> Complex:
        """Response of an output to the input, whose wire is cut."""
        system = self.axis.system(self.input, output, cut=self.input)
        return np.asarray(system(np.exp(1j * omega * system.dt), squeeze=False))[0, 0]

    def turning(self, omega: Array) -> Complex:
        """Speeds of motor and load, both in [rad/s] of the motor: neither is to turn back."""
        load = self.masses.signal(self.masses.names.load.position)
        both = self.of(self.position, omega), self.of(load, omega) / self.masses.ratio
        return np.asarray(np.array(both) * 1j * omega)

    # CCN 17: limits of the machine and of the drive's law, each with what it does not hold for.
    def limits(self, omega: Array) -> list[MoveLimit]:
        """What limits the signals that the input moves: by the machine, and by the drive's law."""
        found: dict[str, MoveLimit] = {}
        wire = self.axis.wires.get(self.port)
        before = ".".join(wire) if wire else ""
        for limit in self._own():
            name = limit.signal.name
            if limit.limit is None or limit.derivative or limit.scale != 1.0:
                continue
            if name == before:  # what is wired to the input is taken over by the excitation
                per = (1.0 if self.is_rate else 0.0) / self.per
                one = np.ones(len(omega), dtype=complex)
                found[name] = MoveLimit(name, limit.unit, one, per, 0.0, limit.limit)
            elif name in self.axis.outputs and limit.signal.component in self.used:
                found[name] = self._limit(name, limit.unit, limit.limit, limit.continuous, omega)
        component = self.port[0]
        said = carried(self.axis.scenario.document.body.component[component])
        for output, parameter in said.limit.items() if isinstance(said, Law) else ():
            name = f"{component}.{output}"
            if name not in found and name in self.axis.outputs:
                value = float(self.axis.value(f"{component}.{parameter}"))
                unit = self.axis.scenario.resolver.ports[component][output].unit or "1"
                found[name] = self._limit(name, unit, value, None, omega)
        return [m for m in found.values() if np.abs(m.response).max() > 0.0]

    def _limit(
        self, name: str, unit: str, limit: float, continuous: float | None, omega: Array
    ) -> MoveLimit:
        still, per = 0.0, 0.0
        if name == self.source:
            still = abs(float(self._point().values[self.masses.names.drive]))
        else:
            slow = self.of(name, self.slow)[0]
            rate = slow if self.is_rate else slow / (1j * self.slow[0])
            per = float(rate.real) / self.per
        return MoveLimit(name, unit, self.of(name, omega), per, still, limit, continuous)

    def _own(self) -> list[Any]:
        """Limits of the machine for this axis."""
        body = self.axis.scenario.document.body
        if not body.limits:
            return []
        rows = self.axis.scenario.axis_limits(self.given)
        return [r for r in rows if (r.element is None or r.element == self.options.axis - 1)]

    def _point(self) -> Any:
        return self.axis.points[self.masses.component]

    def travel(self) -> TravelRoom | None:
        """Room of the load; None if nothing says it."""
        point = self._point()
        speed = point.values[self.masses.names.motor.speed]
        for limit in self._own():
            component, _, name = limit.signal.name.partition(".")
            if component != self.masses.component or limit.low is None or limit.high is None:
                continue
            rate = point.rates.get(name, 0.0)
            if rate:
                at = point.values[name] * limit.scale
                up, down = limit.high - at, at - limit.low
                return TravelRoom(limit.signal.name, up, down, rate * limit.scale / speed)
        return None


def excitation_of(
    scenario: Scenario,
    options: ExciteOptions = ExciteOptions(),
    set: Mapping[str, Any] | None = None,
) -> AxisExcitation:
    """Make a multisine that an axis can follow within its limits.

    Parameters
    ----------
    scenario : Scenario
        One with a plant that says what its two masses are; a machine's limits are kept.
    options : ExciteOptions
    set : mapping, optional
        Values by ``component.variable``.

    Returns
    -------
    AxisExcitation

    Raises
    ------
    InputError
        A value is wrong, or the limits leave no room.
    """
    _check(options)
    moved = ExcitedAxis(scenario, dict(set or {}), options)
    interval = moved.interval
    n = round(options.period / interval)
    if n < 8 or abs(n * interval - options.period) > 1e-9 * options.period + 1e-12:
        raise InputError(
            f"period = {options.period:g} s: a whole number of samples of {interval:g} s wanted"
        )
    lines = _lines(options, interval)
    sized = multisine_of(moved, lines, n)
    sines, limits, room, speed = sized.sines, sized.limits, sized.room, abs(sized.speed)
    sign = math.copysign(1.0, sized.speed)
    one = waves(sines, lines, n)
    lead = _lead(moved, limits, speed)
    command, time = _command(moved, one, sign * speed, lead)
    notes = []
    if room is None:
        notes.append("no [limits] of the scenario is a travel: it is not looked at")
    port = scenario.resolver.ports[moved.port[0]][moved.port[1]]
    if port.type == "Int32":
        command = np.round(command)
        if np.ptp(one) < _GRAINS:
            notes.append(
                f"from peak to peak {np.ptp(one):.3g} whole numbers: {moved.input} rounds what is"
                " small"
            )
    way = 0.0 if room is None else sign * speed * room.per_speed * (float(time[-1]) - lead)
    return AxisExcitation(
        moved.axis,
        moved.masses,
        moved.input,
        port.unit or "1",
        moved.is_rate,
        interval,
        time,
        command,
        one,
        lines / options.period,
        np.abs(sines),
        sign * speed,
        way,
        lead,
        tuple(_move(m, sines, lines, speed, n) for m in limits),
        _crests(moved, sines, lines, n),
        options,
        moved.given,
        tuple(notes),
    )


@dataclass(frozen=True)
class SizedSines:
    """Complex amplitudes at the input, as large as the limits allow, and what limits them."""

    sines: Complex
    speed: float  # [rad/s] of the motor, mean
    limits: tuple[MoveLimit, ...]
    room: TravelRoom | None


def multisine_of(moved: ExcitedAxis, lines: NDArray[np.int64], n: int) -> SizedSines:
    """Sines at whole cycles per period of n samples, about the speed that suits them best."""
    options = moved.options
    omega: Array = np.asarray(2.0 * math.pi * lines / options.period, dtype=np.float64)
    limits = moved.limits(omega)
    if not limits:
        raise InputError(f"{moved.input}: nothing limits what it moves: [limits] is missing")
    whole = options.period * (options.periods + 1) + 2.0 * _LEAD
    room = moved.travel()
    most = _fastest(options, limits, room, whole)
    speed = most if options.speed is None else abs(options.speed)
    if speed > most * (1.0 + 1e-9):
        raise InputError(
            f"speed = {speed:g} rad/s: {most:.4g} rad/s is the most that speed, torque and travel"
            f" leave for {whole:.4g} s"
        )
    turning = moved.turning(omega)
    caps = [(options.margin * m.limit - abs(m.per_speed) * speed - m.still, m) for m in limits]
    for cap, m in caps:
        if cap <= 0.0:
            raise InputError(
                f"{m.signal}: friction and a speed of {speed:.4g} rad/s leave nothing of"
                f" {options.margin:g} times its limit, {m.limit:g} {m.unit}"
            )
    rows = np.array([*turning / (speed / _STEADY), *(m.response / cap for cap, m in caps)])
    size = 1.0 / np.abs(rows).max(axis=0)
    if options.seed is None:
        phases = low_peaks(rows * size, lines)
    else:
        phases = np.random.default_rng(options.seed).uniform(0.0, 2.0 * math.pi, len(lines))
    sines = size * np.exp(1j * phases)
    sines /= np.abs(waves(rows * sines, lines, n * max(1, math.ceil(8 * lines[-1] / n)))).max()
    sines *= _continuous(limits, sines, lines, speed, options)
    if options.speed is None:
        peak = float(np.abs(waves(turning * sines, lines, n)).max())
        speed = min(speed, max(_AMPLE * peak, _SLIDING))
    sign = (
        -1.0 if room is not None and room.down * room.per_speed > room.up * room.per_speed else 1.0
    )
    if options.speed is not None:
        sign = math.copysign(1.0, options.speed)
    return SizedSines(sines, sign * speed, tuple(limits), room)


def _check(options: ExciteOptions) -> None:
    """Refuse numbers that are none of an excitation."""
    for name, low, high in (
        ("period", 1e-3, 1e3),
        ("low", 1e-3, 1e5),
        ("high", 1e-3, 1e5),
        ("margin", 0.01, 1.0),
    ):
        value = getattr(options, name)
        if value is not None and not low <= value <= high:
            raise InputError(f"{name} = {value:g}: {low:g} to {high:g} wanted")
    if not 2 <= options.periods <= 1000:
        raise InputError(f"periods = {options.periods}: 2 to 1000 wanted")
    if options.seed is not None and options.seed < 0:
        raise InputError(f"seed = {options.seed}: a whole number from 0 wanted")
    if options.speed is not None and not 0.0 < abs(options.speed) < 1e5:
        raise InputError(f"speed = {options.speed:g} rad/s: one that is not 0 wanted")


def _lines(options: ExciteOptions, interval: float) -> NDArray[np.int64]:
    """Whole cycles per period that lie in the band."""
    most = _MOST / interval
    high = min(_HIGH, _OF_RATE / interval) if options.high is None else options.high
    if high > most:
        raise InputError(
            f"high = {high:g} Hz: {most:g} Hz is the most at samples of {interval:g} s"
        )
    first = max(1, math.ceil(options.low * options.period - 1e-9))
    last = math.floor(high * options.period + 1e-9)
    if last - first < 7:
        raise InputError(
            f"{options.low:g} to {high:g} Hz: 8 lines at least wanted, {1 / options.period:g} Hz"
            " apart; a longer period has more"
        )
    return np.arange(first, last + 1)


def _fastest(
    options: ExciteOptions, limits: Sequence[MoveLimit], room: TravelRoom | None, seconds: float
) -> float:
    """The largest mean speed of the motor that leaves room for as much beside it."""
    found = [
        _SHARE * options.margin * m.limit / abs(m.per_speed) for m in limits if m.per_speed != 0.0
    ]
    if room is not None:
        way = options.margin * max(room.up, room.down)
        if way <= 0.0:
            raise InputError(f"{room.signal}: it stands outside its travel")
        found.append(way / (abs(room.per_speed) * seconds))
    return min(found, default=_SLIDING)


def _continuous(
    limits: Sequence[MoveLimit],
    sines: Complex,
    lines: NDArray[np.int64],
    speed: float,
    options: ExciteOptions,
) -> float:
    """Factor, 1 at most, with which no RMS is above what is allowed for ever."""
    factor = 1.0
    for m in limits:
        if m.continuous is None:
            continue
        mean = abs(m.per_speed) * speed + m.still
        left = (options.margin * m.continuous) ** 2 - mean**2
        if left <= 0.0:
            raise InputError(
                f"{m.signal}: friction takes {mean:.3g} {m.unit}, {m.continuous:g} is allowed for"
                " ever"
            )
        rms = math.sqrt(0.5 * float(np.sum(np.abs(m.response * sines) ** 2)))
        factor = min(factor, math.sqrt(left) / rms)
    return factor


def _lead(moved: ExcitedAxis, limits: Sequence[MoveLimit], speed: float) -> float:
    """Duration of the start, so that it takes little torque [s], in whole samples."""
    masses = moved.masses.of(moved.axis)
    inertia = masses.motor + masses.load
    torques = [m.limit for m in limits if m.signal == moved.source]
    seconds = _LEAD
    if torques:
        seconds = max(_LEAD, 0.5 * math.pi * inertia * speed / (_LEAD_TORQUE * min(torques)))
    return math.ceil(seconds / moved.interval) * moved.interval


def _command(moved: ExcitedAxis, one: Array, speed: float, lead: float) -> tuple[Array, Array]:
    """The command over time: start, a period to settle, those measured, end; and the times."""
    n, interval = len(one), moved.interval
    rise = round(lead / interval)
    count = rise + n * (moved.options.periods + 1) + rise
    k = np.arange(count + 1)
    up = 0.5 - 0.5 * np.cos(np.pi * np.minimum(k / rise, 1.0))
    down = 0.5 - 0.5 * np.cos(np.pi * np.minimum((count - k) / rise, 1.0))
    part = np.minimum(up, down)
    mean = part * speed / moved.per
    if not moved.is_rate:
        mean = interval * (np.cumsum(mean) - mean)
    return np.asarray(mean + part * one[k % n]), np.asarray(k * interval)


def _move(
    m: MoveLimit, sines: Complex, lines: NDArray[np.int64], speed: float, n: int
) -> LimitedMove:
    added = waves(m.response * sines, lines, n)
    mean = abs(m.per_speed) * speed + m.still
    rms = math.hypot(mean, float(np.sqrt(np.mean(added**2))))
    peak = float(np.abs(added).max())
    return LimitedMove(m.signal, m.unit, mean, peak, m.limit, m.continuous, rms)


def _crests(
    moved: ExcitedAxis, sines: Complex, lines: NDArray[np.int64], n: int
) -> dict[str, float]:
    omega: Array = np.asarray(2.0 * math.pi * lines / moved.options.period, dtype=np.float64)
    rows = {moved.input: np.ones(len(lines)), moved.source: moved.of(moved.source, omega)}
    return {name: crest(waves(row * sines, lines, n)) for name, row in rows.items()}


__all__ = ["AxisExcitation", "ExciteOptions", "LimitedMove", "excitation_of"]
