"""The document's timing contract to the clock of 25 ns, through library and card as FMUs."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import motionfmu

CLOCK = 25e-9  # [s]
T0 = 40960  # [clocks] DDA time of the figures, 1.024 ms


def run(name: str, stop: float | None = None, **settings: Any) -> motionfmu.Result:
    scenario = motionfmu.load(ROOT / "scenarios" / name)
    return scenario.run(set={k.replace("__", "."): v for k, v in settings.items()}, stop=stop)


def pulls(result: motionfmu.Result) -> np.ndarray:
    """Clocks of the interrupts while the axis moves."""
    clocks, first = np.unique(result["card.irq_clock"], return_index=True)
    moving = result["mcc.services"][first] > 3
    return clocks[moving]


@dataclass(frozen=True)
class Contract:
    """What the document promises of a setting; times in clocks."""

    scenario: str
    n: int
    batch: int
    dda: int
    deadline: int


CONTRACTS = [
    Contract("fifo_one", 0, 1, T0, T0),
    Contract("fifo_four", 3, 4, T0, 4 * T0),
    Contract("fifo_doubled", 3, 8, T0 // 2, 2 * T0),
    Contract("fifo_doubled", 7, 8, T0 // 2, 4 * T0),
]


@pytest.mark.parametrize("c", CONTRACTS, ids=str)
@pytest.mark.parametrize("late", [-1, 0, 1])
def test_deadline_of_the_refill(c: Contract, late: int) -> None:
    """(n + 1) T: in time one clock before, a gap at that clock (boundary first) and after."""
    assert c.deadline == (c.n + 1) * c.dda
    latency = (c.deadline + late) * CLOCK
    result = run(c.scenario, 1.5, mcc__min_stock=c.n, mcc__irq_latency=latency)
    assert round(result["mcc.latency"].max() / CLOCK) == c.deadline + late
    gaps = result["card.underflows"][-1, 0]
    assert gaps == 0 if late < 0 else gaps > 50
    assert result["card.pulse_count"][-1, 0] == 20000
    assert not result["mcc.error"].any() and not result["card.frames_refused"].any()


@pytest.mark.parametrize("c", CONTRACTS, ids=str)
def test_an_interrupt_every_n_dda_times(c: Contract) -> None:
    """N T whatever the latency below T; doubled points at half T interrupt as often as before."""
    result = run(c.scenario, mcc__min_stock=c.n, mcc__irq_latency=1e-4)
    assert np.unique(np.diff(pulls(result))).tolist() == [c.batch * c.dda]
    assert c.batch * c.dda == (T0 if c.scenario == "fifo_one" else 4 * T0)
    stock = result["card.stock"][(result.time > 0.1) & (result.time < 0.4), 0]
    assert set(stock.tolist()) == set(range(c.n, c.n + c.batch + 1))


def test_stock_runs_7_6_5_4_3() -> None:
    result = run("fifo_four")
    stock = result["card.stock"][(result.time > 0.1) & (result.time < 0.4), 0]
    falls = stock[np.flatnonzero(np.diff(stock)) + 1].tolist()
    start = falls.index(7)
    rounds = [falls[i : i + 5] for i in range(start, len(falls) - 5, 5)]
    assert len(rounds) > 60 and all(r == [7, 6, 5, 4, 3] for r in rounds)


@pytest.mark.parametrize("latency", [8000, 41000, 80000])
def test_a_single_buffer_stands_still_until_the_write(latency: int) -> None:
    """The interrupt comes every T + L, the gap is L each time, to the clock."""
    t = 122880  # [clocks] 3.072 ms
    result = run("single_buffer_long", mcc__irq_latency=latency * CLOCK)
    moving = result["card.gap_clocks"][:, 0]
    steps = np.unique(np.diff(np.unique(moving)))
    assert steps.tolist() == [latency]
    seq, first = np.unique(result["card.irq_seq"], return_index=True)
    rate = (seq[-10] - seq[10]) / (result.time[first[-10]] - result.time[first[10]])
    assert rate == pytest.approx(1.0 / ((t + latency) * CLOCK), rel=2e-3)


def test_sources_are_served_by_priority() -> None:
    """Position loops, local I/O and timer, (FIFO), encoders, ADC; the remote input comes later."""
    result = run("interrupt_sources")
    inside = (result.time >= 0.0503) & (result.time < 0.0530)
    serving = result["mcc.serving"][inside]
    order = serving[np.r_[True, np.diff(serving) != 0]].tolist()
    assert order[-5:] == [9, 8, 2, 7, 5]
    pages = result["card.irq_pages"]
    assert 0b111000010 in pages  # encoders, ADC, local I/O, position loops at once


def test_each_service_lasts_its_time() -> None:
    result = run("interrupt_sources")
    t, serving = result.time, result["mcc.serving"]
    inside = (t >= 0.0504) & (t < 0.0530)
    change = t[inside][1:][np.diff(serving[inside]) != 0]
    assert np.diff(change)[:4] == pytest.approx(3e-4, abs=5.1e-5)  # seen on the 50 us grid
