"""Runs motionfmu.fmu.pack beside this file, whatever motionfmu the environment has."""

import sys
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path


class Own:
    """Comes before the finder that an editable installation of another checkout brings."""

    @staticmethod
    def find_spec(name: str, path: list[str] | None = None, _: object = None) -> ModuleSpec | None:
        """Find the package here, its modules in it."""
        if name.partition(".")[0] != "motionfmu":
            return None
        here = [str(Path(__file__).resolve().parent)]
        return PathFinder.find_spec(name, here if path is None else path)


sys.meta_path.insert(0, Own)  # type: ignore[arg-type]

if __name__ == "__main__":
    from motionfmu.fmu.pack import main

    sys.exit(main(sys.argv[1:]))
