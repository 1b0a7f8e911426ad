"""A part program as the commands that the C interpreter makes of it."""

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.binding import Struct, dtype, library
from motionfmu.binding import text as text_of
from motionfmu.errors import InputError
from motionfmu.toml_lines import is_file
from motionfmu.toml_lines import text_of as of_file

AXES = 6
ROOM = 4096
REPORTS = 64  # room for all faults and notes
TYPES = (
    "rapid line cw_arc ccw_arc cw_helix ccw_helix dwell 7 8 9 10 outputs stop rapid_joints curve"
).split()
_MORE = 0  # of enum interpreter_result: room was all that ended it


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong in a program, or worth a note.

    Attributes
    ----------
    line : int
        From 1.
    column, length : int
        Offending text in the line, from 1; [characters].
    text : str
        That text.
    why : str
        What is wrong with it, in words.
    """

    line: int
    column: int
    length: int
    text: str
    why: str

    def __str__(self) -> str:
        return f'line {self.line}: {self.why} "{self.text}", column {self.column}'


def judged(
    text: bytes, check: Callable[[ctypes.c_void_p, Any], Any]
) -> tuple[list[Fault], list[Fault], bool]:
    """Faults and notes of a text as a C check tells them, and whether there are more faults."""
    rows, count = np.zeros(REPORTS, dtype("report")), (ctypes.c_int32 * 3)()
    check(rows.ctypes.data_as(ctypes.c_void_p), count)
    found = [_fault(text, r) for r in rows[: count[0] + count[1]]]
    return found[: count[0]], found[count[0] :], bool(count[2])


def _fault(text: bytes, r: Any) -> Fault:
    line, begin = int(r["offset"]), int(r["offset"] + r["at"])
    words = text[begin : begin + int(r["length"])].decode(errors="replace")
    column = len(text[line:begin].decode(errors="replace").removeprefix("\ufeff")) + 1
    why = library().fault_text(ctypes.c_int32(int(r["fault"]))).decode()
    return Fault(int(r["line"]), column, len(words), words, why)


class Program:
    """What a part program does.

    Attributes
    ----------
    text : str
        As read.
    commands : ndarray
        Structured, a row each; the names of its fields are those of ``commands.dtype``, places
        in machine coordinates [mm], feeds [mm/s], dwells [s].
    faults : list of Fault
        None if the program is good, at most 20; the commands are those before the first.
    more : bool
        There are more faults than these.
    notes : list of Fault
        Words that are accepted and do nothing here, each once.
    """

    def __init__(self, text: str, reader: Struct) -> None:
        self._bytes = text_of(text)
        self.text, self._reader = text, reader
        begin = library().binding_gcode_begin
        begin(reader.pointer, self._bytes, ctypes.c_int64(len(self._bytes)))
        check = library().binding_gcode_check
        self.faults, self.notes, self.more = judged(
            self._bytes, lambda rows, count: check(reader.pointer, rows, count)
        )
        self.commands = self._read()

    def __repr__(self) -> str:
        faults = f"{len(self.faults)}{' or more' if self.more else ''}"
        return f"<Program: {len(self.commands)} commands, {faults} faults>"

    def _read(self) -> np.ndarray:
        c, result, report = library(), ctypes.c_int32(_MORE), Struct("report")
        parts, kind = [], dtype("gcode_command")
        c.binding_gcode_read.restype = ctypes.c_int64
        while result.value == _MORE:
            rows = np.zeros(ROOM * kind.itemsize, np.uint8)  # whole structs: fields are not all
            count = c.binding_gcode_read(
                self._reader.pointer,
                rows.ctypes.data_as(ctypes.c_void_p),
                ctypes.c_int64(ROOM),
                ctypes.byref(result),
                report.pointer,
            )
            parts.append(rows[: count * kind.itemsize].copy())
        return np.concatenate(parts).view(kind)

    def seconds(self) -> np.ndarray:
        """Time of each command on the machine.

        Returns
        -------
        (n,) ndarray
            [s] from its begin to that of the next one that takes time, to a period of points.
        """
        return self._driven(None)[0]

    def places(self) -> np.ndarray:
        """Where the tool is at the end of each period.

        Returns
        -------
        (n, 6) ndarray
            [mm] in machine coordinates, a row for each ``period`` from the start on.
        """
        places = np.zeros((self._driven(None)[1], AXES))
        self._driven(places)
        return places

    def _driven(self, places: np.ndarray | None) -> tuple[np.ndarray, int]:
        """Times of the commands, and how many periods there are."""
        times, drive = np.zeros(len(self.commands)), library().binding_gcode_time
        drive.restype = ctypes.c_int64
        periods = drive(
            self._reader.pointer,
            self.commands.ctypes.data_as(ctypes.c_void_p),
            ctypes.c_int64(len(times)),
            times.ctypes.data_as(ctypes.c_void_p),
            None if places is None else places.ctypes.data_as(ctypes.c_void_p),
        )
        return times, periods


def _reader(settings: dict[str, Any], tools: str = "") -> Struct:
    reader = Struct("gcode_reader")
    library().binding_gcode_defaults(reader.pointer)
    for name, value in settings.items():
        reader[name] = value
    tool = library().binding_gcode_tool
    tool.restype = ctypes.c_char_p
    for number, line in enumerate(tools.splitlines(), 1):
        text, at = line.encode(), (ctypes.c_int32 * 2)()
        if why := tool(reader.pointer, text, ctypes.c_int32(len(text)), at):
            found = text[at[0] : at[0] + at[1]].decode(errors="replace")
            raise InputError(f"tool table: line {number}: {why.decode()} {found!r}")
    return reader


def defaults() -> dict[str, Any]:
    """Settings of `read` and their values.

    Returns
    -------
    dict
        Lengths in mm, feed and max_feed in mm/min, speeds in mm/s, accelerations in mm/s^2,
        jerks in mm/s^3 (0: unlimited).
    """
    reader = _reader({})
    return {name: reader[name] for name in reader if name not in ("line", "ended")}


def read(text: str | Path, tools: str = "", **settings: Any) -> Program:
    """Read a part program.

    Parameters
    ----------
    text : str or Path
        All its lines; or, as a `pathlib.Path`, the file that holds them.
    tools : str
        Lines of a tool table (``T1 P1 Z10 D6``: number, pocket, length, diameter [mm]); without
        one every tool exists and has length and diameter 0.
    **settings
        Machine and switches of the language; `defaults` lists them.

    Returns
    -------
    Program

    Raises
    ------
    InputError
        There is no such setting, or it has another shape; a line of the tool table is wrong; a file
        cannot be read, or the text is the name of one.
    """
    if isinstance(text, Path):
        text = of_file(text)
    elif isinstance(text, str) and "\n" not in text and is_file(Path(text)):
        raise InputError(f"{text!r} is the name of a file; Path({text!r}) reads it")
    return Program(text, _reader(settings, tools))
