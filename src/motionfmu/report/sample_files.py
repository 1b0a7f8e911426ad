"""All samples of long curves in files beside a page, which its script reads where one zooms in."""

import json
from pathlib import Path
from typing import Any

from motionfmu.report.samples import Samples, SampleSource, bits, clock

FOLDER = "report.samples"
PIECE = 1 << 16  # samples of a file


class SampleFiles:
    """The files of a page's curves, each named when its curve is drawn."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._sources: dict[int, tuple[int, SampleSource]] = {}

    def more(self, samples: Samples) -> dict[str, Any] | None:
        """What a page says of the files of a curve; None if it has all samples."""
        source = samples.source
        if source is None:
            return None
        number, _ = self._sources.setdefault(id(source), (len(self._sources), source))
        begins = [float(source.time[k]) for k in range(0, len(source.time), PIECE)]
        return {"folder": FOLDER, "curve": number, "begins": begins}

    def write(self) -> None:
        """Write the files of all curves that were asked for."""
        if not self._sources:
            return
        place = self._folder / FOLDER
        place.mkdir(parents=True, exist_ok=True)
        for number, source in self._sources.values():
            for piece, first in enumerate(range(0, len(source.time), PIECE)):
                last = min(first + PIECE, len(source.time))
                found: dict[str, Any] = {
                    "time": clock(source.time[first:last]),
                    "values": bits(source.read(first, last)),
                }
                if source.lines is not None:
                    found["lines"] = bits(source.lines(first, last))
                name = f"{number}.{piece}"
                text = json.dumps(found, separators=(",", ":"))
                (place / f"{name}.js").write_text(f'piece("{name}",{text});\n', encoding="utf-8")
