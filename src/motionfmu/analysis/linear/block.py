"""Linear blocks with the timing of the FMUs between communication points."""

from dataclasses import dataclass, field

import casadi as ca
import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


def nonzero(matrix: Matrix) -> NDArray[np.bool_]:
    """Which elements, numbers or expressions, are not always zero."""
    if matrix.dtype != object:
        return matrix != 0.0
    flat = [not (e.is_zero() if isinstance(e, ca.SX) else e == 0.0) for e in matrix.ravel()]
    return np.array(flat, dtype=bool).reshape(matrix.shape)


@dataclass(frozen=True)
class Sampled:
    """A sampled law, which reads at k T and shows its outputs at (k + 1) T.

    The input vector is ``inputs`` and then ``commands``. At an instant, from input u and state x:
    [next x; outputs; early] = law [x; u]. A law may change from instant to instant, and begins
    again after a cycle of them.
    """

    inputs: tuple[str, ...]  # ports that move
    commands: tuple[str, ...]  # signals that arise inside the block
    states: tuple[str, ...]  # quantities that are kept from one instant to the next
    outputs: tuple[str, ...]  # shown one period later
    early: tuple[str, ...]  # shown at the next communication point
    direct: tuple[str, ...]  # shown at once
    grid_ns: int  # sampling period T [ns]
    # One for each instant of the cycle, shape (n_states + n_outputs + n_early, n_states + n_inputs
    # + n_commands). Objects if some elements are expressions of gains.
    laws: tuple[Matrix, ...]
    now: Matrix  # (n_direct, n_commands): outputs that follow the commands at once
    grain: dict[str, float] = field(default_factory=dict)  # rounding step of ports, in their units
    # fastest change that an input can follow [its unit/s]
    speed: dict[str, float] = field(default_factory=dict)

    @property
    def cycle_ns(self) -> int:
        """Time after which its laws begin again [ns]."""
        return self.grid_ns * len(self.laws)

    @property
    def pattern(self) -> NDArray[np.bool_]:
        """Which elements of the law are not zero at some instant."""
        return np.any([nonzero(m) for m in self.laws], axis=0)

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the values that are kept from one grid instant to the next."""
        return (*self.states, *self.outputs, *self.early)

    @property
    def ports(self) -> tuple[str, ...]:
        """Ports that it shows."""
        return (*self.outputs, *self.early, *self.direct)

    def begin(self, memory: Matrix) -> Matrix:
        """Working memory, of shape (rows, n), at an instant of its grid."""
        # Each output has two places: the value that is shown, and the one computed since.
        n = len(self.states)
        return np.vstack([memory, memory[n : n + len(self.outputs)]])

    def end(self, work: Matrix) -> Matrix:
        """The kept values of a working memory, at an instant of its grid."""
        return work[: len(self.memory)]

    def shown(self, work: Matrix, u: Matrix) -> Matrix:
        """What its ports show, (len(ports), n); of u only commands count."""
        return np.vstack([work[len(self.states) : len(self.memory)], self.now @ self._side(u)])

    def _side(self, u: Matrix) -> Matrix:
        return u[len(self.inputs) :]

    def run(self, work: Matrix, u: Matrix, span: tuple[int, int]) -> Matrix:
        """Working memory after a communication step [ns], u held over it."""
        start, stop = span
        n, m = len(self.states), len(self.outputs)
        instant = -(-start // self.grid_ns) * self.grid_ns
        work = work.copy()
        while instant <= stop:
            if instant > start:
                work[n : n + m] = work[len(self.memory) :]
            if instant < stop:
                law = self.laws[instant // self.grid_ns % len(self.laws)]
                found = law @ np.vstack([work[:n], u])
                work[:n] = found[:n]
                work[len(self.memory) :] = found[n : n + m]
                work[n + m : len(self.memory)] = found[n + m :]
            instant += self.grid_ns
        return work


@dataclass(frozen=True)
class Plant:
    """A plant on its micro-grid, which holds its inputs."""

    inputs: tuple[str, ...]
    states: tuple[str, ...]
    outputs: tuple[str, ...]
    grid_ns: int  # micro step [ns]
    step: tuple[Matrix, Matrix]  # state and input matrix of a micro step: x' = F x + G u
    show: tuple[Matrix, Matrix]  # output matrices: y = C x + D u, the input held last
    commands: tuple[str, ...] = ()

    @property
    def cycle_ns(self) -> int:
        """Every micro step is the same [ns]."""
        return self.grid_ns

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of what it remembers: its states and the inputs held."""
        return (*self.states, *(f"{name} held" for name in self.inputs))

    @property
    def ports(self) -> tuple[str, ...]:
        """Ports that it shows."""
        return self.outputs

    def begin(self, memory: Matrix) -> Matrix:
        """Working memory at an instant of its grid: the same."""
        return memory

    end = begin

    def shown(self, work: Matrix, u: Matrix) -> Matrix:
        """What its ports show; the inputs of the moment do not count."""
        n = len(self.states)
        return self.show[0] @ work[:n] + self.show[1] @ work[n:]

    def run(self, work: Matrix, u: Matrix, span: tuple[int, int]) -> Matrix:
        """Working memory after a communication step [ns], u held over it."""
        n, h = len(self.states), self.grid_ns
        x, held = work[:n], work[n:]
        f, g = self.step
        if span[0] % h == 0 and span[1] % h == 0 and span[1] > span[0]:
            power, sums = np.eye(n), np.zeros_like(g)  # whole micro steps, all with one input
            for _ in range((span[1] - span[0]) // h):
                power, sums = f @ power, f @ sums + g
            return np.vstack([power @ x + sums @ u, u])
        instant = span[0] // h * h
        while instant <= span[1]:
            if instant > span[0]:
                x = f @ x + g @ held
            if span[0] <= instant < span[1]:
                held = u
            instant += h
        return np.vstack([x, held])


Block = Sampled | Plant


def reaches(block: Block) -> NDArray[np.bool_]:
    """Which ports shown (rows) depend on which inputs and commands."""
    if isinstance(block, Plant):
        a, b = (nonzero(m) for m in block.step)
        c, d = (nonzero(m) for m in block.show)
    else:
        n, m = len(block.states), len(block.outputs) + len(block.early)
        law = block.pattern
        a, b, c, d = law[:n, :n], law[:n, n:], law[n : n + m, :n], law[n : n + m, n:]
        c = np.vstack([c, np.zeros((len(block.direct), n), dtype=bool)])
        side = np.zeros((len(block.direct), len(block.inputs)), dtype=bool)
        d = np.vstack([d, np.hstack([side, nonzero(block.now)])])
    for _ in range(len(a)):
        b = b | (a @ b)
    found: NDArray[np.bool_] = d | (c @ b)
    return found
