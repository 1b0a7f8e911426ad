"""A measured response beside the linear model of its scenario, and the plant found in it.

What was recorded is not the plant alone: a torque is held between samples, a speed is a difference
of counts, a drive has a lag. The scenario's linear model has all of that. So the measured response
is divided by how that model differs from its own two masses, and these are fitted to the rest. The
values found make the model anew, until nothing moves.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis import linear
from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.block import Plant, Sampled
from motionfmu.analysis.linear.loops import feedbacks
from motionfmu.analysis.measured_response.mass_names import PlantMasses
from motionfmu.analysis.measured_response.response_estimate import MeasuredResponse
from motionfmu.analysis.measured_response.two_masses import MassFit, MassModel, fit_masses
from motionfmu.base.errors import InputError
from motionfmu.run import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
# [rad/s] of the motor about which a model is linear where nothing says its speed.
_SPEED = 10.0
SUM_ALONE = "one mass: only the sum of the inertias is told"
_ROUNDS = 3  # of fits, each with the model of the one before
_RESTING = 2.0  # a motion whose RMS speed is more than its mean over this turns back
# [rad/s] at which a motion is slow, to tell a position from a speed.
_SLOW = 0.5


@dataclass(frozen=True)
class FoundLoop:
    """An open loop of the scenario with both plants, and with the measured one."""

    at: str
    before: Any  # StandstillSystem
    after: Any
    omega: Array  # [rad/s]
    measured: Complex


@dataclass(frozen=True)
class PlantParameter:
    """A parameter of the plant, before and found."""

    name: str  # as [set] has it
    title: str
    unit: str
    before: float
    value: float
    deviation: float
    why: str = ""  # it is not told

    @property
    def told(self) -> bool:
        """Whether the response tells it."""
        return not self.why


@dataclass(frozen=True)
class FoundResponse:
    """Two masses of a plant, found from a measured response.

    Attributes
    ----------
    axis : AxisModel
        As the scenario has it, about the record's speed.
    after : AxisModel
        With the values found.
    masses : PlantMasses
    measured : MeasuredResponse
        In the units of the signals.
    signals : tuple of str
        Input and output.
    speed : float
        Mean speed of the motor [rad/s].
    fit : MassFit
        On the side of the motor.
    before, found : ndarray of complex, shape (n,)
        The linear model's response at the measured frequencies, with the old values and the new.
    parameters : tuple of PlantParameter
    settings : dict
        What was found, by name, for ``--set``.
    loops : tuple of FoundLoop
    given : dict
        Values that were set.
    notes : tuple of str
    """

    axis: AxisModel
    after: AxisModel
    masses: PlantMasses
    measured: MeasuredResponse
    signals: tuple[str, str]
    speed: float
    fit: MassFit
    before: Complex
    found: Complex
    parameters: tuple[PlantParameter, ...]
    settings: Mapping[str, float]
    loops: tuple[FoundLoop, ...]
    given: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def scenario(self) -> Scenario:
        """The scenario."""
        return self.axis.scenario

    @property
    def old(self) -> MassModel:
        """The masses as the scenario has them."""
        return self.masses.of(self.axis)


def axis_of(
    scenario: Scenario, axis: int, given: Mapping[str, Any], speed: float = _SPEED
) -> tuple[AxisModel, PlantMasses]:
    """The axis' linear model about a speed of its motor [rad/s], and its masses."""
    model = linear.model(scenario, axis, {}, dict(given))
    masses = PlantMasses(model)
    return model.moved({masses.signal(masses.names.motor.speed): speed}), masses


def source_of(axis: AxisModel, masses: PlantMasses, name: str) -> str:
    """The signal that moves the plant, if `name` is that or the plant's input; else an error."""
    drive = masses.signal(masses.names.drive)
    wire = axis.wires.get((masses.component, masses.names.drive))
    source = ".".join(wire) if wire else drive
    if name not in (drive, source):
        both = drive if source == drive else f"{source} or {drive}"
        raise InputError(f"{name} does not move the plant: {both} does")
    return source


