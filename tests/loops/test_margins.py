"""Margins against published numbers, and largest gains by poles and by ringing FMUs."""

import json
import math
import re
from pathlib import Path

import control
import numpy as np
import pytest
from linear_rigs import DEMO, MODES, SMOOTH, THEORY, WIDE, theory
from typer.testing import CliRunner

import motionfmu
from motionfmu import InputError
from motionfmu.analysis import freq, linear
from motionfmu.analysis.freq import limit
from motionfmu.analysis.freq.limit import RingingTest, simulated_gain, small_signal_gain, usual_kick
from motionfmu.analysis.freq.loop_study import LoopStudyOptions, study
from motionfmu.analysis.linear.loops import Limit, boundary, feedbacks, largest_gain
from motionfmu.analysis.linear.stability import closed_poles, margins, response
from motionfmu.cli import app
from motionfmu.report.loop_pages.margin_page import point_line

ENC, PHASE = "card.enc_phase", "drives.phase"
T = 1e-4  # [s]


def test_the_allmargin_example_of_mathworks() -> None:
    """25/(s^3 + 10 s^2 + 10 s + 10): gain 3.6000, phase 29.1104 degrees, delay 0.2847 s."""
    found = margins(control.tf([25.0], [1.0, 10.0, 10.0, 10.0]))
    assert found.stable
    assert found.gain == pytest.approx(3.6, abs=5e-5)
    assert found.phase == pytest.approx(29.1104, abs=5e-5)
    assert found.delay == pytest.approx(0.2847, abs=5e-5)


LOOPS = [
    control.tf([25.0], [1.0, 10.0, 10.0, 10.0]),
    control.tf([5.0, 5.0], [1.0, 2.0, 100.0, 0.0]),  # a resonance
    control.tf([0.3, 0.1], [1.0, -1.7, 0.72], 0.01),
    control.tf([0.4], [1.0, -1.0, 0.0, 0.0], 1e-4),
]


@pytest.mark.parametrize("loop", LOOPS)
def test_margins_are_those_of_python_control(loop: control.TransferFunction) -> None:
    found, grid = margins(loop), np.geomspace(1e-4, 1.0, 10_001)
    grid = grid * (np.pi / loop.dt if loop.dt else 1e3)
    gain, phase, distance, *_ = control.stability_margins(loop)
    assert found.gain == pytest.approx(gain, rel=1e-6)
    assert found.phase == pytest.approx(phase, rel=1e-6)
    assert 1.0 / found.sensitivity == pytest.approx(distance, rel=1e-4)
    disk, decibel, angle = control.disk_margins(control.ss(loop), grid)
    assert found.disk == pytest.approx(disk, rel=1e-4)
    assert 20.0 * math.log10(found.disk_gain) == pytest.approx(decibel, rel=1e-4)
    assert found.disk_phase == pytest.approx(angle, rel=1e-4)
    closed = control.feedback(control.ss(loop), 1)
    assert abs(
        closed(np.exp(1j * found.bandwidth * loop.dt) if loop.dt else 1j * found.bandwidth)
    ) == pytest.approx(math.sqrt(0.5))


OTHERS = [
    control.tf([60.0, 60.0], [1.0, 2.0, 100.0, 0.0]),  # crosses 1 three times
    control.tf([0.3, 0.6, 0.3], [1.0, 0.0, 0.0, 0.0]),  # unstable: the phase must go nearly round
]


@pytest.mark.parametrize("loop", [*LOOPS, *OTHERS])
def test_a_dead_time_of_the_margin_meets_minus_one(loop: control.TransferFunction) -> None:
    """1 + L e^(-s t) = 0 at each crossing; the margin is the smallest t."""
    found = margins(loop)
    assert len(found.phase_crossings) == (3 if loop is OTHERS[0] else 1)
    for c in found.phase_crossings:
        value = loop(np.exp(1j * c.omega * loop.dt) if loop.dt else 1j * c.omega)
        assert 0.0 < c.delay <= 2.0 * math.pi / c.omega
        assert value * np.exp(-1j * c.omega * c.delay) == pytest.approx(-1.0, abs=1e-9)
        assert value * np.exp(-1j * math.radians(c.value)) == pytest.approx(-1.0, abs=1e-9)
    assert found.delay == min(c.delay for c in found.phase_crossings)


