"""Large packages that only some commands need, by the extra that installs them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

from motionfmu.base.errors import InputError


@dataclass(frozen=True)
class Extra:
    """A row of pyproject.toml's optional dependencies."""

    packages: tuple[str, ...]  # names by which they are imported
    use: str  # what needs it: the beginning of a sentence that goes on with "needs"


CARD = ("matplotlib", "scipy", "starlette", "uvicorn", "websockets")
EXTRAS = {
    "tune": Extra(("casadi", "control", "scipy", "threadpoolctl"), "a linear model"),
    "report": Extra(("matplotlib", "scipy"), "a picture, an explanation or a .mat file"),
    "study": Extra(("matplotlib", "pyarrow", "scipy"), "a study or a Parquet file"),
    "dask": Extra(("distributed",), "a study on a cluster"),
    "pandas": Extra(("pandas",), "a table of pandas"),
    "card": Extra(CARD, "planning a drawing"),
    "live": Extra(("starlette", "uvicorn", "websockets"), "a live machine"),
    "opcua": Extra(("asyncua",), "an OPC UA server"),
    "drawing": Extra(("ezdxf", "lxml", "svgelements"), "a drawing in SVG or DXF"),
    "ros": Extra(("yaml",), "a joint trajectory in YAML"),
    "export": Extra(("ziglang",), "compiling for other platforms"),
}


# What pip calls a package whose name is another one.
PROJECTS = {"yaml": "pyyaml"}


class Missing(InputError, ImportError):
    """An extra is not installed; the text says which one, and how to install it."""


def missing(extra: str) -> list[str]:
    """Packages of an extra that are not installed."""
    return [name for name in EXTRAS[extra].packages if find_spec(name) is None]


def needed(extra: str) -> None:
    """Raise `Missing` if an extra is not installed: what needs it, how it is installed."""
    if names := ", ".join(missing(extra)):
        raise Missing(f"{EXTRAS[extra].use} needs {names}: {install(extra)}")


def at_first_use(
    package: str, names: Sequence[str], modules: Callable[[], Sequence[ModuleType]]
) -> Callable[[str], Any]:
    """A package's `__getattr__`, which imports modules that need the extra `tune` when asked."""

    def get(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        needed("tune")
        return next(getattr(m, name) for m in modules() if hasattr(m, name))

    return get


def install(extra: str) -> str:
    """The command that installs an extra; no package index has this project itself."""
    import json
    from importlib import metadata
    from urllib.parse import urlsplit
    from urllib.request import url2pathname

    own = metadata.distribution("motionfmu")
    told = json.loads(own.read_text("direct_url.json") or "{}")
    if "dir_info" in told:  # from its sources
        return f"pip install {' '.join(PROJECTS.get(p, p) for p in EXTRAS[extra].packages)}"
    url = urlsplit(told.get("url", ""))
    file = Path(url2pathname(url.path))
    there = url.scheme == "file" and file.suffix == ".whl" and file.is_file()
    return f'pip install "{file if there else f"motionfmu-{own.version}-....whl"}[{extra}]"'
