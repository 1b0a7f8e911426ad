"""A machine from its file, and programs that run on it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file, shown
from motionfmu.run.program_translation import MachineProgram, program_for, time_of
from motionfmu.run.result import Result
from motionfmu.run.runner import Scenario, load
from motionfmu.scenarios import package_files
from motionfmu.scenarios.body import PLANNED
from motionfmu.scenarios.document import Document, made
from motionfmu.scenarios.table_sources import machine_file

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
        return self.plan().document.beside_config()

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
        limit: float | Literal["planned"] = PLANNED,
        settle: float = 0.1,
        set: Mapping[str, Any] | None = None,
        **tables: Any,
    ) -> Scenario:
        """Put a program on the machine.

        Parameters
        ----------
        program : str or Path
            File of the program, in the language of the machine's controller. A drawing (.plt, .svg,
            .dxf) becomes G-code for a mill and a job for a network card, which takes a part program
            as a job, too. A joint trajectory (.csv, .yaml) becomes a job for a robot.
        limit : float or "planned"
            The longest run [s]; one that is not done by then has a warning. Planned: twice the
            time that its controller plans, and 600 s at least.
        settle : float
            How long it runs on when the program is done [s].
        set : mapping, optional
            Values by ``component.variable``, stronger than the machine's.
        **tables
            Any other key or table of a scenario.toml; ``drawing={"scale": 2.0}`` is stronger than
            the machine's [drawing].

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
        ready = self.translated(file, tables.get("drawing", {}), set)
        values = {str(self.signals.program): str(ready.file), **self._beside(file.resolve())}
        values = ready.values | values | dict(set or {})
        given: dict[str, Any] = {"stop": self.signals.done, "limit": limit, "settle": settle}
        if self.signals.fault is not None:
            given["fault"] = self.signals.fault
        if ready.seconds is not None:
            given = {"stop": time_of(ready.seconds, START, APPROACH + settle)}
        if self.signals.start is not None:
            given["drive"] = [{"input": self.signals.start, "at": [START], "value": [1]}]
        about = f"{file.name} on {self.name}"
        found = Scenario(self._made(given | tables | {"set": values}, file.stem, about))
        found.notes = ready.told
        return found

    def translated(
        self, file: Path, drawing: Mapping[str, Any], set: Mapping[str, Any] | None = None
    ) -> MachineProgram:
        """Translate a program into what the controller reads.

        Parameters
        ----------
        file : Path
            The program.
        drawing : mapping
            A table [drawing], stronger than the machine's.
        set : mapping, optional
            Values by ``component.variable``, stronger than the machine's.

        Returns
        -------
        MachineProgram
            The file that the controller gets.
        """
        asked = {"stop": 1.0} | ({"drawing": drawing} if drawing else {})
        document = self._made(asked, self.name, "")
        document.refuse(list(document.wrong))
        return program_for(document, file.resolve(), set)

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

    def _beside(self, program: Path) -> dict[str, str]:
        """Parameters that name files beside the program which have its name."""
        pairs = self.signals.beside.items()
        found = {key: program.with_suffix(ending) for key, ending in pairs}
        return {key: str(file) for key, file in found.items() if is_file(file)}

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


def machine_of(path: str | Path) -> Machine | None:
    """The machine that a path or name means, if it means none of a scenario."""
    place = Path(path)
    file = place / "machine.toml" if place.is_dir() else place
    if file.is_file() and file.name == "machine.toml":
        return Machine(file.parent.absolute())
    if str(path) in package_files.machines() and package_files.scenario(place) is None:
        return Machine(str(path))
    return None


def machine_scenario(path: str | Path) -> Scenario:
    """The scenario of a path or name, or a machine without a job as one."""
    found = machine_of(path)
    return load(path) if found is None else found.plan()
