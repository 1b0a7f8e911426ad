"""State-space systems of python-control with a right gain at a pole at 1."""

from typing import Any

import control
import numpy as np
from scipy import linalg

from motionfmu.analysis.linear.block import Matrix
from motionfmu.analysis.linear.stability import AT_ONE

# A sum that is below this share of its terms is rounding.
_CANCELLED = 1e-12


class StandstillSystem(control.StateSpace):
    """A discrete state-space system with a right gain at standstill."""

    # The gain is right even if the system has an integrating position that no output shows.

    def dcgain(self, warn_infinite: bool = False) -> Any:
        """Gain for a constant input, in the long run.

        A pole at 1 that an output does not see, or that an input does not move, takes no part in
        it, in spite of rounding. Where an output adds up an input it is infinite, with the sign in
        which it grows; nothing is warned of.
        """
        found = _static(*(np.asarray(m, dtype=float) for m in (self.A, self.B, self.C, self.D)))
        return float(found[0, 0]) if found.shape == (1, 1) else found


def _static(a: Matrix, b: Matrix, c: Matrix, d: Matrix) -> Matrix:
    """Static gain, with the part at 1 separated: [T1 T12; 0 T2] is made block diagonal."""
    if not len(a):
        return d
    a, (scale, _) = linalg.matrix_balance(a, permute=False, separate=True)
    b, c = b / scale[:, None], c * scale
    t, z, m = linalg.schur(a, output="complex", sort=lambda pole: abs(pole - 1.0) <= AT_ONE)
    x = linalg.solve_sylvester(t[:m, :m], -t[m:, m:], -t[:m, m:])
    right = z[:, :m], z[:, :m] @ x + z[:, m:]
    left = (z[:, :m].conj() - z[:, m:].conj() @ x.T).T, z[:, m:].conj().T
    moved = np.linalg.solve(np.eye(len(a) - m) - t[m:, m:], left[1] @ b)
    found: Matrix = np.real(c @ right[1] @ moved) + d
    # C N^k B of the part at 1, compared with the size of its factors
    seen, driven = c @ right[0], left[0] @ b
    size = np.linalg.norm(c, axis=1)[:, None] * np.linalg.norm(b, axis=0)
    size = size * np.linalg.norm(right[0], 2) * np.linalg.norm(left[0], 2) if m else size
    step = t[:m, :m] - np.eye(m)
    for _ in range(m):
        adds = np.real(seen @ driven)
        there = np.abs(adds) > _CANCELLED * size
        found[there] = np.copysign(np.inf, adds[there])
        driven, size = step @ driven, size * np.linalg.norm(step, 2)
    return found


def backward(system: StandstillSystem, output: str, name: str) -> StandstillSystem:
    """A system with the opposite sign, whose states keep their names."""
    return StandstillSystem(
        *(system.A, system.B, -system.C, -system.D, system.dt),
        inputs=system.input_labels,
        outputs=[output],
        states=system.state_labels,
        remove_useless_states=False,
        name=name,
    )
