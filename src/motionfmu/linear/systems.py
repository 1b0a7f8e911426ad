"""State-space systems changed with their names kept."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import control


def backward(system: "control.StateSpace", output: str, name: str) -> "control.StateSpace":
    """The same with the other sign, under other names; the states keep theirs.

    Parameters
    ----------
    system : control.StateSpace
        Of one output.
    output, name : str
        Names of the output and of the system.

    Returns
    -------
    control.StateSpace
    """
    import control

    return control.StateSpace(
        *(system.A, system.B, -system.C, -system.D, system.dt),
        inputs=system.input_labels,
        outputs=[output],
        states=system.state_labels,
        remove_useless_states=False,
        name=name,
    )
