"""Texts by which a parameter names a file, as src/fmi/fmi_path.inc reads them."""

from pathlib import Path
from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

RESOURCE = "resource:"


def local(text: str) -> Path | None:
    """The file on this machine that a text names; None for no file, and for a resource."""
    if not text or text.lower().startswith(RESOURCE):
        return None
    if not text.lower().startswith("file:"):
        return Path(text)
    uri = urlsplit(text)
    return Path(url2pathname(uri.path) if uri.netloc in ("", "localhost") else unquote(text))
