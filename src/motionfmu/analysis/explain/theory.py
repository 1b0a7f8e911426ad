"""Predictions of theory for each cause, from the geometry and the parameters of a run."""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from motionfmu.analysis.contour import analyse
from motionfmu.analysis.contour.circles import SPEED_SPAN
from motionfmu.analysis.contour.geometry import Arc, LineSegment, Segment
from motionfmu.analysis.explain import cause_switches, servo_formulas
from motionfmu.analysis.explain.servo_formulas import Array, ServoAxis

if TYPE_CHECKING:
    from motionfmu.analysis.contour import ContourResult
    from motionfmu.analysis.contour.kinds import Corner
    from motionfmu.run import Result

# Number of points of a segment at which an error of geometry is computed.
PLACES = 361
# A corner below this part of the feed is one at which the command stops.
SLOW = 0.05
# A command that stays at a corner for so many servo lags lets the tool come there: exp(-3) of the
# distance is left.
RESTS = 3.0
BLENDED = "blended"
# Causes whose formula asks for the position gain.
BY_GAIN = ("servo", "chord", "mismatch", "friction")


@dataclass(frozen=True)
class Theory:
    """The prediction of a formula."""

    # largest contour error by the cause [mm]; None without a formula for this geometry
    value: float | None
    formula: str  # the formula, and what it leaves out


NONE = Theory(None, "")


@dataclass(frozen=True)
class CornerRow:
    """A corner: its error in the run beside that of a servo alone."""

    lines: tuple[int, int]  # of the program, before and behind
    # "sharp" at a feed; "stop" for an instant; "rest" until the tool has come; or "blended": the
    # pulses do not come to the corner
    kind: str
    angle: float  # change of direction [rad]
    speed: float  # of the command at the corner; the feed of a blended one [mm/s]
    error: float  # of the run [mm]
    ideal: float  # with all causes but path and servo lag switched off [mm]
    # of first-order axes with the mean gain [mm]; None where a move is too short for its ramps
    theory: float | None


def corner_rows(
    result: "Result", ideal: "ContourResult", book: "RunTheory"
) -> tuple[CornerRow, ...]:
    """All corners of a run, beside those without all causes."""
    rows = []
    for own, other in zip(result.contour().corners, ideal.corners, strict=False):
        lines = (own.line_before, own.line_after)
        kind, speed, said = book.corner(other)
        rows.append(CornerRow(lines, kind, own.angle, speed, own.error, other.error, said))
    return tuple(rows)


