"""In what a run differs from its scenario, in words."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from motionfmu.base.toml_lines import shown
from motionfmu.base.units import spelled
from motionfmu.scenarios.body import Body
from motionfmu.scenarios.system import System
from motionfmu.scenarios.values import start_values, written

if TYPE_CHECKING:
    from motionfmu.run.run_plan import Options, RunPlan


def _value(values: tuple[Any, ...]) -> str:
    """The text of values: a single one if all elements have it."""
    same = len(set(values)) == 1
    if any(isinstance(v, float) for v in values):
        texts = [f"{v:.9g}" for v in values]
        return texts[0] if same else f"[{', '.join(texts)}]"
    text = shown(values[0] if same else list(values))
    return text.lower() if isinstance(values[0], bool) else text


def overrides(scenario: "RunPlan", options: "Options", system: System) -> list[str]:
    """A line for each value that is not the scenario's own; none if the scenario ran as written."""
    body = scenario.document.body
    given = {scenario.resolver.split(name)[0] for name in options.set}
    found = []
    for end, values in ((s.end, s.values) for s in system.settings if s.end.name in given):
        own = written(scenario.resolver, end.name)
        before = start_values(end.port) if own is None else own
        if values == before:
            continue
        unit = f" {spelled(end.port.unit)}".rstrip()
        file = f"{options.source[end.name]}: " if end.name in options.source else ""
        place = "default" if own is None else "scenario"
        found.append(f"{file}{end.name} = {_value(values)}{unit} ({place}: {_value(before)})")
    found += _steps(options, body)
    by_steps = {d.input for d in body.drive}
    left = sorted(body.driven & {*options.undriven})
    found += [
        f"{name}: its {'[[drive]]' if name in by_steps else 'record'} is left out" for name in left
    ]
    return found


def _steps(options: "Options", body: Body) -> Iterator[str]:
    """A line for each time or number of steps that is not the scenario's own."""
    for key, asked, own, unit in (
        ("stop", options.stop, body.stop, " s"),
        ("step", options.step, body.step, " s"),
        ("every", options.every, body.record.every, ""),
    ):
        if asked is not None and asked != own:
            text = own if isinstance(own, str) else f"{own:.9g}{unit}"
            yield f"{key} = {asked:.9g}{unit} (scenario: {text})"
