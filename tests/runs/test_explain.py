"""Contour error explained: every injected cause is named first, with the size theory gives it."""

import json
import math
import re
import shutil
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import FMUS, ROOT
from contour_runs import Machine, Program, lag_error, run_along
from few_cases import few
from typer.testing import CliRunner

import motionfmu
from motionfmu.analysis.contour import ContourInput, analyse
from motionfmu.analysis.explain import (
    cause_switches,
    decompose,
    explain,
    servo_formulas,
    signature,
    theory,
)
from motionfmu.analysis.explain.parameter_expression import evaluate
from motionfmu.analysis.explain.servo_formulas import ServoAxis
from motionfmu.base.errors import InputError
from motionfmu.fmu.archive_names import EXTRA
from motionfmu.report.cause_pages.explain_page import page_text
from motionfmu.report.numbers import length
from motionfmu.scenarios import fmus

RADIUS, FEED, GAIN = 10.0, 30.0, 400  # [mm], [mm/s], register
PER_GAIN = 20.0 / 65536.0 * 300.0 / 60.0 * 10_000 / 2**6  # [1/s] position gain per register unit
SMOOTH = {
    f"machine.{side}_{kind}": 0.0 for side in ("motor", "table") for kind in ("coulomb", "static")
}
NO_STRIBECK = {"machine.motor_static": 0.15, "machine.table_static": 50.0}


def first(value: float, others: float) -> list[float]:
    """A value for X, another for the other axes."""
    return [value, *[others] * 5]


def circle(feed: float = FEED) -> str:
    r = RADIUS
    return f"G21 G17 G90 G61\nG0 X{r}\nG4 P0.2\nG3 X{r} Y0 I-{r} J0 F{feed * 60}\nM30\n"


# name: scenario, settings, program, time [s], size by hand [mm], bounds of simulated over theory
INJECTED = {
    "mismatch": (
        "circle_theory",
        {"mcc.p_gain": [400, 320, 0, 0, 0, 0]},
        circle(),
        2.9,
        0.5 * FEED * (1.0 / (320 * PER_GAIN) - 1.0 / (400 * PER_GAIN)),
        (0.97, 1.03),
    ),
    "backlash": (
        "circle",
        NO_STRIBECK | {"mcc.p_gain": GAIN, "machine.backlash": 1e-4},
        circle(),
        2.9,
        0.05,
        (0.97, 1.03),
    ),
    "friction": (
        "circle",
        SMOOTH
        | {
            "mcc.p_gain": GAIN,
            "drives.velocity_time": 0.0,
            "machine.motor_coulomb": 0.5,
            "machine.motor_static": 0.5,
        },
        circle(),
        2.9,
        0.5 * 2.0 * 0.5 / (GAIN * PER_GAIN * 0.5) * 10.0 / (2.0 * math.pi),
        (0.9, 1.1),
    ),
    "scale": (
        "circle",
        SMOOTH | {"mcc.p_gain": GAIN, "machine.lead_error_slope": first(3e-3, 0.0)},
        circle(),
        2.9,
        3e-3 * RADIUS,
        (0.97, 1.03),
    ),
    "quantisation": (
        "circle_theory",
        {"mcc.ppr": 400, "machine.encoder_lines": 100, "mcc.p_gain": 10_000},
        circle(10.0),
        7.2,
        math.sqrt(0.5) * 0.025 + math.sqrt(2.0) * 0.025,
        (0.2, 1.0),  # a bound: half a pulse and a count on both axes at once, and no servo
    ),
    "chord": (
        "circle_theory",
        {"mcc.dda_time": 0.03, "mcc.dda_length": 13, "mcc.max_rpm": 300.0, "mcc.p_gain": 600},
        circle(),
        3.3,
        2.0 / 3.0 * (FEED * 0.03) ** 2 / (8.0 * RADIUS),  # its mean; the ripple comes on top
        (0.9, 1.1),
    ),
    "torque": (
        "circle",
        SMOOTH | {"drives.torque_limit": first(0.6, 10.0)},
        "G21 G17 G90 G61\nG1 X50 Y50 F6000\nM30\n",
        1.2,
        None,
        (0.9, 1.1),
    ),
}


