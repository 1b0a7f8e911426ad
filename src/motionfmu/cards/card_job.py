"""Job files of a network card: read to positions, written from commands."""

import struct
import zlib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from motionfmu.base.errors import InputError

PAGE, AXES, EVENTS = 256, 4, 11
PAYLOAD, FIRST_BYTE, CRC_AT = 228, 24, 252
COMMAND_MAX = 32767
_HEADER = struct.Struct("<4sHHIIBB2xIII4I4I4I4Q4i32s")
_EVENT = struct.Struct("<HBBI")
_PAGE = struct.Struct("<I4iHH")
_EVENTS_AT = 160


@dataclass(frozen=True)
class FrameEvent:
    """An output that a frame switches as it begins."""

    pins: int  # A bit for each output
    pulse: bool  # Active for `width`, else from now on
    level: int  # 1 high, 0 low
    width: int = 0  # [us] of a pulse


@dataclass(frozen=True)
class Job:
    """A job file."""

    period_ns: int  # [ns] of a frame
    mask: int  # A bit for each axis that moves
    commands: np.ndarray  # [pulses] of each frame
    frame_events: np.ndarray  # Number of the event at the begin of each frame; 0 none
    events: list[FrameEvent] = field(default_factory=list)  # Number 1 first
    # [pulses/m], [pulses/s], [pulses/s^2], [pulses/s^3]
    pulses_per_m: tuple[int, ...] = (0,) * AXES
    speed_max: tuple[int, ...] = (0,) * AXES
    acc_max: tuple[int, ...] = (0,) * AXES
    jerk_max: tuple[int, ...] = (0,) * AXES
    origin: bytes = bytes(32)  # SHA-256 of drawing and settings
    pages: int = 0  # Data pages of the file it was read from
    rest: int = 0  # Event that is put out when the job is aborted; 0 none

    @property
    def positions(self) -> np.ndarray:
        """Positions at the end of each frame."""
        return np.cumsum(self.commands, axis=0, dtype=np.int64)

    @property
    def time(self) -> float:
        """Duration of all frames."""
        return 1e-9 * self.period_ns * len(self.commands)


def read(file: Path) -> Job:
    """Read a job file."""
    try:
        return decode(Path(file).read_bytes(), str(file))
    except OSError as error:
        raise InputError(f"cannot read {file}: {error.strerror}") from None


def decode(text: bytes, name: str = "job") -> Job:
    """Job of the bytes of a file."""
    if len(text) < 2 * PAGE or len(text) % PAGE:
        raise InputError(f"{name}: {len(text)} bytes are no job: whole pages of {PAGE} wanted")
    rows = np.frombuffer(text, np.uint8).reshape(-1, PAGE)
    for k, row in enumerate(rows):
        if zlib.crc32(row[:CRC_AT].tobytes()) != int.from_bytes(row[CRC_AT:].tobytes(), "little"):
            raise InputError(f"{name}: page {k}: its CRC is wrong")
    head = _head(text, name)
    events = []
    for k in range(head.events):
        pins, mode, level, width = _EVENT.unpack_from(text, _EVENTS_AT + k * _EVENT.size)
        events.append(FrameEvent(pins, mode == 1, level, width))
    commands, numbers = _played(rows[1:], head, name)
    end = commands.sum(axis=0).tolist()
    if len(commands) != head.frames or end != head.end:
        raise InputError(f"{name}: {len(commands)} frames to {end}, not as its header says")
    return Job(
        head.period_ns, head.mask, commands, numbers, events,
        head.pulses_per_m, head.speed_max, head.acc_max, head.jerk_max,
        head.origin, head.pages, head.rest,
    )  # fmt: skip


@dataclass(frozen=True)
class _JobHead:
    """What the first page of a job file says of the others."""

    period_ns: int
    mask: int
    rest: int
    pages: int
    frames: int
    events: int  # In the table
    pulses_per_m: tuple[int, ...]
    speed_max: tuple[int, ...]
    acc_max: tuple[int, ...]
    jerk_max: tuple[int, ...]
    end: list[int]  # [pulses] where the last frame ends
    origin: bytes


def _head(text: bytes, name: str) -> _JobHead:
    """The header of a file of whole pages."""
    h = _HEADER.unpack_from(text)
    magic, version, size, ident, period, mask, rest, pages, frames, count = h[:10]
    if magic != b"MCJ1" or version != 1 or size != PAGE:
        raise InputError(f"{name}: no job of version 1")
    origin = h[30]
    if ident != int.from_bytes(origin[:4], "little"):
        raise InputError(f"{name}: its id {ident:#x} is not of its origin")
    there = len(text) // PAGE - 1
    if not 0 < mask < 1 << AXES or not 0 < period or count > EVENTS or pages != there:
        raise InputError(f"{name}: page 0: axes {mask}, period {period} ns, {pages} pages")
    if rest > count:
        raise InputError(f"{name}: page 0: event {rest} for rest, {count} in the table")
    return _JobHead(
        period, mask, rest, pages, frames, count,
        h[10:14], h[14:18], h[18:22], h[22:26], list(h[26:30]), origin,
    )  # fmt: skip