def model_response(
    axis: AxisModel, masses: PlantMasses, pair: tuple[str, str], omega: Array
) -> Any:
    """Output per input of the linear model at frequencies; NaN beyond its sampling."""
    source, output = pair
    drive = masses.signal(masses.names.drive)
    if source == drive:
        system = axis.system(drive, output, cut=drive)
        return _at(system, omega)[0]
    component = source.partition(".")[0]
    block = axis.blocks[component]
    inputs = block.inputs if isinstance(block, Sampled) else ()
    # a signal added to a feedback would be in what the drive shows of the motion: commands first
    fed = {n for n in inputs if axis.wires.get((component, n), ("",))[0] == masses.component}
    entries = sorted(inputs, key=lambda n: n in fed)
    best: Any = None
    for name in entries:
        system = axis.system(f"{component}.{name}", [source, output])
        both = _at(system, omega)
        if np.nanmax(np.abs(both[0])) > 0.0 and np.nanmax(np.abs(both[1])) > 0.0:
            best = both[1] / both[0]
            break
    if best is None:
        raise InputError(
            f"{axis.scenario.document.file}: nothing that {component} reads moves {output}"
        )
    return best


def _at(system: Any, omega: Array) -> Complex:
    found = np.asarray(system(np.exp(1j * omega * system.dt), squeeze=False))[:, 0, :]
    found = np.where(omega * system.dt < math.pi, found, math.nan)
    return np.asarray(found)


def _slow(axis: AxisModel, masses: PlantMasses, pair: tuple[str, str]) -> tuple[complex, bool]:
    """Output per motion of the motor when slow, and whether the output is its rate."""
    omega = np.array([_SLOW, 2.0 * _SLOW])
    position = masses.signal(masses.names.motor.position)
    a = model_response(axis, masses, pair, omega)
    b = model_response(axis, masses, (pair[0], position), omega)
    both = a / b
    growth = abs(both[1] / both[0])
    if abs(growth - 1.0) < 0.05:
        return complex(both[0]), False
    if abs(growth - 2.0) < 0.1:
        return complex(both[0] / (1j * omega[0])), True
    raise InputError(f"{pair[1]} is neither a position nor a speed of the axis")


def speed_of(
    axis: AxisModel, masses: PlantMasses, pair: tuple[str, str], measured: MeasuredResponse
) -> tuple[float, float]:
    """Mean speed of the motor [rad/s] in a record, and the RMS of what is added to it."""
    per, rate = _slow(axis, masses, pair)
    mean, swing = (
        (measured.level, measured.swing) if rate else (measured.drift, measured.swing_rate)
    )
    return mean / per.real, swing / abs(per)


# CCN 16: from the speed over fits to parameters and loops, each part made of the last.
def found_response(
    scenario: Scenario,
    measured: MeasuredResponse,
    signals: tuple[str, str],
    axis: int = 1,
    set: Mapping[str, Any] | None = None,
) -> FoundResponse:
    """Find two masses of a plant in its measured response.

    Parameters
    ----------
    scenario : Scenario
    measured : MeasuredResponse
        In the units of the signals.
    signals : tuple of str
        Input and output, ``component.variable``: what moves the plant, and a position or a speed.
    axis : int
        From 1.
    set : mapping, optional
        Values by ``component.variable``.

    Returns
    -------
    FoundResponse

    Raises
    ------
    InputError
        A signal is none of the axis, or no plant says what its two masses are.
    """
    given = dict(set or {})
    first, masses = axis_of(scenario, axis, given)
    first.port(signals[1], first.outputs, "output")
    pair = source_of(first, masses, signals[0]), signals[1]
    speed, swing = speed_of(first, masses, pair, measured)
    notes = list(measured.notes)
    turns = math.isfinite(swing) and _RESTING * swing > abs(speed)
    if turns:
        notes.append(
            f"the motor turns back (mean speed {speed:.3g} rad/s, RMS {swing:.3g} rad/s about it):"
            " friction at rest is in the response; excite about a steady speed"
        )
    resting = not math.isfinite(speed) or turns
    about = math.copysign(max(_SPEED, abs(speed)), speed) if resting else speed
    before = first.moved({masses.signal(masses.names.motor.speed): about})
    plain = model_response(before, masses, pair, measured.omega)
    seen = np.isfinite(plain)
    if not seen.all():
        notes.append(
            f"frequencies above {measured.omega[seen].max() / (2.0 * math.pi):.4g} Hz lie beyond"
            " the sampling of the scenario and are left out"
        )
        measured, plain = measured.kept(seen), plain[seen]
    load = _of_load(before, masses, pair)
    after, now = before, plain
    for _ in range(_ROUNDS):
        own = masses.of(after)
        rest = measured.scaled(own.response(measured.omega, load) / now)
        fit = fit_masses(rest, own.motor_viscous, load)
        values = {masses.element(n): v for n, (v, _) in masses.settings(fit).items()}
        after = before.changed(values)
        now = model_response(after, masses, pair, measured.omega)
    parameters = _parameters(before, masses, fit)
    if not fit.two:
        notes.append(
            "the response shows one mass: no antiresonance with a resonance above it in the band"
        )
    late, spread = fit.model.delay, fit.deviations["delay"]
    if abs(late) > 3.0 * spread and abs(late) * measured.omega.max() > 0.1:
        word = "later" if late > 0.0 else "earlier"
        notes.append(
            f"the record is {1e6 * abs(late):.3g} ± {1e6 * spread:.2g} µs {word} than the"
            " scenario's model has it; no value of the scenario stands for that"
        )
    return FoundResponse(
        before,
        after,
        masses,
        measured,
        (pair[0], pair[1]),
        speed,
        fit,
        plain,
        now,
        parameters,
        {p.name: p.value for p in parameters if p.told},
        _loops(before, after, masses, (measured, plain)) if not load else (),
        given,
        tuple(notes),
    )


