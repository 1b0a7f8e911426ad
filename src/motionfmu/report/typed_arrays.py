"""Numbers as plotly's typed arrays."""

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray


def packed(values: NDArray[Any], exact: bool = False) -> dict[str, str]:
    """Pack numbers as one base64 text, with its type."""
    # 32 bits hold 7 digits, which a screen never shows. Exact keeps all 64 of a float: for the
    # times of a short stretch late in a run, for counts; so do numbers beyond the range of 32 bits.
    kind = "i4" if values.dtype.kind in "iu" else "f8" if exact else "f4"
    try:
        with np.errstate(over="raise"):
            raw = np.ascontiguousarray(values, dtype="<" + kind).tobytes()
    except FloatingPointError:
        return packed(values, exact=True)
    return {"dtype": kind, "bdata": base64.b64encode(raw).decode()}
