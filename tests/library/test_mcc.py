"""The mcc FMU alone and with the card: bad programs, planned geometry, pulses end to end."""

import csv
import math
import mmap
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from few_cases import few
from fmi_tools import ERROR, OK, WARNING, Instance

HOST = """dda_length dda_divider dda_run min_stock irq_mask ack_seq ack_flags p_gain loop_on
dac_source dac_volts cmd_seq cmd_clock cmd_count cmd_frames index_low latch_seq clear_seq""".split()
CARD = """irq_seq irq_clock irq_flags cmd_ack frames_refused stock pulse_count enc_count
err_count latch_value latch_seen home over_travel stopped enc_count_7 enc_count_8
enc_count_9""".split()
QUARTER = "G21 G17 G90 G61\nG1 X5 F3000\nG3 X0 Y5 I-5\nG4 P0.02\nG2 X5 Y0 R5 Z1\nM2\n"
OFF_CIRCLE = "arc end does not lie on the circle through its start"
FAST = {"acc_time": 0.01, "dec_time": 0.01}


def start(fmi: int, text: str | bytes, folder: Path, **values: Any) -> tuple[int, Instance]:
    """Status of the initialization with a program, and the instance."""
    program = folder / "part.ngc"
    program.write_bytes(text if isinstance(text, bytes) else text.encode())
    instance = Instance("mcc", fmi)
    instance.call("SetDebugLogging", True, 0, None)
    for name, value in {"program": str(program), **values}.items():
        assert instance.set(name, value) == OK, instance.said
    return instance.enter() or instance.call("ExitInitializationMode"), instance


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("G1 X1\n\nY2 Q3\n", 'line 3: word has no use in this line "Q3", column 4'),
        ("G1 X1 A1", "line 1: this machine has no rotary axes (--angles: A B C in place"),
        ("G2 X10 R4 (tight)", 'half the distance to the end "G2 X10 R4 (tight)" (4 mm, half'),
        ("G2 X10 I6", '"G2 X10 I6" (by 2 mm)'),
        ("S9 M3 F60001\nG84 X1 Z-1 R0", '"G84 X1 Z-1 R0" (60001, limit 60000)'),
        (
            "S9 M3 F40000\nG84 X1 Z-1 R0",
            'above max_rpm [rpm] "G84 X1 Z-1 R0" (4000, limit 3000; F30000 mm/min is possible)',
        ),
        ("G1 X1\n\x00", "line 2: byte 0, which no text has, behind"),
        (b"G1 X1 \xff\xfe", "line 1: unexpected character"),
        ("G1 W1", 'axis is not active "W1"'),
        ("G1 X1\nG1 X2 G2\n", 'line 2: second word of one modal group "G2" beside "G1"'),
        ("M3 S9\n\nM8 M9", 'line 3: second word of one modal group "M9" beside "M8"'),
        ("\nG92 X1 G0", 'line 2: two codes take the same words "G0" beside "G92"'),
        ("M64 P1 G4", 'line 1: two codes take the same words "M64" beside "G4"'),
        ("M0 M3 M8 M64 P1 M30", 'line 1: more than four M words in the line "M30"'),
        ("G1 X1\nG10 L2 X1", 'line 2: G10 needs L2 or L20 and P0 to P9 "G10 L2 X1"'),
        ("G10 L2 P10 X1", 'line 1: value out of range "P10"'),
        ("G1 X1 M62", 'line 1: output without P0 to P31 "M62"'),
        ("M65 P32", 'line 1: value out of range "P32"'),
        ("S-5", 'line 1: value out of range "S-5"'),
        ("\nG52", 'line 2: no axis word "G52"'),
        ("G1 X1 L2", 'line 1: word has no use in this line "L2"'),
        ("M6", 'line 1: no T since the tool change before "M6"'),
        ("G1 X1\n" + 257 * "(", 'line 2: line longer than 256 characters "((((' + 252 * "(" + '"'),
        ("", "part.ngc is empty"),
    ],
)
@pytest.mark.parametrize("fmi", [2, 3])
def test_bad_program_is_refused_before_anything_moves(
    fmi: int, text: str | bytes, said: str, tmp_path: Path
) -> None:
    planned = tmp_path / "planned.csv"
    status, instance = start(fmi, text, tmp_path, path_file=str(planned))
    assert status == ERROR
    assert said in instance.said and str(tmp_path / "part.ngc") in instance.said
    instance.free()
    assert [f.name for f in tmp_path.iterdir()] == ["part.ngc"]


