"""Readers of files: any text gives a valid object or one message, and never hangs.

A short run is the same each time. MOTIONFMU_FUZZ=600 draws other inputs for so many seconds each.
"""

import contextlib
import os
import shutil
import signal
import time
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT
from fuzz_texts import changed_tables, changed_text, document
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import motionfmu
from motionfmu import sweep
from motionfmu.base.errors import InputError
from motionfmu.cli.common import settings as gains
from motionfmu.fmu import fmu_toml
from motionfmu.fmu.modelica import class_description
from motionfmu.run.engines.slave import Slave
from motionfmu.scenarios.fmus import fmu_path
from motionfmu.study import tune

SECONDS = float(os.environ.get("MOTIONFMU_FUZZ", "0"))
ROUND = 500  # examples between two looks at the clock
PATIENCE = 60  # [s] an input takes milliseconds; whoever waits this long waits for ever


def fuzz(originals: list[str], body: Callable[[str], Any], examples: int) -> None:
    """Try the originals, which must be valid, then changed ones."""
    for text in (t for o in originals for t in (o, document(tomllib.loads(o)))):
        assert body(text) is not None, text

    def quiet(text: str) -> None:
        body(text)

    search(either(originals), quiet, examples)


def search(strategy: st.SearchStrategy[Any], body: Callable[[Any], None], examples: int) -> None:
    """Try a few inputs, or inputs for SECONDS."""
    quiet = {"deadline": None, "suppress_health_check": list(HealthCheck), "database": None}
    if not SECONDS:
        settings(derandomize=True, max_examples=examples, **quiet)(given(strategy)(body))()
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        settings(max_examples=ROUND, **quiet)(given(strategy)(body))()


@contextlib.contextmanager
def patience() -> Iterator[None]:
    """Whoever does not come back is told by an exception."""

    def ring(*_: object) -> None:
        raise AssertionError(f"no answer in {PATIENCE} s")

    before = signal.signal(signal.SIGALRM, ring)
    signal.alarm(PATIENCE)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def answer(reader: Callable[..., Any], *arguments: Any) -> Any:
    """What a reader makes of its input; None after one message."""
    with patience():
        try:
            found = reader(*arguments)
        except InputError as error:
            lines = error.args  # one for each thing that is wrong
            assert 1 <= len(lines) <= 51, lines
            assert all(t and t.isprintable() and len(t) < 3000 for t in lines), lines
            return None
    assert found is not None
    return found


def texts(*patterns: str) -> list[str]:
    return [f.read_text() for p in patterns for f in sorted(ROOT.glob(p))]


def either(originals: list[str]) -> st.SearchStrategy[str]:
    """Files with their text changed, and, more often, with their tables changed."""
    whole = changed_tables([tomllib.loads(t) for t in originals]).map(document)
    return changed_text(originals) | whole | whole


FMUS = texts("fmus/*/fmu.toml")
PLAIN = [t for t in FMUS if not fmu_toml.names_modelica(t)]
PLANTS = [t for t in FMUS if fmu_toml.names_modelica(t)]


@pytest.mark.more
def test_a_description_is_read_or_refused() -> None:
    def body(text: str) -> Any:
        found = answer(fmu_toml.parse, text, "fmu.toml")
        assert found is None or found.reference_count >= 0
        return found

    fuzz(PLAIN, body, 100)


def test_a_plants_description_is_read_or_refused(tmp_path: Path) -> None:
    file = tmp_path / "fmus/x/fmu.toml"
    file.parent.mkdir(parents=True)
    (tmp_path / "modelica").symlink_to(ROOT / "modelica")

    def body(text: str) -> Any:
        file.write_bytes(text.encode(errors="surrogatepass"))
        found = answer(class_description.read, file)
        assert found is None or found.instances >= 1
        return found

    fuzz(PLANTS, body, 100)


@pytest.mark.more
def test_a_scenario_is_loaded_or_refused(tmp_path: Path) -> None:
    mine = tmp_path / "mine"
    mine.mkdir()
    for file in ROOT.glob("scenarios/*/*.*"):
        if file.suffix in (".ngc", ".job", ".jbi", ".points", ".txt"):
            shutil.copy(file, mine)
    for folder in (f.parent for f in ROOT.glob("scenarios/*/scenario.toml")):  # to be extended
        (tmp_path / folder.name).symlink_to(folder)

    def body(text: str) -> Any:
        (mine / "scenario.toml").write_bytes(text.encode(errors="surrogatepass"))
        found = answer(motionfmu.load, mine)
        assert found is None or found.document.body.component
        return found

    fuzz(texts("scenarios/*/scenario.toml"), body, 60)


