"""The command path: a polyline with its length, directions and orientations."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from motionfmu.analysis.iso9283.turn import Array, between, unit

# Points closer together than this are one: a command that rests or creeps by rounding [mm].
SAME = 1e-6
# A polyline is straight if no point is farther than this off the line of its ends [mm].
STRAIGHT = 1e-6


@dataclass(frozen=True)
class CommandPath:
    """The path that the tool was told to follow.

    Attributes
    ----------
    points : ndarray, shape (m, 3)
        Corners of a polyline in the order of travel [mm], no two that follow each other alike.
    quaternions : ndarray, shape (m, 4), optional
        Commanded orientation at each point, (w, x, y, z).
    """

    points: Array
    quaternions: Array | None = None

    def __post_init__(self) -> None:
        points = self.points
        if points.ndim != 2 or points.shape[1] != 3 or len(points) < 2:
            raise ValueError(f"a path needs (m, 3) points, m >= 2, not {points.shape}")
        if not np.isfinite(points).all():
            raise ValueError("a point of the path is not finite")
        if (np.linalg.norm(np.diff(points, axis=0), axis=1) <= 0.0).any():
            raise ValueError("two points of the path that follow each other are the same")
        if self.quaternions is not None and self.quaternions.shape != (len(points), 4):
            raise ValueError(f"quaternions are {self.quaternions.shape}, not {(len(points), 4)}")

    @classmethod
    def of(cls, points: Array, quaternions: Array | None = None) -> "CommandPath":
        """Make a path of points of which some may repeat.

        A recorded command has such ones.

        Parameters
        ----------
        points : ndarray, shape (n, 3)
            [mm]; points within 1 nm of way become one.
        quaternions : ndarray, shape (n, 4), optional

        Raises
        ------
        ValueError
            Fewer than two different points are left.
        """
        points = np.asarray(points, dtype=np.float64)
        way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        kept = np.unique(np.ceil(way / SAME).astype(np.int64), return_index=True)[1]
        if len(kept) > 1 and (points[kept[-1]] != points[-1]).any():
            kept[-1] = len(points) - 1  # the end is exact
        turned = None if quaternions is None else unit(np.asarray(quaternions)[kept])
        return cls(points[kept], turned)

    @cached_property
    def along(self) -> Array:
        """Length from the start to each point (m,) [mm]."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def length(self) -> float:
        """Length of the path [mm]."""
        return float(self.along[-1])

    @property
    def straight(self) -> bool:
        """Whether all points lie on one line, in its direction."""
        way = (self.points[-1] - self.points[0]) / max(self.length, SAME)
        rest = self.points - self.points[0]
        off = rest - np.outer(rest @ way, way)
        return bool(np.linalg.norm(off, axis=1).max() <= STRAIGHT)

    def at(self, along: Array) -> Array:
        """Points at places of the path.

        Parameters
        ----------
        along : ndarray, shape (n,)
            Length from the start [mm].

        Returns
        -------
        ndarray, shape (n, 3)
        """
        return np.stack([np.interp(along, self.along, c) for c in self.points.T], axis=1)

    def direction(self, along: Array) -> Array:
        """Directions of travel at places of the path.

        At a corner it is that of the piece after it.

        Parameters
        ----------
        along : ndarray, shape (n,)
            Length from the start [mm].

        Returns
        -------
        ndarray, shape (n, 3)
            Unit vectors.
        """
        piece = np.clip(self._piece(along), 0, len(self.points) - 2)
        steps = np.diff(self.points, axis=0)[piece]
        return np.asarray(steps / np.linalg.norm(steps, axis=1, keepdims=True))

    def orientation(self, along: Array) -> Array | None:
        """Commanded orientations at places of the path.

        Parameters
        ----------
        along : ndarray, shape (n,)
            Length from the start [mm].

        Returns
        -------
        ndarray, shape (n, 4), or None
            Quaternions (w, x, y, z); None if the path has none.
        """
        if self.quaternions is None:
            return None
        piece = np.clip(self._piece(along), 0, len(self.points) - 2)
        share = (along - self.along[piece]) / np.diff(self.along)[piece]
        return between(self.quaternions[piece], self.quaternions[piece + 1], share)

    def _piece(self, along: Array) -> np.ndarray:
        return np.searchsorted(self.along, along, side="right") - 1


def read_points(file: str | Path) -> CommandPath:
    """Read a path from a text file.

    Parameters
    ----------
    file : str or Path
        A point a line: x y z [mm], or x y z w qx qy qz with the orientation as quaternion;
        parted by spaces or commas. What follows a ``#`` is a comment.

    Raises
    ------
    ValueError
        The file cannot be read, or a line is wrong; the message names file, line and text.
    """
    rows: list[list[float]] = []
    try:
        lines = Path(file).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"{file}: {getattr(error, 'strerror', None) or error}") from None
    for number, line in enumerate(lines, 1):
        words = line.partition("#")[0].replace(",", " ").split()
        if not words:
            continue
        try:
            row = [float(w) for w in words]
        except ValueError:
            row = []
        if (
            len(row) not in (3, 7)
            or (rows and len(row) != len(rows[0]))
            or not np.isfinite(row).all()
        ):
            wanted = "3 or 7" if not rows else str(len(rows[0]))
            raise ValueError(f"{file}:{number}: {line.strip()!r}: {wanted} numbers wanted")
        rows.append(row)
    if len(rows) < 2:
        raise ValueError(f"{file}: a path needs two points or more, there are {len(rows)}")
    table = np.array(rows)
    return CommandPath.of(table[:, :3], table[:, 3:] if table.shape[1] == 7 else None)
