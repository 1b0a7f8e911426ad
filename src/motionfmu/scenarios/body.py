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
    input: Name  # input or tunable parameter, component.variable
    at: list[float] = Field(min_length=1)  # [s] times of the steps, on communication steps
    value: list[Value] = Field(min_length=1)  # the value from each time on


class Bounds(BaseModel):
    """Bounds of one signal or figure; each one given must hold."""

    model_config = _STRICT
    min: float | Pair | None = None  # no sample is below; of two numbers: the smallest is within
    max: float | Pair | None = None  # no sample is above; of two numbers: the largest is within
    # no magnitude is above; of two numbers: the largest is within
    absmax: float | Pair | None = None
    peak: Pair | None = None  # the largest magnitude of all samples and axes is within
    rms: Pair | None = None  # the root of the mean square of all samples and axes is within
    final: bool | float | Pair | None = None  # the last sample of every axis is this, or within
    # so often every axis has another value than in the sample before
    changes: float | Pair | None = None
    # every axis takes these values one after the other, and no others
    order: tuple[float, ...] | None = Field(default=None, min_length=1, max_length=LISTED_MAX)
    rate: float | None = None  # [s] the other bounds look at (x(t) - x(t - rate)) / rate
    at: float | None = None  # [s] the other bounds look at the first sample from this time on only
    # [s] the other bounds look at the samples within these spans only
    windows: tuple[Pair, ...] | None = Field(default=None, min_length=1)


class Contrary(BaseModel):
    """Values that switch off what the scenario claims; the checks it names must then fail."""

    model_config = _STRICT
    off: str = Field(min_length=1)  # in words: what is switched off
    set: dict[str, Value] = Field(min_length=1)  # values by component.variable, for the whole run
    fails: Names = Field(min_length=1)  # lines of [check] and [expect] each of which must fail


class Contour(BaseModel):
    """Which signals hold the actual position and the pulses put out."""

    model_config = _STRICT
    position: Name  # output: where the tool is
    pulses: Name  # output: the pulses that the card has put out


class RecordTable(BaseModel):
    """What is recorded: names or patterns of outputs, at every step or every so many."""

    model_config = _STRICT
    every: int = Field(default=1, ge=1, le=1_000_000)  # [steps]
    signals: list[Name] = Field(min_length=1, max_length=NAMED_MAX)  # names or patterns of outputs


class Plot(BaseModel):
    """One panel of a figure: signals, and how they are shown."""

    model_config = _STRICT
    signals: Names = Field(min_length=1)  # outputs, or elements of them
    label: str = Field(min_length=1)  # the vertical axis
    steps: bool = False  # values hold between samples; else straight lines
    rate: float | None = None  # [s] show (x(t) - x(t - rate)) / rate
    scale: float = 1.0  # factor, after rate
    levels: dict[str, float] = Field(default_factory=dict)  # dotted lines by their names
    names: list[str] | None = None  # one for each curve, instead of the signals' own


class Figure(BaseModel):
    """Panels above each other that share the time axis [s]."""

    model_config = _STRICT
    title: str = Field(min_length=1)  # heading of the section
    note: str = ""  # a sentence below the heading
    # [s] from and to; else the whole run
    window: list[float] | None = Field(default=None, min_length=2, max_length=2)
    plot: list[Plot] = Field(min_length=1, max_length=FIGURES_MAX)


class MachineSignals(BaseModel):
    """Where a machine takes its program, or targets, and tells that it is done."""

    model_config = _STRICT
    program: Name | None = None  # parameter that names it
    done: Name | None = None  # output that tells the end of the program
    fault: Name | None = None  # output that is not 0 once the controller has given the program up
    start: Name | None = None  # input that starts it when it becomes 1
    config: Name | None = None  # configuration of a network card, for which drawings are planned
    # Parameters that name a file beside the program with its name and this ending, if there is one.
    beside: dict[str, Ending] = Field(default_factory=dict, max_length=LISTED_MAX)
    target: Name | None = None  # input of a positioner: where to go when `start` becomes 1
    count: Annotated[float, Field(gt=0)] | None = None  # [m] of one of `target`
    lowest: Name | None = None  # parameters: least and largest target
    highest: Name | None = None  # see lowest
    homed: dict[str, Value] = Field(default_factory=dict)  # with which it starts as after homing


