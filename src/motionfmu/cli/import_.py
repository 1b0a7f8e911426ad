"""The command that makes a scenario of somebody's SSP, and a machine of somebody's arm."""

import zipfile
from pathlib import Path
from typing import Annotated

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file
from motionfmu.cli.common import app
from motionfmu.cli.run import warnings

SSP = ".ssp"
ARMS = (".urdf", ".xml", ".xacro", ".toml")


@app.command("import")
def import_(  # noqa: PLR0913  (each is an option of the command)
    path: Annotated[
        Path,
        typer.Argument(
            help="An SSP 1.0 or 2.0; an arm as URDF, or as a table of Denavit and Hartenberg or of "
            "OPW lengths (.toml).",
            metavar="FILE",
        ),
    ],
    target: Annotated[
        Path | None, typer.Option("--out", "-o", help="The folder; FILE's name if not given.")
    ] = None,
    stop: Annotated[
        float | None, typer.Option(help="Of an SSP: end [s], instead of the file's.")
    ] = None,
    step: Annotated[
        float | None, typer.Option(help="Of an SSP: communication step [s], likewise.")
    ] = None,
    tip: Annotated[
        str | None,
        typer.Option(metavar="LINK", help="Of a URDF: the link at the end of the arm."),
    ] = None,
    hold: Annotated[
        str | None,
        typer.Option(
            metavar="JOINT[=ANGLE]",
            help="Of an arm: a joint that is held still, at an angle [°] or a place [mm]; of seven "
            "joints that is the third, at 0, if none is given.",
        ),
    ] = None,
) -> None:
    """Make a scenario of an SSP, or a machine of an arm: a folder that runs.

    SSP: scenario.toml and its FMUs. Nested systems become one; values are converted to the units of
    their variables. What a scenario cannot say, such as a transformation on a wire, is refused.
    Arm: machine.toml with controller, card, drives and arm, and a job to try. What the file lacks
    (accelerations, gears, motors, friction) is taken in proportion to another arm, and listed.
    """
    if path.suffix.lower() in ARMS:
        if stop is not None or step is not None:
            raise InputError("--stop and --step are for an SSP")
        _arm(path, target or Path(path.stem), tip, hold)
        return
    if tip is not None:
        raise InputError("--tip is for a URDF")
    if hold is not None:
        raise InputError("--hold is for an arm")
    if path.suffix.lower() != SSP and is_file(path) and not zipfile.is_zipfile(path):
        raise InputError(f"{path}: an SSP ({SSP}) or an arm ({', '.join(ARMS)}) wanted")
    from motionfmu.ssp.ssp_import import take

    taken = take(path, target or Path(path.stem), stop, step)
    size = f"{taken.components} components, {taken.wires} wires, {taken.values} values"
    print(f"{taken.folder / 'scenario.toml'}: {size}")
    warnings(taken.warnings)


def _arm(path: Path, folder: Path, tip: str | None, hold: str | None) -> None:
    """Make a machine of an arm, and print what was taken for granted."""
    from motionfmu.arm_machines import joint_count, make_machine, taken_lines
    from motionfmu.arms import held, table_arm, urdf_arm

    if path.suffix.lower() == ".toml":
        if tip is not None:
            raise InputError("--tip is for a URDF")
        arm = table_arm(path)
    else:
        arm = urdf_arm(path, tip)
    arm = held(arm, hold)
    made = make_machine(arm, folder, path.name)
    size = f"reach {made.geometry.reach:.3g} m, {made.values.arm.mass:.4g} kg"
    print(f"{folder / 'machine.toml'}: {arm.name} to {arm.tip}, {joint_count(arm)}, {size}")
    print(f"not in {path.name}, and taken; what is known better goes into machine.toml:")
    for line in taken_lines(made.values.taken):
        print(f"  {line}")
    warnings(list(made.notes))
    if made.example is not None:
        print(f"next: motionfmu run {made.example} --machine {folder}")
