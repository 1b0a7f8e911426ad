"""A part program as the commands that the C interpreter makes of it."""

import ctypes
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.axis_names import LINEAR, ROTARY, ControllerAxis
from motionfmu.base.binding import Struct, dtype, library
from motionfmu.base.binding import text as text_of
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file

AXES = 6
ROOM = 4096
TRAVEL = "software limits"  # words of the fault that an axis has
REPORTS = 64  # room for all faults and notes
TYPES = (
    "rapid line cw_arc ccw_arc cw_helix ccw_helix dwell 7 8 9 10 outputs stop rapid_joints curve"
).split()
_MORE = 0  # of enum interpreter_result: the call ended because its room was full


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
    file : str
        Name, without its ending, of a file that the program calls; empty: the program itself.
    limits : str
        The value asked and the limit, with the axis that has it, if the fault is about these.
    """

    line: int
    column: int
    length: int
    text: str
    why: str
    file: str = ""
    limits: str = ""

    def __str__(self) -> str:
        file = f"{self.file}.ngc: " if self.file else ""
        more = f" ({self.limits})" if self.limits else ""
        return f'{file}line {self.line}: {self.why} "{self.text}"{more}, column {self.column}'


# Type of the function by which C gets the text of a called file: by name, with its length.
_FILE = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_char_p, ctypes.POINTER(ctypes.c_int64))


def judged(
    texts: Callable[[str], bytes],
    check: Callable[[ctypes.c_void_p, Any], Any],
    axes: Sequence[ControllerAxis] = LINEAR,
) -> tuple[list[Fault], list[Fault], bool]:
    """Faults and notes that a C check finds in texts, and whether there are more faults.

    The texts are those of the files that a program calls, and with an empty name its own.
    """
    rows, count = np.zeros(REPORTS, dtype("report")), (ctypes.c_int32 * 3)()
    check(rows.ctypes.data_as(ctypes.c_void_p), count)
    found = [_fault(texts, r, axes) for r in rows[: count[0] + count[1]]]
    return found[: count[0]], found[count[0] :], bool(count[2])


def _fault(texts: Callable[[str], bytes], r: Any, axes: Sequence[ControllerAxis]) -> Fault:
    file = b"".join(r["file"].tolist()).decode()
    text = texts(file)
    line, begin = int(r["offset"]), int(r["offset"] + r["at"])
    words = text[begin : begin + int(r["length"])].decode(errors="replace")
    column = len(text[line:begin].decode(errors="replace")) + 1
    why = library().fault_text(ctypes.c_int32(int(r["fault"]))).decode()
    limits = ""
    if TRAVEL in why or r["limit"]:
        axis = f"{axes[int(r['axis'])].name} to " if TRAVEL in why else ""
        limits = f"{axis}{r['value']:.6g}, limit {r['limit']:.6g}"
    return Fault(int(r["line"]), column, len(words), words, why, file, limits)


class Texts:
    """A program and the files beside it that it calls, as C asks for them.

    `of` has their texts by name, that of the program under an empty one; `endings` are those of the
    files, the first that is there counts.
    """

    def __init__(
        self, text: str | Path, folder: Path | None = None, endings: Sequence[str] = (".ngc",)
    ) -> None:
        self._endings = endings
        if isinstance(text, Path):
            folder = folder or text.parent
            text = text_in(text)
        elif isinstance(text, str) and "\n" not in text and is_file(Path(text)):
            raise InputError(f"{text!r} is the name of a file; Path({text!r}) reads it")
        self.text, self._folder = text, folder
        self.of = {"": text_of(text)}
        self._unreadable: InputError | None = None
        self.file = _FILE(self._at)

    def call(self) -> tuple[bytes, ctypes.c_int64, Any]:
        """Arguments of the calls that read it; `self` has to live as long as C keeps them."""
        return self.of[""], ctypes.c_int64(len(self.of[""])), self.file

    def tell(self) -> None:
        """Raise the error that kept a file from being read while C asked for it."""
        if self._unreadable:
            raise self._unreadable

    def _at(self, name: bytes, length: Any) -> int | None:
        """Address of the text of a file that is called; none if there is no such file."""
        if (found := name.decode()) not in self.of:
            beside = [self._folder / f"{found}{e}" for e in self._endings] if self._folder else []
            file = next(filter(is_file, beside), None)
            if file is None:
                return None
            try:
                self.of[found] = text_of(text_in(file))
            except InputError as error:  # an exception cannot pass through the C code
                self._unreadable = error
                return None
        length[0] = len(self.of[found])
        return ctypes.cast(ctypes.c_char_p(self.of[found]), ctypes.c_void_p).value


class Program:
    """What a part program does.

    Attributes
    ----------
    text : str
        As read.
    faults : list of Fault
        None if the program is good, at most 20; the commands are those before the first.
    more : bool
        There are more faults than these.
    notes : list of Fault
        Words that are accepted and do nothing here, each once.
    axes : sequence of ControllerAxis
        Name and unit of each of its six axes.
    """

    def __init__(self, texts: Texts, reader: Struct) -> None:
        self._texts, self._reader = texts, reader
        self.text = texts.text
        self.axes = ROTARY if reader["angles"] else LINEAR
        library().binding_gcode_begin(reader.pointer, *texts.call())
        check = library().binding_gcode_check
        self.faults, self.notes, self.more = judged(
            texts.of.__getitem__,
            lambda rows, count: check(reader.pointer, rows, count),
            self.axes,
        )
        texts.tell()

    @property
    def files(self) -> dict[str, str]:
        """Texts of the files that it calls.

        Returns
        -------
        dict of str to str
            By their names without ending.
        """
        return {n: t.decode(errors="replace") for n, t in self._texts.of.items() if n}

    @cached_property
    def commands(self) -> np.ndarray:
        """All its commands.

        Returns
        -------
        ndarray
            Structured, a row each of 0.4 kB; the names of its fields are those of
            ``commands.dtype``, places in machine coordinates [mm], feeds [mm/s], dwells [s].
            `blocks` passes them without holding all.
        """
        raw = [rows.view(np.uint8) for rows in self._read()]
        return np.concatenate(raw).view(dtype("gcode_command"))

    def __repr__(self) -> str:
        faults = f"{len(self.faults)}{' or more' if self.more else ''}"
        return f"<Program: {len(self.commands)} commands, {faults} faults>"

    def blocks(self) -> Iterator[np.ndarray]:
        """Its commands in blocks, which are read anew each time.

        Yields
        ------
        ndarray
            As `commands`, the next ones; only an empty program has an empty block, one.
        """
        if "commands" in self.__dict__:
            every = range(0, max(1, len(self.commands)), ROOM)
            yield from (self.commands[first : first + ROOM] for first in every)
            return
        before = None
        for rows in self._read():
            if len(rows) and before is not None:
                yield before
            before = rows if before is None or len(rows) else before
        if before is not None:
            yield before

    def _read(self) -> Iterator[np.ndarray]:
        c, result, report = library(), ctypes.c_int32(_MORE), Struct("report")
        kind = dtype("gcode_command")
        reader = _copy(self._reader)
        c.binding_gcode_begin(reader.pointer, *self._texts.call())
        c.binding_gcode_read.restype = ctypes.c_int64
        while result.value == _MORE:
            rows = np.zeros(ROOM * kind.itemsize, np.uint8)  # whole structs: fields are not all
            count = c.binding_gcode_read(
                reader.pointer,
                rows.ctypes.data_as(ctypes.c_void_p),
                ctypes.c_int64(ROOM),
                ctypes.byref(result),
                report.pointer,
            )
            yield rows[: count * kind.itemsize].view(kind)
        self._texts.tell()

    def seconds(self) -> np.ndarray:
        """Time of each command on the machine.

        Returns
        -------
        (n,) ndarray
            [s] from its begin to that of the next one that takes time, to a period of points.
        """
        return self._driven(None).seconds

    def places(self) -> np.ndarray:
        """Where the tool is at the end of each period.

        Returns
        -------
        (n, 6) ndarray
            [mm] in machine coordinates, a row for each ``period`` from the start on.
        """
        places = np.zeros((self._driven(None).periods, AXES))
        self._driven(places)
        return places

    def drive(self, places: np.ndarray | None = None) -> "ProgramDrive":
        """A machine that stands before the program.

        Parameters
        ----------
        places : ndarray, optional
            (n, 6) room for where the tool is at the end of each period [mm].

        Returns
        -------
        ProgramDrive
            It takes the program's blocks.
        """
        return ProgramDrive(self._reader, places)

    def _driven(self, places: np.ndarray | None) -> "ProgramDrive":
        drive = self.drive(places)
        for rows, last in marked(self.blocks()):
            drive.take(rows, last)
        return drive


class ProgramDrive:
    """A machine that drives the commands of a program, which it gets in blocks."""

    def __init__(self, reader: Struct, places: np.ndarray | None = None) -> None:
        self._reader = _copy(reader)
        self._places = places
        self._room, self._count = np.zeros(ROOM), 0
        self.periods = 0
        library().binding_gcode_stand(self._reader.pointer)

    @property
    def seconds(self) -> np.ndarray:
        """Time of each command so far (n,) [s]."""
        return self._room[: self._count]

    def take(self, rows: np.ndarray, last: bool) -> None:
        """ProgramDrive the next commands, as far as they alone tell the way."""
        self._count += len(rows)
        if self._count > len(self._room):
            self._room = np.append(self._room, np.zeros(len(self._room)))
        drive, places = library().binding_gcode_time, self._places
        drive.restype = ctypes.c_int64
        self.periods = drive(
            self._reader.pointer,
            rows.ctypes.data_as(ctypes.c_void_p),
            ctypes.c_int64(len(rows)),
            ctypes.c_int32(last),
            self._room.ctypes.data_as(ctypes.c_void_p),
            None if places is None else places.ctypes.data_as(ctypes.c_void_p),
        )


def marked(blocks: Iterable[np.ndarray]) -> Iterator[tuple[np.ndarray, bool]]:
    """Each block, and whether it is the last."""
    before = None
    for rows in blocks:
        if before is not None:
            yield before, False
        before = rows
    if before is not None:
        yield before, True


def _copy(struct: Struct) -> Struct:
    """A struct of the reader with the same settings, in memory of its own."""
    found = Struct("gcode_reader")
    found.restore(struct.saved())
    return found


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
        jerks in mm/s^3 (0: unlimited). If acc_time and dec_time [s] are not 0, these times of ramps
        from rest to any speed count instead of accelerations, with the share of them in which
        the acceleration changes.
    """
    reader = _reader({})
    return {name: reader[name] for name in reader if name not in ("line", "ended")}


def text_in(file: Path) -> str:
    """Text of a program's file, of any length; bytes that are not UTF-8 are in comments only."""
    try:
        if file.exists() and not file.is_file():  # a pipe would be waited for
            raise InputError(f"cannot read {file}: not a regular file")
        return file.read_bytes().decode(errors="replace")
    except OSError as error:
        raise InputError(f"cannot read {file}: {error.strerror}") from None
    except ValueError as error:  # a NUL in the name
        raise InputError(f"cannot read {file}: {error}") from None


def read(
    text: str | Path, tools: str = "", *, folder: Path | None = None, **settings: Any
) -> Program:
    """Read a part program.

    Parameters
    ----------
    text : str or Path
        All its lines; or, as a `pathlib.Path`, the file that holds them.
    tools : str
        Lines of a tool table (``T1 P1 Z10 D6``: number, pocket, length, diameter [mm]); without
        one every tool exists and has length and diameter 0.
    folder : Path, optional
        Where the files are that it calls (``o<name> call``: name.ngc); that of a file by default.
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
    return Program(Texts(text, folder), _reader(settings, tools))
