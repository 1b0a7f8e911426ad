"""What every explanation has: effects by name, and what they leave."""

from typing import Generic, Protocol, TypeVar

from motionfmu.analysis.explain.servo_formulas import Array


class NamedEffect(Protocol):
    """An effect."""

    @property
    def name(self) -> str:
        """Of its cause."""


E = TypeVar("E", bound=NamedEffect)


class Effects(Generic[E]):
    """A whole error beside the sum of its effects, sample by sample."""

    effects: tuple[E, ...]
    whole: Array
    together: Array

    @property
    def residual(self) -> Array:
        """The whole minus the sum of the effects, in its shape [mm]."""
        return self.whole - self.together

    def effect(self, name: str) -> E:
        """One effect by its name; a KeyError tells which there are."""
        found = {e.name: e for e in self.effects}
        if name not in found:
            raise KeyError(f"no effect {name!r}, there is {', '.join(found)}")
        return found[name]
