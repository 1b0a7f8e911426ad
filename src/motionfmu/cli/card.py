"""The commands of the network card: ``motionfmu card ...``; each ``card_*.py`` brings its own."""

import typer

from motionfmu.cli.common import app

card = typer.Typer(help="Network motion card: plan, serve, simulate.", no_args_is_help=True)
app.add_typer(card, name="card")
