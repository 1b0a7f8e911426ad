"""FMUs of other people in scenarios: both engines, theory, and why some cannot run."""

import ctypes
import subprocess
import zipfile
from pathlib import Path
from typing import Any

import foreign_fmus
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import motionfmu
from motionfmu.base import binding
from motionfmu.base.errors import InputError
from motionfmu.base.platforms import here
from motionfmu.export import as_ssp
from motionfmu.report import result_folder
from motionfmu.run.session import Session
from motionfmu.ssp.ssp_import import take
from motionfmu.study import study_columns

ENGINES = ("python", "native", "fmpy")
KINDS = {"ball": 2, "van_der_pol": 3, "feedthrough": 2}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all of them."""
    place = tmp_path_factory.mktemp("foreign")
    for name, fmi in KINDS.items():
        foreign_fmus.built(name, fmi, place)
    return place


def _made(folder: Path, tables: dict[str, Any]) -> motionfmu.Scenario:
    return motionfmu.scenario({"step": 1e-3, **tables}, folder=folder)


def _heights(times: np.ndarray, g: float = 9.81, e: float = 0.7, h: float = 1.0) -> np.ndarray:
    """The ball's height by the textbook: parabolas between bounces at known times."""
    hits = [np.sqrt(2 * h / g)]
    speeds = [e * np.sqrt(2 * g * h)]
    while hits[-1] < times[-1]:
        hits.append(hits[-1] + 2 * speeds[-1] / g)
        speeds.append(e * speeds[-1])
    n = np.searchsorted(hits, times, side="right")
    t = times - np.concatenate([[0.0], hits])[n]
    start = np.where(n == 0, h, 0.0)
    return start + np.concatenate([[0.0], speeds])[n] * t - 0.5 * g * t**2


@pytest.mark.parametrize("engine", ENGINES)
def test_a_ball_bounces_as_the_textbook_says(folder: Path, engine: str) -> None:
    tables = {"stop": 2.0, "component": {"b": "ball.fmu"}, "leave": ["b.ball.lift"]}
    ran = _made(folder, {**tables, "record": {"signals": ["b.*"]}}).run(engine=engine)
    theory = _heights(ran.time)
    assert np.abs(ran["b.ball.pos[2]"] - theory).max() < 1e-11
    assert ran["b.n bounces"][-1] == 4
    assert set(ran["b.ball.phase"]) == {1, 2}
    # Where the ball rises its speed is that of energy: v^2 = v0^2 - 2 g h.
    first = ran["b.n bounces"] == 1
    v0 = 0.7 * np.sqrt(2 * 9.81)
    left = ran["b.der(ball.pos[2])"][first] ** 2 - (v0**2 - 2 * 9.81 * theory[first])
    assert np.abs(left).max() < 1e-11


@pytest.mark.parametrize("engine", ENGINES)
def test_values_reach_a_foreign_fmu(folder: Path, engine: str) -> None:
    given = {"b.ball.material.e": 0.5, "b.world.g": -1.62, "b.ball.lift": 0.12}
    tables = {"stop": 3.0, "component": {"b": "ball.fmu"}, "set": given}
    ran = _made(folder, {**tables, "record": {"signals": ["b.ball.pos[2]"]}}).run(engine=engine)
    assert np.abs(ran["b.ball.pos[2]"] - _heights(ran.time, g=1.5, e=0.5)).max() < 1e-11


@pytest.mark.parametrize("engine", ENGINES)
def test_van_der_pol_is_its_equation(folder: Path, engine: str) -> None:
    tables = {"stop": 10.0, "component": {"osc": "van_der_pol.fmu"}, "set": {"osc.mu": 2.0}}
    ran = _made(folder, {**tables, "record": {"signals": ["osc.*"]}}).run(engine=engine)
    solved = solve_ivp(
        lambda t, x: (x[1], 2.0 * (1 - x[0] ** 2) * x[1] - x[0]),
        (0.0, 10.0), (2.0, 0.0), "DOP853", t_eval=ran.time, rtol=1e-12, atol=1e-13,
    )  # fmt: skip
    assert np.abs(ran["osc.x[1]"] - solved.y[0]).max() < 1e-9
    assert np.ptp(ran["osc.x[1]"]) > 4.0
    assert "osc.x.short" not in ran.signals  # of single precision: no channel records it


LOOP = {
    "stop": 0.5,
    "component": {"axes": "velocity_axes", "through": "feedthrough.fmu", "ball": "ball.fmu"},
    "connect": {
        "through.in[1]": "axes.motor_angle[2]",
        "axes.voltage[1]": "through.out[1]",
        "through.in[2]": "ball.ball.pos[2]",
        "through.whole.in": "ball.n bounces",
        "through.choice.in": "ball.ball.phase",
    },
    "set": {"axes.voltage": [0.0, 1.0, 0.0, 0.0, 0.0, 0.0], "ball.world.g": -200.0},
    "leave": ["through.flag.in", "ball.ball.lift"],
    "record": {"signals": ["axes.motor_angle", "through.*", "ball.*"]},
}


