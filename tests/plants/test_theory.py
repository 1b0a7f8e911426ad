"""Contour errors of the running FMUs against closed formulas.

Every number is taken from the table position of the velocity axes, whose position loop is closed
by the card. V feed [mm/s], R radius [mm], w = V/R [rad/s], Kp position gain [1/s], tau lag of the
velocity loop [s], T sampling time [s]. A result must agree within 0.5 % or 0.2 um.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import motionfmu

COUNTS = 100_000  # encoder counts and command pulses per turn
LEAD = 10.0  # [mm]
SPEED_PER_VOLT = 300.0  # [rpm/V]
DAC_LSB = 20.0 / 65536.0  # [V]
P_SCALE = 6


def kp_of(gain: int) -> float:
    """Position gain [1/s] that a register value of the card's P loop makes."""
    return gain / 2**P_SCALE * DAC_LSB * SPEED_PER_VOLT / 60.0 * COUNTS


def agrees(value: float, theory: float) -> bool:
    """Within 0.5 % or 0.2 um, whichever is larger; lengths in mm."""
    return abs(value - theory) <= max(0.005 * abs(theory), 0.2e-3)


def run(tmp_path: Path, program: str, sample: float, **options):
    """Run `program` on two velocity axes, everything sampled every `sample` seconds."""
    file = tmp_path / "program.ngc"
    file.write_text(program)
    settings = {
        "mcc.program": str(file),
        "mcc.ppr": COUNTS,
        "mcc.lead": LEAD,
        "mcc.bus_period": max(sample, 1e-4),
        "card.loop_period": sample,
        "card.p_scale": P_SCALE,
        "machine.encoder_lines": COUNTS // 4,
        "machine.micro_step": min(sample, 25e-6),
        **{k.replace("__", "."): v for k, v in options.items() if "__" in k},
    }
    scenario = motionfmu.load(ROOT / "scenarios/circle_theory")
    result = scenario.run(set=settings, step=sample, stop=options.get("stop"))
    assert result["mcc.done"][-1] and not result["mcc.error"].any()
    assert not result["mcc.starved"].any() and not result["card.underflows"].any()
    return result


def circle(radius: float, feed: float, direction: int = 3) -> str:
    return (
        f"G21 G17 G90 G61\nG1 X{radius} Y0 F{feed * 60}\n"
        f"G{direction} X{radius} Y0 I{-radius} J0\nM30\n"
    )


def phasors(result, radius: float, feed: float, source: str = "machine") -> np.ndarray:
    """Complex amplitudes [mm] of x and y on the steady part of the circle."""
    t = result.time
    omega = feed / radius
    moving = result["mcc.path_feed"] > 0.999999 * feed
    start, end = t[moving][0], t[moving][-1]
    # The first steady stretch is the straight run-in; the circle is the last one.
    gaps = np.flatnonzero(np.diff(t[moving]) > 0.01)
    if gaps.size:
        start = t[moving][gaps[-1] + 1]
    chosen = (t > start + 0.35) & (t < end - 0.05)
    assert (t[chosen][-1] - t[chosen][0]) * omega > 0.75 * math.pi
    tone = np.column_stack(
        [np.cos(omega * t[chosen]), np.sin(omega * t[chosen]), np.ones(chosen.sum())]
    )
    if source == "machine":
        xy = result["machine.table_position"][chosen, :2] * 1e3
    else:
        xy = result["card.pulse_count"][chosen, :2] * (LEAD / COUNTS)
    fit, *_ = np.linalg.lstsq(tone, xy, rcond=None)
    return fit[0] - 1j * fit[1]


def mean_radius(result, radius: float, feed: float) -> float:
    x, y = phasors(result, radius, feed)
    return 0.5 * abs(x + 1j * y) if abs(x + 1j * y) > abs(x - 1j * y) else 0.5 * abs(x - 1j * y)


@pytest.mark.parametrize(
    ("radius", "feed", "gain"), [(10.0, 50.0, 20), (20.0, 120.0, 25), (5.0, 30.0, 15)]
)
def test_circle_with_an_ideal_velocity_axis(tmp_path, radius, feed, gain) -> None:
    """dR = R (1/sqrt(1 + (V/(R Kp))^2) - 1)."""
    result = run(tmp_path, circle(radius, feed), 1e-5, mcc__p_gain=gain)
    theory = radius * (1.0 / math.hypot(1.0, feed / (radius * kp_of(gain))) - 1.0)
    measured = mean_radius(result, radius, feed) - radius
    assert agrees(measured, theory), (measured, theory)


