"""Programs in a language that a machine's controller does not read, translated into its own."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.base.disk_cache import kept, key
from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.scenarios import fmus
from motionfmu.scenarios.document import Document

if TYPE_CHECKING:
    from motionfmu.cards.plt import PltDrawing

GCODE = (".ngc", ".nc", ".tap", ".gcode")  # endings of part programs
DRAWING, JOB = ".plt", ".mcj"
# [mm] Z of the tool above a drawing and in it, where a machine with a Z axis draws.
UP, DOWN = 0.0, -1.0
CHORD = 1e-3  # [mm] a chord is off an arc of a part program by no more, where a card draws it


@dataclass(frozen=True)
class MachineProgram:
    """What a controller gets: the file, values beside it, how long it takes if that is known."""

    file: Path
    values: dict[str, Any] = field(default_factory=dict)
    seconds: float | None = None


def program_for(document: Document, file: Path) -> MachineProgram:
    """The program as the machine's controller reads it; as it is, if it reads it or refuses it."""
    component = str(document.body.signals.program).partition(".")[0]
    if document.body.signals.config is not None:
        return _job(document, component, file)
    reads_gcode = "tool_table" in fmus.ports(document.body.component[component])
    if file.suffix.lower() == DRAWING and reads_gcode:
        lines = _gcode_of(file, any(axis.name == "Z" for axis in document.axes))
        text = "\n".join(lines) + "\n"
        return MachineProgram(_made(f"{file.stem}.ngc", lambda made: made.write_text(text), text))
    return MachineProgram(file)


def _made(name: str, make: Callable[[Path], Any], *parts: str | bytes) -> Path:
    """A translated file, which is made once of these parts."""
    return kept("programs", key(name, *parts), lambda folder: make(folder / name)) / name


def _job(document: Document, component: str, file: Path) -> MachineProgram:
    """A job for a network card, with the parameters that its configuration gives the card."""
    needed("card")
    from motionfmu.cards import job, load, plt
    from motionfmu.cards.plan import plan, write

    name = str(document.body.signals.config)
    place = document.beside(name)
    if place is None:
        raise document.error(f"config = {name!r}: no such file", "signals", "config")
    config = load(place)
    values = {f"{component}.{k}": v for k, v in config.as_parameters().items()}
    if file.suffix.lower() != JOB:
        if file.suffix.lower() == DRAWING:
            drawing = plt.read(file)
        elif file.suffix.lower() in GCODE:
            drawing = _drawing_of(file)
        else:
            told = f"a drawing ({DRAWING}), a job ({JOB}) or a part program wanted"
            raise InputError(f"{file}: {told}")
        planned = plan(drawing, config)
        file = _made(f"{file.stem}{JOB}", lambda made: write(planned.job, made), planned.job)
    return MachineProgram(file, values, job.read(file).time)


def _drawing_of(file: Path) -> "PltDrawing":
    """The path of a part program in X and Y: what it moves with feed is drawn."""
    from motionfmu.analysis.gcode import read, strokes
    from motionfmu.analysis.gcode.program import TYPES
    from motionfmu.analysis.gcode.summary import MOTIONS
    from motionfmu.cards.plt import PltDrawing
    from motionfmu.cards.plt_plotter import Polyline

    program = read(file)
    if program.faults:
        raise InputError(*(f"{file}: {fault}" for fault in program.faults))
    fed = program.commands[np.isin(np.array(TYPES)[program.commands["type"]], MOTIONS)]
    lines_in_z = fed["line"][fed["end"][:, 2] != fed["start"][:, 2]]
    if len(lines_in_z):
        told = "Z moves with feed; the card draws in X and Y"
        raise InputError(f"{file}: line {lines_in_z[0]}: {told}")
    text = program.text.encode()
    starts = np.cumsum([0, *(len(line) + 1 for line in text.split(b"\n"))])
    lines = []
    for stroke in strokes(program, CHORD):
        first = int(starts[int(stroke.line[0]) - 1])
        last = int(starts[int(stroke.line[-1])])
        lines.append(Polyline(1, not stroke.rapid, stroke.points[:, :2], first, last))
    return PltDrawing(lines, [], file.name, text)


def _gcode_of(file: Path, has_z: bool) -> Iterator[str]:
    """A drawing as lines of a part program, with the pen as Z if there is one."""
    needed("card")
    from motionfmu.cards import plt
    from motionfmu.cards.contours import clean

    contours = clean(plt.read(file))
    if not contours:
        raise InputError(f"{file}: nothing is drawn")
    up, down = (f"G0 Z{UP:g}", f"G1 Z{DOWN:g}") if has_z else ("", "")
    yield from (f"({_plain(file.name)})", "G90 G21 G17 G94 G61")
    for contour in contours:
        yield from (line for line in (up, f"G0 {_place(contour.points[0])}", down) if line)
        if contour.speed:
            yield f"F{contour.speed * 60:.6g}"
        yield from (f"G1 {_place(point)}" for point in contour.points[1:])
    yield from (line for line in (up, "M2") if line)


def _place(point: np.ndarray) -> str:
    return f"X{point[0]:.6f} Y{point[1]:.6f}"


def _plain(name: str) -> str:
    """A name that a comment can hold."""
    return "".join(c for c in name if c.isalnum() or c in " ._-")


def time_of(seconds: float, start: float, settle: float) -> float:
    """When a run of a program with this duration ends [s], a whole number of 10 ms."""
    return math.ceil((start + seconds + settle) * 100) / 100
