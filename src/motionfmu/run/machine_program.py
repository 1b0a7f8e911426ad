"""A machine from its file, and programs that run on it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file, shown
from motionfmu.run.program_translation import program_for, time_of
from motionfmu.run.result import Result
from motionfmu.run.runner import Scenario
from motionfmu.scenarios.document import Document, made
from motionfmu.scenarios.table_sources import machine_file

# [s] Longer than any program that is not told how long it may take.
LIMIT = 600.0
START = 0.05  # [s] when a machine with a start input is started
APPROACH = 0.5  # [s] that a card may take until it plays a job


class Machine:
    """A machine on which programs run without a scenario.

    Parameters
    ----------
    path : str or Path
        A machine.toml or the folder that holds it; or the name of one of `machines`.

    Attributes
    ----------
    file : Path
        The machine.toml.
    name : str
        Of its folder.
    axes : list of MachineAxis
        Name, kind (``linear`` or ``rotary``) and row of each in arrays, from 1.
    signals : MachineSignals
        Names of its table [signals].

    Raises
    ------
    InputError
        There is no such machine, or something in its file is wrong.
    """

    def __init__(self, path: str | Path) -> None:
        self.file = machine_file(path, Path.cwd())
        self.name = self.file.parent.name
        document = self._made({"stop": 1.0}, self.name, "")
        self.signals, self.axes = document.body.signals, document.axes

    @property
    def config(self) -> Path | None:
        """The configuration of its network card; None without one."""
        name = self.signals.config
        return None if name is None else self.plan().document.beside(name)

    @property
    def takes_programs(self) -> bool:
        """Whether its file says where a program goes and how it ends."""
        ends = self.signals.done or self.signals.config
        return self.signals.program is not None and ends is not None

    def __repr__(self) -> str:
        return f"<Machine {self.name}: {self.file}>"

    def scenario(
        self,
        program: str | Path,
        *,
        limit: float = LIMIT,
        settle: float = 0.1,
        set: Mapping[str, Any] | None = None,
        **tables: Any,
    ) -> Scenario:
        """Put a program on the machine.

        Parameters
        ----------
        program : str or Path
            File of the program, in the language of the machine's controller; or a drawing
            (.plt), which a mill gets as G-code, and a network card as a job, as it gets a part
            program.
        limit : float
            The longest run [s]; one that is not done by then has a warning.
        settle : float
            How long it runs on when the program is done [s].
        set : mapping, optional
            Values by ``component.variable``, stronger than the machine's.
        **tables
            Any other key or table of a scenario.toml.

        Returns
        -------
        Scenario
            It ends with the program, and its checks are those that the machine has for every
            program.

        Raises
        ------
        InputError
            The file cannot be read, or the machine takes no program.
        """
        file = Path(program)
        if not is_file(file):
            raise InputError(f"{file}: no such program")
        if not self.takes_programs:
            told = "[signals] program and done are missing: it takes no program"
            raise InputError(f"{self.file}: {told}")
        ready = program_for(self._made({"stop": 1.0}, self.name, ""), file.resolve())
        values = ready.values | {str(self.signals.program): str(ready.file)} | dict(set or {})
        given: dict[str, Any] = {"stop": self.signals.done, "limit": limit, "settle": settle}
        if ready.seconds is not None:
            given = {"stop": time_of(ready.seconds, START, APPROACH + settle)}
        if self.signals.start is not None:
            given["drive"] = [{"input": self.signals.start, "at": [START], "value": [1]}]
        about = f"{file.name} on {self.name}"
        return Scenario(self._made(given | tables | {"set": values}, file.stem, about))

    def plan(self, **tables: Any) -> Scenario:
        """The machine without a program, checked against its FMUs.

        Parameters
        ----------
        **tables
            Keys or tables of a scenario.toml; without stop it runs for 1 s.

        Returns
        -------
        Scenario
            It shows what the machine is made of, and its `axis_limits`.

        Raises
        ------
        InputError
            Something in the machine's file is wrong.
        """
        return Scenario(self._made({"stop": 1.0} | tables, self.name, ""))

    def run(
        self, program: str | Path, *, set: Mapping[str, Any] | None = None, **options: Any
    ) -> Result:
        """Run a program on the machine.

        Parameters
        ----------
        program : str or Path
            As of `scenario`.
        set : mapping, optional
            Values by ``component.variable``, stronger than the machine's.
        **options
            As of `Scenario.run`.
        """
        return self.scenario(program, set=set).run(**options)

    def _made(self, tables: Mapping[str, Any], name: str, about: str) -> Document:
        return made({"machine": str(self.file), **tables}, name, Path.cwd(), about)


def machine(path: str | Path) -> Machine:
    """Read a machine.

    Parameters
    ----------
    path : str or Path
        A machine.toml or the folder that holds it, anywhere; or the name of one that `motionfmu
        machines` lists.

    Raises
    ------
    InputError
        There is no such machine, or something in its file is wrong.
    """
    if not isinstance(path, str | Path):
        raise InputError(f"{shown(path)}: the path or name of a machine wanted")
    return Machine(path)
