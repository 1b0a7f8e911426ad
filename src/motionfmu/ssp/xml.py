"""Files of an SSP archive, as bytes or as trees of XML elements."""

import zipfile
import zlib
from pathlib import Path
from urllib.parse import unquote, urlsplit
from xml.etree import ElementTree as ET

from motionfmu.base.errors import InputError

SIZE_MAX = 64 << 20  # [byte] of an XML file


class Archive:
    """An open .ssp file, which messages name."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            self._zip = zipfile.ZipFile(path)
        except (OSError, zipfile.BadZipFile) as error:
            told = getattr(error, "strerror", None) or error
            raise InputError(f"{path}: not a readable SSP ({told})") from None

    def error(self, text: str) -> InputError:
        """Make the error for a fault in the archive."""
        return InputError(f"{self.path}: {text}")

    def has(self, name: str) -> bool:
        """Whether the archive has a file of this name."""
        return name in self._zip.NameToInfo

    def bytes(self, name: str) -> bytes:
        """The content of a file."""
        try:
            return self._zip.read(name)
        except KeyError:
            raise self.error(f"it has no {name}") from None
        except (OSError, zipfile.BadZipFile, zlib.error, RuntimeError) as error:
            raise self.error(f"{name}: {error}") from None

    def root(self, name: str, tag: str) -> ET.Element:
        """The root element of an XML file; an InputError if its tag is another one."""
        if self.has(name) and self._zip.getinfo(name).file_size > SIZE_MAX:
            raise self.error(f"{name}: larger than {SIZE_MAX >> 20} MiB")
        try:
            found = ET.fromstring(self.bytes(name))
        except ET.ParseError as error:
            raise self.error(f"{name}: {error}") from None
        if found.tag != tag:
            raise self.error(f"{name}: <{plain(found)}> is no <{tag.rpartition('}')[2]}>")
        return found

    def place(self, source: str, what: str) -> str:
        """The file of the archive that the URI `source` of `what` names."""
        parts = urlsplit(source)
        path = unquote(parts.path)
        if parts.scheme or parts.netloc or path.startswith("/"):
            raise self.error(f"{what}: {source} is not inside the SSP")
        return path.removeprefix("./")


def plain(element: ET.Element) -> str:
    """The tag without its namespace."""
    return element.tag.rpartition("}")[2]


def number(archive: Archive, element: ET.Element, key: str, default: float) -> float:
    """An attribute that is a number."""
    text = element.get(key)
    try:
        return default if text is None else float(text)
    except ValueError:
        raise archive.error(f"<{plain(element)}> {key} = {text!r}: no number") from None
