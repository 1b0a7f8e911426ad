"""The signals and parameters of a run, as figures and analyses read them."""

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from motionfmu.run.planned_text import PlannedText
from motionfmu.scenarios.system import Resolver


class RunRecord(Protocol):
    """A run's signals and parameters; `Result` is one."""

    time: NDArray[np.float64]  # [s], shape (N,)
    signals: Mapping[str, NDArray[Any]]
    planned: PlannedText | None

    @property
    def resolver(self) -> Resolver:
        """The scenario's FMUs and file."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A signal, or one axis of it."""

    def parameter(self, name: str) -> Any:
        """Value of a parameter in this run."""
