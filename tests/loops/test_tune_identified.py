"""Tuning for all plants that a record leaves possible, and along what a record drives."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from console import within

import motionfmu
from motionfmu.analysis import linear
from motionfmu.analysis.linear.stability import margins
from motionfmu.base.errors import InputError
from motionfmu.identify import ConfidenceRegion, read_region
from motionfmu.study.tune import problem, tune
from motionfmu.study.tune.problem import read

AXIS = ROOT / "examples/digital_twin/axis"
GAINS = ["drives.position_gain", "drives.velocity_gain"]
NAMES = "machine.table_mass[1]", "machine.table_viscous[1]"


def region(deviations: tuple[float, float], correlation: float = 0.0) -> ConfidenceRegion:
    """Mass and friction of the first axis; the mass is told as 30 kg and what is above them."""
    found = np.array([30.0, 100.0])
    cover = np.outer(deviations, deviations) * np.array([[1.0, correlation], [correlation, 1.0]])
    rows = {
        NAMES[0]: (30.0, np.array([1.0, 0.0])),
        NAMES[1]: (0.0, np.array([0.0, 1.0])),
    }
    settings = {NAMES[0]: 60.0, NAMES[1]: 100.0, "drives.position_gain[1]": 100.0}
    ends = np.zeros(2), np.full(2, np.inf)
    return ConfidenceRegion("a record", settings, ("mass", "viscous"), found, cover, ends, rows)


def test_the_surface_holds_the_share_of_draws_that_it_says() -> None:
    given = region((3.0, 20.0), 0.7)
    for level in (0.5, 0.95):
        edge = [*given.principal(level), *given.surface(level, 30)]
        away = np.array([[p[NAMES[0]] - 60.0, p[NAMES[1]] - 100.0] for p in edge])
        reach = np.einsum("ki,ij,kj->k", away, np.linalg.inv(given.covariance), away)
        assert np.ptp(reach) < 1e-9 * reach[0]
        # of two quantities the region of probability P ends at -2 log(1 - P)
        assert reach[0] == pytest.approx(-2.0 * math.log(1.0 - level), rel=1e-9)
    drawn = np.random.default_rng(3).multivariate_normal([0.0, 0.0], given.covariance, 20_000)
    inside = np.einsum("ki,ij,kj->k", drawn, np.linalg.inv(given.covariance), drawn) < reach[0]
    assert inside.mean() == pytest.approx(0.95, abs=0.005)


def test_no_plant_passes_the_bounds_of_a_quantity() -> None:
    masses = [p[NAMES[0]] for p in region((40.0, 1.0)).principal(0.95)]
    assert min(masses) == 30.0 and max(masses) > 120.0


def test_a_region_is_read_back_as_it_was_written(tmp_path: Path) -> None:
    given = region((3.0, 20.0), 0.7)
    text = json.dumps({"settings": given.settings, "region": given.numbers()})
    (tmp_path / "result.json").write_text(text)
    for place in (tmp_path, tmp_path / "result.json"):
        again = read_region(place)
        assert again.principal(0.9) == given.principal(0.9)
        assert dict(again.settings) == given.settings and again.name == tmp_path.name


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{", "no JSON"),
        ('{"settings": {}}', "not the result of motionfmu identify"),
        ('{"settings": {}, "two_masses": true}', "two masses by --frf, which have no region"),
        ('{"settings": {}, "region": null}', "this record told nothing"),
        ('{"settings": {}, "region": {"free": 1}}', "region.free: input should be a valid list"),
        (None, "No such file"),
    ],
)
def test_what_is_no_identification_is_refused(tmp_path: Path, text: str | None, told: str) -> None:
    if text is not None:
        (tmp_path / "result.json").write_text(text)
    with pytest.raises(InputError, match=f"result.json: .*{told}" if text else told):
        read_region(tmp_path / "result.json")


def test_quantities_of_another_number_are_refused(tmp_path: Path) -> None:
    numbers = region((3.0, 20.0)).numbers() | {"low": [0.0]}
    (tmp_path / "result.json").write_text(json.dumps({"settings": {}, "region": numbers}))
    with pytest.raises(InputError, match="region: not all of it has 2 quantities"):
        read_region(tmp_path)


@pytest.mark.more
def test_gains_keep_the_margins_of_plants_that_the_search_has_not_seen() -> None:
    given = region((4.0, 20.0), 0.5)
    options = {**read(AXIS / "tune.toml"), "gains": GAINS, "check": 0, "starts": 1}
    tuned = tune(AXIS, options, identified=[given])
    assert tuned.region is not None
    assert min(tuned.region.room) > -1e-4 and min(tuned.region.before) < -0.1
    assert tuned.region.added and tuned.study.plants[1:] == list(tuned.region.added)
    # margins by the analysis of loops, in directions that were not drawn
    root = np.linalg.cholesky(given.covariance) * math.sqrt(-2.0 * math.log(0.05))
    highest = []
    for angle in np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False):
        mass, viscous = given.values + root @ [math.cos(angle), math.sin(angle)]
        plant = {NAMES[0]: 30.0 + mass, NAMES[1]: viscous}
        axis = linear.model(AXIS, 1, at=tuned.study.at, set={**tuned.settings, **plant})
        (name,) = tuned.study.parts[0][1].loops
        highest.append(margins(axis.loop(name)).sensitivity)
    assert 1.45 < max(highest) < 1.5 * 1.01
    assert f"of {len(tuned.region.room)} plants" in tuned.toml()
    # values are set as found, and the search begins with the gains of the record
    assert tuned.before[0].result.parameters["machine.table_mass"][:2] == (60.0, 50.0)
    assert tuned.before[0].result.parameters["drives.position_gain"][:2] == (100.0, 160.18)


@pytest.mark.parametrize(
    ("options", "set_", "told"),
    [
        ({"family": {"machine.table_mass": [40, 80]}}, {}, "is in a record and in family.machine"),
        ({}, {"machine.table_mass": 50.0}, "machine.table_mass is set, and identified in a record"),
        ({}, {NAMES[0]: 50.0}, "is set, and identified in a record"),
    ],
)
def test_a_value_has_one_source(options: Any, set_: Any, told: str) -> None:
    with pytest.raises(InputError, match=told.replace("[", r"\[")):
        tune(AXIS, read(AXIS / "tune.toml") | options, set_, identified=[region((1.0, 1.0))])


def test_two_records_tell_two_axes() -> None:
    with pytest.raises(InputError, match="is in a record and in a record: choose one"):
        tune(AXIS, read(AXIS / "tune.toml"), identified=[region((1.0, 1.0)), region((1.0, 1.0))])


def test_folders_of_a_file_stand_beside_it(tmp_path: Path) -> None:
    (tmp_path / "tune.toml").write_text('identified = ["../results/x.identify"]\nlevel = 0.9\n')
    values = read(tmp_path / "tune.toml")
    assert values["identified"] == [str(tmp_path / "../results/x.identify")]
    assert problem(values).level == 0.9
    (tmp_path / "tune.toml").write_text("level = 1.0\n")
    with pytest.raises(InputError, match=r"tune.toml:1: level = 1.0: .*less than 1"):
        read(tmp_path / "tune.toml")


def test_a_folder_that_is_none_is_told_by_the_command(tmp_path: Path) -> None:
    done = within("tune", AXIS, "--identified", tmp_path / "none")
    assert done.returncode == 2 and not (tmp_path / "results").exists()
    assert done.stderr == f"motionfmu: {tmp_path / 'none'}: No such file or directory\n"


@pytest.mark.more
def test_an_axis_is_tuned_along_what_a_record_drives() -> None:
    options = {**read(AXIS / "tune.toml"), "gains": ["drives.position_gain"], "check": 0}
    options |= {"limits": {"margins": {"phase": 30.0}, "overshoot": 1.0}}
    tuned = tune(AXIS, options)
    # mean speed of the reference, whose pieces are of constant speed and acceleration
    speed = tuned.study.at["machine.table_speed"]
    trace = motionfmu.record(AXIS / "record.csv")
    rate = np.abs(np.gradient(trace["reference"], trace.time))
    assert speed == pytest.approx(rate[rate > 0.05 * rate.max()].mean(), rel=0.02)
    for run in (tuned.before[0], tuned.after[0]):
        assert run.model.rms == pytest.approx(run.fmus.rms, rel=0.02)
        # the drive's own following error, in turns of 10 mm, where it samples
        own = run.result["drives.following_error"][11::10, 0] * 10.0
        assert np.sqrt(np.mean(own**2)) == pytest.approx(run.fmus.rms, rel=0.02)
    with pytest.raises(InputError, match="shows no command of the linear model"):
        tune(AXIS, {**options, "command": "drives.speed"})
