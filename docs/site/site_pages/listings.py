"""Pages of single files of the project that another page links."""

from html import escape
from pathlib import Path

from pygments import highlight
from pygments.formatters.html import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound

LARGEST = 200_000  # [characters] of a file that is shown


def listing(root: Path, name: str) -> str:
    """A file, or the names within a folder, as HTML."""
    file = root / name
    if file.is_dir():
        rows = sorted(p.name + "/" * p.is_dir() for p in file.iterdir() if p.name[0] not in "._")
        return (
            f"<h1>{escape(name)}/</h1>\n<ul>{''.join(f'<li>{escape(r)}</li>' for r in rows)}</ul>\n"
        )
    text = file.read_text(encoding="utf-8", errors="replace")[:LARGEST]
    try:
        lexer = get_lexer_for_filename(file.name)
    except ClassNotFound:
        lexer = TextLexer()
    shown = highlight(text, lexer, HtmlFormatter(nowrap=True))
    return (
        f'<h1>{escape(name)}</h1>\n<div class="highlight"><pre tabindex="0">{shown}</pre></div>\n'
    )
