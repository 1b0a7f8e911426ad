"""The C cores: who uses whom. `python tests/house/test_cores.py` draws it."""

import graphlib
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "src"))

from motionfmu.fmu import cores, pack  # noqa: E402

SOURCE = ROOT / "src"
FOLDERS = cores.folders(SOURCE)
CORES = sorted(FOLDERS)
USES = {core: set(cores.uses(FOLDERS[core])) for core in CORES}
STOREYS = {f.parent.name: cores.stands_on(f.parent) for f in SOURCE.glob("*/storey.toml")}
# Storeys that serve any controller, and what their cores may not even mention.
SHARED = [core for core in CORES if FOLDERS[core].parent.name in ("base", "motion", "language")]
WORDS = re.compile(r"(?<![a-z])(mcc|mccl|epcio|msp430|fmi|fmu)(?![a-z])", re.IGNORECASE)
# What a core would have that knows of saved states: functions that judge one or tell what needs no
# copy, and the words for it.
SAVED = re.compile(
    r"\w_(unused|damaged?|sound)\((const )?struct|\bspans_\w+\(|struct spans?\b|\bspans\.h"
    r"|_(unused|damaged?)\.[ch]|saved state|serializ|snapshot|_IN_USE\b",
    re.IGNORECASE,
)
Graph = dict[str, set[str]]


def files(core: str) -> list[Path]:
    return [*FOLDERS[core].glob("*.[ch]")]


def core_of() -> dict[str, str]:
    """The core of each header."""
    return {f.name: core for core in CORES for f in files(core) if f.suffix == ".h"}


def included(core: str) -> set[str]:
    """The cores whose headers the files of a core include; a header of none by its own name."""
    found = {core_of().get(name, name) for f in files(core) for name in cores.included(f)}
    return found - {core}


def circle(graph: Graph) -> list[str]:
    """What uses each other in turn; empty if nothing does."""
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        return list(error.args[1])
    return []


def drawing(uses: Graph) -> str:
    """Each core above all that it uses, with its arrows."""
    level: dict[str, int] = {}
    for core in graphlib.TopologicalSorter(uses).static_order():
        level[core] = 1 + max((level[u] for u in uses[core]), default=-1)
    rows = sorted(uses, key=lambda core: (-level[core], core))
    width = max(map(len, rows))
    return "\n".join(
        f"{level[c]}  {c:<{width}}{' -> ' + ' '.join(sorted(uses[c])) if uses[c] else ''}".rstrip()
        for c in rows
    )


def test_no_cores_use_each_other_in_a_circle() -> None:
    assert circle(USES) == []


def test_a_circle_is_found() -> None:
    assert set(circle({"a": {"b"}, "b": {"c"}, "c": {"a"}})) == {"a", "b", "c"}


def test_no_files_include_each_other_in_a_circle() -> None:
    headers = {f.name: set(cores.included(f)) for c in CORES for f in files(c) if f.suffix == ".h"}
    assert circle(headers) == []


@pytest.mark.parametrize("core", CORES)
def test_a_core_uses_what_it_includes_and_nothing_else(core: str) -> None:
    assert included(core) == USES[core]


@pytest.mark.parametrize("core", CORES)
def test_a_core_uses_its_own_storey_and_those_below(core: str) -> None:
    own = FOLDERS[core].parent.name
    below = {used: FOLDERS[used].parent.name for used in USES[core]}
    assert {u: s for u, s in below.items() if s != own and s not in STOREYS[own]} == {}


def test_storeys_stand_on_each_other_in_no_circle() -> None:
    assert circle({name: set(on) for name, on in STOREYS.items()}) == []
    assert {f.parent.name for f in FOLDERS.values()} == STOREYS.keys()


@pytest.mark.parametrize("core", SHARED)
def test_a_shared_core_knows_no_controller(core: str) -> None:
    told = [
        f"{f.relative_to(ROOT)}:{n}: {line}"
        for f in sorted(FOLDERS[core].glob("*"))
        for n, line in enumerate(f.read_text().splitlines(), 1)
        if WORDS.search(line)
    ]
    assert told == []


def test_a_word_of_a_controller_is_found() -> None:
    assert all(WORDS.search(t) for t in ("the MCC library", "epcio_step", "an FMU", "FMI 3"))
    assert not WORDS.search("fmin(l.acc, l.dec)")


def test_no_core_knows_of_saved_states() -> None:
    told = [
        f"{f.relative_to(ROOT)}:{n}: {line}"
        for core in CORES
        for f in sorted(FOLDERS[core].glob("*"))
        for n, line in enumerate([f.name, *f.read_text().splitlines()])
        if SAVED.search(line)
    ]
    assert told == []


@pytest.mark.parametrize(
    "line",
    [
        "bool trajectory_damaged(const struct trajectory *p, const struct ring *r);",
        "bool dda_sound(const struct dda *d, int32_t channels)",
        "void queue_unused(const struct queue *q, struct spans *s);",
        "const char *pc_damage(const struct pc *pc)",
        "    spans_ring(s, q->item, sizeof q->item[0], QUEUE_SIZE, q->head, q->count);",
        "mcc_damage.c",
        "/* Parts of a saved state that need no copy. */",
    ],
)
def test_what_a_core_had_for_saved_states_is_found(line: str) -> None:
    assert SAVED.search(line)


