"""Sentences that people read: of Markdown, Python, C, Modelica and TOML, each with its line."""

import ast
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token

ABBREVIATION = re.compile(
    r"(?:^|[\s(\[])(?:e\.g|i\.e|cf|vs|approx|resp|Figs?|Eqs?|Sec|No|Nos|Vol|pp?|Dr|ed|al)\.$"
)
END = re.compile(r"[.!?][\"')\]]*(?=\s+[\"'(\[]*(?:[A-Z0-9\u00c0-\u00de]|[a-z]\w*_))")
FORMULA = re.compile(r"\$\$.*?\$\$|(?<![\\\w])\$[^$]+\$", re.DOTALL)
WORD = re.compile(r"[^\W_]")

CODE = re.compile(r"``.+?``|`[^`\n]*(?:\n[^`\n]+)*`", re.DOTALL)
ITEM = re.compile(r"(?:[-*+•]|\d+[.)]|\(\d+\))\s+")
TYPED = re.compile(r"\*{0,2}[\w.]+(?:, \*{0,2}[\w.]+)* : .*")  # of numpydoc: name : type
NAME = re.compile(r"[a-z][^\sA-Z]*")
TITLE = 60  # columns below which a line above a deeper one is a title or a term
RULE = re.compile(r"[-=~^ ]{3,}")
COLUMNS = re.compile(r" {2,}")  # between the columns of a drawing, a listing or a table
PLAIN = re.compile(
    r"(?<!\S)[(\[]?[A-Za-z][a-z'-]*[)\]]?[,.;:]?(?!\S)"
)  # a word, no name or formula

BLOCK = re.compile(r"</?(?:p|div|li|ul|ol|t[dhr]|table|h\d|br|dt|dd|section|figcaption)\b[^>]*>")
TAG = re.compile(r"</?[a-z][^<>]*>")
STYLE = re.compile(r"[^{}]*\{[^{}]*:[^{}]*;[^{}]*\}")  # a rule of CSS
SPAN = re.compile(r"<(code|kbd|style|script)\b[^>]*>.*?</\1>", re.DOTALL)


@dataclass(frozen=True)
class Sentence:
    """One sentence, the line it begins in and whether it is prose (no heading, no cell)."""

    line: int
    text: str
    prose: bool = True

    @property
    def name(self) -> bool:
        """Whether it is a name of code, alone or with its type, and no text."""
        return NAME.fullmatch(self.text) is not None or TYPED.fullmatch(self.text) is not None

    @property
    def words(self) -> int:
        return sum(1 for word in self.text.split() if WORD.search(word))


def sentences(text: str, line: int, prose: bool = True) -> Iterator[Sentence]:
    """The sentences of a plain text that begins in ``line``."""
    begin = 0
    ends = [m.end() for m in END.finditer(text) if not ABBREVIATION.search(text[: m.start() + 1])]
    for end in [*ends, len(text)]:
        piece = text[begin:end]
        blank = len(piece) - len(piece.lstrip())
        if piece.strip():
            yield Sentence(line + text.count("\n", 0, begin + blank), piece.strip(), prose)
        begin = end


# Markdown.


def plain(inline: Token) -> str:
    """An inline's text; code, formula and image are a word each, and lines end where they did."""
    parts = []
    for child in inline.children or []:
        if child.type == "text":
            parts.append(child.content)
        elif child.type in ("softbreak", "hardbreak"):
            parts.append("\n")
        elif child.type == "code_inline":
            parts.append("X" + "\n" * child.content.count("\n"))
        elif child.type == "image":
            parts.append("X")
    return FORMULA.sub(a_word, "".join(parts))


def a_word(found: re.Match[str]) -> str:
    """One word for code or a formula, with its line ends."""
    return "X" + "\n" * found.group().count("\n")


def of_markdown(text: str) -> Iterator[Sentence]:
    """The sentences of a Markdown page; a block of code or formulas has none."""
    kept = re.sub(  # a page's front matter and formulas that stand alone keep their lines
        r"\A---\n.*?\n---\n|^\$\$.*?\$\$",
        _blank,
        text,
        flags=re.DOTALL | re.MULTILINE,
    )
    within = ""
    for token in MarkdownIt("commonmark").enable("table").parse(kept):
        if token.type in ("heading_open", "th_open", "td_open", "paragraph_open"):
            within = token.type
        elif token.type == "inline" and token.map:
            yield from sentences(plain(token), token.map[0] + 1, within == "paragraph_open")


