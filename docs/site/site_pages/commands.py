"""Pages of the console commands: arguments and options, from the application itself."""

from collections.abc import Iterator, Mapping
from enum import Enum
from pathlib import Path
from typing import Any, get_args, get_origin

from site_pages.file_keys import kind
from site_pages.markdown import code, plain, table

# What each command has beside its own options.
HABITS = ("quiet", "verbose", "open", "help")


def commands(app: Any) -> dict[str, Any]:
    """All commands of an application by their full names, those of groups in order."""
    import typer

    return dict(_within(typer.main.get_command(app), ""))


def _within(group: Any, before: str) -> Iterator[tuple[str, Any]]:
    for name, command in sorted(group.commands.items()):
        if hasattr(command, "commands"):
            yield from _within(command, f"{before}{name} ")
        else:
            yield f"{before}{name}", command


def page(found: Mapping[str, Any]) -> str:
    """The page of all commands."""
    first = next(iter(found.values()))
    parts = [
        "# Commands\n\n`motionfmu COMMAND --help` says the same on the console. "
        "A command ends with status 0 if all checks hold, 1 if one fails, 2 for wrong input "
        "and 130 after Ctrl-C.\n\n",
        table(("command", "does"), [_link(name, c) for name, c in found.items()]),
        "\nEvery command has these options, and `--open` if it writes a report:\n\n",
        _options([p for p in first.params if p.name in HABITS]),
        "\n",
        *(_command(name, c) for name, c in found.items()),
    ]
    return "".join(parts)


def _link(name: str, command: Any) -> tuple[str, str]:
    return f"[{name}](#command-{name.replace(' ', '-')})", plain(_paragraphs(command)[0])


def _paragraphs(command: Any) -> list[str]:
    return (command.help or "").split("\n\n")


def _command(name: str, command: Any) -> str:
    arguments, options = (_own(command, kind) for kind in ("argument", "option"))
    words = ["motionfmu", name, *["[OPTIONS]"] * bool(options), *map(_argument, arguments)]
    told = "\n\n".join(plain(part) for part in _paragraphs(command))
    target = f"(command-{name.replace(' ', '-')})="
    text = f"{target}\n## {name}\n\n```console\n{' '.join(words)}\n```\n\n{told}\n\n"
    if arguments:
        rows = [(code(_argument(p)), plain(_kind(p)), plain(p.help or "")) for p in arguments]
        text += table(("argument", "type", "meaning"), rows) + "\n"
    return text + (_options(options) + "\n" if options else "")


def _own(command: Any, kind: str) -> list[Any]:
    """Arguments or options of a command beside those of all."""
    shown = (p for p in command.params if p.name not in HABITS and not getattr(p, "hidden", False))
    return [p for p in shown if p.param_type_name == kind]


def _argument(parameter: Any) -> str:
    name = (parameter.metavar or parameter.name).upper()
    name += "..." if parameter.nargs == -1 else ""
    return name if parameter.required else f"[{name}]"


def _options(options: list[Any]) -> str:
    rows = [(_names(p), plain(_kind(p)), _default(p), plain(p.help or "")) for p in options]
    return table(("option", "type", "default", "meaning"), rows)


def _names(option: Any) -> str:
    return ", ".join(code(name) for name in (*option.opts, *option.secondary_opts))


def _kind(parameter: Any) -> str:
    """What a value is, in words; empty for a switch."""
    if getattr(parameter, "is_flag", False) or getattr(parameter, "count", False):
        return ""
    bare = parameter.type_descriptor.annotation
    if get_origin(bare) is list:
        bare = get_args(bare)[0]
    if isinstance(bare, type) and issubclass(bare, Enum):
        told = ", ".join(str(choice.value) for choice in bare)
    elif parameter.metavar and parameter.param_type_name == "option":
        told = parameter.metavar
    else:
        told = "path" if bare is Path else kind(bare)
        told += f", {parameter.min} or more" if parameter.min is not None else ""
        told += f", {parameter.max} or less" if parameter.max is not None else ""
    several = getattr(parameter, "multiple", False) or parameter.nargs == -1
    return f"{told}; several" if several else told


def _default(option: Any) -> str:
    """The value that holds if the option is not given."""
    value = option.default
    if option.required:
        return "required"
    if value in (None, (), [], "") or callable(value):
        return ""
    if isinstance(value, bool):
        names = option.opts if value else option.secondary_opts
        return code(names[-1]) if names and option.secondary_opts else ""
    return code(str(getattr(value, "value", value)))
