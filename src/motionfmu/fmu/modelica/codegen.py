"""Write a Modelica class as plant.c and plant.h.

plant_model.c integrates the equation in them.

CasADi's own C text serves one point per call, and its null checks keep compilers from doing
two points at once. Here quantity k of lane i stands at [k * lanes + i], each function is one loop
over lanes, compiled for every number of them that can occur, and what depends on parameters only is
computed once (`plant_constants`).
"""

import json
import re
from pathlib import Path

import casadi as ca

from motionfmu.fmu.describe import Description
from motionfmu.fmu.modelica import causal, class_description, equation_text
from motionfmu.fmu.modelica.cprint import TURNS, statements, turned
from motionfmu.fmu.modelica.flat import Declaration
from motionfmu.fmu.modelica.hoist import Split, split
from motionfmu.fmu.modelica.nodes import STEPS, Node, Operations, program
from motionfmu.fmu.modelica.ode import Ode

# The numbers of lanes for which functions are compiled; so many axes at most are integrated
# together, with the smallest number of lanes that holds them. Measured (an evaluation of
# BallScrewAxis for all, 2026-11): 1 lane 16 ns, 2 lanes 16 ns, 4 lanes 19 ns (AVX2: 17), 6 lanes
# 26 ns (AVX2: 23).
WIDTHS = (1, 2, 4, 6)
# Lanes of several runs that are stepped at once. Measured (a step of Runge and Kutta of a run's two
# axes, 2026-11): alone 80 ns, 4 runs in 8 lanes 22 ns, 8 in 16 lanes 17 ns.
TOGETHER = (8, 16)
# Branches are bits of an unsigned int; plant_model.c tries every combination of up to 8 of them.
MAX_BRANCHES = 31
# A Jacobian with more operations is computed column by column from the derivative along a
# direction. To compile that of an arm (900 elements, 29,000 operations) takes 10 s, to compile the
# derivative a third of it.
WHOLE_JACOBIAN = 4000

_NOTE = "/* Generated from {}; do not edit. */\n"
# Argument positions of every program in this module, and their names in C.
_X, _U, _P, _C = range(4)
_WAY = _C  # argument position of the direction of a derivative
_ARGUMENTS = "xupc"


def write(toml: Path, out: Path) -> Description:
    """Write plant.c, plant.h, ode.json of an fmu.toml with the key ``modelica``, where changed."""
    packing = class_description.read(toml)
    ode = causal.load(packing.package, packing.modelica)
    described = class_description.describe_class(toml, packing, ode)
    out.mkdir(parents=True, exist_ok=True)
    how = packing.tolerance, tuple(packing.tunable)
    code, header = generate(ode, packing.instances, *how)
    texts = {"plant.c": code, "plant.h": header, equation_text.FILE: equation_text.to_json(ode)}
    for name, text in texts.items():
        file = out / name
        if not file.exists() or file.read_text() != text:
            file.write_text(text)
    return described


