"""Figures of axes beside their limits: time above what may last."""

from types import SimpleNamespace

import numpy as np
import pytest

from motionfmu.run import decimate
from motionfmu.run.axis_figures import AxisFigure, axis_figures
from motionfmu.scenarios.body import MachineAxis
from motionfmu.scenarios.machine_limits import AxisLimit


def figures_of(values: list[float], **limits: object) -> AxisFigure:
    """The figure of one axis, one sample each tenth of a second."""
    axis = MachineAxis(name="X", kind="linear")
    port = SimpleNamespace(shape=(), type="Float64", unit="N.m")
    end = SimpleNamespace(name="a.torque", port=port)
    limit = AxisLimit(axis, "torque", end, None, 0, "N.m", **limits)  # type: ignore[arg-type]
    run = SimpleNamespace(time=0.1 * np.arange(len(values)), signals={"a.torque": np.array(values)})
    (found,) = axis_figures(run, [limit])  # type: ignore[arg-type]
    return found


@pytest.mark.parametrize(
    ("values", "above", "longest"),
    [
        ([0, 3, 3, 0, -3, -3, -3, 0, 3], 0.6, 0.3),
        ([3, 3, 0, 0], 0.2, 0.2),
        ([0, 0, 3, 3], 0.2, 0.2),
        ([3, 3, 3], 0.3, 0.3),
        ([0, 2, -2, 0], 0.0, 0.0),  # at what may last
    ],
)
def test_time_above_what_may_last(values: list[float], above: float, longest: float) -> None:
    found = figures_of(values, continuous=2.0, overload=0.6)
    assert (found.time_above, found.longest_above) == pytest.approx((above, longest))
    assert found.overload_share == pytest.approx(longest / 0.6)
    assert figures_of(values).longest_above == 0.0
    assert figures_of(values, continuous=2.0).overload_share is None


def test_a_long_time_above_goes_on_over_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(decimate, "ROWS", 4)
    values = [0.0] * 3 + [3.0] * 10 + [0.0] + [3.0] * 2
    assert figures_of(values, continuous=2.0).longest_above == pytest.approx(1.0)
