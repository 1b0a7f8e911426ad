"""Figures of the page about the arm of six joints, from its kinematics, planner and equations."""

import numpy as np
import scipy.linalg
from matplotlib import pyplot as plt
from plots import BLUE, GREEN, GREY, ORANGE, RED, Array, figure, panels
from robot_arm import EXACT, Arm, Pinocchio
from robot_batch import RIG, forward, inverse
from wrist_lines import HALF, IRB, passing, swing

A1, A2, _, C1, C2, C3, C4 = IRB.lengths


def skeleton(joints: Array) -> Array:
    """Places of the joints in the plane y = 0, for joint 1 at 0 or half a turn."""
    th2, p = joints[1], joints[1] + joints[2] + np.pi / 2
    side = np.cos(joints[0])
    shoulder = np.array([A1, C1])
    elbow = shoulder + C2 * np.array([np.sin(th2), np.cos(th2)])
    lifted = elbow + A2 * np.array([np.cos(p), -np.sin(p)])
    wrist = lifted + C3 * np.array([np.sin(p), np.cos(p)])
    places = np.array([[0.0, 0.0], [0.0, C1], shoulder, elbow, lifted, wrist])
    return places * [side, 1.0]


@figure
def postures() -> plt.Figure:
    """The four stands of the arm that reach one pose; the wrist doubles each."""
    told = np.array([[0.0, 0.15, 0.35, 0.0, 0.6, 0.4]])
    pose = forward(IRB, told)
    every = inverse(IRB, pose, told)[0]
    fig, axes = panels(1, 2, (8.6, 3.9))
    for ax, back in zip(axes, (0, 4), strict=True):
        for elbow, colour in ((0, BLUE), (2, RED)):
            q = every[back + elbow]
            flipped = every[back + elbow + 1]
            at = skeleton(q)
            degrees = ", ".join(f"{x:.0f}°" for x in np.degrees(q[3:]))
            other = ", ".join(f"{x:.0f}°" for x in np.degrees(flipped[3:]))
            name = f"{back + elbow}, {back + elbow + 1}: joints 4 to 6 at {degrees} or {other}"
            ax.plot(at[:, 0], at[:, 1], "o-", color=colour, markersize=4, label=name)
        centre, hand = pose[0, [0, 2]], pose[0, [5, 11]]
        ends = np.array([centre - C4 * hand, centre])
        ax.plot(ends[:, 0], ends[:, 1], color=GREEN, linewidth=4, label="hand")
        ax.set(aspect="equal", xlabel="x [m]", xlim=(-1.15, 1.45), ylim=(-0.1, 2.05))
        ax.set_title("shoulder to the front" if back == 0 else "shoulder to the back", fontsize=9)
        ax.legend(fontsize=7, loc="upper center")
    axes[0].set_ylabel("z [m]")
    return fig


def fourth(way: Array, least: float) -> Array:
    """|q4'| beside the singular place by the formula [rad/mm]."""
    g = swing()
    return np.asarray(g * least / ((g * way) ** 2 + least**2))


@figure
def wrist_pass() -> plt.Figure:
    """Joint 4 beside the wrist's singular place: formula and inverse kinematics."""
    way = np.linspace(-HALF, HALF, 3001)
    fig, (left, right) = panels(1, 2, (8.6, 3.5))
    tops = []
    for up, colour in ((3.0, GREEN), (10.0, ORANGE), (30.0, RED), (100.0, BLUE)):
        q = passing(up).joints
        rate = np.abs(np.gradient(q[:, 3], way))
        least = float(np.abs(np.sin(q[:, 4])).min())
        tops.append((least, rate.max()))
        left.semilogy(way, fourth(way, least), color=colour, label=f"{up:g} mm beside")
        left.plot(way[::50], rate[::50], "o", color=colour, markersize=3)
    left.set(xlabel="s [mm]", ylabel="|q4'| [rad/mm]", xlim=(-60, 60))
    left.set_title("lines: formula, dots: inverse kinematics", fontsize=9)
    left.legend(fontsize=8)
    for up in (0.3, 1.0):
        q = passing(up, places=60_001).joints
        rate = np.abs(np.gradient(q[:, 3], 2.0 * HALF / 60_000))
        tops.append((float(np.abs(np.sin(q[:, 4])).min()), rate.max()))
    x = np.array([1e-4, 0.2])
    right.loglog(x, swing() / x, color=GREY, label="g / δ")
    right.loglog(*np.array(tops).T, "o", color=BLUE, markersize=4, label="largest |q4'|")
    right.set(xlabel="δ, least sine of joint 5", ylabel="|q4'| [rad/mm]")
    right.legend(fontsize=8)
    return fig


