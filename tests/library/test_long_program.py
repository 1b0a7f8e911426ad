"""The mcc FMU reads a program of any length in the memory that a short one takes.

python tests/library/test_long_program.py 1000000
"""

import math
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

SCENARIO = """# A wave of short lines.
stop = {stop}
step = 1e-3
leave = ["mcc.hold", "mcc.abort", "mcc.override", "mcc.*_in", "card.*_aux", "card.io_*",
         "card.reg_*", "card.enc_phase"]

[component]
mcc  = "mcc"
card = "epcio"

[connect]
"card.host_*" = "mcc.card_*"
"mcc.card_*"  = "card.*"

[set]
"mcc.program"     = "long.ngc"
"mcc.output_mode" = 0
"mcc.bus_period"  = 1e-3
"mcc.min_stock"   = 10
"mcc.batch"       = 16

[record]
signals = ["mcc.done", "mcc.line", "card.pulse_count"]

[check]
"mcc.done" = {{ final = true }}
"""


def write(file: Path, lines: int, way: float) -> None:
    """Lines along X of a way [mm] each, with a wave of 1 mm in Y."""
    with file.open("w") as f:
        f.write("G64 P0.01 F25000\nG1\n")
        f.writelines(
            f"X{way * i:.5f} Y{math.sin(0.02 * way * i):.6f}\n" for i in range(1, lines - 2)
        )
        f.write("M2\n")


def run(lines: int, way: float, stop: float) -> None:
    """Drive such a program and print the most memory that this process has had [kB]."""
    import motionfmu

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write(folder / "long.ngc", lines, way)
        (folder / "scenario.toml").write_text(SCENARIO.format(stop=stop))
        result = motionfmu.load(folder).run()
    end = round(1000.0 * way * (lines - 3))
    assert result.ok and int(result["mcc.line"].max()) == lines - 1
    assert abs(int(result["card.pulse_count"][-1, 0]) - end) <= 1
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


def memory(lines: int, way: float, stop: float) -> int:
    """The same in a process of its own. [kB]"""
    command = [sys.executable, __file__, *map(str, (lines, way, stop))]
    return int(subprocess.run(command, capture_output=True, check=True, text=True).stdout)


@pytest.mark.more
def test_memory_is_that_of_a_short_program() -> None:
    """A command is 0.7 kB, a line 20 bytes: kept, a hundred thousand would be 70 or 2 MB."""
    short, long = memory(1_000, 1.0, 6.0), memory(100_000, 0.01, 6.0)
    assert short > 20_000
    assert long - short == pytest.approx(0.0, abs=1_500)


if __name__ == "__main__":
    count = int(sys.argv[1])
    rest = [float(x) for x in sys.argv[2:]] or [10_000.0 / count, 60.0]
    run(count, *rest)
