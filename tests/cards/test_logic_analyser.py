"""The logic analyser on the FPGA's own logic: reactions to the clock, phases, pauses, its file."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_tools import OK, Instance

CLOCK = 25e-9  # [s]
SLOT = 200  # [clocks]


def events(file: Path) -> np.ndarray:
    """Rows of the record file: channel, edge, response; -1 where there was none."""
    lines = file.read_text().splitlines()
    assert lines[0] == "channel,edge_clock,response_clock"
    rows = [[int(x or -1) for x in line.split(",")] for line in lines[1:]]
    return np.array(rows, dtype=np.int64).reshape(-1, 3)


def begin(file: Path, period: float, **more: Any) -> Instance:
    """A logic analyser on all channels."""
    values = {"enabled": -1, "record_file": str(file), "bus_period": period}
    values |= {"least_pause": 1e-4, "mean_pause": 3e-4}
    return Instance("logic_analyser", 3).initialize(values | more)


def measure(file: Path, period: float, seconds: float, **more: Any) -> tuple[Instance, Instance]:
    """The FPGA's own logic under the logic analyser; both FMUs at the end."""
    analyser = begin(file, period, **more)
    card = Instance("fpga_card", 3).initialize({"bus_period": period, "follow_mask": -1})
    wires = (
        {"di": "di", "di_clock": "di_clock"},
        {"dout": "response", "dout_clock": "response_clock"},
    )
    known, clocks, length = 0, [0.0] * 32, round(period / CLOCK)
    for k in range(round(seconds / period)):
        said = [{n: a.get(n) for n in w} for a, w in zip((analyser, card), wires, strict=True)]
        changed = said[0]["di"][0] ^ known
        for i, clock in enumerate(said[0]["di_clock"]):  # an edge is new behind its instant only
            assert (
                k * length < clock <= (k + 1) * length if changed >> i & 1 else clock == clocks[i]
            )
        known, clocks = said[0]["di"][0], said[0]["di_clock"]
        for to, w, values in zip((card, analyser), wires, said, strict=True):
            for name, target in w.items():
                assert to.set(target, values[name]) == OK
        assert analyser.step(period) == card.step(period) == OK
    assert analyser.call("Terminate") == OK
    return analyser, card