@pytest.mark.parametrize("fmi", [2, 3])
def test_all_faults_of_a_program_are_told(fmi: int, tmp_path: Path) -> None:
    text = "G1 X5 Q3 F600\n(PRINT, x)\nG91 Y1 $\nM19\nG2 X9 I6\nM19\nX1 Y1 X1\n"
    status, instance = start(fmi, text, tmp_path)
    part = tmp_path / "part.ngc"
    told = [(s, words) for s, _, words in instance.messages if "part.ngc" in words]
    assert status == ERROR
    assert [(s, words[words.index(f"{part}: ") :]) for s, words in told] == [
        (WARNING, f'{part}: line 2: note: a comment that does nothing here "(PRINT, x)", column 1'),
        (WARNING, f'{part}: line 4: note: the spindle stops, it has no angle "M19", column 1'),
        (ERROR, f'{part}: line 1: word has no use in this line "Q3", column 7'),
        (ERROR, f'{part}: line 3: unexpected character "$", column 8'),
        (ERROR, f'{part}: line 5: {OFF_CIRCLE} "G2 X9 I6" (by 3 mm), column 1'),
        (ERROR, f'{part}: line 7: word given twice "X1", column 7'),
    ]
    instance.free()
    status, instance = start(fmi, "G1 X1 Q1\n" * 30, tmp_path)
    told = [(s, words) for s, _, words in instance.messages if s == ERROR]
    assert status == ERROR and len(told) == 21 and told[-1][1].endswith("part.ngc: ... and more")
    instance.free()
    status, instance = start(fmi, "M19\nG1 X1 F60\nM19\n", tmp_path)
    told = [(s, words) for s, _, words in instance.messages if "part.ngc" in words]
    assert status == OK and len(told) == 1 and "line 1: note: the spindle stops" in told[0][1]
    instance.free()


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"min_stock": 62, "batch": 16}, "min_stock 62 + batch 16: the FIFO of the card holds 63"),
        ({"feed": 700.0, "max_feed": 600.0}, "feed 700 mm/min is above max_feed 600 mm/min"),
        ({"bus_period": 1.1e-7}, "bus_period = "),
        ({"start_delay": 1e12}, "start_delay = 1e+12 s is too long"),
        ({"module_offset": [0.0, 0.0, 1e-3, 0.0]}, "module_offset[3] = 0.001 s: interrupts wake"),
        ({"program": "no/such.ngc"}, "program: cannot read no/such.ngc: No such file"),
        ({"program": "."}, "program: cannot read .: Is a directory"),
        ({"home_order": [0, 0, 0, 1, 0, 0]}, "home_order[4] = 1: the axis is not active"),
        ({"home_order": [1] + 5 * [0], "home_high_speed": 501.0}, "home_high_speed[1] = 501 mm/s"),
        ({"home_first": True}, "home_first: home_order names no axis"),
        ({"path_file": "no/such/planned.csv"}, "path_file: cannot write no/such/planned.csv: No"),
    ],
)
def test_bad_parameter_is_named(values: dict[str, Any], said: str, tmp_path: Path) -> None:
    status, instance = start(3, "G1 X1", tmp_path, **values)
    assert status == ERROR and said in instance.said
    instance.free()