@pytest.mark.parametrize("name", few(INJECTED, 3))
def test_an_injected_cause_is_named_first_with_its_size(name: str, tmp_path: Path) -> None:
    scenario, settings, program, stop, by_hand, (low, high) = INJECTED[name]
    file = tmp_path / "program.ngc"
    file.write_text(program)
    set_ = settings | {"mcc.program": str(file)}
    found = explain(ROOT / "scenarios" / scenario, set=set_, stop=stop)
    assert found.result["mcc.done"][-1] and not found.result["mcc.error"].any()
    effect = found.effects[0]
    assert effect.name == name, [(e.name, e.size) for e in found.effects]
    assert effect.theory.value is not None
    assert low <= effect.size / effect.theory.value <= high, (effect.size, effect.theory)
    if by_hand is not None:  # the formula as the book has it
        assert by_hand * 0.95 <= effect.theory.value <= by_hand * 1.5
    # What does not add up is stated, and small here.
    numbers = found.numbers()
    error = found.result.contour().error  # one RMS, over time, wherever the error is told
    assert numbers["contour_error"] == {"max": error.max, "rms": error.rms}
    page = page_text(found)
    assert f"RMS {length(error.rms)}, over time where the tool cuts" in page
    idle = [e for e in found.effects if e.judged and e.size == 0.0 and not e.theory.value]
    assert idle and not any(f'<td class="key">{e.title}' in page for e in idle)
    assert f"Switched off without any change: {idle[0].title}" in page
    assert numbers["residual"]["max"] <= 0.2 * numbers["contour_error"]["max"]
    assert np.allclose(found.together + found.residual, found.whole)
    if effect.without is not None:
        assert effect.without < numbers["contour_error"]["max"]


def test_only_what_a_lead_error_does_across_the_path_counts(tmp_path: Path) -> None:
    """An X that travels too far along X leaves the path where it is; at 45 degrees it does not."""
    file, slope = tmp_path / "program.ngc", 3e-3
    for program, expected in (
        ("G21 G90 G61\nG1 X40 F9000\nM30\n", 0.0),
        ("G21 G90 G61\nG1 X10 F9000\nX20 Y10\nM30\n", slope * 20.0 * math.sqrt(0.5)),
    ):
        file.write_text(program)
        set_ = {"mcc.program": str(file), "machine.lead_error_slope": first(slope, 0.0)}
        result = motionfmu.load(ROOT / "scenarios/circle").run(set=set_, stop=0.9)
        said = theory.RunTheory(result, result.contour()).of("scale").value
        assert said == pytest.approx(expected, abs=1e-12)


def test_places_after_a_rest_do_not_count() -> None:
    """From a rest on, the places that the tool passes within the servo window are left out."""
    speed, gain, step = 50.0, 50.0, 1e-3
    path = Program(0.0, 0.0).line(20.0, 0.0).line(20.0, 20.0).path()
    ramp = speed * step * np.arange(1, 401)
    way = np.concatenate([np.zeros(300), ramp, np.full(400, 20.0), 20.0 + ramp, np.full(300, 40.0)])
    commanded = np.zeros((len(way), 6))
    commanded[:, 0], commanded[:, 1] = np.minimum(way, 20.0), np.maximum(way - 20.0, 0.0)
    actual = commanded.copy()
    for i in range(2):
        actual[:, i] -= lag_error(commanded[:, i], gain, step)
    command = np.where(np.arange(len(way)) < 1080, 1, 2)
    run = analyse(ContourInput(path, step * np.arange(len(way)), actual, commanded, command))
    along = np.linspace(0.0, 40.0, 4001)
    counts = decompose._counted(run, along)
    passed = speed * (run.window - (1.0 - math.exp(-gain * run.window)) / gain)
    assert 3.5 < passed < 4.5
    for start in (0.0, 20.0):
        assert not counts[(along > start) & (along < start + passed - 0.1)].any()
        assert counts[(along > start + passed + 0.1) & (along < start + 19.9)].all()


