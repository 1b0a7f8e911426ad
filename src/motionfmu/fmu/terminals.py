"""Terminals: which variables of an FMU are connected together, and their XML for FMI 3.0."""

import fnmatch
from collections.abc import Container, Sequence
from typing import Any
from xml.etree import ElementTree as ET

from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.base.toml_lines import shown
from motionfmu.fmu.describe import DOMAIN, Terminal, Variable

XML = "terminalsAndIcons/terminalsAndIcons.xml"
ICON = "terminalsAndIcons/icon"
_KEYS = {"kind", "doc", "members", "every"}
_SIZE = 100.0  # size of the icon in units of the diagram, which are tenths of a mm


def read(table: Any, variables: Sequence[Variable]) -> list[Terminal]:
    """Terminals of the tables ``[terminal.NAME]`` of an fmu.toml.

    `members` maps a member's name to a variable's, or to several: ``"*" = "host_*"`` makes
    ``host_dda_run`` the member ``dda_run``. Only inputs and outputs can be members. An InputError
    has a line for each fault.
    """
    faults = Faults()
    if not isinstance(table, dict):
        raise InputError(f"terminal {shown(table)} is no table")
    found = []
    for name, row in table.items():
        with faults.each():
            found.append(_terminal(name, row, variables))
    faults.tell()
    return found


def _terminal(name: str, row: Any, variables: Sequence[Variable]) -> Terminal:
    where = f"terminal {name}"
    if not isinstance(row, dict) or not all(isinstance(row.get(k), str) for k in ("kind", "doc")):
        raise InputError(f"{where}: a table with kind, doc and members wanted")
    for key in sorted(set(row) - _KEYS):
        raise InputError(f"{where}: unknown key {key!r}{suggestion(key, _KEYS)}")
    if not isinstance(row.get("members"), dict) or not row["members"]:
        raise InputError(f"{where}: members {shown(row.get('members'))}: variables by names wanted")
    wires = [v.name for v in variables if v.causality in ("input", "output")]
    members: dict[str, str] = {}
    for member, given in row["members"].items():
        for pattern in given if isinstance(given, list) else [given]:
            members |= _members(where, member, pattern, wires)
    every = row.get("every", True)
    return Terminal(name, row["kind"], row["doc"], tuple(members.items()), every is not False)


def _members(where: str, member: str, pattern: Any, wires: Sequence[str]) -> dict[str, str]:
    if not isinstance(pattern, str) or member.count("*") != pattern.count("*"):
        raise InputError(f"{where}: {member} = {shown(pattern)}: one * on both sides, or none")
    matched = [n for n in wires if fnmatch.fnmatchcase(n, pattern)]
    if not matched:
        told = f"{where}: {member} = {shown(pattern)}: no such input or output"
        raise InputError(told + suggestion(pattern, wires))
    head, _, tail = pattern.partition("*")
    stars = [n[len(head) : len(n) - len(tail)] for n in matched]
    return {member.replace("*", star): n for star, n in zip(stars, matched, strict=True)}


def _add(parent: ET.Element, terminal: Terminal) -> None:
    rule = "plug" if terminal.every else "bus"
    element = ET.SubElement(parent, "Terminal", name=terminal.name, matchingRule=rule)
    element.set("terminalKind", f"{DOMAIN}.{terminal.kind}")
    element.set("description", terminal.doc)
    for member, variable in terminal.members:
        row = {"variableName": variable, "variableKind": "signal", "memberName": member}
        ET.SubElement(element, "TerminalMemberVariable", row)


def described(terminals: Sequence[Terminal]) -> bytes:
    """Text of terminalsAndIcons.xml, with the size of the icon."""
    root = ET.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    drawn = ET.SubElement(root, "GraphicalRepresentation")
    corners = {"x1": "0", "y1": "0", "x2": f"{_SIZE:g}", "y2": f"{_SIZE:g}"}
    ET.SubElement(drawn, "CoordinateSystem", corners, suggestedScalingFactorTo_mm="0.1")
    ET.SubElement(drawn, "Icon", corners)
    if terminals:
        parent = ET.SubElement(root, "Terminals")
        for terminal in terminals:
            _add(parent, terminal)
    ET.indent(root)
    return ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"


def of(xml: bytes) -> list[Terminal]:
    """The terminals in the text of a terminalsAndIcons.xml, kinds without `DOMAIN`."""
    found = []
    for row in ET.fromstring(xml).iterfind("Terminals/Terminal"):
        members = [
            (m.get("memberName", ""), m.attrib["variableName"])
            for m in row.iterfind("TerminalMemberVariable")
        ]
        kind = row.get("terminalKind", "").removeprefix(f"{DOMAIN}.")
        about = (row.attrib["name"], kind, row.get("description", ""), tuple(members))
        found.append(Terminal(*about, every=row.get("matchingRule") == "plug"))
    return found


def within(component: str, terminals: Sequence[Terminal], there: Container[str]) -> list[Terminal]:
    """Terminals of a component as a system's, with those members that the system shows."""
    kept = []
    for t in terminals:
        pairs = [(m, f"{component}.{v}") for m, v in t.members if f"{component}.{v}" in there]
        if pairs:
            whole = t.every and len(pairs) == len(t.members)
            kept.append(Terminal(f"{component}.{t.name}", t.kind, t.doc, tuple(pairs), whole))
    return kept
