"""Files that settings name, which travel inside an archive."""

from dataclasses import dataclass, field, replace
from pathlib import Path

from motionfmu.fmu import places
from motionfmu.scenarios.system import Setting
from motionfmu.toml_lines import is_file


@dataclass
class Resources:
    """Files by their names in an FMU's resources."""

    files: dict[str, Path] = field(default_factory=dict)

    def added(self, file: Path, owner: str) -> str:
        """Take a file in; what a parameter says to name it. `owner` tells two of one name apart."""
        name = places.free_name(file, owner, self.files)
        self.files[name] = file
        return places.RESOURCE + name

    def inside(self, setting: Setting) -> Setting:
        """The setting with files as ``resource:NAME``; they are added to those there are."""
        return replace(setting, values=tuple(self._value(setting, v) for v in setting.values))

    def _value(self, setting: Setting, value: float | int | bool | str) -> float | int | bool | str:
        port = setting.end.port
        # Somebody else's FMU does not say which of its texts are files.
        may = port.file == "read" or (port.type == "String" and port.declared is None)
        file = places.local(str(value)) if may else None
        if file is None or not file.is_absolute() or not is_file(file):
            return value
        return self.added(file, setting.end.component)
