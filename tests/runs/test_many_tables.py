"""Several machines in one scenario: each as it is alone, and no dearer than the others."""

import fnmatch
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.analysis import linear
from motionfmu.analysis.linear import parts, wiring
from motionfmu.fused import text
from motionfmu.run.run_plan import Options
from motionfmu.scenarios import system

sys.path.insert(0, str(ROOT / "tests/bench"))
import growth

DEMO = ROOT / "scenarios/circle"
COUNT = 3
STOP = 0.5  # [s], into the first circle


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three tables of the demo in one scenario."""
    return growth.tables(COUNT, tmp_path_factory.mktemp("tables"))


def test_each_table_has_the_bits_of_the_demo(tables: Path) -> None:
    alone = motionfmu.load(DEMO).run(stop=STOP)
    found = motionfmu.load(tables).run(stop=STOP)
    assert np.abs(alone["machine.table_position"]).max() > 1e-3
    for name, signal in found.signals.items():
        component, _, variable = name.partition(".")
        assert np.array_equal(signal, alone[f"{component.rpartition('_')[0]}.{variable}"]), name
    assert len(found.signals) % COUNT == 0 and len(found.signals) > 10 * COUNT


def test_the_last_of_many_wires_brings_nothing_that_its_input_may_not_have(tables: Path) -> None:
    """A system with so many is carried by several functions."""
    plan = motionfmu.load(tables)
    more = {"more.command": "card_1.irq_seq"}
    bad = plan.changed(
        component=plan.document.tables["component"] | {"more": "network_card"},
        connect=plan.document.tables["connect"] | more,
        leave=[*plan.document.tables["leave"], "more.*"],
    )
    targets = [w.target.name for w in bad.resolved(Options()).wires]
    assert len(targets) > text._COPIES and targets[-1] == "more.command"
    for engine in ("fused", "native"):
        with pytest.raises(motionfmu.InputError, match=r"more: .*command = 0 is below its minimum"):
            bad.run(stop=0.01, engine=engine)


def test_each_table_has_the_gains_of_the_demo(tables: Path) -> None:
    alone = {(g.name, g.axis): (g.value, g.kp) for g in linear.gain_of(DEMO)}
    assert len(alone) == 2
    found = {(g.name, g.axis): (g.value, g.kp) for g in linear.gain_of(tables)}
    expected = {
        (f"mcc_{k}.p_gain", axis): told for k in range(COUNT) for (_, axis), told in alone.items()
    }
    assert found.keys() == expected.keys()
    for which, told in expected.items():
        assert found[which] == pytest.approx(told, rel=1e-12)


def test_a_gain_is_looked_for_where_it_acts(tables: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The paths that are followed for the gains of three tables are three times those of one."""
    seen: list[int] = []
    own = wiring.Net.used

    def used(net: wiring.Net, *ends: list[wiring.Port]) -> set[str]:
        seen.append(len(net.blocks))
        return own(net, *ends)

    monkeypatch.setattr(wiring.Net, "used", used)
    sums = []
    for scenario in (DEMO, tables):
        seen.clear()
        model = linear.model(scenario, 1, {})
        for name in [n for n in model.blocks if n.startswith("mcc")]:
            linear.kp_of(model, f"{name}.p_gain")
        sums.append(sum(seen))
    assert sums[0] > 0 and sums[1] == COUNT * sums[0]


PATTERNS = ("mcc_1.card_*", "card_0.host_*", "*", "mcc*", "*.table_position", "card_?.err_count",
            "machine_2.table_position", "card_1*", "none.*", "none", "mcc_[12].p_gain")  # fmt: skip


@pytest.mark.parametrize("pattern", PATTERNS)
def test_a_pattern_finds_what_a_look_at_all_names_finds(
    tables: Path, pattern: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    resolver = motionfmu.load(tables).resolver
    every = [(c, p) for c, known in resolver.ports.items() for p in known.values()]
    escaped = pattern.replace("[", "[[]")
    asked: list[str] = []
    own = system.matches
    monkeypatch.setattr(
        system, "matches", lambda name, *rest: asked.append(name) or own(name, *rest)
    )
    for causality in ("input", "output"):
        assert [e.name for e in resolver.matching(pattern, causality)] == [
            f"{c}.{p.name}"
            for c, p in every
            if p.causality == causality and fnmatch.fnmatchcase(f"{c}.{p.name}", escaped)
        ]
    component = pattern.partition(".")[0]
    if not set("*?") & set(component):  # a name: no other component is looked at
        assert {name.partition(".")[0] for name in asked} <= {component}


def test_a_gain_is_changed_where_it_acts(tables: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is made anew for the gains of three tables is three times that of one."""
    seen: list[int] = []
    own = parts.parts

    def made(*arguments: Any) -> parts.Parts:
        found = own(*arguments)
        seen.append(len(found.blocks))
        return found

    monkeypatch.setattr(linear.axis, "parts", made)
    sums = []
    for scenario in (DEMO, tables):
        model = linear.model(scenario, 1, {})
        seen.clear()
        for name in [n for n in model.blocks if n.startswith("mcc")]:
            linear.kp_of(model, f"{name}.p_gain")
        sums.append(sum(seen))
    assert sums[0] > 0 and sums[1] == COUNT * sums[0]
