"""Sphinx's settings of the site; `build.py` calls it with a source folder made by then."""

import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

project = "motionfmu"
author = "motionfmu"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml", "menu"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 6
html_math_renderer = "mathml"
default_role = "code"  # a name between single marks in a docstring
napoleon_google_docstring = False
napoleon_use_ivar = True
# Words of a type in a docstring, such as (joints, 3), are no references.
suppress_warnings = ["ref.python"]
autodoc_typehints = "signature"
autodoc_typehints_format = "short"

smartquotes = False
html_theme = "furo"
html_title = "motionfmu"
html_static_path = [str(HERE / "static")]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_copy_source = False
html_show_sourcelink = False
html_show_search_summary = False  # it would fetch pages, which a browser refuses from disk
html_show_copyright = False
html_show_sphinx = False
html_theme_options = {"top_of_page_buttons": []}
exclude_patterns = ["extra"]
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"


def _listings(app: Any) -> Any:
    """Pages of the files that are linked, which the search leaves out."""
    from site_pages.listings import listing

    root = HERE.parent.parent
    for name in (Path(app.srcdir) / "listed.txt").read_text(encoding="utf-8").splitlines():
        yield f"files/{name}", {"title": name, "body": listing(root, name)}, "page.html"


def _bars(app: Any, what: str, name: str, *more: Any) -> None:
    """In a docstring |x| is a size and no substitution."""
    lines = more[-1]
    lines[:] = [re.sub(r"\|([^|`]+)\|", r"\\|\1\\|", line) for line in lines]


def setup(app: Any) -> None:
    """Add the listings, and read docstrings as they are meant."""
    app.connect("html-collect-pages", _listings)
    app.connect("autodoc-process-docstring", _bars)
