"""A machine's folder made for an arm, with a job that shows that it runs."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.arm_machines.arm_values import ArmValues, TakenValue, arm_values
from motionfmu.arm_machines.machine_arm import BY_AXES, BY_LENGTHS, LEVEL, arm_machine
from motionfmu.arms.arm_axes import ArmGeometry, AxesGeometry, driven_geometry
from motionfmu.arms.arm_description import ArmDescription, ArmJoint
from motionfmu.arms.arm_geometry import ROUNDING, NoOpwGeometry
from motionfmu.base.errors import InputError
from motionfmu.base.new_folder import new_folder
from motionfmu.run import machine
from motionfmu.scenarios import package_files
from motionfmu.scenarios.toml_text import pair_lines, table_lines, value_text
from motionfmu.virtual.robot import Kinematics

LIKE = "robot6"  # the machine whose controller, card and drives an arm gets
_OF_A_RUN = ("machine", "stop", "set")
LINE = 0.15  # length of the example's line per reach of the arm
COUNTS = ("one", "two", "three", "four", "five", "six")
STEPS = 20  # at which the line is tried
FURTHEST = 30.0  # [deg] that a joint turns between two of them


@dataclass(frozen=True)
class MadeMachine:
    """The folder of a new machine, and what was taken for granted."""

    folder: Path
    geometry: ArmGeometry
    values: ArmValues
    notes: tuple[str, ...]
    example: Path | None  # a job of a joint move and a line


def make_machine(arm: ArmDescription, folder: Path, source: str) -> MadeMachine:
    """Make a machine of an arm.

    Parameters
    ----------
    arm : ArmDescription
    folder : Path
        It must not be there.
    source : str
        Name of the file the arm comes from.

    Returns
    -------
    MadeMachine

    Raises
    ------
    InputError
        The controller cannot drive such an arm, or the folder cannot be written.
    """
    try:
        geometry = driven_geometry(arm)
    except NoOpwGeometry as error:
        told = (
            "it cannot be driven yet: the controller moves six joints that turn, SCARAs, "
            "palletizers, gantries"
        )
        raise InputError(f"{source}: {arm.name} is {error}; {told}") from None
    like = arm_machine(machine(LIKE))
    values = arm_values(arm, geometry, like)
    notes = (*arm.notes, *_notes(geometry))
    tables = {k: v for k, v in like.tables.items() if k not in _OF_A_RUN}
    if isinstance(geometry, AxesGeometry):
        plants = {BY_LENGTHS: LEVEL if geometry.levels else BY_AXES}
        tables["component"] = {n: plants.get(f, f) for n, f in tables["component"].items()}
        slides = geometry.sliding
        tables["axis"] = [
            {**row, "kind": "linear" if k in slides else row["kind"]}
            for k, row in enumerate(tables["axis"][: len(arm.driven)])
        ]
    kept = {k: v for k, v in like.tables["set"].items() if k not in _given(values)}
    kept = {k: v for k, v in kept.items() if k not in ("soft.tool", "arm.paper_height")}
    about = (
        f"{arm.name}, an arm of {joint_count(arm)}, from {source}: its drives, card, controller."
    )
    with new_folder(folder) as part:
        lines = [f"# {about}", *_machine_lines(tables, kept, values, source)]
        (part / package_files.MACHINE).write_text("\n".join(lines) + "\n", encoding="utf-8")
        example = _example(values)
        if example:
            (part / "example.job").write_text(example[0], encoding="utf-8")
            (part / "example.points").write_text(example[1], encoding="utf-8")
        text = "\n".join(_readme(folder.name, arm, values, source, notes))
        (part / "README.md").write_text(text + "\n", encoding="utf-8")
    job = folder / "example.job" if example else None
    return MadeMachine(folder, geometry, values, notes, job)


def _given(values: ArmValues) -> set[str]:
    return {name for group in values.groups.values() for name in group}


def _notes(geometry: ArmGeometry) -> Iterator[str]:
    if isinstance(geometry, AxesGeometry):
        yield f"driven by its axes, as {geometry.why}"
    if geometry.deviation > ROUNDING:
        off = f"{1e3 * geometry.deviation:.3g} mm"
        yield f"its lengths are off by {off} at the tip, for the angles of the file are rounded"
    if np.abs(geometry.base - np.eye(4)).max() > ROUNDING:
        place = ", ".join(f"{1e3 * x:.6g}" for x in geometry.base[:3, 3])
        turned = np.abs(geometry.base[:3, :3] - np.eye(3)).max() > ROUNDING
        told = "; axis 1 does not stand upright there, gravity acts along it" if turned else ""
        yield f"positions count from axis 1, which is at {place} mm in the base of the file{told}"


def _machine_lines(
    tables: Mapping[str, Any], kept: Mapping[str, Any], values: ArmValues, source: str
) -> Iterator[str]:
    for key, value in tables.items():
        if not isinstance(value, dict) and not (isinstance(value, list) and _rows(value)):
            yield from pair_lines(key, value)
    for name, table in tables.items():
        if isinstance(table, dict) or _rows(table):
            yield from table_lines(name, table)
        if name == "connect":
            yield from _set_lines(kept, values, source)


def _rows(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def _set_lines(kept: Mapping[str, Any], values: ArmValues, source: str) -> Iterator[str]:
    yield from ("", f"# From {source}, but for what README.md lists as taken for granted.", "[set]")
    for group, rows in values.groups.items():
        yield f"# {group}"
        width = max(len(value_text(n)) for n in rows)
        for name, value in rows.items():
            yield f"{value_text(name).ljust(width)} = {value_text(value)}"
    yield f"# as of {LIKE}"
    for name, value in kept.items():
        yield f"{value_text(name)} = {value_text(value)}"


def _readme(
    name: str, arm: ArmDescription, values: ArmValues, source: str, notes: tuple[str, ...]
) -> Iterator[str]:
    yield from (
        f"# {name}",
        "",
        f"{arm.name}, made from {source} by `motionfmu import {source}`.",
        "",
    )
    joints = values.arm.driven
    yield "| joint | " + " | ".join(j.name for j in joints) + " |"
    yield "|" + "---|" * (len(joints) + 1)
    some = any(j.slides for j in joints)  # has units of its own
    rows = {
        f"range [°{', mm' * some}]": [f"{lo:.4g} .. {hi:.4g}" for lo, hi in _ranges(values)],
        f"speed [°/s{', mm/s' * some}]": _cells([_told(j, j.speed) for j in joints]),
        f"acceleration [°/s²{', mm/s²' * some}]": _cells(
            [_told(j, float(j.acceleration or 0.0)) for j in joints]
        ),
        f"gear ratio{', rad/m' * some}": _cells([float(j.ratio or 0.0) for j in joints]),
        "mass [kg]": _cells([j.link.mass for j in joints]),
    }
    for what, cells in rows.items():
        yield f"| {what} | {' | '.join(cells)} |"
    yield from ("", f"Not in {source}, and taken; what is known better goes into machine.toml:", "")
    yield from (f"- {line}" for line in taken_lines(values.taken))
    if notes:
        yield from ("", *(f"- {line}" for line in notes))


def taken_lines(taken: list[TakenValue]) -> list[str]:
    """Say what was taken for granted.

    Parameters
    ----------
    taken : list of TakenValue

    Returns
    -------
    list of str
        A line for each.
    """
    return [f"{t.what}: {f'{t.value} ' if t.value else ''}{t.why} ({t.names})" for t in taken]


def _ranges(values: ArmValues) -> list[tuple[float, float]]:
    return [(_told(j, j.low), _told(j, j.high)) for j in values.arm.driven]


def _told(joint: ArmJoint, value: float) -> float:
    return 1e3 * value if joint.slides else math.degrees(value)


def joint_count(arm: ArmDescription) -> str:
    """Number of an arm's joints, as words.

    Parameters
    ----------
    arm : ArmDescription

    Returns
    -------
    str
    """
    return f"{COUNTS[len(arm.driven) - 1]} joints"


def _cells(values: list[float]) -> list[str]:
    return [f"{v:.4g}" for v in values]


def _example(values: ArmValues) -> tuple[str, str] | None:
    """A job of a joint move and a line from the start pose, and its points; None if none fits."""
    arm = Kinematics(**values.controller)
    start = np.array(values.start)
    here = arm.forward(start)
    size = 1e3 * LINE * values.reach
    for way in (*_ways(size), *_ways(size / 3.0)):
        line: list[np.ndarray] = []
        joints = start
        for share in np.linspace(0.0, 1.0, STEPS + 1):
            frame = here.copy()
            frame[:3, 3] += share * way
            joints, branch = arm.nearest(frame, joints)
            if branch < 0 or np.abs(joints - (line[-1] if line else start)).max() > FURTHEST:
                break
            line.append(joints)
        else:
            return _job(), _points(start, line[-1])
    return None


def _ways(size: float) -> Iterator[np.ndarray]:
    for way in ((0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (-1, 0, 0), (1, 0, 0)):
        yield size * np.array(way, dtype=float)


def _job() -> str:
    rows = (
        "//EXAMPLE",
        "' A joint move, a line back and forth, and home again",
        "MOVJ P000 VJ=50.00",
        "MOVJ P001 VJ=50.00",
        "MOVL P000 V=100.0 PL=0",
        "MOVL P001 V=100.0 PL=0",
        "MOVJ P000 VJ=50.00",
        "END",
    )
    return "\n".join(rows) + "\n"


def _points(start: np.ndarray, end: np.ndarray) -> str:
    rows = ["' Where the arm starts, and the other end of the line"]
    for number, joints in enumerate((start, end)):
        angles = " ".join(f"J{k}={x:.6f}" for k, x in enumerate(joints, 1))
        rows.append(f"P{number:03d} {angles}")
    return "\n".join(rows) + "\n"
