"""Figures of the page about the hydraulic axis: its FMU and linear model beside the formulas."""

import importlib.util
from pathlib import Path

import numpy as np
from fmi_tools import Instance
from hydraulic_rig import Case
from hydraulic_theory import (
    AREA,
    LEAK_PISTON,
    LEAK_VALVE,
    SUPPLY,
    TANK,
    creep,
    largest_gain,
    oil_and_mass,
    served,
    speed_under,
    uniform,
)
from matplotlib import pyplot as plt
from plots import BLUE, GREEN, GREY, ORANGE, RED, figure, panels

from motionfmu.analysis import linear
from motionfmu.analysis.linear import largest_gain as model_gain

ROOT = Path(__file__).resolve().parents[3]
MASS, VISCOUS, DEAD, STROKE = 100.0, 1000.0, 5e-5, 0.1
SMOOTH = {"table_coulomb": 0.0, "table_static": 0.0}


def settled(volts: float, seconds: float, force: float = 0.0, **values: float) -> float:
    """Speed of the running FMU after a time, as a mean over the last tenth of a second [m/s]."""
    fmu = Instance("hydraulic_axis", 3).initialize({"start_position": -0.05, **values})
    fmu.set("voltage", volts)
    fmu.set("force", force)
    place = []
    for _ in range(round(seconds / 0.01)):
        assert fmu.step(0.01) == 0
        place.append(fmu.get("table_position")[0])
    fmu.free()
    return float(place[-1] - place[-11]) / 0.1


@figure
def valve_speeds() -> plt.Figure:
    """Speed of the table over the command, through the dead zone, and over the load."""
    fig, (left, right) = panels(1, 2, (9.0, 3.6))
    volts = np.linspace(0.0, 0.6, 121)
    for overlap, colour in ((0.0, GREEN), (0.03, BLUE)):
        steady = [1e3 * creep(u / 10.0, overlap, 200.0, 300.0) for u in volts]
        left.plot(volts, np.clip(steady, 1e-4, None), color=colour, linewidth=1.0)
        points = np.array([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6])
        found = [1e3 * settled(u, 3.0, valve_overlap=overlap) for u in points]
        left.plot(points, found, "o", color=colour, markersize=4, label=f"overlap {overlap:.0%}")
    left.plot(volts, 1e3 * np.clip(speed_under_line(volts), 1e-6, None), "--", color=GREY,
              linewidth=0.9, label="sharp edge, no friction")  # fmt: skip
    left.set(yscale="log", ylim=(1e-3, 30.0), xlabel="command [V]", ylabel="speed [mm/s]")
    left.legend(fontsize=8, loc="lower right")
    most = (SUPPLY - TANK) * AREA
    forces = np.linspace(-0.999, 0.4, 300) * most
    right.plot(-forces / most, [1e3 * speed_under(0.5, 0.03, f) for f in forces], color=BLUE)
    right.plot(-forces / most, [-f * speed_under(0.5, 0.03, f) / 10.0 for f in forces],
               color=ORANGE, label="power [10 W]")  # fmt: skip
    points = np.array([-0.95, -0.8, -2 / 3, -0.4, -0.2, 0.0, 0.3]) * most
    ideal = {"valve_leakage": 0.0, "cylinder_leakage": 0.0, "table_viscous": 0.0, **SMOOTH}
    found = [1e3 * settled(5.0, 0.4, f, **ideal) for f in points]
    right.plot(-points / most, found, "o", color=BLUE, markersize=4, label="speed [mm/s], 5 V")
    right.axvline(2 / 3, color=GREY, linestyle="--", linewidth=0.9)
    right.set(xlabel="load/stall force", ylim=(0.0, 160.0), xlim=(-0.4, 1.0))
    right.legend(fontsize=8)
    return fig


def speed_under_line(volts: np.ndarray) -> np.ndarray:
    """Speed with a sharp dead zone of 3 % and without friction [m/s]."""
    return np.array([max(speed_under(u / 10.0, 0.03, 0.0), 0.0) for u in volts])


def mode_at(place: float, leak: float, edges: float) -> tuple[float, float]:
    """Natural frequency and damping ratio with the piston at a place [m]."""
    volumes = DEAD + AREA * (STROKE + place), DEAD + AREA * (STROKE - place)
    return oil_and_mass(volumes, MASS, leak, edges, VISCOUS)


