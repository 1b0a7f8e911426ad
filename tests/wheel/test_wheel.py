"""The wheel in an environment outside the tree that has the packages of the base and no others.

And in new environments of each Python that there is, with what the registry has for it.
"""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import wheel_making
from conftest import ROOT
from installed_wheel import Installed

import motionfmu

EXPORTED = sorted(ROOT.glob("build/export/lib/*/motionfmu_stations.so"))


@pytest.fixture(scope="module")
def installed(wheel_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    return Installed(tmp_path_factory.mktemp("wheel"), wheel_file)


pytestmark = [pytest.mark.more, pytest.mark.xdist_group("wheel")]


def test_the_base_is_small(installed: Installed) -> None:
    # 206 MB in November 2026, CMake, for FMPy, 76 of them; newer releases may grow by a twentieth.
    # Byte code would be 32 MB more, FMUs of all platforms 12.
    assert 120.0 < sum(installed.others.values()) < 217.0
    # Ours: 38.9 MB, most of it FMUs and the parts of fused programs, 2.6 of them level_arm, a plant
    # of its own so that other arms are a quarter quicker; 3.5 are the sources that `new sources`
    # lays out. A twentieth may be added.
    assert 10.0 < installed.own < 40.8
    assert installed.others.keys() >= {"fmpy", "numpy", "pydantic"}
    assert not installed.others.keys() & {"scipy", "matplotlib", "casadi", "plotly"}


def test_the_demo_runs_from_an_empty_folder(installed: Installed) -> None:
    before = {p: p.stat().st_mtime_ns for p in installed.site.glob("motionfmu/**/*")}
    done = installed.run("motionfmu", "run", "circle")
    assert done.returncode == 0, done.stderr
    assert "circle: all 14 checks hold\n" in done.stdout and "warning" not in done.stdout
    assert [p.name for p in installed.empty.iterdir()] == ["results"]
    folder = installed.empty / "results/circle"
    assert "Plotly" in (folder / "report.html").read_text()
    assert '"engine": "fused"' in (folder / "result.json").read_text()
    here = motionfmu.load("circle").run()
    for name, values in here.signals.items():
        assert np.load(folder / f"signals/{name}.npy").tobytes() == values.tobytes()
    after = {p: p.stat().st_mtime_ns for p in installed.site.glob("motionfmu/**/*")}
    new = {p for p in after.keys() - before.keys() if "__pycache__" not in p.parts}
    assert not new and {p.name for p in before if before[p] != after[p]} <= {"__pycache__"} | {
        p.parent.name for p in after.keys() - before.keys()
    }


def test_without_a_compiler_the_container_runs_and_says_so_once(installed: Installed) -> None:
    line = ("motionfmu", "run", "circle", "--stop", "0.1", "--out", "slow")
    done = installed.run(*line, PATH="/nowhere", CC="")
    assert done.returncode in (0, 1), done.stderr
    assert done.stdout.count("there is no C compiler") == 1
    assert (installed.empty / "slow/report.html").is_file()


def test_fmpy_runs_the_demo(installed: Installed) -> None:
    line = ("motionfmu", "run", "circle", "--stop", "0.1", "--out", "by_fmpy", "--engine", "fmpy")
    done = installed.run(*line)
    assert done.returncode in (0, 1), done.stderr
    assert '"engine": "fmpy"' in (installed.empty / "by_fmpy/result.json").read_text()


def test_what_else_the_base_does(installed: Installed) -> None:
    known = installed.run("motionfmu", "examples").stdout
    assert "circle " in known and "student_backlash" in known
    done = installed.run("motionfmu", "examples", "--copy", "schedule", "copies")
    assert done.returncode == 0 and (installed.empty / "copies/schedule/wave.ngc").is_file()
    code = (
        "import motionfmu.virtual.mcc as m; c = m.VirtualCard(feed=1200, p_gain=200); "
        "c.mcc.line([1, 0, 0, 0, 0, 0]); print(c.run_until_stop().pulses[0])"
    )
    assert installed.run("python", "-c", code).stdout == "1000\n"
    told = installed.run("motionfmu", "tune", "circle")
    assert told.returncode == 2 and told.stderr.endswith(f'pip install "{installed.file}[tune]"\n')
    code = "import motionfmu.study.tune"
    assert '.whl[tune]"' in installed.run("python", "-c", code).stderr.splitlines()[-1]
    made = installed.run("motionfmu", "export", "circle", "--ssp")
    assert made.returncode == 0 and (installed.empty / "circle.ssp").is_file()


def test_a_users_type_checker_sees_the_types(installed: Installed) -> None:
    """mypy reads the installed package, not this checkout, and holds a user's script against it."""
    (installed.empty / "user.py").write_text(
        "import motionfmu\n"
        "from motionfmu.virtual.mcc import VirtualCard\n"
        "result = motionfmu.load('circle').run()\n"
        "reveal_type(result.ok)\n"
        "reveal_type(VirtualCard().mcc)\n"
        "reveal_type(motionfmu.__version__)\n"
        "result.contuor()\n"
    )
    line = [sys.executable, "-m", "mypy", "--strict", "--python-executable", "../env/bin/python"]
    told = subprocess.run(
        [*line, "--cache-dir", "../mypy", "user.py"],
        cwd=installed.empty,
        env=installed.environ,
        capture_output=True,
        text=True,
    ).stdout.splitlines()
    assert told[:3] == [
        'user.py:4: note: Revealed type is "bool"',
        'user.py:5: note: Revealed type is "motionfmu.virtual.mcc.state.Mcc"',
        'user.py:6: note: Revealed type is "str"',
    ]
    assert told[3].startswith('user.py:7: error: "Result" has no attribute "contuor"')
    assert told[4:] == ["Found 1 error in 1 file (checked 1 source file)"]


@pytest.mark.long  # packages come from the registry
@pytest.mark.parametrize("version", ["3.11", "3.12", "3.13", "3.14"])
def test_each_python_installs_and_runs_it(installed: Installed, tmp_path: Path, version) -> None:
    """With the packages that pip chooses for that Python, the demo has the bits of a run here."""
    found = wheel_making.python(version)
    if found is None:
        pytest.skip(f"there is no Python {version}")
    bin_ = wheel_making.environment(tmp_path / "env", found).parent
    wheel_making.output(*wheel_making.PIP, "--python", bin_ / "python", "install", installed.file)
    env = installed.environ | {"HOME": str(tmp_path)}

    def run(*line: str) -> str:
        done = subprocess.run(
            [bin_ / line[0], *line[1:]], cwd=tmp_path, env=env, capture_output=True, text=True
        )
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout

    assert run("python", "--version").startswith(f"Python {version}.")
    assert run("motionfmu", "--version") == f"motionfmu {motionfmu.__version__}\n"
    told = run("motionfmu", "run", "circle")
    assert "circle: all 14 checks hold\n" in told and "warning" not in told
    here = motionfmu.load("circle").run()
    for name, values in here.signals.items():
        there = np.load(tmp_path / f"results/circle/signals/{name}.npy")
        assert there.tobytes() == values.tobytes(), name
    code = "import motionfmu.virtual.mcc as m; print(m.VirtualCard(feed=1200).read().clock)"
    assert run("python", "-c", code) == "0\n"


def test_the_classifiers_name_the_pythons_that_are_tried() -> None:
    marks = test_each_python_installs_and_runs_it.pytestmark
    (mark,) = [m for m in marks if m.name == "parametrize"]
    row = r'^  "Programming Language :: Python :: (3\.\d+)",$'
    listed = re.findall(row, (ROOT / "pyproject.toml").read_text(), re.MULTILINE)
    assert listed and {*listed} <= {*mark.args[1]}


def shown(library: Path) -> tuple[set[str], set[str]]:
    """Names that a library shows, but what a processor chooses; versions of glibc it asks for."""
    line = ["readelf", "-W", "--dyn-syms", "-V", library]
    told = subprocess.run(line, capture_output=True, text=True, check=True).stdout
    rows = [row.split() for row in told.splitlines()]
    names = {r[7] for r in rows if len(r) == 8 and r[4] == "GLOBAL" and r[6].isdecimal()}
    names = {name for name in names if not name.endswith(("_avx2", "_each"))}
    return names, set(re.findall(r"GLIBC_([\d.]+)", told))


@pytest.mark.skipif(not EXPORTED, reason="make export has not run")
@pytest.mark.parametrize("library", EXPORTED, ids=lambda p: p.parent.name)
def test_the_library_of_each_platform_is_that_of_the_build(library: Path) -> None:
    names, versions = shown(library)
    assert names == shown(ROOT / "build/lib/motionfmu_stations.so")[0]
    assert len(names) > 1000 and {"binding_log", "binding_fields"} <= names
    assert max(tuple(map(int, v.split("."))) for v in versions) <= (2, 17)
