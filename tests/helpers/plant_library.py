"""Compile a Modelica FMU's C without the FMI layer and drive it from Python."""

import ctypes
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.fmu import ctables, fmu_toml
from motionfmu.fmu.describe import STRING_MAX
from motionfmu.fmu.modelica import codegen

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"
PACKAGE = ROOT / "modelica" / "MotionControl"
_ELEMENTARY = ROOT / "src/base/elementary"
_FLAGS = (
    "-std=c11 -O2 -Wall -Wextra -Wpedantic -Wno-unused-function -Werror "
    "-ffp-contract=off -fno-math-errno -fno-trapping-math -fPIC"
)
_DRIVER = """
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include "plant_machine.h"
bool run_wide;
bool run_may_be_wide(void) { return plant_has_avx2(); }
#define plant_has_avx2() run_wide
#include "plant_model.c"
char said[1024];
static void say(const char *format, va_list args)
{
    vsnprintf(said, sizeof said, format, args);
}
static int fmu_fail(struct fmu *f, const char *format, ...)
{
    (void)f;
    va_list args;
    va_start(args, format);
    say(format, args);
    va_end(args);
    return -1;
}
static void fmu_event(struct fmu *f, const char *format, ...)
{
    (void)f;
    va_list args;
    va_start(args, format);
    say(format, args);
    va_end(args);
}
static void fmu_warn(struct fmu *f, const char *format, ...)
{
    (void)f;
    va_list args;
    va_start(args, format);
    say(format, args);
    va_end(args);
}
const size_t run_size = sizeof(struct fmu);
struct fmu *run_new(void) { return calloc(1, sizeof(struct fmu)); }
void run_free(struct fmu *f) { free(f); }
int run_start(struct fmu *f) { said[0] = 0; return model_start(f); }
int run_step(struct fmu *f, int64_t t0, int64_t t1)
{
    said[0] = 0;
    f->tuned = true; /* variables are set in place */
    return model_step(f, t0, t1);
}
double run_radius(double *a) { return plant_spectral_radius(a, PLANT_FINE); }
"""


def equations(name: str) -> list[Path]:
    """What the build has compiled of an FMU's equations, and what they are linked with."""
    made = BUILD / f"CMakeFiles/{name}_equations.dir/gen/{name}/plant.c.o"
    return [made, BUILD / "libelementary.a"]


class Library:
    """The compiled plant of one fmu.toml."""

    def __init__(self, toml: Path, folder: Path, built: bool = False):
        """Make it anew, with all its functions to call, or of what the build has compiled."""
        self.description = fmu_toml.load(toml)
        made, files = folder, [folder / "plant.c", *_ELEMENTARY.glob("*.c")]
        if built:
            made = BUILD / "gen" / toml.parent.name
            files = equations(made.name)
        else:
            codegen.write(toml, folder)
            (folder / "vars.h").write_text(ctables.header(self.description))
        (folder / "driver.c").write_text(_DRIVER)
        target = folder / "plant.so"
        include = [made, ROOT / "src/plant", ROOT / "src/fmi"]
        self.compile([folder / "driver.c", *files], target, include)
        self.c = ctypes.CDLL(str(target))
        self.c.run_new.restype = ctypes.c_void_p
        self.c.run_radius.restype = ctypes.c_double
        self.c.run_may_be_wide.restype = ctypes.c_bool
        # Vectors of AVX2, as where the processor has it, or those that all have.
        self.wide = ctypes.c_bool.in_dll(self.c, "run_wide")
        self.wide.value = self.c.run_may_be_wide()
        for name in ("run_start", "run_free", "run_step"):
            getattr(self.c, name).argtypes = [ctypes.c_void_p]
        self.c.run_step.argtypes += [ctypes.c_int64] * 2
        kinds: dict[str, Any] = {"f64": ctypes.c_double, "i32": ctypes.c_int32}
        kinds |= {"bool": ctypes.c_bool, "string": ctypes.c_char * STRING_MAX}
        fields = [
            (v.name, kinds[v.type] * v.count if v.dims else kinds[v.type])
            for v in self.description.variables
        ]
        self.vars = type("Vars", (ctypes.Structure,), {"_fields_": fields})

    @staticmethod
    def compile(files: list[Path], target: Path, include: list[Path]) -> None:
        """Make a shared library that may use elementary's headers."""
        compiler = os.environ.get("CC") or shutil.which("cc") or shutil.which("gcc")
        assert compiler, "a C compiler is needed"
        command = [*compiler.split(), *_FLAGS.split(), "-shared"]
        command += [f"-I{i}" for i in [*include, _ELEMENTARY]]
        subprocess.run([*command, *map(str, files), "-o", str(target), "-lm"], check=True)


class Run:
    """One instance: set, start, advance, get."""

    def __init__(self, library: Library, **values: Any):
        self.library = library
        self.fmu = library.c.run_new()
        self.vars = library.vars.from_address(self.fmu)
        self.now = 0
        for v in library.description.variables:
            if v.start is not None:
                self.set(**{v.name: v.start if v.dims else v.start[0]})
        self.set(**values)

    def __del__(self) -> None:
        self.library.c.run_free(self.fmu)

    def set(self, **values: Any) -> "Run":
        """Set variables; a scalar fills an array."""
        for name, value in values.items():
            member = getattr(self.vars, name)
            if isinstance(member, ctypes.Array):
                member[:] = np.broadcast_to(value, len(member)).tolist()
            else:
                setattr(self.vars, name, value.encode() if isinstance(value, str) else value)
        return self

    def get(self, name: str) -> np.ndarray:
        """Value of a variable as an array of its own."""
        return np.array(getattr(self.vars, name))

    @property
    def said(self) -> str:
        """Latest error or event."""
        return (ctypes.c_char * 1024).in_dll(self.library.c, "said").value.decode()

    def start(self) -> int:
        """Initialise; status."""
        return self.library.c.run_start(self.fmu)

    def step(self, seconds: float) -> int:
        """Advance; status."""
        until = self.now + round(seconds * 1e9)
        status = self.library.c.run_step(self.fmu, self.now, until)
        self.now = until
        return status


def array(values: Any) -> Any:
    """C array of doubles."""
    flat = np.asarray(values, dtype=float).ravel()
    return (ctypes.c_double * len(flat))(*flat)
