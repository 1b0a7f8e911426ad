"""ISO 230-2 figures and step figures against formulas, brute force and a plant that is known."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import motionfmu
from motionfmu.analysis.data_sheet import sheet_programs
from motionfmu.analysis.data_sheet.sheet_axes import sheet_axes
from motionfmu.analysis.data_sheet.sheet_programs import positioning_program, targets
from motionfmu.analysis.data_sheet.sheet_runs import SheetMachine, positioning
from motionfmu.analysis.positioning import PositioningTest, StepFigures, step_figures

SIZES = st.floats(-1.0, 1.0, allow_subnormal=False)


def test_figures_by_hand() -> None:
    """Two targets, two runs: means 1, 4 up and -2, 3 down; s = sqrt(2) of the first, upwards."""
    up = np.array([[0.0, 4.0], [2.0, 4.0]])
    down = np.array([[-2.0, 3.0], [-2.0, 3.0]])
    found = PositioningTest(np.array([0.0, 1.0]), up, down).figures()
    s = math.sqrt(2.0)
    assert (found["B"], found["B_mean"]) == (3.0, 2.0)  # |1 - -2|; of 3 and 1
    assert found["E"] == 6.0 and (found["E_up"], found["E_down"]) == (3.0, 5.0)
    assert found["M"] == 4.0  # 3.5 - -0.5
    assert found["A"] == pytest.approx(4.0 - min(-2.0, 1.0 - 2.0 * s))
    assert found["R_up"] == pytest.approx(4.0 * s) and found["R_down"] == 0.0
    assert found["R"] == pytest.approx(2.0 * s + 3.0)  # beyond 4 s of one side
    assert found["A_up"] == pytest.approx(max(4.0, 1.0 + 2.0 * s) - (1.0 - 2.0 * s))


def brute(up: list[list[float]], down: list[list[float]]) -> dict[str, float]:
    """The definitions of the standard, number by number."""
    n, m = len(up), len(up[0])

    def mean(rows: list[list[float]], i: int) -> float:
        return sum(row[i] for row in rows) / n

    def s(rows: list[list[float]], i: int) -> float:
        return math.sqrt(sum((row[i] - mean(rows, i)) ** 2 for row in rows) / (n - 1))

    r = []
    for i in range(m):
        reversal = abs(mean(up, i) - mean(down, i))
        r.append(max(2 * s(up, i) + 2 * s(down, i) + reversal, 4 * s(up, i), 4 * s(down, i)))
    ends = [(mean(x, i) + k * 2 * s(x, i)) for x in (up, down) for i in range(m) for k in (-1, 1)]
    means = [mean(x, i) for x in (up, down) for i in range(m)]
    middle = [(mean(up, i) + mean(down, i)) / 2 for i in range(m)]
    return {
        "A": max(ends) - min(ends),
        "E": max(means) - min(means),
        "R": max(r),
        "B": max(abs(mean(up, i) - mean(down, i)) for i in range(m)),
        "B_mean": sum(mean(up, i) - mean(down, i) for i in range(m)) / m,
        "M": max(middle) - min(middle),
    }


@given(st.integers(2, 6), st.integers(1, 5), st.data())
def test_figures_are_those_of_the_definitions(n: int, m: int, data: st.DataObject) -> None:
    rows = st.lists(st.lists(SIZES, min_size=m, max_size=m), min_size=n, max_size=n)
    up, down = data.draw(rows), data.draw(rows)
    found = PositioningTest(np.arange(m), np.array(up), np.array(down)).figures()
    for name, value in brute(up, down).items():
        assert found[name] == pytest.approx(value, abs=1e-12), name
    # what the standard says of any axis
    assert found["A"] >= found["E"] - 1e-12 and found["E"] >= found["M"] - 1e-12
    assert found["R"] >= found["B"] - 1e-12 and found["A"] >= max(found["A_up"], found["A_down"])


@pytest.mark.parametrize(("up", "down"), [((2, 3), (2, 2)), ((1, 3), (1, 3)), ((3,), (3,))])
def test_what_is_no_bidirectional_test(up: tuple[int, ...], down: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match=r"wanted|at least"):
        PositioningTest(np.zeros(3), np.zeros(up), np.zeros(down))


@pytest.mark.more
def test_backlash_and_pitch_error_of_a_screw_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Backlash 15 um and 45 um/m: B is the gap, within what it overshoots; M the slope.

    The loop hunts about its target, as friction and an integral do, and the nut pushes the table on
    by what it overshoots, the same for any gap that is larger.
    """
    monkeypatch.setattr(sheet_programs, "APPROACHES", 2)
    machine = motionfmu.machine("xy_table")
    x = sheet_axes(machine, machine.plan().axis_limits())[0]
    found = {}
    for gap in (0.0, 5e-6, 15e-6):
        values = {"machine.backlash": gap, "machine.lead_error_slope": 45e-6}
        (run,) = positioning(SheetMachine(machine, tmp_path, values), [x], 2.05)
        test, found[gap] = run.test, run.test.figures()
        # it hunts by some counts of 1 um; in its play the nut does so by itself
        assert (1e-3 < run.unrest < 8e-3) if gap == 0.0 else run.unrest < 0.2e-3
        if gap == 0.0:
            continue
        span = test.targets[-1] - test.targets[0]
        assert found[gap]["M"] == pytest.approx(45e-6 * span, abs=0.05e-3)
        rest = sum(test.means) / 2.0 - 45e-6 * test.targets
        assert np.ptp(rest) < 0.05e-3
        # the table lags behind the nut, on either side
        assert found[gap]["B_mean"] == pytest.approx(-found[gap]["B"], abs=0.01e-3)
        # over the travel, unevenly
        assert (test.targets[0], test.targets[-1]) == (-460.0, 460.0)
        assert np.ptp(np.diff(test.targets)) > 10.0
    assert found[15e-6]["B"] == pytest.approx(15e-3, abs=4e-3)
    assert found[15e-6]["B"] - found[5e-6]["B"] == pytest.approx(10e-3, abs=0.05e-3)


