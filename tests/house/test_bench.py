"""The benchmark's own loops record what their scenarios do; its table says what it misses."""

import json
import re
import subprocess
import sys
from collections.abc import Sequence
from datetime import date
from pathlib import Path

import pytest
from conftest import ROOT

import motionfmu

sys.path.insert(0, str(ROOT / "tests/bench"))
import figures
import growth
import medians
import peers
import profiles
from figures import Figure

FOUND = [
    Figure("loop, times real time", 60.0, least=50.0),
    Figure("sweep, efficiency", 0.85, least=0.9),
    Figure("instructions a step", 10100.0, counted=True),
    Figure("instructions / limit", 1.125, most=1.1, counted=True),
    Figure("not measured", float("nan"), most=1.0),
]


@pytest.fixture
def last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A table of the time before, on this machine."""
    file = tmp_path / "last.json"
    before = {"loop, times real time": 90.0, "instructions a step": 10000.0}
    file.write_text(json.dumps({"machine": figures.machine("perf"), "figures": before}))
    monkeypatch.setattr(figures, "LAST", file)
    return file


def test_what_is_missed_is_marked_and_kept_so(last: Path, capsys) -> None:
    figures.show(FOUND, "perf", figures.Kept.NEW)
    told = {line[:52].strip(): line[52:] for line in capsys.readouterr().out.splitlines()}
    assert told["loop, times real time"].split() == "60 90 at least 50 WORSE".split()
    assert told["sweep, efficiency"].split() == "0.85 - at least 0.9 MISSED".split()
    assert told["instructions / limit"].split() == "1.125 - at most 1.1 MISSED".split()
    kept = json.loads(last.read_text())
    assert kept["asked"] == {
        "loop, times real time": "at least 50",
        "sweep, efficiency": "at least 0.9 MISSED",
        "instructions / limit": "at most 1.1 MISSED",
    }
    assert list(kept["figures"]) == [f.name for f in FOUND[:4]]
    assert kept["day"] == date.today().isoformat() and kept["machine"] == figures.machine("perf")


def test_one_round_gives_no_figures_of_time(last: Path, capsys) -> None:
    before = last.read_text()
    figures.show(FOUND, "perf", figures.Kept.ONE_ROUND)
    out = capsys.readouterr().out
    told = {line[:52].strip(): line[52:] for line in out.splitlines()}
    assert told["loop, times real time"].split() == ["about", "60", "at", "least", "50"]
    assert told["sweep, efficiency"].split() == ["about", "0.85", "at", "least", "0.9"]
    assert told["instructions a step"].split() == "10100 10000".split()
    assert told["instructions / limit"].split() == "1.125 - at most 1.1 MISSED".split()
    assert out.count("one round") == 1 and "nothing is kept" in out
    assert last.read_text() == before


def test_one_round_is_never_kept() -> None:
    bench = [sys.executable, ROOT / "tests/bench/bench.py", "--quick", "--renew"]
    path = {"PYTHONPATH": str(ROOT / "tests/helpers")}
    done = subprocess.run(bench, capture_output=True, text=True, env=path)
    assert done.returncode != 0 and done.stdout == ""
    assert done.stderr == "bench: --quick takes one round, which --renew does not keep\n"


def test_the_committed_table_marks_what_it_misses() -> None:
    kept = json.loads((ROOT / "tests/bench/last.json").read_text())
    bounds = {"most": "at most", "least": "at least"}
    assert len(kept["asked"]) > 40 and set(kept["asked"]) <= set(kept["figures"])
    for name, words in kept["asked"].items():
        ((key, number),) = [
            (key, float(words.removeprefix(text).split()[0]))
            for key, text in bounds.items()
            if words.startswith(text)
        ]
        assert Figure(name, kept["figures"][name], **{key: number}).asked == words


def test_a_figure_is_the_median_of_its_rounds() -> None:
    found = medians.Medians()
    for seconds in (3.0, 1.0, 9.0, 1.5, 2.0):
        found.add("loop", seconds)
        found.add("whole", 2 * seconds)
    assert (found["loop"], found["whole"]) == (2.0, 4.0)


def test_no_figure_is_the_best_of_its_rounds() -> None:
    for file in (ROOT / "tests/bench").glob("*.py"):
        assert not re.search(r"= min\(self|min\(getattr", file.read_text()), file.name


# A program with its own text at 0x100 and a part Axes whose step is at 0x200; a library's
# function at 0x900 is called by both.
CALLGRIND = """\
ob=/x/System.so
fn=system_arrive
0x100 5 10
0x104 6 4
cob=/x/libc.so
cfn=copy
calls=2 0x900 0
0x104 6 30
cfn=part_step
calls=2 0x200 0
0x108 7 100
fn=part_step
0x200 0 60
cob=/x/libc.so
cfn=copy
calls=1 0x900 0
0x204 0 40

ob=/x/libc.so
fn=copy
0x900 0 70
"""


class OfTwo(profiles.Program):
    """The program of CALLGRIND; 0x104 stands in the recorder's lines."""

    def __init__(self) -> None:
        self.file, self.part = Path("/x/System.so"), {0x200: "Axes"}

    def of(self, address: int) -> str:
        return "Axes" if address >= 0x200 else ""

    def roles(self, addresses: Sequence[int]) -> dict[int, str]:
        return {at: profiles.RECORDER if at == 0x104 else profiles.LOOP for at in addresses}


