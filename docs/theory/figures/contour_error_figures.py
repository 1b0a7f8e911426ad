"""Figures of the page about the contour error, from the package's formulas and runs of its FMUs."""

import math

import numpy as np
from fmu_runs import PER_GAIN, circles, ran
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from plots import BLUE, GREEN, GREY, ORANGE, RED, Array, figure, panels, tube
from scipy.signal import lti

from motionfmu import Result
from motionfmu.analysis.contour.circles import CirclePass
from motionfmu.analysis.explain import servo_formulas
from motionfmu.analysis.explain.servo_formulas import ServoAxis

LOOP = 1e-4  # [s] period of the card's loop, and its delay


@figure
def nearest_point() -> plt.Figure:
    """A tool that lags on a circle: its nearest point, and what a tangent tells."""
    fig, ax = panels(1, 1, (6.4, 3.9))
    lag = math.radians(32.0)
    angle = np.linspace(math.radians(20.0), math.radians(108.0), 200)
    ax.plot(np.cos(angle), np.sin(angle), color=GREY, linewidth=1.4)
    at = math.radians(95.0)
    goal = np.array([math.cos(at), math.sin(at)])
    own = at - lag
    tool = math.cos(lag) * np.array([math.cos(own), math.sin(own)])
    foot = tool / math.cos(lag)
    ahead = np.array([-math.sin(at), math.cos(at)])
    along = goal + ahead * float((tool - goal) @ ahead)
    line = np.array([goal + 0.12 * ahead, goal - 0.78 * ahead])
    ax.plot(line[:, 0], line[:, 1], "--", color=ORANGE, linewidth=1.0)
    ax.plot(*np.array([tool, goal]).T, color=BLUE, linewidth=1.2)
    ax.plot(*np.array([tool, foot]).T, color=RED, linewidth=2.2)
    ax.plot(*np.array([tool, along]).T, color=ORANGE, linewidth=1.6)
    ax.plot(*np.array([[0.0, 0.0], goal]).T, ":", color=GREY, linewidth=0.9)
    ax.plot(*np.array([[0.0, 0.0], foot]).T, ":", color=GREY, linewidth=0.9)
    for point, colour in ((goal, GREY), (tool, BLUE), (foot, RED), (along, ORANGE)):
        ax.plot(*point, "o", color=colour, markersize=5)
    for text, place, colour in (
        ("command c", goal + np.array([-0.19, 0.02]), GREY),
        ("tool p", tool + np.array([-0.13, -0.06]), BLUE),
        ("contour error: R (1 - cos φ)", foot + np.array([0.03, -0.03]), RED),
        ("by the tangent: R sin² φ", along + np.array([-0.02, 0.04]), ORANGE),
        ("following error: R sin φ", np.array([-0.06, 0.78]), BLUE),
        ("φ", np.array([0.06, 0.5]), GREY),
    ):
        ax.text(*place, text, fontsize=9, color=colour)
    ax.set(xlim=(-0.35, 1.15), ylim=(0.42, 1.1), aspect="equal")
    ax.axis("off")
    return fig


