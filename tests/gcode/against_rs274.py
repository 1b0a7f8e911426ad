"""Part programs by this interpreter and by LinuxCNC's rs274, where that is installed, compared.

python tests/gcode/against_rs274.py --count 2000 [FILE ...]

Compared are ways, feeds, turns of the spindle, coolant, dwells and stops. rs274 prints four
decimals, it knows X Y Z A B C; programs with splines, rigid taps or a probe are
not compared, for it does not print where those lead.
"""

import argparse
import math
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import numpy as np
from random_lines import TOOLS
from random_programs import FLOW, Writer

from motionfmu.analysis.gcode import Program, read

INCH = 25.4  # [mm]; rs274 without a machine counts in inches
PARTS = (
    *("line", "line", "line", "feed", "arc", "radius", "circle", "modes", "dwell", "switch"),
    *("digital", "stop", "offsets", "home", "wrong", "more_offsets", "tool", "inverse", "analog"),
    *("overrides", "contour", "corners", *("series",) * 5),
    *(part for part in FLOW if part not in ("read_back", "macro", "further")),
)
PLACE = 5e-3  # [mm] of four decimals in inches, and sums of some
SHORT = 2.37e-2  # [mm] no motion; no number that a program has
RATIO = 1e-3  # of a feed; G93 makes one of a length
CALL = re.compile(r"\s*\d+ \S+\s+(\w+)\((.*)\)$")
# rs274 leaves corners below 0.05 rad as they are; a radius of 5 mm then makes so much. [mm]
CORNER, CORNER_ANGLE, CORNER_WAY = 0.13, 0.052, 0.2613
TIMEOUT = 60.0  # [s]
_FLAT = ((1, 2), (2, 0), (0, 1))  # axes of a plane by its normal

Event = dict[str, Any]


class Canon:
    """What rs274 prints, as events in machine coordinates [mm]."""

    def __init__(self, point: tuple[float, ...] = (0.0,) * 6) -> None:
        self.unit = 1.0
        self.system, self.shift, self.length = (np.zeros(6) for _ in range(3))
        self.turn = 0.0
        self.at = np.array(point)
        self.plane = 2
        self.now: Event = {"spindle": 0.0, "coolant": 0}
        self.feed, self.speed, self.turning = 0.0, 0.0, 0  # [mm/s], [rpm], 1 clockwise
        self.events: list[Event] = []

    def place(self, values: list[float]) -> np.ndarray:
        """Program coordinates to those of the machine."""
        p = np.array(values)
        p[:3] *= self.unit
        p += self.shift
        a = math.radians(self.turn)
        x, y = p[:2]
        p[0], p[1] = math.cos(a) * x - math.sin(a) * y, math.sin(a) * x + math.cos(a) * y
        return p + self.system + self.length

    def scaled(self, values: list[float]) -> np.ndarray:
        return np.array(values[:6]) * np.array([self.unit] * 3 + [1.0] * 3)

    def add(self, kind: str, **more: Any) -> None:
        self.now["spindle"] = self.turning * self.speed
        self.events.append({"kind": kind} | self.now | more)

    def to(self, kind: str, end: np.ndarray, **more: Any) -> None:
        if kind != "rapid":
            more["feed"] = self.feed
        self.add(kind, start=self.at, end=end, **more)
        self.at = end

    def arc(self, v: list[float]) -> None:
        normal = self.plane
        first, second = _FLAT[normal]
        flat = [0.0] * 6
        flat[3:] = v[6:9]
        flat[first], flat[second], flat[normal] = v[0], v[1], v[5]
        end = self.place(flat)
        flat[first], flat[second] = v[2], v[3]
        centre = self.place(flat)[[first, second]]
        u, w = self.at[[first, second]] - centre, end[[first, second]] - centre
        turns = int(v[4])
        sweep = math.atan2(u[0] * w[1] - u[1] * w[0], u @ w)  # of the shorter way
        sweep = (abs(sweep) if abs(abs(sweep) - math.tau) < 1e-9 else sweep) % math.tau
        if abs(w - u).max() < 5e-5 * self.unit:  # printed the same
            sweep = math.tau if turns > 0 else 0.0
        sweep += math.tau * (turns - 1 if turns > 0 else turns)
        self.to("arc", end, centre=centre, sweep=sweep, plane=normal)

    def call(self, name: str, v: list[float], text: str) -> None:
        """One line of the output."""
        match name:
            case "USE_LENGTH_UNITS":
                self.unit = INCH if "INCH" in text else 1.0
            case "SET_G5X_OFFSET":
                self.system = self.scaled(v[1:])
            case "SET_G92_OFFSET":
                self.shift = self.scaled(v)
            case "USE_TOOL_LENGTH_OFFSET":
                self.length = self.scaled(v)
            case "SET_XY_ROTATION":
                self.turn = v[0]
            case "SELECT_PLANE":
                self.plane = {"XY": 2, "XZ": 1, "YZ": 0}[text[-2:]]
            case "STRAIGHT_TRAVERSE":
                self.to("rapid", self.place(v))
            case "STRAIGHT_FEED":
                self.to("line", self.place(v))
            case "ARC_FEED":
                self.arc(v)
            case "NURBS_FEED" | "NURBS_G5_FEED" | "STRAIGHT_PROBE" | "RIGID_TAP":
                raise NotImplementedError(name)
            case "SET_FEED_RATE":
                self.feed = v[0] * self.unit / 60.0
            case "SET_SPINDLE_SPEED":
                self.speed = v[1]
            case "START_SPINDLE_CLOCKWISE" | "START_SPINDLE_COUNTERCLOCKWISE":
                self.turning = -1 if "COUNTER" in name else 1
            case "STOP_SPINDLE_TURNING" | "ORIENT_SPINDLE":
                self.turning = 0
            case "MIST_ON" | "FLOOD_ON":
                self.now["coolant"] |= 1 if name == "MIST_ON" else 2
            case "MIST_OFF" | "FLOOD_OFF":
                self.now["coolant"] &= ~(1 if name == "MIST_OFF" else 2)
            case "DWELL":
                self.add("dwell", dwell=v[0])
            case "PROGRAM_STOP" | "OPTIONAL_PROGRAM_STOP":
                self.add("stop")
            case "CHANGE_TOOL":
                self.add("tool")


