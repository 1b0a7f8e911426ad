"""The C library from Python, alone, on the virtual card, and beside the FMUs."""

import math
import pickle
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from test_mcc import Machine

import motionfmu.virtual.mcc as mcc
from motionfmu.base.errors import InputError
from motionfmu.virtual.mcc import Mcc, MccError, VirtualCard

HEADER = (ROOT / "src/controllers/mcc/mcc.h").read_text()


def test_codes_are_those_of_the_header() -> None:
    codes = dict(re.findall(r"MCC_(\w+)\s*= (-\d+)", HEADER))
    assert codes and all(mcc.CODES[int(n)][0] == name for name, n in codes.items())


def test_every_call_of_the_library_is_a_method() -> None:
    names = set(
        re.findall(r"^\w+ (?:MCC|mcc(?=_set))_(\w+)\((?:const )?struct mcc \*", HEADER, re.M)
    )
    assert len(names) > 50 and [n for n in names if not callable(getattr(Mcc, n, None))] == []


def test_library_alone_plans_pulses() -> None:
    library = Mcc(feed=1200.0, acc_time=0.05)
    assert library.line([3.0, -1.5, 0, 0, 0, 0]) == 1
    frames = library.take(10_000)
    assert frames.sum(axis=0).tolist() == [3000, -1500, 0, 0, 0, 0]
    assert np.abs(np.diff(frames[:, 0])).max() <= 2
    assert library.get_ppos().tolist() == [3000, -1500, 0, 0, 0, 0]
    assert library.check_stop() == 1 and len(library.take(10)) == 0


MOVES: list[tuple[str, tuple[Any, ...], list[float]]] = [
    ("line", ([1, 2, 3, 4, 5, 6],), [1, 2, 3, 4, 5, 6]),
    ("line_x", (2,), [2, 0, 0, 0, 0, 0]),
    ("line_y", (2,), [0, 2, 0, 0, 0, 0]),
    ("line_z", (2,), [0, 0, 2, 0, 0, 0]),
    ("arc_xy", ([1, 1], [2, 0]), [2, 0, 0, 0, 0, 0]),
    ("arc_yz", ([1, 1], [2, 0]), [0, 2, 0, 0, 0, 0]),
    ("arc_zx", ([1, 1], [2, 0]), [0, 0, 2, 0, 0, 0]),
    ("arc_xyuvw", ([1, 1], [2, 0], [3, 4, 5]), [2, 0, 0, 3, 4, 5]),
    ("arc_yzuvw", ([1, 1], [2, 0], [3, 4, 5]), [0, 2, 0, 3, 4, 5]),
    ("arc_zxuvw", ([1, 1], [2, 0], [3, 4, 5]), [0, 0, 2, 3, 4, 5]),
    ("circle_xy", ([1, 1], mcc.CW), [0] * 6),
    ("circle_yz", ([1, 1], mcc.CCW), [0] * 6),
    ("circle_zx", ([1, 1], mcc.CCW), [0] * 6),
    ("circle_xyuvw", ([1, 1], mcc.CW, [3, 4, 5]), [0, 0, 0, 3, 4, 5]),
    ("circle_yzuvw", ([1, 1], mcc.CW, [3, 4, 5]), [0, 0, 0, 3, 4, 5]),
    ("circle_zxuvw", ([1, 1], mcc.CCW, [3, 4, 5]), [0, 0, 0, 3, 4, 5]),
    ("ptp", ([1, 2, 3, 4, 5, 6],), [1, 2, 3, 4, 5, 6]),
    ("ptp_x", (2,), [2, 0, 0, 0, 0, 0]),
    ("ptp_y", (2,), [0, 2, 0, 0, 0, 0]),
    ("ptp_z", (2,), [0, 0, 2, 0, 0, 0]),
    ("ptp_uvw", (1, 2, 3), [0, 0, 0, 1, 2, 3]),
    ("motion_delay", (30,), [0] * 6),
]


