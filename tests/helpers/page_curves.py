"""The curves of a page as its script unpacks them: by NumPy, from the text of the page."""

import base64
import gzip
import json
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np


def page_data(page: Path | str) -> dict[str, Any]:
    """The data of a page: a file, or its text."""
    text = page if isinstance(page, str) else page.read_text(encoding="utf-8")
    found = re.search(r'id="data">(.*?)</script>', text)
    assert found
    return json.loads(gzip.decompress(base64.b64decode(found[1])))


def unwoven(packed: dict[str, Any]) -> np.ndarray:
    raw = np.frombuffer(zlib.decompress(base64.b64decode(packed["bdata"])), np.uint8)
    size = int(packed["kind"][1])
    words = np.ascontiguousarray(raw.reshape(size, -1).T).view(f"<u{size}")[:, 0]
    assert len(words) == packed["count"]
    if packed["kind"] == "f8":
        return np.cumsum(words, dtype=words.dtype).view("<f8")
    changes = (words >> 1).astype(np.int32) ^ -(words & 1).astype(np.int32)
    whole = np.cumsum(changes, dtype=np.int32)
    if "step" not in packed:
        return whole
    return np.where(whole == -(2**31), np.nan, whole * packed["step"])


def unpacked(value: object) -> np.ndarray:
    """Numbers of a trace, packed or listed."""
    if isinstance(value, dict):
        return np.frombuffer(base64.b64decode(value["bdata"]), "<" + value["dtype"])
    return np.asarray(value, dtype=float)


def curve(data: dict[str, Any], trace: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and values of a sampled trace."""
    clock = data["times"][trace["samples"]["time"]]
    if "bdata" in clock:
        time = unwoven(clock)
    elif "steps" in clock:
        time = clock["start"] + clock["step"] * unwoven(clock["steps"])
    else:
        time = clock["start"] + clock["step"] * np.arange(clock["count"])
    return time, unwoven(trace["samples"]["values"])
