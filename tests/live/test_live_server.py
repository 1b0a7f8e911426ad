"""The server of a live machine: who may, who has the hand, what stays when something is killed."""

import asyncio
import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from appearing import PATIENCE, appears
from websockets.asyncio.client import connect as open_later
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection
from websockets.sync.client import connect as open_socket

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.live import LiveClient


class Served:
    """``motionfmu live`` in a process of its own."""

    def __init__(self, *arguments: str) -> None:
        command = [sys.executable, "-m", "motionfmu", "live", *arguments, "--port", "0"]
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True)
        assert self.process.stdout is not None
        lines = iter(self.process.stdout.readline, "")
        self.url = next(line.split()[1] for line in lines if line.startswith("page:"))
        found = re.search(r":(\d+)/\?token=(\S+)", self.url)
        assert found
        self.port, self.token = int(found[1]), found[2]

    @property
    def machine(self) -> int:
        """The machine's process."""
        pid = self.process.pid
        (child,) = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        return int(child)

    def page(self, **more: Any) -> "Page":
        opening = open_socket(f"ws://127.0.0.1:{self.port}/live", max_size=None, **more)
        return Page(opening.__enter__(), self)

    def http(
        self, path: str, body: Any = None, headers: dict[str, str] | None = None
    ) -> tuple[int, str]:
        given = {"Authorization": f"Bearer {self.token}", **(headers or {})}
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        text = None if body is None else body if isinstance(body, str) else json.dumps(body)
        connection.request("GET" if body is None else "POST", path, text, given)
        answer = connection.getresponse()
        try:
            return answer.status, answer.read().decode()
        finally:
            connection.close()

    def end(self, number: int = signal.SIGINT) -> tuple[int, str, str]:
        """Status, stdout and stderr."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        out, err = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, out, err


class Page:
    """A page that knows the token."""

    def __init__(self, ws: ClientConnection, served: Served) -> None:
        self.ws, self.number = ws, 0
        self.others: list[Any] = []
        ws.send(served.token)
        self.about = json.loads(ws.recv(PATIENCE))["about"]

    def ask(self, request: str, /, **arguments: Any) -> Any:
        self.number += 1
        self.ws.send(json.dumps({"id": self.number, "do": request, "with": arguments}))
        answer = self.next(lambda m: isinstance(m, dict) and m.get("id") == self.number)
        if "error" in answer:
            raise InputError(answer["error"])
        return answer["value"]

    def next(self, wanted: Callable[[Any], bool]) -> Any:
        while True:
            got = self.ws.recv(PATIENCE)
            message = json.loads(got) if isinstance(got, str) else got
            if wanted(message):
                return message
            self.others.append(message)

    def frame(self) -> Any:
        """The next frame."""
        return self.next(lambda m: isinstance(m, dict) and "frame" in m)["frame"]


def gone(pid: int) -> bool:
    """Whether a process has ended, within the tests' patience."""
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until:
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.02)
    return False


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    there = Served("circle")
    yield there
    status, _, err = there.end()
    assert (status, err) == (130, "motionfmu: stopped\n")


def test_frames_have_what_a_page_looks_at(served: Served) -> None:
    page = served.page()
    assert page.frame()["values"] == {}
    page.ask("watch", names=["mcc.position", "mcc.status"])
    frame = page.next(lambda m: "frame" in m and m["frame"]["values"])["frame"]
    assert set(frame["values"]) == {"mcc.position", "mcc.status"} and frame["watchers"] == 1
    later = page.next(lambda m: "frame" in m and m["frame"]["steps"] > frame["steps"])["frame"]
    assert later["time"] == pytest.approx(later["steps"] * 1e-4)
    with pytest.raises(InputError, match=r"did you mean 'mcc\.position'"):
        page.ask("watch", names=["mcc.positio"])
    page.ask("watch", names=None)
    page.ask("values", names=["mcc.line"])
    page.others.clear()
    for _ in range(3):
        page.ask("values", names=["mcc.line"])
        time.sleep(0.05)
    assert not page.others
    page.ws.close()


