"""One of two runs that are compared: a folder of results, or a scenario that is run now."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.columns import TIME, Columns
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file
from motionfmu.run import Result, Scenario, load
from motionfmu.run.result_files import NUMBERS, SIGNALS, TRACK, numbers, track

WANTED = ("scenario", "ok", "checks", "units", "figures", "run")


@dataclass(frozen=True)
class Side:
    """A run as its folder of results holds it."""

    name: str  # of its folder or scenario
    numbers: dict[str, Any] = field(repr=False)  # as in result.json
    time: NDArray[np.float64] = field(repr=False)  # [s]
    signals: Mapping[str, NDArray[Any]] = field(repr=False)
    track: Mapping[str, NDArray[Any]] = field(repr=False)  # as in contour/; empty without a contour


def side(given: "str | Path | Scenario | Result", set: Mapping[str, Any] | None = None) -> Side:
    """Read a folder of results, or run a scenario with values set."""
    if isinstance(given, Result):
        found, place = given, given.name
    elif isinstance(given, Scenario):
        found, place = given.run(set=set or {}), given.name
    elif is_file(Path(given) / NUMBERS):
        if set:
            raise InputError(f"{given}: a folder of results; only a scenario can be run with --set")
        return _read(Path(given))
    else:
        found = load(given).run(set=set or {})
        place = str(given)
    made = json.loads(json.dumps(numbers(found), default=str, allow_nan=False))
    way = track(found.contour()) if made.get("contour") else {}
    way = {name: np.asarray(x) for name, x in way.items()}
    return Side(place, made, found.time, found.signals, way)


def _read(folder: Path) -> Side:
    file = folder / NUMBERS
    try:
        made = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"cannot read {file}: {error.strerror}") from None
    except ValueError as error:
        raise InputError(f"{file}: no JSON: {error}") from None
    if not (folder / SIGNALS).is_dir():
        raise InputError(
            f"{folder}: no {SIGNALS}/; the folder of a run is wanted, with its signals"
        )
    if missing := [k for k in WANTED if not isinstance(made, dict) or k not in made]:
        raise InputError(f"{file}: no {missing[0]!r}: written by another version; run it again")
    signals, time = _columns(folder / SIGNALS, made["units"])
    if strange := sorted({*signals} - {*made["units"]}):
        raise InputError(f"{folder / SIGNALS}: signal {strange[0]!r} is not in {NUMBERS}")
    if short := next((n for n, x in signals.items() if len(x) != len(time)), ""):
        raise InputError(f"{folder / SIGNALS}: {short} has not as many samples as the time")
    wanted = made.get("contour") and (folder / TRACK).is_dir()
    return Side(str(folder), made, time, signals, _columns(folder / TRACK, ())[0] if wanted else {})


def _columns(folder: Path, order: Iterable[str]) -> tuple[Columns, NDArray[np.float64]]:
    """The signals in a folder, and their times; every file is checked."""
    file = f"{TIME}.npy"
    try:
        found = Columns.of(folder, order)
        time = found.time
        if time is None:
            raise InputError(f"{folder}: no {file}")
        for name in found:
            file = f"{name}.npy"
            found[name]
    except OSError as error:
        raise InputError(f"cannot read {error.filename}: {error.strerror or error}") from None
    except ValueError as error:
        raise InputError(f"{folder / file}: no array of numpy: {error}") from None
    return found, time
