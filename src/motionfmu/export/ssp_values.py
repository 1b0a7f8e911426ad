"""Settings of a scenario as the parameter values of an SSP."""

from collections.abc import Iterator

from motionfmu import ssp
from motionfmu.fmu.describe import element_names
from motionfmu.fmu.start_values import texts
from motionfmu.scenarios.system import Setting

_TYPES = {"Float64": "Real", "Int32": "Integer", "Boolean": "Boolean", "String": "String"}


def kind(name: str, fmi: int) -> str:
    """The name that a type of FMI 3 has in an SSP whose FMUs have this version of FMI."""
    return _TYPES[name] if fmi == 2 else name


def values(setting: Setting, fmi: int) -> Iterator[ssp.Value]:
    """A setting as parameters: one in FMI 3, one for each element in FMI 2."""
    port, listed = setting.end.port, texts(setting.values)
    if fmi == 3:
        yield ssp.Value(port.name, kind(port.type, fmi), listed, port.unit)
        return
    for name, text in zip(element_names(port.name, port.shape), listed, strict=True):
        yield ssp.Value(name, kind(port.type, fmi), (text,), port.unit)