@pytest.mark.parametrize(
    ("radius", "feed", "gain", "share"),
    [(10.0, 50.0, 20, 0.25), (10.0, 60.0, 15, 0.5), (20.0, 100.0, 20, 0.125)],
)
def test_circle_with_a_lagging_velocity_axis(tmp_path, radius, feed, gain, share) -> None:
    """dR = R (|Kp/(tau s^2 + s + Kp)| - 1) at s = jw; tau = share/Kp."""
    kp = kp_of(gain)
    tau, s = share / kp, 1j * feed / radius
    result = run(tmp_path, circle(radius, feed), 1e-5, mcc__p_gain=gain, machine__tau=tau)
    theory = radius * (abs(kp / (tau * s * s + s + kp)) - 1.0)
    measured = mean_radius(result, radius, feed) - radius
    assert agrees(measured, theory), (measured, theory)


@pytest.mark.parametrize(
    ("gain", "sample", "feed"), [(20, 5e-3, 50.0), (20, 2e-3, 45.0), (12, 8e-3, 40.0)]
)
def test_circle_of_a_sampled_loop_at_step_equal_to_sampling_time(
    tmp_path, gain, sample, feed
) -> None:
    """|Kp T/(z^d (z - 1) + Kp T)|, z = exp(jwT), one whole sample of computation delay: d = 1."""
    radius = 10.0
    result = run(
        tmp_path,
        circle(radius, feed),
        sample,
        mcc__p_gain=gain,
        mcc__batch=16,
        mcc__min_stock=40,
        mcc__dda_time=2.048e-3,  # the mailbox carries 16 frames in three bus periods
    )
    kt, z = kp_of(gain) * sample, np.exp(1j * feed / radius * sample)
    theory = radius * (abs(kt / (z * (z - 1.0) + kt)) - 1.0)
    continuous = radius * (1.0 / math.hypot(1.0, feed / (radius * kp_of(gain))) - 1.0)
    measured = mean_radius(result, radius, feed) - radius
    assert agrees(measured, theory), (measured, theory)
    assert not agrees(measured, continuous), "the check could not tell the sampled loop"


@pytest.mark.parametrize(("gains", "direction"), [((20, 16), 3), ((20, 16), 2), ((14, 22), 3)])
def test_unequal_gains_make_an_ellipse_that_turns_with_the_direction(
    tmp_path, gains, direction
) -> None:
    """Semi-axes: singular values of the two axes' response phasors; near +-45 degrees."""
    radius, feed = 10.0, 50.0
    result = run(tmp_path, circle(radius, feed, direction), 1e-5, mcc__p_gain=[*gains, 0, 0, 0, 0])
    x, y = phasors(result, radius, feed)
    w = feed / radius
    kx, ky = (kp_of(g) for g in gains)
    hx, hy = (k / (1j * w + k) for k in (kx, ky))
    turn = 1 if direction == 3 else -1
    measured = np.linalg.svd([[x.real, x.imag], [y.real, y.imag]])
    ideal = radius * np.array([hx, hy * np.exp(-1j * turn * math.pi / 2.0)])
    theory = np.linalg.svd(np.column_stack([ideal.real, ideal.imag]))
    for a, b in zip(measured[1], theory[1], strict=True):
        assert agrees(a - radius, b - radius), (a, b)
    slope = math.degrees(math.atan2(measured[0][1, 0], measured[0][0, 0])) % 180.0
    expected = 45.0 if (turn > 0) == (ky > kx) else 135.0
    assert abs(slope - expected) < 10.0


