"""Library and card as FMUs, exchanged value by value, so that every frame is seen on the wire."""

import atexit
import tempfile
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import extract

from motionfmu.run.engines.slave import Slave
from motionfmu.scenario import fmus

STEP = 1e-4  # [s] communication step and bus period
CLOCK = 25e-9  # [s]
AXES = 3
PULSES_PER_MM = 1000
LIMIT = 12.0  # [s] longest run


class Wires:
    """Outputs of one FMU to the inputs of another that bear the same name after a prefix."""

    def __init__(self, slaves: dict[str, Slave]) -> None:
        self.slaves, self.buffers = slaves, {}
        self.gets, self.sets = [], []
        mcc, card = fmus.ports("mcc"), fmus.ports("epcio")
        pairs = [
            (("mcc", "card_" + n[5:]), ("card", n))
            for n in card
            if n.startswith("host_") and "card_" + n[5:] in mcc
        ]
        pairs += [
            (("card", n[5:]), ("mcc", n))
            for n, p in mcc.items()
            if n.startswith("card_") and p.causality == "input"
        ]
        self.ports = {"mcc": mcc, "card": card}
        for source, target in pairs:
            buffer = self.watch(*source)
            to = self.ports[target[0]][target[1]]
            self.sets.append(slaves[target[0]].access("Set", to.type, to.reference, buffer))

    def watch(self, component: str, name: str) -> Any:
        """Read this output at every communication point; returns its buffer."""
        if (component, name) not in self.buffers:
            port = self.ports[component][name]
            slave = self.slaves[component]
            buffer = slave.buffer(port.type, port.count)
            self.gets.append(slave.access("Get", port.type, port.reference, buffer))
            self.buffers[component, name] = buffer
        return self.buffers[component, name]


@dataclass
class Case:
    """A program, the settings of library and card, and what the panel does when."""

    program: str
    settings: dict[str, Any]
    panel: list[tuple[float, str, Any]] = field(default_factory=list)
    refusals: tuple[int, ...] = (0,)  # frames the card refuses of each transaction, in turn


@cache
def unpacked(name: str) -> Path:
    """An FMU, unpacked once for all runs."""
    folder = tempfile.TemporaryDirectory(prefix="motionfmu-")
    atexit.register(folder.cleanup)
    extract(str(fmus.fmu_path(name)), folder.name)
    return Path(folder.name)


