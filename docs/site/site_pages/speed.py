"""The page of speed: the figures that the benchmark has kept, and what is asked of each."""

from collections.abc import Mapping, Sequence
from typing import Any

from site_pages.markdown import plain, table

MISSED = " MISSED"  # behind what is asked, as the benchmark marks it


def page(
    kept: Mapping[str, Any], peers: Mapping[str, Any], growth: Sequence[Mapping[str, Any]]
) -> str:
    """The page of the figures in ``last.json``, ``peers.json``, ``growth.json`` of tests/bench."""
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
        + _beside(peers)
        + _growth(growth)
    )


def _beside(peers: Mapping[str, Any]) -> str:
    """Other people's tools."""
    rows = [
        (
            *(plain(row[key]) for key in ("what", "unit", "tool")),
            *(_number(x) for x in (row["ours"], row["theirs"], row["theirs"] / row["ours"])),
        )
        for row in peers["rows"]
    ]
    return (
        "\n## Other people's tools\n\n"
        f"Found on {plain(peers['day'])} by `make bench BENCH=--peers`, in one run."
        " Each row has the same result by both.\n\n"
        + table(("what", "unit", "tool", "ours", "theirs", "theirs over ours"), rows)
    )


def _growth(growth: Sequence[Mapping[str, Any]]) -> str:
    """What sizes cost."""
    rows = [
        (
            plain(row["name"]),
            plain(row["unit"]),
            *(", ".join(_number(x) for x in row[key]) for key in ("sizes", "costs")),
        )
        for row in growth
    ]
    return "\n## Growth\n\nWhat each size costs, by `make bench BENCH=--growth`.\n\n" + table(
        ("what", "unit", "sizes", "cost"), rows
    )


def _number(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.4g}"
