"""The moving picture of a program that was run dry: arm, tool, path, the bodies of its cell."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.dry_run import DryRun
from motionfmu.report.view.scene import Scene, drawn_samples, frames_of
from motionfmu.run.decimate import at, reader
from motionfmu.scenarios.arm_lengths import LENGTHS, Arm, axes_in_mm


def dry_scene(run: DryRun) -> Scene | None:
    """The moving picture; None of a program that was refused before it moved."""
    s, count = run.samples, len(run.samples)
    if count < 2:
        return None
    place = s["place"].astype(float)
    frames = frames_of(count)
    extent = float(np.linalg.norm(np.ptp(place, axis=0)))
    kept = drawn_samples(count, reader(place), extent)
    rapid = s["feed"][kept] <= 0.0
    return Scene(
        s["time"][frames],
        place[frames],
        _si(s["joint"][frames].astype(float), run.settings),
        arm_in_mm(run.settings),
        s["time"][kept],
        at(reader(place), kept),
        s["speed"][kept].astype(float),
        base=s["base"][frames].astype(float) if np.ptp(s["base"], axis=0).any() else None,
        rapid=None if rapid.all() else rapid,
        cell=run.cell,
    )


def _si(joints: NDArray[np.float64], settings: Mapping[str, Any]) -> NDArray[np.float64]:
    """Joints in rad, of those that slide in m."""
    slides = np.asarray(settings["joint_slides"]) == 1
    return np.where(slides, 1e-3 * joints, np.radians(joints))


def arm_in_mm(settings: Mapping[str, Any]) -> Arm:
    """The arm of a virtual robot's settings, which has its tool in the program."""
    if settings["arm_by"] == 1:
        return Arm((), axes=axes_in_mm(lambda name: np.ravel(settings[name]).tolist()))
    lengths = tuple(1e3 * float(settings[n]) for n in LENGTHS)
    offsets, signs = (np.asarray(settings[n], float) for n in ("joint_offset", "joint_sign"))
    return Arm(lengths, tuple(np.radians(offsets).tolist()), tuple(signs.tolist()))