@pytest.mark.parametrize("core", CORES)
def test_a_core_stands_alone(core: str, tmp_path: Path) -> None:
    """With what it uses it is a library without a gap; headers by themselves: see below."""
    names = cores.closure(SOURCE, [core])
    whole = ["-Wl,--whole-archive", *[ROOT / f"build/lib{n}.a" for n in names]]
    link = ["-shared", "-Wl,--no-undefined", *whole, "-Wl,--no-whole-archive", "-lm"]
    subprocess.run(["cc", *link, "-o", tmp_path / "core.so"], check=True)


def warnings(text: str, standard: str, headers: Path, folder: Path) -> list[str]:
    """What g++ has against a C++ text."""
    (folder / "text.cpp").write_text(text)
    return told(["g++", f"-std={standard}"], [folder / "text.cpp"], headers)


def told(compiler: list[str], files: list[Path], headers: Path) -> list[str]:
    """Warnings and errors of a compiler about files, each by itself."""
    line = [*compiler, "-Wall", "-Wextra", "-Wpedantic", "-fsyntax-only", "-I", headers, *files]
    found = subprocess.run(line, capture_output=True, text=True).stderr.splitlines()
    return [t for t in found if re.search("warning|error", t)]


@pytest.mark.more
def test_installed_headers_are_cxx(tmp_path: Path) -> None:
    """All of them in two orders, and each alone in C and in C++, without a warning."""
    if not shutil.which("g++"):
        pytest.skip("no g++ here")
    pack.headers(SOURCE, tmp_path / "motionfmu")
    names = [f.name for core in CORES for f in files(core) if f.suffix == ".h"]
    names = sorted([*names, "short_names.h"])
    assert names == sorted(f.name for f in (tmp_path / "motionfmu").iterdir())
    lines = [f"#include <motionfmu/{name}>\n" for name in names]
    assert warnings("".join(lines), "c++17", tmp_path, tmp_path) == []
    assert warnings("".join(reversed(lines)), "c++20", tmp_path, tmp_path) == []
    each = sorted((tmp_path / "motionfmu").iterdir())
    assert told(["cc", "-std=c11", "-x", "c"], each, tmp_path) == []
    assert told(["g++", "-std=c++17", "-x", "c++"], each, tmp_path) == []
    literal = "struct s { int a; };\ninline s f() { return (s){ .a = 1 }; }\n"
    assert len(warnings(literal, "c++17", tmp_path, tmp_path)) == 2


def test_a_header_that_cannot_be_installed_is_told(tmp_path: Path) -> None:
    header = tmp_path / "a.h"
    header.write_text('#ifndef A_H\n#define A_H\nint a(void);\n#include "b.h"\n\n#endif\n')
    with pytest.raises(ValueError, match=r"a\.h: a declaration stands before the last #include"):
        cores.cxx(header)
    header.write_text("#pragma once\nint a(void);\n")
    with pytest.raises(ValueError, match=r"a\.h: no guard around the whole file"):
        cores.cxx(header)


def test_a_file_without_a_header_belongs_to_the_first_that_it_includes(tmp_path: Path) -> None:
    core = tmp_path / "base/one"
    core.mkdir(parents=True)
    (core / "core.toml").write_text("uses = []\n")
    for name in ("a.h", "b.h"):
        (core / name).write_text("")
    (core / "more.c").write_text('#include "a.h"\n#include "b.h"\n')
    for name, files in {"a.h": ["a.h", "b.h", "more.c"], "b.h": ["b.h"]}.items():
        root = tmp_path / "model.c"
        root.write_text(f'#include "{name}"\n')
        assert [f.name for f in cores.needed(tmp_path, ["one"], [root])] == files


def test_nine_cores_or_more_serve_any_controller() -> None:
    assert len(SHARED) >= 9 and {"elementary", "path", "trajectory", "tasks"} <= set(SHARED)
    assert not {"mcc", "epcio", "robot_controller", "netcard"} & set(SHARED)


def test_a_drawing_has_each_core_above_all_that_it_uses() -> None:
    rows = drawing({"a": {"b", "c"}, "b": {"c"}, "c": set(), "long": set()}).splitlines()
    assert rows == ["2  a    -> b c", "1  b    -> c", "0  c", "0  long"]
    drawn = [row.split() for row in drawing(USES).splitlines()]
    level = {core: int(n) for n, core, *_ in drawn}
    assert set(level) == set(CORES) and len(drawn) == len(CORES)
    for n, core, *arrows in drawn:
        assert set(arrows) - {"->"} == USES[core]
        assert int(n) == 1 + max((level[used] for used in USES[core]), default=-1)


@pytest.mark.parametrize("line", ['uses = []\nusse = ["path"]', 'uses = "path"', ""])
def test_what_a_core_says_is_known(tmp_path: Path, line: str) -> None:
    (tmp_path / "core.toml").write_text(line)
    with pytest.raises(ValueError, match=r"core\.toml: .* wanted"):
        cores.uses(tmp_path)


if __name__ == "__main__":
    print(drawing(USES))
