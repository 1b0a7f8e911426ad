"""What the commands that take a drawing ask of it, as options that mean the same everywhere."""

import re
from collections.abc import Callable
from typing import Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.drawings.drawing_options import CORNERS, ORDERS, DrawingOptions

Order = Annotated[
    str | None,
    typer.Option(
        help="Of a drawing's contours: file, nearest, or inside (what lies in one before it).",
        autocompletion=lambda: list(ORDERS),
    ),
]
Corners = Annotated[
    str | None,
    typer.Option(
        help="At a drawing's corners: round or stop.", autocompletion=lambda: list(CORNERS)
    ),
]
Pens = Annotated[
    list[int] | None, typer.Option("--pen", help="Of a drawing only what this pen draws.")
]
At = Annotated[
    tuple[float, float] | None,
    typer.Option(metavar="X Y", help="Place of a drawing's 0 [mm]."),
]
Larger = Annotated[float | None, typer.Option("--scale", help="A drawing larger by this factor.")]
Copies = Annotated[
    str | None, typer.Option(metavar="NXxNY", help="Copies of a drawing in X and Y: 3x2.")
]
Pitch = Annotated[
    tuple[float, float] | None,
    typer.Option(metavar="X Y", help="From copy to copy [mm]."),
]
Knife = Annotated[
    float | None, typer.Option(help="A drag knife's edge trails its axis by this [mm].")
]

Page = Annotated[int | None, typer.Option("--page", help="Of a drawing with several: 1, 2 ...")]

# What a number must be, and the same in words.
_RANGES: dict[str, tuple[Callable[[float], bool], str]] = {
    "scale": (lambda x: 0.0 < x <= 1e6, "above 0"),
    "knife": (lambda x: 0.0 <= x <= 100.0, "0 to 100 mm"),
    "page": (lambda n: n >= 1, "1 or more"),
}


def drawing_table(**given: Any) -> dict[str, Any]:
    """A table [drawing] of the options that are given, by the names of their parameters."""
    found = {name: value for name, value in given.items() if value not in (None, [])}
    for name, known in (("order", ORDERS), ("corners", CORNERS)):
        if name in found and found[name] not in known:
            wanted = f"{', '.join(known[:-1])} or {known[-1]}"
            raise InputError(f"--{name} {found[name]}: {wanted} wanted")
    for name, (good, wanted) in _RANGES.items():
        if name in found and not good(found[name]):
            raise InputError(f"--{name} {found[name]:g}: {wanted} wanted")
    if "copies" in found:
        found["copies"] = _copies(found["copies"], found.get("pitch"))
    elif "pitch" in found:
        raise InputError("--pitch: --copies is missing")
    return {name: list(v) if isinstance(v, tuple) else v for name, v in found.items()}


def _copies(text: str, pitch: tuple[float, float] | None) -> list[int]:
    m = re.fullmatch(r"(\d{1,4})[xX](\d{1,4})", text.strip())
    counts = [int(m[1]), int(m[2])] if m else [0, 0]
    if not all(1 <= n <= 1000 for n in counts):
        raise InputError(f"--copies {text}: NXxNY wanted, such as 3x2, each 1 to 1000")
    far = pitch or (0.0, 0.0)
    if any(n > 1 and p == 0.0 for n, p in zip(counts, far, strict=True)):
        raise InputError(f"--copies {text}: --pitch X Y is missing")
    return counts


def drawing_options(table: dict[str, Any]) -> DrawingOptions:
    """The options of a table."""
    given: dict[str, Any] = {k: v for k, v in table.items() if k != "at"}
    given |= {k: tuple(v) for k, v in table.items() if k in ("copies", "pitch")}
    given |= {"offset": tuple(table["at"])} if "at" in table else {}
    return DrawingOptions(**given)
