"""Signals by a table, against a walk over it in Python."""

import random

import pytest
from fmi_tools import Instance

ERROR, TICK = 3, 25e-9


def shown(rows: list[tuple[float, int, float]], now: float) -> dict[int, float]:
    """Value of each signal: that of its latest row, of two at one time the later."""
    past = sorted((at, k) for k, (at, _, _) in enumerate(rows) if at <= now + TICK / 2)
    return {rows[k][1]: rows[k][2] for _, k in past}


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_each_signal_shows_its_latest_row(fmi: int, seed: int) -> None:
    rng = random.Random(seed)
    rows = [
        (rng.randrange(0, 40) * 1e-4, rng.randint(1, 96), float(rng.randint(-3, 3)))
        for _ in range(rng.choice([1, 60, 128]))
    ]
    more = (0.0,) * (128 - len(rows))
    columns = [[*column, *more] for column in zip(*rows, strict=True)]
    given = dict(zip(("at", "signal", "value"), columns, strict=True))
    given["signal"] = [int(s) for s in given["signal"]]
    instance = Instance("stimulus", fmi).initialize(given)
    assert instance.set("offset", [0.5]) == 0
    for k in range(45):
        if k:
            assert instance.step(1e-4) == 0
            offset = 0.5
        else:
            offset = 0.0  # no step has seen the input
        wanted = [shown(rows, k * 1e-4).get(s, 0.0) for s in range(1, 97)]
        assert list(instance.get("real")) == [x + offset for x in wanted[:32]]
        assert list(instance.get("whole")) == wanted[32:64]
        assert list(instance.get("on")) == [x != 0 for x in wanted[64:]]
    instance.free()


def test_a_whole_number_has_32_bits() -> None:
    given = {"signal": [33] + [0] * 127, "value": [3e9] + [0.0] * 127}
    instance = Instance("stimulus", 3)
    for name, values in given.items():
        assert instance.set(name, values) == 0
    with pytest.raises(AssertionError):
        instance.initialize({})
    assert "value[1] = 3000000000: beyond a whole number of 32 bits" in instance.said
    instance.free()
