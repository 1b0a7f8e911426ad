"""Senders that count characters, with real-time bytes at any instant: nothing lost, nothing twice.

MOTIONFMU_FUZZ=600 draws other inputs for so many seconds each.
"""

import os
import re
import time
from collections import deque
from typing import Any

from grbl_fake import HOMES, GrblDialogue
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from motionfmu.live.grbl.line_input import ROOM, LineInput

SECONDS = float(os.environ.get("MOTIONFMU_FUZZ", "0"))
ROUND = 200
# Lines, and what is answered whatever came before them.
LINES = [
    ("G1X{k}F100", "ok"),
    ("g1 x {k} y 2 f100 (one (comment) ; and another", "ok"),
    ("N{k}G0Z-{k}", "ok"),
    ("G4P0.01", "ok"),
    ("M3S{k}", "ok"),
    ("", "ok"),
    ("(nothing)", "ok"),
    ("G5X{k}", "error:20"),
    ("G1X{k}X{k}", "error:25"),
    ("={k}", "error:1"),
    ("G38.2X{k}F0", "error:22"),
    ("T{k}999", "error:38"),
    ("G0" + "Y1" * 41, "error:11"),
    ("$G1", "error:3"),
]
# Bytes that act at once and leave the stream alone.
KEYS = b"?\x90\x91\x92\x93\x94\x95\x96\x97\x99\x9a\x9b\x9c\x9d\xa0\xa1\x80\xff\x86"
HELD = b"!\x84"
BUFFER = re.compile(r"\|Bf:(\d+),(\d+)\|")


def search(strategy: st.SearchStrategy[Any], body: Any, examples: int) -> None:
    """Try a few inputs, the same ones each time; or others for SECONDS."""
    quiet: dict[str, Any] = {"deadline": None, "suppress_health_check": list(HealthCheck)}
    if not SECONDS:
        settings(derandomize=True, max_examples=examples, **quiet)(given(strategy)(body))()
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        settings(max_examples=ROUND, **quiet)(given(strategy)(body))()


class CountingSender:
    """Sends as Grbl's documentation recommends, and holds the answers against its lines."""

    def __init__(self, dialogue: GrblDialogue, lines: list[str]) -> None:
        self.dialogue, self.lines = dialogue, lines
        self.left = deque("".join(line + "\n" for line in lines).encode("ascii"))
        self.flying: deque[int] = deque()  # bytes of whole lines that have no answer
        self.begun = self.next = 0  # bytes sent of the line under way, and its number
        self.answers: list[str] = []
        self._text = ""

    def room(self) -> int:
        """Bytes that may be sent, so that the next whole line fits."""
        size = len(self.lines[self.next]) + 1 if self.next < len(self.lines) else 0
        return size - self.begun if sum(self.flying) + size <= ROOM else 0

    def send(self, most: int) -> None:
        """Send up to so many bytes."""
        count = min(most, self.room(), len(self.left))
        data = bytes(self.left.popleft() for _ in range(count))
        if not data:
            return
        self.begun += len(data)
        if data.endswith(b"\n"):
            self.flying.append(self.begun)
            self.begun, self.next = 0, self.next + 1
        self.dialogue.controller.receive(data)

    def look(self) -> None:
        """Take answers and reports."""
        self._text += self.dialogue.look()
        *lines, self._text = self._text.split("\r\n")
        for line in lines:
            if line == "ok" or line.startswith("error:"):
                assert self.flying, f"{line} that nobody has asked for"
                self.answers.append(line)
                self.flying.popleft()
            elif found := BUFFER.search(line):
                self.reported(int(found[2]))

    def reported(self, room: int) -> None:
        """The buffer has what is not answered, with or without the line that is being done."""
        whole, first = sum(self.flying) + self.begun, self.flying[0] if self.flying else self.begun
        assert room in (ROOM - whole, ROOM - whole + first), (room, whole, first)


def streamed(plan: tuple[list[int], list[tuple[int, int]]]) -> None:
    chosen, events = plan
    lines = [LINES[c][0].format(k=k) for k, c in enumerate(chosen)]
    dialogue = GrblDialogue(looks=2)
    dialogue.begun().say("$10=3\n")
    given_before = len(dialogue.machine.lines)
    sender = CountingSender(dialogue, lines)
    turns = 0
    for size, key in events:
        sender.send(size)
        if key < len(KEYS):
            dialogue.controller.receive(KEYS[key : key + 1])
        elif key < len(KEYS) + len(HELD):
            dialogue.controller.receive(HELD[key - len(KEYS) :][:1])
        sender.look()
    while len(sender.answers) < len(lines):
        sender.send(ROOM)
        dialogue.controller.receive(b"~?")
        sender.look()
        turns += 1
        assert turns < 40 * len(lines) + 200, (sender.answers, lines)
    dialogue.look(5)
    dialogue.say("~", 60)
    assert sender.answers == [LINES[c][1] for c in chosen]
    assert dialogue.controller.input.lost == 0
    taken = [line for line in dialogue.machine.lines[given_before:] if not line.startswith("G17")]
    assert taken == [given_as(line) for line, c in zip(lines, chosen, strict=True) if moves(c)]


