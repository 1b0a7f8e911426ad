"""What a parameter that names a file says: the words of src/fmi/fmi_path.inc, for who packs it."""

from pathlib import Path
from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

RESOURCE = "resource:"


def local(text: str) -> Path | None:
    """The file on this machine that a text names; None: none, or one that the FMU carries."""
    if not text or text.lower().startswith(RESOURCE):
        return None
    if not text.lower().startswith("file:"):
        return Path(text)
    uri = urlsplit(text)
    return Path(url2pathname(uri.path) if uri.netloc in ("", "localhost") else unquote(text))
