"""What a shared library says of itself: PE, Mach-O and universal files, read from their bytes."""

import re
import struct
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import fmpy

from motionfmu.base.platforms import PLATFORMS, Platform

HEADERS = Path(fmpy.__file__).parent / "c-code"

MACHINES = {0x01000007: "x86_64", 0x0100000C: "aarch64"}
_UNIVERSAL, _MACH = 0xCAFEBABE, 0xFEEDFACF
_SYMTAB, _NAME, _LOADED, _VERSION, _SIGNATURE = 0x2, 0xD, 0xC, 0x32, 0x1D
_EXTERNAL, _PRIVATE, _KIND, _SECTION = 0x1, 0x10, 0xE, 0xE  # of a symbol's type
_LINKERS = {"__dso_handle", "_mh_dylib_header"}  # in every library
_AD_HOC = 0x2
_SUPER, _DIRECTORY = 0xFADE0CC0, 0xFADE0C02


@dataclass(frozen=True)
class Mach:
    """One library of a Mac."""

    machine: str
    name: str  # by which a program that is linked with it looks for it
    system: str  # oldest version that loads it
    loaded: tuple[str, ...]
    shown: frozenset[str]  # symbols that it defines for others
    signed: bool
    ad_hoc: bool


def machs(data: bytes) -> list[Mach]:
    """The libraries of a file, which may be universal."""
    if struct.unpack_from(">I", data)[0] != _UNIVERSAL:
        return [_mach(data)]
    found = []
    for k in range(struct.unpack_from(">I", data, 4)[0]):
        processor, _, at, size, power = struct.unpack_from(">5I", data, 8 + 20 * k)
        assert at % (1 << power) == 0 and at + size <= len(data)
        found.append(_mach(data[at : at + size]))
        assert found[-1].machine == MACHINES[processor]
    return found


def _text(data: bytes, at: int) -> str:
    return data[at : data.index(b"\0", at)].decode()


def _mach(data: bytes) -> Mach:
    magic, processor, _, kind, count = struct.unpack_from("<5I", data)
    assert (magic, kind) == (_MACH, 6), "a dynamic library"
    at, name, system, loaded = 32, "", "", []
    shown: set[str] = set()
    signed = ad_hoc = False
    for _ in range(count):
        command, size = struct.unpack_from("<2I", data, at)
        if command == _NAME:
            name = _text(data, at + struct.unpack_from("<I", data, at + 8)[0])
        elif command == _LOADED:
            loaded.append(_text(data, at + struct.unpack_from("<I", data, at + 8)[0]))
        elif command == _VERSION:
            platform, least = struct.unpack_from("<2I", data, at + 8)
            assert platform == 1, "macOS"
            system = f"{least >> 16}.{least >> 8 & 0xFF}"
        elif command == _SYMTAB:
            shown = _shown(data, *struct.unpack_from("<3I", data, at + 8))
        elif command == _SIGNATURE:
            where, length = struct.unpack_from("<2I", data, at + 8)
            signed, ad_hoc = True, _ad_hoc(data[where : where + length])
        at += size
    machine = MACHINES[processor]
    return Mach(machine, name, system, tuple(loaded), frozenset(shown), signed, ad_hoc)


def _shown(data: bytes, symbols: int, count: int, texts: int) -> set[str]:
    found = set()
    for k in range(count):
        text, kind = struct.unpack_from("<IB", data, symbols + 16 * k)
        if kind & (_EXTERNAL | _PRIVATE) == _EXTERNAL and kind & _KIND == _SECTION:
            found.add(_text(data, texts + text).removeprefix("_"))
    return found - _LINKERS


def _ad_hoc(blob: bytes) -> bool:
    magic, _, count = struct.unpack_from(">3I", blob)
    assert magic == _SUPER
    for k in range(count):
        at = struct.unpack_from(">I", blob, 12 + 8 * k + 4)[0]
        if struct.unpack_from(">I", blob, at)[0] == _DIRECTORY:
            return bool(struct.unpack_from(">I", blob, at + 12)[0] & _AD_HOC)
    return False


