"""The document's names: table of the README, headers, exported symbols and tests agree."""

import re
import subprocess

from conftest import ROOT

# The source document prints 89 function names, one of them twice; the second is circle_yzuvw here.
NAMES = 89


def table(text: str) -> dict[str, list[str]]:
    """Test files by function name, from the rows with three columns of names, meaning, tests."""
    rows = re.findall(r"^\| (`MCC_.*?) \| .* \| (`.*`) \|$", text, re.M)
    found: dict[str, list[str]] = {}
    for names, tests in rows:
        for name in re.findall(r"`(MCC_\w+)`", names):
            assert name not in found, f"{name} stands twice"
            found[name] = re.findall(r"`(\S+)`", tests)
    return found


README = table((ROOT / "src/mcc/README.md").read_text())


def declared() -> set[str]:
    headers = [f for f in (ROOT / "src/mcc").glob("*.h") if f.name != "mccl.h"]
    text = "\n".join(f.read_text() for f in headers)
    return set(re.findall(r"^[a-z]\w* (MCC_\w+)\(", text, re.M))


def exported() -> set[str]:
    listing = subprocess.run(
        ["nm", "-g", "--defined-only", ROOT / "build/libmcc.a"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    return set(re.findall(r" T (MCC_\w+)$", listing, re.M))


def test_the_table_has_every_name_of_the_document() -> None:
    assert len(README) == NAMES


def test_the_table_is_what_the_headers_declare() -> None:
    assert set(README) == declared()


def test_what_is_declared_is_there() -> None:
    assert declared() == exported()


def test_the_named_test_calls_the_function() -> None:
    missing = []
    for name, files in README.items():
        texts = [(ROOT / "tests/core" / f).read_text() for f in files]
        calls = any(re.search(rf"\b{name}\b", t) for t in texts)
        missing += [] if files and calls else [name]
    assert missing == []


def test_the_parameters_are_a_type_of_the_headers() -> None:
    text = "\n".join(f.read_text() for f in (ROOT / "src/mcc").glob("*.h"))
    assert "} MCC_MACH_PARAM;" in text and "epcio_axis_param[AXES]" in text


def test_the_table_reader_can_fail() -> None:
    row = "| `MCC_a` `MCC_b` | does | `x.c` `y.c` |\n| `task_c` | no | `z.c` |\n| `MCC_d` | two |\n"
    assert table(row) == {"MCC_a": ["x.c", "y.c"], "MCC_b": ["x.c", "y.c"]}
