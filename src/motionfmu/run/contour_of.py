"""From a run to its contour analysis: which signal is what, in mm."""

from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from motionfmu.analysis.contour import ContourInput, ContourResult, Path, Trace, analyse
from motionfmu.analysis.contour.pulse_path import PulsePaths
from motionfmu.analysis.contour.scaled_values import ScaledValues
from motionfmu.base import units
from motionfmu.base.errors import InputError, NoNumber
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios.contour_signals import CARD, library_of

CLOCK = 25e-9  # [s] period of the card's clock


def _millimetres(run: RunRecord, name: str) -> ScaledValues:
    unit = units.parse(run.resolver.end(name, "contour", "position").port.unit or "1")
    return ScaledValues(run[name], units.parse("mm").factor / unit.factor)


def contour_of(
    run: RunRecord,
    only_drawn: Collection[str],
    progress: Callable[[float], None] = lambda share: None,
    known: PulsePaths | None = None,
) -> ContourResult:
    """Analyse the contour of a run; signals that only figures ask for are no traces.

    `known` holds what this run has in common with others. Without a [contour] table there is an
    InputError, without a contour of the run NoNumber.
    """
    document = run.resolver.document
    contour = document.body.contour
    if contour is None:
        raise InputError(f"{document.file}: the scenario has no [contour] table")
    known = PulsePaths() if known is None else known
    library, card = library_of(run.resolver), contour.pulses.partition(".")[0]

    def axes(name: str) -> Any:
        return np.asarray(run.parameter(f"{library}.{name}"))

    pulses_per_mm = axes("ppr") * axes("gear_ratio") / axes("lead")
    length = int(run[f"{library}.card_dda_length"][-1])
    divider = int(run[f"{library}.card_dda_divider"][-1])
    optional = {name: run.signals.get(f"{card}.{name}") for name in CARD}
    used = tuple(int(i) for i in np.flatnonzero(axes("active")))
    traces = _traces(run, {contour.position, contour.pulses, *only_drawn})
    try:
        return analyse(
            ContourInput(
                path=_path(run, known),
                time=run.time,
                actual=_millimetres(run, contour.position),
                commanded=ScaledValues(run[contour.pulses], pulses_per_mm),
                command=run[f"{library}.command"],
                newest=run[f"{library}.command_newest"],
                stock=optional["stock"],
                interrupts=optional["irq_seq"],
                feed=run[f"{library}.path_feed"],
                axes=used,
                dda_time=2**length * divider * CLOCK,
                traces=traces,
            ),
            progress,
            known,
        )
    except (ValueError, ArithmeticError) as error:
        raise NoNumber(f"no contour: {error}") from None


def _path(run: RunRecord, known: PulsePaths) -> Path:
    if run.planned is None:
        raise ValueError("the library wrote no path")
    return run.planned.path(known)


def _traces(run: RunRecord, hidden: Collection[str]) -> tuple[Trace, ...]:
    """Recorded real signals of drives and card, which the report draws beside the contour error."""
    found = []
    for name, values in run.signals.items():
        port = run.resolver.end(name, "record", "signals").port
        if name in hidden or port.type != "Float64" or not port.shape or port.unit is None:
            continue
        found.append(Trace(name, port.unit, values))
    return tuple(found)
