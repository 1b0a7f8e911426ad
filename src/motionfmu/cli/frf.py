"""What `motionfmu identify --frf` does: two masses from a frequency response."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.cli.common import FAILED, bare_table, out, report

if TYPE_CHECKING:
    from motionfmu.analysis.measured_response import FoundResponse
    from motionfmu.identify import IdentifyOptions
    from motionfmu.run import Scenario


@dataclass(frozen=True)
class ResponseAsked:
    """What the command line says of a response."""

    records: Sequence[Path]
    period: float | None
    band: str | None


def band_of(text: str | None) -> tuple[float | None, float | None]:
    """Read ``LOW:HIGH`` [Hz]; either may be missing."""
    if text is None:
        return None, None
    low, colon, high = text.partition(":")
    try:
        ends = tuple(float(x) if x.strip() else None for x in (low, high))
    except ValueError:
        ends = (None, None)
    sizes = [x for x in ends if x is not None]
    if (
        not colon
        or not sizes
        or not all(0.0 < x < 1e6 for x in sizes)
        or sizes != sorted(set(sizes))
    ):
        raise InputError(f"--band {text}: LOW:HIGH in Hz wanted, as 5:400")
    return ends[0], ends[1]


def identify_frf(
    scenario: "Scenario",
    asked: ResponseAsked,
    options: "IdentifyOptions",
    given: Mapping[str, Any],
    target: Path,
) -> None:
    """Find two masses, write the folder, tell; status 1 if the response tells nothing."""
    from motionfmu.analysis.measured_response import (
        EstimateOptions,
        ResponseOptions,
        identify_response,
    )
    from motionfmu.report import result_folder
    from motionfmu.report.loop_pages.response_page import (
        response_numbers,
        response_page,
        response_toml,
    )

    if options.free is not None or options.fix or options.laws is not None:
        raise InputError("--frf: free, fix and laws are of a record's motion, not of a response")
    if asked.period is not None and not 0.0 <= asked.period < 1e5:
        raise InputError(f"--period {asked.period:g}: seconds wanted; 0 for a record without one")
    how = EstimateOptions(asked.period, *band_of(asked.band))
    wanted = ResponseOptions(options.columns, options.axis, how)
    found = identify_response(scenario, list(asked.records), wanted, given)
    with result_folder.whole(target) as part:
        result_folder.write_result(part, response_page(found), response_numbers(found))
        (part / "found.toml").write_text(response_toml(found), encoding="utf-8")
    _tell(found)
    print(f"values: {target / 'found.toml'}")
    report(target / "report.html")
    if not found.settings:
        raise typer.Exit(FAILED)


def _tell(found: "FoundResponse") -> None:
    from motionfmu.report.loop_pages.response_page import words

    table = bare_table("quantity", "before", "found", "unit")
    for p in found.parameters:
        shown = f"{p.value:.6g} ± {p.deviation:.2g}" if p.told else f"cannot be told: {p.why}"
        table.add_row(p.name, f"{p.before:.6g}", shown, p.unit)
    out.print(table)
    out.print(f"{found.measured.way}, {len(found.measured.omega)} frequencies", markup=False)
    for text in (*words(found), *found.notes):
        out.print(text, markup=False, soft_wrap=True)
