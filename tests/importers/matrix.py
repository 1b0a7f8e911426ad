"""`make importers`: install every tool, run every FMU in it, write docs/importers.md."""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

import importers
from importers import BUILT, EQUAL, PASSED, ROOT, Tool, Verdict

import motionfmu
from motionfmu.export import as_fmu
from motionfmu.scenarios.fmus import fmu_names, fmu_path

PAGE = ROOT / "docs" / "importers.md"
DEMO = "circle"


def systems() -> list[Path]:
    """The demo's system as one FMU, of both versions."""
    found = []
    for fmi in (2, 3):
        found.append(BUILT / f"{DEMO}.fmi{fmi}.fmu")
        as_fmu(motionfmu.load(ROOT / "scenarios" / DEMO), found[-1], fmi, {})
    return found


def set_up(tools: Sequence[Tool]) -> None:
    """Install what is not installed; a tool that lacks a program ends it."""
    for tool in tools:
        if missing := tool.missing():
            sys.exit(f"importers: {tool.name} needs {missing}, which is not installed")
    for tool in tools:
        if not tool.installed():
            print(f"installing {tool.name} {tool.version}", flush=True)
            tool.set_up()


def table(rows: Sequence[Verdict], fmi: int) -> list[str]:
    """One version's part of the page."""
    found = [r for r in rows if r.fmi == fmi]
    heads = list(dict.fromkeys((r.tool, r.version, r.platform) for r in found))
    reasons: list[str] = []
    lines = [
        f"## FMI {fmi}.0",
        "",
        "| FMU | " + " | ".join(f"{t} {v}<br>{p}" for t, v, p in heads) + " |",
        "|" + "---|" * (len(heads) + 1),
    ]
    fmus = sorted({r.fmu for r in found}, key=lambda fmu: (fmu != DEMO, fmu))
    for fmu in fmus:
        cells = []
        for head in heads:
            told = next(
                (
                    r.verdict
                    for r in found
                    if r.fmu == fmu and (r.tool, r.version, r.platform) == head
                ),
                "not run",
            )
            if told not in (EQUAL, PASSED, "not run"):
                if told not in reasons:
                    reasons.append(told)
                told = f"[{reasons.index(told) + 1}]"
            cells.append(told)
        name = f"**{DEMO}** (whole system)" if fmu == DEMO else fmu
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    lines.append("")
    lines += [f"{k}. {text}" for k, text in enumerate(reasons, 1)]
    return [*lines, ""] if reasons else lines


def page(rows: Sequence[Verdict]) -> str:
    """The whole page."""
    good = sum(r.good for r in rows)
    head = [
        "# Other people's importers",
        "",
        "Made by `make importers` ([tests/importers](../tests/importers)). Each FMU runs "
        f"{importers.STEPS} steps with its start values; so does `motionfmu export "
        f"scenarios/{DEMO}`, of which tests compare more steps with the project's own run.",
        "",
        f"- **{EQUAL}**: every output at every step is what FMPy reads.",
        f"- **{PASSED}**: the tool checks archives and runs nothing.",
        "- A number in brackets is a reason below its table.",
        "",
        f"{good} of {len(rows)} cells are one of the first two.",
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
    fmus = [*systems(), *(fmu_path(name, fmi) for fmi in (2, 3) for name in fmu_names())]
    expected = importers.reference(fmus)
    rows = []
    for tool in tools:
        for verdict in importers.verdicts(tool, fmus, expected):
            rows.append(verdict)
            print(verdict.line(), flush=True)
    kept = merged(rows)
    PAGE.parent.mkdir(exist_ok=True)
    PAGE.write_text(page(kept))
    wrong = [r for r in rows if not r.good and not importers.tool(r.folder).knows(r.verdict)]
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
