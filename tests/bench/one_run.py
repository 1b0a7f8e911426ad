"""A scenario of so many steps by an engine: `one_run.py SCENARIO ENGINE FMI STEPS`.

Its loop is what is counted: from the first report of progress to the last before the end.
"""

import ctypes
import os
import sys

import motionfmu

_, name, engine, fmi, steps = sys.argv
scenario = motionfmu.load(name)
stop = int(steps) * scenario.document.body.step
where = os.environ.get("COUNT_HERE")
here = ctypes.CDLL(where) if where else None
LAST = 0.99 - 1e-9  # of 100 reports and the end
marks: list[float] = []


def progress(share: float) -> None:
    """Count from the first report to the last; tell which share of the run that is."""
    if here and not marks:
        here.count_begin()
        marks.append(share)
    elif here and share >= LAST and len(marks) == 1:
        here.count_end()
        marks.append(share)


print(len(scenario.run(engine=engine, fmi=int(fmi), stop=round(stop, 9), progress=progress).time))
if here:
    print("counted share", marks[1] - marks[0], file=sys.stderr)
