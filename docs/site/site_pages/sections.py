"""The sections of the site: which page belongs to which, and the pages that are made."""

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from site_pages import (
    c_headers,
    commands,
    decisions,
    faults,
    file_keys,
    fmus,
    gallery,
    python_modules,
    speed,
    tutorials,
)
from site_pages.markdown import code, plain, table, toctree
from site_pages.staging import DECISIONS, Staged, index, rewritten, write

# By where pages stand: name, heading and first words of a section. The first that fits counts.
SECTIONS = (
    ("scenarios/", "", "", ""),
    ("fmus/", "", "", ""),
    ("src/motionfmu/machines/", "", "", ""),
    ("src/motionfmu/rigs/", "machines", "Rigs", "Parts that several scenarios share."),
    ("src/motionfmu/", "package", "Manual", "What the package does, folder by folder."),
    ("src/", "cores", "C cores", "What the FMUs compute with, free of FMI."),
    ("modelica/", "cores", "", ""),
    ("docs/tour.md", "package", "", ""),
    (
        "docs/architecture/",
        "architecture",
        "Architecture",
        "Three drawings: the parts, the package, one communication step.",
    ),
    ("docs/theory/", "theory", "Theory", "Each claim names its code and the test that holds it."),
    (
        "docs/tutorials/",
        "tutorials",
        "Tutorials",
        "One for each kind of user; each is a notebook, too.",
    ),
    ("docs/how-to/", "how_to", "How to", "One task a page."),
    (f"{DECISIONS}/", "", "", ""),
    ("docs/", "words", "Words and tools", "The glossary, and other people's importers."),
    ("examples/", "examples", "Examples", "Small projects to copy; each builds by itself."),
    ("tests/", "tests", "Tests", "How things are held, and tools beside them."),
    ("", "project", "Project", "Folders, rules of work, changes."),
)


def write_all(staged: Staged) -> None:
    """Write all pages that are made, and the names of the files that are listed."""
    _write_fmus(staged)
    _write_gallery(staged)
    _write_notebooks(staged)
    _write_decisions(staged)
    _write_indexes(staged)
    _write_reference(staged)
    here = Path(__file__).parent.parent
    front = (here / "index.md").read_text(encoding="utf-8")
    write(staged.folder / "index.md", rewritten(front, "index.md", staged))
    write(staged.folder / "listed.txt", "".join(f"{name}\n" for name in sorted(staged.listed)))


def _of(prefix: str, pages: list[str]) -> list[str]:
    """The pages of a section."""

    def place(page: str) -> str:
        return next(p for p, *_ in SECTIONS if page.startswith(p))

    return [page for page in pages if place(page) == prefix]


def _write_fmus(staged: Staged) -> None:
    from motionfmu.fmu.documentation import icon_of
    from motionfmu.scenarios import fmus as built

    names = fmus.names()
    for name in names:
        write(staged.folder / f"icons/{name}.svg", icon_of(staged.root / "fmus" / name))
        file = staged.folder / f"fmus/{name}/README.md"
        head, _, rest = file.read_text(encoding="utf-8").partition("\n")
        icon = f"![Icon of {name}](../../icons/{name}.svg)"
        tables = fmus.variables(list(built.ports(name).values()))
        write(file, f"{head}\n\n{icon}\n{rest}\n{tables}")
    text = fmus.index({name: built.about(name) for name in names})
    write(staged.folder / "fmus.md", text + "\n" + toctree(_of("fmus/", staged.pages)))


def _write_gallery(staged: Staged) -> None:
    found = gallery.cards(staged.root)
    pages = _of("scenarios/", staged.pages) + _of("src/motionfmu/machines/", staged.pages)
    write(staged.folder / "gallery.md", gallery.page(found) + "\n" + toctree(pages))
    gallery.write_pictures(found, staged.folder / "extra/pictures")


def _write_notebooks(staged: Staged) -> None:
    """Write each tutorial as a notebook, to which its page leads."""
    for page in _of("docs/tutorials/", staged.pages):
        text = (staged.root / page).read_text(encoding="utf-8")
        name = f"{Path(page).stem}.ipynb"
        write(staged.folder / "extra/notebooks" / name, tutorials.notebook(text))
        head, _, rest = (staged.folder / page).read_text(encoding="utf-8").partition("\n")
        link = f'<a href="../../notebooks/{name}" download>Take it as a notebook</a>'
        write(staged.folder / page, f"{head}\n\n{link}\n{rest}")


def _write_decisions(staged: Staged) -> None:
    made = decisions.pages_of(staged.root, _of(f"{DECISIONS}/", staged.pages))
    for name, text in made.items():
        write(staged.folder / name, text)


def _write_indexes(staged: Staged) -> None:
    for name in dict.fromkeys(n for _, n, _, _ in SECTIONS if n):
        rows = [row for row in SECTIONS if row[1] == name]
        pages = [page for prefix, *_ in rows for page in _of(prefix, staged.pages)]
        _, _, heading, lead = rows[0]
        write(staged.folder / f"{name}.md", index(heading, lead, pages, staged.root))


def _write_reference(staged: Staged) -> None:
    folder = staged.folder / "reference"
    made = dict(reference(staged.root))
    for name, text in made.items():
        write(folder / f"{name}.md", text)


def reference(root: Path) -> Iterator[tuple[str, str]]:
    """All pages of the reference by their names."""
    from motionfmu import cli

    yield "commands", commands.page(commands.commands(cli.app))
    files = {f"files/{re.sub('[. ]', '_', file.name)}": file for file in file_keys.files()}
    for name, file in files.items():
        yield name, file_keys.page(file)
    rows = [(f"[{f.name}]({name}.md)", plain(f.about)) for name, f in files.items()]
    yield "files", "# Files\n\n" + table(("file", "is"), rows) + "\n" + toctree(files)
    yield "faults", faults.page(list(faults.tables()))
    kept = (root / f"tests/bench/{name}.json" for name in ("last", "peers", "growth"))
    yield "speed", speed.page(*(json.loads(file.read_text("utf-8")) for file in kept))
    package, *modules = python_modules.modules(root / "src/motionfmu")
    for module, text in python_modules.pages(modules).items():
        yield f"python/{module}", text
    menu = toctree(f"{m.removeprefix('motionfmu.')} <python/{m}>" for m in modules)
    yield "python", python_modules.front(package, modules) + menu
    cores = {f"c/{core}": headers for core, headers in _headers(root).items()}
    for name, headers in cores.items():
        yield name, c_headers.page(name[2:], headers)
    yield (
        "c",
        "# C\n\n"
        + _links({name: name[2:] for name in cores})
        + "\n"
        + toctree(f"{name[2:]} <{name}>" for name in cores),
    )


def _links(pages: Mapping[str, str]) -> str:
    return "".join(f"- [{code(text)}]({name}.md)\n" for name, text in pages.items())


def _headers(root: Path) -> dict[str, dict[str, str]]:
    """Text of the installed headers by core and name; tables of numbers are left out."""
    installed = root / "build/include/motionfmu"
    found: dict[str, dict[str, str]] = {}
    for file in sorted(root.glob("src/*/*/core.toml")):
        names = [h.name for h in sorted(file.parent.glob("*.h")) if not h.stem.endswith("_tables")]
        there = {n: (installed / n).read_text("utf-8") for n in names if (installed / n).is_file()}
        if there:
            found[file.parent.name] = there
    return found