def test_a_profile_counts_each_instruction_once() -> None:
    """A longer run of two more steps, each of which does what CALLGRIND has of two."""
    long = CALLGRIND.splitlines()
    short = profiles.read([])
    counts = profiles.read(long).less(short, 2)
    assert sum(counts.own.values()) == 72.0
    found = profiles.parts(counts, OfTwo())
    assert found == {"Axes": 50.0, "wires": 0.0, "recorder": 17.0, "loop around them": 5.0}
    first = dict(profiles.functions(counts, OfTwo()))
    assert first == {"libc: copy": 35.0, "Axes: part_step": 30.0, "the program: system_arrive": 7.0}
    again = profiles.read([*long, *long]).less(profiles.read(long), 2)
    assert profiles.parts(again, OfTwo()) == found


def test_readme_has_the_kept_profiles() -> None:
    kept = json.loads(profiles.KEPT.read_text())
    assert list(kept) == list(profiles.SYSTEMS)
    for name, found in kept.items():
        assert abs(sum(found["parts"].values()) - found["instructions"]) <= len(found["parts"])
        assert found["steps"] == list(profiles.SYSTEMS[name][1])
        assert len(found["functions"]) == profiles.FIRST
    assert profiles.tables(kept) in (ROOT / "tests/bench/README.md").read_text()
    told = f"takes {round(kept['demo']['instructions'], -1):,} instructions as one program"
    assert told in (ROOT / "src/motionfmu/README.md").read_text()


@pytest.mark.parametrize(
    ("scenario", "header"),
    [
        ("scenarios/circle", "tests/bench/fused_circle.h"),
        ("tests/bench/six_axes", "tests/bench/six_axes/fused_six_axes.h"),
    ],
)
def test_the_fused_loop_records_the_signals_of_its_scenario(scenario: str, header: str) -> None:
    listed = {
        ".".join(pair) for pair in re.findall(r"X\((\w+), (\w+),", (ROOT / header).read_text())
    }
    result = motionfmu.load(ROOT / scenario).run(stop=0.01)
    assert listed == set(result.signals)


@pytest.mark.parametrize(
    ("cost", "exponent", "verdict"),
    [
        (lambda n: 1000.0 + 3.0 * n, 1.0, ""),
        (lambda n: 1.0 + 0.5 * (n - 1) ** 1.5, 1.5, "MISSED"),
        (lambda n: 1e6 + 1e4 * (n - 1) ** 2, 2.0, "MISSED"),
        (lambda n: 1000.0 + 1e-3 * n, float("nan"), "not seen"),
        (lambda n: 7.0, float("nan"), "not seen"),
    ],
)
def test_the_exponent_of_growth(cost, exponent: float, verdict: str) -> None:
    """Of powers of the size beyond any start, it is the power."""
    sizes = (1, 10, 100, 1000)
    found = growth.Grown("work", "s", sizes, [cost(n) for n in sizes])
    assert found.exponent == pytest.approx(exponent, nan_ok=True)
    assert found.verdict == verdict


def test_growth_judges_the_largest_sizes() -> None:
    """A start that costs much for small sizes hides no square of the large ones."""
    sizes = (1, 10, 100, 1000, 10_000)
    costs = [10.0 + 1e-4 * n**2 + n for n in sizes]
    found = growth.Grown("work", "s", sizes, costs)
    assert found.exponents[0] < 1.02 and found.verdict == "MISSED"


def test_a_tool_that_finds_something_else_stops_the_benchmark(capsys) -> None:
    peers.agree("pose", True, "by nothing")
    with pytest.raises(SystemExit) as stopped:
        peers.agree("pose", False, "by 2 mm")
    assert str(stopped.value) == "bench: pose: the results differ: by 2 mm"


def test_what_is_not_installed_is_named(tmp_path: Path, monkeypatch, capsys) -> None:
    (tmp_path / "peer_absent.py").write_text("import no_such_library\n")
    (tmp_path / "peer_present.py").write_text(
        "from peers import Row\n"
        "class Rows:\n"
        "    missing = ['its half is not installed']\n"
        "    count = 0\n"
        "    def __call__(self): self.count += 1\n"
        "    def rows(self): return [Row('a sum', 's', 'tool', 2.0, 5.0, self.count)]\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(peers, "PARTS", ("peer_absent", "peer_present"))
    monkeypatch.setattr(peers, "KEPT", tmp_path / "peers.json")
    peers.main(renew=True)
    told = capsys.readouterr().out
    assert f"| a sum | s | tool | 2 | 5 | 2.5 | {peers.ROUNDS} |" in told
    for text in ("no_such_library is not installed", "its half is not installed"):
        assert f"left out: {text}" in told
    assert peers.kept()[1] == [peers.Row("a sum", "s", "tool", 2.0, 5.0, peers.ROUNDS)]


def test_readme_has_the_kept_tables() -> None:
    text = (ROOT / "tests/bench/README.md").read_text()
    about, rows = peers.kept()
    assert peers.table(rows) in text and about["day"] in text
    tools = " ".join(row.tool for row in rows)
    for name in ("libcosim", "ecos", "FMPy", "LinuxCNC", "pinocchio", "python-control"):
        assert name in tools
    grown = growth.kept()
    assert [g.name for g in grown] == [w.name for w in growth.WORKS]
    assert growth.table(grown) in text