@pytest.mark.parametrize("late", [1, 7])
def test_a_loop_rings_with_the_dead_time_of_its_margin(late: int) -> None:
    """k/(z - 1) with n samples: the margin of the loop is what another n samples leave of it."""
    loop, shift = control.tf([0.02], [1.0, -1.0], 1e-3), control.tf([1.0], [1.0, 0.0], 1e-3)
    whole, n = margins(loop).delay, round(margins(loop).delay / 1e-3)
    assert margins(loop * shift**late).delay == pytest.approx(whole - late * 1e-3, rel=1e-9)
    assert margins(loop * shift ** (n - 1)).stable and not margins(loop * shift ** (n + 1)).stable


@pytest.mark.parametrize("loop", LOOPS)
def test_a_peak_of_the_sensitivity_bounds_gain_and_phase(loop: control.TransferFunction) -> None:
    """|1 + L| >= 1/Ms: gain at least Ms/(Ms - 1), phase at least 2 asin(1/(2 Ms)); and the disk."""
    found = margins(loop)
    peak = found.sensitivity
    assert found.gain >= peak / (peak - 1.0) * (1.0 - 1e-6)
    assert found.phase >= math.degrees(2.0 * math.asin(0.5 / peak)) - 1e-6
    assert found.gain >= found.disk_gain * (1.0 - 1e-6)
    assert found.phase >= found.disk_phase - 1e-6
    half = 0.5 * found.disk
    assert found.disk_gain == pytest.approx((1.0 + half) / (1.0 - half))


@pytest.mark.parametrize("gain", [200, 2000, 6000])
def test_what_the_sensitivity_gains_it_loses(gain: int) -> None:
    """The mean of ln |S| up to half the sampling rate is 0, whatever the gain (Bode, discrete)."""
    loop = theory(mcc__p_gain=gain).loop(ENC)
    count = 100_000
    omega = (np.arange(count) + 0.5) * math.pi / count / loop.dt
    size = np.log(np.abs(1.0 + response(loop, omega)))
    assert size.mean() == pytest.approx(0.0, abs=1e-5)
    assert size.max() > 0.1 and size.min() < -0.005


def test_a_gain_beyond_its_margin_is_unstable() -> None:
    loop = theory(mcc__p_gain=200).loop(ENC)
    top = margins(loop).gain
    assert margins(0.999 * loop).stable and not margins(1.001 * top * loop).stable
    assert np.abs(closed_poles(loop, top)).max() == pytest.approx(1.0, abs=1e-9)
    assert margins(1.2 * top * loop).gain_down == pytest.approx(1.0 / 1.2)


def test_the_margins_are_the_nearest_of_several() -> None:
    """Three integrators, two leads: stable in two ranges of the gain, by the closed poles."""
    num = np.poly([-1.0, -1.2, -100.0, -120.0])
    den = np.poly([0.0, 0.0, 0.0, -10.0, -12.0, -1000.0])
    at_300 = control.tf(num, den)(300j)
    num = num / abs(at_300)  # crosses 1 at 300 rad/s, above its three crossings of -180 degrees

    def stable(gain: float) -> bool:
        return bool(np.roots(np.polyadd(den, gain * num)).real.max() < 0.0)

    def edge(low: float, high: float) -> float:
        for _ in range(60):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if stable(middle) == stable(low) else (low, middle)
        return low

    edges = [edge(1e-5, 1e-4), edge(1e-4, 1e-2), edge(1e-2, 1.0)]
    assert [stable(g) for g in (1e-5, 1e-4, 1e-2, 1.0)] == [False, True, False, True]
    found = margins(control.tf(num, den))
    assert sorted(c.value for c in found.gain_crossings) == pytest.approx(edges, rel=1e-6)
    assert found.gain_down == pytest.approx(edges[2], rel=1e-6)
    found = margins(control.tf(2.0 * edges[0] * num, den))  # between the first two
    assert found.gain_down == pytest.approx(0.5, rel=1e-6)
    assert found.gain == pytest.approx(edges[1] / (2.0 * edges[0]), rel=1e-6)


