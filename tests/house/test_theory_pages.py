"""Pages of docs/theory: what they link and name is there, and each figure is made and shown."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import ROOT

FOLDER = ROOT / "docs/theory"
PAGES = sorted(FOLDER.glob("*.md"))
HEAD = "| claim | where in the code | test that holds it |"
# Where files of the tables lie. Of two with one name the page has `folder/name.py`.
PLACES = ("src/**/*.[ch]", "src/**/*.inc", "src/**/*.py", "modelica/**/*.mo")
TESTS = ("tests/**/*.c", "tests/**/*.h", "tests/**/*.py")
FILES = {
    name: file
    for place in PLACES + TESTS
    for file in ROOT.glob(place)
    for name in (file.name, f"{file.parent.name}/{file.name}")
}
# What links these pages.
LINKING = [
    ROOT / name
    for name in (
        "DESIGN.md",
        "CONTRIBUTING.md",
        "src/motion/smooth/README.md",
        "src/motion/path/README.md",
        "src/motionfmu/analysis/explain/README.md",
        "src/motionfmu/analysis/linear/README.md",
        "src/base/pulse/README.md",
        "src/base/tasks/README.md",
        "src/devices/epcio/README.md",
        "src/devices/fpga/README.md",
        "src/devices/player/README.md",
        "src/devices/msp430/README.md",
        "src/controllers/robot_controller/README.md",
        "fmus/hydraulic_axis/README.md",
        "src/controllers/robot/README.md",
        "fmus/robot_arm/README.md",
        "src/motionfmu/identify/README.md",
        "src/motionfmu/identify/arm_dynamics/README.md",
        "src/motionfmu/calibrate/README.md",
        "src/motionfmu/analysis/measured_response/README.md",
    )
]


def heads(text: str) -> set[str]:
    """Anchors of the headings of a page, as GitHub makes them."""
    found = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in found}


def broken_links(text: str, folder: Path) -> list[str]:
    """Links and pictures of a page that lead nowhere."""
    wrong = []
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        name, _, anchor = target.partition("#")
        file = (folder / name).resolve() if name else None
        there = file is None or file.exists()
        if not there or (anchor and anchor not in heads(file.read_text() if file else text)):
            wrong.append(target)
    return wrong


def rows(text: str) -> Iterator[list[str]]:
    """Cells of the table of claims of a page."""
    for line in text.split(HEAD, 1)[1].splitlines()[2:]:
        if not line.startswith("|"):
            return
        yield [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]


def defines(file: Path, name: str) -> bool:
    """Whether a file defines a function, a class, a test or a constant; in Modelica, anything."""
    text, word = file.read_text(), re.escape(name)
    if file.suffix == ".mo":
        return re.search(rf"\b{word}\b", re.sub(r'"[^"]*"', "", text)) is not None
    if file.suffix == ".py":
        return re.search(rf"^ *(def|class) {word}\b|^{word} = ", text, re.MULTILINE) is not None
    constant = rf"^(static const|enum).*\b{word} = "
    function = rf"^[a-z][\w *]*\b{word}\("
    return re.search(rf"{constant}|{function}", text, re.MULTILINE) is not None


def missing(cell: str) -> list[str]:
    """Names in a cell whose file is not there or does not define them; each cell names some."""
    wrong, file, named = [], None, 0
    for name in re.findall(r"`([^`]+)`", cell):
        if re.search(r"\.(c|h|inc|py|mo)$", name):
            file = FILES.get(name)
            wrong += [] if file else [name]
        elif file is None or not defines(file, name):
            wrong.append(name)
        else:
            named += 1
    return wrong if named else [*wrong, f"no function in {cell!r}"]


@pytest.mark.parametrize("page", PAGES, ids=lambda f: f.name)
def test_links_lead_somewhere(page: Path) -> None:
    assert broken_links(page.read_text(), page.parent) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda f: f.name)
def test_formulas_have_characters_of_tex(page: Path) -> None:
    text = re.sub(r"\\text\{[^}]*\}", "", page.read_text())
    found = re.findall(r"\$\$.*?\$\$|\$[^$\n]+\$", text, re.DOTALL)
    assert len(found) > 20
    assert [formula for formula in found if not formula.isascii()] == []


@pytest.mark.parametrize("page", LINKING, ids=lambda f: str(f.relative_to(ROOT)))
def test_the_pages_are_linked(page: Path) -> None:
    links = [f"]({t})" for t in re.findall(r"\]\(([^)\s]*docs/theory[^)\s]*)\)", page.read_text())]
    assert links and broken_links("".join(links), page.parent) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda f: f.name)
def test_what_a_table_of_claims_names_is_there(page: Path) -> None:
    claims = list(rows(page.read_text()))
    assert len(claims) >= 10
    assert {row[0]: wrong for row in claims if (wrong := missing(row[1]) + missing(row[2]))} == {}


def test_every_figure_is_made_and_shown() -> None:
    made = {
        node.name
        for module in (FOLDER / "figures").glob("*_figures.py")
        for node in ast.parse(module.read_text()).body
        if isinstance(node, ast.FunctionDef)
        and any(ast.unparse(d) == "figure" for d in node.decorator_list)
    }
    shown = {n for page in PAGES for n in re.findall(r"!\[[^]]+\]\((\w+)\.svg\)", page.read_text())}
    assert made == shown == {file.stem for file in FOLDER.glob("*.svg")}


def test_what_is_wrong_is_told() -> None:
    assert broken_links("[a](none.md) [b](#here)\n# Here", FOLDER) == ["none.md"]
    assert broken_links("[a](speed.md#9-nothing)", FOLDER) == ["speed.md#9-nothing"]
    assert missing("`shape_join.c` `shape_join`") == []
    assert missing("`shape_join.c` `shape_jion`")[0] == "shape_jion"
    assert missing("`shape_jion.c` `shape_join`")[0] == "shape_jion.c"
    assert missing("`shape_turn.c` `SHARP` `TURN`") == []
    assert missing("`test_speed.py` `test_nothing`")[0] == "test_nothing"
    assert missing("`BallScrewAxis.mo` `nothing`")[0] == "nothing"
    assert missing("`servo_formulas.py` `nothing`")[0] == "nothing"
    assert missing("`speed_profile.c`") == ["no function in '`speed_profile.c`'"]
