"""A plotter that works through the instructions of an HP-GL file."""

import math
from dataclasses import dataclass

import numpy as np

from motionfmu.drawings.drawing import Polyline
from motionfmu.drawings.pen_path import CHORD, PenPath
from motionfmu.drawings.plt_frame import UserUnits
from motionfmu.drawings.plt_labels import A4, PAIRS, Lettering, behind
from motionfmu.drawings.plt_scan import Scanner

UNIT = 0.025  # [mm] of a plotter unit
VERTICES_MAX = 5_000_000  # of a file
_CHORDS_MAX = 3600  # of one arc
_BEZIER_MAX = 1000
_DEGREE = math.pi / 180.0


@dataclass
class _PenStroke:
    """A line that is being drawn: its points [plotter units], its bytes in the file."""

    down: bool
    xs: list[float]
    ys: list[float]
    first: int


class Plotter:
    """The state of a plotter while it works through a file."""

    def __init__(
        self, scan: Scanner, frame: tuple[float, float, float, float] | None, fills: bool
    ) -> None:
        self.scan, self.fills = scan, fills
        self.frame = UserUnits(frame)
        self.pages: list[list[Polyline]] = [[]]  # moves and lines of each
        self.count = 0
        self.pen, self.down, self.relative = 1, False, False
        self.at = (0.0, 0.0)  # [plotter units] on the sheet
        self.deviation = False  # CT1: chords by their distance from the arc
        self.speeds: dict[int, float] = {}
        self.window: tuple[float, float, float, float] | None = None
        self.stroke: _PenStroke | None = None
        self.polygon: list[list[tuple[float, float, bool]]] | None = None  # under way
        self.kept: list[list[tuple[float, float, bool]]] = []  # the latest whole one
        self.lettering = Lettering()
        self.carriage = (0.0, 0.0)  # [plotter units] where the carriage returns to
        self.behind_label = False  # the pen has come there by letters alone, and the move to it
        self.entry: tuple[tuple[float, float], bool] = ((0.0, 0.0), False)

    def run(self) -> None:
        """Work through the whole file."""
        for pair, numbers in self.scan.pairs():
            if (do := _DO.get(pair)) is not None:
                do(self, numbers)
            elif pair == "PE":
                self._encoded()
            elif pair in PAIRS:
                self._told(self.lettering.set(pair, numbers))
                if pair in _RETURNS_HERE:
                    self.carriage = self.at
            elif pair == "LB":
                self.scan.skip(pair)
                self._letters(pair, [])
            elif pair == "CP":
                if len(numbers) not in (0, 2):
                    self.scan.refuse(f"{len(numbers)} numbers, 0 or 2 wanted")
                self._letters(pair, numbers)
            elif pair in _FILLS:
                self._fill(pair, numbers)
            elif pair in _NEXT_PAGE:
                self._next_page()
            else:
                self.scan.skip(pair)
        self._next_page()
        if len(self.pages) > 1:
            self.pages.pop()

    def _next_page(self) -> None:
        """Take a new sheet if something is drawn on this one."""
        self._flush()
        if any(line.down for line in self.pages[-1]):
            self.pages.append([])

    # Lines

    def _flush(self) -> None:
        """End the line that is being drawn."""
        if (s := self.stroke) is None:
            return
        points = np.stack([np.array(s.xs), np.array(s.ys)], axis=1) * UNIT
        speed = self.speeds.get(self.pen, self.speeds.get(0, 0.0))
        path = PenPath.lines(points, s.first)
        self.pages[-1].append(Polyline(self.pen, s.down, path, s.first, speed))
        if self.window is not None and s.down:
            low, high = points.min(axis=0) / UNIT, points.max(axis=0) / UNIT
            w = self.window
            if low[0] < w[0] or low[1] < w[1] or high[0] > w[2] or high[1] > w[3]:
                self.scan.refuse("a line leaves the window of IW; lines are not clipped", s.first)
        self.stroke = None

    def _move(self, xs: list[float], ys: list[float], down: bool) -> None:
        """Go through places of the sheet."""
        self.count += len(xs)
        if self.count > VERTICES_MAX:
            self.scan.refuse(f"more than {VERTICES_MAX} vertices")
        if self.polygon is not None:
            self.polygon[-1] += [(x, y, down) for x, y in zip(xs, ys, strict=True)]
        else:
            down = down and self.pen != 0
            if self.behind_label and not down and self.stroke is not None:
                self.stroke.xs.pop()  # on the way to elsewhere it need not be passed
                self.stroke.ys.pop()
            if self.stroke is None or self.stroke.down != down:
                self._flush()
                self.stroke = _PenStroke(down, [self.at[0]], [self.at[1]], self.scan.first)
                self.count += 1
            self.stroke.xs.extend(xs)
            self.stroke.ys.extend(ys)
        self.at = self.carriage = (xs[-1], ys[-1])
        self.behind_label = False

    def _letters(self, pair: str, numbers: list[float]) -> None:
        """LB, CP: the pen goes to where the next letter would be; nothing is drawn."""
        letters, corners = self.lettering, self.frame.p or A4
        if self.polygon is not None or (pair == "LB" and not letters.goes_on):
            return
        (wide, high), (ax, ay) = letters.cell(corners), letters.along(corners)
        if wide == 0.0 or high == 0.0:
            return
        a, b, c, d = self.frame.turn
        across = wide * (a * ax + b * ay), wide * (c * ax + d * ay)
        up = high * (-a * ay + b * ax), high * (-c * ay + d * ax)
        carriage, (dx, dy) = self.carriage, np.subtract(self.at, self.carriage)
        x = (dx * across[0] + dy * across[1]) / wide**2
        y = (dx * up[0] + dy * up[1]) / high**2
        if pair == "CP" and numbers:
            x, y = x + numbers[0], y + numbers[1]
        else:
            x, y = behind(self.scan.label if pair == "LB" else b"\r\n", letters, (x, y))
        at = (
            carriage[0] + x * across[0] + y * up[0],
            carriage[1] + x * across[1] + y * up[1],
        )
        if at != self.at:
            self._move([at[0]], [at[1]], False)
            self.behind_label = True
        self.carriage = carriage
        if pair == "CP" and numbers and numbers[1]:  # its line is that of the carriage now
            self.carriage = carriage[0] + y * up[0], carriage[1] + y * up[1]

    def _coordinates(self, numbers: list[float]) -> None:
        """PU PD PA PR with a list."""
        if not numbers:
            return
        if len(numbers) % 2:
            self.scan.refuse(f"{len(numbers)} coordinates, an even number wanted")
        self._move(*self.frame.places(numbers, self.relative, self.at), self.down)

    def _pen_up(self, numbers: list[float]) -> None:
        self.down = False
        self._coordinates(numbers)

    def _pen_down(self, numbers: list[float]) -> None:
        self.down = True
        self._coordinates(numbers)
        if not numbers and self.polygon is None:  # a dot, or the begin of a line
            self._move([self.at[0]], [self.at[1]], True)

    def _plot_absolute(self, numbers: list[float]) -> None:
        self.relative = False
        self._coordinates(numbers)

    def _plot_relative(self, numbers: list[float]) -> None:
        self.relative = True
        self._coordinates(numbers)

    # Curves, in user units

    def _chords(self, radius: float, sweep: float, chord: float | None) -> int:
        """Chords of an arc of a radius [user units] and angle [deg]."""
        if chord is not None and not self.deviation:
            step = min(max(abs(chord), 0.1), 180.0)
        else:
            far = CHORD / UNIT / self.frame.largest if chord is None else abs(chord)
            share = min(1.0, far / radius) if radius > 0.0 else 1.0
            step = 2.0 * math.acos(1.0 - share) / _DEGREE if share > 1e-12 else 0.0
        if step * _CHORDS_MAX <= abs(sweep):
            return _CHORDS_MAX
        return max(1, math.ceil(abs(sweep) / step * (1.0 - 1e-9)))

    def _arc(self, centre: tuple[float, float], sweep: float, chord: float | None) -> list[float]:
        """Coordinates along an arc that begins at the pen, end included."""
        if abs(sweep) > 360.0:
            self.scan.refuse(f"an arc of {sweep:g} degrees, at most 360 wanted")
        x, y = self.frame.user(self.at)
        dx, dy = x - centre[0], y - centre[1]
        n = self._chords(math.hypot(dx, dy), sweep, chord)
        found = []
        for k in range(1, n + 1):
            c, s = math.cos(sweep * _DEGREE * k / n), math.sin(sweep * _DEGREE * k / n)
            found += [centre[0] + c * dx - s * dy, centre[1] + s * dx + c * dy]
        if abs(sweep) == 360.0:
            found[-2:] = [x, y]
        return found

    def _draw(self, numbers: list[float], down: bool) -> None:
        self._move(*self.frame.places(numbers, False, self.at), down)

    def _arc_absolute(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 3, 4)
        chord = numbers[3] if len(numbers) > 3 else None
        self._draw(self._arc((numbers[0], numbers[1]), numbers[2], chord), self.down)

    def _arc_relative(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 3, 4)
        x, y = self.frame.user(self.at)
        self._arc_absolute([x + numbers[0], y + numbers[1], *numbers[2:]])

    def _three_points(self, numbers: list[float]) -> None:
        """AT: arc through a place to another."""
        self.scan.wants(numbers, 4, 5)
        (x, y), (ix, iy, ex, ey) = self.frame.user(self.at), numbers[:4]
        bx, by, cx, cy = ix - x, iy - y, ex - x, ey - y
        if cx == cy == 0.0:  # a circle whose diameter ends at the place between
            bx, by = bx / 2.0, by / 2.0
            sweep = 360.0
        else:
            cross = 2.0 * (bx * cy - by * cx)
            if abs(cross) <= 1e-9 * (bx * bx + by * by + cx * cx + cy * cy):
                self._draw([ix, iy, ex, ey], self.down)
                return
            b, c = bx * bx + by * by, cx * cx + cy * cy
            bx, by = (cy * b - by * c) / cross, (bx * c - cx * b) / cross
            turn = math.atan2(cy - by, cx - bx) - math.atan2(-by, -bx)
            sweep = turn / _DEGREE % 360.0 - (0.0 if cross > 0.0 else 360.0)
        if bx == by == 0.0:
            self._draw([ix, iy, ex, ey], self.down)
            return
        chord = numbers[4] if len(numbers) > 4 else None
        points = self._arc((x + bx, y + by), sweep, chord)
        self._draw([*points[:-2], ex, ey], self.down)

    def _three_points_relative(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 4, 5)
        x, y = self.frame.user(self.at)
        ix, iy, ex, ey = numbers[:4]
        self._three_points([x + ix, y + iy, x + ex, y + ey, *numbers[4:]])

    def _around(self, corners: list[float], start: list[float]) -> None:
        """Draw a closed line from a start, pen down, and come back to where the pen was."""
        at, (x, y) = self.at, self.frame.user(self.at)
        if start != [x, y]:
            self._draw(start, False)
        self._draw(corners, True)
        if self.at != at:
            self._move([at[0]], [at[1]], False)

    def _circle(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 1, 2)
        at, (x, y) = self.at, self.frame.user(self.at)
        start = [x + numbers[0], y]
        self.at = self.frame.place(*start)
        points = self._arc((x, y), 360.0, numbers[1] if len(numbers) > 1 else None)
        self.at = at
        self._around(points, start)

    def _edge_rectangle(self, numbers: list[float]) -> None:
        self._around(*self._rectangle(numbers))

    def _edge_rectangle_relative(self, numbers: list[float]) -> None:
        self._around(*self._rectangle_relative(numbers))

    def _edge_wedge(self, numbers: list[float]) -> None:
        self._around(*self._wedge(numbers))

    # Corners and start of closed lines, which become the polygon that EP edges

    def _rectangle(self, numbers: list[float]) -> tuple[list[float], list[float]]:
        self.scan.wants(numbers, 2, 2)
        (x, y), (ex, ey) = self.frame.user(self.at), numbers
        return self._keep([ex, y, ex, ey, x, ey, x, y], [x, y])

    def _rectangle_relative(self, numbers: list[float]) -> tuple[list[float], list[float]]:
        self.scan.wants(numbers, 2, 2)
        x, y = self.frame.user(self.at)
        return self._rectangle([x + numbers[0], y + numbers[1]])

    def _wedge(self, numbers: list[float]) -> tuple[list[float], list[float]]:
        self.scan.wants(numbers, 3, 4)
        at, (x, y) = self.at, self.frame.user(self.at)
        radius, start = numbers[0], numbers[1] * _DEGREE
        first = [x + radius * math.cos(start), y + radius * math.sin(start)]
        self.at = self.frame.place(*first)
        points = self._arc((x, y), numbers[2], numbers[3] if len(numbers) > 3 else None)
        self.at = at
        return self._keep([*first, *points, x, y], [x, y])

    def _keep(self, corners: list[float], start: list[float]) -> tuple[list[float], list[float]]:
        if self.polygon is None:
            places = zip(*self.frame.places([*start, *corners], False, self.at), strict=True)
            self.kept = [[(x, y, k > 0) for k, (x, y) in enumerate(places)]]
        return corners, start

    def _bezier(self, numbers: list[float]) -> None:
        """BZ: curves by three control points each."""
        self._curves(numbers, False)

    def _bezier_relative(self, numbers: list[float]) -> None:
        self._curves(numbers, True)

    def _curves(self, numbers: list[float], relative: bool) -> None:
        if not numbers or len(numbers) % 6:
            self.scan.refuse(f"{len(numbers)} numbers, a multiple of 6 wanted")
        x, y = self.frame.user(self.at)
        found: list[float] = []
        for k in range(0, len(numbers), 6):
            corner = np.array([0.0, 0.0, *numbers[k : k + 6]]).reshape(4, 2)
            corner = np.add(corner, (x, y)) if relative else np.vstack([(x, y), corner[1:]])
            bend = 6.0 * np.linalg.norm(np.diff(corner, 2, axis=0), axis=1).max()
            far = CHORD / UNIT / self.frame.largest
            n = min(_BEZIER_MAX, max(1, math.ceil(math.sqrt(bend / 8.0 / far))))
            t = np.arange(1, n + 1)[:, None] / n
            parts = [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3]
            found += (np.hstack(parts) @ corner).ravel().tolist()
            x, y = corner[3].tolist()
        self._draw(found, self.down)

    # Polygons: parts, each a closed chain of places and whether the pen is down on the way there

    def _polygon_mode(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 0, 1)
        mode = int(numbers[0]) if numbers else 0
        if mode == 0:
            self._flush()
            self.entry = (self.at, self.down)
            self.polygon = [[(*self.at, False)]]
        elif self.polygon is None:
            self.scan.refuse("polygon mode has not begun")
        elif mode in (1, 2):
            part = self.polygon[-1]
            if part and part[-1][:2] != part[0][:2]:
                part.append((*part[0][:2], self.down))
            self.polygon.append([])
            if mode == 2:
                self.kept, self.polygon = self.polygon, None
                self.at, self.down = self.entry
        else:
            self.scan.refuse(f"{numbers[0]:g}: 0, 1 or 2 wanted")

    def _edge_polygon(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 0, 0)
        if self.polygon is not None:
            self.scan.refuse("within polygon mode")
        at = self.at
        for part in self.kept:
            for k, (x, y, down) in enumerate(part):
                self._move([x], [y], down and k > 0)
        if self.at != at:
            self._move([at[0]], [at[1]], False)

    def _fill(self, pair: str, numbers: list[float]) -> None:
        if not self.fills:
            self.scan.refuse("filled areas are not drawn")
        if (area := _FILLS[pair]) is not None:
            area(self, numbers)
        self.scan.skip(pair)

    # Mapping and tools

    def _initialize(self, numbers: list[float]) -> None:
        self._defaults(numbers)
        self.down, self.at, self.carriage = False, (0.0, 0.0), (0.0, 0.0)
        self.behind_label = False

    def _defaults(self, numbers: list[float]) -> None:
        self._flush()
        self.scan.wants(numbers, 0, 0)
        self.frame.reset()
        self.lettering = Lettering()
        self.relative, self.deviation, self.window = False, False, None
        self.polygon, self.kept = None, []
        self.scan.terminator = b"\x03"

    def _corners(self, numbers: list[float]) -> None:
        self._told(self.frame.corners(numbers))

    def _scale(self, numbers: list[float]) -> None:
        self._told(self.frame.scale(numbers))

    def _rotate(self, numbers: list[float]) -> None:
        self._told(self.frame.rotate(numbers))

    def _told(self, wrong: str) -> None:
        if wrong:
            self.scan.refuse(wrong)

    def _input_window(self, numbers: list[float]) -> None:
        self._flush()
        self.window = None
        if numbers:
            self.scan.wants(numbers, 4, 4)
            xs, ys = self.frame.places(numbers, False, self.at)
            self.window = (min(xs), min(ys), max(xs), max(ys))

    def _chord_mode(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 0, 1)
        self.deviation = bool(numbers and numbers[0])

    def _select_pen(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 0, 1)
        pen = int(numbers[0]) if numbers else 0
        if pen < 0 or pen > 255:
            self.scan.refuse(f"pen {pen}, 0 to 255 wanted")
        if pen != self.pen:
            self._flush()
        self.pen = pen

    def _velocity(self, numbers: list[float]) -> None:
        self.scan.wants(numbers, 0, 2)
        self._flush()
        pen = int(numbers[1]) if len(numbers) > 1 else 0
        if not numbers:
            self.speeds.clear()
        elif numbers[0] <= 0.0:
            self.scan.refuse(f"{numbers[0]:g} cm/s, above 0 wanted")
        else:
            self.speeds[pen] = 10.0 * numbers[0]

    def _encoded(self) -> None:
        """PE: each pair by itself, relative but behind an equals sign."""
        down = True
        for what, numbers in self.scan.encoded(_DO):
            if what == ":":
                self._select_pen(numbers)
                continue
            down = "<" not in what
            self._move(*self.frame.places(numbers, "=" not in what, self.at), down)
            self.down = down


