"""What limits the motion of a network card's job, from its plan."""

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.motion_rows import NUMBER_OF, ROW
from motionfmu.cards.config import CardConfig
from motionfmu.cards.plan import DRAWS, RESTS, Plan

# A speed above this share of the feed, or of an axis' highest, counts as that.
AT_FEED, AT_MOST = 0.999, 0.99


def plan_rows(plan: Plan, config: CardConfig) -> NDArray[np.void]:
    """Rows of the planned motion, one a frame.

    Wherever the planner stays below the feed, one axis is at a limit of its speed, acceleration or
    jerk: the one of which the planned places take the largest share. Differences of these places
    show it, for they are not rounded to pulses; the third stands one and a half frames off its row.
    """
    rows = np.zeros(len(plan.steps), ROW)
    axes, motion = len(config.axes), config.motion
    places = plan.places[:, :axes]
    rows["time"] = np.arange(1, len(rows) + 1) * plan.period
    rows["place"][:, :4] = plan.places
    draws = plan.steps == DRAWS
    rows["feed"] = np.where(draws, motion.feed, motion.rapid)
    first = np.diff(places, axis=0, prepend=np.zeros((1, axes))) / plan.period
    ways = np.linalg.norm(first[:, :2], axis=1)
    rows["speed"] = np.where(ways > 0.0, ways, np.linalg.norm(first, axis=1))
    second = np.diff(first, axis=0, append=first[-1:]) / plan.period
    third = np.diff(second, axis=0, append=second[-1:]) / plan.period
    free = 1.0 - motion.reserve
    limits = np.array([(a.speed_max, a.acceleration_max, a.jerk_max) for a in config.axes])
    shares = np.concatenate(
        [
            np.where(np.abs(first) > AT_MOST * limits[:, 0], np.inf, 0.0),
            np.abs(second) / (free * limits[:, 1]),
            np.abs(third) / (free * limits[:, 2]),
        ],
        axis=1,
    )
    most = shares.argmax(axis=1)
    by = np.array([NUMBER_OF["speed"], NUMBER_OF["acceleration"], NUMBER_OF["jerk"]])
    rows["cause"], rows["axis"] = by[most // axes], most % axes + 1
    whole = rows["speed"] >= AT_FEED * rows["feed"]
    rests = plan.steps == RESTS
    for where, name in ((whole, "feed"), (rests, "dwell")):
        rows["cause"][where], rows["axis"][where] = NUMBER_OF[name], 0
    rows["feed"][rests] = 0.0
    return rows
