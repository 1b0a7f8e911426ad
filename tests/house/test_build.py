"""What the build makes anew when a file changes: what it knows of cores, FMUs and tests."""

import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from conftest import ROOT

from motionfmu.base.errors import InputError
from motionfmu.fmu import cores, for_cmake

NINJA = Path(sys.executable).parent / "ninja"
FMUS = sorted(p.parent.name for p in ROOT.glob("fmus/*/fmu.toml"))
TESTS = sorted(ROOT.glob("tests/core/*/*.c"))
LIBRARY = re.compile(r"lib(\w+)\.a")
FMU_TOML = """
name = "Blinker"
description = "A light"
tick_ns = 25
experiment = { stop = 1.0, step = 1e-3 }
cores = ["upper"]
"""
FILES = {
    "pyproject.toml": '[project]\nversion = "1.2.3"\n',
    "src/base/lower/core.toml": "uses = []\n",
    "src/base/lower/lower.h": "",
    "src/base/upper/core.toml": 'uses = ["lower"]\n',
    "src/base/upper/upper.h": '#include "lower.h"\n',
    "src/base/other/core.toml": "uses = []\n",
    "src/base/other/other.h": "",
    "fmus/blinker/fmu.toml": FMU_TOML,
    "tests/core/rig/rig.h": '#include "upper.h"\n',
    "tests/core/lower/lower_alone.c": '#include "lower.h"\n',
    "tests/core/lower/lower_rigged.c": '# include "../rig/rig.h"\n#include <other.h>\n',
}


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A checkout of three cores, an FMU and two tests."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def lists(tree: Path) -> dict[str, list[str]]:
    rows = re.findall(r"set\((\w+)((?: \"[^\"]*\")*)\)\n", for_cmake.lists(tree))
    return {name: re.findall(r"\"([^\"]*)\"", values) for name, values in rows}


def test_lists_of_a_checkout(tree: Path) -> None:
    found = lists(tree)
    assert found["version"] == ["1.2.3"]
    assert found["cores"] == ["lower", "other", "upper"]
    assert found["core_upper_folder"] == [str(tree / "src/base/upper")]
    assert found["core_upper_uses"] == ["lower"] and found["core_upper_all"] == ["upper", "lower"]
    assert found["fmus"] == ["blinker"] and found["fmu_blinker_identifier"] == ["Blinker"]
    assert found["fmu_blinker_modelica"] == ["OFF"]
    assert found["fmu_blinker_cores"] == ["upper"]
    assert found["fmu_blinker_all_cores"] == ["upper", "lower"]
    assert found["test_lower_alone_cores"] == ["lower"] and found["test_lower_alone_folders"] == []
    assert found["test_lower_rigged_cores"] == ["upper"]
    assert found["test_lower_rigged_all_cores"] == ["upper", "lower"]
    assert found["test_lower_rigged_folders"] == [str(tree / "tests/core/rig")]
    read = {Path(name).relative_to(tree) for name in found["read_files"] if str(tree) in name}
    assert read == {Path(name) for name in FILES} - {
        Path(f"src/base/{n}/{n}.h") for n in ("lower", "upper", "other")
    }


def test_a_new_core_changes_no_list_of_another_one(tree: Path) -> None:
    before = lists(tree)
    for name in ("core.toml", "twice.h"):
        (tree / "src/base/twice" / name).parent.mkdir(exist_ok=True)
        (tree / "src/base/twice" / name).write_text("uses = []\n" if name == "core.toml" else "")
    after = lists(tree)
    changed = {name for name in {*before, *after} if before.get(name) != after.get(name)}
    assert changed == {
        "cores",
        "read_files",
        *(f"core_twice_{k}" for k in ("folder", "uses", "all")),
    }


def test_a_wrong_fmu_toml_ends_the_configuration(tree: Path) -> None:
    (tree / "fmus/blinker/fmu.toml").write_text(FMU_TOML.replace("Blinker", "blinker"))
    with pytest.raises(InputError, match=r"fmu\.toml:2: name 'blinker' is not CamelCase"):
        for_cmake.lists(tree)


@cache
def own_lists() -> dict[str, list[str]]:
    return lists(ROOT)


@cache
def inputs() -> dict[str, set[str]]:
    """What steps of the build wait for, by what they make: paths in the checkout or in build/."""
    targets = [f"gen/{name}/vars.h" for name in FMUS]
    targets += [f"test_{file.stem}" for file in TESTS]
    line = [NINJA, "-C", ROOT / "build", "-t", "query", *targets]
    found, told = {}, subprocess.run(line, capture_output=True, text=True, check=True).stdout
    for text in re.split(r"^(?=\S)", told, flags=re.MULTILINE)[1:]:
        names = re.findall(
            r"^    (?:\| )?([^| ]\S*)$", text.split("\n  outputs:\n")[0], re.MULTILINE
        )
        found[text.partition(":\n")[0]] = {name.removeprefix(f"{ROOT}/") for name in names}
    assert found.keys() == set(targets) and all(found.values())
    return found


@pytest.mark.parametrize("name", FMUS)
def test_an_fmu_is_generated_anew_only_with_its_own_files(name: str) -> None:
    """The list of its C files is written when any core changes, but is another with its own."""
    used = own_lists()[f"fmu_{name}_all_cores"]
    folders = {str(f.relative_to(ROOT)): n for n, f in cores.folders(ROOT / "src").items()}
    described = inputs()[f"gen/{name}/vars.h"]
    for file in map(Path, described):
        assert file.parts[0] not in ("fmus", "gen") or file.parts[1] == name
        assert folders.get(str(file.parent)) in (None, *used)
    assert {f"fmus/{name}/fmu.toml", f"gen/{name}/core_files.txt"} <= described
    modelica = any(file.endswith(".mo") for file in described)
    assert own_lists()[f"fmu_{name}_modelica"] == ["ON" if modelica else "OFF"]


def test_a_c_test_is_linked_with_what_it_includes() -> None:
    libraries = {
        file.stem: {m[1] for n in inputs()[f"test_{file.stem}"] if (m := LIBRARY.fullmatch(n))}
        for file in TESTS
    }
    wanted = {file.stem: set(own_lists()[f"test_{file.stem}_all_cores"]) for file in TESTS}
    assert libraries == wanted
    assert libraries["analyser_edges"] == {"analyser"}
