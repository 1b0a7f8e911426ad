"""What was identified as files have it: found.toml and the numbers of result.json."""

import math
from typing import Any

import numpy as np

from motionfmu.identify.confidence_region import KEY, region_of
from motionfmu.identify.identification import Identified, Parameter
from motionfmu.identify.record_run import RecordRun


def value_text(p: Parameter) -> str:
    """A value with its standard deviation, in as many digits as it has."""
    if not p.told or not math.isfinite(p.deviation):
        return f"{p.value:.6g}"
    digits = max(0, 1 - math.floor(math.log10(p.deviation))) if p.deviation > 0.0 else 6
    if digits > 9:
        return f"{p.value:.6g} ± {p.deviation:.2g}"
    return f"{p.value:.{digits}f} ± {p.deviation:.2g}"


def found_toml(found: Identified) -> str:
    """Text of a file for ``--set``, and for the [set] of a machine."""
    lines = [f"# Axis {found.axis} of {found.scenario.name}, identified from {found.record.name}."]
    lines += [f"# {note}" for note in found.notes]
    for p in found.parameters:
        if p.told:
            lines.append(f"# {p.name}: {value_text(p)} {p.unit}")
        else:
            lines.append(f"# {p.name}: left as it is, the record cannot tell it: {p.why}")
    for name, value in found.settings.items():
        shown = str(value).lower() if isinstance(value, bool) else repr(value)
        lines.append(f'"{name}" = {shown}')
    return "\n".join(lines) + "\n"


def found_numbers(found: Identified, run: RecordRun | None) -> dict[str, Any]:
    """All numbers, as result.json has them."""

    def plain(x: float) -> float | None:
        return float(x) if math.isfinite(x) else None

    check, known, chosen = found.check, found.spread, found.chosen
    region = region_of(found)
    return {
        "scenario": found.scenario.name,
        "axis": found.axis,
        "record": found.record.name,
        "samples": len(found.time),
        "laws": list(found.laws),
        "parameters": {
            p.name: {
                "value": p.value,
                "deviation": plain(p.deviation),
                "before": p.before,
                "unit": p.unit,
                "told": p.told,
                "why": p.why,
            }
            for p in found.parameters
        },
        "settings": dict(found.settings),
        "free": list(found.free),
        "correlation": [] if known is None else np.round(known.correlation, 6).tolist(),
        "condition": None if known is None else plain(known.condition),
        KEY: None if region is None else region.numbers(),
        "correlated_samples": None if known is None else known.lag,
        "controller": None
        if check is None
        else {
            "signal": check.signal,
            "lag_steps": check.lag,
            "difference": check.difference,
            "fitted": check.fitted,
            "gains": {n: list(two) for n, two in check.gains.items()},
            "taken": check.taken,
        },
        "tried": [
            {
                "laws": list(v.laws),
                "other": dict(v.other),
                "fitted": dict(v.fitted),
                "kept_back": dict(v.kept),
                "score": v.score,
                "chosen": v is chosen,
            }
            for v in found.tried
        ],
        "residuals": dict(found.residuals),
        "run": None
        if run is None
        else {
            "from": run.settled,
            "differences": dict(run.differences),
            "largest": dict(run.largest),
        },
        "notes": list(found.notes),
    }
