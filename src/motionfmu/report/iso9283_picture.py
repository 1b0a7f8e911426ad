"""The pen lines with their deviation magnified, as PNG and SVG."""

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from motionfmu.analysis.contour.circles import plane_axes
from motionfmu.analysis.iso9283 import Evaluation, Performance
from motionfmu.report.iso9283_section import parts
from motionfmu.report.numbers import length, magnification, unit
from motionfmu.report.pictures import PLAIN, STABLE
from motionfmu.report.style import AXES, GRID, INK, MUTED

PICTURES = ("iso9283.svg", "iso9283.png")
BAND = "#0b5cad"


def write_picture(name: str, found: Evaluation, folder: Path) -> None:
    """Draw the lines over the command path and along it, as `PICTURES`."""
    path = found.path
    drawn = parts(path)
    with matplotlib.rc_context(PLAIN | STABLE):
        picture = Figure(figsize=(12.0, 5.4), layout="constrained")
        grid: Any = picture.add_gridspec(len(drawn), 2)
        factor = _plan(picture.add_subplot(grid[:, 0]), path)
        for i in range(len(drawn)):
            _along(picture.add_subplot(grid[i, 1]), path, i)
        told = f"{name}: {len(path.given.cycles)} cycles, deviation {factor:,.0f} times as large"
        numbers = f"AT_P {length(float(path.accuracy.max()))}"
        if path.repeatability is not None:
            numbers += f", RT_P {length(float(path.repeatability.max()))}"
        picture.suptitle(f"{told}\n{numbers}", x=0.01, ha="left", fontsize=13)
        for file in PICTURES:
            plain = {"Date": None} if file.endswith("svg") else None
            picture.savefig(folder / file, dpi=120, metadata=plain)


def _plan(axes: Any, path: Performance) -> float:
    """The command path and the lines, seen along the normal; returns the magnification."""
    normal = np.array([0.0, 0.0, 1.0]) if path.normal is None else path.normal
    basis = plane_axes(normal)
    gap = path.point - path.command
    sizes = np.linalg.norm(gap, axis=2)
    extent = float(np.linalg.norm(np.ptp(path.command, axis=0)))
    factor = magnification((float(np.percentile(sizes, 95)), float(sizes.max())), extent, extent)
    axes.plot(*(path.given.path.points @ basis.T).T, color=MUTED, lw=1.4, label="command")
    for j, own in enumerate(path.command + factor * gap):
        axes.plot(*(own @ basis.T).T, color=AXES[j % len(AXES)], lw=1.0)
    axes.set_aspect("equal", adjustable="datalim")
    names = ["XYZ"[int(np.argmax(np.abs(b)))] for b in basis]
    axes.set_xlabel(f"{names[0]} [mm]")
    axes.set_ylabel(f"{names[1]} [mm]")
    _dress(axes)
    return factor


def _along(axes: Any, path: Performance, number: int) -> None:
    title, values, mean = parts(path)[number]
    factor, name = unit(max(float(np.abs(v).max()) for _, v, _ in parts(path)))
    if path.repeatability is not None:
        low, high = mean - path.repeatability, mean + path.repeatability
        axes.fill_between(path.along, factor * low, factor * high, color=BAND, alpha=0.13, lw=0)
    for j, own in enumerate(values):
        axes.plot(path.along, factor * own, color=AXES[j % len(AXES)], lw=0.9)
    if len(values) > 1:
        axes.plot(path.along, factor * mean, color=INK, lw=1.8)
    axes.set_ylabel(f"{title} [{name}]")
    axes.set_xlabel("Place on the path [mm]")
    _dress(axes)


def _dress(axes: Any) -> None:
    axes.grid(color=GRID, lw=0.8)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(length=0)
