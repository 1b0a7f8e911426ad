"""The command that makes a scenario of somebody's SSP."""

from pathlib import Path
from typing import Annotated

import typer

from motionfmu.cli.common import app
from motionfmu.cli.run import warnings


@app.command("import")
def import_(
    path: Annotated[Path, typer.Argument(help="An SSP 1.0 or 2.0.", metavar="FILE.ssp")],
    target: Annotated[
        Path | None, typer.Option("--out", "-o", help="The folder; FILE if not given.")
    ] = None,
    stop: Annotated[float | None, typer.Option(help="End [s], instead of the file's.")] = None,
    step: Annotated[float | None, typer.Option(help="Communication step [s], likewise.")] = None,
) -> None:
    """Make a scenario of an SSP: a folder with scenario.toml and its FMUs.

    Nested systems become one; values are converted to the units of their variables. What a scenario
    cannot say, such as a transformation on a wire, is refused.
    """
    from motionfmu.ssp.ssp_import import take

    taken = take(path, target or Path(path.stem), stop, step)
    size = f"{taken.components} components, {taken.wires} wires, {taken.values} values"
    print(f"{taken.folder / 'scenario.toml'}: {size}")
    warnings(taken.warnings)
