"""Rides along chains of smooth segments, planned by src/motion/smooth/speed_profile."""

import ctypes
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
AXES, POINTS = 6, 6
LINE, ARC, CURVE = range(3)
# struct told, struct sample and struct speed_limits of tests/speed/speed_batch.c.
TOLD = np.dtype(
    [(name, float) for name in ("kind", "feed", "cap", "acc", "dec", "jerk", "length")]
    + [("control", float, (POINTS, AXES))]
)
SAMPLE = np.dtype(
    [(name, float) for name in ("way", "rate", "gain", "twitch")]
    + [(name, float, AXES) for name in ("point", "velocity", "acc", "jerk")]
)
STATE = np.dtype([(name, float, AXES) for name in ("point", "slope", "bend")])
LIMITS = np.dtype([(name, float, AXES) for name in ("speed", "acc", "jerk")])
# struct known and struct speed_node, and a row of speed_batch_boxes.
CELL = np.dtype(
    [(name, float) for name in ("length", "feed", "flat", "most", "top", "planes")]
    + [("plane", float, (11, 2))]
)
NODE = np.dtype([(name, float) for name in ("at", "x", "b")])
BOX = np.dtype([(name, float) for name in ("start", "length", "feed", "most")])

LIBRARY = ctypes.CDLL(os.environ.get("SPEED_BATCH", str(ROOT / "build/lib/speed_batch.so")))
_TOLD, _SAMPLE, _LIMITS, _DOUBLES = (
    np.ctypeslib.ndpointer(t, flags="C_CONTIGUOUS") for t in (TOLD, SAMPLE, LIMITS, float)
)
LIBRARY.speed_batch_segments.argtypes = [ctypes.c_int64, _TOLD]
LIBRARY.speed_batch_ride.argtypes = [
    ctypes.c_int64,
    _LIMITS,
    ctypes.c_int64,
    ctypes.c_double,
    ctypes.c_int64,
    _DOUBLES,
    ctypes.c_int64,
    _SAMPLE,
]
LIBRARY.speed_batch_path.argtypes = [
    ctypes.c_int64,
    ctypes.c_int64,
    _DOUBLES,
    np.ctypeslib.ndpointer(STATE, flags="C_CONTIGUOUS"),
]
LIBRARY.speed_batch_path.restype = None
LIBRARY.speed_batch_go.argtypes = [ctypes.c_int64, ctypes.c_double, ctypes.c_double, _SAMPLE]
for each in ("cells", "nodes", "boxes"):
    getattr(LIBRARY, f"speed_batch_{each}").restype = ctypes.c_int64
for each in ("segments", "ride", "stop_way", "gap", "go"):
    getattr(LIBRARY, f"speed_batch_{each}").restype = ctypes.c_double


@dataclass
class Chain:
    """Segments in a row, each begun where the one before ends with its r, r' and r''."""

    rows: list[np.ndarray] = field(default_factory=list)
    feed: float = 100.0
    acc: float = 1000.0
    dec: float = 1000.0
    jerk: float = 0.0

    def _row(self, kind: int, control: np.ndarray, length: float = 0.0) -> None:
        row = np.zeros(1, TOLD)
        row["kind"], row["feed"], row["cap"] = kind, self.feed, 2 * self.feed
        row["acc"], row["dec"], row["length"] = self.acc, self.dec, length
        row["jerk"] = self.jerk
        row["control"][0, : len(control)] = control
        self.rows.append(row)

    def line(self, start: np.ndarray, end: np.ndarray) -> None:
        """Add a straight line."""
        self._row(LINE, np.array([start, end]))

    def arc(self, start: np.ndarray, end: np.ndarray, centre: np.ndarray, ccw: bool) -> None:
        """Add an arc in X Y."""
        self._row(ARC, np.array([start, end, [*centre, 1.0 if ccw else 0.0, 0, 0, 0]]))

    def curve(self, control: np.ndarray, length: float) -> None:
        """Add a polynomial of degree 5."""
        self._row(CURVE, control, length)

    def told(self) -> np.ndarray:
        """All of them as the library takes them."""
        return np.concatenate(self.rows)


def hermite(start: np.ndarray, end: np.ndarray, length: float) -> np.ndarray:
    """Control points of the quintic from rows r, r', r'' to such rows."""
    p, t, b = start
    q, s, d = end
    h = length / 5
    return np.array(
        [
            p,
            p + h * t,
            p + 2 * h * t + h * h * b * 1.25,
            q - 2 * h * s + h * h * d * 1.25,
            q - h * s,
            q,
        ]
    )


def place(x: float = 0.0, y: float = 0.0) -> np.ndarray:
    """Six coordinates of a point or direction in X Y."""
    return np.array([x, y, 0, 0, 0, 0], float)


def random_chain(dice: np.random.Generator, count: int, size: float, feed: float = 100.0) -> Chain:
    """Lines, arcs and curves of up to `size` [mm], r'' continuous, r' of a curve not quite 1."""
    chain = Chain(feed=feed)
    here = np.array([place(), place(1), place()])
    for _ in range(count):
        kind, length = dice.integers(3), size * dice.uniform(0.05, 1)
        angle = np.arctan2(here[1][1], here[1][0]) + dice.uniform(-1.2, 1.2)
        along, across = place(np.cos(angle), np.sin(angle)), place(-np.sin(angle), np.cos(angle))
        ease = length if kind == CURVE else 0.3 * length
        middle = here[1] + along
        corner = here[0] + ease * middle / np.linalg.norm(middle)
        bend = dice.uniform(-3, 3) / length if kind != LINE else 0.0
        there = np.array([corner, along, bend * across])
        chain.curve(hermite(here, there, ease), ease)
        here = there
        if kind == LINE:
            here = np.array([corner + length * along, along, place()])
            chain.line(corner, here[0])
        elif kind == ARC and abs(bend * length) > 0.1:
            centre, sweep = corner + across / bend, dice.uniform(0.1, 5) * np.sign(bend)
            turn = np.eye(AXES)
            turn[:2, :2] = [[np.cos(sweep), -np.sin(sweep)], [np.sin(sweep), np.cos(sweep)]]
            here = np.array([centre + turn @ (corner - centre), turn @ along, bend * turn @ across])
            chain.arc(corner, here[0], centre[:2], bend > 0)
    return chain


