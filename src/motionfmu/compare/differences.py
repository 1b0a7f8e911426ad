"""What was run differently, and which verdicts changed."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.base.units import spelled
from motionfmu.compare.side import Side
from motionfmu.report.numbers import NOTHING
from motionfmu.scenarios.fmus import Port, ports
from motionfmu.scenarios.values import start_values

LISTED = 8  # so many values of a list are shown


@dataclass(frozen=True)
class Different:
    """Something in which the two runs differ, in words."""

    what: str
    a: str
    b: str


@dataclass(frozen=True)
class Checked:
    """A bound of a check in both runs; None where a run has no such check, or no number."""

    name: str
    bounds: tuple[str | None, str | None]
    values: tuple[float | None, float | None]
    ok: tuple[bool | None, bool | None]
    reasons: tuple[str, str]

    @property
    def worse(self) -> bool:
        """Whether it held in A and fails in B."""
        return self.ok[0] is True and self.ok[1] is False


def different(a: Side, b: Side) -> list[Different]:
    """Everything that runs depend on and in which these two differ."""
    one, other = a.numbers["run"], b.numbers["run"]
    plain = [_plain(x) for x in (a, b)]
    found = list(_rows("", plain[0], plain[1]))
    found += _rows("component ", one["components"], other["components"])
    found += _contents("FMU", one["fmus"], other["fmus"])
    found += _rows("input ", one["wires"], other["wires"])
    found += _contents("file", one["files"], other["files"])
    found += _settings(a, b)
    found += _rows("record ", *(r.get("record") or {} for r in (one, other)))
    drives = [{d["input"]: [d["at"], d["value"]] for d in r["drives"]} for r in (one, other)]
    return found + list(_rows("[[drive]] of ", drives[0], drives[1]))


def _plain(x: Side) -> dict[str, str]:
    """Scenario, options and times in words."""
    options, run = x.numbers.get("options", {}), x.numbers["run"]
    found = {"scenario": x.numbers["scenario"]}
    found |= {k: str(options[k]) for k in ("engine", "fmi") if options.get(k) is not None}
    found["step"] = f"{1e3 * run['step']:.9g} ms"
    found["stop"] = _text(run["stop"], "" if isinstance(run["stop"], str) else "s")
    return found | {"every": f"{run['every']} step{'s' * (run['every'] != 1)}"}


def _rows(what: str, a: Mapping[str, Any], b: Mapping[str, Any]) -> Iterable[Different]:
    for name in dict.fromkeys((*a, *b)):
        if name not in a or name not in b or a[name] != b[name]:
            texts = (_text(x[name]) if name in x else NOTHING for x in (a, b))
            yield Different(what + name, *texts)


def _contents(what: str, a: Mapping[str, str], b: Mapping[str, str]) -> Iterable[Different]:
    """Differences of files, by name only, for nobody wants to read their hashes."""
    for name in sorted({*a} & {*b}):
        if a[name] != b[name]:
            yield Different(f"{what} {name}", "one content", "another content")


def _settings(a: Side, b: Side) -> Iterable[Different]:
    """Differences of set values; a run that does not set a value has its FMU's default."""
    given = [x.numbers["run"]["settings"] for x in (a, b)]
    for name in sorted({*given[0], *given[1]}):
        if given[0].get(name) == given[1].get(name):
            continue
        texts = []
        for x, values in zip((a, b), given, strict=True):
            port = port_of(x, name)
            unit = spelled(port.unit) if port else ""
            if name in values:
                texts.append(_text(values[name], unit))
            elif port:
                texts.append(f"{_text(list(start_values(port)), unit)} (default)")
            else:
                texts.append(NOTHING)
        if len({text.removesuffix(" (default)") for text in texts}) > 1:
            yield Different(name, *texts)


def port_of(x: Side, name: str) -> Port | None:
    """A variable of a run's FMU, if there is such an FMU here."""
    component, _, variable = name.partition(".")
    try:
        return ports(x.numbers["run"]["components"][component]).get(variable)
    except (InputError, KeyError):
        return None


def _text(value: Any, unit: str = "") -> str:
    """One value if all elements have it."""
    if isinstance(value, list):
        if value and all(v == value[0] for v in value):
            return _text(value[0], unit)
        more = ", …" if len(value) > LISTED else ""
        listed = f"[{', '.join(_text(v) for v in value[:LISTED])}{more}]"
        return f"{listed} {unit}" if unit else listed
    if isinstance(value, bool):
        return str(value).lower()
    text = f"{value:.9g}" if isinstance(value, float) else str(value)
    return f"{text} {unit}" if unit else text


def checks(a: Side, b: Side) -> list[Checked]:
    """The checks of both runs side by side: equal bounds first, then the same name in turn."""
    rest = list(b.numbers["checks"])
    found: list[list[Any]] = [[v, None] for v in a.numbers["checks"]]
    for keys in (("name", "bounds"), ("name",)):
        for both in (f for f in found if f[1] is None):
            same = (v for v in rest if all(v[k] == both[0][k] for k in keys))
            if (other := next(same, None)) is not None:
                both[1] = other
                rest.remove(other)
    found += [[None, v] for v in rest]
    return [_checked(*both) for both in found]


def _checked(a: Mapping[str, Any] | None, b: Mapping[str, Any] | None) -> Checked:
    def of(key: str, without: Any = None) -> tuple[Any, Any]:
        first, second = (without if v is None else v[key] for v in (a, b))
        return first, second

    name = (a or b or {})["name"]
    return Checked(name, of("bounds"), of("value"), of("ok"), of("reason", ""))
