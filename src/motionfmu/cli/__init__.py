"""The console command: each module here brings its own.

Exit status: 0 all checks hold, 1 a check failed, 2 the input is wrong (one message on stderr),
130 it was ended by Ctrl-C (one line on stderr).
"""

import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    import typer

# Modules with commands that other modules add to, and modules without a command.
SEVERAL = {"card", "common", "console_text", "drawing_choices", "frf", "identify_arm"}


def __getattr__(name: str) -> Any:
    """Import the commands when they are first used: an interrupt is to find `main` before that."""
    if name == "app":
        return _commands()
    raise AttributeError(f"module 'motionfmu.cli' has no attribute {name!r}")


def _commands(asked: str = "") -> "typer.Typer":
    """All commands, or the one that is asked for, if a module has its name."""
    import importlib
    import pkgutil

    from motionfmu.cli.common import app

    known = [module.name for module in pkgutil.iter_modules(__path__)]
    own = [name for name in (asked, f"{asked}_") if name in known and name not in SEVERAL]
    for name in own or known:
        importlib.import_module(f"{__name__}.{name}")
    return _names_only(app) if asked == "--help" else app


def _names_only(app: "typer.Typer") -> "typer.Typer":
    """The application with names and first sentences: options are a fifth of a start."""
    import copy

    bare = copy.copy(app)
    bare.registered_commands = [copy.copy(c) for c in app.registered_commands]
    for command in bare.registered_commands:
        if (real := command.callback) is not None:
            command.callback = _bare(real)
    bare.registered_groups = [copy.copy(g) for g in app.registered_groups]
    for group in bare.registered_groups:
        if group.typer_instance is not None:
            group.typer_instance = _names_only(group.typer_instance)
    return bare


def _bare(command: "Callable[..., Any]") -> "Callable[..., Any]":
    def nothing() -> None:
        pass

    nothing.__name__, nothing.__doc__ = command.__name__, command.__doc__
    return nothing


def main(begin: "Callable[[], None]" = lambda: None) -> None:
    """One line and a status for wrong input and for Ctrl-C; `begin` is called first."""
    try:
        begin()
        status, told = _status()
    except KeyboardInterrupt:
        status, told = 130, "stopped"
    if told:
        print(f"motionfmu: {told}", file=sys.stderr)
    if status:
        sys.exit(status)


def _status() -> tuple[int, str]:
    """Run the command of the command line; status, and what is to be told on stderr."""
    import atexit
    import os
    import signal
    import warnings

    # pydantic would look for plugins in all installed packages, which takes longer than the rest.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "1")
    app = _commands(*sys.argv[1:2])
    from typer.exceptions import TyperException

    from motionfmu.base.deprecation import one_line
    from motionfmu.base.errors import InputError
    from motionfmu.cli.common import STOPPED, WRONG, Stopped

    warnings.formatwarning = one_line
    # At exit all work is done, and an interrupt would only print a traceback.
    atexit.register(signal.signal, signal.SIGINT, signal.SIG_IGN)
    try:
        status = app(prog_name="motionfmu", standalone_mode=False) or 0
    except InputError as error:
        return WRONG, str(error)
    except TyperException as error:  # of the command line itself
        return error.exit_code, _usage(error)
    except Stopped as stopped:
        return STOPPED, f"stopped: {stopped}"
    return status, "stopped" if status == STOPPED else ""


def _usage(error: Any) -> str:
    """What is wrong with the command line; all help, if nothing was asked."""
    if type(error).__name__ == "NoArgsIsHelpError":
        error.show()
        return ""
    text = str(error.format_message()).rstrip(".")
    if near := getattr(error, "possibilities", None):
        text = f"{error.message}; did you mean {near[0]!r}?"
    if "'describe'" in text:
        text += "; did you mean 'info'?"
    text = text.replace(". Did you", "; did you")
    where = error.ctx.command_path if getattr(error, "ctx", None) else "motionfmu"
    return f"{text[:1].lower()}{text[1:]} (help: {where} --help)"
