"""Cells of tutorials and notebooks, run in one namespace by a Python of one's choice."""

import base64
import io
import json
import resource
import subprocess
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.image import imread

# [s] of processor time that the cells of a page may take, with all processes that they start.
PAGE_MAX = 120.0
# Share of the points of a picture that may be others; a curve that is moved takes more.
POINTS = 1e-3
# Runs the cells and writes what each printed; what one has drawn and not closed is cell-N.png.
RUNNER = """
import contextlib, io, json, os, sys
os.environ["MPLBACKEND"] = "Agg"
found, space = [], {}
for number, text in enumerate(json.load(open("cells.json", encoding="utf-8"))):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(text, "<cell>", "exec"), space)
    found.append(out.getvalue())
    if "plt.show()" in text:
        space["plt"].gcf().savefig(f"cell-{number}.png")
        space["plt"].close("all")
json.dump(found, open("printed.json", "w", encoding="utf-8"))
"""


def cells_printed(
    cells: list[str],
    folder: Path,
    python: Path,
    environ: Mapping[str, str],
    limit: float = PAGE_MAX,
) -> list[str]:
    """What cells print in a new process that stands in a folder.

    Its processor time is limited [s], not the time that passes: other work makes no page slower.
    """
    (folder / "cells.json").write_text(json.dumps(cells), encoding="utf-8")
    line = [str(python), "-c", RUNNER]
    before = _of_children()
    done = subprocess.run(line, cwd=folder, env=dict(environ), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    used = _of_children() - before
    assert used <= limit, f"{used:.0f} s of processor time, {limit:g} at most"
    return json.loads((folder / "printed.json").read_text(encoding="utf-8"))


def _of_children() -> float:
    """Processor time of all processes that have been waited for [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def alike(made: Path, kept: Path | str) -> bool:
    """Whether a picture is a file's, or one in base64: hardly a point is another one."""
    shown = kept if isinstance(kept, Path) else io.BytesIO(base64.b64decode(kept))
    new, old = imread(made), imread(shown)
    return new.shape == old.shape and float(np.mean(np.abs(new - old) > 0.1)) < POINTS
