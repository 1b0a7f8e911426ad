"""Scenarios for linear models, with everything that is not linear made small."""

from typing import Any

from conftest import ROOT

from motionfmu.analysis import linear

THEORY, DEMO, MODES = (ROOT / "scenarios" / n for n in ("circle_theory", "circle", "output_modes"))
SMOOTH = {
    f"machine.{name}": 0.0
    for name in ("motor_coulomb", "motor_static", "table_coulomb", "table_static", "backlash")
}
# Limits far away, and counts so small that rounding does not show.
WIDE = {
    "drives.encoder_counts": 2**30,
    "drives.torque_limit": 1e6,
    "drives.speed_limit": 1e6,
    "drives.error_limit": 1e6,
}


def theory(**set_: Any) -> linear.AxisModel:
    """Card and ideal velocity axis."""
    return linear.model(THEORY, set={k.replace("__", "."): v for k, v in set_.items()})


def kp_of(axis: linear.AxisModel) -> float:
    """Position gain [1/s] of `theory`, from the data sheet's units."""
    counts = 4 * axis.value("machine.encoder_lines")
    volts = axis.value("card.host_p_gain") / 2.0 ** axis.value("card.p_scale") * 20.0 / 65536.0
    return float(volts * axis.value("machine.speed_per_volt") / 60.0 * counts)
