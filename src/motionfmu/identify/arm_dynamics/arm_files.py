"""What was found of an arm as files have it: found.toml and the numbers of result.json."""

import math
from typing import Any

import numpy as np

from motionfmu.identify.arm_dynamics.arm_identification import ArmQuantity, IdentifiedArm
from motionfmu.identify.arm_dynamics.arm_run import HeldArm
from motionfmu.identify.arm_dynamics.gear_windup import GearFound


def with_deviation(value: float, deviation: float) -> str:
    """A value with its standard deviation, in as many digits as it has."""
    if not math.isfinite(deviation) or deviation <= 0.0:
        return f"{value:.6g}"
    if 1e-4 <= abs(value) < 1e7:
        digits = max(0, 1 - math.floor(math.log10(deviation)))
        if digits <= 9:
            return f"{value:.{digits}f} ± {deviation:.{digits}f}"
    return f"{value:.4g} ± {deviation:.2g}"


def law_names(found: IdentifiedArm) -> dict[str, list[int]]:
    """Joints, from 1, by the laws that were taken of them."""
    names: dict[str, list[int]] = {}
    for law, joint in found.chosen.laws:
        names.setdefault(law, []).append(joint + 1)
    return {law: sorted(joints) for law, joints in names.items()}


def arm_toml(found: IdentifiedArm) -> str:
    """Text of a file for ``--set``, and for the [set] of a machine."""
    plant = found.plant
    lines = [f"# The arm of {plant.scenario.name}, identified from {found.record.name}."]
    lines += [f"# {note}" for note in found.notes]
    lines.append(
        "# Masses, centres and inertias are those next to the ones before that make the base"
        " parameters; none of them is known by itself."
    )
    for name, value in found.settings.items():
        lines.append(f'"{name}" = {value!r}')
    return "\n".join(lines) + "\n"


def arm_numbers(found: IdentifiedArm, run: HeldArm | None) -> dict[str, Any]:
    """All numbers, as result.json has them."""
    fit, equation = found.fit, found.equation
    return {
        "scenario": found.plant.scenario.name,
        "record": found.record.name,
        "samples": len(found.record.time),
        "rows": int(equation.moving.sum()),
        "low_pass": {"angles": equation.corner, "equation": equation.stretch},
        "condition": fit.condition,
        "correlated_rows": fit.lag,
        "base": {q.name: {"sum": q.text, **_quantity(q)} for q in found.base},
        "joints": {q.name: _quantity(q) for q in found.joints},
        "gears": {str(k + 1): _gear(g) for k, g in found.gears.items()},
        "laws": law_names(found),
        "tried": [
            {
                "laws": [[n, j + 1] for n, j in t.laws],
                "fitted": _plain(t.fitted),
                "kept_back": _plain(t.kept),
            }
            for t in found.tried
        ],
        "kept_back": _plain(found.kept),
        "settings": dict(found.settings),
        "links_off": found.links.misfit,
        "run": None
        if run is None
        else {
            "from": run.settled,
            "added": _plain(run.shares),
            "windup": _plain(run.windup_shares),
        },
        "notes": list(found.notes),
    }


def _quantity(q: ArmQuantity) -> dict[str, Any]:
    return {
        "value": q.value,
        "deviation": _number(q.deviation),
        "before": _number(q.before),
        "unit": q.unit,
        "told": q.told,
    }


def _gear(gear: GearFound) -> dict[str, Any]:
    return {
        "kind": gear.kind,
        "knees": list(gear.knees),
        "stiffness": _plain(gear.stiffness),
        "stiffness_deviation": _plain(gear.stiffness_deviation),
        "secant": gear.secant,
        "left": gear.left,
        "kept_back": gear.share,
        **{
            name: {"value": v, "deviation": _number(d), "told": gear.told(name)}
            for name, (v, d) in gear.values.items()
        },
    }


def _number(x: float) -> float | None:
    return float(x) if math.isfinite(x) else None


def _plain(values: Any) -> list[float | None]:
    return [_number(float(x)) for x in np.ravel(values)]
