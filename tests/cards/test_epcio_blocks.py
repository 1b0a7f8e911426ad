"""The card's further blocks as an FMU: pulse lines, latches, analog, I/O, timer, registers."""

from typing import Any

import pytest
from fmi_tools import ERROR, OK, WARNING, Instance

TICK = 25e-9
TL = 4000  # [clocks] loop period, 100 us
LSB = 20.0 / 65536.0  # [V]
ENC0, RIO0, ADC, LIO = 1, 4, 6, 7  # pages of the interrupt latch


def card(fmi: int = 3, **values: Any) -> Instance:
    return Instance("epcio", fmi).initialize(values)


def to_clock(fmu: Instance, clock: int) -> None:
    now = round(fmu.time / TICK)
    fmu.time = now * TICK
    assert fmu.step((clock - now) * TICK) == OK, fmu.said
    fmu.time = clock * TICK


def first(value: Any, count: int = 6, rest: Any = 0) -> list[Any]:
    """An array with this first element."""
    return [value, *[rest] * (count - 1)]


def page(number: int, bits: int) -> list[int]:
    return [bits if i == number else 0 for i in range(9)]


def write(fmu: Instance, *writes: tuple[int, float]) -> None:
    """Send a register transaction."""
    number = fmu.get("reg_ack")[0] + 1
    rest = [0] * (16 - len(writes))
    assert fmu.set("reg_address", [a for a, _ in writes] + rest) == OK
    assert fmu.set("reg_value", [float(v) for _, v in writes] + rest) == OK
    assert fmu.set("reg_count", len(writes)) == OK
    assert fmu.set("reg_seq", number) == OK


@pytest.mark.parametrize("form", [0, 1, 2])
def test_pulse_lines_carry_the_pulses(form: int) -> None:
    """A receiver at 40 MHz / 16 gets every pulse back from the two lines."""
    fmu = card(
        pulse_format=form,
        pulse_lines=True,
        pulse_width=64,
        host_dda_length=10,
        host_dda_divider=16,
    )
    frames = [[100, -60, *[0] * 4], [-30, 40, *[0] * 4]]
    fmu.set("host_cmd_frames", [x for f in frames for x in f] + [0] * 84)
    fmu.set("host_cmd_count", 2)
    fmu.set("host_cmd_seq", 1)
    count, last = [0, 0], [fmu.get("pulse_a")[:2], fmu.get("pulse_b")[:2]]
    order = {(1, 0): 0, (1, 1): 1, (0, 1): 2, (0, 0): 3}
    started = False
    for clock in range(TL, 4 * 16384, 16):
        to_clock(fmu, clock)
        a, b = fmu.get("pulse_a")[:2], fmu.get("pulse_b")[:2]
        for i in range(2 if started else 0):
            if form == 0:
                count[i] += (a[i] and not last[0][i]) * (-1 if b[i] else 1)
            elif form == 1:
                count[i] += (a[i] and not last[0][i]) - (b[i] and not last[1][i])
            else:
                step = (order[a[i], b[i]] - order[last[0][i], last[1][i]]) % 4
                count[i] += {0: 0, 1: 1, 3: -1}[step]
        started, last = True, [a, b]
        assert count == fmu.get("pulse_count")[:2], clock
    assert count == [70, -20]
    fmu.free()


def test_a_latch_keeps_the_counter_at_the_index_of_another_encoder() -> None:
    """Encoder 2 meets its index a quarter of the way; counter 1 is at a quarter of its way then."""
    fmu = card(index_lines=[2500, 100, *[2500] * 7], latch_source=first(2, 9))
    to_clock(fmu, TL)
    fmu.set("enc_phase", [80.0, 400.0, 0.0, 0.0, 0.0, 0.0])
    to_clock(fmu, 2 * TL)
    assert fmu.get("enc_count")[0] == 320
    assert (fmu.get("latch_value")[0], fmu.get("latch_seen")[0]) == (80, 1)
    fmu.set("enc_phase", [160.0, 800.0, 0.0, 0.0, 0.0, 0.0])
    to_clock(fmu, 3 * TL)  # the first trigger only, until it is armed again
    assert (fmu.get("latch_value")[0], fmu.get("latch_seen")[0]) == (80, 1)
    write(fmu, (0x170, 1), (0x180, 2))
    to_clock(fmu, 4 * TL)
    fmu.set("enc_phase", [240.0, 1200.0, 0.0, 0.0, 0.0, 0.0])
    to_clock(fmu, 5 * TL)  # the last of four
    assert (fmu.get("latch_value")[0], fmu.get("latch_seen")[0]) == (960, 2)
    fmu.free()


