"""What takes long to make and depends on nothing but its key is made once and kept on the disk."""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

# [bytes] what is kept of one kind; the longest unused goes first.
ROOM = 500_000_000
# Things that are kept of one kind.
MOST = 1000


def folder() -> Path:
    """``$MOTIONFMU_CACHE``, else the user's folder for such things (XDG)."""
    if named := os.environ.get("MOTIONFMU_CACHE"):
        return Path(named)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "motionfmu"


def key(*parts: str | bytes) -> str:
    """A name for what these parts make; every part counts, and where each ends."""
    digest = hashlib.sha256()
    for part in parts:
        raw = part.encode() if isinstance(part, str) else part
        digest.update(len(raw).to_bytes(8, "little") + raw)
    return digest.hexdigest()[:32]


def kept(kind: str, name: str, make: Callable[[Path], None]) -> Path:
    """Folder ``kind/name`` as `make` filled it, now or before.

    `make` gets an empty folder. What it raises goes on, and nothing is kept; two processes may make
    the same at once, one is kept. A place that cannot be written to serves this process only.
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
        if not place.is_dir():  # else somebody else was quicker
            raise
    finally:
        shutil.rmtree(made, ignore_errors=True)
    _prune(place)
    return place


_held: dict[tuple[str, str], "tempfile.TemporaryDirectory[str]"] = {}


def _for_now(kind: str, name: str, make: Callable[[Path], None]) -> Path:
    """The same in a folder that goes with the process."""
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
    except OSError:  # somebody else's, or just pruned
        return


def _prune(newest: Path) -> None:
    """Remove the longest unused of a kind until the rest has room."""
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