@figure
def circle_radius() -> plt.Figure:
    """Change of a circle's radius over its angular frequency, by formulas and by runs."""
    gain, radius = 80, 10.0
    kp = gain * PER_GAIN
    lag = 0.25 / kp
    speeds = np.linspace(0.05, 9.5, 200)

    def looped(w: float, tau: float) -> complex:
        return ServoAxis(kp, period=LOOP, delay=LOOP, lag=tau).response(w)

    def fed(w: float) -> complex:
        s, bus = 1j * w, 1e-4
        way = kp * np.exp(-3.5 * bus * s)
        return complex((way + s * np.exp(-2.5 * bus * s)) / (lag * s * s + s + way))

    software = {"mcc__output_mode": 2, "mcc__position_gain": kp, "mcc__velocity_ff": 1.0}
    fig, ax = panels(1, 1, (7.6, 4.0))
    for name, colour, answer, late, ahead, set_ in (
        ("ideal drive", BLUE, lambda w: looped(w, 0.0), 1.5 * LOOP, 0.0, {"mcc__p_gain": gain}),
        (
            "speed lags by 1/(4 Kp)",
            GREEN,
            lambda w: looped(w, lag),
            lag + 1.5 * LOOP,
            0.0,
            {"mcc__p_gain": gain, "machine__tau": lag},
        ),
        (
            "the same, with feed-forward 1",
            RED,
            fed,
            lag + 2.5 * LOOP,
            1.0,
            software | {"machine__tau": lag},
        ),
    ):
        change = [servo_formulas.radius_change(radius, answer(w)) for w in speeds]
        ax.plot(speeds / kp, 1e3 * np.array(change), color=colour, label=name)
        second = 0.5 * radius * speeds**2 * (2.0 * late / kp - (1.0 - ahead**2) / kp**2)
        ax.plot(speeds / kp, 1e3 * second, ":", color=colour, linewidth=1.0)
        for feed in (15.0, 30.0, 50.0, 70.0, 90.0):
            program, stop = circles(radius, feed)
            run = ran("circle_theory", program, stop, **set_)
            found = run.figure("contour.circles.0.ccw.radius_change")
            ax.plot(feed / radius / kp, 1e3 * found, "o", color=colour, markersize=5)
    ax.plot([], [], ":", color=GREY, label="to second order")
    ax.plot([], [], "o", color=GREY, label="runs of the FMUs")
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    ax.set(xlabel="ω / Kp", ylabel="change of the radius [µm], R = 10 mm", xlim=(0.0, 0.5))
    ax.legend(fontsize=8, loc="lower left")
    return fig


def deviation(way: CirclePass, radius: float) -> tuple[Array, Array]:
    """Angle [deg] and radial deviation [µm] of a circle, by angle."""
    angle = np.degrees(np.arctan2(way.points[:, 1], way.points[:, 0])) % 360.0
    order = np.argsort(angle)
    size = 1e3 * (np.hypot(way.points[:, 0], way.points[:, 1]) - radius)
    return angle[order], size[order]


def exact_oval(radius: float, feed: float, gains: tuple[float, float], way: int) -> Array:
    """Places (n, 2) of a tool on a circle with two gains [1/s], one way round."""
    w = way * feed / radius
    t = np.exp(1j * way * np.linspace(0.0, 2.0 * math.pi, 721))
    # a sine lags the cosine in the direction of travel
    x, y = (ServoAxis(k, period=LOOP, delay=LOOP).response(abs(w)) for k in gains)
    x, y = (np.conj(h) if way < 0 else h for h in (x, y))
    return radius * np.column_stack([(x * t).real, (y * t).imag])