@pytest.fixture(scope="module")
def recorded():
    """The demo's circle, both ways round on ball-screw axes."""
    return motionfmu.load(ROOT / "scenarios/circle").run().contour()


def changed(contour, x=None, y=None):
    """The circular test of recorded data whose table stands elsewhere."""
    actual = contour.run.actual.copy()
    if x is not None:
        actual[:, 0] = x(*actual[:, :2].T)
    if y is not None:
        actual[:, 1] = y(*actual[:, :2].T)
    return analyse(replace(contour.run, actual=actual)).circles[0]


def test_a_ballbar_sees_the_reversal_spikes_of_the_demo(recorded) -> None:
    mark = signature(recorded.circles[0], recorded.lag)
    assert [f.name for f in mark.findings if f.named] == ["spikes"]
    # Below theory's 13.6 um for Coulomb friction alone plus a third by break-away.
    assert 0.012 < mark.findings[0].size < 0.018
    assert mark.mean == pytest.approx(recorded.circles[0].ccw.reading.radius_change, abs=1e-3)
    assert "Friction" in mark.words()[0]


@pytest.mark.parametrize("shear", [2e-3, -1e-3])
def test_a_ballbar_sees_squareness(recorded, shear: float) -> None:
    test = changed(recorded, x=lambda x, y: x + shear * y)
    mark = signature(test, recorded.lag)
    assert mark.findings[0].name == "squareness"
    # x + k y turns r into r (1 + k/2 sin 2a) but for k^2; r is less than nominal by the lag.
    radius = 50.0 + mark.mean
    assert mark.findings[0].size == pytest.approx(abs(shear) / 2.0 * radius, rel=1e-4)
    side, angle = re.search(r"at (\w+) than 90° by (\d+) µrad", mark.words()[0]).groups()
    assert side == ("less" if shear > 0.0 else "more")
    assert float(angle) == float(f"{abs(shear) * 1e6 * radius / 50.0:.3g}")


@pytest.mark.parametrize(("axis", "slope"), [("X", 1.5e-3), ("Y", 2e-3)])
def test_a_ballbar_sees_the_scale_of_an_axis(recorded, axis: str, slope: float) -> None:
    test = changed(
        recorded,
        x=(lambda x, y: x * (1.0 + slope)) if axis == "X" else None,
        y=(lambda x, y: y * (1.0 + slope)) if axis == "Y" else None,
    )
    mark = signature(test, recorded.lag)
    assert mark.findings[0].name == "scale" and f"{axis} travels" in mark.words()[0]
    assert mark.findings[0].size == pytest.approx(slope * 50.0 / 2.0, rel=0.05)
    assert not mark.finding("mismatch").named and not mark.finding("squareness").named


def ballbar(machine: Machine):
    path = Program(30.0, 0.0).arc((0.0, 0.0), 2 * math.pi).arc((0.0, 0.0), -2 * math.pi).path()
    return analyse(run_along(path, 50.0, machine, ramp=0.1))


@pytest.mark.parametrize("gains", [(50.0, 40.0, 50.0), (60.0, 66.0, 60.0)])
def test_a_ballbar_sees_unequal_gains(gains) -> None:
    contour = ballbar(Machine(gains))
    mark = signature(contour.circles[0], contour.lag)
    theory = 0.5 * 50.0 * abs(1.0 / gains[0] - 1.0 / gains[1])
    slow = "X lags Y" if gains[0] < gains[1] else "Y lags X"
    assert mark.findings[0].name == "mismatch" and slow in mark.words()[0]
    assert mark.findings[0].size == pytest.approx(theory, rel=0.05)
    # Unequal lags make unequal radii too, 4 % of it here: that is not called a scale.
    assert mark.finding("scale").size < 0.002 * theory


