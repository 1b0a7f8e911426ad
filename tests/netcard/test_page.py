"""The page of the cards, without a socket: who may, commands, jobs, configuration."""

import asyncio
import contextlib
import io
import json
import shutil
import signal
import socket
import subprocess
import sys
import time
import zipfile
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
import pytest
from conftest import ROOT
from console import within
from fleet import Fleet, circle, status
from hypothesis import given, settings
from hypothesis import strategies as st
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.routing import Route
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from motionfmu.base import page_server
from motionfmu.base.errors import InputError
from motionfmu.base.page_guard import HEADERS
from motionfmu.cards.card_job import decode
from motionfmu.cards.config import CardConfig, load, read
from motionfmu.cards.config_text import text_of, with_values
from motionfmu.cards.server_page import PageServer, application
from motionfmu.cards.server_page.form import form
from motionfmu.cards.server_page.job_pictures import POINTS, picture

CARD = ROOT / "examples/network_card_firmware/card.toml"
TOKEN, HOST, LIVE = "a-token", "http://127.0.0.1:8766", "ws://127.0.0.1:8766/live"


def client(fleet: Any, config: Path | None = None, **headers: str) -> TestClient:
    own = {"authorization": f"Bearer {TOKEN}"} | headers
    return TestClient(application(fleet, TOKEN, config), HOST, headers=own)


@pytest.fixture
def fleet() -> Fleet:
    cards = Fleet()
    cards.add(1, "READY")
    cards.add(2, "EMPTY")
    return cards


# Who may.


@pytest.mark.parametrize(
    ("headers", "allowed"),
    [
        ({}, True),
        ({"origin": HOST}, True),
        ({"origin": "http://localhost:8766", "host": "localhost:8766"}, True),
        ({"origin": "http://evil.example"}, False),
        ({"origin": "null"}, False),
        ({"origin": "http://127.0.0.1:1"}, False),
        ({"origin": "https://127.0.0.1:8766"}, False),
        ({"host": "evil.example:8766"}, False),
        ({"host": "evil.example:8766", "origin": "http://evil.example:8766"}, False),
        ({"host": "127.0.0.1.evil.example"}, False),
        ({"authorization": "Bearer another"}, False),
        ({"authorization": ""}, False),
        ({"authorization": "Bearer \u00e4"}, False),
    ],
)
def test_only_this_page_with_the_token_starts_a_card(
    fleet: Fleet, headers: dict[str, str], allowed: bool
) -> None:
    given_headers: Any = {k: v.encode("latin-1") for k, v in headers.items()}
    answer = client(fleet).post("/cards/1/command", json={"name": "start"}, headers=given_headers)
    assert answer.status_code == (200 if allowed else 403)
    assert fleet.done == ([(1, "start")] if allowed else [])
    assert all(answer.headers[k] == v for k, v in HEADERS.items())


@pytest.mark.parametrize(
    ("headers", "token"),
    [({"origin": "http://evil.example"}, TOKEN), ({"host": "evil.example"}, TOKEN), ({}, "x")],
)
def test_nobody_else_hears_of_the_cards(fleet: Fleet, headers: Any, token: str) -> None:
    with pytest.raises(WebSocketDisconnect) as error:
        with client(fleet).websocket_connect(LIVE, headers=headers) as line:
            line.send_text(token)
            line.receive_text()
    assert error.value.code == 1008
    assert fleet.queues == []


def test_who_has_no_token_yet_can_send_little(fleet: Fleet) -> None:
    """4 kB, that are no token, and no byte of a longer message is kept."""

    async def closed(length: int) -> int:
        async with PageServer(application(fleet, TOKEN), 0) as port:
            async with connect(f"ws://127.0.0.1:{port}/live") as line:
                with contextlib.suppress(ConnectionClosed):
                    await line.send("x" * length)
                await line.wait_closed()
                return line.close_code or 0

    assert asyncio.run(closed(4096)) == 1008  # read, and no token
    assert asyncio.run(closed(4097)) == 1009  # too big to be read


def test_the_page_is_whole_without_any_other_server(fleet: Fleet) -> None:
    c = client(fleet, authorization="")
    text = c.get("/?token=x").text
    assert "a-token" not in text and "style=" not in text and "<script>" not in text
    folder = ROOT / "src/motionfmu/cards/server_page"
    for file in folder.glob("*.[jch]*s*"):
        assert c.get(f"/{file.name}").text == file.read_text()
        assert "://" not in file.read_text()
    assert c.get("/app.py").status_code == 404 and c.get("/..%2fconfig.py").status_code == 404
    assert c.get("/cards/1/command").status_code == 405


