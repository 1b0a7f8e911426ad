"""The tables of a scenario: their keys and types."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, PlainValidator
from pydantic_core import PydanticCustomError

from motionfmu.base.toml_lines import KEY_MAX
from motionfmu.scenarios.analyses import Iso9283, RecordFile, View, Waveform

Value = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]
Pair = tuple[float, float]
_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, defer_build=True)
# Each component is an FMU with a library and a folder of its own.
COMPONENTS_MAX = 64
# A component's name becomes that of an FMU instance and of a file; names of the recorder's own
# components begin with "_".
Component = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,63}$")]
# A figure of the axes, such as speed.
FigureName = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,63}$")]
# So many names and patterns at most, for each is compared with all variables of all components.
LISTED_MAX = 1000
NAMED_MAX = 10_000  # exact names: elements of arrays, where an SSP has FMUs of FMI 2
FIGURES_MAX = 100  # a picture each
LONGEST = 1e5  # [s] run: more than a day of machine time
# The limit of a run that may take twice the planned time of its program; at least so long [s].
PLANNED: Literal["planned"] = "planned"
PLANNED_LEAST = 600.0
# Tables of bounds: what must hold whatever is set, and what the scenario as written must give.
CHECK, EXPECT = JUDGED = ("check", "expect")
Name = Annotated[str, Field(max_length=KEY_MAX)]
Ending = Annotated[str, Field(pattern=r"^\.[A-Za-z0-9]{1,32}$")]
Names = Annotated[list[Name], Field(max_length=LISTED_MAX)]


class Drive(BaseModel):
    """An input that steps to given values at given times [s]."""

    model_config = _STRICT
    input: Name
    at: list[float] = Field(min_length=1)
    value: list[Value] = Field(min_length=1)


class Bounds(BaseModel):
    """Bounds of one signal or figure; each one given must hold."""

    model_config = _STRICT
    min: float | Pair | None = None
    max: float | Pair | None = None
    absmax: float | Pair | None = None
    peak: Pair | None = None
    rms: Pair | None = None
    final: bool | float | Pair | None = None
    changes: float | Pair | None = None
    order: tuple[float, ...] | None = Field(default=None, min_length=1, max_length=LISTED_MAX)
    rate: float | None = None
    at: float | None = None
    windows: tuple[Pair, ...] | None = Field(default=None, min_length=1)


class Contrary(BaseModel):
    """Values that switch off what the scenario claims; the checks it names must then fail."""

    model_config = _STRICT
    off: str = Field(min_length=1)
    set: dict[str, Value] = Field(min_length=1)
    fails: Names = Field(min_length=1)


class Contour(BaseModel):
    """Which signals hold the actual position and the pulses put out."""

    model_config = _STRICT
    position: Name
    pulses: Name


class RecordTable(BaseModel):
    """What is recorded: names or patterns of outputs, at every step or every so many."""

    model_config = _STRICT
    every: int = Field(default=1, ge=1, le=1_000_000)  # [steps]
    signals: list[Name] = Field(min_length=1, max_length=NAMED_MAX)


class Plot(BaseModel):
    """One panel of a figure: signals, and how they are shown."""

    model_config = _STRICT
    signals: Names = Field(min_length=1)
    label: str = Field(min_length=1)
    steps: bool = False
    rate: float | None = None
    scale: float = 1.0
    levels: dict[str, float] = Field(default_factory=dict)
    names: list[str] | None = None


class Figure(BaseModel):
    """Panels above each other that share the time axis [s]."""

    model_config = _STRICT
    title: str = Field(min_length=1)
    note: str = ""
    window: list[float] | None = Field(default=None, min_length=2, max_length=2)
    plot: list[Plot] = Field(min_length=1, max_length=FIGURES_MAX)


class MachineSignals(BaseModel):
    """Where a machine takes its program, or targets, and tells that it is done."""

    model_config = _STRICT
    program: Name | None = None  # parameter that names it
    done: Name | None = None
    start: Name | None = None  # input that starts it when it becomes 1
    config: Name | None = None  # configuration of a network card, for which drawings are planned
    # Parameters that name a file beside the program with its name and this ending, if there is one.
    beside: dict[str, Ending] = Field(default_factory=dict, max_length=LISTED_MAX)
    target: Name | None = None  # input of a positioner: where to go when `start` becomes 1
    count: Annotated[float, Field(gt=0)] | None = None  # [m] of one of `target`
    lowest: Name | None = None  # parameters: least and largest target
    highest: Name | None = None
    homed: dict[str, Value] = Field(default_factory=dict)  # with which it starts as after homing


class MachineAxis(BaseModel):
    """An axis of a machine."""

    model_config = _STRICT
    name: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,31}$")]
    kind: Literal["linear", "rotary"]
    row: int | None = Field(default=None, ge=1)  # its element of arrays, from 1


class DrawingTable(BaseModel):
    """What is done with a drawing that a machine gets as its program."""

    model_config = _STRICT
    order: Literal["file", "nearest", "inside"] | None = None
    corners: Literal["round", "stop"] | None = None
    pens: list[int] | None = Field(default=None, max_length=LISTED_MAX)
    speeds: bool = False
    at: Annotated[list[float], Field(min_length=2, max_length=2)] = [0.0, 0.0]  # [mm]
    scale: float = Field(default=1.0, gt=0, le=1e6)
    copies: Annotated[
        list[Annotated[int, Field(ge=1, le=1000)]], Field(min_length=2, max_length=2)
    ] = [1, 1]  # along X and Y
    pitch: Annotated[list[float], Field(min_length=2, max_length=2)] = [0.0, 0.0]  # [mm]
    knife: float = Field(default=0.0, ge=0, le=100)  # [mm]
    up: float = 0.0  # [mm] Z of a mill above a drawing
    down: float = -1.0  # [mm] and in it


def _bound(x: Any) -> Any:
    """A number, one for each axis, or a name, as they come from TOML."""
    listed = x if isinstance(x, list | tuple) else [x]
    numbers = all(isinstance(n, int | float) and not isinstance(n, bool) for n in listed)
    if isinstance(x, str) and 0 < len(x) <= KEY_MAX:
        return x
    if not (numbers and listed and all(math.isfinite(n) for n in listed)):
        told = "a number, a list of one for each axis, or the name of a parameter wanted"
        raise PydanticCustomError("bound", told)
    return tuple(map(float, x)) if isinstance(x, list | tuple) else float(x)


Bound = Annotated[float | tuple[float, ...] | str, PlainValidator(_bound)]


def _numbers(x: Any) -> Any:
    """Times from TOML: one, or one for each axis, above 0."""
    found = _bound(x)
    if isinstance(found, str) or min(found if isinstance(found, tuple) else (found,)) <= 0.0:
        told = "a time above 0, or a list of one for each axis wanted"
        raise PydanticCustomError("numbers", told)
    return found


Numbers = Annotated[float | tuple[float, ...], PlainValidator(_numbers)]


class FigureLimit(BaseModel):
    """Where the signal of a figure of the axes is, and what limits it."""

    model_config = _STRICT
    signal: Name
    derivative: int = Field(default=0, ge=0, le=3)  # the figure is this derivative by time
    limit: Bound | None = None  # of the figure's size
    over: Name | None = None  # parameter, a time: the limit is divided by it; 0: there is none
    low: Bound | None = None
    high: Bound | None = None
    continuous: Bound | None = None  # of its RMS
    overload: Numbers | None = None  # [s] that it may stay above continuous at a time
    when: Name | None = None  # parameter; where it is 0 or false there is no limit


def _listed(x: Any) -> Any:
    """A list of tables of bounds; a single table becomes a list of one."""
    return tuple(x) if isinstance(x, list | tuple) else (x,)


Checks = Annotated[
    tuple[Bounds, ...], BeforeValidator(_listed), Field(min_length=1, max_length=LISTED_MAX)
]


class Body(BaseModel):
    """The tables of a scenario.toml."""

    model_config = _STRICT
    machine: Name | None = None
    signals: MachineSignals = MachineSignals()
    drawing: DrawingTable = DrawingTable()
    axis: list[MachineAxis] = Field(default_factory=list, max_length=LISTED_MAX)
    limits: dict[FigureName, FigureLimit] = Field(default_factory=dict, max_length=FIGURES_MAX)
    stop: Annotated[float, Field(gt=0)] | Name
    limit: Annotated[float, Field(gt=0)] | Literal["planned"] | None = None
    settle: float | None = Field(default=None, ge=0)
    begin: Name | None = None  # file of a saved state in which it begins
    step: float = Field(gt=0)
    component: dict[Component, Name] = Field(min_length=1, max_length=COMPONENTS_MAX)
    connect: dict[str, Name] = Field(default_factory=dict, max_length=NAMED_MAX)
    set: dict[str, Value] = Field(default_factory=dict)
    drive: list[Drive] = Field(default_factory=list, max_length=LISTED_MAX)
    leave: Names = Field(default_factory=list)
    record: RecordTable
    record_file: RecordFile | None = None
    contour: Contour | None = None
    iso9283: Iso9283 | None = None
    view: View = View()
    figure: list[Figure] = Field(default_factory=list, max_length=FIGURES_MAX)
    waveform: list[Waveform] = Field(default_factory=list, max_length=FIGURES_MAX)
    check: dict[str, Checks] = Field(default_factory=dict, max_length=LISTED_MAX)
    expect: dict[str, Checks] = Field(default_factory=dict, max_length=LISTED_MAX)
    contrary: list[Contrary] = Field(default_factory=list, max_length=LISTED_MAX)

    @property
    def stop_limit(self) -> float:
        """The latest time at which a run ends [s]; before it is planned, the least."""
        if isinstance(self.stop, float):
            return self.stop
        return PLANNED_LEAST if self.limit == "planned" else self.limit or LONGEST

    @property
    def driven(self) -> frozenset[str]:
        """Inputs that [drive] or a record drives, whole arrays by their names."""
        given = self.record_file.drive if self.record_file else {}
        return frozenset((*(d.input for d in self.drive), *(n.partition("[")[0] for n in given)))

    @property
    def asked(self) -> Iterator[tuple[str, str, tuple[Bounds, ...]]]:
        """Each line by which a run is judged: its table, name and bounds."""
        for table in JUDGED:
            for name, checks in getattr(self, table).items():
                yield table, name, checks


# The pydantic model of each table, by the table's name.
MODELS: dict[str, type[BaseModel]] = {
    "drive": Drive,
    "check": Bounds,
    "expect": Bounds,
    "contrary": Contrary,
    "contour": Contour,
    "record": RecordTable,
    "record_file": RecordFile,
    "signals": MachineSignals,
    "drawing": DrawingTable,
    "axis": MachineAxis,
    "limits": FigureLimit,
    "figure": Figure,
    "plot": Plot,
    "iso9283": Iso9283,
    "view": View,
    "waveform": Waveform,
}
