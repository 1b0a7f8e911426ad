"""Random part programs, the same for the same seed, and their comparison by both interpreters.

python tests/gcode/random_programs.py --count 20000
"""

import argparse
import random
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from compare import difference
from random_lines import TOOLS, Lines
from second import Options

FLAT = (
    *("line", "line", "line", "feed", "arc", "radius", "circle", "modes", "dwell", "switch"),
    *("digital", "stop", "offsets", "home", "far", "wrong"),
)
MORE = (
    "more_offsets",
    "tool",
    "inverse",
    "turned",
    "spline",
    "nurbs",
    "rotation",
    "scaling",
    *("cycle", "series"),
    *("contour", "corners"),
    *("analog", "overrides", "wait", "probe", "surface", "tap", "saved"),
)
# What the machine knows by name.
NAMES = (
    *("abs_x", "abs_y", "absolute", "adaptive_feed", "call_level", "ccomp", "coord_system"),
    *("current_tool", "feed", "feed_hold", "feed_override", "flood", "ijk_absolute_mode"),
    *("imperial", "incremental", "inverse_time", "line", "metric", "mist", "motion_mode", "plane"),
    *("retract_old_z", "retract_r_plane", "rpm", "selected_tool", "speed_override", "spindle_cw"),
    *("spindle_css_mode", "spindle_on", "spindle_rpm_mode", "task", "tool_offset"),
    *("units_per_minute", "units_per_rev", "value", "value_returned"),
)
FLOW = (
    "setting",
    "indirect",
    "read_back",
    "condition",
    "repeat",
    "loop",
    "sub",
    "call",
    "macro",
    "jump",
    "further",
)
PARTS: tuple[str, ...] = (*FLAT, *MORE, *FLOW)


