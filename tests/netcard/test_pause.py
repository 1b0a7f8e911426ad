"""Pauses of a planned job on the card: its own pulses, differentiated, and the path they draw."""

import numpy as np
import pytest
from card_links import flash_with

from motionfmu.cards.config import read as config_of
from motionfmu.cards.messages import State
from motionfmu.cards.plan import Plan, plan
from motionfmu.cards.sim import VirtualNetCard
from motionfmu.drawings import plt

ACC, JERK, SCALE = 1000.0, 50_000.0, 3000.0  # [mm/s^2] [mm/s^3] [pulses/mm]
MS = 1_000_000  # [ns]
WIDE = 8  # [ms] between the points of a difference: it is a mean of the derivative
AXIS = f"""
pulses_per_mm = {SCALE}
minimum = -100
maximum = 300
speed_max = 150
acceleration_max = {ACC}
jerk_max = {JERK}
"""
DRAWING = b"IN;SP1;PU200,0;PD1400,0,1400,900;CI400;PU0,0;AA0,0,80;PU;"
START, PAUSE = 1, 2  # inputs


@pytest.fixture(scope="module")
def planned() -> Plan:
    config = config_of("".join(f'[[axes]]\nname = "{n}"{AXIS}' for n in "XY"), "card.toml")
    return plan(plt.parse(DRAWING, "shapes.plt"), config)


def played(planned: Plan, seed: int, pauses: int) -> tuple[np.ndarray, int]:
    """Counts of X and Y each ms [mm], with pauses at random; how many times it stood in one."""
    actions, deaf = [START, PAUSE] + [0] * 14, [0] * 16
    flash = flash_with(planned.job)
    card = VirtualNetCard(1, flash=flash, in_action=actions, in_debounce_us=deaf)
    chance = np.random.default_rng(seed)
    most = len(planned.steps)
    near = np.where(chance.random(2 * pauses) < 0.4, 0.1, 1.0)
    gaps = near * chance.integers(50, 1300, 2 * pauses)
    presses = 100 + np.cumsum(gaps.astype(int) + 1)  # [ms] some in the ramp of the one before
    counts: list[list[int]] = []
    stood, was = 0, State.READY

    def press(button: int) -> None:
        card.set_inputs(button)
        card.run(card.now + MS // 10)
        card.set_inputs(0)

    press(START)
    while card.state != State.READY or len(counts) < 100:
        if len(counts) in presses:
            press(START if card.state in (State.PAUSED, State.PAUSING) else PAUSE)
        if len(counts) > presses[-1] and card.state == State.PAUSED:
            press(START)
        card.run((card.now // MS + 1) * MS)
        counts.append(card.pulses[:2])
        stood += card.state == State.PAUSED and was != State.PAUSED
        was = card.state
        assert len(counts) < 3 * most + 3000 * pauses
    assert card["underflows"] == 0
    return np.array(counts) / SCALE, stood


@pytest.mark.parametrize("seed", range(2))
def test_pulses_keep_to_the_limits_and_the_path_in_every_pause(planned: Plan, seed: int) -> None:
    places, stood = played(planned, seed, 8)
    assert stood >= 2
    np.testing.assert_array_equal(places[-1] * SCALE, planned.commands.sum(axis=0)[:2])
    half = 0.5 / SCALE  # what a count is beside its place
    for order, limit, off in ((2, ACC, 4 * half), (3, JERK, 8 * half)):
        padded = np.vstack([np.zeros((4 * WIDE, 2)), places, places[-1:].repeat(4 * WIDE, 0)])
        for _ in range(order):
            padded = padded[WIDE:] - padded[:-WIDE]
        step = (1e-3 * WIDE) ** order
        most = np.abs(padded).max() / step
        print(f"order {order}: {most / limit:.3f} of the limit")
        assert 0.8 * limit < most < limit + off / step
    way = np.vstack([np.zeros(2), np.cumsum(planned.commands, axis=0)[:, :2] / SCALE])
    a, d = way[:-1], np.diff(way, axis=0)
    for p in places[::7]:
        share = np.clip(((p - a) * d).sum(1) / np.maximum((d * d).sum(1), 1e-30), 0.0, 1.0)
        assert np.hypot(*(a + share[:, None] * d - p).T).min() < 1.0 / SCALE
