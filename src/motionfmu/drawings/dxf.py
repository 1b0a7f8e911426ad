"""Drawings in DXF: the lines of the model space, pens by layer, notes on what is left out."""

import io
import logging
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.drawings.drawing import Drawing, Polyline
from motionfmu.drawings.left_out import LeftOut
from motionfmu.drawings.pen_path import Array, EllipseAxes, PathMaker, PenPath, cubics_of

_FLAT = 1e-6  # [drawing units] Z that counts as 0
_BINARY = b"AutoCAD Binary DXF"
DEPTH_MAX = 50  # of blocks in blocks
ENTITIES_MAX = 1_000_000  # those of blocks each time they are inserted
_FRAME = 16  # flag of vertices that are a control frame
_AHEAD = 1e-9  # share of a span by which its ends are taken within it


def parse(text: bytes, name: str = "drawing") -> Drawing:
    """Read the text of a DXF file.

    Circles and arcs are arcs; splines are themselves up to the third degree; ellipses and other
    splines are cubic curves within pen_path.NEAR of them.
    """
    return _DxfReader(text, name).drawing()


@dataclass(frozen=True)
class _Inside:
    """What holds for the entities of a block."""

    layer: str | None = None  # that of the INSERT, for what is on layer 0
    handle: str = ""  # of the outermost INSERT
    depth: int = 0


class _DxfReader:
    """Goes through the entities of a file."""

    def __init__(self, text: bytes, name: str) -> None:
        self.text, self.name, self.left = text, name, LeftOut()
        self.lines: list[Polyline] = []
        self.places: list[str] = []
        self.pens: dict[str, int] = {}
        self.count = 0
        self.doc = self._document()
        self.scale = self._scale()

    def _document(self) -> Any:
        from ezdxf import recover
        from ezdxf.document import Drawing as Document
        from ezdxf.lldxf.const import DXFError
        from ezdxf.lldxf.tagger import binary_tags_loader

        logging.getLogger("ezdxf").addHandler(logging.NullHandler())
        if not self.text.strip():
            raise InputError(f"{self.name}: no DXF: it is empty")
        if self.text[:4] == b"AC10":
            raise InputError(f"{self.name}: a DWG; save it as DXF")
        try:
            if self.text.startswith(_BINARY):
                return Document.load(binary_tags_loader(self.text))
            doc, auditor = recover.read(io.BytesIO(self.text))
        except (DXFError, OSError, ValueError, LookupError, ArithmeticError, TypeError) as error:
            told = str(error).split("\n")[0] or type(error).__name__
            raise InputError(f"{self.name}: no DXF: {told}") from None
        for fault in auditor.errors:
            self.left.add(f"damaged: {fault.message}", 0)
        return doc

    def _scale(self) -> float:
        """Millimetres of a drawing unit."""
        from ezdxf import units

        unit = int(self.doc.header.get("$INSUNITS", 0) or 0)
        if unit == 0:
            self.left.add("no unit ($INSUNITS): one is 1 mm", 0, "")
            return 1.0
        try:
            return float(
                units.conversion_factor(units.InsertUnits(unit), units.InsertUnits.Millimeters)
            )
        except (ValueError, TypeError, IndexError):
            raise InputError(f"{self.name}: $INSUNITS = {unit}: no unit of length") from None

    def drawing(self) -> Drawing:
        """All lines that are seen in model space."""
        self._all(self.doc.modelspace(), _Inside())
        paper = sum(len(layout) for layout in self.doc.layouts if not layout.is_modelspace)
        if paper and not self.lines:
            self.left.add(f"{paper} entities in paper space", 0)
        pens = {number: layer for layer, number in self.pens.items()}
        return Drawing(
            self.lines,
            self.left.notes(),
            self.name,
            self.text,
            place=self.places.__getitem__,
            ordered=False,
            pens=pens,
        )

    @cached_property
    def _lines_of_handles(self) -> dict[str, int]:
        """Line of the file at which the entity of each handle begins."""
        if self.text.startswith(_BINARY):
            return {}
        found: dict[str, int] = {}
        rows, begins = self.text.splitlines(), 0
        for k in range(0, len(rows) - 1, 2):
            code = rows[k].strip()
            if code == b"0":
                begins = k + 1
            elif code == b"5":
                found.setdefault(rows[k + 1].strip().decode("ascii", "replace").upper(), begins + 1)
        return found

    def _place(self, entity: Any, inside: _Inside) -> int:
        """The number of an entity's place, which `Drawing.where` takes."""
        origin = entity.origin_of_copy if entity.is_copy else None
        handle = str((origin or entity).dxf.get("handle") or inside.handle or "")
        line = self._lines_of_handles.get(handle.upper())
        words = f"{entity.dxftype()} {handle}".strip()
        self.places.append(f"line {line}, {words}" if line else words)
        return len(self.places) - 1

    def _line(self, entity: Any) -> int:
        origin = entity.origin_of_copy if entity.is_copy else None
        handle = str((origin or entity).dxf.get("handle") or "")
        return self._lines_of_handles.get(handle.upper(), 0)

    def _all(self, entities: Iterable[Any], inside: _Inside) -> None:
        for entity in entities:
            self.count += 1
            if self.count > ENTITIES_MAX:
                raise InputError(f"{self.name}: more than {ENTITIES_MAX} entities in its blocks")
            self._entity(entity, inside)

    def _entity(self, entity: Any, inside: _Inside) -> None:
        kind, line = entity.dxftype(), self._line(entity)
        layer = str(entity.dxf.get("layer", "0"))
        layer = inside.layer if inside.layer is not None and layer == "0" else layer
        if not self._seen(entity, layer):
            self.left.add(f"{kind} that is off, frozen or invisible", line)
        elif kind == "INSERT":
            self._insert(entity, _Inside(layer, inside.handle, inside.depth + 1))
        elif kind not in _READERS:
            self.left.add(kind, line)
        else:
            self._draw(entity, layer, inside)

    def _seen(self, entity: Any, layer: str) -> bool:
        if entity.dxf.get("invisible", 0):
            return False
        if layer not in self.doc.layers:
            return True
        found = self.doc.layers.get(layer)
        return not (found.is_off() or found.is_frozen())

    def _insert(self, entity: Any, inside: _Inside) -> None:
        if inside.depth > DEPTH_MAX:
            place = self.places[self._place(entity, inside)]
            raise InputError(f"{self.name}: {place}: blocks in blocks, {DEPTH_MAX} deep")
        if entity.block() is None:
            self.left.add(
                f"INSERT of {entity.dxf.get('name', '')!r}, which is not there", self._line(entity)
            )
            return
        within = _Inside(inside.layer, str(entity.dxf.handle or inside.handle), inside.depth)

        def skipped(other: Any, reason: str) -> None:
            self.left.add(f"{other.dxftype()} of a block ({reason})", self._line(other))

        every = entity.multi_insert() if entity.mcount > 1 else [entity]
        for one in every:
            self._all(one.virtual_entities(skipped_entity_callback=skipped), within)

    def _draw(self, entity: Any, layer: str, inside: _Inside) -> None:
        place = self._place(entity, inside)
        pen = EntityPen(place, self.scale)
        try:
            whole = _READERS[entity.dxftype()](pen, entity)
        except (ValueError, TypeError, IndexError, ArithmeticError) as error:
            self.left.add(f"{entity.dxftype()} that is damaged ({error})", self._line(entity))
            return
        if not whole:
            self.left.add(f"{entity.dxftype()} that is a surface", self._line(entity))
        if pen.high:
            what = f"{entity.dxftype()} with Z other than 0: drawn as seen from above"
            self.left.add(what, self._line(entity), "")
        if not pen.finite:
            raise InputError(f"{self.name}: {self.places[place]}: coordinates below 1e9 mm wanted")
        number = self.pens.setdefault(layer, len(self.pens) + 1) if pen.done else 0
        self.lines += (Polyline(number, True, path, place) for path in pen.done)


