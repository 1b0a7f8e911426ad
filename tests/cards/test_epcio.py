"""The EPCIO card as an FMU: exact clocks over a sampled wire, whatever the steps."""

import math
import random
from collections.abc import Iterator
from typing import Any

import pytest
from fmi_tools import ERROR, OK, WARNING, Instance
from hypothesis import given, settings
from hypothesis import strategies as st

TICK = 25e-9
TL = 4000  # [clocks] the default loop_period, 100 us
DDA_PAGE, ENC6_PAGE, LIO_PAGE, PCL_PAGE, PAGES = 0, 3, 7, 8, 9  # pages of the interrupt latch
DDA = {"host_dda_length": 10, "host_dda_divider": 4}  # one DDA time is 4096 clocks
T = 4096


def card(fmi: int = 3, **values: Any) -> Instance:
    return Instance("epcio", fmi).initialize({**DDA, **values})


def to_clock(fmu: Instance, clock: int) -> None:
    """One step to `clock`; the time is counted, not added up."""
    now = round(fmu.time / TICK)
    fmu.time = now * TICK
    assert fmu.step((clock - now) * TICK) == OK, fmu.said
    fmu.time = clock * TICK


def page(number: int, bits: int) -> list[int]:
    """Bits on one page of the interrupt latch."""
    return [bits if i == number else 0 for i in range(PAGES)]


def frames(*rows: list[int]) -> dict[str, Any]:
    """The registers of a transaction of these frames."""
    full = [r + [0] * (6 - len(r)) for r in rows] + [[0] * 6] * (16 - len(rows))
    return {"host_cmd_count": len(rows), "host_cmd_frames": [x for r in full for x in r]}


def send(fmu: Instance, number: int, clock: int, *rows: list[int]) -> None:
    for name, value in {**frames(*rows), "host_cmd_seq": number, "host_cmd_clock": clock}.items():
        assert fmu.set(name, value) == OK, fmu.said


def register(*writes: tuple[int, float]) -> dict[str, Any]:
    """The register mailbox with these writes."""
    rest = [0] * (16 - len(writes))
    return {
        "reg_count": len(writes),
        "reg_address": [a for a, _ in writes] + rest,
        "reg_value": [float(v) for _, v in writes] + rest,
    }


def traffic(seed: int, instants: int) -> Iterator[dict[str, Any]]:
    """What a busy host and moving axes put on the wires at each instant."""
    rng = random.Random(seed)
    number = {"host_cmd_seq": 0, "host_ack_seq": 0, "host_clear_seq": 0}
    phase = [rng.uniform(-3000, 3000) for _ in range(9)]
    every = [0xFFFF] * PAGES
    levels: dict[str, Any] = {"host_irq_mask": every, **DDA}
    for k in range(instants):
        row = {}
        if rng.random() < 0.4:
            number["host_cmd_seq"] += 1
            rows = [[rng.randint(-1023, 1023) for _ in range(5)] for _ in range(rng.randint(0, 6))]
            clock = k * TL + rng.randint(-TL, 2 * TL)
            row |= frames(*rows) | {"host_cmd_clock": float(clock)}
        if rng.random() < 0.3:
            number["host_ack_seq"] += 1
            row["host_ack_flags"] = [rng.getrandbits(16) for _ in range(PAGES)]
        if rng.random() < 0.02:
            number["host_clear_seq"] += 1
        if rng.random() < 0.05:
            levels["host_dda_length"] = rng.randint(10, 11)
            levels["host_dda_divider"] = rng.randint(1, 5)
        levels["host_dda_run"] = rng.random() < 0.95
        levels["host_min_stock"] = rng.choice([3, 3, 3, 0, 7])
        levels["host_irq_mask"] = rng.choice([every, page(0, 0x3F), levels["host_irq_mask"]])
        levels["host_loop_on"] = [rng.random() < 0.95 for _ in range(6)]
        levels["host_dac_source"] = [1, 1, 0, rng.randint(0, 1), 1, 1]
        levels["host_dac_volts"] = [rng.uniform(-12, 12) for _ in range(6)]
        phase = [p + rng.uniform(-3, 3) * 10 ** rng.uniform(-3, 3) for p in phase]
        levels["io_volts"] = [rng.uniform(-10, 10) for _ in range(6)]
        levels["io_ldi"] = [rng.random() < 0.3 for _ in range(8)]
        levels["io_remote"] = [rng.getrandbits(16) for _ in range(24)]
        levels["io_remote_connected"] = [rng.random() < 0.9 for _ in range(6)]
        if rng.random() < 0.1:
            number["reg_seq"] = number.get("reg_seq", 0) + 1
            row |= register(rng.choice([(0x150, 300), (0x180, 0x6001), (0x540, 5001), (0x543, 1)]))
        row |= {"enc_phase": phase[:6], "enc_phase_aux": phase[6:], **number, **levels}
        yield row


