"""Author, version and licence of an FMU, read from the project's files."""

import functools
import re
from importlib import metadata
from pathlib import Path

from motionfmu.base.project_version import version

FOLDER = "documentation/licenses"
ENTRY = f"{FOLDER}/license.txt"
SPDX = "MIT"
# The headers of the FMI standard, packed with the sources, have a licence of their own.
_HEADERS = """

The files fmi2*.h and fmi3*.h in sources/ are those of the FMI standard, (c) MODELISAR consortium
and Modelica Association Project "FMI", under the 2-Clause BSD License, whose text they carry.
"""
_ROOT = Path(__file__).resolve().parents[3]


@functools.cache
def text() -> str:
    """Text of the licence, and of the licences of other people's files in the archive."""
    file = _ROOT / "LICENSE"
    own = file.read_text() if file.is_file() else _installed()
    return own.rstrip("\n") + _HEADERS


def _installed() -> str:
    """The licence as the installed package carries it."""
    for file in metadata.files("motionfmu") or ():
        if file.name == "LICENSE":
            return file.read_text()
    raise FileNotFoundError("the installed motionfmu has no LICENSE")


def attributes() -> dict[str, str]:
    """Attributes of a description's root: version, author, copyright, licence."""
    holder = re.search(r"Copyright \(c\) (\d+) (.+)", text())
    assert holder, "the licence names its holder"
    return {
        "author": holder[2],
        "version": version(),
        "copyright": f"© {holder[1]} {holder[2]}",
        "license": SPDX,
    }
