"""Let CNCjs, a sender that is not ours, work a live machine: its server, and its page once.

    PYTHONPATH=tests/helpers python tests/live/against_cncjs.py [FOLDER]

npm installs it into build/cncjs; it lists ports by udevadm (apt-get install udev). What it says is
printed, a picture of its page is left in FOLDER; ends with an error if something is not what the
machine did.
"""

import asyncio
import contextlib
import json
import math
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PLACE = ROOT / "build/cncjs"
RELAY = Path(__file__).with_name("cncjs_relay.mjs")
VERSION = "1.11.5"
PATIENCE = 90.0  # [s] on the wall
PACE = 4  # homing takes 40 s of the machine
CANCEL_JOG = "\x85"


@contextlib.asynccontextmanager
async def _running(*command: str, cwd: Path = ROOT) -> AsyncIterator[asyncio.subprocess.Process]:
    process = await asyncio.create_subprocess_exec(
        *command, cwd=cwd, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):
            process.send_signal(signal.SIGINT)
        try:
            await asyncio.wait_for(process.wait(), 20.0)
        except TimeoutError:
            process.kill()


async def _printed(process: asyncio.subprocess.Process, pattern: str) -> str:
    """What a process prints that fits."""
    assert process.stdout is not None
    while line := await asyncio.wait_for(process.stdout.readline(), PATIENCE):
        if found := re.search(pattern, line.decode()):
            return found[1]
    raise AssertionError(f"it has not printed {pattern}")


class Sender:
    """CNCjs's server by its socket API."""

    def __init__(self, relay: asyncio.subprocess.Process, device: str) -> None:
        self._relay, self._device = relay, device
        self.status: dict[str, Any] = {}
        self.sent: dict[str, Any] = {}
        self.read: list[str] = []
        self._changed = asyncio.Event()
        self._task = asyncio.ensure_future(self._listen())

    async def _listen(self) -> None:
        assert self._relay.stdout is not None
        while line := await self._relay.stdout.readline():
            event, *told = json.loads(line)
            if event == "controller:state":
                self.status = told[1].get("status", {})
            elif event == "sender:status":
                self.sent = told[0]
            elif event == "serialport:read":
                self.read.append(told[0])
            else:
                print("CNCjs:", event, *map(json.dumps, told))
            self._changed.set()

    @property
    def state(self) -> str:
        """The machine's state as CNCjs shows it."""
        return str(self.status.get("activeState"))

    @property
    def place(self) -> list[float]:
        """The machine's position [mm]."""
        return [float(self.status["mpos"][axis]) for axis in "xyz"]

    def emit(self, *event: Any) -> None:
        """Send an event to the server."""
        assert self._relay.stdin is not None
        self._relay.stdin.write((json.dumps(event) + "\n").encode())

    def command(self, *words: Any) -> None:
        """Give CNCjs a command for the machine."""
        self.emit("command", self._device, *words)

    async def until(self, what: str, holds: Callable[[], bool]) -> None:
        """Wait."""

        async def wait() -> None:
            while not holds():
                self._changed.clear()
                await self._changed.wait()

        try:
            await asyncio.wait_for(wait(), PATIENCE)
        except TimeoutError:
            raise AssertionError(f"never {what}: {self.status} {self.read[-5:]}") from None
        print(f"{what}: {self.state} {self.status.get('mpos')} {self.status.get('ov')}")

    async def until_state(self, *states: str) -> None:
        """Wait for a state."""
        await self.until(" or ".join(states), lambda: self.state in states)

    async def until_read(self, text: str) -> None:
        """Wait for a line of the machine."""
        await self.until(text, lambda: any(text in line for line in self.read))


def part(count: int) -> list[str]:
    """A closed curve of short lines, and rapids."""
    turns = [2 * math.pi * k / count for k in range(count + 1)]
    lines = [f"X{10 * math.sin(t):.3f}Y{5 - 5 * math.cos(t):.3f}" for t in turns]
    return ["G21G90", "M3S2000", "G1F2000", *lines, "G0Z-5", "G0Z-10", "M5"]


