"""Backlash of a machine and what a circle shows of it, without a folder for each run."""

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt

import motionfmu

base = motionfmu.load("circle").changed(stop=4.0)  # one circle

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
rows = []
for gap in (0, 5, 10, 20):  # [µm]
    result = base.changed(set={"machine.backlash": gap * 1e-6}).run()
    x, y = result.contour().circles[0].ccw.points.T  # [mm]
    angle = np.degrees(np.arctan2(y, x)) % 360
    left.plot(angle, (np.hypot(x, y) - 50) * 1e3, ".", ms=1.5, label=f"{gap} µm")
    error = result.contour().error
    rows.append({"backlash [µm]": gap, "max [µm]": error.max * 1e3, "RMS [µm]": error.rms * 1e3})

table = pd.DataFrame(rows).set_index("backlash [µm]")
table.plot(ax=right, marker="o", ylabel="contour error [µm]", ylim=(0, 65))
left.set(xlabel="angle [°]", ylabel="radial deviation [µm]", xticks=range(0, 361, 90))
left.legend(title="backlash", markerscale=6)
print(table.round(1))
figure.savefig("backlash.png", dpi=110)
