"""Measure how long LinuxCNC takes for each shape, and keep it in linuxcnc_times.toml.

    apt-get install linuxcnc-uspace
    .venv/bin/python scenarios/short_lines/in_linuxcnc.py      # five minutes

LinuxCNC runs without a machine: each axis is where it is commanded. A HAL integrator counts the
servo periods of 1 ms in which a line or arc is fed, so rapids and waiting cost nothing, and a busy
computer changes nothing.
"""

import os
import subprocess
import sys
import tempfile
from datetime import UTC, datetime
from pathlib import Path

import shapes
from study import ACC, RUNS, TOLERANCE

HERE = Path(__file__).parent
TIMES = HERE / "linuxcnc_times.toml"
NOBODY = "65534"  # whom LinuxCNC's real-time part becomes where root starts it
INI = """[EMC]
VERSION = 1.1
MACHINE = shapes
[DISPLAY]
DISPLAY = {driver}
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = shapes.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 4.0
SERVO_PERIOD = 1000000
[HAL]
HALFILE = shapes.hal
[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
DEFAULT_LINEAR_VELOCITY = 100
MAX_LINEAR_VELOCITY = 1000
NO_FORCE_HOMING = 1
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.100
TOOL_TABLE = shapes.tbl
[KINS]
KINEMATICS = trivkins coordinates=XYZ
JOINTS = 3
"""
AXIS = """[AXIS_{name}]
MIN_LIMIT = -10000
MAX_LIMIT = 10000
MAX_VELOCITY = 1000
MAX_ACCELERATION = {acc}
[JOINT_{joint}]
TYPE = LINEAR
HOME = 0
HOME_SEQUENCE = 0
MIN_LIMIT = -10000
MAX_LIMIT = 10000
MAX_VELOCITY = 1000
MAX_ACCELERATION = {acc}
FERROR = 1000
MIN_FERROR = 1000
"""
# Kinds 2 and 3 of motion-type are lines and arcs.
HAL = """loadrt trivkins coordinates=XYZ
loadrt motmod servo_period_nsec=1000000 num_joints=3
loadrt conv_s32_u32
loadrt bitslice personality=2
loadrt mux4
loadrt integ
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf conv-s32-u32.0 servo-thread
addf bitslice.0 servo-thread
addf mux4.0 servo-thread
addf integ.0 servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net z joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net type motion.motion-type => conv-s32-u32.0.in
net kind conv-s32-u32.0.out => bitslice.0.in
net low bitslice.0.out-00 => mux4.0.sel0
net high bitslice.0.out-01 => mux4.0.sel1
setp mux4.0.in2 1
setp mux4.0.in3 1
net feeds mux4.0.out => integ.0.in
net enable iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
"""


def write(folder: Path) -> None:
    """Programs and a configuration for them."""
    for name, feed in RUNS:
        head = f"G21 G17 G90 G64 P{TOLERANCE:g} F{feed * 60:g}"
        # Those that begin with a line begin at the origin, as in study.py.
        text = "\n".join([head, "G0 X0 Y0 Z0", *shapes.SHAPES[name](), "M2", ""])
        (folder / f"{name} {feed:g}.ngc").write_text(text)
    axes = "".join(AXIS.format(name=n, joint=k, acc=ACC) for k, n in enumerate("XYZ"))
    ini = INI.format(driver=HERE / "linuxcnc_driver.py") + axes
    (folder / "shapes.ini").write_text(ini)
    (folder / "shapes.hal").write_text(HAL)
    (folder / "shapes.tbl").touch()


def version() -> str:
    """Of the package that is installed."""
    asked = ["dpkg-query", "-W", "-f", "${Version}", "linuxcnc-uspace"]
    return subprocess.check_output(asked, text=True)


def main() -> None:
    """Run all shapes and write their times."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write(folder)
        given = os.environ | {"MOTIONFMU_PROGRAMS": name, "HOME": name}
        if not os.geteuid():
            folder.chmod(0o777)
            given |= {"RTAPI_UID": NOBODY, "RTAPI_FIFO_PATH": f"{name}/rtapi"}
        done = subprocess.run(
            ["linuxcnc", "shapes.ini"], cwd=folder, env=given, check=False, capture_output=True
        )
        times = folder / "times.txt"
        rows = times.read_text().splitlines() if times.exists() else []
        if len(rows) < len(RUNS):
            told = folder / "linuxcnc_debug.txt"
            sys.exit(told.read_text() if told.exists() else done.stderr.decode())
    today = datetime.now(UTC).date().isoformat()
    text = (
        f'# Seconds of feed moves, by in_linuxcnc.py.\nversion = "{version()}"\nday = {today}\n\n'
    )
    found = {tuple(row.split()[:2]): float(row.split()[2]) for row in rows}
    for shape, feed in RUNS:
        seconds = found[shape, f"{feed:g}"]
        text += f'[[shape]]\nname = "{shape}"\nfeed = {feed:g}  # [mm/s]\ntime = {seconds}\n\n'
    TIMES.write_text(text.rstrip() + "\n")


if __name__ == "__main__":
    main()