STUDY = """# About.
scenario = "{}"
sampling = "latin"
runs = 20
seed = 1
stop = 0.1
results = ["contour.error.max", "card.err_count[1].final", "mcc.starved.max"]
cost = "mcc.starved.max"
tuned = "gains.toml"
set = {{ "mcc.p_gain" = [100, 100, 0, 0, 0, 0] }}
[axis]
"mcc.irq_latency" = {{ from = 1e-4, to = 1e-3, log = true }}
"mcc.p_gain[1]" = {{ from = 100, to = 300 }}
"mcc.acc_type" = ["T", "S"]
"machine.tau" = {{ mean = 0.001, deviation = 0.0001 }}
"""


def test_a_study_is_made_or_refused(tmp_path: Path) -> None:
    scenario = ROOT / "scenarios/circle_theory"
    (tmp_path / "gains.toml").write_text(
        '"mcc.irq_latency" = 2e-4\n"mcc.p_gain" = [100, 1]\n"mcc.acc_type" = "T"\n'
        '"machine.tau" = 1e-3\n"drives.velocity_gain" = 1.0\n'
    )
    written = [STUDY.format(scenario)]
    (text,) = texts("scenarios/circle/sweep.toml")
    written.append(text.replace("\n", f'\nscenario = "{ROOT / "scenarios/circle"}"\n', 1))

    def body(text: str) -> Any:
        (tmp_path / "sweep.toml").write_bytes(text.encode(errors="surrogatepass"))
        found = answer(sweep.study, tmp_path / "sweep.toml")
        assert found is None or len(found.points) >= 1
        return found

    fuzz(written, body, 60)


TUNE = """# About.
gains = ["mcc.p_gain"]
velocity = true
axes = "equal"
cost = "itae"
command = "mcc.position"
position = "machine.table_position"
starts = 3
check = 10
[trial]
"mcc.x" = [1.0, 2.0]
[bounds]
"mcc.p_gain" = [1.0, 200]
[family]
"machine.tau" = [0.001, 0.002]
[limits]
overshoot = 0.1
margins = { gain = 2.0, phase = 30.0 }
peak = { "card.dac" = 9.0 }
loop."card.enc_phase" = { sensitivity = 2.0 }
"""


def test_a_tuning_problem_is_read_or_refused(tmp_path: Path) -> None:
    def body(text: str) -> Any:
        (tmp_path / "tune.toml").write_bytes(text.encode(errors="surrogatepass"))
        values = answer(tune.read, tmp_path / "tune.toml")
        return None if values is None else tune.problem(values).plants()

    fuzz([TUNE, *texts("scenarios/*/tune.toml")], body, 100)


def test_gains_are_read_or_refused(tmp_path: Path) -> None:
    def body(text: str) -> Any:
        (tmp_path / "gains.toml").write_bytes(text.encode(errors="surrogatepass"))
        return answer(gains, [str(tmp_path / "gains.toml")])

    fuzz(texts("scenarios/*/gains.toml"), body, 60)


HEADS = {"axis,interval,home": 3, "axis,index,forward,backward": 4}
CELLS = [-1, 0, 1, 2, 6, 7, 100, 255, 256, 32767, 32768, -32767, -32768, 2**31 - 1, 2**31, -(2**63)]


def well_formed(data: bytes) -> bool:
    """Whether the README's words allow this compensation file."""
    width, intervals, last = 0, set(), {}
    for line in data.removesuffix(b"\n").split(b"\n") if data else []:
        if len(line) > 254 or b"\0" in line:
            return False
        text = line.removesuffix(b"\r").decode("latin-1")
        if not text or text.startswith("#"):
            continue
        if text in HEADS:
            width = HEADS[text]
            continue
        cells = text.split(",")
        if not width or len(cells) != width:
            return False
        try:
            axis, place, *rest = (whole(c) for c in cells)
        except ValueError:
            return False
        if not 1 <= axis <= 6:
            return False
        if width == 3:
            if axis in intervals or not 1 <= place < 2**31 or not 0 <= rest[0] <= 255:
                return False
            intervals.add(axis)
        else:
            follows = last.get(axis, place - 1) + 1 == place
            if axis not in intervals or not 0 <= place <= 255 or not follows:
                return False
            if max(map(abs, rest)) > 32767:
                return False
            last[axis] = place
    return intervals == set(last)


