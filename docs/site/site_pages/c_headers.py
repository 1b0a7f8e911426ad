"""Pages of the C cores: what each header says and declares, as a program includes it."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from site_pages.markdown import plain

# Lines of a header that are for the compiler alone.
_FRAME = re.compile(r'extern "C" \{|#.*|\}\n(?=#)')


@dataclass
class Declared:
    """Declarations that share a comment."""

    comment: str = ""
    code: list[str] = field(default_factory=list)


def page(core: str, headers: Mapping[str, str]) -> str:
    """The page of a core: its headers by name, with their text."""
    parts = [f"# {core}: headers\n\nA program includes each as `<motionfmu/NAME>`.\n\n"]
    for name, text in headers.items():
        first, *rest = declarations(text)
        parts.append(f"## `{name}`\n\n")
        if first.comment:
            told = re.sub(r"^\w+ - ", "", first.comment)
            parts.append(words(told[0].upper() + told[1:]))
        parts += [_item(d) for d in ([Declared("", first.code)] if first.code else []) + rest]
    return "".join(parts)


def _item(declared: Declared) -> str:
    told = words(declared.comment) if declared.comment else ""
    if not declared.code:
        return told
    return told + "```c\n" + "\n".join(declared.code) + "\n```\n\n"


def declarations(text: str) -> list[Declared]:
    """Comments of a header with what they are about; the first is about the whole file."""
    found = [Declared()]
    for kind, part in _parts(text):
        if kind == "gap":
            if found[-1].code or found[-1].comment:
                found.append(Declared())
        elif kind == "comment":
            if found[-1].code or found[-1].comment:
                found.append(Declared())
            found[-1].comment = part
        else:
            found[-1].code.append(part)
    return [d for k, d in enumerate(found) if k == 0 or d.comment or d.code]


def _parts(text: str) -> Iterator[tuple[str, str]]:
    """Comments and declarations at the top level of a header, and empty lines between them."""
    lines = iter(_bare(text))
    for line in lines:
        if not line.strip():
            yield "gap", ""
        elif line.startswith("/*"):
            held = [line]
            while "*/" not in held[-1]:
                held.append(next(lines))
            yield "comment", _comment(held)
        else:
            held = [line]
            while not _whole("\n".join(held)) and (more := next(lines, None)) is not None:
                held.append(more)
            yield "code", _declaration(held)


def _bare(text: str) -> list[str]:
    """Lines of a header without its frame: guards, includes, macros, the words for C++."""
    text = re.sub(r"#ifdef __cplusplus\n.*?\n#endif\n(?=\n)", "", text, flags=re.DOTALL)
    text = text.replace("\\\n", "\\ ")
    return [line for line in text.splitlines() if not _FRAME.fullmatch(line)]


def _whole(text: str) -> bool:
    """Whether a declaration has come to its end."""
    bare = re.sub(r"/\*.*?(\*/|\Z)", "", text, flags=re.DOTALL).rstrip()
    pairs = ("{}", "()")
    closed = all(bare.count(a) == bare.count(b) for a, b in pairs)
    return closed and text.count("/*") == text.count("*/") and bare.endswith((";", "}"))


def _declaration(lines: list[str]) -> str:
    """A declaration as it stands; of a function with a body its head."""
    text = "\n".join(lines)
    if body := re.match(r"(static inline [^{;]*\))\s*\{", text):
        return body[1] + ";"
    return text


def _comment(lines: list[str]) -> str:
    """Text of a comment without its marks."""
    text = "\n".join(lines).strip().removeprefix("/*").removesuffix("*/")
    return "\n".join(re.sub(r"^ \* ?", "", line) for line in text.splitlines()).strip()


def words(comment: str) -> str:
    """A comment as Markdown: paragraphs, lists, and drawings as they stand."""
    parts = []
    for paragraph in re.split(r"\n\s*\n", comment):
        lines = paragraph.splitlines()
        if any(re.search(r"[─│┐└┘┌]|\S {3,}\S", line) for line in lines):
            parts.append("```text\n" + paragraph.rstrip() + "\n```\n")
            continue
        text, items = [], []
        for line in lines:
            if line.lstrip().startswith("- "):
                items.append(line.lstrip()[2:])
            elif items:
                items[-1] += " " + line.strip()
            else:
                text.append(line.strip())
        if text:
            parts.append(plain(" ".join(text)) + "\n")
        if items:
            parts.append("".join(f"- {plain(item)}\n" for item in items))
    return "\n".join(parts) + "\n"
