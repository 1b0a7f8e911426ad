"""C text that every system FMU is compiled from: the FMI layer and the standards' headers."""

import functools
from importlib import util
from pathlib import Path

from motionfmu.base import disk_cache
from motionfmu.scenarios.fmus import PACKAGE

OPTIMIZED = "-O3"


def folders() -> list[Path]:
    """Where the C text is: the installed package's, or the checkout's and FMPy's."""
    installed = PACKAGE / "layer"
    if installed.is_dir():
        return [installed]
    fmpy = util.find_spec("fmpy")
    assert fmpy and fmpy.origin, "FMPy is there where FMUs are built"
    return [PACKAGE.parent / "fmi", Path(fmpy.origin).parent / "c-code"]


@functools.cache
def digest() -> str:
    """Of the layer, and of the Python text that generates what is compiled with it."""
    generators = [*Path(__file__).parent.glob("*.py"), *(PACKAGE / "fmu").glob("*.py")]
    files = sorted([*folders()[0].iterdir(), *generators])
    return disk_cache.key(*(part for f in files for part in (f.name, f.read_bytes())))
