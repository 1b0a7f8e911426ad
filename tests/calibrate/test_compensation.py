"""Tables that take a known error away."""

from pathlib import Path

import numpy as np
import pytest
from test_lead_error import BACKLASH, SIZE, made, targets

from motionfmu import InputError
from motionfmu.calibrate import (
    compensation_table,
    compensation_tables,
    compensation_text,
    lead_error,
)

PULSE = 2e-4
ROOT = Path(__file__).parents[2]


def test_a_table_leaves_half_a_pulse_and_the_chords_of_the_wave() -> None:
    error = lead_error(made(targets(), 0.0))
    table = compensation_table(error, 1, PULSE)
    x = np.linspace(-200.0, 200.0, 997)
    forward, backward = table.at(x, PULSE)
    mean = error.mean(x)
    zero = float(error.mean(np.zeros(1))[0]) - BACKLASH / 2
    step = 2 * np.pi / 130.0 * table.interval * PULSE
    chord = SIZE * (1 - np.cos(step / 2))
    left = np.array([mean - BACKLASH / 2 + forward, mean + BACKLASH / 2 + backward]) - zero
    assert np.abs(left).max() < 0.5 * PULSE + chord + 1e-6
    assert np.abs(left).max() > 0.4 * PULSE
    # the origin, approached upwards, stays
    assert table.forward[table.home] == 0


def test_a_table_in_force_is_added() -> None:
    error = lead_error(made(targets(), 0.0))
    first = compensation_table(error, 1, PULSE)
    again = compensation_table(error, 1, PULSE, first)
    assert (np.abs(again.forward - 2 * first.forward) <= 1).all()
    assert (np.abs(again.backward - 2 * first.backward) <= 1).all()


def test_the_origin_is_in_a_table_of_targets_beside_it() -> None:
    x = np.linspace(100.0, 300.0, 9)
    table = compensation_table(lead_error(made(x, 0.0, size=0.0)), 2, PULSE)
    assert table.home == 0 and table.places(PULSE)[-1] >= 300.0


def test_more_points_than_a_table_has_are_spread() -> None:
    x = np.linspace(-1000.0, 1000.0, 401)
    table = compensation_table(lead_error(made(x, 0.0)), 1, PULSE)
    assert len(table.forward) <= 256
    assert table.places(PULSE)[0] <= -1000.0 and table.places(PULSE)[-1] >= 1000.0


def test_text_is_read_back_and_as_the_package_has_it(tmp_path: Path) -> None:
    tables = [compensation_table(lead_error(made(targets(), 0.0)), k, PULSE) for k in (1, 3)]
    file = tmp_path / "c.csv"
    file.write_text(compensation_text(tables, "made"))
    read = compensation_tables(file)
    assert list(read) == [1, 3]
    for table in tables:
        own = read[table.axis]
        assert (own.interval, own.home) == (table.interval, table.home)
        assert (own.forward == table.forward).all() and (own.backward == table.backward).all()
    screw = compensation_tables(ROOT / "scenarios/compensation/screw.csv")[1]
    assert (screw.interval, screw.home, len(screw.forward)) == (100000, 10, 21)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("1,2,3\n", "line 1: '1,2,3': not 3 whole numbers"),
        ("axis,interval,home\n1,2\n", "line 2"),
        ("axis,interval,home\n1,100,0\n", "axis 1 has an interval and no points"),
        ("axis,index,forward,backward\n1,0,0,0\n", "line 2: axis 1 has no interval yet"),
    ],
)
def test_a_wrong_table_is_refused(tmp_path: Path, text: str, told: str) -> None:
    file = tmp_path / "c.csv"
    file.write_text(text)
    with pytest.raises(InputError, match=r"c\.csv") as refused:
        compensation_tables(file)
    assert told in str(refused.value)


def test_an_error_beyond_the_range_of_a_table_is_refused() -> None:
    error = lead_error(made(targets(), 0.0))
    with pytest.raises(InputError, match="32767 at most"):
        compensation_table(error, 1, 1e-8)
