"""The FMUs themselves, run with what was found and laid over the record."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.ground import Ground
from motionfmu.identify.identification import Identified
from motionfmu.identify.span_fit import following
from motionfmu.run import Scenario

Array = NDArray[np.float64]
# FMUs begin at rest and where the command is: from here on [s] they are held against the record.
SETTLED = 0.2


@dataclass(frozen=True)
class RecordRun:
    """Signals of the FMUs at the samples of a record.

    Attributes
    ----------
    time : array of shape (n,)
        Of the samples [s].
    measured, run : arrays of shape (n, n_signals)
        In the signals' units.
    signals : tuple of str
        Their names.
    following : tuple of arrays or None
        Following error of the record and of the run [m or rad].
    settled : float
        From here on [s] the two are compared.
    differences : dict
        Norm of the difference over norm of the record from there on, by signal, and of
        ``following error``.
    largest : dict
        Largest difference likewise, in the signals' units.
    """

    time: Array
    measured: Array
    run: Array
    signals: tuple[str, ...]
    following: tuple[Array, Array] | None
    settled: float
    differences: Mapping[str, float]
    largest: Mapping[str, float]


def run_of_record(
    found: Identified,
    set: Mapping[str, Any] | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> RecordRun:
    """Run the FMUs of the scenario along the record.

    Parameters
    ----------
    found : Identified
    set : mapping, optional
        Values by ``component.variable``; those found if not given.
    progress : callable, optional
        Called with the share done.

    Returns
    -------
    RecordRun
    """
    own, data = found.ground, found.ground.data
    scenario = _along(found.scenario, own)
    values = dict(found.given) | (dict(found.settings) if set is None else dict(set))
    values |= {own.set_name(n): v for n, v in _begin(own).items()}
    result = scenario.run(set=values, progress=progress)
    rows = np.arange(data.samples - 1) * data.every
    columns = []
    for k, name in enumerate(data.compared):
        late = own.late if name in own.loop.shown else 0
        values_ = np.asarray(result[name], dtype=np.float64)
        values_ = values_ if values_.ndim == 1 else values_[:, own.loop.axis - 1]
        columns.append((values_[np.minimum(rows + late, len(values_) - 1)], data.measured[:-1, k]))
    run, measured = (np.column_stack(c) for c in zip(*columns, strict=True))
    error = following(own, (measured, run), np.arange(data.samples - 1))
    time = data.time[:-1]
    settled = min(SETTLED, 0.5 * float(time[-1]))
    there = time >= settled
    pairs = {n: (measured[:, k], run[:, k]) for k, n in enumerate(data.compared)}
    if error is not None:
        pairs["following error"] = error
    differences, largest = {}, {}
    for name, (a, b) in pairs.items():
        whole = float(np.linalg.norm(a[there]))
        differences[name] = float(np.linalg.norm((b - a)[there])) / max(whole, 1e-300)
        largest[name] = float(np.abs((b - a)[there]).max())
    return RecordRun(time, measured, run, data.compared, error, settled, differences, largest)


def _along(scenario: Scenario, own: Ground) -> Scenario:
    """The scenario with the record's columns on its inputs, for as long as the record."""
    data, drives = own.data, []
    cut: dict[str, str | None] = {}
    for k, name in enumerate(own.loop.driven):
        component, _, variable = name.partition(".")
        port = scenario.resolver.ports[component][variable.partition("[")[0]]
        values = data.driven[:: data.every, k]
        at = data.interval * np.arange(len(values))
        plain: list[Any] = [round(v) for v in values] if port.type == "Int32" else values.tolist()
        if port.shape:  # other axes get nothing
            here = np.arange(port.count) == own.loop.axis - 1
            plain = [[v if mine else 0 * v for mine in here] for v in plain]
        rises = np.append(True, np.diff(values) != 0.0)
        steps = np.flatnonzero(rises)
        drives.append(
            {
                "input": name,
                "at": [round(float(at[i]), 12) for i in steps],
                "value": [plain[i] for i in steps],
            }
        )
        if name in scenario.document.body.connect:
            cut[name] = None
    stop = data.interval * (data.samples - 1)
    return scenario.changed(
        drive=drives,
        record_file=None,  # what it drives is driven here, at the samples of the fit
        connect=cut,
        leave=list(cut),
        record={"every": 1, "signals": list(data.compared)},
        stop=round(stop / own.loop.step) * own.loop.step,
        check={},
    )


def _begin(own: Ground) -> dict[str, float]:
    """Parameters that place the plant where its command is: all controllers count from there."""
    ode, loop = own.loop.ode, own.loop
    y = ode.y[[d.name for d in ode.outputs].index(own.rates.outputs[own.position])]
    at = ca.substitute(y, ode.x, ode.start)
    slopes = ca.Function("begin", [ode.p, ode.u], [ca.gradient(at, ode.p), at])
    found, here = slopes(loop.p, loop.u)
    per = own.ratios[f"{loop.component}.{own.rates.outputs[own.position]}"]
    command = next((n for n in loop.driven if n in own.ratios), None)
    if command is None:
        wanted = float(own.moving[0][0])
    else:
        k = loop.driven.index(command)
        wanted = float(own.data.driven[0, k]) / own.ratios[command] * per
    for d, slope, value in zip(ode.parameters, np.array(found).ravel(), loop.p, strict=True):
        if d.unit == own.length and np.isclose(slope, per, rtol=1e-6):
            return {f"{loop.component}.{d.name}": float(value + (wanted - float(here)) / slope)}
    return {}
