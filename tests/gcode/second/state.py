"""What a part program is read with, what it makes, and what is in force in it."""

from dataclasses import dataclass, field
from pathlib import Path

from second.parameters import Parameters

AXES = 6
Point = tuple[float, ...]


class Refused(Exception):
    """The program is wrong in a line, counted from 1."""

    def __init__(self, line: int, why: str) -> None:
        super().__init__(f"line {line}: {why}")
        self.line, self.why = line, why


@dataclass
class Options:
    """How a program is read: switches, start, tools by number as length and diameter [mm]."""

    block_delete: bool = False
    optional_stop: bool = True
    angles: bool = False  # A B C instead of U V W
    fanuc: bool = False  # G4, M98, G51, G65 as Fanuc's controls read them
    feed: float = 10.0  # [mm/s] until the first F
    point: Point = (0.0,) * AXES  # [mm] at the start
    origin: list[list[float]] = field(default_factory=lambda: [[0.0] * AXES for _ in range(9)])
    tools: dict[int, tuple[float, float]] = field(default_factory=dict)
    closed: bool = False  # there are no other tools
    stops: bool = True  # M6 waits for the operator
    folder: Path | None = None  # of files that it calls


@dataclass
class Step:
    """One thing the machine does; only the members of its kind mean something."""

    kind: str  # rapid line arc spline nurbs dwell outputs stop tool
    line: int
    end: Point  # [mm] machine coordinates
    start: Point = ()
    feed: float = 0.0  # [mm/s]
    plane: int = 2  # index of the axis that stands on it
    centre: tuple[float, float] = (0.0, 0.0)  # [mm] in the plane's first and second axis
    sweep: float = 0.0  # [rad] counter-clockwise positive
    control: tuple[tuple[float, float], ...] = ()  # [mm] of a spline, with start and end
    nurbs: tuple[tuple[float, ...], ...] = ()  # [mm] points, and their weights
    order: int = 0  # of a NURBS
    dwell: float = 0.0  # [s]
    set: int = 0  # digital outputs, bits
    clear: int = 0
    spindle: float = 0.0  # [rpm], counter-clockwise below 0
    coolant: int = 0  # 1 mist, 2 flood
    overrides: int = 0  # bits of `machine.FEED` .. `machine.HOLD`
    surface: tuple[float, float] = (0.0, 0.0)  # [mm/s] of G96, and X of its axis [mm]
    analog: dict[int, float] = field(default_factory=dict)  # outputs that change
    probes: bool = False
    tool: int = 0


@dataclass
class State:
    """All modes in force, where the tool is, and the steps made so far."""

    options: Options
    parameters: Parameters = field(default_factory=Parameters)
    steps: list[Step] = field(default_factory=list)
    line: int = 0
    motion: int = -1  # ten times the number of its G; -1 none
    plane: int = 2
    inch: bool = False
    incremental: bool = False
    absolute_centre: bool = False
    feed_mode: int = 940
    feed: float = 0.0  # [mm/s]; of G95 [mm] a turn
    system: int = 0
    origin: list[list[float]] = field(default_factory=list)
    turns: list[float] = field(default_factory=lambda: [0.0] * 108)  # [deg] R of G10 L2
    shift: list[float] = field(default_factory=lambda: [0.0] * AXES)  # G52, G92
    shifted: bool = False
    length: list[float] = field(default_factory=lambda: [0.0] * AXES)  # of the tool, G43
    scaled: bool = False  # G51
    rotated: bool = False  # G68
    scale: list[float] = field(default_factory=lambda: [1.0] * 3)  # G51
    scale_at: list[float] = field(default_factory=lambda: [0.0] * 3)
    turn: float = 0.0  # [deg] G68
    turn_at: tuple[float, float] = (0.0, 0.0)
    turn_plane: int = 2
    polar: bool = False  # G16
    pole: tuple[float, float] = (0.0, 0.0)
    polar_radius: float = 0.0
    polar_angle: float = 0.0  # [deg]
    home: list[list[float]] = field(default_factory=lambda: [[0.0] * AXES, [0.0] * AXES])
    point: list[float] = field(default_factory=list)  # [mm] machine coordinates
    speed: float = 0.0  # [rpm] S of G97
    by_radius: bool = False  # G96
    passing: float = 0.0  # [mm/s] its S
    most: float = 0.0  # [rpm] its D
    turning: int = 0  # 1 M3, -1 M4
    coolant: int = 0
    set: int = 0  # outputs that wait for the next motion
    clear: int = 0
    overrides: int = 0  # as in `Step`
    analog: dict[int, float] = field(default_factory=dict)  # M67, for the next motion
    told: tuple[float, float] = (0.0, 0.0)  # of G96, to the machine
    answer: float = 0.0  # to M66
    touched: float = 0.0  # #5070
    debug: float = 1.0  # #5599
    contact: list[float] = field(default_factory=lambda: [0.0] * AXES)  # of the probe, program
    selected: int = 0  # T
    chosen: bool = False  # since the latest M6
    tool: int = 0  # in the spindle
    old_plane: bool = True  # G98
    old_level: float | None = None  # where the series of cycles began
    sticky: dict[str, float] = field(default_factory=dict)  # words of a cycle
    spline: tuple[float, float] | None = None  # direction in which the last G5 ended
    nurbs: list[tuple[list[float], float]] = field(default_factory=list)  # since G5.2
    nurbs_order: int = 0
    nurbs_feed: float = 0.0  # [mm/s]
    nurbs_plane: int = 2  # that of G5.2
    nurbs_line: int = 0  # of the latest point
    side: int = 0  # of compensation: -1 right, 1 left
    edge: float = 0.0  # [mm] of the centre to the left of the contour
    contour_from: int = 0  # first step of the contour
    # Behind G40: where the contour ended, where the tool stands beside it, the axes of its plane.
    aside: tuple[list[float], list[float], tuple[int, int]] | None = None
    ended: bool = False
    saved: list[dict[str, object]] = field(default_factory=lambda: [{}])  # M70, a row each call

    @property
    def rpm(self) -> float:
        """Speed of the spindle, in G96 the most it may have."""
        most = self.most if self.passing > 0.0 else 0.0
        return self.turning * (most if self.by_radius else self.speed)

    @property
    def unit(self) -> float:
        """Millimetres in a unit of the program."""
        return 25.4 if self.inch else 1.0
