"""Every FMU found: a serialized state that came back with other bytes is refused whole."""

import random
from pathlib import Path

import pytest
from fmi_tools import ERROR, OK, Instance, start_values

from motionfmu.scenarios.fmus import fmu_names

STEP = 1e-3  # [s]


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
    # Single bits everywhere, the header with its times and flags among them; then whole bytes.
    places = [*range(64, 128), *(chance.randrange(len(data)) for _ in range(150))]
    for n, place in enumerate(places):
        wrong = bytearray(data)
        wrong[place] ^= 1 << chance.randrange(8)
        for _ in range(n % 4):
            wrong[chance.randrange(64, len(data))] = chance.randrange(256)
        if wrong == data:
            continue
        count = len(instance.messages)
        status, made = instance.deserialize(bytes(wrong))
        assert (status, made.value) == (ERROR, None), f"byte {place} of {len(data)}"
        assert len(instance.messages) == count + 1
        assert "the state is" in instance.said
    assert instance.serialize(instance.save()) == data
    assert instance.step(STEP) == OK
    instance.free()
