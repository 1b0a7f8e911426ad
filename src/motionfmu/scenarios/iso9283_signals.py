"""What a scenario with an [iso9283] table records for the analysis."""

from motionfmu.base import units
from motionfmu.base.errors import InputError
from motionfmu.scenarios import recording
from motionfmu.scenarios.system import Resolver

TABLE = "iso9283"


def wanted(resolver: Resolver) -> list[str]:
    """Signals the analysis needs, for recording; none without an [iso9283] table."""
    table = resolver.document.body.iso9283
    if table is None:
        return []
    _check_keys(resolver)
    found = []
    for key, name in (("position", table.position), ("command", table.command)):
        if name is not None:
            check_position(resolver, name, TABLE, key)
            found.append(name)
    for key in ("quaternion", "command_quaternion"):
        name = getattr(table, key)
        if name is not None:
            if recording.output(resolver, name, TABLE, key).port.shape != (4,):
                text = f"{key} = {name!r}: four elements (w, x, y, z) wanted"
                raise resolver.document.error(text, TABLE, key)
            found.append(name)
    if table.during is not None:
        if recording.output(resolver, table.during, TABLE, "during").port.shape:
            text = f"during = {table.during!r}: a single value wanted"
            raise resolver.document.error(text, TABLE, "during")
        found.append(table.during)
    return found


def check_position(resolver: Resolver, name: str, table: str, key: str) -> None:
    """Refuse a signal that is no position: three lengths, or six axes of which three count."""
    document = resolver.document
    port = recording.output(resolver, name, table, key).port
    if port.shape not in ((3,), (recording.AXES,)):
        raise document.error(f"{key} = {name!r}: three elements or six axes wanted", table, key)
    if units.parse(port.unit or "1").exponents != units.parse("m").exponents:
        raise document.error(f"{key} = {name!r} is no length", table, key)


# CCN 16: a row of rules between keys that know nothing of each other, each with its message.
def _check_keys(resolver: Resolver) -> None:
    """Refuse keys that exclude each other, and a key without one that it needs."""
    document, table = resolver.document, resolver.document.body.iso9283
    assert table is not None

    def wrong(key: str, text: str) -> InputError:
        return document.error(text, TABLE, key if getattr(table, key) is not None else "")

    ways = [k for k in ("command", "points", "file") if getattr(table, k) is not None]
    if len(ways) != 1:
        raise wrong("points", "one of command, points and file says where the path lies")
    if (table.cycles is None) == (table.during is None):
        raise wrong("cycles", "one of cycles and during says when the cycles are")
    if (table.during is None) != (table.between is None):
        raise wrong("between", "during and between go together")
    if table.command_quaternion is not None and table.command is None:
        raise wrong("command_quaternion", "command_quaternion goes with command")
    stop = document.body.stop_limit
    for low, high in table.cycles or ():
        if not 0.0 <= low < high <= stop:
            raise wrong("cycles", f"cycles: [{low:g}, {high:g}] s is not within 0 .. {stop:g} s")
    if bool(table.poses) != bool(table.reached):
        raise wrong("poses", "poses and reached go together")
    for row in table.reached:
        if len(row) != len(table.poses):
            text = f"reached: {len(row)} times in a cycle for {len(table.poses)} poses"
            raise wrong("reached", text)
        if not all(0.0 <= t <= stop for t in row):
            raise wrong("reached", f"reached: {row} s is not within 0 .. {stop:g} s")
