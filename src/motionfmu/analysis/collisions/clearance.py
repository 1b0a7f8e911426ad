"""How near an arm comes to itself and to its cell, line by line of a program."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.collisions.arm_parts import NAMES, ArmParts
from motionfmu.analysis.collisions.cell import Cell, CellBody
from motionfmu.analysis.collisions.distances import between_segments, from_box

Array = NDArray[np.float64]
FLOOR = "floor"
_PIECE = 20_000  # positions of the arm whose distances are computed at once


@dataclass(frozen=True)
class Approach:
    """Least distance of two parts or bodies in the moves of a line.

    Attributes
    ----------
    line : int
    time : float
        Where they first come too near, else where the distance is least [s].
    distance : float
        [mm], 0 or less where two touch; less only for bars, as deep as one is in the other.
    first, second : str
        A part of the arm; another one, or a body of the cell.
    joint : tuple of float
        Then [deg].
    near : bool
        Whether they come too near: they touch, or are closer than the clearance that is wanted.
    """

    line: int
    time: float
    distance: float
    first: str
    second: str
    joint: tuple[float, ...]
    near: bool

    @property
    def words(self) -> str:
        """Which two, how far apart, where."""
        joints = ", ".join(f"{j:.1f}" for j in self.joint)
        apart = f"comes within {self.distance:.1f} mm of" if self.distance > 0.0 else "runs into"
        other = self.second if self.second in NAMES[1:] else f"the {self.second}"
        return f"{self.first} {apart} {other} at {self.time:.3f} s, joints {joints}"


def distances(
    parts: ArmParts, cell: Cell, joints: Array, tip: Array, base: Array | float = 0.0
) -> Iterator[tuple[str, str, Array]]:
    """Two that can touch, their distance (n,) [mm]; joints (n, 6) [deg], tips and bases (n, 3)."""
    standing = np.broadcast_to(base, tip.shape)
    points, radii = parts.points(joints, tip - standing) + standing[:, None], parts.radii
    bars = [(points[:, k], points[:, k + 1]) for k in range(len(NAMES))]
    for a, b in parts.pairs:
        yield NAMES[a], NAMES[b], between_segments(bars[a], bars[b]) - radii[a] - radii[b]
    for k in range(2, len(NAMES)):  # base and link 1 stand still but for a turn about axis 1
        for body in cell.bodies:
            yield NAMES[k], body.name, _from_body(bars[k], body) - radii[k]
        if cell.floor is not None:
            lowest = np.minimum(bars[k][0][:, 2], bars[k][1][:, 2])
            yield NAMES[k], FLOOR, lowest - cell.floor - radii[k]


def _from_body(bar: tuple[Array, Array], body: CellBody) -> Array:
    if body.half is not None:
        inside = [(end - body.center) @ body.turn for end in bar]
        return from_box((inside[0], inside[1]), body.half)
    assert body.bar is not None
    ends = np.broadcast_to(body.bar[:, None], (2, len(bar[0]), 3))
    return between_segments(bar, (ends[0], ends[1])) - body.radius


def approaches(samples: NDArray[Any], parts: ArmParts, cell: Cell) -> list[Approach]:
    """The least distance of each two parts or bodies, line by line.

    Parameters
    ----------
    samples : (n,) structured ndarray
        As of `DryRun`: ``time``, ``joint``, ``place``, ``base``, ``line``, ``rate``.
    parts : ArmParts
    cell : Cell

    Returns
    -------
    list of Approach
        By line, then by time; line 0 is the position before the first one.
    """
    carried = np.diff(samples["base"], axis=0, prepend=samples["base"][:1])
    moves = (samples["rate"] != 0.0).any(axis=1) | (carried != 0.0).any(axis=1)
    lines = np.where(moves, samples["line"], 0)
    moves[:1] = True
    seen, lines = samples[moves], lines[moves]
    found: dict[tuple[int, str, str], Approach] = {}
    cuts = np.flatnonzero(np.diff(lines)) + 1
    for at in [np.arange(len(seen))[k : k + _PIECE] for k in range(0, len(seen), _PIECE)]:
        piece = seen[at]
        joints, tip = piece["joint"].astype(float), piece["place"].astype(float)
        base = piece["base"].astype(float)
        passes = np.split(np.arange(len(at)), np.unique(np.clip(cuts - at[0], 0, len(at))))
        for first, second, apart in distances(parts, cell, joints, tip, base):
            for rows in passes:
                if not len(rows):
                    continue
                key = int(lines[at[rows[0]]]), first, second
                least = apart[rows]
                close = (least <= 0.0) | (least < cell.clearance)
                row = rows[int(close.argmax() if close.any() else least.argmin())]
                there = tuple(map(float, joints[row]))
                now = Approach(
                    key[0], float(piece["time"][row]), float(least.min()), first, second, there,
                    bool(close.any()),
                )  # fmt: skip
                found[key] = _both(found[key], now) if key in found else now
    return sorted(found.values(), key=lambda a: (a.line, a.time))


def _both(before: Approach, now: Approach) -> Approach:
    """Two passes of a line as one."""
    shown = (
        now
        if now.near > before.near or (now.distance < before.distance and not before.near)
        else before
    )
    return replace(shown, distance=min(before.distance, now.distance))
