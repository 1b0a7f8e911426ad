"""A drive's monitor: speeds, torque and position deviation of one axis, as a figure."""

import numpy as np
from numpy.typing import NDArray

from motionfmu.run.figures import Chart, Curve, Panel
from motionfmu.run.recorded import Recorded
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


def charts(run: Recorded) -> list[Chart]:
    """The waveforms of a run, in the order of the scenario."""
    return [_chart(run, asked) for asked in run.resolver.document.body.waveform]


def _chart(run: Recorded, asked: Waveform) -> Chart:
    k = asked.axis - 1
    whole = (float(run.time[0]), float(run.time[-1]))
    low, high = asked.window or whole
    part = slice(
        max(0, int(np.searchsorted(run.time, low, side="right")) - 1),
        int(np.searchsorted(run.time, high)) + 1,
    )
    turn = float(run.parameter(f"{asked.drives}.{PULSES}")[k])  # [pulses]
    pulses = np.asarray(run[asked.pulses][:, k], dtype=float) / turn

    def curve(name: str, values: NDArray[np.float64], steps: bool = False) -> Curve:
        return Curve(name, run.time[part], values[part], steps)

    def signal(name: str) -> NDArray[np.float64]:
        return np.asarray(run[f"{asked.drives}.{name}"][:, k], dtype=float)

    time, speed = rates.change(run.time, pulses, asked.over)
    inside = (time >= run.time[part][0]) & (time <= run.time[part][-1])
    command = Curve("command", time[inside], MINUTE * speed[inside], False)
    units = np.round(signal("following_error") * turn)
    panels = (
        Panel("speed [r/min]", (command, curve("motor", signal("speed"))), {}, True),
        Panel("torque [%]", (curve("torque", 100.0 / asked.rated * signal("torque")),), {}, False),
        Panel("deviation\n[command units]", (curve("deviation", units, True),), {}, False),
    )
    title = asked.title or f"Drive of axis {asked.axis}"
    note = asked.note or f"100 % is {asked.rated:g} N·m; {turn:g} command units are a motor turn."
    return Chart(title, note, (low, high), asked.window is None, panels)
