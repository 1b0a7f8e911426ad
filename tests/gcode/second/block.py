"""One line executed, in the order of RS-274."""

import math

from second.arcs import arc_of, splines
from second.cutter import begin, finish
from second.cycles import Cycle
from second.frames import end_point, here, machine, origin, plane_axes, program
from second.machine import FEED, SPEED, outputs, probe, saving, switches, wait
from second.moves import straight
from second.nurbs import nurbs
from second.offsets import change, predefined
from second.parameters import Wrong
from second.state import AXES, State, Step
from second.words import Words

PROBES = (382, 383, 384, 385)
CYCLES = (730, 740, 810, 820, 830, 840, 850, 860, 870, 880, 890)
TAKES_AXES = (100, 280, 300, 520, 920)
DAY = 86400.0


def _feed(s: State, w: Words) -> None:
    """F; with G93 each motion but rapids needs its own."""
    if "feed" in w.code and w.code["feed"] != s.feed_mode:
        s.feed_mode = w.code["feed"]
        s.feed = 0.0
    f = w.one("f")
    if f is None:
        return
    if f <= 0.0:
        raise Wrong("feed")
    s.feed = f if s.feed_mode == 930 else f * s.unit
    s.feed /= 60.0 if s.feed_mode != 950 else 1.0


def _tool(s: State, w: Words) -> None:
    if w.has("t"):
        s.selected = w.whole("t", 0, 99999)
        if s.options.closed and s.selected and s.selected not in s.options.tools:
            raise Wrong("no such tool")
        s.chosen = True
    if w.code.get("change") == 61:
        s.tool = w.whole("q", 0, 99999)
    if w.code.get("change") == 6:
        if not s.chosen:
            raise Wrong("M6 without T")
        s.chosen = False
        s.tool, s.turning = s.selected, 0
        outputs(s)
        if s.options.stops:
            step = Step("tool", s.line, tuple(s.point), tuple(s.point))
            step.tool = s.tool
            s.steps.append(step)


def _modes(s: State, w: Words) -> None:
    c = w.code
    if "plane" in c:
        s.plane = {170: 2, 180: 1, 190: 0}[c["plane"]]
    if "cutter" in c:
        _cutter(s, w)
    if c.get("path") == 640:
        w.use("pq")
    if "distance" in c:
        s.incremental = c["distance"] == 910
    if "centre" in c:
        s.absolute_centre = c["centre"] == 901
    if "return" in c:
        s.old_plane = c["return"] == 980


def _cutter(s: State, w: Words) -> None:
    code = w.code["cutter"]
    if code == 400:
        finish(s)
        return
    if code in (411, 421):
        diameter = w.one("d")
        if diameter is None:
            raise Wrong("G41.1 without D")
        begin(s, 1 if code == 411 else -1, diameter * s.unit)
        return
    number = w.whole("d", 0, 99999) if w.has("d") else 0
    number = number or (s.tool if not w.has("d") else 0)
    if number and number not in s.options.tools and s.options.closed:
        raise Wrong("tool")
    begin(s, 1 if code == 410 else -1, s.options.tools.get(number, (0.0, 0.0))[1])


GSYSTEMS = (540, 550, 560, 570, 580, 590, 591, 592, 593)


def _length(s: State, w: Words) -> None:
    code = w.code["length"]
    if code == 430:
        h = w.whole("h", 0, 99999) if w.has("h") else 0
        number = h or s.tool
        if number and number not in s.options.tools and s.options.closed:
            raise Wrong("tool")
        s.length = [0.0, 0.0, s.options.tools.get(number, (0.0, 0.0))[0], 0.0, 0.0, 0.0]
    elif code == 490:
        s.length = [0.0] * AXES
    else:
        for i, letter in enumerate(w.axes):
            if (value := w.one(letter)) is not None:
                s.length[i] = value * s.unit + (s.length[i] if code == 432 else 0.0)


def _polar(s: State, on: bool) -> None:
    """G16 begins with the point where the tool is."""
    s.polar = on
    a, b = plane_axes(s.plane)
    now = program(s, here(s))
    s.pole = (0.0, 0.0)
    s.polar_radius = math.hypot(now[a], now[b])
    s.polar_angle = math.degrees(math.atan2(now[b], now[a]))


def _dwell(s: State, w: Words) -> None:
    letter = "p" if w.has("p") or not s.options.fanuc else "x" if w.has("x") else "u"
    seconds = w.one(letter)
    if seconds is not None and s.options.fanuc and letter in w.whole_numbers:
        seconds /= 1000.0
    if seconds is None or not 0.0 <= seconds <= DAY:
        raise Wrong("dwell")
    step = Step("dwell", s.line, tuple(s.point), tuple(s.point))
    step.dwell = seconds
    s.steps.append(step)


def _tap(s: State, w: Words) -> None:
    """G33.1: K a turn to the point, back with the spindle the other way, I times as fast."""
    turn, faster = w.one("k"), w.one("i")
    if turn is None or turn <= 0.0 or (faster is not None and faster <= 0.0):
        raise Wrong("K or I of G33.1")
    if s.rpm == 0.0 or s.by_radius or s.edge or not w.has(w.axes + "@^"):
        raise Wrong("G33.1 without spindle or axes")
    begin, mode = list(s.point), (s.feed_mode, s.feed)
    turning, speed, overrides = s.turning, s.speed, s.overrides
    end = machine(s, end_point(s, w))
    s.feed_mode, s.feed = 940, turn * s.unit * speed / 60.0
    s.overrides |= FEED | SPEED
    outputs(s)
    straight(s, end, False)
    s.turning, s.speed = -turning, speed * max(1.0, faster or 1.0)
    s.feed *= s.speed / speed
    outputs(s)
    straight(s, begin, False)
    s.turning, s.speed, s.overrides = turning, speed, overrides
    outputs(s)
    s.feed_mode, s.feed = mode


