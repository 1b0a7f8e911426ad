"""An SSP of others becomes a scenario, or is refused with the place."""

import io
import shutil
import sys
import tomllib
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT

import motionfmu
from motionfmu import cli
from motionfmu.base.errors import InputError
from motionfmu.export import as_ssp
from motionfmu.ssp.ssp_import import take

HEAD = """<ssd:SystemStructureDescription version="1.0" name="two" description="Two parts"
  xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription"
  xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon"
  xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues"
  xmlns:ssm="http://ssp-standard.org/SSP1/SystemStructureParameterMapping">"""
FMU = """<fmiModelDescription fmiVersion="2.0" modelName="Part" guid="1">
  <CoSimulation modelIdentifier="Part"/>
  <UnitDefinitions>
    <Unit name="m"><BaseUnit m="1"/></Unit><Unit name="mm"><BaseUnit m="1" factor="0.001"/></Unit>
    <Unit name="K"><BaseUnit K="1"/></Unit>
    <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
  </UnitDefinitions>
  <DefaultExperiment stopTime="3" stepSize="0.01"/>
  <ModelVariables>{}
  </ModelVariables>
</fmiModelDescription>"""
VARIABLES = {
    "u": ("input", '<Real unit="m"/>'),
    "v": ("input", '<Real unit="mm"/>'),
    "y": ("output", '<Real unit="m"/>'),
    "x.a[1]": ("output", "<Real/>"),
    "k": ("parameter", '<Real unit="m"/>'),
    "t": ("parameter", '<Real unit="K"/>'),
    "n": ("parameter", "<Integer/>"),
    "on": ("parameter", "<Boolean/>"),
    "s": ("parameter", "<String/>"),
}
FMU = FMU.format(
    "".join(
        f'<ScalarVariable name="{name}" valueReference="{i}" causality="{kind}">{row}'
        "</ScalarVariable>"
        for i, (name, (kind, row)) in enumerate(VARIABLES.items())
    )
)
INPUT = '<ssd:Connector name="{}" kind="input"/>'
OUTPUT = '<ssd:Connector name="{}" kind="output"/>'


def part(name: str, values: str = "", source: str = "p.fmu", **more: str) -> str:
    """A component with all its connectors."""
    about = "".join(f' {k}="{v}"' for k, v in more.items())
    connectors = INPUT.format("u") + INPUT.format("v") + OUTPUT.format("y")
    return (
        f'<ssd:Component name="{name}" source="{source}"{about}>'
        f"<ssd:Connectors>{connectors}</ssd:Connectors>{bound(values)}</ssd:Component>"
    )


def bound(values: str, mapping: str = "", attributes: str = "") -> str:
    """A parameter set of an element, inline."""
    if not values:
        return ""
    return (
        f"<ssd:ParameterBindings><ssd:ParameterBinding{attributes}><ssd:ParameterValues>"
        f'<ssv:ParameterSet version="1.0" name="p"><ssv:Parameters>{values}</ssv:Parameters>'
        '<ssv:Units><ssc:Unit name="inch"><ssc:BaseUnit m="1" factor="0.0254"/></ssc:Unit>'
        '<ssc:Unit name="degC"><ssc:BaseUnit K="1" offset="273.15"/></ssc:Unit></ssv:Units>'
        f"</ssv:ParameterSet></ssd:ParameterValues>{mapping}"
        "</ssd:ParameterBinding></ssd:ParameterBindings>"
    )


def value(name: str, kind: str, text: str, unit: str = "") -> str:
    """A parameter of a set."""
    of = f' unit="{unit}"' if unit else ""
    return f'<ssv:Parameter name="{name}"><ssv:{kind} value="{text}"{of}/></ssv:Parameter>'


def wire(start: str, end: str, inner: str = "") -> str:
    """A connection of ``element.connector``; without an element the system's own."""
    ends = []
    for key, name in (("start", start), ("end", end)):
        element, _, connector = name.rpartition(".")
        ends.append(f'{key}Element="{element}" ' if element else "")
        ends.append(f'{key}Connector="{connector}" ')
    return f"<ssd:Connection {''.join(ends)}>{inner}</ssd:Connection>"


def system(elements: str, wires: str = "", name: str = "top", own: str = "") -> str:
    """A system; `own`: its connectors and parameter sets."""
    joined = f"<ssd:Connections>{wires}</ssd:Connections>" if wires else ""
    inside = f"{own}<ssd:Elements>{elements}</ssd:Elements>{joined}"
    return f'<ssd:System name="{name}">{inside}</ssd:System>'