def whole(cell: str) -> int:
    """A whole number of 64 bits, blanks around it."""
    digits = cell.strip(" ").lstrip("\t\v\f\r ").removeprefix("+").removeprefix("-")
    if not digits or not all(c in "0123456789" for c in digits) or "+-" in cell:
        raise ValueError(cell)
    if not -(2**63) <= int(cell) < 2**63:
        raise ValueError(cell)
    return int(cell)


@st.composite
def compensation(draw: st.DrawFn) -> bytes:
    """A table of up to two axes, then a few bytes of it changed."""
    cell = st.sampled_from(CELLS) | st.integers(-3, 300)
    lines = ["# screw", "axis,interval,home"]
    used = draw(st.lists(st.integers(1, 6), unique=True, max_size=2))
    lines += [f"{a},{draw(st.integers(1, 9000))},{draw(st.integers(0, 255))}" for a in used]
    lines.append("axis,index,forward,backward")
    for a in used:
        first = draw(st.integers(0, 250))
        lines += [
            f"{a},{first + i},{draw(cell)},{draw(cell)}" for i in range(draw(st.integers(1, 3)))
        ]
    for _ in range(draw(st.integers(0, 2))):
        at = draw(st.integers(0, len(lines)))
        row = [str(draw(cell)) for _ in range(draw(st.integers(1, 5)))]
        change = draw(st.sampled_from(["add", "drop", "again", "odd"]))
        odd = ["", " ", "\t1, 1,1 ", "+1,1,1", "axis", "x" * 254, "x" * 255, "\r", "1,1,1,1,"]
        if change == "add":
            lines.insert(at, ",".join(row))
        elif change == "odd":
            lines.insert(at, draw(st.sampled_from(odd)))
        elif lines and at < len(lines):
            lines[at : at + 1] = [] if change == "drop" else [lines[at]] * 2
    data = draw(st.sampled_from(["\n", "\r\n"])).join(lines).encode()
    if draw(st.integers(0, 3)) == 0:
        at = draw(st.integers(0, len(data)))
        data = data[:at] + draw(st.binary(max_size=3)) + data[at + draw(st.integers(0, 2)) :]
    return data


def test_a_compensation_file_is_read_if_it_is_well_formed(tmp_path: Path) -> None:
    (tmp_path / "part.ngc").write_text("G21 G1 X1 F600\nM2\n")
    table = tmp_path / "screw.csv"
    slave = Slave("mcc", fmu_path("mcc"), 3, [])
    try:

        def body(data: bytes) -> None:
            table.write_bytes(data)
            for name, value in (("program", tmp_path / "part.ngc"), ("comp_file", table)):
                slave.assign("String", slave.references[name], [str(value)])
            slave.assign("Boolean", slave.references["active"], [True] * 6)
            with patience():
                try:
                    slave.initialize()
                    slave.start()
                    read = True
                except InputError as error:
                    assert f"comp_file: {table}: " in str(error) and len(str(error)) < 3000
                    read = False
                finally:
                    slave.renew()
            assert read == well_formed(data), slave.errors

        search(compensation(), body, 200)
    finally:
        slave.free()


@pytest.mark.more
def test_the_search_would_find_what_it_looks_for() -> None:
    """A reader that stumbles over one sort of value, and one that waits for ever, are found."""

    def stumbles(text: str) -> Any:
        if isinstance(tomllib.loads(text).get("starts"), float):
            raise ZeroDivisionError
        raise InputError("one message")

    def body(text: str) -> None:
        with contextlib.suppress(tomllib.TOMLDecodeError, ValueError):
            answer(stumbles, text)

    quiet = {"deadline": None, "database": None, "derandomize": True}
    with pytest.raises(ZeroDivisionError):
        settings(max_examples=200, **quiet)(given(either(["starts = 3\ncheck = 1\n"]))(body))()
    with pytest.raises(AssertionError):
        answer(lambda: (_ for _ in ()).throw(InputError("x" * 4000)))