@pytest.mark.parametrize(("name", "arguments", "end"), MOVES, ids=[m[0] for m in MOVES])
def test_each_move_ends_where_it_should(name: str, arguments: Any, end: list[float]) -> None:
    library = Mcc(active=True, acc_time=0.02, dec_time=0.02)
    assert getattr(library, name)(*arguments) == 1
    frames = library.take(100_000)
    assert library.get_cpos().tolist() == pytest.approx(end, abs=1e-9)
    assert frames.sum(axis=0).tolist() == [1000 * e for e in end]
    assert len(frames) > 5


def test_direction_of_a_circle() -> None:
    for direction, sign in ((mcc.CW, 1), (mcc.CCW, -1)):
        library = Mcc(acc_time=0.02)
        library.circle_xy([5, 0], direction)
        half = library.take(100)
        assert np.sign(half[:, 1].sum()) == sign


SETTINGS = [
    ("acc_type", "S"),
    ("dec_type", "S"),
    ("acc_step", 250.0),
    ("dec_step", 120.0),
    ("dda", 1.024),
    ("max_dda_spd", [10, 20, 30, 40, 50, 60]),
    ("over_spd", 130.0),
    ("ptp_ospd", 40.0),
    ("P_gain", [1, 2, 3, 4, 5, 65535]),
]


@pytest.mark.parametrize(("name", "value"), SETTINGS, ids=[s[0] for s in SETTINGS])
def test_what_is_set_can_be_read(name: str, value: Any) -> None:
    library = Mcc()
    getattr(library, f"set_{name}")(value)
    assert getattr(library, f"get_{name}")() == value


def test_coordinates_and_continuous_path() -> None:
    library = Mcc()
    assert library.get_pos_type() == 1 and library.check_quit() == 1
    library.set_inc()
    library.enable_quit()
    assert library.get_pos_type() == 0 and library.check_quit() == 0
    for _ in range(2):
        library.line_x(2)
    library.set_abs()
    library.disable_quit()
    library.take(10_000)
    assert library.get_cpos()[0] == 4.0


REFUSED = [
    ("line_y", (math.nan,), -5, "PARAMETER"),
    ("line", ([0, 0, 0, 1, 0, 0],), -5, "axis is not used"),
    ("circle_xy", ([1, 1], 2), -5, "PARAMETER"),
    ("set_fspd", (0.0,), -7, "FEED_RATE"),
    ("set_acc_type", ("X",), -5, "PARAMETER"),
    ("set_over_spd", (201,), -5, "PARAMETER"),
    ("motion_hold", (), -11, "nothing moves"),
    ("motion_conti", (), -12, "nothing is held"),
    ("motion_abort", (), -13, "nothing moves"),
    ("task_set_origin", (10, [0] * 6), -5, "PARAMETER"),
    ("task_continue", (), -12, "CONTI_ILLEGAL"),
]


@pytest.mark.parametrize(("name", "arguments", "code", "said"), REFUSED)
def test_refused_call_says_code_and_meaning(
    name: str, arguments: Any, code: int, said: str
) -> None:
    library = Mcc()
    with pytest.raises(MccError, match=said) as e:
        getattr(library, name)(*arguments)
    assert e.value.code == code and name in e.value.call and str(code) in str(e.value)


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("line", ([1, 2, 3],)),
        ("arc_xy", ([1], [2, 3])),
        ("circle_xy", ([1, 1], 0.5)),
        ("set_P_gain", ([1.5] * 6,)),
        ("set_P_gain", ([2**31] * 6,)),
        ("set_P_gain", ([math.nan] * 6,)),
    ],
)
def test_argument_that_is_none_is_an_input_error(name: str, arguments: Any) -> None:
    with pytest.raises(InputError, match="wanted"):
        getattr(Mcc(), name)(*arguments)


def test_ring_full_and_closed_library() -> None:
    library = Mcc()
    with pytest.raises(MccError, match="let the task run"):
        for k in range(1000):
            library.line_x(k % 2)
    assert k > 60
    library.take(10**6)
    assert library.line_x(5) == k + 1
    library.take(10**6)
    library.close_motion()
    with pytest.raises(MccError, match="init_motion"):
        library.line_x(1)
    library.init_motion(feed=180.0)
    assert library.line_x(1) == 1


