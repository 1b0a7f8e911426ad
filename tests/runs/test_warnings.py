"""Grids and steps that are coarse or do not fit are told once, to every importer."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from typer.testing import CliRunner

from motionfmu import load
from motionfmu.cli import app
from motionfmu.run.engines import fmu_messages
from motionfmu.scenarios import fmus
from motionfmu.scenarios.grids import grid

THEORY = ROOT / "scenarios/circle_theory"
LAG, H = 5e-3, 2e-3
COARSE = {"machine.tau": LAG, "machine.micro_step": H}
FINE = {"machine.tau": LAG, "machine.micro_step": 1e-4}


def told(set_: dict, **options) -> tuple[str, ...]:
    return load(THEORY).run(set=set_, stop=0.006, **options).warnings


@pytest.mark.parametrize(
    ("engine", "fmi"), [(e, fmi) for e in ("native", "python", "fmpy") for fmi in (2, 3)]
)
def test_every_engine_hears_the_warnings_of_the_fmus(engine: str, fmi: int) -> None:
    apart, late, coarse = told(COARSE | {"card.loop_period": 7.5e-5}, engine=engine, fmi=fmi)
    error = 100.0 * (H / LAG) ** 4 / 120.0
    assert coarse == (
        "machine: axis 1: micro_step 0.002 s (1 sub-steps) is coarse against its shortest time"
        f" constant, 0.005 s: lags of 0.005 s are off by up to {error:.2g} %"
    )
    assert late == (
        "card: communicationStepSize 0.0001 s and loop_period = 7.5e-05 s do not divide each"
        " other: inputs are up to 0.0001 s old"
    )
    assert apart.startswith(
        "grids do not divide each other: card.loop_period = 7.5e-05 s, machine.micro_step = 0.002"
        " s, mcc.bus_period = 0.0001 s;"
    )


def test_what_fits_is_not_warned_of() -> None:
    assert told({}) == told(FINE) == ()
    assert told({"machine.tau": 1e-6}) == ()  # faster than the step: it has died away between two
    assert told({"machine.tau": 1e-4, "machine.micro_step": 2.5e-5}) == ()
    # a slower card over whole steps, a faster plant, a faster card beside a slow PC
    assert told({"card.loop_period": 2e-4, "machine.micro_step": 5e-5}) == ()
    assert told({"card.loop_period": 1e-4, "mcc.bus_period": 2e-4}) == ()


def test_underruns_are_told_of_when_there_are_ten_times_as_many() -> None:
    run = load(ROOT / "scenarios/pulse_underrun").run(stop=0.6)
    counted = [row.split(" underrun")[0] for row in run.warnings]
    for card in ("document_card", "good_card", "short_card", "long_card"):
        all_of_it = run[f"{card}.underruns"][-1]
        wanted = [f"{card}: {n}" for n in (1, 10, 100, 1000) if n <= all_of_it]
        assert [row for row in counted if row.startswith(card)] == wanted
    assert run["short_card.underruns"][-1] >= 100


@pytest.mark.parametrize("z", [0.3, 0.36])
def test_the_warning_begins_at_an_error_of_a_ten_thousandth(z: float) -> None:
    """Runge-Kutta's step of e^-z: its exponent is wrong by z^4/120 and terms of higher order."""
    growth = sum((-z) ** k / math.factorial(k) for k in range(5))
    wrong = abs(-math.log(growth) / z - 1.0)
    assert z**4 / 120.0 < wrong < 1.5 * z**4 / 120.0
    warned = told(COARSE | {"machine.tau": round(H / z, 9)})
    assert len(warned) == (1 if z > 1.0 / 3.0 else 0)


def test_grids_that_do_not_divide_each_other_are_one_warning() -> None:
    """Only those that a wire joins, each named once; the step divides both."""
    (only,) = told({"card.loop_period": 1.5e-4}, step=2.5e-5)
    assert only.startswith(
        "grids do not divide each other: card.loop_period = 0.00015 s, mcc.bus_period = 0.0001 s;"
    )


def test_a_step_longer_than_both_ends_of_a_wire() -> None:
    """test_wire_delay.py has the delays: such a step makes every sample as long as itself."""
    (only,) = told({}, step=2e-4)
    assert only.startswith("the step, 0.0002 s, is longer than card.loop_period = 0.0001 s, ")
    assert "mcc.bus_period = 0.0001 s" in only and only.count("0.0002 s") == 2


@pytest.mark.parametrize("fmu", [name for name in fmus.fmu_names() if grid(name)])
def test_every_fmu_says_its_grid(fmu: str) -> None:
    port = fmus.ports(fmu)[grid(fmu)]
    assert (port.causality, port.unit, port.shape) == ("parameter", "s", ())


def test_console_page_and_json_have_them(tmp_path: Path) -> None:
    out = tmp_path / "out"
    values = [w for n, v in COARSE.items() for w in ("--set", f"{n}={v}")]
    done = CliRunner().invoke(
        app, ["run", str(THEORY), *values, "--stop", "0.05", "--out", str(out)]
    )
    text = "coarse against its shortest time constant"
    assert done.output.count(text) == 1 and "warning machine: axis 1" in done.output
    assert (out / "report.html").read_text().count(text) == 1
    numbers = json.loads((out / "result.json").read_text())
    assert len(numbers["warnings"]) == 1 and text in numbers["warnings"][0]
    assert np.isfinite(numbers["samples"])


def test_an_error_that_is_over_is_no_warning() -> None:
    """Three stops and three recoveries: each error is told, its end is an event."""
    warned = load(ROOT / "scenarios/protection").run().warnings
    assert [w.split(" after ")[0] for w in warned] == [
        f"mcc: run-time error {code}" for code in ("0xF301", "0xF102", "0xF801")
    ]


def test_twenty_different_warnings_of_a_component_are_kept_and_more_are_told() -> None:
    errors: list[str] = []
    warnings: list[str] = []
    for k in [*range(15), *range(40)]:
        fmu_messages.keep(fmu_messages.WARNING, f"card: number {k}", errors, warnings)
        fmu_messages.keep(fmu_messages.WARNING, f"number {k} of nobody", errors, warnings)
        fmu_messages.keep(0, f"card: news {k}", errors, warnings)
    fmu_messages.keep(fmu_messages.WARNING, "drives: one", errors, warnings)
    more = "card: more warnings than these 20, which are its first"
    assert warnings == [*(f"card: number {k}" for k in range(20)), more, "drives: one"]
    assert errors == []