def test_a_ballbar_sees_backlash() -> None:
    contour = ballbar(Machine(gains=(200.0,) * 3, backlash=0.03))
    mark = signature(contour.circles[0], contour.lag)
    assert mark.findings[0].name == "backlash"
    assert mark.findings[0].size == pytest.approx(0.015, rel=0.05)


def test_a_ballbar_tells_several_faults_apart() -> None:
    contour = ballbar(Machine(gains=(50.0, 48.0, 50.0), backlash=0.02))
    test = changed(contour, x=lambda x, y: x * 1.001 + 8e-4 * y)
    mark = signature(test, contour.lag)
    wanted = {
        "mismatch": 0.5 * 50.0 * (1 / 48 - 1 / 50),
        "backlash": 0.01,
        "scale": 0.5 * 1e-3 * 30.0,
        "squareness": 0.5 * 8e-4 * 30.0,
    }
    for name, size in wanted.items():
        assert mark.finding(name).named
        assert mark.finding(name).size == pytest.approx(size, rel=0.1), name


def test_a_perfect_circle_has_no_diagnosis() -> None:
    contour = ballbar(Machine(gains=(100.0,) * 3))
    assert signature(contour.circles[0], contour.lag).words() == [
        "Nothing above 0.5 µm but the mean radius."
    ]
    with pytest.raises(ValueError, match="both ways"):
        signature(replace(contour.circles[0], cw=None))


def test_published_figures_of_controls() -> None:
    radius, feed = 50.0, 100.0
    w = feed / radius
    t1, t2 = 0.024, 1.0 / 33.0
    # FANUC B-63503EN: acceleration after interpolation, exponential and linear, servo 1/Kp
    exponential = servo_formulas.lag_response(w, t1) * servo_formulas.lag_response(w, t2)
    shrunk = -servo_formulas.radius_change(radius, exponential)
    assert shrunk == pytest.approx((t1**2 / 2 + t2**2 / 2) * feed**2 / radius, rel=0.005)
    linear = servo_formulas.average_response(w, t1) * servo_formulas.lag_response(w, t2)
    shrunk = -servo_formulas.radius_change(radius, linear)
    assert shrunk == pytest.approx((t1**2 / 24 + t2**2 / 2) * feed**2 / radius, rel=0.005)
    # Haas 96-8000: Ra = sqrt(R^2 - L^2), L the distance of the tool behind the command
    h = servo_formulas.lag_response(w, t2)
    following = radius * abs(1.0 - h)
    own = servo_formulas.following_radius(radius, following)
    assert own == pytest.approx(radius + servo_formulas.radius_change(radius, h), rel=1e-12)
    # PMAC: cubic B-spline V^2 T^2/(6 R): 100 mm/s, 10 ms, 50 mm: 3 um
    spline = -servo_formulas.radius_change(radius, servo_formulas.average_response(w, 0.01, 4))
    assert spline == pytest.approx((feed * 0.01) ** 2 / (6.0 * radius), rel=1e-3)
    assert round(spline * 1e3) == 3
    # A polygon's mean radius is two thirds of its sag inside.
    polygon = -servo_formulas.radius_change(radius, servo_formulas.average_response(w, 0.01, 2))
    assert polygon == pytest.approx(2.0 / 3.0 * servo_formulas.chord(radius, feed, 0.01), rel=1e-3)


@pytest.mark.parametrize(
    ("inner", "late"),
    [
        ({}, 0.0),
        ({"lag": 2e-3}, 2e-3),
        ({"lag": 2e-3, "period": 1e-3, "delay": 2e-3}, 4.5e-3),
        ({"velocity_gain": 0.5, "inertia": 2e-3}, 4e-3),
        ({"velocity_gain": 0.5, "velocity_time": 0.02, "inertia": 2e-3}, 0.0),
    ],
)
def test_a_circle_to_second_order(inner: dict[str, float], late: float) -> None:
    """V^2/(2 R) (2 c/Kp - 1/Kp^2): c is lag, delay and half a sample; an integral takes the lag
    of the speed away."""
    gain, radius, feed = 40.0, 10.0, 1.0
    change = servo_formulas.radius_change(radius, ServoAxis(gain, **inner).response(feed / radius))
    said = feed**2 / (2.0 * radius) * (2.0 * late / gain - 1.0 / gain**2)
    assert change == pytest.approx(said, rel=2e-4)


