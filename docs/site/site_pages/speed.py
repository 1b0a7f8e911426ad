"""The page of speed: the figures that the benchmark has kept, and what is asked of each."""

from collections.abc import Mapping
from typing import Any

from site_pages.markdown import plain, table

MISSED = " MISSED"  # behind what is asked, as the benchmark marks it


def page(kept: Mapping[str, Any]) -> str:
    """The page of the figures in ``tests/bench/last.json``."""
    asked: Mapping[str, str] = kept["asked"]
    rows = []
    for name, value in kept["figures"].items():
        told = asked.get(name, "")
        verdict = "missed" if told.endswith(MISSED) else "met" if told else ""
        rows.append((plain(name), _number(value), plain(told.removesuffix(MISSED)), verdict))
    missed = sum(row[-1] == "missed" for row in rows)
    judged = sum(row[-1] != "" for row in rows)
    return (
        "# Speed\n\n"
        "What `make bench BENCH=--renew` has found and kept: each time is processor time, of five"
        " rounds. [The benchmark](../tests/bench/README.md) says what each line is, and"
        " where the time goes.\n\n"
        f"- Found on {plain(kept['day'])}, on {plain(kept['machine'])}"
        " (processor, Python, what counted instructions).\n"
        f"- Of {len(rows)} figures {judged} have a bound, and {missed} of these miss it.\n\n"
        + table(("line", "figure", "asked", "bound"), rows)
    )


def _number(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.4g}"
