"""The command that makes one FMU of a scenario."""

from pathlib import Path
from typing import Annotated

import typer

from motionfmu.cli.common import ScenarioPath, Set, app, settings


@app.command()
def export(
    path: ScenarioPath,
    target: Annotated[
        Path | None, typer.Option("--out", "-o", help="The file; NAME.fmu if not given.")
    ] = None,
    fmi: Annotated[int, typer.Option(help="FMI version: 2 or 3.")] = 3,
    set_: Set = [],  # noqa: B006  (typer makes a new list)
) -> None:
    """Make a scenario's system one FMU, for any importer.

    Parameters and open inputs of all components are its variables, by the names of the scenario and
    with its values; its outputs are what the scenario records. Files that it reads are inside.
    """
    from motionfmu.run import load
    from motionfmu.run.exported import export as write

    scenario = load(path)
    file = target or Path(f"{scenario.name}.fmu")
    made = write(scenario, file, fmi, settings(set_))
    step = scenario.document.body.step
    print(f"{file}: FMI {fmi}, {made} variables; steps are whole multiples of {step:g} s")
