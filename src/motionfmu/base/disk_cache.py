"""A cache on the disk, for what takes long to make and depends on nothing but its key."""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

# [bytes] that are kept of one kind; what was not used for the longest time goes first.
ROOM = 500_000_000
# Number of entries that are kept of one kind.
MOST = 1000


def folder() -> Path:
    """The cache's folder: ``$MOTIONFMU_CACHE``, else that of the user (XDG)."""
    if named := os.environ.get("MOTIONFMU_CACHE"):
        return Path(named)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "motionfmu"


def key(*parts: str | bytes) -> str:
    """A hash of parts, in which every part counts and where one ends and the next begins."""
    digest = hashlib.sha256()
    for part in parts:
        raw = part.encode() if isinstance(part, str) else part
        digest.update(len(raw).to_bytes(8, "little") + raw)
    return digest.hexdigest()[:32]


def kept(kind: str, name: str, make: Callable[[Path], None]) -> Path:
    """The folder ``kind/name`` of the cache, which `make` fills if it is not there.

    `make` gets an empty folder; if it raises an error, nothing is kept. Two processes may fill one
    folder at once, and one of them is kept. Where the cache cannot be written to, the folder lives
    as long as the process.
    """
    place = folder() / kind / name
    if place.is_dir():
        _used(place)
        return place
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        made = Path(tempfile.mkdtemp(prefix=".new-", dir=place.parent))
    except OSError:
        return _for_now(kind, name, make)
    try:
        make(made)
        made.rename(place)
    except OSError:
        if not place.is_dir():  # else another process was quicker
            raise
    finally:
        shutil.rmtree(made, ignore_errors=True)
    _prune(place)
    return place


_held: dict[tuple[str, str], "tempfile.TemporaryDirectory[str]"] = {}


def _for_now(kind: str, name: str, make: Callable[[Path], None]) -> Path:
    """A folder filled by `make` that is deleted with the process."""
    if (kind, name) not in _held:
        held = tempfile.TemporaryDirectory(prefix="motionfmu-")
        try:
            make(Path(held.name))
        except BaseException:
            held.cleanup()
            raise
        _held[kind, name] = held
    return Path(_held[kind, name].name)


def _used(place: Path) -> None:
    try:
        os.utime(place)
    except OSError:  # another user's, or just removed by another process
        return


def _prune(newest: Path) -> None:
    """Remove entries of a kind until the rest has room; the longest unused goes first."""
    found = []
    for place in newest.parent.iterdir():
        try:
            size = sum(f.stat().st_size for f in place.rglob("*") if f.is_file())
            found.append((place.stat().st_mtime, size, place))
        except OSError:
            continue
    room = ROOM
    for count, (_, size, place) in enumerate(sorted(found, reverse=True), 1):
        room -= size
        if (room < 0 or count > MOST) and place != newest:
            shutil.rmtree(place, ignore_errors=True)
