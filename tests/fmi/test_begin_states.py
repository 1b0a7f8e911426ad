"""Every FMU found: begin_state names a serialized state in which an instance begins."""

from pathlib import Path

import pytest
from few_cases import few
from fmi_tools import ERROR, OK, Instance, random_inputs, run, start_values

from motionfmu.scenarios.fmus import fmu_names

STEP = 1e-3  # [s]
COUNT = 5


@pytest.mark.parametrize("fmi", (2, 3))
@pytest.mark.parametrize("name", fmu_names())
def test_it_goes_on_with_the_same_bits_at_any_start_time(
    name: str, fmi: int, tmp_path: Path
) -> None:
    values = start_values(name, tmp_path)
    one = Instance(name, 5 - fmi).initialize(values)  # the state is the other version's
    inputs = random_inputs(one, 5, 2 * COUNT)
    run(one, inputs[:COUNT], STEP)
    file = tmp_path / "one.state"
    file.write_bytes(one.serialize(one.save()))
    other = Instance(name, fmi)
    for key, value in {**values, "begin_state": str(file)}.items():
        assert other.set(key, value) == OK, other.said
    assert other.enter(start=3.0) == OK  # its time of the state
    begun = other.outputs()
    assert other.call("ExitInitializationMode") == OK, other.said
    assert repr(begun) == repr(other.outputs()) == repr(one.outputs())
    assert run(one, inputs[COUNT:], STEP) == run(other, inputs[COUNT:], STEP)
    assert other.get("begin_state") == [str(file).encode()]
    one.free()
    other.free()


@pytest.mark.parametrize("fmi", (2, 3))
def test_what_is_no_state_of_it_is_refused_and_another_one_then_works(
    fmi: int, tmp_path: Path
) -> None:
    def saved(values: dict[str, object]) -> bytes:
        one = Instance("velocity_axes", fmi).initialize(values)
        assert one.step(STEP) == OK
        return one.serialize(one.save())

    good, other = saved({}), saved({"tau": 0.07})
    rest = Instance("velocity_axes", fmi)
    assert rest.enter() == OK
    early, drives = rest.serialize(rest.save()), Instance("servo_drives", fmi).initialize({})
    flipped = bytearray(good)
    flipped[len(good) // 2] ^= 1
    file = tmp_path / "its.state"
    for data, words in (
        (b"", "too short"),
        (good[:-8], "its size is another one"),
        (good + b"x", "its size is another one"),
        (bytes(flipped), "its bytes have changed"),
        (drives.serialize(drives.save()), "the state is not one of VelocityAxes"),
        (early, "not saved between two steps"),
        (other, "tau, element 1, = "),
    ):
        file.write_bytes(data)
        instance = Instance("velocity_axes", fmi)
        assert instance.set("begin_state", str(file)) == OK
        assert instance.enter() == OK
        assert instance.call("ExitInitializationMode") == ERROR
        assert words in instance.said, instance.said
        file.write_bytes(good)
        assert instance.call("ExitInitializationMode") == OK, instance.said
        instance.free()
    missing = Instance("velocity_axes", fmi)
    assert missing.set("begin_state", str(tmp_path / "none")) == OK and missing.enter() == OK
    assert missing.call("ExitInitializationMode") == ERROR and "No such file" in missing.said


@pytest.mark.parametrize("fmi", few((2, 3), 1))
def test_reset_and_another_experiment_begin_at_rest_again(fmi: int, tmp_path: Path) -> None:
    """The state is a parameter's, and goes with it."""
    one = Instance("velocity_axes", fmi).initialize({})
    inputs = random_inputs(one, 1, 2 * COUNT)
    at_rest = run(one, inputs[:COUNT], STEP)
    file = tmp_path / "one.state"
    file.write_bytes(one.serialize(one.save()))
    again = Instance("velocity_axes", fmi).initialize({"begin_state": str(file)})
    later = run(again, inputs[:COUNT], STEP)
    assert later != at_rest
    assert again.call("Reset") == OK
    again.initialize({})
    assert run(again, inputs[:COUNT], STEP) == at_rest