def cuts(rng: random.Random, begin: int, end: int) -> list[int]:
    """Clocks at which to cut begin .. end, at random."""
    return [*sorted(rng.sample(range(begin + 1, end), rng.choice([0, 1, 2, 5]))), end]


@pytest.mark.parametrize("period", [1e-4, 2.5e-5, 3e-4])
@pytest.mark.parametrize("seed", range(3))
def test_any_split_into_steps_gives_the_same_bits(seed: int, period: float) -> None:
    """Inputs change every 100 us; the card looks as often, more often, less often."""
    rng = random.Random(seed)
    extra = {
        "index_lines": 100,
        "enc_rate": [4, 2, 1, 4, 0, 4, 4, 4, 4],
        "enc_wiring": [0, 4, 1, 0, 0, 0, 8, 2, 15],
        "enc_filter": [0, 0, 0, 20, 0, 0, 3, 0, 40],
        "compare_on": True,
        "compare": 500,
        "latch_source": 0x61FF,
        "latch_last": [True, False, True, False, True, False, True, False, True],
        "adc_run": True,
        "adc_compare_on": 255,
        "adc_tagged": 9,
        "timer_period": 7777,
        "watchdog_value": 1000,
        "rio_enabled": [5, 2],
        "rio_edge": 2,
        "ldi_edge": 2,
        "pulse_lines": True,
        "active": [True, True, True, True, True, False],
        "loop_period": period,
    }
    whole, split = card(**extra), card(**extra)
    values = {}
    for k, row in enumerate(traffic(seed, 150)):
        for fmu in (whole, split):
            for name, value in row.items():
                assert fmu.set(name, value) == OK, fmu.said
        to_clock(whole, (k + 1) * TL)
        for cut in cuts(rng, k * TL, (k + 1) * TL):
            to_clock(split, cut)
        values = whole.outputs()
        assert repr(values) == repr(split.outputs()), f"instant {k}"
    assert values["frames_taken"][0] > 30
    assert values["irq_seq"][0] > 20
    assert sum(values["underflows"]) > 5
    whole.free()
    split.free()


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("late", [-1, 0, 1])
def test_deadline_of_a_refill_to_the_clock(fmi: int, late: int) -> None:
    """n = 3, N = 4: in time one clock before (n + 1) T, too late at it and after."""
    fmu = card(fmi, host_irq_mask=page(DDA_PAGE, 1), host_min_stock=3)
    send(fmu, 1, 100, *[[100]] * 5)
    to_clock(fmu, 2 * T - 1)
    assert (fmu.get("stock")[0], fmu.get("irq_seq")) == (4, [0])
    to_clock(fmu, 2 * T)
    assert (fmu.get("stock")[0], fmu.get("irq_seq")) == (3, [1])
    assert fmu.get("irq_clock") == [2 * T]
    send(fmu, 2, 2 * T + 4 * T + late, *[[100]] * 4)
    to_clock(fmu, 6 * T + late - 1)
    assert fmu.get("cmd_ack") == [1]
    to_clock(fmu, 6 * T + late)
    assert fmu.get("cmd_ack") == [2]
    to_clock(fmu, 12 * T)
    assert fmu.get("underflows")[0] == (1 if late < 0 else 2)  # the last one is the end of all
    assert fmu.get("pulse_count")[0] == 900
    fmu.free()


