"""What tools of others show: pages, icons, licences, units, meanings of numbers, terminals."""

import io
import json
import re
import zipfile
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from fmi_tools import unpacked
from fmpy import read_model_description
from lxml import etree
from PIL import Image

import motionfmu
from motionfmu.base import units
from motionfmu.export.system_fmu import as_fmu as export
from motionfmu.fmu.documentation import icon_of, joined, page, png
from motionfmu.fmu.fmu_toml import parse
from motionfmu.fmu.modeldescription import model_description
from motionfmu.scenarios.fmus import fmu_names, fmu_path, ports, terminals_of

every_fmu = pytest.mark.parametrize("name", fmu_names())
both = pytest.mark.parametrize("fmi", (2, 3))
SCHEMA = Path(motionfmu.__file__).parents[2]


def member(name: str, fmi: int, file: str) -> bytes:
    with zipfile.ZipFile(fmu_path(name, fmi)) as archive:
        return archive.read(file)


def root_of(name: str, fmi: int) -> Any:
    return etree.fromstring(member(name, fmi, "modelDescription.xml"))


class Page(HTMLParser):
    """Text of a page, its addresses, and whether each element is closed."""

    EMPTY = frozenset(("meta", "br", "hr", "img", "rect", "circle", "path"))

    def __init__(self, text: str) -> None:
        super().__init__()
        self.words: list[str] = []
        self.open: list[str] = []
        self.links: list[str] = []
        self.places: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.links += [x for k in ("href", "src") if (x := given.get(k))]
        self.places += [x for x in (given.get("id"),) if x]
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.EMPTY:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)


@both
@every_fmu
def test_a_page_tells_the_readme_and_every_variable(name: str, fmi: int) -> None:
    text = member(name, fmi, "documentation/index.html").decode()
    found = Page(text)
    assert found.open == []
    # It stands alone: the licence beside it, places in it, and addresses of others.
    assert {x for x in found.links if not x.startswith(("http", "#"))} == {"licenses/license.txt"}
    assert {x[1:] for x in found.links if x.startswith("#")} <= set(found.places)
    words = " ".join(" ".join(found.words).split())
    for port in ports(name).values():
        assert f"{port.name} " in words
        assert " ".join(port.doc.split()) in words
    readme = (ROOT / "fmus" / name / "README.md").read_text()
    bold = re.findall(r"\*\*(.+?)\*\*", readme)
    assert all(re.sub(r"[`*\[].*", "", x).strip() in words for x in bold)
    assert "](" not in words and "**" not in words


@both
@every_fmu
def test_whose_it_is_stands_in_it(name: str, fmi: int) -> None:
    root = root_of(name, fmi)
    licence = (ROOT / "LICENSE").read_text()
    text = member(name, fmi, "documentation/licenses/license.txt").decode()
    assert text.startswith(licence.rstrip()) and "2-Clause BSD" in text
    holder = re.search(r"Copyright \(c\) (\d+ .+)", licence)
    assert holder and root.get("copyright") == f"© {holder[1]}"
    assert root.get("author") == holder[1].partition(" ")[2]
    assert (root.get("license"), root.get("generationTool")) == ("MIT", "motionfmu")
    assert f'version = "{root.get("version")}"' in (ROOT / "pyproject.toml").read_text()
    assert root.get("generationDateAndTime") is None  # equal sources give equal bytes


def test_a_date_is_the_one_of_the_sources(monkeypatch: pytest.MonkeyPatch) -> None:
    d = parse((ROOT / "fmus/scope/fmu.toml").read_text())
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    for fmi in (2, 3):
        assert b'generationDateAndTime="2023-11-14T22:13:20Z"' in model_description(d, fmi)


@every_fmu
def test_its_icon_is_drawn_in_both_forms(name: str) -> None:
    drawn = member(name, 3, "terminalsAndIcons/icon.svg")
    assert drawn.decode() == icon_of(ROOT / "fmus" / name)
    for picture in (member(name, 3, "terminalsAndIcons/icon.png"), member(name, 2, "model.png")):
        image = Image.open(io.BytesIO(picture))
        assert image.size == (400, 400)
        # Still a picture where a list shows it small.
        small = np.asarray(image.convert("L").resize((32, 32), Image.Resampling.BOX))
        assert small.std() > 20 and (small < 120).sum() > 40


def test_all_icons_differ() -> None:
    """Those that have one of their own."""
    own = [name for name in fmu_names() if (ROOT / "fmus" / name / "icon.svg").is_file()]
    assert len({member(name, 2, "model.png") for name in own}) == len(own) > 15


def test_pictures_and_joined_drawings_are_the_same_bytes_again() -> None:
    drawn = [file.read_text() for file in sorted(ROOT.glob("fmus/*/icon.svg"))[:5]]
    assert joined([drawn[0]] * 3) == drawn[0]
    assert png(joined(drawn)) == png(joined(drawn)) == png(joined(drawn[:4])) != png(drawn[0])


