"""Link and host of a network motion card: streams, cuts, an upload that goes on where it was."""

import copy
import itertools
import random
from pathlib import Path
from typing import Any

import pytest
from fmi_tools import ERROR, OK, Instance
from link_ends import STEP, Card, Link, Stream

BOTH = pytest.mark.parametrize("fmi", [2, 3])
NOISE = random.Random(5).randbytes(60000)
KEY = bytes(range(32))
START, PAUSE, STOP, HOME = 32, 33, 34, 35


def test_order_and_content_are_kept() -> None:
    """Jitter of many periods, losses, slow readers: each stream arrives as it was sent."""
    card, host = Stream(NOISE[:9000], 77), Stream(NOISE[9000:20000], 130)
    rig = Link(card, host, jitter=20e-3, loss=0.01, segment=100, seed=3)
    rig.run(2.5)
    assert bytes(card.got[0]) == host.data
    assert bytes(host.got[0]) == card.data
    assert min(rig.link.get("stalls")) > 0
    assert rig.link.get("on_the_way") == [0, 0]
    assert rig.link.get("card_bytes") == [11000.0]
    rig.link.free()


@pytest.mark.parametrize(("rate", "segment", "overhead"), [(5e5, 536, 78), (2e5, 100, 78)])
def test_rate_is_that_of_the_line(rate: float, segment: int, overhead: int) -> None:
    card = Stream()
    rig = Link(card, Stream(NOISE[:40000]), rate=rate, segment=segment, overhead=overhead)
    rig.run(0.5)
    # From one arrival to another; the first segment holds what the grid gave it.
    at = [k for k in range(1, len(card.times)) if card.times[k] > card.times[k - 1]]
    first, last = at[1], at[-1]
    theory = 8 * (last - first) * (1 + overhead / segment) / rate
    assert card.times[last] - card.times[first] == pytest.approx(theory, rel=0.01)
    assert theory > 0.4
    rig.link.free()


def test_delay_and_jitter_are_bounded_on_both_sides() -> None:
    """A byte each 10 ms: it comes behind delay, within jitter and three instants of the grid."""
    card, late = Stream(), []
    host = Stream()
    rig = Link(card, host, delay=5e-3, jitter=4e-3)
    rig.run(0.01)
    for _ in range(150):
        host.data += b"x"
        sent = round(rig.link.time / STEP) * STEP
        rig.run(0.015)
        late.append(card.times[-1] - sent)
    assert len(card.times) == 150
    assert 5e-3 <= min(late) <= 8e-3
    assert 9e-3 <= max(late) <= 12.001e-3
    rig.link.free()


def test_a_lost_segment_is_a_stall_and_no_gap() -> None:
    card = Stream()
    rig = Link(card, Stream(NOISE[:40000]), loss=0.05, stall=0.3)
    rig.run(1.5)
    gaps = [b - a for a, b in itertools.pairwise(card.times)]
    long = [g for g in gaps if g > 0.1]
    assert bytes(card.got[0]) == NOISE[: len(card.got[0])]
    # Segments lost while one is waited for cost nothing more.
    assert 1 <= len(long) <= rig.link.get("stalls")[0]
    assert all(0.25 < g <= 0.3 + 3 * STEP for g in long)
    rig.link.free()


@BOTH
def test_a_cut_takes_what_is_on_its_way_and_nothing_else(fmi: int) -> None:
    """At a time, behind bytes either way: what came is a beginning."""
    card, host = Stream(NOISE[:20000]), Stream(NOISE[20000:40000])
    cuts = {"cut_at": [0.05] + 7 * [0.0], "cut_behind_card": [700] + 7 * [0]}
    rig = Link(
        card, host, fmi, delay=2e-3, away=0.02, rate=1e6, cut_behind_host=[9000] + 7 * [0], **cuts
    )
    ways = []
    while rig.link.time < 0.4:
        ways.append((rig.link.get("connection")[0], rig.link.get("cuts")[0]))
        rig.step()
    assert sorted(set(ways)) == [(0, 0), (0, 1), (0, 2), (0, 3), (1, 0), (2, 1), (3, 2), (4, 3)]
    assert len(card.got[0]) == 700
    assert sum(map(len, host.got[:3])) == 9000
    for got, sent, data in ((card.got, host.sent, host.data), (host.got, card.sent, card.data)):
        for part, most in zip(got, sent, strict=True):
            assert bytes(part) == data[: len(part)]
            assert 0 < len(part) <= most
        assert len(got[0]) < sent[0]
    rig.link.free()


def test_an_end_that_breaks_the_rule_loses_the_connection() -> None:
    link = Instance("ethernet_link", 3).initialize({"bus_period": STEP})
    assert link.set("card_connect", True) == OK
    for _ in range(4):
        assert link.step(STEP) == OK
    assert link.get("connection") == [1]
    assert link.set("card_tx_count", 513) == OK
    for _ in range(2):
        assert link.step(STEP) == OK
    assert (link.get("connection"), link.get("faults")) == ([0], [1])
    link.free()


def job_file(folder: Path, pages: int) -> Path:
    path = folder / "job.mcj"
    path.write_bytes(NOISE[: pages * 256])
    return path