class EntityPen:
    """Draws entities; what it makes is on the sheet [mm]."""

    def __init__(self, source: int, scale: float) -> None:
        self.source, self.scale = source, scale
        self.done: list[PenPath] = []
        self.high = False  # something has another Z than 0

    def place(self, point: Any) -> Array:
        """A point of the world on the sheet."""
        self.high = self.high or abs(point.z) > _FLAT
        return np.array([point.x, point.y]) * self.scale

    def maker(self, start: Array) -> PathMaker:
        """A path that begins here."""
        return PathMaker(start, self.source)

    def keep(self, maker: PathMaker) -> None:
        """Take a path that is whole."""
        if not maker.empty:
            self.done.append(maker.path())

    @property
    def finite(self) -> bool:
        """Whether all places are some."""
        return all(bool((np.abs(p.nodes) < 1e9).all()) for p in self.done)


def _line(pen: EntityPen, entity: Any) -> bool:
    maker = pen.maker(pen.place(entity.dxf.start))
    maker.line(pen.place(entity.dxf.end))
    pen.keep(maker)
    return True


def _round(pen: EntityPen, entity: Any, begin: float, sweep: float) -> bool:
    """An arc or a circle, which may lie on a plane of its own [deg]."""
    from ezdxf.math import Vec3

    ocs, radius = entity.ocs(), float(entity.dxf.radius)
    u, v = (ocs.to_wcs(Vec3(*way)) for way in ((radius, 0, 0), (0, radius, 0)))
    axes = EllipseAxes(pen.place(ocs.to_wcs(entity.dxf.center)), pen.place(u), pen.place(v))
    _along(pen, axes, np.radians(begin), np.radians(sweep))
    return True


def _along(pen: EntityPen, axes: EllipseAxes, begin: float, sweep: float) -> None:
    maker = pen.maker(axes.at(begin))
    maker.ellipse(axes, begin, begin + sweep)
    if abs(sweep) > 2.0 * np.pi - 1e-9:
        maker.close()
    pen.keep(maker)


def _arc(pen: EntityPen, entity: Any) -> bool:
    begin, end = float(entity.dxf.start_angle), float(entity.dxf.end_angle)
    return _round(pen, entity, begin, (end - begin) % 360.0 or 360.0)


