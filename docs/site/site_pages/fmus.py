"""Pages of the FMUs: what each README says, then its variables as its description has them."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from site_pages.markdown import code, plain, table

if TYPE_CHECKING:
    from motionfmu.scenarios.port import Port

HEADINGS = {"parameter": "Parameters", "input": "Inputs", "output": "Outputs", "local": "Locals"}
KINDS = {"Float64": "real", "Int32": "integer", "Boolean": "Boolean", "String": "text"}


def names() -> list[str]:
    """The FMUs that are built."""
    from motionfmu.scenarios import fmus

    return fmus.fmu_names()


def variables(ports: Sequence["Port"]) -> str:
    """Tables of variables by what they are."""
    text = ""
    for causality, heading in HEADINGS.items():
        rows = [_row(p) for p in ports if p.causality == causality]
        if rows:
            head = ("name", "type", "unit", "start", "range", "meaning")
            text += f"## {heading}\n\n{table(head, rows)}\n"
    return text


def _row(port: "Port") -> tuple[str, ...]:
    from motionfmu.base.units import spelled

    kind = KINDS.get(port.type, port.type) + "".join(f"[{n}]" for n in port.shape)
    told = port.doc + ("; it may change in a run" if port.tunable else "")
    return (
        code(port.name),
        plain(kind),
        plain(spelled(port.unit)),
        _start(port),
        _range(port),
        plain(told),
    )


def _start(port: "Port") -> str:
    """Start values: one if all are equal, else the first six."""
    if port.start is None:
        return ""
    if port.type == "String":
        return code(port.start)
    values = port.start.split()
    if len(set(values)) == 1:
        return code(values[0])
    return code(" ".join(values[:6]) + (" ..." if len(values) > 6 else ""))


def _range(port: "Port") -> str:
    low, high = (f"{x:.10g}" if math.isfinite(x) else "" for x in (port.low, port.high))
    return plain(f"{low} .. {high}") if low or high else ""


def index(about: Mapping[str, str]) -> str:
    """A table of all FMUs with their icons."""
    rows = [
        (f"![{name}](icons/{name}.svg)", f"[{name}](fmus/{name}/README.md)", plain(told))
        for name, told in about.items()
    ]
    return "# FMUs\n\n" + table(("icon", "FMU", "is"), rows)
