"""All settings of a virtual robot, some of them others."""

from typing import Any

from motionfmu.virtual.robot import defaults


def settings(**more: Any) -> dict[str, Any]:
    return {name: value for name, (value, _) in defaults().items()} | more
