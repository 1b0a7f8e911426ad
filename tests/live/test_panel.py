"""Panels of the FMUs, and a machine of the library worked by them."""

from pathlib import Path

import numpy as np
import pytest

from motionfmu import run
from motionfmu.base.errors import InputError
from motionfmu.live import LiveMachine, panel
from motionfmu.live.panel import OperatorPanel, panel_of

ROOT = Path(__file__).resolve().parents[2]
CARRIED = sorted(p.parent.name for p in ROOT.glob("fmus/*/panel.toml"))


@pytest.mark.parametrize("fmu", CARRIED)
def test_names_of_a_panel_are_variables_that_fit_their_use(fmu: str) -> None:
    from motionfmu.scenarios import fmus

    found, ports = panel_of(fmu), fmus.ports(fmu)
    assert isinstance(found, OperatorPanel)
    settable = [*found.key, *found.dial, *found.fault]
    settable += [found.stop] if found.stop else []
    for name in settable:
        port = ports[name]
        assert port.causality == "input" or (port.causality == "parameter" and port.tunable), name
    for name, key in found.key.items():
        assert ports[name].type == "Boolean", (name, key)
    for name in (found.readout.low, found.readout.high, found.readout.limited):
        assert name is None or ports[name].causality == "parameter"
    for name in found.lamp:
        assert ports[name].causality == "output" and ports[name].type == "Boolean", name


def test_a_panel_that_names_no_variable_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for text, said in (
        ('title = "x"\nstate = "stauts"', r"panel\.toml: epcio has no variable 'stauts'"),
        ('title = "x"\n[key.io_stop]\nlabel = "x"\nkind = "pull"', "kind"),
        ("title = ", "panel.toml"),
    ):
        monkeypatch.setattr(panel.fmus, "extra", lambda name, file, text=text: text)
        panel_of.cache_clear()
        with pytest.raises(InputError, match=said):
            panel_of("epcio")
    panel_of.cache_clear()


FAR = {"mcc.home_order": [1, 0, 0, 0, 0, 0], "mcc.home_search": 20.0}


def test_a_search_that_finds_no_switch_is_an_alarm_in_words() -> None:
    from motionfmu.scenarios import fmus

    with LiveMachine(run.scenario({"machine": "mill3", "stop": 1.0}, name="home"), FAR) as mill:
        mill.step(3000)
        mill.set("mcc.go_home", True)
        mill.step(10000)
        declared = fmus.ports("mcc")["error"].declared
        assert declared is not None
        assert f"{mill['mcc.error']} axis 1 finds no home switch" in declared[1]


def test_the_window_of_the_tool_table_shows_what_lines_by_hand_make_of_it(tmp_path: Path) -> None:
    file = tmp_path / "tools.tbl"
    file.write_text("".join(f"T{n} P{n} Z{n}.5 D{2 * n}\n" for n in range(1, 24)))
    made = run.scenario({"machine": "mill3", "stop": 1.0}, name="tools")
    with LiveMachine(made, {"mcc.tool_table": str(file)}) as mill:
        mill.step(100)
        assert mill["mcc.tool_rows"] == 23
        assert list(mill["mcc.tool_listed"]) == list(range(1, 11))
        mill.set("mcc.tool_row", 21)
        mill.set("mcc.mdi", "G10 L1 P22 X-1.5 R7")
        mill.set("mcc.mdi_seq", 1)
        mill.step(1000)
        assert list(mill["mcc.tool_listed"]) == [21, 22, 23, *[-1] * 7]
        offset = np.reshape(mill["mcc.tool_offset"], (10, 6))
        assert list(offset[1]) == [-1.5, 0.0, 22.5, 0.0, 0.0, 0.0]
        assert list(mill["mcc.tool_diameter"][:4]) == [42.0, 14.0, 46.0, 0.0]


@pytest.mark.more
def test_the_mill_finds_its_origins_from_anywhere() -> None:
    start = [0.1234, -0.0567, -0.2345, 0.0, 0.0, 0.0]
    tables = {"machine": "mill3", "stop": 1.0, "set": {"machine.start_position": start}}
    with LiveMachine(run.scenario(tables, name="home")) as mill:
        mill.step(5000)
        mill.set("mcc.go_home", True)
        for _ in range(100):
            mill.step(5000)
            if mill["mcc.homed"] or mill["mcc.error"]:
                break
        assert mill["mcc.homed"] and mill["mcc.error"] == 0
        mill.step(5000)
        # The origin is the index of each motor that is 0 of the scale.
        np.testing.assert_allclose(mill["machine.table_position"][:3], 0.0, atol=2e-5)
        np.testing.assert_allclose(mill["mcc.position"][:3], 0.0, atol=1e-2)


def test_an_encoder_that_is_unplugged_ends_in_an_alarm() -> None:
    """The loop pulls the axis away from what it believes, until the error is too large."""
    with LiveMachine(run.scenario({"machine": "mill3", "stop": 1.0}, name="cut")) as mill:
        mill.step(5000)
        mill.set("mcc.jog_speed", 0.1)
        mill.set("mcc.jog[1]", 1)
        mill.step(1000)
        mill.set("card.enc_unplugged[1]", True)
        moved = mill["machine.table_position"][0]
        mill.step(8000)
        assert mill["mcc.error"] == 0xF801
        assert mill["card.err_count"][0] > 20000
        assert mill["machine.table_position"][0] > moved + 0.02


def test_a_journal_of_faults_is_a_scenario_with_the_same_bits(tmp_path: Path) -> None:
    signals = ["card.enc_count", "machine.table_position"]
    with LiveMachine(run.scenario({"machine": "mill3", "stop": 1.0}, name="cut")) as mill:
        mill.step(3000)
        mill.set("mcc.jog[2]", -1)
        mill.step(500)
        mill.set("card.enc_unplugged[2]", True)
        mill.set("machine.force[1]", 500.0)
        mill.step(500)
        mill.set("card.enc_unplugged[2]", False)
        traced = mill.trace(signals, 500)
        scenario = run.load(mill.save(tmp_path / "cut"))
    result = scenario.changed(record={"every": 1, "signals": signals}).run()
    for name, rows in traced.items():
        assert len(result[name]) == 4500
        assert (result[name][-500:] == rows).all()
