"""State-space systems changed with their names kept."""

from typing import TYPE_CHECKING

import numpy as np

from motionfmu.linear.block import Matrix

if TYPE_CHECKING:
    import control


def replaced(system: "control.StateSpace", c: Matrix, d: Matrix, name: str) -> "control.StateSpace":
    """The same states seen otherwise, with their names.

    Parameters
    ----------
    system : control.StateSpace
    c, d : ndarray
        Output matrices.
    name : str

    Returns
    -------
    control.StateSpace
    """
    import control

    return control.StateSpace(
        *(system.A, system.B, c, d, system.dt),
        inputs=system.input_labels,
        outputs=system.output_labels,
        states=system.state_labels,
        remove_useless_states=False,
        name=name,
    )


def delayed(system: "control.StateSpace", state: str) -> "control.StateSpace":
    """The same output one period later.

    Parameters
    ----------
    system : control.StateSpace
        Of one output.
    state : str
        Name of the state that holds it.

    Returns
    -------
    control.StateSpace
    """
    n = system.nstates
    a = np.block([[system.A, np.zeros((n, 1))], [system.C, np.zeros((1, 1))]])
    import control

    return control.StateSpace(
        *(a, np.vstack([system.B, system.D]), np.eye(1, n + 1, n), np.zeros((1, 1)), system.dt),
        inputs=system.input_labels,
        outputs=system.output_labels,
        states=[*system.state_labels, state],
        remove_useless_states=False,
        name=system.name,
    )
