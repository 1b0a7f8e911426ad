"""SVG: shapes, transforms, units and styles by closed forms, and by svgelements' own reading."""

import io
from pathlib import Path

import numpy as np
import pytest
from lines_apart import apart
from refusals import refusal
from svgelements import SVG, Close, Line, Move, Shape
from svgelements import Path as SvgPath

from motionfmu.drawings import DrawingOptions, svg
from motionfmu.drawings.contours import contours_of

PX = 25.4 / 96
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '


def page(inside: str, size: str = 'width="100mm" height="50mm" viewBox="0 0 100 50"') -> bytes:
    """A drawing whose unit is 1 mm."""
    return f"{HEAD}{size}>\n{inside}\n</svg>".encode()


def nodes(inside: str, **how: str) -> list[list[list[float]]]:
    found = svg.parse(page(inside, **how)).lines
    return [np.round(p.path.nodes, 9).tolist() for p in found]


def words(text: bytes) -> list[str]:
    return [n.words for n in svg.parse(text, "a.svg").notes]


def theirs(text: bytes) -> list[np.ndarray]:
    """The same lines by svgelements' walk and point() [mm], Y up."""
    whole = SVG.parse(io.BytesIO(text), reify=True, ppi=96)
    found: list[list] = []
    for shape in whole.elements():
        for piece in abs(SvgPath(shape)) if isinstance(shape, Shape) else ():
            if isinstance(piece, Move):
                found.append([piece.end])
            elif isinstance(piece, Line | Close):
                found[-1].append(piece.end)
            else:
                found[-1] += [piece.point(t) for t in np.linspace(0.0, 1.0, 600)[1:]]
    return [np.array([[p.x * PX, (whole.height - p.y) * PX] for p in c]) for c in found]


SHAPES = {
    "line": '<line x1="1" y1="2" x2="30" y2="8" stroke="red"/>',
    "polygon": '<polygon points="1,2 30,8 -4 6e0"/><polyline points="5 5 9 9 9 12"/>',
    "rect": '<rect x="3" y="4" width="20" height="9"/><rect x="40" width="9" height="30" ry="3"/>',
    "round": '<circle cx="20" cy="20" r="9"/><ellipse cx="50" cy="25" rx="20" ry="7"/>',
    "path": '<path d="M5 5 L10 10 H 20 V 30 h-4 v5 z m 3 3 l 5 5 -1 9z"/>',
    "curves": '<path d="M5 5 C 10 20 30 -10 40 20 S 60 40 70 20 Q 80 0 90 20 T 95 45"/>',
    "relative": '<path d="m5 5 c 5 15 25 -15 35 15 s 20 20 30 0 q 10 -20 20 0 t 5 25"/>',
    "arcs": '<path d="M10 30 A 15 15 0 0 1 40 30 A 20 10 30 1 0 80 20 a5 5 0 0 1 3 3"/>',
    "turned": '<g transform="translate(30 5) rotate(30) scale(2)">'
    '<rect width="9" height="4" rx="1"/>'
    '<path transform="matrix(.5 0 0 -.5 3 9)" d="M0 0 a 8 8 0 0 1 8 8 C 9 9 1 3 20 0"/></g>',
    "used": '<defs><g id="a"><path d="M0 0 L5 5 5 0z"/></g></defs>'
    '<use xlink:href="#a" x="3" y="9"/><use href="#a" transform="rotate(20 5 5)" y="4"/>',
}


@pytest.mark.parametrize("size", ['width="100mm" height="50mm" viewBox="0 0 100 50"', ""])
@pytest.mark.parametrize("name", SHAPES)
def test_shapes_are_where_another_reader_has_them(name: str, size: str) -> None:
    text = page(SHAPES[name], size or 'width="120px" height="3in" viewBox="-10 5 200 150"')
    ours = [p.points for p in svg.parse(text).lines]
    other = [p for p in theirs(text) if len(p) > 1]
    assert len(ours) == len(other) > 0
    assert apart(ours, other) < 0.001 and apart(other, ours) < 0.0051


