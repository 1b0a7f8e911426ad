"""The C text of a system: its parts' instances, wires, recorder and the order of a step."""

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence

from motionfmu.fmu.ctables import member
from motionfmu.fused.fmu_parts import FmuPart
from motionfmu.fused.system_variables import Roles
from motionfmu.scenarios.system import End, System, Wire

# Letter of struct recorder_column, and bytes.
_KINDS = {"Float64": ("d", 8), "Int32": ("i", 4), "Boolean": ("b", 1)}
_I32 = (-(2**31), 2**31 - 1)
# Lines of a C function: a compiler's time grows with the square of what is copied in one.
_COPIES = 64


def _in_part(end: End) -> str:
    """C expression of a component's variable in its instance, from a `struct model *m`."""
    return f"m->of_{end.component}.v.{end.port.name}"


def _here(end: End) -> str:
    """C expression of the system's own variable, from a `struct vars *v`."""
    return f"v->{member(end.name)}"


def _function(head: str, lines: Iterable[str], unused: Iterable[str], end: str = "") -> str:
    rows = [*(f"(void){name};" for name in unused), *lines, *([end] if end else [])]
    return f"static {head}\n{{\n" + "".join(f"    {row}\n" for row in rows) + "}\n"


def _limits(end: End) -> str:
    """C text that checks the limits of an input that a wire feeds; empty if it has no limits."""
    port, name = end.port, _in_part(end)
    if port.type == "Float64":
        if math.isinf(port.low) and math.isinf(port.high):
            return f"SYSTEM_FINITE({name});"
        low = "-DBL_MAX" if math.isinf(port.low) else repr(port.low)
        high = "DBL_MAX" if math.isinf(port.high) else repr(port.high)
        return f"SYSTEM_REALS({name}, {low}, {high});"
    low_i, high_i = max(port.low, _I32[0]), min(port.high, _I32[1])
    if port.type == "Int32" and (low_i, high_i) != _I32:
        if low_i == 0 and int(high_i) & (int(high_i) + 1) == 0:
            return f"SYSTEM_BITS({name}, {int(high_i)});"
        low = "INT32_MIN" if low_i == _I32[0] else str(int(low_i))
        return f"SYSTEM_WHOLES({name}, {low}, {int(high_i)});"
    return ""


def _table(head: str, rows: Sequence[str]) -> str:
    """C text of an array; without rows it gets one of zeros, for C has no empty array."""
    listed = rows or ["{0}"]
    return f"static const {head}[] = {{\n" + "".join(f"    {row},\n" for row in listed) + "};\n"


def _structs(parts: Mapping[str, FmuPart]) -> Iterable[str]:
    for p in {p.identifier: p for p in parts.values()}.values():
        name = f"struct {p.identifier}_vars"
        yield f"{name} {{\n{p.members}}};\n"
        yield f'_Static_assert(sizeof({name}) == {p.size}, "variables of {p.identifier}");\n'
        yield f"SYSTEM_PART(motionfmu_part_{p.identifier});\n\n"


def _model(system: System, parts: Mapping[str, FmuPart]) -> str:
    lines = []
    for component, fmu in system.components.items():
        p = parts[fmu]
        both = f"struct {p.identifier}_vars v; unsigned char byte[{p.room}];"
        lines.append(f"    _Alignas(FMU_PART_ALIGN) union {{ {both} }} of_{component};\n")
    return (
        "struct model {\n" + "".join(lines) + "    int64_t step; /* [ns] */\n"
        "    int64_t steps; /* made since the start */\n"
        "    int32_t until; /* step at which the signal came; -1: not yet */\n"
        "    int32_t which; /* of the signals that end the run */\n};\n"
    )


def _gives(system: System, parts: Mapping[str, FmuPart], used: Roles) -> Iterable[str]:
    for component, fmu in system.components.items():
        mine = [e for e in used.given if e.component == component]
        lines = [f"struct {parts[fmu].identifier}_vars *to = part;"]
        lines += [f"SYSTEM_COPY(to->{e.port.name}, {_here(e)});" for e in mine]
        head = f"void give_{component}(void *part, const struct vars *v)"
        yield _function(head, lines, ["v"] + ([] if mine else ["part"]))


