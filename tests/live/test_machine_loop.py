"""What an operator holds, types and asks, by a clock that the test turns."""

import inspect
import json
import math
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.live import LiveMachine, Pace
from motionfmu.live.machine_loop import LoopRequest, MachineLoop
from motionfmu.live.serving.request_table import REQUESTS, checked, openapi, parsed


class Wall:
    """A clock that goes on while somebody sleeps."""

    def __init__(self) -> None:
        self.now = 100.0

    def sleep(self, seconds: float) -> None:
        self.now += seconds


class Bench:
    """A loop whose requests are answered in this thread."""

    def __init__(self, machine: LiveMachine, factor: float = 1.0) -> None:
        self.wall = Wall()
        pace = Pace(factor, lambda: self.wall.now, self.wall.sleep)
        self.machine, self.told = machine, []  # type: tuple[LiveMachine, list[Any]]
        self.loop = MachineLoop(machine, pace, tell=lambda *told: self.told.append(told))

    def ask(self, request: str, /, **arguments: Any) -> Any:
        answers: list[Any] = []
        asked = checked(request, arguments)
        self.loop.asked.put(
            LoopRequest(
                asked.name, asked.arguments, lambda value, error: answers.append((value, error))
            )
        )
        self.loop._answer(wait=False)
        while not answers and self.loop._goal is not None:
            self.loop._turn()
        ((value, error),) = answers
        if error is not None:
            raise InputError(error)
        return value

    def turns(self, seconds: float) -> None:
        end = self.wall.now + seconds
        while self.wall.now < end - 1e-9:
            self.loop._turn()


@pytest.fixture
def bench() -> Iterator[Bench]:
    with LiveMachine("circle") as machine:
        yield Bench(machine)


@pytest.mark.parametrize("factor", [0.1, 1.0, 20.0])
def test_a_lost_hand_stops_a_jog_within_a_tenth_of_a_second_on_the_wall(factor: float) -> None:
    with LiveMachine("circle") as machine:
        bench = Bench(machine, factor)
        bench.turns(0.05)
        begun = bench.wall.now
        for _ in range(5):  # signs keep it
            bench.ask("jog", component="mcc", axis=2, direction=-1)
            bench.turns(0.04)
            assert machine["mcc.jog[2]"] == -1
        last = bench.wall.now - 0.04
        while machine["mcc.jog[2]"]:
            bench.loop._turn()
        assert bench.wall.now - begun > 0.2 and bench.wall.now - last <= 0.1 + 2e-3
        actions = [(a.name, a.values) for a in machine.journal]
        assert actions == [("mcc.jog", (0, -1, 0, 0, 0, 0)), ("mcc.jog", (0, 0, 0, 0, 0, 0))]
        held = [a.step * 1e-4 for a in machine.journal]
        assert held[1] - held[0] <= factor * (0.16 + 0.1) + 1e-3


def test_as_fast_as_it_goes_the_wall_alone_counts(bench: Bench) -> None:
    bench.ask("pace", factor=None)
    bench.ask("hold", name="mcc.hold", value=True, rest=False)
    bench.loop.advance(5000)
    assert bench.machine["mcc.hold"]
    bench.wall.now += 0.11
    bench.loop.advance(1)
    assert not bench.machine["mcc.hold"]


def test_a_pause_holds_nothing(bench: Bench) -> None:
    bench.ask("jog", component="mcc", axis=1, direction=1)
    bench.ask("pause")
    bench.wall.now += 5.0
    bench.ask("step", count=3)
    assert bench.machine["mcc.jog[1]"] == 0 and bench.machine.steps == 3


