"""The C cores: which others one uses, and which of their files a model needs.

A folder src/<storey>/<core>/ with a core.toml is a core, whose `uses` names the cores whose headers
it may include: those of its own storey, and of the storeys that src/<storey>/storey.toml names in
`stands_on`.
"""

import re
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path

# What a model that is made of a Modelica class uses, whichever class it is.
OF_PLANTS: tuple[str, ...] = ("elementary",)

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_GUARD = re.compile(r"^#ifndef (\w+)\n#define \1\n", re.MULTILINE)
_END = "\n#endif\n"
_INCLUDE = re.compile(r'^\s*#\s*include\s+"(?:[^"]*/)?([^"/]+)"', re.MULTILINE)

# Lines around a header's declarations, for C++: its functions are those of C, and C11's structs
# without a name raise no warning.
_OPENED = """#ifdef __cplusplus
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#endif
extern "C" {
#endif
"""
_CLOSED = """#ifdef __cplusplus
}
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif
#endif
"""


def folders(source: Path) -> dict[str, Path]:
    """The folder of each core by its name."""
    return {f.parent.name: f.parent for f in sorted(source.glob("*/*/core.toml"))}


def uses(core: Path) -> list[str]:
    """Names of the cores that a core may include."""
    return _names(core / "core.toml", "uses")


def stands_on(storey: Path) -> list[str]:
    """Names of the storeys below one, whose cores its own may use."""
    return _names(storey / "storey.toml", "stands_on")


def _names(file: Path, key: str) -> list[str]:
    told = tomllib.loads(file.read_text())
    names = told.get(key)
    if told.keys() != {key} or not isinstance(names, list):
        raise ValueError(f"{file}: {key}, a list of names, wanted, and nothing else")
    return names


def closure(source: Path, names: Iterable[str]) -> list[str]:
    """These cores, then those that they use, directly or through others."""
    place = folders(source)
    found: list[str] = []
    waiting = list(names)
    while waiting:
        name = waiting.pop(0)
        if name not in found:
            found.append(name)
            waiting += uses(place[name])
    return found


def included(file: Path) -> list[str]:
    """Names of the headers a C file includes, without folders, in their order."""
    return _INCLUDE.findall(file.read_text())


def cxx(header: Path) -> str:
    """Text of a header as it is installed: fit for C++, with a guard of its own."""
    own = r"#ifndef MOTIONFMU_\1\n#define MOTIONFMU_\1\n"
    text, guards = _GUARD.subn(own, header.read_text(), count=1)
    if not guards or not text.endswith(_END):
        raise ValueError(f"{header}: no guard around the whole file")
    *_, last = re.finditer(r"^#(?:define MOTIONFMU_\w+|include .*)\n", text, re.MULTILINE)
    head, body = text[: last.end()], text[last.end() : -len(_END)]
    if re.search(r"^[^#\s]", _COMMENT.sub("", head), re.MULTILINE):
        raise ValueError(f"{header}: a declaration stands before the last #include")
    return f"{head}\n{_OPENED}{body}\n{_CLOSED}{_END}"


def reached(
    files: Iterable[Path], roots: Iterable[Path], owned: Mapping[str, list[Path]] | None = None
) -> list[Path]:
    """All files that C files include, directly or through others, with the C files of headers."""
    known = {f.name: [f, *(owned or {}).get(f.name, [])] for f in files}
    found: set[Path] = set()
    waiting = list(roots)
    while waiting:
        new = {f for name in included(waiting.pop()) for f in known.get(name, [])} - found
        found |= new
        waiting += new
    return sorted(found, key=lambda f: (f.parent.name, f.name))


def needed(source: Path, names: Iterable[str], roots: Iterable[Path]) -> list[Path]:
    """Files of the cores that C files need, headers and sources.

    A C file belongs to the header of its own name, or else to the first one it includes.
    """
    place = folders(source)
    used = [place[name] for name in closure(source, names)]
    headers = [f for folder in used for f in folder.glob("*.h")]
    names_of = {f.name for f in headers}
    owned: dict[str, list[Path]] = {}
    for file in (f for folder in used for f in sorted(folder.glob("*.c"))):
        own = f"{file.stem}.h"
        owned.setdefault(own if own in names_of else included(file)[0], []).append(file)
    return reached(headers, roots, owned)
