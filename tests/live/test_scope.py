"""Triggers and records of the scope, against a search sample by sample."""

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from appearing import appears
from hypothesis import given
from hypothesis import strategies as st

import motionfmu
from motionfmu.base.children import child
from motionfmu.base.errors import InputError
from motionfmu.live import LiveMachine
from motionfmu.live.file_record import FileRecord, RecordHead
from motionfmu.live.live_scope import LiveScope
from motionfmu.live.sample_ring import SampleRing
from motionfmu.live.scope_trigger import ScopeTrigger, TriggerSetting

KINDS = ["rise", "fall", "either", "level", "window", "change"]


def happens(s: TriggerSetting, before: float | None, now: float) -> bool:
    """Whether the event is at a sample, from the one before it."""
    if s.kind == "level":
        return now >= s.level
    if before is None:
        return False
    if s.kind == "change":
        return now != before
    if s.kind == "window":
        return s.level <= before <= s.high and not s.level <= now <= s.high
    up, down = before < s.level <= now, before > s.level >= now
    return {"rise": up, "fall": down, "either": up or down}[s.kind]


def expected(s: TriggerSetting, x: list[float], armed: int) -> list[tuple[int, int, int, bool]]:
    """Begin, event, end of each recording: what an oscilloscope does, sample by sample."""
    found, k, since = [], armed, armed
    while k < len(x):
        event = happens(s, x[k - 1] if k else None, x[k])
        forced = not event and s.mode == "auto" and k - since + 1 >= s.length
        if event or forced:
            end = k + max(1, s.length - round(s.pre * s.length))
            if end > len(x):
                break
            found.append((max(0, end - s.length), k, end, forced))
            if s.mode == "single":
                break
            since = end
            k = max(k + 1, end)
            continue
        k += 1
    return found


@given(
    x=st.lists(st.sampled_from([0.0, 1.0, 2.0, 3.0]), min_size=1, max_size=60),
    parts=st.lists(st.integers(1, 9), min_size=70, max_size=70),
    kind=st.sampled_from(KINDS),
    pre=st.sampled_from([0.0, 0.3, 0.5, 0.9]),
    length=st.integers(2, 12),
    mode=st.sampled_from(["single", "normal", "auto"]),
    armed=st.integers(0, 5),
)
def test_a_trigger_finds_what_a_search_finds_however_it_is_looked_at(  # noqa: PLR0913
    x: list[float], parts: list[int], kind: Any, pre: float, length: int, mode: Any, armed: int
) -> None:
    armed = min(armed, len(x))
    setting = TriggerSetting("a", kind, 1.0, 2.0, pre, length, mode)
    ring = SampleRing(["b", "a"], rows=64)
    rows = np.column_stack([np.arange(len(x)), x])
    ring.write(rows[:armed])
    trigger: ScopeTrigger | None = ScopeTrigger(setting, ring)
    got = []
    first = armed
    for count in parts:
        ring.write(rows[first : first + count])
        first += count
        while trigger is not None and (found := trigger.look()) is not None:
            end = found.begin + len(found.rows)
            got.append((found.begin, found.at, end, found.forced))
            assert found.rows.tolist() == rows[found.begin : end].tolist()
            trigger = None if mode == "single" else trigger
    assert got == expected(setting, x, armed)


@pytest.mark.parametrize("rows", [3, 8])
def test_a_ring_has_the_latest_samples(rows: int) -> None:
    ring = SampleRing(["a"], 10, rows)
    x = np.arange(40.0)[:, None]
    first = 0
    for count in (1, 2, 5, 3, 11, 1):
        ring.write(x[first : first + count])
        first += count
        assert ring.end == 10 + first and ring.begin == max(10, 10 + first - rows)
        begin, there = ring.since(0)
        assert begin == ring.begin and there[:, 0].tolist() == [*range(begin - 10, first)]
    ring.cut(ring.end - 2)
    assert ring.since(0)[1][:, 0].tolist() == [*range(first - rows, first - 2)]
    for step in (3, 70):
        ring.cut(step)
        ring.write(x[:2])
        assert (ring.begin, ring.end) == (step, step + 2) and len(ring.since(0)[1]) == 2


CHANNELS = ["machine.table_position[1]", "mcc.status", "drives.torque[2]"]


def recorded(names: list[str], begin: int, end: int) -> Any:
    """The signals of a plain run of the same scenario, at those steps."""
    whole = list(dict.fromkeys(n.partition("[")[0] for n in names))
    plan = motionfmu.load("circle").changed(record={"every": 1, "signals": whole})
    result = plan.run(stop=end * 1e-4)
    columns = []
    for name in names:
        signal, bracket, element = name.partition("[")
        data = result[signal]
        columns.append(data[begin:end, int(element[:-1]) - 1] if bracket else data[begin:end])
    return np.column_stack(columns).astype(float)


