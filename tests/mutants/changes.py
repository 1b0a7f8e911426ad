"""Changes of one line, by rule: what a slip of the hand or of the mind would make of it."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

# What a change replaces, and by what. Blanks around an operator tell it from a sign or a pointer.
_SWAPS = {
    " < ": " <= ",
    " <= ": " < ",
    " > ": " >= ",
    " >= ": " > ",
    " == ": " != ",
    " != ": " == ",
    " + ": " - ",
    " - ": " + ",
    " * ": " / ",
    " / ": " * ",
    " += ": " -= ",
    " -= ": " += ",
}
_SWAPS_C = _SWAPS | {" && ": " || ", " || ": " && "}
_SWAPS_PYTHON = _SWAPS | {" and ": " or ", " or ": " and ", " not in ": " in ", "True": "False"}
_NUMBER = re.compile(r"(?<![\w.\"])\d+(?![\w.])")
_IF_C = re.compile(r"^(\s*(?:else )?if )\((.*)\) \{$")
# What cannot become nothing: a head of lines, and what ends a function.
_HEAD_OR_END = re.compile(r" *(return|raise|.*: *(#.*)?$)")
_IF_PYTHON = re.compile(r"^(\s*(?:el)?if )(.*):$")
_STATEMENT_C = re.compile(
    r"^\s+(?!return|break|continue|goto|const|static|struct|typedef)[\w.\[\]>(*-][^{}]*;$"
)
# Places of a declared array: one more of them holds what the others did.
_PLACES_C = re.compile(r"^\s+(?!return|else|goto|case)(?:\w+ )+\**\w+((?:\[[\w +]+\])+)(?= = |;)")
# The less or the greater of two, which are one if they are equal.
_EXTREME_C = re.compile(
    r"(?:(?<=[(\[])|(?<=[=,?:] )|(?<=return ))"
    r"((?:\(\w+\))?[\w.>\[\]-]+) [<>] ((?:\(\w+\))?[\w.>\[\]-]+)"
    r" \? (?:\1 : \2|\2 : \1)(?=[;,)\]])"
)
# The length that numpy finds by itself, for which any number below 0 stands.
_ANY_LENGTH_PYTHON = re.compile(r"\.reshape\([^=]*-$")
# Lines that say what is there, or for a checker alone.
_NO_TEST = ("import ", "from ", "_Static_assert", "assert ", "@", "if TYPE_CHECKING:")
_DECLARED_C = re.compile(r"^\s+(?:\w+ )+\**\w+(?:\[.*\])?(?: = .*)?;$")


@dataclass(frozen=True)
class Change:
    """A line of a file, counted from 1, and what it becomes."""

    file: Path
    line: int
    was: str
    became: str

    def text(self, whole: str) -> str:
        """The file with it."""
        lines = whole.split("\n")
        assert lines[self.line - 1] == self.was
        lines[self.line - 1] = self.became
        return "\n".join(lines)


def _bare(text: str) -> list[str]:
    """The lines of a C text with blanks in place of comments, strings and directives."""
    blank = re.compile(
        r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|^\s*#(?:\\\n|[^\n])*', re.DOTALL | re.MULTILINE
    )
    return blank.sub(lambda m: re.sub(r"[^\n]", "\0", m[0]), text).split("\n")


def _code(text: str) -> list[str]:
    """The lines of a Python text with blanks in place of strings, comments and annotations."""
    lines = [re.sub(r"#.*$", lambda m: "\0" * len(m[0]), x) for x in text.split("\n")]
    for node in ast.walk(ast.parse(text)):
        hides = isinstance(node, ast.JoinedStr) or (
            isinstance(node, ast.Constant) and isinstance(node.value, str)
        )
        if hides and node.end_lineno is not None:
            for k in range(node.lineno - 1, node.end_lineno):
                first = node.col_offset if k == node.lineno - 1 else 0
                last = node.end_col_offset if k == node.end_lineno - 1 else len(lines[k])
                assert last is not None
                lines[k] = lines[k][:first] + "\0" * (last - first) + lines[k][last:]
    return lines


def _whole(text: str) -> set[int]:
    """The lines of a Python text that are a statement, or the head of an if, by themselves."""
    kinds = ast.If | ast.Assign | ast.AugAssign | ast.Expr | ast.Return | ast.Raise
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, kinds):
            last = node.test if isinstance(node, ast.If) else node
            if node.lineno == last.end_lineno:
                found.add(node.lineno)
    return found


def _changes_nothing(bare: str, at: int, new: str) -> bool:
    """What C needs no test for, whatever stands around it."""
    places = _PLACES_C.match(bare)
    return bool(places and places.start(1) <= at < places.end(1)) or any(
        new in (" <= ", " >= ") and m.start() <= at < m.end() for m in _EXTREME_C.finditer(bare)
    )


def _of_line(bare: str, line: str, python: bool, whole: bool) -> Iterator[str]:
    for old, new in (_SWAPS_PYTHON if python else _SWAPS_C).items():
        for m in re.finditer(re.escape(old), bare):
            if python or not _changes_nothing(bare, m.start(), new):
                yield line[: m.start()] + new + line[m.end() :]
    for m in _NUMBER.finditer(bare):
        counted = python and not _ANY_LENGTH_PYTHON.search(bare[: m.start()])
        if counted or not (python or _changes_nothing(bare, m.start(), "more")):
            yield f"{line[: m.start()]}{int(m[0]) + 1}{line[m.end() :]}"
    indent = line[: len(line) - len(line.lstrip())]
    if python:
        if whole and (m := _IF_PYTHON.match(bare)):
            yield f"{m[1]}not ({line[m.start(2) : m.end(2)]}):"
        elif whole and indent and not _HEAD_OR_END.match(line) and not line.endswith(": ..."):
            yield f"{indent}pass"
    else:
        if m := _IF_C.match(bare):
            yield f"{m[1]}(!({line[m.start(2) : m.end(2)]})) {{"
        if (
            _STATEMENT_C.match(bare)
            and not _DECLARED_C.match(bare)
            and bare.count("(") == bare.count(")")
        ):
            yield f"{indent};"


def changes(file: Path, text: str) -> Iterator[Change]:
    """All changes of a file."""
    python = file.suffix == ".py"
    whole = _whole(text) if python else set()
    bare_lines = (_code if python else _bare)(text)
    for k, (bare, line) in enumerate(zip(bare_lines, text.split("\n"), strict=True)):
        code = bare.strip("\0 ")
        if code and not code.startswith(_NO_TEST):
            for became in dict.fromkeys(_of_line(bare, line, python, k + 1 in whole)):
                yield Change(file, k + 1, line, became)
