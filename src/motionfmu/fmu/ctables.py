"""C text generated from a Description: struct vars and the variable table."""

import json
from collections.abc import Iterable

from motionfmu.fmu.describe import COMMON, FILES, STRING_MAX, Description, Variable
from motionfmu.fmu.licence import version

_NOTE = "/* Generated from the FMU's description; do not edit. */\n"
_CTYPE = {"f64": "double", "i32": "int32_t", "bool": "bool", "string": "char"}
_VARY = {
    "fixed": "VARY_FIXED",
    "tunable": "VARY_TUNABLE",
    "discrete": "VARY_DISCRETE",
    "continuous": "VARY_CONTINUOUS",
}


def _literal(value: object) -> str:
    return json.dumps(value) if isinstance(value, str | bool) else repr(value)


def _member(v: Variable) -> str:
    dims = "".join(f"[{d}]" for d in v.dims)
    if v.type == "string":
        dims += "[FMU_STRING_MAX]"
    unit = f" /* [{v.unit}] */" if v.unit else ""
    return f"    {_CTYPE[v.type]} {v.name.rpartition('.')[2]}{dims};{unit}"


def member(name: str) -> str:
    """C name of a variable in `struct vars`; those of a component are in a struct of their own."""
    component, dot, own = name.rpartition(".")
    return f"{component}_.{own}" if dot else own


def _members(variables: Iterable[Variable]) -> list[str]:
    groups: dict[str, list[str]] = {}
    for v in variables:
        groups.setdefault(v.name.rpartition(".")[0], []).append(_member(v))
    lines = groups.pop("", [])
    for component, inner in groups.items():
        lines += ["    struct {", *(f"    {line}" for line in inner), f"    }} {component}_;"]
    return lines


def _nested(values: list[str], dims: tuple[int, ...]) -> str:
    if not dims:
        return values[0]
    step = len(values) // dims[0]
    parts = [_nested(values[i * step : (i + 1) * step], dims[1:]) for i in range(dims[0])]
    return "{" + ", ".join(parts) + "}"


def _keeps(v: Variable) -> bool:
    """Whether an instance keeps its own value when it begins in a saved state."""
    return v.name in COMMON or v.declared in FILES.values()


def header(d: Description) -> str:
    """Text of vars.h: the FMU_* constants and `struct vars`, one member per variable."""
    members = "\n".join(_members(d.variables))
    known = f"#define FMU_STRICT {member(d.strict)}\n"
    if d.begin:
        known += f"#define FMU_BEGIN {member(d.begin)}\n"
    if d.grid:
        known += f'#define FMU_GRID {member(d.grid)} /* [s] */\n#define FMU_GRID_NAME "{d.grid}"\n'
    return (
        f"{_NOTE}#ifndef VARS_H\n#define VARS_H\n"
        "#include <stdbool.h>\n#include <stdint.h>\n\n"
        f'#define FMU_NAME "{d.name}"\n#define FMU_TOKEN "{d.token}"\n'
        f'#define FMU_VERSION "{version()}"\n'
        f"#define FMU_TICK_NS {d.tick_ns}\n#define FMU_STRING_MAX {STRING_MAX}\n"
        f"{known}#define FMU_NVARS {len(d.variables)}\n#define FMU_NREFS {d.reference_count}\n\n"
        f"struct vars {{\n{members}\n}};\n#endif\n"
    )


def table(d: Description) -> str:
    """Text of vars.c: `vars_start`, `var_table` and `var_of_ref`."""
    starts, rows, refs = [], [], []
    for row, (v, ref) in enumerate(zip(d.variables, d.references(), strict=True)):
        if v.start is not None:
            values = _nested([_literal(x) for x in v.start], v.dims)
            starts.append(f"    .{member(v.name)} = {values},")
        low = "-DBL_MAX" if v.min is None else repr(float(v.min))
        high = "DBL_MAX" if v.max is None else repr(float(v.max))
        rows.append(
            f'    {{"{v.name}", {ref}, {v.count}, offsetof(struct vars, {member(v.name)}), '
            f"VAR_{v.type.upper()}, CAUSE_{v.causality.upper()}, {_VARY[v.variability]}, "
            f"{low}, {high}, {int(_keeps(v))}}},"
        )
        refs += [str(row)] * v.count
    lines = [", ".join(refs[i : i + 24]) for i in range(0, len(refs), 24)]
    return (
        f'{_NOTE}#include <float.h>\n#include <stddef.h>\n#include "fmi_vars.h"\n\n'
        "static const struct vars vars_start = {\n" + "\n".join(starts) + "\n};\n\n"
        "static const struct var_info var_table[FMU_NVARS] = {\n" + "\n".join(rows) + "\n};\n\n"
        "static const uint16_t var_of_ref[FMU_NREFS] = {\n    " + ",\n    ".join(lines) + "\n};\n"
    )


def main_unit(model: str, fmi: int) -> str:
    """Text of fmu_main.c, which joins the model, by the name of its C file, and the FMI layer."""
    return (
        f"{_NOTE}#define FMI_VERSION {fmi}\n"
        "#define _POSIX_C_SOURCE 200809L /* kinds of files, fmu_file.h */\n"
        f'#include "{model}"\n#include "vars.c"\n'
        '#include "fmi.inc"\n'
    )


def part_unit(model: str, identifier: str) -> str:
    """Text of fmu_part.c, which makes the model a part without FMI."""
    return (
        f"{_NOTE}#define FMU_PART motionfmu_part_{identifier}\n"
        "#define _POSIX_C_SOURCE 200809L /* kinds of files, fmu_file.h */\n"
        f'#include "{model}"\n#include "vars.c"\n'
        '#include "fmi_part.inc"\n'
    )
