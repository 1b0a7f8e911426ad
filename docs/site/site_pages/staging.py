"""The site's source: pages that stand in the project and pages that are made, in one folder."""

import os
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from site_pages.markdown import code, plain, table, toctree, told

LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^)\s]+)\)")
FENCE = re.compile(r"^(```|~~~)")
OUTSIDE = re.compile(r"[a-z]+:|#")
PICTURES = {".png", ".svg", ".jpg", ".gif"}
# Folders whose Markdown is the project's; what lies at the root is taken by its name.
FOLDERS = ("docs", "examples", "fmus", "modelica", "scenarios", "src", "tests")
DECISIONS = "docs/decisions"  # one folder for each subject
AT_ROOT = ("README.md", "DESIGN.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")


@dataclass
class Staged:
    """What has been staged: pages, and files that pages link."""

    root: Path  # of the project
    folder: Path  # of the site's source
    pages: list[str] = field(default_factory=list)  # paths from the root
    listed: set[str] = field(default_factory=set)  # files and folders that need a listing


def found_pages(root: Path) -> list[str]:
    """Markdown of the project, without templates and the site's own."""
    skipped = ("src/motionfmu/cli/templates/", "docs/site/index.md")
    files = [root / name for name in AT_ROOT]
    files += [file for folder in FOLDERS for file in sorted((root / folder).rglob("*.md"))]
    names = (file.relative_to(root).as_posix() for file in files)
    return [name for name in names if not name.startswith(skipped)]


def stage(root: Path, folder: Path) -> Staged:
    """Take all pages of the project over, with links that hold in the site."""
    staged = Staged(root, folder, found_pages(root))
    for name in staged.pages:
        text = (root / name).read_text(encoding="utf-8")
        write(folder / name, rewritten(text, name, staged))
    return staged


def write(file: Path, text: str) -> None:
    """Write a page, unless it is so already: what has not changed is not read again."""
    file.parent.mkdir(parents=True, exist_ok=True)
    if not file.is_file() or file.read_text(encoding="utf-8") != text:
        file.write_text(text, encoding="utf-8")


def rewritten(text: str, name: str, staged: Staged) -> str:
    """A page whose links to folders and files lead to pages of the site."""
    lines, fenced = [], False
    for line in text.splitlines():
        fenced ^= bool(FENCE.match(line.lstrip()))
        own = fenced or line.startswith("    ")
        line = line.replace("```csv", "```text")  # for csv there are no colours
        lines.append(line if own else LINK.sub(lambda m: _link(m, name, staged), line))
    return "\n".join(lines) + "\n"


def _link(match: re.Match[str], name: str, staged: Staged) -> str:
    mark, words, address = match.groups()
    words = LINK.sub(lambda m: _link(m, name, staged), words)
    if OUTSIDE.match(address):
        return f"{mark}[{words}]({address})"
    path, _, place = address.partition("#")
    there = Path(os.path.normpath(Path(name).parent / path)).as_posix()
    file = staged.root / there
    if mark:
        copied = staged.folder / there
        copied.parent.mkdir(parents=True, exist_ok=True)
        if file.is_file():
            shutil.copyfile(file, copied)
        return f"![{words}]({address})"
    if Path(there).parent.as_posix() == DECISIONS:  # a subject: its list of decisions
        return f"[{words}]({'../' * name.count('/')}{subject_page(Path(there).name)})"
    if file.is_dir() and (file / "README.md").is_file():
        return f"[{words}]({path.rstrip('/')}/README.md{'#' * bool(place)}{place})"
    if there in staged.pages or not file.exists():
        return f"[{words}]({address})"  # a page; what leads nowhere is told by the build
    staged.listed.add(there)
    return f'<a class="listing" href="{listing_address(name, there)}">{words}</a>'


def subject_page(subject: str) -> str:
    """Where the list of a subject's decisions stands in the site's source."""
    return f"decisions/{subject}.md"


def listing_address(page: str, file: str) -> str:
    """The way from a page to the listing of a file."""
    return f"{'../' * page.count('/')}files/{file}.html"


def title(file: Path) -> str:
    """The first heading of a page."""
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.startswith("# "):
            return line[2:].strip()
    return file.parent.name


def about(file: Path) -> str:
    """The first sentence behind the heading of a page; empty if something else stands there."""
    lines = file.read_text(encoding="utf-8").splitlines()
    start = next((k for k, line in enumerate(lines) if line.startswith("# ")), 0) + 1
    text = " ".join(_paragraph(lines[start:]))
    text = LINK.sub(lambda m: m[2], text)
    return re.split(r"(?<=[.:;]) ", text)[0].rstrip(":;") if text else ""


def _paragraph(lines: list[str]) -> Iterator[str]:
    begun = False
    for line in lines:
        if line.strip() and line[0] in "|!#`<":
            return
        if line.strip():
            begun = True
            yield line.strip()
        elif begun:
            return


def index(heading: str, lead: str, pages: list[str], root: Path) -> str:
    """A page that lists others: what each is called, where it stands, what it is."""
    rows = [
        (
            f"[{plain(title(root / p))}]({p})",
            code(Path(p).parent.as_posix()),
            told(about(root / p)),
        )
        for p in pages
    ]
    return (
        f"# {heading}\n\n{lead}\n\n" + table(("page", "folder", "is"), rows) + "\n" + toctree(pages)
    )
