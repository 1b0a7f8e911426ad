"""Rows keyed by name, patterns of components, `without`: what they mean, and what is wrong."""

from pathlib import Path

import pytest
from refusals import refusal
from written_out import WHOLE_CIRCLE, WHOLE_TEXT

import motionfmu
from motionfmu.scenarios.body import Body

RADIUS = "contour.circles.0.ccw.radius_change"
# Half the feed from 0.5 s on, and one contrary.
DRIVE = '[drive]\n"mcc.override" = { at = [0.5], value = [0.5] }\n'
CONTRARY = f'[contrary]\n"the gain" = {{ set = {{ "mcc.p_gain" = 100 }}, fails = ["{RADIUS}"] }}\n'
BASE = WHOLE_TEXT[: WHOLE_TEXT.index("[[contrary]]")].replace('"mcc.override", ', "")
BASE += f"{DRIVE}\n{CONTRARY}"
ON, OFF = True, False


def folder(place: Path, name: str, text: str) -> Path:
    (place / name).mkdir()
    (place / name / "scenario.toml").write_text(text)
    (place / name / "circle.ngc").write_bytes((WHOLE_CIRCLE / "circle.ngc").read_bytes())
    return place / name


@pytest.fixture
def base(tmp_path: Path) -> Path:
    """The scenario that the others extend."""
    return folder(tmp_path, "base", BASE)


def extended(base: Path, text: str) -> Path:
    return folder(base.parent, "own", f'# Mine.\nextends = "../base"\n{text}')


def body(base: Path, text: str) -> Body:
    return motionfmu.load(extended(base, text)).document.body


def line_of(file: Path, text: str) -> str:
    """A place as messages have it: the file and the line that begins with a text."""
    lines = file.read_text().splitlines()
    return f"{file}:{1 + next(i for i, x in enumerate(lines) if x.startswith(text))}"


def test_rows_keyed_by_name_are_arrays_of_tables(tmp_path: Path) -> None:
    rows = '[[drive]]\ninput = "mcc.override"\nat = [0.5]\nvalue = [0.5]\n'
    case = f'[[contrary]]\noff = "the gain"\nset = {{ "mcc.p_gain" = 100 }}\nfails = ["{RADIUS}"]\n'
    listed = BASE.replace(DRIVE, rows).replace(CONTRARY, case)
    assert listed.count("[[") == 2
    one = motionfmu.load(folder(tmp_path, "keyed", BASE))
    other = motionfmu.load(folder(tmp_path, "listed", listed))
    assert one.document.body == other.document.body
    a, b = one.run(stop=0.8), other.run(stop=0.8)
    assert all(x.tobytes() == b[name].tobytes() for name, x in a.items())
    assert a["mcc.path_feed"][[4990, 7990]] == pytest.approx([50.0, 25.0], rel=1e-3)  # F3000


def test_a_file_adds_rows_and_list_entries_to_what_it_extends(base: Path) -> None:
    found = body(
        base,
        'leave = ["card.io_ldi"]\n\n[drive]\n"mcc.abort" = { at = [1.0], value = [true] }\n'
        '\n[record]\nsignals = ["mcc.services", "card.dac"]\n'
        '\n[contrary]\n"a step" = { set = { "card.loop_period" = 2e-4 }, fails = ["mcc.done"] }\n',
    )
    assert [d.input for d in found.drive] == ["mcc.override", "mcc.abort"]
    assert [c.off for c in found.contrary] == ["the gain", "a step"]
    assert found.leave[-1] == "card.io_ldi" and "mcc.hold" in found.leave
    assert (
        found.record.signals[-1] == "mcc.services" and found.record.signals.count("card.dac") == 1
    )


def test_without_takes_away_what_is_inherited(base: Path) -> None:
    found = body(
        base,
        'without = ["drive.mcc.override", "contrary.the gain", "record.signals.card.dac",'
        ' "check.mcc.starved", "expect"]\nleave = ["mcc.override"]\n'
        '\n[contrary]\n"the gain" = { set = { "mcc.p_gain" = 50 }, fails = ["mcc.done"] }\n',
    )
    assert found.drive == [] and [c.set for c in found.contrary] == [{"mcc.p_gain": 50}]
    assert "card.dac" not in found.record.signals and "card.err_count" in found.record.signals
    assert "mcc.starved" not in found.check and "mcc.error" in found.check and not found.expect


@pytest.mark.parametrize(
    ("rows", "wanted"),
    [
        ('"*.active" = true', {"mcc": ON, "card": ON, "machine": ON}),
        ('"m*.active" = true', {"mcc": ON, "machine": ON}),
        ('"c?rd.active" = true', {"card": ON}),
        # Of one file a name is stronger than a pattern, and of two patterns the later one.
        ('"mcc.active" = false\n"*.active" = true', {"mcc": OFF, "card": ON, "machine": ON}),
        ('"*.active" = true\n"m*.active" = false', {"mcc": OFF, "card": ON, "machine": OFF}),
        ('"m*.active" = false\n"*.active" = true', {"mcc": ON, "card": ON, "machine": ON}),
        # What a component does not have is not asked of it.
        ('"*.p_gain" = 300', {}),
    ],
)
def test_a_pattern_is_the_variable_of_all_that_have_it(
    base: Path, rows: str, wanted: dict[str, bool]
) -> None:
    found = body(base, f"\n[set]\n{rows}\n").set
    inherited = [True, True, False, False, False, False]
    for component in ("mcc", "card", "machine"):
        assert found[f"{component}.active"] == wanted.get(component, inherited)
    assert found["mcc.p_gain"] == (300 if "p_gain" in rows else 200)
    assert not any("*" in name or "?" in name for name in found)