def test_a_loop_that_rings_at_half_the_sampling_rate() -> None:
    """k/(z - 1) without a delay: k < 2, at z = -1, the end of the curve."""
    found = margins(control.tf([0.5], [1.0, -1.0], 1e-3))
    assert found.gain == pytest.approx(4.0)
    assert found.omega_gain == pytest.approx(math.pi / 1e-3)
    assert margins(control.tf([0.5], [1.0, 1.0])).gain == math.inf  # a first-order lag: never


def test_the_search_for_a_boundary() -> None:
    found, _ = boundary(lambda v: v - 7.3, 0.02, 1e-9, False)
    assert found == pytest.approx(7.3)
    found, _ = boundary(lambda v: v - 7.3, 4000.0, 1e-9, False)
    assert found == pytest.approx(7.3)
    found, tried = boundary(lambda v: v - 7.3, 3.0, 1e-9, True)
    assert found == pytest.approx(7.3) and tried < 8
    assert boundary(lambda v: -1.0, 1.0, 1e-9, False)[0] == math.inf
    assert boundary(lambda v: 1.0, 1.0, 1e-9, False)[0] == 0.0


CASES = [
    # scenario, axis, operating point, values, loop, parameter
    (THEORY, 1, {}, {}, ENC, None),
    (THEORY, 1, {}, {"machine.tau": 1e-3, "machine.encoder_lines": 2**18}, ENC, "mcc.p_gain"),
    (MODES, 2, {}, WIDE | SMOOTH, PHASE, "drives.velocity_gain"),
    (MODES, 1, {}, WIDE | SMOOTH, PHASE, "drives.position_gain"),
    (DEMO, 1, {"machine.motor_speed": 30.0}, {}, PHASE, None),
    (DEMO, 2, {"machine.motor_speed": -30.0}, {"drives.velocity_gain": 2.0}, ENC, None),
]


@pytest.mark.parametrize("case", CASES, ids=lambda c: f"{c[0].name}-{c[1]}-{c[4]}-{c[5]}")
def test_largest_gain_by_poles_and_by_ringing(case) -> None:
    scenario, axis, at, set_, loop, gain = case
    if scenario == MODES:  # the fast loop alone, without the screw's resonance that hides it
        set_ = set_ | {"machine.screw_damping": 3e4}
    if set_.get("machine.tau"):
        set_ = set_ | {"mcc.p_gain": 40, "card.p_scale": 10}
    model = linear.model(scenario, axis, at, set_)
    cut = feedbacks(model)[loop]
    expected = largest_gain(model, loop, cut, gain)
    found = simulated_gain(model, (loop, cut), RingingTest(usual_kick(model, loop, cut), 20), gain)
    assert found.gain == pytest.approx(expected.gain, rel=0.02)
    assert found.omega == pytest.approx(expected.omega, rel=0.06)
    assert found.evaluations > 1


def test_the_ringing_does_not_follow_the_linear_model_blindly(monkeypatch) -> None:
    """A search that is told a limit 40 % too large finds the right one as well."""
    model = theory(machine__tau=1e-3, mcc__p_gain=200)
    right = largest_gain(model, ENC)
    wrong = Limit(1.4 * right.gain, right.omega, 0)
    monkeypatch.setattr(limit, "largest_gain", lambda *_: wrong)
    found = simulated_gain(model, (ENC, ()), RingingTest(50.0, 20))
    assert found.gain == pytest.approx(right.gain, rel=0.02)


def test_a_torque_limit_makes_the_kick_smaller() -> None:
    """At twenty times the gain the usual step runs into the drive's 10 N.m, a fifth does not."""
    model = linear.model(MODES, 2, {"machine.motor_speed": 20.0})
    expected = largest_gain(model, ENC, (), "mcc.p_gain").gain
    found, kick = small_signal_gain(model, (ENC, ()), "mcc.p_gain")
    assert found.gain == pytest.approx(expected, rel=0.02)
    assert kick < usual_kick(model, ENC)


def run(*arguments: object):
    return CliRunner().invoke(app, ["margins", *map(str, arguments)])