def test_one_hand_many_watchers(served: Served) -> None:
    one, other = served.page(), served.page()
    one.ask("name", name="Anna")
    until = time.monotonic() + PATIENCE
    while not (frame := other.frame())["holder"] == "Anna" and time.monotonic() < until:
        pass
    assert not frame["hand"] and frame["watchers"] == 2
    with pytest.raises(InputError, match="Anna has the machine in hand: take it first"):
        other.ask("set", name="mcc.hold", value=True)
    other.ask("stop")  # for everybody
    one.ask("hold", name="mcc.hold", value=True, rest=False)
    other.ask("take")
    assert other.ask("values", names=["mcc.hold"]) == {"mcc.hold": [False]}  # let go with the hand
    other.ask("set", name="machine.force[1]", value=1.5)
    with pytest.raises(InputError, match="somebody else has the machine in hand"):
        one.ask("undo", name="machine.force")
    other.ws.close()
    until = time.monotonic() + PATIENCE
    while one.frame()["holder"] is not None and time.monotonic() < until:
        pass
    one.ask("undo", name="machine.force")  # who acts while nobody has it has it
    assert one.next(lambda m: "frame" in m and m["frame"]["hand"])
    one.ws.close()


def test_a_page_that_is_gone_holds_nothing(served: Served) -> None:
    page, other = served.page(), served.page()
    page.ask("take")
    page.ask("hold", name="mcc.hold", value=True, rest=False)
    page.ws.close()
    until = time.monotonic() + PATIENCE
    while other.ask("values", names=["mcc.hold"])["mcc.hold"][0]:
        assert time.monotonic() < until
    other.ws.close()


def test_samples_come_without_a_gap_and_a_recording_to_who_looks(served: Served) -> None:
    page, idle = served.page(), served.page()
    page.ask("take")
    page.ask("channels", names=["mcc.line", "machine.table_position[1]"])
    page.ask("samples", since=0)
    end = None
    for _ in range(5):
        about = page.next(lambda m: isinstance(m, dict) and "samples" in m)["samples"]
        data = np.frombuffer(page.next(lambda m: isinstance(m, bytes))).reshape(-1, 2)
        assert len(data) == about["rows"] and (end is None or about["begin"] == end)
        end = about["begin"] + about["rows"]
    page.ask("samples")
    setting = {"channel": "mcc.line", "kind": "level", "level": -1.0}
    page.ask("trigger", **setting, length=300, pre=0.0)
    about = page.next(lambda m: isinstance(m, dict) and "triggered" in m)["triggered"]
    data = page.next(lambda m: isinstance(m, bytes))
    assert about["rows"] == 300 and len(data) == 300 * 2 * 8 and about["at"] == about["begin"]
    page.ask("recording", number=0)
    assert {"triggered": about} in page.others and data in page.others
    idle.ask("values", names=[])
    assert not [m for m in idle.others if isinstance(m, bytes)]
    status, text = served.http(f"/samples.csv?begin={about['begin']}&end={about['begin'] + 3}")
    lines = text.splitlines()
    assert status == 200 and lines[0] == "time [s],mcc.line,machine.table_position[1] [m]"
    rows = np.frombuffer(data).reshape(-1, 2)
    got = [[float(x) for x in line.split(",")][1:] for line in lines[1:]]
    assert np.array(got).tobytes() == rows[:3].tobytes()
    page.ws.close(), idle.ws.close()