def schema(file: str) -> etree.XMLSchema:
    import fmpy

    folder = Path(fmpy.__file__).parent / "schema/fmi3"
    return etree.XMLSchema(etree.parse(folder / file))


@every_fmu
def test_terminals_keep_to_the_schema_and_to_the_variables(name: str) -> None:
    xml = member(name, 3, "terminalsAndIcons/terminalsAndIcons.xml")
    assert schema("fmi3TerminalsAndIcons.xsd").validate(etree.fromstring(xml))
    for terminal in terminals_of(name):
        members, variables = zip(*terminal.members, strict=True)
        assert len(set(members)) == len(members)
        assert {ports(name)[v].causality for v in variables} <= {"input", "output"}
    root = etree.fromstring(xml)
    kinds = root.xpath("//Terminal/@terminalKind")
    assert all(kind.startswith("org.motionfmu.") for kind in kinds)


def pairs() -> list[tuple[str, str, str, str]]:
    """Terminals of one kind, of two FMUs."""
    ends = [(n, t.name, t.kind) for n in fmu_names() for t in terminals_of(n)]
    return [
        (a, s, b, t)
        for a, s, kind in ends
        for b, t, other in ends
        if kind == other and (a, s) < (b, t)
    ]


def wires(a: str, s: str, b: str, t: str) -> dict[str, tuple[Any, Any]]:
    one = next(x for x in terminals_of(a) if x.name == s)
    two = next(x for x in terminals_of(b) if x.name == t)
    left = {m: ports(a)[v] for m, v in one.members}
    right = {m: ports(b)[v] for m, v in two.members}
    if one.every and two.every:
        assert set(left) == set(right), (a, s, b, t)
    return {m: (left[m], right[m]) for m in left.keys() & right.keys()}


def test_what_goes_together_has_types_shapes_units_and_directions_that_do() -> None:
    connected = 0
    for a, s, b, t in pairs():
        found = wires(a, s, b, t)
        ways = {(x.causality, y.causality) for x, y in found.values()}
        for x, y in found.values():
            assert x.type == y.type and units.convertible(x.unit, y.unit), (a, x.name, b, y.name)
            assert x.shape == y.shape or {a, b} & {"msp430_positioner", "hydraulic_axis"}
        # Two of the same side, two cards or two plants, do not go together, but no wire is wrong.
        connected += ways <= {("input", "output"), ("output", "input")}
    assert connected >= 14


def test_terminals_are_the_bundles_that_scenarios_connect() -> None:
    """Joined by their terminals, the demo's FMUs have the wires that its scenario lists."""
    system = motionfmu.load(ROOT / "scenarios/circle").resolved(motionfmu.run.run_plan.Options())
    fmu = system.components
    listed = {
        frozenset((f"{fmu[e.component]}.{e.port.name}") for e in (w.source, w.target))
        for w in system.wires
        if "scope" not in (fmu[w.source.component], fmu[w.target.component])
    }
    made = set()
    chosen = [("epcio", "host", "mcc", "card"), ("epcio", "voltages", "servo_drives", "voltages")]
    chosen += [("ball_screw_axes", "motors", "servo_drives", "motors")]
    chosen += [("ball_screw_axes", "encoders", "epcio", "encoders")]
    assert set(chosen) <= set(pairs())
    for a, s, b, t in chosen:
        for x, y in wires(a, s, b, t).values():
            made.add(frozenset((f"{a}.{x.name}", f"{b}.{y.name}")))
    assert made == listed


def factor(unit: Any) -> float:
    return float(unit.find("BaseUnit").get("factor", 1.0))


@both
@every_fmu
def test_units_are_shown_as_users_count(name: str, fmi: int) -> None:
    root = root_of(name, fmi)
    shown = {
        (unit.get("name"), d.get("name")): float(d.get("factor"))
        for unit in root.iterfind("UnitDefinitions/Unit")
        for d in unit.iterfind("DisplayUnit")
    }
    known = {("m", "mm"): 1e3, ("rad", "deg"): 180 / np.pi, ("rad/s", "rpm"): 30 / np.pi}
    known |= {("s", "ms"): 1e3, ("Pa", "bar"): 1e-5, ("m/s", "mm/s"): 1e3, ("m3/s", "L/min"): 6e4}
    assert shown.keys() <= known.keys()
    assert all(np.isclose(x, known[key], rtol=1e-15) for key, x in shown.items())
    rows = list(root.iterfind("ModelVariables//*[@unit]"))
    asked = {(row.get("unit"), row.get("displayUnit")) for row in rows}
    assert {pair for pair in asked if pair[1]} == shown.keys()
    assert not {unit for unit, other in asked if other is None} & {unit for unit, _ in known}


