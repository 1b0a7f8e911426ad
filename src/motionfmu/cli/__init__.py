"""The console command: each module here brings its own.

Exit status: 0 all checks hold, 1 a check failed, 2 the input is wrong (one message on stderr).
"""

import importlib
import pkgutil
import sys

from motionfmu.cli.common import WRONG, app
from motionfmu.errors import InputError

for module in pkgutil.iter_modules(__path__, f"{__name__}."):
    importlib.import_module(module.name)


def main() -> None:
    """Entry point: one message and status 2 for wrong input."""
    try:
        app()
    except InputError as error:
        print(f"motionfmu: {error}", file=sys.stderr)
        sys.exit(WRONG)