def _carried(head: str, wires: Sequence[Wire]) -> str:
    lines = [f"SYSTEM_COPY({_in_part(w.target)}, {_in_part(w.source)});" for w in wires]
    # An output may feed several inputs: what is asked of it is asked once for all with its limits.
    asked: dict[tuple[str, str], str] = {}
    for w in wires:
        if check := _limits(w.target):
            asked.setdefault((w.source.name, check.replace(_in_part(w.target), "")), check)
    checks = asked.values()
    ends = ["struct system_check check = { .good = true };", *checks, "return system_good(&check);"]
    return _function(head, [*lines, *ends], ["m"])


def _carry(system: System) -> Iterable[str]:
    """C text that copies every wire's output to its input, then checks the limits of inputs."""
    parts = [system.wires[k : k + _COPIES] for k in range(0, len(system.wires), _COPIES)]
    if len(parts) < 2:
        yield _carried("bool system_carry(struct model *m)", system.wires)
        return
    for k, wires in enumerate(parts):
        yield _carried(f"SYSTEM_APART bool system_carry_{k}(struct model *m)", wires)
    all_good = " & ".join(f"system_carry_{k}(m)" for k in range(len(parts)))
    yield _function("bool system_carry(struct model *m)", [f"return {all_good};"], [])


def _until(system: System) -> str:
    lines = []
    for which, signal in reversed([*enumerate(system.until.signals if system.until else ())]):
        kind = {"Boolean": "bool", "Int32": "int32_t"}[signal.end.port.type]
        value = f"((const {kind} *)&{_in_part(signal.end)})[{signal.element or 0}]"
        lines.append(f"if ({value} != 0) return {which};")
    return _function("int system_until(const struct model *m)", [*lines, "return -1;"], ["m"])


def _step(system: System, parts: Mapping[str, FmuPart]) -> str:
    calls = [
        f"motionfmu_part_{parts[fmu].identifier}.step(&m->of_{component}, t0, t1) != 0"
        for component, fmu in system.components.items()
    ]
    joined = "\n        || ".join(calls)
    head = "int system_step(struct model *m, int64_t t0, int64_t t1)"
    return _function(head, [f"return {joined} ? -1 : 0;"], [])


def _together(system: System, parts: Mapping[str, FmuPart]) -> str:
    lines = [
        f"SYSTEM_TOGETHER(motionfmu_part_{parts[fmu].identifier}, of_{component})"
        for component, fmu in system.components.items()
    ]
    several = "struct model *const *m, int runs, int64_t t0, int64_t t1, bool *failed"
    text = _function(f"void system_together({several})", lines, [])
    return f"\n#ifdef SYSTEM_QUICKLY\n{text}#endif\n"


def _copies(name: str, arguments: str, lines: Sequence[str]) -> Iterable[str]:
    """C text of a function whose lines stand for themselves, in several if they are many."""
    calls = lines
    if len(lines) > _COPIES:
        parts = range(0, len(lines), _COPIES)
        for k in parts:
            head = f"SYSTEM_APART void {name}_{k}({arguments})"
            yield _function(head, lines[k : k + _COPIES], ["m", "v"])
        calls = [f"{name}_{k}(m, v);" for k in parts]
    yield _function(f"void {name}({arguments})", calls, ["m", "v"])


def _shows(system: System, parts: Mapping[str, FmuPart], used: Roles) -> Iterable[str]:
    taken = [f"SYSTEM_COPY({_in_part(e)}, {_here(e)});" for e in used.taken]
    for component in dict.fromkeys(e.component for e in used.taken if e.port.tunable):
        part = parts[system.components[component]].identifier
        taken.append(f"motionfmu_part_{part}.tuned(&m->of_{component});")
    yield from _copies("system_take", "struct model *m, const struct vars *v", taken)
    back = [f"SYSTEM_COPY({_here(e)}, {_in_part(e)});" for e in used.taken]
    yield from _copies("system_return", "const struct model *m, struct vars *v", back)
    shown = [f"SYSTEM_COPY({_here(e)}, {_in_part(e)});" for e in used.shown]
    if system.until is not None:
        shown += ["v->until_.step = m->until;", "v->until_.which = m->which;"]
    yield from _copies("system_show", "const struct model *m, struct vars *v", shown)


