"""Of many cases a few are in `make test`, all in `make test-all`."""

from collections.abc import Collection, Iterable
from typing import Any

import pytest


def few(
    cases: Iterable[Any],
    kept: int | Collection[Any],
    later: pytest.MarkDecorator = pytest.mark.more,
) -> list[Any]:
    """Parameters, of which all but some have the mark `later`: so many, evenly spread, or these.

    A case is what parametrize takes: a value, a tuple of them or a pytest.param.
    """
    found = list(cases)
    if isinstance(kept, int):
        places = {k * len(found) // kept for k in range(kept)}
    else:
        places = {k for k, case in enumerate(found) if _value(case) in kept}
        assert len(places) == len(kept), "a case that is kept is one of them"
    return [case if k in places else _marked(case, later) for k, case in enumerate(found)]


def _value(case: Any) -> Any:
    values = getattr(case, "values", None)
    return case if values is None or callable(values) else values if len(values) > 1 else values[0]


def _marked(case: Any, mark: pytest.MarkDecorator) -> Any:
    values, marks, name = (case,), (), None
    if isinstance(case, tuple):  # pytest.param gives one, too
        values = tuple(getattr(case, "values", case))
        marks, name = getattr(case, "marks", ()), getattr(case, "id", None)
    return pytest.param(*values, marks=(*marks, mark), id=name)
