"""The driver of fuzz harnesses where there is no libFuzzer: seeds, inputs that grow, failures."""

import subprocess
from pathlib import Path

import pytest
from conftest import ROOT

# Tells each input, and fails on one that is four steps away from any other way through it.
HARNESS = r"""
#include "holds.h"
const int fuzz_count = 10;
static volatile int depth;
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ data[i]) * 16777619u;
    }
    printf("%zu %08x\n", size, hash);
    if (size > 0 && data[0] >= 0xf8) {
        depth = 1;
        if (size > 1 && data[1] >= 0xf8) {
            depth = 2;
            if (size > 2 && data[2] >= 0xf8) {
                depth = 3;
                HOLDS(size < 4 || data[3] < 0xf8);
            }
        }
    }
    return 0;
}
"""


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The harness with and without being told of branches."""
    place = tmp_path_factory.mktemp("driver")
    (place / "toy.c").write_text(HARNESS)
    (place / "corpus").write_bytes(b"abcd")
    here = ["gcc", "-O1", "-I", str(ROOT / "tests/fuzz")]
    driver = str(ROOT / "tests/fuzz/driver.c")
    subprocess.run([*here, "-c", driver, "-o", "driver.o"], cwd=place, check=True)
    for name, more in (("blind", []), ("seeing", ["-fsanitize-coverage=trace-pc"])):
        subprocess.run([*here, *more, "toy.c", "driver.o", "-o", name], cwd=place, check=True)
    return {name: place / name for name in ("blind", "seeing", "corpus")}


def ran(program: Path, *arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    line = [program, *arguments, program.parent / "corpus"]
    return subprocess.run(line, cwd=cwd, capture_output=True, text=True, check=False)


def test_a_seed_gives_the_same_inputs_and_another_one_others(
    built: dict[str, Path], tmp_path: Path
) -> None:
    told = [ran(built["blind"], f"200@{seed}", cwd=tmp_path).stdout for seed in (0, 7, 7, 8)]
    inputs = [text.splitlines()[1:-1] for text in told]
    assert len(inputs[0]) == 200 and inputs[1] == inputs[2]
    assert ran(built["blind"], "200", cwd=tmp_path).stdout == told[0]
    for a, b in ((0, 1), (1, 3), (0, 3)):
        one, other = ({x for x in inputs[k] if int(x.split()[0]) > 8} for k in (a, b))
        assert len(one) > 30 and len(one & other) < 0.2 * len(one)  # all, once
    assert "seed 7" in told[1]


def test_inputs_that_go_new_ways_stay_and_lead_on(built: dict[str, Path], tmp_path: Path) -> None:
    """Four bytes at once take millions of inputs, one after the other thousands."""
    assert ran(built["blind"], "40000@1", cwd=tmp_path).returncode == 0
    found = tmp_path / "found"
    found.mkdir()
    failed = ran(built["seeing"], "40000@1", f"+{found}", cwd=tmp_path)
    assert failed.returncode != 0 and "does not hold" in failed.stderr
    (written,) = tmp_path.glob("found-failed-*")
    assert str(written) in failed.stderr and min(written.read_bytes()[:4]) >= 0xF8
    assert any(min(file.read_bytes()[:3] or b"0") >= 0xF8 for file in found.iterdir())


def test_what_brings_nothing_new_is_deleted(built: dict[str, Path], tmp_path: Path) -> None:
    found = tmp_path / "found"
    found.mkdir()
    high = b"\xff"
    for name, text in (("a", 2 * high), ("b", 2 * high + b"xxxx"), ("c", high), ("d", b"abcd")):
        (found / name).write_bytes(text)
    done = ran(built["seeing"], "0", f"+{found}", cwd=tmp_path)
    assert done.returncode == 0
    left = {file.name for file in found.iterdir()}
    assert {"a", "c"} <= left and "d" not in left


def test_an_input_that_does_not_hold_is_told_without_a_folder(
    built: dict[str, Path], tmp_path: Path
) -> None:
    (tmp_path / "bad").write_bytes(4 * b"\xff")
    failed = ran(built["blind"], "0@3", "bad", cwd=tmp_path)
    (written,) = tmp_path.glob("fuzz-failed-*")
    assert written.name in failed.stderr and written.read_bytes() == 4 * b"\xff"
    assert "seed 3" in failed.stderr
