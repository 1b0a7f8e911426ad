"""Unpack what VDMCheck2 wants to find beside its archive."""

import sys
import zipfile
from pathlib import Path

for jar in Path(sys.argv[1]).glob("*.jar"):
    with zipfile.ZipFile(jar) as archive:
        archive.extractall(jar.parent, [n for n in archive.namelist() if n.startswith("fmi2")])
