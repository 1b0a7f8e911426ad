"""Commands to a robot: moves, jogs, programs, outputs, keys of the pendant."""

import ctypes
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.analysis.gcode.program import Texts
from motionfmu.base.binding import Struct, library, text
from motionfmu.base.errors import suggestion
from motionfmu.virtual.robot.kinematics import Kinematics, configuration, pose_of
from motionfmu.virtual.robot.refusal import (
    RobotError,
    bounded,
    message,
    numbers,
    refused,
    whole_within,
    within,
)

if TYPE_CHECKING:
    from motionfmu.analysis.collisions import Cell
    from motionfmu.virtual.robot.cell_guard import CellGuard

_JOINTS, _LINE, _CIRCLE = range(3)
_SINGULAR = {"slow": 0, "refuse": 1, "wrist": 2}
_ANY_BRANCH = -1
_JOBS = (".JBI", ".jbi", ".job")  # files of the robot language


def _guard(settings: dict[str, Any], cell: "Cell | None") -> "CellGuard | None":
    """Look at moves if there is a cell; else nothing of it is imported, which takes 0.15 s."""
    if cell is None:
        return None
    from motionfmu.virtual.robot.cell_guard import CellGuard

    whole = configuration(settings)
    return CellGuard({name: whole[name] for name in whole}, cell)


