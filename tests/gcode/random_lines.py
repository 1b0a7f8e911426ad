"""Random lines of part programs: motions, modes, switches, cycles."""

import math

from random_values import Values

TOOLS = {1: (10.5, 6.0), 2: (21.25, 8.0), 3: (0.0, 10.0), 17: (33.125, 3.0)}
WRONG = (
    *(
        "G1 X",
        "G1 X1 X2",
        "G0 G1 X1",
        "Q5",
        "G4",
        "G2 X1 Y1",
        "G999",
        "M99999",
        "G1 X1 R2",
        "X1..2",
    ),
    *("G1 (open", "G1 Y#", "#1=", "G1 X[1+]", "G1 X[1/0]", "#0=1", "G1 X#<unknown>", "o1 nothing"),
)


class Lines(Values):
    """Writes lines; each method one thing that a program may do."""

    def __init__(self, seed: int, expressions: bool, plain: bool = False) -> None:
        super().__init__(seed, expressions)
        self.plain = plain  # only what rs274 knows as well
        self.lines: list[str] = []
        self.straight = False  # G0 or G1 is in force, as far as is known

    def one(self, parts: tuple[str, ...]) -> None:
        """Any of these."""
        getattr(self, self.r.choice(parts))()

    def write(self, text: str) -> None:
        """One line, with blanks, small letters, a number or a comment in places."""
        r = self.r
        if text[:1] in "GoOM":
            self.straight = text.startswith(("G0 ", "G1 "))
        if r.random() < 0.1 and text[:1] not in "oO%#":
            text = f"N{r.randint(1, 9999)} {text}"
        if r.random() < 0.05:
            text = text.lower()
        if r.random() < 0.05 and text[:1] not in "oO":
            text += r.choice((" (a comment)", " ; a comment", " (one) (two)"))
        if r.random() < 0.02 and text[:1] not in "oO":
            text = text.replace(" ", "")
        self.lines.append(text if len(text) < 240 else "G4 P0")  # a line has its limit

    def axes(self, letters: str = "XYZ", share: float = 0.6) -> str:
        chosen = [c for c in letters if self.r.random() < share] or [letters[0]]
        return " ".join(c + self.value() for c in chosen)

    def line(self) -> None:
        self.write(
            self.r.choice(("G0 ", "G1 ", "G1 ", "" if self.straight else "G1 ")) + self.axes()
        )

    def far(self) -> None:
        self.write(f"G1 {self.axes('XYZ' if self.plain else 'XYZUVW', 0.3)}")

    def feed(self) -> None:
        self.write(f"F{self.value(10.0, 3000.0)}")

    def arc(self) -> None:
        """Centre form: in increments, whose end is the start turned about the centre."""
        r = self.r
        plane = r.choice((0, 1, 2))
        first, second = ("XY", "ZX", "YZ")[plane]
        radius, begin = r.uniform(0.5, 30.0), r.uniform(0.0, math.tau)
        turn = r.uniform(0.1, 6.1)
        ccw = r.random() < 0.5
        end = begin + (turn if ccw else -turn)
        a, b = -radius * math.cos(begin), -radius * math.sin(begin)
        da, db = a + radius * math.cos(end), b + radius * math.sin(end)
        offsets = {"X": "I", "Y": "J", "Z": "K"}
        words = f"{first}{da:.4f} {second}{db:.4f} {offsets[first]}{a:.4f} {offsets[second]}{b:.4f}"
        if r.random() < 0.3:
            words += f" {'ZYX'[plane]}{self.number(-5.0, 5.0)}"
        if plane == 0 and r.random() < 0.25:
            words += f" P{r.randint(1, 4)}"
        self.write(f"G{17 + plane} G91 G{3 if ccw else 2} {words}")
        self.write("G17 G90")

    def radius(self) -> None:
        """Radius form, long enough for any end within an increment."""
        r = self.r
        x, y = r.uniform(-8.0, 8.0), r.uniform(1.0, 8.0)
        radius = r.uniform(1.01, 3.0) * math.hypot(x, y) / 2.0 * r.choice((1.0, 1.0, -1.0))
        self.write(f"G91 G{r.choice((2, 3))} X{x:.3f} Y{y:.3f} R{radius:.3f}")
        self.write("G90")

    def circle(self) -> None:
        nothing = " K0.000" if self.r.random() < 0.1 and not self.plain else ""
        centre = f"I{self.number(1.0, 5.0)} J{self.number(1.0, 5.0)}"
        self.write(f"G{self.r.choice((2, 3))} {centre}{nothing}")

    def modes(self) -> None:
        self.write(
            self.r.choice(("G90", "G91", "G90", "G20", "G21", "G61", "G61.1", "G64", "G80 G0"))
        )

    def dwell(self) -> None:
        r = self.r
        motion = f" G{r.choice((0, 1))} {self.axes()}" if r.random() < 0.2 else ""
        self.write(f"G4 P{self.value(0.0, 3.0)}{motion}")

    def switch(self) -> None:
        r = self.r
        words = (f"S{self.value(0.0, 9000.0)}", "M3", "M4", "M5", "M7", "M8", "M9")
        words = (*words, f"S{r.randint(0, 9000)} M3", "M3 M8", "M5 M9", "M19", "M19 R90 P1")
        if self.plain:  # where M19 turns the spindle
            words = words[:-2]
        self.write(r.choice(words))

    def digital(self) -> None:
        self.write(f"M{self.r.randint(62, 65)} P{self.r.randint(0, 31)}")

    def stop(self) -> None:
        self.write(self.r.choice(("M0", "M1", "M1")))

    def analog(self) -> None:
        self.write(f"M{self.r.choice((67, 68))} E{self.r.randint(0, 3)} Q{self.value(-10.0, 10.0)}")

    def overrides(self) -> None:
        r = self.r
        code = r.randint(48, 53)
        self.write(f"M{code}" + (r.choice(("", " P0", " P1")) if code >= 50 else ""))

    def wait(self) -> None:
        """M66, which reads 0 here, before the motion of its line."""
        r = self.r
        way = f"M66 P{r.randint(0, 31)}"
        if r.random() < 0.3:
            way = f"M66 E{r.randint(0, 3)}" + r.choice(("", " L0"))
        elif r.random() < 0.7:
            way += f" L{r.randint(1, 4)} Q{self.number(0.1, 5.0)}"
        self.write(way + r.choice(("", "", f" G1 {self.axes()}")))

    def probe(self) -> None:
        r = self.r
        self.write(f"G91 G38.{r.randint(2, 5)} {self.axes()} F{self.number(50.0, 300.0)}")
        self.write(r.choice(("G90", "G90 G0", "G90 G1 X1")))
        if self.expressions and r.random() < 0.7:
            self.write(f"G0 X[#{r.randint(5061, 5063)} + #5070 + 0.37]")

    def tap(self) -> None:
        r = self.r
        self.write(f"G97 S{r.randint(100, 900)} M{r.randint(3, 4)}")
        back = r.choice(("", f" I{self.number(0.5, 3.0)}"))
        self.write(f"G33.1 {self.axes('ZXY', 0.3)} K{self.number(0.2, 2.0)}{back}")
        self.write(r.choice(("G1", "G80", "G0")))

    def saved(self) -> None:
        """Modes that come back."""
        r = self.r
        self.write("M70")
        for _ in range(r.randint(0, 4)):
            self.one(("line", "modes", "feed", "switch", "overrides", "tool", "offsets", "surface"))
        self.write(r.choice(("M72", "M72", "M72 G1 X1", "M71", "M73")))

    def surface(self) -> None:
        r = self.r
        self.write(f"G96 S{r.randint(0, 200)} D{r.randint(100, 4000)} M{r.randint(3, 5)}")
        for _ in range(r.randint(0, 4)):
            self.one(("line", "circle", "feed", "switch", "offsets", "modes"))
        if r.random() < 0.8:
            self.write(r.choice(("G97", f"G97 S{r.randint(0, 3000)}")))

    def offsets(self) -> None:
        r = self.r
        axes = self.axes("XYZ" if self.plain else "XYZUVW", 0.4)
        self.write(
            r.choice(
                (
                    f"G5{r.randint(4, 9)}",
                    f"G10 L2 P{r.randint(0, 6)} {axes}",
                    f"G92 {self.axes()}",
                    f"G92.{r.randint(1, 3)}",
                    f"G52 {self.axes()}",
                    f"G53 G{r.randint(0, 1)} {self.axes()}",
                )
            )
        )

    def home(self) -> None:
        beside = "G0 " if self.r.random() < 0.2 and not self.plain else ""  # rs274 refuses that
        self.write(beside + self.r.choice(("G28", "G28 " + self.axes())))

    def wrong(self) -> None:
        """Now and then a line that is none."""
        if self.r.random() < 0.05:
            self.write(self.r.choice(WRONG))

    def more_offsets(self) -> None:
        r = self.r
        self.write(
            r.choice(
                (
                    f"G59.{r.randint(1, 3)}",
                    f"G10 L20 P{r.randint(0, 9)} {self.axes('XYZ', 0.5)}",
                    f"G10 L2 P{r.randint(7, 9)} {self.axes('XYZ', 0.5)}",
                    "G28.1",
                    "G30.1",
                    "G30",
                    f"G30 {self.axes()}",
                )
            )
        )

    def tool(self) -> None:
        r = self.r
        number = r.choice(list(TOOLS))
        if self.plain:  # alone, rs274 loses its place behind M6 and stops, unless it has just moved
            self.write("G49")
            self.write(f"G90 G0 Z{self.number()}")
            self.write(f"T{number} M6")
            self.write(r.choice(("G43", f"G43 H{number}", f"G43.1 Z{self.number()}", "G49")))
            self.write(f"G90 G0 Z{self.number()}")
            return
        self.write(
            r.choice((f"T{number} M6", f"T{number}", f"T{number} M6 G43", f"G43 H{number}"))
            if r.random() < 0.7
            else r.choice((f"G43.1 Z{self.number()}", "G49", f"G10 L1 P{number} Z{self.number()}"))
        )

    def inverse(self) -> None:
        self.write(f"G93 G1 {self.axes()} F{self.number(0.5, 20.0)}")
        self.write(f"G94 F{self.number(100.0, 900.0)}")

    def turned(self) -> None:
        r = self.r
        self.write(f"G97 S{r.randint(100, 3000)} M3")
        self.write(f"G95 F{self.number(0.02, 0.5)} G1 {self.axes()}")
        self.write(f"G94 F{self.number(100.0, 900.0)}")

    def spline(self) -> None:
        """Curves that turn nowhere on the spot: control points within a third of the chord."""
        n = self.number
        far, near = f"X{n(9.0, 30.0)} Y{n(-9.0, -1.0)}", (0.5, 3.0)
        if self.r.random() < 0.5:
            self.write(f"G17 G91 G5.1 {far} I{n(3.0, 6.0)} J{n(1.0, 3.0)}")
        else:
            ways = f"I{n(*near)} J{n(*near)} P-{n(*near)} Q{n(*near)}"
            self.write(f"G17 G91 G5 {far} {ways}")
            if self.r.random() < 0.5:
                self.write(f"G5 X{n(9.0, 30.0)} Y{n()} P-{n(*near)} Q{n(*near)}")
        self.write("G90")

    def nurbs(self) -> None:
        """Points that go on to one side, in any plane; now and then too few, or one axis alone."""
        r = self.r
        plane = r.choice((0, 1, 2))
        first, second = ("XY", "ZX", "YZ")[plane]
        order = r.choice((0, 0, 3, 4, 5))
        count = max(order, 3) - (1 if r.random() < 0.05 else 0) + r.randint(0, 4)
        self.write("G94 F600")
        self.write(f"G{17 + plane} G91")
        begin = r.choice(("", f" P{self.number(0.5, 2.0)}"))
        self.write("G5.2" + begin + (f" L{order}" if order else ""))
        for _ in range(count - 1):
            weight = r.choice(("", f" P{self.number(0.5, 2.0)}"))
            way = f" {second}{self.number(-5.0, 5.0)}" if r.random() < 0.98 else ""
            self.write(f"{first}{self.number(3.0, 9.0)}{way}{weight}")
        self.write("G5.3")
        self.write("G17 G90")

    def rotation(self) -> None:
        r = self.r
        self.write(f"G17 G68 X{self.number()} Y{self.number()} R{self.value(-180.0, 180.0)}")
        for _ in range(r.randint(1, 4)):
            self.one(("line", "circle", "radius"))
        self.write("G69")

    def scaling(self) -> None:
        self.write(f"G51 X{self.number()} Y{self.number()} Z0 P{self.number(0.5, 2.5)}")
        for _ in range(self.r.randint(1, 4)):
            self.one(("line", "circle", "radius"))
        self.write("G50")

    def cycle(self) -> None:
        r = self.r
        code = r.choice((73, 74, 81, 82, 83, 84, 85, 86, 87, 88, 89))
        self.write(f"G90 G94 G0 Z{self.number(5.0, 20.0)}")
        if code in (74, 84, 86, 87, 88):
            self.write(f"G97 S{r.randint(100, 2000)} M{4 if code == 74 else 3}")
        words = f"X{self.number()} Y{self.number()} Z{self.number(-20.0, -1.0)}"
        words += f" R{self.number(0.5, 4.0)}"
        words += f" Q{self.number(1.0, 6.0)}" if code in (73, 83) else ""
        words += f" P{self.number(0.0, 1.0)}" if code in (74, 82, 84, 86, 88, 89) else ""
        if code == 87:
            words += f" I{self.number()} J{self.number()} K{self.number(0.0, 5.0)}"
        incremental = r.random() < 0.3
        self.write(f"G{r.choice((98, 99))} {'G91 ' if incremental else ''}G{code} {words}")
        for _ in range(r.randint(0, 3)):
            repeat = f" L{r.randint(1, 3)}" if r.random() < 0.3 else ""
            self.write(f"X{self.number()} Y{self.number()}{repeat}")
        self.write("G80 G90")

    def series(self) -> None:
        """Lines of one cycle in any plane, above a level that holds for all of them."""
        r, n = self.r, self.number
        code = r.choice((73, 74, 81, 82, 83, 84, 85, 86, 89))
        # rs274 2.9 swaps axes in taps of other planes, and repeats neither G73 nor G74.
        plane = 0 if self.plain and code in (74, 84) else r.choice((0, 0, 1, 2))
        repeats = not (self.plain and code in (73, 74))
        first, second, deep = ("XYZ", "ZXY", "YZX")[plane]
        incremental = r.random() < 0.5
        self.write(f"G90 G94 G0 {deep}{n(5.0, 30.0)} F{n(50.0, 500.0)}")
        self.write(f"G97 S{r.randint(100, 2000)} M{4 if code == 74 else 3}")
        words = f" {deep}{n(-30.0, -20.0)} R{n(-18.0, 4.0)}"
        words += f" Q{n(2.0, 9.0)}" if code in (73, 83) else ""
        words += f" P{n(0.0, 1.0)}" if code in (74, 82, 84, 86, 89) else ""
        if plane == 0 and r.random() < 0.25:
            self.round(code, words, incremental)
            return
        modes = f"G{17 + plane} G{r.choice((98, 99))} G{91 if incremental else 90} G{code}"
        self.write(f"{modes} {first}{n()} {second}{n()}{words}")
        for _ in range(r.randint(0, 4)):
            hole = r.choice((f"{first}{n()}", f"{second}{n()}", f"{first}{n()} {second}{n()}"))
            hole += f" L{r.randint(1, 4)}" if repeats and r.random() < 0.4 else ""
            hole += f" {deep}{n(-40.0, -20.0)}" if r.random() < 0.2 else ""
            self.write(hole)
        self.write("G80 G90 G17")

    def round(self, code: int, words: str, incremental: bool) -> None:
        """Holes about the zero by radius and angle."""
        r, n = self.r, self.number
        self.write(f"G17 G0 X{n(1.0, 9.0)} Y{n(1.0, 9.0)} Z20")
        modes = f"G{r.choice((98, 99))} G{91 if incremental else 90} G{code}"
        self.write(f"{modes} @{n(1.0, 9.0)} ^{n(5.0, 90.0)}{words}")
        for _ in range(r.randint(0, 4)):
            hole = r.choice((f"@{n(0.5, 3.0)}", f"^{n(5.0, 90.0)}", f"@{n(0.5, 3.0)} ^{n()}"))
            repeats = r.random() < 0.5 and not (self.plain and code in (73, 74))
            self.write(hole + (f" L{r.randint(2, 5)}" if repeats else ""))
        if not self.plain and r.random() < 0.5:  # Fanuc's form
            self.write("G16")
            self.write(f"X{n(1.0, 9.0)} Y{n(5.0, 90.0)} L{r.randint(1, 4)}")
            self.write(f"Y{n(5.0, 90.0)} L{r.randint(1, 4)}")
            self.write("G15")
        self.write("G80 G90")

    def corners(self) -> None:
        """A way of lines with any corners, small ones among them, cut with compensation."""
        r = self.r
        side, x, y = r.choice((41, 42)), 0.0, 0.0
        heading = r.uniform(0.0, math.tau)
        self.write("G17 G21 G90 G94 G80")
        self.write(f"G0 X{x} Y{y}")
        self.write(f"G{side}.1 D{self.number(0.5, 4.0)}")
        slight = False
        for _ in range(r.randint(2, 9)):
            turn = r.choice((r.uniform(-2.0, 2.0), r.uniform(-0.6, 0.6), r.uniform(-0.005, 0.005)))
            both, slight = slight and abs(turn) < 0.005, abs(turn) < 0.005
            way = r.uniform(0.03, 0.1) if both and r.random() < 0.7 else r.uniform(15.0, 60.0)
            x, y = x + way * math.cos(heading), y + way * math.sin(heading)
            self.write(f"G1 X{x:.4f} Y{y:.4f} F{r.randint(100, 900)}")
            heading += turn
        self.write("G40")
        if not self.plain and r.random() < 0.3:  # rs274 moves aside with it, through the contour
            self.write(f"G{r.choice((0, 1))} Z{self.number()}")
        leave = (f"X{x + 30.0:.3f} Y{y - 30.0:.3f}", f"X{x + 30.0:.3f}", f"Y{y - 30.0:.3f}")
        self.write(f"G{r.choice((0, 1))} {r.choice(leave)}")

    def contour(self) -> None:
        """A polygon about a centre with some arcs, cut outside or inside with compensation."""
        r = self.r
        sides, size = r.randint(3, 9), r.uniform(20.0, 60.0)
        ccw = r.random() < 0.5
        angles = [math.tau * (i + r.uniform(-0.2, 0.2)) / sides for i in range(sides)]
        if not ccw:
            angles.reverse()
        radii = [size * r.uniform(0.8, 1.2) for _ in angles]
        points = [(a * math.cos(t), a * math.sin(t)) for a, t in zip(radii, angles, strict=True)]
        side = r.choice((41, 42))
        out = (side == 42) == ccw
        x, y = points[0]
        scale = 1.8 if out else 0.3
        how = r.choice((f"G{side} D{r.choice((1, 2, 3))}", f"G{side}.1 D{self.number(1.0, 5.0)}"))
        self.write("G17 G21 G90 G94 G80")
        self.write(f"G0 X{x * scale:.3f} Y{y * scale:.3f}")
        self.write(how)
        self.write(f"G1 X{x:.4f} Y{y:.4f} F{r.randint(100, 900)}")
        for px, py in [*points[1:], points[0]]:
            kind = r.random()
            if kind < 0.1:
                self.write(f"G4 P{self.number(0.0, 1.0)}")
            elif kind < 0.2:
                self.write(f"G1 Z{self.number(-3.0, 3.0)}")
            if r.random() < 0.3:
                bulge = r.uniform(1.5, 4.0) * size
                self.write(f"G{3 if ccw else 2} X{px:.4f} Y{py:.4f} R{bulge:.4f}")
            else:
                self.write(f"G1 X{px:.4f} Y{py:.4f}")
        self.write("G40")
        self.write(f"G1 X{x * scale:.3f} Y{y * scale:.3f}")