def test_points_are_millimetres_with_y_up() -> None:
    assert nodes('<path d="M10 20 L30 40"/>') == [[[10, 30], [30, 10]]]
    inch = 'width="2in" height="1in"'
    assert nodes('<path d="M96 0 L0 96"/>', size=inch) == [[[25.4, 25.4], [0, 0]]]
    cm = 'width="20cm" height="10cm" viewBox="0 0 100 50"'
    assert nodes('<path d="M10 0 L0 50"/>', size=cm) == [[[20, 100], [0, 0]]]
    middle = 'width="100mm" height="100mm" viewBox="0 0 100 50"'  # in the middle, as it is
    assert nodes('<path d="M0 0 L100 50"/>', size=middle) == [[[0, 75], [100, 25]]]
    for aspect, ends in (("none", [[0, 100], [100, 0]]), ("xMinYMin slice", [[0, 100], [200, 0]])):
        size = f'{middle} preserveAspectRatio="{aspect}"'
        assert nodes('<path d="M0 0 L100 50"/>', size=size) == [ends]


def test_circles_stay_arcs_and_curves_stay_curves() -> None:
    text = page(
        '<g transform="rotate(33) translate(20 3) scale(1.5)"><circle r="4"/>'
        '<path d="M1 1 A 3 3 0 0 0 7 1 C 9 9 3 8 1 1"/></g>'
        '<circle r="4" transform="scale(1 -1)"/><circle r="4" transform="scale(1 2)"/>'
    )
    round_, path, mirrored, oval = (p.path for p in svg.parse(text).lines)
    assert round_.bulges == pytest.approx([-1, -1])  # Y is turned over, so they go right
    assert np.ptp(round_.nodes, axis=0) == pytest.approx(
        [12 * np.cos(np.radians(33)), 12 * np.sin(np.radians(33))]
    )
    assert path.bulges == pytest.approx([1, 0]) and path.curved.tolist() == [False, True]
    assert mirrored.bulges == pytest.approx([1, 1])
    assert oval.curved.all() and not oval.bulges.any()


def test_a_skewed_circle_is_the_image_of_one() -> None:
    # svgelements keeps the radii of an arc at right angles, which those of this one are not.
    (path,) = svg.parse(page('<g transform="skewX(20) scale(.7 1.3)"><circle r="9"/></g>')).lines
    x, y = path.points[:, 0], (50.0 - path.points[:, 1]) / 1.3
    radius = np.hypot((x - np.tan(np.radians(20)) * 1.3 * y) / 0.7, y)
    assert radius == pytest.approx(9.0, abs=2e-4) and len(radius) > 40


def test_a_symbol_fills_the_size_of_its_use() -> None:
    symbol = '<symbol id="s" viewBox="0 0 10 10"><path d="M0 0 L10 10"/></symbol>'
    shown = nodes(f'{symbol}<use href="#s" x="20" y="10" width="20" height="40"/>')
    assert shown == [[[20, 30], [40, 10]]]  # the symbol itself is not drawn
    nested = '<svg x="10" y="5" width="50%" height="50%" viewBox="0 0 50 25">'
    assert nodes(nested + '<rect width="50" height="25"/></svg>')[0][0] == [10, 45]


@pytest.mark.parametrize(
    ("inside", "drawn"),
    [
        ('<path d="M0 0L9 9" display="none"/>', 0),
        ('<g style="display:none"><path d="M0 0L9 9"/></g>', 0),
        ('<g visibility="hidden"><path d="M0 0L9 9"/>'
         '<path visibility="visible" d="M0 0L9 9"/></g>', 1),
        ('<path d="M0 0L9 9" fill="none"/>', 0),
        ('<g stroke="red"><path d="M0 0L9 9" style="fill: none"/></g>', 1),
        ('<style>.a, #b {fill: none} path {stroke: red} g.c{display:none}</style>'
         '<path class="x a" d="M0 0L9 9"/><rect id="b" width="3" height="3"/>'
         '<g class="c"><path d="M0 0L9 9"/></g>', 1),
        ('<style>#b{fill:red} .a{fill:none}</style>'
         '<rect id="b" class="a" width="3" height="3"/>', 1),
        ('<switch><foreignObject/><g><path d="M0 0L9 9"/></g><path d="M0 0L9 9"/></switch>', 1),
        ('<clipPath><path d="M0 0L9 9"/></clipPath><mask><path d="M0 0L9 9"/></mask>', 0),
        ('<rect width="0" height="9"/><circle r="0"/><path d=""/><path d="M 5 5"/>', 0),
    ],
)  # fmt: skip
def test_what_is_not_seen_is_not_drawn(inside: str, drawn: int) -> None:
    assert len(svg.parse(page(inside)).lines) == drawn


