"""The page of faults: each number that an FMU tells, its meaning, and what to do."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from site_pages.markdown import code, plain, table

# Outputs that tell of a fault have one of these words in their names, or advice on some numbers.
NAMES = ("alarm", "error", "fault", "code", "refus", "result")


@dataclass(frozen=True)
class FaultTable:
    """The numbers of one variable: meaning, and what to do about those that are faults."""

    fmu: str
    variable: str
    about: str
    meanings: Mapping[int, str]
    advice: Mapping[int, str]


def tables() -> Iterator[FaultTable]:
    """All variables of the built FMUs that tell a fault."""
    from motionfmu.scenarios import fmus
    from motionfmu.scenarios.fault_advice import advice, meanings

    for fmu in fmus.fmu_names():
        advised = advice(fmu)
        for name, port in fmus.ports(fmu).items():
            told, own = meanings(port), advised.get(name, {})
            named = any(word in name for word in NAMES)
            if port.causality == "output" and told and (own or named):
                shown = told if named else {n: text for n, text in told.items() if n in own}
                yield FaultTable(fmu, name, port.doc.split(": ")[0], shown, own)


def page(found: list[FaultTable]) -> str:
    """The page of all faults."""
    parts = [
        "# Faults\n\nAn FMU tells what went wrong by a number. "
        "Here is what each number means, and what to do about it.\n\n"
    ]
    for one in found:
        parts.append(f"## {code(f'{one.fmu}.{one.variable}')}\n\n{plain(one.about)}.\n\n")
        rows = [
            (str(number), plain(text), plain(one.advice.get(number, "")))
            for number, text in sorted(one.meanings.items())
        ]
        if not one.advice:
            rows = [row[:2] for row in rows]
        parts.append(table(("number", "meaning", "what to do")[: len(rows[0])], rows) + "\n")
    return "".join(parts)
