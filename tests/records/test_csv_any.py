"""Whatever a text holds, it is read or refused with one message that names it."""

import tempfile
from pathlib import Path
from typing import Any

from hypothesis import example, given, settings
from hypothesis import strategies as st

import motionfmu
from motionfmu.base.errors import InputError

WORDS = "time|t [s]|x [mm]|Name|SymbolComment|Data-Type|SampleTime[ms]|Start|Increment|Unit|(V)|é"
CELLS = "0|1|2.5|-1e3|1,5|0x1F|nan|∞|true|12:00:00.5|2026-01-01 00:00:00||EOF"
PIECE = st.sampled_from([*WORDS.split("|"), *CELLS.split("|"), " ", '"', "#", "[", "]", "\x00"])
PART = st.sampled_from([",", ";", "\t", " ", "|", "\n", "\r\n", "\r", "\n\n"])
TEXT = st.lists(st.tuples(PIECE, PART), max_size=60).map(lambda x: "".join(map("".join, x)))
NAME = st.sampled_from(["time", "t", "x", "c1", ""])
LAYOUT = st.fixed_dictionaries(
    {},
    optional={
        "time": NAME,
        "rate": st.sampled_from([1.0, 1e3, 0.0, -1.0, 1e12, 1e-10, 1e-300]),
        "delimiter": st.sampled_from([",", ";", " ", "", "::"]),
        "decimal": st.sampled_from([".", ",", "'"]),
        "skip": st.integers(-1, 4),
        "names": st.lists(NAME, max_size=4),
        "offset": st.sampled_from([0.0, "start", "stop", 1e9, 4.6e9, 1e300]),
        "duplicates": st.sampled_from(["refuse", "first", "last", "mean", "most"]),
        "columns": st.dictionaries(NAME, st.one_of(NAME, st.lists(NAME, max_size=3))),
    },
)


@given(TEXT, LAYOUT)
@settings(max_examples=600, derandomize=True, deadline=None)
@example("true\n0\t", {"rate": 1e12})
@example('"\n1,5 ', {})
def test_any_text_is_read_or_refused(text: str, layout: dict[str, Any]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "trace.csv"
        file.write_bytes(text.encode())
        try:
            found = motionfmu.record(file, **layout)
        except InputError as error:
            assert len(error.args) == 1 and error.args[0]
            assert "\n" not in str(error)
        else:
            assert len(found.ns) >= 2 and (found.ns[1:] > found.ns[:-1]).all()
            assert all(len(x) == len(found.ns) for x in found.columns.values())
            assert repr(found)
