"""Load a scenario and run it."""

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

from motionfmu.errors import InputError
from motionfmu.run.engines import ENGINES
from motionfmu.run.prepared import Options, Prepared
from motionfmu.run.result import Result
from motionfmu.run.wired import Wired, own_settings
from motionfmu.scenarios import grids
from motionfmu.scenarios.system import System


class Scenario(Prepared):
    """A scenario ready to run.

    Parameters
    ----------
    path : str or Path
        A scenario.toml or the folder that holds it.

    Attributes
    ----------
    document : Document
        The file.
    resolver : Resolver
        Its FMUs.
    ends : list of End
        What is recorded.
    only_drawn : set of str
        Names among them that nothing but a figure asks for.

    Raises
    ------
    InputError
        Anything wrong in the file; one message with file, line and value.
    """

    def run(self, **options: Any) -> Result:
        """Run the scenario.

        Parameters
        ----------
        **options : engine, fmi, set, stop, step, undriven, progress
            See `Options`.

        Raises
        ------
        InputError
            An option is wrong, or an FMU refused something; one message.
        """
        asked = Options(**options)
        if asked.engine not in ENGINES:
            raise InputError(f"no engine {asked.engine!r} (there are: {', '.join(ENGINES)})")
        if asked.fmi not in (2, 3):
            raise InputError(f"FMI {asked.fmi!r}: 2 or 3")
        with tempfile.TemporaryDirectory(prefix="motionfmu-") as name:
            folder = Path(name)
            given = replace(asked, set={**asked.set, **own_settings(self, folder)})
            wired = Wired.plan(self, given, self.ends, folder)
            self.check_recording(wired.system, given)

            def engine(system: System) -> tuple[str, ...]:
                told = ENGINES[asked.engine](system, asked.fmi, asked.progress)
                return (*grids.warnings(wired.plain), *told)

            return wired.run(engine, asked)


def load(path: str | Path) -> Scenario:
    """Read a scenario and check it against its FMUs.

    Parameters
    ----------
    path : str or Path
        A scenario.toml or the folder that holds it, anywhere.

    Raises
    ------
    InputError
        Anything wrong in the file; one message with file, line and value.
    """
    return Scenario(path)
