#!/usr/bin/python3
"""Run part programs in a LinuxCNC that is up, as its display: in_linuxcnc.py starts it.

It writes times.txt into the folder of the programs: each program, and its time of feed moves [s].
"""

import importlib
import os
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

LIMIT = 900.0  # [s] for a program


def hal(*words: str) -> str:
    """What halcmd answers."""
    return subprocess.check_output(["halcmd", "-s", *words], text=True).strip()


def main(folder: Path) -> None:
    """Home, then run every program of a folder."""
    linuxcnc: Any = importlib.import_module("linuxcnc")
    command, state = linuxcnc.command(), linuxcnc.stat()

    def told(what: Any, *values: int) -> None:
        what(*values)
        command.wait_complete()

    def wait(what: Callable[[], bool]) -> None:
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            state.poll()
            if what():
                return
            time.sleep(0.01)
        raise TimeoutError

    time.sleep(1.0)
    told(command.state, linuxcnc.STATE_ESTOP_RESET)
    told(command.state, linuxcnc.STATE_ON)
    told(command.mode, linuxcnc.MODE_MANUAL)
    command.home(-1)
    wait(lambda: all(state.homed[:3]))
    with (folder / "times.txt").open("w", encoding="utf-8") as out:
        for file in sorted(folder.glob("*.ngc")):
            told(command.mode, linuxcnc.MODE_AUTO)
            hal("setp", "integ.0.reset", "1")
            time.sleep(0.05)
            hal("setp", "integ.0.reset", "0")
            told(command.program_open, str(file))  # type: ignore[arg-type]
            command.auto(linuxcnc.AUTO_RUN, 0)
            time.sleep(0.5)
            wait(lambda: state.interp_state == linuxcnc.INTERP_IDLE and state.inpos)
            print(file.stem, hal("getp", "integ.0.out"), file=out, flush=True)


if __name__ == "__main__":
    main(Path(os.environ["MOTIONFMU_PROGRAMS"]))
