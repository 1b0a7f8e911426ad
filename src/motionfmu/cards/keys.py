"""Keys of cards: a file of lines ``id = "64 hexadecimal digits"`` that only its owner reads."""

import contextlib
import os
import secrets
import stat
from collections.abc import Iterator
from pathlib import Path

from motionfmu.base.errors import InputError
from motionfmu.base.locking import POSIX, lock, open_folder
from motionfmu.base.toml_lines import Lines, shown, tables_of, text_of
from motionfmu.cards.wire import OPEN_KEY

KEY_BYTES = 32
CARD_MAX = 2**32 - 1


def read_keys(file: Path) -> dict[int, bytes]:
    """Key of each card; InputError if others than the owner may read the file."""
    text = text_of(file)
    if POSIX and (others := stat.S_IMODE(file.stat().st_mode) & 0o077):
        raise InputError(f"{file}: others may read it; chmod 600 it (now {others | 0o600:03o})")
    found = {}
    for name, value in tables_of(text, file).items():
        line = Lines(text).of("", name)
        if not name.isdecimal() or not int(name) <= CARD_MAX:
            raise InputError(f"{file}:{line}: {name!r} is no id of a card, 0 to {CARD_MAX}")
        try:
            key = bytes.fromhex(value)
        except (TypeError, ValueError):
            key = b""
        if len(key) != KEY_BYTES:
            raise InputError(f"{file}:{line}: key of card {name}: 64 hexadecimal digits wanted")
        if key == OPEN_KEY:
            raise InputError(f"{file}:{line}: key of card {name}: zeros are no key")
        found[int(name)] = key
    return found


def new_key(file: Path, card: int) -> bytes:
    """Make a key for a card that has none, and write it into the file."""
    if not 0 <= card <= CARD_MAX:
        raise InputError(f"{shown(card)} is no id of a card, 0 to {CARD_MAX}")
    with alone(file.parent):
        keys = read_keys(file) if file.exists() else {}
        if card in keys:
            raise InputError(f"{file}: card {card} has a key; take its line out to make a new one")
        keys[card] = secrets.token_bytes(KEY_BYTES)
        text = "".join(f'{i} = "{k.hex()}"\n' for i, k in sorted(keys.items()))
        write_whole(file, text.encode())
    return keys[card]


@contextlib.contextmanager
def alone(folder: Path, wait: bool = True) -> Iterator[None]:
    """Lock a folder's keys for this block; InputError if they are locked and `wait` is false."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        held = open_folder(folder)
    except OSError as error:
        raise InputError(f"{folder}: {error.strerror}") from None
    try:
        lock(held, folder, "another program uses this folder", wait)
        yield
    finally:
        os.close(held)


def write_whole(file: Path, data: bytes) -> None:
    """Write a file that only its owner reads; after a crash it is the old one or the new one."""
    part = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        with open(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(part, file)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise InputError(f"{file}: {error.strerror}") from None


class Keys:
    """The file of keys as a server uses it: read again when it has changed.

    A card without a key is let in only if `demanded` is false, with the key of zeros.
    """

    def __init__(self, file: Path, demanded: bool) -> None:
        self._file, self._demanded = file, demanded
        self._keys: dict[int, bytes] = {}
        self._seen: tuple[int, int] | None = None
        self._refresh()

    def __len__(self) -> int:
        return len(self._keys)

    def of(self, card: int) -> bytes:
        """Key of a card; a random key if the card has none and needs one."""
        with contextlib.suppress(
            InputError
        ):  # a file that is wrong now leaves the keys read before
            self._refresh()
        return self._keys.get(card) or (os.urandom(KEY_BYTES) if self._demanded else OPEN_KEY)

    def _refresh(self) -> None:
        try:
            about = self._file.stat()
        except FileNotFoundError:
            self._keys, self._seen = {}, None
            return
        if (now := (about.st_mtime_ns, about.st_ino)) != self._seen:
            self._keys, self._seen = read_keys(self._file), now
