"""Decisions by subject: a page that leads to each subject, and one for each with its decisions."""

import os
import re
from collections.abc import Iterator
from pathlib import Path

from site_pages.markdown import plain, table, toctree
from site_pages.staging import DECISIONS, subject_page, title

_SUBJECT = re.compile(rf"^\| \[([a-z-]+)\]\({DECISIONS}/\1\) \| (.+) \|$", re.MULTILINE)
_DAYS = re.compile(r"^\*Decided ([^*]+)\.\*$", re.MULTILINE)
_SUPERSEDED = re.compile(
    r"^\*Superseded on ([\d-]+) by \[([^\]]+)\]\(([^)\s]+)\)\.?\*$", re.MULTILINE
)


def subjects(root: Path) -> dict[str, str]:
    """What each subject decides about, by the name of its folder, in DESIGN.md's order."""
    return dict(_SUBJECT.findall((root / "DESIGN.md").read_text(encoding="utf-8")))


def pages_of(root: Path, pages: list[str]) -> dict[str, str]:
    """The list of subjects and the page of each, by their names in the site's source."""
    lead = "[How the project is laid out](DESIGN.md), and why each thing is as it is."
    rows, own = [], {}
    for subject, about in subjects(root).items():
        found = [p for p in pages if p.startswith(f"{DECISIONS}/{subject}/")]
        name = subject.replace("-", " ")
        rows.append((f"[{name}]({subject_page(subject)})", about, str(len(found))))
        listed = table(("page", "superseded", "decided"), _rows(root, found)) if found else ""
        head = f"# {name.capitalize()}: decisions\n\n{about}"
        tree = toctree([f"/{p}" for p in found])
        own[subject_page(subject)] = f"{head}\n\n{listed}\n\n{tree}"
    subjects_table = table(("subject", "is about", "pages"), rows)
    tree = toctree(f"{name} <{subject_page(name)}>" for name in subjects(root))
    return {"decisions.md": f"# Decisions\n\n{lead}\n\n{subjects_table}\n\n{tree}", **own}


def _whole(text: str) -> str:
    """A text whose days are not broken at the end of a line."""
    return re.sub(r"\d{4}-\d\d-\d\d", r'<span class="day">\g<0></span>', text)


def _rows(root: Path, pages: list[str]) -> Iterator[tuple[str, str, str]]:
    """Title, what supersedes it and days, sorted by title; superseded ones are last."""
    found = []
    for name in pages:
        text = (root / name).read_text(encoding="utf-8")
        days, old = _DAYS.search(text), _SUPERSEDED.search(text)
        mark = ""
        if old:
            by = Path(os.path.normpath(Path(name).parent / old[3])).as_posix()
            mark = f"on {old[1]} by [{plain(old[2])}](../{by})"
        link = f"[{plain(title(root / name))}](../{name})"
        found.append((link, mark, _whole(days[1]) if days else ""))
    yield from sorted(found, key=lambda row: (bool(row[1]), row[0].lower()))
