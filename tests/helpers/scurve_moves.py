"""Random moves of one coordinate, planned by src/motion/path/scurve and by the ruckig package."""

import ctypes
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import ruckig

ROOT = Path(__file__).resolve().parents[2]
# struct move of tests/scurve/scurve_batch.c, and the power of the second in the unit of each.
SECONDS = {"s": 0, "v": -1, "a": -2, "s1": 0, "v1": -1, "speed": -1, "acc": -2, "dec": -2}
SECONDS |= {"jerk": -3}
MOVE = np.dtype([(name, float) for name in SECONDS])

LIBRARY = ctypes.CDLL(os.environ.get("SCURVE_BATCH", str(ROOT / "build/lib/scurve_batch.so")))
_MOVES, _DOUBLES = (np.ctypeslib.ndpointer(t, flags="C_CONTIGUOUS") for t in (MOVE, float))
LIBRARY.scurve_batch_totals.argtypes = [ctypes.c_int64, _MOVES, ctypes.c_int, _DOUBLES]
LIBRARY.scurve_batch_positions.argtypes = [ctypes.c_int64, _MOVES, ctypes.c_int64, _DOUBLES]
for each in (LIBRARY.scurve_batch_totals, LIBRARY.scurve_batch_positions):
    each.restype = ctypes.c_int64


def rest_to_rest(count: int, dice: np.random.Generator) -> np.ndarray:
    """Limits and ways of motion controllers, every decade alike, in both directions."""

    def decades(low: float, high: float) -> np.ndarray:
        return 10 ** dice.uniform(np.log10(low), np.log10(high), count)

    m = np.zeros(count, MOVE)
    m["speed"] = decades(1, 1000)
    m["acc"], m["dec"] = decades(10, 20_000), decades(10, 20_000)
    m["jerk"] = decades(1e2, 1e7)
    m["s1"] = decades(1e-3, 2000) * dice.choice([-1, 1], count)
    return m


def to_rest(count: int, dice: np.random.Generator, beyond: float = 0.0) -> np.ndarray:
    """The same from a start in motion, within the limits or `beyond` them by a part of them.

    Within the limits is also the speed that is reached on the acceleration's way to 0.
    """
    m = rest_to_rest(count, dice)
    m["v"] = dice.uniform(-1, 1, count) * m["speed"] * (1 + beyond)
    most = m["speed"] * (1 + 2 * beyond)
    up = np.minimum(m["acc"], np.sqrt(2 * m["jerk"] * (most - m["v"])))
    down = np.minimum(m["dec"], np.sqrt(2 * m["jerk"] * (most + m["v"])))
    m["a"] = dice.uniform(-down, up) * (1 + beyond)
    return m


def to_speed(count: int, dice: np.random.Generator, beyond: float = 0.0) -> np.ndarray:
    """The same to a speed within the limits, forwards or backwards."""
    m = to_rest(count, dice, beyond)
    m["v1"] = dice.uniform(-1, 1, count) * m["speed"]
    return m


def in_unit(moves: np.ndarray, second: float) -> np.ndarray:
    """The same moves with another unit of time [s]."""
    told = moves.copy()
    for name, power in SECONDS.items():
        told[name] *= second**-power
    return told


def scurve_totals(moves: np.ndarray, anywhere: bool = False) -> np.ndarray:
    """Durations by scurve; `anywhere`: to speed v1, not to s1. [s]"""
    total = np.empty(len(moves))
    assert LIBRARY.scurve_batch_totals(len(moves), moves, anywhere, total) == 0
    return total


def scurve_positions(moves: np.ndarray, count: int) -> np.ndarray:
    """Positions by scurve at moments from start to end, a row for each move. [mm]"""
    s = np.empty((len(moves), count))
    assert LIBRARY.scurve_batch_positions(len(moves), moves, count, s) == 0
    return s


def ruckig_input(move: Sequence[float], anywhere: bool = False) -> ruckig.InputParameter:
    """One move as ruckig takes it."""
    s, v, a, s1, v1, speed, acc, dec, jerk = move
    told = ruckig.InputParameter(1)
    if anywhere:
        told.control_interface = ruckig.ControlInterface.Velocity
    told.current_position, told.current_velocity, told.current_acceleration = [s], [v], [a]
    told.target_position, told.target_velocity, told.target_acceleration = [s1], [v1], [0.0]
    told.max_velocity, told.max_jerk = [speed], [jerk]
    told.max_acceleration, told.min_acceleration = [acc], [-dec]
    return told


def ruckig_totals(moves: np.ndarray, anywhere: bool = False) -> np.ndarray:
    """Durations by ruckig, not a number where it fails. [s]"""
    planner, plan = ruckig.Ruckig(1), ruckig.Trajectory(1)

    def total(move: Sequence[float]) -> float:
        try:
            done = planner.calculate(ruckig_input(move, anywhere), plan)
        except ruckig.RuckigError:
            return np.nan
        return plan.duration if done == ruckig.Result.Working else np.nan

    return np.array([total(move) for move in moves.tolist()])


def ruckig_positions(move: Sequence[float], count: int) -> np.ndarray:
    """Positions by ruckig at moments from start to end. [mm]"""
    plan = ruckig.Trajectory(1)
    assert ruckig.Ruckig(1).calculate(ruckig_input(move), plan) == ruckig.Result.Working
    return np.array([plan.at_time(t)[0][0] for t in np.linspace(0, plan.duration, count)])
