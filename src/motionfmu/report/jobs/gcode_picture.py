"""The picture of a part program's path."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure

from motionfmu.analysis.gcode import Stroke
from motionfmu.report.jobs.gcode_page import NAMES, colors, is_space
from motionfmu.report.pictures import PLAIN, STABLE
from motionfmu.report.style import GRID, MUTED, RAPID

PICTURES = ("path.png", "path.svg")


def write_picture(name: str, drawn: Sequence[Stroke], folder: Path) -> None:
    """Draw the path by tool, as `PICTURES`."""
    space = bool(drawn) and is_space(drawn)
    with matplotlib.rc_context(PLAIN | STABLE):
        shown = Figure(figsize=(9.0, 7.5), layout="constrained")
        axes: Any = shown.add_subplot(projection="3d" if space else None)
        width = 3 if space else 2
        told: set[str] = set()
        shades = colors(drawn)
        for s in drawn:
            label = "rapid" if s.rapid else f"T{s.tool}" if s.tool else "feed"
            look: dict[str, Any] = (
                {"color": RAPID, "lw": 0.9, "ls": (0, (3, 3)), "zorder": 1}
                if s.rapid
                else {"color": shades[s.tool], "lw": 1.4, "zorder": 3}
            )
            axes.plot(*s.points.T[:width], label="" if label in told else label, **look)
            told.add(label)
        for letter, title in zip("xyz", NAMES[:width], strict=False):
            getattr(axes, f"set_{letter}label")(f"{title} [mm]")
        if space:
            axes.computed_zorder = False
            axes.set_aspect("equal")
        else:
            axes.set_aspect("equal", adjustable="datalim")
            axes.grid(color=GRID, lw=0.8)
            axes.set_axisbelow(True)
            for side in axes.spines.values():
                side.set_visible(False)
            axes.tick_params(length=0)
        axes.set_title(name, loc="left", fontsize=14, fontweight="bold")
        if told:
            axes.legend(loc="upper right", frameon=False, fontsize=10, labelcolor=MUTED)
        for file in PICTURES:
            plain = {"Date": None} if file.endswith("svg") else None
            shown.savefig(folder / file, dpi=160, metadata=plain)
