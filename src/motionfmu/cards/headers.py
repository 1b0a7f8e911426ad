"""The card's C headers: a macro for every number that its firmware is configured by."""

import ipaddress
import os
import re
from collections.abc import Iterator
from pathlib import Path

from pydantic.fields import FieldInfo

from motionfmu.base.errors import InputError
from motionfmu.cards.config import CardConfig
from motionfmu.cards.config_tables import PINS, CardAxis, Input
from motionfmu.cards.fields import Is, Table, WholeNumber, choices, described, numbers

WORD = 2**32
Keys = tuple[str, ...] | None  # of some fields; None: all
# Subject of each header, and the headers that it includes.
ABOUT = {
    "network": ("addresses of card and server", ()),
    "io": ("programmable inputs and outputs", ()),
    "axes": ("scale and limits of the axes", ("io",)),
    "home": ("how the axes go home", ("axes",)),
    "motion": ("periods, pulses, pen, buffer, tasks", ("io",)),
    "config": ("what the card is configured by", ("network", "axes", "home", "io", "motion")),
}


def texts(config: CardConfig, source: str) -> dict[str, str]:
    """Text of each header by its name; `source` is the file that the configuration came from."""
    pins = [f"#define MC_OUT_{n.upper()} {k}U" for k, n in enumerate(config.outputs) if n]
    bodies: dict[str, list[str]] = {
        "network": [],
        "io": [
            *_named(CardAxis, ("limit_level",)),
            *_named(Input),
            "",
            f"#define MC_INPUTS {PINS}U",
            f"#define MC_OUTPUTS {PINS}U",
            *pins,
        ],
        "axes": [f"#define MC_AXES {len(config.axes)}U"],
        "home": [*_named(CardAxis, ("origin_trigger", "home_direction"))],
        "motion": [*_named(config.motion), *_named(config.motion.pen, ("kind",))],
        "config": [],
    }
    checks: dict[str, list[str]] = {part: [] for part in bodies}

    def add(part: str, prefix: str, table: Table, keys: Keys = None) -> None:
        bodies[part] += ["", *_values(prefix, table, keys)]
        checks[part] += _checks(prefix, table, keys)

    add("network", "MC_", config.network)
    for axis in config.axes:
        homing = tuple(k for k in described(axis) if k.startswith(("home_", "origin_")))
        rest = tuple(k for k in described(axis) if k not in homing)
        add("axes", f"MC_{axis.name}_", axis, rest)
        add("home", f"MC_{axis.name}_", axis, homing)
        checks["config"] += _rate(axis.name)
    for table in (config.motion, config.motion.pen, config.pulse, config.fifo, config.tasks):
        add("motion", "MC_", table)
    for k, one in enumerate(config.inputs):
        add("io", f"MC_IN_{k}_", one)
    return {
        f"mc_{part}.h": _header(part, [*body, "", *checks[part]], source)
        for part, body in bodies.items()
    }


def write(config: CardConfig, folder: Path, source: str, crlf: bool = False) -> list[Path]:
    """Write the headers that are missing or differ, each whole or not at all."""
    changed = []
    for name, text in texts(config, source).items():
        data = text.replace("\n", "\r\n" if crlf else "\n").encode("ascii")
        file = folder / name
        part = folder / f".{name}.{os.getpid()}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if file.is_file() and file.read_bytes() == data:
                continue
            try:
                part.write_bytes(data)
                part.replace(file)
            finally:
                part.unlink(missing_ok=True)
        except OSError as error:
            raise InputError(f"{file}: {error.strerror}") from None
        changed.append(file)
    return changed


def _header(part: str, body: list[str], source: str) -> str:
    about, needs = ABOUT[part]
    name, guard = f"mc_{part}.h", f"MC_{part.upper()}_H"
    shown = "".join(c if c.isascii() and c.isprintable() and c not in "*/" else "_" for c in source)
    head = [
        f"/* {name} - {about}.",
        f' * Made of {shown} by "motionfmu card headers"; what is changed here is lost.',
        " */",
        f"#ifndef {guard}",
        f"#define {guard}",
        "",
    ]
    includes = [f'#include "mc_{other}.h"' for other in needs]
    lines = [*head, *includes, *([""] if needs else []), *body, "", "#endif", ""]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines))


def _shown(table: Table, keys: Keys) -> dict[str, tuple[FieldInfo, Is]]:
    """Fields that have a macro, of all or of some."""
    fields = described(table).items()
    return {k: f for k, f in fields if f[1].macro and (keys is None or k in keys)}