def test_compare_interrupts_at_its_clock_and_triggers_a_dac() -> None:
    fmu = card(
        host_irq_mask=page(ENC0, 1),
        compare_on=first(True, 9, False),
        compare=first(100, 9),
        dac_trigger=first(1, 8),
        dac_trigger_volts=first(7.5, 8, 0.0),
    )
    to_clock(fmu, TL)
    fmu.set("enc_phase", first(100.0, 6, 0.0))  # 400 counts in 4000 clocks: 100 after 1000
    to_clock(fmu, 2 * TL)
    assert fmu.get("irq_clock") == [1000.0]
    assert fmu.get("irq_flags")[ENC0] == 1
    assert fmu.get("dac")[0] == 7.5 and fmu.get("dac_fired") == [1]
    write(fmu, (0x310, 0))
    to_clock(fmu, 4 * TL)
    assert fmu.get("dac")[0] == 0.0 and fmu.get("dac_fired") == [0]
    fmu.free()


def test_a_signal_too_fast_for_the_filter_miscounts_and_says_so() -> None:
    fmu = card(enc_filter=40)
    to_clock(fmu, TL)
    fmu.set("enc_phase", [40.0, 60.0, 0.0, 0.0, 0.0, 0.0])  # half a line in 50 and in 33 clocks
    to_clock(fmu, 2 * TL)
    fmu.set("enc_phase", [40.0, 60.0, 0.0, 0.0, 0.0, 0.0])
    to_clock(fmu, 3 * TL)
    counts = fmu.get("enc_count")
    assert counts[0] == 160 and counts[1] < 10
    assert fmu.get("enc_too_fast") == [2]
    write(fmu, (0x141, 1))
    to_clock(fmu, 4 * TL)
    assert fmu.get("enc_too_fast") == [0]
    fmu.free()


def test_an_encoder_whose_plug_is_out_counts_on_behind_it() -> None:
    fmu = card(enc_rate=4)
    counts = []
    for k, out in enumerate([False, True, True, False, False]):
        assert fmu.set("enc_unplugged", first(out, 9, False)) == OK
        assert fmu.set("enc_phase", [10.0 * (k + 1)] * 6) == OK
        to_clock(fmu, (k + 1) * TL)
        to_clock(fmu, (k + 1) * TL + 1)
        counts.append(fmu.get("enc_count")[:2])
    assert counts[-1] == [counts[0][0] + 80, counts[0][1] + 160]
    assert counts[1][0] == counts[2][0] == counts[0][0]
    fmu.free()


def test_a_new_gain_acts_at_the_next_update_and_a_loop_can_be_cleared() -> None:
    fmu = card(host_loop_on=True, host_dac_source=1, p_scale=0, host_p_gain=1)
    to_clock(fmu, TL)
    fmu.set("enc_phase", first(-25.0, 6, 0.0))
    to_clock(fmu, 3 * TL)
    assert fmu.get("dac")[0] == 100 * LSB
    fmu.set("host_p_gain", first(3, 6))
    to_clock(fmu, 4 * TL - 1)
    assert fmu.get("dac")[0] == 100 * LSB
    to_clock(fmu, 4 * TL)  # computed at the instant 3 TL, one period of conversion
    assert fmu.get("dac")[0] == 300 * LSB
    write(fmu, (0x200, 1))
    to_clock(fmu, 5 * TL)
    assert fmu.get("err_count")[0] == 0 and fmu.get("dac")[0] == 0.0
    fmu.free()


def test_fifo_operations() -> None:
    """Erase the newest, shift the oldest out, see the command in progress."""
    fmu = card(host_dda_length=10, host_dda_divider=10)  # 10240 clocks
    rows = [[10 * k, *[0] * 5] for k in range(1, 9)]
    fmu.set("host_cmd_frames", [x for r in rows for x in r] + [0] * 48)
    fmu.set("host_cmd_count", 8)
    fmu.set("host_cmd_seq", 1)
    to_clock(fmu, 10240)
    assert (fmu.get("dda_command")[0], fmu.get("stock")[0]) == (10, 7)
    write(fmu, (0x010, 3), (0x018, 1))
    to_clock(fmu, 4 * TL)
    assert fmu.get("stock")[0] == 3  # 30 40 50 are left
    to_clock(fmu, 100 * TL)
    assert fmu.get("pulse_count")[0] == 10 + 30 + 40 + 50
    fmu.free()