def test_jog_names_what_is_wrong_and_zero_lets_go(bench: Bench) -> None:
    bench.ask("jog", component="mcc", axis=1, direction=1)
    bench.ask("jog", component="mcc", axis=1, direction=0)
    assert bench.machine["mcc.jog[1]"] == 0
    for given, told in (
        ({"component": "mc", "axis": 1}, "mc: no such component; did you mean 'mcc'"),
        ({"component": "machine", "axis": 1}, "machine: it"),
        ({"component": "mcc", "axis": 7}, r"mcc\.jog: axis 7: it has 1 to 6"),
        ({"component": "mcc", "axis": 0}, r"mcc\.jog: axis 0: it has 1 to 6"),
    ):
        with pytest.raises(InputError, match=told):
            bench.ask("jog", direction=1, **given)
    with pytest.raises(InputError, match=r"mcc\.jog\[1\] = 0\.5: -1, 0 or 1 wanted"):
        bench.ask("jog", component="mcc", axis=1, direction=0.5)


def test_a_press_is_ten_milliseconds(bench: Bench) -> None:
    bench.loop.advance(10)
    bench.ask("press", name="mcc.clear_error")
    bench.loop.advance(500)
    steps = [(a.step, a.values) for a in bench.machine.journal]
    assert steps == [(10, (True,)), (110, (False,))]


def test_what_would_not_go_to_rest_is_not_held(bench: Bench) -> None:
    with pytest.raises(InputError, match=r"mcc\.hold = 0: Boolean wanted"):
        bench.ask("hold", name="mcc.hold", value=True)
    bench.loop.advance(2000)
    assert not bench.loop.error and not len(bench.machine.journal)


def test_single_steps_are_answered_when_they_are_made_and_a_pause_ends_them(bench: Bench) -> None:
    with pytest.raises(InputError, match="it runs: pause it first"):
        bench.ask("step")
    bench.ask("pause")
    assert bench.ask("step", count=5000) == pytest.approx(0.5)
    answers: list[Any] = []
    many = LoopRequest("step", {"count": 10**12}, lambda *answer: answers.append(answer))
    bench.loop.asked.put(many)
    bench.loop._answer(wait=False)
    bench.loop._turn()
    assert not answers
    bench.ask("pause")
    assert answers == [(bench.machine.time, None)] and bench.loop._goal is None


def test_undo_and_what_has_changed(bench: Bench) -> None:
    bench.ask("set", name="machine.force[2]", value=150.0)
    bench.ask("set", name="mcc.hold", value=True)
    assert bench.ask("changed") == {
        "machine.force": [[0.0] * 6, [0.0, 150.0, 0.0, 0.0, 0.0, 0.0]],
        "mcc.hold": [[False], [True]],
    }
    bench.ask("undo", name="machine.force")
    assert bench.ask("changed") == {"mcc.hold": [[False], [True]]}
    with pytest.raises(InputError, match=r"machine\.lead cannot be set"):
        bench.ask("undo", name="machine.lead")


def test_stop_is_for_everything_that_has_one(bench: Bench) -> None:
    bench.ask("jog", component="mcc", axis=1, direction=1)
    stopped = bench.ask("stop")
    assert stopped and all(bench.machine[name] for name in stopped)
    assert bench.machine["mcc.jog[1]"] == 0


def slide(**more: Any) -> Bench:
    plan = motionfmu.run.scenario({"machine": "hydraulic_slide", "stop": 1.0, **more})
    return Bench(LiveMachine(plan))


def test_a_press_lasts_as_long_as_its_panel_says_and_is_not_taken_for_bouncing() -> None:
    bench = slide()
    with bench.machine as machine:
        bench.turns(0.1)
        bench.ask("press", name="controller.pb1")
        bench.turns(0.099)
        assert machine["controller.pb1"]
        bench.turns(0.003)
        assert not machine["controller.pb1"]
        assert machine["controller.state"] == 2  # it searches its home switch


@pytest.mark.parametrize(("clears", "code"), [(0, 7), (1, 0)])
def test_the_listing_may_lose_the_edge_of_the_home_switch(clears: int, code: int) -> None:
    """As written it clears every flag; the repaired one finds the switch from the same start."""
    start = {"axis.start_position": -0.0299909, "controller.flag_clear": clears}
    with slide(set=start).machine as machine:
        machine.step(1000)
        machine.set("controller.pb1", True)
        machine.step(1000)
        machine.set("controller.pb1", False)
        machine.step(50_000)
        assert machine["controller.code"] == code
        assert machine["controller.homed"] == (code == 0)


