"""Each page of docs/decisions has its form: title, days, one screen, short sentences, links."""

import re
from datetime import date
from pathlib import Path

import pytest
from conftest import ROOT
from plain_english import LONGEST
from sentences import of_markdown

FOLDER = ROOT / "docs/decisions"
PAGES = sorted(FOLDER.glob("*/*.md"))
MOST_LINES = 60  # of a page, one screen
MOST_COLUMNS = 100  # of a line outside tables
MOST_OF_ROW = 160  # columns of a table's row: a longer one is a paragraph in a cell
DAY = r"(\d{4}-\d\d-\d\d)"
DECIDED = re.compile(rf"\*Decided {DAY}(?:; changed {DAY})?\.\*")
SUPERSEDED = re.compile(rf"\*Superseded on {DAY} by \[[^\]]+\]\(([^)#\s]+)(?:#[^)\s]+)?\)\.?\*")
# What follows the way that was rejected: two words and more behind a colon, another sentence or
# clause. A way alone, however long, teaches nobody why not to try it again.
REASON = re.compile(
    r": (?:\S+ ){2}|; |[.?!]\)? [A-Z0-9`\"(]|\b(?:because|since)\b"
    r"|, (?:\w+ )?(?:as|but|for|so|where|which|who|whose|whom)\b"
)
LINK = re.compile(r"\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^)\s]+)\)")


def faults(text: str, folder: Path) -> list[str]:
    """What is wrong with the form of a page that stands in a folder."""
    lines = text.splitlines()
    head = [line for line in lines[:6] if line]
    found = []
    if not lines[0].startswith("# ") or lines[0].endswith("."):
        found.append(f"line 1: no title: {lines[0]}")
    found += _wrong_days(head[1:3])
    if len(lines) > MOST_LINES:
        found.append(f"{len(lines)} lines; {MOST_LINES} are one screen")
    found += [
        f"line {number}: {len(line)} columns; {most} at most"
        for number, line in enumerate(lines, 1)
        if len(line) > (most := MOST_OF_ROW if line.startswith("|") else MOST_COLUMNS)
    ]
    if not any(line.startswith("## ") and line != "## Rejected" for line in lines):
        found.append("no heading above the decisions")
    if not rejected(text):
        found.append("nothing rejected")
    found += [
        f"{sentence.words} words; {LONGEST} at most: {sentence.text}"
        for sentence in of_markdown(text)
        if sentence.words > LONGEST
    ]
    found += [
        f"rejected without a reason: {way}" for way in rejected(text) if not REASON.search(way)
    ]
    return found + _dead_links(text, folder)


def rejected(text: str) -> list[str]:
    """The ways below "Rejected", a line each, code as a word."""
    section = re.search(r"^## Rejected\n(.*?)(?=^## |\Z)", text, re.DOTALL | re.MULTILINE)
    ways = re.findall(r"^- (.*?)(?=^- |\n\n|\Z)", section[1] if section else "", re.DOTALL | re.M)
    return [" ".join(re.sub(r"`[^`]*`", "X", way).split()) + " " for way in ways]


def _dead_links(text: str, folder: Path) -> list[str]:
    return [
        f"leads nowhere: {address}"
        for _, address in LINK.findall(re.sub(r"`[^`]*`", "", text))
        if not re.match(r"[a-z]+:|#", address) and not (folder / address.partition("#")[0]).exists()
    ]


def _wrong_days(head: list[str]) -> list[str]:
    decided = next((m for line in head if (m := DECIDED.fullmatch(line))), None)
    if decided is None:
        return ["no line '*Decided DAY.*' or '*Decided DAY; changed DAY.*' below the title"]
    first, *later = (date.fromisoformat(day) for day in decided.groups() if day)
    found = [f"changed {day}, not after {first}" for day in later if day <= first]
    for line in head:
        if line.startswith("*Superseded"):
            by = SUPERSEDED.fullmatch(line)
            if by is None or not by[2].endswith(".md"):
                found.append(f"no day and page: {line}")
            elif date.fromisoformat(by[1]) < first:
                found.append(f"superseded on {by[1]}, before {first}")
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: f"{page.parent.name}/{page.stem}")
def test_a_page_has_its_form(page: Path) -> None:
    """A page is one screen that a reader of its subject understands and that leads on."""
    assert faults(page.read_text(encoding="utf-8"), page.parent) == []


def test_titles_are_of_one_page() -> None:
    """A page is found by its title, so no two have the same."""
    titles = [page.read_text(encoding="utf-8").partition("\n")[0] for page in PAGES]
    assert sorted(set(titles)) == sorted(titles)


def test_every_subject_stands_in_the_table() -> None:
    """DESIGN.md says of each folder of pages what it decides, and links it."""
    table = (ROOT / "DESIGN.md").read_text(encoding="utf-8")
    subjects = {page.parent.name for page in PAGES}
    assert len(subjects) > 5
    for subject in subjects:
        assert f"| [{subject}](docs/decisions/{subject}) | " in table, subject


GOOD = """# Side of the road

*Decided 2026-11-22; changed 2026-11-24.*

On which side do cars drive?

## Decided

- **Cars drive on the right.** All neighbours do.

## Rejected

- The left: there are more cars of the other kind.
- The middle, which takes two turns.
"""


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("# Side", "Side", "no title"),
        ("changed 2026-11-24", "changed 2026-11-22", "not after"),
        ("*Decided 2026-11-22; changed 2026-11-24.*", "In November.", "no line"),
        ("## Decided\n\n", "", "no heading"),
        ("All neighbours do.", "do so\n" * 20 + "always.", "words; 40"),
        ("All neighbours do.", "`" + "x" * 100 + "`", "columns; 100"),
        ("## Rejected", "| " + "x" * 160 + " |\n\n## Rejected", "columns; 160"),
        ("On which", "\n" * 60 + "On which", "lines; 60"),
        ("## Rejected", "## Other ways", "nothing rejected"),
        (": there are more cars of the other kind", "", "without a reason: The left."),
        (": there are more cars of the other kind", ": no", "without a reason: The left: no."),
        ("The middle, which takes two turns", "The middle in two turns", "reason: The middle in"),
        ("All neighbours", "[All](nowhere.md) neighbours", "leads nowhere"),
        ("\nOn which", "*Superseded on 2026-11-25 by [x](other.md)*\n\nOn which", "other.md"),
        ("\nOn which", "*Superseded by another page.*\n\nOn which", "no day and page"),
        ("\nOn which", "*Superseded on 2026-11-20 by [x](it.md)*\n\nOn which", "before 2026-11-22"),
    ],
)
def test_a_wrong_form_is_told(old: str, new: str, fault: str, tmp_path: Path) -> None:
    """Each rule finds the page that breaks it, and nothing else is wrong with that page."""
    (tmp_path / "it.md").write_text(GOOD, encoding="utf-8")
    assert faults(GOOD, tmp_path) == []
    (told,) = faults(GOOD.replace(old, new), tmp_path)
    assert fault in told
