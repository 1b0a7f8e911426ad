"""What both interpreters make of a program, in one form, and how they differ."""

import itertools
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from second import Options, Refused, Step, run
from second.nurbs import samples

from motionfmu.analysis.gcode import Program, read

OPTIONS = ("block_delete", "optional_stop", "angles", "feed", "fanuc")
ROUNDING = 1e-9  # [mm] a move that is shorter is none
PLACE, ANGLE, RATIO = 1e-7, 1e-9, 1e-9  # [mm], [rad], of a feed
CURVE = 2e-4  # [mm] commands from a NURBS, 1e-4 by the table of words, and chords of both
TYPES = ("rapid", "line", "arc", "arc", "arc", "arc", "dwell")
OUTPUTS, STOP, CUBIC = 11, 12, 14
# Settings of the C interpreter that hide no fault the other one does not know.
MACHINE: dict[str, Any] = {"max_feed": 1e9, "speed": 1e9, "scale": 1.0}

Event = dict[str, Any]


def mark(commands: NDArray[Any]) -> float:
    """A sum that changes with any end, feed, kind, dwell, speed and line of the commands."""
    lasts = (commands["type"] <= 6) | (commands["type"] >= 13)
    weight = (np.arange(1, len(commands) + 1) % 7 + 1)[:, None] * np.arange(1, 7)
    parts = (commands["end"] * weight)[lasts].sum(), commands["feed"].sum()
    rest = (commands[n].sum() for n in ("dwell", "spindle", "line"))
    return float(sum(parts) + 1e3 * commands["type"].sum() + sum(rest))


AT_FIRST: Event = {"spindle": 0.0, "coolant": 0, "on": 0, "overrides": 0}
AT_FIRST |= {"surface": (0.0, 0.0), "analog": {}}


def settings_of(options: Options) -> dict[str, Any]:
    """The same options for the C interpreter."""
    found = {n: getattr(options, n) for n in OPTIONS}
    found["feed"] *= 60.0  # the second one has mm/s, `read` mm/min
    return MACHINE | found | {"point": list(options.point)}


def first(text: str, options: Options | None = None) -> Program:
    """The program by the C interpreter."""
    options = options or Options()
    lines = (f"T{n} P{n} Z{z} D{d}\n" for n, (z, d) in options.tools.items())
    return read(text, "".join(lines), folder=options.folder, **settings_of(options))


def of_c(program: Program) -> list[Event]:
    """Its commands as events; switches stand in the events behind them."""
    events: list[Event] = []
    state = dict(AT_FIRST)
    for c in program.commands:
        kind = int(c["type"])
        if kind == OUTPUTS:
            state = state | {n: c[n].item() for n in ("spindle", "coolant", "overrides")}
            state["surface"] = (float(c["surface"]), float(c["surface_centre"]))
            state |= _put(state, int(c["set"]), int(c["clear"]), _analog(c))
            continue
        name = "spline" if kind == CUBIC else "stop" if kind == STOP else TYPES[kind]
        name = "tool" if name == "stop" and c["changes"] else name
        event: Event = {"kind": name, "line": int(c["line"])} | state
        if name == "tool":
            event["tool"] = int(c["tool"])
        elif name == "dwell":
            event["dwell"] = float(c["dwell"])
        elif name != "stop":
            if c["length"] < ROUNDING:
                continue
            state = state | _put(state, int(c["set"]), int(c["clear"]), _analog(c))
            event |= state | {"start": c["start"], "end": c["end"], "probes": bool(c["probes"])}
            if name != "rapid":
                event["feed"] = float(c["feed"])
            if name == "arc":
                event |= {"plane": int(c["plane"]), "centre": c["centre"]}
                event["sweep"] = float(c["sweep"])
            if name == "spline":
                event["inner"] = [*c["inner"][0:2], *c["inner"][3:5]]
            event["command"] = c
        events.append(event)
    return [*events, {"kind": "end"} | state]


def of_python(steps: list[Step]) -> list[Event]:
    """Steps of the second interpreter in the same form."""
    events: list[Event] = []
    state = dict(AT_FIRST)
    for s in steps:
        if s.kind == "outputs":
            state = state | {n: getattr(s, n) for n in ("spindle", "coolant", "overrides")}
            state |= _put(state, s.set, s.clear, s.analog) | {"surface": s.surface}
            continue
        event: Event = {"kind": s.kind, "line": s.line} | state
        if s.kind == "tool":
            event["tool"] = s.tool
        elif s.kind == "dwell":
            event["dwell"] = s.dwell
        elif s.kind != "stop":
            state = state | _put(state, s.set, s.clear, s.analog)
            event |= state | {"start": s.start, "end": s.end, "probes": s.probes}
            if s.kind != "rapid":
                event["feed"] = s.feed
            if s.kind == "arc":
                event |= {"plane": s.plane, "centre": s.centre, "sweep": s.sweep}
            if s.kind == "spline":
                event["inner"] = inner(s.control)
            if s.kind == "nurbs":
                event |= {"nurbs": s.nurbs, "order": s.order}
        events.append(event)
    return [*events, {"kind": "end"} | state]


def _put(state: Event, on: int, off: int, analog: dict[int, float]) -> Event:
    """Outputs behind a change of some."""
    return {"on": (state["on"] | on) & ~off, "analog": state["analog"] | analog}


def _analog(c: Any) -> dict[int, float]:
    return {i: float(c["analog"][i]) for i in range(4) if int(c["analog_set"]) >> i & 1}


