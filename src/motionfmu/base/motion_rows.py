"""Rows of a commanded motion, as FMUs and planners write them: NumPy's structured arrays."""

import numpy as np

# time [s] at the row's end, place [mm], speed along the path and programmed feed [mm/s], line and
# command of the program, what limits the motion (`CAUSES`) and the axis of that, from 1.
ROW = np.dtype(
    [
        ("time", "<f8"),
        ("place", "<f8", (6,)),
        ("speed", "<f8"),
        ("feed", "<f8"),
        ("line", "<i4"),
        ("command", "<i4"),
        ("cause", "<i4"),
        ("axis", "<i4"),
    ]
)
# What limits the motion, by the numbers of src/motion/trajectory/limited.h.
CAUSES = {
    1: "feed",
    2: "speed",
    3: "acceleration",
    4: "jerk",
    5: "corner",
    6: "exact stop",
    7: "dwell",
    8: "waiting",
}
NUMBER_OF = {name: number for number, name in CAUSES.items()}