def test_requests_by_http_with_a_key_for_the_hand(served: Served) -> None:
    page = served.page()
    page.ask("take")
    status, text = served.http("/do/set", {"name": "mcc.hold", "value": False})
    assert status == 422 and "take it first" in json.loads(text)["error"]
    status, text = served.http("/do/take", {})
    key = {"Motionfmu-Hand": json.loads(text)["value"]["hand"]}
    assert served.http("/do/set", {"name": "mcc.hold", "value": False}, key)[0] == 200
    with pytest.raises(InputError, match="a program has the machine in hand"):
        page.ask("go")
    assert served.http("/do/drop", {}, key)[0] == 200
    assert served.http("/do/go", {}, key)[0] == 422  # the key is gone with it
    assert served.http("/do/values", {"names": ["mcc.line"]})[0] == 200
    for body, told in (
        ("[", "no JSON"),
        ("[" * 60000, "no JSON"),
        ("[1]", "arguments are a JSON object"),
        ("{}", "names is missing"),
    ):
        status, text = served.http("/do/values", body)
        assert status == 422 and told in json.loads(text)["error"]
    assert served.http("/do/values", " " * 70000)[0] == 413
    assert served.http("/do/watch", {"names": []})[0] == 422
    status, text = served.http("/openapi.json")
    assert status == 200 and "/do/jog" in json.loads(text)["paths"]
    page.ws.close()


def test_strangers_are_refused_and_the_machine_goes_on(served: Served) -> None:
    watching = served.page()
    before = watching.frame()["steps"]
    for headers in ({"Origin": "http://evil.example"}, {"Host": "evil.example"}):
        with pytest.raises(InvalidStatus):
            served.page(additional_headers=headers)
        assert served.http("/do/go", {}, headers)[0] == 403
    for given in ({"Authorization": ""}, {"Authorization": "Bearer x"}):
        assert served.http("/do/go", {}, given)[0] == 403
        assert served.http("/samples.csv", None, given)[0] == 403
    assert served.http("/samples.csv?begin=x")[0] == 422
    with open_socket(f"ws://127.0.0.1:{served.port}/live") as ws:
        ws.send("another token")
        with pytest.raises(ConnectionClosed):
            ws.recv(PATIENCE)
    later = watching.next(lambda m: "frame" in m and m["frame"]["steps"] > before + 100)
    assert not later["frame"]["error"]
    watching.ws.close()


@pytest.mark.parametrize(
    ("message", "told"),
    [
        (b"\x00\xff", "a message is text"),
        ("[" * 60000, "no JSON"),
        ("NaN", "no JSON"),
        ("[1]", "a message is a JSON object"),
        ('{"do": 7}', "7: no such request"),
        ('{"do": "set", "with": {"name": "a", "value": 1e999}}', "a finite number"),
        ('{"do": "set", "with": {"name": "a", "value": %s}}' % ("9" * 1000), "a finite number"),
        ('{"do": "set", "with": {"name": "\\ud800", "value": 1}}', "unicode"),
    ],
)
def test_a_broken_message_is_told_and_the_page_stays(
    served: Served, message: Any, told: str
) -> None:
    page = served.page()
    page.ask("take")
    page.ws.send(message)
    answer = page.next(lambda m: isinstance(m, dict) and "error" in m)
    assert told in answer["error"]
    page.ask("values", names=["mcc.line"])
    page.ws.close()


def test_a_huge_message_closes_its_page_only(served: Served) -> None:
    page, other = served.page(), served.page()
    page.ws.send("x" * 70000)
    with pytest.raises(ConnectionClosed):
        page.next(lambda m: False)
    other.frame()
    other.ws.close()


def test_fifty_watch_at_once(served: Served) -> None:
    async def watch() -> Any:
        async with open_later(f"ws://127.0.0.1:{served.port}/live") as ws:
            await ws.send(served.token)
            await ws.send(json.dumps({"do": "watch", "with": {"names": ["mcc.position"]}}))
            async for text in ws:
                frame = json.loads(text).get("frame", {})
                if frame.get("watchers") == 50 and frame["values"]:
                    seen.append(frame["steps"])
                    break
            while len(seen) < 50:
                await ws.recv()

    async def all_of_them() -> None:
        await asyncio.wait_for(asyncio.gather(*(watch() for _ in range(50))), PATIENCE)

    seen: list[int] = []
    asyncio.run(all_of_them())
    assert len(seen) == 50


