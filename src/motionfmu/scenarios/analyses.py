"""Tables of a scenario that ask for an analysis or a view of the tool, or name a record."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from motionfmu.base.toml_lines import KEY_MAX

STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, defer_build=True)
CYCLES_MAX, POINTS_MAX = 1000, 100_000
PLANES_MAX = 10_000
Name = Annotated[str, Field(max_length=KEY_MAX)]
Pair = Annotated[list[float], Field(min_length=2, max_length=2)]
Point = Annotated[list[float], Field(min_length=3, max_length=3)]
Six = Annotated[list[float], Field(min_length=6, max_length=6)]


class Iso9283(BaseModel):
    """Which signals are the tool, its command path and its cycles, and how they are looked at."""

    model_config = STRICT
    position: Name  # output: where the tool is
    quaternion: Name | None = None  # output: how the tool is turned, (w, x, y, z)
    command: Name | None = None  # output whose first cycle is the command path
    command_quaternion: Name | None = None  # how the command is turned
    # [mm] corners of the command path
    points: list[Point] | None = Field(default=None, min_length=2, max_length=POINTS_MAX)
    file: Name | None = None  # file of the command path: x y z [mm] a line, or x y z w qx qy qz
    # [s] from and to of each run along the path
    cycles: list[Pair] | None = Field(default=None, min_length=1, max_length=CYCLES_MAX)
    during: Name | None = None  # output: every stretch with a value is a cycle
    # of `during`: what lies from the first value to the second is a cycle
    between: Pair | None = None
    speed: float | None = Field(default=None, gt=0)  # [mm/s] commanded; without it no AV and RV
    normal: Point | None = None  # of the surface that is drawn on; z if not given
    pen_width: float = Field(default=0.0, ge=0)  # [mm] of a painted stroke
    planes: int = Field(default=200, ge=2, le=PLANES_MAX)  # how many stand across the path, evenly
    # what is slower than this part of the speed at either end is left out
    ramp: float = Field(default=0.5, ge=0, lt=1)
    # [mm] left out to either side of a corner of more than 10 degrees
    corner: float = Field(default=1.0, ge=0)
    poses: list[Point] = Field(default_factory=list, max_length=CYCLES_MAX)  # [mm] commanded poses
    # [s] when each pose is reached, a row for each cycle
    reached: list[Annotated[list[float], Field(max_length=CYCLES_MAX)]] = Field(
        default_factory=list, max_length=CYCLES_MAX
    )


class View(BaseModel):
    """What the moving picture shows."""

    model_config = STRICT
    tool: Name | None = None  # output: where the tool is
    joints: Name | None = None  # output: [rad] six angles of the joints
    works: Name | None = None  # above 0 while the tool works; else it moves from place to place
    # [m] a1 a2 b c1 c2 c3 c4 of the arm instead of the FMU's
    lengths: Annotated[list[float], Field(min_length=7, max_length=7)] | None = None
    offsets: Six = [0.0] * 6  # [rad] angle of the link = sign q - offset
    signs: Six = [1.0] * 6  # of each joint, 1 or -1
    pen: float = Field(default=0.0, ge=0)  # [m] length of the tool, along z of the flange
    show: bool = True  # whether there is a picture


class Waveform(BaseModel):
    """What a drive's monitor shows of one axis: speeds, torque, following error."""

    model_config = STRICT
    drives: Name  # component of the FMU servo_drives
    axis: int = Field(ge=1)  # its number, from 1
    pulses: Name  # output: command pulses
    rated: float = Field(gt=0)  # [N·m] that is 100 % torque
    over: float = Field(default=1e-3, gt=0)  # [s] time over which speed is taken
    window: Pair | None = None  # [s] from and to; else the whole run
    title: str = ""  # heading of the section
    note: str = ""  # a sentence below the heading


class RecordFile(BaseModel):
    """A record, how it is laid out, which inputs it drives and which signals it is laid over."""

    model_config = STRICT
    file: Name  # beside the scenario; or the folder of a result
    # by a name of one's own: a column's name, a list, or column, unit, scale, zero, round
    columns: dict[Name, Any] = Field(default_factory=dict, max_length=CYCLES_MAX)
    time: Name | None = None  # column of the times
    time_unit: Name | None = None  # unit of the times
    # [1/s] samples a second, of a record without times
    rate: float | None = Field(default=None, gt=0)
    # [s] added to all times; start: the first sample is at 0
    offset: float | Literal["start"] = 0.0
    delimiter: Name | None = None  # between columns; else found by itself
    decimal: Literal[".", ","] | None = None  # mark of a decimal; else found by itself
    encoding: Name | None = None  # of the text; else found by itself
    skip: int = Field(default=0, ge=0)  # lines at the top to pass over
    names: list[Name] | None = None  # of all columns, where the file has none
    duplicates: Literal["refuse", "first", "last", "mean"] = "refuse"  # of two values at one time
    # texts that stand for no value
    missing: list[Name] = Field(default_factory=list, max_length=CYCLES_MAX)
    resample: Literal["linear", "hold"] = "linear"  # what lies between samples
    gaps: Literal["refuse", "interpolate"] = "refuse"  # where an input is driven
    # column by input: its value at the beginning of each step
    drive: dict[Name, Name] = Field(default_factory=dict, max_length=CYCLES_MAX)
    # column by output that it is laid over
    over: dict[Name, Name] = Field(default_factory=dict, max_length=CYCLES_MAX)

    @property
    def layout(self) -> dict[str, Any]:
        """The options of `motionfmu.record`."""
        own = {"file", "resample", "gaps", "drive", "over"}
        return self.model_dump(exclude=own)
