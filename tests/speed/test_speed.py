"""Speed along smooth segments: each axis within its limits, as quick as toppra's bound."""

import itertools

import cell_optimum
import numpy as np
import pytest
import smooth_bound
from few_cases import few
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from speed_rides import (
    LIBRARY,
    SAMPLE,
    Chain,
    Orders,
    at_rest_at_its_end,
    hermite,
    limits,
    place,
    random_chain,
    random_ride,
    ride,
    shares,
)
from toppra_bound import bound

SEEDS = st.integers(0, 2**32 - 1)
ROUNDING = 1e-9


def within(steps: np.ndarray, bounds: np.ndarray, dt: float) -> None:
    """Each axis keeps its limits at every sample, and between samples in the mean."""
    for name, share in shares(steps, bounds, dt).items():
        assert share <= 1 + (1e-6 if name.startswith("change") else ROUNDING), name


def corners(size: float, length: float, count: int) -> np.ndarray:
    """A staircase of lines with a quintic of so many mm at each corner."""
    chain, here, along, across = Chain(), place(), place(1), place(0, 1)
    for i in range(count):
        corner = here + length * along
        chain.line(here, corner)
        here = corner + size * (along + across)
        start, end = np.array([corner, along, place()]), np.array([here, across, place()])
        chain.curve(hermite(start, end, 1.8 * size), 1.8 * size)
        along, across = across, along if i % 2 else -along
    chain.line(here, here + length * along)
    return chain.told()


def circle() -> np.ndarray:
    """Once round, of 10 mm."""
    chain = Chain(feed=400.0)
    chain.arc(place(10), place(10), np.zeros(2), True)
    return chain.told()


def waves(bend: float, length: float) -> np.ndarray:
    """100 mm whose curvature is bend sin(s / length), in curves of 0.5 mm."""
    s = np.linspace(0, 100, 20_001)
    angle = bend * length * (1 - np.cos(s / length))
    middle = 0.5 * (angle[1:] + angle[:-1])
    x = np.append(0, np.cumsum(np.cos(middle))) * s[1]
    y = np.append(0, np.cumsum(np.sin(middle))) * s[1]
    chain, ends = Chain(), []
    for i in range(0, len(s), 100):
        along, across = (
            place(np.cos(angle[i]), np.sin(angle[i])),
            place(-np.sin(angle[i]), np.cos(angle[i])),
        )
        ends.append(np.array([place(x[i], y[i]), along, bend * np.sin(s[i] / length) * across]))
    for start, end in itertools.pairwise(ends):
        chain.curve(hermite(start, end, 0.5), 0.5)
    return chain.told()


def test_line() -> None:
    """A line takes its trapezium or triangle."""
    chain = Chain()
    chain.line(place(), place(10))
    assert ride(chain.told(), limits(1000.0)).time == pytest.approx(0.2, rel=1e-8)
    chain.line(place(10), place(30))
    assert ride(chain.told(), limits(1000.0)).time == pytest.approx(0.4, rel=1e-8)
    assert ride(chain.told(), limits(1000.0, speed=50)).time == pytest.approx(0.65, rel=1e-8)
    asymmetric = Chain(acc=500.0, dec=2000.0)
    asymmetric.line(place(), place(30))
    assert ride(asymmetric.told(), limits()).time == pytest.approx(0.425, rel=1e-8)


def test_circle() -> None:
    """Round a circle: v^2 / r by the path's rule; by each axis' limit between that and its root."""
    by_path = ride(circle(), limits(), Orders(1e-4))
    by_axes = ride(circle(), limits(1000.0), Orders(1e-4))
    assert by_path.steps["rate"].max() == pytest.approx(100.0, rel=1e-8)
    assert 100.0 < by_axes.steps["rate"].max() < 100.0 * 2**0.25
    assert 0.995 < np.abs(by_axes.steps["acc"]).max() / 1000.0 <= 1 + ROUNDING


