"""Least time along the cells of a plan with a constant d2u/dt2 in each: a convex program."""

import casadi
import numpy as np
from speed_rides import planned

PARTS = 60  # of a cell without planes, which may be long


def optimum(told: np.ndarray, bounds: np.ndarray) -> float:
    """Least time from rest to rest within the planes and feeds of the cells. [s]

    A cell without planes is straight: |d2u/dt2| has one limit in it, which its `top` tells.
    """
    cells = planned(told, bounds, "cells")
    lengths, feeds, planes = [], [], []
    for i, cell in enumerate(cells):
        count, rows = int(cell["planes"]), cell["plane"][: int(cell["planes"])]
        if count == 0:
            behind = cells["most"][i + 1] if i + 1 < len(cells) else 0.0
            steep = 1.0 / (cell["top"] - min(cell["feed"], behind))
            rows = PARTS * steep * np.array([[1.0, -1.0], [-1.0, 1.0]])
        parts = 1 if count else PARTS
        lengths += [cell["length"] / parts] * parts
        feeds += [cell["feed"]] * parts
        planes += [rows] * parts
    most = np.minimum(np.append(feeds, 0.0), np.append(0.0, feeds))
    opti = casadi.Opti()
    x = opti.variable(len(most))
    opti.subject_to(opti.bounded(0.0, x, most))
    time = 0.0
    for i, (length, rows) in enumerate(zip(lengths, planes, strict=True)):
        time += 2.0 * length / (casadi.sqrt(x[i] + 1e-9) + casadi.sqrt(x[i + 1] + 1e-9))
        for g0, g1 in rows:
            opti.subject_to(g0 * x[i] + g1 * x[i + 1] <= 1.0)
    opti.minimize(time)
    opti.set_initial(x, np.maximum(1e-3, 1e-3 * most))
    opti.solver("ipopt", {"print_time": 0}, {"print_level": 0, "sb": "yes", "max_iter": 2000})
    return float(opti.solve().value(time))