@pytest.mark.parametrize(("kx", "ky"), [(40.0, 44.0), (50.0, 30.0)])
def test_unequal_lags_to_first_order(kx: float, ky: float) -> None:
    """Half an axis of the oval is V/2 (1/Kx - 1/Ky) longer, the other one shorter."""
    radius, feed = 50.0, 20.0
    x, y = (ServoAxis(k).response(feed / radius) for k in (kx, ky))
    large, small = servo_formulas.ellipse(radius, (x, y))
    oval = 0.5 * feed * abs(1.0 / kx - 1.0 / ky)
    assert 0.5 * (large - small) == pytest.approx(oval, rel=1e-3)


def test_a_reversal_without_inertia() -> None:
    """2 Fc/Kv (e^-at - e^-bt)/(b - a), a = Kp, b = 1/Ti: a peak of k^(1/(1 - k)), k = Kp Ti."""
    axis = ServoAxis(50.0, velocity_gain=0.5, inertia=1e-7, friction=0.2, travel=10.0)
    step = servo_formulas.reversal(axis)[0]
    for ratio in (1.001, 3.0, 0.4):  # Kp Ti
        peak = servo_formulas.reversal(replace(axis, velocity_time=ratio / 50.0))[1]
        assert peak / step == pytest.approx(ratio ** (1.0 / (1.0 - ratio)), rel=2e-3)


def first_order(command: np.ndarray, gain: float, step: float) -> np.ndarray:
    out, x = np.empty_like(command), command[0]
    for i, goal in enumerate(command):
        out[i] = x
        x = goal + (x - goal) * math.exp(-gain * step)
    return out


@pytest.mark.parametrize("kind", ["sharp", "stop", "blended"])
@pytest.mark.parametrize("angle", [90.0, 60.0])
def test_corners_against_a_simulated_loop(kind: str, angle: float) -> None:
    feed, gain, step, acc, th = 50.0, 40.0, 1e-5, 500.0, math.radians(angle)
    t = np.arange(-0.6, 0.6, step)
    ramp = feed / acc
    if kind == "sharp":
        one, two = np.minimum(feed * t, 0.0), np.maximum(feed * t, 0.0)
        said = servo_formulas.corner(feed, th, gain)
        assert said == pytest.approx(math.sin(th) * feed / (math.e * gain), rel=1e-9)
    else:
        late = 0.0 if kind == "stop" else ramp
        u = np.clip(ramp - t - ramp, 0.0, None) if kind == "stop" else np.clip(ramp - t, 0.0, None)
        brake = np.where(u < ramp, 0.5 * acc * u**2, feed * u - 0.5 * feed * ramp)
        v = np.clip(t, 0.0, None)
        one, two = -brake, np.where(v < ramp, 0.5 * acc * v**2, feed * v - 0.5 * feed * ramp)
        said = (
            servo_formulas.corner(0.0, th, gain, acc)
            if kind == "stop"
            else servo_formulas.blended_corner(feed, th, gain, acc)
        )
        assert late in (0.0, ramp)
    x, y = -first_order(one, gain, step), first_order(two, gain, step)
    error = math.sin(th) * float(np.minimum(x, y).max())
    assert said == pytest.approx(error, rel=0.02)


@pytest.mark.parametrize("lags", [0.01, 0.5, 1.5, 1.999, 2.001, 4.0])
def test_a_blend_of_any_length_against_a_simulated_loop(lags: float) -> None:
    """A ramp of so many servo lags: the shorter it is, the sharper the corner."""
    feed, gain, th, step = 50.0, 40.0, math.radians(70.0), 2e-5
    ramp = lags / gain
    t = np.arange(-0.1, 0.3, step)
    left, gone = np.clip(ramp - t, 0.0, None), np.clip(t, 0.0, None)
    one, two = (
        np.where(u < ramp, 0.5 * feed / ramp * u**2, feed * (u - 0.5 * ramp)) for u in (left, gone)
    )
    behind = [c - lag_error(c, gain, step) for c in (-one, two)]
    behind[0] -= feed / gain * np.exp(-gain * (t + 0.1))  # a steady lag from the start on
    error = math.sin(th) * float(np.minimum(-behind[0], behind[1]).max())
    said = servo_formulas.blended_corner(feed, th, gain, feed / ramp)
    assert said == pytest.approx(error, rel=2e-3)


