"""The nonlinear part of a plant's equation, such as friction and gaps."""

from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from motionfmu.analysis.linear.axis import AxisModel
from motionfmu.analysis.linear.block import Matrix, Plant
from motionfmu.analysis.linear.pointwise import Pointwise
from motionfmu.analysis.linear.tuning_parts import linearised
from motionfmu.fmu.modelica.ode import Ode


@dataclass(frozen=True)
class Residual:
    """The nonlinear part w of equations of states."""

    component: str
    inputs: tuple[str, ...]  # of the model; they carry w(x) = f(x, u) - A x - B u
    states: tuple[str, ...]  # outputs of the model that are the plant's states
    values: Pointwise  # x -> w
    slopes: Pointwise  # x -> w, and the elements of dw/dx that are not always 0
    places: tuple[tuple[int, int], ...]  # of these elements: row and column


def with_residuals(axis: AxisModel) -> tuple[AxisModel, tuple[Residual, ...]]:
    """Give a model inputs for what its linear plants leave out.

    Fed with w(x) of its own motion, the linear model moves as the plant. Fed with w of the motion
    that it has without, it is the first step of a successive approximation: at a reversal the
    friction changes its sign when the linear axis turns.
    """
    blocks, found = dict(axis.blocks), []
    for component, block in axis.blocks.items():
        if not isinstance(block, Plant):
            continue
        parts, p = linearised(axis, component)
        ode, point = parts.ode, axis.points[component]
        bent = ca.which_depends(ode.xdot, ode.x, 2, True)
        rows = [k for k, is_bent in enumerate(bent) if is_bent]
        if not rows:
            continue
        a, b, c, d = parts.matrices(point.x, point.u, p)
        n = len(a)
        wide = np.hstack([b, np.eye(n)[:, rows]])
        show = np.vstack([c, np.eye(n)])
        direct = np.zeros((len(show), wide.shape[1]))
        direct[: len(d), : d.shape[1]] = d
        inputs = tuple(f"rest of {ode.states[k].name}" for k in rows)
        states = tuple(f"state {s.name}" for s in ode.states)
        blocks[component] = replace(
            block,
            inputs=(*block.inputs, *inputs),
            outputs=(*block.outputs, *states),
            step=_stepped(block, a, wide),
            show=(show, direct),
        )
        found.append(
            Residual(
                component,
                tuple(f"{component}.{name}" for name in inputs),
                tuple(f"{component}.{name}" for name in states),
                *_functions(parts.ode, rows, (a, p)),
            )
        )
    return replace(axis, blocks=blocks), tuple(found)


def _stepped(block: Plant, a: Matrix, b: Matrix) -> tuple[Matrix, Matrix]:
    """One micro step of a linear equation: sum of h^(k+1) A^k / (k+1)! B, as Runge-Kutta sees it.

    Four terms are the classic method's own; more of them change nothing at its step sizes.
    """
    h = block.grid_ns * 1e-9
    term = h * b
    g = term.copy()
    for k in range(2, 5):
        term = h / k * (a @ term)
        g += term
    known = block.step[1].shape[1]
    g[:, :known] = block.step[1]
    return block.step[0], g


def _functions(
    ode: Ode, rows: list[int], at: tuple[Matrix, Matrix]
) -> tuple[Pointwise, Pointwise, tuple[tuple[int, int], ...]]:
    a, p = at
    x = ca.SX.sym("x", len(a))
    before, after = [ode.x, ode.u, ode.p], [x, ca.SX.zeros(ode.u.shape), ca.SX(ca.DM(p))]
    xdot = ca.substitute([ode.xdot], before, after)[0]
    rest = (xdot - ca.mtimes(ca.SX(ca.DM(a)), x))[rows]
    slopes = ca.jacobian(rest, x)
    places = tuple(zip(*slopes.sparsity().get_triplet(), strict=True))
    elements = ca.vertcat(*(slopes[k] for k in places))
    return Pointwise(x, [rest]), Pointwise(x, [rest, elements]), places
