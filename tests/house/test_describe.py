"""The description of an FMU and what is generated from it."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from conftest import FMUS, ROOT
from few_cases import few
from fmpy import read_model_description

from motionfmu.base import units
from motionfmu.base.platforms import here
from motionfmu.fmu import ctables, fmu_toml, pack
from motionfmu.fmu.describe import Description
from motionfmu.fmu.modeldescription import model_description

NAMES = sorted(p.parent.name for p in ROOT.glob("fmus/*/fmu.toml"))
HEAD = 'name="A"\ndescription="a"\ntick_ns=25\nexperiment={stop=1.0,step=1e-3}\ncores=[]\n'
WIRE = '[input]\nx={type="f64",start=0.0,doc="d"}\n'
JOIN = f'{WIRE}[terminal.a]\nkind="k"\ndoc="d"\n'


def wrong(rows: str) -> str:
    with pytest.raises(ValueError) as caught:
        fmu_toml.parse(HEAD + rows, "a/fmu.toml")
    return str(caught.value)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ('[input]\nx={type="f64", doc="d"}', "a/fmu.toml:7: input x: start is missing"),
        (
            '[input]\nx={type="f32", start=0.0, doc="d"}',
            "a/fmu.toml:7: input x: type 'f32' is not one of f64, i32, bool, string",
        ),
        ('[input]\nx={type="i32", start=0.5, doc="d"}', "start 0.5 is not of type i32"),
        ('[input]\nx={type="i32", start=true, doc="d"}', "start True is not of type i32"),
        ('[input]\nx={type="f64", start=nan, doc="d"}', "start nan is outside -inf .. inf"),
        ('[parameter]\nx={type="f64", start=3.0, max=2.0, doc="d"}', "start 3.0 is outside"),
        ('[input]\nx={type="f64", start=0.0}', "doc is missing"),
        ('[input]\nX={type="f64", start=0.0, doc="d"}', "a name is snake_case"),
        ('[input]\nx={type="f64", start=0.0, unit="furlong", doc="d"}', 'unknown symbol "furlong"'),
        ('[input]\nx={type="bool", start=true, unit="m", doc="d"}', "unit 'm' on type bool"),
        ('[input]\nx={type="f64", dims=[3], start=[0.0, 1.0], doc="d"}', "2 values for 3 elements"),
        ('[output]\nx={type="f64", start=0.0, doc="d"}', "it is calculated and has no start"),
        ('[output]\nx={type="f64", dox="d"}', "unknown key 'dox'"),
        ('[input]\nx={type="f64",start=0.0,doc="d"}\n[output]\nx={type="f64",doc="d"}', "twice"),
        ('[input]\nx={type="i32",start=0,values=["a"],max=1,doc="d"}', "in place of min and max"),
        ('[input]\nx={type="f64",start=0.0,values=["a"],doc="d"}', "values are those of an i32"),
        (
            '[input]\nx={type="i32",start=0,values={a="b"},doc="d"}',
            "a list from 0 on or by numbers",
        ),
        ('[input]\nx={type="i32",start=0,values=[""],doc="d"}', "a list from 0 on or by numbers"),
        ('[input]\nx={type="i32",start=2,values=["a","b"],doc="d"}', "start 2 is outside 0 .. 1"),
        ('[input]\nx={type="i32",start=0,file="read",doc="d"}', "a string is read or written"),
        ('[parameter]\nx={type="string",start="",file="r",doc="d"}', "file 'r' on type string"),
        (f'{WIRE}[terminal.a]\nkind="k"\nmembers={{x="x"}}', "a/fmu.toml:8: terminal a: a table"),
        (f'{JOIN}members={{x="y"}}', "terminal a: x = 'y': no such input or output"),
        (f'{JOIN}members={{"*"="x"}}', "terminal a: * = 'x': one * on both sides"),
        (f"{JOIN}members={{}}", "members {}: variables by names wanted"),
        (f'{JOIN}member={{x="x"}}', "unknown key 'member'; did you mean 'members'?"),
        ("terminal=1", "terminal 1 is no table"),
        ("colour=1", "a/fmu.toml:6: unknown key 'colour'"),
        ("x ==", "a/fmu.toml:6: "),
    ],
)
def test_a_wrong_description_names_the_line_and_the_value(rows: str, message: str) -> None:
    assert message in wrong(rows)


def test_all_that_is_wrong_with_a_description_is_told_at_once() -> None:
    text = HEAD.replace("tick_ns=25", 'tick_sn=25\ngrid="periode"').replace('"A"', '"a"')
    text += '[paramter]\n[parameter]\nperiod={type="f64", strat=1.0, min="0"}\n'
    text += (
        '[input]\nx={type="i23", dox="d", start=0}\ny={type="i32", start=0, dims=[0], doc="d"}\n'
    )
    with pytest.raises(ValueError) as caught:
        fmu_toml.parse(text, "fmu.toml")
    told = [line.removeprefix("fmu.toml:") for line in str(caught.value).splitlines()]
    starts = ("1: name 'a' is not CamelCase", "3: unknown key 'tick_sn'; did you mean 'tick_ns'?",
              "4: grid 'periode': the name of a parameter of type f64 wanted; did you mean 'period",
              "7: unknown key 'paramter'; did you mean 'parameter'?",
              "9: parameter period: unknown key 'strat'; did you mean 'start'?",
              "9: parameter period: doc is missing", "9: parameter period: min '0' is not of type",
              "11: input x: unknown key 'dox'; did you mean 'doc'?",
              "11: input x: type 'i23' is not one of f64, i32, bool, string; did you mean 'i32'?",
              "12: input y: dims [0]: one or two")  # fmt: skip
    for line, start in zip(told, starts, strict=True):
        assert line.startswith(start), line


def test_a_wrong_file_stops_the_build_with_status_2_and_writes_nothing(tmp_path: Path) -> None:
    (tmp_path / "fmu.toml").write_text(HEAD + '[input]\nx={type="f64", start=true, doc="d"}')
    command = [sys.executable, "-m", "motionfmu.fmu.pack", "generate", tmp_path, tmp_path / "out"]
    run = subprocess.run(command, capture_output=True, text=True, cwd=ROOT / "src")
    assert run.returncode == 2
    assert run.stderr == f"{tmp_path}/fmu.toml:7: input x: start True is not of type f64\n"
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("name", "factor", "exponents"),
    [
        ("m", 1.0, {"m": 1}),
        ("mm/min", 1e-3 / 60.0, {"m": 1, "s": -1}),
        ("N.m.s/rad", 1.0, {"kg": 1, "m": 2, "s": -1, "rad": -1}),
        ("kg.m2", 1.0, {"kg": 1, "m": 2}),
        ("1/s", 1.0, {"s": -1}),
        ("rpm/V", 0.10471975511965977, {"kg": -1, "m": -2, "s": 2, "A": 1, "rad": 1}),
    ],
)
def test_units_are_products_of_base_units(name: str, factor: float, exponents: dict) -> None:
    unit = units.parse(name)
    assert unit.factor == pytest.approx(factor, rel=1e-15)
    assert dict(zip(units.BASE, unit.exponents, strict=True)) == {
        **dict.fromkeys(units.BASE, 0),
        **exponents,
    }


def test_only_equal_units_share_a_wire() -> None:
    assert units.convertible("N.m", "kg.m2/s2")
    assert units.convertible(None, "1")
    assert not units.convertible("mm", "m")
    assert not units.convertible("V", None)


@pytest.mark.parametrize("name", few(NAMES[::-1], 1))
def test_the_fmu_says_what_the_description_says(name: str) -> None:
    d = fmu_toml.load(ROOT / "fmus" / name / "fmu.toml")  # takes seconds of a Modelica class
    for fmi in (2, 3):
        says_what_it_should(d, name, fmi)


def says_what_it_should(d: Description, name: str, fmi: int) -> None:
    md = read_model_description(str(FMUS / f"{name}.fmi{fmi}.fmu"), validate=False)
    assert (md.guid if fmi == 2 else md.instantiationToken) == d.token
    found = {v.name: v for v in md.modelVariables}
    found.pop("time", None)
    expected = {
        element: (v, None if v.start is None else v.start[i], ref + i)
        for v, ref in zip(d.variables, d.references(), strict=True)
        for i, element in enumerate(v.element_names() if fmi == 2 else [v.name])
    }
    assert set(found) == set(expected)
    for key, (v, start, ref) in expected.items():
        x = found[key]
        assert (x.valueReference, x.causality, x.variability) == (ref, v.causality, v.variability)
        assert (x.unit, x.description) == (v.unit, v.doc)
        limits = [None if t is None else float(t) for t in (x.min, x.max)]
        assert limits == [None if t is None else float(t) for t in (v.min, v.max)]
        if fmi == 3:
            assert x.shape == v.dims or not v.dims
        if start is None or v.type == "string":
            continue
        read = {"f64": float, "i32": int, "bool": lambda t: t == "true"}[v.type]
        if fmi == 2:
            assert read(x.start) == start
        else:
            got = x.start if isinstance(x.start, list) else x.start.split()
            assert [read(t) for t in got] == v.start


def test_the_token_changes_with_anything_in_the_description() -> None:
    a = fmu_toml.parse(HEAD + '[output]\nx={type="f64", doc="d"}')
    b = fmu_toml.parse(HEAD + '[output]\nx={type="f64", doc="e"}')
    assert re.fullmatch(r"\{[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}\}", a.token)
    assert a.token != b.token
    assert a.token == fmu_toml.parse("# note\n" + HEAD + '[output]\nx={type="f64", doc="d"}').token


def test_arrays_become_scalars_with_structured_names_in_fmi_2() -> None:
    d = fmu_toml.parse(HEAD + '[input]\nx={type="i32", dims=[2,3], start=[1,2,3,4,5,6], doc="d"}')
    two, three = model_description(d, 2).decode(), model_description(d, 3).decode()
    assert [f'name="x[{i},{j}]"' in two for i in (1, 2) for j in (1, 2, 3)] == [True] * 6
    assert 'start="1 2 3 4 5 6"' in three and three.count("<Dimension") == 2
    assert ".x = {{1, 2, 3}, {4, 5, 6}}," in ctables.table(d)
    assert "int32_t x[2][3];" in ctables.header(d)


@pytest.mark.parametrize("fmi", [2, 3])
def test_equal_input_packs_equal_bytes(fmi: int, tmp_path: Path) -> None:
    source = FMUS / f"scope.fmi{fmi}.fmu"
    with zipfile.ZipFile(source) as z:
        library = next(n for n in z.namelist() if n.startswith("binaries/"))
        (tmp_path / "scope.so").write_bytes(z.read(library))
    compiled = pack.CompilerOutput({here(): tmp_path / "scope.so"}, ROOT / "build/parts/scope.o")
    pack.generate(ROOT / "fmus/scope", tmp_path / "gen")
    target = tmp_path / "again.fmu"
    pack.archive(ROOT / "fmus/scope", tmp_path / "gen", fmi, compiled, target)
    assert target.read_bytes() == source.read_bytes()
