"""Formulas of the site, where docutils reads TeX otherwise than TeX does."""

import pytest

pytestmark = pytest.mark.more  # Sphinx, and docutils with it, come with what `more` needs


def shown(text: str) -> str:
    """MathML of a formula in a line, without its lines and its head."""
    import mathml
    from docutils import nodes

    return mathml._formula(nodes.math(text, text), block=False).replace("\n", "").replace(" ", "")


@pytest.mark.parametrize(
    ("short", "whole"),
    [
        (r"\tfrac12 c", r"\tfrac{1}{2} c"),
        (r"\frac1{16}/\frac38", r"\frac{1}{16}/\frac{3}{8}"),
        (r"\frac{\tfrac12a}b", r"\frac{\tfrac{1}{2}a}{b}"),
        (r"\frac\delta{\sqrt3\,g}", r"\frac{\delta}{\sqrt{3}\,g}"),
        (r"\sqrt2x", r"\sqrt{2}x"),
    ],
)
def test_an_argument_without_braces_is_one_character(short: str, whole: str) -> None:
    assert shown(short) == shown(whole)


def test_fractions_are_those_of_tex() -> None:
    import mathml

    assert "<mn>12</mn>" not in shown(r"\tfrac12 c")
    assert mathml.braced(r"\frac{a}{b^{2}}") == r"\frac{a}{b^{2}}"


@pytest.mark.parametrize("accent", ["dot", "ddot", "bar", "hat"])
def test_an_index_stands_beside_a_letter_with_an_accent(accent: str) -> None:
    found = shown(rf"\{accent} Q_i")
    assert "munderover" not in found
    assert "</mover><mi>i</mi></msub>" in found


def test_an_accent_stands_over_its_bold_letter_alone() -> None:
    found = shown(r"\dot{\boldsymbol\omega}_i=a")
    assert found == shown(r"\dot{\mathbf{\omega}}_i=a")
    assert "</mover><mi>i</mi></msub><mo>=</mo>" in found


def test_limits_of_a_sum_stay_below_and_above() -> None:
    import mathml

    assert "munderover" in mathml.beside(mathml.tex2mathml(r"\sum_{i=1}^n x_i", as_block=True))
