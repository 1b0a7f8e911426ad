"""Pulses out = commands in, per axis, to the pulse, whatever happens.

Checked by `host_link` at every communication point:

- a transaction is taken once: frames taken and refused by the card are those of the new number;
- the FIFO stock is the frames taken less those begun, within 0 .. 63;
- the pulses put out lie on the sum of the frames begun, never beyond the one in the DDA;
- at the end every frame taken has been put out, and that is where the library says it is.

More: LINK_EXAMPLES=500 pytest tests/cards/test_conservation.py
"""

import os

import pytest
from host_link import AXES, CLOCK, PULSES_PER_MM, Case, Run, execute
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from motionfmu.base.errors import InputError

RUNS = settings(
    max_examples=int(os.environ.get("LINK_EXAMPLES", "12")),
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)

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


@st.composite
def tables(draw: st.DrawFn) -> str:
    """A comp_file for all axes: pitch errors and a backlash each."""
    axes = [f"{a},{draw(st.integers(50, 2000))},{draw(st.integers(0, 12))}" for a in (1, 2, 3)]
    rows = []
    for axis in (1, 2, 3):
        gap = draw(st.integers(-60, 60))
        errors = draw(st.lists(st.integers(-40, 40), min_size=1, max_size=12))
        rows += [f"{axis},{i},{e},{e + gap}" for i, e in enumerate(errors)]
    return "\n".join(["axis,interval,home", *axes, "axis,index,forward,backward", *rows])


@RUNS
@given(
    program=blocks(),
    setting=fifo,
    table=tables(),
    refusals=st.lists(st.integers(0, 16), max_size=2),
)
@pytest.mark.parametrize("stop", [None, "hold", "abort"])
def test_compensation_is_in_the_commands(tmp_path, stop, **drawn) -> None:
    """Balanced at the end; the position told is the one of the program, without correction."""
    text, end = drawn["program"]
    file = tmp_path / "screw.csv"
    file.write_text(drawn["table"])
    acts = [] if stop is None else [(0.1, stop, True), (0.3, stop, False)]
    setting = {**drawn["setting"], "comp_file": str(file)}
    run = execute(Case(text, setting, acts, refusals=(*drawn["refusals"], 0)), tmp_path)
    if stop != "abort":
        assert run.value("mcc", "position")[:AXES] == pytest.approx(end, abs=1e-9)


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
