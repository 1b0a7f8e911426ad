"""What the notebook views of a run, a loop, a tuning, a comparison and a study have in common."""

import base64
import io
from collections.abc import Iterable, Sequence
from html import escape

from matplotlib.figure import Figure
from PIL import Image

from motionfmu.report.dark_figure import darkened

# Width [pixel] of a view's picture; the file has twice as many.
WIDTH = 680
# The same of a path, and its width [inch] as it is drawn.
PATH_WIDTH, PATH_INCHES = 400, 5.2
# A picture has so many colours: a quarter of the bytes, and no eye sees it.
_COLORS = 256
# Text takes the colour of the page that it stands on; a picture has its own ground, light or dark.
# A notebook that says what it is decides, in JupyterLab, VS Code or Colab; else the browser.
_SAID = '[data-jp-theme-light="true"], .vscode-light, html[theme="light"]'
_DARK = ('[data-jp-theme-light="false"]', ".vscode-dark", 'html[theme="dark"]')
# A notebook has rules of its own for tables, which are stronger but for "important".
STYLE = """
.motionfmu { font: 13px/1.45 Inter, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
.motionfmu p { margin: 0 0 8px; }
.motionfmu .head b { font-size: 16px; }
.motionfmu .sub { opacity: .7; }
.motionfmu .row { display: flex; flex-wrap: wrap; gap: 12px 28px; align-items: flex-start; }
.motionfmu .row > div { min-width: 0; max-width: 100%; }
.motionfmu .scroll { overflow-x: auto; }
.motionfmu img { border-radius: 6px; max-width: 100%; margin: 0; }
.motionfmu table { border-collapse: collapse; margin: 0 0 12px; font-size: 13px; }
.motionfmu tr { background: none !important; }
.motionfmu th, .motionfmu td { border: 0;
  text-align: left !important; padding: 2px 14px 2px 0 !important;
  border-bottom: 1px solid rgba(128, 128, 128, .3); background: none; vertical-align: top; }
.motionfmu th { font-weight: 600; opacity: .7; }
.motionfmu .n { text-align: right !important; white-space: nowrap;
  font-variant-numeric: tabular-nums; }
.motionfmu .ok { color: #2a9d5c; font-weight: 600; }
.motionfmu .failed { color: #e5533d; font-weight: 600; }
.motionfmu summary { cursor: pointer; opacity: .7; }
"""


def _shown_where(page: str) -> str:
    """The rules that show the dark picture and hide the light one on a page."""
    return (
        f"{page} .motionfmu .light {{ display: none; }}"
        f" {page} .motionfmu .dark {{ display: inline; }}\n"
    )


_UNSAID = _shown_where(f":root:not(:has({_SAID}), {_SAID})")
STYLE += "".join(map(_shown_where, _DARK))
STYLE += f"@media (prefers-color-scheme: dark) {{\n{_UNSAID}}}\n"


class NotebookFigure(Figure):
    """A figure that a notebook shows, also one in which nothing has loaded pyplot."""

    def _repr_png_(self) -> bytes:
        return png(self, WIDTH)

    def _repr_html_(self) -> str:
        return f'<div class="motionfmu"><style>{STYLE}</style>{images(self, "figure")}</div>'


def png(figure: Figure, width: float) -> bytes:
    """A figure as a file, for a picture so wide [pixel] on a screen with two dots in each."""
    whole, few = io.BytesIO(), io.BytesIO()
    figure.savefig(whole, format="png", dpi=2 * width / figure.get_figwidth())
    picture = Image.open(whole).convert("RGB")
    few_colors = picture.quantize(_COLORS, dither=Image.Dither.NONE)
    few_colors.save(few, format="png", optimize=True)
    return few.getvalue()


def images(figure: Figure, alt: str, width: int = WIDTH) -> str:
    """A figure in two pictures, of which a page shows the one that suits it."""
    light = _image('class="light"', png(figure, width), alt, width)
    with darkened(figure):
        dark = _image('class="dark" hidden="hidden"', png(figure, width), alt, width)
    return light + dark


def _image(look: str, file: bytes, alt: str, width: int) -> str:
    data = base64.b64encode(file).decode()
    about = f'{look} width="{width}" alt="{escape(alt)}"'
    return f'<img {about} src="data:image/png;base64,{data}"/>'


def view(head: str, *parts: str) -> str:
    """The whole of a view: its first line, and the HTML below it."""
    inner = "".join(parts)
    return f'<div class="motionfmu"><style>{STYLE}</style><p class="head">{head}</p>{inner}</div>'


def beside(left: str, right: str) -> str:
    """Tables, and a picture that stands beside them where there is room."""
    return f'<div class="row"><div>{left}</div>{right}</div>'


def cells(heads: Sequence[str], rows: Iterable[Sequence[str]], numeric: Sequence[int] = ()) -> str:
    """A table of ready HTML; numeric columns stand to the right."""

    def line(tag: str, texts: Sequence[str]) -> str:
        kinds = [' class="n"' if i in numeric else "" for i in range(len(texts))]
        parts = (f"<{tag}{k}>{c}</{tag}>" for k, c in zip(kinds, texts, strict=True))
        return f"<tr>{''.join(parts)}</tr>"

    body = "".join(line("td", row) for row in rows)
    head = f"<thead>{line('th', heads)}</thead>" if any(heads) else ""
    return f'<div class="scroll"><table>{head}<tbody>{body}</tbody></table></div>'
