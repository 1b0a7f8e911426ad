"""Where the FMUs are and what they declare."""

import functools
import math
import os
from dataclasses import dataclass
from pathlib import Path

from fmpy import read_model_description

from motionfmu.errors import InputError

PACKAGE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Port:
    """One variable of an FMU as its description declares it.

    Attributes
    ----------
    name, type, causality, doc : str
        FMI name; Float64, Int32, Boolean or String; FMI causality; description.
    tunable : bool
        A parameter that may change during a run.
    shape : tuple of int
        Empty for a scalar.
    unit : str or None
    reference : int
        First value reference; elements take successive ones.
    start : str or None
        Start values as written in the description.
    low, high : float
        Limits; infinite if none are declared.
    """

    name: str
    type: str
    causality: str
    tunable: bool
    doc: str
    shape: tuple[int, ...]
    unit: str | None
    reference: int
    start: str | None
    low: float
    high: float

    @property
    def count(self) -> int:
        """Number of elements."""
        return math.prod(self.shape)


def folder() -> Path:
    """Folder with the built .fmu files.

    Returns
    -------
    Path
        ``$MOTIONFMU_FMUS``, the installed package's own, or ``build/fmus`` of the source tree.
    """
    if named := os.environ.get("MOTIONFMU_FMUS"):
        return Path(named)
    installed = PACKAGE / "fmus"
    return installed if installed.is_dir() else PACKAGE.parent.parent / "build" / "fmus"


def fmu_names() -> list[str]:
    """Names of the FMUs that are built.

    Returns
    -------
    list of str
        Sorted; the folder names under fmus/.
    """
    return sorted(p.name.removesuffix(".fmi3.fmu") for p in folder().glob("*.fmi3.fmu"))


def fmu_path(name: str, fmi: int = 3) -> Path:
    """Find a built FMU.

    Parameters
    ----------
    name : str
        Folder name under fmus/.
    fmi : int
        2 or 3.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        There is no such FMU; the message lists what there is.
    """
    path = folder() / f"{name}.fmi{fmi}.fmu"
    if not path.is_file():
        known = ", ".join(fmu_names()) or "none is built; run make build"
        raise InputError(f"no FMU {name!r} for FMI {fmi} in {folder()} (there are: {known})")
    return path


@functools.cache
def ports(name: str) -> dict[str, Port]:
    """Variables of an FMU by name.

    Parameters
    ----------
    name : str
        Folder name under fmus/.

    Returns
    -------
    dict
        Port by variable name, from the FMI 3 description, without the independent variable.

    Raises
    ------
    InputError
        There is no such FMU.
    """
    description = read_model_description(str(fmu_path(name)))
    found = {}
    for v in description.modelVariables:
        if v.causality == "independent":
            continue
        start = " ".join(v.start) if isinstance(v.start, list) else v.start
        low, high = (
            side if limit is None else float(limit)
            for limit, side in ((v.min, -math.inf), (v.max, math.inf))
        )
        found[v.name] = Port(
            v.name,
            v.type,
            v.causality,
            v.variability == "tunable",
            v.description or "",
            tuple(int(d.start) for d in v.dimensions),
            v.unit,
            v.valueReference,
            start,
            low,
            high,
        )
    return found
