"""Base parameters: the combinations of standard parameters on which torques depend.

A column of the regressor that is a combination of columns before it is left out, and those take
it in (Gautier 1991). The columns are ordered by preference, and the QR decomposition of a random
motion tells which depend on those before.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# A column whose part across those before it is below this share of itself depends on them.
_ACROSS = 1e-8
# Coefficients below this are none.
_NONE = 1e-9
# Coefficients above this are shown: below are those of joints that are not quite in their places.
_SHOWN = 1e-3


@dataclass(frozen=True)
class BaseParameters:
    """Which columns are kept, and what goes into each."""

    names: tuple[str, ...]  # of all columns
    units: tuple[str, ...]
    kept: NDArray[np.int64]  # columns kept, by their places
    combine: Array  # (kept, columns): base parameters of standard ones
    none: tuple[str, ...]  # columns that no torque depends on

    def text(self, k: int) -> str:
        """A base parameter as a sum of standard ones, but for the least."""
        own = self.kept[k]
        parts = [self.names[own]]
        for j in np.flatnonzero(np.abs(self.combine[k]) > _SHOWN):
            if j != own:
                c = float(self.combine[k, j])
                size = "" if abs(abs(c) - 1.0) < _NONE else f"{abs(c):.4g} "
                parts.append(f"{'-' if c < 0.0 else '+'} {size}{self.names[j]}")
        return " ".join(parts)


def base_parameters(
    matrix: Array, names: tuple[str, ...], units: tuple[str, ...], order: NDArray[np.int64]
) -> BaseParameters:
    """Find them of a regressor at random states, (rows, columns); `order` has columns by rank."""
    size = np.linalg.norm(matrix, axis=0)
    seen = size > _ACROSS * size.max()
    scaled = matrix / np.where(seen, size, 1.0)
    kept: list[int] = []
    basis = np.zeros((len(matrix), 0))
    for k in order:
        if not seen[k]:
            continue
        across = scaled[:, k]
        for _ in range(2):  # twice is enough
            across = across - basis @ (basis.T @ across)
        length = float(np.linalg.norm(across))
        if length > _ACROSS:
            kept.append(int(k))
            basis = np.column_stack([basis, across / length])
    own = np.array(kept, dtype=np.int64)
    combine = np.zeros((len(own), len(names)))
    shares, *_ = np.linalg.lstsq(scaled[:, own], scaled, rcond=None)
    combine[:] = shares * np.where(seen, size, 0.0) / size[own][:, None]
    combine[np.abs(combine) < _NONE] = 0.0
    combine[:, own] = np.eye(len(own))
    ranked = np.argsort(own)
    none = tuple(n for n, s in zip(names, seen, strict=True) if not s)
    return BaseParameters(names, units, own[ranked], combine[ranked], none)
