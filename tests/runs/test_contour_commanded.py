"""What runs have in common is found once and kept, and nothing else is taken for it."""

from dataclasses import replace

import numpy as np
import pytest
from contour_runs import Machine, Program, run_along

from motionfmu.analysis.contour import analyse, pulse_path, scaled_values
from motionfmu.analysis.contour.instants import Instants
from motionfmu.analysis.contour.pulse_path import PulsePaths
from motionfmu.base.order import distinct, median, quantiles

PATH = Program(0, 0).line(20, 0).arc((20, 10), 6.0).line(0, 5).path()
RUN = run_along(PATH, 100.0, Machine(step=5e-4))


@pytest.fixture
def followed(monkeypatch):
    """The runs whose pulses were followed."""
    found, follow = [], pulse_path.commanded
    counting = lambda run, progress: (found.append(run), follow(run, progress))[1]  # noqa: E731
    monkeypatch.setattr(pulse_path, "commanded", counting)
    return found


def test_other_gains_have_the_same_pulses_and_figures_of_their_own(followed) -> None:
    known = PulsePaths()
    slow = replace(
        RUN, actual=run_along(PATH, 100.0, Machine(gains=(20, 20, 20), step=5e-4)).actual
    )
    for run in (RUN, slow, RUN):
        found, alone = analyse(run, known=known), analyse(run)
        assert found.numbers() == alone.numbers()
    assert len(followed) == 1 + 3  # of each alone, and once for all
    assert analyse(slow).error.max > 1.5 * analyse(RUN).error.max


def _later(run):
    values = np.array(run.commanded)
    values[len(values) // 2] += 1e-3
    return replace(run, commanded=values)


CHANGES = {
    "pulses": _later,
    "path": lambda run: replace(run, path=Program(0, 0).line(20, 0).arc((20, 10), 6.1).path()),
    "command": lambda run: replace(run, command=np.minimum(run.command, 1), newest=run.command),
    "newest": lambda run: replace(run, newest=np.maximum(run.command, 2)),
    "time": lambda run: replace(run, time=1.01 * run.time),
    "dda": lambda run: replace(run, dda_time=2e-3),
    "stock": lambda run: replace(run, stock=np.full(len(run.time), 9)),
}


@pytest.mark.parametrize("what", CHANGES)
def test_what_the_pulses_depend_on_is_looked_at(what: str, followed) -> None:
    known, other = PulsePaths(), CHANGES[what](RUN)
    analyse(RUN, known=known)
    assert analyse(other, known=known).numbers() == analyse(other).numbers()
    assert [id(run) for run in followed] == [id(RUN), id(other), id(other)]


def test_what_is_kept_is_bounded_and_the_longest_unused_goes(followed, monkeypatch) -> None:
    known = PulsePaths()
    analyse(RUN, known=known)
    (size,) = (i.size + pulse_path._size(c) for i, c in known._found.values())
    monkeypatch.setattr(pulse_path, "ROOM", int(2.5 * size))
    runs = [replace(RUN, dda_time=1e-3 * k) for k in (1, 2, 3)]
    for run in (runs[0], runs[1], runs[0], runs[2]):
        analyse(run, known=known)
    assert len(followed) == 3 and len(known._found) == 2
    analyse(runs[0], known=known)
    assert len(followed) == 3
    analyse(runs[1], known=known)
    assert len(followed) == 4
    texts = ["a" * pulse_path.TEXTS, "b"]
    first = known.path(texts[0], lambda text: PATH)
    assert known.path(texts[0], lambda text: pytest.fail("it was kept")) is first
    known.path(texts[1], lambda text: PATH)
    assert list(known._paths) == ["b"]


@pytest.mark.parametrize("uneven", [0.0, 0.3])
@pytest.mark.parametrize("shift", [0.0, 0.0123456, -0.0123456, 0.01, -0.01, 5.0, -5.0, 1e-9])
def test_a_shifted_signal_is_what_holds_then(uneven: float, shift: float) -> None:
    random = np.random.default_rng(3)
    time = 1e-3 * (np.arange(700) + uneven * random.uniform(0, 1, 700))
    values = random.integers(0, 100, 700)
    instants = Instants(time)
    assert instants.even == (uneven == 0.0)
    place = [max(0, int((time <= t + shift).sum()) - 1) for t in time]
    assert instants.shifted(values, shift).tolist() == values[place].tolist()


@pytest.mark.parametrize("uneven", [0.0, 0.3])
@pytest.mark.parametrize("span", [0.02, 0.0171, 1e-4, 2.0])
def test_a_speed_is_the_mean_over_its_span(uneven: float, span: float) -> None:
    random = np.random.default_rng(4)
    time = 1e-3 * (np.arange(500) + uneven * random.uniform(0, 1, 500))
    along = np.cumsum(random.uniform(0, 1, 500))
    found = Instants(time).speed(along, span, slice(3, 480))
    for k, t in enumerate(time[3:480]):
        a, b = max(t - span / 2, time[0]), min(t + span / 2, time[-1])
        way = np.interp(b, time, along) - np.interp(a, time, along)
        assert found[k] == pytest.approx(way / (b - a), rel=1e-9)


@pytest.mark.parametrize("count", [1, 2, 3, 10, 1001])
def test_order_is_that_of_numpy(count: int) -> None:
    values = np.random.default_rng(count).normal(size=count).round(1)
    shares = (0.0, 0.05, 0.34, 0.5, 0.999, 1.0)
    assert quantiles(values, shares) == pytest.approx(np.quantile(values, shares), abs=1e-15)
    assert median(values) == pytest.approx(np.median(values), abs=1e-15)
    assert distinct(values).tolist() == np.unique(values).tolist()
    assert distinct(values[:0]).tolist() == []


def test_the_share_that_is_done_grows_to_the_whole(monkeypatch) -> None:
    monkeypatch.setattr(scaled_values, "BLOCK", 400)
    shares: list[float] = []
    analyse(RUN, shares.append)
    assert len(shares) > 2 * len(RUN.time) // 400
    assert shares == sorted(shares) and shares[0] < 0.1 and shares[-1] == 1.0
