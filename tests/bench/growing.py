"""What is done in many sizes for `growth.py`, one process a size: `growing.py WORK SIZE FOLDER`.

`study` makes so many runs of 0.02 s, one worker; `page` writes the page of so many thousand
samples, and marks that part for those who count.
"""

import ctypes
import os
import sys
from pathlib import Path

import motionfmu

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
SHORT = 0.02  # [s] simulated by a run of the study


def study(runs: int, folder: Path) -> None:
    """So many gains of a scenario without a contour."""
    from motionfmu.sweep import Ways, conduct, study

    axis = {"mcc.p_gain": {"from": 50, "to": 50 + max(runs - 1, 1), "n": runs}}
    asked = {"axis": axis, "results": ["card.err_count.absmax"], "stop": SHORT}
    conduct(study(SCENARIOS / "circle_theory", asked), folder / "out", Ways(workers=1))


def page(thousands: int, folder: Path) -> None:
    """The page of a run of the demo, its program over and over."""
    from motionfmu.report import write_report

    result = motionfmu.load(folder / "long").run(stop=thousands * 0.1)
    where = os.environ.get("COUNT_HERE")
    here = ctypes.CDLL(where) if where else None
    if here:
        here.count_begin()
    write_report(result, None, folder / "out")
    if here:
        here.count_end()
        print("counted share 1", file=sys.stderr)


if __name__ == "__main__":
    {"study": study, "page": page}[sys.argv[1]](int(sys.argv[2]), Path(sys.argv[3]))
