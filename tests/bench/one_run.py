"""A scenario of so many steps by an engine: `one_run.py SCENARIO ENGINE FMI STEPS`.

Its loop is what is counted: from the first report of progress to the last before the end.
"""

import sys

import marks

import motionfmu

_, name, engine, fmi, steps = sys.argv
scenario = motionfmu.load(name)
stop = int(steps) * scenario.document.body.step
LAST = 0.99 - 1e-9  # of 100 reports and the end
first: float | None = None
over = False


def progress(share: float) -> None:
    """Count from the first report to the last; tell which share of the run that is."""
    global first, over
    if first is None:
        marks.begin()
        first = share
    elif share >= LAST and not over:
        marks.end(share - first)
        over = True


print(len(scenario.run(engine=engine, fmi=int(fmi), stop=round(stop, 9), progress=progress).time))
