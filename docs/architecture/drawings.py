"""Write the drawings of the architecture's pages, from what the tree says of itself.

    .venv/bin/python docs/architecture/drawings.py

Arrows between C files of `parts.svg` are their `#include` lines and `storey.toml`. The order in
`python-package.svg` is the table of the package's README. Other arrows, and what `step.svg` names,
are written here; `tests/house/test_architecture.py` holds them against the tree.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from html import escape
from pathlib import Path

from motionfmu.fmu import cores

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
INK, LINE, PALE, WAY = "#1a1a1a", "#5a6472", "#eef2f7", "#cfe3f7"
BOX = 46  # height of a box with two lines
Edges = dict[str, set[str]]

# Where each part is drawn, in rows from the top: its centre, and what it is. Its name is its
# folder's; of fmus/ there are two kinds.
PARTS: tuple[dict[str, tuple[int, str]], ...] = (
    {"src/motionfmu": (380, "the Python package")},
    {
        "src/python": (130, "C without FMUs, for Python"),
        "scenarios": (450, "FMUs, wires, values, checks"),
    },
    {"fmus: model.c": (330, "controllers, cards, drives"), "fmus: Modelica": (620, "plants")},
    {"src/plant": (535, "equations over time"), "modelica": (683, "a class a file")},
    {"src/controllers": (200, "software as built"), "src/fmi": (500, "FMI 2.0 and 3.0, once")},
    {
        "src/net": (100, "jobs of network cards"),
        "src/language": (320, "part programs, robot jobs"),
        "src/devices": (580, "hardware as built"),
    },
    {"src/motion": (220, "paths, trajectories")},
    {"src/base": (380, "functions, pulses, links, tasks")},
)

# Who uses whom beside what C files include.
BESIDE: Edges = {
    "src/motionfmu": {"scenarios", "src/python"},
    "scenarios": {"fmus: model.c", "fmus: Modelica"},
    "fmus: Modelica": {"modelica", "src/plant"},
}

# How a scenario becomes a run and its report, and a study the same: a file, then parts of the
# package and what each makes of it.
WAYS: tuple[tuple[str, tuple[tuple[str, str], ...]], ...] = (
    (
        "scenario.toml",
        (
            ("scenarios", "Document, System"),
            ("fused", "one FMU, compiled"),
            ("run", "Result"),
            ("report", "pages, pictures"),
        ),
    ),
    (
        "sweep.toml",
        (
            ("study", "points, workers"),
            ("run", "a Result each"),
            ("sweep", "Outcome"),
            ("report", "pages, pictures"),
        ),
    ),
)

# A communication step in its order: what is done, a name of the code, the file that has it.
STEP: tuple[tuple[str, str, str], ...] = (
    ("values of [drive] that are due", "due", "src/motionfmu/scenarios/system.py"),
    ("all outputs read, all inputs set", "_exchange", "src/motionfmu/run/engines/reference.py"),
    ("a signal that ends the run?", "Ending", "src/motionfmu/run/engines/ending.py"),
    ("row k of the record", "recorder_row", "src/fmi/fmu_recorder.h"),
    ("each FMU steps from t to t + H", "fmi_advance", "src/fmi/fmi_step.inc"),
)
# What an FMU's step is made of, the outer above the inner.
INSIDE: tuple[tuple[str, str, str], ...] = (
    ("to the tick that is nearest", "fmi_plan", "src/fmi/fmi_step.inc"),
    ("the model, inputs held", "model_step", "src/fmi/fmi_model.h"),
    ("a sampled block: its tick", "ploop_tick", "src/devices/epcio/ploop.h"),
    ("or cyclic tasks on a processor", "cyclic_next", "src/base/tasks/cyclic.h"),
    ("or tasks of a real-time kernel", "kernel_next", "src/base/tasks/kernel.h"),
)
# What becomes of the rows.
AFTER: tuple[tuple[str, str, str], ...] = (
    ("signals over time", "Columns", "src/motionfmu/base/columns.py"),
    ("the run, judged", "Result", "src/motionfmu/run/result.py"),
    ("laid beside measured ones", "Record", "src/motionfmu/records/signal_record.py"),
)


class Drawing:
    """An SVG in the making."""

    def __init__(self, width: int, height: int, title: str) -> None:
        self.rows = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
            f'width="{width}" height="{height}" font-family="sans-serif" font-size="13" '
            f'fill="{INK}" role="img" aria-label="{escape(title)}">',
            f"<title>{escape(title)}</title>",
            '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" '
            f'markerHeight="8" orient="auto"><path d="M0 0L8 4L0 8z" fill="{LINE}"/></marker>'
            "</defs>",
            f'<rect width="{width}" height="{height}" fill="#fff"/>',
        ]

    def box(self, x: float, y: float, width: float, height: float, fill: str = PALE) -> None:
        """A box whose upper left corner is given."""
        self.rows.append(
            f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="5" '
            f'fill="{fill}" stroke="{LINE}"/>'
        )

    def text(self, x: float, y: float, words: str, kind: str = "", at: str = "middle") -> None:
        """Words; those of kind name are names of the tree."""
        style = {
            "": "",
            "name": ' font-weight="bold"',
            "small": ' font-size="12"',
            "smaller": ' font-size="10"',
        }
        self.rows.append(
            f'<text x="{x:g}" y="{y:g}" text-anchor="{at}"{style[kind]}>{escape(words)}</text>'
        )

    def labelled(
        self,
        x: float,
        y: float,
        width: float,
        lines: tuple[tuple[str, str], tuple[str, str]],
        fill: str = PALE,
    ) -> None:
        """A box with two lines of words in its middle, and the kind of each."""
        self.box(x, y, width, BOX, fill)
        for down, (words, kind) in zip((19, 37), lines, strict=True):
            self.text(x + width / 2, y + down, words, kind)

    def arrow(self, x: float, y: float, to_x: float, to_y: float, dashed: bool = False) -> None:
        """An arrow from one point to another."""
        dash = ' stroke-dasharray="4 3"' if dashed else ""
        self.rows.append(
            f'<path d="M{x:g} {y:g}L{to_x:g} {to_y:g}" stroke="{LINE}" stroke-width="1.3" '
            f'fill="none" marker-end="url(#tip)"{dash}/>'
        )

    def line(self, x: float, y: float, to_x: float, to_y: float) -> None:
        """A plain line."""
        self.rows.append(f'<path d="M{x:g} {y:g}L{to_x:g} {to_y:g}" stroke="{LINE}"/>')

    def svg(self) -> str:
        """The whole text."""
        return "\n".join([*self.rows, "</svg>"]) + "\n"


def _homes() -> dict[str, str]:
    """The part that each header belongs to."""
    source = ROOT / "src"
    files = [
        (f, f"src/{c.parent.name}") for c in cores.folders(source).values() for f in c.iterdir()
    ]
    files += [(f, f"src/{name}") for name in ("fmi", "plant") for f in (source / name).iterdir()]
    return {f.name: home for f, home in files if f.suffix in (".h", ".inc")}


def _included(files: Iterable[Path], homes: Mapping[str, str]) -> set[str]:
    """The parts whose headers some files include."""
    code = (f for f in files if f.suffix in (".c", ".h", ".inc"))
    return {homes[name] for f in code for name in cores.included(f) if name in homes}


def uses() -> Edges:
    """Which part uses which, directly or not at all."""
    homes = _homes()
    found: Edges = {part: set(BESIDE.get(part, ())) for row in PARTS for part in row}
    for name in ("fmi", "plant", "python"):
        found[f"src/{name}"] |= _included((ROOT / "src" / name).iterdir(), homes)
    found["fmus: model.c"] |= _included(ROOT.glob("fmus/*/*"), homes)
    for storey in (ROOT / "src").glob("*/storey.toml"):
        found[f"src/{storey.parent.name}"] |= {f"src/{n}" for n in cores.stands_on(storey.parent)}
    return {part: used - {part} for part, used in found.items()}


def _below(part: str, found: Edges) -> set[str]:
    """All that a part leads to."""
    return found[part].union(*(_below(used, found) for used in found[part]))


def drawn(found: Edges) -> Iterator[tuple[str, str]]:
    """Arrows without those that others make up: from a part to one that no way leads through."""
    for part, used in found.items():
        through = set().union(*(_below(u, found) for u in used)) if used else set()
        yield from ((part, u) for u in sorted(used - through))


def parts() -> str:
    """Who uses whom, all arrows downward."""
    made = Drawing(760, 590, "Parts of the project, each above all that it uses")
    width, pitch = 190, 73
    place = {
        part: (x, 12 + pitch * k) for k, row in enumerate(PARTS) for part, (x, _) in row.items()
    }
    for part, used in drawn(uses()):
        (x, y), (to_x, to_y) = place[part], place[used]
        assert to_y > y, f"{part} -> {used}: an arrow points up"
        lean = max(-70.0, min(70.0, (to_x - x) * 0.3))
        made.arrow(x + lean, y + BOX, to_x - lean, to_y - 1)
    for row in PARTS:
        for part, (_, words) in row.items():
            x, y = place[part]
            room = 140 if part in ("modelica", "src/plant") else width
            made.labelled(x - room / 2, y, room, ((part, "name"), (words, "small")))
    return made.svg()


def table() -> list[tuple[list[str], str]]:
    """Places of the package in their order, and what each makes, by its README."""
    readme = (ROOT / "src/motionfmu/README.md").read_text(encoding="utf-8")
    rows = re.search(r"## The way of the data\n[^|]*((?:\|.*\n)+)", readme)
    assert rows
    cells = [row.split("|")[1:4] for row in rows[1].splitlines()[2:]]
    return [(re.findall(r"`(\w+(?:/\w+)?)/?`", place), makes) for place, _, makes in cells]


def package() -> str:
    """The order of the package's parts, and the ways of a run and of a study through them."""
    order = [name for names, _ in table() for name in names]
    columns, on_the_way = 4, {part for _, steps in WAYS for part, _ in steps}
    rows = -(-len(order) // columns)
    made = Drawing(760, 190 + 24 * rows, "Parts of the package in their order, and a run's way")
    for lane, (file, steps) in enumerate(WAYS):
        y = 12 + 68 * lane
        made.text(58, y + 27, file, "name")
        for k, (part, thing) in enumerate(steps):
            x = 130 + 160 * k
            made.arrow(x - 30 if k else x - 15, y + 23, x - 2, y + 23)
            made.labelled(x, y, 130, ((f"{part}/", "name"), (thing, "small")), WAY)
    made.text(12, 164, "A part imports only what stands before it:", at="start")
    for k, name in enumerate(order):
        x, y = 12 + 186 * (k // rows), 176 + 24 * (k % rows)
        made.box(x, y, 178, 20, WAY if name in on_the_way else PALE)
        made.text(x + 20, y + 14.5, f"{k + 1}", "small", at="end")
        made.text(x + 26, y + 14.5, name, "smaller", at="start")
    return made.svg()


def step() -> str:
    """One communication step: what is done in which order, and when blocks read and show."""
    made = Drawing(760, 662, "One communication step from t to t + H")
    _column(made, 40, "An engine at t = k H", STEP, range(1, len(STEP)))
    made.rows.append(
        f'<path d="M40 307H18V59H39" stroke="{LINE}" fill="none" marker-end="url(#tip)"/>'
    )
    _column(made, 420, "Within an FMU's step", INSIDE, (1, 2))
    made.arrow(340, 307, 419, 60, dashed=True)
    made.text(12, 372, "What becomes of the rows", at="start")
    for k, (words, name, _) in enumerate(AFTER):
        x = 12 + 255 * k
        made.labelled(x, 382, 220, ((name, "name"), (words, "small")))
        if k:
            made.arrow(x - 34, 405, x - 2, 405)
    _times(made, 470)
    return made.svg()


def _column(
    made: Drawing,
    x: float,
    title: str,
    steps: tuple[tuple[str, str, str], ...],
    reached: Iterable[int],
) -> None:
    """Steps one below the other; those reached have an arrow from the one above."""
    made.text(x + 150, 24, title)
    for k, (words, name, _) in enumerate(steps):
        made.labelled(x, 36 + 62 * k, 300, ((words, ""), (name, "name")))
        if k in reached:
            made.arrow(x + 150, 20 + 62 * k, x + 150, 35 + 62 * k)


def _times(made: Drawing, top: float) -> None:
    """Instants of wires, of a block whose period is two steps, and of a plant's micro steps."""
    made.text(
        12,
        top,
        "When a block and a plant read (down) and show (up); here T = 2 H, h = H / 2",
        at="start",
    )
    begin, width = 180, 130
    lanes = (("wires and rows, H", 1.0), ("sampled block, T", 2.0), ("plant, h", 0.5))
    for lane, (name, period) in enumerate(lanes):
        y = top + 46 + 52 * lane
        made.text(12, y + 5, name, at="start")
        made.line(begin, y, begin + 4 * width, y)
        for k in range(int(4 / period) + 1):
            x = begin + k * period * width
            if not lane:
                made.line(x, y - 12, x, y)
                continue
            made.arrow(x - 4, y - 20, x - 4, y - 1)
            if k:
                made.arrow(x + 4, y - 1, x + 4, y - 20)
    for k in range(5):
        made.text(begin + k * width, top + 178, f"t + {k} H" if k else "t", "small")


DRAWINGS = {"parts": parts, "python-package": package, "step": step}


def main() -> None:
    """Write every drawing."""
    for name, make in DRAWINGS.items():
        (HERE / f"{name}.svg").write_text(make(), encoding="utf-8")
        print(name)


if __name__ == "__main__":
    main()
