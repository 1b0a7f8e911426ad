"""Common parts of the commands: application, options, settings, runs with a progress bar."""

import functools
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import tables_of, text_of, word

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress, ProgressColumn
    from rich.table import Table

    from motionfmu.run import Result, Scenario


class Group(TyperGroup):
    """Commands whose help is listed whole, not cut to a line."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list of commands."""
        with formatter.section("Commands"):
            firsts = ((n, (self.commands[n].help or "").split("\n\n")[0]) for n in self.commands)
            formatter.write_dl([(name, text.replace("\n", " ")) for name, text in firsts])


app = typer.Typer(
    cls=Group,
    help="Motion controllers as FMI co-simulation FMUs.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # to load what draws boxes takes longer than all else
)

FAILED, WRONG, STOPPED = 1, 2, 130


class Stopped(Exception):
    """Ctrl-C has ended a command; the text says what is done."""


class Out:
    """The console; it is loaded when something is first printed."""

    @functools.cached_property
    def console(self) -> "Console":
        """The console of rich, without colours of its own choice."""
        from rich.console import Console

        return Console(highlight=False)

    def print(self, *things: Any, **options: Any) -> None:
        """Print, options as of rich."""
        self.console.print(*things, **options)


out = Out()


def _version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        print(f"motionfmu {version('motionfmu')}")
        raise typer.Exit


@app.callback()
def _all(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Show it and exit."),
    ] = False,
) -> None:
    pass


ScenarioPath = Annotated[
    Path, typer.Argument(help="A scenario: its folder or file, or a name of `motionfmu list`.")
]
Set = Annotated[
    list[str],
    typer.Option(
        "--set", metavar="COMP.VAR=VALUE", help="Stronger than the scenario's; or a gains.toml."
    ),
]


OnMachine = Annotated[
    str | None,
    typer.Option(
        metavar="MACHINE", help="PATH is a program: put it on a machine of `motionfmu machines`."
    ),
]


def loaded(path: Path, machine: str | None) -> "Scenario":
    """The scenario that a path means; with a machine, the program there on that machine."""
    from motionfmu import run

    return run.load(path) if machine is None else run.machine(machine).scenario(path)


def setting(text: str) -> tuple[str, Any]:
    """Read ``comp.var=value``; the value is TOML, a bare word is text."""
    name, equals, value = text.partition("=")
    if not equals:
        raise InputError(f"--set {text}: COMP.VAR=VALUE wanted")
    return name.strip(), word(value.strip())


def settings(texts: list[str]) -> dict[str, Any]:
    """Values by name of all ``--set``, the later one counts; a TOML file is taken whole."""
    return {name: value for name, (value, _) in _given(texts).items()}


def files_of(texts: list[str]) -> dict[str, str]:
    """Name of the file that a value of `settings` is from, by the value's name."""
    return {name: Path(file).name for name, (_, file) in _given(texts).items() if file}


def _given(texts: list[str]) -> dict[str, tuple[Any, str]]:
    """Values by name, and the file each is from; empty for the command line."""
    found: dict[str, tuple[Any, str]] = {}
    for text in texts:
        if "=" in text or not text.endswith(".toml"):
            name, value = setting(text)
            found[name] = (value, "")
            continue
        try:
            tables = tables_of(text_of(text), text)
        except InputError as error:
            raise InputError(f"--set {error}") from None
        found.update({name: (value, text) for name, value in tables.items()})
    return found


def results(name: str, kind: str = "") -> Path:
    """The folder in which a command leaves its result."""
    # The folder of a run has the scenario's name; other commands add their own: circle.tune.
    return Path("results") / (f"{name}.{kind}" if kind else name)


def bare_table(*headings: str) -> "Table":
    """Table without lines."""
    from rich.table import Table

    table = Table(box=None, header_style="dim")
    for heading in headings:
        table.add_column(heading)
    return table


def progress_bar(*columns: "ProgressColumn") -> "Progress":
    """Progress bar with these columns, or those of rich if none, which shows on a terminal only."""
    from rich.progress import Progress

    console = out.console
    return Progress(*columns, console=console, disable=not console.is_terminal, transient=True)


def under_way(what: str) -> None:
    """Show on a terminal what is being made, in place of the last such text."""
    if sys.stdout.isatty():
        print("\r\x1b[2K" + (f"{what} ..." if what else ""), end="", flush=True)


def run_shown(scenario: "Scenario", options: dict[str, Any]) -> "Result":
    """Run, options as of `Scenario.run`, with a progress bar, which shows on a terminal only."""
    if not sys.stdout.isatty():
        return scenario.run(**options)
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn
    from rich.progress import TimeRemainingColumn as TimeLeft

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeLeft())
    with progress_bar(*columns) as bar:
        task = bar.add_task(scenario.name, total=1.0)
        return scenario.run(**options, progress=lambda share: bar.update(task, completed=share))
