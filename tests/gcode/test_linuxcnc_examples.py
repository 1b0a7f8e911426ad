"""The rows of LinuxCNC's examples: reasons of refusal hold, and the word table has their count."""

from conftest import ROOT
from linuxcnc_examples import found, rows, same

from motionfmu.analysis.gcode import read

ROWS = rows()
REFUSED = {name: row for name, row in ROWS.items() if "words" in row}


def test_words_are_refused_for_the_reason_of_the_examples() -> None:
    for name, row in REFUSED.items():
        faults = read(row["words"] + "\n", angles=row.get("angles", False)).faults
        assert faults and faults[0].why == row["why"], name


def test_the_table_of_words_has_the_count() -> None:
    accepted = [row for row in ROWS.values() if "commands" in row]
    assert len(ROWS) == 55 == len(accepted) + len(REFUSED)
    text = (ROOT / "src/language/gcode/README.md").read_text()
    assert f"{len(accepted)} of LinuxCNC's {len(ROWS)} examples are accepted" in text
    lathes = sum("for turning" in row["why"] for row in REFUSED.values())
    assert f"{lathes} of the others are for lathes" in text


def test_another_reading_is_found(tmp_path) -> None:
    file = tmp_path / "a.ngc"
    file.write_text("G1 X1 F60\nX2\n")
    row = found(file)
    assert row["commands"] == 2 and row["way"] == 2.0 and same(row, dict(row))
    assert not any(same(row, row | {k: row[k] + 1}) for k in ("commands", "way", "mark"))
    file.write_text("G1 X1 F60\nG76\n")
    refused = found(file)
    assert refused["line"] == 2 and same(refused, dict(refused)) and not same(refused, row)
    assert not same(refused, refused | {"line": 3}) and not same(refused, refused | {"why": ""})
