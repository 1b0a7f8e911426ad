"""Groups on two cards: each has the pulses it has alone, and those of the mcc FMU."""

from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from fmi_tools import ERROR, OK, Instance

import motionfmu

CHANNELS = {1: ("card1", [0, 1]), 2: ("card1", [3, 4, 5]), 3: ("card2", [2, 1, 0])}
SINGLE = """# One of the programs in the mcc FMU.
stop = 2.0
step = 1e-4
leave = ["mcc.hold", "mcc.abort", "mcc.override", "mcc.*_in", "card.*_aux", "card.io_*",
         "card.reg_*", "card.enc_phase"]

[component]
mcc  = "mcc"
card = "epcio"

[connect]
"card.host_*" = "mcc.card_*"
"mcc.card_*"  = "card.*"

[set]
"mcc.output_mode" = 0
"mcc.acc_time"    = 0.05
"mcc.dec_time"    = 0.05
"mcc.irq_jitter"  = 1e-3

[record]
signals = ["card.pulse_count", "mcc.done"]

[check]
"mcc.done" = { final = true }
"""


def run(**values: Any) -> motionfmu.Result:
    settings = {f"groups.{k}": v for k, v in values.items()}
    return motionfmu.load(ROOT / "scenarios" / "two_cards").run(set=settings)


@pytest.fixture(scope="module")
def together() -> motionfmu.Result:
    return run()


@pytest.mark.parametrize("group", [1, 2, 3])
def test_each_group_has_the_pulses_it_has_alone(group: int, together: motionfmu.Result) -> None:
    others = {f"group{n}_program": "" for n in CHANNELS if n != group}
    alone = run(**others)
    for card in ("card1", "card2"):
        mine = CHANNELS[group][1] if CHANNELS[group][0] == card else []
        pulses = alone[f"{card}.pulse_count"]
        assert np.array_equal(pulses[:, mine], together[f"{card}.pulse_count"][:, mine])
        assert not np.delete(pulses, mine, axis=1).any()
        assert not mine or np.ptp(pulses[:, mine], axis=0).min() > 1000
    signal = together["groups.path_feed"][:, group - 1]
    assert np.array_equal(signal, alone["groups.path_feed"][:, group - 1])


@pytest.mark.parametrize("group", [1, 2, 3])
def test_a_group_is_the_library_of_the_mcc_fmu(
    group: int, together: motionfmu.Result, tmp_path: Any
) -> None:
    (tmp_path / "scenario.toml").write_text(SINGLE)
    program, delay = (("circle", 0.0), ("square", 0.25), ("helix", 0.1))[group - 1]
    values = {
        "mcc.program": str(ROOT / f"scenarios/two_cards/{program}.ngc"),
        "mcc.start_delay": delay,
        "mcc.ppr": [10000, 10000, 20000 if group == 3 else 10000, 10000, 10000, 10000],
    }
    result = motionfmu.load(tmp_path).run(set=values)
    assert result.ok
    card, channels = CHANNELS[group]
    pulses = together[f"{card}.pulse_count"][:, channels]
    assert np.array_equal(result["card.pulse_count"][:, : len(channels)], pulses)


def test_a_held_group_disturbs_no_other(together: motionfmu.Result, tmp_path: Any) -> None:
    text = (ROOT / "scenarios/two_cards/scenario.toml").read_text()
    text = text.replace('"groups.hold", ', "").replace(
        "[record]",
        '[[drive]]\ninput = "groups.hold"\nat = [0.4, 0.7]\n'
        "value = [[false, true, false, false, false, false],"
        " [false, false, false, false, false, false]]\n\n[record]",
    )
    for name in ("circle", "square", "helix"):
        program = ROOT / f"scenarios/two_cards/{name}.ngc"
        (tmp_path / f"{name}.ngc").write_text(program.read_text())
    (tmp_path / "scenario.toml").write_text(text)
    held = motionfmu.load(tmp_path).run()
    assert {c.name for c in held.checks if not c.ok} == {"groups.path_feed[2]"}  # it stands
    for card, channels in (CHANNELS[1], CHANNELS[3]):
        pulses = held[f"{card}.pulse_count"][:, channels]
        assert np.array_equal(pulses, together[f"{card}.pulse_count"][:, channels])
    ends = [r.time[np.flatnonzero(r["groups.done"][:, 1])[0]] for r in (together, held)]
    # The hold acts behind 64 queued points, the release at once.
    assert ends[1] - ends[0] == pytest.approx(0.3 - 64 * 1.024e-3, abs=0.02)
    assert (held["groups.status"][:, 1] == 2).any()