# Plain texts: docstrings, comments, strings.


def paragraphs(text: str, line: int) -> Iterator[tuple[int, str]]:
    """Texts of their own with their lines: paragraphs, items of a list, terms, cells of columns.

    No line vanishes but an example behind ``>>>`` and a block behind ``::``, and a text goes on in
    the line below unless a rule ends it: so a long sentence cannot hide by the way it is laid out.
    """
    held: list[str] = []
    begin, first, at, literal = line, 0, 0, -1  # columns where the text begins and goes on
    example = False
    for number, each in enumerate(text.expandtabs().splitlines(), line):
        bare, deep = each.strip(), _indent(each)
        example = bool(bare) and (example or bare.startswith(">>> "))
        literal = -1 if bare and deep <= literal else literal
        skipped = not bare or RULE.fullmatch(bare) is not None or example or literal >= 0
        cells = COLUMNS.split(bare) if deep else [bare]  # at the margin is prose
        if held and (skipped or len(cells) > 1 or _begins(each, held, first, at)):
            yield begin, "\n".join(held)
            held = []
        if skipped:
            continue
        yield from ((number, cell) for cell in cells[:-1])
        at = each.rindex(cells[-1])
        begin, first = (begin, first) if held else (number, at)
        held.append(cells[-1])
        literal = deep if bare.endswith("::") else literal
        if TYPED.fullmatch(bare) or (deep and _coded(bare)):
            yield begin, "\n".join(held)
            held = []
    if held:
        yield begin, "\n".join(held)


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())


def _begins(line: str, held: list[str], first: int, at: int) -> bool:
    """Whether a line begins a text of its own behind those that are held."""
    bare, deep = line.strip(), _indent(line)
    item = ITEM.match(held[0])
    if deep > at and len(held) == 1:  # below a term, a title or a line that introduces it
        return not item and (len(held[0]) < TITLE or held[0].endswith((".", ":")))
    if deep < first or (item and deep == first):
        return True
    return ITEM.match(bare) is not None or TYPED.fullmatch(bare) is not None


def _coded(line: str) -> bool:
    """Whether a line is a formula, data or a drawing: less than half of it are words."""
    return 2 * len(PLAIN.findall(line)) < len(line.split())


def of_text(text: str, line: int) -> Iterator[Sentence]:
    """The sentences of a docstring or comment; code is a word."""
    for begin, each in paragraphs(CODE.sub(a_word, text), line):
        yield from sentences(ITEM.sub("", each, count=1) if ITEM.match(each) else each, begin)


def of_literal(text: str, line: int) -> Iterator[Sentence]:
    """The sentences of a text that a program writes: of a block of HTML each, of C its comments."""
    if re.search(r"^#(?:include|define|if)", text, re.MULTILINE):
        yield from of_header(text)
        return
    text = BLOCK.sub("\n\n", STYLE.sub("", SPAN.sub(a_word, text)))
    yield from (Sentence(line, one.text) for one in of_text(TAG.sub("", text), line))


def of_html(text: str) -> Iterator[Sentence]:
    """The sentences of a page's HTML, without its scripts."""
    return of_literal(text, 1)


# Languages.

STRING = r'"(?:[^"\\\n]|\\.)*"'
LABEL = re.compile(r" ?[A-Z][\w ]{0,30}: ")  # of what a command wrote into a file, a line each


def of_python(text: str) -> Iterator[Sentence]:
    """The sentences of docstrings and of all texts that a module has as values."""
    tree = ast.parse(text)
    docs = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            if doc := ast.get_docstring(node):
                docs.add(id(node.body[0].value))  # type: ignore[attr-defined]
                yield from of_text(doc, node.body[0].lineno)
    yield from _of_values(tree, docs)


def _of_values(node: ast.AST, docs: set[int]) -> Iterator[Sentence]:
    """Sentences of the texts below a node; what is worked out inside one is a word."""
    if isinstance(node, ast.JoinedStr | ast.BinOp) or isinstance(node, ast.Constant):
        text = _value(node)
        if text is not None and id(node) not in docs:
            yield from of_literal(text, node.lineno)
    inner: Iterable[ast.AST] = ast.iter_child_nodes(node)
    if isinstance(node, ast.JoinedStr):
        inner = [v.value for v in node.values if isinstance(v, ast.FormattedValue)]
    elif isinstance(node, ast.BinOp) and _value(node) is not None:
        inner = [each for each in _summands(node) if _value(each) is None]
    for child in inner:
        yield from _of_values(child, docs)


