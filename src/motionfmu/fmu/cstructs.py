"""C text that checks Booleans and enumerations of a model's state, generated from its structs."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

_NOTE = "/* Generated from the structs of the model's state; do not edit. */\n"
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
_LIST = re.compile(r"^[ \t]*#define (\w+)\(X\)((?:\\\n|[^\n])*)", re.MULTILINE)
_LISTED = re.compile(r"\bX\((\w+),\s*(\w+),|\b(\w+)\(X\)")
_TOKEN = re.compile(r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|\w+|[^\w\s]")


@dataclass
class _Member:
    """A member of a struct; `kind` is bool, enum, struct or other, `of` its enum or struct."""

    name: str
    kind: str
    of: str = ""


@dataclass
class _Definitions:
    structs: dict[str, list[_Member]] = field(default_factory=dict)  # by "struct a" or "A"
    enums: dict[str, list[str]] = field(default_factory=dict)
    lists: dict[str, str] = field(default_factory=dict)  # of X(type, name, ...), by their macro


class _StructReader:
    """Reads the definitions in one C file and skips all other text."""

    def __init__(self, text: str, found: _Definitions) -> None:
        self.tokens = [*_TOKEN.findall(_COMMENT.sub(" ", text)), "", "", ""]
        self.at = 0
        self.found = found
        found.lists.update(_LIST.findall(re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL)))

    def take(self) -> str:
        self.at += 1
        return self.tokens[self.at - 1]

    def next_is(self, *tokens: str) -> bool:
        return tuple(self.tokens[self.at : self.at + len(tokens)]) == tokens

    def read(self) -> None:
        while self.tokens[self.at]:
            word, name = self.tokens[self.at], self.tokens[self.at + 1]
            if self.next_is("typedef", "struct", "{"):
                self.at += 3
                members = list(self.members(""))
                self.found.structs[self.take()] = members
            elif word == "struct" and self.tokens[self.at + 2] == "{":
                self.at += 3
                self.found.structs[f"struct {name}"] = list(self.members(name))
            elif word == "enum" and self.tokens[self.at + 2] == "{":
                self.at += 3
                self.enumerators(name)
            else:
                self.at += 1

    def enumerators(self, name: str) -> None:
        names, depth, begins = [], 1, True
        while depth:
            token = self.take()
            depth += (token in "({") - (token in ")}") if token else -depth
            if begins and depth:
                names.append(token)
            begins = token == "," and depth == 1
        self.found.enums[name] = [n for n in names if n != "}"]

    def members(self, owner: str) -> Iterator[_Member]:
        """The members up to the closing brace, which is read as well."""
        while not self.next_is("}"):
            yield from self.member(owner)
        self.at += 1

    def member(self, owner: str) -> Iterator[_Member]:
        word = self.take()
        while word in ("const", "unsigned", "signed"):
            word = self.take()
        kind, of = ("bool", "") if word == "bool" else ("other", "")
        if word in ("struct", "union", "enum"):
            name = "" if self.next_is("{") else self.take()
            kind, of = word, name if word == "enum" else f"struct {name}"
            if self.next_is("{"):
                self.at += 1
                if word == "enum":
                    of = name or f"{owner}_{len(self.found.enums)}"
                    self.enumerators(of)
                else:
                    inner = list(self.members(owner))
                    if self.next_is(";"):  # without a name its members are those around it
                        self.at += 1
                        yield from inner if word == "struct" else ()
                        return
                    self.found.structs[of] = inner
            if word == "union":
                kind, of = "other", ""  # which of its members counts only the model knows
        elif word not in ("bool",):
            kind, of = "named", word
        if word in self.found.lists:  # LIST(MACRO) makes a member of each X(type, name, ...)
            self.at += 3
            yield from self.listed(word)
            return
        yield from self.declarators(owner, kind, of)

    def listed(self, macro: str) -> Iterator[_Member]:
        for kind, name, inner in _LISTED.findall(self.found.lists[macro]):
            if inner:
                yield from self.listed(inner)
            else:
                yield _Member(name, "bool" if kind == "bool" else "named", kind)

    def declarators(self, owner: str, kind: str, of: str) -> Iterator[_Member]:
        while True:
            name = self.take()
            if not re.fullmatch(r"\w+", name):  # a pointer
                while self.take() != ";":
                    pass
                yield _Member(owner, "pointer")
                return
            yield _Member(name, kind, of)
            while self.next_is("["):
                while self.take() != "]":
                    pass
            if self.take() == ";":
                return


def _looks(found: _Definitions, name: str, done: dict[str, str]) -> bool:
    """Add the checks of a struct, and of structs in it, to `done`; returns whether it has any."""
    if name in done:
        return bool(done[name])
    lines = []
    for m in found.structs[name]:
        if m.kind == "pointer" or m.of == "struct ":
            raise ValueError(f"{name}: a state has neither pointers nor structs without a name")
        if m.kind == "bool":
            lines.append(f"    FMI_ALL_GOOD(unsigned char, p->{m.name}, fmi_good_bool)\n")
        elif m.kind == "enum":
            names = found.enums[m.of]
            lines.append(f"    FMI_ALL_WITHIN(p->{m.name}, {names[0]}, {names[-1]})\n")
        elif m.of in found.structs and _looks(found, m.of, done):
            call = f"fmi_good_{m.of.removeprefix('struct ')}"
            lines.append(f"    FMI_ALL_GOOD({m.of}, p->{m.name}, {call})\n")
    done[name] = "".join(lines)
    return bool(lines)


def flags(texts: Iterable[str]) -> str:
    """Text of state_flags.h, from C files with all structs of the state.

    Its `fmi_good_model` tells whether every Boolean of a `struct model`, the whole, is one and
    every enumeration lies from its first to its last name. Members of unions are left to the model.
    A struct with a pointer or without a name is a ValueError.
    """
    found = _Definitions()
    for text in texts:
        _StructReader(text, found).read()
    done: dict[str, str] = {}
    _looks(found, "struct model", done)
    parts = [
        f"static bool fmi_good_{name.removeprefix('struct ')}(const {name} *p)\n"
        f"{{\n    (void)p;\n{lines}    return true;\n}}\n"
        for name, lines in done.items()
        if lines or name == "struct model"
    ]
    return "\n".join([_NOTE + '#include "fmi_flags.h"\n', *parts])
