"""`make wheel`: the wheel, installed from its file into a new environment and tried there.

python tests/helpers/wheel_making.py build/export build/wheel
"""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PIP = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
# [MB] that the base may have installed: 285 in November 2026, and a twentieth. 76 are CMake, for
# FMPy, 58 ours with FMUs for all platforms.
BASE_MAX = 299.0
MEGA = 1e6


def output(*line: str | Path, cwd: Path = ROOT, **more: str) -> str:
    """What a command prints; one that fails ends everything with what it told."""
    done = subprocess.run(
        [str(x) for x in line], cwd=cwd, capture_output=True, text=True, env=_plain() | more
    )
    if done.returncode:
        raise SystemExit(
            f"{' '.join(map(str, line))}: {done.returncode}\n{done.stdout}{done.stderr}"
        )
    return done.stdout


def _plain() -> dict[str, str]:
    """This environment without what leads to the checkout."""
    own = ("MOTIONFMU_FMUS", "PYTHONPATH", "PYTHONDONTWRITEBYTECODE")
    return {k: v for k, v in os.environ.items() if k not in own}


def source(folder: Path) -> Path:
    """The source distribution, unpacked."""
    backend = "from scikit_build_core.build import build_sdist; print(build_sdist({!r}))"
    name = output(sys.executable, "-c", backend.format(str(folder))).split()[-1]
    output("tar", "-xzf", folder / name, "-C", folder)
    return folder / name.removesuffix(".tar.gz")


def tags(packed: Path) -> str:
    """Tags of a wheel of a build for all platforms; empty for one of this machine alone."""
    found = sorted(file.parent.name for file in packed.glob("lib/*/motionfmu_stations.so"))
    machines = [f"manylinux_2_17_{name.removesuffix('-linux')}" for name in found]
    return f"py3-none-{'.'.join(machines)}" if machines else ""


def build(tree: Path, packed: Path, folder: Path) -> Path:
    """Make the wheel of a source tree with the FMUs and libraries of a build."""
    given = ["-C", f"cmake.define.MOTIONFMU_PACKED={packed.resolve()}"]
    if named := tags(packed):
        given += ["-C", f"wheel.tags={named}"]
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.whl"):
        old.unlink()
    output(*PIP, "wheel", "--no-deps", "--no-build-isolation", *given, "-w", folder, tree)
    (made,) = folder.glob("*.whl")
    return made


def environment(folder: Path, python: str = sys.executable) -> Path:
    """A new environment without pip, of this Python or another; its Python."""
    output(python, "-m", "venv", "--without-pip", "--symlinks", folder)
    return folder / "bin/python"


def python(version: str) -> str | None:
    """The Python 3.x of this machine, on PATH or in pyenv's folder; None if there is none."""
    pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv")
    name = f"python{version}"
    places = [shutil.which(name), *pyenv.glob(f"versions/{version}.*/bin/{name}")]
    for place in map(str, filter(None, places)):
        done = subprocess.run([place, "-c", "import venv"], capture_output=True)
        if done.returncode == 0:
            return place
    return None


def site(python: Path) -> Path:
    """Where an environment's packages are."""
    return Path(output(python, "-c", "import sysconfig as s; print(s.get_path('purelib'))").strip())


def sizes(folder: Path) -> dict[str, float]:
    """Sizes of what stands in a folder, the largest first [MB]."""
    return dict(sorted(_sizes(folder.iterdir()), key=lambda row: -row[1]))


def _sizes(places: Iterable[Path]) -> Iterable[tuple[str, float]]:
    for place in places:
        files = place.rglob("*") if place.is_dir() else [place]
        yield place.name, sum(f.stat().st_size for f in files if f.is_file()) / MEGA


def main(packed: str, folder: str) -> None:
    """Build, install from the registry, run the demo in an empty folder, print sizes."""
    made = build(ROOT, Path(packed), Path(folder))
    print(f"{made}: {made.stat().st_size / MEGA:.1f} MB", flush=True)
    with tempfile.TemporaryDirectory(prefix="motionfmu-") as name:
        place = Path(name)
        python = environment(place / "new")
        output(*PIP, "--python", python, "install", made)
        found = sizes(site(python))
        for package, size in list(found.items())[:8]:
            print(f"{size:8.1f} MB  {package}")
        print(f"{sum(found.values()):8.1f} MB  installed, at most {BASE_MAX:g}")
        empty = place / "empty"
        empty.mkdir()
        told = output(python.parent / "motionfmu", "run", "circle", cwd=empty, HOME=str(place))
        report = empty / "results/circle/report.html"
        card = "from motionfmu.virtual.mcc import VirtualCard; print(VirtualCard().read().clock)"
        output(python, "-c", card, cwd=empty)
        print(*told.splitlines()[-2:-1], f"report: {report.stat().st_size / MEGA:.1f} MB", sep="\n")
    if sum(found.values()) > BASE_MAX:
        raise SystemExit("the base is too large")


if __name__ == "__main__":
    main(*sys.argv[1:])
