"""Files that settings name, which travel inside an archive."""

import os
from dataclasses import dataclass, field, replace
from pathlib import Path

from motionfmu.scenarios.system import Setting
from motionfmu.toml_lines import is_file


@dataclass
class Resources:
    """Files by their names in an FMU's resources."""

    files: dict[str, Path] = field(default_factory=dict)

    def inside(self, setting: Setting) -> Setting:
        """The setting with files as ``resource:NAME``; they are added to those there are."""
        return replace(setting, values=tuple(self._value(setting, v) for v in setting.values))

    def _value(self, setting: Setting, value: float | int | bool | str) -> float | int | bool | str:
        if not (isinstance(value, str) and os.path.isabs(value) and is_file(Path(value))):
            return value
        file, name = Path(value), Path(value).name
        if self.files.get(name, file) != file:
            name = f"{setting.end.component}.{name}"
        self.files[name] = file
        return f"resource:{name}"