def test_card_puts_out_every_pulse_and_motors_follow() -> None:
    card = VirtualCard(output_mode=[mcc.PULSES, mcc.LOOP, mcc.SOFTWARE, 0, 0, 0], p_gain=200)
    card.mcc.line([10, 10, 10, 0, 0, 0])
    moving = card.run(0.5)
    assert moving.status == mcc.RUNNING and moving.errors[1] > 100 > moving.errors[0] >= -20
    still = card.run_until_stop()
    assert still.stopped and still.pulses[:3].tolist() == [10_000] * 3
    rest = card.run(1.0)
    assert rest.table[:3] == pytest.approx([10, 10, 10], abs=2e-3)
    assert rest.clock == still.clock + mcc.CLOCK_HZ and rest.time == rest.clock / mcc.CLOCK_HZ
    assert rest.underflows.sum() == rest.starved == rest.frames_refused == 0
    with pytest.raises(AttributeError, match="no reading 'pulse'"):
        _ = rest.pulse


def test_hold_override_and_abort_reach_the_card() -> None:
    card = VirtualCard()
    card.mcc.line_x(50)
    card.run(0.5)
    card.mcc.motion_hold()
    held = card.run(0.5)
    assert held.status == mcc.HOLD and card.run(0.5).pulses[0] == held.pulses[0]
    card.mcc.motion_conti()
    card.mcc.set_over_spd(200)
    assert card.run(0.5).path_feed == pytest.approx(20.0)
    card.mcc.motion_abort()
    end = card.run_until_stop()
    assert held.pulses[0] < end.pulses[0] < 50_000 and end.status == mcc.STOPPED
    assert card.mcc.get_over_spd() == 200.0


def test_switches_are_named() -> None:
    card = VirtualCard()
    card.set_switches("home", 0, 2)
    with pytest.raises(InputError, match="home, up or down"):
        card.set_switches("Home", 0)
    with pytest.raises(InputError, match=r"0 \.\. 5"):
        card.set_switches("up", 6)


def test_record_is_what_single_runs_read() -> None:
    a, b = VirtualCard(irq_jitter=225e-6), VirtualCard(irq_jitter=225e-6)
    for card in (a, b):
        card.mcc.circle_xy([3, 4], mcc.CCW)
    found = a.record(0.7, 0.001, "pulses", "stock", "path_feed")
    assert found["time"].shape == (701,) and found["pulses"].shape == (701, 6)
    for k in range(0, 701, 50):
        reading = b.run_to(k * 40_000)
        assert reading.pulses.tolist() == found["pulses"][k].tolist()
        assert reading.path_feed == found["path_feed"][k]
    with pytest.raises(InputError, match="no reading 'x'"):
        a.record(1, 0.1, "x")


PART = "G21 G17 G90 G64\nG1 X5 F3000\nG3 X0 Y5 I-5\nG61\nM64 P3\nG4 P0.02\nG2 X5 Y0 R5 Z1\nM2\n"


def test_part_program_and_its_faults() -> None:
    card = VirtualCard()
    with pytest.raises(InputError) as told:
        card.mcc.task_start("G1 X1\nM666\nG4 P\u00e4\n")
    assert str(told.value) == (
        'line 2: unknown word "M666", column 1\nline 3: number expected after "P", column 4'
    )
    assert str(pickle.loads(pickle.dumps(told.value))) == str(told.value)
    with pytest.raises(InputError, match=r"^(line .*\n){20}\.\.\. and more$"):
        card.mcc.task_check("G1 X1 Q1\n" * 21)
    assert card.mcc.task_status() == mcc.STOPPED
    card.mcc.task_set_origin(1, [1, 0, 0, 0, 0, 0])
    card.mcc.task_start(PART)
    with pytest.raises(MccError, match="part program runs"):
        card.mcc.line_x(1)
    end = card.run_until_stop()
    assert end.pulses[:3].tolist() == [6000, 0, 1000] and end.digital_out == 8


# Settings of the card and parameters of the FMU; 1500 rpm are 125 mm/s.
SAME = {"irq_jitter": 1e-4, "irq_latency": 3e-4, "lead": 5.0, "max_rpm": 1500.0, "max_feed": 6000.0}


