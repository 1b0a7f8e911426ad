"""Programs at random in the robot language, against an interpreter that shares nothing with it."""

import ctypes
from typing import Any

import hypothesis.strategies as st
from conftest import ROOT
from hypothesis import HealthCheck, event, given, settings
from robot_job_brute import Brute, Endless

LIBRARY = ctypes.CDLL(str(ROOT / "build/lib/robot_job_steps.so"))
LIBRARY.robot_job_steps_fault.restype = ctypes.c_char_p
ANSWERS = ("move", "dout", "aout", "reach", "wait", "busy", "pause", "end", "fault")
POINTS = """
TOOL 1 X=0 Y=0 Z=150 A=0 B=0 C=0
USER 2 X=900 Y=-300 Z=200 A=0 B=0 C=90
P000 J1=0 J2=-20 J3=10 J4=0 J5=90 J6=0
P001 X=900 Y=0 Z=350 A=180 B=0 C=0 TOOL=1
P002 X=1000 Y=100 Z=350 A=180 B=0 C=0
P003 X=1100 Y=0 Z=350 A=180 B=0 C=0
P004 X=0 Y=0 Z=0 A=180 B=0 C=0 USER=2 TOOL=0
P005 X=0 Y=10 Z=-5 A=0 B=0 C=0
"""
FRAMES = {0: (-1, -1), 1: (1, -1), 2: (-1, -1), 3: (-1, -1), 4: (0, 2)}  # tool, user
PATIENCE = 2000  # lines that nobody sees, before a program is taken for endless
MOST = 4 * PATIENCE  # instructions a call: a line has three at most
CYCLE = 100_000  # [ns]
CYCLES = 150
QUEUE = 8  # requests a cycle
JOBS = ("MAIN", "SUB", "OTHER")


def picked(*values: object) -> st.SearchStrategy[str]:
    return st.sampled_from([str(v) for v in values])


WHOLE = picked("B000", "B1", "I000", "I001", "D000", "D1", "LB000", "LD009")
REAL = picked("R000", "R001", "LR000")
VARIABLE = WHOLE | REAL
CONSTANT = picked(0, 1, 2, 3, -1, 100, -7)
OUTPUT = picked("OT#(1)", "OT#(2)", "OT#(32)")
INPUT = picked("IN#(1)", "IN#(2)", "IN#(32)")
GROUP = picked("IG#(1)", "IG#(4)", "OG#(1)", "OG#(4)")
COMPARED = st.builds(
    "{}{}{}".format, VARIABLE | GROUP, picked("=", "<>", "<", ">", "<=", ">="), CONSTANT | VARIABLE
)
SIGNAL = st.builds("{}{}{}".format, INPUT | OUTPUT, picked("=", "<>"), picked("ON", "OFF"))
ANALOG = st.builds("AI#({}){}{}".format, picked(1, 8), picked("<", ">="), picked(0, 0.5, "R000"))
ONE = COMPARED | SIGNAL | ANALOG | st.builds("({})".format, COMPARED | SIGNAL)
PLAIN = COMPARED | SIGNAL | ANALOG
CONDITION = (
    ONE
    | st.builds(
        lambda word, parts: f" {word} ".join(parts),
        picked("AND", "OR"),
        st.lists(ONE, min_size=2, max_size=3),
    )
    | st.builds("({} {} {})".format, PLAIN, picked("AND", "OR"), PLAIN)
)
MAYBE_IF = st.just("") | st.builds(" IF {}".format, CONDITION)
SECONDS = picked("0.00", "0.0001", "0.00025", "0.001")
ZONE = picked("", " PL=0", " PL=3", " CR=2.5")
TAGS = st.builds("{}{}".format, picked("", " V=10.0", " VR=7.5"), ZONE)
ARC = st.builds(
    lambda start, tags, end: f"MOVC {start}{tags}\nMOVC P002{tags}\n' via\nMOVC P003{tags}\n{end}",
    picked("P001", "P002"),
    TAGS,
    picked("NOP", "DOUT OT#(4) ON"),
)
ROW = st.lists(st.builds("MOVS P00{}{}".format, picked(1, 2, 3), TAGS), min_size=1, max_size=5).map(
    "\n".join
)
NWAIT = picked("", "", " NWAIT")
ARGUMENTS = st.builds(
    "".join, st.lists(st.builds(" ARGF{}".format, CONSTANT | VARIABLE), max_size=2)
)
SIMPLE = st.one_of(
    st.builds("MOVJ P00{}{}{}{}".format, picked(0, 1, 4), picked("", " VJ=50.00"), ZONE, NWAIT),
    st.builds("MOVL P00{}{}{}".format, picked(0, 1, 2, 4), TAGS, NWAIT),
    picked("CWAIT", "SFTON P005", "SFTON P005 UF#(2)", "SFTON P005 BF", "SFTOF", 'MSG "words"'),
    st.builds("DOUT {} {}".format, picked("OG#(1)", "OG#(4)"), picked(0, 1, 255) | WHOLE),
    st.builds("DIN {} {}".format, WHOLE, GROUP),
    st.builds("PULSE {}{}".format, OUTPUT, picked("", " T=0.01", " T=1.50")),
    st.builds("GETARG {} IARG#({})".format, VARIABLE, picked(1, 2)),
    st.builds("MOVC P002 P003{}\nNOP".format, TAGS),
    ARC,
    ROW,
    picked("SPEED VJ=20", "SPEED V=50 VR=5", "SPEED VR=3 VJ=30", "SPEED V=77"),
    picked("PL 2", "PL 0", "TOOL 1", "TOOL 0", "USER 2", "USER 0", "NOP", "' says nothing"),
    st.builds("DOUT {} {}".format, OUTPUT, picked("ON", "OFF")),
    st.builds("AOUT AO#({}) {}".format, picked(1, 8), picked(0, 2.5, -10) | VARIABLE),
    st.builds("DIN {} {}".format, WHOLE, INPUT | OUTPUT),
    st.builds("AIN {} AI#({})".format, REAL, picked(1, 8)),
    st.builds("SET {} {}".format, WHOLE, picked(0, 1, 5, 100) | VARIABLE),
    st.builds("SET {} {}".format, REAL, picked(0, 1, -0.75, 1000) | VARIABLE),
    st.builds("{} {} {}".format, picked("ADD", "SUB", "MUL", "DIV"), VARIABLE, CONSTANT | VARIABLE),
    st.builds("{} {}".format, picked("INC", "DEC"), WHOLE),
    st.builds("WAIT {}{}".format, CONDITION, st.builds(" T={}".format, SECONDS)),
    st.builds("WAIT {}".format, SIGNAL),
    st.builds("TIMER T={}".format, SECONDS),
    st.builds("PAUSE{}".format, MAYBE_IF),
    st.builds("RET IF {}".format, CONDITION),
    st.builds("CALL JOB:{}{}{}".format, picked(*JOBS), ARGUMENTS, MAYBE_IF),
    st.builds("JUMP JOB:{} IF {}".format, picked(*JOBS), CONDITION),
)


