"""Of many cases a few are in `make test`, all in `make test-all`."""

import pytest
from few_cases import few

SLOW = pytest.mark.xdist_group("slow")
MORE = pytest.mark.more.mark


def kept(cases: list[object]) -> list[object]:
    """Those without the mark `more`."""
    return [c for c in cases if MORE not in [m.mark for m in getattr(c, "marks", ())]]


def test_as_many_as_are_asked_evenly_spread() -> None:
    found = few(range(10), 3)
    assert kept(found) == [0, 3, 6] and len(found) == 10
    assert found[1] == pytest.param(1, marks=pytest.mark.more)
    assert kept(few("ab", 2)) == ["a", "b"] and kept(few("ab", 1)) == ["a"]


def test_those_that_are_named() -> None:
    cases = ["a", ("b", 2), pytest.param("c", marks=SLOW), pytest.param("d", 4, marks=SLOW, id="e")]
    for chosen in ("a", ("b", 2), "c", ("d", 4)):
        assert len(kept(few(cases, [chosen]))) == 1
    later = few(cases, ["a"])
    assert later[1] == pytest.param("b", 2, marks=pytest.mark.more)
    assert later[2] == pytest.param("c", marks=(SLOW, pytest.mark.more))
    assert later[3] == pytest.param("d", 4, marks=(SLOW, pytest.mark.more), id="e")


@pytest.mark.parametrize("wrong", [["f"], ["a", "f"]])
def test_a_name_that_is_none_of_them_is_an_error(wrong: list[str]) -> None:
    with pytest.raises(AssertionError, match="is one of them"):
        few(["a", "b"], wrong)


def test_more_than_there_are_are_all() -> None:
    assert few(["a"], 3) == ["a"]
