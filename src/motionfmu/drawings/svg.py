"""Drawings in SVG: their shapes as paths, pens by colour, notes on what is left out."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NoReturn

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.drawings.drawing import Drawing, Polyline
from motionfmu.drawings.left_out import LeftOut
from motionfmu.drawings.pen_path import Array
from motionfmu.drawings.svg_shapes import SHAPES, ShapePen, ShapeValues
from motionfmu.drawings.svg_words import (
    IDENTITY,
    PX,
    StyleRule,
    WrongValue,
    declarations,
    fitted,
    length,
    numbers,
    style_rules,
    transform,
)

_NAMESPACE = "http://www.w3.org/2000/svg"
_LINK = "{http://www.w3.org/1999/xlink}href"
# What draws nothing where it stands.
_SILENT = set(
    "defs symbol clipPath mask marker pattern linearGradient radialGradient meshgradient hatch "
    "solidColor filter title desc metadata style script animate animateTransform animateMotion "
    "animateColor set font font-face view cursor color-profile discard mpath".split()
)
_GROUPS = ("g", "a", "switch")
_UNSEEN = {"clip-path": "clip-path: drawn whole", "mask": "mask: drawn whole"}
_MARKERS = ("marker", "marker-start", "marker-mid", "marker-end")
_INHERITED = ("fill", "stroke", "visibility", "color", *_MARKERS)
ELEMENTS_MAX = 500_000  # those that `use` repeats, each time
DEPTH_MAX = 200
_SIZE = (300.0, 150.0)  # [px] of a drawing that says nothing of its size


@dataclass(frozen=True, eq=False)
class _Around:
    """What holds for the elements inside one."""

    matrix: Array  # to the sheet [mm]
    size: tuple[float, float]  # of the viewport in user units
    style: Mapping[str, str]
    used: tuple[Any, ...] = ()  # elements that `use` is at
    depth: int = 0


def parse(text: bytes, name: str = "drawing") -> Drawing:
    """Read the text of an SVG file.

    A circle or an arc of one is an arc, what a transform makes an ellipse is cubic curves within
    pen_path.NEAR of it, and a curve is itself.
    """
    return _SvgReader(text, name).drawing()


class _SvgReader:
    """Goes through the elements of a file."""

    def __init__(self, text: bytes, name: str) -> None:
        from lxml import etree

        self.text, self.name, self.left = text, name, LeftOut()
        parser = etree.XMLParser(
            resolve_entities="internal", no_network=True, huge_tree=True, remove_comments=True
        )
        try:
            self.root = etree.fromstring(text, parser)
        except etree.XMLSyntaxError as error:
            line, told = error.lineno or 1, str(error.msg).partition(", line ")[0]
            raise InputError(f"{name}: line {line}: no XML: {told}") from None
        if _tag(self.root) != "svg":
            raise InputError(f"{name}: line 1: <{self.root.tag}> is no <svg>")
        self.by_id = {e.get("id"): e for e in self.root.iter() if e.get("id")}
        self.rules = self._rules()
        self.lines: list[Polyline] = []
        self.pens: dict[str, int] = {}
        self.count = 0

    def _rules(self) -> list[StyleRule]:
        found: list[StyleRule] = []
        for element in self.root.iter():
            if _tag(element) == "style":
                rules, unknown = style_rules("".join(element.itertext()))
                found += rules
                for _ in range(unknown):
                    what = "selector of a style sheet other than a tag, class or id"
                    self.left.add(what, element.sourceline, "passed over")
        return sorted(found, key=lambda rule: rule.strength)

    def drawing(self) -> Drawing:
        """All that is seen."""
        width, height = self._sheet()
        to_mm = np.array([[PX, 0, 0], [0, -PX, PX * height], [0, 0, 1]])
        around = _Around(to_mm, (width, height), {"fill": "black", "stroke": "none"})
        self._viewport(self.root, around, (width, height))
        pens = {number: colour for colour, number in self.pens.items()}
        return Drawing(
            self.lines,
            self.left.notes(),
            self.name,
            self.text,
            place="line {}".format,
            ordered=False,
            pens=pens,
        )

    def _sheet(self) -> tuple[float, float]:
        """Width and height of the drawing [px]."""
        box = self._box(self.root)
        whole = (box[2], box[3]) if box else _SIZE
        found = []
        for key, full in zip(("width", "height"), whole, strict=True):
            text = (self.root.get(key) or "").strip()
            if not text or text in ("auto",) or text.endswith("%"):
                what = f"no {key} in a unit: one of the drawing is 1/96 inch"
                self.left.add(what, self.root.sourceline, "")
            value = self._value(self.root, key, length, text or "100%", full)
            found.append(value if value > 0.0 else full)
        return found[0], found[1]

    def _refuse(self, element: Any, what: str) -> NoReturn:
        told = f"line {element.sourceline}: <{_tag(element)}> {what}"
        raise InputError(f"{self.name}: {told}")

    def _value(self, element: Any, key: str, read: Any, text: str, *more: Any) -> Any:
        """A value of an element, read; the error says where it stands."""
        try:
            return read(text, *more)
        except WrongValue as error:
            shown = text if len(text) < 60 else f"{text[:57]}..."
            self._refuse(element, f"{key} = {shown!r}: {error}")

    def _box(self, element: Any) -> list[float] | None:
        text = element.get("viewBox")
        if text is None:
            return None
        box: list[float] = self._value(element, "viewBox", numbers, text)
        if len(box) != 4 or box[2] < 0.0 or box[3] < 0.0:
            self._refuse(element, f"viewBox = {text!r}: x, y, width and height wanted")
        return box if box[2] > 0.0 and box[3] > 0.0 else None

    def _viewport(self, element: Any, around: _Around, size: tuple[float, float]) -> None:
        """An svg or a symbol, whose view box fills a viewport."""
        style = self._style(element, around)
        if style is None:
            return
        whole = size
        edge = matrix = around.matrix @ self._own_matrix(element, style)
        if box := self._box(element):
            aspect = element.get("preserveAspectRatio") or ""
            fit = self._value(
                element, "preserveAspectRatio", lambda text: fitted(box, size, text), aspect
            )
            matrix, size = matrix @ fit, (box[2], box[3])
        first = len(self.lines)
        self._inside(element, replace(around, matrix=matrix, size=size, style=style))
        if style.get("overflow") != "visible" and self._beyond(first, edge, whole):
            what = f"edge of <{_tag(element)}>: what is beyond it is drawn, too"
            self.left.add(what, element.sourceline, "")

    def _beyond(self, first: int, edge: Array, size: tuple[float, float]) -> bool:
        """Whether lines from the first on leave a viewport, which would cut them off."""
        if abs(np.linalg.det(edge)) < 1e-12:
            return False
        back = np.linalg.inv(edge)
        nodes = [p.points @ back[:2, :2].T + back[:2, 2] for p in self.lines[first:]]
        slack = 1e-6 * max(size)
        return any((p < -slack).any() or (p > np.array(size) + slack).any() for p in nodes)

    def _inside(self, element: Any, around: _Around) -> None:
        if around.depth > DEPTH_MAX:
            self._refuse(element, f"stands deeper than {DEPTH_MAX} elements")
        deeper = replace(around, depth=around.depth + 1)
        for inner in _shown(element):
            self._element(inner, deeper)

    def _style(self, element: Any, around: _Around) -> dict[str, str] | None:
        """Properties of an element; None if it is not to be seen."""
        own: dict[str, str] = {k: v for k, v in element.attrib.items() if k in _STYLED}
        names = frozenset(
            [f".{c}" for c in (element.get("class") or "").split()] + [f"#{element.get('id')}"]
        )
        for rule in self.rules:
            if rule.of(_tag(element), names):
                own |= rule.says
        own |= declarations(element.get("style") or "")
        if own.get("display") == "none":
            self.left.add(f"not displayed <{_tag(element)}>", element.sourceline)
            return None
        self._told_of(element, own)
        kept = {k: v for k, v in around.style.items() if k in _INHERITED}
        return kept | {k: v for k, v in own.items() if v != "inherit"}

    def _told_of(self, element: Any, own: Mapping[str, str]) -> None:
        for key, what in _UNSEEN.items():
            if own.get(key, "none") != "none":
                self.left.add(what, element.sourceline, "")

    def _own_matrix(self, element: Any, style: Mapping[str, str]) -> Array:
        text = style.get("transform") if element.get("transform") is None else None
        text = text or element.get("transform")
        if text is None:
            return IDENTITY
        found: Array = self._value(element, "transform", transform, text)
        return found

    def _element(self, element: Any, around: _Around) -> None:
        self.count += 1
        if self.count > ELEMENTS_MAX:
            self._refuse(element, f"is the {ELEMENTS_MAX + 1}th element, too many")
        tag = _tag(element)
        if tag is None or tag in _SILENT:
            return
        if tag == "svg":
            self._nested(element, around)
            return
        style = self._style(element, around)
        if style is None:
            return
        inner = replace(
            around, matrix=around.matrix @ self._own_matrix(element, style), style=style
        )
        if tag in _GROUPS:
            self._inside(element, inner)
        elif tag == "use":
            self._use(element, inner)
        elif tag in SHAPES:
            self._shape(element, inner)
        else:
            self.left.add(f"<{tag}>", element.sourceline)

    def _lengths(self, element: Any, around: _Around, names: str) -> list[float]:
        values = ShapeValues(element.attrib, around.size)
        return [
            self._value(element, n, lambda _, n=n: values.length(n), element.get(n) or "")
            for n in names.split()
        ]

    def _nested(self, element: Any, around: _Around, of_use: Any = None) -> None:
        """An svg within one, or one that `use` shows, which may say another size."""
        x, y = self._lengths(element, around, "x y")
        size = []
        for key, full in zip(("width", "height"), around.size, strict=True):
            text = (of_use.get(key) if of_use is not None else None) or element.get(key) or "100%"
            size.append(self._value(element, key, length, text, full))
        shift = np.array([[1, 0, x], [0, 1, y], [0, 0, 1]], float)
        if size[0] > 0.0 and size[1] > 0.0:
            moved = replace(around, matrix=around.matrix @ shift)
            self._viewport(element, moved, (size[0], size[1]))

    def _use(self, element: Any, around: _Around) -> None:
        link = element.get("href") or element.get(_LINK) or ""
        target = self.by_id.get(link[1:]) if link.startswith("#") else None
        if target is None:
            self.left.add(f"<use> of {link or 'nothing'}, which is not there", element.sourceline)
            return
        if target in around.used or target in element.iterancestors():
            self._refuse(element, f"{link} shows itself")
        x, y = self._lengths(element, around, "x y")
        shift = np.array([[1, 0, x], [0, 1, y], [0, 0, 1]], float)
        inner = replace(around, matrix=around.matrix @ shift, used=(*around.used, target))
        if inner.depth > DEPTH_MAX:
            self._refuse(element, f"stands deeper than {DEPTH_MAX} elements")
        if _tag(target) in ("symbol", "svg"):
            self._nested(target, replace(inner, depth=inner.depth + 1), element)
        else:
            self._element(target, replace(inner, depth=inner.depth + 1))

    def _shape(self, element: Any, around: _Around) -> None:
        style = around.style
        line = element.sourceline
        if style.get("visibility") in ("hidden", "collapse"):
            self.left.add(f"hidden <{_tag(element)}>", line)
            return
        paint = [style.get(key, "none").strip() for key in ("stroke", "fill")]
        seen = [p for p in paint if p not in ("none", "transparent", "")]
        if not seen:
            self.left.add(f"<{_tag(element)}> without stroke and fill", line)
            return
        pen = ShapePen(around.matrix, line)
        values = ShapeValues(element.attrib, around.size)
        try:
            SHAPES[_tag(element)](pen, values)
        except WrongValue as error:
            text = element.get(values.name) or ""
            shown = text if len(text) < 60 else f"{text[:57]}..."
            self._refuse(element, f"{values.name} = {shown!r}: {error}")
        number = self.pens.setdefault(_colour(seen[0], style), len(self.pens) + 1)
        self.lines += (Polyline(number, True, path, line) for path in pen.paths())
        if any(style.get(key, "none") != "none" for key in _MARKERS):
            self.left.add("markers of a line", line)


_STYLED = ("display", "transform", "overflow", *_UNSEEN, *_INHERITED)


def _tag(element: Any) -> Any:
    """The name of an element of SVG; None for others."""
    if not isinstance(element.tag, str):
        return None
    space, _, name = element.tag.rpartition("}")
    return name if space in ("", "{" + _NAMESPACE) else None


def _shown(element: Any) -> Iterator[Any]:
    """Elements in one; of a switch the first that any reader knows."""
    if _tag(element) != "switch":
        yield from element
        return
    for inner in element:
        if _tag(inner) not in (None, "foreignObject") and not inner.get("requiredExtensions"):
            yield inner
            return


def _colour(text: str, style: Mapping[str, str]) -> str:
    from svgelements import Color

    text = style.get("color", "black") if text.lower() == "currentcolor" else text
    if text.startswith("url("):
        return text
    try:
        return str(Color(text).hex or text)
    except (ValueError, TypeError):
        return text
