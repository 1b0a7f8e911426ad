"""The commands of the network card: ``motionfmu card ...``; each ``card_*.py`` brings its own."""

import asyncio
import signal
from collections.abc import Callable

import typer

from motionfmu.cli.common import Group, app

card = typer.Typer(
    cls=Group,
    rich_markup_mode=None,
    help="Network motion card: plan, serve, simulate.",
    no_args_is_help=True,
)
app.add_typer(card, name="card")


def on_end(end: Callable[[], object]) -> None:
    """Call this at Ctrl-C and at SIGTERM, on the event loop that runs."""
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, end)