@figure
def jet_bounds() -> plt.Figure:
    """Bounds of joint 4's derivatives on parts of a line, and how they close in."""
    up, fig_axes = 10.0, panels(1, 2, (8.6, 3.5))
    fig, (left, right) = fig_axes
    way = np.linspace(-HALF, HALF, 16_385)
    q = passing(up, places=len(way)).joints[:, 3]
    slope = np.abs(np.gradient(q, way))
    bend = np.abs(np.gradient(np.gradient(q, way), way))
    left.plot(way, slope, color=BLUE, label="|q4'|", zorder=3)
    for parts, colour in ((32, ORANGE), (128, RED)):
        bound = passing(up, parts).bounds[:, 0, 3]
        edge = np.linspace(-HALF, HALF, parts + 1)
        step = np.append(bound, bound[-1])
        label = f"bounds, {parts} parts"
        left.step(edge, step, where="post", color=colour, linewidth=1.0, label=label)
    left.set(xlim=(-50, 50), xlabel="s [mm]", ylabel="[rad/mm]", ylim=(0, 0.12))
    left.legend(fontsize=8)
    sizes, over = [], []
    for parts in (32, 64, 128, 256, 512, 1024):
        bound = passing(up, parts).bounds[:, :, 3]
        n = (len(way) - 1) // parts
        shape = np.arange(parts)[:, None] * n + np.arange(n + 1)
        true = np.stack([slope[shape].max(axis=1), bend[shape].max(axis=1)], axis=1)
        sizes.append(2.0 * HALF / parts)
        over.append((bound - true).max(axis=0) / true.max(axis=0))
    over = np.array(over)
    for k, colour in ((0, BLUE), (1, RED)):
        name = "|q4" + "'" * (k + 1) + "|"
        right.loglog(sizes, over[:, k], "o", color=colour, markersize=4, label=name)
        guide = over[-2, k] * (np.array(sizes) / sizes[-2]) ** 2
        right.loglog(sizes, guide, "--", color=colour, linewidth=0.9)
    right.set(xlabel="length of a part [mm]", ylabel="bound over largest, as a share of it")
    right.set_title("dashed: with the square of the length", fontsize=9)
    right.legend(fontsize=8)
    return fig


@figure
def line_speed() -> plt.Figure:
    """Speed of the tool beside the wrist's singular place: what each joint allows, and the plan."""
    up, way = 10.0, np.linspace(-HALF, HALF, 6001)
    told = passing(up, places=len(way), feed=300.0)
    q = told.joints
    slope = np.gradient(q, way, axis=0)
    bend = np.gradient(slope, way, axis=0)
    fig, ax = panels(1, 1, (8.6, 3.6))
    fast = (RIG.speed / np.maximum(np.abs(slope), 1e-12)).min(axis=1)
    curved = np.sqrt(RIG.turn / np.maximum(np.abs(bend), 1e-12)).min(axis=1)
    inner = slice(2, -2)
    ax.plot(way[inner], fast[inner], color=GREEN, label="speeds of the joints: Q / |q'|")
    label = "their accelerations: √(A / |q''|)"
    ax.plot(way[inner], curved[inner], color=ORANGE, label=label)
    edge = np.append(0.0, told.segments[:, 0]) * 2.0 * HALF - HALF
    caps = np.append(told.segments[:, 1], told.segments[-1, 1])
    ax.step(edge, caps, where="post", color=BLUE, linewidth=1.6, label="segments of the plan")
    ax.axhline(300.0, color=GREY, linestyle="--", linewidth=0.9, label="feed")
    ax.set(xlabel="s [mm]", ylabel="speed [mm/s]", xlim=(-HALF, HALF), ylim=(0, 370))
    ax.legend(fontsize=8, ncols=2, loc="upper center")
    return fig


