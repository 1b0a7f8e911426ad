"""The gallery: scenarios and machines by picture.

They are chosen by controller, FMU, subject, and the page of theory that their README links.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from motionfmu.scenarios.body import Body

PICTURE = re.compile(r"!\[[^\]]*\]\(([^)\s]+\.(?:png|svg))\)")
# A link to a page of theory, which an example of it has in its README.
THEORY = re.compile(r"\]\((?:\.\./)+docs/theory/([\w-]+)\.md[)#]")
# A subject by what a scenario's tables or files have.
SUBJECTS = {
    "contour error": ("contour.",),
    "path of a tool (ISO 9283)": ("iso9283.",),
    "loop gains and margins": ("tune.toml", "gains.toml", "margins."),
    "study of many runs": ("sweep.toml",),
    "record of a machine": ("record_file",),
}
OTHER = "time and signals"


@dataclass(frozen=True)
class Card:
    """A scenario or a machine as the gallery shows it."""

    name: str
    page: str  # its page, from the root of the site
    about: str
    picture: Path | None  # else the icons of its FMUs are shown
    fmus: tuple[str, ...]
    controllers: tuple[str, ...]
    subjects: tuple[str, ...]
    theory: tuple[str, ...]  # pages, by the words of their file names
    kind: str  # scenario or machine


def controllers(root: Path) -> set[str]:
    """FMUs that control: their cores are controllers, or their panel says what they are doing."""
    import tomllib

    found = set()
    for file in sorted((root / "fmus").glob("*/fmu.toml")):
        cores = tomllib.loads(file.read_text(encoding="utf-8")).get("cores", [])
        panel = file.with_name("panel.toml")
        watched = panel.is_file() and "[monitor]" in panel.read_text(encoding="utf-8")
        if watched or any((root / "src/controllers" / core).is_dir() for core in cores):
            found.add(file.parent.name)
    return found


def cards(root: Path) -> list[Card]:
    """All scenarios and machines."""
    control = controllers(root)
    files = [*sorted((root / "scenarios").glob("*/scenario.toml"))]
    files += sorted((root / "src/motionfmu/machines").glob("*/machine.toml"))
    return [_card(root, file, control) for file in files]


def _card(root: Path, file: Path, control: set[str]) -> Card:
    folder = file.parent
    body, about = _body(file)
    fmus = tuple(sorted(set(body.component.values())))
    return Card(
        folder.name,
        f"{folder.relative_to(root).as_posix()}/README.html",
        about,
        _picture(folder),
        fmus,
        tuple(n for n in fmus if n in control),
        _subjects(body, folder),
        theory_of((folder / "README.md").read_text(encoding="utf-8")),
        "machine" if file.name == "machine.toml" else "scenario",
    )


def _body(file: Path) -> tuple["Body", str]:
    """Tables of a scenario or of a machine, and what its first line says."""
    from motionfmu import run
    from motionfmu.scenarios import document

    if file.name == "machine.toml":
        found = run.machine(file.parent).plan().document
        return found.body, file.read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
    found = document.read(file)
    return found.body, found.about


def _subjects(body: "Body", folder: Path) -> tuple[str, ...]:
    marks = [name for _, name, _ in body.asked] + [p.name for p in folder.iterdir()]
    marks += ["record_file"] if body.record_file else []
    found = [s for s, begins in SUBJECTS.items() if any(m.startswith(begins) for m in marks)]
    return tuple(found) or (OTHER,)


def theory_of(readme: str) -> tuple[str, ...]:
    """The pages of theory that a README links, by the words of their file names."""
    return tuple(name.replace("-", " ") for name in dict.fromkeys(THEORY.findall(readme)))


def _picture(folder: Path) -> Path | None:
    """The first picture of the README, else the first in the folder."""
    readme = folder / "README.md"
    shown = PICTURE.findall(readme.read_text(encoding="utf-8")) if readme.is_file() else []
    there = [folder / name for name in shown] + sorted(folder.glob("*.png"))
    return next((p.resolve() for p in there if p.is_file()), None)


def page(found: Sequence[Card]) -> str:
    """The page: its choices, then a card for each scenario and machine."""
    choices = {
        "kind": sorted({c.kind for c in found}, reverse=True),
        "controller": sorted({n for c in found for n in c.controllers}),
        "fmu": sorted({n for c in found for n in c.fmus}),
        "subject": [s for s in (*SUBJECTS, OTHER) if any(s in c.subjects for c in found)],
        "theory": sorted({name for c in found for name in c.theory}),
    }
    names = {key: "FMU" if key == "fmu" else key.capitalize() for key in choices}
    picked = "".join(
        f'<label>{names[key]} <select name="{key}"><option value="">all</option>'
        + "".join(f"<option>{escape(v)}</option>" for v in values)
        + "</select></label>\n"
        for key, values in choices.items()
    )
    return (
        "# Gallery\n\nEach picture leads to a scenario or a machine that runs as it is. "
        "The choices show only those that fit.\n\n"
        f'<form class="choices" id="choices">\n{picked}</form>\n'
        '<p id="shown" role="status"></p>\n\n'
        f'<div class="cards">\n{"".join(map(_html, found))}</div>\n'
    )


def _html(card: Card) -> str:
    data = {
        "kind": card.kind,
        "controller": "|".join(card.controllers),
        "fmu": "|".join(card.fmus),
        "subject": "|".join(card.subjects),
        "theory": "|".join(card.theory),
    }
    told = " ".join(f'data-{key}="{escape(value)}"' for key, value in data.items())
    return (
        f'<a class="card" href="{card.page}" {told}>'
        f'<img src="pictures/{picture_name(card)}" alt="" loading="lazy">'
        f"<b>{escape(card.name)}</b><span>{escape(card.about)}</span></a>\n"
    )


def picture_name(card: Card) -> str:
    """Name of a card's picture in the site."""
    return f"{card.kind}-{card.name}{'.png' if card.picture else '.svg'}"


def write_pictures(found: Sequence[Card], folder: Path) -> None:
    """Write a small picture of each card; without one the icons of its FMUs."""
    from PIL import Image

    from motionfmu.fmu.documentation import joined
    from motionfmu.scenarios import fmus

    folder.mkdir(parents=True, exist_ok=True)
    for card in found:
        target = folder / picture_name(card)
        if card.picture is None:
            target.write_text(joined([fmus.icon_of(n) for n in card.fmus]), encoding="utf-8")
            continue
        with Image.open(card.picture) as picture:
            small = picture.convert("RGB")
            small.thumbnail((640, 480))
            small.save(target, optimize=True)