def _values(prefix: str, table: Table, keys: Keys) -> Iterator[str]:
    """Macros of a table's fields."""
    known = numbers(table)
    for key, (field, what) in _shown(table, keys).items():
        name, value = f"{prefix}{what.macro}", getattr(table, key)
        if key not in known:
            yield from _bytes(name, value, what.words)
        elif choices(field):
            yield f"#define {name} {_choice(what.macro, value)} /* {what.words} */"
        else:
            yield from _number(name, known[key])


def _checks(prefix: str, table: Table, keys: Keys) -> Iterator[str]:
    """Lines by which a compiler refuses values that the card cannot have."""
    known, fields = numbers(table), _shown(table, keys)
    for key, (_, what) in fields.items():
        if key in known:
            yield from _range(f"{prefix}{what.macro}", known[key])
    for left, sign, right in table.RULES:
        if left in fields:
            a, b = (f"{prefix}{described(table)[key][1].macro}" for key in (left, right))
            yield from _refuse(f"!({a} {sign} {b})", f"{a} must be {sign} {b}")


def _number(name: str, number: WholeNumber) -> Iterator[str]:
    """Macro of a number; one of 64 bits in two words, too, for a compiler that has no long long."""
    what = number.what
    short = f"{number.source:g}"
    value = short if float(short) == number.source else repr(number.source)
    words = f"[{what.counts}] {what.words}" if what.counts else what.words
    words += f", {value} {what.unit}" if what.unit else ""
    yield f"#define {name} {_literal(number.value, what.suffix)} /* {words} */"
    if what.suffix == "ULL":
        high, low = divmod(number.value, WORD)
        yield f"#define {name}_HIGH {high}UL /* the same in two words of 32 bits */"
        yield f"#define {name}_LOW {low}UL"


def _literal(value: int, suffix: str) -> str:
    if suffix == "ULL" and value < WORD:
        suffix = "UL"
    return f"{value}{suffix}" if value >= 0 else f"({value}{suffix})"


def _range(name: str, number: WholeNumber) -> Iterator[str]:
    """Lines by which a compiler refuses a number out of its range."""
    what = number.what
    low, high = (_literal(x, what.suffix) for x in (what.low, what.high))
    tests = [f"{name} < {low}"] if what.low or what.suffix == "L" else []
    tests.append(f"{name} > {high}")
    if what.suffix == "ULL":
        top, rest = divmod(what.high, WORD)
        upper, lower = f"{name}_HIGH", f"{name}_LOW"
        tests = [
            f"({upper} == 0UL && {lower} < {what.low}UL)",
            f"{upper} > {top}UL",
            f"({upper} == {top}UL && {lower} > {rest}UL)",
        ]
    if what.step > 1:
        tests.append(f"{name} % {what.step}{what.suffix} != 0")
    step = f", a multiple of {what.step}" if what.step > 1 else ""
    yield from _refuse(
        " || ".join(tests), f"{name}: {what.low} .. {what.high} {what.counts}".rstrip() + step
    )


def _refuse(condition: str, words: str) -> tuple[str, ...]:
    return (f"#if {condition}", f'#error "{words}"', "#endif")


def _bytes(name: str, text: str, words: str) -> Iterator[str]:
    """A macro for each byte of an address."""
    parts = (
        [int(p, 16) for p in text.split(":")] if ":" in text else ipaddress.IPv4Address(text).packed
    )
    for k, byte in enumerate(parts):
        yield f"#define {name}_{k} {byte}U" + ("" if k else f" /* {words}: {text} */")


def _choice(macro: str, word: str) -> str:
    """Name of a choice: the last word of its macro, and its own."""
    return f"MC_{macro.rpartition('_')[2]}_{word.upper()}"


def _named(table: type[Table] | Table, keys: Keys = None) -> Iterator[str]:
    """Macros of all words of a table's choices, or of some of them."""
    for key, (field, what) in described(table).items():
        if what.macro and (not keys or key in keys):
            for k, word in enumerate(choices(field)):
                yield f"#define {_choice(what.macro, word)} {k}U"


def _rate(axis: str) -> tuple[str, ...]:
    """Lines by which a compiler checks that a pulse is high and low for its width at least."""
    name = f"MC_{axis}_SPEED_MAX"
    words = f"{name}: more than MC_PULSE_WIDTH_NS lets"
    return _refuse(f"{name} > 500000000UL / MC_PULSE_WIDTH_NS", words)
