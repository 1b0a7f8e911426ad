"""Signals of a run by their names: whole arrays, elements, a table."""

import fnmatch
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import UnknownSignal, suggestion
from motionfmu.base.extras import needed

if TYPE_CHECKING:
    import pandas

AXES = 6
TIME = "time [s]"
Signals = Mapping[str, NDArray[Any]]


def locked(data: NDArray[Any]) -> NDArray[Any]:
    """The same array, which cannot be written to any more."""
    data.flags.writeable = False
    return data


def signal(signals: Signals, name: str) -> NDArray[Any]:
    """A signal, or with ``name[i]`` an element of it, i from 1; else `UnknownSignal`."""
    if not isinstance(name, str):
        raise UnknownSignal(f"{name!r}: the name of one signal wanted, such as 'card.stock'")
    if name in signals:
        return signals[name]
    whole, bracket, rest = name.partition("[")
    if not bracket or whole not in signals:
        hint = suggestion(whole, signals) or _recorded(signals)
        raise UnknownSignal(f"no signal {whole!r} is recorded{hint}")
    data, index = signals[whole], rest.removesuffix("]")
    if data.ndim == 1:
        raise UnknownSignal(f"{name}: {whole} is a single value")
    count = data.shape[1]
    if not (rest.endswith("]") and index.isdecimal() and 1 <= int(index) <= count):
        what = "axes" if count == AXES else "elements"
        raise UnknownSignal(f"{name}: {whole} has {count} {what}, [1] to [{count}]")
    return data[:, int(index) - 1]


def _recorded(signals: Signals) -> str:
    return f" (there are: {', '.join(sorted(signals))})" if signals else ": the run records none"


def matching(signals: Signals, patterns: str | Iterable[str]) -> list[str]:
    """Signals that names, and patterns with ``*`` and ``?``, mean, each once."""
    found: dict[str, None] = {}
    for pattern in [patterns] if isinstance(patterns, str) else patterns:
        if isinstance(pattern, str) and ("*" in pattern or "?" in pattern):
            named = [n for n in signals if fnmatch.fnmatchcase(n, pattern.replace("[", "[[]"))]
            if not named:
                raise UnknownSignal(f"{pattern!r} matches no signal{_recorded(signals)}")
        else:
            signal(signals, pattern)
            named = [pattern]
        found.update(dict.fromkeys(named))
    return list(found)


def elements(signals: Signals, name: str) -> dict[str, NDArray[Any]]:
    """Columns of a signal: ``name[1]``, ``name[2]`` and so on, or itself."""
    data = signal(signals, name)
    return {f"{name}[{k + 1}]": c for k, c in enumerate(data.T)} if data.ndim == 2 else {name: data}


def table(
    time: NDArray[np.float64], signals: Signals, names: str | Iterable[str] | None
) -> "pandas.DataFrame":
    """A table over time with a column for each element, in memory of its own."""
    needed("pandas")
    import pandas

    columns: dict[str, NDArray[Any]] = {}
    for name in signals if names is None else matching(signals, names):
        columns |= elements(signals, name)
    return pandas.DataFrame(columns, pandas.Index(time.copy(), name=TIME), copy=True)
