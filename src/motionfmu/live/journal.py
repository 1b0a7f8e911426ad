"""What a person did at a live machine, which with it is a scenario."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Action:
    """What is set when a communication step begins.

    Attributes
    ----------
    step : int
        Number of the communication step, from 0.
    name : str
        ``component.variable``.
    values : tuple
        Of all elements.
    """

    step: int
    name: str
    values: tuple[Any, ...]


@dataclass
class Journal:
    """Actions in their order; a later one of a step counts.

    Attributes
    ----------
    step_ns : int
        Communication step [ns].
    actions : list of Action
    """

    step_ns: int
    actions: list[Action] = field(default_factory=list)

    def add(self, action: Action) -> None:
        """Write an action down.

        Parameters
        ----------
        action : Action
            Not before those that are there.
        """
        for place in range(len(self.actions) - 1, -1, -1):
            old = self.actions[place]
            if old.step != action.step:
                break
            if old.name == action.name:
                del self.actions[place]
                break
        self.actions.append(action)

    def latest(self, count: int) -> list[Action]:
        """So many of the latest actions.

        Parameters
        ----------
        count : int

        Returns
        -------
        list of Action
            In their order.
        """
        return self.actions[max(0, len(self.actions) - count) :]

    def forget(self, step: int) -> None:
        """Take away what acts at a step or later.

        Parameters
        ----------
        step : int
        """
        self.actions = [a for a in self.actions if a.step < step]

    def drives(self, begin: int = 0) -> list[dict[str, Any]]:
        """The [[drive]] tables of a scenario that does the same.

        Parameters
        ----------
        begin : int
            Step from which on.

        Returns
        -------
        list of dict
            For each name, times [s] and values, one for all elements or a list.
        """
        return [
            {
                "input": name,
                "at": [a.step * self.step_ns / 1e9 for a in actions],
                "value": [_plain(a.values) for a in actions],
            }
            for name, actions in self._by_name(begin).items()
        ]

    def _by_name(self, begin: int) -> Mapping[str, list[Action]]:
        found: dict[str, list[Action]] = {}
        for action in (a for a in self.actions if a.step >= begin):
            found.setdefault(action.name, []).append(action)
        return found

    def __iter__(self) -> Iterator[Action]:
        return iter(self.actions)

    def __len__(self) -> int:
        return len(self.actions)


def _plain(values: tuple[Any, ...]) -> Any:
    return values[0] if len(values) == 1 else list(values)