def test_dac_trim() -> None:
    fmu = card(dac_gain=first(1.1, 8, 1.0), dac_offset=[0.0, -0.25, *[0.0] * 6])
    fmu.set("host_dac_volts", [5.0, 1.0, 10.0, 0.0, 0.0, 0.0])
    to_clock(fmu, 2 * TL)
    assert fmu.get("dac")[:3] == [16384 * LSB * 1.1, round(1.0 / LSB) * LSB - 0.25, 10.0 - LSB]
    fmu.free()


@pytest.mark.parametrize("bits", [12, 14, 16])
def test_adc_free_run(bits: int) -> None:
    """Channels in turn, one per adc_time; codes to the nearest step; compare and group."""
    fmu = card(
        adc_bits=bits,
        adc_run=True,
        adc_time=500,
        adc_enabled=0b101,
        adc_tagged=0b101,
        adc_range=[0, 0, 1, *[0] * 5],
        adc_compare_on=1,
        adc_compare_volts=first(2.0, 8, 0.0),
        host_irq_mask=page(ADC, 1),
    )
    assert fmu.set("io_volts", [1.2345, 9.0, 6.789, 0.0, 0.0, 0.0]) == OK
    to_clock(fmu, 2 * TL - 1)
    assert fmu.get("adc_conversions") == [15] and fmu.get("adc_busy") == [True]
    bipolar, unipolar = 20.0 / 2**bits, 10.0 / 2**bits
    volts = fmu.get("adc")
    assert volts[0] == round(1.2345 / bipolar) * bipolar
    assert volts[2] == round(6.789 / unipolar) * unipolar
    assert volts[1] == 0.0  # not enabled
    assert fmu.get("irq_flags")[ADC] == 1 << 8 | 1 << 9
    to_clock(fmu, 2 * TL)
    fmu.set("io_volts", [3.0, 9.0, 6.789, 0.0, 0.0, 0.0])
    to_clock(fmu, 3 * TL)  # channel 1 is sampled at 2 TL, before the pins; again at 2 TL + 1000
    assert fmu.get("irq_clock") == [2 * TL + 1500.0]
    fmu.free()


def test_adc_single_conversion() -> None:
    fmu = card(adc_mode=0, adc_channel=1, adc_time=1000)
    fmu.set("io_volts", [0.0, -4.0, 0.0, 0.0, 0.0, 0.0])
    to_clock(fmu, TL)
    assert fmu.get("adc_conversions") == [0]
    write(fmu, (0x406, 1))
    to_clock(fmu, TL + 999)
    assert fmu.get("adc_busy") == [True]
    to_clock(fmu, TL + 1000)
    assert fmu.get("adc")[1] == pytest.approx(-4.0, abs=20.0 / 2**15)
    assert (fmu.get("adc_busy"), fmu.get("adc_conversions")) == ([False], [1])
    fmu.free()


def test_local_inputs_interrupt_on_their_edges() -> None:
    fmu = card(
        ldi_edge=[0, 1, 2, *[0] * 5], dfi_dedicated=0b1000001, host_irq_mask=page(LIO, 0x7FFF)
    )
    levels = [False] * 8
    seen = []
    for k, (index, level) in enumerate([(0, 1), (1, 1), (2, 1), (0, 0), (1, 0), (2, 0)], 1):
        to_clock(fmu, k * TL)
        levels[index] = bool(level)
        fmu.set("io_ldi", levels)
        to_clock(fmu, k * TL + 1)
        seen.append(fmu.get("irq_flags")[LIO])
        fmu.set("host_ack_flags", page(LIO, seen[-1]))
        fmu.set("host_ack_seq", k)
    assert seen == [1, 0, 4, 0, 2, 4]
    fmu.set("io_up", first(True, 6, False))
    to_clock(fmu, 9 * TL)
    assert fmu.get("irq_flags")[LIO] == 1 << 8  # over-travel of axis 1 on DFI0
    assert fmu.get("over_travel") == [1]
    fmu.free()


