"""Start values that an FMU's archive carries, instead of those its library was built with.

They stand in the description, for whoever imports the FMU, and in a file of the resources, which
the library reads (src/fmi/fmi_start.inc). A token of their own holds the two together.
"""

import hashlib
import math
import re
from collections.abc import Iterable, Mapping
from xml.etree import ElementTree as ET

from motionfmu.base.errors import InputError, suggestion
from motionfmu.fmu.describe import I32, STRING_MAX, TOOL

FILE = "start_values.txt"
LINE_MAX = 1 << 15  # [bytes] longest line that the library reads
_TYPES = {"Real": "Float64", "Integer": "Int32"}
_SETTABLE = ("parameter", "input")


def texts(values: Iterable[float | int | bool | str]) -> tuple[str, ...]:
    """Values as texts of XML attributes."""
    return tuple(str(v).lower() if isinstance(v, bool) else str(v) for v in values)


class _StartVariable:
    """A variable, scalar or array, in the XML tree of a description of either version of FMI."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.rows: list[ET.Element] = []  # XML elements with `start`; FMI 2 has one per element
        self.count = 0
        self.type = ""
        self.causality = "local"

    def add(self, about: ET.Element, row: ET.Element) -> None:
        self.rows.append(row)
        sizes = [int(size.attrib["start"]) for size in row.findall("Dimension")]
        self.count += math.prod(sizes)
        self.type = _TYPES.get(row.tag, row.tag)
        self.causality = about.get("causality", "local")

    def change(self, text: str) -> str:
        """Replace the start values in the tree; returns the words of the resource's line."""
        if self.type == "String":
            return self._change_text(text)
        listed = text.split()
        listed = listed * self.count if len(listed) == 1 else listed
        if len(listed) != self.count:
            raise InputError(f"{self.name} has {self.count} elements, not {len(listed)}")
        pairs = [self._number(x) for x in listed]
        if len(self.rows) == 1:
            self.rows[0].set("start", " ".join(shown for shown, _ in pairs))
        else:
            for row, (shown, _) in zip(self.rows, pairs, strict=True):
                row.set("start", shown)
        return " ".join(words for _, words in pairs)

    def _change_text(self, text: str) -> str:
        wrong = re.search(r"[\0\n]", text) or len(text.encode()) >= STRING_MAX
        if wrong or self.count != 1:
            told = f"one line of less than {STRING_MAX} bytes wanted"
            raise InputError(f"{self.name} = {text!r}: {told}")
        inner = self.rows[0].find("Start")
        if inner is None:
            self.rows[0].set("start", text)
        else:
            inner.set("value", text)
        return text

    def _number(self, text: str) -> tuple[str, str]:
        """Texts of a value for the description and for the resource."""
        if self.type == "Boolean":
            if text not in ("true", "false"):
                raise InputError(f"{self.name} = {text}: true or false wanted")
            return text, str(int(text == "true"))
        kind = float if self.type == "Float64" else int
        try:
            value = kind(text)
        except ValueError:
            raise InputError(f"{self.name} = {text}: {self.type} wanted") from None
        low = float(self.rows[0].get("min", -math.inf))
        high = float(self.rows[0].get("max", math.inf))
        if kind is int:
            low, high = max(low, -I32), min(high, I32 - 1)
        if not (math.isfinite(value) and low <= value <= high):
            raise InputError(f"{self.name} = {text}: outside {low:g} .. {high:g}")
        if isinstance(value, int):
            return str(value), str(value)
        share, power = math.frexp(value)
        return repr(value), f"{int(share * 2**53)}p{power - 53}"


def _variables(root: ET.Element) -> dict[str, _StartVariable]:
    found: dict[str, _StartVariable] = {}
    for about in root.iterfind("ModelVariables/*"):
        row = next(iter(about)) if about.tag == "ScalarVariable" else about
        name = about.attrib["name"].partition("[")[0]
        found.setdefault(name, _StartVariable(name)).add(about, row)
    return found


def changed(xml: bytes, before: bytes, starts: Mapping[str, str]) -> tuple[bytes, bytes]:
    """Description and resource with other start values; `before` is the present resource.

    Values are text; for an array one for each element, with spaces between them, or one for all.
    """
    root = ET.fromstring(xml)
    if root.get("generationTool") != TOOL:
        name = root.get("modelName")
        raise InputError(f"{name}: not an FMU of {TOOL}; its start values are in its library")
    variables = _variables(root)
    settable = {n for n, v in variables.items() if v.causality in _SETTABLE}
    rows = dict(row.partition(" ")[::2] for row in before.decode().splitlines()[1:])
    for name, text in starts.items():
        if name not in settable:
            told = "cannot be set" if name in variables else "no such variable"
            raise InputError(f"{name}: {told}{suggestion(name, settable)}")
        rows[name] = variables[name].change(text)
    listed = "".join(f"{name} {words}\n" for name, words in sorted(rows.items()))
    long = [name for name, words in rows.items() if len(f"{name} {words}\n".encode()) >= LINE_MAX]
    if long:
        raise InputError(f"{long[0]}: more than {LINE_MAX} bytes of values")
    key = "guid" if "guid" in root.attrib else "instantiationToken"
    digest = hashlib.sha256(root.attrib[key].encode() + listed.encode()).hexdigest()
    parts = digest[:8], digest[8:12], digest[12:16], digest[16:20], digest[20:32]
    root.set(key, f"{{{'-'.join(parts)}}}")
    text = ET.tostring(root, encoding="UTF-8", xml_declaration=True) + b"\n"
    return text, f"token {root.get(key)}\n{listed}".encode()