class Commands:
    """Moves, jogs, programs, outputs and keys of a VirtualRobot."""

    def __init__(self, state: Struct, settings: dict[str, Any], cell: "Cell | None" = None) -> None:
        self._state, self._panel = state, Struct("robot_panel", state.pointer)
        self._program: Struct | None = None
        self._texts: tuple[Texts, list[bytes]] | None = None  # C reads them
        self.kinematics = Kinematics(**settings)
        self._guard = _guard(settings, cell)

    def move_joints(self, target: Any, **how: Any) -> int:
        """Move all joints to angles [deg] at a share of their speeds; returns the move's number.

        They start and end together. `share`: 0.5; with the setting `flow`, `zone` [mm]: how far the
        corner with the next move may leave the path; `radius` [mm] instead: as an arc of it does;
        `part`: most of either move that it takes, 0.5.
        """
        return self._move("move_joints", numbers("target", target, 6), **how)

    def move_line(self, target: Any, **how: Any) -> int:
        """Move the tip on a line to X Y Z A B C or a matrix; returns the move's number.

        `feed` [mm/s] and `spin` [deg/s], 0: the highest; `zone` [mm], `radius`, `part` as of
        move_joints; `branch`: the one that the path has to keep; `singular`: slow, refuse or wrist.
        """
        return self._move("move_line", self._pose("target", target), _LINE, **how)

    def move_circle(self, via: Any, target: Any, **how: Any) -> int:
        """Move the tip on a circle through a place [mm] to a pose; the rest as move_line."""
        place = bounded("via", numbers("via", np.asarray(via)[:3] if np.ndim(via) == 1 else via, 3))
        return self._move("move_circle", self._pose("target", target), _CIRCLE, via=place, **how)

    def move_pose(self, target: Any, **how: Any) -> int:
        """Move all joints to a pose, X Y Z A B C or a matrix; the rest as move_joints, `branch`."""
        return self._move("move_pose", self._pose("target", target), **how)

    def _pose(self, name: str, target: Any) -> np.ndarray:
        return pose_of(target) if np.shape(target) == (4, 4) else numbers(name, target, 6)

    def _move(self, call: str, target: np.ndarray, kind: int = _JOINTS, **how: Any) -> int:
        move, why, words = Struct("robot_move"), Struct("robot_refusal"), message()
        if target.shape != (6,):
            raise RobotError(f"{call}: one target of 6 numbers is wanted, got shape {target.shape}")
        bounded("target", target)
        given: dict[str, Any] = {
            "feed": 0.0,
            "spin": 0.0,
            "share": 0.5,
            "zone": 0.0,
            "radius": 0.0,
            "part": 0.5,
            "branch": _ANY_BRANCH,
        }
        given |= {"singular": "slow", "via": np.zeros(3)}
        if unknown := set(how) - set(given):
            name = unknown.pop()
            hint = suggestion(name, given) or f" (there are: {', '.join(given)})"
            raise RobotError(f"{call}: no {name!r}{hint}")
        given |= how
        mode = given["singular"]
        if mode not in _SINGULAR:
            raise RobotError(f"singular = {mode!r}: one of {', '.join(_SINGULAR)} is wanted")
        move["kind"], move["target.by_joints"] = kind, call == "move_joints"
        move["target.branch"] = whole_within("branch", given["branch"], _ANY_BRANCH, 7)
        move["via"], move["singular"] = given["via"], _SINGULAR[mode]
        for name, low, high in (
            ("feed", 0.0, 1e6),
            ("spin", 0.0, 36000.0),
            ("share", 1e-3, 1.0),
            ("zone", 0.0, 1e4),
            ("radius", 0.0, 1e4),
            ("part", 1e-3, 0.5),
        ):
            move[name] = within(name, given[name], low, high)
        six, kept = (ctypes.c_double * 6)(*target), self._state.saved() if self._guard else b""
        code = library().binding_robot_move(
            self._state.pointer, move.pointer, six, why.pointer, words
        )
        if code:
            raise self._busy(call) or refused(call, code, why, words)
        if self._guard and (near := self._guard.nearest(self._state)):
            self._state.restore(kept)
            raise RobotError(f"{call}: {near.words}", "COLLISION", near.distance)
        return int(self._state["move"])

    def _busy(self, call: str) -> RobotError | None:
        """The error if no command can be given now; else None."""
        if self._panel["stopped"]:
            return RobotError(f"{call}: not now: the card has stopped: reset it", "BUSY")
        if library().binding_robot_running(self._state.pointer):
            return RobotError(f"{call}: not now: a program runs", "BUSY")
        return None

    def jog(self, direction: Any, frame: int = 0, *, speed: float = 0.1, way: float = 0.0) -> None:
        """Jog by JOINTS, or along and about the axes of BASE or TOOL, until `release`.

        `direction`: six numbers; `speed`: share of the highest; `way` > 0: only so far, [mm], or
        [deg] where it only turns.
        """
        six = bounded("direction", numbers("direction", direction, 6))
        before = {n: self._panel[n] for n in ("jog", "frame", "jog_speed", "jog_way")}
        asked = {
            "jog": six,
            "frame": whole_within("frame", frame, 0, 2),
            "jog_speed": within("speed", speed, 1e-3, 1.0),
            "jog_way": within("way", way, 0.0, 1e6),
        }
        for name, value in asked.items():
            self._panel[name] = value
        why, words = Struct("robot_refusal"), message()
        code = library().binding_robot_jog(self._state.pointer, why.pointer, words)
        if code:
            for name, value in before.items():
                self._panel[name] = value
            raise self._busy("jog") or refused("jog", code, why, words)

    def release(self) -> None:
        """Let the jog ramp to rest."""
        self._panel["jog"] = 0.0

    def set_tool(self, tool: Any) -> None:
        """Tool X Y Z A B C in the flange's frame for moves by calls; at rest only."""
        six = (ctypes.c_double * 6)(*bounded("tool", numbers("tool", tool, 6), 1e4))
        if library().binding_robot_tool(self._state.pointer, six):
            raise RobotError("set_tool: not now: the arm moves", "BUSY")
        library().binding_robot_arm(self._state.pointer, self.kinematics._arm.pointer)

    def start(
        self,
        program: str | Path,
        points: str = "",
        *,
        language: str = "inform",
        job: str = "",
        folder: Path | None = None,
    ) -> None:
        """Start a program from its text: the robot language with the text of its points, or G-code.

        `language`: inform or gcode; a part program is planned move by move before anything moves.
        `job`: the one to start with. `folder`: where the files are that a program calls; a program
        that is a Path is read from there, and its folder is the default.
        """
        if language not in ("inform", "gcode"):
            raise RobotError(f"language = {language!r}: inform or gcode is wanted")
        if error := self._busy("start"):
            raise error
        if not self._rests():
            raise RobotError("start: not now: the arm moves", "BUSY")
        read, words = Struct("robot_program"), message()
        texts = Texts(program, folder, _JOBS if language == "inform" else (".ngc",))
        both = [texts.of[""], text(points)]
        places = (ctypes.c_char_p * 2)(*both)
        lengths = (ctypes.c_int64 * 2)(*map(len, both))
        gcode = ctypes.c_bool(language == "gcode")
        c = library()
        refused = c.binding_robot_read(
            read.pointer, self._state.pointer, places, lengths, gcode, texts.file, words
        )
        texts.tell()
        if refused:
            raise RobotError(words.value.decode(), "PROGRAM")
        trial = Struct("robot_controller")
        name = text(job)
        refused = c.binding_robot_start(
            self._state.pointer, read.pointer, name, trial.pointer, words
        )
        texts.tell()
        if refused:
            first, *more = words.value.decode(errors="replace").split("\n")
            raise RobotError(first, "PROGRAM", more=more)
        self._program, self._texts = read, (texts, both)

    def _rests(self) -> bool:
        reading = Struct("robot_reading")
        library().robot_station_read(self._state.pointer, reading.pointer)
        return bool(reading["rests"])

    def go_on(self) -> None:
        """Go on behind a pause of the program, or with the next move of single steps."""
        self._panel["press_start"] = True

    def abort(self) -> None:
        """Ramp to rest on the path, drop the program and all moves."""
        self._panel["press_abort"] = True

    def reset(self) -> None:
        """End a stop of the card whose cause is gone."""
        self._panel["press_reset"] = True

    def hold(self, on: bool = True) -> None:
        """Pause on the path, or go on."""
        self._panel["hold"] = bool(on)

    def single(self, on: bool = True) -> None:
        """Let each move of a program wait for `go_on`."""
        self._panel["single"] = bool(on)

    def override(self, share: float) -> None:
        """Speed override, 0 .. 1 (above 1 the arm keeps 1)."""
        self._panel["override"] = within("override", share, 0.0, 2.0)

    def teach(self) -> None:
        """Store where the arm is as a point, at the next interrupt."""
        self._panel["press_teach"] = True

    def replay(self) -> None:
        """Move through the taught points by the joints, at the latest jog's speed."""
        self._panel["press_replay"] = True

    def taught(self) -> str:
        """Lines of a points file for the taught points."""
        lines, count, words = [], self._state["taught"], message()
        for n in range(count):
            library().binding_robot_taught(self._state.pointer, ctypes.c_int32(n), words)
            lines.append(words.value.decode() + "\n")
        return "".join(lines)

    def set_output(self, number: int, on: bool) -> None:
        """Digital output 1 .. 32 once all moves given so far have reached their points."""
        bit = 1 << (self._number("output", number, 32) - 1)
        self._output(bit, bit if on else 0, 0, 0.0)

    def set_analog_output(self, number: int, volts: float) -> None:
        """Analog output 1 .. 8 [V], likewise."""
        self._output(0, 0, self._number("output", number, 8) - 1, self._volts(volts))

    def _output(self, mask: int, value: int, index: int, volts: float) -> None:
        bits = (ctypes.c_uint32(mask), ctypes.c_uint32(value))
        c, volt = library(), ctypes.c_double(volts)
        if c.binding_robot_output(self._state.pointer, *bits, ctypes.c_int32(index), volt):
            raise self._busy("output") or RobotError(
                "output: not now: 32 outputs wait for their moves", "BUSY", 33.0, 32.0
            )

    def _number(self, name: str, number: int, most: int) -> int:
        return whole_within(name, number, 1, most)

    def _volts(self, volts: float) -> float:
        return within("volts", volts, -10.0, 10.0)