def test_emergency_stop_empties_and_holds_off() -> None:
    """What was in the DDA ends; the FIFO is emptied, writes are refused, outputs are off."""
    fmu = card(host_dda_length=10, host_dda_divider=4, servo=63, ready=True, ldo_on=5)
    fmu.call("SetDebugLogging", True, 0, None)
    fmu.set("host_dac_volts", 3.0)
    fmu.set("host_cmd_frames", [100] * 96)
    fmu.set("host_cmd_count", 10)
    fmu.set("host_cmd_seq", 1)
    to_clock(fmu, 3 * TL)
    assert fmu.get("servo_on") == [True] * 6 and fmu.get("ldo") == [5]
    assert fmu.get("stock")[0] == 8 and fmu.get("dac")[0] > 2.9
    fmu.set("io_stop", True)
    to_clock(fmu, 3 * TL + 1)
    assert (fmu.get("stopped"), fmu.get("off")) == ([True], [True])
    assert fmu.get("stock") == [0] * 6 and fmu.get("dac") == [0.0] * 6
    assert fmu.get("servo_on") == [False] * 6
    assert (fmu.get("ldo"), fmu.get("position_ready")) == ([0], [False])
    fmu.set("host_cmd_seq", 2)
    to_clock(fmu, 8 * TL)
    assert fmu.get("frames_refused") == [10]
    assert fmu.get("pulse_count") == [200] * 6
    assert "the emergency stop is pressed" in fmu.said
    fmu.set("io_stop", False)
    fmu.set("host_cmd_seq", 3)
    to_clock(fmu, 40 * TL)
    assert fmu.get("pulse_count") == [1200] * 6
    assert fmu.get("servo_on") == [True] * 6 and fmu.get("dac")[0] > 2.9
    fmu.free()


def test_closed_gate_freezes() -> None:
    fmu = card(host_dda_length=10, host_dda_divider=4)
    fmu.set("host_cmd_frames", [100] * 96)
    fmu.set("host_cmd_count", 3)
    fmu.set("host_cmd_seq", 1)
    to_clock(fmu, 2 * TL)
    write(fmu, (0x504, 0))
    to_clock(fmu, 3 * TL)
    held = fmu.get("pulse_count")[0]
    to_clock(fmu, 30 * TL)
    assert 0 < held < 300 and fmu.get("pulse_count")[0] == held and fmu.get("off") == [True]
    write(fmu, (0x504, 1))
    to_clock(fmu, 60 * TL)
    assert fmu.get("pulse_count")[0] == 300 and fmu.get("off") == [False]
    fmu.free()


def test_timer_and_watchdog() -> None:
    """The timer fires every period to the clock; five of them without a refresh let it expire."""
    fmu = card(
        timer_period=1234,
        watchdog_value=5,
        watchdog_reset=500,
        host_irq_mask=page(LIO, 1 << 15),
        servo=1,
    )
    to_clock(fmu, 1233)
    assert fmu.get("irq_seq") == [0]
    to_clock(fmu, 1234)
    assert (fmu.get("irq_clock"), fmu.get("timer_fired")) == ([1234.0], [1])
    to_clock(fmu, TL)
    write(fmu, (0x543, 1))
    to_clock(fmu, TL + 1)  # refreshed after three firings
    to_clock(fmu, 8 * 1234 - 1)
    assert fmu.get("watchdog_expired") == [False] and fmu.get("servo_on")[0]
    to_clock(fmu, 8 * 1234)
    assert fmu.get("watchdog_expired") == [True] and not fmu.get("servo_on")[0]
    to_clock(fmu, 3 * TL)
    write(fmu, (0x543, 1))
    to_clock(fmu, 3 * TL + 1)
    assert fmu.get("watchdog_expired") == [False] and fmu.get("servo_on")[0]
    fmu.free()


