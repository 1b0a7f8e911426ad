"""Uniform motions that linear models are made about, against the running plant."""

import functools
import json
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from hydraulic_rig import Case, drive, started
from plant_library import Library
from test_hydraulics_theory import INCH, esposito
from typer.testing import CliRunner

from motionfmu import InputError
from motionfmu.analysis import linear
from motionfmu.analysis.linear.plant import Linearised, Point
from motionfmu.cli import app

LOADED = ROOT / "scenarios/hydraulic_gain"
VISCOUS = esposito() | {"table_viscous": 1000.0}


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return Library(
        ROOT / "fmus/hydraulic_axis/fmu.toml", tmp_path_factory.mktemp("hydraulic"), built=True
    )


def found(parameters: dict[str, float], **stated: float) -> Point:
    case = Case(**parameters)
    return _linearised().point(case.p, stated)


@functools.cache
def _linearised() -> Linearised:
    return Linearised(Case().ode)


@pytest.mark.parametrize(
    ("parameters", "speed", "load"),
    [
        ({}, 0.105, {}),
        ({}, 0.2, {"force": -800.0}),
        ({}, -0.235, {"force": 0.0}),
        (esposito(), 0.05, {"force": 0.0}),
        (VISCOUS, 0.0495, {}),
        (VISCOUS, -0.05, {"force": 2000.0}),
    ],
    ids=["slow", "load", "fast", "book", "viscous", "viscous and load"],
)
def test_the_plant_moves_as_the_motion_says(library, parameters, speed, load) -> None:
    """With the voltage that was found, the running plant reaches the speed and stays at it."""
    at = found(parameters, table_speed=speed, **load)
    force = load.get("force", 0.0)
    assert at.values["table_speed"] == pytest.approx(speed, rel=1e-9)
    assert at.values["table_position"] == 0.0 and at.values["force"] == force
    ends = 4.5 * INCH if parameters else 0.09
    run = started(library, **parameters, start_position=-ends if speed > 0.0 else ends)
    run.set(force=force)
    seen = drive(run, 0.35, 1e-3, ("table_speed",), voltage=at.values["voltage"])[-50:, 0]
    assert seen == pytest.approx(speed, rel=2e-4)


def test_the_fastest_motion_is_found_and_the_next_is_not(library) -> None:
    """At 10 V the amplifier gives all it has."""
    run = started(library, start_position=-0.09)
    fastest = drive(run, 0.4, 1e-3, ("table_speed",), voltage=10.0)[-1, 0]
    assert 0.24 < fastest < 0.25
    at = found({}, table_speed=0.99 * fastest, force=0.0)
    assert 9.5 < at.values["voltage"] < 10.0
    with pytest.raises(
        ValueError, match=r"no uniform motion with table_speed = .*, while force = 0"
    ):
        found({}, table_speed=1.01 * fastest, force=0.0)


@pytest.mark.parametrize("speed", [0.12, 0.24])
def test_how_long_a_motion_lasts(speed: float) -> None:
    """From the middle to the end stop, 0.1 m; looked at every 12 %."""
    lasts = found({}, table_speed=speed, force=0.0).lasts
    assert 0.88 * 0.1 / speed < lasts <= 0.1 / speed


def test_an_input_that_nobody_stated_is_told(tmp_path: Path) -> None:
    """What the scenario does with the load is kept, and said on console and page."""
    at = {"axis.table_speed": 0.05, "axis.table_position": 0.0}
    point = linear.model(LOADED, at=at).points["axis"]
    assert point.stated == {"table_speed": 0.05, "table_position": 0.0}
    assert point.held == {"force": -1000.0} and point.values["force"] == -1000.0
    with pytest.raises(
        InputError, match=r"table_speed = 0\.26, table_position = 0, while force = -1000"
    ):
        linear.model(LOADED, at=at | {"axis.table_speed": 0.26})
    out = tmp_path / "out"
    stated = [word for name, value in at.items() for word in ("--at", f"{name}={value}")]
    done = CliRunner().invoke(
        app, ["margins", str(LOADED), *stated, "--no-simulate", "--out", str(out)]
    )
    told = "Not stated, kept as the scenario has them: axis.force = -1000"
    assert told in " ".join(done.output.split())
    assert told in (out / "report.html").read_text()
    numbers = json.loads((out / "result.json").read_text())
    assert numbers["operating_point"]["axis"]["held"] == {"force": -1000.0}


SHARP = {"valve_leakage": 0.0, "cylinder_leakage": 0.0, "valve_rounding": 1e-6}


@pytest.mark.parametrize(
    ("parameters", "speed", "load"),
    [
        (SHARP, -0.049, 0.0),
        (SHARP, 2.4e-4, -108.0),
        (SHARP, 0.02, -1692.0),
        ({"table_coulomb": 2000.0, "table_static": 4000.0}, 0.003, 2500.0),
        ({"area_b": 6e-4}, -0.1, -2000.0),
    ],
)
def test_every_force_and_flow_is_in_balance(parameters, speed, load) -> None:
    """Shut without leakage, sticking, unequal areas: nothing but the position changes."""
    at = found(parameters, table_speed=speed, force=load)
    rates = Case(**parameters).rhs(at.x, at.u).full().ravel()
    place = [d.name for d in Case().ode.states].index("table.position")
    assert rates[place] == pytest.approx(speed, rel=1e-9)
    terms = np.abs(Case(**parameters).slope(at.x, at.u).full()) @ np.maximum(np.abs(at.x), 1e-9)
    assert np.delete(np.abs(rates) / terms, place).max() < 1e-6
    assert abs(at.values["table_position"]) < 1e-3 and 0.0 < abs(at.values["voltage"]) < 10.0