class Writer(Lines):
    """Writes one program; `parts` are the names of the methods it may use."""

    def __init__(self, seed: int, parts: tuple[str, ...] = (), plain: bool = False) -> None:
        self.parts = parts or PARTS
        super().__init__(seed, "setting" in self.parts, plain)
        self.label = 100
        self.fanuc = options(seed).fanuc and not plain
        self.depth = 0
        self.subs: list[str] = []
        self.macros: list[str] = []

    def setting(self) -> None:
        r = self.r
        kind = r.random()
        if kind < 0.6:
            self.write(f"#{r.randint(1, 40)} = [{self.tree(r.randint(0, 3))}]")
        elif kind < 0.8:
            self.write(f"#{r.randint(1, 40)}={self.number()} #{r.randint(1, 40)}={self.number()}")
        else:
            name = r.choice(("_global", "_other"))
            self.write(f"#<{name}> = [{self.tree(1)}]")
            if name not in self.names and self.depth == 0:
                self.names.append(name)

    def indirect(self) -> None:
        self.write(f"#5={self.r.randint(1, 30)}")
        self.write(f"#[#5 + 1] = {self.number()}")
        self.write("G1 X[##5 mod 10]")

    def read_back(self) -> None:
        name = self.r.choice(("#5420", "#5421", "#5422", "#<_x>", "#<_y>", "#<_z>", "#5220"))
        if self.r.random() < 0.5:
            name = f"#<_{self.r.choice(NAMES)}>"
        self.write(f"G1 X[[{name} + 0.37] mod 30] Y[{name} + 1]")  # 0 stands on no border

    def new_label(self) -> str:
        self.label += 1
        return str(self.label)

    def body(self) -> None:
        self.depth += 1
        for _ in range(self.r.randint(1, 4)):
            self.one(self.parts if self.depth < 3 else FLAT)
        self.depth -= 1

    def condition(self) -> None:
        label = self.new_label()
        self.write(f"o{label} if [{self.tree(1)}]")
        self.body()
        for _ in range(self.r.choice((0, 0, 1, 2))):
            self.write(f"o{label} elseif [{self.tree(1)}]")
            self.body()
        if self.r.random() < 0.5:
            self.write(f"o{label} else")
            self.body()
        self.write(f"o{label} endif")

    def repeat(self) -> None:
        label = self.new_label()
        self.write(f"o{label} repeat [{self.r.randint(0, 4)}]")
        self.body()
        self.leave(label)
        self.write(f"o{label} endrepeat")

    def leave(self, label: str) -> None:
        """Break or continue, on a condition; rs274 2.9 miscounts the loops behind one."""
        if self.r.random() < 0.3 and not self.plain:
            inner = self.new_label()
            self.write(f"o{inner} if [{self.tree(1)}]")
            self.write(f"o{label} {self.r.choice(('break', 'continue'))}")
            self.write(f"o{inner} endif")
            self.line()

    def loop(self) -> None:
        """While and do, counted by a name of their own."""
        label = self.new_label()
        counter = f"#<_n{label}>"
        self.write(f"{counter} = 0")
        top, bottom = f"while [{counter} lt {self.r.randint(0, 4)}]", "endwhile"
        if self.r.random() < 0.5:
            top, bottom = "do", top
        self.write(f"o{label} {top}")
        self.write(f"{counter} = [{counter} + 1]")
        self.body()
        self.leave(label)
        self.write(f"o{label} {bottom}")

    def jump(self) -> None:
        """GOTO, IF, WHILE and END of Fanuc's controls, with counters of their own."""
        if not self.fanuc or self.depth:
            return
        r, self.depth = self.r, 2
        n = 20000 + 10 * (self.label + 1)
        self.label += 1
        kind = r.choice(("back", "ahead", "loops", "then", "out", "wrong"))
        if kind == "back":
            self.lines += ["#31=0", f"N{n} #31=#31+1"]
            self.one(FLAT)
            self.lines.append(f"IF [#31 {r.choice(('LT', 'LE', 'NE'))} 3] GOTO {n}")
        elif kind == "ahead":
            way = r.choice((f"GOTO {n}", f"GOTO[{n - 1}+1]", f"if[{self.tree(1)}]goto{n}"))
            self.lines.append(way)
            self.one(FLAT)
            self.lines.append(f"N{n} G1 X#31")
        elif kind in ("loops", "out"):
            self.lines += ["#31=0", f"WHILE [#31 LT {r.randint(0, 3)}] DO{n % 3 + 1}"]
            self.lines += ["#32=0", "#31=#31+1"]
            if kind == "out":
                self.lines.append(f"IF[[#31 EQ 2] AND [{self.tree(0)} GT 0]]GOTO{n}")
            self.lines.append(f"WHILE[#32LE#31]DO{(n + 1) % 3 + 1}")
            self.one(FLAT)
            self.lines += [f"#32=#32+1*{r.randint(1, 2)}", f"END {(n + 1) % 3 + 1}"]
            self.lines += [f"END{n % 3 + 1}", f"N{n}"]
        elif kind == "then":
            self.lines.append(f"IF [{self.tree(1)}] THEN #33=-#31+{self.number()}*2")
            self.lines.append("G1 X[#33 mod 10 + 0.37]")
        elif r.random() < 0.2:
            wrong = ("GOTO 99", "END 1", "WHILE [0] DO 2", "IF [1] X1", "DO 4", "IF 1 GOTO 2")
            self.lines.append(r.choice(wrong))
        self.depth = 0

    def further(self) -> None:
        """Words that only Fanuc's and Haas' controls have."""
        if not self.fanuc or self.depth:
            return
        r, self.depth = self.r, 2
        kind = r.choice(("exact", "origin", "take", "peck", "vacant", "modal"))
        if kind == "exact":
            self.lines.append(f"G9 G1 X{self.value()} Y{self.value()}")
        elif kind == "origin":
            n = r.randint(1, 48)
            self.lines.append(f"G10 L20 P{n} X{self.value()} Y{self.value()}")
            self.lines.append(f"G1 X[#{7001 + 20 * (n - 1)} mod 10] Y[#5002 mod 10]")
        elif kind == "take":
            self.lines.append(f"{r.choice(('G54.1', 'G154'))} P{r.choice((1, 2, 48, 99))}")
            self.one(FLAT)
            self.lines.append("G54")
        elif kind == "peck":
            dwell = r.choice(("", " P200", " P.5"))
            self.lines.append(f"G90 G{r.choice((73, 83))} X{self.value()} Z-9 R-2 Q3{dwell} F200")
            self.lines.append(f"Y{self.value()}\nG80")
        elif kind == "vacant":
            self.lines.append(f"#{r.randint(1, 40)}=#{r.choice((0, 33, 150))}")
            n = r.randint(1, 40)
            self.lines.append(f"IF [#{n} {r.choice(('EQ', 'NE', 'GE'))} #0] THEN #33=#{n}*2+1")
            self.lines.append(f"G1 X#{n} Y[#33 mod 10]")
        else:
            self.macros.append(f"O{5000 + len(self.macros)}")
            letters = "".join(f" {c}{self.value()}" for c in r.sample("ABIJKXYZ", r.randint(0, 4)))
            self.lines.append(f"G66 P{self.macros[-1][1:]}{letters}")
            for _ in range(r.randint(1, 3)):
                self.one(FLAT)
            self.lines.append("G67")
        self.depth = 0

    def sub(self) -> None:
        """A sub, defined where only the main program stands, and its calls."""
        if self.depth or len(self.subs) > 3:
            return self.call()
        label = self.r.choice((self.new_label(), f"<part{self.new_label()}>"))
        self.write(f"o{label} sub")
        self.write(f"#<inner> = #{self.r.randint(1, 4)}")
        self.depth = 1
        self.names.append("inner")
        self.body()
        self.write("G1 X[#<inner> mod 10]")
        self.names.remove("inner")
        self.depth = 0
        if self.r.random() < 0.3:
            self.write(f"o{label} return [{self.tree(0)}]")
        self.write(f"o{label} endsub" + self.r.choice(("", f" [{self.tree(0)}]")))
        self.subs.append(label)
        self.call()

    def call(self) -> None:
        if not self.subs or self.depth > 1:
            return
        arguments = " ".join(f"[{self.tree(0)}]" for _ in range(self.r.randint(0, 5)))
        # Not the sub itself: what is called was written before, so calls end.
        label = self.r.choice(self.subs)
        self.write(f"o{label} call {arguments}".rstrip())
        if self.r.random() < 0.3:
            self.write("#9 = #<_value>")

    def macro(self) -> None:
        """M98 or, with Fanuc's forms, G65 of a program that stands behind the end."""
        r = self.r
        number = 5000 + len(self.macros)
        self.macros.append(f"O{number}")
        runs = r.randint(0, 3)
        times = f" P{number}" + (f" L{runs}" if r.random() < 0.5 else "")
        if self.fanuc and r.random() < 0.3:
            times = f" P{runs}{number}"
        if self.fanuc and r.random() < 0.6:
            letters = r.sample("ABCIJKDEFHMQRSTUVWXYZ", r.randint(0, 6))
            times += "".join(f" {c}{self.value()}" for c in letters)
            self.write(f"G65{times}")
        else:
            self.write(f"M98{times}")

    def program(self) -> str:
        """The whole text."""
        self.write("G21 G17 G90 F600")
        if self.expressions:
            self.write("#<_global> = 3")
        for _ in range(self.r.randint(3, 25)):
            self.one(self.parts)
        self.write(self.r.choice(("M2", "M30", "M30")))
        for name in self.macros:
            self.depth = 2
            self.write(name)
            self.one(FLAT)
            self.write(f"G91 G1 X1 Y[#{self.r.randint(1, 26)} mod 10 + 0.37]")
            self.write("G90")
            self.write("M99")
        return "\n".join(self.lines) + "\n"


