"""What is told of a controller's program and channel, by samples of its outputs."""

from collections.abc import Iterator, Sequence
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import pytest

from motionfmu.live.opcua.channel_watch import (
    ChannelMode,
    ChannelSample,
    ChannelState,
    ChannelWatch,
    ProgramState,
    way,
)
from motionfmu.live.opcua.controller_channel import words
from motionfmu.live.panel import panel_of
from motionfmu.scenarios import fmus

ROOT = Path(__file__).resolve().parents[2]
P, S, M = ProgramState, ChannelState, ChannelMode
# What can follow what, after OPC 40501-1, 8.4.8.
ALLOWED = {
    (P.Initializing, P.Running),
    (P.Initializing, P.Aborted),
    (P.Running, P.Ended),
    (P.Running, P.Interrupted),
    (P.Running, P.Aborted),
    (P.Interrupted, P.Running),
    (P.Interrupted, P.Aborted),
    (P.Ended, P.Initializing),
    (P.Aborted, P.Initializing),
}
Action = tuple[str, Sequence[Any]]
# Time, value of state, alarm, actions; then mode, state of the channel and of the program.
Row = tuple[float, int, int, list[Action], ChannelMode, ChannelState, ProgramState]
RUN, REST, HOLD = 0, 1, 2  # status of the library
MILL: dict[str, list[Row]] = {
    "a program with a hold, and once more": [
        (0.0, REST, 0, [], M.Automatic, S.Reset, P.Initializing),
        (0.1, RUN, 0, [], M.Automatic, S.Active, P.Running),
        (0.2, HOLD, 0, [("hold", [True])], M.Automatic, S.Interrupted, P.Interrupted),
        (0.3, RUN, 0, [("hold", [False])], M.Automatic, S.Active, P.Running),
        (0.4, REST, 0, [], M.Automatic, S.Reset, P.Ended),
        (0.5, REST, 0, [], M.Automatic, S.Reset, P.Ended),
        (0.6, RUN, 0, [("cycle_start", [True])], M.Automatic, S.Active, P.Running),
    ],
    "motion by hand is no program": [
        (0.1, RUN, 0, [("jog", [0, 1, 0])], M.JogManual, S.Active, P.Initializing),
        (0.2, RUN, 0, [("jog", [0, 0, 0])], M.JogManual, S.Active, P.Initializing),
        (0.3, REST, 0, [], M.JogManual, S.Reset, P.Initializing),
        (0.4, RUN, 0, [("go_home", [True])], M.Reference, S.Active, P.Initializing),
        (0.5, REST, 0, [("go_home", [False])], M.Reference, S.Reset, P.Initializing),
        (0.6, RUN, 0, [("cycle_start", [True])], M.Automatic, S.Active, P.Running),
        (0.7, RUN, 0, [("jog", [1, 0, 0])], M.Automatic, S.Active, P.Running),
        (0.8, REST, 0, [], M.Automatic, S.Reset, P.Ended),
        (0.9, 5, 0, [("mpg_axis", [1])], M.JogManual, S.Active, P.Ended),
        (1.0, RUN, 0, [("mpg_axis", [0])], M.JogManual, S.Active, P.Ended),
    ],
    "an alarm ends a program, which is there again when it has gone": [
        (0.1, RUN, 0, [], M.Automatic, S.Active, P.Running),
        (0.2, REST, 63489, [], M.Automatic, S.Reset, P.Aborted),
        (0.3, REST, 0, [("clear_error", [True])], M.Automatic, S.Reset, P.Initializing),
        (0.4, REST, 61698, [], M.Automatic, S.Reset, P.Initializing),
        (0.5, REST, 0, [], M.Automatic, S.Reset, P.Initializing),
    ],
    "an abort ends it for good": [
        (0.1, RUN, 0, [], M.Automatic, S.Active, P.Running),
        (0.2, RUN, 0, [("abort", [True])], M.Automatic, S.Active, P.Running),
        (0.3, REST, 0, [("abort", [False])], M.Automatic, S.Reset, P.Aborted),
        (0.4, REST, 0, [], M.Automatic, S.Reset, P.Aborted),
        (0.5, RUN, 0, [("cycle_start", [True])], M.Automatic, S.Active, P.Running),
        (0.6, REST, 0, [], M.Automatic, S.Reset, P.Ended),
    ],
    "taken back in time": [
        (5.0, RUN, 0, [("jog", [1])], M.JogManual, S.Active, P.Initializing),
        (1.0, RUN, 0, [], M.Automatic, S.Active, P.Running),
        (1.1, REST, 0, [], M.Automatic, S.Reset, P.Ended),
        (0.5, REST, 0, [], M.Automatic, S.Reset, P.Ended),
    ],
}


