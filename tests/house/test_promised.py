"""What a version has promised is there in the next one: docs/stability.md."""

import copy
import tomllib

import pytest
from conftest import ROOT
from promised_surface import Surface, missing, surface, written

LIST = ROOT / "tests/house/promised.toml"


# How many names of a kind there are, at least.
LEAST = {"fmu": 1000, "start": 600, "range": 300, "terminal": 100, "written": 250, "c": 60}


@pytest.fixture(scope="module")
def there() -> Surface:
    return surface()


def test_all_that_was_promised_is_there(there: Surface) -> None:
    """Who takes a name away takes it out of the list, and puts a row into CHANGELOG.md."""
    promised = tomllib.loads(LIST.read_text())
    assert missing(promised, there) == []
    assert promised.keys() == there.keys()
    for kind, least in LEAST.items():
        assert sum(len(n) for rows in promised[kind].values() for n in rows.values()) > least, kind


@pytest.mark.parametrize(
    ("kind", "place", "said", "name"),
    [
        ("fmu", "mcc", "output Float64[6] mm", "position"),
        ("command", "run", "options", "--set"),
        ("file", "scenario.toml", "keys", "drive.at"),
        ("python", "motionfmu.virtual.mcc", "names", "VirtualCard"),
        ("python", "motionfmu", "names", "Result.save"),
        ("python", "motionfmu.analysis.contour", "names", "ContourResult.numbers"),
        ("start", "mcc", "0.1", "acc_time"),
        ("terminal", "epcio", "host, host_link", "stock=stock"),
        ("status", "motionfmu", "130", "STOPPED"),
        ("environment", "motionfmu", "variables", "MOTIONFMU_CACHE"),
        ("written", "result.json", "names", "checks.ok"),
        ("written", "contour.json", "names", "error.max"),
        ("written", "check --junit", "names", "testcase.classname"),
        ("written", "gcode --json", "names", "time"),
        ("c", "mccl.h", "functions", "MCC_AbortMotion"),
        ("c", "mccl.h", "functions", "MCC_ArcXYUVW"),
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


def test_a_range_may_grow_and_not_shrink(there: Surface) -> None:
    for now, told in (("0.0 to 5.0", 0), ("-inf to inf", 0), ("0.0 to 4.9", 1), ("1.0 to 9.0", 1)):
        was = {"range": {"mcc": {"0.0 to 5.0": ["feed"]}}}
        assert len(missing(was, {"range": {"mcc": {now: ["feed"]}}})) == told, now
    other = copy.deepcopy(there)
    other["range"]["mcc"]["0.002 to inf"] = other["range"]["mcc"].pop("0.001 to inf")
    assert "range mcc: acc_time (0.001 to inf)" in missing(there, other)


def test_the_list_is_written_as_it_is_read(there: Surface) -> None:
    text = written(there)
    assert tomllib.loads(text) == there
    assert max(map(len, text.splitlines())) <= 100