# Cards.


def test_a_command_is_answered_with_its_end_and_its_reason(fleet: Fleet) -> None:
    c = client(fleet)
    fleet.add(3, connected=False)

    def told(card: int, name: str) -> tuple[bool, str, str]:
        said = c.post(f"/cards/{card}/command", json={"name": name}).json()
        return said["ok"], said["text"], said["state"]

    assert told(1, "start") == (True, "done", "RUNNING")
    assert told(1, "home") == (False, "not in this state", "RUNNING")
    assert told(2, "start") == (False, "there is no job in the card", "EMPTY")
    assert told(3, "stop") == (False, "the card is not connected", "")
    assert fleet.done == [(1, "start")]
    assert c.post("/cards/1/command", content=b"[1]").json() == {
        "errors": ["a JSON object is wanted"]
    }
    assert c.post("/cards/1/command", content=b"[" * 100_000).status_code == 422
    assert c.post("/cards/x/command", json={}).status_code == 404


def test_a_page_hears_of_all_cards_then_of_those_that_change(fleet: Fleet) -> None:
    fleet.tell("connected", 2, "hello")
    c = client(fleet)
    with c.websocket_connect(LIVE, headers={"origin": HOST}) as line:
        line.send_text(TOKEN)
        first = line.receive_json()
        assert [card["id"] for card in first["cards"]] == [1, 2]
        assert first["cards"][0]["status"]["load"] == list(status().load)
        assert [e["text"] for e in first["events"]] == ["hello"]
        c.post("/cards/1/command", json={"name": "start"})
        then = line.receive_json()
        assert [(card["id"], card["state"]) for card in then["cards"]] == [(1, "RUNNING")]
        assert [e["text"] for e in then["events"]] == ["start: done"]
        del fleet.cards[2]
        fleet.tell("status", 1, "")
        assert line.receive_json() == {"cards": [], "gone": [2], "events": []}
    deadline = time.monotonic() + 60  # it takes milliseconds
    while fleet.queues and time.monotonic() < deadline:
        time.sleep(0.01)
    assert fleet.queues == []


# Jobs.


def test_a_picture_has_the_speed_the_pen_and_the_places_of_the_job() -> None:
    data = circle(40.0)
    p = picture(decode(data), data, "circle.mcj")
    x, y, v = (np.array(p[k]) for k in ("x", "y", "speed"))
    down = np.array(p["down"], bool)
    assert np.abs(np.hypot(x - 40.0, y) - 40.0).max() < 2e-3  # half a pulse in each axis
    ways = np.hypot(np.diff(x), np.diff(y)) / 1e-3
    assert np.abs(ways - v[1:]).max() < 0.06 + 0.7  # its rounding, and that of the places
    assert p["fastest"] == pytest.approx(
        2 * np.pi * 40 / 2.6 * 2, rel=2e-2
    )  # sin^2: twice its mean
    assert p["drawn"] == pytest.approx(2 * np.pi * 40, rel=1e-3) and p["moved"] == 0
    assert not down[:10].any() and down[12:2600].all() and not down[2670:].any()
    assert p["lines"] == 1 and p["low"] == [0, -40] and p["high"] == [80, 40]


def test_a_long_job_is_thinned_where_it_does_not_show() -> None:
    data = circle(40.0, turns=8)
    p = picture(decode(data), data, "long.mcj")
    x, y = np.array(p["x"]), np.array(p["y"])
    assert len(x) <= POINTS + 4 < p["frames"] and p["frame"][-1] == p["frames"]
    middle = np.hypot((x[1:] + x[:-1]) / 2 - 40, (y[1:] + y[:-1]) / 2)
    assert 39.9 < middle.min() and np.hypot(x - 40, y).max() < 40.002
    assert np.all(np.diff(p["frame"]) > 0)