def test_everything_left_out_is_told_once_with_its_first_line() -> None:
    text = page(
        '<text x="3">a</text>\n<g><text>b<tspan>c</tspan></text></g>\n<image width="3"/>\n'
        '<path d="M0 0L9 9" clip-path="url(#c)" marker-end="url(#m)"/>\n<use href="#none"/>\n'
        '<rect width="4" height="4" visibility="hidden"/>\n'
        "<style>g > path {fill: red}</style>"
    )
    assert words(text) == [
        "passed over selector of a style sheet other than a tag, class or id (line 8)",
        "left out <text>, 2 times (line 2)",
        "left out <image> (line 4)",
        "clip-path: drawn whole (line 5)",
        "left out markers of a line (line 5)",
        "left out <use> of #none, which is not there (line 6)",
        "left out hidden <rect> (line 7)",
    ]
    told = words(page("<path d='M0 0L9 9'/>", "viewBox='0 0 9 9'"))
    assert told == [f"no {key} in a unit: one of the drawing is 1/96 inch (line 1)"
                    for key in ("width", "height")]  # fmt: skip


@pytest.mark.parametrize(
    ("inside", "told"),
    [
        ('<path d="M5 5L95 45"/>', []),
        ('<path d="M5 5L95 55"/>', ["edge of <svg>: what is beyond it is drawn, too (line 1)"]),
        (
            '<svg width="9" height="9"><path d="M5 5L9.5 4"/></svg>',
            ["edge of <svg>: what is beyond it is drawn, too (line 2)"],
        ),
        ('<svg width="9" height="9" overflow="visible"><path d="M5 5L9.5 4"/></svg>', []),
    ],
)
def test_an_edge_cuts_nothing_off_but_is_told(inside: str, told: list[str]) -> None:
    assert words(page(inside)) == told


@pytest.mark.parametrize(
    ("inside", "told"),
    [
        ("<path", "line 3: no XML: "),
        ('\n<path d="M0 0 L 5 X"/>', "line 3: <path> d = 'M0 0 L 5 X': 'X' is no path data"),
        ('<path d="M0 0 L 5"/>', "line 2: <path> d = 'M0 0 L 5': path data ends within a command"),
        ('<path d="L 5 5"/>', "path data that begins with M wanted"),
        ('<path d="M0 0 L 1e400 3"/>', "coordinates below 1e9 wanted"),
        ('<circle r="-3"/>', "line 2: <circle> r = '-3': 0 or more wanted"),
        ('<rect width="3furlong" height="3"/>', "width = '3furlong': a length wanted"),
        ('<polygon points="1 2 3"/>', "points = '1 2 3': an even number of coordinates wanted"),
        ('<g transform="turn(3)"/>', "<g> transform = 'turn(3)': turn with 1 numbers is no"),
        ('<svg viewBox="0 0 5"/>', "<svg> viewBox = '0 0 5': x, y, width and height wanted"),
        ('<g id="a"><use href="#a"/></g>', "line 2: <use> #a shows itself"),
        ('<use id="a" href="#b"/><use id="b" href="#a"/>', "shows itself"),
    ],
)
def test_what_is_wrong_is_told_with_file_line_and_value(inside: str, told: str) -> None:
    (found,) = refusal(svg.parse, page(inside), "a.svg")
    assert found.startswith("a.svg: line ") and told in found


def test_no_more_is_drawn_than_there_is_room_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(svg, "ELEMENTS_MAX", 1000)
    more = "".join(f'<g id="g{k}">{f"<use href=%#g{k - 1}%/>" * 10}</g>' for k in range(1, 9))
    text = page('<path id="g0" d="M0 0L1 1"/>' + more.replace("%", '"'))
    assert "1001th element" in refusal(svg.parse, text)[0]
    assert refusal(svg.parse, b"<html/>", "a.svg") == ["a.svg: line 1: <html> is no <svg>"]


def test_pens_are_colours_and_each_line_knows_its_place(tmp_path: Path) -> None:
    text = page(
        '<g stroke="#f00"><path d="M0 0L9 9"/>\n<path d="M20 20L9 9"/></g>\n'
        '<path stroke="red" d="M20 20L30 20"/><path fill="blue" d="M0 40 L5 40"/>'
    )
    found = svg.parse(text, "a.svg")
    assert found.pens == {1: "#ff0000", 2: "#0000ff"}
    assert [found.where(p.first) for p in found.lines[:2]] == ["a.svg: line 2", "a.svg: line 3"]
    red, blue = contours_of(found, DrawingOptions())
    assert red.path.source.tolist() in ([2, 3, 4], [4, 3, 2]) and blue.pen == 2
