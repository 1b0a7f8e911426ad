"""From a run to its contour analysis: which signal is what, in mm."""

import pathlib
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu import recording, units
from motionfmu.contour import ContourInput, ContourResult, Path, Trace, analyse, read_path
from motionfmu.errors import InputError, NoNumber

if TYPE_CHECKING:
    from motionfmu.result import Result
    from motionfmu.run import Scenario

CLOCK = 25e-9  # [s] of the card
# Outputs the analysis wants beside position and pulses, by their owner.
LIBRARY = ("command", "command_newest", "path_feed", "card_dda_length", "card_dda_divider")
CARD = ("stock", "irq_seq", "dac")


def library_of(scenario: "Scenario") -> str:
    """Name of the component that plans the path.

    Parameters
    ----------
    scenario : Scenario

    Returns
    -------
    str

    Raises
    ------
    InputError
        No component plans a path.
    """
    for name, ports in scenario.resolver.ports.items():
        if "path_file" in ports:
            return name
    raise scenario.document.error("no component plans a path (none has path_file)", "contour")


def wanted(scenario: "Scenario") -> list[str]:
    """Signals the contour analysis needs, for recording.

    Parameters
    ----------
    scenario : Scenario

    Returns
    -------
    list of str
        Empty if the scenario has no [contour] table.
    """
    contour = scenario.document.body.contour
    if contour is None:
        return []
    for key, name in (("position", contour.position), ("pulses", contour.pulses)):
        _check_axes(scenario, key, name)
    library, card = library_of(scenario), contour.pulses.partition(".")[0]
    more = [f"{card}.{name}" for name in CARD if name in scenario.resolver.ports.get(card, {})]
    return [contour.position, contour.pulses, *(f"{library}.{name}" for name in LIBRARY), *more]


def _check_axes(scenario: "Scenario", key: str, name: str) -> None:
    """Refuse what is no row of axes; the position is a length."""
    document = scenario.document
    port = recording.output(scenario.resolver, name, "contour", key).port
    if port.shape != (recording.AXES,):
        raise document.error(
            f"{key} = {name!r}: a value for each of six axes wanted", "contour", key
        )
    unit = units.parse(port.unit or "1")
    if key == "position" and unit.exponents != units.parse("m").exponents:
        raise document.error(f"{name} is no length", "contour", key)


def _millimetres(result: "Result", name: str) -> Any:
    unit = units.parse(result.scenario.resolver.end(name, "contour", "position").port.unit or "1")
    return result[name] * (unit.factor / units.parse("mm").factor)


def contour_of(result: "Result") -> ContourResult:
    """Analyse the contour of a run.

    Parameters
    ----------
    result : Result
        Of a scenario with a [contour] table.

    Returns
    -------
    ContourResult

    Raises
    ------
    InputError
        There is no [contour] table.
    NoNumber
        The run has no contour.
    """
    document = result.scenario.document
    contour = document.body.contour
    if contour is None:
        raise InputError(f"{document.file}: the scenario has no [contour] table")
    library, card = library_of(result.scenario), contour.pulses.partition(".")[0]

    def axes(name: str) -> Any:
        return np.asarray(result.parameter(f"{library}.{name}"))

    pulses_per_mm = axes("ppr") * axes("gear_ratio") / axes("lead")
    length = int(result[f"{library}.card_dda_length"][-1])
    divider = int(result[f"{library}.card_dda_divider"][-1])
    optional = {name: result.signals.get(f"{card}.{name}") for name in CARD}
    used = tuple(int(i) for i in np.flatnonzero(axes("active")))
    traces = _traces(result, (contour.position, contour.pulses))
    try:
        return analyse(
            ContourInput(
                path=_path(result),
                time=result.time,
                actual=_millimetres(result, contour.position),
                commanded=result[contour.pulses] / pulses_per_mm,
                command=result[f"{library}.command"].astype(np.int64),
                newest=result[f"{library}.command_newest"].astype(np.int64),
                stock=optional["stock"],
                interrupts=optional["irq_seq"],
                feed=result[f"{library}.path_feed"],
                axes=used,
                dda_time=2**length * divider * CLOCK,
                traces=traces,
            )
        )
    except (ValueError, ArithmeticError) as error:
        raise NoNumber(f"no contour: {error}") from None


def _path(result: "Result") -> Path:
    if result.geometry is None:
        raise ValueError("the library wrote no path")
    with tempfile.TemporaryDirectory(prefix="motionfmu-") as folder:
        file = pathlib.Path(folder) / "path.csv"
        file.write_text(result.geometry, encoding="utf-8")
        try:
            return read_path(file)
        except ValueError as error:
            raise ValueError(str(error).replace(str(file), "planned path")) from None


def _traces(result: "Result", used: tuple[str, ...]) -> tuple[Trace, ...]:
    """Real signals of the drives and the card that the report also draws."""
    found = []
    for name, values in result.signals.items():
        port = result.scenario.resolver.end(name, "record", "signals").port
        if (
            name in (*used, *result.scenario.only_drawn)
            or port.type != "Float64"
            or not port.shape
            or port.unit is None
        ):
            continue
        found.append(Trace(name, port.unit, values))
    return tuple(found)
