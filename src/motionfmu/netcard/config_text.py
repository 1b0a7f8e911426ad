"""A card's configuration as the text of its file."""

from typing import Any

from motionfmu.netcard.config import CardConfig
from motionfmu.netcard.tables import Input


def text_of(config: CardConfig) -> str:
    """Text of a card.toml that gives this configuration; of pins those that do or are something."""
    tree = config.model_dump()
    inputs, outputs = tree.pop("inputs"), tree.pop("outputs")
    axes, pen = tree.pop("axes"), tree["motion"].pop("pen")
    lines = ["# Configuration of a network motion card."]
    lines += _table("[network]", tree.pop("network"))
    for axis in axes:
        lines += _table("[[axes]]", axis)
    lines += _table("[motion]", tree.pop("motion"))
    lines += _table("[motion.pen]", pen)
    for name, table in tree.items():
        lines += _table(f"[{name}]", table)
    for k, table in enumerate(inputs):
        if table != Input().model_dump():
            lines += _table(f"[inputs.{k}]", table)
    lines += _table("[outputs]", {str(k): name for k, name in enumerate(outputs) if name})
    return "\n".join(lines) + "\n"


def _table(head: str, values: dict[str, Any]) -> list[str]:
    wide = max(map(len, values), default=0)
    rows = [f"{key:{wide}} = {_value(value)}" for key, value in values.items()]
    return ["", head, *rows] if rows else []


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return f'"{value}"' if isinstance(value, str) else repr(value)
