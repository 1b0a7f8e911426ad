"""Every FMU found: equal bits in both versions, after a reset, from a state, side by side."""

import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from few_cases import few
from fmi_tools import OK, Instance, random_inputs, run, start_values, unpacked
from fmpy import simulate_fmu
from fmpy.build import build_platform_binary

from motionfmu.scenarios.fmus import fmu_names, fmu_path

STEPS = 40
# Comes before the compiler: an object is made once for both builds, if its options are the same.
LAUNCHER = """#!/bin/sh
for file; do :; done
kept={kept}/${{file##*/}}
for word; do
    [ "$last" = -o ] && object=$word
    case $word in -DFMI*) ;; -[DOfs]*) kept=$kept$word ;; esac
    last=$word
done
if [ "${{file##*/}}" = fmu_main.c ]; then exec "$@"; fi
if [ -e "$kept" ]; then exec ln "$kept" "$object"; fi
"$@" && ln "$object" "$kept"
"""
VERSIONS = (2, 3)
every_fmu = pytest.mark.parametrize("name", fmu_names())
both = pytest.mark.parametrize("fmi", VERSIONS)


def size_of(name: str) -> float:
    return float(unpacked(name, 3)[0].defaultExperiment.stepSize)


def started(name: str, fmi: int, folder: Path) -> Instance:
    return Instance(name, fmi).initialize(start_values(name, folder))


def run_anew(name: str, fmi: int, folder: Path, seed: int) -> list[str]:
    instance = started(name, fmi, folder)
    seen = run(instance, random_inputs(instance, seed, STEPS), size_of(name))
    assert instance.call("Terminate") == OK, instance.said
    instance.free()
    return seen


def test_there_are_fmus() -> None:
    assert len(fmu_names()) >= 6


@every_fmu
def test_both_versions_give_the_same_bits(name: str, tmp_path: Path) -> None:
    results = []
    for fmi, seed in ((2, 1), (3, 1), (3, 2)):
        seen = run_anew(name, fmi, tmp_path, seed)
        results.append((seen, {f.name: f.read_bytes() for f in tmp_path.iterdir()}))
    assert results[0] == results[1]
    assert results[1] != results[2]  # the inputs matter


@both
@every_fmu
def test_reset_gives_a_fresh_instance(name: str, fmi: int, tmp_path: Path) -> None:
    instance = started(name, fmi, tmp_path)
    run(instance, random_inputs(instance, 3, STEPS), size_of(name))
    assert instance.call("Reset") == OK
    instance.initialize(start_values(name, tmp_path))
    again = run(instance, random_inputs(instance, 4, STEPS), size_of(name))
    instance.free()
    assert again == run_anew(name, fmi, tmp_path, 4)


