"""Formulas as MathML, which browsers set themselves: no script, no network."""

import re
from typing import Any
from xml.etree import ElementTree

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util import logging

LOG = logging.getLogger(__name__)
# Commands that docutils does not know, by what it knows.
SAME = {r"\dots": r"\ldots"}
# An argument of TeX: a group, a command, a character. docutils takes 12 of \frac12 as one number.
ARGUMENT = r"\s*(\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\}|\\[A-Za-z]+|[^\s{}\\])"
FRACTION = re.compile(r"(\\[td]?frac)(?![A-Za-z])" + ARGUMENT + ARGUMENT)
# Behind \boldsymbol docutils lets an accent stand over all that follows.
BOLD = re.compile(r"\\boldsymbol(?![A-Za-z])" + ARGUMENT)
DIGIT_ROOT = re.compile(r"(\\sqrt)\s*(\d)")
SPACE = "{http://www.w3.org/1998/Math/MathML}"
# What stands over a letter: an index is beside the letter, not below it.
ACCENTS = frozenset("˙¨ˉˆˇ→¯")


def setup(app: Any) -> dict[str, bool]:
    """Register the renderer as ``mathml``."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(writer: Any, node: Any) -> None:
    writer.body.append(_formula(node, block=False))
    raise nodes.SkipNode


def _block(writer: Any, node: Any) -> None:
    writer.body.append(f'<div class="math" tabindex="0">{_formula(node, block=True)}</div>')
    raise nodes.SkipNode


def _formula(node: Any, block: bool) -> str:
    """MathML of a formula; one that cannot be read is a warning and stays as it is written."""
    text = re.sub(r"\\[a-z]+", lambda m: SAME.get(m[0], m[0]), node.astext())
    try:
        return beside(str(tex2mathml(braced(text), as_block=block)))
    except MathError as error:
        LOG.warning("formula %r: %s", text, error, location=node)
        return f"<code>{text}</code>"


def braced(text: str) -> str:
    """A formula whose fractions, roots and bold letters have their arguments in braces."""

    def group(part: str) -> str:
        return part if part.startswith("{") else f"{{{part}}}"

    def whole(m: re.Match[str]) -> str:
        return m[1] + "".join(group(FRACTION.sub(whole, m[k])) for k in (2, 3))

    text = BOLD.sub(lambda m: rf"\mathbf{group(m[1])}", text)
    return FRACTION.sub(whole, DIGIT_ROOT.sub(r"\1{\2}", text))


def beside(mathml: str) -> str:
    """The same MathML with an index of a letter with an accent beside it."""
    ElementTree.register_namespace("", SPACE.strip("{}"))
    root = ElementTree.fromstring(mathml.replace("&ApplyFunction;", "\u2061"))
    for both in root.iter(f"{SPACE}munderover"):
        letter, index, accent = both
        if accent.text in ACCENTS:
            over = ElementTree.Element(f"{SPACE}mover", accent="true")
            over.extend([letter, accent])
            both.tag = f"{SPACE}msub"
            both[:] = [over, index]
    return ElementTree.tostring(root, encoding="unicode")