@pytest.mark.more
def test_silent_connections_and_pages_that_read_nothing_are_cut_off(served: Served) -> None:
    silent = [socket.create_connection(("127.0.0.1", served.port)) for _ in range(500)]
    for s in silent[::2]:
        s.send(b"GET / HTTP/1.1\r\n")  # and no more
    alone = socket.create_connection(("127.0.0.1", served.port))
    page = served.page()  # while they are there
    assert page.frame()["watchers"] == 1
    for s in (*silent, alone):
        s.settimeout(PATIENCE)
        try:
            assert s.recv(1) == b""
        except ConnectionResetError:
            pass
        s.close()
    page.ask("take")
    page.ask("channels", names=[f"mcc.position[{k}]" for k in range(1, 7)])
    page.ask("samples", since=0)
    page.ask("watch", names=["mcc.position", "machine.table_position", "drives.torque"])
    watching = served.page()
    frame = watching.next(lambda m: "frame" in m and m["frame"]["watchers"] == 2)
    # The client reads no more once 16 messages wait in it; the server drops it some seconds later.
    watching.next(lambda m: "frame" in m and m["frame"]["watchers"] == 1)
    assert watching.frame()["steps"] > frame["frame"]["steps"]
    watching.ws.close()


def test_an_operators_script_is_a_test(served: Served, tmp_path: Path) -> None:
    with motionfmu.live.connect(served.url, "script") as m:
        assert isinstance(m, LiveClient) and "circle" in repr(m)
        m.take()
        m.set("machine.force[2]", 12.0)
        assert m["machine.force"].tolist() == [0, 12, 0, 0, 0, 0] and m["machine.force[2]"] == 12
        m.pause()
        begun = m.time
        assert m.step(250) == pytest.approx(begun + 0.025)
        with pytest.raises(InputError, match="the machine stands"):
            m.wait("mcc.status", 99)
        m.channels(["machine.table_position[1]"])
        m.record(tmp_path / "trace.csv")
        m.pace(None)
        m.go()
        until = m.time + 0.5
        while m.time < until:
            pass
        assert m.end_record() == [str(tmp_path / "trace.csv")]
        m.jog("X", 1, 0.2)
        assert m["mcc.jog[1]"] == 0
        with pytest.raises(InputError, match="Q: the machine has no such axis"):
            m.jog("Q", 1, 0.2)
        m.pause()
        last, steps = m["machine.table_position"], m.ask("frame")["steps"]
        m.step()
        m.save(tmp_path / "done")
        m.pace(1.0)
        m.go()
    plan = motionfmu.load(tmp_path / "done").changed(record={"every": 1})
    assert plan.run()["machine.table_position"][steps].tobytes() == last.tobytes()
    trace = motionfmu.record(tmp_path / "trace.csv")
    assert len((tmp_path / "trace.csv").read_text().splitlines()) > 5000 and trace


@pytest.mark.parametrize(
    ("url", "told"),
    [
        ("http://127.0.0.1:1/?token=x", "no live machine answers"),
        ("127.0.0.1:8770", "the address that motionfmu live prints is wanted"),
        ("http://127.0.0.1:8770/", "the address that motionfmu live prints is wanted"),
    ],
)
def test_an_address_where_there_is_nothing(url: str, told: str) -> None:
    with pytest.raises(InputError, match=told):
        motionfmu.live.connect(url)


def test_a_server_that_is_killed_leaves_the_scenario_and_the_record(tmp_path: Path) -> None:
    served = Served("circle", "--save-as", str(tmp_path / "saved"))
    page = served.page()
    page.ask("channels", names=["machine.table_position[1]"])
    begin = page.ask("record", file=str(tmp_path / "trace.csv"))
    page.ask("set", name="machine.force[1]", value=80.0)
    page.next(lambda m: "frame" in m and m["frame"]["steps"] > begin + 2000)
    machine = served.machine
    served.process.kill()
    assert gone(machine)
    appears(tmp_path / "trace.csv")
    table = np.loadtxt(tmp_path / "trace.csv", delimiter=",", skiprows=1)
    result = motionfmu.load(tmp_path / "saved").changed(record={"every": 1}).run()
    own = result["machine.table_position"][begin : begin + len(table), 0]
    assert len(table) > 2000 and own.tobytes() == table[: len(own), 1].tobytes()
    served.end()


