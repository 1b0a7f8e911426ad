"""Pulses out = commands in, per axis, to the pulse, whatever happens.

Library and card run as FMUs and are exchanged here, value by value, so that every frame is seen on
the wire. What is checked at every communication point:

- a transaction is taken once: frames taken and refused by the card are those of the new number;
- the FIFO stock is the frames taken less those begun, within 0 .. 63;
- the pulses put out lie on the sum of the frames begun, never beyond the one in the DDA;
- at the end every frame taken has been put out, and that is where the library says it is.
"""

import atexit
import tempfile
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import extract
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from motionfmu import fmus
from motionfmu.engines.slave import Slave
from motionfmu.errors import InputError

STEP = 1e-4  # [s] communication step and bus period
CLOCK = 25e-9  # [s]
AXES = 3
PULSES_PER_MM = 1000
LIMIT = 12.0  # [s] longest run
RUNS = settings(
    max_examples=30,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


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
        for name in ("done", "error", "position", "starved", "status"):
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
        assert np.array_equal(pulses[:AXES], np.round(position[:AXES] * PULSES_PER_MM))


def execute(case: Case, folder: Path, after: float = 0.2) -> Run:
    run = Run(case, folder)
    try:
        run.go(after)
        run.balance()
        return run
    finally:
        run.close()


place = st.integers(-3000, 3000).map(lambda i: i / 1000)


@st.composite
def blocks(draw: st.DrawFn) -> tuple[str, list[float]]:
    """A part program, and where it ends [mm]."""
    lines, at = ["G21 G17 G90 F6000"], [0.0, 0.0, 0.0]
    for _ in range(draw(st.integers(1, 6))):
        kind = draw(st.sampled_from(["G0", "G1", "G1", "arc", "helix", "circle", "G4", "mode"]))
        if kind == "mode":
            lines.append(draw(st.sampled_from(["G61", "G64"])))
        elif kind == "G4":
            lines.append(f"G4 P{draw(st.integers(0, 20)) / 1000}")
        elif kind in ("G0", "G1"):
            at = [draw(place), draw(place), draw(place)]
            lines.append(f"{kind} X{at[0]} Y{at[1]} Z{at[2]}")
        else:
            way = draw(st.sampled_from(["G2", "G3"]))
            radius = draw(st.integers(200, 3000)) / 1000
            if kind == "circle":
                lines.append(f"{way} X{at[0]:.3f} Y{at[1]:.3f} I{radius} J0")
            else:  # half a turn about a centre on the x axis
                end = [round(at[0] + 2 * radius, 3), at[1], at[2]]
                end[2] = round(at[2] + 0.5, 3) if kind == "helix" else at[2]
                lines.append(f"{way} X{end[0]} Y{end[1]} Z{end[2]} I{radius} J0")
                at = end
    return "\n".join([*lines, "M30"]) + "\n", at


fifo = st.fixed_dictionaries(
    {
        "min_stock": st.integers(0, 62),
        "batch": st.integers(1, 16),
        "dda_length": st.integers(11, 15),
        "dda_time": st.sampled_from([0.5e-3, 1e-3, 2e-3]),
        "irq_latency": st.sampled_from([0.0, 5e-5, 3e-4, 1.1e-3, 4.1e-3, 9e-3]),
        "irq_jitter": st.sampled_from([0.0, 1e-3, 5e-3]),
        "seed": st.integers(0, 1000),
        "queue_depth": st.sampled_from([4, 16, 64]),
        "ipo_period": st.sampled_from([1e-3, 5e-3]),
        "acc_time": st.sampled_from([5e-3, 0.05]),
        "dec_time": st.sampled_from([5e-3, 0.03]),
        "max_rpm": st.just(600.0),
    }
).map(lambda d: {**d, "min_stock": min(d["min_stock"], 63 - d["batch"])})


@RUNS
@given(program=blocks(), setting=fifo)
def test_every_program_ends_where_it_says(tmp_path, program, setting) -> None:
    text, end = program
    run = execute(Case(text, setting), tmp_path)
    assert run.value("mcc", "error") == 0
    pulses = run.value("card", "pulse_count")[:AXES]
    assert pulses == [round(x * PULSES_PER_MM) for x in end]


@RUNS
@given(
    program=blocks(),
    setting=fifo,
    panel=st.lists(
        st.tuples(
            st.integers(0, 3000).map(lambda i: i / 10000),
            st.sampled_from(["hold", "override"]),
            st.integers(0, 4),
        ),
        max_size=6,
    ),
)
def test_hold_and_override_lose_nothing(tmp_path, program, setting, panel) -> None:
    text, end = program
    acts = [(t, n, v % 2 == 1 if n == "hold" else 0.5 * v) for t, n, v in panel]
    acts += [(0.35, "hold", False), (0.35, "override", 1.0)]
    run = execute(Case(text, setting, acts), tmp_path)
    assert run.value("card", "pulse_count")[:AXES] == [round(x * PULSES_PER_MM) for x in end]


@RUNS
@given(program=blocks(), setting=fifo, at=st.integers(0, 4000).map(lambda i: i / 10000))
def test_an_abort_keeps_the_position_to_the_pulse(tmp_path, program, setting, at) -> None:
    run = execute(Case(program[0], setting, [(at, "abort", True)]), tmp_path)
    assert run.value("mcc", "status") == 1


@pytest.mark.parametrize(("minimum", "batch"), [(0, 1), (3, 4), (7, 8)])
@pytest.mark.parametrize("late", [-1, 1])
def test_the_deadline_is_exact_to_the_clock(tmp_path, minimum, batch, late) -> None:
    """(n + 1) T less one clock: no underflow; one clock more: underflow. Step 100 us."""
    time = 2**12 * 10 * CLOCK
    setting = {
        "min_stock": minimum,
        "batch": batch,
        "dda_time": time,
        "irq_latency": (minimum + 1) * time + late * CLOCK,
    }
    program = "G21 G90 G61 F3000\nG1 X20 Y10\nM30\n"
    run = execute(Case(program, setting), tmp_path)
    assert (run.underflows > 0) == (late > 0)
    assert run.value("card", "pulse_count")[:2] == [20000, 10000]


@RUNS
@given(
    program=blocks(),
    setting=fifo,
    refusals=st.lists(st.integers(0, 16), min_size=1, max_size=4),
)
def test_what_the_card_refuses_is_sent_again(tmp_path, program, setting, refusals) -> None:
    """Never more than two whole transactions in a row, which the library takes for a fault."""
    text, end = program
    run = execute(Case(text, setting, refusals=(*refusals[:2], 0, *refusals[2:], 0)), tmp_path)
    assert run.value("card", "pulse_count")[:AXES] == [round(x * PULSES_PER_MM) for x in end]


def test_an_axis_inactive_on_the_card_is_told(tmp_path) -> None:
    run = Run(Case("G21 G90 F3000\nG1 X5 Y3\nM30\n", {}), tmp_path)
    try:
        run.give("card", "active", [True, False, True, False, False, False])
        with pytest.raises(InputError, match="is every axis that is active here active on the"):
            run.go()
    finally:
        run.close()


def test_a_late_pc_only_delays(tmp_path) -> None:
    program = "G21 G90 G64 F3000\nG1 X2 Y1\nG3 X4 Y1 I1 J0\nG1 Z-1\nM30\n"
    ends = []
    for latency in (0.0, 2e-3, 20e-3):
        run = execute(Case(program, {"irq_latency": latency, "acc_time": 0.01}), tmp_path)
        ends.append((run.value("card", "pulse_count"), [f for f in run.taken if any(f)]))
    assert ends[0] == ends[1] == ends[2]


def test_the_books_would_notice(tmp_path) -> None:
    """A frame that the card never took, or took twice, does not pass."""
    case = Case("G21 G90 F3000\nG1 X2\nM30\n", {})
    run = Run(case, tmp_path)
    try:
        run.go()
        moved = next(i for i, f in enumerate(run.taken) if f[0])
        for wrong in (run.taken[:moved] + run.taken[moved + 1 :], [*run.taken, run.taken[moved]]):
            right, run.taken = run.taken, wrong
            with pytest.raises(AssertionError):
                run.balance()
            run.taken = right
        run.balance()
    finally:
        run.close()