def _summands(node: ast.AST) -> list[ast.AST]:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return [*_summands(node.left), *_summands(node.right)]
    return [node]


def _value(node: ast.AST) -> str | None:
    """The text of a value, None if it is none; what is worked out in it is a word."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else None
    if isinstance(node, ast.JoinedStr):
        return "".join(_value(each) or "X" for each in node.values)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        found = [_value(each) for each in _summands(node)]
        if any(each is not None for each in found):
            return "".join("X" if each is None else each for each in found)
    return None


def of_header(text: str) -> Iterator[Sentence]:
    """The sentences of a header's comments; the lines of one are one text."""
    for found in re.finditer(rf"{STRING}|/\*(.*?)\*/|//([^\n]*)", text, re.DOTALL):
        comment = found[1] or found[2]
        if comment:
            lines = [re.sub(r"^\s*\*(?: |$)|^ (?=\S)", "", line) for line in comment.splitlines()]
            yield from of_text("\n".join(lines), text.count("\n", 0, found.start()) + 1)


def of_code(text: str) -> Iterator[Sentence]:
    """The sentences of the texts in C; those in a row are one."""
    bare = re.sub(
        rf"({STRING})|/\*.*?\*/|//[^\n]*", lambda m: m[1] or _blank(m), text, flags=re.DOTALL
    )
    for found in re.finditer(rf"{STRING}(?:[\s+]*(?:[A-Z]\w*\s*)?{STRING})*", bare):
        joined = "".join(each[1:-1] for each in re.findall(STRING, found.group()))
        joined = joined.replace("\\n", "\n").replace('\\"', "'")
        yield from of_literal(joined, bare.count("\n", 0, found.start()) + 1)


def of_c(text: str) -> Iterator[Sentence]:
    """The sentences of the texts and of the comments of a C file."""
    yield from of_code(text)
    yield from of_header(text)


def of_script(text: str) -> Iterator[Sentence]:
    """The sentences of the texts in JavaScript; what a template works out is a word."""
    return of_code(re.sub(r"`((?:[^`\\]|\\.)*)`", _no_template, text))


def _no_template(found: re.Match[str]) -> str:
    text = re.sub(r"\$\{[^{}]*\}", "X", found[1]).replace('"', "'")
    return '"' + text.replace("\n", " ") + '"' + _blank(found)


def of_modelica(text: str) -> Iterator[Sentence]:
    """The sentences of descriptions and comments of Modelica; a description may have lines."""
    many = STRING.replace(r"\n", "")
    for found in re.finditer(rf"{many}|/\*(.*?)\*/|//([^\n]*)", text, re.DOTALL):
        said = found[1] or found[2] or found.group()[1:-1]
        yield from of_literal(said, text.count("\n", 0, found.start()) + 1)


def _blank(found: re.Match[str]) -> str:
    return "\n" * found.group().count("\n")


def of_toml(text: str) -> Iterator[Sentence]:
    """The sentences of a TOML file's comments and texts; comment lines in a row are one."""
    held: list[str] = []
    begin = 0
    for number, line in enumerate([*text.splitlines(), ""], 1):
        comment = line[1:] if line.startswith("#") else None
        if held and (comment is None or LABEL.match(comment)):
            yield from of_text("\n".join(held), begin)
            held = []
        if comment is not None:
            begin = begin if held else number
            held.append(comment.removeprefix(" "))
            continue
        for found in re.finditer(rf"{STRING}|'[^'\n]*'|#(.*)", line):
            yield from of_literal(found[1] or found.group()[1:-1], number)


READERS = {
    ".md": of_markdown,
    ".py": of_python,
    ".h": of_header,
    ".c": of_c,
    ".html": of_html,
    ".inc": of_c,
    ".js": of_script,
    ".mo": of_modelica,
    ".toml": of_toml,
}


def of_file(name: str, text: str) -> list[Sentence]:
    """The sentences of a file by its name."""
    return list(READERS[Path(name).suffix](text))
