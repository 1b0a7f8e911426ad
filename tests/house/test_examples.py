"""The examples: the build line works, C and Python print the same, the numbers are right."""

import re
import subprocess
import sys
from pathlib import Path

from conftest import ROOT

FOLDER = "src/station/example"
PART = f"{FOLDER}/part.ngc"


def output(*command: str | Path) -> str:
    return subprocess.run(
        [str(c) for c in command], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout


def test_c_and_python_print_the_same_numbers(tmp_path: Path) -> None:
    head = (ROOT / FOLDER / "virtual_card.c").read_text().split("*/")[0]
    build = re.search(r"gcc .*?-o virtual_card", head, re.S)
    assert build
    line = build[0].replace("\\\n *", "").replace("-o virtual_card", f"-o {tmp_path / 'card'}")
    output("sh", "-c", line)
    in_c = output(tmp_path / "card", PART)
    assert in_c == output(sys.executable, "-m", "motionfmu.mcc.example", PART)
    assert re.findall(r"pulses (.*), int", in_c) == ["0 0 0", "15000 12000 5000"]
    assert re.findall(r"underflows (.*)", in_c) == ["0", "0"]
    assert "refused: -7" in in_c


def test_every_example_is_in_the_readme() -> None:
    text = (ROOT / FOLDER / "README.md").read_text()
    files = {f.name for f in (ROOT / FOLDER).iterdir()} - {"README.md"}
    assert files == set(re.findall(r"\]\(([\w.]+)\)", text))


def test_the_readme_example_runs() -> None:
    text = (ROOT / "README.md").read_text()
    code = re.search(r"```python\n(from motionfmu\.mcc .*?)```", text, re.S)
    assert code and output(sys.executable, "-c", code[1]).split()[:2] == ["[20000", "5000"]