@settings(max_examples=60)
@given(SEEDS)
def test_path_rule(seed: int) -> None:
    """Without limits of axes: along the path and across it, each within the ramp."""
    dice = np.random.default_rng(seed)
    chain = random_chain(dice, 10, float(10 ** dice.uniform(-1, 1.5)), 10 ** dice.uniform(1, 2.8))
    told = chain.told()
    told["acc"], told["dec"] = 10 ** dice.uniform(2, 4, (2, 1))
    overrides = np.append(np.repeat(dice.choice([0, 0.3, 1, 2], 20), 40), 1.0)
    steps = ride(told, limits(), Orders(1e-3, overrides, int(dice.choice([1, 1000])))).steps
    steps = steps[steps["rate"] > 1e-3]
    way = steps["velocity"] / np.linalg.norm(steps["velocity"], axis=1)[:, None]
    along = (steps["acc"] * way).sum(axis=1)
    across = np.linalg.norm(steps["acc"] - along[:, None] * way, axis=1)
    acc, dec = told["acc"][0], told["dec"][0]
    for most, peak in ((acc, along.max()), (dec, -along.min()), (min(acc, dec), across.max())):
        assert peak <= most * (1 + ROUNDING)
    assert max(along.max() / acc, -along.min() / dec) > 0.98


@pytest.mark.parametrize("seed", range(6))
def test_bound(seed: int) -> None:
    """At most 2.5 % above the bound of toppra, never below it."""
    dice = np.random.default_rng(seed)
    told = random_chain(dice, 8, 5.0).told()
    least = bound(told, 1000.0, 100.0)
    ratio = ride(told, limits(1000.0), Orders(1e-2)).time / least
    print(f"{len(told)} segments: {least:.4f} s, {ratio:.4f}")
    assert 0.9995 < ratio < 1.025


@pytest.mark.parametrize("seed", few(range(8), 3))
def test_optimum_of_the_same_cells(seed: int) -> None:
    """At points of 1 ms within 0.2 % of the least time with a constant d2u/dt2 in each cell."""
    dice = np.random.default_rng(seed)
    size, feed = float(10 ** dice.uniform(-0.5, 1)), float(10 ** dice.uniform(1.5, 2.8))
    told = random_chain(dice, 6, size, feed).told()
    bounds = limits(1000.0 * np.array([1, dice.uniform(0.3, 3), 1, 1, 1, 1]))
    ratio = ride(told, bounds, Orders(1e-3)).time / cell_optimum.optimum(told, bounds)
    print(f"{ratio:.5f}")
    assert 0.998 < ratio < 1.002


@settings(max_examples=150)
@given(SEEDS, st.booleans())
@example(10, False)
@example(223, False)
@example(3, True)
@example(35, True)
@example(4105827, False)  # a low override where an axis needs the speed to rise
@example(16054, True)  # braking to rest leads into parts with a lower most speed
@example(10905, True)  # from nearly rest, at no acceleration
@example(27476, True)  # a share of a plan that lands where the chain ends, but for rounding
@example(47927, True)
def test_orders(seed: int, smooth: bool) -> None:
    """Random overrides, holds and look-ahead: within the limits, at rest at the end."""
    done, bounds, orders = random_ride(seed, smooth)
    within(done.steps, bounds, orders.dt)
    assert at_rest_at_its_end(done)


@settings(max_examples=60)
@given(SEEDS)
@example(28)
@example(760)
def test_sudden_overrides(seed: int) -> None:
    """High and low overrides in turn: no speed is left but by an acceleration within the limits."""
    dice = np.random.default_rng(seed)
    size, feed = float(10 ** dice.uniform(0, 1)), float(10 ** dice.uniform(2, 2.8))
    told = random_chain(dice, 8, size, feed).told()
    bounds = limits(10 ** dice.uniform(2, 4) * np.array([1, dice.uniform(0.3, 3), 1, 1, 1, 1]))
    choices = dice.choice([0.05, 0.3, 1, 2], 300)
    overrides = np.append(np.repeat(choices, dice.integers(1, 8, 300)), 1.0)
    orders = Orders(10 ** dice.uniform(-3.5, -2.3), overrides, 1000, 1_000_000)
    done = ride(told, bounds, orders)
    within(done.steps, bounds, orders.dt)
    assert at_rest_at_its_end(done)


