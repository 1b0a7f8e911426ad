"""Look-ahead from the part program to the points in the card: tolerance, limits, time saved."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.analysis.contour import ContourInput, analyse, read_path

PLATE = ROOT / "scenarios/lookahead"
LINES = (PLATE / "plate.ngc").read_text().splitlines()
HEAD, MOVES = LINES[:3], LINES[3:-2]
TOLERANCE, FEED, RAMP = 0.02, 50.0, 0.05  # [mm], [mm/s], [s]
DDA = 1.024e-3  # [s]
ACC = {"T": FEED / RAMP, "S": FEED / (0.75 * RAMP)}  # [mm/s^2] of a ramp, half of it with jerk


@dataclass
class Points:
    """Every point the library has written, one per DDA time."""

    time: np.ndarray  # [s] since the motion began
    place: np.ndarray  # [mm] shape (n, 6)
    speed: np.ndarray  # [mm/s]
    deviation: np.ndarray  # [mm] from the programmed path


def points(folder: Path, words: str, ramps: str, moves: list[str]) -> Points:
    """Run the first moves of the plate."""
    program = folder / "part.ngc"
    head = "\n".join(HEAD).replace("G64 P0.02", words)
    assert words in head
    program.write_text("\n".join([head, *moves, "M30", "%", ""]))
    settings = {"program": str(program), "batch": 1, "start_delay": 0.05}
    settings |= {"acc_type": ramps, "dec_type": ramps}
    result = motionfmu.load(PLATE).run(
        set={f"mcc.{name}": value for name, value in settings.items()},
        stop=9.0 if "G64" in words else 16.0,
    )
    assert result["mcc.done"][-1] and not result["mcc.error"].any()
    place = result["mcc.position"]
    seen = 1 + np.flatnonzero(np.any(np.diff(place, axis=0) != 0.0, axis=1))
    assert np.diff(result.time[seen]).max() < 1.2 * DDA  # none is missing
    seen = np.concatenate([[seen[0] - 1], seen])
    file = folder / "path.csv"
    file.write_text(result.geometry or "")
    time, command = result.time[seen], result["mcc.command"][seen].astype(np.int64)
    told = ContourInput(read_path(file), time, place[seen], place[seen], command)
    distance = analyse(told).track.distance
    return Points(time - time[0], place[seen], result["mcc.path_feed"][seen], distance)


@pytest.mark.parametrize("ramps", ["T", "S"])
@pytest.mark.parametrize("count", [2, 12, 100, len(MOVES)])
def test_limits_hold_at_every_point(count: int, ramps: str, tmp_path: Path) -> None:
    """However many commands the ring holds, from two to more than it has room for."""
    p = points(tmp_path, "G64 P0.02", ramps, MOVES[:count])
    assert 0.4 * TOLERANCE < p.deviation.max() <= TOLERANCE * (1.0 + 1e-6)
    assert 0.999 * FEED < p.speed.max() <= FEED * (1.0 + 1e-9)
    way = np.hypot(*np.diff(p.place, axis=0).T[:2])
    assert way.max() <= FEED * DDA * (1.0 + 1e-9)
    change = np.hypot(*np.diff(p.place, 2, axis=0).T[:2]) / DDA**2
    # Across the path and along it, each within the limit.
    assert 0.9 * ACC[ramps] < change.max() <= 2.0**0.5 * ACC[ramps] * (1.0 + 1e-6)
    last = np.array([float(word[1:]) for word in MOVES[count - 1].split() if word[0] in "XY"])
    assert p.place[-1][1] == last[-1]  # every move that ends here names Y
    assert p.speed[-1] <= ACC[ramps] * DDA


def test_exact_stop_by_both_words(tmp_path: Path) -> None:
    """At a corner under G61 and G61.1 the axes rest, and nothing is rounded; under G64 they run."""
    few = MOVES[:3]
    found = {words: points(tmp_path, words, "T", few) for words in ("G61", "G61.1", "G64 P0.02")}
    stop, other, runs = found.values()
    assert np.array_equal(stop.place, other.place) and np.array_equal(stop.speed, other.speed)
    assert stop.deviation.max() < 1e-9 < 1e-3 < runs.deviation.max()
    assert len(runs.time) < len(stop.time)
    slow = ACC["T"] * DDA  # [mm/s] what a ramp has at most in the last point before rest
    assert (other.speed[1:-1] <= slow).sum() >= 2 and (runs.speed[2:-2] > slow).all()


def test_time_saved(tmp_path: Path) -> None:
    time = {
        name: points(tmp_path, words, ramps, MOVES).time[-1]
        for name, words, ramps in (
            ("stop", "G61", "T"),
            ("T", "G64 P0.02", "T"),
            ("S", "G64 P0.02", "S"),
        )
    }
    assert time["T"] / time["stop"] == pytest.approx(0.4285, abs=0.002)
    assert time["S"] / time["stop"] == pytest.approx(0.444, abs=0.002)


def test_wider_tolerance_is_used_and_saves_time(tmp_path: Path) -> None:
    few = MOVES[:12]
    narrow = points(tmp_path, "G64 P0.02", "T", few)
    program = [few[0] + " G64 P0.2", *few[1:]]
    wide = points(tmp_path, "G64 P0.02", "T", program)
    assert 0.06 < wide.deviation.max() <= 0.2
    assert 0.95 * narrow.time[-1] < wide.time[-1] < 0.98 * narrow.time[-1]