def _tables(system: System, parts: Mapping[str, FmuPart], recorded: Sequence[End]) -> Iterable[str]:
    yield f"enum {{ SYSTEM_PARTS = {len(system.components)}, SYSTEM_WIRES = {len(system.wires)}, "
    yield f"SYSTEM_COLUMNS = {len(recorded)} }};\n\n"
    yield _table(
        "struct system_part system_parts",
        [
            f'{{"{c}", &motionfmu_part_{parts[fmu].identifier}, '
            f"offsetof(struct model, of_{c}), give_{c}}}"
            for c, fmu in system.components.items()
        ],
    )
    number = dict(zip(system.components, itertools.count(), strict=False))
    rows = []
    for w in system.wires:
        at, to = w.target, number[w.target.component]
        struct = f"struct {parts[system.components[at.component]].identifier}_vars"
        rows.append(f"{{{to}, offsetof({struct}, {at.port.name})}}")
    yield _table("struct system_wire system_wires", rows)
    yield _table(
        "struct recorder_column system_columns",
        [f"{{\"{e.name}\", '{_KINDS[e.port.type][0]}', {e.port.count}}}" for e in recorded],
    )


def _keep(recorded: Sequence[End]) -> str:
    """C text that copies what is recorded into a row, in the order of the recorder's groups."""
    wide = {8: ["SYSTEM_KEEP(-1, r->time);"]}
    for i, e in enumerate(recorded):
        width = _KINDS[e.port.type][1] * e.port.count
        wide.setdefault(width, []).append(f"SYSTEM_KEEP({i}, {_in_part(e)});")
    lines = ["char *const *block = r->block;", "size_t at;"]
    for group, width in enumerate(sorted(wide)):
        lines += [f"at = recorder_place(r, &r->groups[{group}]);", *wide[width]]
    head = "inline void system_keep(const struct model *m, const struct recorder *r)"
    return _function(head, lines, ["m"])


def main_unit(fmi: int, quickly: bool) -> str:
    """Text of fmu_main.c; with `quickly` code that runs once is compiled without optimization."""
    return (
        "/* Generated; do not edit. */\n"
        + ("#define SYSTEM_QUICKLY\n" if quickly else "")
        + f"#define FMI_VERSION {fmi}\n"
        "#define _GNU_SOURCE /* kinds of files, fmu_file.h; room for them on the disk */\n"
        '#include "model.c"\n#include "vars.c"\n'
        'SYSTEM_COLD_BEGIN\n#include "fmi.inc"\nSYSTEM_COLD_END\n'
    )


def model(
    system: System, parts: Mapping[str, FmuPart], used: Roles, recorded: Sequence[End]
) -> str:
    """Text of model.c; `parts` gives the part of each FMU by its name."""
    pieces = [
        "/* Generated from a scenario's components and wires; do not edit. */\n"
        '#include "vars.h"\n#include "fmu_system.h"\n\n',
        *_structs(parts),
        _model(system, parts),
        "\n#define MODEL_BLOB\n#define MODEL_PARTS\n",
        '#include "fmi_model.h"\n#include "fmu_recorder.h"\n\n',
        "SYSTEM_COLD_BEGIN\n",
        *_gives(system, parts, used),
        "SYSTEM_COLD_END\n\n",
        *_tables(system, parts, recorded),
        _keep(recorded),
        *_carry(system),
        _until(system),
        _step(system, parts),
        _together(system, parts),
        *_shows(system, parts, used),
        '\n#include "fmi_system.inc"\n',
    ]
    return "".join(pieces)
