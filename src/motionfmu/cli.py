"""The console command.

Exit status: 0 all checks hold, 1 a check failed, 2 the input is wrong (one message on stderr).
"""

import json
import math
import sys
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from motionfmu.errors import InputError

if TYPE_CHECKING:
    from motionfmu.freq.study import Asked, LoopStudy
    from motionfmu.linear import AxisModel
    from motionfmu.run import Result, Scenario
    from motionfmu.sweep import Outcome, Study, Ways

app = typer.Typer(
    help="Motion controllers as FMI co-simulation FMUs.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
out = Console(highlight=False)

FAILED, WRONG, STOPPED = 1, 2, 130
ScenarioPath = Annotated[Path, typer.Argument(help="Folder of a scenario, or its scenario.toml.")]
Engine = Annotated[str, typer.Option(help="native, python or fmpy.")]
Fmi = Annotated[int | None, typer.Option(help="FMI version: 2 or 3; 3 but for engine fmpy.")]
Set = Annotated[
    list[str],
    typer.Option(
        "--set", metavar="COMP.VAR=VALUE", help="Stronger than the scenario's; or a gains.toml."
    ),
]


def setting(text: str) -> tuple[str, Any]:
    """Read ``comp.var=value``; the value is TOML, a bare word is text.

    Parameters
    ----------
    text : str
        As given on the command line.

    Returns
    -------
    str, object
        Name and value.

    Raises
    ------
    InputError
        There is no ``=``.
    """
    name, equals, value = text.partition("=")
    if not equals:
        raise InputError(f"--set {text}: COMP.VAR=VALUE wanted")
    try:
        return name.strip(), tomllib.loads(f"x = {value}")["x"]
    except tomllib.TOMLDecodeError:
        return name.strip(), value.strip()


def settings(texts: list[str]) -> dict[str, Any]:
    """Values of all ``--set``; a file of values is taken whole.

    Parameters
    ----------
    texts : list of str
        ``comp.var=value``, or a TOML file of ``"comp.var" = value``.

    Returns
    -------
    dict
        By name; a later one counts.

    Raises
    ------
    InputError
        There is no ``=``, or the file is missing or no TOML.
    """
    found: dict[str, Any] = {}
    for text in texts:
        if "=" in text or not text.endswith(".toml"):
            found.update([setting(text)])
            continue
        try:
            found.update(tomllib.loads(Path(text).read_text(encoding="utf-8")))
        except OSError as error:
            raise InputError(f"--set {text}: {error.strerror}") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise InputError(f"--set {text}: {error}") from None
    return found


def _version(engine: str, fmi: int | None) -> int:
    """FMPy's container runs FMI 2 components only."""
    return fmi if fmi is not None else 2 if engine == "fmpy" else 3


def _verdicts(result: "Result") -> None:
    table = Table(box=None, header_style="dim")
    for heading in ("", "check", "found", "asked"):
        table.add_column(heading)
    for v in result.checks:
        mark = "[green]ok[/]" if v.ok else "[bold red]FAILED[/]"
        table.add_row(mark, v.name, f"{v.value:.6g}", v.bounds.replace("[", r"\["))
    out.print(table)


def _run(scenario: "Scenario", options: dict[str, Any]) -> "Result":
    """Run with a progress bar, which shows on a terminal only."""
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn
    from rich.progress import TimeRemainingColumn as TimeLeft

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeLeft())
    with Progress(*columns, console=out, disable=not out.is_terminal, transient=True) as bar:
        task = bar.add_task(scenario.name, total=1.0)
        return scenario.run(**options, progress=lambda share: bar.update(task, completed=share))


