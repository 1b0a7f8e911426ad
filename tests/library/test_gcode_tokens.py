"""The words of a line are those that gcodeparser, another program, finds in it.

Random lines go to `src/language/gcode/tokens.h` and to gcodeparser 0.3. That one reads the dialect
of printers, so half of the lines are written in what both have in common and reach it as they are,
and the other half may use all of RS-274 and are put into its dialect by `plain`.

More: GCODE_LINES=1000000 .venv/bin/python -m pytest tests/library/test_gcode_tokens.py
"""

import ctypes
import os
import random
import re

import pytest
from conftest import ROOT
from gcodeparser import parse_gcode_lines

LIBRARY = ctypes.CDLL(os.environ.get("GCODE_WORDS", str(ROOT / "build/lib/gcode_words.so")))
LINES = int(os.environ.get("GCODE_LINES", "10000"))
WORDS_MAX = 40
LETTERS = "ABCDEFHIJKLNPQRSTUVWXYZ"  # once in a line; G and M more often; O is no word
BLANKS = ["", "", " ", " ", "  ", "\t"]

Word = tuple[str, float]


def ours(line: str) -> list[Word]:
    """Words by our tokenizer."""
    letters = ctypes.create_string_buffer(WORDS_MAX)
    values = (ctypes.c_double * WORDS_MAX)()
    text = line.encode()
    count = LIBRARY.word_list(text, len(text), letters, values)
    assert count >= 0, (line, count)
    return list(zip(letters.raw[:count].decode(), values[:count], strict=True))


def plain(line: str) -> str:
    """A line of RS-274 in the dialect of gcodeparser."""
    # It knows no ( ), whose text it would read; a ( behind a ; is none.
    line = re.sub(r"\([^)]*\)|;.*", lambda m: m[0] if m[0].startswith(";") else "", line)
    code, *comment = line.partition(";")
    # Blanks inside a word end the word for it, and a / in front ends the line.
    code = re.sub(r"[ \t\r]", "", code).removeprefix("/")
    # Codes are integers for it; what follows the point, and the words behind it, would be lost.
    code = re.sub(r"[Gg](?=\d*\.)", "_", code)
    # It takes "5." for an integer and fails.
    code = re.sub(r"(\d\.)(?!\d)", r"\g<1>0", code)
    return code + "".join(comment)


def theirs(lines: list[str]) -> list[list[Word]]:
    """Words of each line by gcodeparser."""
    words: list[list[Word]] = [[] for _ in lines]
    # It drops the words before the first G, M or T: every line begins with a T0, taken off below.
    for block in parse_gcode_lines("\n".join("T0 " + line for line in lines)):
        letter, number = block.command
        assert number is not None
        # Words stand under the code they follow; a line is the codes with theirs, in their order.
        words[block.line_index] += [(letter, float(number))]
        words[block.line_index] += [
            ("G" if name == "_" else name, float(value)) for name, value in block.params.items()
        ]
    assert all(line[0] == ("T", 0.0) for line in words)
    return [line[1:] for line in words]


class Writer:
    """Random lines, the same for the same seed."""

    def __init__(self, seed: int, rs274: bool) -> None:
        self.random, self.rs274 = random.Random(seed), rs274

    def one(self, choices: list[str]) -> str:
        """Any of them."""
        return self.random.choice(choices)

    def digits(self, least: int, most: int) -> str:
        """As many digits, leading zeros among them."""
        return "".join(self.random.choices("0123456789", k=self.random.randint(least, most)))

    def number(self) -> str:
        """With sign and decimals or without; 15 digits are exact in a double."""
        forms = [self.digits(1, 15), self.digits(1, 9) + "." + self.digits(1, 6)]
        forms += ["." + self.digits(1, 6)] + [self.digits(1, 9) + "."] * self.rs274
        return self.one(["", "", "-", "+"]) + self.one(forms)

    def words(self) -> list[str]:
        """Words of one line; N before all others."""
        letters = self.random.sample(LETTERS, self.random.randint(0, 8))
        words = [letter + self.number() for letter in letters if letter != "N"]
        words += [
            self.one(["G", "M"]) + self.digits(1, 3) for _ in range(self.random.randint(0, 5))
        ]
        if self.rs274 and self.random.random() < 0.2:  # one, as gcodeparser gets it as a parameter
            words.append("G" + self.digits(1, 2) + "." + self.digits(1, 1))
        self.random.shuffle(words)
        return ["N" + self.digits(1, 5)] * ("N" in letters) + words

    def comment(self, end: str) -> str:
        """Some text that looks like words."""
        choices = [" ", "G1", "X5", ";", "(", "/", "%", '"', "a", "m3", ".", "-"]
        choices += [")"] * (end == "\n")
        return "".join(self.random.choices(choices, k=self.random.randint(0, 6)))

    def line(self) -> str:
        """A line."""
        text = self.one(["", "", "", "/", " / "]) if self.rs274 else ""
        for word in self.words():
            if self.rs274 and self.random.random() < 0.3:
                word = "".join(c + self.one(BLANKS) for c in word)
            if self.rs274 and self.random.random() < 0.1:
                word = f"({self.comment(')')}){word}"
            text += self.one(BLANKS) + (word.lower() if self.random.random() < 0.3 else word)
        text += self.one(BLANKS)
        if self.random.random() < 0.3:
            text += ";" + self.comment("\n")
        return text + self.one(["", "", "\r"])


def corpus(rs274: bool) -> list[str]:
    """All lines of one kind."""
    writer = Writer(7, rs274)
    return [writer.line() for _ in range(LINES)]


@pytest.mark.parametrize("rs274", [False, True], ids=["common", "rs274"])
def test_words_are_those_of_gcodeparser(rs274: bool) -> None:
    lines = corpus(rs274)
    other = theirs([plain(line) for line in lines] if rs274 else lines)
    bad = [(a, ours(a), b) for a, b in zip(lines, other, strict=True) if ours(a) != b]
    assert bad == []
    assert sum(map(len, other)) > 4 * LINES


def test_the_comparison_can_fail() -> None:
    for line, like in [("G1 X2.5", "G1 X2.50001"), ("G1 X5", "G1 Y5"), ("N1 G0 X1", "G0 X1")]:
        assert ours(line) == theirs([line])[0] != theirs([like])[0]
    # Without `plain` each of its rules is needed.
    for line in ["(G1)X5", "X5 0", "/X5", "G90.1 X5"]:
        assert ours(line) == theirs([plain(line)])[0] != theirs([line])[0]
    with pytest.raises(ValueError, match=r"'5\.'"):
        theirs(["X5."])
    assert ours("X5.") == theirs([plain("X5.")])[0]
