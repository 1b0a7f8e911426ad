"""motionfmu.virtual.mcc's settings: those of the C structs, with names and units of the FMU."""

import re
import tomllib
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import motionfmu.virtual.mcc as mcc
from motionfmu.base.binding import Struct
from motionfmu.base.errors import InputError
from motionfmu.virtual.mcc import VirtualCard
from motionfmu.virtual.mcc.state import configuration


def members(header: str, struct: str) -> set[str]:
    """Names of a struct's members, without those that are structs."""
    body = re.search(rf"struct {struct} \{{\n(.*?)\n\}};", header, re.S)
    assert body
    text = re.sub(r"/\*.*?\*/", "", body[1], flags=re.S).replace("enum ", "")
    found = set()
    for line in text.split(";"):
        if (words := line.split()) and words[0] != "struct":
            found |= {w.split("[")[0] for w in " ".join(words[1:]).replace(",", " ").split()}
    return {f.strip("*") for f in found if f}


# What a setting is called where the struct says it shorter, and those that the FMU has not.
RENAMED = {
    "used": "active", "pitch": "lead", "rpm": "max_rpm", "inverted": "pos2encoder_dir",
    "index_low": "index_on", "check_ot": "check_over_travel", "track_limit": "track_error_limit",
    "acc": "axis_acc", "jerk": "axis_jerk", "bus": "bus_period", "ipo": "ipo_period",
    "latency": "irq_latency", "jitter": "irq_jitter", "interpreter": "interpreter_period",
    "process": "process_period", "module_unit": "module_unit_time", "module_most": "module_units",
    "home_direction": "home_dir",
}  # fmt: skip
OWN = {"max_dda", "ptp_ratio", "limit_check", "encoder_backward"}


def test_settings_have_names_and_units_of_the_fmu() -> None:
    fmu = tomllib.loads((ROOT / "fmus/mcc/fmu.toml").read_text())["parameter"]
    have = {n: unit for n, (_, unit) in mcc.defaults().items() if not n.startswith("asyn_")}
    assert set(have) - set(fmu) == OWN
    units = {n: fmu[n]["unit"] for n in set(have) - OWN if "unit" in fmu[n]}
    assert units == {n: have[n] for n in units}
    other = {have[n] for n in set(have) - set(units)}
    assert other <= {"", "bit", "bits", "pulses", "counts"}  # those FMI has no unit for
    # As the FMU takes them: feed [mm/min], times in whole clocks, the index ON when high.
    assert mcc.defaults()["feed"][0] == fmu["feed"]["start"] == 600.0
    assert mcc.defaults()["bus_period"][0] == fmu["bus_period"]["start"] == 1e-4
    assert mcc.defaults()["index_on"][0].all() and fmu["index_on"]["start"] is True
    config = configuration({"ipo_period": 1.00001e-3, "pos2encoder_dir": [1, 0, 0, 0, 0, 1]})
    assert config["ipo_period"] == 1e-3 and config["pos2encoder_dir"].sum() == 2
    for name, value in (("ipo_period", np.nan), ("module_time", 1e300), ("active", 2)):
        with pytest.raises(InputError, match=f"^{name} = .*: one .* wanted"):
            configuration({name: value})


def test_every_setting_of_library_and_pc_has_its_name() -> None:
    have = set(mcc.defaults())
    machine = (ROOT / "src/controllers/mcc/machine.h").read_text()
    pc = (ROOT / "src/controllers/pc/pc.h").read_text()
    # A program of the FMU, its start and its panel have calls here.
    wanted = members(machine, "machine") | members(machine, "machine_axis")
    modules = {"priority", "offset", "time", "unit", "most"}
    wanted |= members(pc, "pc_config") - {"start", "wait_start", "no_panel"} - modules
    wanted |= {f"module_{n}" for n in modules}
    wanted |= {f"asyn_{n}" for n in members(machine, "machine_asyn")}
    homing = (ROOT / "src/controllers/mcc/home.h").read_text()
    wanted |= {f"home_{n}" for n in members(homing, "home_config")}
    wanted = {RENAMED.get(n, n) for n in wanted}
    assert wanted <= have, wanted - have


def test_every_reading_has_its_name() -> None:
    station = (ROOT / "src/controllers/station/station.h").read_text()
    assert members(station, "station_reading") == set(Struct("reading"))


def test_member_finder_can_fail() -> None:
    text = "struct a {\n    int b, c[4];  /* d */\n    struct e f;\n    double g[2][AXES];\n};\n"
    assert members(text, "a") == {"b", "c", "g"}


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"fed": 1.0}, "no setting 'fed'; did you mean 'feed'?"),
        ({"feed": "fast"}, "feed = 'fast': one number wanted"),
        ({"ppr": 1.5}, "ppr = 1.5: one whole number or 6 of them wanted"),
        ({"lead": [1, 2]}, "lead = [1, 2]: one number or 6 of them wanted"),
        ({"acc_type": "TS"}, "acc_type = 'TS': one letter wanted"),
        ({"active": 2}, "active = 2: one truth value or 6 of them wanted"),
        ({"acc_time": 0.1, "feed": -1.0}, "feed = -1.0 is out of range"),
        ({"bus_period": 0}, "bus_period = 0 is out of range"),
        ({"min_stock": 60, "batch": 16}, "min_stock = 60 is out of range"),
        ({"min_stock": 55, "batch": 16}, "do not fit together: min_stock = 55, batch = 16"),
        ({"feed": 120e3, "max_feed": 90e3}, "feed = 120000.0 is out of range"),
        ({"output_mode": 3}, "output_mode = 3 is out of range"),
    ],
)
def test_wrong_setting_is_named(settings: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        VirtualCard(**settings)
