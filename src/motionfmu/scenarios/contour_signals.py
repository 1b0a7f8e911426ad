"""What a scenario with a [contour] table records for the analysis."""

from motionfmu.base import units
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import Resolver

# Outputs that the analysis needs beside position and pulses, by the FMU that has them.
LIBRARY = ("command", "command_newest", "path_feed", "card_dda_length", "card_dda_divider")
CARD = ("stock", "irq_seq", "dac")


def library_of(resolver: Resolver) -> str:
    """Name of the component that plans the path; InputError if none does."""
    for name, ports in resolver.ports.items():
        if "path_file" in ports:
            return name
    raise resolver.document.error("no component plans a path (none has path_file)", "contour")


def wanted(resolver: Resolver) -> list[str]:
    """Signals the contour analysis needs, for recording; none without a [contour] table."""
    contour = resolver.document.body.contour
    if contour is None:
        return []
    for key, name in (("position", contour.position), ("pulses", contour.pulses)):
        _check_axes(resolver, key, name)
    library, card = library_of(resolver), contour.pulses.partition(".")[0]
    more = [f"{card}.{name}" for name in CARD if name in resolver.ports.get(card, {})]
    return [contour.position, contour.pulses, *(f"{library}.{name}" for name in LIBRARY), *more]


def _check_axes(resolver: Resolver, key: str, name: str) -> None:
    """Refuse a signal that is no array of axes, and a position that is no length."""
    document = resolver.document
    port = recording.output(resolver, name, "contour", key).port
    if port.shape != (recording.AXES,):
        raise document.error(
            f"{key} = {name!r}: a value for each of six axes wanted", "contour", key
        )
    unit = units.parse(port.unit or "1")
    if key == "position" and unit.exponents != units.parse("m").exponents:
        raise document.error(f"{name} is no length", "contour", key)
