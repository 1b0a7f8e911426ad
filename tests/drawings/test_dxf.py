"""DXF: each entity, blocks, units and layers, where ezdxf's own flattening has them."""

import io
from collections.abc import Callable

import ezdxf
import numpy as np
import pytest
from ezdxf import disassemble
from ezdxf.document import Drawing as Document
from lines_apart import apart
from refusals import refusal

from motionfmu.drawings import DrawingOptions, dxf
from motionfmu.drawings.contours import contours_of


def text_of(doc: Document) -> bytes:
    out = io.StringIO()
    doc.write(out)
    return out.getvalue().encode()


def made(draw: Callable, unit: int = 4) -> Document:
    doc = ezdxf.new("R2010", units=unit)
    draw(doc, doc.modelspace())
    return doc


def theirs(doc: Document) -> list[np.ndarray]:
    """Lines of the model space by ezdxf [drawing units]."""
    entities = disassemble.recursive_decompose(doc.modelspace())
    parts = disassemble.to_primitives(entities, max_flattening_distance=1e-4)
    found = [np.array([(v.x, v.y) for v in p.vertices()]) for p in parts]
    return [p for p in found if len(p) > 1]


def curves(doc: Document, at) -> None:
    at.add_spline([(0, 0), (10, 20), (30, -10), (45, 12), (60, 3)])  # by fit points
    at.add_open_spline([(0, 30), (10, 50), (30, 20), (40, 40), (60, 30)], degree=2)
    at.add_open_spline([(0, 60), (9, 80), (30, 50), (40, 70), (60, 60), (70, 90)], degree=5)
    at.add_rational_spline([(0, 90), (0, 110), (20, 110), (40, 90)], [1, 0.7, 3, 1])


def bulges(doc: Document, at) -> None:
    rows = [(0, 0, 0), (10, 0, 0.5), (10, 10, -0.3), (0, 10, 2.0)]
    at.add_lwpolyline(rows, format="xyb", close=True)
    at.add_lwpolyline([(x + 30, y, b) for x, y, b in rows], format="xyb")
    at.add_lwpolyline(rows, format="xyb", dxfattribs={"extrusion": (0, 0, -1)})
    at.add_polyline2d([(x, y + 40, b) for x, y, b in rows], format="xyb", close=True)
    at.add_polyline3d([(0, 70, 0), (5, 75, 0), (9, 70, 0)])


def blocks(doc: Document, at) -> None:
    inner = doc.blocks.new("inner", base_point=(1, 1))
    inner.add_circle((3, 4), 2)
    inner.add_lwpolyline([(0, 0, 0.4), (5, 5, 0)], format="xyb")
    outer = doc.blocks.new("outer")
    outer.add_blockref("inner", (10, 0), {"rotation": 30, "xscale": 2, "yscale": 2})
    outer.add_line((0, 0), (3, 3))
    at.add_blockref("outer", (50, 0), {"rotation": -20, "xscale": 1.5, "yscale": 0.5})
    at.add_blockref("outer", (0, 50), {"xscale": -1})
    grid = {"row_count": 2, "column_count": 3, "row_spacing": 30, "column_spacing": 40}
    at.add_blockref("inner", (100, 100), grid | {"rotation": 10})


def rounds(doc: Document, at) -> None:
    at.add_line((0, 0), (30, 5))
    at.add_arc((10, 20), 8, 300, 100)
    at.add_arc((50, 20), 8, 10, 200, dxfattribs={"extrusion": (0, 0, -1)})
    at.add_circle((40, 40), 7)
    at.add_ellipse((70, 20), (20, 5), 0.4, 0.5, 5.0)
    at.add_ellipse((70, 60), (0, 9), 0.8)


@pytest.mark.parametrize("draw", [rounds, bulges, curves, blocks])
def test_entities_are_where_another_reader_has_them(draw: Callable) -> None:
    doc = made(draw)
    found = dxf.parse(text_of(doc))
    ours, other = [p.points for p in found.lines], theirs(doc)
    assert found.notes == [] and len(ours) == len(other)
    # Arcs of its polylines are cubic curves, 2.7e-4 of their radius off; these are up to 10 mm.
    near = 0.001 if draw in (rounds, curves) else 0.0028
    assert apart(ours, other) < near and apart(other, ours) < 0.0052 + near


def test_circles_stay_arcs_splines_stay_curves() -> None:
    doc = made(rounds)
    line, arc, mirrored, circle, *ovals = (p.path for p in dxf.parse(text_of(doc)).lines)
    assert not line.bulges.any() and (arc.bulges > 0).all() and (mirrored.bulges < 0).all()
    assert circle.bulges == pytest.approx([1, 1])
    assert all(p.curved.all() for p in ovals)
    cubic = made(lambda doc, at: at.add_open_spline([(0, 0), (1, 2), (3, 1), (4, 4)]))
    (found,) = dxf.parse(text_of(cubic)).lines
    assert found.path.piece(0).tolist() == [[0, 0], [1, 2], [3, 1], [4, 4]]


def test_a_closed_spline_goes_round_once() -> None:
    # ezdxf's flattening goes on over the knots at either end, where there is no curve.
    corners = np.array([(80.0, 0, 0), (100, 0, 0), (105, 20, 0), (85, 25, 0)])
    doc = made(lambda doc, at: at.add_spline().set_closed(corners))
    (found,) = contours_of(dxf.parse(text_of(doc)), DrawingOptions())
    assert found.closed and len(found.path.source) == 4
    uniform = [(corners[k - 1] + 4 * corners[k] + corners[(k + 1) % 4]) / 6 for k in range(4)]
    nodes = found.path.nodes
    assert all(np.linalg.norm(nodes - place[:2], axis=1).min() < 1e-6 for place in uniform)