def test_remote_slaves() -> None:
    """Inputs arrive an exchange later, an edge interrupts, a slave that never answers is told."""
    fmu = card(
        rio_time=1000,
        rio_enabled=[3, 0],
        rio_retry=[1, 0],
        rio_out_on=[0x1234, *[0] * 23],
        io_remote_connected=[True, False, True, True, True, True],
        host_irq_mask=page(RIO0, 0x3FFF),
    )
    to_clock(fmu, 999)
    assert fmu.get("remote_ready") == [0] and fmu.get("remote_out_1")[0] == 0
    to_clock(fmu, 1000)
    assert fmu.get("remote_ready") == [1] and fmu.get("remote_out_1")[0] == 0x1234
    to_clock(fmu, TL)
    assert fmu.get("irq_flags")[RIO0] == 1 << 13  # two failures of slave 2: not ready
    assert fmu.get("irq_clock") == [4000.0] and fmu.get("remote_errors")[1] == 2
    fmu.set("io_remote", [0x8001, 7, *[0] * 22])
    to_clock(fmu, TL + 999)
    assert fmu.get("remote_in_1")[0] == 0
    to_clock(fmu, 2 * TL)
    assert (fmu.get("remote_in_1")[0], fmu.get("remote_in_2")[0]) == (0x8001, 7)
    assert fmu.get("irq_flags")[RIO0] & 1
    fmu.free()


def test_a_slave_that_a_register_switches_on_shows_its_inputs_of_now() -> None:
    fmu = card(rio_time=1000, io_remote_connected=[True] * 6)
    to_clock(fmu, 3 * TL)
    fmu.set("io_remote", [0x8001, *[0] * 23])
    write(fmu, (0x602, 1))
    to_clock(fmu, 3 * TL + 999)
    assert fmu.get("remote_ready") == [0]
    to_clock(fmu, 3 * TL + 1000)
    assert (fmu.get("remote_ready"), fmu.get("remote_in_1")[0]) == ([1], 0x8001)
    fmu.free()


@pytest.mark.parametrize(
    ("address", "value", "said"),
    [
        (0x110, 3, "register 0x110 = 3 refused in transaction 1: an encoder multiplies by"),
        (0x111, 1.5, "register 0x111 = 1.5 refused in transaction 1: the value is no number"),
        (0xFFF, 1, "register 0xFFF = 1 refused in transaction 1: there is no register"),
        (0x300, 10.5, "register 0x300 = 10.5 refused in transaction 1: a voltage is"),
    ],
)
def test_a_refused_register_ends_the_transaction(address: int, value: float, said: str) -> None:
    """What stands before it is written, what stands after it is not; the status tells."""
    fmu = card()
    fmu.call("SetDebugLogging", True, 0, None)
    to_clock(fmu, TL)
    write(fmu, (0x500, 3), (address, value), (0x500, 7))
    to_clock(fmu, 2 * TL)
    assert said in fmu.said and fmu.messages[-1][0] == WARNING
    assert fmu.get("reg_ack") == [1] and fmu.get("reg_status")[0] != 0
    assert fmu.get("ldo") == [3]
    write(fmu, (0x500, 7))
    to_clock(fmu, 3 * TL)
    assert (fmu.get("reg_status"), fmu.get("ldo")) == ([0], [7])
    fmu.free()


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("enc_wiring", [0, 4, *[0] * 7], "enc_wiring[2] = 4: the encoder wiring"),
        ("adc_bits", 13, "adc_bits = 13: the ADC has 12, 14 or 16 bit"),
        ("adc_compare_volts", [0.0, -1.0, *[0.0] * 6], "adc_compare_volts[2] = -1: the compare"),
    ],
)
def test_parameters_that_do_not_fit_are_named(name: str, value: Any, message: str) -> None:
    fmu = Instance("epcio", 3)
    fmu.set("enc_format", [0, 2, *[0] * 7])
    fmu.set("adc_range", [0, 1, *[0] * 6])
    assert fmu.set(name, value) == OK
    fmu.enter()
    assert fmu.call("ExitInitializationMode") == ERROR
    assert any(message in text for _, _, text in fmu.messages), fmu.messages
    fmu.free()


def test_a_module_that_is_reset_takes_the_hosts_levels_again() -> None:
    """They have not changed, but the card's have: of DAC and DDA time."""
    fmu = card(host_dac_volts=first(1.5, rest=0.0), host_dda_length=11, host_dda_divider=7)
    to_clock(fmu, 10 * TL)
    volts, time = fmu.get("dac")[0], fmu.get("dda_time")
    assert volts == pytest.approx(1.5, abs=LSB)
    assert time == [7 * 2**11 * TICK]
    write(fmu, (0x700, 8), (0x700, 1))
    shown = []
    for instant in range(11, 40):
        to_clock(fmu, instant * TL)
        shown.append(fmu.get("dac")[0])
    assert shown.count(0.0) == 1 and shown.count(volts) == len(shown) - 1
    assert fmu.get("dda_time") == time
    fmu.free()