@pytest.mark.parametrize("name", MILL)
def test_the_library_tells_its_program(name: str) -> None:
    panel = panel_of("mcc")
    assert panel is not None and panel.monitor is not None
    watch = ChannelWatch(panel.monitor)
    for time, state, code, actions, *expected in MILL[name]:
        watch.look(ChannelSample(time, state, code, actions=actions))
        assert [watch.mode, watch.state, watch.program] == expected, time
        assert watch.fault == (code != 0)


def seen(fmu: str, states: list[int]) -> Iterator[tuple[ChannelMode, ChannelState, ProgramState]]:
    panel = panel_of(fmu)
    assert panel is not None and panel.monitor is not None
    watch = ChannelWatch(panel.monitor)
    for k, state in enumerate(states):
        watch.look(ChannelSample(0.1 * k, state))
        yield watch.mode, watch.state, watch.program


def test_other_controllers_tell_theirs() -> None:
    # idle, running, hold, jog while it is held, running, waiting, the card has stopped, idle
    assert list(seen("soft_controller", [0, 1, 2, 6, 2, 1, 3, 8, 0])) == [
        (M.Automatic, S.Reset, P.Initializing),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Interrupted, P.Interrupted),
        (M.JogManual, S.Active, P.Interrupted),
        (M.Automatic, S.Interrupted, P.Interrupted),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Reset, P.Aborted),
        (M.Automatic, S.Reset, P.Initializing),
    ]
    # unhomed, search, accelerate before it was seen to rest, decelerate, ready, fault
    assert list(seen("msp430_positioner", [0, 2, 5, 7, 4, 8])) == [
        (M.Automatic, S.Reset, P.Initializing),
        (M.Reference, S.Active, P.Initializing),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Reset, P.Ended),
        (M.Automatic, S.Reset, P.Ended),
    ]
    # ready, homing, ready, running, pausing, paused, running, stopping, ready
    assert list(seen("network_card", [1, 6, 1, 2, 3, 4, 2, 5, 1])) == [
        (M.Automatic, S.Reset, P.Initializing),
        (M.Reference, S.Active, P.Initializing),
        (M.Reference, S.Reset, P.Initializing),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Interrupted, P.Interrupted),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Active, P.Running),
        (M.Automatic, S.Reset, P.Aborted),
    ]


def test_increments_are_another_mode() -> None:
    panel = panel_of("mcc")
    assert panel is not None and panel.monitor is not None
    watch = ChannelWatch(panel.monitor)
    watch.look(ChannelSample(0.1, RUN, increment=True, actions=[("jog", [1])]))
    assert watch.mode is M.JogIncrement


def test_run_time_is_that_of_the_program_alone() -> None:
    panel = panel_of("mcc")
    assert panel is not None and panel.monitor is not None
    watch = ChannelWatch(panel.monitor)
    times = []
    for time, state in ((1.0, REST), (2.0, RUN), (3.5, RUN), (4.0, HOLD), (9.0, RUN), (9.25, RUN)):
        watch.look(ChannelSample(time, state))
        times.append(watch.run_time)
    assert times == [0.0, 0.0, 1.5, 1.5, 1.5, 1.75]
    for time, state in ((10.0, REST), (11.0, RUN), (11.5, RUN)):
        watch.look(ChannelSample(time, state))
    assert watch.run_time == 0.5


def test_a_program_goes_no_way_that_the_specification_has_not() -> None:
    for begin, end in product(P, P):
        steps = [begin, *way(begin, end)]
        assert steps[-1] is end and set(pairwise(steps)) <= ALLOWED
    assert way(P.Running, P.Running) == []


@pytest.mark.parametrize(
    "fmu",
    sorted(p.parent.name for p in ROOT.glob("fmus/*/panel.toml") if "[monitor]" in p.read_text()),
)
def test_states_of_a_monitor_are_those_of_its_variable(fmu: str) -> None:
    panel = panel_of(fmu)
    assert panel is not None and panel.monitor is not None and panel.state is not None
    monitor, meant = panel.monitor, words(fmu, panel.state)
    lists = (monitor.running, monitor.interrupted, monitor.aborting, monitor.fault)
    told = [s for states in (*lists, *monitor.by_hand.values()) for s in states]
    assert len(told) == len(set(told)) and set(told) <= set(meant)
    ports = fmus.ports(fmu)
    for name in (monitor.feed, monitor.rapid, monitor.spindle):
        assert name is None or (ports[name].type == "Float64" and ports[name].count == 1)


def test_words_of_values() -> None:
    assert words("mcc", "error")[63489] == "following error of axis 1"
    assert words("mcc", "status")[1] == "stopped (no stock)"
    assert words("network_card", "task")[-1] == "none yet"
    assert words("mcc", "position") == {}
