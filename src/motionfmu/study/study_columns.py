"""Columns of a study's table: figures of analyses and statistics of signals, for each run."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.names import unit as unit_of
from motionfmu.analysis.iso9283.evaluation import unit as units_of
from motionfmu.base.errors import NoNumber, suggestion
from motionfmu.run import Scenario
from motionfmu.run.checks import TABLES, is_figure, wrong_figure
from motionfmu.run.result import Result
from motionfmu.scenarios import recording
from motionfmu.scenarios.body import Bounds
from motionfmu.scenarios.contour_signals import wanted as of_contour
from motionfmu.scenarios.iso9283_signals import wanted as of_iso9283
from motionfmu.scenarios.record_signals import wanted as of_record
from motionfmu.scenarios.system import End

Array = NDArray[Any]

# Each is taken over all samples and all elements.
STATISTICS: dict[str, Callable[[Array], float]] = {
    "final": lambda x: float(x[-1]),
    "min": lambda x: float(x.min()),
    "max": lambda x: float(x.max()),
    "absmax": lambda x: float(np.abs(x).max()),
    "rms": lambda x: float(np.sqrt((x**2).mean())),
    "mean": lambda x: float(x.mean()),
    "span": lambda x: float(np.ptp(x)),
}


@dataclass(frozen=True)
class Column:
    """A number of each run, in a column of the table."""

    # ``contour.<figure>``, ``iso9283.<figure>``, or a signal and a name of STATISTICS:
    # ``card.stock.min``, ``card.err_count[1].final``.
    name: str
    end: End | None = None  # the signal; None for a figure of an analysis

    @property
    def unit(self) -> str:
        """Unit of the signal or the figure; else empty."""
        if self.end:
            return self.end.port.unit or ""
        kind, _, figure = self.name.partition(".")
        return units_of(figure.rpartition(".")[2]) if kind == "iso9283" else unit_of(figure)

    def of(self, result: Result) -> float:
        """The number of a run, in the signal's unit or that of the analysis."""
        # Raises `NoNumber` if the run has no such number, or it is not finite.
        if self.end is None:
            value = result.figure(self.name)
        else:
            signal, _, statistic = self.name.rpartition(".")
            value = STATISTICS[statistic](np.asarray(result[signal], dtype=float))
        if not math.isfinite(value):
            raise NoNumber(f"{self.name} is not finite")
        return value


def column(scenario: Scenario, name: str) -> Column:
    """The column with a name; an InputError or ValueError if there can be none."""
    if is_figure(name):
        if told := wrong_figure(name, scenario.resolver):
            raise ValueError(told)
        return Column(name)
    signal, _, statistic = name.rpartition(".")
    component, ports = name.partition(".")[0], scenario.resolver.ports
    if component not in ports and (close := suggestion(component, [*TABLES, *ports])):
        raise ValueError(f"{name}: no component or analysis {component!r}{close}")
    if statistic not in STATISTICS or "." not in signal:
        known = ", ".join(STATISTICS)
        analyses = " or ".join(f"{table}.FIGURE" for table in TABLES)
        text = f"SIGNAL.STATISTIC (one of {known}), {analyses} wanted"
        hint = suggestion(statistic, STATISTICS) if "." in signal else ""
        raise ValueError(f"{name}: {text}{hint}")
    whole, element = scenario.resolver.split(signal)
    end = recording.output(scenario.resolver, whole, "", "")
    if element is not None and not 0 <= element < end.port.count * bool(end.port.shape):
        raise ValueError(f"{name}: {whole} has no element {element + 1}")
    if statistic == "final" and element is None and end.port.shape:
        raise ValueError(f"{name}: the final value of which element, {whole}[1]?")
    return Column(name, end)


def usual(scenario: Scenario) -> list[Column]:
    """The columns of a study that names none: the numbers that the scenario checks."""
    found: dict[str, Column] = {}
    for table, name, checks in scenario.document.body.asked:
        for check in checks:
            for wanted in [name] if is_figure(name) else _checked(scenario, table, name, check):
                found[wanted] = column(scenario, wanted)
    return list(found.values())


def _checked(scenario: Scenario, table: str, name: str, check: Bounds) -> Iterable[str]:
    if check.at is not None or check.windows is not None or check.rate is not None:
        return
    whole, element = scenario.resolver.split(name)
    port = scenario.resolver.end(whole, table, name).port
    for bound in ("min", "max", "absmax", "rms", "final"):
        if getattr(check, bound) is None:
            continue
        several = bound == "final" and element is None and port.shape
        for signal in [f"{name}[{i + 1}]" for i in range(port.count)] if several else [name]:
            yield f"{signal}.{bound}"
    if check.peak is not None:
        yield f"{name}.absmax"


def signals(scenario: Scenario, columns: Iterable[Column]) -> list[End]:
    """The outputs that a run records, each once: for columns, checks and contour."""
    checked = [n for _, n, _ in scenario.document.body.asked if not is_figure(n)]
    sources = (of_contour, of_iso9283, of_record)
    analysed = [name for wanted in sources for name in wanted(scenario.resolver)]
    names = [*analysed, *(scenario.resolver.split(n)[0] for n in checked)]
    ends = [recording.output(scenario.resolver, n, "check", n) for n in names]
    ends += [c.end for c in columns if c.end]
    return list({e.name: e for e in ends}.values())
