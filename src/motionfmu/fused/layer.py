"""C text that every system FMU is compiled from: the FMI layer and the standards' headers."""

import functools
from importlib import util
from pathlib import Path

from motionfmu.base import disk_cache
from motionfmu.scenarios.fmus import PACKAGE

OPTIMIZED = "-O3"


def folders() -> list[Path]:
    """Folders of the C text: the installed package's, or those of the checkout and of FMPy."""
    installed = PACKAGE / "layer"
    if installed.is_dir():
        return [installed]
    fmpy = util.find_spec("fmpy")
    assert fmpy and fmpy.origin, "FMPy is there where FMUs are built"
    return [PACKAGE.parent / "fmi", Path(fmpy.origin).parent / "c-code"]


@functools.cache
def digest() -> str:
    """A hash of the layer's text, and of the Python text that generates the rest of the C text."""
    generators = [*Path(__file__).parent.glob("*.py"), *(PACKAGE / "fmu").glob("*.py")]
    files = sorted([*folders()[0].iterdir(), *generators])
    return disk_cache.key(*(part for f in files for part in (f.name, f.read_bytes())))