@both
@every_fmu
def test_nominal_values_stand_where_a_size_is_far_from_one(name: str, fmi: int) -> None:
    for row in root_of(name, fmi).iterfind("ModelVariables//*[@unit]"):
        if row.get("unit") in ("m", "mm", "rpm", "Pa", "s", "N/m"):
            assert 0.0 < float(row.get("nominal")) != 1.0


@both
@every_fmu
def test_every_number_that_means_something_says_what(name: str, fmi: int) -> None:
    root = root_of(name, fmi)
    types = {row.get("name"): row for row in root.iterfind("TypeDefinitions/*")}
    for row in root.iterfind("ModelVariables//*[@declaredType]"):
        declared = types[row.get("declaredType")]
        about = row if fmi == 3 else row.getparent()
        assert row.tag in ("Int32", "Integer", "String")
        if row.tag != "String":
            assert about.get("description").endswith(": " + declared.get("description"))
    for row in root.find("ModelVariables"):
        whole = row if fmi == 3 else row[0]
        if whole.tag in ("Int32", "Integer") and MODES.search(row.get("name")):
            assert whole.get("declaredType") or "see README" in row.get("description"), row.attrib


MODES = re.compile(r"(^|_)(mode|format|edge|status|state|stage|law|task|module|upload)(\[.*)?$")


@both
def test_types_of_files_and_numbers(fmi: int) -> None:
    root = root_of("mcc", fmi)
    types = {row.get("name"): row.get("description") for row in root.find("TypeDefinitions")}
    assert "resource:NAME" in types["InputFile"] and "file:///PATH" in types["OutputFile"]
    assert types["Error"].startswith("0 none, 61698 emergency stop")
    assert {p.name for p in ports("mcc").values() if p.file == "read"} == {
        "program", "comp_file", "tool_table", "begin_state"
    }  # fmt: skip
    assert [p.name for p in ports("mcc").values() if p.file == "written"] == [
        "path_file",
        "plan_file",
    ]


@every_fmu
def test_the_internal_step_is_stated(name: str) -> None:
    folder, header = Path(unpacked(name, 3)[1]), member(name, 3, "sources/vars.h").decode()
    grid = json.loads((folder / "extra/org.motionfmu/grid.json").read_text())["grid"]
    tick = re.search(r"FMU_TICK_NS (\d+)", header)
    assert tick
    wanted = float(ports(name)[grid].start or 0) if grid else int(tick[1]) * 1e-9
    assert float(root_of(name, 3).find("CoSimulation").get("fixedInternalStepSize")) == wanted
    tool = root_of(name, 2).find("VendorAnnotations/Tool")
    assert tool.get("name") == "org.motionfmu"
    assert float(tool.find("FixedInternalStepSize").get("seconds")) == wanted


@pytest.fixture(scope="module", params=[2, 3])
def system(request: Any, tmp_path_factory: pytest.TempPathFactory) -> tuple[int, Path]:
    file = tmp_path_factory.mktemp("system") / "circle.fmu"
    export(motionfmu.load(ROOT / "scenarios/circle"), file, request.param, {})
    return request.param, file


def test_an_exported_system_shows_the_same(system: tuple[int, Path]) -> None:
    fmi, file = system
    with zipfile.ZipFile(file) as archive:
        names = set(archive.namelist())
        text = archive.read("documentation/index.html").decode()
        root = etree.fromstring(archive.read("modelDescription.xml"))
        assert b"MIT License" in archive.read("documentation/licenses/license.txt")
        if fmi == 3:
            xml = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
            assert schema("fmi3TerminalsAndIcons.xsd").validate(xml)
            assert {"terminalsAndIcons/icon.svg", "terminalsAndIcons/icon.png"} <= names
        else:
            assert "model.png" in names
    assert Page(text).open == [] and "machine.table_position" in text
    types = {row.get("name") for row in root.find("TypeDefinitions")}
    assert {"InputFile", "mcc.HomeMode", "drives.Mode"} <= types
    assert root.get("license") == "MIT" and not [n for n in names if n.startswith("extra/")]
    assert not names & {"variables.html", "terminals.xml"}
    read_model_description(str(file), validate=True)


def test_words_of_a_readme_are_safe_in_a_page() -> None:
    text = "# Title\n\nA [link](../other) and [one](https://x.org), <b>no</b> ![pic](a.png) a < b\n"
    made = page("T & U", "x < y", text, "", "<svg></svg>")
    assert "A link and" in made and 'href="https://x.org"' in made and "../other" not in made
    assert "&lt;b&gt;no&lt;/b&gt; (pic) a &lt; b" in made and "T &amp; U" in made
    assert "x &lt; y" in made and "<h1>Title" not in made
