"""What is wrong with a text of columns is one message with file, line and character."""

from pathlib import Path
from typing import Any

import pytest

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.records import csv_table

GOOD = "time [s],position [mm],current [A]\n0.000,1.5,0.1\n0.001,1.6,0.2\n0.002,1.7,0.3\n"
SEMI = "time [s];position [mm]\n0,000;1,5\n0,001;1,6\n0,002;1,7\n"

# What it is, the text, what the caller says, and the whole message behind the folder.
CASES: list[tuple[str, str, dict[str, Any], str]] = [
    ("nothing in it", "", {}, "trace.csv: nothing in it"),
    ("blank lines", "\n \n\n", {}, "trace.csv: nothing in it"),
    (
        "a head alone",
        "time [s],x [mm]\n",
        {},
        "trace.csv:1:1: no line of numbers among the first 2; the last one is 'time [s],x [mm]'",
    ),
    (
        "prose",
        "Dear colleague,\nhere is the trace.\n",
        {},
        "trace.csv:2:1: no line of numbers among the first 3; the last one is 'here is the trace.'",
    ),
    ("a NUL", GOOD.replace("1.6", "1\x00.6"), {}, "trace.csv:3:8: no text, it has a NUL"),
    (
        "text among numbers",
        GOOD.replace("1.6", "1.6mm"),
        {},
        "trace.csv:3:7: position = '1.6mm': a number wanted",
    ),
    (
        "a word",
        GOOD.replace("0.2\n", "fault\n"),
        {},
        "trace.csv:3:11: current = 'fault': a number wanted",
    ),
    (
        "two decimal points",
        GOOD.replace("1.6", "1.6.2"),
        {},
        "trace.csv:3:7: position = '1.6.2': a number wanted",
    ),
    (
        "points between thousands",
        SEMI.replace("1,6", "1.001,6"),
        {},
        "trace.csv:3:7: position = '1.001,6': a number without signs between its thousands wanted",
    ),
    (
        "a decimal comma among points",
        GOOD.replace("0.001,1.6", '0.001,"1,6"'),
        {},
        'trace.csv:3:7: position = \'1,6\': "," where other numbers have "." (line 2); say decimal',
    ),
    (
        "a decimal point among commas",
        SEMI.replace("0,001;1,6", "0,001;1.6"),
        {},
        'trace.csv:3:7: position = \'1.6\': "." where other numbers have "," (line 2); say decimal',
    ),
    (
        "a field missing",
        GOOD.replace("1.6,0.2", "1.6"),
        {},
        "trace.csv:3:10: 2 fields, 3 wanted (columns parted by comma)",
    ),
    (
        "a field too many",
        GOOD.replace("1.6,0.2", "1.6,0.2,0.3"),
        {},
        "trace.csv:3:15: 4 fields, 3 wanted (columns parted by comma)",
    ),
    (
        "decimal commas parted by commas",
        GOOD.replace("1.6,0.2", "1,6,0,2"),
        {},
        "trace.csv:3:11: 5 fields, 3 wanted (columns parted by comma)",
    ),
    (
        "a quote that is open",
        GOOD.replace("1.6", '"1.6'),
        {},
        "trace.csv:3:7: a quote that is not closed",
    ),
    (
        "commas that may be both",
        "1,2\n3,4\n",
        {"rate": 1000.0},
        "trace.csv:1:1: '1,2' is 2 columns, or 1 with decimal commas: say delimiter, or decimal",
    ),
    (
        "text behind the numbers",
        GOOD + "total: 3 rows\n",
        {},
        "trace.csv:5:14: 1 field, 3 wanted (columns parted by comma)",
    ),
    (
        "beyond all numbers",
        GOOD.replace("1.6", "1.6e999"),
        {},
        "trace.csv:3:7: position = '1.6e999': beyond all numbers",
    ),
    (
        "time goes back",
        GOOD.replace("0.002", "0.0005"),
        {},
        "trace.csv:4:1: time: 0.0005 s comes after 0.001 s",
    ),
    ("time has no value", GOOD.replace("0.001", ""), {}, "trace.csv:3:1: time has no value"),
    (
        "time beyond all times",
        GOOD.replace("0.002", "1e12"),
        {},
        "trace.csv:4:1: time: 1e+12 s is beyond all times here",
    ),
    (
        "two values at one time",
        GOOD.replace("0.002,", "0.001,"),
        {},
        "trace.csv:4:7: position has two values at 0.001 s, 1.6 and 1.7: say duplicates",
    ),
    (
        "two values within a nanosecond",
        GOOD.replace("0.002,", "0.0010000001,"),
        {},
        "trace.csv:4:14: position has two values at 0.001 s, 1.6 and 1.7: say duplicates",
    ),
    ("one sample", "time [s],x\n0,1\n", {}, "trace.csv: 1 sample, two wanted"),
    (
        "two columns of one name",
        GOOD.replace("current [A]", "position [mm]"),
        {},
        "trace.csv:1:24: 'position' is the name of two columns: say names",
    ),
    (
        "two columns of times that differ",
        GOOD.replace("current [A]", "time [s]"),
        {},
        "trace.csv:1:24: 'time' has other times than the first one: say names, and time",
    ),
    (
        "no column of times",
        GOOD.replace("time [s]", "index"),
        {},
        "trace.csv:1:1: no column of times (index, position, current): say time, or rate",
    ),
    (
        "times in millimetres",
        GOOD.replace("time [s]", "time [mm]"),
        {},
        "trace.csv:1:1: 'time' is in [mm], no unit of time",
    ),
    (
        "times in no unit",
        GOOD.replace("time [s]", "time [ticks]"),
        {"time": "time"},
        'trace.csv:1:1: \'time\': unit "ticks": unknown symbol "ticks"',
    ),
    (
        "a column of times that is not there",
        GOOD,
        {"time": "tine"},
        "trace.csv: time = 'tine': no such column; did you mean 'time'?",
    ),
    (
        "rate and time",
        GOOD,
        {"rate": 1000.0, "time": "time"},
        "record: rate = 1000 Hz and time = 'time': one of them",
    ),
    (
        "a rate of nothing",
        GOOD,
        {"rate": 0},
        "record: rate = 0: samples a second wanted, up to 1e+09",
    ),
    (
        "an option that is none",
        GOOD,
        {"delimeter": ";"},
        "record: no option 'delimeter'; did you mean 'delimiter'?",
    ),
    (
        "a delimiter of two characters",
        GOOD,
        {"delimiter": "::"},
        "record: delimiter = '::': one character wanted",
    ),
    (
        "a delimiter that is not there",
        GOOD,
        {"delimiter": ";"},
        "trace.csv: no line of numbers among the first 5 with delimiter = ';'",
    ),
    (
        "a decimal sign that is none",
        GOOD,
        {"decimal": "'"},
        'record: decimal = "\'": "." or "," wanted',
    ),
    (
        "comma for both",
        GOOD,
        {"delimiter": ",", "decimal": ","},
        'record: delimiter and decimal are both ","',
    ),
    (
        "an encoding that is none",
        GOOD,
        {"encoding": "utf-99"},
        "record: encoding = 'utf-99': no such encoding",
    ),
    (
        "another encoding",
        GOOD.replace("current", "Drehmoment äöü"),
        {"encoding": "ascii"},
        "trace.csv:1:35: no ascii text, byte 0xc3",
    ),
    ("skip beyond the end", GOOD, {"skip": 9}, "trace.csv: nothing in it"),
    (
        "skip of less than nothing",
        GOOD,
        {"skip": -1},
        "record: skip = -1: a number of lines wanted",
    ),
    (
        "names for other columns",
        GOOD,
        {"names": ["time [s]", "x"]},
        "trace.csv:2:1: names: 2 for 3 columns",
    ),
    (
        "no way of duplicates",
        GOOD,
        {"duplicates": "average"},
        "record: duplicates = 'average': refuse, first, last, mean wanted",
    ),
    (
        "an offset in words",
        GOOD,
        {"offset": "now"},
        "record: offset = 'now': seconds or \"start\" wanted",
    ),
    (
        "a mapped column that is not there",
        GOOD,
        {"columns": {"x": "positon"}},
        "trace.csv: columns: x = 'positon': no such column; did you mean 'position'?",
    ),
    (
        "a mapped unit that is none",
        GOOD,
        {"columns": {"x": {"column": "position", "unit": "furlong"}}},
        'columns: x: unit "furlong": unknown symbol "furlong"',
    ),
    (
        "a mapped key that is none",
        GOOD,
        {"columns": {"x": {"column": "position", "factor": 2}}},
        "record: columns: x = {'column': 'position', 'factor': 2}: unknown key 'factor'",
    ),
    (
        "elements of two units",
        GOOD,
        {"columns": {"x": ["position", "current"]}},
        "trace.csv:1:24: columns: x: 'position' [mm] and 'current' [A]: one unit wanted",
    ),
    (
        "a mapped name that another has",
        GOOD,
        {"columns": {"current": "position"}},
        "trace.csv:1:24: columns: 'current' is another column's name here",
    ),
    (
        "a time of day that is none",
        "time;x\n12:00:00.1;1\n12:60:00.2;2\n",
        {},
        "trace.csv:3:1: time = '12:60:00.2': no time of day",
    ),
    (
        "a date that is none",
        "time;x\n2026-02-28 12:00:00;1\n2026-02-30 12:00:00;2\n",
        {},
        "trace.csv:3:1: time = '2026-02-30 12:00:00': day is out of range for month",
    ),
    (
        "no time of day",
        "time;x\n12:00:00.1;1\n0.2;2\n",
        {},
        "trace.csv:3:1: time = '0.2': a time of day wanted",
    ),
]


