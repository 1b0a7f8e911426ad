"""Start values of components from parameter sets: in the description or in files, mapped or not."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from xml.etree import ElementTree as ET

from motionfmu.ssp.flat_wires import SSC, SSD, Nodes, Path, shown
from motionfmu.ssp.structure import MAPPING, VALUES, Value
from motionfmu.ssp.xml import Archive, number, plain

SSV, SSM = f"{{{VALUES}}}", f"{{{MAPPING}}}"
_SET = "application/x-ssp-parameter-set"


@dataclass(frozen=True)
class ParameterValue:
    """A value of a component's variable, and the set it is from."""

    component: Path
    value: Value
    source: ET.Element  # the parameter set, which has units and enumerations of its own


def given(nodes: Nodes) -> tuple[list[ParameterValue], list[str]]:
    """Values of all components, later ones stronger; and the names that no variable has."""
    found: list[ParameterValue] = []
    lost: list[str] = []
    for path, component in nodes.components.items():
        for source, value in _bound(nodes.archive, path, component):
            found.append(ParameterValue(path, value, source))
    # Values that a system gives are stronger than those of the components in it.
    for path, system in sorted(nodes.systems.items(), key=lambda x: -len(x[0])):
        for source, value in _bound(nodes.archive, path, system):
            targets = list(_targets(nodes, path, value.name))
            found += [
                ParameterValue(owner, replace(value, name=name), source) for owner, name in targets
            ]
            lost += [] if targets else [f"{shown(path)}{'.' if path else ''}{value.name}"]
    return found, lost


def _targets(nodes: Nodes, path: Path, name: str) -> Iterator[tuple[Path, str]]:
    """The components' variables that a name in a system's parameter set means."""
    if (path, name) in nodes.kinds:
        yield from nodes.fed((path, name))
    for owner in nodes.components:
        if owner[: len(path)] == path:
            head = ".".join(owner[len(path) :]) + "."
            if name.startswith(head):
                yield owner, name[len(head) :]
    for inner in nodes.systems:
        if inner != path and inner[: len(path)] == path:
            head = ".".join(inner[len(path) :]) + "."
            if name.startswith(head) and (inner, name[len(head) :]) in nodes.kinds:
                yield from nodes.fed((inner, name[len(head) :]))


def _bound(archive: Archive, path: Path, element: ET.Element) -> Iterator[tuple[ET.Element, Value]]:
    """The values, each with its parameter set, that are bound to an element, by its own names."""
    what = shown(path) or "the system"
    for binding in element.iterfind(f"{SSD}ParameterBindings/{SSD}ParameterBinding"):
        if binding.get("type", _SET) != _SET:
            raise archive.error(f"{what}: {binding.get('type')} is no parameter set")
        if binding.get("sourceBase", "SSD") != "SSD":
            raise archive.error(f"{what}: parameter sets inside an FMU are not taken over")
        source = binding.get("source")
        if source is not None:
            root = archive.root(archive.place(source, what), f"{SSV}ParameterSet")
        else:
            inline = binding.find(f"{SSD}ParameterValues/{SSV}ParameterSet")
            if inline is None:
                raise archive.error(f"{what}: a ParameterBinding without values")
            root = inline
        prefix = binding.get("prefix", "")
        values = [_value(archive, what, p) for p in root.iter(f"{SSV}Parameter")]
        named = [replace(v, name=prefix + v.name) for v in values]
        mapping = binding.find(f"{SSD}ParameterMapping")
        for value in named if mapping is None else _mapped(archive, what, mapping, named):
            yield root, value


def _value(archive: Archive, what: str, parameter: ET.Element) -> Value:
    name = parameter.get("name", "")
    kinds = [c for c in parameter if c.tag.startswith(SSV)]
    if len(kinds) != 1:
        raise archive.error(f"{what}: parameter {name} has no value")
    one, kind = kinds[0], plain(kinds[0])
    listed = tuple(v.get("value", "") for v in one.iterfind(f"{SSV}Value"))
    text = one.get("value", "")
    if not listed:
        listed = (text,) if kind in ("String", "Enumeration") else tuple(text.split())
    return Value(name, kind, listed, one.get("unit"))


def _mapped(
    archive: Archive, what: str, mapping: ET.Element, values: list[Value]
) -> Iterator[Value]:
    """Values renamed by a mapping; values that it does not name are left out."""
    source = mapping.get("source")
    tag = f"{SSM}ParameterMapping"
    root = mapping.find(tag) if source is None else archive.root(archive.place(source, what), tag)
    by_name = {v.name: v for v in values}
    for entry in () if root is None else root.iter(f"{SSM}MappingEntry"):
        value = by_name.get(entry.get("source", ""))
        if value is None:
            continue
        target = entry.get("target", "")
        for child in entry:
            if child.tag == f"{SSC}LinearTransformation":
                factor = number(archive, child, "factor", 1.0)
                offset = number(archive, child, "offset", 0.0)
                value = _scaled(archive, f"{what}: {target}", value, (factor, offset))
            elif plain(child).endswith("Transformation"):
                raise archive.error(f"{what}: {target}: {plain(child)} is not taken over")
        yield replace(value, name=target)


def _scaled(archive: Archive, what: str, value: Value, line: tuple[float, float]) -> Value:
    factor, offset = line
    try:
        texts = tuple(repr(factor * float(x) + offset) for x in value.text)
    except ValueError:
        raise archive.error(f"{what}: {' '.join(value.text)!r}: no number") from None
    # The mapping makes it a number of another unit, so the old unit is dropped.
    return replace(value, text=texts, unit=None)
