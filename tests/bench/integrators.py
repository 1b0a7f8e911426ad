"""Which integrator a plant needs: error against Radau and cost, measured on a hard trajectory.

PYTHONPATH=tests/helpers python tests/bench/integrators.py        prints the table of
fmus/hydraulic_axis/README.md. Times are of one core; they compare with each other only.
"""

import ctypes
import tempfile
import time
from pathlib import Path

import casadi as ca
import numpy as np
from hydraulic_rig import HARD, START, STEP, Case, reference
from plant_library import ROOT, Library, array

from motionfmu.fmu import ctables, fmu_toml
from motionfmu.fmu.modelica import codegen
from motionfmu.fmu.modelica.cprint import statements
from motionfmu.fmu.modelica.nodes import program

HERE = Path(__file__).parent
METHODS = ("RK4", "Bogacki-Shampine 3(2)", "Dormand-Prince 5(4)", "RODAS 4(3)")
# Where the plant is some twenty times stiffer than it is delivered.
STIFF = {
    "table_rest_speed": 1e-5,
    "laminar_drop": 1e4,
    "dead_volume_a": 1e-5,
    "dead_volume_b": 1e-5,
}


def slope(ode):
    """C text of the Jacobian with the branches as they are."""
    p = program([ode.x, ode.u, ode.p], [ca.jacobian(ode.xdot, ode.x)])
    n = len(ode.states)

    def leaf(_, node):
        return f"{'xup'[node.input[0]]}[{node.input[1]}]" if node.op == ca.OP_INPUT else None

    lines = statements(p, p.results[0], leaf)
    lines += [f"jacobian[{k % n * n + k // n}] = a{a};" for k, a in enumerate(p.results[0])]
    head = "void plant_slope(const double *x, const double *u, const double *p, double *jacobian)"
    return '#include <math.h>\n#include "plant.h"\n' + head + "\n{\n" + "\n".join(lines) + "\n}\n"


def build(case):
    """The candidates as a shared library."""
    folder = Path(tempfile.mkdtemp())
    toml = ROOT / "fmus/hydraulic_axis/fmu.toml"
    codegen.write(toml, folder)
    (folder / "vars.h").write_text(ctables.header(fmu_toml.load(toml)))
    (folder / "slope.c").write_text(slope(case.ode))
    files = [HERE / "integrators.c", folder / "plant.c", folder / "slope.c"]
    files.append(ROOT / "build/libelementary.a")
    Library.compile(files, folder / "bench.so", [folder, ROOT / "src/plant"])
    c = ctypes.CDLL(str(folder / "bench.so"))
    i, d, n, v = ctypes.c_int, ctypes.c_double, ctypes.c_long, ctypes.c_void_p
    c.bench_run.argtypes = [i, i, d, d, n, v, v, v, v]
    return c


def run(c, case, how, scale):
    """States at every micro step, and milliseconds per simulated second."""
    method, n, tolerance, h = how
    best, shown = np.inf, np.empty(0)
    for _ in range(5):
        x, parts = array(case.start), []
        c.bench_begin(array(scale))
        spent, t0 = 0.0, 0.0
        for t1, *u in HARD:
            steps = round((t1 - t0) / h)
            out = array(np.empty(steps * len(scale)))
            begin = time.process_time()
            c.bench_run(method, n, tolerance, h, steps, array(u), array(case.p), x, out)
            spent += time.process_time() - begin
            parts.append(np.reshape(out, (steps, -1)))
            t0 = t1
        best, shown = min(best, spent), np.concatenate(parts)
    return shown, 1e3 * best / HARD[-1][0]


def main():
    cases = [Case(**START), Case(**START, **STIFF)]
    exact = [reference(case, HARD, 1e-12) for case in cases]
    size = ca.Function("size", [cases[0].ode.p], [cases[0].ode.sizes])
    c = build(cases[0])
    fixed = [(m, n, 0.0, h) for h in (STEP,) for m in (0, 3) for n in (1, 2, 4, 8, 16)]
    free = [(m, 0, t, h) for h in (STEP, 1e-4) for m in (1, 2, 3) for t in (1e-7, 1e-8, 1e-9)]
    print(
        "| method | micro step [us] | steps | error | evaluations/s | ms/s | stiff: error | ms/s |"
    )
    for how in fixed + free:
        row = [METHODS[how[0]], f"{how[3] * 1e6:g}", f"{how[1]} equal" if how[1] else f"{how[2]:g}"]
        for case, wanted in zip(cases, exact, strict=True):
            shown, cost = run(c, case, how, size(case.p).full().ravel())
            every = round(how[3] / STEP)
            error = np.abs(shown - wanted[every - 1 :: every]) / np.abs(wanted).max(axis=0)
            calls = ctypes.c_long.in_dll(c, "bench_rhs_calls").value / HARD[-1][0]
            row += [f"{error.max():.1e}", f"{calls:.0f}", f"{cost:.0f}"]
        del row[7]
        print("|", " | ".join(row), "|", flush=True)


if __name__ == "__main__":
    main()
