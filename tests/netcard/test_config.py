"""The card's configuration: one description, every fault told with line and value."""

import re
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT
from hypothesis import given, settings
from hypothesis import strategies as st

from motionfmu.base.errors import InputError
from motionfmu.cards import config_tables, load
from motionfmu.cards.config import faults, read
from motionfmu.cards.fields import choices, described

EXAMPLE = ROOT / "examples/network_card_firmware/card.toml"
TEXT = EXAMPLE.read_text()
# Type, name, elements, lowest and highest value of each setting of the card.
SETTING = re.compile(r'X\((\w+), +(\w+), (?:\[(\d+)\])?,\s*"[^"]*", [^,]+, ([^,]+), ([^,]+),')
HEADER = (ROOT / "src/controllers/netcard/card_settings.h").read_text().replace("\\\n", "")
KNOWN = {m[2]: m for m in SETTING.finditer(HEADER)}


def told(text: str) -> list[str]:
    with pytest.raises(InputError) as error:
        read(text, "card.toml")
    return str(error.value).splitlines()


def test_the_example_is_what_its_file_says() -> None:
    c = load(EXAMPLE)
    assert [a.name for a in c.axes] == ["X", "Y"]
    assert (c.axes[0].maximum, c.axes[1].maximum, c.axes[0].home_travel) == (410, 290, 450)
    assert [i.action for i in c.inputs[:5]] == ["start", "stop", "home", "pause", "none"]
    assert len(c.inputs) == len(c.outputs) == 16
    assert (c.outputs[0], c.outputs[5], c.outputs[1]) == ("pen", "valve", "")
    assert c.motion.period == 0.001 and c.fifo.depth == 512 and c.tasks.home_active == 2


def test_parameters_are_settings_of_the_card_within_their_ranges() -> None:
    assert len(KNOWN) == len(re.findall(r"\bX\(\w+, ", HEADER)) - 1 > 50  # one is the comment's
    found = load(EXAMPLE).as_parameters()
    assert found.keys() <= KNOWN.keys()
    for name, value in found.items():
        kind, elements, low, high = (KNOWN[name][k] for k in (1, 3, 4, 5))
        values = value if isinstance(value, list) else [value]
        assert len(values) == int(elements or 1), name
        for one in values:
            assert isinstance(one, bool) == (kind == "bool"), name
            assert kind == "bool" or float(low) <= one <= float(high), name


def test_a_number_that_the_file_may_have_is_one_that_the_card_takes_and_the_other_way() -> None:
    narrower = {"period_ns"} | {name for name in KNOWN if name.startswith("priority")}
    seen = 0
    for table in (
        config_tables.Network,
        config_tables.CardAxis,
        config_tables.CardMotion,
        config_tables.Pulse,
        config_tables.Fifo,
    ):
        for field, what in described(table).values():
            row = KNOWN.get(what.parameter)
            if row and not choices(field) and row[1] != "bool" and row[2] not in narrower:
                seen += 1
                low = max(float(row[4]), what.low if row[2] == "card_id" else -1e99)  # 0 is none
                assert (what.low, what.high) == (low, float(row[5])), row[2]
    assert seen > 15


def test_parameters_are_pulses_and_an_axis_that_is_not_there_stands() -> None:
    found = load(EXAMPLE).as_parameters()
    assert found["position_high"][:2] == [410_000, 290_000]
    assert found["position_low"][0] == -5000 and found["home_order"] == [1, 2, 0, 0]
    assert found["speed_max"][0] == 200_000 and found["jerk_max"][0] == 50_000_000
    assert found["origin_trigger"][:2] == [1, 1] and found["limit_high"][0] is True
    assert found["in_action"][:5] == [1, 3, 4, 2, 0]
    assert (found["period_ns"], found["pulse_width_ns"]) == (1_000_000, 1000)