def generate(
    ode: Ode, instances: int, tolerance: float | None = None, tunable: tuple[str, ...] = ()
) -> tuple[str, str]:
    """Text of plant.c and plant.h; one instance has scalars, more have arrays.

    Parameters of `tunable` may change in a run.

    With a tolerance, the error of one step, the steps follow the error, and each axis has steps of
    its own. A ValueError tells of too many branches, or an operation without a form in C.
    """
    if not ode.states or not ode.outputs:
        raise ValueError(f"{ode.name}: a plant needs a state and an output")
    equations = split(program([ode.x, ode.u, ode.p], [ode.xdot, ode.y]), {_X, _U}, _C)
    jacobian = program([ode.x, ode.u, ode.p], [ca.jacobian(ode.xdot, ode.x)])
    if len(jacobian.nodes) > WHOLE_JACOBIAN:
        way = ca.SX.sym("way", ode.x.numel())
        slope = ca.jtimes(ode.xdot, ode.x, way)
        jacobian = program([ode.x, ode.u, ode.p, way], [slope])
    branches = _branches(jacobian)
    bits = len({bit for bit, _ in branches.values()})
    if tolerance is None and bits > MAX_BRANCHES:
        raise ValueError(f"{ode.name}: {bits} branches in the Jacobian, at most {MAX_BRANCHES}")
    used = (1,) if tolerance else widths(instances)
    together = () if tolerance else TOGETHER[: 1 if instances == 1 else None]
    sizes = {
        "INSTANCES": instances,
        "LANES": used[-1],
        "WIDEST": max(used + together),
        "STATES": len(ode.states),
        "INPUTS": len(ode.inputs),
        "OUTPUTS": len(ode.outputs),
        "PARAMETERS": len(ode.parameters),
        "CONSTANTS": len(equations.constants),
        "BRANCHES": bits,
        "CONTROLLED": int(tolerance is not None),
        "TUNABLES": len(tunable),
    }
    note = _NOTE.format(ode.name)
    return (
        note
        + "#include <math.h>\n#include <stddef.h>\n#include <string.h>\n\n"
        + '#include "elementary.h"\n#include "plant.h"\n\n'
        + "\n".join(
            [
                _ports(ode, "[instance]" if instances > 1 else ""),
                _tuned(tunable),
                _of_parameters(ode, equations),
                *_loops(ode, equations, used, together),
            ]
        )
        + _jacobian(ode, jacobian, branches),
        note
        + _header(sizes, (used, together), tolerance).replace(
            _MEMBERS, _tuned_members(ode, tunable, instances)
        ),
    )


def widths(instances: int) -> tuple[int, ...]:
    """The `WIDTHS` that blocks of so many axes can have."""
    return tuple(w for k, w in enumerate(WIDTHS) if k == 0 or WIDTHS[k - 1] < instances)


def _branches(jacobian: Operations) -> dict[int, tuple[int, bool]]:
    """Comparisons that depend on states or inputs: the bit of each, and whether it is negated.

    The slope of a minimum or maximum has both a <= b and b <= a: one bit is enough for the two.
    """
    moving = jacobian.depends({_X, _U})
    logic = {ca.OP_NOT, ca.OP_AND, ca.OP_OR, ca.OP_FLOOR, ca.OP_CEIL}
    found: dict[int, tuple[int, bool]] = {}
    bits: dict[tuple[int, ...], int] = {}
    for k, n in enumerate(jacobian.nodes):
        if not moving[k] or n.op not in STEPS - logic:
            continue
        opposite = (n.op, *reversed(n.args))
        if n.op == ca.OP_LE and opposite in bits:
            found[k] = bits[opposite], True
        else:
            found[k] = bits.setdefault((n.op, *n.args), len(bits)), False
    return found


def _function(head: str, lines: list[str]) -> str:
    """Text of a C function; arguments that it does not use are cast to void."""
    body = "\n".join(lines)
    arguments = re.findall(r"(\w+)[,)]", head)
    unused = [a for a in arguments if not re.search(rf"\b{a}\b", body)]
    lines = [f"(void){a};" for a in unused] + lines
    return f"{head}\n{{\n" + "".join(f"    {line}\n" for line in lines) + "}\n"


def _member(d: Declaration, element: str) -> str:
    """C text of a member of struct vars, or of an element of it."""
    subscripts = d.name.removeprefix(d.base)[1:-1].split(",") if d.base else []
    return f"v->{d.port}{element}" + "".join(f"[{int(k) - 1}]" for k in subscripts)


def _cast(d: Declaration, text: str) -> str:
    """C text of a member of struct vars as a double."""
    if d.type == "Boolean":
        return f"{text} ? 1.0 : 0.0"
    return text