@pytest.mark.parametrize("gain", [1e7, 400.0, 20.0])
def test_chords_behind_a_servo_against_a_simulated_loop(gain: float) -> None:
    """A servo that follows all shows the sag, a slow one two thirds of it."""
    period, count = 0.01, 4000
    t = np.arange(60 * count) / count  # chords
    sag = 4.0 * (t % 1.0) * (1.0 - t % 1.0)
    seen = sag - lag_error(sag, gain, period / count)
    largest = float(seen[-count:].max())
    said = servo_formulas.chord_behind_servo(1.0, period, ServoAxis(gain))
    assert said == pytest.approx(largest, rel=0.005)
    assert 2.0 / 3.0 < said < 1.0


def test_ellipse_and_reversal_against_brute_force() -> None:
    x, y = ServoAxis(50.0).response(2.0), ServoAxis(40.0, period=1e-3, delay=1e-3).response(2.0)
    turn = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 20001))
    size = np.hypot((x * turn).real, (y * turn).imag)
    assert servo_formulas.ellipse(1.0, (x, y)) == pytest.approx((size.max(), size.min()), rel=1e-6)
    axis = ServoAxis(
        50.0, velocity_gain=0.5, velocity_time=0.02, inertia=2e-3, friction=0.2, travel=10.0
    )
    step, place, speed, integral, largest = 1e-6, 0.0, 0.0, 0.0, 0.0
    for _ in range(150_000):
        ask = 0.5 * (-50.0 * place - speed)
        integral += ask * step / 0.02
        speed += step / 2e-3 * (ask + integral - 0.4)
        place += speed * step
        largest = max(largest, -place)
    peak = largest * 10.0 / (2.0 * math.pi)
    assert servo_formulas.reversal(axis)[1] == pytest.approx(peak, rel=0.01)
    stiff = servo_formulas.reversal(replace(axis, velocity_time=0.0))
    assert stiff[0] == pytest.approx(2 * 0.2 / (50.0 * 0.5) * 10.0 / (2 * math.pi))
    assert stiff[1] == 0.5 * stiff[0]
    assert servo_formulas.lost_motion_arc(50.0, 0.01) == pytest.approx(math.acos(1.0 - 0.01 / 50.0))
    assert servo_formulas.line_mismatch(100.0, math.pi / 4, (40.0, 50.0)) == pytest.approx(0.25)


