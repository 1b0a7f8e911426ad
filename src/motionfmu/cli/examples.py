"""The command that shows and copies what comes with the package to work on."""

import os
import re
import shutil
from pathlib import Path
from typing import Annotated

import typer

from motionfmu.base.errors import InputError
from motionfmu.cli.common import app
from motionfmu.cli.console_text import print_rows
from motionfmu.cli.list import first_line

_PICTURE = re.compile(r"!\[([^\]]*)\]\(([\w./-]+)\)")


@app.command()
def examples(
    name: Annotated[str | None, typer.Argument(help="Of an example; all if none.")] = None,
    target: Annotated[Path | None, typer.Argument(help="Folder to copy into; else here.")] = None,
    copy: Annotated[bool, typer.Option("--copy", help="Copy, do not list.")] = False,
) -> None:
    """List the scenarios and projects that come with motionfmu, or copy them to work on.

    --copy takes one, with others whose files it names, or all; each becomes a folder of its name.
    """
    from motionfmu.scenarios import package_files

    if not copy:
        if target is not None:
            raise InputError(f"{target}: what is this folder for? --copy copies into it")
        known = package_files.examples()
        chosen = known if name is None else {p.name: p for p in package_files.needed(name)}
        print_rows([((each,), first_line(place)) for each, place in chosen.items()])
        return
    places = [*package_files.examples().values()] if name is None else package_files.needed(name)
    _copy(places, target or Path())


def _without_dead_pictures(readme: Path) -> None:
    """Write the words of a picture where it would be, if it did not come with the package."""
    if not readme.is_file():
        return
    text = readme.read_text(encoding="utf-8")

    def shown(found: re.Match[str]) -> str:
        return found[0] if (readme.parent / found[2]).is_file() else f"*{found[1]}*"

    if (told := _PICTURE.sub(shown, text)) != text:
        readme.write_text(told, encoding="utf-8")


def _copy(places: list[Path], target: Path) -> None:
    """Copy folders into one, all or none."""
    if there := [t for p in places if os.path.lexists(t := target / p.name)]:
        raise InputError(*(f"{path} is there already" for path in there))
    part = target / f".examples.part{os.getpid()}"
    made: list[Path] = []
    try:
        for place in places:
            shutil.copytree(place, part / place.name, ignore=shutil.ignore_patterns("__pycache__"))
            _without_dead_pictures(part / place.name / "README.md")
        for place in places:
            (part / place.name).rename(target / place.name)
            made.append(target / place.name)
    except BaseException as error:
        for folder in made:
            shutil.rmtree(folder, ignore_errors=True)
        if isinstance(error, OSError):
            raise InputError(f"cannot write {target}: {error.strerror or error}") from None
        raise
    finally:
        shutil.rmtree(part, ignore_errors=True)
    print(f"{target}: {', '.join(p.name for p in places)}")
    if (places[0] / "scenario.toml").is_file():
        print(f"next: motionfmu run {target / places[0].name}")