def packed(
    folder: Path, text: str, files: Mapping[str, bytes] | None = None, fmu: str = FMU
) -> Path:
    """An SSP with an FMU that is a description alone."""
    inner = io.BytesIO()
    with zipfile.ZipFile(inner, "w") as archive:
        archive.writestr("modelDescription.xml", fmu)
    with zipfile.ZipFile(folder / "two.ssp", "w") as archive:
        head = "" if text.startswith("<?xml") else HEAD
        archive.writestr("SystemStructure.ssd", f"{head}{text}</ssd:SystemStructureDescription>")
        for name, data in ({"p.fmu": inner.getvalue()} | dict(files or {})).items():
            archive.writestr(name, data)
    return folder / "two.ssp"


def taken(folder: Path, text: str, **more: Any) -> dict[str, Any]:
    """The tables of the scenario."""
    made = take(packed(folder, text, **more), folder / "out", 1.0, 1e-3)
    tables = tomllib.loads((folder / "out" / "scenario.toml").read_text())
    return tables | {"warnings": made.warnings}


def test_parts_wires_and_what_is_open(tmp_path: Path) -> None:
    both = part("a") + part("b-1")
    # The second wire is written from its input to its output, which the standard allows.
    found = taken(tmp_path, system(both, wire("a.y", "b-1.u") + wire("a.u", "b-1.y")))
    assert found["component"] == {"a": "resources/a.fmu", "b_1": "resources/b_1.fmu"}
    assert found["connect"] == {"b_1.u": "a.y", "a.u": "b_1.y"}
    assert found["leave"] == ["a.*", "b_1.*"] and (found["stop"], found["step"]) == (1.0, 1e-3)
    assert found["record"]["signals"] == ["a.y", "b_1.y"]
    with zipfile.ZipFile(tmp_path / "out/resources/b_1.fmu") as fmu:
        assert fmu.read("modelDescription.xml").decode() == FMU
    assert (tmp_path / "out/scenario.toml").read_text().startswith("# Two parts\n")


def test_a_wire_that_is_to_convert_no_units_is_taken(tmp_path: Path) -> None:
    plain = wire("a.y", "b.v").replace(
        "<ssd:Connection ", '<ssd:Connection suppressUnitConversion="true" '
    )
    assert taken(tmp_path, system(part("a") + part("b"), plain))["connect"] == {"b.v": "a.y"}


def test_nested_systems_become_one(tmp_path: Path) -> None:
    ports = f"<ssd:Connectors>{INPUT.format('in')}{OUTPUT.format('out')}</ssd:Connectors>"
    inner = system(part("p"), wire("in", "p.u") + wire("p.y", "out"), "inner", ports)
    outer = system(inner, wire("in", "inner.in") + wire("inner.out", "out"), "outer", ports)
    wires = wire("q.y", "outer.in") + wire("outer.out", "q.u")
    found = taken(tmp_path, system(outer + part("q"), wires))
    assert found["connect"] == {"outer_inner_p.u": "q.y", "q.u": "outer_inner_p.y"}


def test_values_in_other_units_and_of_all_types(tmp_path: Path) -> None:
    values = value("k", "Real", "2", "inch") + value("t", "Real", "20", "degC")
    values += (
        value("n", "Integer", "-3") + value("on", "Boolean", "1") + value("s", "String", "a b")
    )
    found = taken(tmp_path, system(part("a", values)))
    assert found["set"]["a.k"] == pytest.approx(0.0508, rel=1e-15)
    assert found["set"]["a.t"] == pytest.approx(293.15, rel=1e-15)
    others = {k: v for k, v in found["set"].items() if k not in ("a.k", "a.t")}
    assert others == {"a.n": -3, "a.on": True, "a.s": "a b"}


def test_values_of_the_system_are_stronger_and_find_nested_parts(tmp_path: Path) -> None:
    own = value("n", "Integer", "1") + value("on", "Boolean", "true")
    inner = system(part("p", own), "", "in", bound(value("p.n", "Integer", "4")))
    own = bound(value("in.p.n", "Integer", "2") + value("in.q.n", "Integer", "3"))
    found = taken(tmp_path, system(inner, own=own))
    assert found["set"] == {"in_p.n": 2, "in_p.on": True}
    assert found["warnings"] == ["values of no parameter and no input, left out: in.q.n"]


