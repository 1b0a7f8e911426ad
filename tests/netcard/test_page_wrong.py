"""The page of the cards: whatever is sent, the answer is no fault of the server."""

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from test_page import CARD, TOKEN, client

from motionfmu.cards.config import load
from motionfmu.cards.server import Cards
from motionfmu.cards.server_page import application

SERVED = client(Cards(Path("no folder of a server")))
JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.just(10**4000)
    | st.floats()
    | st.text(st.characters(categories=["L", "Cc", "Cs", "So"]), max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner),
    max_leaves=6,
)
NAMES = ["start", "home", "output", "axes", "pins", "card", "self", "name", "job", "text", "fly"]
POSTS = [
    "/cards/1/command",
    f"/cards/{2**40}/command",
    f"/cards/{'9' * 5000}/command",
    "/cards/1/job",
    "/open",
    "/open?name=%00&page=1",
    "/picture",
    "/config/form",
    "/config/read",
    "/config/check",
    "/config/text",
    "/config/save",
    "/config/headers",
    "/config/send/1",
    f"/config/send/{'9' * 5000}",
]


def test_the_routes_tried_are_all_there_are(tmp_path: Path) -> None:
    routes = application(Cards(tmp_path), TOKEN, None).routes
    posts = {r.path.split("{")[0] for r in routes if "POST" in (getattr(r, "methods", 0) or ())}
    assert {p for p in posts if not any(path.startswith(p) for path in POSTS)} == set()


ANYTHING = given(
    st.sampled_from(POSTS),
    st.dictionaries(st.sampled_from(NAMES), JSON | st.sampled_from(NAMES)) | JSON,
    st.none() | st.binary(max_size=20),
)


@pytest.mark.more
@ANYTHING
@example("/cards/1/command", {"name": "start", "card": 5}, None)
@example("/cards/1/command", {"name": "\ud800"}, None)
@example("/config/read", {"text": "\ud800 = 1", "name": "\ud800"}, None)
@example("/cards/1/command", {}, b'{"name": "home", "axes": ' + b"9" * 5000 + b"}")
@example("/open?page=%ff", {}, b"PD1,1")
@settings(deadline=None, max_examples=40)
def test_wrong_types_are_refused_in_words(path: str, asked: Any, raw: bytes | None) -> None:
    refused(path, asked, raw)


@pytest.mark.long
@ANYTHING
@settings(deadline=None, max_examples=300)
def test_many_wrong_types_are_refused_in_words(path: str, asked: Any, raw: bytes | None) -> None:
    refused(path, asked, raw)


def refused(path: str, asked: Any, raw: bytes | None) -> None:
    """Whatever comes, the answer is what it is good for, or 4xx with a message."""
    body = json.dumps(asked).encode() if raw is None else raw
    answer = SERVED.post(path, content=body)
    assert answer.status_code < 500
    if answer.status_code == 422:
        assert all(answer.json()["errors"])


@pytest.mark.more
@given(st.data())
@settings(deadline=None, max_examples=100)
def test_wrong_values_of_a_configuration_are_refused_in_words(data: Any) -> None:
    values: Any = json.loads(json.dumps(load(CARD).model_dump()))
    for _ in range(data.draw(st.integers(1, 3))):
        at = values
        while True:
            keys = list(at) if isinstance(at, dict) else list(range(len(at)))
            key = data.draw(st.sampled_from(keys))
            if not (isinstance(at[key], dict | list) and at[key] and data.draw(st.booleans())):
                break
            at = at[key]
        at[key] = data.draw(JSON)
    body = json.dumps(values).encode()
    for path in ("check", "text", "headers", "send/1"):
        answer = SERVED.post(f"/config/{path}", content=body)
        assert answer.status_code in (200, 422), answer.text
        if answer.status_code == 422:
            assert all(answer.json()["errors"])
