"""Files that settings name, which travel inside an archive."""

from dataclasses import dataclass, field, replace
from itertools import chain, count
from pathlib import Path

from motionfmu.analysis.gcode.subprogram_files import called
from motionfmu.base.toml_lines import is_file
from motionfmu.fmu import places
from motionfmu.scenarios.system import Setting


@dataclass
class Resources:
    """Files by their names in an FMU's resources."""

    files: dict[str, Path] = field(default_factory=dict)

    def added(self, file: Path, owner: str) -> str:
        """Add a file and the files that it calls; returns how a parameter names it.

        They stay side by side; if another file has the name of one of them, in a folder `owner`.
        """
        several = [file, *called(file)]
        folders = chain(("", f"{owner}/"), (f"{owner}.{k}/" for k in count(2)))
        folder = next(
            f for f in folders if all(self.files.get(f + x.name, x) == x for x in several)
        )
        self.files |= {folder + x.name: x for x in several}
        return places.RESOURCE + folder + file.name

    def inside(self, setting: Setting) -> Setting:
        """The setting with its files named as ``resource:NAME``; the files are added to this."""
        return replace(setting, values=tuple(self._value(setting, v) for v in setting.values))

    def _value(self, setting: Setting, value: float | int | bool | str) -> float | int | bool | str:
        port = setting.end.port
        # A foreign FMU does not say which of its texts name files.
        may = port.file == "read" or (port.type == "String" and port.declared is None)
        file = places.local(str(value)) if may else None
        if file is None or not file.is_absolute() or not is_file(file):
            return value
        return self.added(file, setting.end.component)
