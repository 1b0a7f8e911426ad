"""What the build needs to know of cores, FMUs and C tests, as lines in CMake's language.

CMake reads no TOML and no C text: `python src/pack.py cmake` prints these lines when the build is
configured, and CMakeLists.txt includes them.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path

from motionfmu.base import project_version
from motionfmu.base.toml_lines import text_of
from motionfmu.fmu import cores, fmu_toml


def lists(root: Path) -> str:
    """Every list that CMakeLists.txt uses, of the checkout in this folder.

    - ``version`` of the package.
    - ``cores``, and of each ``core_X_folder``, ``core_X_uses`` and ``core_X_all``, itself and all
      that it uses, directly or not.
    - ``fmus``, and of each ``fmu_X_identifier``, ``fmu_X_cores``, ``fmu_X_all_cores`` and
      ``fmu_X_modelica``, ON or OFF.
    - Of each C file of a test ``test_X_cores``, whose headers it includes, ``test_X_all_cores``,
      and ``test_X_folders``, which hold the headers of tests that it includes.
    - ``read_files``: the lists change only with one of them.
    """
    project = root / "pyproject.toml"
    folders = cores.folders(root / "src")
    fmus = sorted(root.glob("fmus/*/fmu.toml"))
    tests = _Tests(root)
    own = [Path(__file__), Path(cores.__file__), project]
    read = [*own, *(f / "core.toml" for f in folders.values()), *fmus, *sorted(tests.files)]
    rows = [
        ("version", [project_version.stated(root)]),
        ("cores", list(folders)),
        *_of_cores(root / "src", folders),
        ("fmus", [f.parent.name for f in fmus]),
        *(row for file in fmus for row in _of_fmu(root / "src", file)),
        *tests.rows,
        ("read_files", read),
    ]
    quoted = ((name, "".join(f' "{x}"' for x in values)) for name, values in rows)
    return "".join(f"set({name}{values})\n" for name, values in quoted)


Rows = Iterator[tuple[str, Iterable[str | Path]]]


def _of_cores(source: Path, folders: dict[str, Path]) -> Rows:
    for name, folder in folders.items():
        yield f"core_{name}_folder", [folder]
        yield f"core_{name}_uses", cores.uses(folder)
        yield f"core_{name}_all", cores.closure(source, [name])


def _of_fmu(source: Path, file: Path) -> Rows:
    name, modelica = file.parent.name, fmu_toml.names_modelica(text_of(file))
    if modelica:
        from motionfmu.fmu.modelica import class_description

        identifier, used = class_description.read(file).name, cores.OF_PLANTS
    else:
        described = fmu_toml.load(file)
        identifier, used = described.name, described.cores
    yield f"fmu_{name}_identifier", [identifier]
    yield f"fmu_{name}_modelica", ["ON" if modelica else "OFF"]
    yield f"fmu_{name}_cores", used
    yield f"fmu_{name}_all_cores", cores.closure(source, used)


class _Tests:
    """The C tests of cores and the harnesses of fuzzing, and what they include."""

    def __init__(self, root: Path) -> None:
        headers = {f for place in ("core", "fuzz") for f in root.glob(f"tests/{place}/**/*.h")}
        own = {f.name: f for f in (*root.glob("src/fmi/*"), *sorted(headers))}
        core_of = {
            header.name: name
            for name, folder in cores.folders(root / "src").items()
            for header in folder.glob("*.h")
        }
        self.files: set[Path] = set()  # all that was read
        self.rows: list[tuple[str, Iterable[str | Path]]] = []
        for file in sorted((*root.glob("tests/core/*/*.c"), *root.glob("tests/fuzz/fuzz_*.c"))):
            whole = [file, *cores.reached(own.values(), [file])]
            used = {core_of[name] for f in whole for name in cores.included(f) if name in core_of}
            self.files.update(whole)
            self.rows += [
                (f"test_{file.stem}_cores", sorted(used)),
                (f"test_{file.stem}_all_cores", cores.closure(root / "src", sorted(used))),
                (f"test_{file.stem}_folders", sorted({f.parent for f in whole if f in headers})),
            ]
