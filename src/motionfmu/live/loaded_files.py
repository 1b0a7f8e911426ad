"""Files that the FMUs of a live machine read, as they were when it began."""

import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path

from motionfmu.base.errors import InputError
from motionfmu.run.begin_state import files_of
from motionfmu.run.translated_places import places_beside
from motionfmu.scenarios.system import Setting


class LoadedFiles:
    """Copies in a folder that is deleted when nobody refers to this object any more.

    Somebody may edit a program while the machine runs it: the machine, and what is saved of it,
    keep the one that was loaded.
    """

    def __init__(self, settings: Iterable[Setting]) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="motionfmu-")
        self.values: dict[str, str] = {}  # paths of the copies, by ``component.variable``
        for s in settings:
            several = files_of(s)
            if several:
                place = Path(self._folder.name) / s.end.name
                place.mkdir()
                self.values[s.end.name] = str(place / several[0].name)
                self._copy([*several, *places_beside(several[0])], place)

    def _copy(self, files: Iterable[Path], place: Path) -> None:
        for file in files:
            try:
                shutil.copyfile(file, place / file.name)
            except OSError as error:
                raise InputError(f"{file}: {error.strerror or error}") from None
