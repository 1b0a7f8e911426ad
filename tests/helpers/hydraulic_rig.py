"""The hydraulic axis for tests: its equation, a hard trajectory, and scipy's Radau over it."""

import functools

import casadi as ca
import numpy as np
from plant_library import PACKAGE, Run
from scipy.integrate import solve_ivp

from motionfmu.fmu.modelica import causal

# Until t [s]: voltage [V], load force [N]. A step and its reversal, crawling both ways just beyond
# the deadband of 0.3 V, load steps while the valve is shut, full speed into the stop, away from it.
HARD = (
    (0.03, 5.0, 0.0),
    (0.06, -5.0, 0.0),
    (0.08, 0.35, 0.0),
    (0.10, -0.35, 0.0),
    (0.12, 0.0, 2500.0),
    (0.14, 0.0, -2500.0),
    (0.17, 10.0, 0.0),
    (0.19, -3.0, 0.0),
)
START = {"start_position": 0.096}
STEP = 25e-6  # [s] micro step
# What the states show as: all but the speed of the spool.
SHOWN = ("current", "spool", "pressure_a", "pressure_b", "table_position", "table_speed")


@functools.cache
def equation():
    """The Modelica class of the axis, flattened once."""
    return causal.load(PACKAGE, "MotionControl.HydraulicAxis")


class Case:
    """The equation with some parameters changed."""

    def __init__(self, **changed):
        self.ode = equation()
        self.p = self.ode.values(**changed)
        self.start = self.ode.initial(self.p)
        self.value = dict(zip((d.name for d in self.ode.parameters), self.p, strict=True))
        x, u = self.ode.x, self.ode.u
        xdot, y = (ca.substitute(e, self.ode.p, self.p) for e in (self.ode.xdot, self.ode.y))
        self.rhs = ca.Function("rhs", [x, u], [xdot])
        self.slope = ca.Function("slope", [x, u], [ca.jacobian(xdot, x)])
        self.names = [d.name for d in self.ode.outputs]
        self.shown = ca.Function("shown", [x, u], [y[[self.names.index(n) for n in SHOWN]]])


def reference(case, pieces, rtol=1e-10):
    """States at every micro step of a trajectory of held inputs, by scipy's Radau.

    Absolute tolerances are rtol times what is large for a state.
    """
    large = np.array([1.0, 1.0, 500.0, 1e7, 1e7, 0.1, 0.2, 0.1, 0.2])
    x, t0, found = case.start, 0.0, []
    for t1, *u in pieces:
        times = t0 + STEP * np.arange(1, round((t1 - t0) / STEP) + 1)
        times[-1] = t1
        s = solve_ivp(
            lambda t, x, u=u: case.rhs(x, u).full().ravel(),
            (t0, t1),
            x,
            method="Radau",
            rtol=rtol,
            atol=rtol * large,
            max_step=1e-4,  # else it may step over a table that stops and goes on
            jac=lambda t, x, u=u: case.slope(x, u).full(),
            t_eval=times,
        )
        assert s.success, s.message
        x, t0 = s.y[:, -1], t1
        found.append(s.y.T)
    return np.concatenate(found)


def started(library, **values):
    """A run of the plant that is initialised."""
    run = Run(library, **values)
    assert run.start() == 0, run.said
    return run


def drive(run, seconds, every=STEP, names=SHOWN, **inputs):
    """Hold inputs for a time; outputs at each step as columns."""
    run.set(**inputs)
    rows = []
    for _ in range(round(seconds / every)):
        assert run.step(every) == 0, run.said
        rows.append([float(run.get(name)) for name in names])
    return np.array(rows)


def drive_all(run, pieces, **how):
    """Outputs along a trajectory of held inputs."""
    times = np.diff([0.0, *(piece[0] for piece in pieces)])
    parts = [
        drive(run, seconds, **how, voltage=voltage, force=force)
        for seconds, (_, voltage, force) in zip(times, pieces, strict=True)
    ]
    return np.concatenate(parts)
