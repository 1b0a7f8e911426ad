"""Functions are plain, or say why not: cyclomatic complexity (CCN) as lizard counts it."""

import functools
import re
import subprocess
from collections.abc import Iterator

import lizard
import pytest
from conftest import ROOT

# One more than the decisions in a function: every if, loop, case, && and ||, ? and comprehension.
SPLIT, EXPLAIN = 25, 15
# What is left to the tests: oracles and random inputs, each of which one file uses.
FOLDERS = ("src", "fmus", "examples", "scenarios", "docs")
C = (".c", ".h", ".inc")
REASON = re.compile(r"\bCCN (\d+):(?= \w)")
# Lizard loses its way behind the operators in an assertion at the top of a file.
ASSERTION = re.compile(r"^_?[Ss]tatic_assert\([^;]*;", re.MULTILINE)


def sources() -> list[str]:
    listed = subprocess.run(
        ["git", "ls-files", *FOLDERS], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.splitlines()
    return [n for n in listed if n.endswith((*C, ".py")) and (ROOT / n).exists()]


@functools.cache
def functions(file: str, text: str) -> list[lizard.FunctionInfo]:
    """Functions of a file; macros are read over, so a table of rows counts nothing."""
    text = ASSERTION.sub(lambda found: "\n" * found[0].count("\n"), text)
    return lizard.analyze_file.analyze_source_code(file, text).function_list


def comment(lines: list[str], first: int, in_c: bool) -> tuple[int, int]:
    """Lines of the comment right above a function that begins at a line, both counted from 0."""
    if not in_c:
        while first and lines[first - 1].lstrip().startswith("@"):
            first -= 1
        end = first
        while first and lines[first - 1].lstrip().startswith("#"):
            first -= 1
        return first, end
    end = first
    if first and lines[first - 1].rstrip().endswith("*/"):
        first -= 1
        while first and "/*" not in lines[first]:
            first -= 1
    return first, end


def complaints(file: str, text: str) -> Iterator[str]:
    """What is wrong with the functions of a file: place, name, CCN and what to do."""
    lines = text.split("\n")
    told = {k: found for k, line in enumerate(lines) if (found := REASON.search(line))}
    for f in functions(file, text):
        ccn, where = f.cyclomatic_complexity, f"{file}:{f.start_line}: {f.name} has CCN"
        begin, end = comment(lines, f.start_line - 1, file.endswith(C))
        reasons = [told.pop(k) for k in range(begin, end) if k in told]
        if ccn > SPLIT:
            yield f"{where} {ccn}: split it at a part that has a name of its own; {SPLIT} at most"
        elif ccn > EXPLAIN and not reasons:
            yield (
                f"{where} {ccn}: let a table or a helper make it plainer, or say in the comment"
                f" above it why not: CCN {ccn}: ..."
            )
        elif ccn > EXPLAIN and int(reasons[0][1]) != ccn:
            yield f"{where} {ccn}, not {reasons[0][1]}: look whether its reason still holds"
        elif ccn <= EXPLAIN and reasons:
            yield f"{where} {ccn}: it needs no reason any more, take that away"
    yield from (f"{file}:{k + 1}: {m[0]} a reason above no function" for k, m in told.items())


def test_every_function_is_plain_or_says_why_not() -> None:
    assert [told for n in sources() for told in complaints(n, (ROOT / n).read_text())] == []


def unseen(file: str, text: str) -> list[str]:
    """Lines at which the body of a C function begins that lizard does not see."""
    seen = {k for f in functions(file, text) for k in range(f.start_line, f.end_line + 1)}
    bodies = [k for k, line in enumerate(text.split("\n"), 1) if line == "{"]
    return [f"{file}:{k}" for k in bodies if k not in seen]


def test_lizard_sees_every_function_of_c() -> None:
    names = [n for n in sources() if n.endswith(C)]
    assert [k for n in names for k in unseen(n, (ROOT / n).read_text())] == []
    assert unseen("a.c", 'static_assert(1 < 2, "so");\nint f(void)\n{\n}\n') == []
    assert unseen("a.c", "TABLE\n{\n}\n") == ["a.c:2"]


def c_function(ccn: int, above: str = "") -> str:
    ifs = "".join(f"    if (x > {k})\n        x++;\n" for k in range(ccn - 1))
    return f"{above}static int walk(int x)\n{{\n{ifs}    return x;\n}}\n"


def python_function(ccn: int, above: str = "") -> str:
    ifs = "".join(f"    if x > {k}:\n        x += 1\n" for k in range(ccn - 1))
    return f"{above}@cached\ndef walk(x):\n{ifs}    return x\n"


@pytest.mark.parametrize(
    ("ccn", "reason", "told"),
    [
        (15, "", ""),
        (16, "", "walk has CCN 16: let a table or a helper make it plainer"),
        (16, "CCN 16: one case for each state.", ""),
        (16, "CCN 16:", "walk has CCN 16: let a table"),
        (17, "CCN 16: one case for each state.", "walk has CCN 17, not 16: look whether"),
        (15, "CCN 16: one case for each state.", "walk has CCN 15: it needs no reason any more"),
        (25, "CCN 25: one case for each state.", ""),
        (26, "CCN 26: one case for each state.", "walk has CCN 26: split it"),
    ],
)
def test_what_is_not_plain_is_told(ccn: int, reason: str, told: str) -> None:
    for above in (f"/* {reason} */\n", f"/* It walks.\n * {reason} */\n") if reason else ("",):
        found = list(complaints("a.c", "int before;\n\n" + c_function(ccn, above)))
        assert len(found) == bool(told) and all(told in line for line in found)
    above = f"# It walks.\n# {reason}\n" if reason else ""
    found = list(complaints("a.py", "before = 1\n\n\n" + python_function(ccn, above)))
    assert len(found) == bool(told) and all(told in line for line in found)


def test_a_reason_above_no_function_is_told() -> None:
    text = c_function(3) + "/* CCN 20: it was here. */\n\nint left;\n"
    assert list(complaints("a.c", text)) == ["a.c:9: CCN 20: a reason above no function"]


def test_a_table_in_a_macro_counts_nothing() -> None:
    rows = "".join(f"    X(A{k}, k == {k} && k ? 1 : 0) \\\n" for k in range(40))
    text = f"#define ROWS(X) \\\n{rows}    X(LAST, 0)\n\n#define PICK(a, b) if (k == a) return b;\n"
    text += "static int pick(int k)\n{\n    ROWS(PICK)\n    return 0;\n}\n"
    assert [f.cyclomatic_complexity for f in functions("a.c", text)] == [1]
