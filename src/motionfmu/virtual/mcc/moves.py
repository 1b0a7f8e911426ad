"""Motion calls: each puts a command into the ring and returns its index."""

from collections.abc import Sequence

from motionfmu.virtual.mcc.calls import Calls, Numbers, doubles, real, whole

# Directions of a circle.
CW, CCW = 0, 1


class Moves(Calls):
    """Lines, arcs, circles, rapids, dwell.

    Each call returns the command's index, from 1 on, and raises MccError if it is refused. Targets
    are absolute or incremental as set_abs and set_inc say: X Y Z U V W, those of an arc or a circle
    two axes in the order of its plane, and U V W, all in mm. A direction is CW (0) or CCW (1).
    """

    def _arc(self, plane: str, via: Numbers, end: Numbers) -> int:
        return self._do(f"MCC_arc_{plane}", *doubles(via, 2), *doubles(end, 2))

    def _arc_uvw(self, plane: str, points: Sequence[Numbers], uvw: Numbers) -> int:
        both = (*doubles(points[0], 2), *doubles(points[1], 2))
        return self._do(f"MCC_arc_{plane}uvw", doubles(both, 4), doubles(uvw, 3))

    def _circle(self, plane: str, centre: Numbers, direction: int) -> int:
        return self._do(f"MCC_circle_{plane}", *doubles(centre, 2), whole(direction))

    def _circle_uvw(self, plane: str, at: tuple[Numbers, int], uvw: Numbers) -> int:
        centre, direction = doubles(at[0], 2), whole(at[1])
        return self._do(f"MCC_circle_{plane}uvw", centre, direction, doubles(uvw, 3))

    def line(self, target: Numbers) -> int:
        """Straight line of all six axes [mm]."""
        return self._do("MCC_line", doubles(target))

    def line_x(self, x: float) -> int:
        """Straight line of X [mm]."""
        return self._do("MCC_line_x", real(x))

    def line_y(self, y: float) -> int:
        """Straight line of Y [mm]."""
        return self._do("MCC_line_y", real(y))

    def line_z(self, z: float) -> int:
        """Straight line of Z [mm]."""
        return self._do("MCC_line_z", real(z))

    def arc_xy(self, via: Numbers, end: Numbers) -> int:
        """Arc in the plane X Y through a point to its end [mm]."""
        return self._arc("xy", via, end)

    def arc_yz(self, via: Numbers, end: Numbers) -> int:
        """Arc in the plane Y Z through a point to its end [mm]."""
        return self._arc("yz", via, end)

    def arc_zx(self, via: Numbers, end: Numbers) -> int:
        """Arc in the plane Z X through a point to its end [mm]."""
        return self._arc("zx", via, end)

    def arc_xyuvw(self, via: Numbers, end: Numbers, uvw: Numbers) -> int:
        """Arc in the plane X Y while U V W follow [mm]."""
        return self._arc_uvw("xy", (via, end), uvw)

    def arc_yzuvw(self, via: Numbers, end: Numbers, uvw: Numbers) -> int:
        """Arc in the plane Y Z while U V W follow [mm]."""
        return self._arc_uvw("yz", (via, end), uvw)

    def arc_zxuvw(self, via: Numbers, end: Numbers, uvw: Numbers) -> int:
        """Arc in the plane Z X while U V W follow [mm]."""
        return self._arc_uvw("zx", (via, end), uvw)

    def circle_xy(self, centre: Numbers, direction: int) -> int:
        """Full circle in the plane X Y [mm]."""
        return self._circle("xy", centre, direction)

    def circle_yz(self, centre: Numbers, direction: int) -> int:
        """Full circle in the plane Y Z [mm]."""
        return self._circle("yz", centre, direction)

    def circle_zx(self, centre: Numbers, direction: int) -> int:
        """Full circle in the plane Z X [mm]."""
        return self._circle("zx", centre, direction)

    def circle_xyuvw(self, centre: Numbers, direction: int, uvw: Numbers) -> int:
        """Full circle in the plane X Y while U V W follow [mm]."""
        return self._circle_uvw("xy", (centre, direction), uvw)

    def circle_yzuvw(self, centre: Numbers, direction: int, uvw: Numbers) -> int:
        """Full circle in the plane Y Z while U V W follow [mm]."""
        return self._circle_uvw("yz", (centre, direction), uvw)

    def circle_zxuvw(self, centre: Numbers, direction: int, uvw: Numbers) -> int:
        """Full circle in the plane Z X while U V W follow [mm]."""
        return self._circle_uvw("zx", (centre, direction), uvw)

    def ptp(self, target: Numbers) -> int:
        """Rapid of all six axes, which arrive together [mm]."""
        return self._do("MCC_ptp", doubles(target))

    def ptp_x(self, x: float) -> int:
        """Rapid of X [mm]."""
        return self._do("MCC_ptp_x", real(x))

    def ptp_y(self, y: float) -> int:
        """Rapid of Y [mm]."""
        return self._do("MCC_ptp_y", real(y))

    def ptp_z(self, z: float) -> int:
        """Rapid of Z [mm]."""
        return self._do("MCC_ptp_z", real(z))

    def ptp_uvw(self, u: float, v: float, w: float) -> int:
        """Rapid of U V W, which arrive together [mm]."""
        return self._do("MCC_ptp_uvw", real(u), real(v), real(w))

    def motion_delay(self, ms: float) -> int:
        """Dwell [ms]."""
        return self._do("MCC_motion_delay", real(ms))
