"""Every FMU found: a serialized state that came back with other bytes is refused whole."""

import random
from pathlib import Path

import pytest
from fmi_tools import ERROR, OK, Instance, start_values

from motionfmu.scenarios.fmus import fmu_names

STEP = 1e-3  # [s]
# [byte] a state's header, and where in it its size stands: token, version, size of struct state.
HEADER, SIZE = 160, 64 + 32 + 8


@pytest.mark.parametrize("fmi", (2, 3))
@pytest.mark.parametrize("name", fmu_names())
def test_a_damaged_state_is_refused_and_changes_nothing(
    name: str, fmi: int, tmp_path: Path
) -> None:
    instance = Instance(name, fmi).initialize(start_values(name, tmp_path))
    assert instance.step(STEP) == OK
    state = instance.save()
    data = instance.serialize(state)
    chance = random.Random(name)

    def refused(wrong: bytes, words: str) -> None:
        count = len(instance.messages)
        status, made = instance.deserialize(wrong)
        assert (status, made.value) == (ERROR, None)
        assert len(instance.messages) == count + 1 and words in instance.said

    # Single bits everywhere, all of the header among them; then whole bytes beside them.
    places = [*range(HEADER), *(chance.randrange(len(data)) for _ in range(150))]
    for n, place in enumerate(places):
        wrong = bytearray(data)
        wrong[place] ^= 1 << chance.randrange(8)
        for _ in range(n % 4):
            wrong[chance.randrange(HEADER, len(data))] = chance.randrange(256)
        size = range(SIZE, SIZE + 8)
        refused(bytes(wrong), "bytes given" if place in size else "the state is")
    for length in (0, 1, HEADER - 1, HEADER, len(data) // 2, len(data) - 8, len(data) - 1):
        refused(data[:length], "bytes given")
    refused(data + bytes(8), "bytes given")
    half = (HEADER + len(data)) // 16 * 8
    refused(data[:HEADER] + data[half:] + data[HEADER:half], "its bytes have changed")
    assert instance.serialize(instance.save()) == data
    assert instance.step(STEP) == OK
    instance.free()


@pytest.mark.parametrize("fmi", (2, 3))
def test_a_robot_does_not_go_on_in_other_jobs(fmi: int, tmp_path: Path) -> None:
    """Its place in a job is a number of an instruction: of another text it would be any."""
    file = tmp_path / "timers.job"
    file.write_text(50 * "TIMER T=0.01\n" + "END\n")
    values = {"program": str(file), "start": True}
    one = Instance("soft_controller", fmi).initialize(values)
    for _ in range(40):
        assert one.step(1e-2) == OK, one.said
    data = one.serialize(one.save())
    same = Instance("soft_controller", fmi).initialize(values)
    assert same.restore(same.deserialize(data)[1], one.time) == OK
    file.write_text("END\n")
    other = Instance("soft_controller", fmi).initialize(values)
    status, state = other.deserialize(data)
    assert status == OK and other.restore(state, one.time) == OK
    assert other.step(1e-2) == ERROR
    assert "program: the state is one of another program" in other.said
    assert same.step(1e-2) == OK and one.step(1e-2) == OK
    assert same.outputs() == one.outputs() and one.get("done") == [False]