def _numbers(text: str) -> list[float]:
    found = []
    for word in text.replace(",", " ").split():
        try:
            found.append(float(word))
        except ValueError:
            break
    return found


def there(text: str, folder: Path, options: tuple[str, ...] = ()) -> tuple[list[Event], str]:
    """Events by rs274 and its message, empty if it accepts the program."""
    (folder / "part.ngc").write_text(text)
    rows = (f"T{n} P{n} Z{z / INCH:.12f} D{d / INCH:.12f}\n" for n, (z, d) in TOOLS.items())
    (folder / "tools.tbl").write_text("".join(rows))
    (folder / "rs274.var").unlink(missing_ok=True)
    done = subprocess.run(
        ["rs274", *options, "-t", "tools.tbl", "-v", "rs274.var", "-g", "part.ngc"],
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=TIMEOUT,
        check=False,
    )
    canon = Canon()
    for line in done.stdout.splitlines():
        if match := CALL.match(line):
            canon.call(match[1], _numbers(match[2]), match[2])
    why = [s for s in done.stderr.splitlines() if s != "executing" and "variable file" not in s]
    return canon.events, "" if done.returncode == 0 else " | ".join(why[:2]) or "refused"


def here(program: Program) -> list[Event]:
    """Events of the C interpreter in the same form."""
    kinds = {4: "arc", 5: "arc", 2: "arc", 3: "arc", 0: "rapid", 1: "line", 13: "rapid"}
    events: list[Event] = []
    now: Event = {"spindle": 0.0, "coolant": 0}
    for c in program.commands:
        kind = int(c["type"])
        if kind == 11:
            now = {"spindle": float(c["spindle"]), "coolant": int(c["coolant"])}
        elif kind == 6:
            events.append({"kind": "dwell", "dwell": float(c["dwell"])} | now)
        elif kind == 12:
            events.append({"kind": "tool" if c["changes"] else "stop"} | now)
        elif kind == 14:
            raise NotImplementedError("spline")
        else:
            event = {"kind": kinds[kind], "start": c["start"], "end": c["end"]} | now
            event["line"] = int(c["line"])
            if kinds[kind] != "rapid":
                event["feed"] = float(c["feed"])
            if kinds[kind] == "arc":
                event |= {"centre": c["centre"], "sweep": float(c["sweep"])}
                event["plane"] = int(c["plane"])
            events.append(event)
    return events


def _radius(e: Event) -> float:
    return float(np.hypot(*(e["end"][list(_FLAT[e["plane"]])] - e["centre"])))


def _corner(e: Event) -> bool:
    """The arc about a small corner of a contour."""
    return abs(e["sweep"]) < CORNER_ANGLE and abs(e["sweep"]) * _radius(e) < CORNER_WAY


