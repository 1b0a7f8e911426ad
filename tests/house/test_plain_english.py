"""The check of plain sentences finds what is planted, and takes no code for a sentence."""

from pathlib import Path

import plain_english
import pytest

LONG = "Word " + " ".join(["word"] * 40) + "."
SHORT = "A short sentence stands here."


@pytest.mark.parametrize(
    ("page", "line"),
    [
        (f"{SHORT}\n\n- {SHORT}\n- {LONG}\n", 4),
        (f"| a | b |\n|---|---|\n| {SHORT} | x |\n| y | {LONG} |\n", 4),
        (f"{SHORT} {SHORT}\n{LONG.replace(' ', chr(10), 3)}\n", 2),
        (f"{SHORT}\n\n```c\nint x; {LONG}\n```\n\n{LONG}\n", 7),
        (f"$$\nx\n$$\n\n> {LONG}\n", 5),
    ],
    ids=["list item", "table cell", "across lines", "behind code", "quote behind a formula"],
)
def test_a_long_sentence_is_named_with_its_line(page: str, line: int) -> None:
    (said,) = plain_english.breaks("page.md", page)
    assert said.startswith(f'page.md:{line}: 41 words, at most 40: "Word word')
    assert said.endswith("make it two sentences with a verb each")


@pytest.mark.parametrize(
    "text",
    [
        "Some cards, e.g. A and B, i.e. Both of them, run (cf. Fig. 3) at 2.5 mm.",
        "Eq. 4 and Sec. 2 hold.",
        "The name `code.with. Dots` and [a link. Text](http://a.b/c.d) are one",
        "The sum $a. B$ is small.",
    ],
)
def test_abbreviations_code_and_formulas_end_no_sentence(text: str) -> None:
    pieces = list(plain_english.of_markdown(text))
    assert len(pieces) == (2 if "a link" in text else 1)


def test_code_and_formula_are_a_word_each() -> None:
    (one,) = plain_english.of_markdown("Call `a b c d` with $x + y + z$ now.")
    assert one.words == 5


def test_sentences_end_at_a_full_stop_before_a_capital_or_a_name_of_c() -> None:
    found = [
        one.text for one in plain_english.sentences("It runs. Then (so.) It\nstops. a_b ends.", 7)
    ]
    assert found == ["It runs.", "Then (so.)", "It\nstops.", "a_b ends."]


def test_a_page_of_long_sentences_is_told_by_its_average() -> None:
    text = " ".join(["Word " + "word " * 23 + "end."] * 5)
    (said,) = plain_english.breaks("page.md", text)
    assert said.startswith("page.md:1: 25.0 words a sentence on average, below 25")
    assert not plain_english.breaks("page.md", text.replace("Word word", "Word", 1))


def test_a_forbidden_word_is_told_with_what_to_write() -> None:
    (said,) = plain_english.breaks("page.md", "We use it in\norder to move.")
    assert said == 'page.md:1: "in order to" in "We use it in order to move. ..."; say "to"'
    assert not plain_english.breaks("page.md", "Run `utilize` there.")


def test_docstrings_and_helps_are_read() -> None:
    code = f'"""{SHORT}\n\n{LONG}"""\n\ndef f():\n    """{LONG}"""\n\ndef _g():\n    """{LONG}"""\n'
    assert [said.split(": ")[0] for said in plain_english.breaks("a.py", code)] == ["a.py:6"]
    assert [s.split(": ")[0] for s in plain_english.breaks("a.py", f'\nf(help="{LONG}")')] == [
        "a.py:2"
    ]


def test_of_a_docstring_only_the_first_sentence_counts() -> None:
    assert not plain_english.breaks("a.py", f'"""{SHORT} {LONG}"""')


def test_comments_of_headers_are_read() -> None:
    text = f"/* {SHORT} */\nint x; /* {LONG} */\n\n/* {LONG[:60]}\n * {LONG[60:]}\n */\n"
    assert [said.split(": ")[0] for said in plain_english.breaks("a.h", text)] == ["a.h:4"]


def test_what_a_project_breaks_fails_the_check(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "README.md").write_text(SHORT)
    assert (plain_english.main(tmp_path), capsys.readouterr().out) == (0, "")
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs/page.md").write_text(LONG + "\n")
    assert plain_english.main(tmp_path) == 1
    (said,) = capsys.readouterr().out.splitlines()
    assert said.startswith("docs/page.md:1: 41 words, at most 40: ")