@both
@every_fmu
def test_a_state_runs_on_anywhere(name: str, fmi: int, tmp_path: Path) -> None:
    one = started(name, fmi, tmp_path)
    inputs = random_inputs(one, 5, STEPS)
    size = size_of(name)
    run(one, inputs[: STEPS // 2], size)
    state, time = one.save(), one.time
    data = one.serialize(state)
    rest = run(one, inputs[STEPS // 2 :], size)
    assert one.restore(state, time) == OK, one.said
    assert run(one, inputs[STEPS // 2 :], size) == rest
    assert one.free_state(state) == OK
    one.free()
    for version in VERSIONS:  # a new instance, never initialised
        other = Instance(name, version)
        status, state = other.deserialize(data)
        assert status == OK, other.said
        assert other.restore(state, time) == OK, other.said
        assert run(other, inputs[STEPS // 2 :], size) == rest
        other.free_state(state)
        other.free()


@both
@every_fmu
def test_two_instances_do_not_know_each_other(name: str, fmi: int, tmp_path: Path) -> None:
    folders = [tmp_path / "a", tmp_path / "b"]
    for folder in folders:
        folder.mkdir()
    pair = [started(name, fmi, folder) for folder in folders]
    inputs = [random_inputs(pair[0], seed, STEPS) for seed in (6, 7)]
    seen: list[list[str]] = [[], []]
    for k in range(STEPS):
        for i in (0, 1):
            seen[i] += run(pair[i], [inputs[i][k]], size_of(name))
    for instance in pair:
        instance.free()
    assert seen == [run_anew(name, fmi, tmp_path, seed) for seed in (6, 7)]


@pytest.mark.parametrize("name", few(fmu_names(), 7))
def test_dividing_the_step_changes_no_bit(name: str, tmp_path: Path) -> None:
    whole = run_anew(name, 3, tmp_path, 8)
    size = size_of(name)
    for parts in (2, 4, 10):
        instance = started(name, 3, tmp_path)
        seen = []
        for row in random_inputs(instance, 8, STEPS):
            seen.append(run(instance, [row] * parts, size / parts)[-1])
        instance.free()
        assert seen == whole


@both
@every_fmu
def test_fmpy_simulates_it(name: str, fmi: int, tmp_path: Path) -> None:
    stop = STEPS * size_of(name)
    result = simulate_fmu(
        str(fmu_path(name, fmi)),
        stop_time=stop,
        start_values=start_values(name, tmp_path),
        output_interval=size_of(name),
    )
    assert len(result) == STEPS + 1
    assert result["time"][-1] == pytest.approx(stop, rel=1e-12)


def sources(name: str, fmi: int) -> dict[str, bytes]:
    with zipfile.ZipFile(fmu_path(name, fmi)) as archive:
        return {n: archive.read(n) for n in archive.namelist() if n.startswith("sources/")}


@pytest.fixture
def quick_build(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """Options with which what is the same in both versions is compiled once."""
    launcher = tmp_path / "launcher"
    launcher.write_text(LAUNCHER.format(kept=tmp_path))
    launcher.chmod(0o755)
    monkeypatch.setattr(subprocess, "check_call", quiet_call)
    monkeypatch.setenv("CMAKE_GENERATOR", "Ninja")
    monkeypatch.setenv("PATH", str(Path(sys.executable).parent), prepend=os.pathsep)
    # Not optimised: compiled in a fourth of the time, and other code than what is shipped.
    return {
        "CMAKE_C_FLAGS_RELEASE:STRING": "-O0",
        "CMAKE_C_STANDARD:STRING": "11",
        "CMAKE_C_COMPILER_LAUNCHER:STRING": str(launcher),
    }


@pytest.mark.more
@every_fmu
def test_packed_sources_give_the_same_bits(
    name: str, tmp_path: Path, quick_build: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    two, three = sources(name, 2), sources(name, 3)
    differing = {n for n in two.keys() & three.keys() if two[n] != three[n]}
    assert differing == {"sources/fmu_main.c"}
    alone = two.keys() ^ three.keys() - {"sources/buildDescription.xml"}
    assert all(re.fullmatch(r"sources/fmi[23]\w+\.h", n) for n in alone)
    shipped = [run_anew(name, fmi, tmp_path, 9) for fmi in VERSIONS]
    for fmi in VERSIONS:
        folder = tmp_path / f"fmu{fmi}"
        with zipfile.ZipFile(fmu_path(name, fmi)) as archive:
            archive.extractall(folder)
        for binary in (folder / "binaries").glob("*/*"):
            binary.unlink()
        build_platform_binary(folder, cmake_options=dict(quick_build))
        assert len(list((folder / "binaries").glob("*/*"))) == 1
    monkeypatch.setattr("fmi_tools.unpacked", lambda n, v: at(tmp_path / f"fmu{v}", n, v))
    assert [run_anew(name, fmi, tmp_path, 9) for fmi in VERSIONS] == shipped


def at(folder: Path, name: str, fmi: int) -> tuple[object, ...]:
    description, _, variables = unpacked(name, fmi)
    return description, str(folder), variables


def quiet_call(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
