"""What a system structure description says, whatever its version."""

from collections.abc import Sequence
from dataclasses import dataclass

SSD = "SystemStructure.ssd"
# The namespaces of SSP 2.0 are those of 1.0.
COMMON = "http://ssp-standard.org/SSP1/SystemStructureCommon"
DESCRIPTION = "http://ssp-standard.org/SSP1/SystemStructureDescription"
VALUES = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"
MAPPING = "http://ssp-standard.org/SSP1/SystemStructureParameterMapping"
# SSP has no element for a master's step; the tools of the Open Simulation Platform read it from an
# annotation of this type, and so does this package.
STEP = "com.opensimulationplatform"
OSP = "http://opensimulationplatform.com/SSP/OSPAnnotations"


@dataclass(frozen=True)
class Connector:
    """A variable of a component that a connection may join.

    Attributes
    ----------
    name : str
        That of the variable.
    kind : str
        ``input``, ``output``, ``parameter``, ``calculatedParameter`` or ``inout``.
    type : str
        Of SSP 1.0 ``Real``, ``Integer``, ``Boolean``, ``String``, ``Enumeration`` or ``Binary``; of
        2.0 also FMI 3's; empty where the FMU says it.
    unit : str or None
        Name of a unit of the structure, or none said.
    shape : tuple of int
        Sizes of an array, SSP 2.0 only.
    """

    name: str
    kind: str
    type: str
    unit: str | None = None
    shape: tuple[int, ...] = ()


@dataclass(frozen=True)
class Value:
    """A start value of a variable.

    Attributes
    ----------
    name : str
        Of the variable.
    type : str
        As of a `Connector`.
    text : tuple of str
        One for each element, as XML has it.
    unit : str or None
        In which it is given; None is the variable's own.
    """

    name: str
    type: str
    text: tuple[str, ...]
    unit: str | None = None


@dataclass(frozen=True)
class Component:
    """An FMU of the system.

    Attributes
    ----------
    name : str
        Of the instance, unique in the system.
    source : str
        Path of the FMU in the archive.
    connectors : sequence of Connector
        Those that are shown.
    values : sequence of Value
        Start values; a later one of a variable counts.
    """

    name: str
    source: str
    connectors: Sequence[Connector] = ()
    values: Sequence[Value] = ()


@dataclass(frozen=True)
class Connection:
    """A wire from an output to an input.

    Attributes
    ----------
    source, target : tuple of str
        Names of component and connector.
    source_index, target_index : tuple of int
        Which element, from 1; empty for the whole.
    factor, offset : float
        The target gets factor * value + offset.
    """

    source: tuple[str, str]
    target: tuple[str, str]
    source_index: tuple[int, ...] = ()
    target_index: tuple[int, ...] = ()
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Structure:
    """A system of FMUs without nested systems.

    Attributes
    ----------
    name, about : str
        Its name, and what it is.
    version : str
        ``1.0`` or ``2.0``.
    components : sequence of Component
        The FMUs, in order.
    connections : sequence of Connection
        All wires.
    stop, step : float or None
        Of the default experiment [s]; None if not said.
    """

    name: str
    about: str
    version: str
    components: Sequence[Component]
    connections: Sequence[Connection]
    stop: float | None = None
    step: float | None = None
