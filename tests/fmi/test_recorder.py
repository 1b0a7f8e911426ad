"""What the recorder writes is what NumPy reads."""

import subprocess
from pathlib import Path

import numpy as np

ROWS = 50_000
ROOT = Path(__file__).parents[2]


def test_numpy_reads_the_files(tmp_path: Path) -> None:
    """Types, shapes and every element, read by NumPy from what its own header says."""
    folder = tmp_path / "signals"
    subprocess.run([ROOT / "build/test_recorder", folder], check=True)
    found = {f.stem: np.load(f, mmap_mode="r") for f in folder.iterdir()}
    k, axis = np.arange(ROWS), np.arange(6)
    wanted = {
        "time": k * 1e-4,
        "a.six": k[:, None] + 0.125 * axis,
        "a.count": -k.astype(np.int32),
        "a.many": (k[:, None] >> axis & 1).astype(bool),
        "b.one": -0.5 * k,
        "b.two": np.column_stack([1.0 * k * k, 1.0 / (k + 1)]),
        "b.on": k % 3 == 0,
        "c.late": np.where((k >= 10_000) & (k < 10_100), 1.0, 0.0),
        "b.counts": (k[:, None] * 6 + axis).astype(np.int32),
    }
    assert sorted(found) == sorted(wanted)
    # what is 0 for long takes no room on the disk (where files can have holes)
    assert (folder / "c.late.npy").stat().st_blocks * 512 <= 4096 * 20
    for name, data in wanted.items():
        assert found[name].dtype == data.dtype, name
        assert found[name].flags.aligned, name
        np.testing.assert_array_equal(found[name], data, err_msg=name)
