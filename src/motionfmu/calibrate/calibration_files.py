"""What was found as files that runs take: found.toml, the tables, compensated.toml."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from motionfmu.calibrate.arm_calibration import ArmCalibration
from motionfmu.calibrate.machine_calibration import MachineCalibration

FOUND, COMPENSATED, COMPENSATION = "found.toml", "compensated.toml", "compensation.csv"


def _rows(values: Mapping[str, Any]) -> list[str]:
    """Values as TOML."""
    return [f"{json.dumps(name)} = {_shown(value)}" for name, value in values.items()]


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(repr, value)) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)


def machine_files(found: MachineCalibration, folder: Path) -> dict[str, str]:
    """Text of each file by its name; `folder` is where they will stand."""
    lines = [f"# Geometry of {found.machine}."]
    for p in found.parameters:
        shown = f"{p.found.text()} {p.found.unit}" if p.found.told else f"left: {p.found.why}"
        lines.append(f"# {p.part}, {p.name}: {shown}, from {p.record}")
    plant = [*lines, *_rows(found.settings)]
    files = {FOUND: "\n".join(plant) + "\n"}
    if found.compensation:
        files[COMPENSATION] = found.compensation
        table = {found.compensated: str(folder.resolve() / COMPENSATION)}
        files[COMPENSATED] = "\n".join([*plant, *_rows(table)]) + "\n"
    return files


def arm_files(found: ArmCalibration) -> dict[str, str]:
    """Text of each file by its name."""
    lines = [f"# Geometry of {found.machine}, from {found.record.name}."]
    for name, e in found.parameters.items():
        shown = f"{e.text()} {e.unit}" if e.told else f"left: {e.why}"
        lines.append(f"# {name}: {shown}")
    told = "# The same arm, and what its controller can know of it told to both."
    return {
        FOUND: "\n".join([*lines, *_rows(found.settings)]) + "\n",
        COMPENSATED: "\n".join([told, *_rows(found.compensated)]) + "\n",
    }
