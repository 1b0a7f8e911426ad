"""The check of plain sentences finds what is planted, and takes no code for a sentence."""

from pathlib import Path

import plain_english
import pytest
import sentences
from conftest import ROOT

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
    pieces = list(sentences.of_markdown(text))
    assert len(pieces) == (2 if "a link" in text else 1)


def test_code_and_formula_are_a_word_each() -> None:
    (one,) = sentences.of_markdown("Call `a b c d` with $x + y + z$ now.")
    assert one.words == 5


def test_sentences_end_at_a_full_stop_before_a_capital_or_a_name_of_c() -> None:
    found = [one.text for one in sentences.sentences("It runs. Then (so.) It\nstops. a_b ends.", 7)]
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


def test_words_that_the_glossary_replaces_are_refused() -> None:
    """Those that stand as code in its last column, also their plural; names of code are none."""
    page = "| word | gives way |\n|---|---|\n| **new name**, **b** | x | `old name`, other |\n"
    assert plain_english.replaced(page) == {"old name": "new name"}
    assert plain_english.TERMS["lag error"] == "following error"
    for old, word in plain_english.BETTER.items():
        told = plain_english.breaks("page.md", f"This is the {old} here.")
        assert [f'say "{word}"' in said or not word for said in told] == [True], old
        assert (
            not plain_english.breaks("CHANGELOG.md", f"The {old}.")
            or old in plain_english.FORBIDDEN
        )
    assert plain_english.breaks("a.py", 'x = axis("Attitude")\n')
    assert not plain_english.breaks("a.py", 'x = {"attitude": "arm.attitude"}\n')
    assert not plain_english.breaks(
        "a.py", 'def f():\n    """Do.\n\n    attitude : float\n    """\n'
    )


HEADER = f"/* {LONG[:60]}\n * {LONG[60:]} */\n"
DOC = f'"""{SHORT}\n\n{SHORT} {LONG}\n"""\n'
# A numpydoc table whose entries are long together, and one entry that is long.
TABLE = "Parameters\n    ----------\n" + f"    a : int\n        {LONG[:90]}.\n" * 3


@pytest.mark.parametrize(
    ("name", "text", "line"),
    [
        ("a.py", DOC, 3),
        (
            "a.py",
            f'def f():\n    """{SHORT}\n\n    {TABLE}    b : int\n        {LONG}\n    """',
            13,
        ),
        ("a.py", f'def _f():\n    """{LONG}"""\n', 2),
        ("a.py", f'def f():\n    def g():\n        """{LONG}"""\n', 3),
        ("a.py", f'\nf(help="{LONG}")\n', 2),
        ("a.py", f'_habit("{LONG}", "-q", "--quiet")\n', 1),
        ("a.py", f'raise InputError(f"{{name}}: {LONG[:80]}"\n    "{LONG[80:]}")\n', 1),
        ("a.py", f'x = "{LONG[:80]}" + str(y) + "{LONG[80:]}"\n', 1),
        ("a.py", f"x = f\"{{f('{LONG}')}}\"\n", 1),
        ("a.py", f'x = "<p>{SHORT}</p><p>{LONG[:30]}<b>{LONG[30:]}</b></p>"\n', 1),
        ("a.py", f'x = """#include <a.h>\n/* {LONG} */\n"""\n', 1),
        ("a.h", f"int x;\n\n{HEADER}", 3),
        ("a.h", f"/* {SHORT}\n *\n * {SHORT} {LONG} */\n", 3),
        ("a.h", f"int x; /* {LONG} */\n", 1),
        ("a.h", f"int x; // {LONG}\n", 1),
        ("a.h", f"/* {SHORT}\n * - {SHORT}\n * - {LONG[:60]}\n *   {LONG[60:]} */\n", 3),
        ("a.h", f"/* {SHORT}\n *     1 a    {LONG[:60]}\n *            {LONG[60:]} */\n", 2),
        ("a.c", f'\nfail(f, "%s: {LONG[:70]}"\n     "{LONG[70:]}", x);\n', 2),
        ("a.c", f"\nint x; /* {LONG} */\n", 2),
        ("a.inc", f'say("{LONG}");\n', 1),
        ("a.mo", f'model A "{SHORT}"\n  Real x "{LONG}";\n', 2),
        ("a.mo", f'annotation(Documentation(info = "<p>{SHORT}\n{LONG}</p>"));\n', 2),
        ("a.js", f'say("{LONG[:70]}" +\n  "{LONG[70:]}");\n', 1),
        ("a.js", f"say(`{LONG[:70]}${{name}} {LONG[70:]}`);\n", 1),
        ("a.html", f"<p>{SHORT}</p>\n<p>{LONG}</p>\n", 2),
        ("a.toml", f"# {LONG[:60]}\n# {LONG[60:]}\nx = 1\n", 1),
        ("a.toml", f"x = 1  # {LONG}\n", 1),
        ("a.toml", f'\nx = {{ type = "f64", doc = "{LONG}" }}\n', 2),
    ],
)
def test_texts_of_every_language_are_read(name: str, text: str, line: int) -> None:
    (said,) = plain_english.breaks(name, text)
    where, told = said.split(": ", 1)
    assert where.rpartition(":")[0] == name
    assert abs(int(where.rpartition(":")[2]) - line) <= 1  # a text of several lines tells its first
    assert "words, at most 40" in told


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.py", f'def f():\n    """{SHORT}\n\n    {TABLE}    """\n'),
        ("a.py", f'"""{SHORT}\n\n>>> {LONG}\n{LONG}\n"""\n'),
        ("a.py", 'x = ".a { color: red; }' + " .b { width: 1px; margin: 0; }" * 12 + '"\n'),
        ("a.py", f'x = "<table><tr><td>{LONG[:90]}</td><td>{LONG[:110]}</td></tr></table>"\n'),
        ("a.py", f'f("<script>{LONG}</script>")\n'),
        ("a.h", f"int x;\n/* {SHORT}\n * - {LONG[:90]}\n * - {LONG[:90]} */\n"),
        ("a.h", f"/* {SHORT}\n *\n" + " *     o---x     the first one\n" * 15 + " */\n"),
        ("a.toml", "# Gains of a loop.\n" + "# Feedback: the card reads the motor\n" * 9),
    ],
)
def test_lists_drawings_and_code_are_no_sentences(name: str, text: str) -> None:
    assert not plain_english.breaks(name, text)


@pytest.mark.parametrize(
    "text",
    [
        f"/* {LONG[:70]}\n *     {LONG[70:130]}\n * {LONG[130:]} */\n",
        f"/* {LONG[:70]}\n *{LONG[70:130]}\n * {LONG[130:]} */\n",
        f"/* {LONG[:100].replace(' ', '  ')}\n * {LONG[100:].replace(' ', '   ')} */\n",
        f"/* {SHORT}\n * - {LONG[:100]}\n *     {LONG[100:150]}\n *   {LONG[150:]} */\n",
    ],
    ids=["a deeper line", "another margin", "gaps at the margin", "a deeper line of an item"],
)
def test_prose_that_is_laid_out_as_a_drawing_is_read(text: str) -> None:
    (said,) = plain_english.breaks("a.h", text)
    assert "41 words" in said


def test_what_users_read_is_held() -> None:
    """Each kind of text that the check knows has files of the project that it holds."""
    held = {Path(name).suffix for name in plain_english.files(ROOT)}
    assert held == set(sentences.READERS)


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
