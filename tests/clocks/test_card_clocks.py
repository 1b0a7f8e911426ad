"""The formulas of docs/theory/card-clocks.md against the cores' pulses, counts and stock."""

import numpy as np
import pytest
from clock_runs import CARDS, counted, lateness, played, pulse_ticks, stock

DICE = np.random.default_rng(5)


@pytest.mark.parametrize("ticks", [1024, 4096, 50_000])
def test_distances_of_pulses(ticks: int) -> None:
    """floor or ceil of ticks/k, over a boundary too; each less than a tick late."""
    for k in np.unique(np.r_[1:40, DICE.integers(40, ticks, 60), ticks - 1]):
        tick = pulse_ticks(int(k), ticks)
        late = tick - (2 * np.arange(k) + 1) * ticks / (2 * k)
        assert 0.0 <= late.min() and late.max() < 1.0
        around = np.diff(np.r_[tick, ticks + tick[0]])
        assert set(around) <= {ticks // k, -(-ticks // k)}


def test_distance_over_a_boundary_where_the_command_changes() -> None:
    """floor(N/2k) + ceil(N/2k')."""
    for k, after in DICE.integers(1, 4096, (300, 2)):
        gap = 4096 - pulse_ticks(int(k), 4096)[-1] + pulse_ticks(int(after), 4096)[0]
        assert gap == 4096 // (2 * k) + -(-4096 // (2 * after))


@pytest.mark.parametrize("card", CARDS)
@pytest.mark.parametrize("share", [0.137, 0.731, 1.37, 3.77, 20.3])
def test_how_late_pulses_of_a_uniform_motion_are(card: str, share: float) -> None:
    """To a tick as much as the formula; and less than a pulse off the line."""
    period, tick, spread = CARDS[card]
    speed = share / period  # [pulses/clock]
    clock = played(speed, period, 3000, spread)
    index = np.arange(len(clock))
    off = np.abs(clock - (index + 0.5) / speed).max()
    assert off == pytest.approx(lateness(share) / speed, rel=0.02, abs=tick)
    assert np.abs(speed * clock - index - 0.5).max() < 0.5 + speed * tick


@pytest.mark.parametrize("filter_clocks", [1, 2, 10, 40, 255])
def test_highest_rate_behind_a_filter(filter_clocks: int) -> None:
    """2 f/F counts/s: none is lost there, almost all a little above."""
    lines = 500.0
    half = max(filter_clocks, 2)  # [clocks] of half a line period; 2 are an edge a clock
    assert counted(0.1, 0.1 + lines, round(2.0 * lines * half), filter_clocks) == (4 * lines, False)
    if filter_clocks > 2:
        shorter = round(2.0 * lines * (filter_clocks - 1))
        counts, told = counted(0.1, 0.1 + lines, shorter, filter_clocks)
        assert told and counts < 0.02 * 4 * lines


def test_counts_in_a_window() -> None:
    """The mean is exact, the variance p (1 - p), p the broken part of the mean."""
    for mean in (0.25, 3.5, 17.9):
        starts = DICE.uniform(0.0, 1.0, 4000)
        found = np.array([counted(s, s + mean / 4.0, 4000, 0)[0] for s in starts])
        p = mean % 1.0
        assert set(found) == {int(mean), int(mean) + 1}
        assert found.mean() == pytest.approx(mean, abs=5.0 * np.sqrt(p * (1.0 - p) / 4000))
        assert found.std() == pytest.approx(np.sqrt(p * (1.0 - p)), rel=0.06)


@pytest.mark.parametrize(("minimum", "batch"), [(0, 1), (3, 4), (7, 8), (2, 9), (5, 3), (6, 1)])
def test_latency_that_a_stock_bears(minimum: int, batch: int) -> None:
    """n + 1 DDA times, or N where a refill leaves the condition true; an interrupt each N."""
    most = min(minimum + 1, batch)
    assert stock(minimum, batch, most - 0.001, 2000)[1] == 0
    assert stock(minimum, batch, most + 0.02, 2000)[1] > 0
    if batch > minimum > 0:
        found, _ = stock(minimum, batch, 0.3, 2000)
        asked = np.flatnonzero((found[1:] == minimum) & (found[:-1] > minimum))
        assert set(np.diff(asked)) == {batch}