def test_a_skew_plane_is_seen_from_above() -> None:
    def askew(doc: Document, at) -> None:
        at.add_circle((0, 0), 10, dxfattribs={"extrusion": (0, 1, 1)})
        at.add_lwpolyline(
            [(0, 0, 1), (10, 0, 0)], format="xyb", dxfattribs={"extrusion": (1, 0, 2)}
        )
        at.add_line((0, 0, 5), (3, 4, 9))

    doc = made(askew)
    found = dxf.parse(text_of(doc))
    ours, other = [p.points for p in found.lines], theirs(doc)
    assert apart(ours, other) < 0.0028 and apart(other, ours) < 0.008
    assert [n.text.split(" with ")[0] for n in found.notes] == ["CIRCLE", "LWPOLYLINE", "LINE"]
    assert all("Z other than 0: drawn as seen from above" in n.text for n in found.notes)


@pytest.mark.parametrize(("unit", "size"), [(4, 1.0), (1, 25.4), (5, 10.0), (6, 1000.0), (0, 1.0)])
def test_units_become_millimetres(unit: int, size: float) -> None:
    found = dxf.parse(text_of(made(lambda doc, at: at.add_line((0, 0), (2, 1)), unit)))
    assert found.lines[0].path.nodes[1] == pytest.approx([2 * size, size])
    assert [n.words for n in found.notes] == ([] if unit else ["no unit ($INSUNITS): one is 1 mm"])


def hidden(doc: Document, at) -> None:
    for name in ("off", "frozen", "there"):
        doc.layers.add(name)
    doc.layers.get("off").off()
    doc.layers.get("frozen").freeze()
    block = doc.blocks.new("b")
    block.add_line((0, 0), (9, 9))  # on layer 0: that of the insert
    block.add_line((0, 0), (8, 9), {"layer": "off"})
    at.add_line((0, 0), (1, 1), {"layer": "off"})
    at.add_circle((0, 0), 3, {"layer": "frozen"})
    at.add_line((0, 0), (2, 1), {"invisible": 1})
    at.add_blockref("b", (0, 0), {"layer": "there"})
    at.add_blockref("b", (0, 0), {"layer": "frozen"})
    at.add_text("word")
    at.add_text("word")
    at.add_mtext("words")
    at.add_point((1, 1))
    at.add_hatch().paths.add_polyline_path([(0, 0), (1, 0), (1, 1)])


def test_what_is_off_is_not_drawn_and_what_is_left_out_is_told() -> None:
    found = dxf.parse(text_of(made(hidden)), "a.dxf")
    assert [p.path.nodes[1].tolist() for p in found.lines] == [[9, 9]]
    assert found.pens == {1: "there"}
    told = {n.text: n.count for n in found.notes}
    unseen = "{} that is off, frozen or invisible".format
    assert told == {
        unseen("LINE"): 3,
        unseen("CIRCLE"): 1,
        unseen("INSERT"): 1,
        "TEXT": 2,
        "MTEXT": 1,
        "POINT": 1,
        "HATCH": 1,
    }
    rows = text_of(made(hidden)).splitlines()
    (text,) = (n for n in found.notes if n.text == "TEXT")
    assert rows[text.line - 1] == b"TEXT"
    assert found.told.startswith("a.dxf: left out ") and "TEXT, 2 times (line " in found.told


def test_a_line_knows_its_place() -> None:
    doc = made(lambda doc, at: at.add_line((0, 0), (1, 1)))
    text = text_of(doc)
    found = dxf.parse(text, "a.dxf")
    where = found.where(found.lines[0].first)
    handle = doc.modelspace()[0].dxf.handle
    line = text.splitlines().index(b"LINE") + 1
    assert where == f"a.dxf: line {line}, LINE {handle}"


def test_loose_lines_and_arcs_become_one_outline() -> None:
    def slot(doc: Document, at) -> None:
        at.add_arc((40, 0), 5, 270, 90)
        at.add_line((0, 5), (40, 5))
        at.add_line((40, -5), (0, -5.004))
        at.add_arc((0, 0), 5, 90, 270)
        at.add_circle((20, 0), 2)

    inner, outer = contours_of(dxf.parse(text_of(made(slot))), DrawingOptions())
    assert inner.closed and outer.closed and np.count_nonzero(outer.path.bulges) == 2
    way = np.linalg.norm(np.diff(outer.points, axis=0), axis=1).sum()
    assert way == pytest.approx(80 + 10 * np.pi, abs=0.02)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (b"AC1032\0\0", "a.dxf: a DWG; save it as DXF"),
        (b"hello\nworld\n", "a.dxf: no DXF: "),
        (b"", "a.dxf: no DXF: it is empty"),
    ],
)
def test_what_is_no_drawing(text: bytes, told: str) -> None:
    (found,) = refusal(dxf.parse, text, "a.dxf")
    assert found.startswith(told)


def test_units_and_places_beyond_all_sheets() -> None:
    light_years = made(lambda doc, at: at.add_line((0, 0), (1, 1)), 19)
    (told,) = refusal(dxf.parse, text_of(light_years), "a.dxf")
    assert "coordinates below 1e9 mm wanted" in told and ", LINE " in told
