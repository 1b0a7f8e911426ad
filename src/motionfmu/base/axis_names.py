"""The six axes of a controller, where a machine gives them no other names."""

from typing import NamedTuple

AXIS_NAMES = "XYZUVW"


class ControllerAxis(NamedTuple):
    """An axis as a controller's program sees it."""

    name: str
    unit: str  # of its positions: mm, or ° for an axis that turns


# In their order, and with A B C for U V W.
LINEAR = tuple(ControllerAxis(name, "mm") for name in AXIS_NAMES)
ROTARY = (*LINEAR[:3], *(ControllerAxis(name, "°") for name in "ABC"))