def test_a_stop_by_a_key_of_several_uses_is_pressed_in_motion_alone() -> None:
    bench = slide()
    with bench.machine as machine:
        bench.turns(0.1)
        assert bench.ask("stop") == []
        bench.turns(0.3)
        assert machine["controller.state"] == 0
        assert abs(machine["axis.table_speed"]) < 1e-9
        bench.ask("press", name="controller.pb1")
        bench.turns(0.5)
        assert machine["controller.state"] == 2
        assert bench.ask("stop") == ["controller.pb1"]
        bench.turns(0.3)
        assert machine["controller.state"] == 0
        assert abs(machine["axis.table_speed"]) < 1e-3


def test_a_fault_of_an_fmu_stands_the_machine_until_it_goes_back(bench: Bench) -> None:
    bench.loop.advance(100)
    bench.ask("set", name="machine.force[1]", value=1e18)
    bench.loop.advance(1000)
    assert "more counts" in bench.loop.error and not bench.loop.running
    for request in ("go", "step"):
        with pytest.raises(InputError, match="go back to an earlier state"):
            bench.ask(request)
    assert bench.ask("back", time=1.0) == 0.0
    bench.ask("go")
    bench.loop.advance(1000)
    assert not bench.loop.error and bench.machine.steps == 1000


def test_a_mistake_of_the_loop_is_an_answer(bench: Bench, capfd: Any) -> None:
    bench.loop.do_kept = lambda: 1 / 0  # type: ignore[method-assign]
    with pytest.raises(InputError, match="kept: ZeroDivisionError"):
        bench.ask("kept")
    assert bench.ask("frame")["steps"] == 0


def test_lines_go_to_the_controller_one_by_one(tmp_path: Path) -> None:
    with LiveMachine(motionfmu.machine("xy_table").plan()) as machine:
        bench = Bench(machine)
        bench.turns(0.3)
        numbers = [bench.ask("mdi", line=f"G1 F6000 X{k % 3}")["number"] for k in range(30)]
        assert numbers == [*range(1, 31)]
        assert bench.ask("frame")["lines"] == 30
        with pytest.raises(InputError, match="without CR"):
            bench.ask("mdi", line="G0 X1\r\nG0 X2")
        with pytest.raises(InputError, match=r"mcc\.mdi = .*less than"):
            bench.ask("mdi", line="(" + "x" * 2000)
        with pytest.raises(InputError, match="drives: it"):
            bench.ask("mdi", line="G0", component="drives")
        for _ in range(3000):
            bench.turns(0.01)
            if machine["mcc.mdi_done"] == 30:
                break
        assert machine["mcc.mdi_done"] == machine["mcc.mdi_lines"] == 30
        assert bench.ask("frame")["lines"] == 0
        assert machine["mcc.position[1]"] == pytest.approx(29 % 3, abs=1e-3)
        there = machine["machine.table_position"]
        machine.step()
        machine.save(tmp_path / "typed")
    result = motionfmu.load(tmp_path / "typed").run()
    assert result["machine.table_position"][-1].tobytes() == there.tobytes()


def test_an_abort_drops_the_lines_that_wait() -> None:
    with LiveMachine(motionfmu.machine("xy_table").plan()) as machine:
        bench = Bench(machine)
        bench.turns(0.3)
        for _ in range(40):
            bench.ask("mdi", line="G1 F600 X100")
        bench.ask("press", name="mcc.abort")
        assert bench.ask("frame")["lines"] == 0
        with pytest.raises(InputError, match="256 lines wait"):
            for _ in range(257):
                bench.ask("mdi", line="G0 X0")


def test_every_request_is_a_method_with_these_arguments() -> None:
    methods = {n.removeprefix("do_") for n in dir(MachineLoop) if n.startswith("do_")}
    own = {name for name, kind in REQUESTS.items() if not kind.server}
    assert methods - own <= {"end", "part", "samples", "recording"} and own <= methods
    for name in own - {"trigger"}:
        parameters = inspect.signature(getattr(MachineLoop, f"do_{name}")).parameters
        fields = REQUESTS[name].model_fields
        assert set(fields) == set(parameters) - {"self"}, name
        for argument, field in fields.items():
            needed = parameters[argument].default is inspect.Parameter.empty
            # a list that is left out is empty
            assert field.is_required() == needed, (name, argument)


