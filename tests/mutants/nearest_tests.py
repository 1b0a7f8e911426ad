"""Which tests are nearest to a file, by a rule that needs no list."""

import ast
import re
from functools import cache
from pathlib import Path

MOST = 12  # Python tests of a change: whoever is farther away sees it by chance
FEW = 8  # modules that use one: of more, those that use these are everywhere


@cache
def _headers(tree: Path) -> dict[str, Path]:
    return {
        f.name: f
        for pattern in ("src/*/*.[hi]*", "src/*/*/*.[hi]*", "tests/core/**/*.h")
        for f in tree.glob(pattern)
    }


@cache
def _reached(tree: Path, file: Path) -> frozenset[Path]:
    """The headers that a C file includes, and those they include."""
    found: set[Path] = set()
    waiting = [file]
    while waiting:
        for name in re.findall(
            r'^#\s*include "(?:.*/)?(.*)"', waiting.pop().read_text(), re.MULTILINE
        ):
            header = _headers(tree).get(name)
            if header and header not in found:
                found.add(header)
                waiting.append(header)
    return frozenset(found)


def of_c(tree: Path, file: Path) -> list[str]:
    """C tests of a core's file: those of its folder, then all that include its headers.

    The narrowest come first.
    """
    core = file.parent.name
    own = sorted(f.stem for f in tree.glob(f"tests/core/{core}/*.c"))
    others = []
    for test in tree.glob("tests/core/*/*.c"):
        folders = {h.parent.name for h in _reached(tree, test)}
        if core in folders and test.parent.name != core:
            others.append((len(folders), test.stem))
    # In a large folder those first whose name begins or ends as the file's.
    words = set(file.stem.split("_")) - {core}
    own.sort(key=lambda name: -len(words & set(name.split("_"))))
    return [*own, *(name for _, name in sorted(others))]


@cache
def _texts(tree: Path) -> dict[Path, str]:
    """All modules and their tests, these with what they import from files beside them."""
    found = {f: f.read_text() for f in tree.glob("src/motionfmu/**/*.py")}
    helpers = {f.stem: f for f in tree.glob("tests/helpers/*.py")}
    for test in tree.glob("tests/**/test_*.py"):
        text = test.read_text()
        if "importers" not in test.parts:
            beside = helpers | {f.stem: f for f in test.parent.glob("*.py")}
            named = re.findall(r"^(?:from|import) (\w+)", text, re.MULTILINE)
            own = [beside[n] for n in named if n in beside and not n.startswith("test_")]
            found[test] = "\n".join([text, *(f.read_text() for f in own)])
    return found


def _names(text: str, module: str) -> int:
    """How often a text names a module."""
    folder, _, stem = module.rpartition(".")
    if folder not in text:  # most: searching takes a thousand times as long
        return 0
    own = rf"from {re.escape(folder)} import .*\b{stem}\b"
    return sum(len(re.findall(rule, text)) for rule in (rf"\b{re.escape(module)}\b", own))


def _module(tree: Path, file: Path) -> str:
    parts = file.relative_to(tree / "src").with_suffix("").parts
    return ".".join(p for p in parts if p != "__init__")


def _functions(text: str, line: int) -> set[str]:
    """Names of the function, and of the class, that a line stands in, or of those that call it.

    A name with an underscore is not a test's: in its place are the functions of the module that
    call it, and so on.
    """
    kinds = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef
    nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, kinds)]
    named = {
        node.name: {n.attr if isinstance(n, ast.Attribute) else getattr(n, "id", "")
                    for n in ast.walk(node)}
        for node in nodes
        if not isinstance(node, ast.ClassDef)
    }  # fmt: skip
    waiting = [n.name for n in nodes if n.lineno <= line <= (n.end_lineno or 0)]
    found: set[str] = set()
    while waiting:
        if (name := waiting.pop()) not in found:
            found.add(name)
            if name.startswith("_"):
                waiting += [caller for caller, names in named.items() if name in names]
    return {name for name in found if not name.startswith("_")}


@cache
def _modules(tree: Path) -> dict[str, str]:
    """The texts of the modules by their names."""
    return {_module(tree, f): t for f, t in _texts(tree).items() if tree / "src" in f.parents}


@cache
def _users(tree: Path, module: str) -> list[str]:
    """The modules that name a module."""
    named = _modules(tree).items()
    return [user for user, text in named if user != module and _names(text, module)]


def of_python(tree: Path, file: Path, line: int = 0) -> list[str]:
    """Python tests of a line of a module, the nearest first.

    Near are those that name the module, the function around the line, or a module which imports
    it, and those that type its words, or those of what uses it, as a command.
    """
    module, folder = _module(tree, file), _module(tree, file.parent / "__init__.py")
    texts, stem = _texts(tree), file.stem
    functions = [re.compile(rf"\b{name}\b") for name in _functions(texts[file], line)]
    users = _users(tree, module)
    # A command's own module often hands on to one that has the work, and that to one more.
    further = {u for user in users for u in _users(tree, user)} if len(users) <= FEW else set()
    typed = [m.rpartition(".")[2].split("_") for m in {module, *users, *further} if ".cli." in m]
    commands = [re.compile(r"[(\[]\s*" + r",\s*".join(f'"{w}"' for w in words)) for words in typed]
    found = []
    for test, text in texts.items():
        if not test.name.startswith("test_") or "long" in test.stem:
            continue
        hits = 8 * _names(text, module) + 2 * sum(_names(text, user) > 0 for user in users)
        hits += 4 * (stem in test.stem) + (file.parent.name in test.stem)
        hits += min(4, len(re.findall(rf"\b{re.escape(folder)}\b", text)))
        hits += 6 * sum(bool(typed.search(text)) for typed in commands)
        if hits:  # a function alone has a name that others have, too
            hits += 4 * sum(bool(name.search(text)) for name in functions)
            found.append((-hits, str(test.relative_to(tree))))
    return [name for _, name in sorted(found)][:MOST]
