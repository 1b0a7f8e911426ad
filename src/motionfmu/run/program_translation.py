"""Programs in a language that a machine's controller does not read, translated into its own."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.base.disk_cache import kept, key
from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.drawings import DrawingOptions
from motionfmu.run import joint_trajectory
from motionfmu.run.trajectory_job import job_of
from motionfmu.run.translated_places import write_places
from motionfmu.scenarios import fmus
from motionfmu.scenarios.document import Document

if TYPE_CHECKING:
    from motionfmu.drawings import Drawing

GCODE = (".ngc", ".nc", ".tap", ".gcode")  # endings of part programs
JOB, ROWS = ".mcj", ".npy"
ANOTHER = "--page or [drawing] page chooses another"
CHORD = 1e-3  # [mm] a chord is off an arc of a part program by no more, where a card draws it


@dataclass(frozen=True)
class MachineProgram:
    """What a controller gets: the file, values beside it, how long it takes if that is known."""

    file: Path
    values: dict[str, Any] = field(default_factory=dict)
    seconds: float | None = None
    notes: tuple[str, ...] = ()  # what of a drawing is left out
    page: int = 1  # which of a drawing's
    pages: int = 1  # that it has
    paged: str = ""  # the same in words, of a drawing with several

    @property
    def told(self) -> tuple[str, ...]:
        """All that is to be known of it."""
        return (*((self.paged,) if self.paged else ()), *self.notes)


def program_for(
    document: Document, file: Path, given: Mapping[str, Any] | None = None
) -> MachineProgram:
    """The program as the machine's controller reads it; as it is, if it reads it or refuses it.

    Values that are given for the run are stronger than the machine's.
    """
    component = str(document.body.signals.program).partition(".")[0]
    if file.suffix.lower() in joint_trajectory.ENDINGS and document.body.signals.config is None:
        ports = fmus.ports(document.body.component[component])
        if {"joint_speed", "points"} <= ports.keys():
            return _trajectory(document, component, file, dict(given or {}))
    from motionfmu.drawings.reading import ENDINGS, is_drawing

    drawn = is_drawing(file)
    if not drawn and (given := options_of(document).changes):
        if any(document.sources[0].has("drawing", _KEYS.get(key, key), None) for key in given):
            raise InputError(f"{file}: {', '.join(given)} is for drawings ({', '.join(ENDINGS)})")
    if document.body.signals.config is not None:
        return _job(document, component, file)
    if drawn and "tool_table" in fmus.ports(document.body.component[component]):
        return drawing_as_gcode(
            file, options_of(document), any(a.name == "Z" for a in document.axes)
        )
    return MachineProgram(file)


_KEYS = {"offset": "at"}


def _trajectory(
    document: Document, component: str, file: Path, given: dict[str, Any]
) -> MachineProgram:
    """A joint trajectory as a job; corners between its points flow."""
    ports = fmus.ports(document.body.component[component])
    name = f"{component}.joint_speed"
    start = str(ports["joint_speed"].start).split()
    asked = (dict(document.body.set) | given).get(name, [float(x) for x in start])
    speeds = np.broadcast_to(np.asarray(asked, dtype=float), (len(start),))
    job = job_of(
        joint_trajectory.read_trajectory(file), file, [a.name for a in document.axes], speeds
    )

    def make(target: Path) -> None:
        target.write_text(job.text, encoding="utf-8")
        write_places(target, file, [f"line {n}" for n in job.lines])

    values = {f"{component}.flow": True} if "flow" in ports else {}
    made = _made(f"{file.stem}.job", make, job.text, str(file), str(job.lines))
    return MachineProgram(made, values, notes=job.notes)


def options_of(document: Document) -> DrawingOptions:
    """What a machine and whoever runs it ask of a drawing."""
    table = document.body.drawing
    i, j = table.copies
    if (i > 1 and table.pitch[0] == 0.0) or (j > 1 and table.pitch[1] == 0.0):
        raise document.error(f"copies = {table.copies}: a pitch is missing", "drawing", "copies")
    plain = table.model_dump(exclude={"at", "copies", "pitch"})
    x, y = table.at
    return DrawingOptions(
        **plain, offset=(x, y), copies=(i, j), pitch=(table.pitch[0], table.pitch[1])
    )


def drawing_as_gcode(file: Path, options: DrawingOptions, has_z: bool) -> MachineProgram:
    """A drawing as a part program, with the pen as Z if there is one."""
    from motionfmu.drawings import reading
    from motionfmu.drawings.contours import contours_of
    from motionfmu.drawings.gcode_text import gcode_of

    drawing = reading.read(file, page=options.page)
    contours = contours_of(drawing, options)
    if not contours:
        raise InputError(drawing.nothing)
    made = gcode_of(contours, file.name, options, has_z)
    told = {first: drawing.place(first) for first in set(made.source) if first >= 0}
    places = [told.get(first, "") for first in made.source]
    name = f"{file.stem}.ngc"

    def make(target: Path) -> None:
        target.write_text(made.text, encoding="utf-8")
        write_places(target, file, places)

    return MachineProgram(
        _made(name, make, made.text, str(file), "\n".join(places)), **_told(drawing)
    )


def _told(drawing: "Drawing") -> dict[str, Any]:
    """What a `MachineProgram` says of the drawing that it was made of."""
    notes = (drawing.told,) if drawing.notes else ()
    paged = drawing.paged and f"{drawing.name}: {drawing.paged}; {ANOTHER}"
    return {"notes": notes, "page": drawing.page, "pages": drawing.pages, "paged": paged}


def _made(name: str, make: Callable[[Path], Any], *parts: str | bytes) -> Path:
    """A translated file, which is made once of these parts."""
    return kept("programs", key(name, *parts), lambda folder: make(folder / name)) / name


def _job(document: Document, component: str, file: Path) -> MachineProgram:
    """A job for a network card, with the parameters that its configuration gives the card."""
    needed("card")
    from motionfmu.cards import card_job, load
    from motionfmu.cards.plan import plan, write
    from motionfmu.cards.plan_rows import plan_rows
    from motionfmu.drawings import reading
    from motionfmu.drawings.reading import ENDINGS, is_drawing

    name = str(document.body.signals.config)
    place = document.beside_config()
    if place is None:
        raise document.error(f"config = {name!r}: no such file", "signals", "config")
    config = load(place)
    values = {f"{component}.{k}": v for k, v in config.as_parameters().items()}
    told: dict[str, Any] = {}
    if file.suffix.lower() != JOB:
        options = options_of(document)
        if is_drawing(file):
            drawing = reading.read(file, page=options.page)
        elif file.suffix.lower() in GCODE:
            drawing, options = _drawing_of(file), DrawingOptions()
        else:
            wanted = f"a drawing ({', '.join(ENDINGS)}), a job ({JOB}) or a part program wanted"
            raise InputError(f"{file}: {wanted}")
        planned = plan(drawing, config, options)
        told = _told(drawing)

        def make(target: Path) -> None:
            write(planned.job, target)
            np.save(motion_file(target), plan_rows(planned, config))

        file = _made(f"{file.stem}{JOB}", make, planned.job, ROWS)
    return MachineProgram(file, values, card_job.read(file).time, **told)


def motion_file(job: str | Path) -> Path:
    """Where the planned motion of a job made here is kept."""
    return Path(job).with_suffix(ROWS)


def _drawing_of(file: Path) -> "Drawing":
    """The path of a part program in X and Y: what it moves with feed is drawn."""
    from motionfmu.analysis.gcode import read, strokes
    from motionfmu.analysis.gcode.program import TYPES
    from motionfmu.analysis.gcode.summary import MOTIONS
    from motionfmu.drawings import Drawing, Polyline
    from motionfmu.drawings.pen_path import PenPath

    program = read(file)
    if program.faults:
        raise InputError(*(f"{file}: {fault}" for fault in program.faults))
    fed = program.commands[np.isin(np.array(TYPES)[program.commands["type"]], MOTIONS)]
    lines_in_z = fed["line"][fed["end"][:, 2] != fed["start"][:, 2]]
    if len(lines_in_z):
        told = "Z moves with feed; the card draws in X and Y"
        raise InputError(f"{file}: line {lines_in_z[0]}: {told}")
    lines = []
    for stroke in strokes(program, CHORD):
        first = int(stroke.line[0])
        path = PenPath.lines(stroke.points[:, :2], first)
        lines.append(Polyline(1, not stroke.rapid, path, first))
    return Drawing(lines, [], str(file), program.text.encode(), place="line {}".format)


def time_of(seconds: float, start: float, settle: float) -> float:
    """When a run of a program with this duration ends [s], a whole number of 10 ms."""
    return math.ceil((start + seconds + settle) * 100) / 100