def options(seed: int) -> Options:
    """Switches of the language, as random as the program."""
    r = random.Random(seed)
    return Options(
        optional_stop=r.random() < 0.5,
        point=tuple(r.choice((0.0, 0.0, r.uniform(-9.0, 9.0))) for _ in range(6)),
        tools=dict(TOOLS),
        closed=True,
        fanuc=r.random() < 0.4,
    )


def each(count: int, start: int = 0, parts: tuple[str, ...] = ()) -> Iterator[tuple[int, str]]:
    """Seeds and their programs."""
    for seed in range(start, start + count):
        yield seed, Writer(seed, parts).program()


def differing(
    count: int, start: int = 0, parts: tuple[str, ...] = (), show: Callable[[str], None] = print
) -> Counter[str]:
    """How many programs agree and how many do not, which are shown."""
    found: Counter[str] = Counter()
    for seed, text in each(count, start, parts):
        how = difference(text, options(seed))
        found["differ" if how else "same"] += 1
        if how:
            show(f"seed {seed}: {how}")
    return found


def main() -> None:
    """Compare as many programs as asked."""
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("--count", type=int, default=1000)
    p.add_argument("--start", type=int, default=0)
    p.add_argument("--parts", default="", help="only these, with commas between")
    p.add_argument("--show", type=int, help="print the program of a seed")
    a = p.parse_args()
    parts = tuple(a.parts.split(",")) if a.parts else ()
    if a.show is not None:
        print(Writer(a.show, parts).program())
        return
    found = differing(a.count, a.start, parts)
    print(dict(found))
    sys.exit(bool(found["differ"]))


if __name__ == "__main__":
    main()