@pytest.mark.parametrize(
    ("text", "layout", "told"), [c[1:] for c in CASES], ids=[c[0] for c in CASES]
)
def test_a_wrong_text_has_its_message(
    text: str, layout: dict[str, Any], told: str, tmp_path: Path
) -> None:
    file = tmp_path / "trace.csv"
    file.write_text(text, encoding="utf-8", newline="")
    with pytest.raises(InputError) as error:
        motionfmu.record(file, **layout)
    assert error.value.args == (told.replace("trace.csv", str(file)),)


def test_there_are_fifty_cases_with_as_many_messages() -> None:
    assert len(CASES) == 52
    assert len({told for *_, told in CASES}) == 50  # of nothing, in three ways, there is one


def test_the_text_itself_is_good(tmp_path: Path) -> None:
    for text in (GOOD, SEMI):
        file = tmp_path / "trace.csv"
        file.write_text(text)
        assert motionfmu.record(file)["position"].tolist() == [1.5, 1.6, 1.7]


def test_a_file_that_is_none(tmp_path: Path) -> None:
    for path, told in (
        (tmp_path / "none.csv", "no such file"),
        (tmp_path / "book.xlsx", "no record: .parquet, .mat, .csv"),
        (tmp_path, "no folder of a result"),
        (3, "the path of a record wanted"),
    ):
        if str(path).endswith("xlsx"):
            Path(str(path)).write_bytes(b"PK")
        with pytest.raises(InputError, match=told):
            motionfmu.record(path)


def test_a_text_beyond_the_size(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "trace.csv"
    file.write_text(GOOD)
    monkeypatch.setattr(csv_table, "SIZE_MAX", len(GOOD) - 1)
    with pytest.raises(InputError, match="are the most"):
        motionfmu.record(file)


def test_parquet_and_matlab_files_that_are_none(tmp_path: Path) -> None:
    for name, data, told in (
        ("a.parquet", b"PAR1 no", "no Parquet file"),
        ("a.mat", b"MATLAB 5.0 no", "no file of MATLAB"),
        ("b.mat", b"M" * 512 + b"\x89HDF\r\n\x1a\n", 'save\\(name, "-v7"\\)'),
    ):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(InputError, match=told):
            motionfmu.record(tmp_path / name)
