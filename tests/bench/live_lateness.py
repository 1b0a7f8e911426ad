"""How late a live machine wakes at 1x, with its page open: `live_lateness.py MINUTES [attacked]
[OPTION...]`, options of `motionfmu live`.

A line a minute: wake-ups, their quantiles, memory of server and machine. With `attacked` every
other minute has strangers at its port: who is silent, who has no token, another host's name, a
foreign origin, too large or broken frames, and pages that ask for everything and read nothing.
"""

import asyncio
import contextlib
import json
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from playwright.async_api import async_playwright
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake

import motionfmu

CHROMIUM = "/usr/bin/chromium"
MACHINE = "mill3"
SHARES = (0.5, 0.99, 0.999, 1.0)
EVERYTHING = ["mcc.position", "machine.table_position", "drives.torque", "card.dac"]
REQUESTS = (
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",  # no token
    b"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n",  # another host's name
    b"POST /set HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: https://evil.example\r\n\r\n",
    b"GET /" + b"a" * 60_000 + b" HTTP/1.1\r\n\r\n",
    b"\x16\x03\x01" + bytes(range(256)) * 16,  # no HTTP
)


@contextlib.contextmanager
def machine(*options: str) -> Iterator[tuple[int, str, int, str]]:
    """The command's process, its page, port and token."""
    command = [sys.executable, "-m", "motionfmu", "live", MACHINE, "--port", "0", *options]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        for line in process.stdout:
            if found := re.search(r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)", line):
                yield process.pid, found[0], int(found[1]), found[2]
                return
    finally:
        process.terminate()
        process.wait()


def memory(pid: int) -> list[float]:
    """Resident megabytes of a process and of its children."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    found = []
    for p in (str(pid), *children):
        text = Path(f"/proc/{p}/status").read_text()
        found.append(int(re.search(r"VmRSS:\s+(\d+)", text)[1]) / 1024)  # type: ignore[index]
    return found


async def knock(port: int, request: bytes, wait: float) -> None:
    """Open a connection, say something, and wait."""
    with contextlib.suppress(OSError):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(request)
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(reader.read(1), wait)
        writer.close()


async def broken(port: int, first: str | bytes, then: str | bytes) -> None:
    """A WebSocket that says something wrong."""
    with contextlib.suppress(OSError, ConnectionClosed, InvalidHandshake, TimeoutError):
        async with connect(f"ws://127.0.0.1:{port}/live", max_size=None) as ws:
            await ws.send(first)
            await ws.send(then)
            await asyncio.wait_for(ws.recv(), 1.0)


async def deaf(port: int, token: str) -> None:
    """A page that asks for everything and reads nothing."""
    with contextlib.suppress(OSError, ConnectionClosed, InvalidHandshake):
        async with connect(f"ws://127.0.0.1:{port}/live", max_queue=1) as ws:
            await ws.send(token)
            await ws.send(json.dumps({"do": "watch", "with": {"names": EVERYTHING}}))
            await ws.send(json.dumps({"do": "samples", "with": {"since": 0}}))
            await asyncio.sleep(10.0)


async def attack(port: int, token: str, until: float) -> int:
    """All of them, again and again; how many there were."""
    count = 0
    while time.monotonic() < until:
        silent = [knock(port, b"", 2.0) for _ in range(500)]
        asked = [knock(port, r, 2.0) for r in REQUESTS for _ in range(20)]
        wrong = [
            broken(port, "no token", "x"),
            broken(port, "a" * 10_000_000, "x"),
            broken(port, token, "{" * 100_000),
            broken(port, token, b"\xff" * 5000),
        ]
        pages = [deaf(port, token) for _ in range(5)]
        await asyncio.gather(*silent, *asked, *wrong, *pages)
        count += len(silent) + len(asked) + len(wrong) + len(pages)
    return count


def counts(url: str) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Ends of the histogram's classes [s], and wake-ups in them."""
    with motionfmu.connect(url) as client:
        found = client.ask("lateness")
    return np.array(found["ends"]), np.array(found["counts"])


def quantile(ends: NDArray[np.float64], counts: NDArray[np.int64], share: float) -> float:
    """The end of the class [ms] below which a share of the wake-ups lies."""
    reached = np.searchsorted(np.cumsum(counts), share * counts.sum())
    return float(1e3 * ends[min(reached, len(ends) - 1)])


async def watch(minutes: int, attacked: bool, *options: str) -> None:
    """Open the page, and tell a line a minute."""
    with machine(*options) as (pid, url, port, token):
        async with async_playwright() as play:
            browser = await play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
            page = await browser.new_page(viewport={"width": 1400, "height": 900})
            await page.goto(url)
            before = (await asyncio.to_thread(counts, url))[1]
            begun = before
            for minute in range(1, minutes + 1):
                until, strangers = time.monotonic() + 60.0, 0
                if attacked and minute % 2 == 0:
                    strangers = await attack(port, token, until)
                await asyncio.sleep(max(0.0, until - time.monotonic()))
                ends, now = await asyncio.to_thread(counts, url)
                late = " ".join(f"{quantile(ends, now - before, s):8.3f}" for s in SHARES)
                held = " ".join(f"{m:6.1f}" for m in memory(pid))
                told = f"{minute:4} min {int((now - before).sum()):7} wake-ups, late by {late}"
                print(f"{told} ms; {held} MB; {strangers} strangers", flush=True)
                before = now
            for end, count in zip(ends, now - begun, strict=True):
                print(f"  up to {1e3 * end:9.3f} ms: {count}")
            await browser.close()


if __name__ == "__main__":
    more = [a for a in sys.argv[2:] if a != "attacked"]
    asyncio.run(watch(int(sys.argv[1]), len(more) < len(sys.argv) - 2, *more))