def _move(s: State, w: Words) -> None:
    """The motion in force, if the line has words for it."""
    axes = w.has(w.axes + "@^")
    now = "motion" in w.code
    if now:
        s.motion = w.code["motion"] if w.code["motion"] != 800 else -1
    if s.motion not in CYCLES:
        s.old_level = None
    if now or s.motion not in CYCLES:
        keep = s.sticky if now and s.motion == s.sticky.get("code") else {}
        s.sticky = keep | {"code": s.motion} if s.motion in CYCLES else {}
    free = w.code.get("other") == 530
    if free:
        if s.motion not in (0, 10) or not axes:
            raise Wrong("G53")
        end = list(origin(s, w))
        for i, letter in enumerate(w.axes):
            if (value := w.one(letter)) is not None:
                end[i] = value * (1.0 if letter in "abc" else s.unit)
        straight(s, end, s.motion == 0)
        return
    if s.motion != 50:
        s.spline = None
    held = bool(s.nurbs) and (axes or any(c in w.rest() for c in "ijkrp"))
    if s.motion == 53 or held or (s.motion == 52 and (now or axes or "p" in w.rest())):
        nurbs(s, w)
    elif s.motion in PROBES:
        probe(s, w)
    elif s.motion == 331:
        if now or axes or w.has("ik"):
            _tap(s, w)
    elif s.motion in CYCLES:
        if axes or now:
            if not axes:
                raise Wrong("cycle without axes")
            Cycle(s, w, outputs).run()
    elif s.motion in (20, 30):
        if now or axes or any(c in w.rest() for c in "ijkr"):
            arc_of(s, w)
    elif s.motion in (50, 51):
        if now or axes:
            splines(s, w)
    elif s.motion in (0, 10):
        if axes:
            if s.motion == 10 and s.feed_mode == 930 and not w.has("f"):
                raise Wrong("G93 without F")
            straight(s, machine(s, end_point(s, w)), s.motion == 0)
    elif axes:
        raise Wrong("no motion in force")


def _stop(s: State, w: Words) -> None:
    stop = w.code.get("stop")
    if stop in (0, 60) or (stop == 1 and s.options.optional_stop):
        s.steps.append(Step("stop", s.line, tuple(s.point), tuple(s.point)))
    if stop in (2, 30):
        if s.nurbs:
            raise Wrong("no G5.3 before the end")
        finish(s)
        on = s.rpm != 0.0 or s.coolant or s.overrides
        s.turning = s.coolant = s.overrides = 0
        s.by_radius = False
        if on:
            outputs(s)
        s.ended = True


def _frame(s: State, w: Words) -> None:
    """Units, system and length of the tool."""
    if "units" in w.code:
        s.inch = w.code["units"] == 200
    if "system" in w.code:
        if w.code["system"] in GSYSTEMS:
            s.system = GSYSTEMS.index(w.code["system"])
        else:
            s.system = 8 + w.whole("p", 1, 99)
    if "length" in w.code:
        _length(s, w)


def execute(s: State, w: Words) -> None:
    """Everything that a line says, but calls."""
    if "units" in w.code:
        s.inch = w.code["units"] == 200
    other = w.code.get("other")
    beside = (0, 10, 800) if other in (280, 300) else (800,)  # G28 of posts with G0 or G1
    if other in TAKES_AXES and w.code.get("motion", 800) not in beside and w.has(w.axes):
        raise Wrong("two codes that take axis words")
    if "user" in w.code:
        w.use("pq")
    _feed(s, w)
    if w.code.get("io") == 66:
        wait(s, w)
    _tool(s, w)
    _frame(s, w)
    switches(s, w)
    if "saving" in w.code:
        saving(s, w.code["saving"])
        _frame(s, w)
    if other == 40:
        _dwell(s, w)
    _modes(s, w)
    if other in (100, 520, 920, 921, 922, 923) or "scale" in w.code or "turn" in w.code:
        change(s, w)
    if "polar" in w.code:
        _polar(s, w.code["polar"] == 160)
    if s.nurbs and other in (280, 300):
        raise Wrong("not between G5.2 and G5.3")
    if other in (280, 281, 300, 301):
        predefined(s, w)
    made = len(s.steps)
    if other == 40 and not w.has("p"):
        pass  # X or U of a Fanuc, which are its time
    elif other not in TAKES_AXES and not ("scale" in w.code or "turn" in w.code):
        if w.code.get("length") not in (431, 432):
            _move(s, w)
    elif "motion" in w.code:
        s.motion = w.code["motion"] if w.code["motion"] != 800 else -1
    if "exact" in w.code and len(s.steps) > made and s.motion not in CYCLES and not s.nurbs:
        s.steps.append(Step("dwell", s.line, tuple(s.point), tuple(s.point)))
    if w.rest():
        raise Wrong(f"words without use: {sorted(w.rest())}")
    _stop(s, w)