def test_the_scope_has_every_step_and_a_recording_that_has_begun_is_whole() -> None:
    found: list[Any] = []
    with LiveMachine("circle") as machine:
        scope = LiveScope(machine, found.append)
        scope.channels(CHANNELS)
        setting = TriggerSetting("machine.table_position[1]", "rise", 0.04, 0, 0.25, 800)
        with pytest.raises(InputError, match=r"trigger on mcc\.line: the scope's channels are"):
            scope.trigger(TriggerSetting("mcc.line", "rise"))
        scope.trigger(setting)
        while not scope.state()["trigger"] == "recording":
            scope.fill(37)
        scope.channels(["mcc.line"])  # somebody looks at something else
        scope.trigger(None)
        assert scope.state()["trigger"] == "recording" and not found
        scope.fill(1000)
        (one,) = found
        assert len(one.rows) == 800 and one.at - one.begin == 200
        assert one.rows[199, 0] < 0.04 <= one.rows[200, 0]
        begin, lines = scope.ring.since(0)
        assert begin + len(lines) == machine.steps
    rows = recorded(CHANNELS, one.begin, one.begin + 800)
    assert rows.tobytes() == one.rows.tobytes()


def test_going_back_ends_a_recording_where_it_is(tmp_path: Path) -> None:
    found: list[Any] = []
    with LiveMachine("circle") as machine:
        scope = LiveScope(machine, found.append)
        scope.channels(["mcc.path_feed"])
        machine.step(900)
        machine.keep()
        scope = LiveScope(machine, found.append)
        scope.channels(["mcc.path_feed"])
        scope.trigger(TriggerSetting("mcc.path_feed", "level", -1.0, pre=0.0, length=500))
        scope.fill(100)
        assert scope.record(tmp_path / "file.csv", None, None) == 1000
        machine.back(0.09)
        scope.back()
        assert [len(f.rows) for f in found] == [100] and scope.ring.end == 900
        scope.fill(600)
        assert [len(f.rows) for f in found] == [100, 500]
        (file,) = scope.end_records()  # a file goes on from where the machine went back to
        file.whole()
        assert file.rows == len((tmp_path / "file.csv").read_text().splitlines()) - 1 == 600


def test_a_record_is_whole_in_csv_and_numpy(tmp_path: Path) -> None:
    with LiveMachine("circle") as machine:
        scope = LiveScope(machine, lambda found: None)
        with pytest.raises(InputError, match="the scope has no channels"):
            scope.record(tmp_path / "x.csv", None, None)
        scope.channels(CHANNELS)
        scope.fill(3000)
        assert scope.record(tmp_path / "a.csv", 1000, None) == 1000
        assert scope.record(tmp_path / "b.npz", None, 5000) == 3000
        with pytest.raises(InputError, match=r"b\.npz is being written by another record"):
            scope.record(tmp_path / "b.npz", None, None)
        machine.keep()
        scope.fill(700)
        machine.back(machine.time)
        scope.back()
        scope.channels(["mcc.line"])  # the records go on with their own
        scope.fill(2800)
        for record in scope.end_records():
            record.whole()
        for name, told in (("a.csv", "is there already"), ("c.txt", r"\.csv or \.npz")):
            with pytest.raises(InputError, match=told):
                scope.record(tmp_path / name, None, None)
    there = recorded(CHANNELS, 1000, 5800)
    appears(tmp_path / "b.npz")
    with pytest.raises(InputError, match="is there already"):
        FileRecord(tmp_path / "b.npz", RecordHead(CHANNELS, ["", "", ""], 1), 0, None)
    text = (tmp_path / "a.csv").read_text().splitlines()
    head = "time [s],machine.table_position[1] [m],mcc.status,drives.torque[2] [N.m]"
    assert text[0] == head and len(text) == 5801 - 1000
    values = np.array([[float(x) for x in line.split(",")] for line in text[1:]])
    assert values[:, 1:].tobytes() == there.tobytes()
    assert values[:, 0] == pytest.approx(np.arange(1000, 5800) * 1e-4, abs=1e-12)
    with np.load(tmp_path / "b.npz") as arrays:
        assert arrays["time"].tobytes() == (np.arange(3000, 5000) * 100000 / 1e9).tobytes()
        for column, name in enumerate(CHANNELS):
            assert arrays[name].tobytes() == there[2000:4000, column].tobytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.csv", "b.npz"]


@pytest.mark.parametrize("sent", [b"", b'{"file": "x'], ids=["nothing", "half a head"])
def test_a_record_whose_machine_was_killed_before_it_began_leaves_nothing(
    sent: bytes, tmp_path: Path
) -> None:
    part = tmp_path / ".x.npz.part1"
    part.touch()
    command, options = child(f"from {FileRecord.__module__} import main; main()")
    done = subprocess.run([*command, str(part)], input=sent, capture_output=True, **options)
    assert (done.returncode, done.stderr) == (0, b"") and list(tmp_path.iterdir()) == []