@pytest.mark.parametrize("engine", ENGINES)
def test_elements_of_ours_go_through_foreign_scalars(folder: Path, engine: str) -> None:
    """Axis 2 turns at a constant speed w; its angle is the voltage of axis 1, which sums it up.

    The voltage of step k is the angle that the feedthrough was given at k - 1.
    """
    ran = _made(folder, LOOP).run(engine=engine)
    w, step = 300.0 * 2 * np.pi / 60, 1e-3
    angles = ran["axes.motor_angle"]
    assert np.abs(angles[:, 1] - w * ran.time).max() < 1e-12 * w * 500
    assert (ran["through.out[1]"][1:] == angles[:-1, 1]).all()
    k = np.arange(len(ran.time))
    theory = w * w * step**2 * np.maximum(k - 1, 0) * np.maximum(k - 2, 0) / 2
    assert np.abs(angles[:, 0] - theory).max() < 1e-9
    assert angles[-1, 0] > 1.0
    assert (ran["through.whole.out"][1:] == ran["ball.n bounces"][:-1]).all()
    assert ran["ball.n bounces"][-1] >= 4
    assert (ran["through.choice.out"][1:] == ran["ball.ball.phase"][:-1]).all()
    assert not angles[:, 2:].any()


def test_all_engines_give_the_same_bits(folder: Path) -> None:
    a, *others = (_made(folder, LOOP).run(engine=engine) for engine in ENGINES)
    for b in others:
        assert sorted(a.signals) == sorted(b.signals)
        for name in a.signals:
            assert np.array_equal(a[name], b[name]), name


def test_nothing_named_runs_natively(folder: Path) -> None:
    scenario = _made(folder, LOOP)
    ran = scenario.run(stop=0.01)
    assert ran.options["engine"] == "native" and ran.warnings == ()
    (told,) = scenario.run(stop=0.01, fmi=3).warnings
    assert told == "fmi = 3: wires join elements of arrays, so FMUs that have both run as FMI 2"
    with pytest.raises(InputError, match=r"engine fused: feedthrough\.fmu has no C text of ours"):
        scenario.run(engine="fused", stop=0.01)


def test_names_with_dots_and_brackets_go_everywhere(folder: Path, tmp_path: Path) -> None:
    """Into sessions, columns of a study, what was run, and the report, which looks for a tool."""
    left = ["through.in[1]", *LOOP["leave"]]
    connect = {k: v for k, v in LOOP["connect"].items() if k != "through.in[1]"}
    tables = {**LOOP, "connect": connect, "leave": left, "stop": 0.02}
    scenario = _made(folder, tables)
    with Session(scenario, ["through.in[1]"]) as session:
        ran = session.run({"through.in[1]": 0.25})
    assert (ran["through.out[1]"][1:] == 0.25).all()
    assert study_columns.column(scenario, "through.out[1].max").end.name == "through.out[1]"
    ran = scenario.run(set={"through.in[1]": 0.5})
    assert ran.overrides == ["through.in[1] = 0.5 (default: 0)"]
    assert result_folder.save(ran, tmp_path / "r").name == "report.html"


# A value of each type, at the ends of those that are exact in a sum of doubles; its weight there.
TYPES: dict[str, tuple[Any, int]] = {
    "Float32.in": (0.5, 1),
    "Float64.in": (-1.25, 2),
    "Int8.in": (-128, 3),
    "UInt8.in": (255, 4),
    "Int16.in": (-32768, 5),
    "UInt16.in": (65535, 6),
    "Int32.in": (-(2**31), 7),
    "UInt32.in": (2**32 - 1, 8),
    "Int64.in": (-(2**45), 9),
    "UInt64.in": (2**44 + 1, 10),
    "Boolean.in": (True, 11),
    "choice.in": (1, 13),
}


@pytest.mark.parametrize("engine", ENGINES)
def test_all_types_of_fmi_3_go_over_wires(folder: Path, engine: str) -> None:
    foreign_fmus.built("feedthrough", 3, folder, "all")
    names = [*TYPES, "text.in", "Int16.row.in", "Float64.row.in"]
    given = {f"a.{name}": value for name, (value, _) in TYPES.items()}
    given |= {
        "a.text.in": "four",
        "a.Int16.row.in": [1, 2, -3],
        "a.Float64.row.in": [1.0, 2.0, 3.0],
    }
    tables = {
        "stop": 4e-3,
        "component": {"a": "all.fmu", "b": "all.fmu"},
        "connect": {f"b.{n}": f"a.{n[:-2]}out" for n in names},
        "set": given,
        "leave": ["*.bytes.in"],
        "record": {"signals": ["*"]},
    }
    ran = _made(folder, tables).run(engine=engine)
    theory = sum(float(value) * weight for value, weight in TYPES.values()) + 12 * 4 + 14 * -3
    assert ran["b.sum"][0] == 0.0 and (ran["b.sum"][1:] == theory).all()
    assert ran["b.Float64.row.out"].tolist() == [[1.0, 2.0, 3.0]] * 4
    assert "b.Int64.out" not in ran.signals  # no channel records it


