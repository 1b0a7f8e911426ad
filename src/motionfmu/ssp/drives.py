"""Tables [[drive]] of a scenario for what the FMU Stimulus drives in an SSP."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from motionfmu.ssp.flat_wires import WirePath
from motionfmu.ssp.structure import Value

MODEL = "Stimulus"
_OUTPUTS, _EACH = ("real", "whole", "on"), 32
_COLUMNS = ("at", "signal", "value")


@dataclass
class InputSteps:
    """An input that is driven, and the values that its elements take over time."""

    input: str
    steps: dict[float, dict[int, float]] = field(default_factory=dict)  # [s], by element, from 0

    def toml(self, kind: str) -> list[str]:
        """Lines of the input's [[drive]]; `kind` is the type of the values: float, int or bool."""
        width = 1 + max(k for values in self.steps.values() for k in values)
        held, lines = [0.0] * width, []
        for at in sorted(self.steps):
            for k, value in self.steps[at].items():
                held[k] = value
            texts = [_text(x, kind) for x in held]
            lines.append(texts[0] if width == 1 else f"[{', '.join(texts)}]")
        times = ", ".join(repr(at) for at in sorted(self.steps))
        return [
            "\n[[drive]]",
            f'input = "{self.input}"',
            f"at    = [{times}]",
            f"value = [{', '.join(lines)}]",
        ]


def _text(x: float, kind: str) -> str:
    if kind == "bool":
        return "true" if x else "false"
    return str(round(x)) if kind == "int" else repr(x)


def table(values: Iterable[Value]) -> list[tuple[float, int, float]]:
    """Rows of a Stimulus: time [s], signal, value; a ValueError if a text is no number."""
    columns: dict[str, dict[int, str]] = {name: {} for name in _COLUMNS}
    for value in values:
        name, bracket, index = value.name.partition("[")
        if name in columns:
            first = int(index[:-1]) - 1 if bracket else 0
            columns[name] |= {first + k: text for k, text in enumerate(value.text)}
    rows = []
    for k, signal in sorted(columns["signal"].items()):
        if int(signal) == 0:
            break
        at, size = (float(columns[name].get(k, "0")) for name in ("at", "value"))
        rows.append((at, int(signal), size))
    return rows


def signal_of(way: WirePath) -> int:
    """The number of the signal at the source of a wire, from 1."""
    name, bracket, index = way.source[1].partition("[")
    element = int(index[:-1]) if bracket else way.source_index[0]
    return _OUTPUTS.index(name) * _EACH + element
