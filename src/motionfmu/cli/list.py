"""The command that lists FMUs and scenarios."""

from pathlib import Path

from motionfmu.cli.common import app
from motionfmu.cli.console_text import print_rows


@app.command("list")
def list_all() -> None:
    """List the FMUs, and the scenarios of ./scenarios, else those that come with the package."""
    from motionfmu.scenarios import fmus, package_files

    if names := fmus.fmu_names():
        print("FMUs")
        print_rows([((name,), fmus.about(name)) for name in names])
    else:
        print(f"FMUs: none is built in {fmus.folder()}; make build builds them")
    here = Path("scenarios").glob(f"*/{package_files.SCENARIO}")
    found = {str(file.parent): file.parent for file in sorted(here)} or package_files.scenarios()
    if found:
        print("Scenarios")
        print_rows([((name,), first_line(folder)) for name, folder in found.items()])
    else:
        print("Scenarios: none in ./scenarios; motionfmu new scenario NAME makes one")


def first_line(folder: Path) -> str:
    """What a scenario shows or a machine is, right or wrong; of another project its title."""
    from motionfmu.scenarios.package_files import MACHINE, SCENARIO

    told = (folder / name for name in (SCENARIO, MACHINE))
    file = next((f for f in told if f.is_file()), folder / "README.md")
    with file.open(encoding="utf-8", errors="replace") as stream:
        return stream.readline(1000).strip().lstrip("# ")