class Machine:
    """Library and card, wired, one communication step at a time (Jacobi)."""

    def __init__(self, fmi: int, values: dict[str, Any]) -> None:
        self.mcc = Instance("mcc", fmi).initialize(values)
        self.card = Instance("epcio", fmi).initialize({})
        self.wires = [(self.mcc, f"card_{n}", self.card, f"host_{n}") for n in HOST]
        self.wires += [(self.card, n, self.mcc, f"card_{n}") for n in CARD]
        self.seq = -1

    def step(self, size: float) -> None:
        """Move every wire, then step both."""
        values = []
        seq = self.mcc.get("card_cmd_seq")[0]
        for source, name, sink, target in self.wires:
            if name != "card_cmd_frames" or seq != self.seq:
                values.append((sink, target, source.get(name)))
        self.seq = seq
        for sink, target, value in values:
            assert sink.set(target, value) == OK, sink.said
        assert self.mcc.step(size) == OK, self.mcc.said
        assert self.card.step(size) == OK, self.card.said

    def seen(self) -> list[Any]:
        """Outputs of both, without the mailbox."""
        names = ("status", "done", "line", "command", "path_feed", "position", "queue", "starved")
        card = ("pulse_count", "stock", "irq_seq", "irq_clock", "underflows", "cmd_ack")
        return [self.mcc.get(n) for n in names] + [self.card.get(n) for n in card]

    def irqs(self) -> int:
        """Interrupts so far."""
        return int(self.card.get("irq_seq")[0])

    def end(self) -> None:
        """Terminate and free both."""
        for instance in (self.mcc, self.card):
            assert instance.call("Terminate") == OK, instance.said
            instance.free()


def program(folder: Path, text: str) -> str:
    """Name of a file with the text."""
    (folder / "part.ngc").write_text(text)
    return str(folder / "part.ngc")


@pytest.mark.parametrize("fmi", few([3, 2], 1))
def test_jog_and_hand_wheel_from_the_panel(fmi: int) -> None:
    machine = Machine(fmi, {**FAST, "output_mode": 0, "queue_depth": 8})

    def pass_time(steps: int) -> tuple[list[int], int]:
        for _ in range(steps):
            machine.step(1e-4)
        return machine.card.get("pulse_count")[:3], machine.mcc.get("status")[0]

    machine.mcc.set("jog", [1, -1, 0, 0, 0, 0])
    (x, y, z), status = pass_time(3000)
    assert (status, z) == (0, 0) and 12000 < x == -y < 15000  # 50 mm/s for less than 0.3 s
    machine.mcc.set("jog", 0)
    still, status = pass_time(1000)
    assert status == 1 and machine.mcc.get("done")[0]
    assert pass_time(500)[0] == still

    machine.mcc.set("mpg_ratio", -2.5)
    machine.mcc.set("mpg_axis", 3)
    assert pass_time(100)[1] == 5 and not machine.mcc.get("done")[0]
    for k in range(300):  # 7.77 turns of a wheel with 100 lines
        machine.card.set("enc_phase_aux", [777.0 * k / 299, 0.0, 0.0])
        machine.step(1e-4)
    (x, y, z), status = pass_time(1500)
    assert machine.card.get("enc_count_7")[0] == 3108
    assert ([x, y], z, status) == (still[:2], -7770, 5)
    machine.mcc.set("mpg_axis", 0)
    assert pass_time(100) == ([x, y, z], 1)
    machine.end()


