"""Public URDFs by hand: what the import says of each, held against pinocchio and MuJoCo.

    PYTHONPATH=tests/helpers python tests/arms/against_public_urdfs.py FOLDER [--run] [--tip LINK]

For each URDF in FOLDER: tip and torques at 1000 random states against pinocchio, the URDF and the
MJCF written and read back, the kind of arm. With --run also the machine that is made of it: all its
branches by the controller's kinematics, and its example, a joint move and a line. Of seven joints
the third is held, as the import does.
"""

import argparse
import tempfile
from pathlib import Path

import mujoco
import numpy as np
from random_arms import worst_differences

from motionfmu import run
from motionfmu.arm_machines import arm_machine, make_machine
from motionfmu.arms import (
    ArmDescription,
    NoOpwGeometry,
    OpwGeometry,
    driven_geometry,
    held,
    mjcf_text,
    urdf_arm,
    urdf_text,
)
from motionfmu.arms.urdf_reader import urdf_text_arm
from motionfmu.base.errors import InputError
from motionfmu.virtual.robot import Kinematics

STATES = 1000


def checked(file: Path, tip: str | None, rng: np.random.Generator) -> ArmDescription:
    """The arm of a file, after all comparisons; prints their largest differences."""
    arm = urdf_arm(file, tip)
    text = file.read_text(encoding="utf-8")
    place, torque = worst_differences(text, arm, STATES, rng)
    again = urdf_text_arm(urdf_text(arm), "again.urdf", arm.tip)
    q = rng.uniform(-3.0, 3.0, (STATES, len(arm.driven)))
    back = float(np.abs(arm.forward(q) - again.forward(q)).max())
    own, theirs = worst_differences(urdf_text(arm), again, STATES, rng)
    mujoco.MjModel.from_xml_string(mjcf_text(arm))
    assert max(place, torque, back, own, theirs) < 1e-10, file
    print(
        f"  {len(arm.driven)} joints to {arm.tip}, {arm.mass:.4g} kg; pinocchio: tip {place:.0e}, "
    )
    print(f"  torque {torque:.0e}; written and read back {max(back, own, theirs):.0e}")
    return arm


def driven(arm: ArmDescription, file: Path, rng: np.random.Generator) -> None:
    """Make the arm a machine, solve all branches, run its example; prints the figures."""
    with tempfile.TemporaryDirectory() as place:
        made = make_machine(arm, Path(place) / "machine", file.name)
        machine = run.machine(made.folder)
        own = arm_machine(machine)
        solver = Kinematics(**made.values.controller)
        count = len(arm.driven)
        q = np.zeros((STATES, 6))
        q[:, :count] = np.degrees(rng.uniform(-3.0, 3.0, (STATES, count)))
        near = q + rng.uniform(-0.3, 0.3, q.shape)  # looked for from there without a closed form
        branches = solver.inverse(solver.forward(q), near)
        there = ~np.isnan(branches).any(axis=-1)
        wanted = np.broadcast_to(solver.forward(q)[:, None], (*there.shape, 4, 4))
        off = solver.forward(branches[there]) - wanted[there]
        apart = float(np.abs(off[..., :3, 3]).max()) / 1e3
        nearest = np.abs((branches - q[:, None] + 180.0) % 360.0 - 180.0).max(axis=-1)
        reached = there.any(axis=1).mean()  # iteration leaves out what it cannot prove
        found = (nearest < 1e-4).any(axis=1).mean()  # the rest has other joints for its place
        print(f"  {reached:.1%} of places reached, {found:.1%} by the joints given")
        assert apart < 1e-9 and min(reached, found) > 0.98, file
        assert made.example is not None, file
        result = machine.run(made.example)
        joints = result["soft.joint_command"][:, :count]
        base = np.linalg.inv(made.geometry.base)
        tip = (base @ arm.forward(joints))[:, :3, 3]
        gap = float(np.abs(tip - result["soft.tool_position"]).max())
        limits = own.arm.driven
        rate = np.abs(result["soft.joint_rate"])[:, :count] / [j.speed for j in limits]
        within = (joints >= [j.low - 1e-9 for j in limits]).all()
        within &= (joints <= [j.high + 1e-9 for j in limits]).all()
        assert result.ok and within and rate.max() < 1.0 + 1e-6 and gap < 1e-6, file
        print(f"  branches {apart:.0e} m; ran {result.time[-1]:.2f} s, command {gap:.0e} m from it")


def main() -> None:
    """Go through a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--run", action="store_true")
    parser.add_argument("--tip", help="of all of them, where several chains end")
    options = parser.parse_args()
    rng = np.random.default_rng(1)
    for file in sorted(options.folder.glob("*.urdf")):
        print(file.name)
        try:
            arm = held(checked(file, options.tip, rng))
            found = driven_geometry(arm)
        except (InputError, NoOpwGeometry) as error:
            print(f"  {error}")
            continue
        if isinstance(found, OpwGeometry):
            lengths = ", ".join(f"{1e3 * x:.4g}" for x in found.lengths)
            print(f"  spherical wrist: {lengths} mm")
        else:
            print(f"  by its axes: {found.why}")
        if options.run:
            try:
                driven(arm, file, rng)
            except InputError as error:
                print(f"  {error}")


if __name__ == "__main__":
    main()
