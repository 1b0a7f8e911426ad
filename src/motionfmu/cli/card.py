"""The commands of the network card: ``motionfmu card ...``; each ``card_*.py`` brings its own."""

from collections.abc import Callable

from motionfmu.cli.common import App, Group, app

card = App(
    cls=Group,
    rich_markup_mode=None,
    help="Network motion card: plan, serve, simulate.",
    no_args_is_help=True,
)
app.add_typer(card, name="card")


def on_end(end: Callable[[], object]) -> list[int]:
    """Call this at Ctrl-C and at SIGTERM, on the event loop that runs; the list gets which."""
    import asyncio
    import signal

    came: list[int] = []

    def ended(number: int) -> None:
        came.append(number)
        end()

    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        try:
            loop.add_signal_handler(number, ended, number)
        except NotImplementedError:  # Windows
            signal.signal(number, lambda n, _: loop.call_soon_threadsafe(ended, n))
    return came


def stopped(came: list[int]) -> None:
    """Ctrl-C is told and has its status; SIGTERM is how a service is asked to end."""
    import signal

    if signal.SIGINT in came:
        raise KeyboardInterrupt