def test_a_machine_that_is_killed_is_told(tmp_path: Path) -> None:
    served = Served("circle")
    page = served.page()
    page.ask("channels", names=["mcc.line"])
    page.ask("record", file=str(tmp_path / "trace.npz"))
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until and not any(f.stat().st_size for f in tmp_path.iterdir()):
        page.frame()
    os.kill(served.machine, signal.SIGKILL)
    ended = page.next(lambda m: isinstance(m, dict) and "ended" in m)["ended"]
    assert ended == "the machine's process was ended by SIGKILL"
    status, _, err = served.end(0)
    assert (status, err) == (1, f"motionfmu: {ended}\n")
    appears(tmp_path / "trace.npz")
    with np.load(tmp_path / "trace.npz") as arrays:
        assert set(arrays) == {"time", "mcc.line"}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_when_it_is_told(number: int, tmp_path: Path) -> None:
    served = Served("xy_table", "--save-as", str(tmp_path / "saved"), "--pace", "inf")
    page = served.page()
    page.frame()
    machine = served.machine
    status, out, err = served.end(number)
    stopped = number == signal.SIGINT
    assert (status, err) == ((130, "motionfmu: stopped\n") if stopped else (0, ""))
    assert out == f"saved: {tmp_path / 'saved/scenario.toml'}\n" and gone(machine)
    motionfmu.load(tmp_path / "saved")


def told(*arguments: str) -> str:
    """The message of a command whose input is wrong."""
    command = [sys.executable, "-m", "motionfmu", "live", *arguments]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
    assert ran.returncode == 2 and ran.stderr.count("\n") == 1 and not ran.stdout
    return ran.stderr


def test_a_port_that_is_none_or_taken_is_told(served: Served) -> None:
    assert "--port 70000: 0 to 65535 wanted" in told("circle", "--port", "70000")
    assert "in use" in told("circle", "--port", str(served.port))


@pytest.mark.more
def test_wrong_input_is_one_message(tmp_path: Path) -> None:
    for arguments, text in (
        (["circl"], "circl"),
        (["mill3", "--program", "nix.ngc"], "nix.ngc: no such program"),
        (["circle", "--program", "nix.ngc"], "nix.ngc: no such program"),
        (["circle", "--pace", "0.001"], "pace 0.001: 0.01 to 100, or inf"),
        (["circle", "--save-as", str(tmp_path)], "is there already"),
        (["circle", "--set", "mcc.nix=1"], "mcc.nix"),
    ):
        assert text in told(*arguments, "--port", "0")


@pytest.mark.skipif(sys.platform != "linux", reason="SCHED_FIFO is Linux's")
def test_only_the_machine_runs_before_others() -> None:
    may = "import os; os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(49))"
    if subprocess.run([sys.executable, "-c", may], capture_output=True, check=False).returncode:
        command = [sys.executable, "-m", "motionfmu", "live", "circle", "--realtime"]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        assert ran.returncode == 2 and "motionfmu: --realtime: Operation not" in ran.stderr
        return
    server = Served("circle", "--realtime")
    threads = os.listdir(f"/proc/{server.machine}/task")
    assert {os.sched_getscheduler(int(t)) for t in threads} == {os.SCHED_FIFO}
    assert len(threads) > 2 and os.sched_getscheduler(server.process.pid) == os.SCHED_OTHER
    server.end()


@pytest.mark.more
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_refused_requests_leave_no_memory(served: Served) -> None:
    """A wrong request leaves cycles of objects, with all of its text."""

    def held() -> float:
        text = Path(f"/proc/{served.process.pid}/status").read_text()
        found = re.search(r"VmRSS:\s+(\d+) kB", text)
        assert found
        return int(found[1]) / 1024

    def knock() -> None:
        with socket.create_connection(("127.0.0.1", served.port)) as s:
            s.sendall(b"GET /" + b"a" * 60_000 + b" HTTP/1.1\r\n\r\n")
            assert s.recv(12) == b"HTTP/1.1 400"

    for _ in range(100):
        knock()
    before = held()
    for _ in range(400):
        knock()
    assert held() < before + 20.0  # [MB]
