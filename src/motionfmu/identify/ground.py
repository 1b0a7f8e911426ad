"""What all fits of a record share: the loop, the record on its grid, and inverse dynamics."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError, suggestion
from motionfmu.identify import rigid_motion
from motionfmu.identify.axis_loop import AxisLoop, axis_loop
from motionfmu.identify.axis_record import AxisRecord
from motionfmu.identify.contact_shooting import ContactShooting
from motionfmu.identify.controller_check import ControllerCheck, controller_check, gains_of
from motionfmu.identify.free_parameters import (
    FreeParameters,
    Identifiable,
    carried,
    checked,
    free_parameters,
    movable,
)
from motionfmu.identify.limited_samples import LimitedSamples, limited_samples
from motionfmu.identify.loop_motion import LoopMotion, Pieces, PieceStart
from motionfmu.identify.plant_rates import PlantRates
from motionfmu.identify.recorded_loop import ColumnUse, RecordedLoop, ratio_of_inputs, recorded
from motionfmu.identify.rigid_motion import Followed, Way
from motionfmu.identify.shooting import Shooting, Stretch
from motionfmu.run import Scenario

Array = NDArray[np.float64]
# Low pass before speeds and accelerations are taken of a record [Hz], and the most of it as a share
# of the sampling rate: above the motion of machines, below the noise of their encoders.
LOW_PASS, OF_RATE = 60.0, 1.0 / 16.0
# Points of the inverse dynamics, and the periods of the low pass left out at both ends.
_POINTS, _ENDS = 800, 3.0
# Speeds below this share of the largest tell of rest, not of friction in motion.
_MOVING = 0.02
# Pieces of multiple shooting [s], and the fewest samples of one.
_PIECE, _FEWEST = 0.1, 20
# Points at which the fastest rate is looked for.
_LOOKS = 40
# Time before a drive first reaches its limit by which its law can be judged [s].
_JUDGED = 0.2
# Share of the largest speed at which the directions of a motion are taken.
_PART = 0.3
# A plant with a gap has forgotten on which side it began when it has moved at this share of its
# largest speed, for so long [s].
_AWAY, _TOUCHED = 0.1, 0.2
# Time in which the motion of a plant with a gap is held to be another than the recorded one [s].
_STRANGE = 0.05
# Share of the points whose slopes of the drive are believed.
_BELIEVED = 0.9
# A quantity is not moved by more than so many times what it is believed to be.
_SEVERAL = 10.0
# An axis that moves by no more than so many grains, or deviations of the noise, stands still.
_STILL = 30.0
# A residual that rounding to a grain leaves.
_ROUNDED = 1.0 / np.sqrt(12.0)
# Share of a signal's range that a residual is not below, for a record that is exact.
_EXACT = 1e-7


@dataclass(frozen=True)
class IdentifyOptions:
    """What is asked of a record.

    Parameters
    ----------
    columns : mapping
        What each column of the record is, by its name.
    axis : int
        Of the scenario, from 1.
    free : sequence of str, optional
        Quantities that are free instead of those that the plant proposes.
    fix : sequence of str
        Quantities that stay as the scenario has them.
    laws : sequence of str, optional
        Extensions of the friction law that are taken, instead of those that validation chooses.
    keep : float
        Share of the record, at its end, that is kept back for validation.
    controller : bool
        Whether gains of the controller that the record contradicts are taken from the record.
    compiled : bool
        Whether the machine's C compiler is used, if there is one.
    """

    columns: Mapping[str, ColumnUse]
    axis: int = 1
    free: Sequence[str] | None = None
    fix: Sequence[str] = ()
    laws: Sequence[str] | None = None
    keep: float = 0.3
    controller: bool = True
    compiled: bool = True


@dataclass(frozen=True)
class Ground:
    """A loop with its record."""

    loop: AxisLoop
    data: RecordedLoop
    check: ControllerCheck | None
    known: Identifiable
    other: Mapping[str, Any]  # values tried that the scenario does not say
    rates: PlantRates
    motion: LoopMotion
    way: Way
    drive: int  # input that moves the plant
    position: int  # output of `rates` that is its position
    moving: tuple[Array, Array, Array]  # position, speed, acceleration at all samples
    force: Array  # what drives it, at all samples, through the same low pass
    points: NDArray[np.int64]  # samples at which inverse dynamics are taken
    memory: Array  # of the laws at all points
    late: int  # communication steps by which laws show later what the record has
    limited: LimitedSamples  # samples that are left out
    ratios: Mapping[str, float] = field(default_factory=dict)  # of signals per m or rad
    length: str = "m"  # unit of what the ratios are per
    gains_taken: bool = False  # whether the loop has gains of the record
    still: bool = False  # whether the axis does not move more than its encoder rounds

    @property
    def first(self) -> int:
        """The first sample that is compared."""
        return self.late // self.data.every

    def free(self, names: Sequence[str]) -> FreeParameters:
        """Free quantities of these names."""
        given = self.loop.p, self.loop.u
        return free_parameters(self.loop.ode, names, given, self.known, self.rates.moved)

    def follow(self, free: FreeParameters, values: Array, points: Any) -> Followed:
        """States and drive that follow the record's motion at samples."""
        s, v, a = (m[points] for m in self.moving)
        plan = self.way, self.drive, self.position
        return rigid_motion.follow(self.rates, (s, v, a), plan, free.values(values))

    def stretch(self, begin: int, end: int) -> tuple[Stretch, NDArray[np.int64]]:
        """Pieces of samples [begin, end), and the sample at which each begins."""
        data = self.data
        size = max(_FEWEST, round(_PIECE / data.interval))
        runs = self.limited.runs(begin, end)
        each = [np.arange(a, max(a + 1, b - size // 2), size, dtype=np.int64) for a, b in runs]
        nothing = [np.zeros(0, dtype=np.int64)]
        starts = np.concatenate([*each, *nothing])
        lengths = np.concatenate(
            [*(np.diff(np.append(s, run[1])) for s, run in zip(each, runs, strict=True)), *nothing]
        )
        rows = np.concatenate([*(np.arange(a, b) for a, b in runs), *nothing])
        joined = np.concatenate([*(np.arange(len(s)) > 0 for s in each), np.zeros(0, dtype=bool)])
        pieces = Pieces(
            starts * data.every, lengths * data.every, data.every, self.late % data.every
        )
        measured = np.empty((len(rows), len(data.compared)))
        floor = np.empty(len(data.compared))
        outputs = [f"{self.loop.component}.{n}" for n in self.rates.outputs] + list(self.loop.shown)
        for k, name in enumerate(data.compared):
            back = self.first if name in self.loop.shown else 0
            measured[:, k] = data.measured[rows - back, k]
            grain = self.loop.grain.get(name, 0.0) * _ROUNDED
            floor[k] = max(grain, _EXACT * float(np.ptp(data.measured[:, k])))
        columns = np.array([outputs.index(n) for n in data.compared], dtype=np.int64)
        settled = [np.arange(a, b) >= self._settled(a, b) for a, b in runs]
        counted = np.concatenate([*settled, np.zeros(0, dtype=bool)])
        known = joined, data.driven, measured, columns, floor, rows, counted
        return Stretch(pieces, *known), starts

    def _settled(self, begin: int, end: int) -> int:
        """The sample from which on a motion does not know where in its gap the plant began."""
        if not self.gap:
            return begin
        speed = np.abs(self.moving[1])
        fast = np.flatnonzero(speed[begin:end] > _AWAY * speed.max())
        first = begin + int(fast[0]) if len(fast) else begin
        return min(first + round(_TOUCHED / self.data.interval), (begin + end) // 2)

    @property
    def gap(self) -> bool:
        """Whether parts of the plant move across a gap."""
        return bool(self.way.gap.any())

    def fixed(self, p: Array, u: Array) -> FreeParameters:
        """Nothing free, with these parameters and inputs."""
        return replace(self.free(()), p=p, u=u)

    def value(self, name: str) -> float:
        """Value of a parameter or an input of the plant, as the scenario has it."""
        for rows, values in (
            (self.loop.ode.parameters, self.loop.p),
            (self.loop.ode.inputs, self.loop.u),
        ):
            for d, value in zip(rows, values.tolist(), strict=True):
                if d.name == name:
                    return float(value)
        raise KeyError(name)

    def set_name(self, name: str) -> str:
        """A component's variable as --set takes it: the axis' element of an array."""
        component, _, variable = name.partition(".")
        shape = self.loop.scenario.resolver.ports[component][variable].shape
        return f"{name}[{self.loop.axis}]" if shape else name

    def shooting(
        self, free: FreeParameters, span: tuple[int, int], values: Array
    ) -> tuple[Shooting, PieceStart]:
        """The problem of a span of samples, and starts of its pieces that follow the record."""
        stretch, starts = self.stretch(*span)
        some = np.linspace(0, self.data.samples - 1, _LOOKS * 5).astype(np.int64)
        x = self.follow(free, values, np.concatenate([starts, some])).x
        w = self.memory[starts * self.data.every]
        ranges = np.concatenate([np.ptp(x, axis=1), np.ptp(self.memory, axis=0)])
        given = self.motion, stretch, free.values, (free.low, free.high), ranges
        problem = Shooting(*given)
        if self.gap:
            window = max(_FEWEST, round(_STRANGE / self.data.interval))
            problem = ContactShooting(*given, self._farthest(free, values), window)
        return problem, PieceStart(x[:, : len(starts)].T.copy(), w.copy())

    def reach(self, free: FreeParameters, values: Array) -> Array:
        """Change of each free quantity that is as much as all of the drive; infinite if none is."""
        if not (len(values) and len(self.points)):
            return np.full(len(values), np.inf)
        slopes = np.abs(self.follow(free, values, self.points).slopes)
        # in a gap a slope may be anything
        slopes = np.minimum(slopes, np.quantile(slopes, _BELIEVED, axis=0))
        drive = np.sqrt(np.mean(self.force[self.points] ** 2))
        each = np.sqrt(np.mean(slopes**2, axis=0))
        return np.where(each > 0.0, drive / np.maximum(each, 1e-300), np.inf)

    def _farthest(self, free: FreeParameters, values: Array) -> Array:
        """The same, but no more than several times what is believed, nor than a limit."""
        size = np.maximum(np.abs(values), np.abs(free.start))
        most = np.where(free.start == 0.0, np.inf, _SEVERAL * size)
        most = np.minimum(most, np.where(np.isfinite(free.high), np.abs(free.high), np.inf))
        most = np.minimum(most, self.reach(free, values))
        return np.where(np.isfinite(most), most, np.maximum(size, 1.0))


# CCN 22: one record's way from its columns to what all fits share, each part made of the last.
def ground(
    scenario: Scenario,
    record: AxisRecord,
    options: IdentifyOptions,
    given: tuple[Mapping[str, Any], Mapping[str, Any]],
) -> Ground:
    """Loop, record, controller and inverse dynamics; `given` are values, and values tried."""
    own, other = given
    inputs = [u.signal for u in options.columns.values() if _is_input(scenario, u.signal)]
    outputs = [u.signal for u in options.columns.values() if u.signal not in inputs]

    def made(more: Mapping[str, Any]) -> AxisLoop:
        return axis_loop(scenario, options.axis, {**own, **other, **more}, (inputs, outputs))

    loop = made({})
    known = carried(loop.fmu)
    asked = [*known.free, *checked(loop.ode, options.free or (), loop.wired, "free")]
    shown = [n.partition(".")[2] for n in outputs if n.partition(".")[0] == loop.component]
    every = list(dict.fromkeys([*loop.fed, *shown]))
    drive = _drive(loop)
    ratios = _ratios(loop, drive)
    every = every or [n.partition(".")[2] for n in ratios if n.startswith(f"{loop.component}.")][:1]
    rates = PlantRates(loop.ode, every, movable(known, asked, loop.ode))
    data = recorded(loop, record, options.columns, ratios)
    position, raw = _position(loop, data, every, ratios)
    motion = LoopMotion(loop, rates, options.compiled)
    per = ratios[f"{loop.component}.{every[position]}"]
    fed = [np.repeat(raw * ratios[f"{loop.component}.{n}"] / per, data.every) for n in loop.fed]
    points = len(data.driven)
    seen = np.column_stack([data.driven, *(f[:points] for f in fed)])
    limited = limited_samples(loop, data, _force(loop, data, drive, (motion.along(seen)[0], seen)))
    check = None
    signal = next((s for s in data.compared if s in loop.shown), None)
    if signal is not None:
        column = data.measured[: _unlimited(limited, data), data.compared.index(signal)]
        values = dict(loop.values.items())
        check = controller_check(
            (loop, signal, column, data.every),
            lambda at: motion.with_laws(at).along(seen)[1][:, loop.shown.index(signal)],
            made,
            gains_of(loop, values),
        )
        if check.taken and options.controller:
            loop = made({n: v for n, (_, v) in check.gains.items()})
            motion = motion.with_laws(loop)
    memory, _ = motion.along(seen)
    cutoff = min(LOW_PASS, OF_RATE / data.interval)
    smooth = rigid_motion.smooth(
        [raw, _force(loop, data, drive, (memory, seen))], data.interval, cutoff
    )
    speed, acceleration = rigid_motion.derivatives(smooth[0], data.interval)
    grain = loop.grain.get(f"{loop.component}.{every[position]}", 0.0)
    ends = min(int(_ENDS / cutoff / data.interval), data.samples // 4)
    at = np.arange(ends, data.samples - ends, max(1, data.samples // _POINTS))
    at = at[~limited.out[at]]
    at = at[np.abs(speed[at]) > _MOVING * np.abs(speed[at]).max(initial=0.0)]
    way = _way(loop, rates, (drive, position), float(np.abs(speed).max()))
    motion.contact = bool(way.gap.any())
    return Ground(
        loop=loop,
        data=data,
        check=check,
        known=known,
        other=other,
        rates=rates,
        motion=motion,
        way=way,
        drive=drive,
        position=position,
        moving=(smooth[0], speed, acceleration),
        force=smooth[1],
        points=at,
        memory=memory,
        late=check.lag if check else 0,
        limited=limited,
        ratios=ratios,
        gains_taken=bool(check and check.taken and options.controller),
        still=bool(np.ptp(smooth[0]) <= _STILL * max(grain, float(np.std(raw - smooth[0])))),
    )


def _unlimited(limited: LimitedSamples, data: RecordedLoop) -> int:
    """Samples from the beginning on by which a law is judged: until it first reaches its limit."""
    enough = limited.first * data.interval > _JUDGED
    return limited.first if enough else data.samples


def _is_input(scenario: Scenario, signal: str) -> bool:
    component, _, variable = signal.partition(".")
    ports = scenario.resolver.ports.get(component)
    if ports is None:
        raise InputError(f"{signal}: the scenario has no component {component!r}")
    port = ports.get(variable.partition("[")[0])
    if port is None:
        raise InputError(f"{signal}: {component} has no such signal{suggestion(variable, ports)}")
    return port.causality == "input"


def _drive(loop: AxisLoop) -> int:
    """The input that moves the plant: the first one that a law or the record sets."""
    if not loop.wired:
        raise InputError(
            f"{loop.scenario.document.file}: nothing moves {loop.component}: neither a wire nor a"
            " column of the record sets an input of it"
        )
    return loop.wired[0]


def _way(loop: AxisLoop, rates: PlantRates, of: tuple[int, int], speed: float) -> Way:
    """Directions in which the plant moves: looked for at rest, then in motion."""
    drive, position = of
    x = loop.ode.initial(loop.p)
    way = rigid_motion.way(rates, drive, position, (x, loop.u, loop.p))
    moving = rigid_motion.moving(rates, way, _PART * speed, (x, loop.u, loop.p))
    return rigid_motion.way(rates, drive, position, (moving, loop.u, loop.p))


# CCN 19: candidates are tried in turn until one moves freely.
def _ratios(loop: AxisLoop, drive: int) -> dict[str, float]:
    """Signals per metre, or per radian, of the axis in a slow motion."""
    real = [d.name for d in loop.ode.outputs if d.type == "Real"]
    reader = PlantRates(loop.ode, real, ())
    metres = [k for k, d in enumerate(loop.ode.outputs) if d.type == "Real" and d.unit == "m"]
    angles = [k for k, d in enumerate(loop.ode.outputs) if d.type == "Real" and d.unit == "rad"]
    place = {d.name: k for k, d in enumerate(loop.ode.outputs)}
    x = loop.ode.initial(loop.p)
    for candidate in (*metres, *angles):
        output = real.index(loop.ode.outputs[candidate].name)
        try:
            way = rigid_motion.way(reader, drive, output, (x, loop.u, loop.p))
        except InputError:
            continue
        found = {
            f"{loop.component}.{n}": float(way.ratios[k])
            for k, n in enumerate(real)
            if abs(way.ratios[k]) > 0.0 and place[n] >= 0
        }
        if loop.fed and f"{loop.component}.{loop.fed[0]}" in found:
            per = found[f"{loop.component}.{loop.fed[0]}"]
            inputs = zip(loop.driven, ratio_of_inputs(loop).tolist(), strict=True)
            found |= {n: r * per for n, r in inputs if r != 0.0}
        return found
    raise InputError(f"{loop.component}: no output of it is a position that moves freely")


def _position(
    loop: AxisLoop, data: RecordedLoop, outputs: Sequence[str], ratios: Mapping[str, float]
) -> tuple[int, Array]:
    """The output that is the axis' position, and what the record has of it or of its command."""
    own = [f"{loop.component}.{n}" for n in outputs]
    positions = [k for k, n in enumerate(own) if abs(ratios.get(n, 0.0)) > 0.0 and _moves(loop, n)]
    for k in positions:
        if own[k] in data.compared:
            return k, data.measured[:, data.compared.index(own[k])]
    for name in loop.driven:
        if name in ratios and positions:
            column = data.driven[:: data.every, loop.driven.index(name)]
            return positions[0], column * ratios[own[positions[0]]] / ratios[name]
    raise InputError(
        f"{data.record.name}: neither a position of {loop.component} nor a command of it is there"
    )


def _moves(loop: AxisLoop, name: str) -> bool:
    unit = {d.name: d.unit for d in loop.ode.outputs}[name.partition(".")[2]]
    return unit in ("m", "rad", "1", "")


def _force(loop: AxisLoop, data: RecordedLoop, drive: int, of: tuple[Array, Array]) -> Array:
    """What drives the plant at all samples: as recorded, else what the laws ask."""
    memory, seen = of
    laws = loop.laws
    for k, name in enumerate(loop.shown):
        if name in data.compared and np.array_equal(laws.show[:, k], laws.take[:, drive]):
            return data.measured[:, data.compared.index(name)]
    points = np.arange(0, len(seen), data.every)
    j = points % laws.cycle
    asked = np.einsum("kj,kj->k", laws.take[j, drive], memory[points])
    return np.asarray(asked + np.einsum("kj,kj->k", laws.through[j, drive], seen[points]))