async def _drive(sender: Sender, device: str) -> None:
    sender.emit("open", device, {"controllerType": "Grbl", "baudrate": 115200})
    await sender.until_state("Alarm")
    sender.command("homing")
    await sender.until_state("Home")
    await sender.until_state("Idle")
    assert sender.place == [0, 0, 0]

    sender.command("gcode", "$J=G91X-200Z-200F3000")
    await sender.until_state("Jog")
    await sender.until("on its way", lambda: sender.place[0] < -2)
    sender.emit("write", device, CANCEL_JOG)
    await sender.until_state("Idle")
    assert -200 < sender.place[0] < -2
    sender.command("gcode", "$J=G91X200F3000")
    await sender.until_state("Jog")
    sender.emit("write", device, "!")
    await sender.until_state("Idle")
    sender.command("gcode", "G53G0X0Y0Z-30")
    await sender.until("there", lambda: sender.place == [0, 0, -30] and sender.state == "Idle")
    sender.command("gcode", "G10L20P1X0Y0Z0")
    await sender.until("zero", lambda: sender.status["wpos"] == dict.fromkeys("xyz", "0.000"))

    lines = part(600)
    sender.command("gcode:load", "part", "\n".join(lines), {})
    await sender.until("loaded", lambda: sender.sent.get("total", 0) >= len(lines))
    sender.command("gcode:start")
    await sender.until("half sent", lambda: sender.sent["received"] > 300)
    sender.command("feedhold")
    await sender.until_state("Hold")
    sender.command("feedOverride", 10)
    sender.command("rapidOverride", 50)
    sender.command("spindleOverride", -10)
    await sender.until("overrides", lambda: sender.status["ov"] == [110, 50, 90])
    sender.command("cyclestart")
    await sender.until_state("Run")
    await sender.until("all received", lambda: sender.sent["received"] == sender.sent["total"])
    await sender.until("end", lambda: sender.place == [0, 0, -40] and sender.state == "Idle")
    assert not any("error:" in line for line in sender.read)
    sender.command("gcode:stop")
    sender.command("feedOverride", 0)
    sender.command("rapidOverride", 100)
    sender.command("spindleOverride", 0)
    await sender.until("overrides", lambda: sender.status["ov"] == [100, 100, 100])

    sender.command("gcode", "G38.3Z-20F3000")
    await sender.until_read("[PRB:0.000,0.000,-50.000:0]")
    sender.command("gcode", "G1X200F1500")
    await sender.until_state("Run")
    sender.command("reset")
    await sender.until_read("ALARM:3")
    await sender.until_state("Alarm")
    sender.command("unlock")
    await sender.until_state("Idle")
    assert 0 < sender.place[0] < 200
    sender.emit("close", device)
    await asyncio.sleep(1.0)


async def _at_page(port: str, device: str, folder: Path) -> None:
    """Connect, home, jog, run a program as a person at CNCjs's page does."""
    from playwright.async_api import async_playwright, expect

    lines = part(60)
    file = folder / "part.ngc"
    file.write_text("\n".join(lines) + "\n")
    async with async_playwright() as library:
        browser = await library.chromium.launch(
            executable_path="/usr/bin/chromium", args=["--no-sandbox"]
        )
        page = await browser.new_page(viewport={"width": 1400, "height": 1000})
        page.set_default_timeout(30000)
        await page.goto(f"http://127.0.0.1:{port}/")
        shown = page.locator("body")
        await _connect(page, device)
        await expect(shown).to_contain_text("Alarm", timeout=60000)
        await page.get_by_role("button", name="Homing").first.click()
        await expect(shown).not_to_contain_text("-50.000", timeout=60000)  # where it has been
        await expect(shown).to_contain_text("Idle", timeout=60000)
        await page.locator("button", has_text="X+").first.click()
        await expect(shown).to_contain_text("1.000")
        await page.locator("input[type=file]").first.set_input_files(file)
        await page.locator("button:has(.fa-play), button[title='Run']").first.click()
        count = len(lines) + 1  # and CNCjs's own %wait
        received = f"{count} / {count}"
        await expect(shown.get_by_text(received)).to_have_count(2, timeout=60000)
        await expect(shown).to_contain_text("-40.000")
        await page.screenshot(path=folder / "cncjs.png")
        await browser.close()


async def _connect(page: Any, device: str) -> None:
    await page.get_by_text("Choose a port").first.click()
    await page.get_by_text(device, exact=True).first.click()
    await page.get_by_role("button", name="Open").first.click()


async def _work(folder: Path) -> None:
    live = ("-m", "motionfmu", "live", "mill3", "--port", "0", "--grbl", "pty", "--pace", f"{PACE}")
    async with _running(sys.executable, *live) as machine:
        device = await _printed(machine, r"grbl: (\S+)")
        folder.mkdir(parents=True, exist_ok=True)
        config = folder / "cncrc"
        config.write_text(json.dumps({"ports": [{"path": device, "manufacturer": ""}]}))
        options = ("--port", "0", "--host", "127.0.0.1", "--config", str(config))
        async with _running("node", "node_modules/cncjs/bin/cncjs", *options, cwd=PLACE) as server:
            port = await _printed(server, r"http://127.0.0.1:(\d+)")
            async with _running("node", str(RELAY), port, cwd=PLACE) as relay:
                await _drive(Sender(relay, device), device)
            await _at_page(port, device, folder)


def main() -> None:
    """Install CNCjs, if it is not there, and let it work."""
    if not shutil.which("udevadm"):
        sys.exit("CNCjs' page lists no port without udevadm: apt-get install udev")
    PLACE.mkdir(parents=True, exist_ok=True)
    if not (PLACE / "node_modules/cncjs").is_dir():
        command = ["npm", "install", "--no-fund", "--no-audit", f"cncjs@{VERSION}"]
        subprocess.run(command, cwd=PLACE, check=True)
    with tempfile.TemporaryDirectory() as folder:
        asyncio.run(_work(Path(sys.argv[1] if len(sys.argv) > 1 else folder)))


if __name__ == "__main__":
    main()
