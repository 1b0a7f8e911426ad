"""The examples, outside the tree: C, C++ and Python print the same, the numbers are right."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import FMUS, ROOT

import motionfmu

# Core and program of each example, its package, its inputs.
EXAMPLES = [
    ("station", "virtual_card", "mcc.card_example", ["part.ngc"]),
    ("robot_station", "virtual_robot", "robot.robot_example", ["plate.job", "plate.points"]),
]
CMAKE = Path(sys.executable).parent / "cmake"


def output(*command: str | Path, cwd: Path = ROOT) -> str:
    done = subprocess.run([str(c) for c in command], cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Libraries, headers and packages as they are installed."""
    folder = tmp_path_factory.mktemp("prefix")
    output(CMAKE, "--install", "build", "--prefix", folder, "--component", "development")
    return folder


def needs(tool: str) -> None:
    if not shutil.which(tool):
        pytest.skip(f"no {tool} here")


def copied(name: str, folder: Path) -> Path:
    return shutil.copytree(ROOT / "examples" / name, folder / name)


def build_line(source: Path, prefix: Path) -> str:
    """Build an example by the line in its head; the line."""
    needs("pkg-config")
    (line,) = re.findall(r"(?:cc|c\+\+) -O2 .*", source.read_text())
    where = f"PKG_CONFIG_PATH={prefix}/lib/pkgconfig"
    # The packages know their own folder: no other path is needed.
    output("sh", "-c", f"export {where}; {line} -Wall -Wextra -Werror", cwd=source.parent)
    return line


def printed(example: tuple[str, str, str, list[str]], prefix: Path, folder: Path) -> str:
    """What both programs print."""
    core, name, module, inputs = example
    project = copied(name, folder)
    line = build_line(project / f"{name}.c", prefix)
    assert line in (project / "README.md").read_text() and f"motionfmu-{core})" in line
    in_c = output(project / name, *inputs, cwd=project)
    assert in_c == output(sys.executable, "-m", f"motionfmu.virtual.{module}", *inputs, cwd=project)
    return in_c


@pytest.mark.more
def test_card_in_c_and_python_prints_the_same_numbers(prefix: Path, tmp_path: Path) -> None:
    text = printed(EXAMPLES[0], prefix, tmp_path)
    assert re.findall(r"pulses (.*), int", text) == ["0 0 0", "15000 12000 5000"]
    assert re.findall(r"underflows (.*)", text) == ["0", "0"]
    assert "refused: -7" in text


@pytest.mark.more
def test_robot_in_c_and_python_prints_the_same_numbers(prefix: Path, tmp_path: Path) -> None:
    text = printed(EXAMPLES[1], prefix, tmp_path)
    rests = re.findall(r"X +(\S+)  Y +(\S+)  Z +(\S+) mm +0.00 mm/s", text)
    ends = [(1000, 200, 700), (1000, -100, 500), (1000, -100, 550)]
    for found, wanted in zip((rests[0], *rests[-2:]), ends, strict=True):
        assert [float(f) for f in found] == pytest.approx(wanted, abs=0.03)
    assert re.findall(r"underruns (.*)", text) == ["0, error 0"] * 2
    assert "out of reach at" in text and text.count("OT 1") > 50


@pytest.mark.more
def test_a_project_finds_the_package_in_c_and_cxx(prefix: Path, tmp_path: Path) -> None:
    needs("g++")
    project = copied("virtual_card", tmp_path)
    output(CMAKE, "-G", "Ninja", "-B", "build", f"-DCMAKE_PREFIX_PATH={prefix}", cwd=project)
    output(CMAKE, "--build", "build", cwd=project)
    in_c = output(project / "build/virtual_card", "part.ngc", cwd=project)
    assert in_c.splitlines()[-1].startswith("pulses 15000 12000 5000,")
    by_cmake = output(project / "build/square")
    build_line(project / "square.cpp", prefix)
    assert output(project / "square") == by_cmake
    exact, path = map(float, re.findall(r"([\d.]+) s", by_cmake))
    # 10 mm at 20 mm/s with ramps of 0.1 s: 0.6 s a side; blends save one ramp at each of three.
    assert exact == pytest.approx(2.4, abs=0.02)
    assert path == pytest.approx(2.1, abs=0.02)


@pytest.mark.more
def test_installed_libraries_show_names_of_the_project_alone(prefix: Path) -> None:
    found = output("nm", "-g", "--defined-only", *(prefix / "lib/motionfmu").glob("*.a"))
    shown = {words[2] for line in found.splitlines() if len(words := line.split()) == 3}
    assert len(shown) > 1000  # else nothing was looked at
    assert {name for name in shown if not name.startswith("motionfmu_")} == set()


