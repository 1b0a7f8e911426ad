"""Library and card as FMUs, connected value by value, so that every frame can be checked."""

import atexit
import tempfile
from ctypes import sizeof
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import extract

from motionfmu.run.engines.slave import Slave
from motionfmu.scenarios import fmus

STEP = 1e-4  # [s] communication step and bus period
CLOCK = 25e-9  # [s]
AXES = 3
PULSES_PER_MM = 1000
LIMIT = 12.0  # [s] longest run
WATCHED = {
    "mcc": [
        *("card_cmd_seq", "card_cmd_count", "card_cmd_frames", "pos2encoder_dir", "dry_run"),
        *("done", "error", "position", "compensation", "starved", "status", "line"),
    ],
    "card": ["stock", "pulse_count", "frames_taken", "frames_refused", "underflows", "cmd_ack"],
}


class Wires:
    """Outputs of one FMU to the inputs of another that bear the same name after a prefix.

    One call gets all outputs of a type, and one sets the inputs that some of them are wired to.
    """

    def __init__(self, slaves: dict[str, Slave], watched: dict[str, list[str]]) -> None:
        mcc, card = fmus.ports("mcc"), fmus.ports("epcio")
        ports = {"mcc": mcc, "card": card}
        pairs = {("mcc", "card_" + n[5:]): n for n in card if n.startswith("host_")}
        pairs = {source: n for source, n in pairs.items() if source[1] in mcc}
        pairs |= {
            ("card", n[5:]): n
            for n, p in mcc.items()
            if n.startswith("card_") and p.causality == "input"
        }
        outputs = {*pairs, *((c, n) for c, names in watched.items() for n in names)}
        self.buffers: dict[tuple[str, str], Any] = {}
        self.gets, self.sets = [], []
        for component, other in (("mcc", "card"), ("card", "mcc")):
            mine = sorted(o for o in outputs if o[0] == component)
            for kind in sorted({ports[component][n].type for _, n in mine}):
                some = [o for o in mine if ports[component][o[1]].type == kind]
                some.sort(key=lambda o: o not in pairs)  # wired ones first
                sources = [ports[component][n] for _, n in some]
                targets = [ports[other][pairs[o]] for o in some if o in pairs]
                whole = slaves[component].buffer(kind, sum(p.count for p in sources))
                place = 0
                for output, port in zip(some, sources, strict=True):
                    part = type(slaves[component].buffer(kind, port.count))
                    self.buffers[output] = part.from_buffer(whole, place)
                    place += sizeof(part)
                references = [p.reference for p in sources]
                get = slaves[component].access("Get", kind, references[0], whole, *references[1:])
                self.gets.append(get)
                if targets:
                    wired = slaves[other].buffer(kind, sum(p.count for p in targets))
                    wired = type(wired).from_buffer(whole)
                    references = [p.reference for p in targets]
                    put = slaves[other].access("Set", kind, references[0], wired, *references[1:])
                    self.sets.append(put)


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
    """Steps library and card and checks the balance of all frames at each step."""

    def __init__(self, case: Case, folder: Path) -> None:
        file = folder / "program.ngc"
        file.write_text(case.program)
        messages: list[str] = []
        self.slaves = {
            "mcc": Slave("mcc", unpacked("mcc"), 3, messages),
            "card": Slave("card", unpacked("epcio"), 3, messages),
        }
        self.wires = Wires(self.slaves, WATCHED)
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
        buffer = self.wires.buffers[component, name]
        return buffer[0] if len(buffer) == 1 else list(buffer)

    def go(self, after: float = 0.2) -> None:
        """Run until the program is done and `after` seconds more."""
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
        """Check sent and taken frames at a communication point."""
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
        """Check that all frames have been put out and the library's position is their sum."""
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
