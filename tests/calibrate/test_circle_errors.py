"""Geometry of two axes in circles made in closed form."""

from pathlib import Path

import numpy as np
import pytest

from motionfmu import InputError
from motionfmu.calibrate import CircleChoice, circle_errors, circle_record

RADIUS = 100.0
SQUARE, SCALE, BX, BY, LAG = 80e-6, 50e-6, 6e-3, 4e-3, 2e-3
CENTRE = (3e-3, -5e-3)


def circle(way: int, square: float = SQUARE, scale: float = SCALE) -> tuple[np.ndarray, ...]:
    """Command angle, and where two axes with errors stand, about the nominal centre [mm]."""
    a = way * np.linspace(0.0, 4.0 * np.pi, 7201)
    x, y = RADIUS * np.cos(a), RADIUS * np.sin(a)
    # an axis that lags by its own time: the one the first axis has more turns the oval about
    x = RADIUS * np.cos(a - way * LAG / RADIUS)
    for place, width, speed in ((x, BX, -way * np.sin(a)), (y, BY, way * np.cos(a))):
        # behind a gap the table stands back by half of it, and takes all of it up at a reversal
        shift = 0.5 * width * np.sign(speed)
        shift = np.where(speed == 0.0, 0.0, shift)
        place -= shift
    x, y = x * (1.0 + 0.5 * scale), y * (1.0 - 0.5 * scale)
    x = x - square * y
    return a, x + CENTRE[0], y + CENTRE[1]


def ballbar(tmp_path: Path, noise: float = 0.0, **errors: float) -> Path:
    rng = np.random.default_rng(4)
    rows = ["angle [deg],deviation [um]"]
    for way in (1, -1):
        a, x, y = circle(way, **errors)
        size = (np.hypot(x, y) - RADIUS) * 1e3 + noise * rng.normal(size=len(a))
        start = 0.0 if way > 0 else 720.0
        angle = np.degrees(np.unwrap(np.arctan2(y, x)))
        angle = angle - angle[0] + start
        rows += [f"{p:.6f},{d:.6f}" for p, d in zip(angle, size, strict=True)]
    file = tmp_path / "ballbar.csv"
    file.write_text("\n".join(rows) + "\n")
    return file


def found(file: Path, plane: str = "XY", **choice: object):
    record = circle_record([file], plane, CircleChoice(radius=RADIUS, **choice))
    return record, circle_errors(record.test, plane)


def test_every_part_is_that_of_the_formula(tmp_path: Path) -> None:
    _, errors = found(ballbar(tmp_path))
    # second orders: angles are those of the tool, deviations 1e-4 of the radius
    assert errors.squareness.value == pytest.approx(SQUARE, abs=3e-7)
    assert errors.scale.value == pytest.approx(SCALE, abs=3e-7)
    assert [b.value for b in errors.backlash] == pytest.approx([BX, BY], abs=3e-5)
    assert [c.value for c in errors.centre] == pytest.approx(CENTRE, abs=3e-5)
    assert errors.mismatch.value == pytest.approx(0.5 * LAG, abs=3e-5)


def test_squareness_is_the_angle_from_the_first_axis_to_the_second(tmp_path: Path) -> None:
    _, x, y = circle(1, square=1e-3, scale=0.0)
    y_axis = np.array([x[np.argmax(y)], y[np.argmax(y)]])
    assert np.degrees(np.arctan2(*y_axis[::-1])) > 90.0  # more than 90 degrees
    _, errors = found(ballbar(tmp_path, square=1e-3, scale=0.0))
    assert errors.squareness.value == pytest.approx(1e-3, rel=1e-3)


def test_values_are_within_their_deviations(tmp_path: Path) -> None:
    _, errors = found(ballbar(tmp_path, noise=2.0))
    for e, truth in (
        (errors.squareness, SQUARE),
        (errors.scale, SCALE),
        (errors.backlash[0], BX),
        (errors.backlash[1], BY),
        (errors.mismatch, 0.5 * LAG),
    ):
        assert abs(e.value - truth) < 4.0 * e.deviation
        assert e.deviation < 0.3 * truth


def test_places_in_the_machine_have_a_centre(tmp_path: Path) -> None:
    rows = ["Z [mm],X [mm]"]
    for way in (1, -1):
        _, z, x = circle(way)
        rows += [f"{p + 30.0:.7f},{q - 120.0:.7f}" for p, q in zip(z, x, strict=True)]
    file = tmp_path / "zx.csv"
    file.write_text("\n".join(rows) + "\n")
    record, errors = found(file, "ZX")
    assert record.centre == (30.0, -120.0)
    assert errors.squareness.value == pytest.approx(SQUARE, abs=3e-7)
    assert [c.value for c in errors.centre] == pytest.approx(CENTRE, abs=3e-5)


@pytest.mark.parametrize(
    ("rows", "radius", "told"),
    [
        ("angle,deviation\n0,1\n", None, "--radius"),
        ("angle,deviation\n0,1\n90,1\n", -1.0, "--radius"),
        ("X [mm],Y [mm]\n10,0\n0,10\n-10,0\n0,-10\n", 100.0, "R 10 mm, --radius says 100"),
        ("X [mm],Y [mm]\n100,0\n0,100\n-100,\n0,-100\n", 100.0, "a value is missing"),
        ("angle,size\n0,1\n1,2\n", 100.0, "angle and deviation or radius wanted"),
    ],
)
def test_a_wrong_circle_is_one_message(
    tmp_path: Path, rows: str, radius: float | None, told: str
) -> None:
    file = tmp_path / "c.csv"
    file.write_text(rows)
    with pytest.raises(InputError, match=r"c\.csv") as refused:
        circle_record([file], "XY", CircleChoice(radius=radius))
    assert told in str(refused.value)


def test_one_way_round_tells_no_geometry(tmp_path: Path) -> None:
    a, x, y = circle(1)
    rows = [f"{p:.6f},{d:.6f}" for p, d in zip(np.degrees(a), np.hypot(x, y) - RADIUS, strict=True)]
    file = tmp_path / "c.csv"
    file.write_text("angle [deg],deviation [mm]\n" + "\n".join(rows) + "\n")
    with pytest.raises(InputError, match="no circle clockwise"):
        circle_record([file], "XY", CircleChoice(radius=RADIUS))