@settings(max_examples=60, derandomize=True)
@given(SEEDS, st.booleans())
@example(3641, False)
@example(3030, False)
def test_stop(seed: int, smooth: bool) -> None:
    """A hold comes to rest where it was told, or, with T, before; its bounds are measured ones."""
    dice = np.random.default_rng(seed)
    told = random_chain(dice, 10, 5.0).told()
    bounds, dt = limits(1000.0, jerk=50_000.0 * smooth), 1e-3
    full = ride(told, bounds, Orders(dt))
    orders = Orders(dt, most=int(dice.integers(1, len(full.steps))))
    way = ride(told, bounds, orders).steps["way"][-1]
    goal = LIBRARY.speed_batch_stop_way()
    steps = []
    for _ in range(10_000):
        steps.append(np.zeros(1, SAMPLE))
        left = LIBRARY.speed_batch_go(len(told), 0.0, dt, steps[-1])
        if left > 0 or steps[-1]["rate"][0] == 0:
            break
    within(np.concatenate(steps), bounds, dt)
    short = 0.0 if smooth else 0.24 * (goal - way)
    assert goal - short - 1e-9 <= steps[-1]["way"][0] <= goal + 1e-9


def test_smooth_line() -> None:
    """A line with limited jerk: four parts of constant jerk, or to the feed."""
    bounds = limits(1000.0, jerk=50_000.0)
    for way, time, more in ((0.1, (32 * 0.1 / 50_000) ** (1 / 3), 1e-6), (30.0, 0.42, 1e-3)):
        chain, by_path = Chain(), Chain(jerk=50_000.0)
        for made, limit in ((chain, bounds), (by_path, limits())):
            made.line(place(), place(way))
            done = ride(made.told(), limit)
            assert -1e-6 < done.time / time - 1 < more
            gain, rate = done.steps["gain"][:-1], np.diff(done.steps["rate"][:-1])
            assert np.abs(rate - 0.5e-3 * (gain[1:] + gain[:-1])).max() < 0.5 * 50_000.0 * 1e-6


@pytest.mark.parametrize("feed", [0.5, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 30.0])
def test_smooth_slow_line(feed: float) -> None:
    """A line at a low feed is driven at that feed: two ramps and the rest."""
    chain = Chain(feed=feed)
    chain.line(place(), place(30))
    ramp = 2 * np.sqrt(feed / 50_000.0) if feed < 20.0 else feed / 1000.0 + 0.02
    ratio = ride(chain.told(), limits(1000.0, jerk=50_000.0)).time / (30 / feed + ramp)
    print(f"{feed} mm/s: {ratio:.5f}")
    assert 1 - 1e-6 < ratio < 1.012


@pytest.mark.parametrize("seed", range(5))
def test_smooth_parts_meet(seed: int) -> None:
    """Parts of segments end where the next ones begin, to the bit: no rest between them."""
    told = random_chain(np.random.default_rng(seed), 10, 3.0).told()
    ride(told, limits(1000.0, jerk=50_000.0), Orders(most=1))
    assert LIBRARY.speed_batch_gap() == 0.0


@pytest.mark.parametrize(
    ("name", "told", "most"),
    [
        ("circle", circle(), 1.2),
        ("corners", corners(0.1, 10.0, 10), 1.3),
        ("waves 2", waves(0.2, 2.0), 1.25),
        ("waves 10", waves(0.1, 10.0), 1.25),
        ("waves 5", waves(0.5, 5.0), 1.25),
    ],
)
def test_smooth_is_quick(name: str, told: np.ndarray, most: float) -> None:
    """With a jerk that takes 20 ms to the acceleration, little slower than without."""
    quick = ride(told, limits(1000.0)).time
    smooth = ride(told, limits(1000.0, jerk=50_000.0))
    within(smooth.steps, limits(1000.0, jerk=50_000.0), 1e-3)
    print(f"{name}: {quick:.3f} s, with limited jerk {smooth.time / quick:.3f}")
    assert 1.0 < smooth.time / quick < most


@pytest.mark.parametrize(
    ("name", "told"),
    few(
        [
            ("waves 2", waves(0.2, 2.0)),
            ("waves 5", waves(0.5, 5.0)),
            ("waves 1", waves(0.5, 1.0)),
            ("curves", random_chain(np.random.default_rng(3), 12, 4.0).told()),
        ],
        1,
    ),
)
def test_smooth_bound(name: str, told: np.ndarray) -> None:
    """At most 8 % above the bound of linear programs with the same limits."""
    least = smooth_bound.bound(told, 1000.0, 50_000.0, told["feed"].min())
    ratio = ride(told, limits(1000.0, jerk=50_000.0), Orders(1e-3)).time / least
    print(f"{name}: {least:.4f} s, {ratio:.4f}")
    assert 0.99 < ratio < 1.08


