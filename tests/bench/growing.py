"""What is done in many sizes for `growth.py`, one process a size: `growing.py WORK SIZE FOLDER`.

`study` makes so many runs of 0.02 s, one worker; `page` writes the page of so many thousand
samples. Each prints the processor time of that, without the start.
"""

import resource
import sys
import tempfile
from pathlib import Path

import motionfmu

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
SHORT = 0.02  # [s] simulated by a run of the study


def used() -> float:
    """Processor time of this process and those it has waited for [s]."""
    both = [resource.getrusage(w) for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in both)


def study(runs: int, folder: Path) -> None:
    """So many gains of a scenario without a contour."""
    from motionfmu.sweep import Ways, conduct, study

    start = used()

    axis = {"mcc.p_gain": {"from": 50, "to": 49 + runs, "n": runs}}
    asked = {"axis": axis, "results": ["card.err_count.absmax"], "stop": SHORT}
    with tempfile.TemporaryDirectory(dir=folder) as fresh:  # rows that are there are not made anew
        conduct(study(SCENARIOS / "circle_theory", asked), Path(fresh) / "out", Ways(workers=1))
    print(used() - start)


def page(thousands: int, folder: Path) -> None:
    """The page of a run of the demo, its program over and over."""
    from motionfmu.report import write_report

    result = motionfmu.load(folder / "long").run(stop=thousands * 0.1)
    start = used()
    write_report(result, None, folder / "out")
    print(used() - start)


if __name__ == "__main__":
    {"study": study, "page": page}[sys.argv[1]](int(sys.argv[2]), Path(sys.argv[3]))