def _of_load(axis: AxisModel, masses: PlantMasses, pair: tuple[str, str]) -> bool:
    """Whether an output is a motion of the load: of the plant, and not that of the motor."""
    if pair[1].partition(".")[0] != masses.component:
        return False
    block = axis.blocks[masses.component]
    assert isinstance(block, Plant)
    show = block.show[0]
    places = {n: k for k, n in enumerate(block.outputs)}
    row = show[places[pair[1].partition(".")[2]]]
    motor = {
        k
        for n in (masses.names.motor.position, masses.names.motor.speed)
        for k in np.flatnonzero(show[places[n]])
    }
    return not motor.issuperset(np.flatnonzero(row))


def _parameters(axis: AxisModel, masses: PlantMasses, fit: MassFit) -> tuple[PlantParameter, ...]:
    """The plant's parameters that are two masses, before and found."""
    n = masses.names
    names = {
        "motor": n.motor.inertia,
        "load": n.load.inertia,
        "stiffness": n.spring.stiffness,
        "damping": n.spring.damping,
        "load_viscous": n.load.viscous,
    }
    told = masses.settings(fit)
    ports = axis.scenario.resolver.ports[masses.component]
    found = []
    for key, name in names.items():
        before = float(axis.value(masses.signal(name)))
        value, deviation = told.get(name, (before, math.inf))
        why = "" if name in told else fit.why.get(key) or SUM_ALONE
        port = ports[name]
        title = port.doc
        found.append(
            PlantParameter(
                masses.element(name),
                title,
                port.unit or "1",
                before,
                value,
                deviation,
                why,
            )
        )
    return tuple(found)


def _loops(
    before: AxisModel,
    after: AxisModel,
    masses: PlantMasses,
    of: tuple[MeasuredResponse, Complex],
) -> tuple[FoundLoop, ...]:
    """Open loops whose feedback is the motor's motion, with the plant as it was measured.

    With q the measured plant over that of the model and M the loop inside, which is closed, the
    loop becomes L q (1 + M)/(1 + q M).
    """
    measured, plain = of
    q = measured.values / plain
    cuts = feedbacks(before)
    found = []
    for name, cut in cuts.items():
        port = before.port(name, before.inputs, "input")
        source = before.wires[port]
        signal = ".".join(source)
        if source[0] != masses.component or _of_load(before, masses, ("", signal)):
            continue
        inner = [n for n in cuts if n != name and n not in cut]
        if len(inner) > 1:
            continue
        loop = before.loop(name, cut)
        values = _at(loop, measured.omega)[0]
        inside = np.zeros_like(values)
        if inner:
            inside = _at(before.loop(inner[0], tuple({*cuts[inner[0]], name})), measured.omega)[0]
        whole = values * q * (1.0 + inside) / (1.0 + q * inside)
        keep = np.isfinite(whole)
        found.append(
            FoundLoop(name, loop, after.loop(name, cut), measured.omega[keep], whole[keep])
        )
    return tuple(found)


__all__ = [
    "FoundLoop",
    "FoundResponse",
    "PlantParameter",
    "axis_of",
    "found_response",
    "model_response",
    "source_of",
    "speed_of",
]
