"""What of a machine is geometry: the calibration.toml that its FMUs carry, and the values there."""

import functools
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.analysis.explain.parameter_expression import evaluate
from motionfmu.base.errors import InputError, suggestion
from motionfmu.run.run_plan import Options, RunPlan
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import System
from motionfmu.scenarios.values import start_values

Array = NDArray[np.float64]
FILE = "calibration.toml"
PLANES = ("XY", "ZX", "YZ")


class AxisErrors(BaseModel):
    """Parameters of an axis by the part of its positioning error."""

    model_config = ConfigDict(extra="forbid", strict=True)
    backlash: str | None = None
    slope: str | None = None
    amplitude: str | None = None
    period: str | None = None
    phase: str | None = None

    @property
    def wave(self) -> tuple[str, str, str] | None:
        """Amplitude, period and phase of a wave; None if the plant has no such wave."""
        names = self.amplitude, self.period, self.phase
        return None if None in names else names  # type: ignore[return-value]


class Compensation(BaseModel):
    """Where a controller takes its tables from."""

    model_config = ConfigDict(extra="forbid", strict=True)
    file: str  # parameter: path of the tables
    pulse: str  # [mm] by axis, an expression of its parameters


class ArmPose(BaseModel):
    """Where the tool of an arm rests, and what moves it there."""

    model_config = ConfigDict(extra="forbid", strict=True)
    joints: str
    position: str
    attitude: str
    errors: list[str]
    known: dict[str, str] = Field(default_factory=dict)  # error that adds to it; -: takes from it


class Geometry(BaseModel):
    """The tables of a calibration.toml."""

    model_config = ConfigDict(extra="forbid", strict=True)
    axis: AxisErrors | None = None
    squareness: dict[str, str] = Field(default_factory=dict)
    compensation: Compensation | None = None
    pose: ArmPose | None = None


@functools.cache
def carried(fmu: str) -> Geometry:
    """The tables that an FMU carries; empty if it has none."""
    text = fmus.extra(fmu, FILE) if fmus.is_ours(fmu) else None
    if text is None:
        return Geometry()
    try:
        found = Geometry.model_validate(tomllib.loads(text))
    except (tomllib.TOMLDecodeError, ValidationError) as error:
        raise InputError(f"{fmu}: {FILE}: {str(error).splitlines()[0]}") from None
    if unknown := [n for n in _named(found) if n not in fmus.ports(fmu)]:
        raise InputError(f"{fmu}: {FILE}: {unknown[0]!r} is no variable of it")
    if wrong := [p for p in found.squareness if p not in PLANES]:
        raise InputError(f"{fmu}: {FILE}: [squareness] {wrong[0]}: {', '.join(PLANES)} are known")
    return found


def _named(found: Geometry) -> list[str]:
    """All variables that the tables name."""
    names: list[str] = list(found.squareness.values())
    for table in (found.axis, found.pose):
        for value in table.model_dump().values() if table else ():
            if isinstance(value, dict):
                names += [*value, *(e.lstrip("-").partition("[")[0] for e in value.values())]
            else:
                names += value if isinstance(value, list) else [value] if value else []
    return names + ([found.compensation.file] if found.compensation else [])


def axis_rows(plan: RunPlan) -> dict[str, int]:
    """Row of each axis by its name; X, Y, Z, U, V, W where the machine names none."""
    rows = {a.name: a.row or k for k, a in enumerate(plan.document.axes, 1)}
    return rows or {n: k for k, n in enumerate("XYZUVW", 1)}


def row_of_axis(rows: Mapping[str, int], name: str, record: str) -> int:
    """Row of an axis; an InputError that begins with the record if there is none."""
    if name not in rows:
        raise InputError(
            f"{record}: {name!r} is neither an axis of the machine ({', '.join(rows)}) nor a plane"
            f" ({', '.join(PLANES)}){suggestion(name, rows)}"
        )
    return rows[name]


@dataclass(frozen=True)
class MachineGeometry:
    """The components of a scenario whose geometry can be found, and their values."""

    plan: RunPlan
    system: System

    @classmethod
    def of(cls, plan: RunPlan, given: dict[str, Any]) -> "MachineGeometry":
        """Of a scenario or a machine with values stronger than its own."""
        return cls(plan, plan.resolved(Options(set=given)))

    @property
    def name(self) -> str:
        """File that is named in messages."""
        return str(self.plan.document.file)

    def find(self, table: str) -> tuple[str, Any] | None:
        """The component that carries a table, and the table; None if none does."""
        found = [
            (name, getattr(carried(fmu), table))
            for name, fmu in self.system.components.items()
            if getattr(carried(fmu), table)
        ]
        if len(found) > 1:
            several = ", ".join(name for name, _ in found)
            raise InputError(f"{self.name}: {several}: one component with [{table}] wanted")
        return found[0] if found else None

    def values(self, component: str, variable: str) -> tuple[Any, ...]:
        """Values of a parameter, one for each element."""
        for setting in reversed(self.system.settings):
            if (setting.end.component, setting.end.port.name) == (component, variable):
                return tuple(setting.values)
        return start_values(fmus.ports(self.system.components[component])[variable])

    def value(self, component: str, variable: str, axis: int) -> float:
        """Value of a parameter for an axis, from 1."""
        values = self.values(component, variable)
        return float(values[axis - 1 if len(values) > 1 else 0])

    def pulse(self, component: str, table: Compensation) -> Array:
        """Length of a pulse of each axis [mm]."""
        fmu = self.system.components[component]
        numbers: dict[str, Any] = {}
        for name, port in fmus.ports(fmu).items():
            if port.causality == "parameter" and port.type != "String":
                numbers[name] = np.array(self.values(component, name), float)
        try:
            return np.atleast_1d(np.asarray(evaluate(table.pulse, numbers), float))
        except ValueError as error:
            raise InputError(f"{fmu}: {FILE}: pulse = {error}") from None