@pytest.mark.parametrize(
    ("old", "new", "place", "why"),
    [
        ("192.168.1.50", "192.168.1.500", "network.ip", "500"),
        ("192.168.1.50", "192.168.1.255", "network.ip", "an end of the network 192.168.1.0/24"),
        ("255.255.255.0", "255.0.255.0", "network.netmask", "ones, then zeros"),
        ('"192.168.1.1"', '"10.0.0.1"', "network.gateway", "not in the card's network"),
        ("02:00", "01:00", "network.mac", "group"),
        ("02:00", "02-00", "network.mac", "six bytes"),
        ("port    = 8765", "port = 65536", "network.port", "1 .. 65535 wanted"),
        ("port    = 8765", 'port = "4013"', "network.port", "valid integer"),
        ("pulses_per_mm    = 1000", "pulses_per_mm = 1000.0005", "axes.0.pulses_per_mm", "whole"),
        ("pulses_per_mm    = 1000", "pulses_per_mm = nan", "axes.0.pulses_per_mm", "finite"),
        ("minimum          = -5 ", "minimum = 410 ", "axes.0.minimum", "not < maximum = 410"),
        ("maximum          = 410", "maximum = 1e7", "axes.0.maximum", "10000000000 pulses"),
        ("speed_max        = 200 ", "speed_max = 501 ", "axes.0.speed_max", "501000 pulses/s"),
        ("speed_min        = 0.5", "speed_min = 201", "axes.0.speed_min", "not <= speed_max"),
        ("home_slow        = 1", "home_slow = 30", "axes.0.home_slow", "not <= home_speed"),
        ('"falling"', '"fall"', "axes.0.origin_trigger", "'rising', 'falling'"),
        ("jerk_max         = 50000 ", "jerk_max = 0.0 ", "axes.0.jerk_max", "1 .. "),
        ('name             = "X"', 'name = "Y"', "axes.0.name", "axis 1 of a card is X"),
        ("period       = 0.001 ", "period = 0.00025001 ", "motion.period", "multiple of 20"),
        ("period       = 0.001 ", "period = 0.0002 ", "motion.period", "250000 .. 10000000"),
        ("tolerance    = 0.02 ", "tolerance = 0 ", "motion.tolerance", "greater than 0"),
        ("output   = 0", "output = 16", "motion.pen.output", "0 .. 15 wanted"),
        ("output   = 0", 'axis = "Z"\nkind = "axis"', "motion.pen.axis", "no such axis"),
        ('5 = "valve"', '5 = "pen"', "outputs.5", "two outputs of one name"),
        ('5 = "valve"', '16 = "valve"', "outputs.16", "pins are 0 .. 15"),
        ('5 = "valve"', '5 = "*/ x"', "outputs.5", "should match"),
        ("[inputs.3]", "[inputs.x]", "inputs.x", "pins are 0 .. 15"),
        ('action = "pause"', 'action = "paus"', "inputs.3.action", "; did you mean 'pause'?"),
        ("dwell    = 0.03 ", "dwel = 0.03 ", "motion.pen.dwel", "key; did you mean 'dwell'?"),
        ("maximum          = 410", "maximun = 4", "axes.0.maximun", "key; did you mean 'maximum'?"),
        ('action = "pause"', 'acton = "pause"', "inputs.3.acton", "did you mean 'action'?"),
        ("[network]", "[netwrok]", "netwrok", "unknown key; did you mean 'network'?"),
        ("[network]", "[tasks]\npause = 5\n[network]", "tasks.pause", "5 is not < stop = 4"),
    ],
)
def test_a_wrong_value_is_told_once_with_its_line(old: str, new: str, place: str, why: str) -> None:
    assert old in TEXT
    text = TEXT.replace(old, new, 1)
    if new.endswith('"axis"'):
        text = text.replace('kind     = "output"\n', "")
    (message,) = told(text)
    first = next(part for part in new.split("\n") if not part.startswith("[tasks"))
    at = text[: text.index(first)].count("\n") + 1
    assert re.match(rf"card\.toml:{at}: {re.escape(place)}\b", message), message
    assert why in message


