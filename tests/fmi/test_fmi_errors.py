"""Every FMU found: what is refused, with which status and words, and that it changes nothing."""

import ctypes
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from few_cases import few
from fmi_tools import ERROR, OK, Instance, Variable, start_values, unpacked

from motionfmu.scenarios.fmus import fmu_names

every_fmu = pytest.mark.parametrize("name", fmu_names())
both = pytest.mark.parametrize("fmi", (2, 3))
Act = Callable[[Instance], int]
STEP = 1e-3  # [s]


def go(instance: Instance, *calls: str) -> None:
    """Make these calls, which must succeed."""
    for call in calls:
        if call == "enter":
            status = instance.enter()
        elif call == "step":
            status = instance.step(STEP)
        elif call == "strict":
            status = instance.set("strict_step", True)
        else:
            status = instance.call(call)
        assert status == OK, (call, instance.said)


def first(instance: Instance, accept: Callable[[Variable], bool]) -> str:
    return instance.names(accept)[0]


def output(instance: Instance) -> str:
    return first(instance, lambda v: v.causality == "output")


def set_itself(instance: Instance, name: str) -> int:
    """Set a variable to 0, or the least it may be."""
    v = instance.variables[name]
    number = max(v.min or 0.0, 0.0)
    return instance.set(
        name, "" if v.type == "String" else number if v.type == "f64" else int(number)
    )


def set_fixed(instance: Instance) -> int:
    fixed = first(instance, lambda v: v.causality == "parameter" and v.variability == "fixed")
    return set_itself(instance, fixed)


def set_input(instance: Instance) -> int:
    return set_itself(instance, first(instance, lambda v: v.causality == "input"))


INIT, RUN = ("enter",), ("enter", "ExitInitializationMode")
END = (*RUN, "step", "Terminate")
STRICT = ("strict", *RUN)
# What went before; the call that is out of order; words of the one message.
OUT_OF_ORDER: list[tuple[tuple[str, ...], Act, str]] = [
    ((), lambda i: i.step(1e-3), "DoStep is not allowed in Instantiated, only in Step Mode"),
    ((), lambda i: i.call("ExitInitializationMode"), "only in Initialization Mode"),
    ((), lambda i: i.call("Terminate"), "Terminate is not allowed in Instantiated"),
    ((), lambda i: i.status_of_get(output(i)), "has no value before Initialization Mode"),
    ((), lambda i: i.set(output(i), 0), "is an output and cannot be set in Instantiated"),
    (INIT, lambda i: i.enter(), "is not allowed in Initialization Mode, only in Instantiated"),
    (INIT, lambda i: i.step(1e-3), "DoStep is not allowed in Initialization Mode"),
    (INIT, lambda i: i.call("Terminate"), "Terminate is not allowed in Initialization Mode"),
    (INIT, lambda i: i.set(output(i), 0), "is an output and cannot be set"),
    (RUN, lambda i: i.enter(), "is not allowed in Step Mode, only in Instantiated"),
    (RUN, lambda i: i.call("ExitInitializationMode"), "is not allowed in Step Mode"),
    (RUN, set_fixed, "is a fixed parameter and cannot be set in Step Mode"),
    (RUN, lambda i: i.set(output(i), 0), "is an output and cannot be set in Step Mode"),
    (END, lambda i: i.step(1e-3), "DoStep is not allowed in Terminated, only in Step Mode"),
    (END, lambda i: i.call("Terminate"), "Terminate is not allowed in Terminated"),
    (END, lambda i: i.enter(), "is not allowed in Terminated, only in Instantiated"),
    (END, set_input, "is an input and cannot be set in Terminated"),
    (RUN, lambda i: i.step(0.0), "communicationStepSize 0 s is not a positive time"),
    (RUN, lambda i: i.step(-1e-3), "communicationStepSize -0.001 s is not a positive time"),
    (STRICT, lambda i: i.step(0.0), "communicationStepSize 0 s is not a positive whole multiple"),
    (
        STRICT,
        lambda i: i.step(1e-3 + 1e-9),
        "communicationStepSize 0.001000001 s is not a positive",
    ),
    (STRICT, lambda i: i.step(math.nan), "which strict_step asks for"),
    (RUN, lambda i: i.step(math.nan), "communicationStepSize nan s"),
    (RUN, lambda i: i.step(math.inf), "communicationStepSize inf s"),
    (RUN, lambda i: i.step(1e-3, time=0.5), "0.5 s is not where the previous step ended, 0 s"),
    (RUN, lambda i: i.step(1e-3, time=math.nan), "currentCommunicationPoint nan s"),
    (RUN, lambda i: i.step(1e-3, time=math.inf), "currentCommunicationPoint inf s"),
    (RUN, lambda i: i.step(1e-3, time=-math.inf), "currentCommunicationPoint -inf s"),
]