def test_a_drawing_is_planned_with_the_configuration_and_sent(fleet: Fleet, tmp_path: Path) -> None:
    drawing = b"IN;SP1;PU400,400;PD2000,400,2000,1600;PU0,0;SP0;"
    config = tmp_path / "card.toml"
    shutil.copy(CARD, config)
    c = client(fleet, config)
    p = c.post("/open?name=a.plt", content=drawing).json()
    assert (p["name"], p["lines"]) == ("a.plt", 1)
    # A corner swings out by the tolerance at most.
    assert [*p["low"], *p["high"]] == pytest.approx([10, 10, 50, 40], abs=0.021)
    assert p["drawn"] == pytest.approx(70, abs=0.1)
    assert p["fastest"] > 90
    assert c.post("/picture", json={"job": p["job"]}).json() == p
    assert c.post("/cards/2/job", json={"job": p["job"]}).json()["ok"]
    assert fleet.cards[2].job == p["job"] and fleet.cards[2].state == "READY"
    wrong = c.post("/open?name=b.plt", content=b"IN;SP1;PD20000,0;")
    assert wrong.status_code == 422
    assert "X = 500.000 mm, beyond the limit 410 mm" in wrong.json()["errors"][0]
    assert c.post("/picture", json={"job": "0"}).json() is None
    assert "not open any more" in c.post("/cards/2/job", json={"job": 1}).json()["errors"][0]
    told = client(fleet).post("/open?name=c.plt", content=drawing).json()["errors"]
    assert told == ["c.plt: a drawing needs the card's configuration: fill it in first"]
    damaged = bytearray(circle())
    damaged[300] ^= 1
    assert c.post("/open", content=bytes(damaged)).status_code == 422


def test_one_page_of_a_drawing_is_opened(fleet: Fleet) -> None:
    drawing = b"IN;SP1;PU400,400;PD2000,400;PG;PU400,800;PD1000,800;PG;"
    c = client(fleet, CARD)
    for page, width in (("", 40), ("&page=1", 40), ("&page=2", 15)):
        p = c.post(f"/open?name=a.plt{page}", content=drawing).json()
        assert p["drawn"] == pytest.approx(width, abs=0.1)
        assert (p["page"], p["pages"]) == (int(page[-1:] or 1), 2)
        assert p["notes"] == []  # nothing is passed over
    for page, why in (("3", "a.plt: no page 3, it has 2 pages"), ("x", "page 'x': a number")):
        wrong = c.post(f"/open?name=a.plt&page={page}", content=drawing)
        assert wrong.status_code == 422 and wrong.json()["errors"][0].startswith(why)


