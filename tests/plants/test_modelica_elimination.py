"""The solution of coupled linear equations against numpy, and pivots that are refused."""

import sys

import casadi as ca
import numpy as np
import pytest

from motionfmu.fmu.modelica import elimination


def solved(a, b, values=None, **at):
    """Solution of the elimination at a point."""
    labels = [f"z{k}" for k in range(b.numel())]
    x = elimination.solve(ca.SX(a), ca.SX(b), values or {}, labels)
    names = ca.symvar(ca.veccat(x))
    point = ca.DM([at[str(s)] for s in names]) if names else ca.DM(0, 1)
    return np.array(ca.Function("x", [ca.vertcat(ca.SX(0, 1), *names)], [x])(point)).ravel()


@pytest.mark.parametrize("seed", range(8))
def test_random_sparse_systems(seed):
    """Chains of sums with a positive definite rest, rows and columns shuffled."""
    rng = np.random.default_rng(seed)
    n, core = 40, 4
    s = ca.SX.sym("s", 6)
    spread = rng.uniform(0.5, 1.5, (core, core))
    moving = ca.SX(spread @ spread.T + core * np.eye(core)) + ca.diag(s[:core] ** 2)
    a = ca.SX.eye(n)
    a[:core, :core] = moving
    for i in range(core, n):
        for j in rng.choice(i, 2, replace=False):
            a[i, int(j)] = (
                ca.sin(s[int(j) % 6]) if rng.random() < 0.5 else float(rng.integers(1, 4))
            )
    rows, columns = (rng.permutation(n).tolist() for _ in range(2))
    a, b = a[rows, columns], ca.SX(rng.normal(size=n)) * s[5]
    at = {f"s_{k}": v for k, v in enumerate(rng.normal(size=6))}
    found = solved(a, b, **at)
    exact = ca.Function("f", [s], [ca.densify(a), b])(list(at.values()))
    wanted = np.linalg.solve(*(np.array(m) for m in exact)).ravel()
    assert found == pytest.approx(wanted, rel=1e-9, abs=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("seed", range(8))
def test_an_array_of_zeros_changes_no_bit(seed):
    """Coefficients of 0 anywhere but on the way: the same pivots and rounding as without them."""
    rng = np.random.default_rng(seed)
    n = 30
    s, p = ca.SX.sym("s", 3), [ca.SX.sym(f"p[{k}]") for k in range(60)]
    a = 4.0 * ca.SX.eye(n)
    for i in range(n):
        for j in rng.choice(n, 2, replace=False):
            a[i, int(j)] += ca.sin(s[int(j) % 3])
    more = ca.SX(a)
    for q in p:
        i, j = (int(k) for k in rng.integers(0, n, 2))
        if more[i, j].is_zero():
            more[i, j] = q if rng.random() < 0.5 else -q
    b = ca.SX(rng.normal(size=n))
    at = {f"s_{k}": v for k, v in enumerate(rng.normal(size=3))}
    none = {str(q): 0.0 for q in p}
    plain = solved(a, b, **at)
    assert (solved(more, b, none, **at, **none) == plain).all()
    # What they are when they are not 0 is part of the solution.
    some = {str(q): v for q, v in zip(p, rng.uniform(-0.5, 0.5, len(p)), strict=True)}
    names = ca.vertcat(s, *p)
    matrix = ca.Function("f", [names], [ca.densify(more)])([*at.values(), *some.values()])
    wanted = np.linalg.solve(np.array(matrix), np.array(ca.DM(b))).ravel()
    assert solved(more, b, none, **at, **some) == pytest.approx(wanted, rel=1e-8, abs=1e-8)
    assert np.abs(wanted - plain).max() > 1e-3


def test_a_pivot_that_changes_its_sign_is_not_taken():
    """The first coefficient is no pivot, nor the least filling one; with another order it goes."""
    x = ca.SX.sym("x")
    a = ca.vertcat(ca.horzcat(x, 1 + x * x), ca.horzcat(2 + x * x, x))
    assert solved(a, ca.SX([1.0, 2.0]), x=0.0) == pytest.approx([1.0, 1.0])
    rotated = ca.vertcat(ca.horzcat(ca.cos(x), -ca.sin(x)), ca.horzcat(ca.sin(x), ca.cos(x)))
    with pytest.raises(elimination.NoPivot, match="for z0, z1 have no pivot that never vanishes"):
        solved(rotated, ca.SX([1.0, 2.0]), x=0.0)


def test_parameters_are_looked_at_near_their_values():
    """A mass is no pivot that may vanish; what a switch at 0 puts in its place is looked at."""
    m, gap = ca.SX.sym("m"), ca.SX.sym("gap")
    a = ca.vertcat(ca.horzcat(m, m), ca.horzcat(-m, m))
    assert solved(a, ca.SX([2.0, 0.0]), {"m": 3.0}, m=2.0) == pytest.approx([0.5, 0.5])
    with pytest.raises(elimination.NoPivot, match="no pivot"):
        solved(a, ca.SX([2.0, 0.0]), m=2.0)
    a = ca.vertcat(ca.horzcat(ca.if_else(gap > 0, 0, m), m), ca.horzcat(m, 0.5 * m))
    found = solved(a, ca.SX([2.0, 6.0]), {"m": 1.0, "gap": 0.0}, m=1.0, gap=1.0)
    assert found == pytest.approx([5.0, 2.0])


def test_a_hundred_unknowns_are_soon_solved():
    """As many as an arm of six joints has, as a chain: counted, as seconds are the machine's."""
    n, s = 100, ca.SX.sym("s", 100)
    a = ca.SX.eye(n)
    for k in range(1, n):
        a[k, k - 1] = 0.4 * ca.cos(s[k])
        a[k - 1, k] = 0.4 * ca.sin(s[k])
    calls = 0

    def count(_frame, event, _what):
        nonlocal calls
        calls += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        x = elimination.solve(a, s, {}, [f"z{k}" for k in range(n)])
    finally:
        sys.setprofile(before)
    assert 2e4 < calls < 4e5  # 1.2e5, half a second
    assert n < ca.Function("x", [s], [x]).n_instructions() < 25 * n
