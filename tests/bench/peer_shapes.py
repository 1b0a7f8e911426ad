"""Times of shapes by LinuxCNC's planner, as in_linuxcnc.py measured them, beside ours."""

import sys
import tomllib
from pathlib import Path

import numpy as np
from peers import Row, agree

FOLDER = Path(__file__).resolve().parents[2] / "scenarios/short_lines"
sys.path.insert(0, str(FOLDER))
import study  # noqa: E402

ROUNDING = 1e-3  # [mm] of points and chords beside the tolerance


class Rows:
    """Simulated time of each shape [s], the same every time."""

    def __init__(self) -> None:
        self.missing: list[str] = []
        self._times: dict[tuple[str, float], float] = {}

    def __call__(self) -> None:
        if not self._times:
            self._times = {run: self._driven(*run) for run in study.RUNS}

    @staticmethod
    def _driven(name: str, feed: float) -> float:
        """Drive a shape; its path must be within the tolerance that LinuxCNC was given, too."""
        read = study.program(name, feed, *study.WORDS[study.T])
        path = np.vstack([study.programmed(chain) for chain in study.chains(read)])
        off = max(study.distances(read.places()[:, :3], path))
        agree(f"shape {name}", off <= study.TOLERANCE + ROUNDING, f"{off:.4f} mm off the lines")
        return study.fed(read)

    def rows(self) -> list[Row]:
        """A row for each shape and feed."""
        file = FOLDER / "linuxcnc_times.toml"
        version = tomllib.loads(file.read_text(encoding="utf-8"))["version"].partition("~")[0]
        return [
            Row(
                f"time to drive {name} at {feed:g} mm/s within {study.TOLERANCE:g} mm",
                "s",
                f"LinuxCNC {version}, recorded",
                self._times[name, feed],
                seconds,
                1,
            )
            for (name, feed), seconds in study.recorded().items()
        ]
