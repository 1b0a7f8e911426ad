"""What is done with a drawing before a machine follows it."""

from dataclasses import dataclass, fields
from typing import Any

ORDERS = ("file", "nearest", "inside")
CORNERS = ("round", "stop")


@dataclass(frozen=True)
class DrawingOptions:
    """Options of the way from a drawing to a machine's path."""

    # Of the contours: "file", "nearest" or "inside", the nearest of those in which nothing is left
    # to draw. None: "inside" for a drawing without an order of its own (SVG, DXF), else "file".
    order: str | None = None
    # "round" within the tolerance, or "stop": to rest exactly at vertices where the path
    # turns by more than the configuration's corner angle. None: a card rounds, a mill stops.
    corners: str | None = None
    pens: list[int] | None = None  # Only lines of these pens; None: of all
    speeds: bool = False  # A card keeps the speeds that the drawing asks for below its feed
    # [mm] from the drawing's origin to the machine's position 0
    offset: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0  # The drawing is larger by this factor about its origin, before all else
    copies: tuple[int, int] = (1, 1)  # along X and Y
    pitch: tuple[float, float] = (0.0, 0.0)  # [mm] from copy to copy
    knife: float = 0.0  # [mm] by which a drag knife's edge trails its axis; 0 none
    up: float = 0.0  # [mm] Z of a mill above a drawing
    down: float = -1.0  # [mm] Z of a mill in it
    page: int = 1  # Which page of an HP-GL file with several, from 1

    @property
    def changes(self) -> dict[str, Any]:
        """The options that are not at their defaults, by name."""
        return {
            f.name: value for f in fields(self) if (value := getattr(self, f.name)) != f.default
        }