def test_files_are_opened_by_a_process_of_their_own(
    fleet: Fleet, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Commands do not wait for a plan: nothing of it runs beside them."""

    def never(*_: object) -> None:
        raise AssertionError("a file was opened by the server itself")

    names = ("opened", "decode", "picture")
    for name in ("plan_process.opened", *(f"job_pictures.{name}" for name in names)):
        monkeypatch.setattr(f"motionfmu.cards.server_page.{name}", never)
    c = client(fleet, CARD)
    assert c.post("/open?name=a.plt", content=b"PU400,400;PD2000,400;").json()["lines"] == 1
    assert c.post("/open?name=b.mcj", content=circle()).json()["lines"] == 1
    monkeypatch.setattr("sys.executable", shutil.which("false"))
    told = c.post("/open?name=c.plt", content=b"PD1,1;")
    assert told.status_code == 422 and "c.plt: it could not be opened" in told.json()["errors"][0]


def test_that_process_imports_nothing_of_the_folder_it_runs_in(
    fleet: Fleet, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("json", "numpy", "contextlib", "motionfmu"):
        (tmp_path / f"{name}.py").write_text("open('imported', 'w').write(__name__)\n")
    monkeypatch.chdir(tmp_path)
    opened = client(fleet).post("/open?name=b.mcj", content=circle())
    assert not (tmp_path / "imported").exists()
    assert opened.json()["lines"] == 1


def test_an_answer_is_not_held_back_for_an_acknowledgement(fleet: Fleet) -> None:
    async def option() -> int:
        serving = PageServer(application(fleet, TOKEN), 0)
        async with serving as port:
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(b"GET / HTTP/1.1\r\nhost: localhost\r\n\r\n")
            await reader.readline()
            (taken,) = serving._server.server_state.connections
            there = taken.transport.get_extra_info("socket")  # type: ignore[union-attr]
            found = int(there.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
            writer.close()
            return found

    assert asyncio.run(option())


def test_more_bytes_than_a_job_can_have_are_not_kept(fleet: Fleet) -> None:
    answer = client(fleet).post("/open", content=bytes((16 << 20) + 1))
    assert answer.json() == {"errors": ["more than 16777216 bytes"]}


# Configuration.


def test_the_form_has_every_field_of_the_file() -> None:
    config = load(CARD).model_dump()
    pen = config["motion"].pop("pen")
    rows = {s["place"]: {f["name"]: f for f in s["fields"]} for s in form()}
    for place in ("network", "motion", "pulse", "fifo", "tasks"):
        assert set(rows[place]) == set(config[place])
    assert set(rows["motion.pen"]) == set(pen) and set(rows["inputs"]) == set(config["inputs"][0])
    assert set(rows["axes"]) == set(config["axes"][0]) - {"name"}
    period = rows["motion"]["period"]
    assert (period["low"], period["high"], period["unit"]) == pytest.approx((250e-6, 0.01, "s"))
    assert rows["axes"]["jerk_max"]["unit"] == "mm/s³"
    assert rows["motion"]["corner_angle"]["unit"] == "°"
    assert rows["motion"]["reserve"]["high"] == 0.9 and rows["tasks"]["run"]["kind"] == "whole"
    assert rows["inputs"]["action"]["choices"][2] == "pause"
    assert rows["axes"]["maximum"]["default"] is None
    assert rows["motion"]["must_home"]["kind"] == "yes" and rows["network"]["ip"]["kind"] == "text"


def test_values_are_checked_as_the_file_is_and_saved_whole(fleet: Fleet, tmp_path: Path) -> None:
    file = tmp_path / "card.toml"
    shutil.copy(CARD, file)
    c = client(fleet, file)
    values = c.post("/config/form").json()["values"]
    assert c.post("/config/check", json=values).json() == {"faults": []}
    values["axes"][0]["speed_max"], values["network"]["port"] = 600, 0
    found = c.post("/config/check", json=values).json()["faults"]
    assert [f["place"] for f in found] == ["network.port", "axes.0.speed_max"]
    before = file.read_text()
    assert c.post("/config/save", json=values).status_code == 422
    assert c.post("/config/headers", json=values).status_code == 422
    assert file.read_text() == before
    values["axes"][0]["speed_max"], values["network"]["port"] = 150, 9000
    assert c.post("/config/save", json=values).json() == {"file": str(file)}
    assert load(file).axes[0].speed_max == 150 and load(file).network.port == 9000
    assert [f.name for f in tmp_path.iterdir()] == ["card.toml"]
    answer = c.post("/config/headers", json=values)
    archive = zipfile.ZipFile(io.BytesIO(answer.content))
    assert len(archive.namelist()) == 6
    assert b"MC_X_SPEED_MAX 150000UL" in archive.read("mc_axes.h")
    assert c.post("/config/headers", json=values).content == answer.content
    said = c.post("/config/read", json={"text": before, "name": "x.toml"}).json()
    assert said["values"] == json.loads(load(CARD).model_dump_json())
    told = c.post("/config/read", json={"text": "[network]\nport = 0\n", "name": "x.toml"}).json()
    assert told["errors"][1].startswith("x.toml:2: network.port = 0: ")
    with pytest.raises(InputError):
        application(fleet, TOKEN, tmp_path / "none.toml")


def test_comments_stay_or_their_loss_is_told_before(fleet: Fleet, tmp_path: Path) -> None:
    file = tmp_path / "card.toml"
    text = CARD.read_text() + "# the end\n"
    file.write_text(text)
    c = client(fleet, file)
    values = c.post("/config/form").json()["values"]
    c.post("/config/save", json=values)
    assert file.read_text() == text
    values["axes"][1]["speed_max"], values["inputs"][7]["action"] = 150, "stop"
    values["pulse"]["width"], values["outputs"][5] = 0.8e-6, "air"
    assert c.post("/config/save", json=values).json() == {"file": str(file)}
    saved = file.read_text()
    assert saved.count("#") == text.count("#") and saved.startswith(text[:200])
    assert load(file) == CardConfig.model_validate(values) != load(CARD)
    del values["axes"][1]
    assert c.post("/config/save", json=values).json() == {"file": str(file), "loses": True}
    assert file.read_text() == saved
    assert c.post("/config/save?lose", json=values).json() == {"file": str(file)}
    assert len(load(file).axes) == 1


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("feed = 1 # a", "feed = 7 # a"),
        ("'feed'=1.0#a", "'feed'=7#a"),
        ("feed = 1e0\r\n", "feed = 7\r\n"),
        ("# feed = 1", "feed = 7\n# feed = 1"),
        ("feed = 1\n[outputs]\n1 = 'a#b' # c", "feed = 7\n[outputs]\n1 = 'a#b' # c"),
    ],
)
def test_only_the_value_is_replaced(old: str, new: str) -> None:
    text = CARD.read_text()
    head = text[text.index("[[axes]]") : text.index("[motion]")]
    config = read(f"{head}[motion]\n{new}".replace("a#b", "ab"), "")
    changed = with_values(f"{head}[motion]\n{old}".replace("a#b", "ab"), config)
    assert changed == f"{head}[motion]\n{new}".replace("a#b", "ab")


def test_the_form_is_sent_to_a_card(fleet: Fleet) -> None:
    c = client(fleet, CARD)
    values = c.post("/config/form").json()["values"]
    line = "Axis X: Highest speed: 1 -> 200 mm/s: "
    said = c.post("/config/send/1", json=values).json()
    assert said == {"ok": True, "text": "done", "lines": [f"{line}done"]}
    assert fleet.done == [(1, "speed_max 200000")]
    fleet.move(1, "RUNNING")
    said = c.post("/config/send/1", json=values).json()
    assert not said["ok"] and said["lines"][0].startswith(f"{line}the card is busy")
    values["axes"][0]["speed_max"] = 600
    assert c.post("/config/send/1", json=values).status_code == 422
    assert len(fleet.done) == 2
    headers = {"authorization": ""}
    assert c.post("/config/send/1", json=values, headers=headers).status_code == 403


NUMBERS = st.floats(0.5, 400).map(lambda x: round(x, 6))


@settings(max_examples=15)
@given(st.data())
def test_the_text_of_a_configuration_is_read_as_the_same(data: Any) -> None:
    tree = load(CARD).model_dump()
    tree["axes"][0]["speed_max"] = data.draw(st.floats(20, 500))
    tree["axes"][1]["maximum"] = data.draw(NUMBERS)
    tree["motion"]["tolerance"] = data.draw(st.floats(1e-9, 10))
    tree["motion"]["must_home"] = data.draw(st.booleans())
    tree["inputs"][data.draw(st.integers(0, 15))]["edge"] = "both"
    tree["outputs"][data.draw(st.integers(6, 15))] = data.draw(st.from_regex(r"\A[a-z][0-9_]{2}\Z"))
    config = CardConfig.model_validate(tree)
    assert read(text_of(config), "card.toml") == config


# The command.


def test_the_command_serves_the_page_and_ends_with_it(tmp_path: Path) -> None:
    line = ["card", "serve", "--port", "0", "--folder", tmp_path / "cards", "-c", CARD]
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        refused = within(*line, "--page", port)
    assert refused.returncode == 2 and refused.stdout == ""
    assert refused.stderr == f"motionfmu: page 127.0.0.1:{port}: Address already in use\n"
    command = [sys.executable, "-m", "motionfmu", *map(str, line), "--page", str(port)]
    server = subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    assert server.stdout and server.stdout.readline().startswith("cards: 127.0.0.1:")
    address = server.stdout.readline().removeprefix("page: ").strip()
    head, _, token = address.partition("?token=")
    assert head == f"http://127.0.0.1:{port}/" and len(token) >= 20
    answer = httpx2.post(f"{head}config/form", headers={"authorization": f"Bearer {token}"})
    assert answer.json()["file"] == str(CARD)
    assert (
        httpx2.post(f"{head}config/form", headers={"authorization": "Bearer x"}).status_code == 403
    )
    server.send_signal(signal.SIGINT)
    assert server.wait(20) == 130


def test_of_too_many_connections_the_oldest_that_asks_for_nothing_goes(
    fleet: Fleet, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(page_server, "CONNECTIONS", 3)
    monkeypatch.setattr(page_server, "ASKING", 1e6)

    async def which() -> list[bool]:
        async with PageServer(application(fleet, TOKEN), 0) as port:
            lines = []
            for _ in range(5):
                lines.append(await asyncio.open_connection("127.0.0.1", port))
                await asyncio.sleep(0.05)
            ends = [asyncio.create_task(reader.read()) for reader, _ in lines]
            await asyncio.wait(ends[:2], timeout=60)
            gone = [end.done() for end in ends]
            for _, writer in lines:
                writer.close()
            return gone

    assert asyncio.run(which()) == [True, True, False, False, False]


def test_a_page_that_ends_answers_first() -> None:
    async def main() -> bytes:
        begun, done = asyncio.Event(), asyncio.Event()

        async def slow(_: Request) -> PlainTextResponse:
            begun.set()
            await asyncio.sleep(0.2)
            done.set()
            return PlainTextResponse("whole")

        async with PageServer(Starlette(routes=[Route("/", slow)]), 0) as port:
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
            await begun.wait()
        assert done.is_set()
        return await reader.read()

    assert asyncio.run(main()).endswith(b"whole")
