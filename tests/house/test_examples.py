"""The examples: the build line works, C and Python print the same, the numbers are right."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

# Core and program of each example, its package, its inputs.
EXAMPLES = [
    ("station", "virtual_card", "mcc", ["part.ngc"]),
    ("robot_station", "virtual_robot", "robot", ["plate.job", "plate.points"]),
]


def output(*command: str | Path) -> str:
    return subprocess.run(
        [str(c) for c in command], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout


def printed(core: str, name: str, package: str, inputs: list[str], folder: Path) -> str:
    """What both programs print."""
    head = (ROOT / f"src/{core}/example/{name}.c").read_text().split("*/")[0]
    build = re.search(rf"gcc .*?-o {name}", head, re.S)
    assert build
    line = build[0].replace("\\\n *", "").replace(f"-o {name}", f"-o {folder / name}")
    assert "-O2" in line
    line = line.replace("-O2", "-O0")  # compiled in a fourth of the time
    output("sh", "-c", line)
    files = [f"src/{core}/example/{f}" for f in inputs]
    in_c = output(folder / name, *files)
    assert in_c == output(sys.executable, "-m", f"motionfmu.{package}.example", *files)
    return in_c


def test_card_in_c_and_python_prints_the_same_numbers(tmp_path: Path) -> None:
    text = printed(*EXAMPLES[0], tmp_path)
    assert re.findall(r"pulses (.*), int", text) == ["0 0 0", "15000 12000 5000"]
    assert re.findall(r"underflows (.*)", text) == ["0", "0"]
    assert "refused: -7" in text


def test_robot_in_c_and_python_prints_the_same_numbers(tmp_path: Path) -> None:
    text = printed(*EXAMPLES[1], tmp_path)
    rests = re.findall(r"X +(\S+)  Y +(\S+)  Z +(\S+) mm +0.00 mm/s", text)
    ends = [(1000, 200, 700), (1000, -100, 500), (1000, -100, 550)]
    for found, wanted in zip((rests[0], *rests[-2:]), ends, strict=True):
        assert [float(f) for f in found] == pytest.approx(wanted, abs=0.03)
    assert re.findall(r"underruns (.*)", text) == ["0, error 0"] * 2
    assert "out of reach at" in text and text.count("OT 1") > 50


@pytest.mark.parametrize("core", [e[0] for e in EXAMPLES])
def test_every_example_is_in_the_readme(core: str) -> None:
    folder = ROOT / f"src/{core}/example"
    files = {f.name for f in folder.iterdir()} - {"README.md"}
    assert files == set(re.findall(r"\]\(([\w.]+)\)", (folder / "README.md").read_text()))


def test_the_readme_example_runs() -> None:
    text = (ROOT / "README.md").read_text()
    code = re.search(r"```python\n(from motionfmu\.mcc .*?)```", text, re.S)
    assert code and output(sys.executable, "-c", code[1]).split()[:2] == ["[20000", "5000"]


def test_the_example_of_the_robot_station_runs() -> None:
    text = (ROOT / "src/robot_station/README.md").read_text()
    code = re.search(r"```python\n(.*?)```", text, re.S)
    assert code
    told, where = output(sys.executable, "-c", code[1]).splitlines()
    assert "joint 1 to 190 deg, limit 180 deg" in told and where == "[1000.0, 100.0, 900.0]"
