"""Sizes of an excitation at each frequency, so that it keeps limits and the operating point."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.freq.excitation import Excitation, shaped
from motionfmu.analysis.freq.response import room
from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.block import Sampled
from motionfmu.analysis.linear.residual import Residual, with_residuals
from motionfmu.analysis.linear.stability import response
from motionfmu.analysis.linear.tuning_parts import limit, matrices
from motionfmu.analysis.linear.wiring import Port

Array = NDArray[np.float64]
Complex = NDArray[Any]
Loop = tuple[str, tuple[str, ...]]  # input, inputs of other loops that are cut
# Share of a limit's margin that is used; the rest is for the transient and errors of the model.
_ROOM = 0.5
# Share of the stated speed, so that no axis turns back, where friction and gaps act.
_SPEED = 0.3
# A loop is measured where |L| is above this; nonlinear parts may change it by this share at most.
WORTH, _BEYOND, _HALVINGS = 0.1, 0.005, 40


def limits(axis: AxisModel, loop: Loop) -> dict[str, float]:
    """Largest magnitude of the outputs that move and have a limit."""
    at, cut = loop
    found = {}
    for component, block in axis.blocks.items():
        if not isinstance(block, Sampled):
            continue
        for port in (*block.outputs, *block.early):
            name = f"{component}.{port}"
            most = limit(axis, name)
            if most < math.inf:
                system = axis.system(at, name, cut)
                if system.nstates or system.D.any():
                    found[name] = most
    return found


def small(
    axis: AxisModel, loop: Loop, size: tuple[int, NDArray[np.int64]], kick: float | None
) -> Excitation:
    """A multisine that reaches no limit and turns nothing back.

    Each frequency has the size that uses an equal share of what is tightest there, so that slow
    ones stand above the rounding and fast ones do not fill the torque alone. The size is samples of
    a period and its cycles; a kick is the largest magnitude if nothing bounds it sooner.
    """
    at, cut = loop
    n, lines = size
    dt = float(axis.loop(at, cut).dt)
    omega = lines.astype(np.float64) * (2.0 * math.pi / (n * dt))
    slope = (1.0 - np.exp(-1j * omega * dt)) / dt
    caps = []
    for name, most in limits(axis, loop).items():
        left = max(most - abs(_steady(axis, name)), 0.0)
        caps.append((_ROOM * left, response(axis.system(at, name, cut), omega)))
    for component, point in axis.points.items():
        for name, rate in point.rates.items():
            if rate != 0.0:
                moved = response(axis.system(at, f"{component}.{name}", cut), omega)
                caps.append((_SPEED * abs(rate), slope * moved))
    if room(axis, at) < math.inf:
        caps.append((max(room(axis, at), 0.0), slope))
    if kick is not None or not caps:
        caps.append((1.0 if kick is None else kick, np.ones(len(lines), dtype=complex)))
    found = shaped(n, lines, [(cap, of) for cap, of in caps if np.any(of != 0.0)])
    return _nearly_linear(axis, loop, found)


def _nearly_linear(axis: AxisModel, loop: Loop, signal: Excitation) -> Excitation:
    """A signal so small that the nonlinear parts of the plants' equations have no effect.

    The rest w of the equations along the linear motion acts like a further input: what it moves at
    the input of the loop, first order, is compared with what the signal moves there.
    """
    at, cut = loop
    wide, rests = with_residuals(axis)
    source = ".".join(axis.wires[_port(at)])
    names = [name for rest in rests for name in rest.states]
    inputs = [name for rest in rests for name in rest.inputs]
    if not names:
        return signal
    n, dt = len(signal.signal), float(axis.loop(at, cut).dt)
    omega = signal.lines.astype(np.float64) * (2.0 * math.pi / (n * dt))
    spectrum = np.fft.rfft(signal.signal)[signal.lines]
    moved = _responses(wide, ([at], [*names, source]), cut, omega)[:, :, 0] * spectrum[:, None]
    back = _responses(wide, (inputs, [source]), cut, omega)[:, 0, :]
    worth = np.abs(response(axis.loop(at, cut), omega)) > WORTH
    whole = np.zeros((n // 2 + 1, len(names)), dtype=complex)
    whole[signal.lines] = moved[:, :-1]
    motion = np.fft.irfft(whole, n, axis=0)
    begin = np.concatenate([axis.points[rest.component].x for rest in rests])
    factor = 1.0
    for _ in range(_HALVINGS):
        at_rest, along = _rests(rests, begin[None]), _rests(rests, begin + factor * motion)
        beyond = np.fft.rfft(along - at_rest, axis=0)[signal.lines]
        wrong = np.abs(np.sum(back * beyond, axis=1)) / np.abs(factor * moved[:, -1])
        if not worth.any() or wrong[worth].max() <= _BEYOND:
            break
        factor *= 0.5
    return replace(signal, signal=factor * signal.signal)


def _rests(rests: tuple[Residual, ...], states: Array) -> Array:
    found, place = [], 0
    for rest in rests:
        width = len(rest.states)
        part = states[:, place : place + width].T
        found.append(rest.values(part)[0].T)
        place += width
    return np.hstack(found)


def _responses(
    axis: AxisModel,
    ends: tuple[list[str], list[str]],
    cut: tuple[str, ...],
    omega: Array,
) -> Complex:
    """From inputs to outputs, shape (frequencies, outputs, inputs)."""
    found = matrices(axis, *ends, cut)
    z = np.exp(1j * omega * found.period_ns * 1e-9)
    resolvent = z[:, None, None] * np.eye(len(found.a)) - found.a
    driven = np.broadcast_to(found.b, (len(z), *found.b.shape))
    values: Complex = found.d + found.c @ np.linalg.solve(resolvent, driven)
    return values


def _port(name: str) -> Port:
    component, _, variable = name.partition(".")
    return component, variable


def _steady(axis: AxisModel, name: str) -> float:
    """Value of an output at the operating point if a plant reads it; else 0."""
    component, _, variable = name.partition(".")
    for target, source in axis.wires.items():
        if source == (component, variable) and target[0] in axis.points:
            return axis.points[target[0]].values[target[1]]
    return 0.0
