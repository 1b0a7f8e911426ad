"""Sentences of pages, commands' helps and public docstrings: how long they are, and their words.

``python tests/helpers/plain_english.py`` prints what breaks the rules and fails then.
"""

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token

ROOT = Path(__file__).resolve().parents[2]
LONGEST = 40  # words of one sentence
MEAN = 25  # words of a page's sentences, on average
FEW = 5  # sentences below which an average says nothing

# What a word says instead; where it says nothing, the word goes.
FORBIDDEN = {
    "simply": "",
    "obviously": "",
    "of course": "",
    "please note": "",
    "seamless": "",
    "seamlessly": "",
    "powerful": "what it does",
    "cutting-edge": "",
    "state-of-the-art": "",
    "blazing": "a figure",
    "leverage": "use",
    "utilize": "use",
    "in order to": "to",
    "lag error": "following error",
}

ABBREVIATION = re.compile(
    r"(?:^|[\s(\[])(?:e\.g|i\.e|cf|vs|approx|resp|Figs?|Eqs?|Sec|No|Nos|Vol|pp?|Dr|ed|al)\.$"
)
END = re.compile(r"[.!?][\"')\]]*(?=\s+[\"'(\[]*(?:[A-Z0-9\u00c0-\u00de]|[a-z]\w*_))")
FORMULA = re.compile(r"\$\$.*?\$\$|(?<![\\\w])\$[^$]+\$", re.DOTALL)
WORD = re.compile(r"[^\W_]")
PLAINER = re.compile(rf"(?<![\w-])(?:{'|'.join(FORBIDDEN)})(?![\w-])", re.IGNORECASE)


@dataclass(frozen=True)
class Sentence:
    """One sentence, the line it begins in and whether it is prose (no heading, no cell)."""

    line: int
    text: str
    prose: bool = True

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
    return FORMULA.sub(lambda m: "X" + "\n" * m.group().count("\n"), "".join(parts))


def of_markdown(text: str) -> Iterator[Sentence]:
    """The sentences of a Markdown page; a block of code or formulas has none."""
    kept = re.sub(  # a page's front matter and formulas that stand alone keep their lines
        r"\A---\n.*?\n---\n|^\$\$.*?\$\$",
        lambda m: "\n" * m.group().count("\n"),
        text,
        flags=re.DOTALL | re.MULTILINE,
    )
    within = ""
    for token in MarkdownIt("commonmark").enable("table").parse(kept):
        if token.type in ("heading_open", "th_open", "td_open", "paragraph_open"):
            within = token.type
        elif token.type == "inline" and token.map:
            yield from sentences(plain(token), token.map[0] + 1, within == "paragraph_open")


def first_sentence(doc: str, line: int) -> Iterator[Sentence]:
    """The first sentence of a docstring or comment, its code a word each."""
    text = re.sub(r"``[^`]*``|`[^`]*`", "X", doc.split("\n\n")[0])
    yield from list(sentences(text, line))[:1]


def definitions(tree: ast.Module) -> Iterator[ast.Module | ast.ClassDef | ast.FunctionDef]:
    """A module, its classes and functions, and the methods of its classes."""
    yield tree
    for node in tree.body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            yield node
        if isinstance(node, ast.ClassDef):
            yield from (each for each in node.body if isinstance(each, ast.FunctionDef))


def of_python(text: str) -> Iterator[Sentence]:
    """First sentences of public docstrings, and every ``help=`` of a command."""
    tree = ast.parse(text)
    for node in definitions(tree):
        name = getattr(node, "name", "module")
        if not name.startswith("_") and (doc := ast.get_docstring(node)):
            yield from first_sentence(doc, node.body[0].lineno)
    if "help=" not in text:
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.keyword) and node.arg == "help":
            if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
                yield from sentences(re.sub(r"`[^`]*`", "X", node.value.value), node.value.lineno)


def of_header(text: str) -> Iterator[Sentence]:
    """First sentences of a header's comments that stand in lines of their own."""
    for found in re.finditer(r"^[ \t]*/\*(.*?)\*/", text, re.DOTALL | re.MULTILINE):
        lines = [re.sub(r"^\s*\* ?", "", line) for line in found[1].splitlines()]
        yield from first_sentence("\n".join(lines), text.count("\n", 0, found.start()) + 1)


READERS = {".md": of_markdown, ".py": of_python, ".h": of_header}


def breaks(name: str, text: str) -> list[str]:
    """What a file's text breaks, a line each: file, line, words, the beginning, what to do."""
    found = list(READERS[Path(name).suffix](text))
    out = []
    for one in found:
        beginning = " ".join(one.text.split()[:8])
        where = f"{name}:{one.line}:"
        if one.words > LONGEST:
            out.append(
                f'{where} {one.words} words, at most {LONGEST}: "{beginning} ..."; '
                "make it two sentences with a verb each"
            )
        for word in PLAINER.findall(" ".join(one.text.split())):
            better = FORBIDDEN[word.lower()]
            do = f'say "{better}"' if better else "leave it out"
            out.append(f'{where} "{word}" in "{beginning} ..."; {do}')
    prose = [one.words for one in found if one.prose]
    if name.endswith(".md") and len(prose) >= FEW and sum(prose) >= MEAN * len(prose):
        most = max((one for one in found if one.prose), key=lambda one: one.words)
        mean = sum(prose) / len(prose)
        out.append(
            f"{name}:{most.line}: {mean:.1f} words a sentence on average, below {MEAN}; split the "
            f'longest first, "{" ".join(most.text.split()[:8])} ..." of {most.words}'
        )
    return out


def files(root: Path = ROOT) -> list[str]:
    """Every file that is held, by its name from the root."""
    pages = [
        "README.md",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "DESIGN.md",
        "SECURITY.md",
        "docs/**/*.md",
    ]
    pages += [f"{folder}/**/README.md" for folder in ("examples", "fmus", "modelica", "scenarios")]
    pages += ["src/**/README.md", "tests/**/README.md", "src/motionfmu/**/*.py", "src/*/*/*.h"]
    return sorted({str(path.relative_to(root)) for glob in pages for path in root.glob(glob)})


def main(root: Path = ROOT) -> int:
    """Print what breaks the rules."""
    out = [said for f in files(root) for said in breaks(f, (root / f).read_text(encoding="utf-8"))]
    print(*out, sep="\n", end="\n" if out else "")
    return 1 if out else 0


if __name__ == "__main__":
    sys.exit(main())
