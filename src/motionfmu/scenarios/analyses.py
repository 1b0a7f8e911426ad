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
    position: Name
    quaternion: Name | None = None
    command: Name | None = None
    command_quaternion: Name | None = None
    points: list[Point] | None = Field(default=None, min_length=2, max_length=POINTS_MAX)
    file: Name | None = None
    cycles: list[Pair] | None = Field(default=None, min_length=1, max_length=CYCLES_MAX)
    during: Name | None = None
    between: Pair | None = None
    speed: float | None = Field(default=None, gt=0)
    normal: Point | None = None
    pen_width: float = Field(default=0.0, ge=0)
    planes: int = Field(default=200, ge=2, le=PLANES_MAX)
    ramp: float = Field(default=0.5, ge=0, lt=1)
    corner: float = Field(default=1.0, ge=0)
    poses: list[Point] = Field(default_factory=list, max_length=CYCLES_MAX)
    reached: list[Annotated[list[float], Field(max_length=CYCLES_MAX)]] = Field(
        default_factory=list, max_length=CYCLES_MAX
    )


class View(BaseModel):
    """What the moving picture shows."""

    model_config = STRICT
    tool: Name | None = None
    joints: Name | None = None
    works: Name | None = None  # above 0 while the tool works; else it moves from place to place
    lengths: Annotated[list[float], Field(min_length=7, max_length=7)] | None = None
    offsets: Six = [0.0] * 6
    signs: Six = [1.0] * 6
    pen: float = Field(default=0.0, ge=0)
    show: bool = True


class Waveform(BaseModel):
    """What a drive's monitor shows of one axis: speeds, torque, following error."""

    model_config = STRICT
    drives: Name
    axis: int = Field(ge=1)
    pulses: Name
    rated: float = Field(gt=0)
    over: float = Field(default=1e-3, gt=0)
    window: Pair | None = None
    title: str = ""
    note: str = ""


class RecordFile(BaseModel):
    """A record, how it is laid out, which inputs it drives and which signals it is laid over."""

    model_config = STRICT
    file: Name
    columns: dict[Name, Any] = Field(default_factory=dict, max_length=CYCLES_MAX)
    time: Name | None = None
    time_unit: Name | None = None
    rate: float | None = Field(default=None, gt=0)
    offset: float | Literal["start"] = 0.0
    delimiter: Name | None = None
    decimal: Literal[".", ","] | None = None
    encoding: Name | None = None
    skip: int = Field(default=0, ge=0)
    names: list[Name] | None = None
    duplicates: Literal["refuse", "first", "last", "mean"] = "refuse"
    missing: list[Name] = Field(default_factory=list, max_length=CYCLES_MAX)
    resample: Literal["linear", "hold"] = "linear"  # what lies between samples
    gaps: Literal["refuse", "interpolate"] = "refuse"  # where an input is driven
    drive: dict[Name, Name] = Field(default_factory=dict, max_length=CYCLES_MAX)
    over: dict[Name, Name] = Field(default_factory=dict, max_length=CYCLES_MAX)

    @property
    def layout(self) -> dict[str, Any]:
        """The options of `motionfmu.record`."""
        own = {"file", "resample", "gaps", "drive", "over"}
        return self.model_dump(exclude=own)
