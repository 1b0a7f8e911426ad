"""Where the instructions of a step go, by callgrind: `make bench BENCH=--profile`.

Of each system a longer and a shorter run of the fused engine are counted instruction by
instruction, and subtracted. A part has what its step takes with all that it calls. What of the
program's own text belongs to wires and recorder tell the lines of its source, for which it is
compiled with them (`-g`, the same instructions).
"""

import json
import re
import shlex
import subprocess
import sys
import tempfile
from bisect import bisect
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import commands
import counting

from motionfmu.base import compiler

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_name("profiles.json")
# Scenario, and steps of the two runs.
SYSTEMS: dict[str, tuple[Path, Sequence[int]]] = {
    "demo": (commands.DEMO, counting.STEPS),
    "six axes": (Path(__file__).parent / "six_axes", counting.STEPS),
    "robot_line": (ROOT / "scenarios/robot_line", (20_000, 30_000)),
    "network card": (ROOT / "scenarios/plt_plate", counting.STEPS),
}
FIRST = 10  # functions
AT_ONCE = 2
WIRES, RECORDER, LOOP = "wires", "recorder", "loop around them"
# Functions of fmi_system.inc and of a program's text, in lines of which these two stand.
OF_WIRES = {"system_carry", "system_spans"}
OF_RECORDER = re.compile(r"recorder_|system_keep$|system_record$")
_CALLGRIND = (
    "valgrind",
    "--tool=callgrind",
    "--instr-atstart=no",
    "--dump-instr=yes",
    "--compress-pos=no",
    "--compress-strings=no",
)


Instructions = Counter[Any]  # by where they stand


@dataclass
class Counts:
    """What callgrind has counted."""

    own: Instructions = field(default_factory=Counter)  # of file, function, address
    # Of calls, with all that is called: file and address of the call, file and address called.
    calls: Instructions = field(default_factory=Counter)

    def less(self, other: "Counts", steps: float) -> "Counts":
        """What a shorter run leaves of this one for each of the steps between them."""

        def each(mine: Instructions, its: Instructions) -> Instructions:
            return Counter({key: (n - its[key]) / steps for key, n in mine.items()})

        return Counts(each(self.own, other.own), each(self.calls, other.calls))


def read(lines: Iterable[str]) -> Counts:
    """A file of callgrind whose positions and names are written out."""
    found = Counts()
    place = function = called = ""
    target: int | None = None
    for line in lines:
        key, sign, value = line.rstrip("\n").partition("=")
        if line.startswith("0x"):
            address, _, cost = line.split()
            if target is None:
                found.own[place, function, int(address, 16)] += int(cost)
            else:
                found.calls[place, int(address, 16), called or place, target] += int(cost)
                target, called = None, ""
        elif sign and key == "ob":
            place = value
        elif sign and key == "fn":
            function = value
        elif sign and key == "cob":
            called = value
        elif sign and key == "calls":
            target = int(value.split()[1], 16)
    return found


class Program:
    """A fused program's file: which addresses are of which part, and which lines they stand in."""

    def __init__(self, file: Path) -> None:
        self.file = file
        told = _told("readelf", "-sW", file)
        groups, group, structs = [], 0, []
        for row in (line.split() for line in told.splitlines()):
            if len(row) < 7 or not row[1].strip("0123456789abcdef") == "":
                continue
            group += row[3] == "FILE"
            name = row[7] if len(row) > 7 else ""
            if row[3] == "FUNC" and row[4] == "LOCAL":
                groups.append((int(row[1], 16), group))
            elif row[3] == "OBJECT" and name.startswith("motionfmu_part_"):
                at = int(row[1], 16)
                structs.append((at, at + int(row[2]), name.removeprefix("motionfmu_part_")))
        self._starts = sorted(groups)
        self.part: dict[int, str] = {}  # of the functions that a part shows
        for row in (line.split() for line in _told("readelf", "-rW", file).splitlines()):
            if len(row) == 4 and row[2] == "R_X86_64_RELATIVE":
                at = int(row[0], 16)
                for begin, end, name in structs:
                    if begin <= at < end:
                        self.part[int(row[3], 16)] = name
        shown = {self._group(at): name for at, name in self.part.items()}
        self._names = shown

    def _group(self, address: int) -> int:
        return self._starts[bisect(self._starts, (address, sys.maxsize)) - 1][1]

    def of(self, address: int) -> str:
        """The part in which an address stands; empty for the program's own text."""
        return self._names.get(self._group(address), "")

    def roles(self, addresses: Sequence[int]) -> dict[int, str]:
        """Wires, recorder or loop: by the functions in whose lines an address stands."""
        text = "\n".join(map(hex, addresses))
        line = ["addr2line", "-e", str(self.file), "-f", "-i", "-a"]
        told = subprocess.run(line, input=text, capture_output=True, text=True, check=True).stdout
        found: dict[int, str] = {}
        for block in re.split(r"^(?=0x)", told, flags=re.MULTILINE)[1:]:
            address, *rows = block.splitlines()
            names = rows[::2]
            role = LOOP
            if any(OF_RECORDER.match(name) for name in names):
                role = RECORDER
            elif OF_WIRES & set(names):
                role = WIRES
            found[int(address, 16)] = role
        return found


