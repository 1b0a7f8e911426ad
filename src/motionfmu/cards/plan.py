"""Planning of a job from contours: speed along a smooth path, whole pulses in each DDA period."""

import ctypes
import hashlib
import json
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.binding import Struct, dtype, library
from motionfmu.base.errors import InputError
from motionfmu.cards.config import CardConfig
from motionfmu.drawings import Drawing, DrawingOptions
from motionfmu.drawings.contours import PenContour, contours_of, corners

AXES = 4
PAGE = 256
ROOM = 1 << 15  # most frames of one call
_PAYLOAD, _FRAME = 228, 13  # bytes of a page, of a frame at most
_EVENTS = 11
_MOVE, _DRAW, _STOP = range(3)
# The structs that the planner in C gets.
_SETTINGS = (
    "pulses_per_mm speed acc jerk period_ns tolerance rapid reserve pen pen_axis up down dwell"
).split()
RESTS, SLIDES, DRAWS = 1, 2, 3  # kind of motion of which a frame is part


@dataclass(frozen=True)
class Plan:
    """A job and its planned motion."""

    job: bytes  # The file for the card
    period: float  # [s] of a frame
    places: np.ndarray  # [mm] planned at the end of each frame
    commands: np.ndarray  # [pulses] of each frame
    events: np.ndarray  # 1 lowers, 2 raises a pen by an output, at the begin of the frame; 0 none
    steps: np.ndarray  # 1 a rest while the pen moves, 2 pen up (or the pen's axis moves), 3 drawing
    stops: int  # Rests within contours
    contours: list[PenContour]  # What is drawn, in this order
    seconds: float  # [s] that planning took


def plan(drawing: Drawing, config: CardConfig, options: DrawingOptions | None = None) -> Plan:
    """Plan a drawing for a card."""
    options = options or DrawingOptions()
    if len(config.axes) < 2:
        raise InputError(f"{len(config.axes)} axes in the configuration, X and Y wanted")
    contours = contours_of(drawing, options)
    if not contours:
        raise InputError(drawing.nothing)
    _within(drawing, contours, config, options.offset)
    began = time.perf_counter()
    planner = _planner(config)
    _start(planner, config, origin(drawing, config, options))
    pages: list[bytes] = []
    blocks = list(_run(planner, _vertices(contours, config, options), pages))
    job = _end(planner, pages, drawing.name)
    every = np.concatenate(blocks)
    return Plan(
        job,
        config.motion.period,
        places=every["place"],
        commands=every["command"],
        events=every["event"],
        steps=every["step"],
        stops=planner["stops"],
        contours=contours,
        seconds=time.perf_counter() - began,
    )


def origin(drawing: Drawing, config: CardConfig, options: DrawingOptions) -> bytes:
    """SHA-256 of a drawing and all that its plan depends on: what a job's header has."""
    planner, motion = _planner(config), config.motion
    settings = {name: planner[name] for name in _SETTINGS}
    settings |= {
        "feed": motion.feed,
        "corner": motion.corner_angle,
        "pen_output": motion.pen.output,
    }
    chosen = ", ".join(f"{name}={value!r}" for name, value in _named(drawing, options).items())
    settings |= {
        "pen": [motion.pen.output, motion.pen.up_level],
        "options": f"Options({chosen})",  # this text must not change, or hashes of old jobs would
    }
    told = json.dumps(settings, sort_keys=True, default=lambda row: row.tolist())
    return hashlib.sha256(drawing.text + b"\0" + told.encode()).digest()


def _named(drawing: Drawing, options: DrawingOptions) -> dict[str, Any]:
    """Options by name: those that hashes have always had, and what others say."""
    always = {
        "order": options.order or drawing.order,
        "corners": options.corners or "round",
        "pens": options.pens,
        "speeds": options.speeds,
        "offset": options.offset,
    }
    unused = ("up", "down", "page")
    page = {"page": drawing.page} if drawing.page > 1 else {}
    more = {k: v for k, v in options.changes.items() if k not in {*always, *unused}}
    return always | more | page


def write(job: bytes, file: Path) -> None:
    """Write a job, whole or not at all."""
    if file.is_dir():
        raise InputError(f"cannot write {file}: it is a folder")
    part = file.with_name(f".{file.name}.part")
    try:
        part.write_bytes(job)
        part.replace(file)
    except OSError as error:
        raise InputError(f"cannot write {file}: {error.strerror}") from None


