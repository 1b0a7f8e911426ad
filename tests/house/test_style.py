"""How the project reads: docstrings, names, purity of the cores."""

import ast
import importlib
import re
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT

from motionfmu.fmu import cores

PYTHON = sorted(ROOT.glob("src/motionfmu/**/*.py"))
LIBRARIES = sorted((ROOT / "build").glob("lib*.a"))
BUILT = [
    *sorted((ROOT / "build/lib").glob("*_fmi[23].so")),
    *sorted((ROOT / "build/lib").glob("motionfmu_stations.so")),
    *sorted((ROOT / "build/parts").glob("*.o")),
]
# What a core may take from outside: mathematics that IEEE 754 fixes to the bit, and the copies the
# compiler makes by itself. All other mathematics is in elementary, the same bits everywhere.
ALLOWED = set(
    "ceil copysign fabs floor fmod ilogb ldexp llround lround modf rint round sqrt trunc"
    " memcpy memset memcmp memmove strchr _GLOBAL_OFFSET_TABLE_".split()
)


def exported() -> dict[str, set[str]]:
    """What a user imports, by its module: the names in __all__ of the package and its folders."""
    found: dict[str, set[str]] = {}
    for file in ROOT.glob("src/motionfmu/**/__init__.py"):
        tree = ast.parse(file.read_text())
        for node in tree.body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
                names = set(ast.literal_eval(node.value))
                for source in ast.walk(tree):
                    if isinstance(source, ast.ImportFrom):
                        of = found.setdefault(str(source.module), set())
                        of |= names & {a.name for a in source.names}
    return found


EXPORTED = exported()
# A line under the title of a section: Parameters, Returns, Raises, Attributes, ...
SECTION = re.compile(r"^-{3,}$", re.MULTILINE)


def public_definitions(tree: ast.Module) -> list[ast.FunctionDef | ast.ClassDef]:
    found = []
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            if any(".command" in ast.unparse(d) for d in node.decorator_list):
                continue  # a console command describes its options to the user who asks for help
            found.append(node)
            if isinstance(node, ast.ClassDef):
                found += [
                    m
                    for m in node.body
                    if isinstance(m, ast.FunctionDef) and not m.name.startswith("_")
                ]
    return found


def complaints(text: str, exported: set[str]) -> list[str]:
    """What is wrong with the docstrings and signatures of one module."""
    tree, found = ast.parse(text), []
    classes = [n for n in tree.body if isinstance(n, ast.ClassDef) and n.name in exported]
    full = {n for n in tree.body if getattr(n, "name", "") in exported}
    full |= {m for c in classes for m in c.body if not getattr(m, "name", "_").startswith("_")}
    if not ast.get_docstring(tree):
        found.append("module without docstring")
    for node in public_definitions(tree):
        doc = ast.get_docstring(node) or ""
        first = doc.split("\n" if node in full else "\n\n", 1)[0]
        if not first.endswith(".") or (len(first) > 64 if node in full else first.count("\n") > 2):
            found.append(f"{node.name}: summary {first!r}")
        if isinstance(node, ast.FunctionDef):
            arguments = [a.arg for a in node.args.args if a.arg not in ("self", "cls")]
            options = [a.arg for a in node.args.kwonlyargs]  # a user calls them by name
            counted = arguments if node in full else arguments + options
            if len(counted) > 5:
                found.append(f"{node.name}: {len(counted)} arguments")
            arguments += options
            if node not in full:
                continue
            if len(arguments) > 0 and "Parameters\n----------" not in doc:
                found.append(f"{node.name}: parameters not described")
            missing = [a for a in arguments if not re.search(rf"^[^\n]*\b{a}\b[^\n]*:", doc, re.M)]
            found += [f"{node.name}: parameter {a} not described" for a in missing]
    found += [
        f"{node.name}: sections, but no user imports it"
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and node not in full
        if SECTION.search(ast.get_docstring(node) or "")
    ]
    found += [
        "import *"
        for n in ast.walk(tree)
        if isinstance(n, ast.ImportFrom) and any(a.name == "*" for a in n.names)
    ]
    return found


@pytest.mark.parametrize("file", PYTHON, ids=lambda f: str(f.relative_to(ROOT / "src")))
def test_public_python_is_described(file: Path) -> None:
    module = ".".join(file.relative_to(ROOT / "src").with_suffix("").parts)
    assert complaints(file.read_text(), EXPORTED.get(module, set())) == []


def test_the_description_check_can_fail() -> None:
    bad = '"""M."""\nfrom a import *\ndef f(a, b, c, d, e, g):\n    """Do it"""\n'
    assert len(complaints(bad, {"f"})) == 10
    assert len(complaints(bad, set())) == 3
    section = '    """Do it.\n\n    Parameters\n    ----------\n    a : int\n    """\n'
    told = [f"{name}: sections, but no user imports it" for name in ("f", "_g", "C")]
    listed = "".join(f"{head}:\n{section}" for head in ("def f(a)", "def _g(a)", "class C"))
    assert complaints(f'"""M."""\n{listed}', set()) == told
    assert complaints(f'"""M."""\n{listed}', {"f"}) == told[1:]
    assert complaints(f'"""M."""\n{listed}', {"f", "C"}) == [told[1]]
    wrapped = '"""M."""\ndef f():\n    """A sentence that goes\n    on."""\n'
    assert complaints(wrapped, set()) == []
    assert len(complaints(wrapped, {"f"})) == 1
    assert len(complaints(wrapped.replace("on.", "on\n    and on\n    and on."), set())) == 1