def _sweep(study: "Study", folder: Path, ways: "Ways") -> "Outcome":
    """Run a study with a progress bar, which shows on a terminal only."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeElapsedColumn as TimeUsed
    from rich.progress import TimeRemainingColumn as TimeLeft

    from motionfmu.sweep import conduct

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeUsed(),
        TextColumn("left"),
        TimeLeft(),
        TextColumn("{task.fields[told]}"),
    )
    with Progress(*columns, console=out, disable=not out.is_terminal, transient=True) as bar:
        task, at = bar.add_task(study.name, total=len(study.points), told=""), [0]

        def show(done: int, errors: int) -> None:
            at[0] = done
            told = f"[red]{errors} with an error[/]" if errors else ""
            bar.update(task, completed=done, told=told)

        try:
            return conduct(study, folder, replace(ways, progress=show))
        except KeyboardInterrupt:
            told = f"{at[0]} of {len(study.points)} runs are done; the same command goes on"
            print(f"motionfmu: stopped: {told}", file=sys.stderr)
            raise typer.Exit(STOPPED) from None


@app.command("list")
def list_all() -> None:
    """List the FMUs that are built and the scenarios of this project."""
    from motionfmu import fmus, scenario

    out.print("[bold]FMUs[/]")
    for name in fmus.fmu_names():
        out.print(f"  {name}")
    out.print("[bold]Scenarios[/]")
    for file in sorted(Path("scenarios").glob("*/scenario.toml")):
        out.print(f"  {file.parent}  [dim]{scenario.read(file).about}[/]")


@app.command()
def info(what: Annotated[str, typer.Argument(help="An FMU's name, or a scenario.")]) -> None:
    """Show the variables of an FMU, or what a scenario is made of."""
    from motionfmu import fmus

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
    for check, bounds in body.check.items():
        out.print(f"  check {check}  [dim]{bounds.model_dump(exclude_none=True)}[/]")


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

    from motionfmu import fmus

    with zipfile.ZipFile(fmus.fmu_path(name, fmi)) as archive:
        print(archive.read("modelDescription.xml").decode(), end="")


def _describe(name: str) -> None:
    from motionfmu import fmus

    table = Table(box=None, header_style="dim")
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


@app.command()
def run(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    engine: Engine = "native",
    fmi: Fmi = None,
    set_: Set = [],  # noqa: B006  (typer makes a new list)
    stop: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    step: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    folder: Annotated[Path | None, typer.Option("--out", help="Result folder.")] = None,
    csv: Annotated[bool, typer.Option("--csv", help="Also write signals.csv.")] = False,
) -> None:
    """Run a scenario, judge it and write its report."""
    from motionfmu import outcome
    from motionfmu.run import load

    scenario = load(path)
    target = outcome.usable(folder or Path("results") / scenario.name)
    options: dict[str, Any] = {
        "engine": engine,
        "fmi": _version(engine, fmi),
        "set": settings(set_),
        "stop": stop,
        "step": step,
    }
    result = _run(scenario, options)
    shown = outcome.save(result, target, options, csv)
    _verdicts(result)
    out.print(f"{scenario.name}: {'all checks hold' if result.ok else 'a check FAILED'}")
    out.print(f"report: {shown}", soft_wrap=True)
    if not result.ok:
        raise typer.Exit(FAILED)


@app.command()
def check(
    paths: Annotated[list[Path] | None, typer.Argument(help="Scenarios; all if none.")] = None,
    engine: Engine = "native",
    fmi: Fmi = None,
) -> None:
    """Run scenarios and judge them; nothing is written."""
    from motionfmu.run import load

    chosen = paths or sorted(p.parent for p in Path("scenarios").glob("*/scenario.toml"))
    if not chosen:
        raise InputError("no scenario here: name one, or run from the project's folder")
    failed = False
    for path in chosen:
        scenario = load(path)
        result = _run(scenario, {"engine": engine, "fmi": _version(engine, fmi)})
        mark = "[green]ok[/]" if result.ok else "[bold red]FAILED[/]"
        out.print(f"{mark}  {scenario.name}  [dim]{len(result.checks)} bounds[/]")
        if not result.ok:
            failed = True
            _verdicts(result)
    if failed:
        raise typer.Exit(FAILED)


@app.command()
def contour(
    path: ScenarioPath,
    set_: Set = [],  # noqa: B006  (typer makes a new list)
    folder: Annotated[Path | None, typer.Option("--out", help="Result folder.")] = None,
    figures: Annotated[
        bool, typer.Option("--figures", help="Only print the contour figures of one run.")
    ] = False,
) -> None:
    """Explain the contour error of a scenario: which cause makes how much of it."""
    from motionfmu.run import load

    given = settings(set_)
    if figures:
        found = _run(load(path), {"set": given}).contour().numbers()
        table = Table(box=None, header_style="dim")
        for heading in ("figure", "value"):
            table.add_column(heading)
        for name, value in _flat({k: v for k, v in found.items() if k != "commands"}):
            table.add_row(name, value)
        out.print(table)
        return
    _explain(path, given, folder)


def _explain(path: Path, settings: dict[str, Any], folder: Path | None) -> None:
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

    from motionfmu import outcome
    from motionfmu.explain import explain
    from motionfmu.explain.page import write_explanation
    from motionfmu.report.numbers import length
    from motionfmu.scenario import scenario_file

    name = scenario_file(path).parent.name
    target = outcome.usable(folder or Path("results") / f"{name}_contour")
    columns = (BarColumn(), TaskProgressColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=out, disable=not out.is_terminal, transient=True) as bar:
        task = bar.add_task(name, total=1.0)
        found = explain(
            path,
            set=settings,
            progress=lambda what, share: bar.update(task, completed=share, description=what),
        )
    table = Table(box=None, header_style="dim")
    table.add_column("cause")
    for heading in ("largest", "99 %", "theory", "error without"):
        table.add_column(heading, justify="right")
    for e in found.effects:
        both = ("" if v is None else length(v) for v in (e.theory.value, e.without))
        sizes = (length(e.size), length(e.usual)) if e.judged else ("not judged", "")
        table.add_row(e.title, *sizes, *both)
    numbers = found.numbers()
    for title, key in (("Sum of the effects", "sum_of_effects"), ("Residual", "residual")):
        table.add_row(f"[dim]{title}[/]", length(numbers[key]["max"]))
    table.add_row("[bold]Contour error[/]", length(numbers["contour_error"]["max"]))
    out.print(table)
    for e in found.effects:
        if not e.judged:
            out.print(f"[bold]{e.title}[/] not judged: {e.how.replace('[', chr(92) + '[')}")
    for mark in found.signatures:
        out.print(f"[bold]Ballbar, radius {mark.test.radius:g} mm[/]")
        for words in mark.words():
            out.print(f"  {words}")
    with outcome.whole(target) as part:
        shown = write_explanation(found, part).name
    out.print(f"report: {target / shown}", soft_wrap=True)


@app.command()
def margins(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    axis: Annotated[int, typer.Option(help="Axis, from 1.")] = 1,
    at: Annotated[
        list[str],
        typer.Option("--at", metavar="COMP.VAR=VALUE", help="Operating point of a plant."),
    ] = [],  # noqa: B006
    loop: Annotated[str | None, typer.Option(help="Input at which to open; all if none.")] = None,
    gain: Annotated[
        str | None, typer.Option(help="With --loop: parameter whose largest value is wanted.")
    ] = None,
    kick: Annotated[
        float | None, typer.Option(help="Step that makes it ring, in the input's unit.")
    ] = None,
    simulate: Annotated[bool, typer.Option(help="Also run the FMUs.")] = True,
    set_: Set = [],  # noqa: B006
    folder: Annotated[Path | None, typer.Option("--out", help="Result folder.")] = None,
) -> None:
    """Margins and largest stable gains of a scenario's loops, and their report."""
    from motionfmu import outcome
    from motionfmu.freq.study import Asked
    from motionfmu.linear import model
    from motionfmu.report.margin_page import numbers, page_text

    if gain is not None and loop is None:
        raise InputError(f"--gain {gain}: say with --loop which loop it belongs to")
    point = dict(setting(text) for text in at)
    linear = model(path, axis, point, settings(set_))
    target = outcome.usable(folder or Path("results") / f"{linear.scenario.name}-margins")
    gains = {loop: gain} if loop is not None and gain is not None else {}
    studies = _study(linear, Asked(loop, gains, simulate, kick))
    with outcome.whole(target) as part:
        (part / "report.html").write_text(page_text(linear, studies), encoding="utf-8")
        text = json.dumps(numbers(linear, studies), indent=1, allow_nan=False)
        (part / outcome.NUMBERS).write_text(text + "\n", encoding="utf-8")
    table = Table(box=None, header_style="dim")
    table.add_column("loop", overflow="fold")
    for heading in ("gain", "phase", "delay", "peak S", "largest", "simulated"):
        table.add_column(heading, no_wrap=True)
    for s in studies:
        m, ringing = s.margins, s.simulated.gain if s.simulated else math.nan
        cells = (f"x {m.gain:.4g}", f"{m.phase:.4g}°", f"{m.delay * 1e3:.4g} ms")
        name = s.at if m.stable else f"{s.at} [bold red]unstable[/]"
        table.add_row(
            name, *cells, f"{m.sensitivity:.4g}", f"{s.linear.gain:.5g}", f"{ringing:.5g}"
        )
    out.print(table)
    out.print(f"report: {target / 'report.html'}", soft_wrap=True)


