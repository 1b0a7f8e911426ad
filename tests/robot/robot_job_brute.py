"""The robot language read line by line as it runs: slow, and sharing nothing with the core."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction

NS = 1_000_000_000
LIMITS = {"B": (0, 255), "I": (-(2**15), 2**15 - 1), "D": (-(2**31), 2**31 - 1)}
OPENING = {
    "ENDIF": "IF",
    "ENDLOOP": "LOOP",
    "ENDWHILE": "WHILE",
    "NEXT": "FOR",
    "ENDSWITCH": "SWITCH",
}
CALLS = 12
Number = int | float


class Stop(Exception):
    """A program that cannot go on; says why."""


class Endless(Exception):
    """Too many lines in a row that nobody sees."""


@dataclass
class World:
    """What the program sees."""

    now: int = 0  # [ns]
    reached: int = 0  # moves
    di: int = 0
    ai: list[float] = field(default_factory=lambda: [0.0] * 8)  # [V]


@dataclass
class Frame:
    job: str
    at: int = 0
    left: dict[int, int | None] = field(default_factory=dict)  # rounds of the LOOP at a line
    own: dict[str, Number] = field(default_factory=dict)  # LB LI LD LR
    arguments: list[Number] = field(default_factory=list)


class Brute:
    """Yields a tuple for each request: kind, line, number of moves, and what belongs to it."""

    def __init__(self, text: str, frames: dict[int, tuple[int, int]], patience: int):
        self.frames = frames  # tool and user frame of a point, -1 where the point has none
        self.patience = patience
        self.world = World()
        self.jobs: dict[str, list[tuple[int, str]]] = {}
        name = "MAIN"
        for number, line in enumerate(text.splitlines(), 1):
            words = line.split("'")[0].strip()
            if words.startswith("JOB "):
                name = words[4:]
                self.jobs[name] = []
            elif words:
                self.jobs.setdefault(name, []).append((number, words))
        self.stack = [Frame(next(iter(self.jobs)))]
        self.moves = 0
        self.out = 0
        self.speed = {"VJ": 10.0, "V": 100.0, "VR": 20.0}
        self.usual, self.level, self.tool, self.user = "V", 0, 0, 0
        self.variables: dict[str, Number] = {}
        self.shift = (-1, 0)  # point, user frame
        self.early = 0  # the latest move is NWAIT

    # -- values

    def kept(self, name: str) -> dict[str, Number]:
        return self.stack[-1].own if name[0] == "L" else self.variables

    def value(self, text: str) -> Number:
        if m := re.fullmatch(r"(IN|OT|AI|IG|OG)#\((\d+)\)", text):
            n = int(m[2]) - 1
            if m[1] == "AI":
                return self.world.ai[n]
            if m[1] in ("IG", "OG"):
                return (self.world.di if m[1] == "IG" else self.out) // 256**n % 256
            return (self.world.di if m[1] == "IN" else self.out) >> n & 1
        if text in ("ON", "OFF"):
            return int(text == "ON")
        if re.fullmatch(r"L?[BID]\d+", text):
            return self.kept(text).get(text, 0)
        if re.fullmatch(r"L?R\d+", text):
            return self.kept(text).get(text, 0.0)
        return int(text) if re.fullmatch(r"-?\d+", text) else float(text)

    def store(self, name: str, x: Number | Fraction) -> None:
        if "R" in name:
            if abs(x) == float("inf") or x != x:
                raise Stop("result out of range")
            self.kept(name)[name] = float(x)
            return
        low, high = LIMITS[name.lstrip("L")[0]]
        if abs(x) == float("inf") or not low <= int(x) <= high:
            raise Stop("result out of range")
        self.kept(name)[name] = int(x)

    def calculate(self, word: str, name: str, operand: str) -> None:
        a: Number | Fraction = self.value(name)
        b: Number | Fraction = self.value(operand)
        if word in ("SET", "DIN", "AIN"):
            self.store(name, b)
            return
        if word == "DIV" and b == 0:
            raise Stop("division by zero")
        if isinstance(a, int) and isinstance(b, int) and "R" not in name:
            a, b = Fraction(a), Fraction(b)
        else:
            a, b = float(a), float(b)
        done = {"ADD": lambda: a + b, "SUB": lambda: a - b, "MUL": lambda: a * b}
        self.store(name, done.get(word, lambda: a / b)())

    def holds(self, condition: str) -> bool:
        bare = re.sub(r"(?<!#)\(|(?<!\d)\)|(?<=\))\)", "", condition)
        bare = re.sub(r"(?<!\()(\b[\w.-]+)\)", r"\1", bare)  # a number before the bracket's end
        for word, enough in ((" AND ", all), (" OR ", any)):
            if word in bare:
                return enough([self.comparison(part) for part in bare.split(word)])
        return self.comparison(bare)

    def comparison(self, condition: str) -> bool:
        m = re.fullmatch(r"(\S+?)(<=|>=|<>|=|<|>)(\S+)", condition.strip())
        assert m, condition
        a, b = self.value(m[1]), self.value(m[3])
        return {
            "=": a == b,
            "<>": a != b,
            "<": a < b,
            ">": a > b,
            "<=": a <= b,
            ">=": a >= b,
        }[m[2]]

    # -- places

    def first(self, at: int) -> str:
        """The word a line of the running job begins with, IF in one spelling."""
        word = self.jobs[self.stack[-1].job][at][1].split()[0]
        return {"IFTHEN": "IF"}.get(word, word)

    def scan(self, at: int, step: int, wanted: set[str]) -> int:
        """The next line that begins with one of these, past whole blocks."""
        deep = 0
        opening, closing = set(OPENING.values()), set(OPENING)
        if step < 0:
            opening, closing = closing, opening
        while True:
            at += step
            word = self.first(at)
            if deep == 0 and word in wanted:
                return at
            deep += (word in opening) - (word in closing)

    def label(self, name: str) -> int:
        lines = self.jobs[self.stack[-1].job]
        return next(i for i, (_, t) in enumerate(lines) if t in (f"*{name}", f"LABEL {name}"))

    # -- the program

    def reach(self, line: int) -> Iterator[tuple]:
        while self.world.reached < self.moves:
            yield "reach", line, self.moves
        self.early = 0

    def run(self) -> Iterator[tuple]:
        line = 0
        quiet = 0
        while True:
            frame = self.stack[-1]
            lines = self.jobs[frame.job]
            if frame.at >= len(lines) or lines[frame.at][1] == "END":
                line = lines[min(frame.at, len(lines) - 1)][0]
                if len(self.stack) > 1:
                    self.stack.pop()
                    continue
                yield from self.reach(line)
                break
            line, text = lines[frame.at]
            quiet += 1
            if quiet > self.patience:
                raise Endless
            try:
                for request in self.line(line, text):
                    quiet = 0
                    yield request
                    if request[0] == "end":
                        return
            except Stop as why:
                yield "fault", line, self.moves, str(why)
                return
        yield "end", line, self.moves

    def line(self, line: int, text: str) -> Iterator[tuple]:
        frame = self.stack[-1]
        words = text.split()
        word = self.first(frame.at)
        condition = ""
        if word in ("JUMP", "CALL", "RET", "PAUSE") and "IF" in words:
            condition = text.split(" IF ")[1]
        elif word in ("IF", "ELSEIF", "WHILE", "WAIT"):
            condition = text.split(" T=")[0].split(" ", 1)[1]
        if word in ("ELSEIF", "ELSE", "CASE", "DEFAULT"):  # the branch before has been done
            ends = {"ENDIF"} if word in ("ELSEIF", "ELSE") else {"ENDSWITCH"}
            frame.at = self.scan(frame.at, 1, ends) + 1
            return
        if word == "SWITCH":
            yield from self.choose(words[1])
            return
        if self.looks(text) or word in ("WAIT", "TIMER", "CWAIT"):
            yield from self.reach(line)
        frame.at += 1
        if word == "IF":
            while not self.holds(condition):
                frame.at = self.scan(frame.at - 1, 1, {"ELSEIF", "ELSE", "ENDIF"}) + 1
                there = self.jobs[frame.job][frame.at - 1][1]
                if not there.startswith("ELSEIF"):
                    return
                condition = there.split(" ", 1)[1]
                if self.looks(there):
                    yield from self.reach(self.jobs[frame.job][frame.at - 1][0])
        elif word == "WHILE":
            if not self.holds(condition):
                frame.at = self.scan(frame.at - 1, 1, {"ENDWHILE"}) + 1
        elif word == "ENDWHILE":
            frame.at = self.scan(frame.at - 1, -1, {"WHILE"})
        elif word == "FOR":
            _, name, start, end, step = self.counted(text)
            self.store(name, self.value(start))
            self.count(frame.at - 1, name, end, step)
        elif word == "NEXT":
            start_at = self.scan(frame.at - 1, -1, {"FOR"})
            _, name, _, end, step = self.counted(self.jobs[frame.job][start_at][1])
            self.calculate("ADD", name, str(step))
            self.count(start_at, name, end, step)
        elif word == "LOOP":
            count = int(self.value(words[1])) if len(words) > 1 else None
            frame.left[frame.at - 1] = count
            if count is not None and count <= 0:
                frame.at = self.scan(frame.at - 1, 1, {"ENDLOOP"}) + 1
        elif word == "ENDLOOP":
            start = self.scan(frame.at - 1, -1, {"LOOP"})
            left = frame.left[start]
            frame.left[start] = None if left is None else left - 1
            if left is None or left > 1:
                frame.at = start + 1
        elif word in ("JUMP", "CALL", "RET", "PAUSE"):
            yield from self.go(line, words, condition)
        elif word in ("WAIT", "TIMER"):
            times = [w[2:] for w in words if w.startswith("T=")]
            until = self.world.now + round(Fraction(times[0]) * NS) if times else None
            while not (condition and self.holds(condition)):
                if until is not None and self.world.now >= until:
                    break
                yield "wait", line, self.moves
        elif word not in (
            *("NOP", "ENDIF", "LABEL", "ENDSWITCH", "CWAIT", "MSG"),
        ) and not word.startswith("*"):
            yield from self.simple(line, words)

    @staticmethod
    def looks(text: str) -> bool:
        return any(word in text for word in ("IN#", "AI#", "IG#"))

    @staticmethod
    def counted(text: str) -> tuple[str, str, str, str, int]:
        m = re.fullmatch(r"FOR (\w+) ?= ?(\S+) TO (\S+)( STEP (\S+))?", text)
        assert m, text
        return "FOR", m[1], m[2], m[3], int(m[5] or 1)

    def count(self, at: int, name: str, end: str, step: int) -> None:
        """Go on in a FOR, or behind its NEXT."""
        here, last = self.value(name), self.value(end)
        on = here >= last if step < 0 else here <= last
        self.stack[-1].at = (at if on else self.scan(at, 1, {"NEXT"})) + 1

    def choose(self, looked_at: str) -> Iterator[tuple]:
        """Go to the CASE of a SWITCH whose value it is, to DEFAULT or to the end."""
        frame = self.stack[-1]
        at = frame.at
        while True:
            at = self.scan(at, 1, {"CASE", "DEFAULT", "ENDSWITCH"})
            line, text = self.jobs[frame.job][at]
            if not text.startswith("CASE"):
                break
            if self.looks(looked_at):
                yield from self.reach(line)
            if self.value(looked_at) in [self.value(x) for x in text[5:].split(",")]:
                break
        frame.at = at + 1

    def go(self, line: int, words: list[str], condition: str) -> Iterator[tuple]:
        if condition and not self.holds(condition):
            return
        frame = self.stack[-1]
        if words[0] == "PAUSE":
            yield from self.reach(line)
            yield "pause", line, self.moves
        elif words[0] == "RET":
            if len(self.stack) == 1:
                yield from self.reach(line)
                yield "end", line, self.moves
            else:
                self.stack.pop()
        elif words[0] == "CALL":
            if len(self.stack) > CALLS:
                raise Stop("CALL inside too many others")
            given = [self.value(w[4:]) for w in words[2:] if w.startswith("ARGF")]
            self.stack.append(Frame(words[1][4:], arguments=given))
        elif words[1].startswith("JOB:"):
            self.stack[-1] = Frame(words[1][4:], own=frame.own, arguments=frame.arguments)
        else:
            frame.at = self.label(words[1].lstrip("*"))

    def simple(self, line: int, words: list[str]) -> Iterator[tuple]:
        word = words[0]
        if word in ("MOVJ", "MOVL", "MOVC", "MOVS"):
            yield from self.move(line, words)
        elif word == "SPEED":
            for tag, value in (w.split("=") for w in words[1:]):
                self.speed[tag] = float(value)
                self.usual = self.usual if tag == "VJ" else tag
        elif word in ("PL", "TOOL", "USER"):
            setattr(self, {"PL": "level"}.get(word, word.lower()), int(words[1]))
        elif word == "GETARG":
            n = int(words[2][6:-1]) - 1
            if n >= len(self.stack[-1].arguments):
                raise Stop("an argument it was not called with")
            self.store(words[1], self.stack[-1].arguments[n])
        elif word in ("SFTON", "SFTOF"):
            user = int(words[2][4:-1]) if len(words) > 2 and words[2][:2] == "UF" else 0
            self.shift = (int(words[1][1:]), user) if word == "SFTON" else (-1, 0)
        elif word == "PULSE":
            n = int(words[1][4:-1]) - 1
            self.out &= ~(1 << n)
            seconds = Fraction(words[2][2:] if len(words) > 2 else "0.3")
            yield "dout", line, self.moves - self.early, n, 1, 1, int(seconds * NS)
        elif word == "DOUT" and words[1].startswith("OG"):
            n, value = 8 * (int(words[1][4:-1]) - 1), self.value(words[2])
            if not 0 <= value <= 255:
                raise Stop("result out of range")
            self.out = self.out & ~(255 << n) | int(value) << n
            yield "dout", line, self.moves - self.early, n, 8, int(value), 0
        elif word == "DOUT":
            n = int(words[1][4:-1]) - 1
            self.out = self.out & ~(1 << n) | (words[2] == "ON") << n
            yield "dout", line, self.moves - self.early, n, 1, int(words[2] == "ON"), 0
        elif word == "AOUT":
            volt = self.value(words[2])
            if not -10 <= volt <= 10:
                raise Stop("result out of range")
            yield "aout", line, self.moves - self.early, int(words[1][4:-1]) - 1, float(volt)
        elif word in ("INC", "DEC"):
            self.calculate({"INC": "ADD", "DEC": "SUB"}[word], words[1], "1")
        else:
            self.calculate(word, words[1], words[2])

    def in_row(self) -> int:
        """3 for a part of a curve, 1 for a line: the first of a row, and rows of one or two."""
        lines, at = self.jobs[self.stack[-1].job], self.stack[-1].at - 1
        first = last = at
        while first > 0 and lines[first - 1][1].startswith("MOVS"):
            first -= 1
        while last + 1 < len(lines) and lines[last + 1][1].startswith("MOVS"):
            last += 1
        return 3 if last - first > 1 and at > first else 1

    def move(self, line: int, words: list[str]) -> Iterator[tuple]:
        points = [int(w[1:]) for w in words[1:] if re.fullmatch(r"P\d+", w)]
        tags = dict(w.split("=") for w in words[1:] if "=" in w)
        path, via = "JLCS".index(words[0][3]), 0
        path = self.in_row() if path == 3 else path
        if path == 2 and len(points) == 1:
            lines = self.jobs[self.stack[-1].job]
            at = self.stack[-1].at - 1
            row = 0
            while at - row - 1 >= 0 and re.fullmatch(
                r"MOVC P\d+( \S+=\S+)*", lines[at - row - 1][1]
            ):
                row += 1
            if row % 3 == 0:
                path = 1
            elif row % 3 == 1:
                return
            else:
                via = int(lines[at - 1][1].split()[1][1:])
        elif path == 2:
            via = points[0]
        tag = next((t for t in tags if t in ("VJ", "V", "VR")), "")
        speed = float(tags[tag]) if tag else self.speed["VJ" if path == 0 else self.usual]
        tag = tag or ("VJ" if path == 0 else self.usual)
        tool, user = self.frames[points[-1]]
        self.moves += 1
        self.early = int("NWAIT" in words)
        yield (
            "move",
            line,
            self.moves,
            path,
            points[-1],
            via,
            ("", "VJ", "V", "VR").index(tag),
            speed,
            int(tags.get("PL", self.level)),
            float(tags.get("CR", 0)),
            self.tool if tool < 0 else tool,
            self.user if user < 0 else user,
            *self.shift,
        )
