"""LinuxCNC's example programs, which are not ours to hand on, by our reader.

python tests/gcode/linuxcnc_examples.py FOLDER

FOLDER is nc_files of github.com/LinuxCNC/linuxcnc. What is read otherwise than
linuxcnc_examples.toml has it is printed.
"""

import argparse
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from compare import mark

from motionfmu.analysis.gcode import read

FILE = Path(__file__).with_suffix(".toml")


def rows() -> dict[str, dict[str, Any]]:
    """What the reader makes of each program, by its name."""
    return dict(tomllib.loads(FILE.read_text(encoding="utf-8"))["program"])


def found(file: Path, angles: bool = False) -> dict[str, Any]:
    """The same of a file: commands, way [mm] and mark of them all, or the first fault."""
    program = read(file, max_feed=1e9, speed=1e9, angles=angles)
    if program.faults:
        first = program.faults[0]
        return {"line": first.line, "why": first.why}
    c = program.commands
    lasts = (c["type"] <= 6) | (c["type"] >= 13)
    return {"commands": len(c), "way": float(c["length"][lasts].sum()), "mark": mark(c)}


def same(one: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether two readings of a program agree."""
    if {"line", "commands"} & one.keys() != {"line", "commands"} & other.keys():
        return False
    if "line" in one:
        return (one["line"], one["why"]) == (other["line"], other["why"])
    pairs = [(one[k], other[k]) for k in ("commands", "way", "mark")]
    return all(np.isclose(a, b, rtol=1e-9, atol=1e-9) for a, b in pairs)


def main() -> int:
    """Compare each program of a folder with its row."""
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("folder", type=Path)
    folder, known = p.parse_args().folder, rows()
    files = {f.name: f for f in sorted(folder.glob("*.ngc"))}
    told = [f"{name}: no row" for name in files.keys() - known.keys()]
    told += [f"{name}: no file" for name in known.keys() - files.keys()]
    for name in files.keys() & known.keys():
        now = found(files[name], known[name].get("angles", False))
        if not same(now, known[name]):
            told.append(f"{name}: {now}")
    print("\n".join(sorted(told)) or f"{len(files)} programs, as in {FILE.name}")
    return bool(told)


if __name__ == "__main__":
    sys.exit(main())