def _ports(ode: Ode, element: str) -> str:
    """C functions that copy between `struct vars` and plain arrays; `element` is an index in C."""
    names = {
        kind: ", ".join(f'"{d.name}"' for d in group)
        for kind, group in (("state", ode.states), ("output", ode.outputs))
    }
    shown = [
        f"{_member(d, element)} = y[{k} * lanes]{' != 0.0' if d.type == 'Boolean' else ''};"
        for k, d in enumerate(ode.outputs)
    ]
    parameters = [
        f"p[{k}] = {_cast(d, _member(d, element))};" for k, d in enumerate(ode.parameters)
    ]
    inputs = [
        f"u[{k} * lanes] = {_cast(d, _member(d, element))};" for k, d in enumerate(ode.inputs)
    ]
    return "\n".join(
        [
            f"const char *const plant_state_names[PLANT_STATES] = {{{names['state']}}};",
            f"const char *const plant_output_names[PLANT_OUTPUTS] = {{{names['output']}}};\n",
            _function(
                "int plant_active(const struct vars *v, int instance)",
                [f"return v->active{element};"],
            ),
            _function(
                "void plant_parameters(const struct vars *v, int instance, double *p)", parameters
            ),
            _function(
                "void plant_inputs(const struct vars *v, int instance, int lanes, double *u)",
                inputs,
            ),
            _function(
                "void plant_show(struct vars *v, int instance, int lanes, const double *y)", shown
            ),
        ]
    )


_MEMBERS = "    /* members */"


def _tuned_members(ode: Ode, tunable: tuple[str, ...], instances: int) -> str:
    """Members of struct plant_tuned; C wants one at least."""
    ports = [d.port for d in ode.parameters]
    sizes = {name: ports.count(name) * instances for name in tunable}
    return "\n".join(f"    double {n}[{size}];" for n, size in sizes.items()) or "    char none;"


def _tuned(tunable: tuple[str, ...]) -> str:
    """C function that looks for changed parameters."""
    lines = []
    for name in tunable:
        both = f"was->{name}, &v->{name}, sizeof was->{name}"
        lines += [
            f"if (memcmp({both}) != 0) {{",
            f"    memcpy({both});",
            "    changed = true;",
            "}",
        ]
    head = "bool plant_tuned(const struct vars *v, struct plant_tuned *was)"
    return _function(head, ["bool changed = false;", *lines, "return changed;"])


def _single(_: int, node: Node) -> str | None:
    """C text of a program's input for one instance."""
    group, place = node.input
    return f"{_ARGUMENTS[group]}[{place}]" if node.op == ca.OP_INPUT else None


def _of_parameters(ode: Ode, equations: Split) -> str:
    """C functions of parameters alone: checks, initial state, sizes and constants."""
    conditions = ca.vertcat(ca.SX(0, 1), *(c for c, _ in ode.checks))
    early = program([ode.x, ode.u, ode.p], [conditions, ode.start, ode.sizes])
    checks, start, sizes = early.results
    lines = statements(early, checks, _single)
    for node, (_, text) in zip(checks, ode.checks, strict=True):
        lines += [f"if (a{node} == 0.0) {{", f"    return {json.dumps(text)};", "}"]
    check = _function("const char *plant_check(const double *p)", [*lines, "return NULL;"])

    def of_states(name: str, nodes: tuple[int, ...]) -> list[str]:
        rows = enumerate(zip(nodes, ode.states, strict=True))
        filled = [f"{name}[{k}] = a{node}; /* {d.name} */" for k, (node, d) in rows]
        return [*statements(early, nodes, _single), *filled]

    initial = _function("void plant_start(const double *p, double *x)", of_states("x", start))
    large = _function("void plant_sizes(const double *p, double *size)", of_states("size", sizes))
    lines = statements(equations.early, [node for node, _ in equations.constants], _single)
    for k, (node, inverted) in enumerate(equations.constants):
        lines.append(f"c[{k}] = {'1.0 / ' if inverted else ''}a{node};")
    constants = _function("void plant_constants(const double *p, double *c)", lines)
    return "\n".join([check, initial, large, constants])


