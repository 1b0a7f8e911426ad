"""Shares of limits over a run and what is nearest, against loops over the samples."""

from types import SimpleNamespace

import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.report.limit_section import share_words
from motionfmu.run import decimate, limit_shares
from motionfmu.run.axis_figures import axis_figures
from motionfmu.run.limit_shares import FEED, PATH, STANDS, cycle_bounds
from motionfmu.scenarios import limited_signals as told
from motionfmu.scenarios.body import MachineAxis
from motionfmu.scenarios.machine_limits import AxisLimit

STEP = 0.01
CAUSE = {
    "feed": 1,
    "acceleration": 3,
    "jerk": 4,
    "corner": 5,
    "exact stop": 6,
    "dwell": 7,
    "waiting": 8,
}


def limit(name: str, element: int, figure: str, derivative: int, **given: float) -> AxisLimit:
    port = SimpleNamespace(shape=(2,), type="Float64", unit="1")
    end = SimpleNamespace(name=f"c.{'rate' if derivative else figure}", port=port)
    axis = MachineAxis(name=name, kind="linear")
    return AxisLimit(axis, figure, end, element, derivative, "1", **given)  # type: ignore[arg-type]


def made(count: int = 400, seed: int = 3) -> tuple[SimpleNamespace, list[AxisLimit]]:
    """A run of two axes with all causes, and their limits."""
    rng = np.random.default_rng(seed)
    signals = {
        "c.speed": rng.uniform(-3.0, 3.0, (count, 2)),
        "c.rate": np.cumsum(rng.uniform(-0.1, 0.1, (count, 2)), axis=0),
        "c.travel": rng.uniform(-5.0, 9.0, (count, 2)),
        f"c.{told.BY}": rng.integers(0, 9, count),
        f"c.{told.FEED}": rng.choice([0.0, 2.0], count),
        f"c.{told.SPEED}": rng.choice([0.0, 1.0, 2.0], count),
    }
    signals["c.speed"][rng.random(count) < 0.2] = 0.0
    limits = [
        *(limit(n, k, "travel", 0, low=-5.0, high=9.0) for k, n in enumerate("XY")),
        *(limit(n, k, "speed", 0, limit=3.0 + k) for k, n in enumerate("XY")),
        *(limit(n, k, "acceleration", 1, limit=10.0, scale=2.0) for k, n in enumerate("XY")),
    ]
    names = {told.BY, told.AXIS, told.FEED, told.SPEED, told.LINE, told.PLACE}
    resolver = SimpleNamespace(ports={"c": dict.fromkeys(names)})
    run = SimpleNamespace(time=STEP * np.arange(count), signals=signals, resolver=resolver)
    return run, limits


def by_hand(run: SimpleNamespace) -> tuple[dict[str, np.ndarray], list[str]]:
    """Shares and what is nearest, one sample after the other."""
    s = run.signals
    count = len(run.time)
    shares = {n: np.zeros((count, 2)) for n in ("travel", "speed", "acceleration")}
    names = []
    for i in range(count):
        for k in range(2):
            shares["travel"][i, k] = abs(s["c.travel"][i, k] - 2.0) / 7.0
            shares["speed"][i, k] = abs(s["c.speed"][i, k]) / (3.0 + k)
            if i:
                change = 2.0 * (s["c.rate"][i, k] - s["c.rate"][i - 1, k]) / STEP
                shares["acceleration"][i, k] = abs(change) / 10.0
        cause, feed, now = (s[f"c.{n}"][i] for n in (told.BY, told.FEED, told.SPEED))
        ends = [
            (round(shares[f][i, k], 3), "XY"[k]) for f in ("speed", "acceleration") for k in (0, 1)
        ]
        follows = 1.0 if cause == CAUSE["feed"] else min(1.0, now / feed) if feed else 0.0
        ends.append((follows, FEED))
        ramp = cause in (CAUSE["acceleration"], CAUSE["jerk"], CAUSE["corner"], CAUSE["exact stop"])
        ends.append((0.9995 if ramp else 0.0, PATH))
        name = max(ends, key=lambda e: e[0])[1]
        if cause in (CAUSE["dwell"], CAUSE["waiting"]):
            name = STANDS
        elif now <= 0.0 and shares["speed"][i].max() < 1e-3:
            name = STANDS
        names.append(name if cause else "")
    return shares, names


@pytest.mark.parametrize("rows", [4096, 7])
def test_shares_and_the_nearest_are_those_of_a_loop(
    rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(decimate, "ROWS", rows)
    run, limits = made()
    found = limit_shares.limit_shares(run, limits)  # type: ignore[arg-type]
    shares, names = by_hand(run)
    assert [s.figure for s in found] == list(shares)
    for s in found:
        assert s.axes == ("X", "Y")
        whole = np.concatenate(list(decimate.blocks(len(run.time), s.read)))
        assert np.allclose(whole, shares[s.figure], rtol=0.0, atol=1e-9)
    bounds = cycle_bounds(run, found)  # type: ignore[arg-type]
    assert bounds is not None
    place = np.concatenate(list(decimate.blocks(len(run.time), bounds.read)))
    assert ["" if np.isnan(p) else bounds.names[int(p)] for p in place] == names
    assert bounds.time == pytest.approx(STEP * sum(map(bool, names)))
    for one in bounds.nearest:
        assert one.time == pytest.approx(STEP * names.count(one.name))
        told_by = sum(t for _, t in one.by)
        assert told_by == pytest.approx(one.time) or one.name in (FEED, STANDS)
    assert {one.name for one in bounds.nearest} == {"X", "Y", FEED, PATH, STANDS}


def test_the_largest_share_of_a_travel_is_at_the_nearer_end() -> None:
    run, limits = made()
    shares, _ = by_hand(run)
    for k, figure in enumerate(axis_figures(run, limits)[:2]):  # type: ignore[arg-type]
        at = int(shares["travel"][:, k].argmax())
        words = f"{100.0 * shares['travel'][at, k]:.0f} % at {STEP * at:.3f} s"
        assert share_words(figure).startswith(words)


def test_without_a_controller_that_tells_there_are_shares_alone() -> None:
    run, limits = made()
    del run.signals[f"c.{told.BY}"]
    found = limit_shares.limit_shares(run, limits)  # type: ignore[arg-type]
    assert len(found) == 3 and cycle_bounds(run, found) is None  # type: ignore[arg-type]
    open_ends = [limit(n, k, "travel", 0, low=0.0) for k, n in enumerate("XY")]
    assert limit_shares.limit_shares(run, open_ends) == []  # type: ignore[arg-type]


def test_a_limit_over_a_time() -> None:
    """A jerk's limit is the acceleration's over the time in which it comes up."""
    scenario = motionfmu.load(ROOT / "scenarios/robot_pick")

    def jerks(**given: float) -> list[float | None]:
        set = {f"soft.{name}": value for name, value in given.items()}
        return [x.limit for x in scenario.axis_limits(set) if x.figure == "jerk"]

    wanted = [10e3, 10e3, 10e3, 20e3, 20e3, 30e3]  # [deg/s3]
    assert jerks() == pytest.approx(wanted)
    assert jerks(smooth_time=0.1) == pytest.approx([0.5 * x for x in wanted])
    assert jerks(smooth_time=0.0) == [None] * 6