@figure
def unequal_gains() -> plt.Figure:
    """Two axes with unequal gains: a line beside its path, a circle both ways round."""
    gains = (200 * PER_GAIN, 160 * PER_GAIN)
    set_ = {"mcc__p_gain": [200, 160, 0, 0, 0, 0]}
    fig, (left, right) = panels(1, 2, (9.2, 3.8))
    run = ran(
        "circle_theory", "G21 G17 G90 G61\nG4 P0.2\nG1 X70 Y70 F6000\nG4 P0.3\nM30\n", 1.9, **set_
    )
    contour = run.contour()
    rows = contour.cutting
    signed = contour.track.signed
    assert signed is not None
    left.plot(run.time[rows], 1e3 * signed[rows], color=BLUE, label="run of the FMUs")
    said = -1e3 * abs(servo_formulas.line_mismatch(100.0, math.pi / 4.0, gains))
    left.axhline(
        said, color=RED, linestyle="--", linewidth=1.0, label="V sin a cos a (1/Kx - 1/Ky)"
    )
    left.set(xlabel="t [s]", ylabel="contour error [µm]", title="line at 45°, 100 mm/s")
    left.legend(fontsize=8, loc="upper center")
    radius, feed = 20.0, 60.0
    program, stop = circles(radius, feed, 2, "32")
    test = ran("circle_theory", program, stop, **set_).contour().circles[0]
    for way, name, colour, sign in ((test.ccw, "ccw", BLUE, 1), (test.cw, "cw", RED, -1)):
        assert way is not None
        angle, size = deviation(way, radius)
        some = slice(None, None, len(angle) // 40)
        right.plot(angle[some], size[some], "o", color=colour, markersize=4, label=f"run, {name}")
        oval = exact_oval(radius, feed, gains, sign)
        place = np.degrees(np.arctan2(oval[:, 1], oval[:, 0])) % 360.0
        order = np.argsort(place)
        size = 1e3 * (np.hypot(oval[:, 0], oval[:, 1]) - radius)
        right.plot(place[order], size[order], color=colour, linewidth=0.9)
    right.plot([], [], color=GREY, linewidth=0.9, label="formula")
    right.set(xlabel="angle [°]", ylabel="radial deviation [µm]", xlim=(0, 360))
    right.set(title="circle R 20, 60 mm/s", xticks=range(0, 361, 90))
    right.set_ylim(-240, 180)
    right.legend(fontsize=8, ncols=3, loc="upper center")
    return fig


CORNER = "G21 G17 G90 {mode}\nG4 P0.2\nG1 X40 Y0 F3000\nX40 Y40\nG4 P0.3\nM30\n"


def corner_of(ax: Axes, title: str, mode: str, ramp: float, said: float) -> None:
    """A square corner of a run, and the band of the error that theory tells."""
    run = ran(
        "circle_theory",
        CORNER.format(mode=mode),
        2.9,
        mcc__p_gain=200,
        mcc__acc_time=ramp,
        mcc__dec_time=ramp,
    )
    tool = 1e3 * run["machine.table_position"][:, :2]
    pulses = run["card.pulse_count"][:, :2] * 1e-3
    tube(ax, np.array([[20.0, 0.0], [40.0, 0.0], [40.0, 20.0]]), said)
    ax.plot([20.0, 40.0, 40.0], [0.0, 0.0, 20.0], color=GREY, linewidth=1.0, label="path")
    ax.plot(pulses[:, 0], pulses[:, 1], ":", color=ORANGE, linewidth=1.3, label="command")
    ax.plot(tool[:, 0], tool[:, 1], color=BLUE, linewidth=1.4, label="tool")
    ax.set(xlim=(38.2, 40.9), ylim=(-0.8, 1.9), aspect="equal", xlabel="X [mm]")
    error = run.contour().corners[0].error
    ax.set_title(f"{title}\nrun {1e3 * error:.0f} µm, formula {1e3 * said:.0f} µm", fontsize=9)


@figure
def tool_at_corners() -> plt.Figure:
    """A square corner at the feed, from a stop for an instant, and with moves that overlap."""
    kp, feed, ramp = 200 * PER_GAIN, 50.0, 0.1
    sharp = servo_formulas.corner(feed, 0.5 * math.pi, kp)
    stop = servo_formulas.corner(0.0, 0.5 * math.pi, kp, feed / ramp)
    blended = servo_formulas.blended_corner(feed, 0.5 * math.pi, kp, feed / ramp)
    fig, axes = panels(1, 3, (9.4, 3.8), sharey=True)
    corner_of(axes[0], "at the feed", "G64", 1e-3, sharp)
    corner_of(axes[1], "a stop for an instant", "G61", ramp, stop)
    corner_of(axes[2], "moves overlap", "G64", ramp, blended)
    axes[0].set_ylabel("Y [mm]")
    axes[0].legend(fontsize=8, loc="upper left")
    return fig


def around(run: Result, radius: float) -> tuple[Array, Array]:
    """Angle behind the quadrant at 0, -15 to 40 [deg], and radial deviation there [µm]."""
    way = run.contour().circles[0].ccw
    assert way is not None
    angle, size = deviation(way, radius)
    angle = np.where(angle > 180.0, angle - 360.0, angle)
    rows = np.flatnonzero((angle > -15.0) & (angle < 40.0))
    rows = rows[np.argsort(angle[rows])]
    return angle[rows], size[rows]


def trailing(angle: Array, half: float) -> Array:
    """Radial deviation of two axes that each trail by so much, at angles [deg] about 0."""
    a = np.radians(angle)
    return half * (np.where(a > 0.0, 1.0, -1.0) * np.cos(a) - np.sin(a))


@figure
def reversal() -> plt.Figure:
    """What friction and backlash leave at the quadrants of a circle, by formulas and by runs."""
    radius, feed, gain, coulomb = 20.0, 40.0, 400, 0.5
    program, stop = circles(radius, feed, 2)
    smooth = {f"machine__{s}_{k}": 0.0 for s in ("motor", "table") for k in ("coulomb", "static")}
    motor = {"machine__motor_coulomb": coulomb, "machine__motor_static": coulomb}
    table = {"machine__table_coulomb": 50.0, "machine__table_static": 50.0}
    near = np.linspace(-14.5, 39.5, 800)

    def change(cause: dict[str, float], before: dict[str, float], time: float) -> Array:
        """What a cause adds to the radial deviation [µm]."""
        fixed = {"mcc__p_gain": gain, "drives__velocity_time": time}
        with_it, without = (
            np.interp(near, *around(ran("circle", program, stop, **fixed, **s), radius))
            for s in (smooth | before | cause, smooth | before)
        )
        return with_it - without

    servo = ServoAxis(
        gain * PER_GAIN,
        velocity_gain=0.5,
        inertia=2e-3 + 100.0 * (0.01 / (2.0 * math.pi)) ** 2,
        friction=coulomb,
        travel=10.0,
    )
    fig, axes = panels(1, 3, (9.6, 3.4))
    axes[0].plot(near, change(motor, {}, 0.0), color=BLUE, label="run of the FMUs")
    half = 1e3 * servo_formulas.reversal(servo)[1]
    axes[0].plot(near, trailing(near, half), "--", color=RED, linewidth=1.0, label="formula")
    axes[0].set(title="friction, P velocity loop", ylabel="radial deviation [µm]")
    axes[0].legend(fontsize=8)
    axes[1].plot(near, change(motor, {}, 0.02), color=BLUE)
    kv, kp, rate = servo.velocity_gain, servo.gain, 50.0
    law = lti(
        [2.0 * coulomb * 1e3 * 10.0 / (2.0 * math.pi)],
        [servo.inertia, kv, kv * (kp + rate), kv * kp * rate],
    )
    behind = near[near > 0.0]
    time, answer = law.impulse(T=np.linspace(0.0, math.radians(40.0) * radius / feed, 800))
    shown = np.interp(np.radians(behind) * radius / feed, time, answer)
    axes[1].plot(behind, shown, "--", color=RED, linewidth=1.0)
    axes[1].set(title="friction, PI velocity loop")
    width = 0.05
    axes[2].plot(near, change({"machine__backlash": 1e-3 * width}, table, 0.02), color=BLUE)
    gone = np.clip(radius * (1.0 - np.cos(np.radians(near))), 0.0, width)
    taken = np.where(near > 0.0, gone - 0.5 * width, -0.5 * width)
    across = trailing(near, 0.5 * width) + (taken - np.sign(near) * 0.5 * width) * np.cos(
        np.radians(near)
    )
    axes[2].plot(near, 1e3 * across, "--", color=RED, linewidth=1.0)
    arc = math.degrees(servo_formulas.lost_motion_arc(radius, width))
    axes[2].axvline(arc, color=GREY, linestyle=":", linewidth=1.0)
    axes[2].set(title="backlash of 50 µm")
    for ax in axes:
        ax.set_xlabel("angle behind the quadrant [°]")
    return fig
