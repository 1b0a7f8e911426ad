"""`make importers`: install every tool, run every FMU in it, write docs/importers.md."""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import replace

import importers
import numpy as np
from importers import BUILT, EQUAL, PASSED, READ, ROOT, Case, Tool, Verdict

import motionfmu
from motionfmu.base.platforms import PLATFORMS
from motionfmu.export import Choice, as_fmu, as_ssp

PAGE = ROOT / "docs" / "importers.md"
EXPORTED = ROOT / "build" / "export" / "fmus"
DEMO = "circle"
HERE = "x86_64-linux"
ODD = 333_333e-9  # [s] a step that is no multiple of a tick of 25 ns


def cases() -> dict[Case, np.ndarray]:
    """What all tools run, and the rows that FMPy reads of what gcc made for this machine."""
    demo = motionfmu.load(ROOT / "scenarios" / DEMO)
    wanted: list[tuple[Case, Case]] = []
    for case in importers.fmus(ROOT / "build" / "fmus"):
        wanted.append((replace(case, file=EXPORTED / case.file.name), case))
    for fmi in (2, 3):
        here, there = (BUILT / f"{DEMO}.{name}.fmi{fmi}.fmu" for name in ("here", "all"))
        as_fmu(demo, here, fmi, {})
        as_fmu(demo, there, fmi, {}, Choice(platforms=PLATFORMS))
        wanted.append((Case(DEMO, fmi, there), Case(DEMO, fmi, here)))
        odd = Case(f"{DEMO}, 1/3 ms", fmi, there, size=ODD)
        wanted.append((odd, replace(odd, file=here)))
        mcc = Case("mcc, 1/3 ms", fmi, EXPORTED / f"mcc.fmi{fmi}.fmu", size=ODD)
        wanted.append((mcc, replace(mcc, file=ROOT / f"build/fmus/mcc.fmi{fmi}.fmu")))
    found = importers.reference([own for _, own in wanted])
    made = {case: rows for (case, _), rows in zip(wanted, found, strict=True)}
    ssp = BUILT / f"{DEMO}.ssp"
    as_ssp(demo, ssp, 2, {})
    whole = next(c for c in made if (c.title, c.fmi) == (DEMO, 2))
    names = tuple(importers.job(whole, BUILT).names)
    step = demo.document.body.step
    return made | {Case(f"{DEMO}.ssp", 2, ssp, step, names): made[whole]}


def set_up(tools: Sequence[Tool]) -> None:
    """Install what is not installed; a tool that lacks a program ends it."""
    for tool in tools:
        if missing := tool.missing():
            sys.exit(f"importers: {tool.name} needs {missing}, which is not installed")
    for tool in tools:
        if not tool.installed():
            print(f"installing {tool.name} {tool.version}", flush=True)
            tool.set_up()


SHORT = {EQUAL: "equal", PASSED: "good", READ: "read"}
SYSTEMS = {
    DEMO: f"**{DEMO}**, one FMU",
    f"{DEMO}.ssp": f"**{DEMO}**, SSP 1.0",
    f"{DEMO}, 1/3 ms": f"**{DEMO}**, one FMU, steps of 1/3 ms",
    "mcc, 1/3 ms": "mcc, steps of 1/3 ms",
}


def table(rows: Sequence[Verdict], fmi: int) -> list[str]:
    """One version's part of the page."""
    found = {(r.fmu, r.folder): r for r in rows if r.fmi == fmi}
    heads = {r.folder: r for r in found.values()}
    order = sorted(heads, key=lambda f: (importers.tool(f).checks, heads[f].platform != HERE, f))
    reasons: list[str] = []

    def cell(fmu: str, folder: str) -> str:
        if (fmu, folder) not in found:
            return ""
        told = found[fmu, folder].verdict
        if told in SHORT:
            return SHORT[told]
        why = importers.tool(folder).why(told)
        text = f"{heads[folder].tool}: {told}" + (f". {why}." if why else "")
        if text not in reasons:
            reasons.append(text)
        said = SHORT[EQUAL] if told.startswith(EQUAL) else ""
        return f"{said}&nbsp;[{reasons.index(text) + 1}]".removeprefix("&nbsp;")

    lines = [
        f"## FMI {fmi}.0",
        "",
        "| FMU | " + " | ".join(map(_head, (heads[f] for f in order))) + " |",
        "|" + "---|" * (len(order) + 1),
    ]
    for fmu in sorted({fmu for fmu, _ in found}, key=lambda fmu: (fmu not in SYSTEMS, fmu)):
        cells = [cell(fmu, folder) for folder in order]
        lines.append(f"| {SYSTEMS.get(fmu, fmu)} | " + " | ".join(cells) + " |")
    lines.append("")
    lines += [f"{k}. {text}" for k, text in enumerate(reasons, 1)]
    return [*lines, ""] if reasons else lines