def _loops(
    ode: Ode, equations: Split, used: tuple[int, ...], together: tuple[int, ...]
) -> list[str]:
    """plant_rhs_N and plant_outputs_N for N lanes, each also for processors with AVX2.

    Angles are one loop over lanes, all that needs their sines and cosines is another: between them
    the angles of all lanes are turned at once.
    """
    names = {_X: ode.states, _U: ode.inputs}
    late = equations.late

    def lane(_: int, node: Node) -> str | None:
        if node.op != ca.OP_INPUT:
            return None
        group, place = node.input
        name = f" /* {names[group][place].name} */" if group in names else ""
        return f"{_ARGUMENTS[group]}[{place} * lanes + i]{name}"

    def loop(lines: list[str]) -> list[str]:
        body = (f"    {line}" for line in lines)
        return ["PLANT_ROLLED", "for (int i = 0; i < lanes; i++) {", *body, "}"]

    texts = []
    for name, to, result in zip(("rhs", "outputs"), ("dx", "y"), late.results, strict=True):
        angles = turned(late, result)
        place = {a: k for k, a in enumerate(angles)}

        def turn(k: int, node: Node, place: dict[int, int] = place) -> str | None:
            if node.op in TURNS and node.args[0] in place:
                return f"{TURNS[node.op]}[{place[node.args[0]]} * lanes + i]"
            return lane(k, node)

        body = []
        if angles:
            size = f"[{len(angles)} * PLANT_WIDEST]"
            body = [f"double angle{size}, sine{size}, cosine{size};"]
            lines = statements(late, angles, lane)
            body += loop(lines + [f"angle[{place[a]} * lanes + i] = a{a};" for a in angles])
            body.append(f"turns({len(angles)} * lanes, angle, sine, cosine);")
        lines = statements(late, result, turn)
        body += loop(lines + [f"{to}[{k} * lanes + i] = a{node};" for k, node in enumerate(result)])
        arguments = (
            "const double *restrict x, const double *restrict u,\n"
            f"    const double *restrict c, double *restrict {to})"
        )
        head = f"static PLANT_INLINE void {name}(int lanes, el_turns *turns,\n    {arguments}"
        texts.append(_function(head, body))
        for before, after, turns, several in (
            ("", "", "each", used),
            ("EL_AVX2 ", "_avx2", "avx2", used + together),
        ):
            for w in several:
                head = f"{before}void plant_{name}_{w}{after}({arguments}"
                call = f"{name}({w}, el_turns_{turns}, x, u, c, {to});"
                texts.append(_function(head, [call]))
    return texts


def _jacobian(ode: Ode, jacobian: Operations, branches: dict[int, tuple[int, bool]]) -> str:
    """Text of plant_jacobian for one instance; the caller decides comparisons."""

    def leaf(k: int, node: Node) -> str | None:
        if k not in branches:
            along = node.op == ca.OP_INPUT and node.input[0] == _WAY
            return f"way[{node.input[1]}]" if along else _single(k, node)
        place, inverted = branches[k]
        bit = f"({'~' if inverted else ''}branches >> {place} & 1u)"
        return f"{bit} ? 1.0 : -1.0" if node.op == ca.OP_SIGN else f"(double){bit}"

    (result,) = jacobian.results
    n = len(ode.states)
    lines = statements(jacobian, result, leaf)
    arguments = "const double *x, const double *u, const double *p,\n    unsigned branches"
    head = f"\nvoid plant_jacobian({arguments}, double *jacobian)"
    if len(result) == n * n:
        for k, node in enumerate(result):  # CasADi counts column by column
            lines.append(f"jacobian[{k % n * n + k // n}] = a{node};")
        return _function(head, lines)
    lines += [f"slope[{k}] = a{node};" for k, node in enumerate(result)]
    along = f"\nstatic void along({arguments}, const double *way, double *slope)"
    return _function(along, lines) + _function(head, _COLUMNS)


