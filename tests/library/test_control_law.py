"""The software control law: lags, radius losses, cross-coupled control against closed formulas."""

import importlib.util
import math
from pathlib import Path
from typing import Any

import control
import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.analysis import linear
from motionfmu.analysis.contour import ContourResult
from motionfmu.base.errors import InputError

FOLDER = ROOT / "scenarios" / "control_law"
FEED = 100.0  # [mm/s]
KX, KY, TAU = 40.0, 30.0, 3e-3  # [1/s], [1/s], [s]
BUS = 1e-4  # [s]
OFF = {"mcc.velocity_ff": 0.0, "mcc.cross_gain": 0.0, "mcc.cross_integral": 0.0}
# Pulses of 0.125 um: half a pulse of rounding is nothing beside a radius that loses 1.5 um.
FINE = {"ppr": 80000, "machine.encoder_lines": 20000, "dda_length": 14}
LINE = "G21 G90 G61 G1 F6000\nX{x:.4f} Y{y:.4f}\nM2\n"
CIRCLE = "G21 G90 G61 G1 F6000\nG3 I-40\nM2\n"


def six(x: float, y: float) -> list[float]:
    return [x, y, 0.0, 0.0, 0.0, 0.0]


@pytest.fixture
def run(tmp_path: Path):
    """Run a program on the scenario's axes, everything beyond the P law off but what is set."""
    scenario = motionfmu.load(FOLDER)

    def runs(text: str, stop: float, **more: Any) -> Any:
        file = tmp_path / "part.ngc"
        file.write_text(text)
        given = {f"mcc.{k}" if "." not in k else k: v for k, v in more.items()}
        given = {**OFF, "mcc.program": str(file), **given}
        return scenario.run(set=given, stop=stop)

    return runs


