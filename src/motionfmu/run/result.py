"""What a run gave: signals, contour, verdicts."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.errors import NoNumber
from motionfmu.run import figures, waveforms
from motionfmu.run.checks import Verdict, is_figure, judge
from motionfmu.run.figures import Chart
from motionfmu.run.prepared import Prepared
from motionfmu.scenarios import values
from motionfmu.scenarios.system import Resolver

if TYPE_CHECKING:
    from motionfmu.contour import ContourResult
    from motionfmu.iso9283 import Evaluation


def since(time: NDArray[np.float64], x: NDArray[Any]) -> float | None:
    """From when on a signal is not 0 to the end [s]; None if it never was 0 or is so at last."""
    zero = np.flatnonzero(x == 0)
    return float(time[zero[-1] + 1]) if len(zero) and zero[-1] + 1 < len(x) else None


@dataclass
class Result:
    """What a run gave.

    Attributes
    ----------
    scenario : Scenario
    time : ndarray
        Times of the samples [s], shape (N,).
    signals : dict
        By name: (N, 6) for an array of axes, (N,) for a scalar.
    parameters : dict
        Value of every parameter that was set, by name.
    geometry : str or None
        The planned path as the library wrote it (CSV), if the scenario has a contour.
    warnings : tuple of str
        What the FMUs warned of, and grids that do not divide each other; each once.
    options : mapping
        How it was run, as given: engine, fmi, set, stop, step, every.
    overrides : list of str
        In what it was not run as written, in words; empty if it was.
    stopped : str
        Why it ended: ``stop = 4 s``, ``mcc.done at 16.213 s``.
    signal_at : float or None
        When the signal that ends the run came [s]; None if it did not, or a time ends it.
    """

    scenario: Prepared
    time: NDArray[np.float64]
    signals: dict[str, NDArray[Any]]
    parameters: dict[str, Any]
    geometry: str | None = None
    warnings: tuple[str, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    overrides: list[str] = field(default_factory=list)
    stopped: str = ""
    signal_at: float | None = None
    _contour: "ContourResult | NoNumber | None" = None
    _iso9283: "Evaluation | NoNumber | None" = None

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A signal, or with ``name[i]`` one axis of it, i from 1."""
        if name in self.signals:
            return self.signals[name]
        whole, bracket, rest = name.partition("[")
        index = rest.removesuffix("]")
        if bracket and whole in self.signals and index.isdecimal():
            data = self.signals[whole]
            if data.ndim == 2 and 1 <= int(index) <= data.shape[1]:
                return data[:, int(index) - 1]
        raise KeyError(f"{name} is not recorded (recorded: {', '.join(sorted(self.signals))})")

    def parameter(self, name: str) -> Any:
        """Value of a parameter in this run, set or from its description.

        Parameters
        ----------
        name : str
            ``component.variable``.

        Returns
        -------
        tuple
            One value per element.
        """
        if name in self.parameters:
            return self.parameters[name]
        return values.start_values(self.resolver.end(name, "set", name).port)

    def contour(self) -> "ContourResult":
        """The contour error of this run against the planned geometry.

        Raises
        ------
        InputError
            The scenario has no [contour] table.
        NoNumber
            This run has no contour; the reason.
        """
        if self._contour is None:
            from motionfmu.run.contour_of import contour_of

            try:
                self._contour = contour_of(self, self.scenario.only_drawn)
            except NoNumber as reason:
                self._contour = reason
        if isinstance(self._contour, NoNumber):
            raise self._contour
        return self._contour

    @property
    def done_at(self) -> float | None:
        """When the scenario's program was done [s].

        None if that is unknown, or it never was.
        """
        if self.signal_at is not None:
            return self.signal_at
        recorded = (x for n, x in self.signals.items() if n.endswith(".done") and x.ndim == 1)
        times = [t for x in recorded if (t := since(self.time, x)) is not None]
        return max(times, default=None)

    @property
    def no_contour(self) -> str:
        """Why this run has no contour; else empty."""
        try:
            if self.scenario.document.body.contour is not None:
                self.contour()
        except NoNumber as reason:
            return str(reason)
        return ""

    def iso9283(self) -> "Evaluation":
        """The figures of this run after ISO 9283.

        Raises
        ------
        InputError
            The scenario has no [iso9283] table.
        NoNumber
            This run has no such figures; the reason.
        """
        if self._iso9283 is None:
            from motionfmu.run.iso9283_of import evaluation_of

            try:
                self._iso9283 = evaluation_of(self)
            except NoNumber as reason:
                self._iso9283 = reason
        if isinstance(self._iso9283, NoNumber):
            raise self._iso9283
        return self._iso9283

    @property
    def no_iso9283(self) -> str:
        """Why this run has no figures after ISO 9283; else empty."""
        try:
            if self.scenario.document.body.iso9283 is not None:
                self.iso9283()
        except NoNumber as reason:
            return str(reason)
        return ""

    def figure(self, name: str) -> float:
        """A figure of an analysis.

        Parameters
        ----------
        name : str
            The table that asks for the analysis and the figure's own name: ``contour.error.max``,
            ``iso9283.AT_P``.

        Raises
        ------
        NoNumber
            This run does not have it; the reason.
        """
        table, _, own = name.partition(".")
        return self.contour().number(own) if table == "contour" else self.iso9283().number(own)

    def figures(self) -> list[Chart]:
        """The figures the scenario asks for, with their curves.

        Returns
        -------
        list of Chart
            Empty if the scenario has no [[figure]] and no [[waveform]].
        """
        return [*figures.charts(self), *waveforms.charts(self)]

    def overview(self) -> list[Chart]:
        """One figure for each recorded signal.

        Returns
        -------
        list of Chart
            Not more than `motionfmu.run.figures.OVERVIEW`.
        """
        return figures.overview(self, self.scenario.ends)

    @property
    def resolver(self) -> Resolver:
        """The scenario's FMUs and file."""
        return self.scenario.resolver

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.scenario.name

    @property
    def about(self) -> str:
        """What the scenario shows: its first line."""
        return self.scenario.document.about

    @property
    def checks(self) -> list[Verdict]:
        """The verdict of every bound in the scenario's [check] table.

        A number that this run does not have is a failed check with its reason.
        """
        found = []
        listed = self.scenario.document.body.check.items()
        for name, check in ((n, c) for n, checks in listed for c in checks):
            if not is_figure(name):
                found += judge(name, check, self.time, self[name])
                continue
            value, reason = math.nan, ""
            try:
                value = self.figure(name)
            except NoNumber as told:
                reason = str(told)
            verdicts = judge(name, check, np.zeros(1), np.array([value]))
            found += [replace(v, reason=reason) for v in verdicts]
        return found

    @property
    def ok(self) -> bool:
        """Whether every check holds."""
        return all(v.ok for v in self.checks)