def test_a_pattern_is_stronger_than_the_names_of_the_file_that_is_extended(base: Path) -> None:
    found = body(base, '\n[check]\n"*.starved" = { max = 5 }\n').check
    assert [row.max for row in found["mcc.starved"]] == [5.0]
    assert [row.max for row in found["card.underflows"]] == [0.0]


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ('[set]\n"*.p_gian" = 3', "*.p_gian: no component that fits has this variable"),
        ('[check]\n"x*.queue" = { max = 3 }', "x*.queue: no component that fits has this variable"),
        ('[set]\n"*.p_gain" = -3', "mcc.p_gain = -3: outside 0 .. 65535"),
        ('[set]\n"c?rd.active" = 3', "card.active = 3: Boolean wanted"),
        ('[check]\n"*.queue" = { mux = 2 }', "unknown key 'mux'; did you mean 'max'?"),
        (
            '[drive]\n"*.abort" = { at = [0.7], value = [true] }',
            "*.abort: a pattern goes in [set], [check] and [expect] only",
        ),
        (
            f'[contrary]\n"x" = {{ set = {{ "*.p_gain" = 1 }}, fails = ["{RADIUS}"] }}',
            "set *.p_gain: a pattern goes in [set], [check] and [expect] only",
        ),
        ('[drive]\n"mcc.abort" = { at = [0.7] }', "value is missing"),
        (
            '[drive]\n"mcc.abort" = { at = [0.7], valu = [true] }',
            "unknown key 'valu'; did you mean 'value'?",
        ),
        ('[contrary]\n"x" = { sett = {}, fails = [] }', "unknown key 'sett'; did you mean 'set'?"),
        (
            f'[contrary]\n"x" = {{ set = {{ "mcc.p_gian" = 1 }}, fails = ["{RADIUS}"] }}',
            "set mcc.p_gian: mcc has no variable 'p_gian'; did you mean 'p_gain'?",
        ),
    ],
)
def test_a_wrong_row_is_named_where_it_stands(base: Path, rows: str, told: str) -> None:
    own = extended(base, f"\n{rows}\n")
    first, *_ = refusal(motionfmu.load, own)
    assert first == f"{own}/scenario.toml:5: {told}"


def test_two_contraries_of_one_name_are_told_with_both_files(base: Path) -> None:
    again = CONTRARY.replace("100", "50")
    own = extended(base, f"\n{again}")
    (told,) = refusal(motionfmu.load, own)
    first = line_of(base / "scenario.toml", '"the gain"')
    assert told == f"{own}/scenario.toml:5: off = 'the gain' is there twice, first at {first}"


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("drive.mcc.overide", "; did you mean 'mcc.override'?"),
        ("contrary.the gian", "; did you mean 'the gain'?"),
        ("chekc.mcc.done", "; did you mean 'check'?"),
        ("leave.mcc.override", ""),
    ],
)
def test_what_nothing_inherited_has_is_refused(base: Path, name: str, near: str) -> None:
    own = extended(base, f'without = ["{name}"]\n')
    (told,) = refusal(motionfmu.load, own)
    assert told.startswith(f"{own}/scenario.toml:3: without '{name}': nothing that is inherited")
    assert told.endswith(near or told)


def test_what_is_wrong_in_both_files_is_told_of_both(base: Path) -> None:
    file = base / "scenario.toml"
    file.write_text(file.read_text().replace('"mcc.p_gain"     = 200', '"*.p_gian" = 200'))
    place = line_of(file, '"*.p_gian"')
    own = extended(base, '\n[drive]\n"mcc.hodl" = { at = [0.7], value = [true] }\n')
    assert sorted(refusal(motionfmu.load, own)) == sorted(
        [
            f"{place}: *.p_gian: no component that fits has this variable",
            f"{own}/scenario.toml:5: mcc.hodl: mcc has no variable 'hodl'; did you mean 'hold'?",
        ]
    )


def test_what_a_file_opens_is_told_where_the_other_has_leave(base: Path) -> None:
    """A wire that goes leaves its input open, of which the file that was inherited is told."""
    own = extended(base, 'without = ["connect.machine.voltage", "leave.mcc.hold"]\n')
    (told,) = refusal(motionfmu.load, own)
    place = line_of(base / "scenario.toml", "[connect]")
    assert told.startswith(f"{place}: inputs mcc.hold, machine.voltage are open: connect, drive")
