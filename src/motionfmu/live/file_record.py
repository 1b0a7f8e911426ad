"""Samples written to a file for as long as one likes, by a process of their own.

The machine's process only passes them on. The other one ends when the pipe does, however that came
about, so a record that has begun is whole even if the machine's process was killed.
"""

import contextlib
import json
import os
import struct
import subprocess
import sys
import threading
import zipfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Any, BinaryIO

import numpy as np

from motionfmu.base.children import child
from motionfmu.base.errors import InputError
from motionfmu.live.sample_ring import SampleRing

KINDS = (".csv", ".npz")
# A block: number of the first step, bytes. One of no bytes forgets what is at that step or later.
_BLOCK = struct.Struct("<qq")
_ROWS = 1 << 14  # that are turned into text at a time


@dataclass(frozen=True)
class RecordHead:
    """What a record's file says beside the samples."""

    channels: Sequence[str]
    units: Sequence[str]
    step_ns: int


class FileRecord:
    """Samples that go into a file."""

    def __init__(self, file: Path, head: RecordHead, begin: int, end: int | None) -> None:
        self.name = str(file)
        part = claimed(file)
        self._next, self._begin, self._end = begin, begin, end
        self._blocks: SimpleQueue[bytes | None] = SimpleQueue()
        about = json.dumps({"file": str(file.absolute()), **asdict(head)})
        # To start the process takes some ms, for which the machine does not wait.
        self._passed, self._whole = threading.Event(), threading.Event()
        given = (f"{about}\n".encode(), part)
        threading.Thread(target=self._send, args=given, daemon=True).start()

    @property
    def rows(self) -> int:
        """Steps that are written."""
        return self._next - self._begin

    @property
    def complete(self) -> bool:
        """Whether it has ended."""
        return self._end is not None and self._next >= self._end

    def write(self, ring: SampleRing) -> None:
        """Pass on what the ring has that is new."""
        until = ring.end if self._end is None else min(self._end, ring.end)
        begin = max(self._next, ring.begin)
        if until > begin:
            data = ring.between(begin, until).tobytes()
            self._blocks.put(_BLOCK.pack(begin, len(data)) + data)
            self._next = until
            if self.complete:
                self._blocks.put(None)

    def cut(self, step: int) -> None:
        """Forget what is at a step or later."""
        if step < self._next:
            self._next = step
            self._begin = min(self._begin, step)
            self._blocks.put(_BLOCK.pack(step, 0))

    def end(self) -> None:
        """Write no more."""
        if not self.complete:
            self._end = self._next
            self._blocks.put(None)

    def passed(self, patience: float) -> None:
        """Wait until the other process has everything [s]."""
        self._passed.wait(patience)

    def whole(self) -> None:
        """Wait until the file is there."""
        self._whole.wait()

    def _send(self, about: bytes, part: Path) -> None:
        command, options = child(f"from {__name__} import main; main()")
        process = subprocess.Popen([*command, str(part)], stdin=subprocess.PIPE, **options)
        pipe = process.stdin
        assert pipe is not None
        with contextlib.suppress(OSError):  # the process was killed
            pipe.write(about)
            while (block := self._blocks.get()) is not None:
                pipe.write(block)
                pipe.flush()
            pipe.close()
        self._passed.set()
        process.wait()
        self._whole.set()


def claimed(file: Path) -> Path:
    """An empty file beside one that is to be written, which must not be there."""
    if file.suffix.lower() not in KINDS:
        raise InputError(f"{file}: a record is written as {' or '.join(KINDS)}")
    if os.path.lexists(file):
        raise InputError(f"{file} is there already")
    part = file.absolute().with_name(f".{file.name}.part{os.getpid()}")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        part.open("xb").close()
    except OSError as error:
        if part.exists():
            raise InputError(f"{file} is being written by another record") from None
        raise InputError(f"cannot write {file}: {error.strerror or error}") from None
    return part


def main() -> None:
    """Write a record: head and blocks come on stdin, the argument names the file they gather in."""
    part, stream = Path(sys.argv[1]), sys.stdin.buffer
    line = stream.readline()
    if not line.endswith(b"\n"):  # the machine's process was killed before it sent the head
        part.unlink(missing_ok=True)
        return
    about = json.loads(line)
    file = Path(about["file"])
    head = RecordHead(about["channels"], about["units"], about["step_ns"])
    try:
        with part.open("wb") as raw:
            _gather(stream, raw, 8 * (1 + len(head.channels)))
        flat: Any = np.memmap(part, float, "r") if part.stat().st_size else np.zeros(0)
        rows = flat.reshape(-1, 1 + len(head.channels))
        whole = part.with_name(f"{part.name}.whole")
        write = {".csv": _write_csv, ".npz": _write_npz}[file.suffix.lower()]
        with whole.open("wb") as out:
            write(out, rows, head)
        whole.replace(file)
    finally:
        part.unlink(missing_ok=True)


def _gather(stream: BinaryIO, raw: BinaryIO, row: int) -> None:
    """Write rows of step and samples as they come."""
    while len(given := stream.read(_BLOCK.size)) == _BLOCK.size:
        step, size = _BLOCK.unpack(given)
        if not size:
            raw.flush()
            _forget(Path(raw.name), step, row)
            raw.seek(0, os.SEEK_END)
            continue
        data = stream.read(size)
        data = data[: len(data) // (row - 8) * (row - 8)]
        samples = np.frombuffer(data).reshape(-1, row // 8 - 1)
        steps = np.arange(step, step + len(samples), dtype=float)
        raw.write(np.column_stack([steps, samples]).tobytes())


def _forget(file: Path, step: int, row: int) -> None:
    """Cut off the rows at a step or later."""
    size = file.stat().st_size
    if size:
        steps = np.memmap(file, float, "r").reshape(-1, row // 8)[:, 0]
        os.truncate(file, int(np.searchsorted(steps, step)) * row)


def _write_csv(out: BinaryIO, rows: Any, head: RecordHead) -> None:
    out.write(csv_head(head).encode())
    for first in range(0, len(rows), _ROWS):
        block = rows[first : first + _ROWS]
        out.write(csv_rows(block[:, 0].astype(np.int64), block[:, 1:], head.step_ns).encode())


def csv_head(head: RecordHead) -> str:
    """The first line of a record in CSV: names with units."""
    named = zip(head.channels, head.units, strict=True)
    heads = ["time [s]", *(f"{name} [{unit}]" if unit else name for name, unit in named)]
    return ",".join(heads) + "\n"


def csv_rows(steps: Any, samples: Any, step_ns: int) -> str:
    """Lines of a record in CSV; all digits of a number, none for what is no number."""
    lines = []
    for step, row in zip(steps.tolist(), samples.tolist(), strict=True):
        whole, part = divmod(step * step_ns, 10**9)
        texts = ("" if x != x else repr(x) for x in row)
        lines.append(f"{whole}.{part:09d}," + ",".join(texts) + "\n")
    return "".join(lines)


def _write_npz(out: BinaryIO, rows: Any, head: RecordHead) -> None:
    """Write an array for each channel beside ``time`` [s]; NumPy's own would hold all in memory."""
    columns = {"time": 0} | {name: k + 1 for k, name in enumerate(head.channels)}
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED, allowZip64=True) as archive:
        for name, column in columns.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                shape = {"descr": "<f8", "fortran_order": False, "shape": (len(rows),)}
                np.lib.format.write_array_header_1_0(member, shape)
                for first in range(0, len(rows), _ROWS):
                    block = np.array(rows[first : first + _ROWS, column])
                    if not column:
                        block = block * head.step_ns / 1e9
                    member.write(block.tobytes())