def _head(r: Verdict) -> str:
    platform = "" if r.platform == HERE else r.platform
    return "<br>".join(x for x in (r.tool, r.version, platform) if x)


def page(rows: Sequence[Verdict]) -> str:
    """The whole page."""
    good = sum(r.good for r in rows)
    some = sum(not r.good and r.verdict.startswith(EQUAL) for r in rows)
    head = [
        "# Other people's importers",
        "",
        "Made by `make importers` ([tests/importers](../tests/importers)). The FMUs are those of "
        f"`make export`; each runs {importers.STEPS} steps with its start values. So does the "
        f"demo, `scenarios/{DEMO}`, exported as one FMU and as an SSP; tests compare more of its "
        "steps with the project's own run. Alone, most FMUs stand still; "
        "[tests/ports](../tests/ports) drives their inputs. A step of 1/3 ms (333333 ns) is no "
        "multiple of a tick.",
        "",
        "- **equal**: every output at every step has the bits that FMPy reads of the library that "
        "gcc made for this machine.",
        "- **good**: the tool looks at archives, runs nothing, and has no complaint.",
        "- **read**: nothing here runs a Mac's libraries. Their bytes were read: symbols (those of "
        "the standard), install name (`@rpath/MODEL.dylib`), oldest system (11.0), what they load "
        "(libSystem) and ARM's ad-hoc signature.",
        "- A number in brackets is a remark below its table. An empty cell is not for this tool.",
        f"- The platform is {HERE} where none is named. `fmu_bits` is the C program that "
        "[tests/ports](../tests/ports) runs under wine and qemu.",
        "",
        f"{len(rows)} cells: {good} equal, good or read, {some} equal with a remark, "
        f"{len(rows) - good - some} a reason alone.",
        "",
    ]
    return "\n".join([*head, *table(rows, 2), *table(rows, 3)]).rstrip("\n") + "\n"


def main(argv: Sequence[str] | None = None) -> int:
    """Do it all; 1 if a run differs or a tool that should run an FMU does not."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="*", help="folders of tools; others keep their cells")
    given = parser.parse_args(argv)
    tools = [t for t in importers.tools() if not given.only or t.folder in given.only]
    BUILT.mkdir(parents=True, exist_ok=True)
    set_up(tools)
    expected = cases()
    rows = []
    for tool in tools:
        for verdict in importers.verdicts(tool, expected):
            rows.append(verdict)
            print(verdict.line(), flush=True)
    kept = merged(rows)
    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(page(kept))
    wrong = [r for r in rows if not r.good and not importers.tool(r.folder).why(r.verdict)]
    for r in wrong:
        print(f"{r.fmu} FMI {r.fmi} in {r.tool}: {r.verdict}", file=sys.stderr)
    return 1 if wrong else 0


def merged(rows: Sequence[Verdict]) -> list[Verdict]:
    """These rows, and what tools that were not run now have told before; kept in results.jsonl."""
    file = BUILT / "results.jsonl"
    before = file.read_text().splitlines() if file.is_file() else []
    now, there = {r.folder for r in rows}, {t.folder for t in importers.tools()}
    old = [r for line in before if (r := Verdict(**json.loads(line))).folder in there - now]
    found = sorted([*old, *rows], key=lambda r: (r.tool.lower(), r.platform))
    file.write_text("".join(r.line() + "\n" for r in found))
    return found


if __name__ == "__main__":
    sys.exit(main())
