"""Conversion of an HP-GL file's numbers to positions on the sheet: IP, SC, RO."""

from itertools import accumulate

Place = tuple[float, float]
# Quarter turns counter-clockwise.
_TURNS = {0: (1, 0, 0, 1), 90: (0, -1, 1, 0), 180: (-1, 0, 0, -1), 270: (0, 1, -1, 0)}


class UserUnits:
    """User units: scaled into P1 .. P2, then rotated about the origin of the sheet."""

    def __init__(self, machine: tuple[float, float, float, float] | None) -> None:
        self.machine = machine
        self.reset()

    def reset(self) -> None:
        """As after DF."""
        self.p = self.machine
        self.scaling: list[float] | None = None
        self.turn = _TURNS[0]
        self._map()

    def _map(self) -> str:
        """Set scale and offset of both coordinates; returns a fault."""
        self.sx, self.sy, self.ox, self.oy = 1.0, 1.0, 0.0, 0.0
        s, p = self.scaling, self.p
        if s is not None:
            if p is None:
                return "scale without P1 and P2; set them by IP, or a frame of the machine"
            kind = int(s[4]) if len(s) > 4 else 0
            if kind == 2:
                self.sx, self.sy = s[1], s[3]
                self.ox, self.oy = p[0] - s[0] * s[1], p[1] - s[2] * s[3]
            else:
                wide, high = s[1] - s[0], s[3] - s[2]
                if wide == 0.0 or high == 0.0:
                    return "scale of a range that is empty"
                self.sx, self.sy = (p[2] - p[0]) / wide, (p[3] - p[1]) / high
                left = bottom = 0.0
                if kind == 1:
                    least = min(abs(self.sx), abs(self.sy))
                    x, y = (-least if f < 0.0 else least for f in (self.sx, self.sy))
                    share = s[5:7] if len(s) > 6 else [50.0, 50.0]
                    left = (p[2] - p[0] - x * wide) * share[0] / 100.0
                    bottom = (p[3] - p[1] - y * high) * share[1] / 100.0
                    self.sx, self.sy = x, y
                self.ox = p[0] + left - s[0] * self.sx
                self.oy = p[1] + bottom - s[2] * self.sy
            least, most = sorted((abs(self.sx), abs(self.sy)))
            if not (1e-9 <= least and most <= 1e9):
                return f"scale of {self.sx:g} and {self.sy:g} plotter units"
        self.plain = s is None and self.turn == _TURNS[0]
        self.largest = max(abs(self.sx), abs(self.sy))
        return ""

    def corners(self, numbers: list[float]) -> str:
        """Carry out IP; returns a fault."""
        if len(numbers) == 4:
            self.p = (numbers[0], numbers[1], numbers[2], numbers[3])
        elif len(numbers) == 2 and self.p is not None:
            x, y = numbers
            self.p = (x, y, x + self.p[2] - self.p[0], y + self.p[3] - self.p[1])
        elif len(numbers) == 0:
            self.p = self.machine
        elif len(numbers) == 2:
            return "P1 alone without a P2; set both, or a frame of the machine"
        else:
            return f"{len(numbers)} numbers, 0, 2 or 4 wanted"
        return self._map()

    def scale(self, numbers: list[float]) -> str:
        """Carry out SC; returns a fault."""
        if len(numbers) not in (0, 4, 5, 7):
            return f"{len(numbers)} numbers, 0, 4, 5 or 7 wanted"
        if len(numbers) > 4 and numbers[4] not in (0.0, 1.0, 2.0):
            return f"scale of type {numbers[4]:g}, 0, 1 or 2 wanted"
        self.scaling = numbers or None
        return self._map()

    def rotate(self, numbers: list[float]) -> str:
        """Carry out RO; returns a fault."""
        angle = numbers[0] if numbers else 0.0
        if len(numbers) > 1 or angle not in _TURNS:
            return f"{', '.join(f'{n:g}' for n in numbers)}: 0, 90, 180 or 270 degrees wanted"
        self.turn = _TURNS[int(angle)]
        return self._map()

    def place(self, x: float, y: float) -> Place:
        """Position on the sheet [plotter units] of user units."""
        x, y = self.sx * x + self.ox, self.sy * y + self.oy
        a, b, c, d = self.turn
        return a * x + b * y, c * x + d * y

    def user(self, at: Place) -> Place:
        """User units of a position on the sheet."""
        a, b, c, d = self.turn
        x, y = a * at[0] + c * at[1], b * at[0] + d * at[1]
        return (x - self.ox) / self.sx, (y - self.oy) / self.sy

    def places(
        self, numbers: list[float], relative: bool, at: Place
    ) -> tuple[list[float], list[float]]:
        """Coordinates of the sheet of pairs of numbers, absolute or from place to place."""
        xs, ys = numbers[0::2], numbers[1::2]
        if not self.plain:
            a, b, c, d = self.turn
            ox, oy = (0.0, 0.0) if relative else (self.ox, self.oy)
            us, vs = [self.sx * x + ox for x in xs], [self.sy * y + oy for y in ys]
            xs = [a * u + b * v for u, v in zip(us, vs, strict=True)]
            ys = [c * u + d * v for u, v in zip(us, vs, strict=True)]
        if relative:
            return (
                list(accumulate(xs, initial=at[0]))[1:],
                list(accumulate(ys, initial=at[1]))[1:],
            )
        return xs, ys
