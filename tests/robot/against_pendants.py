"""Jobs of pendants and of RoboDK's post-processor, which are not ours, by hand.

    PYTHONPATH=tests/helpers python tests/robot/against_pendants.py FOLDER [MOTOMAN.PY]

FOLDER has .JBI files. There are some on GitHub in ros-industrial/motoman,
Yaskawa-Global/motoros2, rpiRobotics/dx200_motion_progam_exec, tshikina/YaskawaInformSupport and
matthijsk/motoman-inform-vim-syntax. Each is read or refused; most are of other arms, so they are
not run. MOTOMAN.PY is the post-processor (ros-industrial-attic/robodk_postprocessors, Apache 2.0)
with the robodk.py that it imports beside it: it writes twenty programs of moves at random, which
the robot runs to their ends.
"""

import contextlib
import random
import sys
import tempfile
from pathlib import Path

import numpy as np
from fmi_tools import Instance
from py_opw_kinematics import KinematicModel, Robot
from scipy.spatial.transform import RigidTransform, Rotation

import motionfmu

PROGRAMS = 20
PULSES = [r * 2500 / 360 for r in (100, 120, 120, 100, 100, 80)]  # a degree
TOOLS = "".join(f"TOOL {n} X=0 Y=0 Z=150 A=0 B=0 C=0\n" for n in range(1, 64))
USERS = "".join(f"USER {n} X=0 Y=0 Z=0 A=0 B=0 C=0\n" for n in range(1, 64))
HOME = [0.0, 20.0, 10.0, 0.0, 60.0, 0.0]


def read(folder: Path, points: Path) -> None:
    """Tell of every file whether it is read, or why not."""
    files = sorted(p for p in folder.iterdir() if p.suffix.lower() == ".jbi")
    taken = 0
    for file in files:
        fmu = Instance("soft_controller", 3)
        fmu.set("program", str(file))
        fmu.set("points", str(points))
        fmu.enter()
        good = fmu.call("ExitInitializationMode") == 0
        taken += good
        said = "" if good else fmu.messages[-1][2].replace(str(folder) + "/", "")
        print(f"{file.name}: {said or 'read'}")
        fmu.free()
    print(f"{len(files)} files, {taken} read")


def arm() -> Robot:
    """The robot's own kinematics, by another library."""
    lengths = (0.15, -0.115, 0.0, 0.445, 0.7, 0.795, 0.085)
    offsets = (0.0, 0.0, -np.pi / 2, 0.0, 0.0, 0.0)
    model = KinematicModel(*lengths, offsets=offsets, flip_axes=(False,) * 6)
    return Robot(model, degrees=False)


class Moves:
    """Programs of moves at random over the table, written by a post-processor."""

    def __init__(self, post: object, seed: int) -> None:
        self.rng = random.Random(seed)
        self.post = post
        self.module = sys.modules["Motoman"]
        self.joints = list(HOME)
        self.robot = arm()
        self.tip = np.eye(4)
        self.tip[2, 3] = 150.0

    def at(self, x: float, y: float, z: float) -> tuple[object, list[float]]:
        """The pose with the tool down at a place [mm], and its joints."""
        pose = np.array([[-1, 0, 0, x], [0, 1, 0, y], [0, 0, -1, z], [0, 0, 0, 1.0]])
        flange = pose @ np.linalg.inv(self.tip)
        place = RigidTransform.from_components(
            flange[:3, 3] / 1000.0, Rotation.from_matrix(flange[:3, :3])
        )
        near = self.robot.inverse(place, current_joints=tuple(np.radians(self.joints)))[0]
        self.joints = [float(q) for q in np.degrees(near)]
        return self.module.Mat(pose.tolist()), self.joints

    def place(self) -> tuple[float, float, float]:
        r = self.rng
        return r.uniform(700, 1100), r.uniform(-400, 400), r.uniform(250, 500)

    def write(self, folder: Path, name: str) -> np.ndarray:
        """Write a program; where it ends [mm]."""
        post, rng = self.post, self.rng
        post.ProgStart(name)
        post.setTool(self.module.Mat(self.tip.tolist()), 9, "pen")
        post.setSpeed(rng.choice([20.0, 30.0]))
        post.MoveJ(None, list(HOME))
        end = self.place()
        post.MoveJ(*self.at(*end))
        for _ in range(rng.randint(3, 8)):
            kind = rng.choice(["line", "line", "joints", "arc", "output", "pause", "zone", "say"])
            if kind == "line":
                end = tuple(np.array(end) + [rng.uniform(-40, 40) for _ in range(3)])
                post.MoveL(*self.at(*end))
            elif kind == "joints":
                end = self.place()
                post.MoveJ(*self.at(*end))
            elif kind == "arc":
                post.MoveL(*self.at(*end))
                x, y, z = end
                via, end = (x + 20, y + 20, z), (x + 40, y, z)
                post.MoveC(*self.at(*via), *self.at(*end))
                post.MoveL(*self.at(*end))  # five MOVC in a row are no two arcs
            elif kind == "output":
                post.setDO(rng.randint(1, 32), rng.randint(0, 1))
            elif kind == "pause":
                post.Pause(rng.choice([50, 100]))
            elif kind == "zone":
                post.setZoneData(rng.choice([-1, 0, 2, 5]))
            else:
                post.RunMessage("Nothing to be said, but for this", rng.random() < 0.5)
        post.waitDI(1, 0, 100)
        post.ProgFinish(name)
        post.ProgSave(str(folder), name)
        return np.array(end)


def run(file: Path, points: Path) -> motionfmu.Result:
    """The robot runs a program."""
    values = {"soft.program": str(file), "soft.points": str(points), "*.start_joint": HOME}
    values |= {"soft.tool": [0.0] * 6}
    text = {"machine": "robot6", "stop": "soft.done", "limit": 40.0, "set": values}
    return motionfmu.scenario(text).run()


def post_programs(motoman: Path, points: Path) -> None:
    """Write and run the programs of the post-processor."""
    sys.path.insert(0, str(motoman.parent))
    module = __import__(motoman.stem)
    worst = 0.0
    with tempfile.TemporaryDirectory() as folder:
        for n in range(PROGRAMS):
            with contextlib.redirect_stdout(None):
                post = module.RobotPost("Motoman", "arm", 6, pulses_x_deg=PULSES)
                # Lists of the class, for RoboDK has a process for each program.
                post.PROG_LIST, post.PROG_NAMES, post.PROG_FILES = [], [], []
                post.PROG_TARGETS = []
                end = Moves(post, n).write(Path(folder), f"P{n}")
            file = Path(folder) / f"P{n}.JBI"
            result = run(file, points)
            tip = result["soft.tool_position"][-1] * 1000.0
            off = float(np.linalg.norm(tip - end))
            worst = max(worst, off)
            moves = file.read_text().count("MOV")
            good = result.done_at is not None and result["soft.error"][-1] == 0
            print(f"{file.name}: {moves} moves, {'done' if good else 'not done'}, {off:.3f} mm off")
            for warning in result.warnings:
                if "soft" in warning:
                    print("   ", warning)
    print(f"{PROGRAMS} programs, the worst end is {worst:.3f} mm off: half a pulse")


def main() -> None:
    """Read the files, then run what the post-processor writes."""
    with tempfile.TemporaryDirectory() as folder:
        points = Path(folder) / "tools.points"
        points.write_text(TOOLS + USERS)
        read(Path(sys.argv[1]), points)
        if len(sys.argv) > 2:
            post_programs(Path(sys.argv[2]), points)


main()
