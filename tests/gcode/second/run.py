"""A whole program: its lines in the order in which O words and calls have them executed."""

from dataclasses import dataclass, field

from second.block import execute
from second.lines import Line, read
from second.parameters import LOCAL, Parameters, Wrong
from second.state import Options, Refused, State, Step
from second.system import connect
from second.words import NEAR, Words

STEPS_MAX = 1_000_000  # lines executed
DEPTH_MAX = 10
MACRO = dict(zip("abcijkdefhmqrstuvwxyz", (*range(1, 10), 11, 13, *range(17, 27)), strict=True))
ENDS = {"while": "endwhile", "repeat": "endrepeat", "sub": "endsub"}


@dataclass
class Frame:
    """A call: where it returns to, what it hides, and its loops."""

    back: int
    label: object
    style: str  # sub, program or main
    before: dict[int, float] = field(default_factory=dict)
    left: int = 0  # repeats of M98 or G65 still to do
    given: list[float] | None = None  # to each of them
    loops: dict[object, list[float]] = field(default_factory=dict)  # repeats left, doing
    chosen: set[object] = field(default_factory=set)  # if with a branch done


class Program:
    """The lines of a text and the one that is next."""

    def __init__(self, text: str, options: Options) -> None:
        self.lines = text.removeprefix("\ufeff").split("\n")
        self.read: dict[int, Line] = {}
        self.s = State(options)
        self.s.origin = [list(o) for o in options.origin]
        self.s.point, self.s.feed = list(options.point), options.feed
        self.p: Parameters = self.s.parameters
        connect(self.s)
        self.next = 0
        self.frames = [Frame(-1, None, "main")]
        self.percent = False
        self.work = 0

    def line(self, at: int) -> Line:
        """The tree of a line, by its index."""
        if at not in self.read:
            self.read[at] = read(self.lines[at])
        return self.read[at]

    def label(self, line: Line) -> object:
        """A number or a name."""
        if callable(line.label):
            value = line.label(self.p)
            if abs(value - round(value)) > NEAR or value < 0.0:
                raise Wrong("label")
            return round(value)
        return line.label

    def find(self, label: object, orders: tuple[str, ...], begin: int) -> int:
        """The first line from `begin` on that gives one of the orders to a label."""
        for at in range(begin, len(self.lines)):
            try:
                line = self.line(at)
                if line.label is None or line.order not in orders:
                    continue
                if self.label(line) == label:
                    return at
            except Wrong:
                continue
        raise Wrong(f"no {'/'.join(orders)} of {label}")

    def value(self, line: Line) -> float:
        if len(line.arguments) != 1:
            raise Wrong("one value wanted")
        return line.arguments[0](self.p)

    # ---- orders ----

    def flow(self, at: int, line: Line) -> None:
        """Execute an O word."""
        label, frame = self.label(line), self.frames[-1]
        order = line.order
        getattr(self, f"on_{order or 'number'}")(at, line, label, frame)

    def on_number(self, at: int, line: Line, label: object, frame: Frame) -> None:
        """O and a number alone: the name of a program."""

    def on_sub(self, at: int, line: Line, label: object, frame: Frame) -> None:
        self.next = self.find(label, ("endsub",), at) + 1

    def on_call(self, at: int, line: Line, label: object, frame: Frame) -> None:
        arguments = [a(self.p) for a in line.arguments]
        if len(self.frames) > DEPTH_MAX:
            raise Wrong("calls too deep")
        begin = self.find(label, ("sub",), 0)
        before = self.p.enter(arguments + [0.0] * (LOCAL - len(arguments)))
        self.frames.append(Frame(at + 1, label, "sub", before))
        self.next = begin + 1

    def on_endsub(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if frame.style != "sub" or frame.label != label:
            raise Wrong("end of a sub that was not called")
        if line.arguments:
            self.p.globals["_value"] = self.value(line)
            self.p.globals["_value_returned"] = 1.0
        self.frames.pop()
        self.p.leave(frame.before)
        self.next = frame.back

    on_return = on_endsub

    def on_if(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if self.value(line) != 0.0:
            frame.chosen.add(label)
            return
        frame.chosen.discard(label)
        self.branch(at + 1, label, frame)

    def branch(self, at: int, label: object, frame: Frame) -> None:
        """The first branch from here on whose condition holds."""
        while True:
            at = self.find(label, ("elseif", "else", "endif"), at)
            found = self.line(at)
            if found.order != "elseif" or self.value(found) != 0.0:
                break
            at += 1
        if found.order != "endif":
            frame.chosen.add(label)
        self.next = at + 1

    def on_else(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if label not in frame.chosen:
            raise Wrong("branch without if")
        self.next = self.find(label, ("endif",), at)

    on_elseif = on_else

    def on_endif(self, at: int, line: Line, label: object, frame: Frame) -> None:
        frame.chosen.discard(label)

    def on_do(self, at: int, line: Line, label: object, frame: Frame) -> None:
        frame.loops[label] = [-1.0, float(at)]

    def on_while(self, at: int, line: Line, label: object, frame: Frame) -> None:
        holds = self.value(line) != 0.0
        if label in frame.loops and frame.loops[label][0] == -1.0:
            if holds:
                self.next = int(frame.loops[label][1]) + 1
            else:
                del frame.loops[label]
            return
        if not holds:
            self.next = self.find(label, ("endwhile",), at) + 1
            frame.loops.pop(label, None)
        else:
            frame.loops[label] = [-2.0, float(at)]

    def on_endwhile(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if label not in frame.loops:
            raise Wrong("end without while")
        self.next = int(frame.loops[label][1])

    def on_repeat(self, at: int, line: Line, label: object, frame: Frame) -> None:
        times = round(self.value(line))
        if times < 1:
            self.next = self.find(label, ("endrepeat",), at) + 1
        else:
            frame.loops[label] = [float(times), float(at)]

    def on_endrepeat(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if label not in frame.loops:
            raise Wrong("end without repeat")
        frame.loops[label][0] -= 1.0
        if frame.loops[label][0] > 0.0:
            self.next = int(frame.loops[label][1]) + 1
        else:
            del frame.loops[label]

    def bottom(self, label: object, frame: Frame) -> int:
        """The last line of a loop."""
        if label not in frame.loops:
            raise Wrong("not in a loop")
        kind, begin = frame.loops[label]
        end = "while" if kind == -1.0 else "endwhile" if kind == -2.0 else "endrepeat"
        return self.find(label, (end,), int(begin) + 1)

    def on_break(self, at: int, line: Line, label: object, frame: Frame) -> None:
        self.next = self.bottom(label, frame) + 1
        del frame.loops[label]

    def on_continue(self, at: int, line: Line, label: object, frame: Frame) -> None:
        self.next = self.bottom(label, frame)

    # ---- numbered programs ----

    def call(self, at: int, w: Words, given: list[float] | None = None) -> None:
        """P L of M98 or G65: a program further down, with #1 to #30 of its own if they are given.

        Fanuc's controls may write how often in front of the four digits of its number.
        """
        number, times = w.whole("p", 0, 99999999), 1
        if w.has("l"):
            times = w.whole("l", 0, 99999)
        elif self.s.options.fanuc and number >= 10000:
            times, number = divmod(number, 10000)
        if len(self.frames) > DEPTH_MAX:
            raise Wrong("calls too deep")
        begin = self.find(number, ("",), 0)
        if times:
            frame = Frame(at + 1, number, "program", self.p.enter(given), times - 1, given)
            self.frames.append(frame)
            self.next = begin + 1

    def macro(self, at: int, pairs: list[tuple[str, float]]) -> None:
        """G65: letters are the parameters of the program that it calls."""
        given = [0.0] * LOCAL
        for letter, value in pairs[1:]:
            if letter in MACRO:
                given[MACRO[letter] - 1] = value
        w = Words([(c, v) for c, v in pairs[1:] if c not in MACRO], False)
        self.call(at, w, given)
        if w.rest() or w.code:
            raise Wrong("no argument of G65")

    def come_back(self) -> None:
        """M99."""
        frame = self.frames[-1]
        if frame.style == "main":
            self.s.ended = True
        elif frame.style == "sub":
            raise Wrong("M99 in a sub")
        elif frame.left:
            frame.left -= 1
            self.p.give(frame.given)
            self.next = self.find(frame.label, ("",), 0) + 1
        else:
            self.frames.pop()
            self.p.leave(frame.before)
            self.next = frame.back

    def step(self) -> None:
        """Execute the next line."""
        at = self.next
        self.next += 1
        self.s.line = at + 1
        text = self.lines[at]
        if text.strip().startswith("/") and self.s.options.block_delete:
            return
        line = self.line(at)
        if line.percent:
            self.s.ended = self.percent
            self.percent = True
            return
        if line.label is not None:
            self.flow(at, line)
            return
        pairs = [(c, v(self.p)) for c, v in line.words]
        new = [(t if isinstance(t, str) else t(self.p), v(self.p)) for t, v in line.settings]
        for target, value in new:
            self.p.set(target, value)
        if self.s.options.fanuc and pairs[:1] == [("g", 65.0)]:
            self.macro(at, pairs)
            return
        words = Words(pairs, self.s.options.angles, line.whole)
        if words.code.get("call"):
            self.call(at, words)
        execute(self.s, words)
        if words.code.get("stop") == 99:
            self.come_back()


def run(text: str, options: Options | None = None) -> tuple[list[Step], Refused | None]:
    """The steps of a program up to its end or its first fault, and that fault."""
    program = Program(text, options or Options())
    s = program.s
    while not s.ended and program.next < len(program.lines):
        program.work += 1
        made = len(s.steps)
        try:
            if program.work > STEPS_MAX:
                raise Wrong("too many lines executed")
            program.step()
        except (Wrong, OverflowError) as error:
            del s.steps[made:]
            line = error.line if isinstance(error, Wrong) and error.line else s.line
            return s.steps[: s.contour_from if s.edge else None], Refused(line, str(error))
    return s.steps, None
