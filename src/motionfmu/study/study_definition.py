"""A study: its scenario, the axes that are varied, the columns of its table."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from motionfmu.base.errors import Faults, InputError
from motionfmu.run import Scenario, load, machine
from motionfmu.scenarios import fmus
from motionfmu.scenarios.table_sources import machine_file
from motionfmu.study import study_axes as ax
from motionfmu.study.study_columns import Column
from motionfmu.study.study_file import StudyFile, read
from motionfmu.study.study_resolver import StudyResolver


@dataclass(frozen=True)
class WorkerJob:
    """All that a worker needs to know of a study, except its points."""

    scenario: str  # path of the scenario.toml, or of a program
    machine: str  # path of the machine.toml of a program, else empty
    digest: str  # hash of its files and FMUs; a worker whose files differ refuses the study
    named: tuple[str, ...]  # texts among the study's values, which may name files
    axes: tuple[str, ...]
    columns: tuple[str, ...]
    set: dict[str, Any]  # values for all runs
    stop: float | None  # end of a run instead of the scenario's [s]
    step: float | None  # communication step instead of the scenario's [s]


@dataclass(frozen=True, repr=False)
class Study:
    """A study whose every name and value was checked.

    Attributes
    ----------
    name, about : str
        Name of the scenario's folder; what the first line of the study's file says.
    axes : tuple of Axis
    columns : tuple of Column
    points : sequence of tuple
        One value per axis; the order of the rows. Each is made when it is asked for.
    job : WorkerJob
        For the workers.
    sampling, seed : str, int
        How the points were made.
    cost : str
        The column that is to be small; empty if none is.
    tuned : dict
        Values of the tuned point by axis; empty if there is none.
    """

    name: str
    about: str
    axes: tuple[ax.Axis, ...]
    columns: tuple[Column, ...]
    points: ax.StudyPoints = field(repr=False)
    job: WorkerJob
    sampling: str
    seed: int
    cost: str
    tuned: dict[str, ax.Value]

    def __repr__(self) -> str:
        axes = ", ".join(axis.name for axis in self.axes)
        return f"<Study {self.name}: {len(self.points)} runs over {axes}; cost {self.cost}>"

    @property
    def shown(self) -> str:
        """The column that is drawn: the cost, else the first column."""
        return self.cost or self.columns[0].name

    @cached_property
    def digest(self) -> str:
        """Hash of all that must be equal for rows to belong to one study."""
        job = json.dumps(self.job.__dict__, default=str, sort_keys=True)
        found = hashlib.sha256(f"[{job}, [".encode())  # JSON of both, block by block
        for first in range(0, len(self.points), ax.BLOCK):
            block = json.dumps(self.points[first : first + ax.BLOCK], default=str)
            found.update((", " * (first > 0) + block[1:-1]).encode())
        found.update(b"]]")
        return found.hexdigest()


def study(path: str | Path, given: Mapping[str, Any] | None = None) -> Study:
    """Read a study and check it against its scenario.

    Parameters
    ----------
    path : str or Path
        A study's file; or a scenario, whose sweep.toml is taken if there is one.
    given : mapping, optional
        Keys of the file that count instead of what is written there.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        Anything wrong: all of it at once, each with file, line and value.
    """
    given = {k: v for k, v in (given or {}).items() if v is not None}
    faults = Faults()
    file = read(Path(path), given, faults)
    body = file.body
    scenario = faults.of(lambda: _scenario(file))
    if scenario is None:
        file.origin.refuse(faults)
        raise InputError(f"{path}: no scenario")
    asked = StudyResolver(file, scenario, faults)
    chosen, columns = asked.axes(), asked.columns()
    asked.options()
    runs, cost, tuned = asked.runs(chosen), asked.cost(columns), asked.tuned(chosen)
    file.origin.refuse(faults)
    return Study(
        name=scenario.name,
        about=file.about or scenario.document.about,
        axes=chosen,
        columns=columns,
        points=ax.points(chosen, body.sampling, runs, body.seed),
        job=WorkerJob(
            scenario=str(file.folder.resolve() / (body.program or scenario.document.file)),
            machine=str(machine_file(body.machine, file.folder)) if body.machine else "",
            digest=digest(scenario, _texts(chosen, body.set)),
            named=_texts(chosen, body.set),
            axes=tuple(a.name for a in chosen),
            columns=tuple(c.name for c in columns),
            set=dict(body.set),
            stop=body.stop,
            step=body.step,
        ),
        sampling=body.sampling,
        seed=body.seed,
        cost=cost,
        tuned=tuned,
    )


def _scenario(file: StudyFile) -> Scenario:
    origin, body = file.origin, file.body
    place = Path(body.scenario)
    if body.machine or body.program:
        for key in ("machine", "program"):
            if getattr(body, key) is None:
                raise origin.error(f"{key} is missing: a machine and a program wanted")
        return _on_machine(file, str(body.machine), str(body.program))
    try:
        return load(place if "scenario" in origin.given else file.folder / place)
    except InputError as error:
        if ": no such scenario" in str(error):
            raise origin.error(str(error), "", "scenario") from None
        raise


def _on_machine(file: StudyFile, name: str, program: str) -> Scenario:
    try:
        return machine(machine_file(name, file.folder)).scenario(file.folder / program)
    except InputError as error:
        key = "program" if ": no such program" in str(error) else "machine"
        if "no such" in str(error):
            raise file.origin.error(str(error), "", key) from None
        raise


def digest(scenario: Scenario, given: Iterable[Any] = ()) -> str:
    """Fingerprint of a scenario, the files it names and its FMUs."""
    # Given values may name files beside the scenario, too.
    names = sorted({*scenario.document.body.component.values(), "scope"})
    found = hashlib.sha256()
    files = [*scenario.document.files, *(fmus.fmu_path(name) for name in names)]
    for value in (*scenario.document.body.set.values(), *given):
        listed = value if isinstance(value, list) else [value]
        texts = (x for x in listed if isinstance(x, str) and x)
        files += [file for x in texts if (file := scenario.document.beside(x))]
    for file in files:
        found.update(hashlib.sha256(file.read_bytes()).digest())
    return found.hexdigest()


def _texts(chosen: tuple[ax.Axis, ...], given: Mapping[str, Any]) -> tuple[str, ...]:
    lists = [a.source.values for a in chosen if isinstance(a.source, ax.ListedValues)]
    lists += [v if isinstance(v, list) else [v] for v in given.values()]
    return tuple(x for values in lists for x in values if isinstance(x, str))