def _played(rows: np.ndarray, head: _JobHead, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Commands and event numbers of all pages of data, each of which goes on where one ended."""
    axes = [k for k in range(AXES) if head.mask >> k & 1]
    commands, numbers, at = [], [], 0
    place = np.zeros(AXES, np.int64)
    for k, row in enumerate(rows, 1):
        first, *begin, n, used = _PAGE.unpack_from(row.tobytes())
        where = f"{name}: page {k}"
        if first != at or n == 0 or used > PAYLOAD or list(place) != begin:
            raise InputError(f"{where}: frame {first} at {begin}, {at} at {place.tolist()} wanted")
        found, switched = _frames(row[FIRST_BYTE : FIRST_BYTE + used], len(axes), n, where)
        if switched.max(initial=0) > head.events or np.abs(found).max() > COMMAND_MAX:
            raise InputError(f"{where}: an event or a command beyond its range")
        full = np.zeros((n, AXES), np.int32)
        full[:, axes] = found
        place = place + full.sum(axis=0)
        at += n
        commands.append(full)
        numbers.append(switched)
    return np.vstack(commands), np.concatenate(numbers)


def _frames(
    payload: np.ndarray, axes: int, count: int, where: str
) -> tuple[np.ndarray, np.ndarray]:
    """Commands and event numbers of a page."""
    ends = np.flatnonzero(payload < 128)
    starts = np.concatenate([[0], ends[:-1] + 1])
    sizes = ends - starts + 1
    if not len(ends) or ends[-1] != len(payload) - 1 or sizes.max() > 3:
        raise InputError(f"{where}: a number that does not end")
    if ((sizes > 1) & (payload[ends] == 0)).any():
        raise InputError(f"{where}: a number that is not the shortest")
    padded = np.concatenate([payload, [0, 0]]).astype(np.int64) & 127
    values = np.zeros(len(ends), np.int64)
    for k in range(3):
        values += np.where(sizes > k, padded[starts + k] << 7 * k, 0)
    rows, events, at = [], np.zeros(count, np.int32), 0
    n = 0
    while n < count:
        left = values[at:]
        heads = left[::axes][: count - n]
        marked = np.flatnonzero(heads & 1)
        take = int(marked[0]) + 1 if len(marked) else count - n
        block = left[: take * axes].reshape(-1, axes) if take * axes <= len(left) else None
        if block is None:
            raise InputError(f"{where}: fewer numbers than {count} frames have")
        rows.append(block)
        n, at = n + take, at + take * axes
        if len(marked):
            if at >= len(values):
                raise InputError(f"{where}: fewer numbers than {count} frames have")
            events[n - 1] = values[at]
            at += 1
    if at != len(values):
        raise InputError(f"{where}: more numbers than {count} frames have")
    zigzag = np.vstack(rows)
    zigzag[:, 0] >>= 1
    return np.cumsum((zigzag >> 1) ^ -(zigzag & 1), axis=0), events


def encode(job: Job) -> bytes:
    """Bytes of a job file."""
    axes = [k for k in range(AXES) if job.mask >> k & 1]
    pages: list[bytes] = []
    payload, first, before = bytearray(), 0, [0] * len(axes)
    begin = place = np.zeros(AXES, np.int64)
    for n, (row, event) in enumerate(zip(job.commands, job.frame_events, strict=True)):
        frame = _frame([int(row[k]) for k in axes], before, int(event))
        if len(payload) + len(frame) > PAYLOAD:
            pages.append(_page(first, begin, n - first, bytes(payload)))
            payload, first, begin = bytearray(), n, place
            frame = _frame([int(row[k]) for k in axes], [0] * len(axes), int(event))
        payload += frame
        before = [int(row[k]) for k in axes]
        place = place + row
    pages.append(_page(first, begin, len(job.commands) - first, bytes(payload)))
    header = _HEADER.pack(
        b"MCJ1", 1, PAGE, int.from_bytes(job.origin[:4], "little"), job.period_ns, job.mask,
        job.rest, len(pages), len(job.commands), len(job.events), *job.pulses_per_m,
        *job.speed_max, *job.acc_max, *job.jerk_max, *place.tolist(), job.origin,
    )  # fmt: skip
    header = header.ljust(_EVENTS_AT, b"\0")
    header += b"".join(_EVENT.pack(e.pins, e.pulse, e.level, e.width) for e in job.events)
    return b"".join(map(_sealed, [header.ljust(CRC_AT, b"\0"), *pages]))


def _frame(row: list[int], before: list[int], event: int) -> bytes:
    found = bytearray()
    for k, (a, b) in enumerate(zip(row, before, strict=True)):
        value = 2 * (a - b) if a >= b else 2 * (b - a) - 1
        if k == 0:
            value = 2 * value + (event > 0)
        while value > 127:
            found.append(value & 127 | 128)
            value >>= 7
        found.append(value)
    return bytes(found) + (bytes([event]) if event else b"")


def _page(first: int, begin: np.ndarray, count: int, payload: bytes) -> bytes:
    head = _PAGE.pack(first, *begin.tolist(), count, len(payload))
    return (head + payload).ljust(CRC_AT, b"\xff")


def _sealed(page: bytes) -> bytes:
    return page + zlib.crc32(page).to_bytes(4, "little")
