"""The card as a C library gives the same numbers as the card as an FMU."""

import subprocess

import numpy as np
import pytest
from conftest import ROOT
from fmi_tools import OK, Instance

PERIOD, FRAMES = 1e-4, 400


def command(n: int) -> int:
    half = n % (FRAMES // 2)
    ramp = half + 1 if half < FRAMES // 4 else FRAMES // 2 - half
    return 0 if n >= FRAMES else (2 if n < FRAMES // 2 else -2) * ramp


@pytest.fixture(scope="module")
def table() -> np.ndarray:
    program = ROOT / "build/test_card_program"
    done = subprocess.run([program, "--table"], capture_output=True, text=True, check=True)
    return np.array([[float(x) for x in row.split()] for row in done.stdout.splitlines()])


@pytest.mark.parametrize("fmi", [2, 3])
def test_library_and_fmu_give_the_same_numbers(fmi: int, table: np.ndarray) -> None:
    """Driven with the phases of the C program; frames and acknowledges as its host writes them."""
    mask = [1, 1 << 3, *[0] * 7]
    fmu = Instance("epcio", fmi).initialize(
        {
            "active": [True, *[False] * 5],
            "index_lines": 500,
            "latch_source": [1, *[0] * 8],
            "latch_last": True,
            "host_dda_length": 12,
            "host_dda_divider": 5,
            "host_irq_mask": mask,
            "host_p_gain": [200, 0, 0, 0, 0, 0],
            "host_loop_on": [True, *[False] * 5],
            "host_dac_source": [1, 0, 0, 0, 0, 0],
        }
    )
    sent = transactions = acknowledged = 0
    for k, row in enumerate(table[:8000]):
        phase, pulses, counts, error, volts, _, _, latched = row
        assert fmu.get("pulse_count")[0] == pulses
        assert fmu.get("dac")[0] == volts
        flags = fmu.get("irq_flags")
        before, line = fmu.get("stock")[0], fmu.get("irq")[0]
        fmu.set("enc_phase", [phase, 0.0, 0.0, 0.0, 0.0, 0.0])
        # The index interrupt of this instant is read by the program at once, by us one step later.
        if line:
            acknowledged += 1
            fmu.set("host_ack_seq", acknowledged)
            fmu.set("host_ack_flags", flags)
        if before <= 3:
            transactions += 1
            rows = [[command(sent + i), 0, 0, 0, 0, 0] for i in range(4)]
            sent += 4
            fmu.set("host_cmd_count", 4)
            fmu.set("host_cmd_frames", [x for r in rows for x in r] + [0] * 72)
            fmu.set("host_cmd_clock", 0.0)
            fmu.set("host_cmd_seq", transactions)
        assert fmu.step(PERIOD) == OK, fmu.said
        assert fmu.get("enc_count")[0] == counts
        assert fmu.get("err_count")[0] == error, k
        assert fmu.get("latch_value")[0] == latched
    assert transactions > 100 and acknowledged > 50
    fmu.free()
