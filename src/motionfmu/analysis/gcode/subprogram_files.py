"""Files that a part program calls, found in its text, because they must be packed with it."""

import re
from pathlib import Path

from motionfmu.base.toml_lines import is_file

# A call in a line without its blanks, which do not count; names o#1 and o[..] are computed.
_CALL = re.compile(r"/*(?:n?[\d.]+)?o(?:<([^>]*)>|(\d+)|[#\[].*)call", re.IGNORECASE)
# M100 to M199, whose subprograms are m100.ngc ..
_USER = re.compile(r"m(1\d\d)(?!\d)", re.IGNORECASE)
_NUMBERED = re.compile(r"\d+\.ngc")


def called(program: Path) -> list[Path]:
    """Files beside a program that it calls (``o<name> call``: name.ngc), or that those call.

    So are the files of M100 to M199 (m100.ngc). What a computed number calls may be any file with
    a number as its name.
    """
    found: list[Path] = []
    waiting = [program]
    while waiting:
        text = waiting.pop().read_bytes().decode("utf-8-sig", errors="replace")
        for file in _of_text(text, program.parent):
            if file not in found and file != program:
                found.append(file)
                waiting.append(file)
    return sorted(found)


def _of_text(text: str, folder: Path) -> set[Path]:
    files: set[Path] = set()
    for line in text.splitlines():
        words = "".join(re.sub(r"\([^)]*\)|;.*", "", line).split())
        files.update(folder / f"m{number}.ngc" for number in _USER.findall(words))
        if not (call := _CALL.match(words)):
            continue
        name, number = call.groups()
        if name or number:
            files.add(folder / f"{name.lower() if name else int(number)}.ngc")
        else:
            files.update(f for f in folder.iterdir() if _NUMBERED.fullmatch(f.name))
    return {f for f in files if is_file(f)}