@dataclass(frozen=True)
class Pe:
    """A library of Windows."""

    machine: int
    made: int  # [s] since 1970
    shown: frozenset[str]
    loaded: frozenset[str]


def pe(data: bytes) -> Pe:
    """Read a DLL."""
    head = struct.unpack_from("<I", data, 0x3C)[0]
    assert data[head : head + 4] == b"PE\0\0"
    machine, count, made = struct.unpack_from("<2HI", data, head + 4)
    size = struct.unpack_from("<H", data, head + 20)[0]
    tables = head + 24 + 112
    rows = [struct.unpack_from("<8x4I", data, head + 24 + size + 40 * k) for k in range(count)]

    def place(address: int) -> int:
        for length, begin, raw, at in rows:
            if begin <= address < begin + max(length, raw):
                return address - begin + at
        raise ValueError(f"no section has {address:x}")

    exports, _, imports = struct.unpack_from("<3I", data, tables)
    at = place(exports)
    names = struct.unpack_from("<I", data, at + 24)[0]
    names_at = place(struct.unpack_from("<I", data, at + 32)[0])
    shown = {
        _text(data, place(struct.unpack_from("<I", data, names_at + 4 * k)[0]))
        for k in range(names)
    }
    loaded, at = set(), place(imports)
    while name := struct.unpack_from("<I", data, at + 12)[0]:
        loaded.add(_text(data, place(name)))
        at += 20
    return Pe(machine, made, frozenset(shown), frozenset(loaded))


def library(fmu: Path, fmi: int, platform: Platform) -> bytes:
    """A platform's library of an FMU."""
    with zipfile.ZipFile(fmu) as archive:
        places = [
            n for n in archive.namelist() if n.startswith(f"binaries/{platform.folder(fmi)}/")
        ]
        assert len(places) == 1, places
        assert places[0].endswith(platform.suffix)
        return archive.read(places[0])


@cache
def standard(fmi: int) -> frozenset[str]:
    """Functions of the standard; in FMI 2 those of co-simulation alone."""
    text = (HEADERS / f"fmi{fmi}Functions.h").read_text()
    names = re.findall(rf"^\s*FMI{fmi}_Export\s+\w+TYPE\s+(\w+);", text, re.MULTILINE)
    only = re.compile(
        "fmi2(EnterEvent|NewDiscrete|EnterContinuous|CompletedIntegrator|SetTime|SetContinuous"
        "|GetDerivatives|GetEventInd|GetContinuous|GetNominals)"
    )
    return frozenset(n for n in names if not only.match(n))


def mac_faults(fmu: Path, fmi: int) -> list[str]:
    """What is wrong with an FMU's libraries for a Mac, read from their bytes."""
    return list(_mac_faults(fmu, fmi))


def _mac_faults(fmu: Path, fmi: int) -> Iterator[str]:
    with zipfile.ZipFile(fmu) as archive:
        text = archive.read("modelDescription.xml").decode()
    identifier = re.findall(r'modelIdentifier="(\w+)"', text)[0]
    files = {library(fmu, fmi, p) for p in PLATFORMS if p.system == "darwin"}
    found = {one.machine: one for data in files for one in machs(data)}
    if (len(files), sorted(found)) != (1 if fmi == 2 else 2, ["aarch64", "x86_64"]):
        yield f"{len(files)} files for {sorted(found)}"
    for machine, one in found.items():
        if one.name != f"@rpath/{identifier}.dylib":
            yield f"{machine}: its name is {one.name}"
        if one.system != "11.0":
            yield f"{machine}: for macOS {one.system}"
        if one.loaded != ("/usr/lib/libSystem.B.dylib",):
            yield f"{machine}: it loads {one.loaded}"
        if one.shown != standard(fmi):
            yield f"{machine}: it shows {sorted(one.shown ^ standard(fmi))}"
        if machine == "aarch64" and not (one.signed and one.ad_hoc):
            yield f"{machine}: not signed"
