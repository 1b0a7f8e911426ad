"""Words that the source says of the fields of a class: comments beside them, its docstring."""

import ast
import inspect
import re
import tokenize
from io import StringIO
from textwrap import dedent


def words_of(kind: type) -> dict[str, str]:
    """Words by field, of the class and of those that it extends."""
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        if "__annotations__" in vars(base) and base.__module__.startswith("motionfmu"):
            source = dedent(inspect.getsource(base))
            found |= attributes(base.__doc__ or "") | comments(source)
    return found


def comments(source: str) -> dict[str, str]:
    """Comment of each field of a class: behind it, else in the lines right above it."""
    lines = _comment_lines(source)
    bare = {
        token.start[0]: token.string.lstrip("# ").rstrip()
        for token in tokenize.generate_tokens(StringIO(source).readline)
        if token.type == tokenize.COMMENT
    }
    found = {}
    fields = (n for n in _body(source) if isinstance(n, ast.AnnAssign))
    for node in fields:
        first, last = node.lineno, node.end_lineno or node.lineno
        beside = [bare[n] for n in range(first, last + 1) if n in bare and bare[n] != "fmt: skip"]
        above: list[str] = []
        line = first - 1
        while line in lines:
            above.insert(0, bare[line])
            line -= 1
        if told := beside or above:
            found[ast.unparse(node.target)] = " ".join(told)
    return found


def _comment_lines(source: str) -> set[int]:
    """Numbers of the lines that have nothing but a comment."""
    return {n for n, line in enumerate(source.splitlines(), 1) if line.lstrip().startswith("#")}


def _body(source: str) -> list[ast.stmt]:
    found = ast.parse(source).body[0]
    assert isinstance(found, ast.ClassDef)
    return found.body


def attributes(doc: str) -> dict[str, str]:
    """Words of a numpydoc section of attributes, by name."""
    text = inspect.cleandoc(doc)
    if "Attributes\n----------\n" not in text:
        return {}
    part = text.split("Attributes\n----------\n", 1)[1]
    found = {}
    for names, told in re.findall(
        r"^(\w[\w, ]*) : .*\n((?:    .*\n?)+)", part + "\n", re.MULTILINE
    ):
        for name in names.split(", "):
            found[name] = " ".join(told.split())
    return found
