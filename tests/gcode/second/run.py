"""A whole program: its lines in the order in which O words and calls have them executed."""

from dataclasses import dataclass, field

from second.block import CYCLES, execute
from second.lines import Line, plain, read
from second.machine import restore
from second.parameters import LOCAL, LOCAL_FANUC, Parameters, Wrong
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
    file: str  # to which it returns
    shown: int  # line of the program in which it stands
    label: object
    style: str  # sub, program or main
    before: list[float | None] | None = None
    left: int = 0  # repeats of M98 or G65 still to do
    given: list[float | None] | None = None  # to each of them
    rest: bool = False  # the line that calls it is still to be executed
    loops: dict[object, list[float]] = field(default_factory=dict)  # repeats left, doing
    fanuc: list[tuple[int, int]] = field(default_factory=list)  # DO that run: number, line
    chosen: set[object] = field(default_factory=set)  # if with a branch done


class Program:
    """The lines of a text and the one that is next."""

    def __init__(self, text: str, options: Options) -> None:
        self.texts = {"": text.removeprefix("\ufeff").split("\n")}
        self.file = ""  # that is called, by its name
        self.read: dict[tuple[str, int], Line] = {}
        self.s = State(options)
        self.s.origin = [list(o) for o in options.origin] + [[0.0] * 6 for _ in range(99)]
        self.modal: tuple[int, Words, list[float | None]] | None = None  # depth of G66, its words
        self.s.point, self.s.feed = list(options.point), options.feed
        self.p: Parameters = self.s.parameters
        connect(self.s)
        self.p.fanuc = options.fanuc
        self.next = self.at = 0
        self.frames = [Frame(-1, "", 0, None, "main")]
        self.percent = self.called = False
        self.work = 0

    @property
    def lines(self) -> list[str]:
        """Those of the text that is read now."""
        return self.texts[self.file]

    def line(self, at: int) -> Line:
        """The tree of a line, by its index."""
        if (self.file, at) not in self.read:
            text = self.lines[at]
            colon = text.lstrip().startswith(":") and self.s.options.fanuc
            self.read[self.file, at] = read(
                text.replace(":", "O", 1) if colon else text, self.s.options.fanuc
            )
        return self.read[self.file, at]

    def shown(self) -> int:
        """The line of the program that is executed, of a call where it is in a file."""
        if not self.file:
            return self.at + 1
        return next(f.shown for f in reversed(self.frames) if not f.file and f.label is not None)

    def sub(self, label: object) -> int:
        """Go to the text with the sub of a label, and to its line."""
        for file in (self.file, "", str(label)):
            if file not in self.texts:
                folder = self.s.options.folder
                if folder is None or not (folder / f"{file}.ngc").is_file():
                    continue
                self.texts[file] = (folder / f"{file}.ngc").read_text().split("\n")
            before, self.file = self.file, file
            try:
                return self.find(label, ("sub",), 0)
            except Wrong:
                self.file = before
        raise Wrong(f"no sub {label}")

    def label(self, line: Line) -> object:
        """A number or a name."""
        if callable(line.label):
            value = plain(line.label(self.p))
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

    def leave(self, frame: Frame) -> None:
        """Back behind a call."""
        self.frames.pop()
        self.p.leave(frame.before)
        self.next, self.file = frame.back, frame.file
        self.called = frame.rest
        if (kept := self.s.saved.pop()).get("returns"):
            restore(self.s, kept)

    def value(self, line: Line) -> float:
        if len(line.arguments) != 1:
            raise Wrong("one value wanted")
        return plain(line.arguments[0](self.p))

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
        arguments: list[float | None] = [plain(a(self.p)) for a in line.arguments]
        if len(self.frames) > DEPTH_MAX:
            raise Wrong("calls too deep")
        file = self.file
        begin = self.sub(label)
        before = self.p.enter(arguments + [0.0] * (LOCAL - len(arguments)))
        self.frames.append(Frame(at + 1, file, self.s.line, label, "sub", before))
        self.s.saved.append({})
        self.next = begin + 1

    def on_endsub(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if frame.style != "sub" or frame.label != label:
            raise Wrong("end of a sub that was not called")
        if line.arguments:
            self.p.globals["_value"] = self.value(line)
            self.p.globals["_value_returned"] = 1.0
        self.leave(frame)

    def on_return(self, at: int, line: Line, label: object, frame: Frame) -> None:
        """It may have the label of an if or a loop around it."""
        self.on_endsub(at, line, frame.label, frame)

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

    # ---- Fanuc ----

    def around(self, at: int) -> range:
        """Lines of the numbered program that a line is in."""

        def heads(i: int) -> bool:
            try:
                line = self.line(i)
            except Wrong:
                return False
            return line.label is not None and line.order == ""

        begin = next((i for i in range(at, -1, -1) if heads(i)), 0)
        end = next((i for i in range(at + 1, len(self.lines)) if heads(i)), len(self.lines))
        return range(begin, end)

    def tree(self, at: int) -> Line:
        """A line; nothing if it is none, or passed over."""
        passed = self.lines[at].strip().startswith("/") and self.s.options.block_delete
        try:
            return Line() if passed else self.line(at)
        except Wrong:
            return Line()

    def counted(self, given: float | None, most: int) -> int:
        value = plain(given)
        if abs(value - round(value)) > NEAR or not 1 <= round(value) <= most:
            raise Wrong("number")
        return round(value)

    def end_of(self, loop: int, begin: int) -> int:
        """The END of a DO."""
        for at in self.around(begin):
            line = self.tree(at)
            if at > begin and line.order == "fanuc_end" and line.arguments[0](self.p) == loop:
                return at
        raise Wrong("DO without END")

    def jump(self, at: int, value: float | None) -> None:
        """GOTO."""
        number = self.counted(value, 99999999)
        found = [i for i in self.around(at) if self.tree(i).number == number]
        if not found:
            raise Wrong(f"no N{number}")
        self.next = next((i for i in found if i > at), found[0])
        loops = self.frames[-1].fanuc
        while loops and not loops[-1][1] < self.next <= self.end_of(*loops[-1]):
            loops.pop()

    def on_fanuc_goto(self, at: int, line: Line, label: object, frame: Frame) -> None:
        self.jump(at, line.arguments[0](self.p))

    def on_fanuc_if_goto(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if plain(line.arguments[0](self.p)) != 0.0:
            self.jump(at, line.arguments[1](self.p))

    def on_fanuc_if_then(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if plain(line.arguments[0](self.p)) != 0.0:
            self.put(line)

    def on_fanuc_do(self, at: int, line: Line, label: object, frame: Frame) -> None:
        loop = self.counted(line.arguments[-1](self.p), 3)
        if loop in [n for n, _ in frame.fanuc]:
            raise Wrong("DO within its own")
        if len(line.arguments) == 2 and plain(line.arguments[0](self.p)) == 0.0:
            self.next = self.end_of(loop, at) + 1
        else:
            frame.fanuc.append((loop, at))

    on_fanuc_while_do = on_fanuc_do

    def on_fanuc_end(self, at: int, line: Line, label: object, frame: Frame) -> None:
        if not frame.fanuc or frame.fanuc[-1][0] != line.arguments[0](self.p):
            raise Wrong("END without its DO")
        self.next = frame.fanuc.pop()[1]

    def put(self, line: Line) -> None:
        """What a line sets, all of it read before."""
        new = [(t if isinstance(t, str) else t(self.p), v(self.p)) for t, v in line.settings]
        for target, value in new:
            self.p.set(target, value)

    # ---- numbered programs ----

    def call(self, at: int, w: Words, given: list[float | None] | None = None) -> None:
        """P L of M98 or G65: a program further down, with #1 .. of its own if they are given.

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
            before = self.p.enter(given)
            line = self.s.line
            frame = Frame(at + 1, self.file, line, number, "program", before, times - 1, given)
            self.frames.append(frame)
            self.s.saved.append({})
            self.next = begin + 1

    def user(self, at: int, numbers: list[int], values: dict[str, float]) -> None:
        """M100 to M199: a sub with P and Q, before the rest of the line."""
        if len(numbers) > 1 or len(self.frames) > DEPTH_MAX:
            raise Wrong("two user commands, or too deep")
        file, label = self.file, f"m{numbers[0]}"
        begin = self.sub(label)
        given: list[float | None] = [values.get("p", -1.0), values.get("q", -1.0)]
        before = self.p.enter(given + [0.0] * (LOCAL - 2))
        self.frames.append(Frame(at, file, self.s.line, label, "sub", before, rest=True))
        self.s.saved.append({})
        self.next = begin + 1

    def macro(self, at: int, pairs: list[tuple[str, float]]) -> None:
        """G65, G66: letters are the parameters of the program that it calls."""
        given: list[float | None] = [None] * LOCAL_FANUC
        places = {c: [n] for c, n in MACRO.items() if c not in "ijk"}
        places |= {c: [4 + i + 3 * n for n in range(10)] for i, c in enumerate("ijk")}
        group, latest = -1, "z"
        for letter, value in pairs[1:]:
            if letter in "ijk":
                group, latest = group + (letter <= latest), letter
                if group > 9:
                    raise Wrong("too many I J K")
                given[places[letter][group] - 1] = value
            elif letter in MACRO:
                if not places[letter]:
                    raise Wrong("argument given twice")
                given[places[letter].pop() - 1] = value
        w = Words([(c, v) for c, v in pairs[1:] if c not in MACRO], False)
        if w.code or w.rest() - set("pl"):
            raise Wrong("no argument of G65")
        if pairs[0][1] == 65.0:
            self.call(at, w, given)
            return
        number = w.whole("p", 0, 99999999)
        self.find(number if w.has("l") else number % 10000, ("",), 0)
        if self.modal:
            raise Wrong("G66 within G66")
        self.modal = len(self.frames), w, given

    def again(self, at: int, w: Words) -> None:
        """The call of G66 behind a line that moves; G67 ends it."""
        if "modal" in w.code:
            self.modal = None
        if not self.modal or self.modal[0] != len(self.frames) or self.s.ended:
            return
        other, length = w.code.get("other"), w.code.get("length")
        moves = other in (None, 280, 300, 530) or (other == 40 and w.has("p"))
        if not w.has(w.axes + "@^") or not moves or length in (431, 432):
            return
        if w.code.get("scale") == 510 or w.code.get("turn") == 680:
            return
        if self.s.motion in CYCLES or self.s.nurbs:
            raise Wrong("cycle while G66 is in force")
        self.call(at, *self.modal[1:])

    def come_back(self) -> None:
        """M99."""
        frame = self.frames[-1]
        if frame.style == "main" and self.s.nurbs:
            raise Wrong("no G5.3 before M99")
        if frame.style == "main":
            self.s.ended = True
        elif frame.style == "sub":
            raise Wrong("M99 in a sub")
        elif frame.left:
            frame.left -= 1
            self.p.give(frame.given)
            self.next = self.find(frame.label, ("",), 0) + 1
        else:
            self.leave(frame)
            if self.modal:
                self.modal = min(self.modal[0], len(self.frames)), *self.modal[1:]

    def step(self) -> None:
        """Execute the next line."""
        self.at = at = self.next
        self.next += 1
        self.s.line = self.shown()
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
        values = [(c, v(self.p)) for c, v in line.words]
        pairs = [(c, v) for c, v in values if v is not None]
        user = [round(v) for c, v in pairs if c == "m" and 100 <= v < 200 and v == round(v)]
        called, self.called = self.called, False
        if user and not called:
            self.user(at, user, dict(pairs))
            return
        self.put(line)
        if self.s.options.fanuc and pairs[:1] in ([("g", 65.0)], [("g", 66.0)]):
            self.macro(at, pairs)
            return
        words = Words(pairs, self.s.options.angles, line.whole, self.s.options.fanuc)
        if words.code.get("call"):
            self.call(at, words)
        execute(self.s, words)
        self.again(at, words)
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
            line = error.line if isinstance(error, Wrong) and error.line else program.at + 1
            return s.steps[: s.contour_from if s.edge else None], Refused(line, str(error))
    return s.steps, Refused(s.nurbs_line, "no G5.3") if s.nurbs else None