def fmu_pulses(fmi: int, folder: Path, steps: int) -> np.ndarray:
    program = folder / "part.ngc"
    program.write_text(PART)
    wired = Machine(fmi, {"program": str(program), "output_mode": 0, **SAME})
    rows = []
    for _ in range(steps):
        rows.append([wired.card.get(n) for n in ("pulse_count", "stock", "irq_clock")])
        wired.step(1e-4)
    wired.end()
    return np.array([[*p[:3], *s[:3], c[0]] for p, s, c in rows])


def test_card_is_the_fmus_clock_by_clock(tmp_path: Path) -> None:
    steps = 6000
    card = VirtualCard(**SAME)
    card.mcc.task_start(PART)
    found = card.record(steps * 1e-4, 1e-4, "pulses", "stock", "irq_clock")
    rows = np.c_[found["pulses"][:, :3], found["stock"][:, :3], found["irq_clock"]][:steps]
    assert rows[-1, 0] != 0
    np.testing.assert_array_equal(rows, fmu_pulses(3, tmp_path, steps))


def test_binding_works_outside_the_source_tree(tmp_path: Path) -> None:
    text = "import motionfmu.virtual.mcc as m; c = m.VirtualCard(); c.mcc.line_x(1)"
    text += "; print(c.run_until_stop())"
    run = subprocess.run(
        [sys.executable, "-c", text], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert "pulses=[1000" in run.stdout


def test_axes_move_for_themselves() -> None:
    card = VirtualCard(active=True)
    card.mcc.set_ptp_asyn_acc_type("TTTSSS")
    card.mcc.set_ptp_asyn_decc_type("STSTST")
    card.mcc.set_ptp_asyn_acc_step([50] * 6)
    card.mcc.set_ptp_asyn_dec_step([80] * 6)
    assert card.mcc.get_ptp_asyn_acc_type() == "TTTSSS"
    assert card.mcc.get_ptp_asyn_dec_type() == "STSTST"
    assert card.mcc.get_ptp_asyn_acc_step() == [50.0] * 6
    assert card.mcc.get_ptp_asyn_dec_step() == [80.0] * 6
    card.mcc.ptp_asyn([6, 5, 4, 3, 2, 1])
    assert card.run_until_stop().pulses.tolist() == [6000, 5000, 4000, 3000, 2000, 1000]
    card.mcc.jog_i(0, -1.5, 20)
    card.mcc.jog_s(1, 25)
    card.mcc.jog_c(2, 1, 10)
    with pytest.raises(MccError, match="NOTACCEPTED"):
        card.mcc.line_x(1)
    card.run(0.5)
    card.mcc.jog_c(2, 0, 10)
    end = card.run_until_stop()
    assert end.pulses[:2].tolist() == [4500, 5025] and end.pulses[2] > 20_000


def test_axis_follows_the_hand_wheel() -> None:
    card = VirtualCard()
    card.mcc.MPG_set(1, 7, 2.5)
    for counts in (0, 40, 100, 300):
        card.set_encoder(7, counts)
        moved = card.run(0.2)
    assert moved.pulses[1] == 750 and moved.status == mcc.WHEEL
    card.mcc.MPG_disable()
    assert card.run_until_stop().status == mcc.STOPPED
    with pytest.raises(InputError, match=r"6 \.\. 8"):
        card.set_encoder(0, 1)


def test_homing_finds_switch_and_index() -> None:
    card = VirtualCard(home_order=[1, 0, 0, 0, 0, 0], home_offset=2.0)
    with pytest.raises(MccError, match="HOME_COMMAND_NOTCALLED"):
        card.mcc.check_homef()
    card.mcc.go_home([1, 0, 0, 0, 0, 0])
    while not card.mcc.check_homef():
        reading = card.run(0.001)
        card.set_switches("home", *([0] if reading.table[0] < -25.0 else []))
        assert reading.time < 20
    # the first index beyond the switch at -25 mm is at -20 mm
    assert card.read().table[0] == pytest.approx(-18.0, abs=1e-3)
    assert card.mcc.get_cpos()[0] == 0.0
    with pytest.raises(InputError, match="home_low_speed = 0, home_order = 1"):
        VirtualCard(home_low_speed=0, home_order=1)


def test_compensation_is_in_the_pulses_only() -> None:
    card = VirtualCard()
    card.mcc.set_comp(0, 1000, 0, [0, 3, 7], [0, 5, 9])
    card.mcc.line_x(2)
    end = card.run_until_stop()
    assert end.pulses[0] == 2007 and end.position[0] == 2.0
    card.mcc.line_x(1)
    assert card.run_until_stop().pulses[0] == 1005
    card.mcc.set_comp(0, 0, 0, [0])
    assert card.run_until_stop().pulses[0] == 1000
    with pytest.raises(MccError, match="PARAMETER"):
        card.mcc.set_comp(0, 1000, 300, [0])
    with pytest.raises(InputError, match="forward"):
        card.mcc.set_comp(0, 1000, 0, [0] * 257)
    for rows in ((), ([],), (5,), ([0], 5), ([0], [])):
        with pytest.raises(InputError, match="one or two lists of pulses wanted"):
            card.mcc.set_comp(0, 1000, 0, *rows)


def test_dry_run_puts_out_no_pulse() -> None:
    card = VirtualCard()
    assert card.mcc.check_dry_run() == 1
    card.mcc.enable_dry_run()
    assert card.mcc.check_dry_run() == 0
    card.mcc.line_x(3)
    end = card.run_until_stop()
    assert end.position[0] == 3.0 and end.pulses[0] == 0
    card.mcc.disable_dry_run()
    assert card.read().position[0] == 0.0


def test_axis_parameters_become_effective_or_none_does() -> None:
    card = VirtualCard()
    card.mcc.update_param(pitch=[5, 10, 10, 10, 10, 10], cart_max_speed=50.0)
    card.mcc.line_x(1)
    assert card.run_until_stop().pulses[0] == 2000
    for values in ({"pitch": 4, "PPR": 0}, {"cart_max_speed": 1.0}):
        with pytest.raises(MccError):
            card.mcc.update_param(**values)
    with pytest.raises(InputError, match="did you mean 'pitch'"):
        card.mcc.update_param(pitsch=4)
    card.mcc.update_param()
    card.mcc.line_x(2)
    assert card.run_until_stop().pulses[0] == 4000


def test_single_block_waits_for_leave() -> None:
    card = VirtualCard()
    card.mcc.task_set_single_block(True)
    card.mcc.line_x(1)
    card.mcc.line_x(2)
    reading = card.run(1.0)
    while reading.status == mcc.BLOCK:
        card.mcc.task_continue()
        reading = card.run(1.0)
    assert reading.stopped and reading.pulses[0] == 2000


def test_limits_and_position_reached_can_be_set_and_read() -> None:
    card = VirtualCard(high_limit=5.0, low_limit=-5.0)
    assert card.mcc.get_check_OT() == [0] * 6
    card.mcc.set_check_OT([1, 0, 0, 0, 0, 0])
    assert card.mcc.get_check_OT() == [1, 0, 0, 0, 0, 0]
    with pytest.raises(MccError, match="PARAMETER"):
        card.mcc.line_x(5.001)
    card.mcc.set_max_dda_acc([50] * 6)
    card.mcc.set_inpos_tol([0.1, 0.2, 0.3, 0.1, 0.1, 0.1])
    assert card.mcc.get_max_dda_acc() == [50] * 6
    assert card.mcc.get_inpos_tol()[:3] == [0.1, 0.2, 0.3]
    card.mcc.enable_in_pos(3)
    card.mcc.disable_in_pos(2)
    card.mcc.line_x(5)
    assert card.run_until_stop().pulses[0] == 5000
    card.run(0.1)
    assert card.mcc.check_in_pos()[:3] == [1, 1, 1]


def test_emergency_stop_ends_with_an_error_and_the_true_position() -> None:
    card = VirtualCard()
    card.mcc.line_x(50)
    card.run(1.0)
    card.set_stop(True)
    stopped = card.run(0.5)
    assert stopped.error == 0xF102 and 5000 < stopped.pulses[0] < 15_000
    with pytest.raises(MccError, match="RUN_TIME"):
        card.mcc.clear_error()
    card.set_stop(False)
    card.run(0.5)
    card.mcc.clear_error()
    assert round(card.read().position[0] * 1000) == stopped.pulses[0]
    card.mcc.line_x(0)
    assert card.run_until_stop().pulses[0] == 0