def look(told: np.ndarray, ways: np.ndarray) -> np.ndarray:
    """Points, r' and r'' of the path at rising ways."""
    LIBRARY.speed_batch_segments(len(told), told)
    states = np.zeros(len(ways), STATE)
    LIBRARY.speed_batch_path(len(told), len(ways), np.ascontiguousarray(ways), states)
    return states


def limits(acc: float | np.ndarray = 0.0, speed: float = 0.0, jerk: float = 0.0) -> np.ndarray:
    """Limits of the axes; 0 none, acc 0: the path's ramp."""
    told = np.zeros(1, LIMITS)
    told["acc"], told["speed"], told["jerk"] = acc, speed, jerk
    return told


def planned(told: np.ndarray, bounds: np.ndarray, what: str) -> np.ndarray:
    """Rows of CELL, NODE or BOX ("cells", "nodes", "boxes") of a plan of all segments from rest."""
    LIBRARY.speed_batch_segments(len(told), told)
    rows = np.zeros(2048, {"cells": CELL, "nodes": NODE, "boxes": BOX}[what])
    known = (ctypes.c_int64(len(told)), bounds.ctypes.data_as(ctypes.c_void_p))
    room = (ctypes.c_int64(len(rows)), rows.ctypes.data_as(ctypes.c_void_p))
    if what == "boxes":
        planned(told, bounds, "nodes")
        return rows[: LIBRARY.speed_batch_boxes(*room)]
    plan = LIBRARY.speed_batch_cells if what == "cells" else LIBRARY.speed_batch_nodes
    return rows[: plan(*known, ctypes.c_double(1.0), *room)]


@dataclass
class Ride:
    """Result of a ride: its time [s] and a row for each step."""

    time: float
    steps: np.ndarray
    length: float


@dataclass
class Orders:
    """Settings of a ride: overrides of its steps, of which the last one holds from then on."""

    dt: float = 1e-3
    overrides: Sequence[float] | np.ndarray = (1.0,)
    ahead: int = 100_000
    most: int = 200_000


def ride(told: np.ndarray, bounds: np.ndarray, orders: Orders | None = None) -> Ride:
    """Ride along the segments, so many known ahead, for so many steps at most."""
    o = orders or Orders()
    length = LIBRARY.speed_batch_segments(len(told), told)
    steps = np.zeros(o.most, SAMPLE)
    overrides = np.array(o.overrides, float)
    time = LIBRARY.speed_batch_ride(
        len(told), bounds, o.ahead, o.dt, len(overrides), overrides, o.most, steps
    )
    count = o.most if time < 0 else int(np.ceil(time / o.dt - 1e-9))
    return Ride(time, steps[:count], length)


def random_ride(seed: int, smooth: bool) -> tuple[Ride, np.ndarray, Orders]:
    """Random segments, limits, overrides, holds and look-ahead, and how the ride went."""
    dice = np.random.default_rng(seed)
    count, size = int(dice.integers(1, 14)), float(10 ** dice.uniform(-1, 1.5))
    told = random_chain(dice, count, size, float(10 ** dice.uniform(1, 2.8))).told()
    acc = 10 ** dice.uniform(2, 4) * np.array([1, dice.uniform(0.3, 3), 1, 1, 1, 1])
    bounds = limits(acc, dice.choice([0, 30.0, 100.0]), acc * 10 ** dice.uniform(0.5, 3) * smooth)
    choices = dice.choice([0, 0.05, 0.3, 0.7, 1, 1.5, 2], dice.integers(1, 60))
    overrides = np.append(np.repeat(choices, dice.integers(1, 200)), 1.0)
    ahead, dt = int(dice.choice([0, 1, 3, 1000])), 10 ** dice.uniform(-3.5, -2.3)
    orders = Orders(dt, overrides, ahead, 1_000_000)
    return ride(told, bounds, orders), bounds, orders


def shares(steps: np.ndarray, bounds: np.ndarray, dt: float) -> dict[str, float]:
    """Most of each limit that an axis takes at a sample, and between samples in the mean."""
    found = {}
    for name, quantity, before in (
        ("speed", "velocity", "point"),
        ("acc", "acc", "velocity"),
        ("jerk", "jerk", "acc"),
    ):
        most = bounds[name][0]
        if most.any():
            found[quantity] = float((np.abs(steps[quantity]) / most).max())
            change = np.abs(np.diff(steps[before], axis=0)) / (most * dt)
            found[f"change of {before}"] = float(change.max(initial=0.0))
    return found


def at_rest_at_its_end(done: Ride) -> bool:
    """Check that a ride never goes back or beyond the path, and ends at rest at its end."""
    way = done.steps["way"]
    return (
        done.time > 0
        and abs(way[-1] - done.length) <= 1e-9
        and done.steps["rate"][-1] == 0
        and bool((np.diff(way) >= 0).all())
        and way.max() <= done.length + 1e-9
    )
