"""Common parts of the commands: application, options, settings, runs with a progress bar."""

import contextlib
import functools
import os
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import tables_of, text_of, word

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress, ProgressColumn
    from rich.table import Table

    from motionfmu.run import Result, Scenario


class Flags:
    """Flags that are not given are False: typer loads pydantic to look at a None."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Arguments and options of the command."""
        params: list[Any] = super().get_params(ctx)  # type: ignore[misc]
        for param in params:
            if getattr(param, "is_flag", False) and param.default is None:
                param.default = False
        return params


class Group(Flags, TyperGroup):
    """Commands whose help is listed whole, not cut to a line."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list of commands."""
        with formatter.section("Commands"):
            firsts = ((n, (self.commands[n].help or "").split("\n\n")[0]) for n in self.commands)
            formatter.write_dl([(name, text.replace("\n", " ")) for name, text in firsts])


@dataclass
class Mode:
    """How much a command tells, and whether its page is to be opened."""

    quiet: bool = False
    verbose: bool = False
    open: bool = False
    loud: Any = None  # what was stdout before -q


mode = Mode()


def _chosen(ctx: typer.Context, option: typer.CallbackParam, value: bool) -> None:
    """Take a habit of all commands; it ends with the command."""
    name = str(option.name)
    setattr(mode, name, value)
    if not value:
        return
    ctx.call_on_close(lambda: setattr(mode, name, False))
    if name == "quiet":
        usual, silence = sys.stdout, open(os.devnull, "w", encoding="utf-8")
        ctx.call_on_close(silence.close)
        ctx.call_on_close(lambda: _loud(usual))
        sys.stdout, mode.loud = silence, usual
    if name == "verbose":
        began = time.perf_counter()
        ctx.call_on_close(lambda: _took(time.perf_counter() - began))


def _loud(usual: Any) -> None:
    sys.stdout, mode.loud = usual, None


def _took(seconds: float) -> None:
    print(f"took {seconds:.2f} s", file=sys.stderr)


def _habit(told: str, *names: str) -> Any:
    return typer.Option(*names, callback=_chosen, expose_value=False, help=told)


@functools.cache
def _habits() -> list[Any]:
    """The options of a command that has nothing but habits."""
    one = typer.Typer(add_completion=False, rich_markup_mode=None)

    @one.command()
    def nothing(
        quiet: Annotated[
            bool, _habit("Print nothing; the status says it.", "-q", "--quiet")
        ] = False,
        verbose: Annotated[
            bool, _habit("Tell more, and how long it took.", "-v", "--verbose")
        ] = False,
        open: Annotated[bool, _habit("Open the report in the browser.", "--open")] = False,
    ) -> None:
        pass

    return list(typer.main.get_command(one).params)


class Command(Flags, TyperCommand):
    """A command with the habits of all: -q and -v, and --open if it writes a result folder."""

    def __init__(self, *args: Any, params: list[Any] | None = None, **more: Any) -> None:
        paged = any(p.name == "folder" for p in params or ())
        own = [option for option in _habits() if paged or option.name != "open"]
        super().__init__(*args, params=[*(params or ()), *own], **more)


class App(typer.Typer):
    """An application whose commands have the habits of all."""

    def command(self, name: str | None = None, **more: Any) -> Any:
        """Register a command."""
        return super().command(name, **{"cls": Command} | more)


app = App(
    cls=Group,
    help="Motion controllers as FMI co-simulation FMUs.",
    no_args_is_help=True,
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
        from motionfmu.base import project_version

        print(f"motionfmu {project_version.version()}")
        raise typer.Exit


@app.callback()
def _all(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Show it and exit."),
    ] = False,
) -> None:
    pass


def _scenarios(incomplete: str) -> list[str]:
    """What a shell offers for a scenario: names of `motionfmu list`, folders, files."""
    import glob

    from motionfmu.scenarios import package_files

    paths = [f"{p}/" if Path(p).is_dir() else p for p in glob.glob(f"{glob.escape(incomplete)}*")]
    names = [name for name in package_files.scenarios() if name.startswith(incomplete)]
    return sorted({*names, *paths})


ScenarioPath = Annotated[
    Path,
    typer.Argument(
        help="A scenario: its folder or file, or a name of `motionfmu list`.",
        autocompletion=_scenarios,
    ),
]
Folder = Annotated[Path | None, typer.Option("--out", "-o", help="Result folder.")]
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


Over = Annotated[
    list[str],
    typer.Option("--map", metavar="SIGNAL=COLUMN", help="Which column lies over a signal."),
]
LayoutFile = Annotated[
    Path | None,
    typer.Option("--layout", metavar="FILE.toml", help="Keys of [record_file] for the record."),
]


def record_options(
    over: list[str], layout: Path | None
) -> tuple[dict[str, str] | None, dict[str, Any] | None]:
    """Columns by signals of all ``--map``, and the keys of a ``--layout``; None if not given."""
    pairs = dict(pair(text) for text in over)
    given = None if layout is None else tables_of(text_of(layout), layout)
    if given is not None:
        given = dict(given.get("record_file", given))
        pairs = {**given.pop("over", {}), **pairs}
        for key in ("file", "drive", "resample", "gaps"):
            given.pop(key, None)
    return pairs or None, given


def pair(text: str) -> tuple[str, str]:
    """Read ``signal=column``."""
    signal, equals, column = text.partition("=")
    if not (signal.strip() and equals and column.strip()):
        raise InputError(f"--map {text}: SIGNAL=COLUMN wanted")
    return signal.strip(), column.strip()


def loaded(path: Path, machine: str | None, drawing: dict[str, Any] | None = None) -> "Scenario":
    """The scenario that a path means; with a machine, the program there on that machine.

    drawing: what is asked of a program that is a drawing, as the table of that name.
    """
    from motionfmu import run

    tables: dict[str, Any] = {"drawing": drawing} if drawing else {}
    if machine is None:
        if drawing:
            raise InputError(f"--{next(iter(drawing))}: it goes with --machine and a drawing")
        return run.load(path)
    return run.machine(machine).scenario(path, **tables)


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


def give(text: str) -> None:
    """Print what was asked for by --json, also with -q."""
    print(text, file=mode.loud or sys.stdout)


def detail(text: str) -> None:
    """Print a line that -v asks for."""
    if mode.verbose:
        print(text)


def report(page: Path) -> None:
    """Say where the page is, and open it if that is asked for."""
    print(f"report: {page}")
    if mode.open:
        import webbrowser

        webbrowser.open(page.resolve().as_uri())


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


@contextlib.contextmanager
def stages(name: str = "") -> Iterator[Callable[[str, float], None]]:
    """A progress bar whose function takes what is done and the share done of all."""
    with progress_bar() as bar:
        task = bar.add_task(name, total=1.0)
        begin = f"{name}: " if name else ""
        yield lambda what, share: bar.update(task, description=begin + what, completed=share)


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