@pytest.mark.parametrize("fmi", [2, 3])
def test_arcs_end_to_end(fmi: int, tmp_path: Path) -> None:
    planned = tmp_path / "planned.csv"
    values = {"program": program(tmp_path, QUARTER), "path_file": str(planned), **FAST}
    machine = Machine(fmi, {**values, "output_mode": 0})
    pulses, statuses, raised = [], set(), []
    for _ in range(8000):
        machine.step(1e-4)
        pulses.append(machine.card.get("pulse_count")[:3])
        statuses.add(machine.mcc.get("status")[0])
        raised.append(machine.card.get("irq_clock")[0])
        if machine.mcc.get("done")[0] and machine.card.get("pulse_count")[:3] == [5000, 0, 1000]:
            break
    x, y, _ = (np.array(pulses) / 1000.0).T
    assert machine.mcc.get("done")[0] and pulses[-1] == [5000, 0, 1000]
    assert machine.mcc.get("position")[:3] == [5.0, 0.0, 1.0]
    assert machine.card.get("underflows") == [0] * 6
    assert {0, 3} <= statuses
    # An interrupt each N = 4 DDA times of 40960 clocks, first when 7 frames have become 3.
    assert np.unique(raised).tolist() == [163840.0 * k for k in range(machine.irqs() + 1)]
    on_arc = y > 0.01
    # Straight between points 0.05 mm apart, pulses spread evenly: chord error and a pulse.
    radius = np.hypot(x[on_arc], y[on_arc])
    assert np.abs(radius - 5.0).max() < 0.0512**2 / (8 * 5.0) + 1.5e-3
    machine.end()

    rows = list(csv.DictReader(planned.open()))
    assert [r["type"] for r in rows] == ["1", "3", "6", "4"]
    assert [r["line"] for r in rows] == ["2", "3", "4", "5"]
    assert float(rows[1]["sweep"]) == pytest.approx(math.pi / 2, abs=1e-15)
    assert float(rows[3]["sweep"]) == pytest.approx(-math.pi / 2, abs=1e-12)
    assert float(rows[3]["length"]) == pytest.approx(math.hypot(2.5 * math.pi, 1.0), abs=1e-12)
    assert [float(rows[1][f"normal_{a}"]) for a in "xyz"] == [0.0, 0.0, 1.0]
    assert float(rows[1]["feed"]) == 50.0
    assert sorted(f.name for f in tmp_path.iterdir()) == ["part.ngc", "planned.csv"]


@pytest.mark.parametrize("bus", [1e-4, 2e-4])
def test_deadline_is_exact_to_the_clock_on_a_coarse_wire(bus: float, tmp_path: Path) -> None:
    # The FIFO has n = 3 commands and one is being put out: (n + 1) T = 4.096 ms to refill it.
    gaps = []
    for late in (-25e-9, 25e-9):
        values = {"program": program(tmp_path, "G1 X10 F3000"), "start_delay": 0.02, **FAST}
        values |= {"bus_period": bus, "irq_latency": 4.096e-3 + late, "output_mode": 0}
        machine = Machine(3, values)
        for _ in range(round(0.3 / bus)):
            machine.step(bus)
        assert machine.card.get("pulse_count")[0] == round(machine.mcc.get("position")[0] * 1e3)
        assert machine.mcc.get("latency")[0] == pytest.approx(4.096e-3 + late, abs=1e-12)
        gaps.append(machine.card.get("underflows")[0])
        machine.end()
    assert gaps[0] == 0 and gaps[1] > 20


def test_dividing_the_step_changes_no_bit(tmp_path: Path) -> None:
    runs = []
    values = {"program": program(tmp_path, QUARTER), "irq_latency": 3.3e-4, "irq_jitter": 1e-3}
    for split in (1, 2, 5):
        machine = Machine(3, {**values, **FAST, "output_mode": 0})
        seen = []
        for k in range(600):
            assert machine.mcc.set("hold", 300 <= k < 400) == OK
            assert machine.mcc.set("override", 1.0 if k < 100 else 0.7) == OK
            for _ in range(split):
                machine.step(1e-4 / split)
            seen.append(repr(machine.seen()))
        runs.append(seen)
        assert machine.card.get("pulse_count")[0] > 1000
        machine.end()
    assert runs[0] == runs[1] == runs[2]


def test_abort_keeps_what_the_card_was_given(tmp_path: Path) -> None:
    machine = Machine(3, {"program": program(tmp_path, QUARTER), **FAST, "output_mode": 0})
    for k in range(1600):
        assert machine.mcc.set("abort", k > 500) == OK
        machine.step(1e-4)
    assert machine.mcc.get("done")[0] and machine.mcc.get("status") == [1]
    position = np.array(machine.mcc.get("position")[:3])
    pulses = np.array(machine.card.get("pulse_count")[:3])
    assert 0.0 < position[0] < 5.0
    assert np.abs(position * 1000.0 - pulses).max() <= 0.5 + 1e-9
    machine.end()