def test_the_command_writes_a_report_with_all_numbers(tmp_path: Path) -> None:
    out = tmp_path / "out"
    rest = ("--at", "machine.table_speed=0")
    done = run(THEORY, "--set", "machine.tau=1e-3", *rest, "--out", out)
    assert done.exit_code == 0, done.output
    assert "card.enc_phase" in done.output and "mcc.p_gain[1] = 200 (Kp 47.7 1/s)" in done.output
    assert "Position gain Kp" in (out / "report.html").read_text()
    numbers = json.loads((out / "result.json").read_text())
    (loop,) = numbers["loops"]
    model = theory(machine__tau=1e-3)
    expected = margins(model.loop(ENC))
    assert loop["margins"]["gain"] == pytest.approx(expected.gain)
    assert loop["margins"]["phase"] == pytest.approx(expected.phase)
    assert loop["largest_gain"]["gain"] == pytest.approx(expected.gain, rel=1e-6)
    assert loop["largest_gain_simulated"]["gain"] == pytest.approx(expected.gain, rel=0.02)
    omega = np.array(loop["measured"]["omega"])
    measured = np.array(loop["measured"]["real"]) + 1j * np.array(loop["measured"]["imaginary"])
    real = model.loop(ENC)(np.exp(1j * omega * T))
    big = np.abs(real) > 0.1
    assert np.abs(measured[big] / real[big] - 1.0).max() < 0.03
    page = (out / "report.html").read_text()
    for told in (
        "Phase margin",
        "Disk margin",
        "Bode",
        "Nyquist",
        "Step response",
        "machine.table_speed = 0 m/s (stated)",
    ):
        assert told in page
    assert numbers["operating_point"]["machine"]["values"]["motor_speed"] == 0.0
    assert list(tmp_path.iterdir()) == [out]


def test_the_operating_point_is_the_programs_and_told_first(tmp_path: Path) -> None:
    """At rest the demo's axis sticks: 13 degrees of phase that no cut of its circle has."""
    done = run(DEMO, "--no-simulate", "--out", tmp_path / "a")
    first = done.output.splitlines()[0]
    told = re.match(r"Operating point: (\S+) = (\S+) m/s \(mean feed of the program\)", first)
    assert told, first
    speed = float(told[2])
    base = motionfmu.load(DEMO)
    cut = base.run().contour()
    way = np.linalg.norm(np.diff(cut.run.commanded, axis=0), axis=1)[cut.cutting[1:]]
    mean = way[way > 0.0].mean() / np.diff(cut.run.time).mean() / 1e3  # [m/s]
    assert speed == pytest.approx(mean, rel=1e-3) and 0.09 < mean < 0.1
    numbers = json.loads((tmp_path / "a" / "result.json").read_text())
    outer = next(row for row in numbers["loops"] if row["at"] == ENC)
    moving = margins(linear.model(DEMO, 1, {told[1]: mean}).loop(ENC)).phase
    assert outer["margins"]["phase"] == pytest.approx(moving, rel=1e-3) and moving > 80.0
    page = (tmp_path / "a" / "report.html").read_text()
    head = page[page.index("<header>") : page.index("</header>")]
    assert "Operating point: " in head and f"At {told[1]} = " in page and "Stated" not in page

    done = run(DEMO, "--no-simulate", "--at", f"{told[1]}=0", "--out", tmp_path / "b")
    assert done.output.splitlines()[0] == f"Operating point: {told[1]} = 0 m/s (stated)"
    still = point_line(linear.model(DEMO), "no path tells a speed")
    assert still.startswith("Operating point: at rest (no path tells a speed), where friction is")


@pytest.mark.parametrize(
    ("scenario", "axis", "at"),
    [
        (DEMO, 1, {"machine.motor_speed": 30.0}),
        (DEMO, 2, {"machine.motor_speed": -3.0}),
        (MODES, 2, {"machine.motor_speed": 20.0}),
        (MODES, 1, {}),  # at rest, within the friction's steep slope
    ],
    ids=["demo", "demo slow", "modes", "modes at rest"],
)
def test_the_running_fmus_do_what_the_model_says(scenario, axis, at, monkeypatch) -> None:
    """No limit is reached, nothing turns back or comes loose: within 2 % and 2 degrees."""
    monkeypatch.setattr(
        "motionfmu.analysis.freq.loop_study.small_signal_gain", lambda *_: (None, 0.0)
    )
    model = linear.model(scenario, axis, at)
    found = study(model, LoopStudyOptions())
    assert [s.at for s in found] == list(feedbacks(model))
    for s in found:
        assert s.measured is not None and s.difference is not None
        omega = s.measured.omega
        assert omega[0] < 1.5 * s.margins.omega_phase and len(omega) > 30
        real = s.loop(np.exp(1j * omega * s.loop.dt))
        big = np.abs(real) > 0.1
        ratio = s.measured.values[big, 0] / real[big]
        size, angle = np.abs(np.abs(ratio) - 1.0).max(), np.degrees(np.abs(np.angle(ratio))).max()
        assert s.difference == pytest.approx((100.0 * size, angle))
        assert size < 0.02 and angle < 2.0


