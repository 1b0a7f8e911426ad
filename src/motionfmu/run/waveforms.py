"""A drive's monitor: speeds, torque and position deviation of one axis, as a figure."""

from collections.abc import Callable

import numpy as np

from motionfmu.run.decimate import Array, reader
from motionfmu.run.figures import Chart, Curve, Panel, curve
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios import rates, recording
from motionfmu.scenarios.analyses import Waveform
from motionfmu.scenarios.system import End, Resolver

SIGNALS = ("speed", "torque", "following_error")
PULSES = "pulses_per_turn"
MINUTE = 60.0  # [s]


def wanted(resolver: Resolver) -> list[End]:
    """Outputs that the waveforms show, for recording; what is no drive is refused."""
    found = []
    for i, asked in enumerate(resolver.document.body.waveform):
        table = f"waveform.{i}"
        for signal in SIGNALS:
            end = recording.output(resolver, f"{asked.drives}.{signal}", table, "drives")
            if not 1 <= asked.axis <= end.port.count:
                text = f"axis = {asked.axis}: {asked.drives} has axes 1 to {end.port.count}"
                raise resolver.document.error(text, table, "axis")
            found.append(end)
        resolver.end(f"{asked.drives}.{PULSES}", table, "drives")
        pulses = recording.output(resolver, asked.pulses, table, "pulses")
        if pulses.port.count < asked.axis:
            text = f"pulses = {asked.pulses!r}: there is no axis {asked.axis}"
            raise resolver.document.error(text, table, "pulses")
        stop = resolver.document.body.stop_limit
        if asked.window is not None and not 0.0 <= asked.window[0] < asked.window[1] <= stop:
            text = f"window = {asked.window!r}: from and to within 0 .. {stop:g} s wanted"
            raise resolver.document.error(text, table, "window")
        step = round(resolver.document.body.step * 1e9)
        if told := rates.wrong(asked.over, step, stop):
            raise resolver.document.error(told.replace("rate", "over"), table, "over")
        found.append(pulses)
    return found


def charts(run: RunRecord) -> list[Chart]:
    """The waveforms of a run, in the order of the scenario."""
    return [_chart(run, asked) for asked in run.resolver.document.body.waveform]


def _chart(run: RunRecord, asked: Waveform) -> Chart:
    k = asked.axis - 1
    whole = (float(run.time[0]), float(run.time[-1]))
    low, high = asked.window or whole
    span = (low, high)
    turn = float(run.parameter(f"{asked.drives}.{PULSES}")[k])  # [pulses]
    pulses = run[asked.pulses][:, k]
    back = rates.steps(run.time, asked.over)
    speed = rates.reader(pulses, back, asked.over)

    def rpm(first: int, last: int) -> Array:
        return np.asarray(MINUTE / turn * speed(first, last))

    def signal(name: str, of: Callable[[Array], Array], signal: str, steps: bool = False) -> Curve:
        read = reader(run[f"{asked.drives}.{signal}"][:, k])
        return curve(name, run.time, lambda a, b: of(read(a, b).astype(float)), span, steps)

    command = curve("command", run.time[back:], rpm, span, False)
    motor = signal("motor", lambda x: x, "speed")
    torque = signal("torque", lambda x: 100.0 / asked.rated * x, "torque")
    units = signal("deviation", lambda x: np.round(x * turn), "following_error", True)
    panels = (
        Panel("speed [r/min]", (command, motor), {}, True),
        Panel("torque [%]", (torque,), {}, False),
        Panel("deviation\n[command units]", (units,), {}, False),
    )
    title = asked.title or f"Drive of axis {asked.axis}"
    note = asked.note or f"100 % is {asked.rated:g} N·m; {turn:g} command units are a motor turn."
    return Chart(title, note, (low, high), asked.window is None, panels)
