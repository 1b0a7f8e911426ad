"""Lines that were followed, from the analyses of a run."""

import numpy as np

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.iso9283 import Performance
from motionfmu.report.view.scene import DeviationLine
from motionfmu.run.decimate import MOST, at, reader


def from_contour(contour: ContourResult) -> DeviationLine:
    """The tool beside the exact path, where it cuts; of very many samples some, evenly."""
    cut = np.flatnonzero(contour.cutting)
    if len(cut) > MOST:
        cut = cut[np.linspace(0, len(cut) - 1, MOST).round().astype(np.int64)]
    foot = contour.track.feet(cut)
    return DeviationLine(foot, at(reader(contour.run.actual), cut)[:, :3] - foot)


def from_cycles(path: Performance) -> list[DeviationLine]:
    """A line for each cycle, in the planes across the command path."""
    return [DeviationLine(path.command, point - path.command) for point in path.point]