def _within(
    drawing: Drawing, contours: list[PenContour], config: CardConfig, offset: tuple[float, float]
) -> None:
    """Refuse a vertex beyond a limit of its axis."""
    for c in contours:
        for k, axis in enumerate(config.axes[:2]):
            places = c.points[:, k] + offset[k]
            for worst, limit in ((places.min(), axis.minimum), (places.max(), axis.maximum)):
                if not axis.minimum <= worst <= axis.maximum:
                    raise InputError(
                        f"{drawing.where(c.first)}: a line goes to {axis.name} = {worst:.3f} mm, "
                        f"beyond the limit {limit:g} mm"
                    )


def _planner(config: CardConfig) -> Struct:
    """The planner of C with the settings of a card."""
    p, motion, pen = Struct("planner"), config.motion, config.motion.pen
    rows = [(a.pulses_per_mm, a.speed_max, a.acceleration_max, a.jerk_max) for a in config.axes] + [
        (0.0, 1.0, 1.0, 1.0)
    ] * (AXES - len(config.axes))
    for name, values in zip(
        ("pulses_per_mm", "speed", "acc", "jerk"), zip(*rows, strict=True), strict=True
    ):
        p[name] = values
    p["period_ns"] = round(motion.period * 1e9)
    p["tolerance"], p["rapid"], p["reserve"] = motion.tolerance, motion.rapid, motion.reserve
    p["pen"] = int(pen.kind == "axis")
    p["pen_axis"] = "XYZU".index(pen.axis)
    p["up"], p["down"], p["dwell"] = pen.up, pen.down, pen.dwell
    scales = [round(row[0] * 1000) for row in rows]
    p["axes"], p["pulses_per_m"] = (1 << len(config.axes)) - 1, scales
    p["events"] = p["rest"] = 2 if pen.kind == "output" else 0
    for name, k in (("speed_max", 1), ("acc_max", 2)):
        p[name] = [min(2**32 - 1, round(row[k] * row[0])) for row in rows]
    return p


def _start(p: Struct, config: CardConfig, origin: bytes) -> None:
    pen, axes = config.motion.pen, config.axes
    jerks = [round(a.jerk_max * a.pulses_per_mm) for a in axes] + [0] * (AXES - len(axes))
    pins, levels = np.zeros(_EVENTS, np.uint16), np.zeros(_EVENTS, np.uint8)
    if pen.kind == "output":
        pins[:2] = 1 << pen.output
        levels[:2] = [pen.up_level != "high", pen.up_level == "high"]
    library().binding_plan_start(
        p.pointer,
        origin,
        *(_pointer(x) for x in (np.array(jerks, np.uint64), pins, levels)),
    )


def _pointer(array: np.ndarray) -> ctypes.c_void_p:
    return array.ctypes.data_as(ctypes.c_void_p)


def _vertices(
    contours: list[PenContour], config: CardConfig, options: DrawingOptions
) -> np.ndarray:
    """Moves and lines of all contours."""
    motion, kind = config.motion, dtype("plan_vertex")
    counts = [max(len(c.points), 2) for c in contours]
    v = np.zeros(sum(counts), kind)
    at = 0
    for c, n in zip(contours, counts, strict=True):
        part = v[at : at + n]
        at += n
        part["point"] = c.points + np.array(options.offset)
        slower = options.speeds and c.speed > 0.0
        part["feed"] = min(motion.feed, c.speed) if slower else motion.feed
        part["kind"] = _DRAW
        part["kind"][0] = _MOVE
        if options.corners == "stop":
            sharp = corners(c.points, motion.corner_angle)
            part["kind"][: len(sharp)][sharp] = _STOP
    return v


def _run(p: Struct, vertices: np.ndarray, pages: list[bytes]) -> Iterator[np.ndarray]:
    """Blocks of frames; appends the pages that are full."""
    run = library().binding_plan_run
    run.restype = ctypes.c_int64
    kind = dtype("plan_frame")
    page = np.zeros((ROOM * _FRAME // (_PAYLOAD - _FRAME) + 2) * PAGE, np.uint8)
    done = (ctypes.c_int64 * 2)()
    at, made = 0, 1
    while made > 0:
        frames = np.zeros(ROOM, kind)
        rest = vertices[at:]
        count = (ctypes.c_int64 * 3)(len(rest), ROOM, 1)
        made = run(p.pointer, _pointer(rest), count, _pointer(frames), _pointer(page), done)
        at += done[0]
        pages.append(page[: done[1] * PAGE].tobytes())
        yield frames[:made]


def _end(p: Struct, pages: list[bytes], name: str) -> bytes:
    last, header = ctypes.create_string_buffer(PAGE), ctypes.create_string_buffer(PAGE)
    end = library().binding_plan_end
    end.restype = ctypes.c_char_p
    if wrong := end(p.pointer, last, header):
        raise InputError(f"{name}: {wrong.decode()}")
    return header.raw + b"".join(pages) + last.raw
