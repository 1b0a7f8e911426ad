"""The robot language read line by line as it runs: slow, and sharing nothing with the core."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction

NS = 1_000_000_000
LIMITS = {"B": (0, 255), "I": (-(2**15), 2**15 - 1), "D": (-(2**31), 2**31 - 1)}
OPENING = {"ENDIF": "IF", "ENDLOOP": "LOOP", "ENDWHILE": "WHILE"}
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

    # -- values

    def value(self, text: str) -> Number:
        if m := re.fullmatch(r"(IN|OT|AI)#\((\d+)\)", text):
            n = int(m[2]) - 1
            if m[1] == "AI":
                return self.world.ai[n]
            return (self.world.di if m[1] == "IN" else self.out) >> n & 1
        if text in ("ON", "OFF"):
            return int(text == "ON")
        if re.fullmatch(r"[BID]\d+", text):
            return self.variables.get(text, 0)
        if re.fullmatch(r"R\d+", text):
            return self.variables.get(text, 0.0)
        return int(text) if re.fullmatch(r"-?\d+", text) else float(text)

    def store(self, name: str, x: Number | Fraction) -> None:
        if name[0] == "R":
            if abs(x) == float("inf") or x != x:
                raise Stop("result out of range")
            self.variables[name] = float(x)
            return
        low, high = LIMITS[name[0]]
        if abs(x) == float("inf") or not low <= int(x) <= high:
            raise Stop("result out of range")
        self.variables[name] = int(x)

    def calculate(self, word: str, name: str, operand: str) -> None:
        a: Number | Fraction = self.value(name)
        b: Number | Fraction = self.value(operand)
        if word in ("SET", "DIN", "AIN"):
            self.store(name, b)
            return
        if word == "DIV" and b == 0:
            raise Stop("division by zero")
        if isinstance(a, int) and isinstance(b, int) and name[0] != "R":
            a, b = Fraction(a), Fraction(b)
        else:
            a, b = float(a), float(b)
        done = {"ADD": lambda: a + b, "SUB": lambda: a - b, "MUL": lambda: a * b}
        self.store(name, done.get(word, lambda: a / b)())

    def holds(self, condition: str) -> bool:
        m = re.fullmatch(r"(\S+?)(<=|>=|<>|=|<|>)(\S+)", condition.strip("()"))
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
            condition = words[words.index("IF") + 1]
        elif word in ("IF", "ELSEIF", "WHILE", "WAIT"):
            condition = words[1]
        if word == "ELSEIF" or word == "ELSE":  # the branch before has been done
            frame.at = self.scan(frame.at, 1, {"ENDIF"}) + 1
            return
        if "IN#" in text or "AI#" in text or word in ("WAIT", "TIMER"):
            yield from self.reach(line)
        frame.at += 1
        if word == "IF":
            while not self.holds(condition):
                frame.at = self.scan(frame.at - 1, 1, {"ELSEIF", "ELSE", "ENDIF"}) + 1
                there = self.jobs[frame.job][frame.at - 1][1]
                if not there.startswith("ELSEIF"):
                    return
                condition = there.split()[1]
                if "IN#" in there or "AI#" in there:
                    yield from self.reach(self.jobs[frame.job][frame.at - 1][0])
        elif word == "WHILE":
            if not self.holds(condition):
                frame.at = self.scan(frame.at - 1, 1, {"ENDWHILE"}) + 1
        elif word == "ENDWHILE":
            frame.at = self.scan(frame.at - 1, -1, {"WHILE"})
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
        elif word not in ("NOP", "ENDIF", "LABEL") and not word.startswith("*"):
            yield from self.simple(line, words)

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
            self.stack.append(Frame(words[1][4:]))
        elif words[1].startswith("JOB:"):
            self.stack[-1] = Frame(words[1][4:])
        else:
            frame.at = self.label(words[1].lstrip("*"))

    def simple(self, line: int, words: list[str]) -> Iterator[tuple]:
        word = words[0]
        if word in ("MOVJ", "MOVL", "MOVC"):
            yield from self.move(line, words)
        elif word == "SPEED":
            for tag, value in (w.split("=") for w in words[1:]):
                self.speed[tag] = float(value)
                self.usual = self.usual if tag == "VJ" else tag
        elif word in ("PL", "TOOL", "USER"):
            setattr(self, {"PL": "level"}.get(word, word.lower()), int(words[1]))
        elif word == "DOUT":
            n = int(words[1][4:-1]) - 1
            self.out = self.out & ~(1 << n) | (words[2] == "ON") << n
            yield "dout", line, self.moves, n, int(words[2] == "ON")
        elif word == "AOUT":
            volt = self.value(words[2])
            if not -10 <= volt <= 10:
                raise Stop("result out of range")
            yield "aout", line, self.moves, int(words[1][4:-1]) - 1, float(volt)
        elif word in ("INC", "DEC"):
            self.calculate({"INC": "ADD", "DEC": "SUB"}[word], words[1], "1")
        else:
            self.calculate(word, words[1], words[2])

    def move(self, line: int, words: list[str]) -> Iterator[tuple]:
        points = [int(w[1:]) for w in words[1:] if re.fullmatch(r"P\d+", w)]
        tags = dict(w.split("=") for w in words[1:] if "=" in w)
        path, via = "JLC".index(words[0][3]), 0
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
        )