class Writer:
    """Writes one job; labels may be jumped to from their own LOOP and from inside it."""

    def __init__(self, draw: Any):
        self.draw = draw
        self.labels = 0
        self.jumps: list[tuple[int, list[list[str]]]] = []
        self.lines: list[str] = []

    def block(self, depth: int, scopes: list[list[str]]) -> None:
        for _ in range(self.draw(st.integers(1, 5))):
            blocks = ("if", "loop", "while", "for", "switch") * (depth < 3)
            kinds = ("simple",) * 6 + ("label", "jump") + blocks
            getattr(self, self.draw(st.sampled_from(kinds)) + "_")(depth, scopes)

    def simple_(self, depth: int, scopes: list[list[str]]) -> None:
        self.lines += self.draw(SIMPLE).split("\n")

    def label_(self, depth: int, scopes: list[list[str]]) -> None:
        name = f"L{self.labels}"
        self.labels += 1
        scopes[-1].append(name)
        self.lines.append(self.draw(picked(f"*{name}", f"LABEL {name}")))

    def jump_(self, depth: int, scopes: list[list[str]]) -> None:
        self.jumps.append((len(self.lines), scopes))
        self.lines.append(self.draw(MAYBE_IF))

    def if_(self, depth: int, scopes: list[list[str]]) -> None:
        self.lines.append(self.draw(picked("IF", "IFTHEN")) + " " + self.draw(CONDITION))
        self.block(depth + 1, scopes)
        for _ in range(self.draw(st.integers(0, 2))):
            self.lines.append("ELSEIF " + self.draw(CONDITION))
            self.block(depth + 1, scopes)
        if self.draw(st.booleans()):
            self.lines.append("ELSE")
            self.block(depth + 1, scopes)
        self.lines.append("ENDIF")

    def loop_(self, depth: int, scopes: list[list[str]]) -> None:
        self.lines.append("LOOP" + self.draw(picked("", " 0", " 1", " 2", " 5", " I000", " B000")))
        self.block(depth + 1, [*scopes, []])
        self.lines.append("ENDLOOP")

    def for_(self, depth: int, scopes: list[list[str]]) -> None:
        name = self.draw(WHOLE)
        begin, end = self.draw(picked(0, 1, 3) | WHOLE), self.draw(picked(0, 2, 4) | WHOLE)
        step = self.draw(picked("", " STEP 2", " STEP -1"))
        self.lines.append(f"FOR {name}{self.draw(picked('=', ' = '))}{begin} TO {end}{step}")
        self.block(depth + 1, scopes)
        self.lines.append(f"NEXT {name}")

    def switch_(self, depth: int, scopes: list[list[str]]) -> None:
        self.lines.append("SWITCH " + self.draw(WHOLE | GROUP))
        for _ in range(self.draw(st.integers(0, 2))):
            self.lines.append("CASE " + self.draw(picked(0, 1, "0,5", "B000,3") | WHOLE))
            self.block(depth + 1, scopes)
        if self.draw(st.booleans()):
            self.lines.append("DEFAULT")
            self.block(depth + 1, scopes)
        self.lines.append("ENDSWITCH")

    def while_(self, depth: int, scopes: list[list[str]]) -> None:
        self.lines.append("WHILE " + self.draw(CONDITION))
        self.block(depth + 1, scopes)
        self.lines.append("ENDWHILE")

    def text(self, name: str) -> list[str]:
        self.block(0, [[]])
        for at, scopes in self.jumps:
            labels = [name for scope in scopes for name in scope]
            condition = self.lines[at]
            self.lines[at] = "NOP"
            if labels:
                star = self.draw(picked("*", ""))
                self.lines[at] = f"JUMP {star}{self.draw(st.sampled_from(labels))}{condition}"
        return [f"JOB {name}", *self.lines, *(["END"] if self.draw(st.booleans()) else [])]