def test_pulses_appear_at_their_clock() -> None:
    fmu = card()
    send(fmu, 1, 0, [7, -7])
    to_clock(fmu, T)
    for j in range(1, 8):  # pulse j is at tick ceil((j - 1/2) 1024 / 7)
        clock = T + 4 * math.ceil((j - 0.5) * 1024 / 7)
        to_clock(fmu, clock - 1)
        assert fmu.get("pulse_count")[:2] == [j - 1, 1 - j]
        to_clock(fmu, clock)
        assert fmu.get("pulse_count")[:2] == [j, -j]
    fmu.free()


def test_a_mailbox_is_emptied_once() -> None:
    fmu = card()
    send(fmu, 7, 0, [10], [20])
    for k in range(1, 40):
        to_clock(fmu, k * TL)
    assert fmu.get("frames_taken") == [2]
    assert fmu.get("pulse_count")[0] == 30
    assert fmu.get("cmd_ack") == [7]
    fmu.free()


def test_a_voltage_stands_one_period_after_its_cause() -> None:
    fmu = card(host_loop_on=True, host_dac_source=[1, 0, 0, 0, 0, 0], p_scale=0, host_p_gain=1)
    assert fmu.set("host_dac_volts", 5.0) == OK
    assert fmu.set("host_dac_volts_aux", [20.0, -20.0]) == OK
    to_clock(fmu, TL)  # the instant at 0 is computed ...
    assert fmu.get("dac")[:2] == [0.0, 5.0]  # ... and stands from here on
    assert fmu.get("dac_7") == [10.0 - 20 / 65536]
    assert fmu.get("dac_8") == [-10.0]
    assert fmu.set("enc_phase", -25.0) == OK
    to_clock(fmu, TL + 1)
    assert fmu.get("enc_count")[0] == -100
    assert fmu.get("err_count")[0] == 100
    to_clock(fmu, 2 * TL - 1)
    assert fmu.get("dac")[0] == 0.0
    to_clock(fmu, 2 * TL)
    assert fmu.get("dac")[0] == 100 * 20 / 65536
    fmu.free()


@pytest.mark.parametrize("fmi", [2, 3])
def test_dac_7_and_8_and_encoders_7_to_9_reach_a_plant_of_six_axes(fmi: int) -> None:
    fmu = card(fmi)
    assert fmu.set("host_dac_volts_aux", [2.5, -1.25]) == OK
    assert fmu.set("enc_phase_aux", [0.0, 1.0, 0.0]) == OK
    assert fmu.set("enc_phase_six_aux", [0.0, 0.0, 0.0, 7.0, 8.0, 9.0]) == OK
    to_clock(fmu, TL)
    assert fmu.get("dac_six_aux") == [2.5, -1.25, 0.0, 0.0, 0.0, 0.0]
    assert fmu.get("dac") == [0.0] * 6
    assert fmu.set("enc_phase_six_aux", [10.0, 20.0, -30.0, 70.0, 80.0, 90.0]) == OK
    to_clock(fmu, 2 * TL)
    counts = [fmu.get(f"enc_count_{n}")[0] for n in (7, 8, 9)]
    assert counts == [40, 80, -120]
    assert fmu.get("enc_count") == [0] * 6
    fmu.free()


@pytest.mark.parametrize("fmi", [2, 3])
def test_the_seventh_error_counter_interrupts_at_its_limit(fmi: int) -> None:
    """What the host commands less the counts of encoder 7, on a bit of its own."""
    bit = 1 << 6
    fmu = card(fmi, error_limit=100, host_irq_mask=page(PCL_PAGE, bit))
    assert fmu.set("host_command_aux", 5000) == OK
    assert fmu.set("host_loop_on_aux", True) == OK
    steps = (
        (5000, 0.0, 0),
        (5099, 0.0, 99),
        (5099, -0.25, 100),
        (5099, -9.0, 135),
        (4000, 0.0, -1000),
    )
    for k, (command, phase, error) in enumerate(steps, 1):
        fmu.set("host_command_aux", command)
        fmu.set("enc_phase_aux", [phase, 1000.0, -1000.0])
        to_clock(fmu, k * TL)
        assert fmu.get("err_count_7") == [error]
        over = abs(error) >= 100
        assert fmu.get("irq_flags")[PCL_PAGE] == (bit if over else 0)
        assert fmu.get("irq_seq") == [int(over)]
    assert fmu.get("irq_clock") == [2 * TL]  # the instant that saw the hundredth
    assert fmu.get("err_count") == [0] * 6
    fmu.set("host_loop_on_aux", False)
    to_clock(fmu, 6 * TL)
    assert fmu.get("err_count_7") == [0]
    fmu.free()