@both
@pytest.mark.parametrize("name", few(fmu_names(), 6))
def test_a_call_out_of_order_is_one_clear_error(name: str, fmi: int, tmp_path: Path) -> None:
    for before, act, words in OUT_OF_ORDER:
        instance = Instance(name, fmi)
        for key, value in start_values(name, tmp_path).items():
            assert instance.set(key, value) == OK
        go(instance, *before)
        count = len(instance.messages)
        assert act(instance) == ERROR, words
        assert len(instance.messages) == count + 1
        status, category, text = instance.messages[-1]
        assert (status, category) == (ERROR, "logStatusError")
        assert words in text
        assert f"fmi{fmi}" in text
        left = {
            (): (*RUN, "step"),
            INIT: ("ExitInitializationMode", "step"),
            RUN: ("step",),
            STRICT: ("step",),
        }
        go(instance, *left.get(before, ("Reset",)))  # the refused call changed nothing
        instance.free()


@both
@every_fmu
def test_bad_numbers_are_refused_and_name_the_variable(name: str, fmi: int) -> None:
    instance = Instance(name, fmi)
    settable = instance.names(lambda v: v.causality in ("parameter", "input"))
    tried = 0
    for key in settable:
        v = instance.variables[key]
        if v.type not in ("f64", "i32"):
            continue
        before = instance.get(key)
        bad: list[tuple[float, str]] = []
        if v.type == "f64":
            bad += [(x, "is not finite") for x in (math.nan, math.inf, -math.inf)]
        unit = 1 if v.type == "i32" else 1.0
        if v.min is not None and v.min > -(2**31):
            bad.append((type(unit)(v.min) - unit, "is below its minimum"))
        if v.max is not None and v.max < 2**31 - 1:
            bad.append((type(unit)(v.max) + unit, "is above its maximum"))
        for value, words in bad:
            values = [*before[:-1], value]  # good elements before a bad one
            assert instance.set(key, values) == ERROR, (key, value)
            which = f" element {v.count} = " if v.count > 1 else " = "
            assert f"{key}{which}" in instance.said
            assert words in instance.said
            assert instance.get(key) == before
            tried += 1
    instance.free()
    assert tried > 0


@both
@every_fmu
def test_strings_and_references(name: str, fmi: int) -> None:
    instance = Instance(name, fmi)
    for key in instance.names(lambda v: v.type == "String"):
        assert instance.set(key, "x" * 1023) == OK
        assert instance.set(key, "x" * 1024) == ERROR
        assert f"{key} is longer than" in instance.said
        assert instance.get(key) == [b"x" * 1023]
    real = "Real" if fmi == 2 else "Float64"
    value, count = (ctypes.c_double * 1)(), () if fmi == 2 else (1,)
    unknown = max(max(v.refs) + v.count for v in instance.variables.values()) + 1
    assert instance.call(f"Get{real}", (ctypes.c_uint32 * 1)(unknown), 1, value, *count) == ERROR
    assert f"unknown value reference {unknown}" in instance.said
    for other in instance.names(lambda v: v.type != "f64")[:1]:
        reference = (ctypes.c_uint32 * 1)(instance.variables[other].refs[0])
        assert instance.call(f"Get{real}", reference, 1, value, *count) == ERROR
        assert f"{other} (value reference {reference[0]}) is " in instance.said
        assert instance.said.endswith("not a real number")
    instance.free()