def _worth(events: list[Event], contour: bool) -> list[Event]:
    """Without motions too short to be seen and dwells of nothing."""
    kept, at = [], np.zeros(6)
    for e in events:
        if contour and e["kind"] == "arc" and _corner(e):
            continue
        if "end" in e and e["kind"] != "arc":
            if abs(e["end"] - at).max() < (CORNER_WAY if contour else SHORT):
                continue
            at = e["end"]
        elif "end" in e:
            at = e["end"]
        if e["kind"] != "dwell" or e["dwell"] > 0.0:
            kept.append(e)
    return kept


def _same(name: str, a: Any, b: Any, size: float, contour: bool) -> bool:
    if name in ("end", "centre"):
        place = CORNER if contour and name == "end" else PLACE
        return bool(abs(np.asarray(a) - np.asarray(b)).max() < place * size)
    if name in ("feed", "dwell", "spindle"):
        return math.isclose(a, b, rel_tol=RATIO, abs_tol=2e-4)
    if name == "sweep":
        return abs(a - b) < 0.02 * size
    return name in ("start", "line") or bool(a == b)


def differs(a: list[Event], b: list[Event], whole: bool, contour: bool) -> str:
    """The first event in which two ways differ, empty if none; `contour`: beside one."""
    one, other = _worth(a, contour), _worth(b, contour)
    for i, (x, y) in enumerate(zip(one, other, strict=False)):
        # A centre far away is known as well as the chord's direction is.
        away = max(1.0, abs(x.get("centre", np.zeros(2))).max() / 50.0)
        turned = away  # the sweep of a small arc is known less well
        if x["kind"] == y["kind"] == "arc":
            turned = max(away, 50.0 * PLACE / max(_radius(x), PLACE))
        for name in x.keys() & y.keys():
            size = away if name == "centre" else turned if name == "sweep" else 1.0
            if not _same(name, x[name], y[name], size, contour):
                return f"event {i}, {name}:\n  here  {x}\n  there {y}"
        if x["kind"] != y["kind"]:
            return f"event {i}:\n  here  {x}\n  there {y}"
    if whole and len(one) != len(other):
        rest = one[len(other) :] or other[len(one) :]
        return f"{len(one)} events here, {len(other)} there; first of the rest {rest[0]}"
    return ""


def compare(text: str, folder: Path, **settings: Any) -> tuple[str, str]:
    """How a program fares: one word, and what there is to say about it."""
    tools = "".join(f"T{n} P{n} Z{z} D{d}\n" for n, (z, d) in TOOLS.items())
    program = read(text, tools, **({"max_feed": 1e9, "speed": 1e9, "scale": 1.0} | settings))
    try:
        theirs, why = there(text, folder)
        ours = here(program)
    except NotImplementedError as error:
        return "not compared", str(error)
    contour = re.search(r"[gG]4[12]", text) is not None
    if program.faults and why:
        return "refused by both", f"{program.faults[0]} | {why}"
    if program.faults or why:
        who = "refused here" if program.faults else "refused there"
        found = differs(ours, theirs, False, contour) if program.faults else ""
        return who, f"{program.faults[0] if program.faults else why}{found and chr(10) + found}"
    found = differs(ours, theirs, True, contour)
    return ("differs", found) if found else ("same", "")


def programs(count: int, start: int, parts: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Names and texts of random programs, the same for the same numbers."""
    for seed in range(start, start + count):
        yield f"seed {seed}", Writer(seed, parts or PARTS, plain=True).program()


def main() -> int:
    """Compare as many random programs as asked, or files."""
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("files", nargs="*", type=Path)
    p.add_argument("--count", type=int, default=200)
    p.add_argument("--start", type=int, default=0)
    p.add_argument("--parts", default="", help="only these, with commas between")
    p.add_argument("--all", action="store_true", help="tell what is refused by both, too")
    a = p.parse_args()
    if not shutil.which("rs274"):
        print("rs274 is not installed (apt-get install linuxcnc-uspace); nothing was compared")
        return 2
    parts = tuple(a.parts.split(",")) if a.parts else ()
    texts = ((str(f), f.read_text(errors="replace")) for f in a.files)
    found: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        for name, text in texts if a.files else programs(a.count, a.start, parts):
            how, what = compare(text, Path(folder), angles=bool(a.files))
            found[how] += 1
            if how not in ("same", "refused by both", "not compared") or a.all:
                print(f"{name}: {how}: {what}")
    print(dict(found))
    return bool(found["differs"])


if __name__ == "__main__":
    sys.exit(main())