@figure
def oil() -> plt.Figure:
    """Natural frequency and damping ratio of oil and mass over the place of the piston."""
    fig, (left, right) = panels(1, 2, (9.0, 3.3))
    places = np.linspace(-0.099, 0.099, 199)
    edge = AREA * 0.05 / (SUPPLY - TANK)
    for name, opened, colour in (("valve shut", 0.0, BLUE), ("at 50 mm/s", 0.05, RED)):
        edges = 2.0 * LEAK_VALVE + (edge if opened else 0.0)
        own = [mode_at(s, LEAK_PISTON, edges) for s in places]
        points = []
        for s in np.linspace(-0.09, 0.09, 13):
            case = Case(**SMOOTH, valve_rounding=1e-7, start_position=s)
            x = np.array(case.start)
            stroke = 0.03 + opened / (speed_under(1.03, 0.03, 0.0) or 1.0)
            x[[0, 1]] = stroke if opened else 0.0
            a = case.slope(x, [10.0 * x[0], 0.0]).full()
            roots = np.linalg.eigvals(a[np.ix_((3, 4, 6), (3, 4, 6))])
            root = roots[np.argmax(np.abs(roots.imag))]
            points.append((s, abs(root), -root.real / abs(root)))
        at, omega, zeta = np.array(points).T
        left.plot(1e3 * places, [o for o, _ in own], color=colour)
        left.plot(1e3 * at, omega, "o", color=colour, markersize=4, label=name)
        right.plot(1e3 * places, [z for _, z in own], color=colour)
        right.plot(1e3 * at, zeta, "o", color=colour, markersize=4, label=name)
    left.set(xlabel="place [mm]", ylabel="natural frequency [rad/s]", ylim=(350, 540))
    right.set(xlabel="place [mm]", ylabel="damping ratio", ylim=(0.0, 0.13))
    left.legend(fontsize=8)
    right.legend(fontsize=8)
    return fig


@figure
def oil_gain() -> plt.Figure:
    """Largest velocity gain over the damping of oil and mass, with fast and slow lags."""
    at = {"axis.table_speed": 0.05, "axis.table_position": 0.0, "axis.force": 0.0}
    own = {"controller.law": 0, "controller.p_gain": 1200, "controller.timer_cycles": 5}
    own |= {f"axis.{name}": value for name, value in SMOOTH.items()}
    quick = {"controller.timer_period": 2e-4, "controller.filter_time": 1e-4}
    quick |= {"axis.valve_frequency": 5000.0, "axis.current_time": 2e-5}
    edge = AREA * 0.05 / (SUPPLY - TANK)  # an edge that is open for 50 mm/s
    fig, ax = panels(1, 1, (7.2, 3.8))
    for more, valve, lags, dead, colour, name in (
        (quick, 5000.0, (2e-5, 1e-4), 3e-4, RED, "fast valve and controller"),
        ({}, 500.0, (2e-4, 2e-3), 7e-4, BLUE, "valve of 500 rad/s, filter of 2 ms"),
    ):
        leaks = np.r_[0.0, np.geomspace(1e-13, 1.3e-11, 60)]
        lines, points = [], []
        for leak in leaks:
            mode = mode_at(0.0, leak, 2.0 * LEAK_VALVE + edge)
            lines.append((mode[1], largest_gain(mode, (valve, 0.8), lags, dead)[0]))
        for leak in (0.0, 1e-12, 2e-12, 4e-12, 6e-12, 8e-12, 1e-11, 1.25e-11):
            given = own | more | {"axis.cylinder_leakage": leak}
            axis = linear.model(ROOT / "scenarios/hydraulic_gain", at=at, set=given)
            loop = axis.loop("controller.scale_phase")
            kp = abs(loop(np.exp(0.05j * loop.dt))) * 0.05
            mode = mode_at(0.0, leak, 2.0 * LEAK_VALVE + edge)
            points.append((mode[1], kp * model_gain(axis, "controller.scale_phase").gain))
        ax.plot(*np.array(lines).T, color=colour, linewidth=1.0)
        ax.plot(*np.array(points).T, "o", color=colour, markersize=4, label=name)
    zeta = np.linspace(0.0, 0.34, 2)
    omega = mode_at(0.0, 0.0, 0.0)[0]
    ax.plot(zeta, 2.0 * zeta * omega, ":", color=GREY, label="2 ζ ω")
    ax.axhline(omega / 3.0, color=GREY, linestyle="--", linewidth=0.9, label="ω/3")
    ax.set(xlabel="damping ratio ζ of oil and mass", ylabel="largest gain K [1/s]")
    ax.set(xlim=(0.0, 0.34), ylim=(0.0, 260.0))
    ax.legend(fontsize=8, loc="upper left")
    return fig


@figure
def edges_lost() -> plt.Figure:
    """Edges that the interrupt routine loses, over the speed, for three timer routines."""
    file = ROOT / "scenarios/hydraulic_lost_counts/study.py"
    spec = importlib.util.spec_from_file_location("lost_counts_study", file)
    assert spec is not None and spec.loader is not None
    study = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(study)
    fig, ax = panels(1, 1, (7.2, 3.5))
    for cycles, colour in ((400, RED), (200, ORANGE), (100, BLUE)):
        border = study.border(cycles, study.WRITTEN)
        speeds = np.linspace(0.7, 1.75, 200) * border
        formula = study.theory(cycles, study.WRITTEN, speeds)
        ax.plot(1e-3 * speeds, formula, color=colour, linewidth=1.0)
        # Off whole numbers of edges in a timer period, at which all periods fall alike.
        points = (np.floor(np.linspace(0.7, 1.75, 20) * border * 1e-3) + 0.381966) * 1e3
        lost = [served(uniform(v, 8e6, 1.0), 8000, cycles, False)[0] for v in points]
        ax.plot(1e-3 * points, lost, "o", color=colour, markersize=4, label=f"{cycles} cycles")
        ax.axvline(1e-3 * border, color=colour, linestyle="--", linewidth=0.8)
    ax.set(xlabel="speed [1000 counts/s]", ylabel="edges lost [1/s]", ylim=(-20, 800))
    ax.legend(fontsize=8, title="routine of the timer", title_fontsize=8)
    return fig
