"""An arm of a scenario as identification sees it: geometry, gears, and values believed before."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, ValidationError

from motionfmu.base.errors import InputError
from motionfmu.run import Scenario
from motionfmu.scenarios import fmus
from motionfmu.scenarios.values import settings, start_values

Array = NDArray[np.float64]
FILE = "identify.toml"


class _NamedParts(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class _ArmSignals(_NamedParts):
    """Inputs and outputs, all joints of each."""

    torque: str  # of the motors
    motor: str  # angles of the motors
    speed: str  # of the motors
    link: str  # angles of the links
    phase: str  # of the motors' encoders
    lines: str  # parameter: lines of these encoders


class _ArmLinks(_NamedParts):
    """Parameters of the links."""

    mass: str  # of each link
    center: str  # of mass, in the link's frame
    inertia: str  # moments xx, yy, zz of each link about its centre of mass
    product: str  # xy, yz, zx, taken as known
    viscous: str  # friction of the joint behind its gear


class _ArmLoad(_NamedParts):
    """Parameters of the load on the last link, which a record does not move."""

    mass: str  # of the load
    center: str  # of mass, in the last link's frame
    inertia: str  # moments of the load about its centre of mass


class _ArmMotors(_NamedParts):
    """Parameters of the motors."""

    inertia: str  # of each motor
    coulomb: str  # friction at speed
    static: str  # friction at rest
    stribeck: str  # speed at which friction falls from the one to the other
    viscous: str  # friction by speed


class _ArmGears(_NamedParts):
    """Parameters of the gears."""

    stiffness: list[str]  # slopes of the torque over the wind-up, one more than knees
    knees: list[str]  # torques at which the slope changes
    damping: str  # of the gear
    lost: str  # lost motion
    zero: str  # error of the joint's zero
    amplitudes: list[str]  # of the transmission error, once and twice per turn of the motor
    phases: list[str]  # likewise


class ArmTable(_NamedParts):
    """The table [arm] of an identify.toml: names of the class for what an arm has."""

    axes: list[str]  # of the joints: x, y or z, in frames parallel to the base at inner angle 0
    origins: list[list[str]]  # x, y, z of each joint in the link before; "" for none
    moved: str  # what is added to the origins
    sign: str  # inner angle = sign * joint angle - offset
    offset: str  # likewise
    ratio: str  # of the gears
    gravity: str  # acceleration
    start: str  # joint angles at the start
    signals: _ArmSignals
    links: _ArmLinks
    load: _ArmLoad
    motors: _ArmMotors
    gears: _ArmGears


@dataclass(frozen=True)
class ArmPlant:
    """An arm: joints in a chain, each with a motor behind a gear.

    Angles without a word are inner ones, sign * joint angle - offset; frames of the links are
    parallel to the base where these are 0.
    """

    scenario: Scenario
    component: str
    table: ArmTable
    values: Mapping[str, Array]  # of the FMU's parameters, by name, in their shapes
    given: Mapping[str, Any]  # what the caller set

    @property
    def count(self) -> int:
        """Number of joints."""
        return len(self.table.axes)

    @property
    def fmu(self) -> str:
        """The FMU of the arm."""
        return self.scenario.document.body.component[self.component]

    def of(self, name: str) -> Array:
        """Value of a parameter by its name."""
        return self.values[name]

    @property
    def axes(self) -> Array:
        """Axes of the joints, (joints, 3)."""
        return np.array([np.eye(3)["xyz".index(a)] for a in self.table.axes])

    @property
    def origins(self) -> Array:
        """Joints in the links before [m], (joints, 3)."""
        rows = [[float(self.of(n)) if n else 0.0 for n in row] for row in self.table.origins]
        return np.array(rows) + self.of(self.table.moved)

    @property
    def sign(self) -> Array:
        """1 or -1 of each joint."""
        return self.of(self.table.sign)

    @property
    def offset(self) -> Array:
        """Inner angle = sign * joint angle - offset [rad]."""
        return np.radians(self.of(self.table.offset))

    @property
    def ratio(self) -> Array:
        """Turns of the motor per turn of the joint."""
        return self.of(self.table.ratio)

    @property
    def gravity(self) -> float:
        """Acceleration of free fall [m/s2]."""
        return float(self.of(self.table.gravity))

    def signal(self, variable: str) -> str:
        """The full name of a variable."""
        return f"{self.component}.{variable}"


def table_of(fmu: str) -> ArmTable | None:
    """The table [arm] that an FMU carries; None if it is no arm."""
    text = fmus.extra(fmu, FILE)
    if text is None:
        return None
    try:
        given = tomllib.loads(text).get("arm")
        return None if given is None else ArmTable.model_validate(given)
    except (tomllib.TOMLDecodeError, ValidationError) as error:
        raise InputError(f"{fmu}: {FILE}: {str(error).splitlines()[0]}") from None


def component_of(scenario: Scenario) -> str | None:
    """The component of a scenario whose FMU says that it is an arm."""
    for name, fmu in scenario.document.body.component.items():
        if fmus.is_ours(fmu) and table_of(fmu) is not None:
            return name
    return None


def arm_plant(scenario: Scenario, given: Mapping[str, Any]) -> ArmPlant:
    """The arm of a scenario, with values of the caller."""
    name = component_of(scenario)
    if name is None:
        known = ", ".join(scenario.document.body.component.values())
        raise InputError(f"{scenario.name}: none of its FMUs ({known}) says that it is an arm")
    table = table_of(scenario.document.body.component[name])
    assert table is not None
    found = {s.end.name: s.values for s in settings(scenario.resolver, given)}
    values = {}
    for port in scenario.resolver.ports[name].values():
        if port.causality == "parameter" and port.type in ("Float64", "Int32"):
            own = found.get(f"{name}.{port.name}") or start_values(port)
            values[port.name] = np.array(own, dtype=np.float64).reshape(port.shape)
    return ArmPlant(scenario, name, table, values, dict(given))
