"""Which parameters of a plant are two masses and their spring: the two_masses.toml of its FMU."""

import functools
import tomllib

from pydantic import BaseModel, ConfigDict, ValidationError

from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.linear_form import evaluate
from motionfmu.analysis.measured_response.two_masses import MassFit, MassModel
from motionfmu.base.errors import InputError
from motionfmu.scenarios import fmus

FILE = "two_masses.toml"
# Deviations above 0 that what is left for the load of one mass is told from.
VAGUE_LOAD = 3.0


class MotorSide(BaseModel):
    """Names of the plant's variables that are the mass on the drive's side."""

    model_config = ConfigDict(extra="forbid", strict=True)
    inertia: str
    viscous: str
    position: str
    speed: str


class LoadSide(BaseModel):
    """Those on the side of the load."""

    model_config = ConfigDict(extra="forbid", strict=True)
    inertia: str
    viscous: str
    position: str


class SpringNames(BaseModel):
    """Those of what joins the two."""

    model_config = ConfigDict(extra="forbid", strict=True)
    stiffness: str
    damping: str


class MassNames(BaseModel):
    """The tables of a two_masses.toml."""

    model_config = ConfigDict(extra="forbid", strict=True)
    drive: str  # input that moves the motor
    ratio: str  # formula of parameters: motion of the load per motion of the motor
    motor: MotorSide
    load: LoadSide
    spring: SpringNames


@functools.cache
def names_in(fmu: str) -> MassNames | None:
    """The tables that an FMU carries; None if it has none."""
    text = fmus.extra(fmu, FILE)
    if text is None:
        return None
    try:
        return MassNames.model_validate(tomllib.loads(text))
    except (tomllib.TOMLDecodeError, ValidationError) as error:
        raise InputError(f"{fmu}: {FILE}: {str(error).splitlines()[0]}") from None


class PlantMasses:
    """The plant of an axis whose FMU says what its two masses are; an InputError if none does."""

    def __init__(self, axis: AxisModel) -> None:
        components = axis.scenario.document.body.component
        found = {c: names for c in axis.blocks if (names := names_in(components[c])) is not None}
        if len(found) != 1:
            told = ", ".join(found) or "none"
            raise InputError(
                f"{axis.scenario.document.file}: one plant with a {FILE} is wanted, there are:"
                f" {told}"
            )
        self.axis = axis
        [(self.component, self.names)] = found.items()
        values = axis.values(self.component)
        self.ratio = float(evaluate(self.names.ratio, values))  # type: ignore[arg-type]

    def signal(self, name: str) -> str:
        """A variable of the plant with its component."""
        return f"{self.component}.{name}"

    def of(self, axis: AxisModel) -> MassModel:
        """The masses that a model of the axis has, on the side of the motor."""
        n, per = self.names, self.ratio * self.ratio

        def value(name: str) -> float:
            return float(axis.value(self.signal(name)))

        return MassModel(
            value(n.motor.inertia),
            value(n.load.inertia) * per,
            value(n.spring.stiffness) * per,
            value(n.spring.damping) * per,
            value(n.motor.viscous),
            value(n.load.viscous) * per,
        )

    def settings(self, fit: MassFit) -> dict[str, tuple[float, float]]:
        """Values and deviations of the plant's parameters that a fit tells, by name.

        Of one mass the sum is told: the motor keeps what a data sheet says, the load has the rest.
        """
        n, per, m = self.names, self.ratio * self.ratio, fit.model
        if not fit.two:
            rest = m.motor - float(self.axis.value(self.signal(n.motor.inertia)))
            deviation = fit.deviations["motor"]
            told = fit.told("motor") and rest > VAGUE_LOAD * deviation
            return {n.load.inertia: (rest / per, deviation / per)} if told else {}
        rows = {
            "motor": (n.motor.inertia, m.motor, 1.0),
            "load": (n.load.inertia, m.load, per),
            "stiffness": (n.spring.stiffness, m.stiffness, per),
            "damping": (n.spring.damping, m.damping, per),
            "load_viscous": (n.load.viscous, m.load_viscous, per),
        }
        return {
            name: (float(value / factor), float(fit.deviations[key] / factor))
            for key, (name, value, factor) in rows.items()
            if fit.told(key)
        }

    def element(self, name: str) -> str:
        """A variable of the plant, or the axis' element of it, as [set] has it."""
        port = self.axis.scenario.resolver.ports[self.component][name]
        whole = self.signal(name)
        return f"{whole}[{self.axis.axis}]" if port.shape else whole
