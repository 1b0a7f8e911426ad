"""The text of an HP-GL file as instructions: pairs of letters with their numbers."""

import re
from collections.abc import Container, Iterator
from typing import NoReturn

from motionfmu.base.errors import InputError

NUMBER_MAX = 2.0**30
_PAIR = re.compile(rb"([A-Za-z]{2})([-+0-9., \t\r\n\0]*)[;\s\0]*")
_NUMBER = re.compile(rb"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")
_BLANK = re.compile(rb"[;\s\0\x1a\x03]+")
# ESC.X with its numbers up to a colon; PCL's ESC%0B, ESC E, ESC&l1O; PJL up to the line's end.
_DEVICE = re.compile(
    rb"\x1b\.(?:[@HIMNPQST](?:[0-9; \t,]*:)?|[A-Za-z()])"
    rb"|\x1b[!-/][`-~]?(?:[-+0-9.]*[`-~])*[-+0-9.]*[@-^]|\x1b[0-~]"
    rb"|@PJL[^\n]*\n?|@"
)
_PCL = re.compile(rb"\x1b%-?[0-9]*A\Z")
_BACK = re.compile(rb"\x1b%-?[0-9]*[BX]")
_LABELS = ("LB", "BL", "WD")
# Texts in quotes, or without them up to a semicolon; BP has its texts among numbers.
_QUOTED = ("CO", "MG", "BP")
_QUOTE = re.compile(rb'[^;"A-Za-z]*"')
_PLAIN = re.compile(rb"[^;]*")
_BOM = b"\xef\xbb\xbf"
_TWO_BYTES = re.compile(rb"[\xc2\xc3][\x80-\xbe]")  # in UTF-8; no digits of PE
_REST = re.compile(rb"[-+0-9., ]*[;\s]*")
_KINDS = {
    "text": "AD CF CP DI DR DV ES LO PB BL SA SD SI SL SM SR SS DT LB TD UC DL CC CS CA SB",
    "pen": "AC AP AS FS GP PC PW PT TR UL LA LT SG NP MC PP WU SV SC VA VN",
    "page": "AF AH EC FR PG PS RP BP NR",
    "comment": "CO MG",
    "tick marks": "TL XT YT",
    "filled area": "FP FT RA RR WG RF",
    "polygon": "FI FN",
    "device": "CV DC DP GC IM IR IV KY OA OC OD OE OF OG OH OI OK OL OO OP OS OT OW QL RC RM SU",
}
_KNOWN = {pair: kind for kind, pairs in _KINDS.items() for pair in pairs.split()}


def _is_utf8(text: bytes) -> bool:
    try:
        text.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