WRONG = {
    ("set", "a.Int8.in", 128): "a.Int8.in = 128: outside -128 .. 127",
    ("set", "a.UInt64.in", -1): "a.UInt64.in = -1: outside 0 .. 18446744073709551615",
    ("set", "a.bytes.in", "00"): "a.bytes.in is Binary, of which nothing is set here",
    ("set", "a.size", 4): "a.size is an structuralParameter and cannot be set",
    ("connect", "a.bytes.in", "a.bytes.out"): "a.bytes.in is Binary, which no wire here carries",
    ("record", "signals", ("a.Int64.out",)): "a.Int64.out is Int64: only Float64, Int32, Boolean",
}


@pytest.mark.parametrize("wrong", WRONG, ids=lambda w: w[1])
def test_what_no_run_has_of_fmi_3_is_told(folder: Path, wrong: tuple[str, str, Any]) -> None:
    foreign_fmus.built("feedthrough", 3, folder, "all")
    table, key, value = wrong
    tables = {"stop": 4e-3, "component": {"a": "all.fmu"}, "leave": ["*"], "set": {}, "connect": {}}
    tables["record"] = {"signals": ["*"]}
    given = list(value) if isinstance(value, tuple) else value
    with pytest.raises(InputError) as told:
        _made(folder, tables | {table: {**tables[table], key: given}})
    assert WRONG[wrong] in str(told.value)


def test_an_ssp_of_foreign_fmus_comes_back_with_the_same_bits(folder: Path, tmp_path: Path) -> None:
    """FMUs as they are, wires of elements, values in parameter sets alone, which is told."""
    scenario = _made(folder, {**LOOP, "stop": 0.2})
    told = as_ssp(scenario, tmp_path / "it.ssp", 2, {}).left_out
    assert [line.partition(":")[0] for line in told] == ["ball"]
    take(tmp_path / "it.ssp", tmp_path / "back")
    assert (tmp_path / "back/resources/ball.fmu").read_bytes() == (folder / "ball.fmu").read_bytes()
    wanted, found = scenario.run(), motionfmu.load(tmp_path / "back").run()
    for name in ("ball.ball.pos[2]", "through.out[1]", "through.choice.out"):
        assert wanted[name].tobytes() == found[name].tobytes() and np.ptp(wanted[name]) > 0
    with pytest.raises(InputError, match="wires join elements of arrays"):
        as_ssp(scenario, tmp_path / "x.ssp", 3, {})
    tables = {"stop": 0.1, "component": {"osc": "van_der_pol.fmu"}}
    pol = _made(folder, {**tables, "record": {"signals": ["osc.*"]}})
    with pytest.raises(InputError, match=r"osc is FMI 3, which no SSP 1\.0 has: --fmi 3"):
        as_ssp(pol, tmp_path / "x.ssp", 2, {})
    assert as_ssp(pol, tmp_path / "x.ssp", 3, {}).left_out == []


def _refused(folder: Path, fmu: str) -> str:
    tables = {"stop": 0.1, "component": {"x": fmu}, "leave": ["x.*"]}
    with pytest.raises(InputError) as told:
        _made(folder, {**tables, "record": {"signals": ["x.*"]}}).run()
    return str(told.value)


def _variant(folder: Path, name: str, change: dict[str, str], **files: bytes) -> str:
    """The ball's archive with texts of its description and libraries changed; returns its name."""
    with (
        zipfile.ZipFile(folder / "ball.fmu") as old,
        zipfile.ZipFile(folder / f"{name}.fmu", "w") as new,
    ):
        for entry in old.namelist():
            data = old.read(entry)
            if entry == "modelDescription.xml":
                text = data.decode()
                for before, after in change.items():
                    assert before in text
                    text = text.replace(before, after)
                data = text.encode()
            elif "library" in files:
                data = files["library"]
            if "place" in files:
                entry = entry.replace(here().folder(2), files["place"].decode())
            new.writestr(entry, data)
    return f"{name}.fmu"