@every_fmu
def test_array_sizes_are_checked(name: str) -> None:
    instance = Instance(name, 3)
    for v in instance.variables.values():
        if v.type == "f64" and v.causality in ("parameter", "input"):
            values = (ctypes.c_double * (v.count + 1))()
            refs = (ctypes.c_uint32 * 1)(v.refs[0])
            for wrong in (v.count - 1, v.count + 1):
                assert instance.call("GetFloat64", refs, 1, values, wrong) == ERROR
                words = f"nValues is {wrong}, the variables have {v.count}"
                assert words in instance.said
    instance.free()


@both
@every_fmu
def test_tunable_parameters_may_change_while_running(name: str, fmi: int, tmp_path: Path) -> None:
    instance = Instance(name, fmi).initialize(start_values(name, tmp_path))
    tunable = instance.names(lambda v: v.causality == "parameter" and v.variability == "tunable")
    for key in tunable:
        value = instance.get(key)
        assert instance.set(key, value) == OK, instance.said
    assert instance.step(STEP) == OK, instance.said
    instance.free()


@both
@every_fmu
def test_nothing_is_made_from_wrong_arguments(name: str, fmi: int) -> None:
    cases: list[tuple[dict[str, object], str]] = [
        ({"token": "{other}"}, 'the token "{other}" is not that of this FMU'),
        ({"title": ""}, "instanceName is missing"),
    ]
    cases += [({"kind": 0}, "not for model exchange")] if fmi == 2 else []
    cases += [({"event_mode": True}, "has no event mode")] if fmi == 3 else []
    for wrong, words in cases:
        instance = Instance(name, fmi, **wrong)  # type: ignore[arg-type]
        assert not instance.fmu.component
        assert words in instance.said


@both
@every_fmu
def test_states_of_others_are_refused(name: str, fmi: int, tmp_path: Path) -> None:
    instance = Instance(name, fmi).initialize(start_values(name, tmp_path))
    state = instance.save()
    data = instance.serialize(state)
    token = unpacked(name, fmi)[0].guid.encode()
    assert data.count(token) == 1
    for wrong, words in (
        (data[:-1], f"{len(data) - 1} bytes given"),
        (data.replace(token, b"{00000000" + token[9:]), "the state is not one of"),
        (data[:64] + b"9" + data[65:], "the state is not one of this version of"),
        (data[:96] + bytes(8) + data[104:], "the state is not one of this version of"),
    ):
        status, made = instance.deserialize(wrong)
        assert (status, made.value) == (ERROR, None)
        assert words in instance.said
    assert instance.free_state(state) == OK
    assert instance.step(STEP) == OK
    instance.free()


@both
def test_resources_are_found_in_every_form(fmi: int, tmp_path: Path) -> None:
    for form in ("/a", "/a/", "file:///a%20b", "file:/a/", "file://localhost/a", "", "http://x/y"):
        instance = Instance("scope", fmi, resources=form)
        assert instance.fmu.component, form
        instance.free()


@both
def test_a_simulation_does_not_pass_its_stop_time(fmi: int) -> None:
    instance = Instance("scope", fmi)
    assert instance.enter(start=5.0, stop=5.3) == OK
    assert instance.call("ExitInitializationMode") == OK
    for _ in range(3):
        assert instance.step(0.1) == OK, instance.said  # ends at 5.299999999999999
    assert instance.step(0.1) == ERROR
    assert "passes stopTime 5.3 s" in instance.said
    instance.free()
