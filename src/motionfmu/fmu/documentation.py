"""Documentation in an FMU: a page made from its README and variables, an icon, a licence."""

import html
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

from motionfmu.base import units
from motionfmu.fmu import licence, terminals
from motionfmu.fmu.describe import Description, Variable

VARIABLES = "variables.html"  # the part of the page that is generated from a description
TERMINALS = "terminals.xml"
PNG_SIZE = 400  # [pixel]
_ICON = Path(__file__).with_name("icon.svg")  # of an FMU that has none
_SVG = "http://www.w3.org/2000/svg"
_HEADINGS = {
    "parameter": "Parameters",
    "input": "Inputs",
    "output": "Outputs",
    "local": "Local variables",
}
# Its colours are those of the report's pages, which stand further down the way of the data.
_STYLE = """
:root { color-scheme: light dark; --ink: #1b2733; --muted: #5b6b7a; --line: #d5dee5;
  --accent: #0b6e99; --panel: #fff; --shade: #f1f5f8 }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8eef4; --muted: #93a3b2; --line: #33424f; --accent: #56a8f5; --panel: #0d141b;
    --shade: #1a2631 }
  header svg { background: #e8eef4; border-radius: 8px }
}
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--panel);
  max-width: 75rem; margin: 2rem auto; padding: 0 1rem; overflow-wrap: break-word }
header { display: flex; gap: 1.5rem; align-items: center; border-bottom: 2px solid var(--accent) }
header svg { width: 7rem; height: 7rem; flex: none; margin-bottom: 1rem }
h1 { margin: 0 } h2 { margin-top: 2.5rem; color: var(--accent) } header p { margin: .3rem 0 1rem }
code, pre { font: 14px/1.45 ui-monospace, monospace; background: var(--shade); border-radius: 3px }
code { padding: 0 .2em } pre { padding: .7rem 1rem; overflow-x: auto } pre code { padding: 0 }
table { border-collapse: collapse; width: 100%; font-size: 14px; display: block; overflow-x: auto }
th, td { text-align: left; vertical-align: top; padding: .25rem .7rem .25rem 0;
  border-bottom: 1px solid var(--line) }
td:first-child { font-family: ui-monospace, monospace; white-space: nowrap }
td.n { white-space: nowrap } td:last-child { width: 100%; min-width: 16rem }
nav a { margin-right: 1rem } a { color: var(--accent) }
footer { margin: 3rem 0; color: var(--muted); font-size: 14px }
"""


