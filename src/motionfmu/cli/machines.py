"""The command that lists machines."""

from motionfmu.cli.common import app
from motionfmu.cli.info import first_line, print_rows


@app.command()
def machines() -> None:
    """List the machines on which programs run: those of the package and of ./machines."""
    from motionfmu.scenarios import package_files

    print_rows([((name,), first_line(place)) for name, place in package_files.machines().items()])