class Scanner:
    """Reads a text from its begin to its end and knows the place that it has reached."""

    def __init__(self, text: bytes, name: str) -> None:
        self.text, self.name = text, name
        self.first = self.next = 0  # bytes of the instruction under way
        if text.startswith(_BOM):
            self.next = len(_BOM)
        # An editor wrote it as UTF-8: the last digits of PE have two bytes.
        self._two_bytes = _TWO_BYTES.search(text) is not None and _is_utf8(text)
        self.pair = ""
        self.terminator = b"\x03"
        self.label = b""  # the text of LB
        self._skipped: dict[str, list[int]] = {}

    def place(self, byte: int) -> tuple[int, int]:
        """Line and column of a byte, from 1."""
        before = self.text[:byte].replace(b"\r\n", b" \n").replace(b"\r", b"\n")
        return before.count(b"\n") + 1, byte - before.rfind(b"\n")

    def refuse(self, why: str, byte: int | None = None) -> NoReturn:
        """Raise the error of this instruction."""
        at = self.first if byte is None else byte
        pair = f"{self.pair}: " if self.pair else ""
        raise InputError(f"{self.where(at)}: {pair}{why}")

    def where(self, byte: int) -> str:
        """File, line, column and byte in words."""
        return f"{self.name}: {self.in_words(byte)}"

    def in_words(self, byte: int) -> str:
        """Line, column and byte in words."""
        line, column = self.place(byte)
        return f"line {line}, column {column}, byte {byte}"

    def wants(self, numbers: list[float], least: int, most: int) -> None:
        """Refuse an instruction with too few or too many numbers."""
        if not least <= len(numbers) <= most:
            wanted = f"{least}" if least == most else f"{least} to {most}"
            self.refuse(f"{len(numbers)} numbers, {wanted} wanted")

    def skip(self, pair: str) -> None:
        """Note an instruction that does nothing here."""
        kind = _KNOWN.get(pair, "unknown")
        self.note(f"{pair}: {kind}")

    def note(self, what: str) -> None:
        """Count something that does nothing here, from this place on."""
        found = self._skipped.setdefault(what, [self.first, 0])
        found[1] += 1

    def notes(self) -> list[tuple[int, int, int, int, str]]:
        """What was ignored: line, column, byte, number of times, text."""
        return [(*self.place(at), at, n, what) for what, (at, n) in self._skipped.items()]

    def pairs(self) -> Iterator[tuple[str, list[float]]]:
        """Each instruction and its numbers."""
        text, match, end = self.text, _PAIR.match, len(self.text)
        while self.next < end:
            m = match(text, self.next)
            if m is None:
                self._other()
                continue
            self.first = self.next
            self.pair = pair = m[1].decode().upper()
            if pair in _SPECIAL:
                self.next = m.end(1)
                if pair != "PE":
                    self._special(pair)
                yield pair, []
                continue
            self.next = m.end()
            yield pair, self._numbers(m)
        self.pair = ""

    def _numbers(self, m: re.Match[bytes]) -> list[float]:
        try:
            found = [float(w) for w in m[2].replace(b",", b" ").replace(b"\0", b" ").split()]
        except ValueError:
            found = self._slowly(m)
        if found and not (max(found) <= NUMBER_MAX and min(found) >= -NUMBER_MAX):
            worst = max(found, key=abs)
            self.refuse(f"{worst:g} is beyond {NUMBER_MAX:.0f}")
        return found

    def _slowly(self, m: re.Match[bytes]) -> list[float]:
        """Read numbers that signs separate as well; an error names a text that is no number."""
        found, at, end = [], m.start(2), m.end(2)
        while at < end:
            if self.text[at] in b", \t\r\n\0":
                at += 1
            elif number := _NUMBER.match(self.text, at, end):
                found.append(float(number[0]))
                at = number.end()
            else:
                self.refuse(f"{self.text[at : at + 1].decode()!r} is no number", at)
        return found

    def _other(self) -> None:
        """What is between instructions."""
        text, self.first, self.pair = self.text, self.next, ""
        if m := _BLANK.match(text, self.next):
            self.next = m.end()
        elif m := _DEVICE.match(text, self.next):
            self.next = m.end()
            if _PCL.match(m[0]):
                back = _BACK.search(text, self.next)
                self.next = back.start() if back else len(text)
            shown = m[0][:12].decode("latin-1").replace("\x1b", "ESC").strip()
            self.note(f"{shown}: device")
        elif text[self.next : self.next + 1] == b"!":
            self.next += 1
            self.note("!: unknown")
        else:
            byte = text[self.next : self.next + 1].decode("latin-1")
            self.refuse(f"{byte!r} begins no instruction")

    def _special(self, pair: str) -> None:
        """Pass over parameters that are no numbers."""
        text = self.text
        if pair in _LABELS:
            end = text.find(self.terminator, self.next)
            if end < 0:
                self.refuse(f"the text has no end {self.terminator!r}")
            # Letters, not bytes: of two bytes in UTF-8 the first counts.
            written = text[self.next : end]
            self.label = re.sub(rb"[\x80-\xbf]", b"", written) if self._two_bytes else written
            self.next = end + len(self.terminator)
        elif pair == "DT":
            mark = text[self.next : self.next + 1]
            plain = mark in (b"", b";", b"\r", b"\n")
            self.terminator = b"\x03" if plain else mark
            self.next += len(mark)
            if not plain:
                self._to_end()
        elif pair in _QUOTED:
            self._quoted()
        elif pair == "SM" and text[self.next : self.next + 1] not in (b";", b"\r", b"\n", b""):
            self.next += 1
            self._to_end()

    def _quoted(self) -> None:
        """Skip the texts of one instruction, whose letters are no instructions."""
        text, quoted = self.text, False
        while m := _QUOTE.match(text, self.next):
            end = text.find(b'"', m.end())
            if end < 0:
                self.refuse("the text in quotes has no end")
            self.next, quoted = end + 1, True
        if not quoted and self.pair != "BP" and (m := _PLAIN.match(text, self.next)):
            self.next = m.end()
        self._to_end()

    def _to_end(self) -> None:
        m = _REST.match(self.text, self.next)
        self.next = m.end() if m else self.next

    # CCN 19: a scanner of one character at a time, whose states are its local variables.
    def encoded(self, drawn: Container[str]) -> Iterator[tuple[str, list[float]]]:
        """Flags and numbers of PE: (":", [pen]), or (flags among "<=", [x, y]).

        drawn: pairs that draw something; one of these or of those passed over may end it, too.
        """
        text, at, base, fraction = self.text, self.next, 64, 0
        pair: list[float] = []
        flags, self.next = "", len(text)
        while at < len(text):
            c = text[at]
            if c == 0x1B and not pair:  # ESC: HP-GL/2 is left
                self.next = at
                return
            if c == 0x3B:  # ;
                break
            if c in b":<>=7":
                if pair:
                    self.refuse("a flag within a pair", at)
                at += 1
                if c == 0x37:
                    base = 32
                elif c == 0x3C or c == 0x3D:
                    flags += chr(c)
                else:
                    value, at = self._encoded(at, base)
                    if c == 0x3A:
                        yield ":", [float(value)]
                    else:
                        fraction = value
                        if abs(fraction) > 26:
                            self.refuse(f"{fraction} fraction bits, at most 26 wanted", at)
                continue
            if c <= 32 or c == 127:
                at += 1
                continue
            if not pair and self._unclosed(at, base, drawn):
                self.next = at
                return
            value, at = self._encoded(at, base)
            pair.append(value * 2.0**-fraction)
            if abs(pair[-1]) > NUMBER_MAX:
                self.refuse(f"{pair[-1]:g} is beyond {NUMBER_MAX:.0f}", at)
            if len(pair) == 2:
                yield flags, pair
                flags, pair = "", []
        if pair:
            self.refuse("an odd number of coordinates", at)
        self.next = min(at + 1, len(text))

    def _unclosed(self, at: int, base: int, drawn: Container[str]) -> bool:
        """Whether the next instruction begins here, PE without its semicolon.

        Its letters are digits that no last digit follows: AutoCAD ends its pages so.
        """
        text, last = self.text, 191 if base == 64 else 95
        pair = text[at : at + 2].decode("latin-1")
        if pair not in _KNOWN and pair not in drawn:
            return False
        while at < len(text) and (63 <= text[at] < last or text[at] <= 32):
            at += 1
        return at == len(text) or text[at] < 63

    def _encoded(self, at: int, base: int) -> tuple[int, int]:
        """One number, its last digit marked, and where it ends."""
        text, first, value, shift = self.text, at, 0, 0
        bits, last = (6, 191) if base == 64 else (5, 95)
        while True:
            c = text[at] if at < len(text) else 0x3B
            at += 1
            if c <= 32 or c == 127:
                continue
            if self._two_bytes and c in (0xC2, 0xC3):
                c = (c & 3) << 6 | text[at] & 0x3F
                at += 1
            digit = c - last if c >= last else c - 63
            if not (0 <= digit < base) or shift > 60:
                self.refuse("an encoded number that does not end", first)
            value += digit << shift
            if c >= last:
                return (-(value >> 1) if value & 1 else value >> 1), at
            shift += bits


_SPECIAL = frozenset((*_LABELS, *_QUOTED, "PE", "DT", "SM"))
