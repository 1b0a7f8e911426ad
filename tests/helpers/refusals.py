"""What a call that is wrong says."""

from typing import Any

import pytest

import motionfmu


def refusal(call: Any, *given: Any, **named: Any) -> list[str]:
    """The lines of the InputError that a call raises."""
    with pytest.raises(motionfmu.InputError) as told:
        call(*given, **named)
    return list(told.value.args)
