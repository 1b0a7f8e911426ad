"""What comes with the package, found by name: scenarios, and projects to start from."""

import os
import re
from collections.abc import Callable
from pathlib import Path

from motionfmu.base.errors import InputError, suggestion

PACKAGE = Path(__file__).resolve().parents[1]
MACHINES, RIGS = PACKAGE / "machines", PACKAGE / "rigs"
SCENARIO, MACHINE = "scenario.toml", "machine.toml"
_OTHER = re.compile(r"""["']\.\./(\w+)["'/]""")


def folder(kind: str) -> Path:
    """Folder of all ``scenarios`` or ``examples``: the installed package's, or the checkout's."""
    installed = PACKAGE / "shipped"
    return (installed if installed.is_dir() else PACKAGE.parent.parent) / kind


def sources() -> dict[str, Path]:
    """What cores and FMUs are built of: each place in a tree of sources, and what stands there."""
    installed = folder("sources")
    root = installed if installed.is_dir() else PACKAGE.parent.parent
    names = ("CMakeLists.txt", "pyproject.toml", "LICENSE", "fmus", "modelica")
    inner = {f"src/{place.name}": place for place in sorted((root / "src").glob("[!_]*"))}
    return {**{name: root / name for name in names}, **inner, "src/motionfmu": PACKAGE}


def scenarios() -> dict[str, Path]:
    """Folders of the scenarios that have a name: those of the package and of ./scenarios."""
    return _named(SCENARIO, folder("scenarios"), Path("scenarios"))


def machines() -> dict[str, Path]:
    """Folders of the machines that have a name: those of the package and of ./machines."""
    return _named(MACHINE, MACHINES, Path("machines"))


def rigs() -> dict[str, Path]:
    """Folders of parts of machines on the bench, which a scenario names as it does a machine."""
    return _named(MACHINE, RIGS)


def _named(file: str, *places: Path) -> dict[str, Path]:
    """Folders with such a file by their names; one of a later place hides those before."""
    found = [one.parent for place in places for one in sorted(place.glob(f"*/{file}"))]
    return {each.name: each for each in found}


def examples() -> dict[str, Path]:
    """Folders that can be copied, by name: the package's scenarios, and its projects."""
    found = [*folder("scenarios").glob(f"*/{SCENARIO}"), *folder("examples").glob("*/README.md")]
    return {file.parent.name: file.parent for file in sorted(found)}


def is_name(given: str | Path) -> bool:
    """Whether a text can only be a scenario's name, for no file or folder has it as its path."""
    return len(Path(given).parts) == 1 and not os.path.lexists(given)


def scenario(given: str | Path) -> Path | None:
    """Folder of the scenario with this name; None if the text is a path or no scenario has it."""
    return scenarios().get(str(given)) if is_name(given) else None


def unknown(given: str, known: Callable[[], dict[str, Path]]) -> str:
    """The end of a message about an unknown name: the names that are near it, else all names."""
    names = list(known())
    return suggestion(given, names) or f" (there are: {', '.join(names) or 'none'})"


def no_scenario(given: str | Path) -> str:
    """The hint that follows the words `no such scenario`; it is empty if a path was given."""
    if not is_name(given):
        return ""
    name = str(given)
    if name in machines():
        return f": it is a machine, on which a program runs: run PROGRAM --machine {name}"
    # A name with a suffix is that of a file, which no list shows.
    listed = "" if Path(given).suffix else " (motionfmu list shows them)"
    return suggestion(name, [*scenarios(), *machines()]) or listed


def needed(name: str) -> list[Path]:
    """Folder of an example, and folders of other examples whose files it names."""
    known = examples()
    if name not in known:
        raise InputError(f"{name}: no such example{unknown(name, examples)}")
    found, waiting = [known[name]], [known[name]]
    while waiting:
        text = "".join(file.read_text(encoding="utf-8") for file in waiting.pop().glob("*.toml"))
        others = {known[other] for other in _OTHER.findall(text) if other in known}
        new = sorted(others - {*found})
        found += new
        waiting += new
    return found