def lengths(told: np.ndarray) -> list[float]:
    """Length of each segment."""
    return [LIBRARY.speed_batch_segments(1, told[i : i + 1]) for i in range(len(told))]


@pytest.mark.parametrize("seed", range(4))
def test_streaming(seed: int) -> None:
    """Known in time, segments that come one by one take as long as all at once."""
    told = random_chain(np.random.default_rng(seed), 30, 2.0).told()
    whole = ride(told, limits(1000.0)).time
    assert ride(told, limits(1000.0), Orders(ahead=20)).time == pytest.approx(whole, rel=1e-12)
    assert ride(told, limits(1000.0), Orders(ahead=1)).time > whole


def test_override_of_a_corner() -> None:
    """Twice the feed is as quick as a feed of twice as much."""
    told = corners(0.1, 10.0, 1)
    fast = told.copy()
    fast["feed"] *= 2
    twice = ride(told, limits(1000.0), Orders(overrides=[2.0])).time
    assert twice == pytest.approx(ride(fast, limits(1000.0)).time, rel=1e-12)
    assert twice < ride(told, limits(1000.0)).time


def least_to_rest(v: float, braking: float, acc: float, jerk: float) -> float:
    """Time of a ramp to the deepest braking, a while with it and a ramp back, on a straight way."""
    deep = np.sqrt(jerk * v + 0.5 * braking**2)
    if deep <= acc:
        return float((2.0 * deep - braking) / jerk)
    return (2.0 * acc - braking) / jerk + v / acc + (0.5 * braking**2 / acc - acc) / jerk


@settings(max_examples=150, derandomize=True)
@given(SEEDS)
@example(225)  # in a bend, braking a little, where it could land by less than 1e-3 of the jerk
@example(228)  # nearly at rest, still becoming faster
def test_a_hold_never_idles(seed: int) -> None:
    """Wherever it comes, whatever the override before: little longer than a straight way needs.

    The way may take up to twice what an axis may.
    """
    acc, jerk, dt = 1000.0, 50_000.0, 1e-3
    dice = np.random.default_rng(seed)
    told = random_chain(dice, 10, 5.0).told()
    first, then = float(10.0 ** dice.uniform(-4, 0.2)), int(dice.integers(1, 400))
    second, for_ = float(10.0 ** dice.uniform(-4, 0.2)), int(dice.integers(1, 60))
    overrides = [first] * then + [second] * for_
    steps = ride(told, limits(acc, jerk=jerk), Orders(dt, overrides, 1000, len(overrides))).steps
    v, a = float(steps[-1]["rate"]), float(steps[-1]["gain"])
    assume(len(steps) == len(overrides) and v > 0.0)
    least = least_to_rest(v, max(0.0, -a), 2.0 * acc, 2.0 * jerk)
    one, time = np.zeros(1, SAMPLE), 0.0
    while one["rate"][0] > 0.0 or time == 0.0:
        LIBRARY.speed_batch_go(len(told), 0.0, least / 20, one)
        time += least / 20
        assert time < 8.0 * least


@pytest.mark.parametrize("override", [2.0, 1.0, 0.1, 0.01, 3e-3, 1e-3, 5e-4])
def test_a_hold_of_a_slow_ride_brings_it_to_rest(override: float) -> None:
    """However slow it goes, nearly as quickly as the jerk lets it."""
    chain, acc, jerk = Chain(feed=50.0), 1000.0, 20000.0
    chain.line(place(), place(200.0))
    orders = Orders(1e-4, [override] * 3000 + [0.0], 1000, 9000)
    steps = ride(chain.told(), limits(acc, 0.0, jerk), orders).steps
    v = steps["rate"][2999]
    assert v == pytest.approx(50.0 * override, rel=0.05)
    best = least_to_rest(v, 0.0, acc, jerk)
    rests = np.flatnonzero(steps["rate"][3000:] == 0.0)
    assert len(rests) and 0.98 * best - 1e-4 < (rests[0] + 1) * 1e-4 < 2.0 * best + 1e-4
    within(steps, limits(acc, 0.0, jerk), 1e-4)
