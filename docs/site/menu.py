"""The menu of all pages: Sphinx would resolve it for each page, here that is done once."""

import re
from typing import Any

from sphinx.util.osutil import relative_uri

TAGS = re.compile(
    r'(<ul>|<ul class="simple">|</ul>|<li class="[^"]*">|</li>|'
    r'<a class="reference internal" href="[^"]*">)'
)


class Menu:
    """The menu of the front page, cut at its tags; no entry of it leads to the front page."""

    def __init__(self, html: str) -> None:
        self.pieces = TAGS.split(html)
        self.links: dict[int, str] = {}  # by place of a link: where it leads
        self.around: dict[str, set[int]] = {}  # by where they lead: links, and tags around
        held: list[int] = []
        for k, piece in enumerate(self.pieces):
            if piece.startswith(("<ul", "<li")):
                held.append(k)
            elif piece in ("</ul>", "</li>"):
                held.pop()
            elif piece.startswith('<a class="reference internal"'):
                self.links[k] = piece.split('"')[3]
                self.around.setdefault(self.links[k], set()).update(held, {k})

    def at(self, page: str) -> str:
        """The menu of the page at an address: the entries that lead there are marked."""
        pieces = list(self.pieces)
        for k, address in self.links.items():
            own = relative_uri(page, address) or "#"
            pieces[k] = f'<a class="reference internal" href="{own}">'
        for k in self.around.get(page, ()):
            if pieces[k] == "<ul>":
                pieces[k] = '<ul class="current">'
            elif pieces[k].startswith("<li"):
                pieces[k] = pieces[k].replace('">', ' current">')
            else:
                pieces[k] = pieces[k].replace('class="', 'class="current ')
        return "".join(pieces)


def _once(app: Any, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Replace the function by which the theme asks for the menu of a page."""
    resolved = context.get("toctree")

    def toctree(**how: Any) -> str:
        if how.get("collapse", True):
            return str(resolved(**how))
        if not hasattr(app, "menu"):
            app.menu = Menu(str(app.builder._get_local_toctree("index", **how)))
        return app.menu.at(app.builder.get_target_uri(page))

    if resolved is not None:
        context["toctree"] = toctree


def setup(app: Any) -> dict[str, bool]:
    """Connect ahead of the theme's own handler, which asks for the menu with priority 500."""
    app.connect("html-page-context", _once, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
