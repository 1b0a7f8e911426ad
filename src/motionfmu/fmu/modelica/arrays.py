"""Elements of Modelica arrays as scalars: ``mass[2]``, ``center[2,3]``."""

import itertools
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

Expression = dict[str, Any]
Index = tuple[int, ...]


def element_name(base: str, index: Index) -> str:
    """Flat name of an element; a scalar has an empty index."""
    return f"{base}[{','.join(map(str, index))}]" if index else base


def indices(dims: Iterable[int]) -> Iterator[Index]:
    """All indices of an array, row by row; one empty index for a scalar."""
    return itertools.product(*(range(1, d + 1) for d in dims))


def subscripts(reference: dict[str, Any]) -> Index | None:
    """Subscripts of a VarRef, if all are numbers."""
    found = tuple(s.get("Index", {}).get("value") for s in reference["subscripts"])
    return found if all(isinstance(k, int) for k in found) else None


class Elements:
    """Picks elements of expressions, with the dimensions of all variables of a class."""

    def __init__(self, dims: Mapping[str, Iterable[int]]) -> None:
        self._dims = {name: tuple(d) for name, d in dims.items()}

    def shape(self, e: Expression) -> tuple[int, ...]:
        """Dimensions of an expression; empty for a scalar."""
        ((kind, d),) = e.items()
        if kind == "Array":
            return len(d["elements"]), *self.shape(d["elements"][0])
        if kind == "VarRef":
            dims = self._dims.get(d["name"]["name"], ())
            given = d["subscripts"]
            kept = [n for n, s in zip(dims, given, strict=False) if "Colon" in s]
            return *kept, *dims[len(given) :]
        if kind == "Unary":
            return self.shape(d["rhs"])
        if kind == "Binary":
            return max(self.shape(d["lhs"]), self.shape(d["rhs"]), key=len)
        return ()

    def pick(self, e: Expression, index: Index) -> Expression:
        """One element of an expression; an expression that is no array is returned whole."""
        if len(self.shape(e)) != len(index):
            return e
        ((kind, d),) = e.items()
        if kind == "Array":
            return self.pick(d["elements"][index[0] - 1], index[1:])
        if kind == "VarRef":
            rest = [{"Index": {"value": k}} for k in index]
            given = [rest.pop(0) if "Colon" in s else s for s in d["subscripts"]]
            return {"VarRef": {**d, "subscripts": given + rest}}
        if kind == "Unary":
            return {"Unary": {**d, "rhs": self.pick(d["rhs"], index)}}
        if kind == "Binary" and self._elementwise(d):
            sides = {side: self.pick(d[side], index) for side in ("lhs", "rhs")}
            return {"Binary": {**d, **sides}}
        return e

    def _elementwise(self, d: dict[str, Any]) -> bool:
        """Whether an operation of arrays, or of a number and an array, acts element by element."""
        return d["op"] in ("Add", "Sub") or () in (self.shape(d["lhs"]), self.shape(d["rhs"]))
