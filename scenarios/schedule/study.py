"""Where the deadlines break as a point of the interpolation takes longer, beside the analysis.

    .venv/bin/python scenarios/schedule/study.py [picture.png]

Response time analysis: R = C + sum over the more urgent modules of ceil(R / T) C, with C the
longest time of a run and T the cycle; the deadline holds while R <= T.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from rich.progress import track

import motionfmu
from motionfmu.report.studies.study_picture import save

HERE = Path(__file__).parent
# Times of a point [ns]: a grid, and the last that holds and one clock more for both modules.
POINTS = sorted({*range(100_000, 960_001, 20_000), 479_000, 479_025, 544_000, 544_025})
NAMES = ("interpreter", "interpolation")
COLOURS = ("#d55e00", "#0072b2")


def response(own: tuple[int, int], urgent: list[tuple[int, int]]) -> float:
    """Longest response of a module; not a number above its cycle.

    Parameters
    ----------
    own : tuple of int
        Longest time of a run and cycle [ns].
    urgent : list of tuple of int
        The same of the more urgent modules.
    """
    r, last = own[0], 0
    while r != last and r <= own[1]:
        last = r
        r = own[0] + sum(-(-r // cycle) * time for time, cycle in urgent)
    return r if r <= own[1] else np.nan


def analysis(point: int) -> list[float]:
    """Longest responses of interpreter and interpolation [ns].

    Parameters
    ----------
    point : int
        Time of a point [ns].
    """
    # Position control four frames, process control; the cycles of the scenario.
    urgent = [(180_000, 4_096_000), (200_000, 2_048_000)]
    interpolation = (100_000 + point, 1_024_000)
    interpreter = (200_000 + 2 * 500_000, 4_096_000)
    return [response(interpreter, [*urgent, interpolation]), response(interpolation, urgent)]


def main(picture: Path) -> None:
    """Run the sweep, print the table, draw the picture.

    Parameters
    ----------
    picture : Path
        File to write.
    """
    scenario = motionfmu.load(HERE)
    theory = np.array([analysis(p) for p in POINTS]) * 1e-6
    found, missed, starved = [], [], []
    for point in track(POINTS, "sweep", transient=True, disable=not sys.stdout.isatty()):
        result = scenario.run(set={"mcc.module_unit_time": [5e-4, point * 1e-9, 3e-5, 0.0]})
        found.append(result["mcc.module_response"][-1, :2] * 1e3)
        missed.append(result["mcc.module_missed"][-1, :2])
        starved.append(result["mcc.starved"][-1])
    print(f"{'point':>8} {'':14} {'longest':>9} {'analysis':>9}  [ms] {'missed':>7} {'starved':>8}")
    for k, point in enumerate(POINTS):
        for i, name in enumerate(NAMES):
            print(
                f"{point * 1e-6:8.6f} {name:14} {found[k][i]:9.6f} {theory[k, i]:9.6f}"
                f"       {missed[k][i]:7d} {starved[k]:8d}"
            )
    x = np.array(POINTS) * 1e-6
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(9, 6.5))
    for i, (name, colour, cycle) in enumerate(zip(NAMES, COLOURS, (4.096, 1.024), strict=True)):
        above.plot(x, theory[:, i], color=colour, label=f"{name}: analysis")
        style = {"color": colour, "linestyle": "", "marker": "o", "markersize": 4}
        above.plot(x, np.array(found)[:, i], **style, label=f"{name}: longest of the run")
        above.axhline(cycle, color=colour, linewidth=1, linestyle=":")
        below.plot(x, np.array(missed)[:, i], color=colour, marker="o", markersize=4, label=name)
    below.plot(x, starved, color="#009e73", marker="o", markersize=4, label="starved frames")
    above.set_title("Deadlines break where the response passes the cycle (dotted)", loc="left")
    above.set_ylabel("response [ms]")
    above.set_ylim(0, 6)
    below.set_ylabel("missed deadlines, frames")
    below.set_xlabel("processor time of a point [ms]")
    for axes in (above, below):
        axes.legend(frameon=False)
    save(figure, picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "breaking.png")
