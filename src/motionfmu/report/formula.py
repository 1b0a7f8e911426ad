"""Formulas written as plain text, in readable type."""

import re
from html import escape

# Quantities that stand alone, with an index, behind an underscore; a minus between two terms.
_RULES = (
    (r"(?<![A-Za-z])([KFT])([pvxycd])(?![a-z])", r"<i>\1</i><sub>\2</sub>"),
    (r"(?<![A-Za-z<])([VRHBTJL])(?![A-Za-z])", r"<i>\1</i>"),
    (r"(?<=sin |cos )a\b|(?<=\(θ\) )a\b", "<i>a</i>"),
    (r"\bdv/dt\b", "d<i>v</i>/d<i>t</i>"),
    (r"\b([A-Z]{2})_(\w+)", r"\1<sub>\2</sub>"),
    (r" - ", " \N{MINUS SIGN} "),
)


def readable(text: str) -> str:
    """A formula, or words with one, as HTML: indices below, quantities in italics."""
    html = escape(text)
    for pattern, shown in _RULES:
        html = re.sub(pattern, shown, html)
    return html
