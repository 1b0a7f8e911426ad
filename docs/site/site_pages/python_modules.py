"""Pages of the Python interface: the modules of the package with names of their own to import."""

import ast
import importlib
from collections.abc import Sequence
from pathlib import Path

from site_pages.markdown import code, plain, table


def modules(package: Path) -> list[str]:
    """Full names of the packages that say in `__all__` what they give."""
    found = []
    for file in sorted(package.rglob("__init__.py")):
        if _gives(file.read_text(encoding="utf-8")):
            found.append(".".join(file.parent.relative_to(package.parent).parts))
    return found


def _gives(text: str) -> bool:
    """Whether a module has an `__all__` with names in it."""
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return bool(ast.literal_eval(node.value))
    return False


def page(module: str, elsewhere: Sequence[str] = ()) -> str:
    """The page of a module, which Sphinx fills with the docstrings of its names.

    What another page has already is left out.
    """
    options = [f":exclude-members: {', '.join(elsewhere)}"] if elsewhere else []
    lines = [f".. automodule:: {module}", "   :members:", "   :member-order: groupwise"]
    lines += [f"   {option}" for option in options]
    return f"# {module}\n\n```{{eval-rst}}\n" + "\n".join(lines) + "\n```\n"


def pages(modules: Sequence[str]) -> dict[str, str]:
    """The page of each module."""
    found, seen = {}, set()
    for module in modules:
        own = importlib.import_module(module)
        things = {name: getattr(own, name) for name in own.__all__}
        places = {name: (getattr(x, "__module__", module), name) for name, x in things.items()}
        found[module] = page(module, [name for name, place in places.items() if place in seen])
        seen |= set(places.values())
    return found


def front(package: str, modules: Sequence[str]) -> str:
    """The page of the package itself: names that another module documents, and the modules."""
    own = importlib.import_module(package)
    rows = []
    for name in own.__all__:
        found = getattr(own, name)
        there = max((m for m in modules if found.__module__.startswith(m)), key=len, default="")
        told = (found.__doc__ or "").strip().partition("\n")[0]
        link = f"[{name}](python/{there}.md)" if there else code(name)
        rows.append((link, plain(told)))
    more = [(f"[{m}](python/{m}.md)", plain(_first(m))) for m in modules]
    return (
        f"# Python\n\n`import {package}` gives these names:\n\n{table(('name', 'is'), rows)}\n"
        f"Its modules have more:\n\n{table(('module', 'is'), more)}\n"
    )


def _first(module: str) -> str:
    return (importlib.import_module(module).__doc__ or "").strip().partition("\n")[0]
