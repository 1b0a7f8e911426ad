"""Settings of a card over the wire: what differs is sent, in an order that the card takes."""

import asyncio
import re
from typing import Any

import pytest
from card_links import HOST, bench, run, until
from conftest import ROOT
from soft_card import SoftCard
from test_sim import job_of

from motionfmu.cards.card_settings import asked, fields, lines, numbers, shown
from motionfmu.cards.config import CardConfig, load
from motionfmu.cards.messages import State
from motionfmu.cards.sim import VirtualNetCard, simulate
from motionfmu.cards.views import Code

CONFIG = load(ROOT / "examples/network_card_firmware/card.toml")
HEADER = (ROOT / "src/controllers/netcard/card_settings.h").read_text()


def changed(**values: Any) -> CardConfig:
    """The example with other values, `axes` those of X."""
    tree = CONFIG.model_dump()
    for table, given in values.items():
        (tree["axes"][0] if table == "axes" else tree[table]).update(given)
    return CardConfig.model_validate(tree)


def test_numbers_are_those_of_the_list_in_the_header() -> None:
    rows = re.findall(r"X\(\w+, +(\w+), (?:\[(\d+)\])?,", HEADER.replace("\\\n", ""))
    assert [*numbers().items()] == [(n, (i, int(k or 1))) for i, (n, k) in enumerate(rows)]
    found = asked(CONFIG)
    assert {name for name, _ in found} == fields().keys() - {"card_id"}
    assert shown("speed_max", found["speed_max", 0], found["pulses_per_m", 0]) == "200"
    assert shown("origin_trigger", 1, 1) == "falling" and shown("must_home", 1, 1) == "yes"


def test_what_differs_is_sent_once_and_nothing_to_a_card_that_moves() -> None:
    async def main() -> None:
        soft = SoftCard(3)
        async with bench() as b:
            assert (await b.cards.configure(3, CONFIG)).result.code == Code.OFFLINE
            b.serve(soft)
            await b.online([3])
            end = await b.cards.configure(3, CONFIG)
            assert end.result.ok and len(end.changed) == len(soft.orders) > 50
            result, has = await b.cards.settings(3)
            assert result.ok and has.items() >= asked(CONFIG).items()
            assert (await b.cards.configure(3, CONFIG)).changed == ()
            other = changed(axes={"speed_max": 150.0}, fifo={"depth": 256})
            soft.state = State.RUNNING
            end = await b.cards.configure(3, other)
            assert (end.result.code, len(end.changed)) == (Code.BUSY, 1)
            soft.state = State.READY
            end = await b.cards.configure(3, other)
            assert [*lines(asked(other), end)] == [
                "Frames of the FIFO: 512 -> 256: done, acts from the next power-up on",
                "Axis X: Highest speed: 200 -> 150 mm/s: done",
            ]
            assert b.texts(3, "result")[-1] == "configure, 2 settings changed: done"
            await b.unplug()
            assert (await b.cards.configure(3, CONFIG)).result.code == Code.OFFLINE
            assert (await b.cards.settings(3))[0].code == Code.OFFLINE

    run(main())


def test_the_card_takes_every_step_and_acts_when_it_is_said_to() -> None:
    low = {"minimum": 0.0, "maximum": 1.0, "speed_max": 2.0, "home_speed": 2.0, "speed_min": 0.5}
    high = {"minimum": 50.0, "maximum": 60.0, "speed_max": 400.0, "home_speed": 90.0}
    wide = {"minimum": -50.0, "maximum": 60.0, "speed_max": 400.0, "home_speed": 90.0}
    stop_at_7 = [i.model_dump() for i in CONFIG.inputs]
    stop_at_7[7]["action"] = "stop"

    async def main() -> None:
        async with bench() as b:
            card = VirtualNetCard(5, in_action=[0] * 16)
            task = asyncio.create_task(simulate([card], (HOST, b.port), 10.0))
            await b.online([5])
            assert (await b.cards.upload(5, job_of())).ok
            await until(lambda: b.view(5).state == "READY")
            for axis in (low, high, low, high, wide):
                speeds = {"speed_min": 5.0} | axis | {"home_slow": 0.5}
                end = await b.cards.configure(5, changed(axes=speeds))
                assert end.result.ok, end.result.text
                assert all(s.result.ok for s in end.changed)
            last = CONFIG.model_dump() | {"inputs": stop_at_7, "fifo": {"depth": 64}}
            last["motion"]["must_home"], last["axes"][1]["minimum"] = True, -50.0
            config = CardConfig.model_validate(last)
            end = await b.cards.configure(5, config)
            assert end.result.ok
            assert {s.name for s in end.changed if s.later} >= {"fifo_depth", "in_action"}
            assert (await b.cards.settings(5))[1].items() >= asked(config).items()
            assert (await b.cards.command(5, "start")).code == Code.NOT_HOMED  # at once
            last["motion"]["must_home"] = False
            assert (await b.cards.configure(5, CardConfig.model_validate(last))).result.ok
            task.cancel()
        assert stock(card) > 200 and stock(card) > 200  # as it was powered up
        card.power_cycle()
        card.run(card.now + 1_000_000)
        assert 32 < stock(card) <= 64

    run(main())


def stock(card: VirtualNetCard) -> int:
    """Most frames that the FIFO holds in a run."""
    most = 0
    card._c.netcard_command(card._card, 0, 0)
    card.run(card.now + 1_000_000)
    assert card.state == State.RUNNING
    while card.state != State.READY:
        card.run(card.now + 1_000_000)
        most = max(most, card["stock"])
    return most


@pytest.mark.parametrize("name", ["speed_max", "position_high"])
def test_bounds_are_raised_first_and_lowered_last(name: str) -> None:
    from motionfmu.cards.card_settings import in_order

    wanted = {("acc_max", 0): 2, (name, 0): 5, ("home_speed", 0): 3, (name, 1): 5}
    has = {("acc_max", 0): 2, (name, 0): 3, ("home_speed", 0): 1, (name, 1): 9}
    assert in_order(wanted, has) == [(name, 0), ("home_speed", 0), (name, 1)]