def test_a_value_of_a_systems_input_goes_to_all_that_it_feeds(tmp_path: Path) -> None:
    """At whatever depth the parameter set is."""
    ports = f"<ssd:Connectors>{INPUT.format('in')}</ssd:Connectors>"
    wires = wire("in", "p.u") + wire("in", "q.u")
    inner = part("p") + part("q")
    own = ports + bound(value("in", "Real", "2.5"))
    assert taken(tmp_path, system(inner, wires, own=own))["set"] == {"p.u": 2.5, "q.u": 2.5}
    shutil.rmtree(tmp_path / "out")
    outer = system(system(inner, wires, "a", ports), own=bound(value("a.in", "Real", "1.5")))
    assert taken(tmp_path, outer)["set"] == {"a_p.u": 1.5, "a_q.u": 1.5}


def test_a_file_of_values_with_a_prefix_and_a_mapping(tmp_path: Path) -> None:
    line = '<ssc:LinearTransformation factor="3" offset="1"/>'
    entry = f'<ssm:MappingEntry source="f.gain" target="k">{line}</ssm:MappingEntry>'
    mapping = f'<ssm:ParameterMapping version="1.0">{entry}</ssm:ParameterMapping>'
    mapping = f"<ssd:ParameterMapping>{mapping}</ssd:ParameterMapping>"
    binding = f'<ssd:ParameterBinding source="v.ssv" prefix="f.">{mapping}</ssd:ParameterBinding>'
    bindings = f"<ssd:ParameterBindings>{binding}</ssd:ParameterBindings>"
    component = part("a").replace("</ssd:Component>", f"{bindings}</ssd:Component>")
    values = value("gain", "Real", "2") + value("n", "Integer", "5")
    text = (
        '<ssv:ParameterSet version="1.0" name="p" xmlns:ssv='
        '"http://ssp-standard.org/SSP1/SystemStructureParameterValues">'
        f"<ssv:Parameters>{values}</ssv:Parameters></ssv:ParameterSet>"
    )
    found = taken(tmp_path, system(component), files={"v.ssv": text.encode()})
    assert found["set"] == {"a.k": 7.0}


def test_times_are_those_of_the_file_then_of_its_fmus(tmp_path: Path) -> None:
    osp = 'xmlns:osp="http://opensimulationplatform.com/SSP/OSPAnnotations"'
    step = f'<osp:Algorithm {osp}><osp:FixedStepAlgorithm baseStepSize="0.002"/></osp:Algorithm>'
    annotation = f'<ssc:Annotation type="com.opensimulationplatform">{step}</ssc:Annotation>'
    experiment = (
        '<ssd:DefaultExperiment startTime="1" stopTime="5"><ssd:Annotations>'
        f"{annotation}</ssd:Annotations></ssd:DefaultExperiment>"
    )
    (tmp_path / "a").mkdir()
    made = take(packed(tmp_path / "a", system(part("a")) + experiment), tmp_path / "a/out")
    tables = tomllib.loads((made.folder / "scenario.toml").read_text())
    assert (tables["stop"], tables["step"]) == (4.0, 0.002)
    assert made.warnings == ["it begins at 1 s; a scenario begins at 0"]
    made = take(packed(tmp_path, system(part("a"))), tmp_path / "out")
    tables = tomllib.loads((made.folder / "scenario.toml").read_text())
    assert (tables["stop"], tables["step"]) == (3.0, 0.01) and len(made.warnings) == 2
    bare = FMU.replace('<DefaultExperiment stopTime="3" stepSize="0.01"/>', "")
    with pytest.raises(InputError, match="neither it nor an FMU says how long: --stop, --step"):
        take(packed(tmp_path, system(part("a")), fmu=bare), tmp_path / "none")