@pytest.mark.parametrize(
    "file", sorted(ROOT.glob("fmus/*/causes.toml")), ids=lambda f: f.parent.name
)
def test_the_causes_of_every_fmu_are_in_it_and_name_its_variables(file: Path) -> None:
    found = cause_switches.of_fmu(file.parent.name)
    assert len(found) > 1 and cause_switches.THEORY in found
    with zipfile.ZipFile(fmus.fmu_path(file.parent.name)) as archive:
        assert archive.read(f"{EXTRA}/{cause_switches.FILE}") == file.read_bytes()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[heat]\nset = { tau = 0 }\n", r"own/causes.toml: \[heat\]: .* needs a title"),
        ("[mismatch]\nmean = ['tua']\n", r"\[mismatch\]: own has no variable 'tua'"),
        ("[mismatch]\nmeans = ['tau']\n", r"own/causes.toml: .*means"),
        ("[mismatch\n", r"own/causes.toml:1: "),
        ("[heat]\ntitle = 'Heat'\nset = { tau = 0 }\n", None),
    ],
)
def test_an_fmu_brings_its_causes_with_it(text, message, tmp_path, monkeypatch) -> None:
    for name in ("mcc", "epcio", "scope"):
        (tmp_path / f"{name}.fmi3.fmu").symlink_to(FMUS / f"{name}.fmi3.fmu")
    with (
        zipfile.ZipFile(FMUS / "velocity_axes.fmi3.fmu") as old,
        zipfile.ZipFile(tmp_path / "own.fmi3.fmu", "w") as new,
    ):
        for item in old.namelist():
            new.writestr(item, text if item == f"{EXTRA}/{cause_switches.FILE}" else old.read(item))
    monkeypatch.setenv("MOTIONFMU_FMUS", str(tmp_path))
    cause_switches.of_fmu.cache_clear()
    fmus._ports.cache_clear()
    try:
        if message is not None:
            with pytest.raises(InputError, match=message):
                cause_switches.of_fmu("own")
            return
        shutil.copytree(ROOT / "scenarios/mismatch_line", tmp_path / "line")
        file = tmp_path / "line/scenario.toml"
        own = '[component]\nmachine = "own"\n\n[record]'
        file.write_text(file.read_text().replace("[record]", own, 1))
        listed = cause_switches.causes(motionfmu.load(file))
        assert listed[-1].name == "heat" and listed[-1].title == "Heat"
    finally:
        cause_switches.of_fmu.cache_clear()
        fmus._ports.cache_clear()


def test_a_cause_that_cannot_be_switched_off_says_why() -> None:
    """16 bit would be wanted for pulses an eighth as long; a late PC must not change the motion."""
    found = explain(ROOT / "scenarios/interpolation_points", stop=1.3)
    effect = found.effect("quantisation")
    assert not effect.judged and "dda_length: 16 would be wanted" in effect.how
    assert found.effects[0].name == "chord"
    with pytest.raises(KeyError, match="no effect 'heat', there is chord"):
        found.effect("heat")
    # A corner run through without a stop for the tool: 0.2725 a/Kp^2, a = V/t.
    corner = found.corners[0]
    gain = 40 * 8 * PER_GAIN
    assert corner.kind == "stop" and corner.theory == pytest.approx(
        0.2725 * 100.0 / 0.05 / gain**2, rel=0.001
    )
    assert corner.ideal == pytest.approx(corner.theory, rel=0.05)


def test_expressions_are_arithmetic_only() -> None:
    values = {"a": np.array([1.0, 2.0]), "m": np.array([1.0, 1.0])}
    assert evaluate("2 * a**2 / 4 + pi - pi if m == 1 else 0", values).tolist() == [0.5, 2.0]
    for bad in ("b", "a.size", "__import__('os')", "a +", "[1]", "'x'"):
        with pytest.raises(ValueError, match=r"no parameter|not understood|invalid syntax"):
            evaluate(bad, values)


def test_the_command_writes_a_page_or_nothing(tmp_path: Path) -> None:
    from motionfmu.cli import app

    out = tmp_path / "r"
    line = str(ROOT / "scenarios/mismatch_line")
    done = CliRunner().invoke(app, ["contour", line, "--out", str(out)], catch_exceptions=False)
    assert done.exit_code == 0 and "Mismatch of the axes" in done.stdout
    numbers = json.loads((out / "result.json").read_text())
    first = numbers["effects"][0]
    assert first["name"] == "mismatch" and first["size"] == pytest.approx(0.262, abs=1e-3)
    assert first["theory"] == pytest.approx(first["size"], rel=0.01)
    page = (out / "report.html").read_text()
    assert "262 µm" in page and "Residual" in page and (out / "causes.png").stat().st_size > 5000
    for wrong, words in (
        ([str(ROOT / "scenarios/fifo_one")], r"\[contour\]"),
        ([line, "--set", "mcc.p_gian=3"], "p_gain"),
    ):
        with pytest.raises(InputError, match=words):
            CliRunner().invoke(
                app, ["contour", *wrong, "--out", str(tmp_path / "no")], catch_exceptions=False
            )
        assert not (tmp_path / "no").exists()
