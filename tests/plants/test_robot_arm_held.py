"""The arm at rest in the hands of six drives: it settles and then stands."""

from pathlib import Path

import numpy as np
import pytest

import motionfmu

SCENARIO = """# Arm held by six drives in position mode.
stop = 60.0
step = 1e-4
leave = ["drives.enable", "drives.alarm_reset", "drives.dac", "drives.pulse_count", "arm.force"]

[component]
drives = "servo_drives"
arm    = "robot_arm"

[connect]
"drives.phase" = "arm.motor_phase"
"arm.torque"   = "drives.torque"

[set]
"arm.start_joint" = [0.0, 17.188733853924695, -11.459155902616466, 0.0, 22.918311805232932, 0.0]
"drives.mode" = 1
"drives.pulses_per_turn" = 2500
"drives.position_gain" = 30
"drives.velocity_gain" = [0.2, 0.3, 0.15, 0.02, 0.02, 0.01]
"drives.velocity_time" = 0.03

[record]
signals = ["arm.motor_angle"]

[check]
"arm.motor_angle[1]" = { absmax = 0.1 }
"""
COUNTS = 2**20 / (2 * np.pi)


def test_an_arm_in_the_hands_of_drives_stands(tmp_path: Path) -> None:
    """Sinks while the integrals come, and from 10 s on no motor moves by a count in 50 s."""
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    result = motionfmu.load(tmp_path).run()
    assert result.ok
    counts = result["arm.motor_angle"] * COUNTS
    late = counts[100_000:]
    sunk = np.abs(counts[:20_000] - counts[-1]).max()
    print("largest way after 10 s [counts]", np.ptp(late, axis=0).max(), "before", sunk)
    assert sunk > 1000, "no torque at the start: it sinks"
    assert np.ptp(late, axis=0).max() < 1.0


# Joint 2 of the arm at power-off: brake, its time to close, how long the loops hold it [s]; least
# and most way [deg].
@pytest.mark.parametrize(
    ("brake", "close", "hold", "ways"),
    [
        (0.0, 0.0, 0.0, (10.0, 90.0)),
        (10.0, 0.0, 0.0, (0.0, 0.05)),
        (10.0, 0.05, 0.08, (0.0, 0.05)),
        (10.0, 0.05, 0.0, (0.1, 1.5)),
        (0.5, 0.0, 0.0, (1.0, 90.0)),
    ],
)
def test_at_power_off_an_arm_falls_or_its_brakes_hold_it(
    tmp_path: Path, brake: float, close: float, hold: float, ways: tuple[float, float]
) -> None:
    text = SCENARIO.replace("stop = 60.0", "stop = 2.6").replace('"drives.enable", ', "")
    text = text.replace(
        "[record]",
        f"""
"drives.brake_torque" = {brake}
"drives.brake_close_time" = {close}
"drives.brake_hold_time" = {hold}

[drive]
"drives.enable" = {{ at = [2.0], value = [false] }}

[record]""",
    )
    text = text.replace("arm.motor_angle[1]", "arm.motor_angle[6]").replace("0.1 }", "1e9 }")
    (tmp_path / "scenario.toml").write_text(text)
    motor = motionfmu.load(tmp_path).run()["arm.motor_angle"][:, 1]
    way = float(np.degrees(np.abs(motor[20_000:] - motor[20_000]).max())) / 120.0
    assert ways[0] <= way <= ways[1], way
