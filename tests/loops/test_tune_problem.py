"""Problem files of `tune`: what is wrong with one is told at once, with its line."""

from pathlib import Path

import pytest
from linear_rigs import DEMO

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.study.tune import read


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('cost = "iso"\n', r"t\.toml:1: cost = 'iso'"),
        ('axes = "each"\ngain = 3\n', r"t\.toml:2: gain = 3"),
        ('[bounds]\n"mcc.p_gain" = [5, 2]\n', r"t\.toml:2: bounds\.mcc\.p_gain = \[5.*, 2"),
        ('[family]\n"machine.tau" = [2, 2]\n', r"t\.toml:2: family\.machine\.tau = \[2.*, 2"),
        ("[limits]\novershoot = -1\n", r"t\.toml:2: limits\.overshoot = -1"),
        ("axes = \n", r"t\.toml:1: "),
    ],
)
def test_a_wrong_problem_file_is_named_with_its_line(
    text: str, message: str, tmp_path: Path
) -> None:
    file = tmp_path / "t.toml"
    file.write_text(text)
    with pytest.raises(InputError, match=message):
        read(file)


def test_all_that_is_wrong_with_a_problem_is_told_at_once(tmp_path: Path) -> None:
    file = tmp_path / "t.toml"
    file.write_text(
        'cost = "iso"\naxis = "each"\ncommand = "mcc.hold"\n[bound]\n"mcc.p_gain" = [2, 5]\n'
        '[family]\n"machine.tau" = [2, 2]\n[limits]\novershot = 0.1\n[limits.margins]\n'
        'gian = 2.0\n[limits.loop."drives.dac"]\nphase = 200.0\n'
    )
    with pytest.raises(InputError) as caught:
        read(file)
    told = [line.removeprefix(f"{file}:") for line in str(caught.value).splitlines()]
    words = ("1: cost = 'iso'", "2: axis = 'each': unknown key; did you mean 'axes'?",
             "3: command: command and position go", "4: bound: unknown table; did you mean",
             "7: family.machine.tau = [2.0, 2.0]: the", "9: limits.overshot = 0.1: unknown key; "
             "did you mean 'overshoot'?", "11: limits.margins.gian = 2.0: unknown key; did you mean"
             " 'gain'?", "13: limits.loop.drives.dac.phase = 200.0:")  # fmt: skip
    for line, start in zip(told, words, strict=True):
        assert line.startswith(start), line


def test_all_names_that_the_scenario_lacks_are_told_at_once(tmp_path: Path) -> None:
    file = tmp_path / "t.toml"
    file.write_text(
        'gains = ["mcc.p_gian"]\n[bounds]\n"mcc.p_gain" = [2, 5]\n[family]\n'
        '"machin.tau" = [1, 2]\n[limits.peak]\n"drives.tork" = 1.0\n[at]\nx = true\n'
    )
    with pytest.raises(InputError) as caught:
        read(file, motionfmu.load(DEMO))
    told = [line.removeprefix(f"{file}:") for line in str(caught.value).splitlines()]
    words = ("1: gains: mcc.p_gian: mcc has no variable 'p_gian'; did you mean 'p_gain'?",
             "3: bounds.mcc.p_gain: it is not among the gains: mcc.p_gian; did you mean",
             "5: family: machin.tau: no component 'machin'; did you mean 'machine'?",
             "7: limits.peak: drives.tork: ", "9: at.x = True: input should be")  # fmt: skip
    for line, start in zip(told, words, strict=True):
        assert line.startswith(start), line
    assert "did you mean 'torque'?" in told[-2]
