"""Platforms that an FMU has libraries for: folders, targets of the cross compiler, one Mac file."""

import platform
import struct
import sys
from collections.abc import Mapping
from dataclasses import dataclass

from motionfmu.base.errors import InputError

# The glibc of RHEL 7 and the first macOS for ARM; newer systems load such libraries, too.
_TARGETS = {
    "x86_64-linux": "x86_64-linux-gnu.2.17",
    "aarch64-linux": "aarch64-linux-gnu.2.17",
    "x86_64-windows": "x86_64-windows-gnu",
    "x86_64-darwin": "x86_64-macos.11.0",
    "aarch64-darwin": "aarch64-macos.11.0",
}
_SUFFIX = {"linux": ".so", "windows": ".dll", "darwin": ".dylib"}
_FMI2 = {"linux": "linux", "windows": "win", "darwin": "darwin"}

# A universal binary has a head, a row for each library, and libraries that begin at whole pages.
_MAGIC, _PAGE = 0xCAFEBABE, 14  # power of two
_PE_AT = 0x3C  # where the head of a Windows library is said to be
_ROW = struct.Struct(">5I")  # processor, its kind, offset, size, alignment


@dataclass(frozen=True)
class Platform:
    """A system and a processor, by the names of FMI 3."""

    name: str  # x86_64-linux, for example

    @property
    def target(self) -> str:
        """Zig's name of the platform, with the oldest system that loads its libraries."""
        return _TARGETS[self.name]

    @property
    def system(self) -> str:
        """One of linux, windows, darwin."""
        return self.name.partition("-")[2]

    @property
    def suffix(self) -> str:
        """Ending of a library."""
        return _SUFFIX[self.system]

    def folder(self, fmi: int) -> str:
        """Folder of its libraries under binaries/ of an FMU.

        FMI 2 names no processors but x86 ones: others have the names of FMI 3, but a Mac's library
        is one for both.
        """
        machine = self.name.partition("-")[0]
        if fmi == 3 or (machine != "x86_64" and self.system != "darwin"):
            return self.name
        return f"{_FMI2[self.system]}64"


PLATFORMS = tuple(map(Platform, _TARGETS))


def here() -> Platform:
    """This machine, which may be none of `PLATFORMS`."""
    system = {"win32": "windows"}.get(sys.platform, sys.platform)
    machine = {"AMD64": "x86_64", "arm64": "aarch64"}.get(platform.machine(), platform.machine())
    return Platform(f"{machine}-{system}")


def named(text: str) -> tuple[Platform, ...]:
    """Platforms that a text names: a list with commas, ``all``, or none for ``here``."""
    if text in ("here", "all"):
        return PLATFORMS if text == "all" else ()
    names = text.split(",")
    if wrong := [name for name in names if name not in _TARGETS]:
        known = ", ".join(("here", "all", *_TARGETS))
        raise InputError(f"no platform {wrong[0]!r} (there are: {known})")
    return tuple(Platform(name) for name in dict.fromkeys(names))


def libraries(fmi: int, identifier: str, made: Mapping[Platform, bytes]) -> dict[str, bytes]:
    """Files of an FMU, by their names in it, from the library for each platform."""
    found: dict[str, list[bytes]] = {}
    for one, code in made.items():
        name = f"binaries/{one.folder(fmi)}/{identifier}{one.suffix}"
        found.setdefault(name, []).append(undated(code) if one.system == "windows" else code)
    return {
        name: codes[0] if len(codes) == 1 else universal(codes) for name, codes in found.items()
    }


def undated(code: bytes) -> bytes:
    """A library of Windows without the time at which it was made, which its head alone has."""
    head = int.from_bytes(code[_PE_AT : _PE_AT + 4], "little")
    if code[head : head + 4] != b"PE\0\0":
        raise ValueError("no library of Windows")
    return code[: head + 8] + bytes(4) + code[head + 12 :]


def universal(codes: list[bytes]) -> bytes:
    """One file for several processors of a Mac, each library at a whole page (mach-o/fat.h)."""
    head = struct.pack(">2I", _MAGIC, len(codes))
    made, page = bytearray(1 << _PAGE), 1 << _PAGE
    for code in codes:
        processor, kind = struct.unpack_from("<2I", code, 4)  # behind the magic number of Mach-O
        made += bytes(-len(made) % page)
        head += _ROW.pack(processor, kind, len(made), len(code), _PAGE)
        made += code
    made[: len(head)] = head
    return bytes(made)
