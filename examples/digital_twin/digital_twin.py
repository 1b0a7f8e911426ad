"""A record of a real axis becomes its model, and the model better gains."""

from pathlib import Path

from matplotlib import pyplot as plt

import motionfmu
from motionfmu.identify import identify, run_of_record
from motionfmu.study.tune import read, tune

AXIS = Path(__file__).resolve().parent / "axis"
scenario = motionfmu.load(AXIS)

# 1. The record: one period of 6.24 s at 1 kHz.
record = motionfmu.record(AXIS / "record.csv")

# 2. Identify: mass, friction and the controller's true gains, then the FMUs beside the record.
found = identify(scenario, record)  # what its columns are, axis/identify.toml says
for p in found.parameters:
    print(f"{p.name:32} {p.value:9.4g} ± {p.deviation:.2g} {p.unit}")
twin = run_of_record(found)
for name, share in twin.differences.items():
    print(f"FMUs beside the record, {name}: {100 * share:.2f} %")

# 3. Tune on the twin, with margins for every plant that the record leaves possible.
tuned = tune(scenario, read(AXIS / "tune.toml"), identified=[found])
print(tuned)
print(tuned.region.text)
before, after = tuned.before[0], tuned.after[0]

figure, (top, middle, bottom) = plt.subplots(3, 1, figsize=(10, 9), layout="constrained")
measured, simulated = (1e6 * f for f in twin.following)
top.plot(twin.time, measured, lw=1, label="record")
top.plot(twin.time, simulated, "--", lw=1, label="FMUs")
rest = twin.time >= twin.settled
middle.plot(twin.time[rest], (simulated - measured)[rest], lw=0.7, color="tab:red")
for run, name in ((before, "gains of the record"), (after, "gains found")):
    bottom.plot(run.fmus.time, -1e3 * run.fmus.values, lw=0.8, label=name)
top.set(ylabel="following error [µm]", title="The twin beside the real axis")
middle.set(ylabel="twin less record [µm]", title="What is left, from 0.2 s on")
bottom.set(
    xlabel="time [s]", ylabel="following error [µm]", title="What the gains found should give"
)
top.legend(), bottom.legend()
figure.savefig("digital_twin.png", dpi=110)