@pytest.mark.more
def test_a_program_may_have_names_of_the_sources(prefix: Path, tmp_path: Path) -> None:
    own = "int ring_push(void) { return 1; }\nint adc_start(void) { return 2; }\n"
    call = (
        "#include <motionfmu/station.h>\n#include <stdio.h>\nstatic struct station s;\n"
        "int ring_push(void);\nint adc_start(void);\nint main(void)\n{\n"
        "    struct station_config c = motionfmu_station_defaults();\n"
        '    printf("%d %d\\n", motionfmu_station_start(&s, &c), ring_push() + adc_start());\n}\n'
    )
    (tmp_path / "own.c").write_text(own)
    (tmp_path / "main.c").write_text("/* cc -O2 main.c own.c LIBRARIES */\n" + call)
    flags = output(
        "sh",
        "-c",
        f"PKG_CONFIG_PATH={prefix}/lib/pkgconfig pkg-config --cflags --libs motionfmu-station",
    )
    output(
        "cc",
        "-O2",
        "-Wall",
        "-Werror",
        "main.c",
        "own.c",
        *flags.split(),
        "-o",
        "own",
        cwd=tmp_path,
    )
    assert output(tmp_path / "own") == "0 3\n"


def test_the_example_of_the_tour_runs() -> None:
    text = (ROOT / "docs/tour.md").read_text()
    code = re.search(r"```python\n(from motionfmu\.virtual\.mcc .*?)```", text, re.S)
    assert code and output(sys.executable, "-c", code[1]).split()[:2] == ["[20000", "5000"]


def test_the_example_of_the_robot_station_runs() -> None:
    text = (ROOT / "src/controllers/robot_station/README.md").read_text()
    code = re.search(r"```python\n(.*?)```", text, re.S)
    assert code
    told, where = output(sys.executable, "-c", code[1]).splitlines()
    assert "joint 1 to 190 deg, limit 180 deg" in told and where == "[1000.0, 100.0, 900.0]"


@pytest.mark.more
def test_a_master_of_ones_own_finds_the_bits_of_a_run(tmp_path: Path) -> None:
    folder = ROOT / "examples/fmpy_loop"
    told = output(sys.executable, folder / "circle.py", FMUS, cwd=tmp_path)
    run = motionfmu.load("circle").run()
    error = run.contour().error.max * 1e3  # [µm]
    assert told == f"feed 100.000 mm/s, largest contour error {error:.1f} µm\n"
    with np.load(tmp_path / "circle.npz") as found:
        assert len(found.files) == 6
        for name, values in found.items():
            own = run[name].reshape(len(run.time), -1).astype(float)
            assert values.tobytes() == own.tobytes(), name
    imported = re.findall(r"^(?:import|from) (\w+)", (folder / "circle.py").read_text(), re.M)
    assert set(imported) - sys.stdlib_module_names == {"fmpy", "numpy"}


@pytest.mark.more
def test_the_script_of_a_student_shows_half_the_backlash(tmp_path: Path) -> None:
    folder = ROOT / "examples/student_backlash"
    rows = output(sys.executable, folder / "backlash.py", cwd=tmp_path).splitlines()[2:]
    gap, largest, rms = np.array([row.split() for row in rows], dtype=float).T
    assert gap.tolist() == [0, 5, 10, 20] and (np.diff(rms) > 0.0).all()
    assert np.diff(largest) / np.diff(gap) == pytest.approx([0.5] * 3, abs=0.02)
    assert (tmp_path / "backlash.png").read_bytes()[:4] == (folder / "backlash.png").read_bytes()[
        :4
    ]
    code = (folder / "backlash.py").read_text().splitlines()
    assert sum(bool(line) for line in code) < 30


@pytest.mark.more
def test_the_digital_twin_repeats_its_record_and_follows_better(tmp_path: Path) -> None:
    folder = ROOT / "examples/digital_twin"
    told = output(sys.executable, folder / "digital_twin.py", cwd=tmp_path)
    shares = dict(re.findall(r"beside the record, ([\w. ]+): ([\d.]+) %", told))
    assert float(shares["following error"]) < 0.25 and float(shares["drives.torque"]) < 3.8
    (mass,) = re.findall(r"table_mass +([\d.]+)", told)
    assert float(mass) + 1e-5 * (2.0 * np.pi / 0.01) ** 2 == pytest.approx(95.1089, rel=0.01)
    before, after = map(float, re.findall(r"nominal plant: RMS ([\d.]+) .* → ([\d.]+)", told)[0])
    assert before == pytest.approx(577.0, rel=0.01) and after < before / 12.0
    kept, count = re.findall(r"^(\d+) of (\d+) plants on the 95 % region", told, re.M)[0]
    assert kept == count
    text = (folder / "README.md").read_text()
    for figure in (f"{before:.0f}", f"{after:.0f} µm RMS", f"of {count} possible ones"):
        assert figure in text
    assert (tmp_path / "digital_twin.png").read_bytes()[:4] == b"\x89PNG"
