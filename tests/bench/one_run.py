"""A scenario of so many steps by an engine: `one_run.py SCENARIO ENGINE FMI STEPS`."""

import sys

import motionfmu

_, name, engine, fmi, steps = sys.argv
scenario = motionfmu.load(name)
stop = int(steps) * scenario.document.body.step
print(len(scenario.run(engine=engine, fmi=int(fmi), stop=round(stop, 9)).time))
