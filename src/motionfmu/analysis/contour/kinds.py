"""Plain numbers of a contour analysis, with the names that result.json has."""

from dataclasses import dataclass

AXES = "xyzuvw"


@dataclass(frozen=True)
class Corner:
    """A corner between two cutting moves."""

    line_before: int  # of the program
    line_after: int
    point: tuple[float, float, float]  # [mm]
    angle: float  # change of direction; pi for a line that turns back [rad]
    error: float  # largest contour error on the two moves within the servo window [mm]
    time: float  # when it is largest [s]
    speed: float  # least commanded speed within the servo window [mm/s]


@dataclass(frozen=True)
class Statistics:
    """Size of an error over many samples: its magnitude [mm], and where it is largest."""

    max: float
    rms: float
    mean: float
    p50: float
    p95: float
    p99: float
    time: float  # when it is largest [s]
    line: int  # of the program, and command, where it is largest
    command: int
    point: tuple[float, float, float]  # of the path where it is largest [mm]


@dataclass(frozen=True)
class CircleFigures:
    """Circular test of one directed path [mm]."""

    # circular deviation G: minimum radial separation of two concentric circles (minimum zone, own
    # centre) that envelop the path
    g: float
    g_least_squares: float  # range of the radii about the least-squares centre
    # radial deviation F: largest distance from the nominal centre, minus the nominal radius
    f_max: float
    f_min: float  # with the smallest distance
    f_max_centred: float  # the same about the least-squares centre, set-up errors removed
    f_min_centred: float
    radius_change: float  # mean radius about the least-squares centre, minus the nominal radius
    radius_change_nominal: float  # about the nominal centre
    offset: tuple[float, float]  # least-squares centre minus nominal centre, in the plane's axes
    major_change: float  # semi-axes of the fitted ellipse minus the nominal radius
    minor_change: float
    orientation: float  # of the major axis from the plane's first axis [rad]


@dataclass(frozen=True)
class BothWays:
    """Circular test of both directions together [mm]."""

    # bi-directional circular deviation G(b): minimum radial separation of two concentric circles
    # (minimum zone) that envelop both paths
    g: float
    # mean bi-directional radial deviation D: mean of both directions' mean radii about their common
    # least-squares centre, minus the nominal radius
    d: float
    d_nominal: float  # the same about the nominal centre
