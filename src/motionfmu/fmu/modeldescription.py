"""modelDescription.xml for FMI 2.0 and 3.0 from one Description."""

import os
import time
from collections.abc import Sequence
from xml.etree import ElementTree as ET

from motionfmu.base import units
from motionfmu.fmu import licence
from motionfmu.fmu.describe import DOMAIN, TOOL, Description, Variable

_TYPE = {
    2: {"f64": "Real", "i32": "Integer", "bool": "Boolean", "string": "String"},
    3: {"f64": "Float64", "i32": "Int32", "bool": "Boolean", "string": "String"},
}
_CATEGORIES = {
    "logStatusError": "What went wrong, with the value",
    "logStatusWarning": "What runs on, but not as asked",
    "logEvents": "What the model did",
}


def _text(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return value if isinstance(value, str) else repr(value)


def _add(parent: ET.Element, tag: str, **attributes: object) -> ET.Element:
    kept = {k: _text(v) for k, v in attributes.items() if v is not None}
    return ET.SubElement(parent, tag, kept)


def _units(root: ET.Element, d: Description) -> None:
    names = sorted({v.unit for v in d.variables if v.unit})
    if names:
        parent = _add(root, "UnitDefinitions")
        for name in names:
            unit = units.parse(name)
            element = _add(parent, "Unit", name=name)
            ET.SubElement(element, "BaseUnit", unit.attributes())
            if other := units.shown_as(name):
                factor = unit.factor / units.parse(other).factor
                _add(element, "DisplayUnit", name=other, factor=factor)


def _types(root: ET.Element, d: Description, fmi: int) -> None:
    """Types that variables declare: of numbers with a meaning, and of names of files."""
    declared = {v.declared: v for v in d.variables if v.declared}
    if not declared:
        return
    parent = _add(root, "TypeDefinitions")
    for (name, text), v in declared.items():
        limits = {k: x for k, x in _limits(v).items() if k in ("min", "max")}
        if fmi == 2:
            _add(
                _add(parent, "SimpleType", name=name, description=text), _TYPE[2][v.type], **limits
            )
        else:
            _add(parent, f"{_TYPE[3][v.type]}Type", name=name, description=text, **limits)


def _head(root: ET.Element, d: Description, fmi: int, sources: Sequence[str]) -> None:
    state = "state" if fmi == 2 else "State"
    cs = _add(
        root,
        "CoSimulation",
        modelIdentifier=d.name,
        canHandleVariableCommunicationStepSize=True,
        **{f"canGetAndSetFMU{state}": True, f"canSerializeFMU{state}": True},
    )
    if fmi == 2:
        cs.set("canNotUseMemoryManagementFunctions", "true")
        files = _add(cs, "SourceFiles") if sources else cs
        for name in sources:
            _add(files, "File", name=name)
    else:
        cs.set("fixedInternalStepSize", _text(d.step))
    _units(root, d)
    _types(root, d, fmi)
    categories = _add(root, "LogCategories")
    for name, text in _CATEGORIES.items():
        _add(categories, "Category", name=name, description=text)
    _add(
        root,
        "DefaultExperiment",
        startTime=0.0,
        stopTime=float(d.experiment["stop"]),
        stepSize=float(d.experiment["step"]),
    )
    if fmi == 2:
        tool = _add(_add(root, "VendorAnnotations"), "Tool", name=DOMAIN)
        _add(tool, "FixedInternalStepSize", seconds=d.step)


def _about(v: Variable, name: str, reference: int) -> dict[str, object]:
    return {
        "name": name,
        "valueReference": reference,
        "description": v.doc,
        "causality": v.causality,
        "variability": v.variability,
        "initial": v.initial,
    }


def _limits(v: Variable) -> dict[str, object]:
    kind = float if v.type == "f64" else int
    found: dict[str, object] = {"unit": v.unit, "displayUnit": units.shown_as(v.unit)}
    found["declaredType"] = v.declared[0] if v.declared else None
    for key in ("min", "max"):
        limit = getattr(v, key)
        found[key] = None if limit is None else kind(limit)
    found["nominal"] = v.nominal or units.usual(v.unit)
    return found


def _variables2(parent: ET.Element, d: Description) -> list[int]:
    calculated, index = [], 0
    for v, first in zip(d.variables, d.references(), strict=True):
        for i, name in enumerate(v.element_names()):
            index += 1
            scalar = _add(
                parent,
                "ScalarVariable",
                **_about(v, name, first + i),
            )
            start = None if v.start is None else v.start[i]
            _add(scalar, _TYPE[2][v.type], **_limits(v), start=start)
            if v.causality == "output":
                calculated.append(index)
    return calculated


def _variables3(parent: ET.Element, d: Description) -> list[int]:
    _add(
        parent,
        "Float64",
        name="time",
        valueReference=d.reference_count,
        causality="independent",
        variability="continuous",
        description="Simulation time",
        unit=None,
    )
    calculated = []
    for v, ref in zip(d.variables, d.references(), strict=True):
        start = None if v.start is None or v.type == "string" else " ".join(map(_text, v.start))
        element = _add(
            parent,
            _TYPE[3][v.type],
            **_about(v, v.name, ref),
            **_limits(v),
            start=start,
        )
        for size in v.dims:
            _add(element, "Dimension", start=size)
        if v.type == "string":
            for value in v.start or []:
                _add(element, "Start", value=value)
        if v.causality == "output":
            calculated.append(ref)
    return calculated


def model_description(d: Description, fmi: int, sources: Sequence[str] = ()) -> bytes:
    """Make the text of modelDescription.xml, UTF-8; FMI 2's has the list of C files to compile.

    Outputs depend on no input at the same instant: every block samples.
    """
    root = ET.Element("fmiModelDescription", fmiVersion=f"{fmi}.0", modelName=d.name)
    root.set("guid" if fmi == 2 else "instantiationToken", d.token)
    root.set("description", d.description)
    for key, text in licence.attributes().items():
        root.set(key, text)
    root.set("generationTool", TOOL)
    if moment := os.environ.get("SOURCE_DATE_EPOCH"):
        date = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(int(moment)))
        root.set("generationDateAndTime", date)
    root.set("variableNamingConvention", "structured")
    _head(root, d, fmi, sources)
    variables = _add(root, "ModelVariables")
    structure_of = {2: _variables2, 3: _variables3}
    calculated = structure_of[fmi](variables, d)
    structure = _add(root, "ModelStructure")
    if fmi == 2:
        for tag in ("Outputs", "InitialUnknowns"):
            parent = _add(structure, tag) if calculated else structure
            for index in calculated:
                direct = "" if tag == "Outputs" else None
                _add(parent, "Unknown", index=index, dependencies=direct)
    else:
        for ref in calculated:
            _add(structure, "Output", valueReference=ref, dependencies="")
        for ref in calculated:
            _add(structure, "InitialUnknown", valueReference=ref)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