class MachineAxis(BaseModel):
    """An axis of a machine."""

    model_config = _STRICT
    # a letter or a word, as programs and pages have it
    name: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,31}$")]
    kind: Literal["linear", "rotary"]  # what it does
    row: int | None = Field(default=None, ge=1)  # its element of arrays, from 1


class DrawingTable(BaseModel):
    """What is done with a drawing that a machine gets as its program."""

    model_config = _STRICT
    # of contours; else inside for SVG and DXF, file for plots
    order: Literal["file", "nearest", "inside"] | None = None
    corners: Literal["round", "stop"] | None = None  # how sharp corners are taken
    # numbers of the pens that are drawn; else all
    pens: list[int] | None = Field(default=None, max_length=LISTED_MAX)
    speeds: bool = False  # the drawing's own speeds count
    at: Annotated[list[float], Field(min_length=2, max_length=2)] = [0.0, 0.0]  # [mm]
    scale: float = Field(default=1.0, gt=0, le=1e6)  # factor of the drawing's size
    copies: Annotated[
        list[Annotated[int, Field(ge=1, le=1000)]], Field(min_length=2, max_length=2)
    ] = [1, 1]  # along X and Y
    pitch: Annotated[list[float], Field(min_length=2, max_length=2)] = [0.0, 0.0]  # [mm]
    knife: float = Field(default=0.0, ge=0, le=100)  # [mm]
    up: float = 0.0  # [mm] Z of a mill above a drawing
    down: float = -1.0  # [mm] and in it
    page: int = Field(default=1, ge=1)  # which one of a file of HP-GL with several, from 1


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
    signal: Name  # output: its value for each axis
    derivative: int = Field(default=0, ge=0, le=3)  # the figure is this derivative by time
    limit: Bound | None = None  # of the figure's size
    over: Name | None = None  # parameter, a time: the limit is divided by it; 0: there is none
    low: Bound | None = None  # least value of the figure
    high: Bound | None = None  # largest value of the figure
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
    machine: Name | None = None  # machine whose tables are taken: its name, or the path of a folder
    signals: MachineSignals = MachineSignals()
    drawing: DrawingTable = DrawingTable()
    axis: list[MachineAxis] = Field(default_factory=list, max_length=LISTED_MAX)
    limits: dict[FigureName, FigureLimit] = Field(default_factory=dict, max_length=FIGURES_MAX)
    stop: Annotated[float, Field(gt=0)] | Name  # [s] when the run ends, or the signal that ends it
    fault: Name | None = None  # signal that ends the run, too, as one that failed
    # [s] at the latest, where a signal ends the run; planned: twice the planned time
    limit: Annotated[float, Field(gt=0)] | Literal["planned"] | None = None
    # [s] how long a run goes on behind the signal that ends it
    settle: float | None = Field(default=None, ge=0)
    begin: Name | None = None  # file of a saved state in which it begins
    step: float = Field(gt=0)  # [s] communication step
    # FMU by the name of the component
    component: dict[Component, Name] = Field(min_length=1, max_length=COMPONENTS_MAX)
    # output by input: wires; both have the same type, shape and unit
    connect: dict[str, Name] = Field(default_factory=dict, max_length=NAMED_MAX)
    # values of parameters, and of inputs that stay
    set: dict[str, Value] = Field(default_factory=dict)
    drive: list[Drive] = Field(default_factory=list, max_length=LISTED_MAX)
    # inputs left at their start values on purpose; patterns
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