_COLUMNS = """\
for (int j = 0; j < PLANT_STATES; j++) {
    double way[PLANT_STATES] = {0.0}, slope[PLANT_STATES];
    way[j] = 1.0;
    along(x, u, p, branches, way, slope);
    for (int i = 0; i < PLANT_STATES; i++) {
        jacobian[i * PLANT_STATES + j] = slope[i];
    }
}""".splitlines()


_WIDTHS = "/* widths */"
_SEVERAL = f"""
/* The same for several runs, whose axes fill so many lanes; on processors with AVX2 only. */
#define PLANT_TOGETHER(X) {_WIDTHS}
#define PLANT_LANE_FUNCTIONS(n) \\
    EL_AVX2 plant_function plant_rhs_##n##_avx2, plant_outputs_##n##_avx2;
PLANT_TOGETHER(PLANT_LANE_FUNCTIONS)
#undef PLANT_LANE_FUNCTIONS
"""


def _header(
    sizes: dict[str, int], lanes: tuple[tuple[int, ...], ...], tolerance: float | None
) -> str:
    members = "\n".join(f"    PLANT_{name} = {value}," for name, value in sizes.items())
    widths, together = (" ".join(f"X({w})" for w in several) for several in lanes)
    several = _SEVERAL.replace(_WIDTHS, together) if together else ""
    flat = " __attribute__((flatten))" if len(lanes[0]) > 1 else ""
    return f"""#ifndef PLANT_H
#define PLANT_H

#include <stdbool.h>

#include "plant_machine.h"
#include "vars.h"

enum {{
{members}
}};

/* Numbers of lanes of a block. A function of `lanes` is compiled for each of them. */
#define PLANT_WIDTHS(X) {widths}
#if defined(__GNUC__)
#define PLANT_INLINE inline __attribute__((always_inline))
#define PLANT_FLAT{flat}
#else
#define PLANT_INLINE inline
#define PLANT_FLAT
#endif
/* A loop over two lanes becomes vectors only if it is not unrolled before. */
#if defined(__GNUC__) && !defined(__clang__)
#define PLANT_ROLLED _Pragma("GCC unroll 1")
#else
#define PLANT_ROLLED
#endif

/* [1] Error of a controlled step as a share of a state's size. */
#define PLANT_TOLERANCE {tolerance or 0.0!r}

extern const char *const plant_state_names[PLANT_STATES];
extern const char *const plant_output_names[PLANT_OUTPUTS];

/* Between struct vars and plain numbers. u and y step by `lanes`. */
int plant_active(const struct vars *v, int instance);

/* Parameters that may change in a run, as they were looked at last. True if one has changed since;
 * *was has the new ones. */
struct plant_tuned {{
{_MEMBERS}
}};
bool plant_tuned(const struct vars *v, struct plant_tuned *was);
void plant_parameters(const struct vars *v, int instance, double *p);
void plant_inputs(const struct vars *v, int instance, int lanes, double *u);
void plant_show(struct vars *v, int instance, int lanes, const double *y);

/* Of the parameters alone: NULL or what is wrong with them, initial state, what is large for each
 * state, constants of a run. */
const char *plant_check(const double *p);
void plant_start(const double *p, double *x);
void plant_sizes(const double *p, double *size);
void plant_constants(const double *p, double *c);

/* Rates of the states dx, and outputs y, of so many lanes; quantity k of lane i at
 * [k * lanes + i]. */
typedef void plant_function(const double *restrict x, const double *restrict u,
    const double *restrict c, double *restrict result);
#define PLANT_LANE_FUNCTIONS(n) \
    plant_function plant_rhs_##n, plant_outputs_##n; \
    EL_AVX2 plant_function plant_rhs_##n##_avx2, plant_outputs_##n##_avx2;
PLANT_WIDTHS(PLANT_LANE_FUNCTIONS)
#undef PLANT_LANE_FUNCTIONS
{several}
/* d(rhs)/dx row by row, with each comparison decided by a bit of `branches`. */
void plant_jacobian(const double *x, const double *u, const double *p, unsigned branches,
    double *jacobian);

#endif
"""
