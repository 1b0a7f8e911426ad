"""`make importers`: install every tool, run every FMU in it, write docs/importers.md."""

import argparse
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace

import importers
import numpy as np
from importers import BUILT, EQUAL, NOT_RUN, PASSED, READ, ROOT, Case, Tool, Verdict

import motionfmu
from motionfmu.base.platforms import PLATFORMS
from motionfmu.export import Choice, as_fmu, as_ssp

PAGE = ROOT / "docs" / "importers.md"
EXPORTED = ROOT / "build" / "export" / "fmus"
DEMO = "circle"
HERE = "x86_64-linux"
# Behind a verdict on an archive of this machine's build.
OF_GCC = ", of the FMU that gcc made for this machine; that of `make export` was not run"
ODD = 333_333e-9  # [s] a step that is no multiple of a tick of 25 ns


def listed() -> list[Case]:
    """All rows of the page; the SSP's does not know its names yet."""
    found = []
    for fmi in (2, 3):
        whole = BUILT / f"{DEMO}.all.fmi{fmi}.fmu"
        found += [
            Case(DEMO, fmi, whole),
            Case(f"{DEMO}, 1/3 ms", fmi, whole, size=ODD),
            Case("mcc, 1/3 ms", fmi, EXPORTED / f"mcc.fmi{fmi}.fmu", size=ODD),
        ]
        for file in sorted(ROOT.glob("fmus/*/fmu.toml")):
            name = file.parent.name
            found.append(Case(name, fmi, EXPORTED / f"{name}.fmi{fmi}.fmu"))
    return [*found, Case(f"{DEMO}.ssp", 2, BUILT / f"{DEMO}.ssp")]


def fmu_cases(names: Sequence[str], of_gcc: bool) -> dict[Case, np.ndarray]:
    """Some FMUs alone, as gcc or `make export` made them, and the rows that FMPy reads of gcc's."""
    wanted = [case for case in listed() if case.title in names]
    here = [replace(case, file=ROOT / "build/fmus" / case.file.name) for case in wanted]
    return dict(zip(here if of_gcc else wanted, importers.reference(here), strict=True))


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


SHORT = {EQUAL: "equal", PASSED: "good", READ: "read", NOT_RUN: NOT_RUN}
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
        why = importers.tool(folder).why(told.removesuffix(OF_GCC))
        text = f"{heads[folder].tool}: {told}" + (f". {why}." if why else "")
        if text not in reasons:
            reasons.append(text)
        said = next((SHORT[word] for word in (EQUAL, PASSED) if told.startswith(word)), "")
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
    some = sum(not r.good and r.verdict.startswith((EQUAL, PASSED)) for r in rows)
    left = sum(r.verdict == NOT_RUN for r in rows)
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
        "- **not run**: the FMU is newer than the latest run of this tool.",
        "- A number in brackets is a remark below its table. An empty cell is not for this tool.",
        f"- The platform is {HERE} where none is named. `fmu_bits` is the C program that "
        "[tests/ports](../tests/ports) runs under wine and qemu.",
        "",
        f"{len(rows)} cells: {good} equal, good or read, {some} equal or good with a remark, "
        f"{len(rows) - good - some - left} a reason alone, {left} not run.",
        "",
    ]
    return "\n".join([*head, *table(rows, 2), *table(rows, 3)]).rstrip("\n") + "\n"


def main(argv: Sequence[str] | None = None) -> int:
    """Do it all; 1 if a run differs or a tool that should run an FMU does not."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="*", help="folders of tools; others keep their cells")
    parser.add_argument("--fmus", nargs="*", help="FMUs alone; other rows keep their cells")
    parser.add_argument(
        "--gcc", action="store_true", help="of --fmus those of this machine's build, not the export"
    )
    given = parser.parse_args(argv)
    if given.gcc and not given.fmus:
        parser.error("--gcc wants --fmus")
    tools = [t for t in importers.tools() if not given.only or t.folder in given.only]
    tools = [t for t in tools if not given.gcc or t.platform == HERE]
    BUILT.mkdir(parents=True, exist_ok=True)
    set_up(tools)
    expected = fmu_cases(given.fmus, given.gcc) if given.fmus else cases()
    rows = []
    for tool in tools:
        for verdict in importers.verdicts(tool, expected):
            rows.append(verdict)
            print(verdict.line(), flush=True)
    mark = OF_GCC if given.gcc else ""
    told = [replace(r, verdict=r.verdict + mark) for r in rows]
    PAGE.write_text(page(merged(told, PAGE.read_text())))
    wrong = [r for r in rows if not r.good and not importers.tool(r.folder).why(r.verdict)]
    for r in wrong:
        print(f"{r.fmu} FMI {r.fmi} in {r.tool}: {r.verdict}", file=sys.stderr)
    return 1 if wrong else 0


def merged(rows: Sequence[Verdict], before: str) -> list[Verdict]:
    """These rows, and what a page from before has of tools and FMUs that were not run now."""
    found = {(r.fmu, r.fmi, r.folder): r for r in [*cells(before), *rows]}
    every = [(case, tool) for case in listed() for tool in importers.tools() if tool.can(case)]
    kept = [
        found.get((case.title, case.fmi, tool.folder)) or _verdict(case.title, case.fmi, tool)
        for case, tool in every
    ]
    return sorted(kept, key=lambda r: (r.tool.lower(), r.platform))


def _verdict(title: str, fmi: int, tool: Tool, told: str = NOT_RUN) -> Verdict:
    return Verdict(title, fmi, tool.name, tool.version, tool.platform, told, tool.folder)


def cells(text: str) -> Iterator[Verdict]:
    """What tools have told, as a page has it; of another version of a tool it has nothing."""
    by_head = {_head(_verdict("", 0, tool)): tool for tool in importers.tools()}
    titles = {shown: title for title, shown in SYSTEMS.items()}
    whole = {short: told for told, short in SHORT.items() if told != NOT_RUN}
    for fmi, part in re.findall(r"^## FMI (\d)\.0\n(.*?)(?=^## |\Z)", text, re.M | re.S):
        reasons = dict(re.findall(r"^(\d+)\. (.*)$", part, re.M))
        table = [line[2:-2].split(" | ") for line in part.splitlines() if line.startswith("| ")]
        for shown, *row in table[1:]:
            for head, cell in zip(table[0][1:], row, strict=True):
                tool, number = by_head.get(head), re.search(r"\[(\d+)\]", cell)
                told = _told(reasons[number[1]], tool) if number and tool else whole.get(cell)
                if tool and told:
                    yield _verdict(titles.get(shown, shown), int(fmi), tool, told)


def _told(reason: str, tool: Tool) -> str:
    """The verdict of which a reason below a table was made."""
    told = reason.removeprefix(f"{tool.name}: ")
    for why in tool.known.values():
        told = told.removesuffix(f". {why}.")
    return told


if __name__ == "__main__":
    sys.exit(main())
