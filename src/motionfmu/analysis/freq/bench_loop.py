"""The loop of a bench: the C library steps its FMUs, which are of FMI 3, and adds the signals."""

import ctypes
from collections.abc import Callable, Mapping, Sequence
from ctypes import c_double, c_int32, c_int64, c_size_t, c_uint32, c_void_p
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.binding import library
from motionfmu.run.engines.slave import Slave
from motionfmu.scenarios.fmus import Port
from motionfmu.scenarios.system import Wire

Array = NDArray[np.float64]
# Given the outputs so far, a row each: with how many of them the run ends; None if it goes on.
Ends = Callable[[Array], int | None]
_KINDS = {"Float64": ord("d"), "Int32": ord("i"), "Boolean": ord("?")}
_PIECE = 500  # steps between two looks at whether the run ends


class _AccessStruct(ctypes.Structure):
    """The struct bench_access of src/python/binding_bench.h, as those below."""

    _fields_ = (
        ("call", c_void_p),
        ("instance", c_void_p),
        ("values", c_void_p),
        ("count", c_size_t),
        ("reference", c_uint32),
    )


class _WireStruct(ctypes.Structure):
    _fields_ = (("get", _AccessStruct), ("put", _AccessStruct), ("offset", c_void_p))


class _OutputStruct(ctypes.Structure):
    _fields_ = (("get", _AccessStruct), ("kind", c_int32), ("place", c_int32))


class _TapStruct(ctypes.Structure):
    _fields_ = (
        ("put", _AccessStruct),
        ("source", ctypes.POINTER(_OutputStruct)),
        ("base", c_double),
        ("gain", c_double),
        ("late", c_void_p),
        ("delay", c_int32),
        ("oldest", c_int32),
        ("kind", c_int32),
        ("place", c_int32),
        ("bytes", c_size_t),
    )


class _SlaveStruct(ctypes.Structure):
    _fields_ = (("step", c_void_p), ("instance", c_void_p))


class _LoopStruct(ctypes.Structure):
    _fields_ = (
        ("wire", c_void_p),
        ("output", c_void_p),
        ("tap", c_void_p),
        ("slave", c_void_p),
        ("wires", c_int32),
        ("outputs", c_int32),
        ("taps", c_int32),
        ("slaves", c_int32),
        ("step_ns", c_int64),
        ("rows", c_int64),
        ("refused", c_void_p),
        ("by", c_void_p),
    )


@dataclass(frozen=True)
class Element:
    """One element of a variable of a component."""

    component: str
    port: Port
    place: int


class BenchLoop:
    """Wires, outputs and taps of initialized FMUs, which run once.

    They step in the order in which `slaves` has them, with a communication step of `step_ns`.
    """

    def __init__(self, slaves: Mapping[str, Slave], step_ns: int) -> None:
        self._slaves, self._step_ns = slaves, step_ns
        self._kept: list[Any] = []  # memory that C reads and writes
        self._wires: list[_WireStruct] = []
        self._outputs: list[_OutputStruct] = []
        self._taps: list[_TapStruct] = []

    def _access(self, verb: str, component: str, port: Port, buffer: Any) -> _AccessStruct:
        call, instance = self._slaves[component].address(f"{verb}{port.type}")
        return _AccessStruct(call, instance, ctypes.addressof(buffer), len(buffer), port.reference)

    def _buffer(self, component: str, port: Port) -> Any:
        self._kept.append(self._slaves[component].buffer(port.type, port.count))
        return self._kept[-1]

    def _reader(self, of: Element) -> _OutputStruct:
        buffer = self._buffer(of.component, of.port)
        access = self._access("Get", of.component, of.port, buffer)
        return _OutputStruct(access, _KINDS[of.port.type], of.place)

    def wire(self, wire: Wire, offset: Sequence[float]) -> None:
        """Carry the value of a wire in each step, or the value plus a constant."""
        source, target = wire.source, wire.target
        buffer = self._buffer(source.component, source.port)
        get = self._access("Get", source.component, source.port, buffer)
        put = self._access("Set", target.component, target.port, buffer)
        self._kept.append((c_double * len(offset))(*offset))
        added = ctypes.addressof(self._kept[-1]) if offset else None
        self._wires.append(_WireStruct(get, put, added))

    def output(self, element: Element) -> None:
        """Record one element of an output."""
        self._outputs.append(self._reader(element))

    def tap(
        self,
        element: Element,
        start: Sequence[Any],
        source: Element | None,
        gain: float = 1.0,
        delay: int = 0,
    ) -> None:
        """Add a signal to one element of an input.

        It is added to `start`, or to what the source brings, which is multiplied by `gain` and
        delayed by some steps.
        """
        buffer = self._buffer(element.component, element.port)
        buffer[:] = list(start)
        put = self._access("Set", element.component, element.port, buffer)
        self._kept.append((c_double * delay)())
        late = ctypes.addressof(self._kept[-1])
        kind, base = _KINDS[element.port.type], float(buffer[element.place])
        from_ = None if source is None else ctypes.pointer(self._reader(source))
        size = ctypes.sizeof(buffer)  # a wire joins what has one type and one size
        self._taps.append(
            _TapStruct(put, from_, base, gain, late, delay, 0, kind, element.place, size)
        )

    def run(self, added: Array, ends: Ends | None = None) -> tuple[Array, Array]:
        """Run with a row of `added` for each step, a column for each tap.

        Returns a row of the outputs before each step, and one of what was really added in it; an
        InputError with the message of an FMU that refuses.
        """
        steps = [_SlaveStruct(*s.address("DoStep")) for s in self._slaves.values()]
        parts: list[list[Any]] = [self._wires, self._outputs, self._taps, steps]
        kinds: tuple[Any, ...] = (_WireStruct, _OutputStruct, _TapStruct, _SlaveStruct)
        arrays = [(k * max(len(p), 1))(*p) for k, p in zip(kinds, parts, strict=True)]
        loop = _LoopStruct(*map(ctypes.addressof, arrays), *map(len, parts), self._step_ns)
        added = np.ascontiguousarray(added, dtype=float)
        shown, used = np.zeros((len(added), loop.outputs)), np.zeros(added.shape)
        step = library().binding_bench
        while loop.rows < len(added):
            to = c_int64(min(loop.rows + _PIECE, len(added)))
            rows = (x.ctypes.data_as(c_void_p) for x in (added, shown, used))
            went_on = step(ctypes.byref(loop), to, *rows)
            last = None if ends is None else ends(shown[: loop.rows])
            if last is not None:
                return shown[:last], used[:last]
            if not went_on:
                raise self._refusal(loop)
        return shown, used

    def _refusal(self, loop: _LoopStruct) -> Exception:
        by = next(s for s in self._slaves.values() if s.address("DoStep")[1] == loop.by)
        if loop.refused is None:
            return by.refusal("doStep")
        refused = _AccessStruct.from_address(loop.refused).call
        names = (f"{verb}{kind}" for verb in ("Get", "Set") for kind in _KINDS)
        return by.refusal(next(n for n in names if by.address(n)[0] == refused))
