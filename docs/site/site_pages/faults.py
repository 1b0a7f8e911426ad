"""The page of faults: each number that an FMU tells, its meaning, and what to do."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import resources

from site_pages.markdown import code, plain, table

# Beside the alarm of a panel: outputs that tell of a fault have one of these words in their names.
ALARMS = ("alarm", "error")  # about these the live page advises by words, if the panel does not
NAMES = ("alarm", "error", "fault", "code", "refus", "result")


@dataclass(frozen=True)
class FaultTable:
    """The numbers of one variable: meaning, and what to do about those that have advice."""

    fmu: str
    variable: str
    about: str
    meanings: Mapping[int, str]
    advice: Mapping[int, str]


@dataclass(frozen=True)
class AdviceRules:
    """What the live page advises by the words of a fault: patterns, and what to do."""

    rules: tuple[tuple[re.Pattern[str], str], ...]
    otherwise: str

    @classmethod
    def read(cls, script: str) -> "AdviceRules":
        """The rules of the page's script."""
        part = script[script.index("const ADVICE = [") :]
        rows = re.findall(r'\[/(.+?)/i,\s*"(.+?)"\]', part[: part.index("\n];")])
        last = re.search(r'\[, "(.+?)"\]', part)
        assert rows and last
        return cls(tuple((re.compile(about, re.I), text) for about, text in rows), last[1])

    def of(self, words: str) -> str:
        """What to do about a fault."""
        return next((t for about, t in self.rules if about.search(words)), self.otherwise)


def tables() -> Iterator[FaultTable]:
    """All variables of the built FMUs that tell a fault."""
    from motionfmu.live.machine_about import meanings
    from motionfmu.live.panel import panel_of
    from motionfmu.scenarios import fmus

    script = resources.files("motionfmu.live.serving") / "page/words.js"
    rules = AdviceRules.read(script.read_text(encoding="utf-8"))
    for fmu in fmus.fmu_names():
        panel = panel_of(fmu)
        for name, port in fmus.ports(fmu).items():
            alarm = panel is not None and name == panel.alarm
            if port.causality != "output" or not (alarm or any(word in name for word in NAMES)):
                continue
            if told := meanings(port):
                own = {int(k): v for k, v in panel.advice.items()} if panel and alarm else {}
                words = {n: rules.of(t) for n, t in told.items() if n} if name in ALARMS else {}
                yield FaultTable(fmu, name, port.doc.split(": ")[0], told, words | own)


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
