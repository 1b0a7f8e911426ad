"""Two runs side by side, and their page."""

import fnmatch
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.extras import needed
from motionfmu.compare import overlay
from motionfmu.compare.comparison_page import write_comparison
from motionfmu.compare.comparison_view import comparison_html, comparison_text
from motionfmu.compare.pairing import Pairing
from motionfmu.compare.side import side
from motionfmu.run import Result, Scenario


class Comparison(Pairing):
    """Two runs side by side; every difference is B - A.

    Attributes
    ----------
    a, b : Side
        The runs: name, numbers as in result.json, time, signals, track.
    common : Common
        The instants at which signals are compared, and how they were found.
    names : list of str
        Signals that both runs have and that can be compared; ``comparison[name]`` has a, b and
        difference of one, common samples x axes.
    left : dict
        Why a signal is not among them, by its name.
    signals : list of Apart
        How far apart each signal is.
    different : list of Different
        What was run differently.
    checks : list of Checked
        Verdicts side by side.
    worse : list of str
        Checks that held in A and fail in B, or, if A holds as a whole, that fail in B.
    ok : bool
        Whether there is none of these.
    """

    def __repr__(self) -> str:
        return comparison_text(self)

    def _repr_html_(self) -> str:
        needed("report")
        return comparison_html(self)

    def save(self, folder: str | Path) -> Path:
        """Write the page and result.json, whole or not at all.

        Parameters
        ----------
        folder : str or Path
            New, empty, or with an older result.

        Returns
        -------
        Path
            The page.

        Raises
        ------
        InputError
            The folder cannot be written, or holds something else.
        """
        return write_comparison(self, Path(folder))


def compare(
    a: "str | Path | Scenario | Result",
    b: "str | Path | Scenario | Result",
    signals: Iterable[str] = ("*",),
    set: Mapping[str, Any] | None = None,
) -> Comparison:
    """Lay one run over another.

    Parameters
    ----------
    a, b : str, Path, Scenario or Result
        A folder of results, a scenario that is run now, or a result.
    signals : iterable of str
        Names or patterns of the signals to compare.
    set : mapping, optional
        Values for the run of B, a scenario: ``{"mcc.p_gain": 300}``.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        A folder holds no run, the runs have nothing in common, or a pattern fits no signal.
    """
    if set and isinstance(b, Result):
        raise InputError("set: B is a result that has been run; a scenario is wanted")
    first, second = side(a), side(b, set)
    known = list(dict.fromkeys((*first.signals, *second.signals)))
    chosen = []
    for pattern in signals:
        fits = fnmatch.filter(known, pattern)
        if not fits:
            told = suggestion(pattern, known)
            raise InputError(f"no signal {pattern!r} in {first.name} and {second.name}{told}")
        chosen += fits
    names, left = [], {}
    at = overlay.common(first, second)
    for name in (n for n in known if n in {*chosen}):
        if name not in first.signals or name not in second.signals:
            left[name] = f"only in {'A' if name in first.signals else 'B'}"
        elif why := overlay.mismatch(name, first, second):
            left[name] = why
        else:
            names.append(name)
    found = Comparison(first, second, at, names, left)
    if not names and not any(None not in c.bounds for c in found.checks):
        raise InputError(f"{first.name} and {second.name} have no signal and no check in common")
    return found
