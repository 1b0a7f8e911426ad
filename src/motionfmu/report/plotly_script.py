"""The script that draws plots: plotly's own, cut to the kinds of curves that pages have, packed."""

import base64
import gzip
import re
from importlib.util import find_spec
from pathlib import Path

from motionfmu.base import disk_cache

# Beside scatter, which the core of the script has; curves in space are half of the rest.
PLANE = ("bar", "contour", "scatterpolar")
SPACE = (*PLANE, "scatter3d")
PACKED = "plotly.txt"
# The bundler's two functions that make a module of a function, each called once for each module.
_WRAPPERS = re.compile(
    r"(?<![\w$])([\w$]+)=(?:\(\w+,\w+\)=>\(\)=>\{try\{return|\(\w+,\w+,\w+\)=>\(\)=>\{if\(\w+\)throw)"
)
_LISTED = re.compile(r"\.register\(\[((?:[\w$]+\(\),?)+)\]\)")
_KIND = re.compile(r'moduleType:"trace",name:"(\w+)"')
_SAME = re.compile(r"exports=([\w$]+)\(\)\}\)$")
_CALL = re.compile(r"(?<![\w$.])([\w$]+)\(\)")
_TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|' + r"'(?:[^'\\\n]|\\.)*'|[\w$]+|[`/{}()\[\]]",
    re.DOTALL,
)
_PATTERN = re.compile(r"/(?:[^/\\\[\n]|\\.|\[(?:[^\]\\\n]|\\.)*\])+/[a-z]*")
_BEFORE_PATTERN = {"return", "typeof", "case", "in", "of", "delete", "void", "throw", "else", "do"}


def packed_text(text: str, level: int = 9) -> str:
    """A text as gzip in base64, which a browser unpacks."""
    return base64.b64encode(gzip.compress(text.encode(), level, mtime=0)).decode()


def packed_script(space: bool) -> str:
    """The packed script, for pages with curves in space or without."""
    file, kinds = _file(), SPACE if space else PLANE
    name = disk_cache.key(file.read_bytes(), Path(__file__).read_bytes(), *kinds)

    def make(folder: Path) -> None:
        (folder / PACKED).write_text(packed_text(cut(file.read_text("utf-8"), kinds)), "ascii")

    return (disk_cache.kept("plotly", name, make) / PACKED).read_text("ascii")


def _file() -> Path:
    """The whole script: the wheel's, else that of plotly's package."""
    own = Path(__file__).parent / "plotly"
    if not own.is_dir():
        found = find_spec("plotly")
        assert found is not None and found.submodule_search_locations
        own = Path(found.submodule_search_locations[0]) / "package_data"
    return own / "plotly.min.js"


def cut(text: str, kinds: tuple[str, ...]) -> str:
    """The script with these kinds of curves alone; whole where it is bundled in another way.

    It is a list of functions, one for each module, that are called when they are first needed: one
    that nobody calls becomes 0.
    """
    wrappers, listed = _WRAPPERS.findall(text), _LISTED.search(text)
    if len(wrappers) != len(("CommonJS", "ES")) or listed is None:
        return text
    modules = _modules(text, wrappers)
    bodies = {name: text[a:b] for name, (a, b) in modules.items()}
    names = _CALL.findall(listed[1])
    kept = [name for name in names if _kind(bodies, name) in kinds]
    first = next(name for name, (a, b) in modules.items() if a < listed.start() < b)
    short = f".register([{','.join(f'{name}()' for name in kept)}])"
    bodies[first] = bodies[first].replace(listed[0], short)
    called, left = {first}, [first]
    while left:
        found = set(_CALL.findall(bodies[left.pop()])) & bodies.keys() - called
        called |= found
        left += found
    out, end = [], 0
    for name, (a, b) in modules.items():
        out += [text[end:a], bodies[name] if name in called else f"{name}=0"]
        end = b
    return "".join([*out, text[end:]])


def _kind(bodies: dict[str, str], name: str) -> str:
    """The kind of curve that a module draws; empty if it draws none by itself."""
    if found := _KIND.search(bodies[name]):
        return found[1]
    same = _SAME.search(bodies[name])
    return _kind(bodies, same[1]) if same else ""


def _modules(text: str, wrappers: list[str]) -> dict[str, tuple[int, int]]:
    """Where each module begins and ends, in order."""
    begins = re.compile(rf"(?<![\w$.])([\w$]+)=(?:{'|'.join(map(re.escape, wrappers))})\(")
    found, end = {}, 0
    while (begin := begins.search(text, end)) is not None:
        end = _closed(text, begin.end() - 1)
        found[begin[1]] = begin.start(), end
    return found


# CCN 16: a case for each kind of token in which a bracket is none.
def _closed(text: str, place: int) -> int:
    """The end of what the bracket at a place opens."""
    depth, end, before = 0, place, ""
    while True:
        token = _TOKEN.search(text, end)
        assert token is not None
        word, at = token[0], token.start()
        before = (text[end:at].strip() or before)[-1:] if end < at else before
        end = token.end()
        if word.startswith(("//", "/*")):
            continue
        if word == "`":
            while text[end] != "`":
                end = _closed(text, end + 1) if text.startswith("${", end) else end + 1
                end += text[end - 1] == "\\"
            end, word = end + 1, '"'
        elif word == "/" and (before in _BEFORE_PATTERN or not re.match(r"[\w$)\]}\"'`]", before)):
            if pattern := _PATTERN.match(text, at):
                end, word = pattern.end(), '"'
        elif word in "({[":
            depth += 1
        elif word in ")}]":
            depth -= 1
            if not depth:
                return end
        before = word if word[-1].isalnum() else word[-1]
