"""A file of MATLAB as columns of numbers."""

from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.records.layout import Layout
from motionfmu.records.quantities import name_and_unit
from motionfmu.records.raw_table import RawTable

_HDF5 = b"\x89HDF\r\n\x1a\n"
_HEAD = 512  # [bytes] an HDF5 file of MATLAB begins with its own text


def mat_table(file: Path, layout: Layout) -> RawTable:
    """Read arrays of one length, also those in structures: ``out.time``, ``out.signals.values``."""
    needed("report")
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        with file.open("rb") as stream:
            head = stream.read(_HEAD + len(_HDF5))
        if head[_HEAD:] == _HDF5 or head.startswith(_HDF5):
            told = 'a file of MATLAB 7.3, which is HDF5: save(name, "-v7") writes one that is read'
            raise InputError(f"{file}: {told}")
        found = loadmat(file, squeeze_me=True, struct_as_record=False)
    except OSError as error:
        raise InputError(f"{file}: {error.strerror or error}") from None
    except (MatReadError, ValueError, NotImplementedError, TypeError, IndexError) as error:
        raise InputError(f"{file}: no file of MATLAB: {error}") from None
    arrays: dict[str, Any] = {}
    for name, value in found.items():
        if not name.startswith("__"):
            _collect(name, value, arrays)
    rows = _rows(file, arrays, layout)
    names: list[str] = []
    units: list[str | None] = []
    values: list[Any] = []
    for name, data in arrays.items():
        own, unit = name_and_unit(name)
        if data.shape[0] != rows:
            data = data.T
        parts = [data] if data.ndim == 1 else list(data.T)
        for i, part in enumerate(parts):
            names.append(own if data.ndim == 1 else f"{own}[{i + 1}]")
            units.append(unit)
            values.append(part)

    def where(row: int, k: int) -> str:
        return f"{file}: {names[k]}" + (f"({row + 1})" if row >= 0 else "")

    return RawTable(str(file), names, units, values, where)


def _collect(name: str, value: Any, found: dict[str, Any]) -> None:
    """The arrays of numbers of a variable, by their names."""
    if hasattr(value, "_fieldnames"):
        for key in value._fieldnames:
            _collect(f"{name}.{key}", getattr(value, key), found)
    elif isinstance(value, np.ndarray) and value.dtype == object:
        for i, one in enumerate(value.ravel()):
            _collect(f"{name}({i + 1})", one, found)
    elif isinstance(value, np.ndarray) and value.dtype.kind in "fiub" and value.ndim in (1, 2):
        found[name] = value


def _rows(file: Path, arrays: dict[str, Any], layout: Layout) -> int:
    """The length of the record, that of its times; what has another one is left out."""
    if not arrays:
        raise InputError(f"{file}: no array of numbers in it")
    last = {name: name.rpartition(".")[2].lower() for name in arrays}
    times = [n for n in arrays if n == layout.time]
    times = times or [n for n in arrays if last[n] in ("t", "time", "tout") and arrays[n].ndim == 1]
    if times:
        if layout.time is None:
            arrays["time"] = arrays.pop(times[0])
            times = ["time"]
        rows = len(arrays[times[0]])
    else:
        rows = max(max(x.shape) for x in arrays.values())
    for name in [n for n, x in arrays.items() if rows not in x.shape]:
        del arrays[name]
    return rows
