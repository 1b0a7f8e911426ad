"""The menu that is made once, against the one that Sphinx makes for each page."""

import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

pytestmark = pytest.mark.more

TREE = """# {title}

```{{toctree}}
:hidden:
{rows}
```
"""
PAGES = {
    "index": ("a", "deep/b", "The web <https://example.org>"),
    "a": ("deep/er/c", "deep/d"),
    "deep/b": ("/deep/d",),  # twice in the menu
    "deep/d": (),
    "deep/er/c": (),
}
CONF = """
import sys
sys.path.insert(0, {folder!r})
extensions = ["myst_parser", *{more}]
html_theme = "furo"
html_last_updated_fmt = None
suppress_warnings = ["toc.multiple_toc_parents"]
"""


def built(folder: Path, more: list[str]) -> dict[str, str]:
    """All pages of a site with some extensions."""
    pytest.importorskip("sphinx", reason="Sphinx is not installed: make docs installs it")
    for name, rows in PAGES.items():
        file = folder / "source" / f"{name}.md"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(TREE.format(title=name, rows="\n".join(rows)))
    conf = CONF.format(folder=str(ROOT / "docs/site"), more=more)
    (folder / "source/conf.py").write_text(conf)
    line = [sys.executable, "-m", "sphinx", "-b", "html", "-W", folder / "source", folder / "out"]
    done = subprocess.run([str(word) for word in line], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return {f.relative_to(folder).as_posix(): f.read_text() for f in folder.rglob("*.html")}


def test_each_page_has_the_menu_that_sphinx_gives_it(tmp_path: Path) -> None:
    wanted, found = (built(tmp_path / name, more) for name, more in (("by", []), ("own", ["menu"])))
    assert len(wanted) > len(PAGES) and found == wanted
    assert 'class="current' in wanted["out/deep/er/c.html"]
