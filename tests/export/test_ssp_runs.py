"""An exported SSP that is imported again runs with the bits of the scenario that it was."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from few_cases import few

import motionfmu
from motionfmu.export import as_ssp
from motionfmu.export.stimuli import stimuli
from motionfmu.run import Options
from motionfmu.ssp.ssp_import import take

STEPS = 120  # of each run
# What each scenario has that the others have not: wires of arrays and a part program; driven
# inputs; one that is driven element by element, and in whole numbers; tables beside the program.
SCENARIOS = {
    "circle": "machine.table_position",
    "hydraulic_load": "axis.table_position",
    "interrupt_sources": "card.irq_pages",
    "compensation": "machine.table_position",
}
FORCE = {"input": "axis.force", "at": [0.002, 0.004], "value": [4000.0, -2000.0]}
# What an input has before it is driven is neither 0 nor its start value.
BEFORE = {"axis.force": 3000.0}
CHANGED: dict[str, dict[str, Any]] = {"hydraulic_load": {"drive": [FORCE], "set": BEFORE}}


def column(result: Any, name: str, shape: tuple[int, ...]) -> np.ndarray:
    """A signal of either run: FMUs of FMI 2 have a variable for each element."""
    if name in result.signals:
        return np.asarray(result[name])
    names = [f"{name}[{','.join(str(k + 1) for k in place)}]" for place in np.ndindex(shape)]
    return np.stack([result[n] for n in names], -1).reshape(-1, *shape)


@pytest.mark.parametrize(("before", "first"), [(BEFORE, 3000.0), ({}, 0.0)])
def test_an_input_has_its_own_value_until_it_is_driven(
    before: dict[str, float], first: float
) -> None:
    """The FMU that drives it says so from the start: its wire is there at once."""
    load = motionfmu.load(ROOT / "scenarios/hydraulic_load")
    for at, rows in ((0.002, [(0.0, 1, first), (0.002, 1, 4000.0)]), (0.0, [(0.0, 1, 4000.0)])):
        drive = {"input": "axis.force", "at": [at], "value": [4000.0]}
        system = load.changed(drive=[drive], set=before).resolved(Options())
        ((made,), lost) = stimuli(system)
        assert (made.rows, lost) == (rows, [])


@pytest.mark.parametrize("fmi", few([2, 3], [3]))
@pytest.mark.parametrize("name", SCENARIOS)
def test_all_signals_have_the_bits_of_the_scenario(name: str, fmi: int, tmp_path: Path) -> None:
    scenario = motionfmu.load(ROOT / "scenarios" / name).changed(**CHANGED.get(name, {}))
    as_ssp(scenario, tmp_path / "it.ssp", fmi, {})
    take(tmp_path / "it.ssp", tmp_path / "back")
    stop = STEPS * scenario.document.body.step
    wanted = scenario.run(stop=stop)
    found = motionfmu.load(tmp_path / "back").run(stop=stop)
    assert len(wanted.time) == STEPS and np.ptp(wanted[SCENARIOS[name]], axis=0).any()
    for signal in wanted.signals:
        bits = wanted[signal]
        back = column(found, signal, bits.shape[1:])
        assert back.astype(bits.dtype).tobytes() == bits.tobytes(), signal