class RunTheory:
    """The formulas of theory, applied to one run.

    The run without any cause, `ideal`, gives the corners, and the position gain if no FMU has it.
    """

    def __init__(self, result: "Result", ideal: "ContourResult") -> None:
        self.contour = result.contour()
        self.ideal = ideal  # where the command shows its corners best
        self.told = cause_switches.quantities(result)
        self.used = [i for i in cause_switches.used(result) if i < 3]
        self.measured_gain = not (self.told.get("gain", np.zeros(6))[self.used] > 0.0).all()
        if self.measured_gain:
            lag = max(ideal.lag, 1e-6)
            names = ("gain", "period", "delay", "lag")
            self.told |= {n: np.full(6, 1.0 / lag if n == "gain" else 0.0) for n in names}
        self.axes = {i: ServoAxis.of(self.told, i) for i in self.used}
        self.mean_gain = float(np.mean([a.gain for a in self.axes.values()]))
        self.moves = [
            (s, self._speed(s)) for s in self.contour.run.path.segments if s.label.kind != "ptp"
        ]

    def of(self, name: str) -> Theory:
        """What theory says of a cause, named as in causes.toml, or of ``servo``."""
        method = getattr(self, f"_{name}", None)
        found = NONE if method is None or not self.moves else method()
        assert isinstance(found, Theory)
        if self.measured_gain and found.value and name in BY_GAIN:
            return replace(found, formula=found.formula + "; Kp measured in the run")
        return found

    def corner(self, corner: "Corner") -> tuple[str, float, float | None]:
        """Kind of a corner as in `CornerRow`, its speed [mm/s], and the error that a servo
        makes of it [mm], None where a move is too short for its ramps.
        """
        run = self.ideal.run
        both = (corner.line_before, corner.line_after)
        short = min((s.length for s, _ in self.moves if s.label.line in both), default=0.0)
        feed = next((v for s, v in self.moves if s.label.line == corner.line_after), 0.0)
        times = [float(self._told(n)[0]) for n in ("acc_time", "dec_time")]
        acceleration = feed / max(*times, 1e-6) if min(times) > 0.0 else 0.0
        near = np.abs(run.time - corner.time) <= self.ideal.window + max(times)
        gap = np.linalg.norm(run.commanded[near, :3] - np.array(corner.point), axis=1)
        reach = 2.0 * math.sqrt(2.0) * float(self._told("pulse").max()) + feed * run.dda_time
        rests = float(np.sum(gap <= reach)) * float(np.median(np.diff(run.time)))
        if rests > RESTS * self.contour.lag + math.sqrt(8.0 * reach / max(acceleration, 1.0)):
            return "rest", 0.0, 0.0
        if gap.min() > reach and acceleration > 0.0:
            if short < 0.5 * feed * sum(times):
                return BLENDED, feed, None
            said = servo_formulas.blended_corner(feed, corner.angle, self.mean_gain, acceleration)
            return BLENDED, feed, said
        # The least speed is a mean over a span; this one is that of a stop for an instant.
        speed = max(0.0, corner.speed - 0.25 * acceleration * SPEED_SPAN)
        if speed < SLOW * feed:
            speed = 0.0
        said = servo_formulas.corner(speed, corner.angle, self.mean_gain, acceleration)
        return ("sharp" if speed else "stop"), speed, said

    def _path(self) -> Theory:
        blended = [c for c in map(self.corner, self.ideal.corners) if c[0] == BLENDED]
        if not blended:
            return Theory(0.0, "no blended corners")
        time = float(self._told("acc_time")[0])
        text = "blended corner: sin(θ) a T²/8, T the time of the ramp"
        angles = [c.angle for c in self.ideal.corners if self.corner(c)[0] == BLENDED]
        pairs = zip(blended, angles, strict=True)
        return Theory(max(abs(math.sin(a)) * b[1] * time / 8.0 for b, a in pairs), text)

    def _speed(self, segment: Segment) -> float:
        """Largest speed the library commands on a segment [mm/s]."""
        run = self.contour.run
        own = run.command == segment.label.command
        if run.feed is None or not own.any():
            return segment.label.feed
        return float(run.feed[own].max())

    def _told(self, name: str) -> Array:
        return self.told.get(name, np.zeros(6))

    def _arcs(self) -> list[tuple[Arc, float]]:
        return [(s, v) for s, v in self.moves if isinstance(s, Arc) and v > 0.0]

    def _plane(self, arc: Arc) -> tuple[int, int] | None:
        """Axes of the main plane an arc lies in, right-handed."""
        normal = int(np.argmax(np.abs(arc.axis)))
        pair = ((normal + 1) % 3, (normal + 2) % 3)
        flat = abs(abs(float(arc.axis[normal])) - 1.0) < 1e-6
        return pair if flat and all(i in self.axes for i in pair) else None

    def _servo(self) -> Theory:
        found = [0.0]
        for arc, speed in self._arcs():
            if pair := self._plane(arc):
                mean = self._mean_axis(pair)
                change = servo_formulas.radius_change(arc.radius, mean.response(speed / arc.radius))
                found.append(abs(change))
        sharp = (self.corner(c) for c in self.ideal.corners)
        found += [said for kind, _, said in sharp if kind != BLENDED and said is not None]
        text = "circles R(|H| - 1), about V²/(2 Kp² R); corners sin(θ) V/(e Kp), from rest"
        text += " 0.27 sin(θ) a/Kp²; lines 0"
        if any(kind == BLENDED for kind, _, _ in map(self.corner, self.ideal.corners)):
            return Theory(None, "blended corners: only together with the path, see the corners")
        return Theory(max(found), text)

    def _mean_axis(self, pair: tuple[int, int]) -> ServoAxis:
        a, b = (self.axes[i] for i in pair)
        names = ServoAxis.__dataclass_fields__
        return ServoAxis(**{n: 0.5 * (getattr(a, n) + getattr(b, n)) for n in names})

    def _chord(self) -> Theory:
        found = []
        for arc, speed in self._arcs():
            if pair := self._plane(arc):
                time = self.contour.run.dda_time
                sag = servo_formulas.chord(arc.radius, speed, time)
                found.append(servo_formulas.chord_behind_servo(sag, time, self._mean_axis(pair)))
        if not found:
            return Theory(0.0, "lines have no chords")
        return Theory(max(found), "chord V²T²/(8R): two thirds, and the ripple the servo lets by")

    def _quantisation(self) -> Theory:
        pulse, count = (float(self._told(n)[self.used].max()) for n in ("pulse", "count"))
        if pulse <= 0.0:
            return NONE
        text = "at most: √½ pulse, and an encoder count on either axis"
        return Theory(math.sqrt(0.5) * pulse + math.sqrt(2.0) * count, text)

    def _mismatch(self) -> Theory:
        found = []
        for segment, speed in self.moves:
            if isinstance(segment, LineSegment):
                found.append(self._line_mismatch(segment, speed))
            elif isinstance(segment, Arc) and speed > 0.0 and (pair := self._plane(segment)):
                own = (self.axes[i].response(speed / segment.radius) for i in pair)
                large, small = servo_formulas.ellipse(segment.radius, tuple(own))  # type: ignore[arg-type]
                mean = self._mean_axis(pair).response(speed / segment.radius)
                middle = segment.radius * abs(mean)
                found.append(max(large - middle, middle - small))
        if not found:
            return NONE
        text = "line V sin a cos a (1/Kx - 1/Ky); circle: ellipse of both responses at V/R"
        return Theory(max(found), text)

    def _line_mismatch(self, line: LineSegment, speed: float) -> float:
        way = line.end - line.start
        size = float(np.linalg.norm(way))
        if size == 0.0:
            return 0.0
        unit = way / size
        lags = np.zeros(3)
        for i, axis in self.axes.items():
            lags[i] = unit[i] / axis.gain  # delays and inner lags do not change a steady lag
        return speed * float(np.linalg.norm(lags - (lags @ unit) * unit))

    def _friction(self) -> Theory:
        peaks = [
            servo_formulas.reversal(self.axes[i])[1] + float(self._told("windup")[i])
            for arc, _ in self._arcs()
            for i in self._plane(arc) or ()
        ]
        if not peaks:
            return NONE
        integral = any(a.velocity_time > 0.0 for a in self.axes.values())
        text = "reversal 2 Fc/(Kp Kv), half to each side, and the wind-up of the screw"
        if integral:
            text = "step of 2 Fc on the loop with integral, and the wind-up of the screw"
        return Theory(max(peaks), text)

    def _backlash(self) -> Theory:
        pairs = [(arc, self._plane(arc)) for arc, _ in self._arcs()]
        widths = [(float(self._told("backlash")[i]), arc) for arc, p in pairs for i in p or ()]
        if not widths:
            return NONE
        width, arc = max(widths, key=lambda w: w[0])
        angle = math.degrees(servo_formulas.lost_motion_arc(arc.radius, width))
        text = f"half the backlash to each side; table at rest for acos(1 - B/R) = {angle:.2f}°"
        return Theory(0.5 * width, text)

    def _scale(self) -> Theory:
        largest = 0.0
        slope, wave, period = (self._told(n)[:3] for n in ("slope", "wave", "wave_period"))
        for segment, _ in self.moves:
            along = np.linspace(0.0, segment.length, PLACES)
            point, way = segment.at(along), segment.tangent(along)
            turn = np.divide(point, period, out=np.zeros_like(point), where=period > 0.0)
            error = slope * point + wave * np.sin(2.0 * math.pi * turn)
            across = error - np.sum(error * way, axis=1)[:, None] * way
            largest = max(largest, float(np.linalg.norm(across, axis=1).max()))
        return Theory(largest, "lead error across the path: slope times position, and the wave")

    def _torque(self) -> Theory:
        """A reduced model follows the commands of the run, once limited and once not."""
        needed = ("inertia", "velocity_gain", "travel", "torque_limit")
        if self.measured_gain or not all(self._told(n)[self.used].all() for n in needed):
            return NONE
        run = self.contour.run
        free, bound = run.actual.copy(), run.actual.copy()
        for i, axis in self.axes.items():
            limit = float(self._told("torque_limit")[i])
            free[:, i] = servo_formulas.limited(run.commanded[:, i], run.time, axis, math.inf)
            bound[:, i] = servo_formulas.limited(run.commanded[:, i], run.time, axis, limit)
        errors = [analyse(replace(run, actual=x)).error.max for x in (bound, free)]
        text = "rigid axes without delays: J dv/dt + friction = PI torque within the limit"
        return Theory(errors[0] - errors[1], text)
