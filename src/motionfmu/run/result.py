"""What a run gave: signals, contour, verdicts."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.columns import ROWS, Columns, forget
from motionfmu.base.errors import InputError, NoNumber
from motionfmu.base.shown_by import drawn, report
from motionfmu.run import figures, record_matches, signals, waveforms
from motionfmu.run.checks import TABLES, Verdict, is_figure, judge, tally
from motionfmu.run.figures import Chart
from motionfmu.run.record_matches import RecordMatches
from motionfmu.run.run_plan import RunPlan
from motionfmu.scenarios import values
from motionfmu.scenarios.body import CHECK, Bounds
from motionfmu.scenarios.system import Resolver

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

    from motionfmu.analysis.contour import ContourResult
    from motionfmu.analysis.contour.pulse_path import PulsePaths
    from motionfmu.analysis.iso9283 import Evaluation
    from motionfmu.records import Record
    from motionfmu.run.planned_text import PlannedText


def since(time: NDArray[np.float64], x: NDArray[Any]) -> float | None:
    """Time from which a signal is not 0 until the end [s]; None if there is no such time."""
    for end in range(len(x), 0, -ROWS):
        first = max(0, end - ROWS)
        zero = np.flatnonzero(x[first:end] == 0)
        forget(x)
        if len(zero):
            after = first + int(zero[-1]) + 1
            return float(time[after]) if after < len(x) else None
    return None


@dataclass(eq=False, repr=False)
class Result(Mapping[str, NDArray[Any]]):
    """What a run gave: its signals by name, verdicts, analyses.

    ``result["card.stock"]`` is a signal, ``result["card.stock[1]"]`` its first axis. Arrays are
    those that the analyses read, so they cannot be written to: ``.copy()`` gives one that can.

    Attributes
    ----------
    scenario : Scenario
    time : ndarray
        Times of the samples [s], shape (N,).
    signals : Mapping
        By name: (N, 6) for an array of axes, (N,) for a scalar. They are read from the disk when
        they are asked for; what is not saved goes with the result.
    parameters : dict
        Value of every parameter that was set, by name.
    planned : PlannedText or None
        What the library wrote of the planned path, if the scenario has a contour.
    warnings : tuple of str
        What the FMUs warned of, FMUs that do not agree on a machine, grids that do not divide each
        other; each once.
    options : mapping
        How it was run, as given: engine, fmi, set, stop, step, every.
    overrides : list of str
        In what it was not run as written, in words; empty if it was.
    stopped : str
        Why it ended: ``stop = 4 s``, ``mcc.done at 16.213 s``.
    signal_at : float or None
        When the signal that ends the run came [s]; None if it did not, or a time ends it.
    known : PulsePaths or None
        What its contour has in common with those of other runs of a session.

    Examples
    --------
    >>> result = motionfmu.load("scenarios/circle").run()  # doctest: +SKIP
    >>> result  # doctest: +SKIP
    <Result circle: all 14 checks hold, 80000 rows of 21 signals, 8 s>
    >>> result.to_pandas(["mcc.path_feed", "machine.*"]).describe()  # doctest: +SKIP
    >>> result.plot("mcc.path_feed", ("drives.torque[1]", "drives.torque[2]"))  # doctest: +SKIP
    """

    scenario: RunPlan
    time: NDArray[np.float64]
    signals: Mapping[str, NDArray[Any]]
    parameters: dict[str, Any]
    planned: "PlannedText | None" = None
    warnings: tuple[str, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    overrides: list[str] = field(default_factory=list)
    stopped: str = ""
    signal_at: float | None = None
    known: "PulsePaths | None" = None
    _contour: "ContourResult | NoNumber | None" = None
    _iso9283: "Evaluation | NoNumber | None" = None
    _matches: "RecordMatches | NoNumber | None" = None

    def __post_init__(self) -> None:
        signals.locked(self.time)
        if not isinstance(self.signals, Columns):
            for data in self.signals.values():
                signals.locked(data)

    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A signal, or with ``name[i]`` one axis of it, i from 1."""
        return signals.signal(self.signals, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self.signals)

    def __len__(self) -> int:
        return len(self.signals)

    def __bool__(self) -> bool:
        return True

    def __repr__(self) -> str:
        return f"<Result {self.name}: {self.judgement}, {self.size}>"

    def _repr_html_(self) -> str:
        return str(drawn("notebook").html(self))

    @property
    def size(self) -> str:
        """How much was recorded, in words."""
        n, rows = len(self.signals), len(self.time)
        return f"{rows} rows of {n} signal{'s' * (n != 1)}, {self.seconds:.6g} s"

    @property
    def seconds(self) -> float:
        """From the first sample to the end of the last [s]."""
        return float(2.0 * self.time[-1] - self.time[-2]) if len(self.time) > 1 else 0.0

    @property
    def units(self) -> dict[str, str]:
        """Unit of every signal by its name; "1" for a plain number."""
        ends = {name: self.resolver.end(name, "record", "signals") for name in self.signals}
        return {name: end.port.unit or "1" for name, end in ends.items()}

    def to_pandas(self, names: str | Iterable[str] | None = None) -> "pandas.DataFrame":
        """The signals as a table, in memory of its own.

        Also called `to_dataframe`.

        Parameters
        ----------
        names : str or iterable of str, optional
            Signals, elements such as ``card.stock[1]``, patterns with ``*`` and ``?``; else all.

        Returns
        -------
        DataFrame
            A row a sample, its index the time [s]; a column an element. ``attrs["units"]`` has the
            unit of each column, ``attrs["scenario"]`` the name.

        Raises
        ------
        InputError
            There is no such signal (an `UnknownSignal`), or pandas is not installed.
        """
        found = signals.table(self.time, self.signals, names)
        units = self.units
        found.attrs["units"] = {c: units[c.partition("[")[0]] for c in found.columns}
        found.attrs["scenario"] = self.name
        return found

    to_dataframe = to_pandas

    def plot(
        self, *names: str | tuple[str, ...], window: tuple[float, float] | None = None
    ) -> "Figure":
        """Draw signals over time, or what the report begins with.

        In a script ``matplotlib.pyplot.show()`` shows it; a notebook shows what is returned.

        Parameters
        ----------
        *names : str or tuple of str
            Signals or elements; each gets a panel, those of a tuple share one. None: the path with
            its contour error, else the scenario's first figure, else the first signal.
        window : tuple of float, optional
            From and to [s]; else the whole run.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        InputError
            There is no such signal (an `UnknownSignal`), or the window is not within the run.
        """
        figure: Figure = drawn("notebook").plot(self, names, window)
        return figure

    def save(
        self,
        folder: str | Path,
        csv: bool = False,
        signals: bool = True,
        pictures: bool = False,
        trajectory: bool = False,
    ) -> Path:
        """Write the folder that ``motionfmu run`` writes, with its report.

        Parameters
        ----------
        folder : str or Path
            New, empty, or with an older result, which is replaced.
        csv : bool
            Also ``signals.csv``.
        signals : bool
            Also ``signals/``, a NumPy file for each; without it two results cannot be compared.
        pictures : bool
            Also the page's pictures as files, PNG and SVG.
        trajectory : bool
            Also ``trajectory.csv``, the commanded joints of a robot.

        Returns
        -------
        Path
            The report.

        Raises
        ------
        InputError
            The folder holds something else, or cannot be written; no joints are recorded.
        """
        outcome = report("result_folder")
        shown: Path = outcome.save(
            self, Path(folder), outcome.Kept(csv, signals, pictures, trajectory)
        )
        return shown

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
        return values.value_of(self.resolver, self.parameters, name)

    @property
    def geometry(self) -> str | None:
        """The planned path as the library wrote it.

        Returns
        -------
        str or None
            CSV; None if the scenario has no contour.
        """
        return None if self.planned is None else self.planned.text()

    def contour(self, progress: Callable[[float], None] = lambda share: None) -> "ContourResult":
        """The contour error of this run against the planned geometry.

        Parameters
        ----------
        progress : callable
            Called with the share done, 0 to 1, while it is found for the first time.

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
                drawn = self.scenario.only_drawn
                self._contour = contour_of(self, drawn, progress, self.known)
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

    def record_matches(self) -> RecordMatches:
        """The record of the scenario laid over this run.

        Returns
        -------
        RecordMatches
            ``found`` by signal; its `Match` has both on their common time, difference and lag.

        Raises
        ------
        InputError
            The scenario has no [record_file] table.
        NoNumber
            Run and record have no time in common.
        """
        if self.resolver.document.body.record_file is None:
            raise InputError(f"{self.name}: the scenario has no [record_file] table")
        if self._matches is None:
            try:
                self._matches = record_matches.matches(self)
            except NoNumber as reason:
                self._matches = reason
        if isinstance(self._matches, NoNumber):
            raise self._matches
        return self._matches

    @property
    def no_record(self) -> str:
        """Why the record cannot be laid over this run; else empty."""
        try:
            if self.resolver.document.body.record_file is not None:
                self.record_matches()
        except NoNumber as reason:
            return str(reason)
        return ""

    def record(self) -> "Record":
        """The signals of this run, as a measured record is.

        Returns
        -------
        Record
            The same arrays, with times in whole ns; ``save`` writes it to a file.
        """
        from motionfmu.records import Record

        ns = np.rint(np.asarray(self.time) * 1e9).astype(np.int64)
        return Record(self.name, ns, self.signals, self.units)

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
            ``iso9283.AT_P``, ``record.position.nrmse``.

        Raises
        ------
        InputError
            No analysis has such a figure, or the scenario does not ask for it.
        NoNumber
            This run does not have it; the reason.
        """
        table, _, own = name.partition(".")
        if table not in TABLES or not own:
            raise InputError(f"no figure {name!r}: contour.error.max and iso9283.AT_P are some")
        if table == record_matches.TABLE:
            if told := record_matches.wrong(own, self.resolver):
                raise InputError(told)
            return self.record_matches().number(own)
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

    @cached_property
    def checks(self) -> list[Verdict]:
        """Verdicts of all bounds in [check], then of those in [expect].

        What is expected of a scenario as written is judged in such a run only, else ``ok`` is None.
        A number that this run does not have is a failed check with its reason.
        """
        found: list[Verdict] = []
        for table, name, checks in self.scenario.document.body.asked:
            judged = table == CHECK or self.as_written
            for verdict in (v for check in checks for v in self._judge(name, check)):
                found.append(replace(verdict, table=table, judged=judged))
        return found

    def _judge(self, name: str, check: Bounds) -> list[Verdict]:
        """Judge a signal or a figure by each bound of a line."""
        if not is_figure(name):
            return judge(name, check, self.time, self[name])
        value, reason = math.nan, ""
        try:
            value = self.figure(name)
        except NoNumber as told:
            reason = str(told)
        verdicts = judge(name, check, np.zeros(1), np.array([value]))
        return [replace(v, reason=reason) for v in verdicts]

    @property
    def as_written(self) -> bool:
        """Whether the scenario ran as its file has it.

        Nothing was set or timed otherwise, and it was not made by `Scenario.changed`.
        """
        return not self.overrides and not self.scenario.document.changed

    @property
    def judgement(self) -> str:
        """The verdict in words."""
        return tally(v.ok for v in self.checks).words

    @property
    def ok(self) -> bool:
        """Whether every check that is judged holds."""
        return not any(v.ok is False for v in self.checks)