def _told(*line: str | Path) -> str:
    return subprocess.run(line, capture_output=True, text=True, check=True).stdout


def parts(counts: Counts, program: Program) -> Instructions:
    """Instructions of a step by part, those of the program's own text by what they are for.

    What Python does around the program is not among them.
    """
    name = str(program.file)
    own = [(at, n) for (file, _, at), n in counts.own.items() if file == name]
    mine = [(at, n) for at, n in own if not program.of(at)]
    out = [c for c in counts.calls.items() if c[0][0] == name and not program.of(c[0][1])]
    roles = program.roles([*(at for at, _ in mine), *(c[0][1] for c in out)])
    found: Instructions = Counter()
    for at, n in mine:
        found[roles[at]] += n
    for (_, at, file, target), n in out:
        if file == name and program.of(target):
            found[program.part[target]] += n
        elif file != name:
            found[roles[at]] += n
    return Counter({what: found[what] for what in [*program.part.values(), WIRES, RECORDER, LOOP]})


def functions(counts: Counts, program: Program) -> Iterator[tuple[str, float]]:
    """The first functions by their own instructions of a step, with their part or library."""
    found: Instructions = Counter()
    for (file, function, at), n in counts.own.items():
        if file == str(program.file):
            of = program.of(at) or "the program"
        else:
            of = Path(file).name.partition(".so")[0]
        found[f"{of}: {re.sub(r'[.](constprop|part|isra|lto_priv).*', '', function)}"] += n
    yield from found.most_common(FIRST)


def _counted(scenario: Path, steps: int, folder: Path) -> tuple[Counts, float]:
    """What was counted, and of which share of the run."""
    out = folder / str(steps)
    line = [*_CALLGRIND, f"--callgrind-out-file={out}", *counting.of_run(scenario, "fused")]
    found = compiler.compiler()
    assert found is not None, "the benchmark has built the FMUs"
    more = {"CC": f"{shlex.join(found.command)} -g", "COUNT_HERE": str(counting.MARKS)}
    told = subprocess.run(
        [str(a).format(steps) for a in line],
        check=True,
        env=commands.environment() | more,
        capture_output=True,
        text=True,
    ).stderr
    with out.open() as file:
        return read(file), counting.share(told)


def profile(name: str) -> dict[str, Any]:
    """Instructions of a step of a system: all, by part, and its first functions."""
    scenario, steps = SYSTEMS[name]
    with tempfile.TemporaryDirectory(prefix="motionfmu-") as folder:
        (short, seen), (long, same) = (_counted(scenario, n, Path(folder)) for n in steps)
    assert seen == same, "both report progress equally often"
    counts = long.less(short, seen * (steps[1] - steps[0]))
    (file,) = {f for f, *_ in counts.own if Path(f).name == "System.so"}
    program = Program(Path(file))
    found = parts(counts, program)
    return {
        "steps": list(steps),
        "instructions": round(sum(found.values())),
        "parts": {part: round(n) for part, n in found.items()},
        "functions": {what: round(n) for what, n in functions(counts, program)},
    }


def tables(found: dict[str, Any]) -> str:
    """The two tables of README.md."""
    rows = ["| of a step | " + " | ".join(found) + " |", "|---|" + "---|" * len(found)]
    named = list(dict.fromkeys(p for f in found.values() for p in f["parts"]))
    named.sort(key=[WIRES, RECORDER, LOOP].count)
    for part in named:
        cells = [f"{f['parts'][part]:,}" if part in f["parts"] else "" for f in found.values()]
        rows.append(f"| {part} | " + " | ".join(cells) + " |")
    whole = " | ".join(f"{f['instructions']:,}" for f in found.values())
    rows += [f"| all | {whole} |", "", rows[0].replace("of a step", "first functions"), rows[1]]
    for k in range(FIRST):
        each = [[*f["functions"].items()][k] for f in found.values()]
        rows.append(f"| {k + 1} | " + " | ".join(f"`{what}` {n:,}" for what, n in each) + " |")
    return "\n".join(rows) + "\n"


def show(before: dict[str, Any], after: dict[str, Any]) -> None:
    """Print the profiles beside those that were kept."""
    for name, now in after.items():
        last = before.get(name, {})
        print(f"\n{f'{name}, instructions a step':52}{'before':>10}{'after':>10}")
        for kind in ("parts", "functions"):
            for what, n in now[kind].items():
                told = last.get(kind, {}).get(what, "-")
                print(f"  {what:50}{told:>10}{n:10}")
            if kind == "parts":
                print(f"  {'all':50}{last.get('instructions', '-'):>10}{now['instructions']:10}")
                print(" first functions, without what they call")


def main() -> None:
    """Count all systems, print them and keep them."""
    before = json.loads(KEPT.read_text()) if KEPT.exists() else {}
    with ThreadPoolExecutor(AT_ONCE) as pool:
        after = dict(zip(SYSTEMS, pool.map(profile, SYSTEMS), strict=True))
    show(before, after)
    KEPT.write_text(json.dumps(after, indent=1) + "\n")