def test_the_program_of_a_test_goes_to_each_target_from_both_sides() -> None:
    machine = motionfmu.machine("mill3")
    z = sheet_axes(machine, machine.plan().axis_limits())[2]
    assert (z.low, z.high, z.word) == (-400.0, 0.0, "Z")  # the software limits, not the switches
    program = positioning_program(z, 0.55)
    assert list(program.targets) == list(targets(z))
    text = program.text.splitlines()
    place, came = None, {}
    for number, line in enumerate(text, 1):
        if line.startswith("G0 Z"):
            before, place = place, float(line[4:])
        if line.startswith("G4"):
            came[number] = (place, place > before)
    for run in program.lines:
        for way, upwards in ((0, True), (1, False)):
            told = [came[n] for n in run[way]]
            assert told == [(t, upwards) for t in program.targets]


def first_order(time: np.ndarray, tau: float) -> np.ndarray:
    return 1.0 - np.exp(-time / tau)


def second_order(time: np.ndarray, omega: float, zeta: float) -> np.ndarray:
    damped = omega * math.sqrt(1.0 - zeta * zeta)
    angle = damped * time
    part = np.cos(angle) + zeta * omega / damped * np.sin(angle)
    return np.asarray(1.0 - np.exp(-zeta * omega * time) * part)


@pytest.mark.parametrize("tau", [0.003, 0.07])
def test_step_figures_of_a_first_order_lag(tau: float) -> None:
    """Rise ln 9, settling within 2 % ln 50 time constants."""
    time = np.linspace(0.0, 10.0 * tau, 20001)
    found = step_figures(time, -3.0 * first_order(time, tau), -3.0)
    assert found.rise == pytest.approx(math.log(9.0) * tau, rel=1e-5)
    assert found.settling == pytest.approx(math.log(50.0) * tau, rel=1e-5)
    assert found.overshoot == 0.0


@pytest.mark.parametrize("zeta", [0.3, 0.6])
def test_step_figures_of_a_second_order_lag(zeta: float) -> None:
    """Overshoot exp(-pi zeta / sqrt(1 - zeta^2)); the band is entered for good."""
    omega = 40.0
    time = np.linspace(0.0, 2.0, 200001)
    values = second_order(time, omega, zeta)
    found = step_figures(time, values)
    assert found.overshoot == pytest.approx(
        math.exp(-math.pi * zeta / math.sqrt(1.0 - zeta**2)), rel=1e-6
    )
    after = time > found.settling + 1e-5
    assert np.abs(values[after] - 1.0).max() <= 0.02
    at = np.interp(found.settling, time, values)
    assert abs(at - 1.0) == pytest.approx(0.02, rel=1e-4)


def test_steps_that_do_not_arrive() -> None:
    time = np.linspace(0.0, 1.0, 101)
    assert step_figures(time, 0.5 * time) == StepFigures(math.inf, 0.0, math.inf)
    assert step_figures(time, np.ones(101)) == StepFigures(0.0, 0.0, 0.0)
    assert step_figures(time, 0.5 * time).numbers() == {
        "rise": None,
        "overshoot": 0.0,
        "settling": None,
    }
    with pytest.raises(ValueError, match="no figures"):
        step_figures(time, time, 0.0)
