"""Numbered and named parameters of a part program."""

import math
from collections.abc import Callable


class Wrong(Exception):
    """A line that the language does not allow, the one executed if none is given."""

    def __init__(self, why: str, line: int = 0) -> None:
        super().__init__(why)
        self.line = line


LOCAL = 30  # parameters of a call
LAST = 5602


class Parameters:
    """What #1, #<name> stand for; `system` gives those that the machine itself keeps."""

    def __init__(self) -> None:
        self.numbered: dict[int, float] = {}
        self.globals: dict[str, float] = {}
        self.locals: list[dict[str, float]] = [{}]
        self.system: Callable[[int | str], float | None] = lambda name: None
        self.kept: Callable[[int, float], bool] = lambda number, value: False

    @staticmethod
    def whole(number: float) -> int:
        """A parameter's number; nearly whole is whole."""
        near = round(number)
        if not math.isfinite(number) or abs(number - near) > 1e-4 or not 1 <= near <= LAST:
            raise Wrong("number of a parameter")
        return near

    def named(self, name: str) -> dict[str, float]:
        """Where a name lives."""
        return self.globals if name.startswith("_") else self.locals[-1]

    def exists(self, name: str) -> bool:
        """Whether a name has a value."""
        return name in self.named(name) or self.system(name) is not None

    def get(self, name: str | float) -> float:
        """Value of a parameter; of an unknown name there is none."""
        if isinstance(name, str):
            found = self.system(name)
            if found is None:
                found = self.named(name).get(name)
            if found is None:
                raise Wrong("unknown name")
            return found
        number = self.whole(name)
        found = self.system(number)
        return self.numbered.get(number, 0.0) if found is None else found

    def set(self, name: str | float, value: float) -> None:
        """Set one; those of the machine itself are refused."""
        if isinstance(name, str):
            if self.system(name) is not None:
                raise Wrong("read only")
            self.named(name)[name] = value
            return
        number = self.whole(name)
        if not self.kept(number, value):
            if self.system(number) is not None:
                raise Wrong("read only")
            self.numbered[number] = value

    def give(self, values: list[float] | None) -> None:
        """The parameters of a call, if it has any of its own."""
        self.numbered.update(enumerate(values or [], start=1))

    def enter(self, given: list[float] | None) -> dict[int, float]:
        """Begin a call; what its own parameters were is given back."""
        own = range(1, LOCAL + 1) if given is not None else ()
        before = {i: self.numbered.get(i, 0.0) for i in own}
        self.give(given)
        self.locals.append({})
        self.globals["_value"] = self.globals["_value_returned"] = 0.0
        return before

    def leave(self, before: dict[int, float]) -> None:
        """End a call."""
        self.numbered.update(before)
        self.locals.pop()