def host_of(job: Path, fmi: int = 3, **values: Any) -> Instance:
    orders = {"command": [HOME, START, PAUSE, STOP] + 12 * [0], "status_interval": 0.0}
    times = [0.02, 0.03, 0.031, 0.06] + 12 * [0.0]
    start = {"job": str(job), "bus_period": STEP, "command_at": times, **orders, **values}
    return Instance("card_host", fmi).initialize(start)


@pytest.mark.parametrize("key", [b"", KEY], ids=["open", "key"])
def test_an_upload_goes_on_where_the_link_was_cut(key: bytes, tmp_path: Path) -> None:
    """Four cuts: the card sees no page twice, each command once, and has the job in the end."""
    pages = 40
    card = Card(key or bytes(32), pages)
    host = host_of(job_file(tmp_path, pages), key=key.hex())
    cuts = {"cut_behind_card": [1500, 4000, 9000] + 5 * [0], "cut_at": [0.08] + 7 * [0.0]}
    rig = Link(card, host, delay=3e-3, away=0.0, connect_time=0.0, **cuts)
    rig.run(0.6)
    assert rig.link.get("cuts") == [4]
    assert rig.link.get("faults") == [0]
    assert card.stored == NOISE[: pages * 256]
    assert card.twice == 0
    assert host.get("upload") == [5]
    assert 0.05 < host.get("stored_at")[0] < 0.5
    again, sent = host.get("pages_again")[0], host.get("pages_sent")[0]
    assert sent - again == pages
    assert 0 < again <= 4 * 16  # at most the credit at each cut
    assert card.order == [HOME, START, PAUSE, STOP]
    assert host.get("command_stage")[:5] == [3, 3, 3, 3, 0]
    assert host.get("command_code")[:5] == [0, 0, 0, 0, -1]
    times = list(zip(host.get("command_sent"), host.get("command_answered"), strict=True))[:4]
    assert all(sent + 6e-3 < answered for sent, answered in times)
    rig.link.free()
    host.free()


def test_a_new_connection_waits_until_both_ends_have_let_go_of_the_old_one(tmp_path: Path) -> None:
    """The host sees a cut some instants late: what it shows till then is not read."""
    card, host = Card(bytes(32), 8), host_of(job_file(tmp_path, 8), bus_period=7 * STEP)
    rig = Link(card, host, away=0.0, connect_time=0.0, cut_at=[0.05, 0.101, 0.153] + 5 * [0.0])
    rig.run(0.5)
    assert (rig.link.get("cuts"), rig.link.get("faults")) == ([3], [0])
    assert card.stored == NOISE[: 8 * 256]
    rig.link.free()
    host.free()


def test_a_host_without_the_key_gets_nowhere(tmp_path: Path) -> None:
    host = host_of(job_file(tmp_path, 3), key=KEY.hex())
    card = Card(bytes(32), 3)
    rig = Link(card, host)
    with pytest.raises(Exception, match="the PC has another key"):
        rig.run(0.1)
    assert host.get("up") == [False]
    rig.link.free()
    host.free()


def seen(rig: Link, host: Instance) -> str:
    return repr((rig.link.outputs(), host.outputs()))


def test_versions_parts_and_states_give_the_same_bits(tmp_path: Path) -> None:
    """In mid-upload: FMI 2 and 3, steps in two, and on from a state that came back as bytes."""
    job = job_file(tmp_path, 30)
    ends = []
    for fmi, parts in ((2, 1), (3, 1), (3, 2)):
        host = host_of(job, fmi, key=KEY.hex())
        rig = Link(Card(KEY, 30), host, fmi, jitter=2e-3, cut_behind_card=[3000] + 7 * [0])
        rig.run(0.04, parts)
        assert 0 < host.get("pages_sent")[0] < 30
        kept = []
        for fmu in (rig.link, host):
            state = fmu.save()
            kept.append((fmu.serialize(state), fmu.time))
            fmu.free_state(state)
        card = copy.deepcopy(rig.card)
        rig.run(0.2, parts)
        ends.append(seen(rig, host))
        assert host.get("upload") == [5]
        rig.card = card
        for fmu, (data, time) in zip((rig.link, host), kept, strict=True):
            status, state = fmu.deserialize(data)
            assert status == OK
            assert fmu.restore(state, time) == OK
            fmu.free_state(state)
        rig.run(0.2, parts)
        ends.append(seen(rig, host))
        rig.link.free()
        host.free()
    assert len(set(ends)) == 1


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"key": "12"}, "key: 2 characters, not 64 hexadecimal digits"),
        ({"key": 63 * "0" + "g"}, "key: character 64 is not a hexadecimal digit"),
        ({"command": [5] + 15 * [0]}, "command[1] = 5: not 32 to 37"),
        ({"job": "/nowhere"}, "job: cannot read /nowhere: No such file or directory"),
        ({"job": "odd"}, "odd is not 1 to 8192 pages of 256 bytes"),
        ({"bus_period": 1.5e-8}, "bus_period"),
    ],
)
def test_a_wrong_parameter_is_told(values: dict[str, Any], said: str, tmp_path: Path) -> None:
    if values.get("job") == "odd":
        (tmp_path / "odd").write_bytes(bytes(100))
        values = {"job": str(tmp_path / "odd")}
    host = Instance("card_host", 3)
    status = max(host.set(name, value) for name, value in values.items())
    status = max(status, host.enter(), host.call("ExitInitializationMode"))
    assert status >= ERROR
    assert any(said in text for _, _, text in host.messages)
    host.free()