def _study(linear: "AxisModel", asked: "Asked") -> "list[LoopStudy]":
    """Study with a progress bar, which shows on a terminal only."""
    from rich.progress import Progress

    from motionfmu.freq.study import study

    with Progress(console=out, disable=not out.is_terminal, transient=True) as bar:
        task = bar.add_task(linear.scenario.name, total=1.0)
        return study(
            linear, replace(asked, progress=lambda share: bar.update(task, completed=share))
        )


@app.command()
def sweep(  # noqa: PLR0913  (each is an option of the command)
    path: Annotated[Path, typer.Argument(help="A study's TOML file, or a scenario (folder).")],
    vary: Annotated[
        list[str],
        typer.Option(metavar="COMP.VAR=LO:HI:N", help="Or LO:HI, LO:HI:N:log, a list a,b,c."),
    ] = [],  # noqa: B006
    sampling: Annotated[str | None, typer.Option(help="grid, random or latin.")] = None,
    runs: Annotated[int | None, typer.Option(help="Number of runs, if drawn.")] = None,
    seed: Annotated[int | None, typer.Option(help="Of the draws.")] = None,
    result: Annotated[
        list[str],
        typer.Option(metavar="NAME", help="contour.error.max, card.stock.min ...; the checks'."),
    ] = [],  # noqa: B006
    cost: Annotated[str | None, typer.Option(help="Result that is to be small.")] = None,
    tuned: Annotated[str | None, typer.Option(help='TOML file of "comp.var" = value.')] = None,
    set_: Set = [],  # noqa: B006
    stop: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    step: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    workers: Annotated[int | None, typer.Option(min=1, help="Processes; all cores.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a dask scheduler.")] = None,
    folder: Annotated[Path | None, typer.Option("--out", help="Result folder.")] = None,
    new: Annotated[bool, typer.Option("--new", help="Begin again, do not resume.")] = False,
) -> None:
    """Run a scenario at many points; resumes where an earlier call was ended."""
    from motionfmu import sweep as sweeps
    from motionfmu.sweep.axes import option

    given: dict[str, Any] = {"sampling": sampling, "runs": runs, "seed": seed, "cost": cost}
    given |= {"tuned": tuned, "stop": stop, "step": step, "results": result or None}
    given["set"] = settings(set_) or None
    given["axis"] = dict(option(text) for text in vary) or None
    chosen = sweeps.study(path, given)
    target = folder or Path("results") / f"{chosen.name}.sweep"
    outcome = _sweep(chosen, target, sweeps.Ways(workers, scheduler, new))
    before = f", {outcome.resumed} of them before" if outcome.resumed else ""
    out.print(f"{chosen.name}: {len(outcome.rows)} runs{before}, {outcome.errors} with an error")
    if (best := outcome.best) is not None:
        for name, value in zip(chosen.job.axes, chosen.points[best], strict=True):
            out.print(f"  {name} = {value}", markup=False)
        out.print(f"  {chosen.cost} = {outcome.cost[best]:.6g}  [dim]smallest, run {best}[/]")
    out.print(f"table: {outcome.folder / 'sweep.parquet'}", soft_wrap=True)
    out.print(f"report: {outcome.folder / 'report.html'}", soft_wrap=True)
    if outcome.best is None:
        raise typer.Exit(FAILED)


def _flat(value: Any, name: str = "") -> list[tuple[str, str]]:
    if isinstance(value, dict):
        pairs = list(value.items())
    elif isinstance(value, list):
        pairs = [(str(i), v) for i, v in enumerate(value)]
    else:
        return [(name, f"{value:.6g}" if isinstance(value, float) else str(value))]
    return [row for k, v in pairs for row in _flat(v, f"{name}.{k}" if name else k)]


def main() -> None:
    """Entry point: one message and status 2 for wrong input."""
    from motionfmu import cli_tune  # noqa: F401  (its command joins the others)

    try:
        app()
    except InputError as error:
        print(f"motionfmu: {error}", file=sys.stderr)
        sys.exit(WRONG)


if __name__ == "__main__":
    main()