LINEAR = '<ssc:LinearTransformation factor="2" offset="0"/>'
WRONG = [
    (system(part("a", source="q.fmu")), "a: there is no q.fmu in it"),
    (system(part("a", source="http://x/p.fmu")), "a: http://x/p.fmu is not inside the SSP"),
    (system(part("a", type="application/x-ssp-package")), "a: application/x-ssp-package is no FMU"),
    (system(part("a", implementation="ModelExchange")), "a: ModelExchange is not run here"),
    (system(part("a") + part("b"), wire("a.y", "b.z")), "connection: no connector b.z"),
    (
        system(part("a") + part("b"), wire("a.y", "b.y")),
        "connection of a.y and b.y: both give a value",
    ),
    (system(part("a") + part("b"), wire("a.u", "b.u")), "a.u and b.u: none gives a value"),
    (system(part("a") + part("b"), wire("a.y", "b.u", LINEAR)), "a.y and b.u: factor 2, offset 0"),
    (
        system(part("a") + part("b"), wire("a.y", "b.v")),
        "b.v: m and mm: a wire here converts",
    ),
    (system(part("a") + part("a")), "two elements 'a', or one without a name"),
    (system(part("a", value("k", "Real", "1", "degC"))), "a.k = '1': units of two dimensions"),
    (system(part("a", value("n", "Real", "1.5"))), "a.n = '1.5': invalid literal"),
    (system(part("a", value("on", "String", "yes"))), "a.on = 'yes': Boolean wanted"),
    (
        system('<ssd:SignalDictionaryReference name="d" dictionary="x"/>'),
        "d: signal dictionaries",
    ),
    ("<ssd:Units/>", "it has no system"),
    (system(part("a")) + "<", "SystemStructure.ssd: "),
]


@pytest.mark.parametrize(("text", "told"), WRONG, ids=[told for _, told in WRONG])
def test_what_cannot_be_taken_over_is_refused(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(InputError) as error:
        taken(tmp_path, text)
    assert str(error.value).startswith(f"{tmp_path / 'two.ssp'}: ") and told in str(error.value)
    assert [p.name for p in tmp_path.iterdir()] == ["two.ssp"]


def test_fmus_that_are_not_for_us(tmp_path: Path) -> None:
    old = FMU.replace('fmiVersion="2.0"', 'fmiVersion="1.0"')
    with pytest.raises(InputError, match=r"a: p.fmu is FMI 1.0; 2.0 or 3.0 wanted"):
        taken(tmp_path, system(part("a")), fmu=old)
    exchange = FMU.replace("CoSimulation", "ModelExchange")
    with pytest.raises(InputError, match=r"a: p.fmu is not for co-simulation"):
        taken(tmp_path, system(part("a")), fmu=exchange)
    (tmp_path / "two.ssp").write_bytes(b"no archive")
    with pytest.raises(InputError, match=r"two.ssp: not a readable SSP"):
        take(tmp_path / "two.ssp", tmp_path / "out")
    with pytest.raises(InputError, match=r"it is there already"):
        take(tmp_path / "two.ssp", tmp_path)


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_exported_scenario_comes_back(fmi: int, tmp_path: Path) -> None:
    demo = motionfmu.load(ROOT / "scenarios/circle")
    written = as_ssp(demo, tmp_path / "c.ssp", fmi, {})
    made = take(tmp_path / "c.ssp", tmp_path / "back")
    assert (made.components, made.wires, made.warnings) == (4, written.connections, [])
    tables = tomllib.loads((tmp_path / "back/scenario.toml").read_text())
    body = demo.document.body
    assert (tables["stop"], tables["step"]) == (body.stop, body.step)
    assert tables["set"]["mcc.program"] == "resource:circle.ngc"
    if fmi == 3:
        assert tables["connect"]["card.enc_phase"] == "machine.motor_phase"
        assert tables["set"]["mcc.active"] == body.set["mcc.active"]
    else:
        assert tables["connect"]["card.enc_phase[6]"] == "machine.motor_phase[6]"


@pytest.mark.parametrize("fmi", [2, 3])
def test_driven_inputs_come_back_as_such(fmi: int, tmp_path: Path) -> None:
    given = motionfmu.load(ROOT / "scenarios/hydraulic_positioning")
    as_ssp(given, tmp_path / "c.ssp", fmi, {})
    assert take(tmp_path / "c.ssp", tmp_path / "back").components == 2
    tables = tomllib.loads((tmp_path / "back/scenario.toml").read_text())
    found = {d["input"]: dict(zip(d["at"], d["value"], strict=True)) for d in tables["drive"]}
    for drive in given.document.body.drive:
        wanted = dict(zip(drive.at, drive.value, strict=True))
        assert {0.0: found[drive.input][0.0]} | wanted == found[drive.input]
        assert not found[drive.input][0.0] or 0.0 in drive.at
    assert not [name for name in tables["connect"] if name in found]


def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    packed(tmp_path, system(part("a") + part("b"), wire("a.y", "b.u")))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["motionfmu", "import", "two.ssp", "--step", "0.001"])
    cli.main()
    said = capsys.readouterr().out
    assert said.startswith("two/scenario.toml: 2 components, 1 wires, 0 values\n")
    assert "warning stop = 3 s is that of its FMUs: it has none" in said
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 2 and "two: it is there already" in capsys.readouterr().err
