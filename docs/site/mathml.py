"""Formulas as MathML, which browsers set themselves: no script, no network."""

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util import logging

LOG = logging.getLogger(__name__)
# Commands that docutils does not know, by what it knows.
SAME = {r"\dots": r"\ldots"}
# Two digits behind \frac are numerator and denominator; docutils takes them for one number.
DIGITS = re.compile(r"(\\[td]?frac) ?(\d)(\d)")


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
    text = DIGITS.sub(r"\1{\2}{\3}", text)
    try:
        return str(tex2mathml(text, as_block=block))
    except MathError as error:
        LOG.warning("formula %r: %s", text, error, location=node)
        return f"<code>{text}</code>"
