"""The motion of a program as a run had it, by a controller that tells what limits it."""

import numpy as np

from motionfmu.analysis.cycle_time.program_plan import CommandedMotion
from motionfmu.base.motion_rows import ROW
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios import limited_signals as told

FIELDS = {"speed": told.SPEED, "feed": told.FEED, "line": told.LINE, "axis": told.AXIS}


def driven(run: RunRecord) -> CommandedMotion | None:
    """Take the motion of a program from a run.

    Parameters
    ----------
    run : Result
        Of a machine that says its axes.

    Returns
    -------
    CommandedMotion or None
        While the program runs, its waits included; None if no controller tells what limits it.
    """
    component = told.controller(run.resolver)
    wanted = (told.BY, told.PLACE, *FIELDS.values())
    names = {variable: f"{component}.{variable}" for variable in wanted}
    if any(name not in run.signals for name in names.values()):
        return None
    by = np.asarray(run.signals[names[told.BY]])
    runs = by != 0
    rows = np.zeros(int(runs.sum()), ROW)
    if len(run.time) < 2 or not len(rows):
        return None
    frame = float(run.time[1] - run.time[0])
    rows["time"] = np.arange(1, len(rows) + 1) * frame
    rows["cause"] = by[runs]
    for field, variable in FIELDS.items():
        rows[field] = np.asarray(run.signals[names[variable]])[runs]
    rows["place"][:, :3] = 1e3 * np.asarray(run.signals[names[told.PLACE]])[runs]
    axes = tuple(axis.name for axis in run.resolver.document.controller_axes)
    return CommandedMotion(frame, rows, axes, driven=True)
