"""A process that keeps what it has freed gets no fresh pages for the same work."""

import subprocess
import sys

import pytest

# Arrays too small for NumPy's huge pages, together more than glibc keeps by itself.
WORK = """
import resource
import numpy as np
from motionfmu.base import heap

if {keeps}:
    heap.keep_freed()
for _ in range(4):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    arrays = [np.ones(400_000) for _ in range(8)]
    del arrays
    after = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
print(after - before)
"""


def faults(keeps: bool) -> int:
    """Page faults of the last round."""
    line = [sys.executable, "-c", WORK.format(keeps=keeps)]
    return int(subprocess.run(line, check=True, capture_output=True, text=True).stdout)


@pytest.mark.skipif(sys.platform != "linux", reason="glibc is Linux's")
def test_freed_memory_is_used_again() -> None:
    assert faults(keeps=True) < 50 < faults(keeps=False)