def test_index_interrupt_carries_its_interpolated_clock() -> None:
    fmu = card(host_irq_mask=page(ENC6_PAGE, 1 << 3), index_lines=10)
    to_clock(fmu, TL)
    fmu.set("enc_phase_aux", [40.0, 0.0, 0.0])  # four pulses; the first after a quarter of the way
    to_clock(fmu, 2 * TL)
    assert fmu.get("irq_flags") == [1 << 6, 0, 0, 1 << 3, 0, 0, 0, 0, 0]
    assert fmu.get("irq_seq") == [1]
    assert fmu.get("irq_clock") == [TL / 4]
    assert fmu.get("enc_count_7") == [160]
    fmu.free()


def test_an_acknowledge_keeps_what_fired_meanwhile() -> None:
    fmu = card(host_irq_mask=page(DDA_PAGE, 0x3F), host_min_stock=0)
    send(fmu, 1, 0, [5])
    to_clock(fmu, 2 * TL)
    assert fmu.get("irq_flags")[0] & 1  # fell to 0 at T
    send(fmu, 2, 2 * TL, [6])
    to_clock(fmu, 3 * TL)  # and again at 2 T, in this period
    assert fmu.get("irq_seq") == [1]
    fmu.set("host_ack_flags", page(DDA_PAGE, 0x3F))
    fmu.set("host_ack_seq", 1)
    to_clock(fmu, 4 * TL)
    assert fmu.get("irq_seq") == [2]
    assert fmu.get("irq_clock") == [3 * TL]
    fmu.set("host_ack_seq", 2)
    to_clock(fmu, 5 * TL)
    assert fmu.get("irq") == [False]
    assert fmu.get("irq_seq") == [2]
    fmu.free()


def test_a_dda_length_that_waits_is_taken_when_the_commands_are_out() -> None:
    """Nothing on the wires has changed by then."""
    fmu = card(host_dda_length=11)
    assert fmu.call("SetDebugLogging", True, 0, None) == OK
    send(fmu, 1, 0, [2000], [2000], [2000])
    to_clock(fmu, TL)
    assert fmu.set("host_dda_length", 10) == OK
    to_clock(fmu, 2 * TL)
    assert fmu.messages[-1][0] == WARNING and "host_dda_length = 10 waits" in fmu.said
    to_clock(fmu, 3 * TL)
    assert fmu.get("dda_time") == [2 * T * TICK]
    to_clock(fmu, 12 * TL)
    assert fmu.get("dda_time") == [T * TICK]
    assert fmu.get("pulse_count")[0] == 6000
    fmu.free()


def test_refused_frames_are_counted_and_explained() -> None:
    fmu = card(active=[True, True, False, False, False, False])
    assert fmu.call("SetDebugLogging", True, 0, None) == OK
    send(fmu, 1, 0, [1], [1024], [1])
    to_clock(fmu, TL)
    assert (fmu.get("frames_taken"), fmu.get("frames_refused")) == ([1], [2])
    assert fmu.messages[-1][0] == WARNING
    assert "axis 1, command 1024: the command is larger than the DDA length allows" in fmu.said
    send(fmu, 2, TL, [0, 0, 4])
    to_clock(fmu, 2 * TL)
    assert "axis 3, command 4: the axis is not active" in fmu.said
    fmu.set("host_dda_run", False)
    for k in range(3, 9):
        send(fmu, k, 0, *[[k]] * 16)
        to_clock(fmu, k * TL)
    assert fmu.get("stock") == [63, 63, 0, 0, 0, 0]
    assert "the FIFO holds 63 commands already" in fmu.said
    fmu.set("host_clear_seq", 1)
    to_clock(fmu, 9 * TL)
    assert fmu.get("stock") == [0] * 6
    fmu.free()


