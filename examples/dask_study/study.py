"""Gain and backlash against the contour error of a circle, on a dask cluster."""

import math

import distributed
import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt

from motionfmu import sweep

RADIUS, FEED = 20.0, 50.0  # [mm], [mm/s] of arc/arc.ngc
# DAC codes for a count over 2^6, 20 V over 2^16 codes, 300 rpm/V of 10,000 counts a turn [1/s].
KP = 1 / 2**6 * 20 / 2**16 * 300 / 60 * 10_000
ERROR = "contour.error.max"


def main() -> None:
    """Run the study, print its table, draw it."""
    study = sweep.study("arc")  # arc/sweep.toml
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None
    ) as cluster:  # or dask_jobqueue.SLURMCluster, dask_kubernetes.KubeCluster: it has an address
        ways = sweep.Ways(scheduler=cluster.scheduler_address)
        found = sweep.conduct(study, "results/arc.sweep", ways)

    gains, gaps = (np.unique(found.axis(name)) for name in ("mcc.p_gain", "machine.backlash"))
    error = 1e3 * found.column(ERROR).reshape(len(gains), len(gaps))  # [µm] the last axis fastest
    print("gain   lag    ", "  ".join(f"{1e6 * gap:3.0f} µm" for gap in gaps))
    for gain, row in zip(gains, error, strict=True):
        print(f"{gain:4.0f} {lag(gain):6.1f} ", *(f"{value:7.1f}" for value in row))

    figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    for gap, column in zip(gaps, error.T, strict=True):
        axes.plot(gains, column, "o-", label=f"{1e6 * gap:.0f} µm")
    axes.plot(gains, [lag(gain) for gain in gains], "k:", label="the lag alone")
    axes.set(
        xlabel="gain of the position loop", ylabel="largest contour error [µm]", ylim=(0, None)
    )
    axes.legend(title="backlash")
    figure.savefig("study.png", dpi=110)


def lag(gain: float) -> float:
    """What a loop that lags takes from the radius [µm], for a gain of the card."""
    angle = math.atan(FEED / (RADIUS * KP * gain))
    return 1e3 * RADIUS * (1.0 - math.cos(angle))


if __name__ == "__main__":
    main()
