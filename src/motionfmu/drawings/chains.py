"""Lines of a drawing without an order, joined where their ends meet."""

from collections import defaultdict
from dataclasses import replace

import numpy as np

from motionfmu.drawings.drawing import Polyline
from motionfmu.drawings.pen_path import SAME, Array, PenPath, joined

MEET = 0.01  # [mm] ends nearer than this are joined, by a line where they are not in one place


class _LooseEnds:
    """Ends of lines that are not joined yet, by squares of the size of MEET."""

    def __init__(self, lines: list[Polyline]) -> None:
        self.squares: dict[tuple[int, ...], list[tuple[int, int]]] = defaultdict(list)
        self.paths = [(line.path, line.path.reversed) for line in lines]
        self.groups = [(line.pen, line.speed) for line in lines]
        self.loose = [not _closed(line.path) for line in lines]
        for k, both in enumerate(self.paths):
            if self.loose[k]:
                for turned, path in enumerate(both):
                    self.squares[_square(path.nodes[0])].append((k, turned))

    def next(self, tail: PenPath, group: tuple[int, float]) -> tuple[int, PenPath] | None:
        """The line that begins where another ends and turns least from it."""
        at, (i, j) = tail.nodes[-1], _square(tail.nodes[-1])
        heading = tail.piece_path(-1).headings()[0, 1]
        best, found = 2.0, None
        near = [(i + a, j + b) for a in (-1, 0, 1) for b in (-1, 0, 1)]
        for k, turned in (end for square in near for end in self.squares.get(square, ())):
            path = self.paths[k][turned]
            if not self.loose[k] or self.groups[k] != group:
                continue
            if np.hypot(*(path.nodes[0] - at)) > MEET:
                continue
            turn = 1.0 - float(heading @ path.piece_path(0).headings()[0, 0])
            if found is None or turn < best - 1e-9:
                best, found = turn, (k, path)
        return found


def _square(place: Array) -> tuple[int, ...]:
    return tuple(np.floor(place / MEET).astype(int).tolist())


def _closed(path: PenPath) -> bool:
    return len(path.source) == 0 or bool(np.abs(path.nodes[-1] - path.nodes[0]).max() <= SAME)


def chained(lines: list[Polyline]) -> list[Polyline]:
    """Lines of the same pen joined end to end, in the order in which their parts begin."""
    ends = _LooseEnds(lines)
    found = []
    for k, line in enumerate(lines):
        if not ends.loose[k]:
            if _closed(line.path):
                found.append(line)
            continue
        ends.loose[k] = False
        chain = _grown([line.path], ends, ends.groups[k])
        if not _whole(chain):  # at its other end
            turned = _grown([p.reversed for p in reversed(chain)], ends, ends.groups[k])
            chain = [p.reversed for p in reversed(turned)]
        if _whole(chain) and np.abs(chain[-1].nodes[-1] - chain[0].nodes[0]).max() > SAME:
            chain.append(PenPath.lines(chain[0].nodes[:1], int(chain[-1].source[-1])))
        found.append(replace(line, path=joined(chain)) if len(chain) > 1 else line)
    return found


def _grown(chain: list[PenPath], ends: _LooseEnds, group: tuple[int, float]) -> list[PenPath]:
    """A chain with all that follows its end, until it is closed."""
    while not _whole(chain) and (more := ends.next(chain[-1], group)):
        k, path = more
        ends.loose[k] = False
        chain.append(path)
    return chain


def _whole(chain: list[PenPath]) -> bool:
    """Whether a chain ends where it begins."""
    gap = float(np.hypot(*(chain[-1].nodes[-1] - chain[0].nodes[0])))
    long = len(chain) > 1 or len(chain[0].source) > 1
    return gap <= SAME or (gap <= MEET and long)
