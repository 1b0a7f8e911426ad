"""Motion of an axis in its loop over pieces of a record, with exact derivatives.

With the machine's C compiler by ``shooting_loop.c`` and CasADi's text of the plant's equation, kept
in the cache; without one by CasADi's machine, all pieces at once.
"""

import copy
import ctypes
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.base import disk_cache
from motionfmu.base.compiler import FLAGS, Compiler, compiler
from motionfmu.identify.axis_loop import AxisLoop
from motionfmu.identify.plant_rates import Places, PlantRates

Array = NDArray[np.float64]
_LOOP = Path(__file__).parent / "native" / "shooting_loop.c"
_FAST = "-O3"
# Cycles after which the laws have taken in where they begin.
_REST = 3
# Fastest rate [1/s] of a plant whose motion is looked at: beyond it a value is wrong.
_FASTEST = 5e5
# Numbers of integration steps in a communication step.
_COUNTS = sorted({2**n for n in range(40)} | {3 * 2**n for n in range(40)})


@dataclass(frozen=True)
class Pieces:
    """Pieces of a record, each with a start of its own."""

    begin: NDArray[np.int64]  # communication point at which each begins
    length: NDArray[np.int64]  # communication steps
    every: int  # communication steps between two samples that are compared
    late: int = 0  # communication steps by which outputs of laws are sampled later, below `every`
    joined: NDArray[np.bool_] | None = None  # which begin where the one before ended; compiled only

    @property
    def samples(self) -> NDArray[np.int64]:
        """Samples of each."""
        return -(-self.length // self.every)


@dataclass(frozen=True)
class PieceStart:
    """State of all pieces at their beginning or end."""

    x: Array  # (pieces, n_x) of the plant
    w: Array  # (pieces, n_w) of the laws


@dataclass(frozen=True)
class Moved:
    """What a motion gave."""

    end: PieceStart
    ends: Array  # (pieces, n_x + n_w, directions): derivatives of the ends, x then w
    y: Array  # (samples, n_y + n_shown): outputs of the plant, then of the laws
    slopes: Array  # (samples, n_y + n_shown, directions)


class LoopMotion:
    """Motions of one loop; directions are the elements of the start, then the free quantities."""

    def __init__(self, loop: AxisLoop, rates: PlantRates, compiled: bool = True) -> None:
        self.loop, self.rates, self.sub_steps = loop, rates, 1
        self.contact = False  # whether contact opens and closes
        shown = list(rates.outputs)
        self._fed = np.array([shown.index(n) for n in loop.fed], dtype=np.int64)
        cc = compiler() if compiled else None
        self._library = None if cc is None else _library(rates, cc)

    def with_laws(self, loop: AxisLoop) -> "LoopMotion":
        """The same with other laws around the plant."""
        other = copy.copy(self)
        other.loop = loop
        return other

    @property
    def width(self) -> int:
        """Elements of a start."""
        return self.rates.width[0] + len(self.loop.laws.memory)

    def run(
        self,
        start: PieceStart,
        pieces: Pieces,
        driven: Array,
        values: tuple[Array, Array, Array, Array],
        bare: bool = False,
    ) -> Moved:
        """Move all pieces; `bare`: without derivatives.

        `driven` has a row of driven inputs for each communication point; `values` are p, u that
        stay, and the derivatives of moved parameters and of inputs to the free quantities.
        """
        p, u = values[0], np.repeat(values[1][:, None], len(start.x), axis=1)
        fastest = self.rates.fastest(start.x.T, u, p)
        if not fastest.max(initial=0.0) < _FASTEST:
            return self._nothing(start, pieces, values)
        needed = self.rates.steps(self.loop.step, fastest, self.contact)
        # of few numbers, so that a search mostly sees one function
        self.sub_steps = next(k for k in _COUNTS if k >= needed)
        every = self._compiled if self._library is not None else self._mapped
        return every(start, pieces, driven, values, bare)

    def chained(
        self,
        start: PieceStart,
        pieces: Pieces,
        driven: Array,
        values: tuple[Array, Array],
        joined: NDArray[np.bool_],
    ) -> tuple[PieceStart, Array]:
        """Starts of pieces where those that are joined begin at the end of the one before, and y.

        The others begin at `start`; `values` are p, u. Steps are as short as in the last `run`.
        """
        p, u = values
        still = p, u, np.zeros((len(self.rates.moved), 0)), np.zeros((len(u), 0))
        if self._library is not None:
            moved = self._compiled(start, replace(pieces, joined=joined), driven, still, bare=True)
            at, before = np.flatnonzero(joined), np.flatnonzero(joined) - 1
            x, w = start.x.copy(), start.w.copy()
            x[at], w[at] = moved.end.x[before], moved.end.w[before]
            return PieceStart(x, w), moved.y
        x, w = start.x.copy(), start.w.copy()
        shown, end = [], PieceStart(x[:1], w[:1])
        for k in range(len(x)):
            here = slice(k, k + 1)
            if joined[k]:
                x[k], w[k] = end.x[0], end.w[0]
            one = Pieces(pieces.begin[here], pieces.length[here], pieces.every, pieces.late)
            moved = self._mapped(PieceStart(x[here], w[here]), one, driven, still, bare=True)
            shown.append(moved.y)
            end = moved.end
        return PieceStart(x, w), np.concatenate(shown)

    def along(self, seen: Array) -> tuple[Array, Array]:
        """The laws alone along what they see at all points, (points, n_v), from where they rest.

        Their memory at each point, (points + 1, n_w), and what they show, (points, n_shown).
        """
        laws = self.loop.laws
        n_w = len(laws.memory)
        w, shown = np.zeros((len(seen) + 1, n_w)), np.zeros((len(seen), len(self.loop.shown)))
        for _ in range(_REST):
            for j in range(laws.cycle):
                w[0] = laws.keep[j] @ w[0] + laws.read[j] @ seen[0]
        if self._library is not None and n_w:
            nothing = np.zeros((0, 0))
            axis = _LoopAxis(self, (self.loop.p, self.loop.u, nothing, nothing))
            axis.directions = axis.first = 0
            given = np.ascontiguousarray(seen)
            self._library.loop_laws(
                ctypes.byref(axis), len(seen), *(_pointer(a) for a in (given, w, shown))
            )
            return w, shown
        for k, v in enumerate(seen):
            j = k % laws.cycle
            shown[k] = laws.show[j] @ w[k] + laws.direct[j] @ v
            w[k + 1] = laws.keep[j] @ w[k] + laws.read[j] @ v
        return w, shown

    def _nothing(self, start: PieceStart, pieces: Pieces, values: tuple[Array, ...]) -> Moved:
        """A motion that is no number."""
        directions = self.width + values[2].shape[1]
        shown = self.rates.width[4] + len(self.loop.shown)
        rows = int(pieces.samples.sum())
        return Moved(
            PieceStart(np.full_like(start.x, np.nan), np.full_like(start.w, np.nan)),
            np.full((len(start.x), self.width, directions), np.nan),
            np.full((rows, shown), np.nan),
            np.full((rows, shown, directions), np.nan),
        )

    def _compiled(
        self,
        start: PieceStart,
        pieces: Pieces,
        driven: Array,
        values: tuple[Array, Array, Array, Array],
        bare: bool = False,
    ) -> Moved:
        """Move all pieces in C; `bare`: without derivatives, which `joined` pieces have not."""
        assert self._library is not None
        axis = _LoopAxis(self, values)
        if bare:
            axis.directions = axis.first = 0
        n, count = axis.directions, len(pieces.begin)
        x, w = start.x.copy(), start.w.copy()
        n_x, n_w = x.shape[1], w.shape[1]
        s_x = np.zeros((count, n_x, n))
        s_w = np.zeros((count, n_w, n))
        if not bare:
            s_x[:, :, :n_x] = np.eye(n_x)
            s_w[:, :, n_x : n_x + n_w] = np.eye(n_w)
        rows, shown = int(pieces.samples.sum()), axis.n_y + axis.n_shown
        y, s_y = np.empty((rows, shown)), np.empty((rows, shown, n))
        own = max(f.sz_w() for f in (self.rates.rates, self.rates.shows)) + 1
        room = np.empty(self._library.loop_room(ctypes.byref(axis), own))
        given = [np.ascontiguousarray(driven)]
        begin, length = (
            np.ascontiguousarray(a, dtype=np.int64) for a in (pieces.begin, pieces.length)
        )
        on = None if pieces.joined is None else np.ascontiguousarray(pieces.joined, dtype=np.uint8)
        self._library.loop_run(
            ctypes.byref(axis),
            count,
            *(_pointer(a) for a in (begin, length)),
            None if on is None else _pointer(on),
            *(pieces.every, pieces.late),
            *(_pointer(a) for a in (given[0], x, s_x, w, s_w, y, s_y)),
            own,
            _pointer(room),
        )
        return Moved(PieceStart(x, w), np.concatenate([s_x, s_w], axis=1), y, s_y)

    def _mapped(
        self,
        start: PieceStart,
        pieces: Pieces,
        driven: Array,
        values: tuple[Array, Array, Array, Array],
        bare: bool = False,
    ) -> Moved:
        """Move all pieces by CasADi's machine, all at once; `bare`: without derivatives."""
        p, u0, dp, du = values
        loop, laws = self.loop, self.loop.laws
        x, w = start.x.T.copy(), start.w.T.copy()
        n_x, count, n_w = *x.shape, len(w)
        first = 0 if bare else n_x + n_w
        n = first + dp.shape[1]
        s_x = np.zeros((count, n_x, n))
        s_w = np.zeros((count, n_w, n))
        if not bare:
            s_x[:, :, :n_x] = np.eye(n_x)
            s_w[:, :, n_x:first] = np.eye(n_w)
        free = np.zeros((dp.shape[0], n))
        free[:, first:] = dp
        ends, slopes = np.zeros((count, n_x, n)), np.zeros((count, n_w, n))
        last_x, last_w = x.copy(), w.copy()
        samples = pieces.samples
        own = self.rates.width[4]
        wide = own + len(loop.shown)
        places = np.concatenate([[0], np.cumsum(samples)])
        y, s_y = np.empty((samples.sum(), wide)), np.empty((samples.sum(), wide, n))
        h = loop.step / self.sub_steps
        for k in range(int(pieces.length.max())):
            point = np.minimum(pieces.begin + k, len(driven) - 1)
            j = point % laws.cycle
            shows = self.rates.at("shows", x, np.repeat(u0[:, None], count, axis=1), p)
            c, _, q = self.rates.dense("shows", shows)
            s_out = c @ s_x + q @ free
            v = np.concatenate([driven[point].T, shows[0][self._fed]])
            s_v = np.concatenate(
                [np.zeros((count, len(loop.driven), n)), s_out[:, self._fed]], axis=1
            )
            u = u0[:, None] + _each(laws.take[j], w) + _each(laws.through[j], v)
            s_u = laws.take[j] @ s_w + laws.through[j] @ s_v
            s_u[:, :, first:] += du
            going = np.flatnonzero(k < pieces.length)
            rows = places[going] + k // pieces.every
            if k % pieces.every == 0:
                y[rows, :own], s_y[rows, :own] = shows[0].T[going], s_out[going]
            if k % pieces.every == pieces.late:
                shown = _each(laws.show[j], w) + _each(laws.direct[j], v)
                y[rows, own:] = shown.T[going]
                s_y[rows, own:] = (laws.show[j] @ s_w + laws.direct[j] @ s_v)[going]
            w, s_w = (
                _each(laws.keep[j], w) + _each(laws.read[j], v),
                laws.keep[j] @ s_w + laws.read[j] @ s_v,
            )
            for _ in range(self.sub_steps):
                x, s_x = self._step((x, s_x), (u, s_u), (p, free), h)
            done = np.flatnonzero(pieces.length == k + 1)
            last_x[:, done], last_w[:, done] = x[:, done], w[:, done]
            ends[done], slopes[done] = s_x[done], s_w[done]
        return Moved(PieceStart(last_x.T, last_w.T), np.concatenate([ends, slopes], axis=1), y, s_y)

    def _step(
        self, of: tuple[Array, Array], u: tuple[Array, Array], p: tuple[Array, Array], h: float
    ) -> tuple[Array, Array]:
        """One classic Runge-Kutta step of h [s] of all pieces."""
        rise, s_rise = np.zeros_like(of[0]), np.zeros_like(of[1])
        k, s_k = rise, s_rise
        for part, weight in ((0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)):
            x, s_x = of[0] + part * h * k, of[1] + part * h * s_k
            found = self.rates.at("rates", x, u[0], p[0])
            a, b, q = self.rates.dense("rates", found)
            k, s_k = found[0], a @ s_x + b @ u[1] + q @ p[1]
            rise, s_rise = rise + weight * k, s_rise + weight * s_k
        return of[0] + h / 6.0 * rise, of[1] + h / 6.0 * s_rise


def _each(matrices: Array, columns: Array) -> Array:
    """The product of each piece's matrix with its column."""
    found: Array = np.einsum("kij,jk->ik", matrices, columns)
    return found


def _library(rates: PlantRates, cc: Compiler) -> ctypes.CDLL:
    """The compiled loop of a plant, from the cache if it is there."""
    generator = ca.CodeGenerator("plant_text")
    for f in (rates.rates, rates.shows):
        arguments, made = _symbols(f)
        generator.add(ca.Function(f"plant_{f.name()}", arguments, made))
        generator.add(ca.Function(f"plain_{f.name()}", arguments, made[:1]))
    text, loop = generator.dump(), _LOOP.read_text(encoding="utf-8")

    def make(folder: Path) -> None:
        (folder / "plant.c").write_text(text, encoding="utf-8")
        (folder / "loop.c").write_text(loop, encoding="utf-8")
        cc.library(["plant.c", "loop.c"], "loop.so", folder, _FAST)

    key = disk_cache.key(text, loop, cc.version, *cc.command, *FLAGS, _FAST)
    library = ctypes.CDLL(str(disk_cache.kept("identify", key, make) / "loop.so"))
    library.loop_room.restype = ctypes.c_longlong
    library.loop_room.argtypes = [ctypes.c_void_p, ctypes.c_longlong]
    library.loop_run.restype = None
    pointer, whole = ctypes.c_void_p, ctypes.c_longlong
    library.loop_run.argtypes = [
        *(pointer, whole, pointer, pointer, pointer, whole, whole),
        *(pointer,) * 7,
        *(whole, pointer),
    ]
    library.loop_laws.restype = None
    library.loop_laws.argtypes = [pointer, whole, pointer, pointer, pointer]
    return library


def _symbols(f: ca.Function) -> tuple[list[Any], list[Any]]:
    arguments = f.sx_in()
    return arguments, f.call(arguments)


def _pointer(a: NDArray[Any]) -> ctypes.c_void_p:
    return ctypes.c_void_p(a.ctypes.data)


class _Matrix(ctypes.Structure):
    """``struct places`` of shooting_loop.c."""

    _fields_ = [
        ("count", ctypes.c_longlong),
        ("row", ctypes.c_void_p),
        ("column", ctypes.c_void_p),
    ]


_NUMBERS = (
    *("n_x", "n_u", "n_p", "n_q", "n_y", "n_w", "n_v", "n_shown", "n_driven"),
    *("cycle", "directions", "first", "sub_steps"),
)
_ARRAYS = ("p", "u", "dp", "du", "fed")
_LAWS = ("keep", "read", "take", "through", "show", "direct")


class _LoopAxis(ctypes.Structure):
    """``struct axis`` of shooting_loop.c, of one loop and its values."""

    _fields_ = [
        *((name, ctypes.c_longlong) for name in _NUMBERS),
        ("step", ctypes.c_double),
        *((name, ctypes.c_void_p) for name in _ARRAYS),
        ("rates", _Matrix * 3),
        ("shows", _Matrix * 3),
        *((name, ctypes.c_void_p) for name in _LAWS),
    ]

    def __init__(self, motion: LoopMotion, values: tuple[Array, Array, Array, Array]) -> None:
        super().__init__()
        loop, rates = motion.loop, motion.rates
        self._held: list[NDArray[Any]] = []
        self.n_x, self.n_u, self.n_p, self.n_q, self.n_y = rates.width
        self.n_w, self.n_driven = len(loop.laws.memory), len(loop.driven)
        self.n_v, self.n_shown = self.n_driven + len(loop.fed), len(loop.shown)
        self.cycle, self.sub_steps, self.step = loop.laws.cycle, motion.sub_steps, loop.step
        self.first = motion.width
        self.directions = self.first + values[2].shape[1]
        arrays = dict(zip(_ARRAYS, (*values, motion._fed), strict=True))
        arrays |= {name: getattr(loop.laws, name) for name in _LAWS}
        for name, value in arrays.items():
            setattr(self, name, self._hold(value))
        for name in ("rates", "shows"):
            for k, places in enumerate(getattr(rates, f"{name[:-1]}_places")):
                getattr(self, name)[k] = self._matrix(places)

    def _hold(self, a: NDArray[Any]) -> int:
        """Address of an array, which lives as long as this."""
        whole = np.ascontiguousarray(a, dtype=np.int64 if a.dtype.kind == "i" else np.float64)
        self._held.append(whole)
        return int(whole.ctypes.data)

    def _matrix(self, places: Places) -> _Matrix:
        return _Matrix(len(places.rows), self._hold(places.rows), self._hold(places.columns))
