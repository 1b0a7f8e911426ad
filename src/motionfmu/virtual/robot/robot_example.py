"""A program on the virtual robot: moves by calls, one of them refused, then a job.

examples/virtual_robot/virtual_robot.c does the same.
"""

import sys
from pathlib import Path

from motionfmu.virtual.robot import RobotError, VirtualRobot


def run(robot: VirtualRobot) -> None:
    """Run and print ten times a second until all rests."""
    rests = False
    while not rests:
        r = robot.run(0.1)
        x, y, z = r.pose[:3]
        print(
            f"{r.time:6.1f} s  X {x:9.3f}  Y {y:9.3f}  Z {z:9.3f} mm"
            f"  {r.path_feed:6.2f} mm/s  OT {r.outputs}"
        )
        rests = r.rests
    x, y, z = r.pulses[:3]
    print(f"pulses {x} {y} {z}, underruns {r.underruns}, error {r.error}")


def main() -> None:
    """Moves by calls, then a job with its points if named."""
    robot = VirtualRobot(ik_time=30e-6)

    robot.move_pose([1000, 0, 700, 180, 0, 180], share=0.5, zone=2)
    robot.move_circle([1100, 100, 700], [1000, 200, 700, 180, 0, 180], feed=200, zone=2)
    run(robot)
    try:
        robot.move_line([2000, 0, 700, 180, 0, 180], feed=200)
    except RobotError as error:
        print(str(error).removeprefix("move_line: "))

    if len(sys.argv) > 2:
        job, points = (Path(name).read_text() for name in sys.argv[1:3])
        robot.start(job, points)
        run(robot)


if __name__ == "__main__":
    main()
