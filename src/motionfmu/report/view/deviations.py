"""Lines that were followed, from the analyses of a run."""

import numpy as np

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.scaled_values import blocks, picked
from motionfmu.analysis.iso9283 import Performance
from motionfmu.report.view.scene import DeviationLine
from motionfmu.run.decimate import MOST, at, reader


def from_contour(contour: ContourResult) -> DeviationLine:
    """The tool beside the exact path, where it cuts; of very many samples some, evenly."""
    count = int(np.count_nonzero(contour.cutting))
    ranks = np.arange(count)
    if count > MOST:
        ranks = np.linspace(0, count - 1, MOST).round().astype(np.int64)
    parts, before = [np.zeros(0, dtype=np.int64)], 0
    for own in blocks(len(contour.cutting)):
        rows = own.start + np.flatnonzero(contour.cutting[own])
        a, b = np.searchsorted(ranks, [before, before + len(rows)])
        parts.append(rows[ranks[a:b] - before])
        before += len(rows)
    cut, track = np.concatenate(parts), contour.track
    foot = picked(track.feet, cut, track.segment, track.along)
    return DeviationLine(foot, at(reader(contour.run.actual), cut)[:, :3] - foot)


def from_cycles(path: Performance) -> list[DeviationLine]:
    """A line for each cycle, in the planes across the command path."""
    return [DeviationLine(path.command, point - path.command) for point in path.point]