def test_a_pulse_is_shorter_than_half_its_period() -> None:
    text = TEXT + "[pulse]\nwidth = 2.5e-6\n"
    assert read(text, "").axes[0].speed_max == 200  # 200,000 pulses/s, 2.5 us high and low
    messages = told(text.replace("2.5e-6", "2.6e-6"))
    assert [m.split(" ")[1] for m in messages] == ["axes.0.speed_max", "axes.1.speed_max"]
    assert all("lets 192308" in m for m in messages)


def test_everything_wrong_is_told_at_once_in_the_order_of_the_file() -> None:
    text = TEXT.replace("8765", "0").replace("home_back ", "home_bak ", 1)
    text = text.replace('"stop"', '"halt"').replace("dwell    = 0.03", "dwell = -1")
    text = text.replace("maximum          = 290", "maximum = -10")
    messages = told(text)
    places = [m.split(" ")[1].rstrip(":") for m in messages]
    assert places == [
        "network.port",
        "axes.0.home_bak",
        "axes.1.minimum",
        "motion.pen.dwell",
        "inputs.1.action",
    ]
    lines = [int(m.split(":")[1]) for m in messages]
    assert lines == sorted(lines)
    assert messages[2].endswith("-5.0 is not < maximum = -10.0")


def test_a_fault_hides_no_other_and_makes_no_other() -> None:
    text = TEXT.replace(
        "home_back        = 2\nhome_travel      = 320", "home_back = 0\nhome_travl = 320"
    )
    messages = told(text.replace('"192.168.1.50"', '"192.168.1"'))
    places = [m.split(" ")[1] for m in messages]
    assert places == ["network.ip", "axes.1.home_back", "axes.1.home_travl"]
    # The speed of the exact approach is above the default that stands in for what is wrong.
    text = TEXT.replace("home_speed       = 20", 'home_speed = "50"', 1)
    messages = told(text.replace("home_slow        = 1", "home_slow = 30", 1))
    assert [m.split(" ")[1] for m in messages] == ["axes.0.home_speed"]


def test_no_axis_and_five_axes_are_refused() -> None:
    assert "axes" in told("[network]\nid = 2\n")[0]
    axis = '[[axes]]\nname = "X"\npulses_per_mm = 100\nminimum = 0\nmaximum = 9\nspeed_max = 30\n'
    axis += "acceleration_max = 9\n"
    assert read(axis, "").axes[0].speed_max == 30
    assert "at most 4" in told(axis * 5)[0]
    assert told(axis.replace("maximum = 9\n", ""))[0].startswith("card.toml:1: axes.0.maximum: ")


def test_a_file_that_is_not_there_or_no_toml_is_one_message(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.toml: No such file"):
        load(tmp_path / "none.toml")
    assert told("[network\n")[0].startswith("card.toml:1: ")


VALUES: Any = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=8),
    st.lists(st.integers(), max_size=3),
)
KEYS = st.sampled_from(
    "network axes motion inputs outputs tasks name minimum ip mac period pen 3 x".split()
)
TREES = st.recursive(VALUES, lambda inner: st.dictionaries(KEYS, inner, max_size=4), max_leaves=12)


@settings(max_examples=40)
@given(st.dictionaries(KEYS, st.one_of(TREES, st.lists(TREES, max_size=3)), max_size=4))
def test_whatever_stands_in_a_file_is_told(found: dict[str, Any]) -> None:
    wrong = faults(found)
    assert wrong  # it has no whole axis
    assert all(place and why for place, _, why in wrong)


@pytest.mark.parametrize("depth", [10**400, -(10**400)])
def test_a_whole_number_of_any_size_is_refused_in_words(depth: int) -> None:
    wrong = faults({"fifo": {"depth": depth}})
    assert [why for place, _, why in wrong if place == "fifo.depth"] != []
