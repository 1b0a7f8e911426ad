"""Least time with limited jerk along a chain: linear programs, each near the answer before it."""

import numpy as np
from scipy import sparse
from scipy.optimize import linprog
from speed_rides import LIBRARY, look

AXES = 2
LEAST = 1e-2  # [mm^2/s^2] x in the denominators


def bound(told: np.ndarray, acc: float, jerk: float, feed: float, step: float = 0.05) -> float:
    """Time from rest to rest with both axes within acc and jerk at the points of a grid. [s]

    With x = (du/dt)^2 an axis has the jerk (r' x'' / 2 + 3/2 r'' x' + r''' x) sqrt(x); the tangent
    of 1 / sqrt(x) lies below it, so that each program stays within the limit.
    """
    length = LIBRARY.speed_batch_segments(len(told), told)
    n = int(np.ceil(length / step))
    h = length / n
    ways = h * (np.arange(n) + 0.5)
    near = [look(told, np.clip(ways + d, 0, length)) for d in (-0.1 * h, 0.0, 0.1 * h)]
    first, second = near[1]["slope"][:, :AXES], near[1]["bend"][:, :AXES]
    third = (near[2]["bend"] - near[0]["bend"])[:, :AXES] / (0.2 * h)
    slope = sparse.diags([-1 / h, 1 / h], [0, 1], shape=(n, n + 1)).tocsr()
    mean = sparse.diags([0.5, 0.5], [0, 1], shape=(n, n + 1)).tocsr()
    bend = (sparse.diags([-1 / h, 1 / h], [0, 1], shape=(n - 1, n)) @ slope).tocsr()
    most = (feed / np.linalg.norm(first, axis=1)) ** 2
    top = np.minimum(np.append(most, 0.0), np.append(0.0, most))
    rows = []
    for k in range(AXES):
        a = sparse.diags(first[:, k] / 2) @ slope + sparse.diags(second[:, k]) @ mean
        rows += [a / acc, -a / acc]
    x = top.copy()
    for _ in range(6):
        found, limits = list(rows), [np.ones(n)] * len(rows)
        for k in range(AXES):
            for part in (slice(0, n - 1), slice(1, n)):
                at = np.maximum(mean[part] @ x, LEAST)
                j = sparse.diags(first[part, k] / 2) @ bend
                j += sparse.diags(1.5 * second[part, k]) @ slope[part]
                j += sparse.diags(third[part, k]) @ mean[part]
                j = sparse.diags(np.sqrt(at) / jerk) @ j
                tangent = sparse.diags(0.5 / at) @ mean[part]
                found += [j + tangent, tangent - j]
                limits += [np.full(n - 1, 1.5)] * 2
        scale = np.maximum(x, 1.0)
        table = (sparse.vstack(found) @ sparse.diags(scale)).tocsr()
        size = np.maximum(abs(table).max(axis=1).toarray().ravel(), 1.0)
        worth = scale * np.maximum(x, 25.0) ** -1.5
        answer = linprog(
            -worth / worth.max(),
            A_ub=sparse.diags(1 / size) @ table,
            b_ub=np.concatenate(limits) / size,
            bounds=np.stack([np.zeros(n + 1), top / scale], 1),
            method="highs-ipm",
        )
        x = answer.x * scale
    speed = np.sqrt(np.maximum(x, 0.0))
    return float((2 * h / (speed[1:] + speed[:-1])).sum())
