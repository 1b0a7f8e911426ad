"""A Parquet file as columns of numbers."""

from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.records.layout import Layout
from motionfmu.records.quantities import name_and_unit
from motionfmu.records.raw_table import RawTable

UNIT = b"unit"  # key of a column's metadata


def parquet_table(file: Path, layout: Layout) -> RawTable:
    """Read a Parquet file; units are in the metadata of its columns, or in their names."""
    needed("study")
    import pyarrow
    from pyarrow import parquet

    try:
        table = parquet.read_table(file)
    except (pyarrow.ArrowException, OSError) as error:
        raise InputError(f"{file}: no Parquet file: {str(error).splitlines()[0]}") from None
    if not table.num_rows:
        raise InputError(f"{file}: nothing in it")
    names: list[str] = []
    units: list[str | None] = []
    values: list[Any] = []
    stamps = set()
    for schema, column in zip(table.schema, table.columns, strict=True):
        told = (schema.metadata or {}).get(UNIT)
        name, unit = name_and_unit(schema.name)
        if told is not None:
            name, unit = schema.name, told.decode() or None
        for own, data, stamp in _parts(file, name, column):
            if stamp:
                stamps.add(len(names))
            names.append(own)
            units.append(unit)
            values.append(data)

    def where(row: int, k: int) -> str:
        return f"{file}: column {names[k]!r}" + (f", row {row + 1}" if row >= 0 else "")

    return RawTable(str(file), names, units, values, where, stamps=frozenset(stamps))


def _parts(file: Path, name: str, column: Any) -> list[tuple[str, Any, bool]]:
    """A column, or the elements of one of lists, as numbers; what is no number is an error."""
    import pyarrow

    kind = column.type
    if pyarrow.types.is_fixed_size_list(kind):
        flat = column.combine_chunks()
        data = flat.flatten().to_numpy(zero_copy_only=False).reshape(len(column), kind.list_size)
        return [(f"{name}[{i + 1}]", data[:, i], False) for i in range(kind.list_size)]
    if pyarrow.types.is_timestamp(kind) or pyarrow.types.is_duration(kind):
        day = pyarrow.types.is_timestamp(kind)
        fine = pyarrow.timestamp("ns", kind.tz) if day else pyarrow.duration("ns")
        return [(name, column.cast(fine).cast(pyarrow.int64()).to_numpy(), True)]
    numbers = pyarrow.types
    if numbers.is_integer(kind) or numbers.is_floating(kind) or numbers.is_boolean(kind):
        data = column.to_numpy()
        if data.dtype == object:  # Booleans of which some are missing
            data = np.array([np.nan if x is None else float(x) for x in data])
        return [(name, data, False)]
    if numbers.is_decimal(kind):
        return [(name, column.cast(pyarrow.float64()).to_numpy(), False)]
    raise InputError(f"{file}: column {name!r} is {kind}: numbers wanted")