def test_too_many_pulses_stop_the_motion(tmp_path: Path) -> None:
    text = "G1 X100 F30000\n"
    machine = Machine(3, {"program": program(tmp_path, text), **FAST, "ppr": 100000})
    largest = 0
    for _ in range(800):
        machine.step(1e-4)
        largest = max(largest, *machine.mcc.get("card_cmd_frames"))
    assert machine.mcc.get("error") == [0xF203]
    assert 3500 < largest <= 4095  # 5120 pulses per DDA time were asked for
    assert not machine.mcc.get("done")[0] and machine.mcc.get("status") == [1]
    assert machine.card.get("pulse_count")[0] == round(machine.mcc.get("position")[0] * 1e4)
    machine.end()


def test_a_restored_state_goes_on_the_same_way(tmp_path: Path) -> None:
    values = {"program": program(tmp_path, QUARTER), **FAST}
    machine = Machine(3, values)
    for _ in range(100):
        machine.step(1e-4)
    state, time = machine.mcc.save(), machine.mcc.time
    first = [repr(machine.mcc.outputs()) for _ in range(300) if machine.mcc.step(1e-4) == OK]
    assert machine.mcc.restore(state, time) == OK
    second = [repr(machine.mcc.outputs()) for _ in range(300) if machine.mcc.step(1e-4) == OK]
    assert first == second and len(first) == 300
    assert machine.mcc.free_state(state) == OK
    machine.end()


CLEAR = Path("/proc/self/clear_refs")  # a 5 sets the peak back to what is in use


@contextmanager
def peak() -> Iterator[list[float]]:
    """Growth of the peak of resident memory while it is open, in one element [MiB]."""

    def status(name: str) -> float:
        rows = Path("/proc/self/status").read_text().splitlines()
        return next(float(r.split()[1]) for r in rows if r.startswith(name)) / 1024

    CLEAR.write_text("5")
    before, grown = status("VmRSS"), [math.nan]
    yield grown
    grown[0] = status("VmHWM") - before


@pytest.mark.skipif(not CLEAR.exists(), reason="needs Linux to tell the peak of memory")
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_million_lines_need_no_memory(fmi: int, tmp_path: Path) -> None:
    few = "".join(f"G1 X0.{n % 1000:03} Y0.{n * 7 % 1000:03} F3000\n" for n in range(10_000))
    long = tmp_path / "long.ngc"
    with long.open("w") as file:
        for _ in range(100):
            file.write(few)
    assert long.stat().st_size > 20_000_000
    values: dict[str, Any] = {**FAST, "output_mode": 0}
    warm = Machine(fmi, {**values, "program": program(tmp_path, few)})
    warm.step(1e-3)
    warm.end()
    with peak() as grown:
        machine = Machine(fmi, {**values, "program": str(long)})
        for _ in range(300):
            machine.step(1e-3)
    assert machine.mcc.get("status") == [0] and machine.mcc.get("line")[0] > 5
    assert machine.card.get("pulse_count")[1] > 0
    machine.end()
    assert grown[0] < 5.0

    with long.open("a") as file:
        file.write("G1 X1 Q3\n")
    with peak() as grown:
        instance = Instance("mcc", fmi)
        assert instance.set("program", str(long)) == OK
        assert ERROR in (instance.enter(), instance.call("ExitInitializationMode"))
    assert 'line 1000001: word has no use in this line "Q3"' in instance.said
    assert grown[0] < 5.0
    instance.free()

    with peak() as grown, mmap.mmap(-1, long.stat().st_size) as fresh:
        for page in range(0, len(fresh), mmap.PAGESIZE):
            fresh[page] = 1
    assert grown[0] > 19.0  # what it would be with the text in memory