def test_what_is_no_fmu_is_told_with_its_place(folder: Path) -> None:
    assert f"[component] x: no such FMU: {folder}/none.fmu" in _refused(folder, "none.fmu")
    (folder / "text.fmu").write_text("no archive")
    assert "no FMU, which is a zip archive" in _refused(folder, "text.fmu")
    with zipfile.ZipFile(folder / "empty.fmu", "w") as archive:
        archive.writestr("readme.txt", "")
    assert "no FMU: it has no modelDescription.xml" in _refused(folder, "empty.fmu")


def test_what_cannot_run_here_is_told(folder: Path) -> None:
    exchange = _variant(folder, "exchange", {"<CoSimulation": "<ModelExchange"})
    assert "it has no CoSimulation, only ModelExchange" in _refused(folder, exchange)
    old = _variant(folder, "old", {'fmiVersion="2.0"': 'fmiVersion="1.0"'})
    assert "FMI 1.0; 2.0 and 3.0 can run" in _refused(folder, old)
    other = _variant(folder, "other", {}, place=b"win64")
    told = _refused(folder, other)
    assert (
        f"no library for this machine (binaries/{here().folder(2)}/ is empty; it has win64)" in told
    )
    named = _variant(folder, "named", {"bouncing_ball_2": "another"})
    assert f"no library another in binaries/{here().folder(2)}/" in _refused(folder, named)
    broken = _variant(folder, "broken", {}, library=b"no library")
    assert "does not load" in _refused(folder, broken)
    assert "invalid ELF header" in _refused(folder, broken) or "too short" in _refused(
        folder, broken
    )


def test_a_library_that_misses_another_is_told_in_the_loaders_words(folder: Path) -> None:
    source = folder / "needs.c"
    source.write_text("int there(void); int fmi2Instantiate(void) { return there(); }\n")
    (folder / "there.c").write_text("int there(void) { return 1; }\n")
    for command in (
        ["cc", "-shared", "-fPIC", "there.c", "-o", "libthere.so"],
        ["cc", "-shared", "-fPIC", "needs.c", "-L.", "-lthere", "-o", "needs.so"],
    ):
        subprocess.run(command, cwd=folder, check=True)
    needs = _variant(folder, "needs", {}, library=(folder / "needs.so").read_bytes())
    told = _refused(folder, needs)
    assert "does not load: libthere.so: cannot open shared object file" in told


def test_wires_of_elements_are_checked(folder: Path) -> None:
    for connect, told in (
        ({"through.in[1]": "axes.motor_angle[7]"}, "axes.motor_angle is Float64[6]"),
        ({"through.in[1]": "axes.motor_angle"}, "through.in[1] is Float64, axes.motor_angle"),
        (
            {"axes.voltage[2]": "through.out[1]", "axes.voltage[02]": "through.out[2]"},
            "axes.voltage[2] has two sources",
        ),
        (
            {"axes.voltage[2]": "through.out[1]", "axes.voltage": "card.dac"},
            "axes.voltage has two sources",
        ),
        (
            {"axes.voltage": "card.dac", "axes.voltage[2]": "through.out[1]"},
            "axes.voltage[2] has two sources",
        ),
    ):
        parts = LOOP["component"] | {"card": "epcio"}
        tables = {**LOOP, "component": parts, "connect": connect, "leave": ["*"], "set": {}}
        with pytest.raises(InputError) as error:
            _made(folder, tables)
        assert told in str(error.value)
    tables = {**LOOP, "set": {}}
    with pytest.raises(InputError, match=r"input axes\.voltage is open"):
        _made(folder, tables)


def test_an_array_is_fed_when_each_element_is(folder: Path) -> None:
    each = {f"axes.voltage[{k}]": "through.out[1]" for k in range(1, 7)}
    tables = {**LOOP, "set": {}, "leave": ["through.*", "ball.*"], "stop": 0.1}
    ran = _made(folder, {**tables, "connect": {**LOOP["connect"], **each}}).run()
    assert not ran["axes.motor_angle"].any()  # nothing starts the loop


def test_the_logger_of_fmi_2_makes_text_of_a_format_and_its_values() -> None:
    told: list[tuple[int, bytes]] = []
    log = binding.library().binding_log
    back = ctypes.CFUNCTYPE(None, ctypes.c_int, ctypes.c_char_p)(lambda *row: told.append(row))
    rest = (b"ball", 1, b"logStatusWarning", b"%s %d of %d at %g s: 100 %%", b"bounce", 2, 3)
    log(ctypes.byref(back), *rest, ctypes.c_double(0.5))
    log(None, *rest, ctypes.c_double(0.5))  # an FMU that lost its environment
    log(ctypes.byref(back), b"ball", 3, b"", b"%5000d", 1)
    assert told[0] == (1, b"bounce 2 of 3 at 0.5 s: 100 %")
    assert len(told) == 2 and told[1][0] == 3 and len(told[1][1]) == 4095
