"""Where the pen of a plotter stands behind a label of HP-GL, whose letters are not drawn."""

import math
from dataclasses import dataclass

Vector = tuple[float, float]
Corners = tuple[float, float, float, float]  # P1 and P2 [plotter units]
A4: Corners = (250.0, 596.0, 10250.0, 7796.0)  # of a plotter that nobody has told others
CENTIMETRE = 400.0  # [plotter units]
WIDTH, HEIGHT = 0.19, 0.27  # [cm] of a capital letter on A4
_SHARES = 0.75, 1.5  # [%] of P1 .. P2, of SR without numbers
# A letter's cell: so many widths to the next letter, so many heights to the next line.
_SPACE, _LINE = 1.5, 2.0
_TAB = 8  # cells from one tab stop to the next, beginning at the carriage return point
# Paths of letters: right, down, left, up, and the label origins whose labels go on where one ends.
_PATHS = ((1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 1.0))
_GOES_ON = (
    {1, 2, 3, 11, 12, 13, 21},
    {3, 6, 9, 13, 16, 19},
    {7, 8, 9, 17, 18, 19},
    {1, 4, 7, 11, 14, 17, 21},
)
_ORIGINS = {*range(1, 10), *range(11, 20), 21}


@dataclass
class Lettering:
    """Size, direction and spacing of letters, as after DF."""

    size: Vector = (WIDTH, HEIGHT)  # [cm], or [%] of P1 .. P2
    by_corners: bool = False  # size is that of SR
    direction: Vector = (1.0, 0.0)  # run and rise
    slope: bool = False  # direction is that of DR, [%] of P1 .. P2
    extra: Vector = (0.0, 0.0)  # shares of a cell that ES adds to spaces and lines
    path: int = 0  # DV: 0 right, 1 down, 2 left, 3 up
    line_back: bool = False  # a line feed of DV goes the other way
    origin: int = 1  # LO

    # CCN 18: an instruction after the other, each with what it refuses.
    def set(self, pair: str, numbers: list[float]) -> str:
        """Carry out SI SR DI DR ES DV LO; returns a fault."""
        least, most = _COUNTS[pair]
        if len(numbers) and not least <= len(numbers) <= most:
            wanted = f"{least}" if least == most else f"{least} to {most}"
            return f"{len(numbers)} numbers, 0 or {wanted} wanted"
        if pair in ("SI", "SR"):
            self.by_corners = pair == "SR"
            default = _SHARES if self.by_corners else (WIDTH, HEIGHT)
            self.size = (numbers[0], numbers[1]) if numbers else default
        elif pair in ("DI", "DR"):
            self.slope = pair == "DR"
            self.direction = (numbers[0], numbers[1]) if numbers else (1.0, 0.0)
            if self.direction == (0.0, 0.0):
                return "0, 0 is no direction"
        elif pair == "ES":
            self.extra = (
                (numbers[0], numbers[1] if len(numbers) > 1 else 0.0) if numbers else (0, 0)
            )
        elif pair == "DV":
            path, back = ([*numbers, 0.0, 0.0])[:2]
            if path not in (0, 1, 2, 3) or back not in (0, 1):
                return f"{path:g}, {back:g}: a path 0 to 3 and 0 or 1 wanted"
            self.path, self.line_back = int(path), bool(back)
        else:
            origin = numbers[0] if numbers else 1
            if origin not in _ORIGINS:
                return f"{origin:g}: 1 to 9, 11 to 19 or 21 wanted"
            self.origin = int(origin)
        return ""

    @property
    def goes_on(self) -> bool:
        """Whether the pen stays behind a label; else it is where it was before."""
        return self.origin in _GOES_ON[self.path]

    def cell(self, corners: Corners) -> Vector:
        """Width and height of a cell [plotter units]."""
        if self.by_corners:
            wide, high = corners[2] - corners[0], corners[3] - corners[1]
            width, height = self.size[0] * wide / 100.0, self.size[1] * high / 100.0
        else:
            width, height = (CENTIMETRE * x for x in self.size)
        return _SPACE * width * (1.0 + self.extra[0]), _LINE * height * (1.0 + self.extra[1])

    def along(self, corners: Corners) -> Vector:
        """Unit vector of the direction, on the sheet before RO."""
        run, rise = self.direction
        if self.slope:
            run, rise = run * (corners[2] - corners[0]), rise * (corners[3] - corners[1])
        length = math.hypot(run, rise)
        return run / length, rise / length


def behind(text: bytes, lettering: Lettering, offset: Vector) -> Vector:
    """Cells right and up of the carriage return point behind a text that begins at an offset."""
    step = _PATHS[lettering.path]
    line = (step[1], -step[0])  # a quarter turn clockwise
    if lettering.line_back:
        line = (-line[0], -line[1])
    x, y = offset
    for c in text:
        way = x * step[0] + y * step[1]  # along the path, from the carriage return point on
        if c >= 32:
            n = 1.0
        elif c == 8:
            n = -1.0
        elif c == 9:
            n = (math.floor(way / _TAB + 1e-9) + 1) * _TAB - way
        elif c == 13:
            n = -way
        else:
            if c == 10:
                x, y = x + line[0], y + line[1]
            continue
        x, y = x + n * step[0], y + n * step[1]
    return x, y


_COUNTS = {"SI": (2, 2), "SR": (2, 2), "DI": (2, 2), "DR": (2, 2), "ES": (1, 2), "DV": (1, 2)}
_COUNTS |= {"LO": (1, 1)}
PAIRS = tuple(_COUNTS)
