"""Numbers of docs/theory and of the C files that use them, from their definitions."""

import math
import re

import numpy as np
import pytest
from conftest import ROOT

T = np.linspace(0.0, 1.0, 20_001)


def constant(file: str, name: str) -> float:
    """A number that a C file defines."""
    text = (ROOT / "src/motion" / file).read_text()
    return float(re.search(rf"\b{name} = ([0-9.e-]+)", text)[1])  # type: ignore[index]


def test_blend_of_look_ahead() -> None:
    """Its bounds hold, and none is more than twice as wide as it must be."""
    part, x = 0.5 * T, T  # the half of it before the vertex; all of it
    h, steep, y = 3 * x**2 - 2 * x**3, 3 * x * (1 - x), 2 * x**3 * (1 - 0.5 * x)
    s = 2 * x - 1
    assert constant("trajectory/corner.c", "CUT") == y[T == 0.5][0]
    near, off = 2 * part - 1, 2 * part**3 * (1 - 0.5 * part)
    before, behind = 0.5 * (off**2 - 2 * off * near).max(), 0.5 * (off**2).max()
    print(f"off by the curvature before {before:.5f}, behind {behind:.5f}")
    assert max(before, behind) <= constant("trajectory/corner.c", "CUT_CURVED") < 2 * before
    bend = ((1 - h) ** 2 + h**2 + steep * (2 * y - s)).max()
    assert bend <= constant("trajectory/corner.c", "BEND_CURVED") < 1.01 * bend
    twist = (3 * steep + 1.5 * abs(1 - 2 * x) * (2 * y - s)).max()
    print(f"bend {bend:.4f}, twist {twist:.4f}")
    assert twist <= 4.0 < 2 * twist


def out(p: float) -> np.ndarray:
    """How far inside its line the first half of a corner is, p of the half length at its end."""
    bend = constant("smooth/shape_corner.c", "BEND")
    more, cut = (constant("smooth/shape_corner.c", name) for name in ("MORE_BEND", "CUT"))
    end = bend + more * (2 * cut - p)
    control = [0.0, 0.0, 0.0, p + end / 20.0 - 0.4, p - 0.2, p]
    return sum(math.comb(5, k) * T**k * (1 - T) ** (5 - k) * c for k, c in enumerate(control))


def test_how_far_a_corner_swings_out() -> None:
    """With p = SWING cos as far as it cuts in, to 4 % at small turns; at large ones farther."""
    assert out(0.375).min() == 0.0
    swing = constant("smooth/shape_corner.c", "SWING")
    for degrees in range(1, 160, 3):
        cosine = math.cos(math.radians(degrees) / 2)
        ratio = -out(swing * cosine).min() * cosine / (swing * cosine)
        assert ratio > (0.94 if degrees < 48 else 1.0), degrees


def test_angles_of_corners() -> None:
    """sin^2 of half an angle, as the code compares them."""
    for name, degrees in (("SHARP", 53.13), ("TURN", 25.0)):
        half = math.radians(degrees) / 2
        value = constant("smooth/shape_turn.c", name)
        assert value == pytest.approx(math.sin(half) ** 2, rel=2e-3)


def farthest(w: np.ndarray, base: float, v1: float, sag: bool) -> tuple[np.ndarray, np.ndarray]:
    """Time and place of two pulses that are not held."""
    x, y = np.sqrt(w - base) * (-1 if sag else 1), np.sqrt(w - v1)
    return 2 * (x + y), (base + w) * x + (w + v1) * y


@pytest.mark.parametrize(
    ("base", "v1", "sag"), [(0.2, 0.1, False), (-0.5, -3.0, True), (-0.5, 0.3, False)]
)
def test_growth_of_the_farthest_place(base: float, v1: float, sag: bool) -> None:
    """d way / dT = w + x y / 2, and the equation of both peaks' sum."""
    w = max(base, v1) + np.linspace(0.3, 2.0, 200_001)
    time, way = farthest(w, base, v1, sag)
    x, y = np.sqrt(w - base) * (-1 if sag else 1), np.sqrt(w - v1)
    growth = np.gradient(way, time)[5:-5]
    assert np.abs(growth - (w + 0.5 * x * y)[5:-5]).max() < 1e-4
    z, d = x + y, v1 - base
    assert np.abs(z**4 + 4 * (base + v1) * z**2 - 4 * way * z - d**2).max() < 1e-9
