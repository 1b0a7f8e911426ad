"""The MSP430 positioner: its decoder against the listing ticked clock by clock, its speed limit."""

import math
from typing import Any

import numpy as np
import pytest
from fmi_tools import ERROR, OK, Instance
from hypothesis import given, settings
from hypothesis import strategies as st
from msp430_chip import GRAIN, LATENCY, LISTING, Chip, repaired

CLOCK = 125e-9  # [s] at 8 MHz
NAME = "msp430_positioner"


def positioner(**values: Any) -> Instance:
    return Instance(NAME, 3).initialize(values)


def to_clock(fmu: Instance, clock: int) -> None:
    """One step to a clock; the time is counted, not added up."""
    now = round(fmu.time / CLOCK)
    fmu.time = now * CLOCK
    assert fmu.step((clock - now) * CLOCK) == OK, fmu.said
    fmu.time = clock * CLOCK


def word(x: int) -> int:
    return (x + 32768) % 65536 - 32768


small = st.integers(-24, 24)
large = st.integers(-400, 400)
to_an_edge = st.integers(-8, 8).map(lambda n: n * GRAIN // 4)
dither = st.sampled_from([-1, 1, 0])
moves = st.lists(
    st.tuples(st.one_of(small, large, to_an_edge, dither), st.booleans()), min_size=1, max_size=60
)


@settings(max_examples=200)
@given(
    moves=moves,
    start=st.sampled_from([0, 1, -1, 16, 15, -16, 5000]),
    one=st.booleans(),
    clocks=st.sampled_from([120, 40, 400, 1000]),
    timer=st.sampled_from([(4000, 400), (1009, 300), (8000, 5)]),
)
def test_the_decoder_is_the_listing_ticked_clock_by_clock(
    moves: list[tuple[int, bool]], start: int, one: bool, clocks: int, timer: tuple[int, int]
) -> None:
    fmu = positioner(
        pin_period=clocks * CLOCK,
        flag_clear=int(one),
        timer_period=timer[0] * CLOCK,
        timer_cycles=timer[1],
        speed=1000.0,
        acceleration=1e6,
    )
    chip = Chip(one, *timer)
    phase, shown = start, None
    for k, (step, home) in enumerate([(0, False), *moves, (0, False), (0, False)]):
        now = phase + max(-clocks * GRAIN // 4, min(step, clocks * GRAIN // 4))
        fmu.set("scale_phase", now / GRAIN)
        fmu.set("home", home)
        to_clock(fmu, (k + 1) * clocks)
        chip.sample(phase, now, clocks, home)
        shown = [fmu.get(n)[0] for n in ("counter", "counter2", "edges", "lost", "turned")]
        memory = chip.memory
        assert shown == [
            word(memory["wMCounter"]),
            word(memory["wSt"]),
            chip.edges,
            chip.lost,
            chip.turned,
        ], k
        assert chip.quarter is not None
        pins = chip.lines(chip.quarter)
        assert [fmu.get("pin_a")[0], fmu.get("pin_b")[0]] == [bool(pins & 4), bool(pins & 16)], k
        assert 0 <= fmu.get("interrupt")[0] <= 5
        phase = now
    fmu.free()


def path_clocks(one: bool, up: bool) -> list[tuple[int, int, int]]:
    """Clocks from acceptance to level read, to the flags' clearing and to the end, per source.

    Added up by hand from the listing: a test with its jump takes 6 clocks (A) or 7 (B), reading a
    level 5 (PGB) or 4 (PGA), a jump 2, a counter 4, clearing all 4, reti 5; the repaired routine
    clears one flag in 4 (A) or 5 (B) before it reads the level.
    """
    rows = []
    for source in range(4):
        start = LATENCY + (0, 6, 12, 19)[source] + (6, 6, 7, 7)[source]
        jmp = 2 if (up and source in (1, 2)) or (not up and source == 0) else 0
        drop = (4, 4, 5, 5)[source] if one else 0
        read = start + drop + (5, 5, 4, 4)[source]
        clear = read + 2 + jmp + 8 + (0 if one else 4)
        rows.append((read, clear, clear + 5))
    return rows


def shortest(one: bool, up: bool, wait: int) -> int:
    """Least clocks between edges at which no count is lost, when an edge may wait for `wait`.

    As written the next edge must come after the flags are cleared; repaired after the level is
    read, and four services must fit into four edges.
    """
    rows = path_clocks(one, up)
    if not one:
        return wait + max(clear for _, clear, _ in rows) + 1
    longest = max(read for read, _, _ in rows) + 1 + wait
    return longest if wait else max(longest, -(-sum(end for *_, end in rows) // 4))


def counts_wrong(one: bool, up: bool, clocks: int, timer: tuple[int, int]) -> int:
    """Edges lost or turned at one edge per `clocks`, over all alignments with the timer."""
    fmu = positioner(
        pin_period=4 * clocks * CLOCK,
        flag_clear=int(one),
        timer_period=timer[0] * CLOCK,
        timer_cycles=timer[1],
        speed=1000.0,
        acceleration=1e6,
    )
    steps = min(timer[0] + 8, 600)
    for k in range(steps):
        way = min(k, steps - 2)  # rest in the end: every edge is served
        fmu.set("scale_phase", float(way if up else -way))
        to_clock(fmu, 4 * clocks * (k + 1))
    wrong = fmu.get("lost")[0] + fmu.get("turned")[0]
    assert (wrong == 0) == (fmu.get("counter")[0] == word(fmu.get("edges")[0]))
    assert fmu.get("edges")[0] == (4 if up else -4) * (steps - 2)
    fmu.free()
    return int(wrong)


@pytest.mark.parametrize("up", [True, False])
@pytest.mark.parametrize("one", [False, True])
def test_the_first_count_is_lost_at_the_speed_of_the_formula(one: bool, up: bool) -> None:
    least = shortest(one, up, 0)
    assert least == (47 if one else 51)
    never = (524288, 5)  # the timer does not fire in this run
    assert counts_wrong(one, up, least, never) == 0
    assert counts_wrong(one, up, least - 1, never) > 0


@pytest.mark.parametrize("up", [True, False])
@pytest.mark.parametrize("one", [False, True])
def test_the_timers_interrupt_takes_its_time_from_that_speed(one: bool, up: bool) -> None:
    cycles = 60
    least = shortest(one, up, LATENCY + cycles)
    for clocks, right in ((least, True), (least - 1, False)):
        # one clock more than whole periods of four edges: every alignment comes
        timer = (4 * clocks + 1, cycles)
        assert (counts_wrong(one, up, clocks, timer) == 0) == right


def test_the_listing_can_be_repaired_in_one_way() -> None:
    assert LISTING.count("mov.b") == 3 and repaired(LISTING).count("mov.b") == 0
    assert repaired(LISTING).count("bic.b") == 5


# A loop whose words round by less than 1e-4 of the step of 12000 counts, and whose dead time (timer
# and PWM and pins: 3 periods of 5 ms) is small beside 1/Kp: 0.5 mV and 0.1 counts/s per count.
FINE = {
    "timer_period": 5e-3,
    "pin_period": 5e-3,
    "pwm_counts": 40000,
    "filter_time": 1e-5,
    "step_target": True,
    "error_limit": 32767,
    "low_limit": -20000,
    "high_limit": 20000,
    "scale_time": 0.0,
    "debounce": 0.0,
    "flag_clear": 1,
    "p_gain": 1,
    "p_shift": 0,
    "speed": 20000.0,
    "home_speed": 100.0,
    "acceleration": 10000.0,
    "band": 0,
}
STEP = 12000
KP = 0.1  # [1/s]
KI = 13 / 65536 * KP / 5e-3  # [1/s2] with i_gain / 2^i_shift = 13 / 65536


class Axis:
    """The controller on an ideal integrator: `slope` counts/s per volt."""

    def __init__(self, slope: float, values: dict[str, Any]) -> None:
        self.fmu, self.slope = positioner(**values), slope
        self.period = round(self.fmu.get("pin_period")[0] / CLOCK)
        self.place, self.k = 0.5, 0
        self.rows: list[dict[str, float]] = []

    def run(self, steps: int, *names: str) -> None:
        """Pin periods; the named outputs and the place are kept."""
        for _ in range(steps):
            self.fmu.set("scale_phase", self.place / 4)
            self.k += 1
            to_clock(self.fmu, self.k * self.period)
            volts = self.fmu.get("voltage")[0]
            self.place += self.slope * volts * self.period * CLOCK
            row = {n: self.fmu.get(n)[0] for n in names}
            self.rows.append({"time": self.k * self.period * CLOCK, "place": self.place, **row})

    def press(self, button: str, steps: int = 2) -> None:
        """Down and up."""
        for down in (True, False):
            self.fmu.set(button, down)
            self.run(steps)

    def home(self) -> None:
        """Home where it stands."""
        self.run(2)
        self.fmu.set("pb1", True)
        self.run(3)
        self.fmu.set("home", True)
        self.run(20)
        self.fmu.set("pb1", False)
        self.run(2)
        assert self.fmu.get("homed") == [True]


def step_response(law: int) -> tuple[np.ndarray, np.ndarray]:
    """Time since TRACK jumped, and the rest of the way as a share of the step."""
    axis = Axis(KP / 5e-4, {**FINE, "law": law, "i_gain": 13, "i_shift": 16})
    axis.home()
    axis.fmu.set("target", STEP)
    axis.rows = []
    axis.fmu.set("pb2", True)
    axis.run(10000, "track")
    axis.fmu.free()
    start = next(r["time"] for r in axis.rows if r["track"] == STEP) - 5e-3  # shown a period later
    time = np.array([r["time"] for r in axis.rows]) - start
    rest = 1 - np.array([r["place"] for r in axis.rows]) / STEP
    return time[time > 0], rest[time > 0]


def test_a_step_with_p_is_one_exponential() -> None:
    time, rest = step_response(0)
    assert np.abs(rest - np.exp(-KP * time)).max() < 1e-3
    assert np.abs(rest - np.exp(-1.01 * KP * time)).max() > 2e-3


def test_the_literal_integral_is_its_closed_form() -> None:
    """ds/dt = (Kp + Ki t) e: every period the gain grows, nothing is added up."""
    time, rest = step_response(1)
    assert np.abs(rest - np.exp(-KP * time - KI * time**2 / 2)).max() < 1e-3
    assert rest.min() > -1e-3  # so it cannot overshoot an integrator
    assert np.abs(rest - np.exp(-KP * time - 1.05 * KI * time**2 / 2)).max() > 2e-3


def test_the_sum_of_errors_is_its_closed_form() -> None:
    time, rest = step_response(2)
    wn = math.sqrt(KI)
    z = KP / (2 * wn)
    wd = wn * math.sqrt(1 - z * z)
    theory = np.exp(-z * wn * time) * (np.cos(wd * time) - z * wn / wd * np.sin(wd * time))
    assert np.abs(rest - theory).max() < 1e-3
    assert rest.min() < -1e-2  # overshoots by e^(-pi z / sqrt(1 - z^2)) at least


@pytest.mark.parametrize("duty", [0.5, 0.25, 0.9])
def test_ripple_and_resolution(duty: float) -> None:
    """The ripple of a duty that stands; a step of the PWM is 20 V / N."""
    axis = Axis(0.0, {**FINE, "p_shift": 4, "law": 0, "pwm_counts": 800, "filter_time": 1e-4})
    axis.home()
    axis.fmu.set("target", round((duty - 0.5) * 800 * 16))
    axis.press("pb2", 20)
    assert axis.fmu.get("duty") == [round(duty * 800)]
    x = 800 * CLOCK / 1e-4
    peak = 20 * (1 - math.exp(-duty * x)) * (1 - math.exp(-(1 - duty) * x)) / (1 - math.exp(-x))
    assert axis.fmu.get("ripple")[0] == pytest.approx(peak, rel=1e-9)
    assert axis.fmu.get("voltage")[0] == pytest.approx(20 * duty - 10, abs=1e-9)
    axis.fmu.set("target", round((duty - 0.5) * 800 * 16) - 16)
    axis.press("pb2", 20)
    assert axis.fmu.get("voltage")[0] == pytest.approx(20 * duty - 10 - 20 / 800, abs=1e-9)
    axis.fmu.free()


def test_voltage_is_what_a_fine_grid_shows_in_the_mean() -> None:
    """The mean over a pin period, whatever the period; shown at (k + 2) P is that from k P on."""
    means = []
    for part in (1, 10):
        fmu = positioner(pin_period=5e-4 / part, filter_start=0.0)
        volts = []
        for k in range(20 * part):
            to_clock(fmu, (k + 1) * 4000 // part)
            volts.append(fmu.get("voltage")[0])
        means.append(np.array(volts[1:]))
        fmu.free()
    assert np.allclose(means[1][:180].reshape(18, 10).mean(axis=1), means[0][:18], atol=1e-12)
    assert means[0][0] < -8.0 and abs(means[0][-1]) < 0.2  # the filter charges from 0 V


def test_position_with_trapezoid_and_limits_at_every_period() -> None:
    values = {
        "flag_clear": 1,
        "timer_cycles": 100,
        "debounce": 0.0,
        "pin_period": 1e-3,
        "pwm_counts": 8000,
        "p_gain": 2,
        "p_shift": 0,
        "i_gain": 1,
        "i_shift": 5,
        "speed": 15000.0,
        "acceleration": 60000.0,
    }
    axis = Axis(4000.0, values)
    axis.home()
    axis.run(200)
    axis.rows = []
    for target in (20000, 19000, 19001, -1000):
        axis.fmu.set("target", target)
        axis.press("pb2", 30)
        axis.run(3000, "track", "track_speed", "track_acceleration", "state", "counter")
        assert axis.fmu.get("track") == [float(target)] and axis.fmu.get("state") == [4]
        assert abs(axis.fmu.get("counter")[0] - target) <= 1
    rows = [r for r in axis.rows if "track" in r]
    speeds = np.array([r["track_speed"] for r in rows])
    # fixed point: 2^-16 counts/tick, of the speed and of its change
    assert np.abs(speeds).max() <= 15000.0 + 1000 / 65536
    assert max(abs(r["track_acceleration"]) for r in rows) <= 60000.0 + 1e6 / 65536
    assert np.abs(speeds).max() == pytest.approx(15000.0, abs=0.02)
    assert {r["state"] for r in rows} == {4, 5, 6, 7}
    assert axis.fmu.get("lost") == [0]
    axis.fmu.free()


# In clocks of 1 s this pin period is 25 times 2^64 ns, less 0.7 s.
LONGEST = 461168601842.0
SLOWEST = {"clock": 1.0, "timer_period": 1000.0, "pin_period": LONGEST}
SLOWEST |= {"speed": 10.0, "home_speed": 1.0, "acceleration": 0.01}
WRONG = [
    ({"clock": 3e6}, "clock = 3000000 Hz: not a whole number of ns per clock"),
    ({"pin_period": 1.00003e-4}, "pin_period = 0.000100003"),
    ({"pin_period": 1e-12}, "pin_period"),
    ({"timer_period": 1.00001e-3}, "timer_period = 0.00100001"),
    ({"timer_period": 0.1}, "longer than the timer counts, 0.065536 s"),
    ({"timer_period": 1e9}, "timer_period = 1000000000 is above its maximum 128"),
    ({"clock": 4095.0}, "clock = 4095 is below its minimum 4096"),
    (SLOWEST, "clock = 1 is below its minimum 4096"),
    ({"pin_period": LONGEST}, "pin_period = 461168601842 is above its maximum 128"),
    ({"pin_period": 0.0655362}, "pin_period = 0.0655362"),
    ({"timer_cycles": 7994}, "timer_cycles = 7994: with the latency of 6 not less than"),
    ({"speed": 0.001}, "speed = 0.001"),
    ({"speed": 2e7}, "speed = 20000000: 20000 counts per timer period, outside"),
    ({"home_speed": 0.0}, "home_speed = 0"),
    ({"acceleration": 1.0}, "acceleration = 1: 1e-06 counts per timer period"),
    ({"acceleration": 10.0, "speed": 1e6}, "acceleration = 10: takes more than 65535 timer"),
    ({"home_direction": 0}, "home_direction = 0: must be -1 or 1"),
    ({"low_limit": 5, "high_limit": 5}, "low_limit = 5: not below high_limit = 5"),
    ({"scale_time": 1e9}, "scale_time = 1000000000 s: too long"),
]


@pytest.mark.parametrize(("values", "told"), WRONG, ids=lambda x: str(x)[:60])
def test_a_wrong_parameter_is_named(values: dict[str, Any], told: str) -> None:
    fmu = Instance(NAME, 3)
    status = OK
    for name, value in values.items():
        status = status or fmu.set(name, value)
    if status == OK:
        fmu.enter()
        status = fmu.call("ExitInitializationMode")
    assert status == ERROR
    said = [text for _, _, text in fmu.messages]
    assert any(told in text for text in said) and len(said) == 1, said
    fmu.free()


@pytest.mark.parametrize("clock_ns", [125, 244125])
def test_the_longest_periods_are_what_the_timer_counts(clock_ns: int) -> None:
    """Timer_A has 16 bit and divides by 8; the slowest clock is a watch crystal's eighth."""
    slow = {"speed": 10.0, "home_speed": 1.0, "acceleration": 0.01, "clock": 1e9 / clock_ns}
    period = clock_ns * 8 * 65536 * 1e-9
    fmu = positioner(pin_period=period, timer_period=period, **slow)
    for served in (0, 0, 1, 2):  # at an instant the timer fires, at the next it shows
        assert fmu.step(period) == OK, fmu.said
        assert fmu.get("ticks") == [served]
    fmu.free()


def test_a_phase_that_cannot_be_followed_is_named() -> None:
    for phase, told in (
        (1e16, "more edges than a number"),
        (250.0, "more than one edge per clock"),
    ):
        fmu = positioner()
        assert fmu.step(1e-4) == OK
        fmu.set("scale_phase", phase)
        assert fmu.step(1e-4) == ERROR
        assert told in fmu.said and f"scale_phase = {phase:.17g}" in fmu.said
        fmu.free()