@figure
def gear() -> plt.Figure:
    """A gear's torque over its wind-up, and the frequencies of joint 2 on it."""
    fig, (left, right) = panels(1, 2, (8.6, 3.5))
    plain = Arm()
    lost = plain.parameter("lost_motion")[1]
    k1, k2, k3, t1, t2 = (
        plain.parameter(n)[1]
        for n in ("stiffness_1", "stiffness_2", "stiffness_3", "knee_1", "knee_2")
    )
    windup = np.linspace(-2.4e-3, 2.4e-3, 401)
    wound = np.maximum(np.abs(windup) - lost / 2.0, 0.0)
    bends = (t1 / k1, t1 / k1 + (t2 - t1) / k2)
    size = k1 * wound + (k2 - k1) * np.maximum(wound - bends[0], 0.0)
    size += (k3 - k2) * np.maximum(wound - bends[1], 0.0)
    left.plot(1e3 * windup, np.sign(windup) * size, color=BLUE, label="formula")
    exact = Arm(**{n: v for n, v in EXACT.items() if n != "lost_motion"})
    found = []
    for x in windup[::25]:
        state = exact.state(rotor_angle=np.eye(6)[1] * x * exact.parameter("gear_ratio")[1])
        found.append(exact.outputs(state, np.zeros(9))["gear_torque"][1])
    left.plot(1e3 * windup[::25], found, "o", color=RED, markersize=4, label="class of the plant")
    for knee in (t1, t2):
        left.axhline(knee, color=GREY, linestyle=":", linewidth=0.9)
    left.set(xlabel="wind-up [mrad]", ylabel="torque on the link [N·m]")
    left.legend(fontsize=8)
    stiff = np.full(6, 1e10)
    stiff[1] = k1
    ratio = plain.parameter("gear_ratio")[1]
    motor = ratio**2 * plain.parameter("motor_inertia")[1]
    free = Arm(**EXACT, gravity=0)
    body, elbow = Pinocchio(free), np.radians(np.linspace(-150, 70, 56))
    own = np.array([body.inertia(inner(q))[1, 1] for q in elbow])
    locked, loose = np.sqrt(k1 / own), np.sqrt(k1 * (1.0 / own + 1.0 / motor))
    right.plot(np.degrees(elbow), locked / 2 / np.pi, color=BLUE, label="motor locked")
    right.plot(np.degrees(elbow), loose / 2 / np.pi, color=ORANGE, label="motor free")
    for q in elbow[::5]:
        hz = modes(body.inertia(inner(q)), stiff, motor)
        label = "all joints, the other gears stiff" if q == elbow[0] else None
        right.plot([np.degrees(q)] * 2, hz, "o", color=RED, markersize=4, label=label)
    soft = plain.parameter("stiffness_1")
    first = [np.sqrt(scipy.linalg.eigh(np.diag(soft), body.inertia(inner(q)))[0][0]) for q in elbow]
    right.plot(
        np.degrees(elbow),
        np.array(first) / 2 / np.pi,
        "--",
        color=GREY,
        label="lowest of all, with all gears, locked",
    )
    right.set(xlabel="joint 3 [deg]", ylabel="frequency [Hz]", ylim=(0, None))
    right.legend(fontsize=7)
    return fig


def inner(third: float) -> Array:
    """Inner angles with joint 3 there and the others at 0."""
    return np.array([0.0, 0.0, third + np.pi / 2, 0.0, 0.3, 0.0])


def modes(mass: Array, stiffness: Array, motor: float) -> tuple[float, float]:
    """Lowest frequencies of all joints with motors locked, and with that of joint 2 free [Hz]."""
    locked = scipy.linalg.eigh(np.diag(stiffness), mass)[0][0]
    with_motor = scipy.linalg.block_diag(mass, [[motor]])
    spring = scipy.linalg.block_diag(np.diag(stiffness), [[stiffness[1]]])
    spring[1, 6] = spring[6, 1] = -stiffness[1]
    free = scipy.linalg.eigh(spring, with_motor)[0][1]
    return float(np.sqrt(locked) / 2 / np.pi), float(np.sqrt(free) / 2 / np.pi)