def test_what_was_not_excited_is_left_out_and_told(tmp_path: Path) -> None:
    """A quarter count beside friction that sticks: nothing small enough stands above rounding."""
    out = tmp_path / "out"
    done = run(DEMO, "--loop", ENC, "--at", "machine.motor_speed=0", "--out", out)
    told = "53 of 53 frequencies left out"
    assert done.exit_code == 0 and told in " ".join(done.output.split())
    (loop,) = json.loads((out / "result.json").read_text())["loops"]
    assert "measured" not in loop and told in loop["notes"][0]
    assert told in (out / "report.html").read_text()


@pytest.mark.parametrize(
    ("peak", "told"), [(2.0, "reached its limit of 1"), (0.05, "no linear loop")]
)
def test_fmus_that_are_not_linear_are_told_of(peak, told, tmp_path, monkeypatch) -> None:
    """A multisine of the old kind fills the torque at its limit; a smaller one meets friction."""

    def large(axis, loop, size, kick) -> freq.Excitation:
        return freq.multisine(*size, peak)

    monkeypatch.setattr("motionfmu.analysis.freq.loop_study.small", large)
    at, set_ = "machine.motor_speed=0.5", "drives.torque_limit=1"
    done = run(
        DEMO, "--loop", PHASE, "--at", at, "--set", set_, "--out", tmp_path / "out", "--kick", 0.05
    )
    assert done.exit_code == 0 and told in " ".join(done.output.split()), done.output
    assert told in (tmp_path / "out" / "report.html").read_text()


def test_an_unstable_loop_is_called_so(tmp_path: Path) -> None:
    done = run(THEORY, "--set", "mcc.p_gain=60000", "--no-simulate", "--out", tmp_path / "out")
    assert done.exit_code == 0 and "unstable" in done.output
    assert "unstable as it is" in (tmp_path / "out" / "report.html").read_text()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([DEMO, "--axis", 9], "axis = 9"),
        ([DEMO, "--at", "machine.motor_speed"], "COMP.VAR=VALUE wanted"),
        ([DEMO, "--at", "machine.motor_speed=fast"], "a number wanted"),
        ([DEMO, "--loop", "card.encphase"], "card.encphase is no input"),
        ([DEMO, "--gain", "mcc.p_gain"], "say with --loop"),
        ([DEMO, "--loop", ENC, "--gain", "mcc.gain"], "mcc.gain"),
        ([DEMO, "--kick", "0"], "kick = 0.0"),
        ([DEMO.parent / "fifo_one"], "no loop"),
    ],
)
def test_a_wrong_command_is_named_and_writes_nothing(tmp_path, arguments, told) -> None:
    done = run(*arguments, "--out", tmp_path / "out")
    assert isinstance(done.exception, InputError)
    assert told in str(done.exception)
    assert not list(tmp_path.iterdir())


def test_without_a_point_the_scenario_is_read_and_run_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A model that is moved to the program's speed is the one made there."""
    seen: list[str] = []
    own, models = motionfmu.Scenario.run, linear.axis.parts
    monkeypatch.setattr(
        motionfmu.Scenario, "run", lambda *a, **k: seen.append("run") or own(*a, **k)
    )
    monkeypatch.setattr(
        linear.axis,
        "parts",
        lambda *a: seen.append("new" if a[4] is None else "kept") or models(*a),
    )
    done = run(DEMO, "--no-simulate", "--out", tmp_path)
    assert done.exit_code == 0, done.output
    assert (seen.count("new"), seen.count("run")) == (1, 1)

    at = {"machine.motor_speed": 30.0}
    moved, made = linear.model(DEMO).moved(at), linear.model(DEMO, 1, at)
    assert moved.at == made.at and moved.points.keys() == made.points.keys()
    z = np.exp(1j * np.array([1.0, 30.0, 900.0]) * T)
    assert np.array_equal(moved.loop(ENC)(z), made.loop(ENC)(z))
