"""The XML of a system structure."""

from collections.abc import Iterable, Sequence
from xml.etree import ElementTree as ET

from motionfmu.base import units
from motionfmu.fmu.describe import TOOL
from motionfmu.ssp.structure import (
    COMMON,
    DESCRIPTION,
    OSP,
    STEP,
    VALUES,
    Component,
    Connection,
    Connector,
    Structure,
    Value,
)

# Some readers look for these prefixes and not for the namespaces.
_PREFIXES = {"ssc": COMMON, "ssd": DESCRIPTION, "ssv": VALUES, "osp": OSP}


def _root(tag: str, uses: Sequence[str], **attributes: str) -> ET.Element:
    spaces = {f"xmlns:{prefix}": _PREFIXES[prefix] for prefix in uses}
    return ET.Element(tag, spaces | attributes)


def _text(root: ET.Element) -> bytes:
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def _units(root: ET.Element, tag: str, names: Iterable[str | None]) -> None:
    used = sorted({name for name in names if name})
    if used:
        parent = ET.SubElement(root, tag)
        for name in used:
            unit = ET.SubElement(parent, "ssc:Unit", name=name)
            ET.SubElement(unit, "ssc:BaseUnit", units.parse(name).attributes())


def _connector(parent: ET.Element, c: Connector) -> None:
    element = ET.SubElement(parent, "ssd:Connector", name=c.name, kind=c.kind)
    ET.SubElement(element, f"ssc:{c.type}", {"unit": c.unit} if c.unit else {})
    for size in c.shape:
        ET.SubElement(element, "ssc:Dimension", size=str(size))


def _component(parent: ET.Element, c: Component, values: str | None) -> None:
    element = ET.SubElement(parent, "ssd:Component", name=c.name, source=c.source)
    element.set("type", "application/x-fmu-sharedlibrary")
    if c.connectors:
        connectors = ET.SubElement(element, "ssd:Connectors")
        for connector in c.connectors:
            _connector(connectors, connector)
    if values is not None:
        bindings = ET.SubElement(element, "ssd:ParameterBindings")
        ET.SubElement(bindings, "ssd:ParameterBinding", source=values)


def _connection(parent: ET.Element, c: Connection) -> None:
    element = ET.SubElement(parent, "ssd:Connection")
    element.set("startElement", c.source[0])
    element.set("startConnector", c.source[1])
    element.set("endElement", c.target[0])
    element.set("endConnector", c.target[1])
    for key, index in (("startIndices", c.source_index), ("endIndices", c.target_index)):
        if index:
            element.set(key, " ".join(map(str, index)))
    if (c.factor, c.offset) != (1.0, 0.0):
        # Both attributes are written, for a reader is known that takes a missing factor for 0.
        transformation = ET.SubElement(element, "ssc:LinearTransformation")
        transformation.set("factor", repr(c.factor))
        transformation.set("offset", repr(c.offset))


def _experiment(root: ET.Element, s: Structure) -> None:
    if s.stop is None and s.step is None:
        return
    experiment = ET.SubElement(root, "ssd:DefaultExperiment", startTime="0.0")
    if s.stop is not None:
        experiment.set("stopTime", repr(s.stop))
    if s.step is not None:
        annotations = ET.SubElement(experiment, "ssd:Annotations")
        annotation = ET.SubElement(annotations, "ssc:Annotation", type=STEP)
        algorithm = ET.SubElement(annotation, "osp:Algorithm")
        ET.SubElement(algorithm, "osp:FixedStepAlgorithm", baseStepSize=repr(s.step))


def description(s: Structure, files: dict[str, str]) -> bytes:
    """Make the text of SystemStructure.ssd.

    Parameters
    ----------
    s : Structure
        Names of units are those of `motionfmu.base.units`.
    files : dict
        Path of the parameter set of a component in the archive, by the component's name.
    """
    root = _root("ssd:SystemStructureDescription", ["ssd", "ssc", "ssv", "osp"])
    root.set("version", s.version)
    root.set("name", s.name)
    root.set("description", s.about)
    root.set("generationTool", TOOL)
    system = ET.SubElement(root, "ssd:System", name=s.name, description=s.about)
    elements = ET.SubElement(system, "ssd:Elements")
    for component in s.components:
        _component(elements, component, files.get(component.name))
    if s.connections:
        parent = ET.SubElement(system, "ssd:Connections")
        for connection in s.connections:
            _connection(parent, connection)
    _units(root, "ssd:Units", (k.unit for c in s.components for k in c.connectors))
    _experiment(root, s)
    return _text(root)


def parameter_values(name: str, values: Sequence[Value], version: str) -> bytes:
    """Make the text of a parameter set (.ssv).

    Parameters
    ----------
    name : str
        Of the set, by which tools ask for it.
    values : sequence of Value
        Its parameters.
    version : str
        ``1.0`` or ``2.0``; in 1.0 each value has one element.
    """
    root = _root("ssv:ParameterSet", ["ssv", "ssc"], version=version, name=name)
    parent = ET.SubElement(root, "ssv:Parameters")
    for value in values:
        element = ET.SubElement(parent, "ssv:Parameter", name=value.name)
        one = ET.SubElement(element, f"ssv:{value.type}")
        if value.type == "String" and len(value.text) > 1:
            for text in value.text:
                ET.SubElement(one, "ssv:Value", value=text)
        else:
            one.set("value", " ".join(value.text))
        if value.unit:
            one.set("unit", value.unit)
    _units(root, "ssv:Units", (v.unit for v in values))
    return _text(root)
