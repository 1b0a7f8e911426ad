"""A system exported for other platforms, from the C text of its FMUs."""

import re
import subprocess
import zipfile
from importlib import util
from pathlib import Path

import bits
import pytest
from conftest import ROOT
from console import command
from few_cases import few

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.base.platforms import PLATFORMS, Platform, here, named

SCENARIO = ROOT / "scenarios/circle"
STEPS, STEP = 400, 1e-4


def test_platforms_are_named() -> None:
    assert named("here") == ()
    assert named("all") == PLATFORMS
    assert named("x86_64-windows,x86_64-windows") == (Platform("x86_64-windows"),)
    with pytest.raises(InputError, match=r"no platform 'win64' \(there are: here, all, x86_64-l"):
        named("x86_64-linux,win64")


@pytest.mark.more
@pytest.mark.skipif(not util.find_spec("ziglang"), reason="no zig: make export installs it")
def test_a_system_from_the_text_of_its_fmus_gives_the_same_bits(tmp_path: Path) -> None:
    others = [p for p in PLATFORMS if p.name in bits.RUNNERS and not bits.missing(p)]
    for name, platforms in (("one", "here"), ("text", ",".join(p.name for p in (here(), *others)))):
        target = str(tmp_path / f"{name}.fmu")
        done = command("export", SCENARIO, "-o", target, "--platforms", platforms)
        assert done.returncode == 0, done.stderr
    job = bits.Job(STEPS, STEP)
    run = motionfmu.load(SCENARIO).run(stop=STEPS * STEP)
    positions = [bits.hash_of(row.tobytes()) for row in run["machine.table_position"]]
    wanted = bits.hashes(tmp_path / "one.fmu", here(), job, tmp_path)
    assert len({row.split()[1] for row in wanted}) > 300 and len(set(positions)) > 200
    for platform in (here(), *others):
        found = bits.hashes(tmp_path / "text.fmu", platform, job, tmp_path)
        assert bits.different(wanted, found) == "", platform
        table = bits.Job(STEPS, STEP, shown=["machine.table_position"])
        rows = bits.hashes(tmp_path / "text.fmu", platform, table, tmp_path)
        assert [row.split()[1] for row in rows[:-1]] == positions, platform
    with zipfile.ZipFile(tmp_path / "text.fmu") as archive:
        names = archive.namelist()
        library = next(n for n in names if re.fullmatch(rf"binaries/{here().name}/.*", n))
        shown = archive.extract(library, tmp_path)
    assert {"sources/mcc/fmu_part.c", "sources/epcio/fmu_names.h"} <= set(names)
    told = subprocess.run(["nm", "-D", "--defined-only", shown], capture_output=True, text=True)
    assert {line.split()[-1][:4] for line in told.stdout.splitlines()} == {"fmi3"}


# Of each scenario: communication steps, and what is given from the start of what it gives later.
ON_ARM: dict[str, tuple[int, dict[str, int]]] = {
    "circle": (STEPS, {}),
    "pocket": (STEPS, {}),
    "plt_plate": (2 * STEPS, {"card.command_seq": 1}),
    "robot_line": (STEPS, {}),
    "hydraulic_positioning": (STEPS, {"controller.pb1": 1}),
}


@pytest.mark.more
@pytest.mark.skipif(not util.find_spec("ziglang"), reason="no zig: make export installs it")
@pytest.mark.parametrize("fmi", few([3, 2], 1, pytest.mark.long))
@pytest.mark.parametrize("name", ON_ARM)
@pytest.mark.parametrize("platform", [Platform("aarch64-linux")], ids=lambda p: p.name)
def test_an_arm_processor_gives_the_bits_of_a_system(
    platform: Platform, name: str, fmi: int, tmp_path: Path
) -> None:
    """By instructions of its own, from the start."""
    if reason := bits.missing(platform):
        pytest.skip(reason)
    scenario = motionfmu.load(ROOT / "scenarios" / name)
    for file, where in (("here", "here"), ("arm", platform.name)):
        target = str(tmp_path / f"{file}.fmu")
        words = ("-o", target, "--fmi", str(fmi), "--platforms", where)
        done = command("export", ROOT / "scenarios" / name, *words)
        assert done.returncode == 0, done.stderr
    steps, given = ON_ARM[name]
    job = bits.Job(steps, scenario.document.body.step, whole=given)
    wanted = bits.hashes(tmp_path / "here.fmu", here(), job, tmp_path)
    assert len({row.split()[1] for row in wanted}) > steps / 2
    assert bits.different(wanted, bits.hashes(tmp_path / "arm.fmu", platform, job, tmp_path)) == ""
