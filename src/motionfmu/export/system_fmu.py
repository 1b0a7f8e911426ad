"""A scenario's system as one FMU file, for any importer of FMI 2 or 3."""

import json
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from motionfmu import fused
from motionfmu.base.errors import InputError
from motionfmu.base.platforms import Platform
from motionfmu.base.toml_lines import is_file
from motionfmu.export.export_choice import also_shown, check_version
from motionfmu.export.program_check import check_scenario
from motionfmu.export.resources import Resources
from motionfmu.fmu import documentation
from motionfmu.fmu.pack import RESOURCES, write_whole
from motionfmu.fused.resource_files import carrying, placed
from motionfmu.run.controller_plan import bounded
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios import fmus

PROGRAM = "program.json"  # file that a run here reads instead of the description
_LEFT = (
    PROGRAM,
    documentation.VARIABLES,
    documentation.TERMINALS,
)  # the latter two are in the documentation


@dataclass(frozen=True)
class Choice:
    """What an exported system shows, and for whom it is compiled.

    Attributes
    ----------
    inner : collection of str
        Patterns of outputs that are shown beside the recorded ones.
    platforms : sequence of Platform
        For which it is compiled, from C text that it carries; without any for this machine alone.
    """

    inner: Collection[str] = ()
    platforms: Sequence[Platform] = ()


def as_fmu(
    scenario: RunPlan,
    target: Path,
    fmi: int,
    given: Mapping[str, Any],
    choice: Choice = Choice(),
) -> int:
    """Write the system as an FMU.

    Parameters
    ----------
    scenario : RunPlan
        Its parameters, open inputs and recorded outputs become variables, by its names; its values
        are their start values, and the files that they name resources.
    target : Path
        The .fmu.
    fmi : int
        2 or 3.
    given : mapping
        Value by ``component.variable``, stronger than the scenario's.
    choice : Choice
        What it shows beside what is recorded, and its platforms.

    Returns
    -------
    int
        Number of its variables.

    Raises
    ------
    InputError
        Of a system that cannot be one FMU, a pattern that matches nothing, a file that cannot be
        written.
    """
    check_version(fmi)
    options = bounded(scenario, Options(set=given))
    system, resources = scenario.resolved(options), Resources()
    check_scenario(scenario, system, given)
    system = placed(system, carrying(system))
    settings = tuple(resources.inside(s) for s in system.settings)
    ends = also_shown(scenario, choice.inner, ("output",))
    try:
        program = fused.exported(
            replace(system, settings=settings),
            ends,
            fmi,
            identifier(scenario.name),
            choice.platforms,
        )
    except fused.NotFused as why:
        instead = "; an SSP needs none" if isinstance(why, fused.NoCompiler) else ""
        raise InputError(f"{scenario.name} cannot be one FMU: {why}{instead}") from None
    # The system's C text is of no use without that of its FMUs.
    left = _LEFT if choice.platforms else (*_LEFT, "sources/")
    packed = {
        name: f
        for f in program.folder.rglob("*")
        if f.is_file() and not (name := str(f.relative_to(program.folder))).startswith(left)
    }
    packed |= {f"{RESOURCES}/{name}": file for name, file in resources.files.items()}
    readme = scenario.document.file.parent / "README.md"
    text = ""
    if is_file(readme):
        packed["documentation/README.md"] = readme
        text = readme.read_text()
    icon = documentation.joined(
        [x for fmu in system.components.values() if (x := fmus.icon_of(fmu))]
    )
    about = (scenario.name, f"The system of {scenario.name}: {', '.join(system.components)}")
    made = documentation.files(fmi, program.folder, about, text, icon)
    write_whole(target, {n: f.read_bytes() for n, f in packed.items()} | made)
    return len(json.loads((program.folder / PROGRAM).read_bytes())["variables"])


def identifier(name: str) -> str:
    """A scenario's name as a model identifier: two_cards is TwoCards."""
    words = re.findall(r"[A-Za-z0-9]+", name)
    joined = "".join(word[:1].upper() + word[1:] for word in words)
    return joined if joined[:1].isalpha() else f"System{joined}"