@pytest.mark.parametrize(
    ("angle", "gains", "feed"),
    [(45.0, (20, 16), 100.0), (30.0, (16, 24), 60.0), (70.0, (18, 20), 40.0)],
)
def test_line_with_mismatched_gains(tmp_path, angle, gains, feed) -> None:
    """Steady contour error V sin a cos a (1/Kx - 1/Ky)."""
    a = math.radians(angle)
    length = 1.2 * feed
    x, y = length * math.cos(a), length * math.sin(a)
    program = f"G21 G17 G90 G61\nG1 X{x:.6f} Y{y:.6f} F{feed * 60}\nM30\n"
    result = run(tmp_path, program, 1e-5, mcc__p_gain=[*gains, 0, 0, 0, 0])
    moving = np.flatnonzero(result["mcc.path_feed"] > 0.999999 * feed)
    k = moving[int(0.8 * moving.size)]
    x, y = result["machine.table_position"][k, :2] * 1e3
    measured = x * math.sin(a) - y * math.cos(a)
    kx, ky = (kp_of(g) for g in gains)
    theory = -feed * math.sin(a) * math.cos(a) * (1.0 / kx - 1.0 / ky)
    assert agrees(measured, theory), (measured, theory)


@pytest.mark.parametrize(
    ("turn", "gain", "feed"), [(90.0, 10, 50.0), (60.0, 12, 80.0), (120.0, 8, 30.0)]
)
def test_sharp_corner(tmp_path, turn, gain, feed) -> None:
    """Largest contour error sin(th) V/(e Kp), th the angle of turn, matched first-order loops.

    For turns up to 90 degrees; the corner passes at full feed, the ramps of 1 ms overlapping.
    """
    th = math.radians(turn)
    kp = kp_of(gain)
    run_in = 12.0 * feed / kp
    x1 = run_in + run_in * math.cos(th)
    program = (
        f"G21 G17 G90 G64\nG1 X{run_in:.6f} Y0 F{feed * 60}\n"
        f"X{x1:.6f} Y{run_in * math.sin(th):.6f}\nM30\n"
    )
    result = run(tmp_path, program, 2e-5, mcc__p_gain=gain, mcc__acc_time=1e-3, mcc__dec_time=1e-3)
    xy = result["machine.table_position"][:, :2] * 1e3 - [run_in, 0.0]
    direction = np.array([math.cos(th), math.sin(th)])
    first = np.hypot(np.maximum(xy[:, 0], 0.0), xy[:, 1])
    along = np.maximum(xy @ direction, 0.0)
    second = np.hypot(*(xy - along[:, None] * direction).T)
    near = np.hypot(*xy.T) < 0.8 * run_in
    measured = np.minimum(first, second)[near].max()
    theory = math.sin(th) * feed / (math.e * kp)
    assert agrees(measured, theory), (measured, theory)


@pytest.mark.parametrize("divider", [10, 5])
@pytest.mark.parametrize(("radius", "feed"), [(2.0, 35.0), (3.0, 30.0)])
def test_chord_error_of_the_interpolation(tmp_path, radius, feed, divider) -> None:
    """R (1 - cos(V T/(2 R))): the pulses of one DDA time run along a chord."""
    counts = 1_000_000
    dda_time = 2**15 * divider * 25e-9
    result = run(
        tmp_path,
        circle(radius, feed),
        1e-4,
        mcc__ppr=counts,
        mcc__dda_length=15,
        mcc__dda_time=dda_time,
        mcc__output_mode=0,
    )
    t = result.time
    steady = result["mcc.path_feed"] > 0.999999 * feed
    window = (t > t[steady][-1] - 2.0 * radius / feed) & (t < t[steady][-1] - 10 * dda_time)
    r = np.hypot(*(result["card.pulse_count"][window, :2] * (LEAD / counts)).T)
    theory = radius * (1.0 - math.cos(feed * dda_time / (2.0 * radius)))
    assert agrees(radius - r.min(), theory), (radius - r.min(), theory)
    assert abs(r.max() - radius) < 0.2e-3


@pytest.mark.parametrize("gain", [10, 3, 40])
def test_counts_that_the_dac_rounds_away(tmp_path, gain) -> None:
    """An error of less than 2^scale/(2 gain) counts asks for less than half a code: the axis rests.

    Only X has an error that is left; it comes from one side.
    """
    program = "G21 G17 G90 G61\nG1 X1 Y0 F300\nG4 P1.5\nM30\n"
    result = run(tmp_path, program, 1e-4, mcc__p_gain=gain)
    left = result["card.err_count"][-1, 0]
    assert left == math.ceil(2**P_SCALE / (2.0 * gain)) - 1