@pytest.mark.parametrize("folder", [f.parent for f in PYTHON if "__all__" in f.read_text()])
def test_what_a_user_imports_is_there_and_shown(folder: Path) -> None:
    package = importlib.import_module(".".join(folder.relative_to(ROOT / "src").parts))
    assert all(getattr(package, name) is not None for name in package.__all__)
    assert set(package.__all__) <= set(dir(package))


def sources() -> list[Path]:
    names = subprocess.run(
        ["git", "ls-files", "*.c", "*.h", "*.inc", "*.py", "*.mo"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    return [ROOT / n for n in names]


def test_lines_of_c_fit_a_hundred_columns() -> None:
    long = [
        f"{f.relative_to(ROOT)}:{n}"
        for f in sources()
        if f.suffix in (".c", ".h", ".inc", ".mo") and f.exists()
        for n, line in enumerate(f.read_text().splitlines(), 1)
        if len(line) > 100
    ]
    assert long == []


def test_c_file_names_are_unique_because_sources_are_packed_flat() -> None:
    names = [f.name for f in sources() if f.suffix in (".c", ".h", ".inc") and f.name != "model.c"]
    assert sorted(names) == sorted(set(names))


@pytest.mark.parametrize(
    "folder",
    sorted(f.parent for f in (*ROOT.glob("fmus/*/fmu.toml"), *ROOT.glob("scenarios/*/*.toml"))),
    ids=lambda f: f.name,
)
def test_every_fmu_and_scenario_says_what_it_is(folder: Path) -> None:
    assert (folder / "README.md").read_text().startswith("# ")


def names(library: Path) -> tuple[set[str], set[str]]:
    """What a library has, and what it takes from outside."""
    listing = subprocess.run(["nm", library], capture_output=True, text=True, check=True).stdout
    rows = [line.split() for line in listing.splitlines()]
    own = {r[-1] for r in rows if len(r) == 3}
    return own, {r[-1] for r in rows if len(r) == 2 and r[0] == "U"} - own


@pytest.mark.parametrize("library", LIBRARIES, ids=lambda f: f.name)
def test_cores_use_mathematics_only(library: Path) -> None:
    used = cores.closure(ROOT / "src", [library.stem[3:]])
    known = set().union(ALLOWED, *(names(library.with_name(f"lib{c}.a"))[0] for c in used))
    assert names(library)[1] <= known


def inexact() -> set[str]:
    """What the C library's mathematics has that IEEE 754 does not fix to the bit."""
    where = ["gcc", "-print-file-name=libm.so.6"]
    file = subprocess.run(where, capture_output=True, text=True, check=True).stdout.strip()
    listing = subprocess.run(
        ["nm", "-D", "--defined-only", file], capture_output=True, text=True, check=True
    ).stdout
    return {line.split()[-1].split("@")[0] for line in listing.splitlines()} - ALLOWED


@pytest.mark.parametrize("file", BUILT, ids=lambda f: f.name)
def test_what_is_built_takes_no_mathematics_that_platforms_do_differently(file: Path) -> None:
    """Of the compiler's making, too: it may turn one function into another."""
    found = subprocess.run(["nm", "-u", file], capture_output=True, text=True, check=True).stdout
    taken = {line.split()[-1].split("@")[0] for line in found.splitlines() if line.split()[:1]}
    assert taken & inexact() == set()


def test_mathematics_that_platforms_do_differently_is_known() -> None:
    assert {"sin", "sincos", "exp2", "hypot", "powf", "tgamma"} <= inexact()
    assert len(BUILT) >= 30


@pytest.mark.parametrize("library", LIBRARIES, ids=lambda f: f.name)
def test_cores_keep_no_variables_of_their_own(library: Path) -> None:
    listing = subprocess.run(["nm", library], capture_output=True, text=True, check=True).stdout
    own = [line for line in listing.splitlines() if re.search(r" [bBdDcC] ", line)]
    assert own == []


def test_every_core_is_checked_for_purity() -> None:
    found = {p.parent.name for p in ROOT.glob("src/*/*/*.c")}
    assert found == cores.folders(ROOT / "src").keys()
    assert {f"lib{c}.a" for c in found} == {f.name for f in LIBRARIES}


def test_generated_and_private_things_are_not_committed() -> None:
    found = subprocess.run(
        [
            "git",
            "grep",
            "-nIE",
            "(/root/|/work/|pytest-of|TODO|FIXME)",
            "--",
            ".",
            ":!tests/house/test_style.py",
        ],
        cwd=ROOT,
        capture_output=True,
        text=True,
    ).stdout
    assert found == ""
