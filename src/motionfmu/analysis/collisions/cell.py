"""The bodies around an arm, from a file.

clearance = 10                   # [mm] least distance that is wanted, 0 if not given
floor     = 0                    # [mm] height of a floor; without it there is none

[radius]                         # [mm] of parts of the arm, instead of usual ones
"link 2" = 90
tool     = 20

[[body]]
name = "table"
box  = [800, 600, 300]           # lengths along x, y, z [mm]
at   = [900, 0, 150, 0, 0, 30]   # X Y Z [mm], A B C [deg] of its centre, in the arm's base

[[body]]
name = "post"
bar  = [[0, 800, 0], [0, 800, 2000]]   # ends [mm] of a bar with round ends
radius = 60
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, model_validator

from motionfmu.arms.arm_description import turn_of
from motionfmu.base.toml_lines import model_of

Array = NDArray[np.float64]
Three = tuple[float, float, float]
Six = tuple[float, float, float, float, float, float]
Part = Literal["base", "link 1", "link 2", "link 3", "link 4", "link 5", "link 6", "tool"]


@dataclass(frozen=True)
class CellBody:
    """A box, or a bar with round ends.

    Attributes
    ----------
    name : str
    half : (3,) ndarray or None
        Half the lengths of a box [mm].
    turn, center : (3, 3), (3,) ndarray
        Of the box in the base.
    bar : (2, 3) ndarray or None
        Ends [mm] of a bar.
    radius : float
        Of the bar [mm].
    """

    name: str
    half: Array | None = None
    turn: Array = field(default_factory=lambda: np.eye(3))
    center: Array = field(default_factory=lambda: np.zeros(3))
    bar: Array | None = None
    radius: float = 0.0


@dataclass(frozen=True)
class Cell:
    """What an arm may not touch.

    Attributes
    ----------
    bodies : tuple of CellBody
    floor : float or None
        Height of a floor [mm].
    clearance : float
        Least distance that is wanted [mm].
    radii : dict
        Of parts of the arm [mm], by name.
    """

    bodies: tuple[CellBody, ...] = ()
    floor: float | None = None
    clearance: float = 0.0
    radii: dict[str, float] = field(default_factory=dict)


class _CellKeys(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class _BodyRow(_CellKeys):
    name: str = Field(min_length=1)  # what messages call it
    box: Three | None = None  # [mm] lengths of a box along x, y, z
    at: Six = (0.0,) * 6  # [mm, deg] X Y Z A B C of its centre, in the arm's base
    bar: tuple[Three, Three] | None = None  # [mm] ends of a bar with round ends
    radius: float | None = Field(default=None, gt=0.0)  # [mm] of the bar

    @model_validator(mode="after")
    def _one_kind(self) -> "_BodyRow":
        if (self.box is None) == (self.bar is None):
            raise ValueError("a box or a bar is wanted")
        if (self.bar is None) != (self.radius is None):
            raise ValueError("bar and radius belong together")
        if self.box is not None and min(self.box) <= 0.0:
            raise ValueError("lengths of a box are above 0")
        return self


class _CellFile(_CellKeys):
    clearance: float = Field(default=0.0, ge=0.0)  # [mm] least distance that is wanted
    floor: float | None = None  # [mm] height of a floor; without it there is none
    # [mm] of parts of the arm, instead of usual ones
    radius: dict[Part, Annotated[float, Field(gt=0.0)]] = Field(default_factory=dict)
    body: list[_BodyRow] = Field(default_factory=list)


def read_cell(file: str | Path) -> Cell:
    """Read a cell from a TOML file.

    Parameters
    ----------
    file : str or Path

    Returns
    -------
    Cell

    Raises
    ------
    InputError
        Something in it is wrong; the message has its line and value.
    """
    found = model_of(file, _CellFile)
    bodies = tuple(_body(row) for row in found.body)
    return Cell(bodies, found.floor, found.clearance, {str(n): r for n, r in found.radius.items()})


def _body(row: _BodyRow) -> CellBody:
    if row.bar is not None:
        return CellBody(row.name, bar=np.array(row.bar), radius=float(row.radius or 0.0))
    place, (a, b, c) = np.array(row.at[:3]), np.radians(row.at[3:])
    return CellBody(row.name, 0.5 * np.array(row.box), turn_of(a, b, c), place)