@pytest.mark.parametrize(
    ("name", "given", "told"),
    [
        ("jogg", {}, "'jogg': no such request; did you mean 'jog'"),
        (["a"], {}, "no such request"),
        ("set", [], "set: arguments are a JSON object"),
        ("set", {"name": "a"}, "set: value is missing"),
        ("set", {"name": "a", "value": 1, "valu": 2}, "there is no argument valu; did you mean"),
        ("set", {"name": "a", "value": 10**1000}, "a finite number, true, false or a text"),
        ("set", {"name": "a", "value": 10**5000}, "set: value = such a number"),
        ("set", {"name": "a", "value": math.inf}, "a finite number, true, false or a text"),
        ("set", {"name": "a", "value": [1, [2]]}, "a finite number, true, false or a text"),
        ("pace", {"factor": "fast"}, 'pace: factor = "fast": a valid number wanted'),
        ("step", {"count": -1}, "step: count = -1: greater than or equal to 0 wanted"),
        ("step", {"count": True}, "step: count = true: a valid integer wanted"),
        ("trigger", {"channel": "a", "kind": "up"}, "'rise', 'fall', 'either'"),
        ("trigger", {"channel": "a", "length": 10**9}, "less than or equal to"),
    ],
)
def test_a_wrong_request_is_told(name: Any, given: Any, told: str) -> None:
    with pytest.raises(InputError) as error:
        checked(name, given)
    assert told in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    "text", ["", "{", "[" * 60000, "NaN", '{"a": Infinity}', "1" * 5000, '"\\ud800', "\x00"]
)
def test_a_text_that_is_no_json_is_told(text: str) -> None:
    with pytest.raises(InputError, match="no JSON"):
        parsed(text)


def test_brackets_in_texts_are_not_nested() -> None:
    line = "G1 X[" * 300 + '\\"'
    text = json.dumps({"line": line, "rows": [[1], [{"a": []}]] * 40})
    assert parsed(text) == {"line": line, "rows": [[1], [{"a": []}]] * 40}
    deep = "[" * 32 + "]" * 32
    assert isinstance(parsed(deep), list)
    with pytest.raises(InputError, match="no JSON"):
        parsed(f"[{deep}]")


def test_the_documentation_has_every_request() -> None:
    document = openapi("1")
    told = {p.removeprefix("/do/") for p in document["paths"]} | set(document["x-websocket"])
    assert set(REQUESTS) <= told
    schema = document["components"]["schemas"]["jog"]
    assert set(schema["required"]) == {"component", "axis", "direction"}
    for path, operations in document["paths"].items():
        for operation in operations.values():
            assert operation["description"], path


def test_the_loop_ends_from_another_thread() -> None:
    with LiveMachine("circle") as machine:
        loop = MachineLoop(machine, Pace(math.inf))
        thread = threading.Thread(target=loop.run)
        thread.start()
        loop.asked.put(LoopRequest("end", {}, lambda value, error: None))
        thread.join(20)
        assert not thread.is_alive()


@pytest.mark.parametrize("name", ["pause", "back"])
def test_nothing_moves_once_a_pause_is_answered(bench: Bench, name: str) -> None:
    """As fast as it goes, where a turn more would be a thousand steps."""
    loop, machine = bench.loop, bench.machine
    loop.pace.set(math.inf)
    bench.turns(0.0)
    loop.advance(25_000)
    stood = []

    def answered(value: object, error: str | None) -> None:
        stood.append(machine.steps)
        end = LoopRequest("end", {}, lambda value, error: None)
        threading.Timer(0.2, loop.asked.put, (end,)).start()

    arguments = {"time": 1.5} if name == "back" else {}
    loop.asked.put(LoopRequest(name, arguments, answered))
    loop.run()
    assert [machine.steps] == stood == [10_000 if name == "back" else 25_000]