# Of the pairs that say how letters are, those that set the carriage return point.
_RETURNS_HERE = ("DI", "DR", "DV", "LO")
_NEXT_PAGE = ("PG", "AF", "AH", "FR", "BP")
_FILLS = {
    "FP": None,
    "RA": Plotter._rectangle,
    "RR": Plotter._rectangle_relative,
    "WG": Plotter._wedge,
}
_DO = {
    "PU": Plotter._pen_up,
    "PD": Plotter._pen_down,
    "PA": Plotter._plot_absolute,
    "PR": Plotter._plot_relative,
    "AA": Plotter._arc_absolute,
    "AR": Plotter._arc_relative,
    "AT": Plotter._three_points,
    "RT": Plotter._three_points_relative,
    "BZ": Plotter._bezier,
    "BR": Plotter._bezier_relative,
    "CI": Plotter._circle,
    "EA": Plotter._edge_rectangle,
    "ER": Plotter._edge_rectangle_relative,
    "EW": Plotter._edge_wedge,
    "PM": Plotter._polygon_mode,
    "EP": Plotter._edge_polygon,
    "IN": Plotter._initialize,
    "DF": Plotter._defaults,
    "IP": Plotter._corners,
    "SC": Plotter._scale,
    "RO": Plotter._rotate,
    "IW": Plotter._input_window,
    "CT": Plotter._chord_mode,
    "SP": Plotter._select_pen,
    "VS": Plotter._velocity,
}