class Run:
    """Steps library and card and keeps the books of every frame."""

    def __init__(self, case: Case, folder: Path) -> None:
        file = folder / "program.ngc"
        file.write_text(case.program)
        messages: list[str] = []
        self.slaves = {
            "mcc": Slave("mcc", unpacked("mcc"), 3, messages),
            "card": Slave("card", unpacked("epcio"), 3, messages),
        }
        self.wires = Wires(self.slaves)
        self.give("mcc", "program", [str(file)])
        self.give("mcc", "ppr", [10 * PULSES_PER_MM] * 6)
        active = [i < AXES for i in range(6)]
        self.give("mcc", "active", active)
        self.give("card", "active", active)
        for name, value in case.settings.items():
            count = fmus.ports("mcc")[name].count
            self.give("mcc", name, [value] * count)
        self.sent: list[list[int]] = []  # frames of the transaction on the wire
        self.taken: list[list[int]] = []  # every frame the card has taken, in order
        self.sums = [[0] * 6]  # where the first k frames lead to
        self.seq = 0
        self.refusals, self.short, self.refused = case.refusals, 0, 0
        self.panel = sorted(case.panel, key=lambda row: row[0])
        self.underflows = 0

    def give(self, component: str, name: str, values: list[Any]) -> None:
        port = fmus.ports({"mcc": "mcc", "card": "epcio"}[component])[name]
        self.slaves[component].assign(port.type, port.reference, values)

    def value(self, component: str, name: str) -> Any:
        buffer = self.wires.watch(component, name)
        return buffer[0] if len(buffer) == 1 else list(buffer)

    def watch_all(self) -> None:
        for name in ("stock", "pulse_count", "frames_taken", "frames_refused", "underflows"):
            self.wires.watch("card", name)
        for name in ("card_cmd_seq", "card_cmd_count", "card_cmd_frames"):
            self.wires.watch("mcc", name)
        self.wires.watch("card", "cmd_ack")
        for name in ("pos2encoder_dir", "dry_run"):
            self.wires.watch("mcc", name)
        for name in ("done", "error", "position", "compensation", "starved", "status"):
            self.wires.watch("mcc", name)

    def go(self, after: float = 0.2) -> None:
        """Run until the program is done and `after` seconds more."""
        self.watch_all()
        for slave in self.slaves.values():
            slave.initialize()
        for slave in self.slaves.values():
            slave.start()
        k, rest = 0, None
        while rest is None or rest > 0:
            assert k * STEP < LIMIT, "the program does not end"
            while self.panel and self.panel[0][0] <= k * STEP:
                _, name, value = self.panel.pop(0)
                self.give("mcc", name, [value])
            for get in self.wires.gets:
                get()
            self.refuse()
            self.book()
            for put in self.wires.sets:
                put()
            for slave in self.slaves.values():
                slave.step(k * STEP, STEP)
            over = self.value("mcc", "done") or self.value("mcc", "error")
            if rest is None and over and not self.panel:
                rest = round(after / STEP)
            rest = None if rest is None else rest - 1
            k += 1
        for get in self.wires.gets:
            get()
        self.book()

    def refuse(self) -> None:
        """Keep the last frames of a transaction from the card, which says it has refused them."""
        seq, count = (self.wires.buffers["mcc", f"card_cmd_{n}"] for n in ("seq", "count"))
        if seq[0] != self.seq:
            self.refused += self.short
            self.short = min(count[0], self.refusals[seq[0] % len(self.refusals)])
        count[0] -= self.short
        acknowledged = self.value("card", "cmd_ack") == seq[0]
        told = self.refused + (self.short if acknowledged else 0)
        self.wires.buffers["card", "frames_refused"][0] += told

    def book(self) -> None:
        """Check the books at a communication point."""
        frames = self.value("card", "frames_taken")
        new = frames - len(self.taken)
        assert 0 <= new <= len(self.sent), "a frame came from nowhere"
        for frame in self.sent[:new]:
            self.taken.append(frame)
            self.sums.append([a + b for a, b in zip(self.sums[-1], frame, strict=True)])
        self.sent = self.sent[new:]
        seq = self.value("mcc", "card_cmd_seq")
        if seq != self.seq:
            self.seq, count = seq, self.value("mcc", "card_cmd_count")
            flat = self.value("mcc", "card_cmd_frames")
            self.sent = [flat[6 * i : 6 * i + 6] for i in range(count)]
        stock, pulses = self.value("card", "stock"), self.value("card", "pulse_count")
        for axis in range(AXES):
            assert 0 <= stock[axis] <= 63
            begun = len(self.taken) - stock[axis]
            assert begun >= 0
            low, high = sorted((self.sums[max(0, begun - 1)][axis], self.sums[begun][axis]))
            assert low <= pulses[axis] <= high, f"axis {axis}: {pulses[axis]} not in {low}..{high}"
        self.underflows = sum(self.value("card", "underflows"))

    def close(self) -> None:
        for slave in self.slaves.values():
            slave.free()

    def balance(self) -> None:
        """All frames are out, and the library knows where that is."""
        pulses = np.array(self.value("card", "pulse_count"))
        frames = np.array(self.taken).reshape(-1, 6).sum(axis=0)
        assert np.array_equal(pulses, frames), "pulses out are not the commands in"
        position = np.array(self.value("mcc", "position"))
        commanded = np.round(position * PULSES_PER_MM) + self.value("mcc", "compensation")
        commanded *= np.where(self.value("mcc", "pos2encoder_dir"), -1, 1)
        commanded *= not self.value("mcc", "dry_run")
        assert np.array_equal(pulses[:AXES], commanded[:AXES])


def execute(case: Case, folder: Path, after: float = 0.2) -> Run:
    run = Run(case, folder)
    try:
        run.go(after)
        run.balance()
        return run
    finally:
        run.close()
