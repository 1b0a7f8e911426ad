"""The commands that make a new FMU, scenario or machine of one that works, or lay out sources."""

import contextlib
import os
import re
import shutil
from pathlib import Path
from typing import Annotated

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.new_folder import new_folder
from motionfmu.cli.common import App, Group, app

TEMPLATES = Path(__file__).parent / "templates"
# Made of the sources, or of other packages; an installed package has them beside its Python text.
MADE = ("fmus", "layer", "lib", "plotly", "shipped")
Name = Annotated[str, typer.Argument(help="Small letters, digits and _; its folder's name.")]

new = App(
    cls=Group,
    rich_markup_mode=None,
    help="Make a new FMU, scenario or machine that works, to be changed; or lay out the sources.",
    no_args_is_help=True,
)
app.add_typer(new, name="new")


@new.command()
def fmu(name: Name) -> None:
    """Make a first-order filter: fmus/NAME and a test of it, in the project's folder."""
    _usable(name)
    if not (Path("fmus").is_dir() and Path("src/fmi/fmi_model.h").is_file()):
        raise InputError(
            "no fmus/ and src/fmi/ here: go to the folder of the project's sources, or make one by"
            " `motionfmu new sources FOLDER`"
        )
    test = Path("tests/fmi") / f"test_{name}.py"
    folder = Path("fmus") / name
    _free(folder, test)
    _make(TEMPLATES / "fmu", folder, name, {"test.py.in": test})
    print(f"{folder}: {', '.join(sorted(p.name for p in folder.iterdir()))}")
    print(f"test: {test}")
    print("contract: src/fmi/fmi_model.h; keys of fmu.toml: CONTRIBUTING.md")
    print(f"next: make build && .venv/bin/python -m pytest tests/fmi -m 'not long' -k {name}")


@new.command()
def scenario(name: Name) -> None:
    """Make an axis that moves, with checks and what fails them: scenarios/NAME, else NAME here."""
    _usable(name)
    folder = Path("scenarios") / name if Path("scenarios").is_dir() else Path(name)
    _free(folder)
    _make(TEMPLATES / "scenario", folder, name, {})
    print(f"{folder}: {', '.join(sorted(p.name for p in folder.iterdir()))}")
    print(f"next: motionfmu run {folder}; motionfmu check {folder} --contrary")


@new.command()
def machine(
    name: Name,
    like: Annotated[str, typer.Option(metavar="MACHINE", help="One of `motionfmu machines`.")],
) -> None:
    """Make machines/NAME, a machine like another one: all its values in one file, to be changed."""
    from motionfmu import run
    from motionfmu.run.machine_copy import copy_machine

    _usable(name)
    folder = Path("machines") / name
    _free(folder)
    copy_machine(run.machine(like), folder)
    print(f"{folder}: {', '.join(sorted(p.name for p in folder.iterdir()))}")
    print(f"next: motionfmu run PROGRAM --machine {name}")


@new.command()
def sources(
    folder: Annotated[Path, typer.Argument(help="It is made, with a CMakeLists.txt.")],
) -> None:
    """Lay out what cores and FMUs are built of: for a firmware, a C program, one's own FMU."""
    from motionfmu.scenarios import package_files

    with new_folder(folder) as part:
        for name, place in package_files.sources().items():
            target = part / name
            target.parent.mkdir(exist_ok=True)
            if place.is_file():
                shutil.copy(place, target)
                continue
            made = MADE if place == package_files.PACKAGE else ()
            left_out = shutil.ignore_patterns("__pycache__", "*.png", *made)
            shutil.copytree(place, target, ignore=left_out)
    print(f"{folder}: cores in src, FMUs in fmus and modelica")
    print(f"next: cmake -S {folder} -B build -DMOTIONFMU_FMUS=OFF; cmake --build build")


def _usable(name: str) -> None:
    if len(name) > 48 or not re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", name):
        told = "small letters and digits, in parts with _ between, 48 at most, wanted"
        raise InputError(f"NAME {name!r}: {told}")


def _free(*paths: Path) -> None:
    for path in paths:
        if os.path.lexists(path):
            raise InputError(f"{path} is there already")


def rendered(template: Path, name: str) -> str:
    """Text of a template for a name, which is CamelCase as {{Name}}."""
    camel = "".join(part.capitalize() for part in name.split("_"))
    text = template.read_text(encoding="utf-8")
    return text.replace("{{name}}", name).replace("{{Name}}", camel)


def _make(templates: Path, folder: Path, name: str, elsewhere: dict[str, Path]) -> None:
    """Write a folder whole or not at all, and the files that stand elsewhere."""
    try:
        with new_folder(folder) as part:
            for template in templates.iterdir():
                target = elsewhere.get(template.name, part / template.name)
                target.write_text(rendered(template, name), encoding="utf-8")
    except BaseException:
        for file in elsewhere.values():
            with contextlib.suppress(OSError):
                file.unlink(missing_ok=True)
        raise
