"""Other people's tools beside ours: `make bench BENCH=--peers`.

Each row computes the same thing twice, by a tool and by this project, and stops the benchmark if
the results differ. What is not installed is named and left out; `--install` installs importers as
`make importers` does. `--renew` keeps the table in peers.json.
"""

import importlib
import json
import platform
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from datetime import date
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import Progress

KEPT = Path(__file__).with_name("peers.json")
ROUNDS = 5
# Modules with a class `Rows`: a call of it is a round, `rows` gives what was found.
PARTS = ("peer_importers", "peer_shapes", "peer_arm", "peer_loops")
HEAD = "| what | unit | tool | ours | theirs | theirs over ours | rounds |"


@dataclass(frozen=True)
class Row:
    """What a tool and ours took for the same."""

    what: str
    unit: str
    tool: str
    ours: float
    theirs: float
    rounds: int  # each figure is the median of so many; 1 if it is the same every time

    @property
    def ratio(self) -> float:
        """Theirs over ours."""
        return self.theirs / self.ours

    def cells(self) -> list[str]:
        """As the table has it."""
        figures = [short(x) for x in (self.ours, self.theirs, self.ratio)]
        return [self.what, self.unit, self.tool, *figures, str(self.rounds)]


def short(value: float) -> str:
    """A figure with three digits."""
    return f"{float(f'{value:.3g}'):,.0f}" if value >= 100 else f"{value:.3g}"


def agree(what: str, same: bool, told: str) -> None:
    """Stop the benchmark if a tool has found something else."""
    if not same:
        sys.exit(f"bench: {what}: the results differ: {told}")


def table(rows: Iterable[Row]) -> str:
    """The rows in Markdown."""
    lines = [HEAD, "|---|---|---|---|---|---|---|"]
    return "\n".join([*lines, *(f"| {' | '.join(row.cells())} |" for row in rows)]) + "\n"


def kept() -> tuple[dict[str, Any], list[Row]]:
    """What was kept: when and where, and the rows."""
    read = json.loads(KEPT.read_text(encoding="utf-8"))
    return read, [Row(**row) for row in read.pop("rows")]


def measured() -> tuple[list[Row], list[str]]:
    """Let all take turns; the rows, and what is left out."""
    parts, missing = [], []
    for name in PARTS:
        try:
            parts.append(importlib.import_module(name).Rows())
        except ModuleNotFoundError as error:
            missing.append(f"{error.name} is not installed")
    with Progress(transient=True, console=Console(stderr=True)) as progress:
        task = progress.add_task("peers", total=ROUNDS * len(parts))
        for _ in range(ROUNDS):
            for part in parts:
                part()
                progress.advance(task)
    missing += [text for part in parts for text in part.missing]
    return [row for part in parts for row in part.rows()], missing


def main(renew: bool) -> None:
    """Print the table; keep it if asked."""
    rows, missing = measured()
    print(table(rows))
    for text in missing:
        print(f"left out: {text}")
    if renew:
        about = {"day": date.today().isoformat(), "machine": platform.machine()}
        numbers = ("ours", "theirs")
        found = [
            {k: float(f"{v:.4g}") if k in numbers else v for k, v in asdict(row).items()}
            for row in rows
        ]
        text = json.dumps(about | {"rows": found}, indent=1, ensure_ascii=False)
        KEPT.write_text(text + "\n", encoding="utf-8")