def _circle(pen: EntityPen, entity: Any) -> bool:
    return _round(pen, entity, 0.0, 360.0)


def _ellipse(pen: EntityPen, entity: Any) -> bool:
    begin, end = float(entity.dxf.start_param), float(entity.dxf.end_param)
    sweep = (end - begin) % (2.0 * np.pi)
    sweep = 2.0 * np.pi if sweep < 1e-9 or abs(end - begin) >= 2.0 * np.pi - 1e-9 else sweep
    u, v = pen.place(entity.dxf.major_axis), pen.place(entity.minor_axis)
    _along(pen, EllipseAxes(pen.place(entity.dxf.center), u, v), begin, sweep)
    return True


def _lwpolyline(pen: EntityPen, entity: Any) -> bool:
    rows = [(x, y, b) for x, y, b in entity.get_points("xyb")]
    _bulged(pen, entity, rows, float(entity.dxf.get("elevation", 0.0)), bool(entity.closed))
    return True


def _polyline(pen: EntityPen, entity: Any) -> bool:
    if entity.is_polygon_mesh or entity.is_poly_face_mesh:
        return False
    used = [v for v in entity.vertices if not v.dxf.get("flags", 0) & _FRAME]
    if entity.is_2d_polyline:
        rows = [(v.dxf.location.x, v.dxf.location.y, float(v.dxf.get("bulge", 0.0))) for v in used]
        height = float(entity.dxf.get("elevation").z if entity.dxf.hasattr("elevation") else 0.0)
        _bulged(pen, entity, rows, height, bool(entity.is_closed))
        return True
    places = [pen.place(v.dxf.location) for v in used]
    if len(places) > 1:
        maker = pen.maker(places[0])
        for place in places[1:]:
            maker.line(place)
        if entity.is_closed:
            maker.close()
        pen.keep(maker)
    return True


def _bulged(
    pen: EntityPen, entity: Any, rows: Sequence[tuple[float, float, float]], z: float, closed: bool
) -> None:
    """Lines and arcs between vertices of a plane."""
    from ezdxf.math import Vec3

    if len(rows) < 2:
        return
    ocs = entity.ocs()
    up = ocs.uz.z
    if abs(up) < 1.0 - 1e-9:  # it lies askew, and arcs are seen as ellipses
        for part in entity.virtual_entities():
            _READERS[part.dxftype()](pen, part)
        return
    places = [pen.place(ocs.to_wcs(Vec3(x, y, z))) for x, y, _ in rows]
    maker = pen.maker(places[0])
    ends = [*places[1:], places[0]] if closed else places[1:]
    for end, (_, _, bulge) in zip(ends, rows, strict=False):
        _bulge(maker, end, bulge if up > 0.0 else -bulge)
    pen.keep(maker)


def _bulge(maker: PathMaker, end: Array, bulge: float) -> None:
    """An arc by tan(angle / 4); one of more than half a circle becomes two."""
    if abs(bulge) <= 1.0:
        maker.arc(end, bulge)
        return
    start = maker.at
    half = np.tan(np.arctan(bulge) / 2.0)
    chord = end - start
    # The middle of the arc is bulge / 2 of the chord beside it, to its right.
    middle = 0.5 * (start + end) + 0.5 * bulge * np.array([chord[1], -chord[0]])
    maker.arc(middle, half)
    maker.arc(end, half)


def _spline(pen: EntityPen, entity: Any) -> bool:
    spline = entity.construction_tool()
    points = [pen.place(p) for p in spline.control_points]
    if spline.degree <= 3 and not spline.is_rational and spline.is_clamped:
        pieces = [np.array([pen.place(p) for p in b]) for b in spline.bezier_decomposition()]
    else:
        pieces = _spans(pen, spline)
    if not pieces or len(points) < 2:
        raise ValueError("no points")
    maker = pen.maker(pieces[0][0])
    for p in pieces:
        if len(p) == 2:
            maker.line(p[1])
        elif len(p) == 3:
            maker.cubic(p[0] + 2 / 3 * (p[1] - p[0]), p[2] + 2 / 3 * (p[1] - p[2]), p[2])
        else:
            maker.cubic(p[1], p[2], p[3])
    pen.keep(maker)
    return True


def _spans(pen: EntityPen, spline: Any) -> list[Array]:
    """Cubic curves near to a spline, between its knots."""
    knots, degree = list(spline.knots()), spline.degree
    inner = sorted(set(knots[degree : len(knots) - degree]))
    found: list[Array] = []
    for a, b in pairwise(inner):
        ahead = _AHEAD * (b - a)

        def place(t: float, a: float = a + ahead, b: float = b - ahead) -> tuple[Array, Array]:
            point, way = spline.derivative(min(max(t, a), b), 1)
            return pen.place(point), pen.place(way)

        found += cubics_of(place, a, b)
    return found


_READERS = {
    "LINE": _line,
    "ARC": _arc,
    "CIRCLE": _circle,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
    "HELIX": _spline,
}
