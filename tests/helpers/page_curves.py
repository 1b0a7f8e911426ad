"""The curves of a page as its script unpacks them: by NumPy, from the text of the page."""

import base64
import json
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np


def page_data(page: Path) -> dict[str, Any]:
    found = re.search(r'id="data">(.*?)</script>', page.read_text(encoding="utf-8"), re.DOTALL)
    assert found
    return json.loads(found[1])


def unwoven(packed: dict[str, Any]) -> np.ndarray:
    raw = np.frombuffer(zlib.decompress(base64.b64decode(packed["bdata"])), np.uint8)
    size = int(packed["kind"][1])
    words = np.ascontiguousarray(raw.reshape(size, -1).T).view(f"<u{size}")[:, 0]
    summed = np.cumsum(words, dtype=words.dtype)
    assert len(summed) == packed["count"]
    return summed.view("<" + packed["kind"])


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
    else:
        time = clock["start"] + clock["step"] * np.arange(clock["count"])
    return time, unwoven(trace["samples"]["values"])
