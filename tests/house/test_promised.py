"""What a version has promised is there in the next one: docs/stability.md."""

import copy
import tomllib

import pytest
from conftest import ROOT
from promised_surface import Surface, missing, surface, written

LIST = ROOT / "tests/house/promised.toml"


@pytest.fixture(scope="module")
def there() -> Surface:
    return surface()


def test_all_that_was_promised_is_there(there: Surface) -> None:
    """Who takes a name away takes it out of the list, and puts a row into CHANGELOG.md."""
    promised = tomllib.loads(LIST.read_text())
    assert missing(promised, there) == []
    assert {"fmu", "command", "file", "python"} == promised.keys()
    assert sum(len(n) for rows in promised["fmu"].values() for n in rows.values()) > 1000


@pytest.mark.parametrize(
    ("kind", "place", "said", "name"),
    [
        ("fmu", "mcc", "output Float64[6] mm", "position"),
        ("command", "run", "options", "--set"),
        ("file", "scenario.toml", "keys", "drive.at"),
        ("python", "motionfmu.virtual.mcc", "names", "VirtualCard"),
    ],
)
def test_a_name_that_goes_is_told(there: Surface, kind, place, said, name) -> None:
    less = copy.deepcopy(there)
    less[kind][place][said].remove(name)
    assert missing(there, less) == [f"{kind} {place}: {name} ({said})"]
    assert missing(less, there) == [], "a new one is not"


def test_a_variable_with_another_unit_is_told(there: Surface) -> None:
    other = copy.deepcopy(there)
    other["fmu"]["mcc"]["output Float64[6] m"] = other["fmu"]["mcc"].pop("output Float64[6] mm")
    assert "fmu mcc: position (output Float64[6] mm)" in missing(there, other)


def test_the_list_is_written_as_it_is_read(there: Surface) -> None:
    text = written(there)
    assert tomllib.loads(text) == there
    assert max(map(len, text.splitlines())) <= 100
