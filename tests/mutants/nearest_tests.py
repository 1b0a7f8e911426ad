"""Which tests are nearest to a file, by a rule that needs no list."""

import re
from functools import cache
from pathlib import Path

MOST = 12  # tests of a change: whoever is farther away sees it by chance


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
    """C tests of a core's file: those of its folder, then narrow ones that include its headers."""
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
    return [*own, *(name for _, name in sorted(others))][: MOST if len(own) < MOST else len(own)]


@cache
def _texts(tree: Path) -> dict[Path, str]:
    """All modules and their tests."""
    found = [*tree.glob("src/motionfmu/**/*.py"), *tree.glob("tests/**/test_*.py")]
    return {f: f.read_text() for f in found if "importers" not in f.parts}


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


def of_python(tree: Path, file: Path) -> list[str]:
    """Python tests of a module: those that name it or its folder, the more often the nearer.

    Those follow that name a module which imports it, or type its words as a command.
    """
    module, folder = _module(tree, file), _module(tree, file.parent / "__init__.py")
    texts, stem = _texts(tree), file.stem
    users = [
        _module(tree, f)
        for f, text in texts.items()
        if "src" in f.relative_to(tree).parts and f != file and _names(text, module)
    ]
    commands = [m.rpartition(".")[2].split("_") for m in (module, *users) if ".cli." in m]
    found = []
    for test, text in texts.items():
        if not test.name.startswith("test_") or "long" in test.stem:
            continue
        hits = 8 * _names(text, module) + 2 * sum(_names(text, user) > 0 for user in users)
        hits += 4 * (stem in test.stem or file.parent.name in test.stem)
        hits += len(re.findall(rf"\b{re.escape(folder)}\b", text))
        hits += 2 * sum(all(f'"{w}"' in text for w in words if w) for words in commands)
        if hits:
            found.append((-hits, str(test.relative_to(tree))))
    return [name for _, name in sorted(found)][:3]
