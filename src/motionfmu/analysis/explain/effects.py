"""Effects of an explanation by name, and the residual that they leave."""

from typing import Generic, Protocol, TypeVar

from motionfmu.analysis.explain.servo_formulas import Array


class NamedEffect(Protocol):
    """An effect with the name of its cause."""

    @property
    def name(self) -> str:
        """Name of the cause."""


E = TypeVar("E", bound=NamedEffect)


class Effects(Generic[E]):
    """A whole error beside the sum of its effects, sample by sample."""

    effects: tuple[E, ...]
    whole: Array
    together: Array

    @property
    def residual(self) -> Array:
        """The whole error minus the sum of the effects [mm]."""
        return self.whole - self.together

    def effect(self, name: str) -> E:
        """One effect by its name; a KeyError tells which there are."""
        found = {e.name: e for e in self.effects}
        if name not in found:
            raise KeyError(f"no effect {name!r}, there is {', '.join(found)}")
        return found[name]
