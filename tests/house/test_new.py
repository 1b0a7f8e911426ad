"""What `motionfmu new` makes works as it stands, and is what CONTRIBUTING.md shows."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import fmpy
import pytest
from conftest import FMUS, ROOT
from console import within

from motionfmu.base.platforms import here
from motionfmu.cli.new import TEMPLATES, rendered
from motionfmu.fmu import pack
from motionfmu.run import suite

NAME = "lag_filter"


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project's folder in which both commands were given."""
    folder = tmp_path_factory.mktemp("project")
    for place in ("fmus", "scenarios", "tests/fmi", "src/fmi"):
        (folder / place).mkdir(parents=True)
    (folder / "src/fmi/fmi_model.h").touch()
    made = within("new", "fmu", NAME, folder=folder)
    assert made.returncode == 0, made.stderr
    assert within("new", "scenario", "lag_axis", folder=folder).returncode == 0
    return folder


@pytest.mark.more
def test_a_new_fmu_builds_and_passes_what_every_fmu_must(project: Path) -> None:
    source, gen, built = project / "fmus" / NAME, project / "gen", project / "built"
    built.mkdir()
    pack.generate(source, gen)
    headers = Path(fmpy.__file__).parent / "c-code"
    part = built / "part.o"  # compiled as the build does
    line = "gcc -std=c11 -Wall -Wextra -Wpedantic -Werror -fPIC -fvisibility=hidden"
    line += " -ffp-contract=off -r -nostdlib"
    cores = pack.compiled_sources(source, gen)
    folders = (gen, source, ROOT / "src/fmi", ROOT / "src/base/elementary")
    places = [f"-I{p}" for p in folders]
    subprocess.run([*line.split(), *places, gen / pack.PART_UNIT, *cores, "-o", part], check=True)
    subprocess.run(["objcopy", "--localize-hidden", part], check=True)
    for fmi in (2, 3):
        library = built / f"{NAME}{fmi}.so"
        line = "gcc -std=c11 -Wall -Wextra -Wpedantic -Werror -fPIC -fvisibility=hidden -shared"
        places = [f"-I{p}" for p in (*folders, headers)]
        units = [gen / f"fmi{fmi}/fmu_main.c", *cores]
        subprocess.run(
            [*line.split(), *places, *units, "-ffp-contract=off", "-o", library, "-lm"], check=True
        )
        pack.archive(
            source,
            gen,
            fmi,
            pack.CompilerOutput({here(): library}, part),
            built / f"{NAME}.fmi{fmi}.fmu",
        )
    for fmu in FMUS.glob("scope.*"):
        shutil.copy(fmu, built)
    test = ROOT / "tests/fmi" / f"test_{NAME}.py"
    # Not those that compile it again from the sources within, nor what reads the build's library,
    # or its folder in this tree.
    others = "sources or fmutool or carries_little or page_tells"
    chosen = ["-m", "not long", "-k", f"{NAME} and not ({others})"]
    line = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *chosen]
    kinds = ("errors", "extremes", "runs", "shown", "states", "descriptions")
    files = [ROOT / f"tests/fmi/test_fmi_{kind}.py" for kind in kinds]
    files.append(project / "tests/fmi" / test.name)
    own = {"MOTIONFMU_FMUS": str(built), "PYTHONPATH": str(ROOT / "tests")}
    done = subprocess.run(
        [*line, f"--rootdir={ROOT}", "-c", ROOT / "pyproject.toml", *files],
        capture_output=True, text=True, cwd=ROOT, env=os.environ | own,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-3000:]
    passed = re.search(r"(\d+) passed", done.stdout)
    assert passed and int(passed[1]) >= 35 and "failed" not in done.stdout


def test_a_new_scenario_holds_and_fails_where_it_must(project: Path) -> None:
    folder = project / "scenarios/lag_axis"
    assert (folder / "README.md").read_text().startswith("# lag_axis\n")
    ways = [suite.SuiteWays(contraries=off) for off in (False, True)]
    cases = [case for way in ways for case in suite.judged(folder, {}, way)]
    assert len(cases) == 3 and all(case.ok for case in cases), cases
    assert all(case.off for case in cases[1:])


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (f"fmu {NAME}", f"fmus/{NAME} is there already"),
        ("scenario lag_axis", "scenarios/lag_axis is there already"),
        ("fmu 2nd", "NAME '2nd': small letters and digits"),
        ("fmu a-b", "NAME 'a-b': small letters"),
        ("scenario ../x", "NAME '../x': small letters"),
        ("machine ../x --like gantry", "NAME '../x': small letters"),
    ],
)
def test_a_name_that_is_taken_or_wrong_is_refused(project: Path, line: str, told: str) -> None:
    before = sorted(project.rglob("*"))
    refused = within("new", *line.split(), folder=project)
    assert refused.returncode == 2 and refused.stderr.startswith(f"motionfmu: {told}")
    assert sorted(project.rglob("*")) == before


def test_an_fmu_is_made_in_the_project_only_and_whole_or_not(tmp_path: Path) -> None:
    assert "src/fmi/ here" in within("new", "fmu", NAME, folder=tmp_path).stderr
    for place in ("fmus", "src/fmi"):
        (tmp_path / place).mkdir(parents=True)
    (tmp_path / "src/fmi/fmi_model.h").touch()
    refused = within("new", "fmu", NAME, folder=tmp_path)  # no tests/fmi
    assert refused.stderr == f"motionfmu: cannot write fmus/{NAME}: No such file or directory\n"
    assert list((tmp_path / "fmus").iterdir()) == []


def test_contributing_shows_the_template_and_every_key() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text()
    for file in ("fmu.toml", "model.c"):
        assert rendered(TEMPLATES / "fmu" / file, NAME) in text
    from motionfmu.fmu import describe, fmu_toml

    rows = re.findall(r"^\| (`[^|]*) \|", text, re.M)
    shown = {key for row in rows for key in re.findall(r"`(\w+)`", row)}
    assert shown >= fmu_toml.HEAD | fmu_toml.MAY | describe._KEYS | set(describe.CAUSALITIES)


def test_new_sources_are_a_tree_of_their_own_that_can_be_built(tmp_path: Path) -> None:
    made = within("new", "sources", "mine", folder=tmp_path)
    assert made.stdout.startswith(
        "mine: cores in src, FMUs in fmus and modelica\nnext: cmake -S mine"
    )
    tree = tmp_path / "mine"
    for place in ("src/base", "src/fmi", "src/motion", "fmus", "modelica", "src/motionfmu/fmu"):
        kept = {f.relative_to(ROOT) for f in (ROOT / place).rglob("*") if f.is_file()}
        kept = {f for f in kept if "__pycache__" not in f.parts and f.suffix != ".png"}
        assert kept == {f.relative_to(tree) for f in (tree / place).rglob("*") if f.is_file()}
        assert all((tree / f).read_bytes() == (ROOT / f).read_bytes() for f in kept)
    line = [sys.executable, tree / "src/pack.py", "cmake"]
    lists = subprocess.run(line, capture_output=True, text=True, check=True).stdout
    assert str(tree / "src/base/pulse") in lists and str(ROOT) not in lists
    assert within("new", "fmu", NAME, folder=tree).stderr.endswith("No such file or directory\n")
    refused = within("new", "sources", "mine", folder=tmp_path)
    assert refused.stderr == "motionfmu: mine is there already\n"
    assert [p.name for p in tmp_path.iterdir()] == ["mine"]