@pytest.mark.parametrize("period", [5e-6, 5e-5, 1e-4])
def test_the_fpga_reacts_at_the_next_exchange(tmp_path: Path, period: float) -> None:
    seconds = {5e-6: 0.02, 5e-5: 0.15, 1e-4: 0.15}[period]
    analyser, card = measure(tmp_path / "edges.csv", period, seconds)
    rows = events(tmp_path / "edges.csv")
    reaction = rows[:, 2] - rows[:, 1]
    # the first exchange at or behind each edge, whatever the wires' period
    assert np.array_equal(rows[:, 2], -(-rows[:, 1] // SLOT) * SLOT)
    assert card.get("late") == [0]
    assert analyser.get("timeouts") == analyser.get("strays") == [0] * 32
    if period == 5e-5:
        assert len(rows) > 10_000
        formula = (SLOT - 1) / 2
        print(f"{len(rows)} edges, mean {reaction.mean() * 25e-3:.4f} us, {formula * 25e-3:.4f} us")
        assert abs(reaction.mean() / formula - 1) < 0.02
        assert (reaction.min(), reaction.max()) == (0, SLOT - 1)
        counts = np.bincount(reaction // 20, minlength=10)
        assert np.all(np.abs(counts - len(rows) / 10) < 5 * np.sqrt(len(rows) / 10))
    for i in range(32):
        mine = reaction[rows[:, 0] == i] * CLOCK
        assert analyser.get("responses")[i] == len(mine) > 10
        assert analyser.get("edges")[i] - len(mine) in (0, 1)
        statistics = [mine[-1], mine.min(), mine.mean(), mine.max()]
        shown = [analyser.get(n)[i] for n in ("latest", "least", "mean", "most")]
        assert shown == pytest.approx(statistics, rel=1e-12, abs=1e-18)


def test_groups_are_the_figures_of_their_channels(tmp_path: Path) -> None:
    file, group = tmp_path / "edges.csv", [1] * 8 + [2] * 12 + [6] * 12
    analyser, _ = measure(file, 5e-5, 0.02, group=group, enabled=~0x10001)
    rows = events(file)
    for g in range(1, 7):
        channels = [i for i in range(32) if group[i] == g and i not in (0, 16)]
        mine = (rows[:, 2] - rows[:, 1])[np.isin(rows[:, 0], channels)] * CLOCK
        assert analyser.get("group_responses")[g - 1] == len(mine)
        assert (len(mine) > 100) == (g in (1, 2, 6))
        want = [mine.min(), mine.mean(), mine.max()] if len(mine) else [0.0] * 3
        shown = [analyser.get(f"group_{n}")[g - 1] for n in ("least", "mean", "most")]
        assert shown == pytest.approx(want, rel=1e-12, abs=1e-18)
    assert analyser.get("group_failures") == [0] * 6


def test_pauses_lie_within_their_limits_and_follow_the_seed(tmp_path: Path) -> None:
    runs = []
    for name, seed, enabled in (("a", 1, -1), ("b", 1, 0x10), ("c", 2, -1)):
        measure(tmp_path / name, 5e-5, 0.04, seed=seed, enabled=enabled)
        rows = events(tmp_path / name)
        assert set(rows[:, 0]) == (set(range(32)) if enabled == -1 else {4})
        runs.append(rows[rows[:, 0] == 4])
    assert np.array_equal(runs[0], runs[1])  # other channels change nothing
    assert not np.array_equal(runs[0][:5], runs[2][:5])
    rows = events(tmp_path / "a")
    pauses = []
    for i in range(32):
        mine = rows[rows[:, 0] == i]
        assert not np.array_equal(mine[:3, 1], runs[0][:3, 1]) or i == 4
        for before, after in pairwise(mine):
            seen = (
                -(-max(before[2], 1) // 2000) * 2000 + 2000
            )  # the instant behind that of the answer
            pauses.append(after[1] - seen)
    assert min(pauses) >= 4000 - 2000
    assert 20_000 - 2000 <= max(pauses) <= 20_000
    assert abs(np.mean(pauses) / 12_000 - 1) < 0.03


def test_an_edge_without_an_answer_is_counted(tmp_path: Path) -> None:
    file = tmp_path / "edges.csv"
    analyser = begin(file, 5e-5, enabled=3, timeout=1e-3)
    for k in range(200):
        late = (
            k >= 100
        )  # an answer to nothing, on a channel that waits and on one that does not run
        assert analyser.set("response", 5 if late else 0) == OK
        assert analyser.set("response_clock", 100.0) == OK
        assert analyser.step(5e-5) == OK
    assert analyser.call("Terminate") == OK
    rows = events(file)
    for i in (0, 1):
        mine = rows[rows[:, 0] == i]
        assert np.all(mine[:, 2] == -1)
        assert analyser.get("timeouts")[i] == len(mine) > 5
        # unanswered for 1 ms: the next edge is more than that and a pause behind
        assert np.diff(mine[:, 1]).min() > 40_000 + 4000
        assert np.diff(mine[:, 1]).max() < 40_000 + 20_000 + 2 * 2000 + 2000
    assert analyser.get("strays")[:3] == [1, 0, 0]
    assert analyser.get("group_failures")[0] == sum(analyser.get("timeouts")) + 1
    assert analyser.get("responses") == [0] * 32


def test_an_answer_has_the_level_of_its_edge(tmp_path: Path) -> None:
    analyser = begin(tmp_path / "edges.csv", 5e-5, enabled=1, timeout=1e-3)
    for _ in range(400):  # low for ever, and changed just now
        assert analyser.set("response_clock", 1e6) == OK
        assert analyser.step(5e-5) == OK
    assert analyser.call("Terminate") == OK
    rows = events(tmp_path / "edges.csv")
    assert np.all(rows[::2, 2] == -1)  # to high: not answered
    assert np.all(rows[1::2, 2] == 1e6)
    assert len(rows) > 10


def test_what_is_seen_at_an_instant_shows_at_the_next(tmp_path: Path) -> None:
    analyser = begin(tmp_path / "edges.csv", 1e-4)
    for _ in range(20):
        before = analyser.outputs()
        assert analyser.step(5e-5) == OK
        assert analyser.outputs() == before
        assert analyser.step(5e-5) == OK
    assert any(analyser.get("edges"))
    analyser.free()


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("mean_pause", 5e-5, "mean_pause[1] = 5e-05 s: less than least_pause = 0.0001 s"),
        ("bus_period", 1e-4 + 1e-9, "not a whole number of 25 ns clocks"),
        ("record_file", "/nowhere/edges.csv", "record_file: cannot write /nowhere/edges.csv"),
    ],
)
def test_what_cannot_work_is_refused(tmp_path: Path, name: str, value: Any, said: str) -> None:
    analyser = Instance("logic_analyser", 3)
    values = {"least_pause": 1e-4, "mean_pause": 3e-4} | {name: value}
    for n, v in values.items():
        assert analyser.set(n, v) == OK
    assert analyser.enter() == OK
    assert analyser.call("ExitInitializationMode") != OK
    assert said in analyser.said