@st.composite
def programs(draw: Any) -> str:
    return "\n".join(line for name in JOBS for line in Writer(draw).text(name)) + "\n"


class Core:
    """The core through its test library."""

    def load(self, text: str) -> str:
        message = ctypes.create_string_buffer(420)
        LIBRARY.robot_job_steps_load(POINTS.encode(), text.encode(), message)
        return message.value.decode()

    def next(self, brute: Brute) -> tuple[object, ...]:
        """The next request, in the terms of the other one."""
        w = brute.world
        r = (ctypes.c_double * 20)()
        LIBRARY.robot_job_steps_next(
            ctypes.c_int64(w.now),
            ctypes.c_int64(w.reached),
            ctypes.c_uint32(w.di),
            (ctypes.c_double * 8)(*w.ai),
            MOST,
            r,
        )
        kind, head = ANSWERS[int(r[0])], (ANSWERS[int(r[0])], int(r[1]), int(r[2]))
        if kind == "move":
            return (*head, *r[3:12], r[16], r[17])
        if kind == "dout":
            return (*head, r[12], r[18], r[13], r[19])
        if kind == "aout":
            return (*head, r[12], r[14])
        if kind == "fault":
            return (*head, LIBRARY.robot_job_steps_fault(int(r[15])).decode())
        return head

    def variables(self) -> dict[str, float]:
        v = (ctypes.c_double * 400)()
        LIBRARY.robot_job_steps_variables(v)
        return {f"{'BIDR'[i // 100]}{i % 100}": x for i, x in enumerate(v)}


def compare(text: str, inputs: list[int], volts: list[float], slow: int) -> str:
    """Both through the same cycles; what the last answer was."""
    core = Core()
    assert core.load(text) == "", text
    brute = Brute(text, FRAMES, PATIENCE)
    requests = brute.run()
    since, kind = 0, ""
    for n in range(CYCLES):
        w = brute.world
        w.now = n * CYCLE
        w.di = inputs[n * len(inputs) // CYCLES]
        w.ai = [volts[n * len(volts) // CYCLES]] * 8
        since = since + 1 if w.reached < brute.moves else 0
        if since >= slow:
            w.reached, since = w.reached + 1, 0
        for _ in range(QUEUE):
            try:
                wanted = next(requests)
            except Endless:
                return "endless"
            assert core.next(brute) == wanted, text
            kind = wanted[0]
            if kind in ("end", "fault"):
                same_variables(core, brute)
                return kind
            if kind in ("reach", "wait", "pause"):
                break
    same_variables(core, brute)
    return f"still {kind}"


def same_variables(core: Core, brute: Brute) -> None:
    mine = core.variables()
    other = {f"{k[0]}{int(k[1:])}" for k in brute.variables}
    for name, value in brute.variables.items():
        assert mine[f"{name[0]}{int(name[1:])}"] == value, name
    assert all(value == 0 for name, value in mine.items() if name not in other)


@given(
    programs(),
    st.lists(st.sampled_from([0, 1, 2, 3, 1 << 31, 0xFFFFFFFF]), min_size=1, max_size=12),
    st.lists(st.sampled_from([0.0, 0.5, -3.0, 9.75]), min_size=1, max_size=5),
    st.integers(1, 4),
)
@settings(max_examples=100, suppress_health_check=list(HealthCheck))
def test_programs_at_random_ask_for_the_same(
    text: str, inputs: list[int], volts: list[float], slow: int
) -> None:
    event(compare(text, inputs, volts, slow))


def test_a_program_by_hand_comes_to_its_end() -> None:
    text = """JOB MAIN
LOOP 3
CALL JOB:PICK
IF IN#(1)=ON
MOVL P001 V=50 CR=5
ELSE
MOVC P002 P003 PL=1
ENDIF
ENDLOOP
JOB PICK
INC B000
DOUT OT#(1) ON
MOVJ P000 VJ=20
TIMER T=0.001
RET
"""
    assert compare(text, [1, 0], [0.0], 3) == "end"
    assert Core().load(text.replace("P001", "P101")) == (
        'line 5: point not in the points file "P101"'
    )
