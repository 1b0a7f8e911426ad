"""The commands that list and describe FMUs and scenarios."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from motionfmu.cli.common import app, bare_table, out
from motionfmu.errors import InputError

if TYPE_CHECKING:
    from motionfmu.run import Scenario


@app.command("list")
def list_all() -> None:
    """List the FMUs that are built and the scenarios of this project."""
    from motionfmu.scenarios import document, fmus

    out.print("[bold]FMUs[/]")
    for name in fmus.fmu_names():
        out.print(f"  {name}")
    out.print("[bold]Scenarios[/]")
    for file in sorted(Path("scenarios").glob("*/scenario.toml")):
        out.print(f"  {file.parent}  [dim]{document.read(file).about}[/]")


@app.command()
def info(what: Annotated[str, typer.Argument(help="An FMU's name, or a scenario.")]) -> None:
    """Show the variables of an FMU, or what a scenario is made of."""
    from motionfmu.scenarios import fmus

    if what in fmus.fmu_names():
        _describe(what)
        return
    from motionfmu.run import load

    if not Path(what).exists():
        known = ", ".join(fmus.fmu_names())
        raise InputError(f"{what}: neither an FMU ({known}) nor a scenario")
    scenario = load(what)
    body = scenario.document.body
    out.print(f"[bold]{scenario.name}[/]  {scenario.document.about}")
    out.print(f"{body.stop:g} s in steps of {body.step:g} s")
    for name, fmu in body.component.items():
        out.print(f"  {name:12} {fmu}")
    for line in _gains(scenario):
        out.print(f"  gain {line}", markup=False)
    for check, tables in body.check.items():
        for bounds in tables:
            out.print(f"  check {check}  [dim]{bounds.model_dump(exclude_none=True)}[/]")
    for case in body.contrary:
        out.print(f"  contrary: {case.off}  [dim]{case.set}[/]")


def _gains(scenario: "Scenario") -> list[str]:
    """Position gains of the scenario's loops, also in 1/s."""
    from motionfmu.linear import gain_of
    from motionfmu.linear.position_gain import in_lines

    return in_lines(gain_of(scenario))


@app.command()
def describe(
    name: Annotated[str, typer.Argument(help="An FMU's name.")],
    xml: Annotated[bool, typer.Option("--xml", help="Print its modelDescription.xml.")] = False,
    fmi: Annotated[int, typer.Option(help="FMI version of the XML: 2 or 3.")] = 3,
) -> None:
    """Show the variables of an FMU with units, start values and meaning."""
    if not xml:
        _describe(name)
        return
    import zipfile

    from motionfmu.scenarios import fmus

    path = fmus.fmu_path(name, fmi)
    try:
        with zipfile.ZipFile(path) as archive:
            print(archive.read("modelDescription.xml").decode(), end="")
    except (zipfile.BadZipFile, KeyError) as error:
        raise InputError(f"{path}: no readable modelDescription.xml ({error.args[0]})") from None


def _describe(name: str) -> None:
    from motionfmu.scenarios import fmus

    table = bare_table()
    for heading in ("", "variable", "type", "unit"):
        table.add_column(heading, no_wrap=True)
    table.add_column("start", overflow="fold", max_width=12)
    table.add_column("meaning", min_width=24)
    for port in fmus.ports(name).values():
        kind = port.type + "".join(f"[{n}]" for n in port.shape)
        values = (port.start or "").split()
        start = values[0] if values and len(set(values)) == 1 else (port.start or "")
        cells = (port.causality, port.name, kind, port.unit or "", start, port.doc)
        table.add_row(*(c.replace("[", r"\[") for c in cells))
    out.print(table)