def moves(chosen: int) -> bool:
    """Whether a line goes to the library."""
    text, answer = LINES[chosen]
    return answer == "ok" and text[:1] not in ("", "(", "$")


def given_as(line: str) -> str:
    """As the library gets it: without spaces, comments, number."""
    text = re.sub(r"\(.*|;.*|\s", "", line).upper()
    return re.sub(r"^N\d+", "", text)


def plans() -> st.SearchStrategy[tuple[list[int], list[tuple[int, int]]]]:
    lines = st.lists(st.integers(0, len(LINES) - 1), min_size=1, max_size=40)
    key = st.integers(0, 3 * (len(KEYS) + len(HELD)))
    return st.tuples(lines, st.lists(st.tuples(st.integers(0, ROOM), key), max_size=80))


def test_each_line_has_one_answer_in_its_turn() -> None:
    search(plans(), streamed, 150)


def test_a_reset_leaves_a_session_as_it_was_at_first() -> None:
    def run(before: bytes) -> None:
        dialogue = GrblDialogue(looks=2).begun()
        dialogue.controller.receive(before.replace(b"$N", b"$M"))  # start lines are kept
        dialogue.look(5)
        dialogue.say("\x18", 400)
        dialogue.controller.receive(b"$X\n")
        dialogue.look(5)
        reports = dialogue.say("$10=3\n?", 30)
        assert reports[-1].startswith("<Idle|"), (before, reports)
        assert "|Bf:255,128|" in reports[-1]
        told = dialogue.say("$G\nG1X1F100\nG1X2\nG6\n", 60)
        assert told == [
            "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]",
            "ok",
            "ok",
            "ok",
            "error:20",
        ]
        assert "G17G21G90G94G54" in dialogue.machine.lines

    search(st.one_of(st.binary(max_size=60), talk()), run, 150)


def talk() -> st.SearchStrategy[bytes]:
    """Pieces of what senders say, in any order."""
    pieces = [line.format(k=7) + "\n" for line, _ in LINES]
    pieces += ["$J=X10F100\n", "$C\n", "$SLP\n", "$H\n", "$#\n", "$$\n", "$I\n", "$N\n", "M0\n"]
    pieces += ["M30\n", "$RST=*\n", "G38.2X5F10\n", "\x18", "!", "~", "?", "\x84", "\x85", "$X\n"]
    pieces += ["G2X1Y1I1J0F1\n", "G20\n", "G91\n", "G10L20P0X0Y0Z0\n", "G92X1\n", "\x9e", "$N0="]
    return st.lists(st.sampled_from(pieces), max_size=30).map(
        lambda found: "".join(found).encode("latin-1")
    )


def test_no_bytes_break_a_session() -> None:
    def run(chunks: list[bytes]) -> None:
        for parameters in (None, HOMES):
            dialogue = GrblDialogue(parameters).begun()
            ends = answers = 0
            for chunk in chunks:
                dialogue.controller.receive(chunk)
                ends += chunk.count(b"\n") + chunk.count(b"\r")
                for line in dialogue.look(3).split("\r\n"):
                    answers += line == "ok" or line.startswith("error:")
                assert answers <= ends
                assert 0 <= dialogue.controller.input.held <= ROOM

    search(st.lists(st.one_of(st.binary(max_size=200), talk()), max_size=12), run, 150)


def test_a_buffer_that_is_full_loses_bytes_and_says_so() -> None:
    taken = LineInput()
    assert [taken.put(byte) for byte in b"G0X1\n" * 26][-3:] == [True, False, False]
    assert (taken.held, taken.lost) == (ROOM, 2)
    assert taken.line() == ("G0X1", 5)


def test_a_comment_ends_where_grbl_ends_it() -> None:
    taken = LineInput()
    for byte in b"g1 (a;b) x1 (c\n;(d) y\n/g0/x2)\ng0(((a)z3\n":
        taken.put(byte)
    found = [taken.line() for _ in range(5)]
    assert [f and f[0] for f in found] == ["G1X1", "", "G0X2)", "G0Z3", None]
