"""Numbered and named parameters of a part program."""

import math
from collections.abc import Callable


class Wrong(Exception):
    """A line that the language does not allow, the one executed if none is given."""

    def __init__(self, why: str, line: int = 0) -> None:
        super().__init__(why)
        self.line = line


LOCAL, LOCAL_FANUC = 30, 33  # parameters of a call
LAST = 5602


class Alarm(Wrong):
    """#3000 has been set."""


class Parameters:
    """What #1, #<name> stand for; `system` gives those that the machine itself keeps."""

    def __init__(self) -> None:
        self.numbered: dict[int, float] = {}
        self.fanuc = False  # what was never set is vacant: None
        self.globals: dict[str, float] = {}
        self.locals: list[dict[str, float]] = [{}]
        self.system: Callable[[int | str], float | None] = lambda name: None
        self.kept: Callable[[int, float], bool] = lambda number, value: False

    def whole(self, number: float) -> int:
        """A parameter's number; nearly whole is whole."""
        near = round(number)
        if (
            not math.isfinite(number)
            or abs(number - near) > 1e-4
            or not 1 <= near <= LAST + 11000 * self.fanuc
        ):
            raise Wrong("number of a parameter")
        return near

    def named(self, name: str) -> dict[str, float]:
        """Where a name lives."""
        return self.globals if name.startswith("_") else self.locals[-1]

    def exists(self, name: str) -> bool:
        """Whether a name has a value."""
        return name in self.named(name) or self.system(name) is not None

    def get(self, name: str | float | None) -> float | None:
        """Value of a parameter; of an unknown name there is none."""
        if isinstance(name, str):
            found = self.system(name)
            if found is None:
                found = self.named(name).get(name)
            if found is None:
                raise Wrong("unknown name")
            return found
        if self.fanuc and abs(name or 0.0) <= 1e-4:
            return None
        number = self.whole(name or 0.0)
        found = self.system(number)
        return self.numbered.get(number, None if self.fanuc else 0.0) if found is None else found

    def set(self, name: str | float | None, value: float | None) -> None:
        """Set one; those of the machine itself are refused."""
        if value is None and not isinstance(name, str) and 1 <= (name or 0.0) <= 5000:
            self.numbered.pop(self.whole(name or 0.0), None)
            return
        value = value or 0.0
        if isinstance(name, str):
            if self.system(name) is not None:
                raise Wrong("read only")
            self.named(name)[name] = value
            return
        number = self.whole(name or 0.0)
        if self.fanuc and number == 3000:
            raise Alarm("alarm")
        if not self.kept(number, value):
            if self.system(number) is not None:
                raise Wrong("read only")
            self.numbered[number] = value

    def give(self, values: list[float | None] | None) -> None:
        """The parameters of a call, if it has any of its own."""
        for i, value in enumerate(values or [], start=1):
            self.numbered.pop(i, None)
            if value is not None:
                self.numbered[i] = value

    def enter(self, given: list[float | None] | None) -> list[float | None] | None:
        """Begin a call; what its own parameters were is given back."""
        if given is None:
            before = None
        else:
            given = given + [None] * ((LOCAL_FANUC if self.fanuc else LOCAL) - len(given))
            before = [self.numbered.get(i) for i in range(1, len(given) + 1)]
        self.give(given)
        self.locals.append({})
        self.globals["_value"] = self.globals["_value_returned"] = 0.0
        return before

    def leave(self, before: list[float | None] | None) -> None:
        """End a call."""
        self.give(before)
        self.locals.pop()
