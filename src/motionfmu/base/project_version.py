"""The project's version: pyproject.toml states it, and everything else asks here."""

from pathlib import Path

_ROOT = Path(__file__).resolve().parents[3]


def version() -> str:
    """The version of the sources that this file stands in, else of the installed package."""
    if (_ROOT / "pyproject.toml").is_file():
        return stated(_ROOT)
    from importlib import metadata

    return metadata.version("motionfmu")


def stated(root: Path) -> str:
    """The version of the sources in a folder."""
    import tomllib

    return str(tomllib.loads((root / "pyproject.toml").read_text())["project"]["version"])