ASKS = "M66 P2 L3 Q1.5\nM66 E3\nG1 Y#5399\nG38.2 X20 F600\nG0 X[#5061 + 2] Y[#5070 * 3]\nM2\n"


def asking(text: str, name: str, ones: tuple[str, ...], folder: Any) -> motionfmu.Result:
    """A run in which an input rises 0.3 s from the start and a probe touches at 1 s."""
    drives = "".join(
        f'[[drive]]\ninput = "{name}.{n}"\nat = [{at}]\nvalue = [{one}]\n\n'
        for (n, at), one in zip((("digital_in", 0.3), ("probe_in", 1.0)), ones, strict=True)
    )
    part = folder / "asks.ngc"
    part.write_text(ASKS)
    (folder / "scenario.toml").write_text(text.replace("[record]", drives + "[record]"))
    return motionfmu.load(folder).run(stop=2.0)


def found(result: motionfmu.Result, pulses: Any) -> None:
    """Nothing moves before the input; the program ends 2 mm behind the contact."""
    moved = result.time[np.flatnonzero(np.diff(pulses[:, :2], axis=0).any(axis=1))[0]]
    assert 0.3 < moved < 0.32
    contact = pulses[np.searchsorted(result.time, 1.0), 0] / 1000.0
    assert 3.0 < contact < 8.0
    # A bus period at 10 mm/s is one pulse, the ramp's place is where the contact was seen.
    assert pulses[-1, 0] / 1000.0 == pytest.approx(contact + 2.0, abs=2.5e-3)
    assert pulses[-1, 1] == 3000


def test_a_group_asks_for_inputs_and_a_probe(tmp_path: Any) -> None:
    text = (ROOT / "scenarios/two_cards/scenario.toml").read_text()
    for name in ("square", "helix"):
        text = text.replace(f'"{name}.ngc"', '""')
    text = text.replace('"circle.ngc"', '"asks.ngc"')
    text = text.replace(
        "[record]", '"groups.analog_in" = [' + "0, 0, 0, 0.5, " * 6 + "]\n\n[record]", 1
    )
    text = text[: text.index("[[figure]]")]
    ones = ("[4, 0, 0, 0, 0, 0]", "[true, false, false, false, false, false]")
    result = asking(text, "groups", ones, tmp_path)
    assert result["groups.done"][-1, 0] and not result["groups.error"].any()
    found(result, result["card1.pulse_count"])


def test_a_program_asks_for_inputs_and_a_probe(tmp_path: Any) -> None:
    text = SINGLE.replace(
        "[record]",
        '"mcc.program" = "asks.ngc"\n"mcc.probe_place" = 2\n"mcc.analog_in" = 0.5\n\n[record]',
    )
    result = asking(text, "mcc", ("4", "true"), tmp_path)
    assert result.ok
    found(result, result["card.pulse_count"])


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"group2_card": 1, "group2_channel": [3, 0, 0, 0, 0, 0]}, "group2_channel: no axis at"),
        ({"group2_card": 2}, "group2_channel: no axis at all, or a channel of card 2"),
        ({"group1_channel": [1, 1, 0, 0, 0, 0]}, "group1_channel: no axis at all, or a channel"),
        ({"group1_card": 0}, "there is no group"),
        ({"group3_program": "x.ngc"}, "group3_program: cannot read x.ngc: No such file"),
        ({"min_stock": 62, "batch": 16}, "min_stock 62 + batch 16"),
        ({"bus_period": 1.1e-7}, "bus_period = "),
    ],
)
def test_bad_groups_are_named(values: dict[str, Any], said: str) -> None:
    instance = Instance("mcc_groups", 3)
    for name, value in values.items():
        assert instance.set(name, value) == OK
    assert ERROR in (instance.enter(), instance.call("ExitInitializationMode"))
    assert said in instance.said
    instance.free()


def test_a_program_without_group_and_a_bad_program_are_named(tmp_path: Any) -> None:
    part = tmp_path / "part.ngc"
    part.write_text("G1 X1\nG1 V2\n")
    for name, said in (
        ("group2_program", "group2_program: group2_card is 0, there is no such group"),
        ("group1_program", "part.ngc: line 2: "),
    ):
        instance = Instance("mcc_groups", 2)
        assert instance.set(name, str(part)) == OK
        assert ERROR in (instance.enter(), instance.call("ExitInitializationMode"))
        assert said in instance.said
        instance.free()