def middle(contour: ContourResult) -> float:
    """Mean signed error of the middle third of the motion [mm]."""
    assert contour.track.signed is not None
    own = np.flatnonzero(contour.cutting)
    return float(contour.track.signed[own[len(own) // 3 : 2 * len(own) // 3]].mean())


def line_at(degrees: float) -> tuple[str, float]:
    """A line of 100 mm; and sin a cos a."""
    a = math.radians(degrees)
    return LINE.format(x=100 * math.cos(a), y=100 * math.sin(a)), math.sin(a) * math.cos(a)


@pytest.mark.parametrize("degrees", [20.0, 30.0, 115.0])
def test_line_lags_by_what_is_not_fed_forward(run, degrees: float) -> None:
    text, sc = line_at(degrees)
    # positive is left: there the tool is if X lags more
    p_only = FEED * sc * (1.0 / KX - 1.0 / KY)
    for kff in (0.0, 0.6):
        contour = run(text, 1.6, velocity_ff=six(kff, kff)).contour()
        assert middle(contour) == pytest.approx((1.0 - kff) * p_only, rel=0.01)
    # following error V (1 - kff)/K of an axis, to the count
    steady = contour.following[np.flatnonzero(contour.cutting)[5000], :2]
    a = math.radians(degrees)
    want = 0.4 * FEED * np.array([math.cos(a) / KX, math.sin(a) / KY])
    assert steady == pytest.approx(want, abs=2e-3)


def test_matched_lag_makes_the_line_straight_and_ends_in_place(run) -> None:
    text, sc = line_at(30.0)
    result = run(text, 2.5, command_lag=six(1.0 / KY - 1.0 / KX, 0.0))
    assert abs(middle(result.contour())) < 0.005 * FEED * sc * (1.0 / KY - 1.0 / KX)
    # at rest nothing of the filter is left: half a code of the DAC is 0.2 counts
    assert np.abs(result["card.err_count"][-1]).max() <= 1
    assert result["card.pulse_count"][-1, 0] == round(100e3 * math.cos(math.radians(30)))


@pytest.mark.parametrize("degrees", [30.0, 75.0])
def test_cross_coupling_divides_the_error_of_a_line(run, degrees: float) -> None:
    """Steady: e_x Kx - W e sin a = V cos a, e_y Ky + W e cos a = V sin a, e = e_y c - e_x s."""
    text, sc = line_at(degrees)
    a, coupled = math.radians(degrees), 80.0
    by = 1.0 + coupled * (math.sin(a) ** 2 / KX + math.cos(a) ** 2 / KY)
    contour = run(text, 1.6, cross_gain=coupled).contour()
    assert middle(contour) == pytest.approx(FEED * sc * (1.0 / KX - 1.0 / KY) / by, rel=0.01)
    # and an integral takes all of it
    contour = run(text, 1.6, cross_gain=coupled, cross_integral=3000.0).contour()
    assert abs(middle(contour)) < 1e-3


def test_cross_coupling_has_the_nearest_point_of_a_circle(run) -> None:
    """The tangent at the commanded point would leave L^2/2R = 78 um, L the following distance."""
    equal: dict[str, Any] = {"position_gain": six(40.0, 40.0)}
    lag = FEED / 40.0
    plain = run(CIRCLE, 3.2, **equal).contour()
    assert abs(middle(plain)) > 0.03
    coupled = run(CIRCLE, 3.2, **equal, cross_gain=80.0, cross_integral=3000.0).contour()
    assert abs(middle(coupled)) < 0.01 * lag**2 / 80.0


@pytest.mark.parametrize("kff", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("tau", [0.0, 3e-3])
def test_radius_loss_of_a_circle(run, kff: float, tau: float) -> None:
    """The error acts three bus periods late, the speed two; both are held for one."""
    gain, radius = 40.0, 40.0
    more: dict[str, Any] = {"machine.tau": tau, "velocity_ff": six(kff, kff)} | FINE
    contour = run(CIRCLE, 3.2, position_gain=six(gain, gain), **more).contour()
    s = 1j * FEED / radius
    error, speed = gain * np.exp(-3.5 * BUS * s), kff * s * np.exp(-2.5 * BUS * s)
    h = (error + speed) / (s * (tau * s + 1.0) + error)
    loss = radius * (abs(h) - 1.0)
    # inside a counter-clockwise circle is left
    assert middle(contour) == pytest.approx(-loss, rel=0.005, abs=0.1e-3)


def test_all_off_is_the_p_law_to_the_bit(run) -> None:
    text, _ = line_at(30.0)
    result = run(text, 1.0, position_gain=0.0, software_gain=1.3e-3)
    want = np.clip(1.3e-3 * result["card.err_count"], -10.0, 10.0)
    assert np.array_equal(result["mcc.card_dac_volts"][1:], want[:-1])
    code = np.round(want[:-2] / (20.0 / 65536)) * (20.0 / 65536)
    assert np.array_equal(result["card.dac"][2:, :2], code[:, :2])
    # Kp in 1/s is the same thing in other units
    volts = 60.0 / (10000 * 300.0)
    other = run(text, 1.0, position_gain=six(1.3e-3 / volts, 1.3e-3 / volts))
    assert np.abs(other["card.dac"] - result["card.dac"]).max() <= 20.0 / 65536 * 1.01


def test_voltages_stay_within_the_dac(run) -> None:
    text, _ = line_at(30.0)
    result = run(text, 1.6, position_gain=six(3e3, 3e3), velocity_ff=six(1, 1), cross_gain=1e4)
    assert np.abs(result["card.dac"]).max() <= 10.0
    assert np.abs(result["card.dac"]).max() > 9.9


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"velocity_ff": 1.2}, "velocity_ff"),
        ({"output_mode": [2, 1, 2, 2, 2, 2]}, r"position_gain\[2\] = 30 .*output_mode\[2\] = 1"),
        (
            {"output_mode": [2, 1, 2, 2, 2, 2], "position_gain": 0.0, "cross_gain": 5.0},
            r"cross_gain = 5 couples X Y Z by the software law: output_mode\[2\] = 1",
        ),
        (
            {"active": [True, *[False] * 5], "position_gain": six(1, 0), "cross_integral": 5.0},
            "cross_integral = 5 couples X Y Z: only 1 of them active",
        ),
        ({"speed_per_volt": 0.0}, "speed_per_volt"),
        ({"command_lag": -1e-3}, "command_lag"),
    ],
)
def test_wrong_parameters_are_named(run, given: dict[str, Any], told: str) -> None:
    with pytest.raises((InputError, RuntimeError), match=told):
        run(LINE.format(x=1, y=1), 0.1, **given)


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"mcc.velocity_ff": six(0.8, 0.8)},
        {"mcc.command_lag": six(8e-3, 2e-3)},
        {"mcc.velocity_ff": six(1.0, 0.5), "mcc.command_lag": six(8e-3, 2e-3)},
    ],
)
def test_linear_model_moves_as_the_fmus_do(run, more: dict[str, Any]) -> None:
    text, _ = line_at(30.0)
    result = run(text, 1.6, **more)
    for axis in (1, 2):
        model = linear.model(FOLDER, axis, set=OFF | more)
        system = model.system("card.pulses", "machine.table_position")
        pulses = result["card.pulse_count"][:, axis - 1].astype(float)
        moved = control.forced_response(system, U=pulses, squeeze=True).y
        real = result["machine.table_position"][:, axis - 1]
        # half a bus period of the speed fed forward, and rounding: 3 um of 87 mm
        assert np.abs(np.asarray(moved) - real).max() < 3e-6
        if "mcc.velocity_ff" in more:
            without = linear.model(FOLDER, axis, set={**OFF, **more, "mcc.velocity_ff": 0.0})
            loops = [m.loop("card.enc_phase") for m in (model, without)]
            assert loops[0].frequency_response([300.0]).complex == pytest.approx(
                loops[1].frequency_response([300.0]).complex
            )


def test_linear_model_refuses_coupled_axes() -> None:
    with pytest.raises(InputError, match=r"mcc: cross_gain couples the axes; set it to 0"):
        linear.model(FOLDER, 1)


def test_study_is_what_the_readme_says() -> None:
    spec = importlib.util.spec_from_file_location("control_law_study", FOLDER / "study.py")
    assert spec is not None and spec.loader is not None
    study = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(study)
    readme = (FOLDER / "README.md").read_text()
    cases = {name: study.run(name, more) for name, more in study.CASES.items()}
    for case in cases.values():
        row = next(x for x in readme.splitlines() if x.startswith(f"| {case.name} |"))
        told = [float(x) for cell in row.split("|")[2:5] for x in cell.split("/")]
        found = [x * 1e3 for path in study.PATHS for x in case.size(path)]
        assert told == pytest.approx(found, abs=0.06)
    rms = {name: case.size("circle R20")[1] for name, case in cases.items()}
    assert rms["P + feed-forward + CCC"] < 0.1 * rms["P + feed-forward"] < 0.02 * rms["P"]
