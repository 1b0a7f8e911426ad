"""The command that makes files for other tools of a scenario or an FMU."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.cli.common import OnMachine, Set, app, loaded, settings
from motionfmu.cli.run import warnings


@app.command()
def export(  # noqa: PLR0913  (each is an option)
    path: Annotated[
        Path,
        typer.Argument(
            help="Folder of a scenario, its scenario.toml, or an FMU's name; of an arm its machine."
        ),
    ],
    machine: OnMachine = None,
    target: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="The file; NAME.fmu, .ssp, .urdf, .xml if not given."),
    ] = None,
    fmi: Annotated[
        int | None, typer.Option(help="FMI version: 2 or 3; 3, of an SSP 2 if not given.")
    ] = None,
    platforms: Annotated[
        str,
        typer.Option(
            help="Of an FMU: here, or all, or names with commas (x86_64-windows): compiled by zig "
            "from the C text of its FMUs, which goes with it."
        ),
    ] = "here",
    program: Annotated[
        Path | None, typer.Option(help="Of an FMU alone: the part program that is packed with it.")
    ] = None,
    set_: Set = [],  # noqa: B006  (typer makes a new list)
    ssp: Annotated[
        bool, typer.Option("--ssp/--fmu", help="SSP of its FMUs, or one FMU of all.")
    ] = False,
    inner: Annotated[
        list[str],
        typer.Option(metavar="PATTERN", help="Signals shown beside the recorded: 'card.err_*'."),
    ] = [],  # noqa: B006
    urdf: Annotated[bool, typer.Option("--urdf", help="The arm of a machine as a URDF.")] = False,
    mjcf: Annotated[
        bool, typer.Option("--mjcf", help="The arm of a machine as a model of MuJoCo.")
    ] = False,
) -> None:
    """Make a scenario's system one FMU, or an SSP; an FMU with its files inside; an arm's URDF.

    FMU: parameters and open inputs of all components are its variables, by the names of the
    scenario and with its values; its outputs are what the scenario records. SSP: components, wires,
    values, time; 1.0 with FMI 2, 2.0 with FMI 3. Files that it reads are inside. An arm: links with
    masses, joints with limits and gears, the tip of its tool; without payload and motors.
    """
    if urdf or mjcf:
        _arm(path, target, urdf, settings(set_))
        return
    if machine is None and _is_fmu(path):
        _pack(path.name, target, fmi or 3, program, settings(set_))
        return
    if program is not None:
        raise InputError(
            "--program is for an FMU alone; of a scenario --set COMPONENT.program=FILE"
        )
    from motionfmu.base.platforms import named

    scenario = loaded(path, machine)
    step = scenario.document.body.step
    if not ssp:
        from motionfmu.export import Choice, as_fmu

        fmi = 3 if fmi is None else fmi
        file = target or Path(f"{scenario.name}.fmu")
        made = as_fmu(scenario, file, fmi, settings(set_), Choice(inner, named(platforms)))
        print(f"{file}: FMI {fmi}, {made} variables; inside it steps by {step:g} s")
        return
    from motionfmu.export import as_ssp

    fmi = 2 if fmi is None else fmi
    file = target or Path(f"{scenario.name}.ssp")
    written = as_ssp(scenario, file, fmi, settings(set_), inner)
    size = f"{written.components} components, {written.connections} connections"
    print(f"{file}: SSP {fmi - 1}.0, FMI {fmi}, {size}; steps of {step:g} s")
    warnings(written.left_out)


def _arm(path: Path, target: Path | None, urdf: bool, given: Mapping[str, Any]) -> None:
    """Write the arm of a machine, and print what it holds."""
    from motionfmu.arm_machines import arm_machine
    from motionfmu.arms import mjcf_text, urdf_text
    from motionfmu.run import machine

    found = machine(path)
    arm = arm_machine(found, given).arm
    file = target or Path(f"{found.name}.{'urdf' if urdf else 'xml'}")
    text = urdf_text(arm) if urdf else mjcf_text(arm)
    try:
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}") from None
    print(f"{file}: {arm.name}, {len(arm.driven)} joints, {arm.mass:.4g} kg, tip {arm.tip}")
    where = "a URDF" if urdf else "MJCF"
    print(f"not in {where}: highest accelerations, payload, motors, stiffness of the gears")


def _is_fmu(path: Path) -> bool:
    """Whether a path of the command line is the name of a built FMU and no existing file."""
    from motionfmu.scenarios.fmus import fmu_names

    return len(path.parts) == 1 and not path.exists() and path.name in fmu_names()


def _pack(
    name: str, target: Path | None, fmi: int, program: Path | None, given: Mapping[str, Any]
) -> None:
    """Write an FMU with its files inside, and print what it holds."""
    from motionfmu.export.single_fmu import packed, program_of

    values = {key.removeprefix(f"{name}."): value for key, value in given.items()}
    if program is not None:
        values[program_of(name)] = str(program)
    file = target or Path(f"{name}.fmu")
    files, refused = packed(name, file, fmi, values)
    inside = ", ".join(files) or "nothing"
    print(f"{file}: FMI {fmi}, {name} with {inside} in its resources, values set: {len(values)}")
    warnings([f"until other values are set: {line}" for line in refused.splitlines()])
