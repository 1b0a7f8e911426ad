"""What a wire and a sampled block delay, as the timing table of src/motionfmu/README.md says."""

from pathlib import Path

import numpy as np
import pytest

import motionfmu

PERIOD = 1e-4  # [s] of the card's loop and of the drives
CAUSE = 20 * PERIOD  # [s] the encoder jumps
SCENARIO = """# A jump of the encoder, seen in the voltage of the card and the torque of the drive.
stop = 6e-3
step = 1e-4
leave = ["card.*", "drives.*"]

[component]
card = "epcio"
drives = "servo_drives"

[connect]
"drives.dac" = "card.dac"

[set]
"card.host_loop_on" = true
"card.host_dac_source" = 1
"card.host_p_gain" = 60
"drives.velocity_time" = 0.0

[[drive]]
input = "card.enc_phase"
at = [2e-3]
value = [-5.0]

[record]
signals = ["card.dac", "drives.torque"]
"""


def first_change(result: motionfmu.Result, name: str) -> float:
    """Time of the first sample that is not 0, in periods after the cause."""
    row = int(np.flatnonzero(result[name][:, 0])[0])
    return (result.time[row] - CAUSE) / PERIOD


@pytest.mark.parametrize("engine", ["native", "python", "fmpy"])
@pytest.mark.parametrize(
    ("parts", "dac", "torque"),
    [
        # communication steps per period, then periods until each output shows the jump
        (1, 1, 2),
        (4, 1, 2),
        (10, 1, 2),
        (0.5, 2, 4),
        (0.25, 4, 8),
    ],
)
def test_delay_of_a_chain(
    tmp_path: Path, engine: str, parts: float, dac: float, torque: float
) -> None:
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    result = motionfmu.load(tmp_path).run(engine=engine, step=PERIOD / parts)
    assert first_change(result, "card.dac") == pytest.approx(dac)
    assert first_change(result, "drives.torque") == pytest.approx(torque)
