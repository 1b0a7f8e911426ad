"""What the commands share: the application, its options, settings, a run with a progress bar."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from motionfmu.errors import InputError
from motionfmu.toml_lines import tables_of, text_of, word

if TYPE_CHECKING:
    from rich.progress import Progress, ProgressColumn

    from motionfmu.run import Result, Scenario

app = typer.Typer(
    help="Motion controllers as FMI co-simulation FMUs.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
out = Console(highlight=False)

FAILED, WRONG, STOPPED = 1, 2, 130
ScenarioPath = Annotated[Path, typer.Argument(help="Folder of a scenario, or its scenario.toml.")]
Set = Annotated[
    list[str],
    typer.Option(
        "--set", metavar="COMP.VAR=VALUE", help="Stronger than the scenario's; or a gains.toml."
    ),
]


def setting(text: str) -> tuple[str, Any]:
    """Read ``comp.var=value``; the value is TOML, a bare word is text."""
    name, equals, value = text.partition("=")
    if not equals:
        raise InputError(f"--set {text}: COMP.VAR=VALUE wanted")
    return name.strip(), word(value.strip())


def settings(texts: list[str]) -> dict[str, Any]:
    """Values by name of all ``--set``, the later one counts; a TOML file is taken whole."""
    found: dict[str, Any] = {}
    for text in texts:
        if "=" in text or not text.endswith(".toml"):
            found.update([setting(text)])
            continue
        try:
            found.update(tables_of(text_of(text), text))
        except InputError as error:
            raise InputError(f"--set {error}") from None
    return found


def results(name: str, kind: str = "") -> Path:
    """The folder in which a command leaves its result."""
    # A run's has the scenario's name alone; any other ends with the command's: circle.tune.
    return Path("results") / (f"{name}.{kind}" if kind else name)


def bare_table(*headings: str) -> Table:
    """Table without lines."""
    table = Table(box=None, header_style="dim")
    for heading in headings:
        table.add_column(heading)
    return table


def progress_bar(*columns: "ProgressColumn") -> "Progress":
    """Progress bar with these columns, or those of rich if none, which shows on a terminal only."""
    from rich.progress import Progress

    return Progress(*columns, console=out, disable=not out.is_terminal, transient=True)


def run_shown(scenario: "Scenario", options: dict[str, Any]) -> "Result":
    """Run, options as of `Scenario.run`, with a progress bar, which shows on a terminal only."""
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn
    from rich.progress import TimeRemainingColumn as TimeLeft

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeLeft())
    with progress_bar(*columns) as bar:
        task = bar.add_task(scenario.name, total=1.0)
        return scenario.run(**options, progress=lambda share: bar.update(task, completed=share))