def _number(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _start(v: Variable) -> str:
    """Text of start values: a single one if all are equal, else the first nine at most."""
    texts = [_number(x) if x != "" else '""' for x in v.start or []]
    if len(set(texts)) <= 1:
        return "".join(texts[:1])
    return ", ".join(texts[:9]) + (" ..." if len(texts) > 9 else "")


def _range(v: Variable) -> str:
    if v.min is None and v.max is None:
        return ""
    low = "" if v.min is None else _number(v.min)
    return f"{low} .. {'' if v.max is None else _number(v.max)}"


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{text}</th>" for text in headings)
    cells = []
    for row in rows:
        *short, last = (html.escape(text, quote=False) for text in row)
        joined = "".join(f'<td class="n">{text}</td>' for text in short)
        cells.append(f"<tr>{joined}<td>{last}</td></tr>\n")
    return f"<table><thead><tr>{head}</tr></thead>\n<tbody>\n{''.join(cells)}</tbody></table>\n"


def _kind(v: Variable) -> str:
    name = {"f64": "real", "i32": "integer", "bool": "Boolean", "string": "text"}[v.type]
    return name + "".join(f"[{n}]" for n in v.dims) + (", tunable" if v.tunable else "")


def _sections(d: Description) -> Iterator[str]:
    ms = f"{d.step * 1e3:.10g} ms"
    step = f"Communication steps may be of any size: see <code>{d.strict}</code>. "
    if d.grid:
        step += f"Inside it steps by <code>{d.grid}</code>, {ms} if that is left alone."
    else:
        step += f"Inside it steps by {ms}."
    yield f'<h2 id="steps">Steps</h2>\n<p>{step}</p>\n'
    if d.terminals:
        kinds = [
            (t.name, t.kind, ", ".join(m if m == v else f"{m} = {v}" for m, v in t.members), t.doc)
            for t in d.terminals
        ]
        yield '<h2 id="terminals">Terminals</h2>\n<p>Terminals of one kind go together.</p>\n'
        yield "<table><thead><tr><th>name</th><th>kind</th><th>what, and its members</th></tr>"
        yield "</thead>\n<tbody>\n"
        for name, kind, members, doc in kinds:
            told = f"{html.escape(doc)}: <code>{html.escape(members)}</code>"
            yield f'<tr><td>{name}</td><td class="n">{kind}</td><td>{told}</td></tr>\n'
        yield "</tbody></table>\n"
    for causality, heading in _HEADINGS.items():
        rows = [v for v in d.variables if v.causality == causality]
        if not rows:
            continue
        yield f'<h2 id="{causality}">{heading}</h2>\n'
        set_here = causality in ("parameter", "input")
        more = ("start", "range") if set_here else ()
        cells = []
        for v in rows:
            between = (_start(v), _range(v)) if set_here else ()
            cells.append((v.name, _kind(v), units.spelled(v.unit), *between, v.doc))
        yield _table(("name", "type", "unit", *more, "meaning"), cells)


def variables(d: Description) -> str:
    """The part of the page with steps, terminals and variables."""
    return "".join(_sections(d))


def _readme(text: str) -> str:
    """Markdown as HTML; of pictures, and of links to files outside the archive, the words stay."""
    from markdown_it import MarkdownIt

    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = markdown.parse(text)
    for token in tokens:
        inside, hidden = [], 0
        for child in token.children or []:
            address = child.attrGet("href") if child.type == "link_open" else None
            if child.type == "link_open" and not str(address).startswith(("http:", "https:")):
                hidden += 1
            elif child.type == "link_close" and hidden:
                hidden -= 1
            elif child.type == "image":
                child.type, child.content = "text", f"({child.content})"
                inside.append(child)
            else:
                inside.append(child)
        if token.children:
            token.children = inside
    return str(markdown.renderer.render(tokens, markdown.options, {}))


def page(title: str, about: str, readme: str, fragment: str, icon: str) -> str:
    """Text of documentation/index.html, which needs no other file."""
    readme = re.sub(r"\A# .*\n", "", readme)
    found = re.findall(r'<h2 id="(\w+)">(.*?)</h2>', fragment)
    ways = "".join(f'<a href="#{place}">{html.escape(text)}</a> ' for place, text in found)
    told = licence.attributes()
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width">\n'
        f"<title>{html.escape(title)}</title>\n"
        f"<style>{_STYLE}</style>\n</head>\n<body>\n<header>\n{icon}\n<div>\n"
        f"<h1>{html.escape(title)}</h1>\n<p>{html.escape(about)}</p>\n<nav>{ways}</nav>\n"
        f"</div>\n</header>\n{_readme(readme)}{fragment}"
        f"<footer>motionfmu {told['version']}, {html.escape(told['copyright'])}, "
        f'<a href="licenses/license.txt">{told["license"]}</a></footer>\n</body>\n</html>\n'
    )


def icon_of(folder: Path) -> str:
    """The icon in an FMU's folder; the common icon if it has none."""
    own = folder / "icon.svg"
    return (own if own.is_file() else _ICON).read_text()


def joined(icons: Sequence[str]) -> str:
    """One icon that shows up to four others."""
    ET.register_namespace("", _SVG)
    kept = list(dict.fromkeys(icons))[:4]
    if len(kept) == 1:
        return kept[0]
    root = ET.Element(f"{{{_SVG}}}svg", viewBox="0 0 100 100")
    for n, text in enumerate(kept):
        drawn = ET.fromstring(text)
        place = {"x": str(n % 2 * 52), "y": str(n // 2 * 52 if len(kept) > 2 else 26)}
        drawn.attrib |= {**place, "width": "48", "height": "48"}
        root.append(drawn)
    return ET.tostring(root, encoding="unicode") + "\n"


def png(icon: str) -> bytes:
    """An icon as a PNG picture."""
    import resvg_py

    return bytes(resvg_py.svg_to_bytes(svg_string=icon, width=PNG_SIZE, skip_system_fonts=True))


def files(
    fmi: int, generated: Path, about: tuple[str, str], readme: str, icon: str
) -> dict[str, bytes]:
    """The files of the documentation by their names in the archive; `about` is title and subtitle.

    The folder `generated` has `VARIABLES` and `TERMINALS`.
    """
    picture = png(icon)
    fragment = (generated / VARIABLES).read_text()
    packed = {
        "documentation/index.html": page(*about, readme, fragment, icon).encode(),
        licence.ENTRY: licence.text().encode(),
    }
    if fmi == 2:
        return packed | {"model.png": picture}
    drawn = {f"{terminals.ICON}.svg": icon.encode(), f"{terminals.ICON}.png": picture}
    return packed | drawn | {terminals.XML: (generated / TERMINALS).read_bytes()}
