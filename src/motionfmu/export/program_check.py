"""Part programs that travel: no file is written with one inside that no machine takes."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.base.program_endings import ROBOT_JOBS
from motionfmu.fmu import places
from motionfmu.run.engines import lean
from motionfmu.run.engines.slave import Slave
from motionfmu.run.run_plan import RunPlan
from motionfmu.scenarios import fmus
from motionfmu.scenarios.port import Port
from motionfmu.scenarios.system import End, Setting, System
from motionfmu.scenarios.values import values_of

FMI = 3  # an FMU says the same in both versions
# Who uses an FMU may set what it is not given: a machine with all axes, faster than any program,
_WIDEST: dict[str, Any] = {"active": True, "max_feed": 1e9, "max_rpm": 1e9}
_WIDEST |= {f"group{n}_channel": [1, 2, 3, 4, 5, 6] for n in range(1, 7)}
# that reads the same words in one of several ways.
_SWITCHES = ("fanuc", "rotary_names", "block_delete")


def check_scenario(scenario: RunPlan, system: System, given: Mapping[str, Any]) -> None:
    """Refuse a scenario in which an FMU of ours refuses the files that it reads."""
    for name, fmu in system.components.items():
        mine = [s for s in system.settings if s.end.component == name]
        if fmus.is_ours(fmu) and any(map(_reads, mine)):
            if error := _refusal(name, fmu, mine):
                raise scenario.located(error, system, given)


def check_alone(fmu: str, settings: Sequence[Setting]) -> str:
    """Refuse an FMU with a program that is wrong for any machine its user can make of it.

    Returns what it says if it is only refused until other values are set; else an empty text.
    """
    if not any(map(_reads, settings)) or (error := _refusal(fmu, fmu, settings)) is None:
        return ""
    told = []
    for others in _machines(fmu, settings):
        refused = _refusal(fmu, fmu, [*settings, *others])
        if refused is None or not _of_a_program(refused, settings):
            return str(error)
        told.append(refused)
    raise told[0]


def _refusal(component: str, fmu: str, settings: Sequence[Setting]) -> InputError | None:
    """What an FMU says that does not begin with these values and files; None if it does.

    It runs no step. Files that it would write are left out, and those that it carries are not here.
    """
    slave = Slave(component, lean.unpacked(fmu, fmus.version(fmu, FMI)), FMI, [], logging=False)
    try:
        for s in settings:
            if not s.end.port.file or _reads(s):
                slave.assign(s.end.port.type, s.end.port.reference, s.values)
        slave.initialize()
        slave.start()
    except InputError as error:
        return error
    finally:
        slave.free()
    return None


def _reads(setting: Setting) -> bool:
    """Whether it names a file on this machine that is read."""
    read = setting.end.port.file == "read"
    return read and places.local(str(setting.values[0])) is not None


def _machines(fmu: str, settings: Sequence[Setting]) -> Iterator[list[Setting]]:
    """What may be set beside these settings so that more programs are good, the usual first."""
    ports = fmus.ports(fmu)
    free = {n: p for n, p in ports.items() if n not in {s.end.port.name for s in settings}}
    widest = [_setting(fmu, p, _WIDEST[n]) for n, p in free.items() if n in _WIDEST]
    switches = [free[n] for n in _SWITCHES if n in free]
    usual = [p.start == "true" for p in switches]
    for turned in product((False, True), repeat=len(switches)):
        values = [u != t for u, t in zip(usual, turned, strict=True)]
        yield widest + [_setting(fmu, p, v) for p, v in zip(switches, values, strict=True)]


def _setting(fmu: str, port: Port, value: Any) -> Setting:
    end = End(fmu, port)
    return Setting(end, values_of(end, min(value, port.high) if type(value) is float else value))


def _of_a_program(error: InputError, settings: Sequence[Setting]) -> bool:
    """Whether an FMU refuses the text of a program that it was given, all of which is here."""
    given = {s.end.port.name: str(s.values[0]) for s in settings}
    for name, file in given.items():
        # The points of a robot's job are in another file.
        robots = Path(file).suffix.lower() in ROBOT_JOBS or given.get("language") == "inform"
        if name.endswith("program") and not (robots and "points" not in given):
            if f": {file}: " in str(error):
                return True
    return False