@settings(max_examples=25)
@given(
    length=st.integers(10, 12),
    divider=st.integers(1, 20),
    minimum=st.integers(0, 62),
    batches=st.lists(st.tuples(st.integers(0, 16), st.integers(-9000, 20000)), max_size=30),
    seed=st.integers(0, 2**31),
)
def test_pulses_out_are_commands_taken(
    length: int, divider: int, minimum: int, batches: list[tuple[int, int]], seed: int
) -> None:
    """Whatever the FIFO setting and however late or early the host writes."""
    rng = random.Random(seed)
    top = 2**length - 1
    fmu = card(host_dda_length=length, host_dda_divider=divider, host_min_stock=minimum)
    want = [0] * 6
    clock, sent = 0, 0
    for number, (count, delay) in enumerate(batches, 1):
        rows = [[rng.randint(-top, top) for _ in range(6)] for _ in range(count)]
        before = fmu.get("frames_taken")[0]
        send(fmu, number, clock + delay, *rows)
        clock += TL * (1 + max(0, delay) // TL + rng.randint(0, 8))
        to_clock(fmu, clock)
        assert fmu.get("cmd_ack") == [number]
        sent += count
        taken = fmu.get("frames_taken")[0]
        assert taken + fmu.get("frames_refused")[0] == sent
        for row in rows[: taken - before]:
            want = [a + b for a, b in zip(want, row, strict=True)]
    to_clock(fmu, clock + 66 * 2**length * divider)
    assert fmu.get("stock") == [0] * 6
    assert fmu.get("pulse_count") == want
    fmu.free()


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("loop_period", 1.0001e-4 + 3e-9, "loop_period = 0.000100013"),
        ("loop_period", 2.6e-8, "not a whole number of 25 ns clocks"),
        ("enc_rate", [4, 3, *[4] * 7], "enc_rate[2] = 3: an encoder multiplies by 0, 1, 2 or 4"),
        ("adc_bits", 13, "adc_bits = 13: the ADC has 12, 14 or 16 bit"),
    ],
)
def test_wrong_parameters_are_named(name: str, value: Any, message: str) -> None:
    fmu = Instance("epcio", 3)
    assert fmu.set(name, value) == OK
    fmu.enter()
    assert fmu.call("ExitInitializationMode") == ERROR
    assert any(message in text for _, _, text in fmu.messages), fmu.messages
    fmu.free()


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"enc_phase": [0, 0, 1e300, 0, 0, 0]}, "enc_phase[3] = 1e+300: the phase is"),
        ({"enc_phase_aux": [0, -1e17, 0]}, "enc_phase_aux[2] = -1e+17: the phase is"),
        (
            {"enc_phase_six_aux": [0, 0, 1e17, 0, 0, 0]},
            "enc_phase_six_aux[3] = 1e+17: the phase is",
        ),
        ({"host_cmd_seq": 1, "host_cmd_clock": 1e17}, "host_cmd_clock = 1e+17: not a clock"),
    ],
)
def test_wrong_inputs_are_named(values: dict[str, Any], message: str) -> None:
    fmu = card()
    to_clock(fmu, TL)
    for name, value in values.items():
        assert fmu.set(name, value) == OK
    assert fmu.step(TL * TICK) == ERROR
    assert any(message in text for _, _, text in fmu.messages), fmu.messages
    fmu.free()


def test_a_full_bus_is_an_error() -> None:
    fmu = card()
    for number in range(1, 9):
        send(fmu, number, 10**9, [1])
        to_clock(fmu, number * TL)
    send(fmu, 9, 10**9, [1])
    assert fmu.step(TL * TICK) == ERROR
    assert any("host_cmd_seq = 9: eight transactions" in m[2] for m in fmu.messages)
    fmu.free()