def inner(control: tuple[tuple[float, float], ...]) -> list[float]:
    """Inner control points of a curve of the third degree, raised to it if it is of the second."""
    start, *middle, end = control
    if len(middle) == 1:
        q = middle[0]
        middle = [tuple(a[i] + 2.0 / 3.0 * (q[i] - a[i]) for i in range(2)) for a in (start, end)]
    return [x for point in middle for x in point]


def _same(name: str, a: Any, b: Any) -> bool:
    if name in ("start", "end", "centre", "inner", "surface"):
        return bool(np.allclose(a, b, rtol=1e-12, atol=PLACE))
    if name == "analog":
        return a.keys() == b.keys() and np.allclose([a[k] for k in a], [b[k] for k in a])
    if name == "sweep":
        return abs(a - b) < ANGLE * max(1.0, abs(a)) + 1e-7
    if isinstance(a, float):
        return math.isclose(a, b, rel_tol=RATIO, abs_tol=1e-12)
    return bool(a == b)


def difference(text: str, options: Options | None = None) -> str:
    """How the two differ in a program, empty if they do not."""
    options = options or Options()
    one = first(text, options)
    steps, refused = run(text, replace(options, tools=dict(options.tools)))
    found = _faults(one, refused)
    a, b = of_c(one), of_python(steps)
    return found or _events(a, b, bool(refused))


def _faults(one: Program, refused: Refused | None) -> str:
    theirs = one.faults[0] if one.faults else None
    if (theirs is None) == (refused is None) and (
        theirs is None or refused is None or theirs.line == refused.line
    ):
        return ""
    return f"C: {theirs}; Python: {refused}"


def _bezier(c: Any) -> NDArray[np.float64]:
    """Points of a command, a line or a cubic curve, 0.025 mm apart. [mm]"""
    a, d = c["start"][:3], c["end"][:3]
    t = np.linspace(0.0, 1.0, 50 + int(40.0 * c["length"]))[:, None]
    if not c["cubic"]:
        return np.asarray(a + t * (d - a))
    p, q, u = c["inner"][:3], c["inner"][3:], 1.0 - t
    return np.asarray(u**3 * a + 3.0 * u * u * t * p + 3.0 * u * t * t * q + t**3 * d)


def _nurbs(pieces: list[Event], whole: Event) -> str:
    """Whether the C interpreter's pieces are a curve, and both have the same beside it."""
    fine = samples(whole["nurbs"], whole["order"], 20_000)
    parts = [_bezier(x["command"]) for x in pieces]
    path = np.vstack([parts[0], *(x[1:] for x in parts[1:])])
    apart = max(_farthest(path, fine), _farthest(fine[::20], path))
    gaps = [b["start"] - a["end"] for a, b in itertools.pairwise(pieces)]
    if apart > CURVE or np.abs(gaps).max(initial=0.0) > PLACE:
        return f"pieces {apart} mm from the curve"
    for x in pieces:
        for name in x.keys() & whole.keys() - {"kind", "line", "start", "end"}:
            if not _same(name, x[name], whole[name]):
                return f"{name} of a piece"
    ends = _same("start", pieces[0]["start"], whole["start"])
    return "" if ends and _same("end", pieces[-1]["end"], whole["end"]) else "ends of a curve"


def _farthest(points: NDArray[np.float64], line: NDArray[np.float64]) -> float:
    """The largest distance of points from a line of chords. [mm]"""
    near = cKDTree(line).query(points)[1]
    least = np.full(len(points), np.inf)
    for begin in (np.maximum(near - 1, 0), np.minimum(near, len(line) - 2)):
        a, chord = line[begin], line[begin + 1] - line[begin]
        square = np.maximum((chord * chord).sum(axis=1), 1e-300)
        share = np.clip(((points - a) * chord).sum(axis=1) / square, 0.0, 1.0)[:, None]
        least = np.minimum(least, np.linalg.norm(points - a - share * chord, axis=1))
    return float(least.max())


def _pieces(a: list[Event], whole: Event) -> list[Event]:
    """Those of a curve at the beginning of what the C interpreter has made."""
    fine = samples(whole["nurbs"], whole["order"], 20_000)
    left = float(np.linalg.norm(np.diff(fine, axis=0), axis=1).sum())
    for i, x in enumerate(a):
        if x["kind"] not in ("line", "spline"):
            return a[:i]
        left -= float(x["command"]["length"])
        if left < 1e-2 and _same("end", x["end"], whole["end"]):
            return a[: i + 1]
    return a


def _events(a: list[Event], b: list[Event], refused: bool = False) -> str:
    """What is held back at a fault, by one of them, is nobody's business."""
    at = 0
    a, b = (a[:-1], b[:-1]) if refused else (a, b)
    for i, y in enumerate(b):
        if at == len(a):
            return "" if refused else f"C has {len(a)} events, Python {len(b)}"
        if y["kind"] == "nurbs":
            pieces = _pieces(a[at:], y)
            why = _nurbs(pieces, y) if pieces else "no pieces"
            if why:
                return f"event {i}: {why}"
            at += len(pieces)
            continue
        x = a[at]
        at += 1
        for name in (x.keys() | y.keys()) - {"command"}:
            if name not in x or name not in y or not _same(name, x[name], y[name]):
                return f"event {i}, {name}:\n  C      {x}\n  Python {y}"
    return "" if at == len(a) or refused else f"C has {len(a)} events, Python {len(b)}"


def programs() -> list[Path]:
    """The corpus."""
    return sorted((Path(__file__).parent / "programs").glob("*.ngc"))
