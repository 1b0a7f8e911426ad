"""The moving picture as a section of the page."""

import base64
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.order import quantiles
from motionfmu.report.error_scale import magnification, scale_end, within
from motionfmu.report.html_page import Page
from motionfmu.report.numbers import figure
from motionfmu.report.style import AXES, RAPID
from motionfmu.report.view.scene import Scene

if TYPE_CHECKING:
    from motionfmu.analysis.collisions import CellBody

PICTURE = (
    "view_math.js",
    "machine_faces.js",
    "depth_buffer.js",
    "camera_controls.js",
)  # of a machine, shared
SCRIPTS = (*PICTURE, "view.js")
TITLE = "The machine in motion"
LEVELS = 65535
# From slow to fast: lightness rises, so it reads in grey as well.
SPEED = ("#20307a", "#2a6fb0", "#2b9c95", "#7ab648", "#e8b020")
SPEEDS = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
PLAYED = 12.0  # [s] a run is played in about this time, at one of `SPEEDS`
LINE_POINTS = 600  # of a line of deviations
MAGNIFY_MAX = 4  # power of ten
LOOKS = {"whole": "Whole", "path": "Path", "top": "Top", "front": "Front", "side": "Side"}
KEYS = (
    "Drag to turn, shift and drag or two fingers to move, wheel (after a click) or pinch to zoom,"
    " double click for the whole. Keys: space plays, ← → step, ↑ ↓ zoom, with shift they turn."
)


def add_view(
    page: Page,
    scene: Scene | None,
    told: str = "The machine as it was recorded.",
    begin: float | None = None,
    missing: str = "",
) -> dict[str, Any]:
    """Add the section and give the data of its script; without a scene there are none.

    It begins at a time, or at the end. What is missing for a scene is said in its place.
    """
    if scene is None:
        if missing:
            page.section(TITLE, missing, "")
        return {}
    duration = float(scene.time[-1] - scene.time[0])
    wanted = min(SPEEDS, key=lambda s: abs(np.log(s * PLAYED / max(duration, 1e-9))))
    deviates = any(np.abs(line.gap).max(initial=0.0) > 0.0 for line in scene.lines)
    factor = _magnify(scene) if deviates else 1.0
    rapid = np.zeros(len(scene.speed), bool) if scene.rapid is None else scene.rapid
    fastest = quantiles(scene.speed[~rapid], (0.995,))[0] or 1.0
    note = f"{told} Colour is the speed of the tool."
    if deviates:
        count = len(scene.lines)
        what = "its line" if count == 1 else f"its {count} lines, one colour each,"
        note += f" Beside the path {what} with the deviation magnified."
    page.section(
        TITLE,
        note,
        _html(wanted, factor, deviates, _scale(scene, rapid, fastest)),
    )
    return {"views": [view_data(scene, fastest) | {"begin": begin}]}


def view_data(scene: Scene, fastest: float) -> dict[str, Any]:
    """The data that the script of the view draws."""
    arm = scene.arm
    end = scale_end(_errors(scene)) if scene.lines else 0.0
    return {
        "id": "view",
        "time": quantised(scene.time),
        "tool": [quantised(c) for c in scene.tool.T],
        "joints": None if scene.joints is None else [quantised(c) for c in scene.joints.T],
        "base": None if scene.base is None else [quantised(c) for c in scene.base.T],
        "arm": None
        if arm is None
        else {
            "lengths": arm.lengths,
            "offsets": arm.offsets,
            "signs": arm.signs,
            "pen": arm.pen,
            "axes": arm.axes,
        },
        "path": {
            "time": quantised(scene.path_time),
            "point": [quantised(c) for c in scene.path.T],
            "speed": quantised(np.minimum(scene.speed, fastest)),
            "rapid": _ranges(scene.rapid),
        },
        "floor": scene.cell.floor if scene.cell else None,
        "cell": [_body(body) for body in scene.cell.bodies] if scene.cell else [],
        "rapid": RAPID,
        "fastest": fastest,
        "lines": [
            {
                "foot": [quantised(c) for c in _few(line.foot).T],
                "gap": [quantised(c) for c in within(_few(line.gap), end).T],
            }
            for line in scene.lines
        ],
        "colours": SPEED,
        "curves": ["#a8204a", *AXES[1:]],
        "axes": ["#b3341f", "#2d7a2d", "#2a5db0"],
    }


def _ranges(there: NDArray[np.bool_] | None) -> list[list[int]]:
    """First and last place of each run of true ones."""
    if there is None or not there.any():
        return []
    cuts = np.flatnonzero(np.diff(np.concatenate([[False], there, [False]])))
    return [[int(a), int(b) - 1] for a, b in cuts.reshape(-1, 2)]


def _body(body: "CellBody") -> dict[str, Any]:
    """A body of the cell as the script takes it."""
    if body.bar is not None:
        return {"bar": body.bar.tolist(), "radius": body.radius}
    half = [] if body.half is None else body.half.tolist()
    return {"half": half, "turn": body.turn.tolist(), "centre": body.center.tolist()}


def quantised(values: NDArray[Any]) -> dict[str, Any]:
    """Pack numbers as 16-bit steps between the least and the largest."""
    # A step is 1/65535 of the span, a tenth of a pixel at most.
    low, high = float(np.min(values, initial=np.inf)), float(np.max(values, initial=-np.inf))
    if not len(values):
        low = high = 0.0
    step = (high - low) / LEVELS
    steps = np.zeros(len(values)) if step == 0.0 else np.round((values - low) / step)
    raw = np.clip(steps, 0, LEVELS).astype("<u2").tobytes()
    return {"low": low, "step": step, "bdata": base64.b64encode(raw).decode()}


def _few(values: NDArray[Any]) -> NDArray[Any]:
    chosen = np.linspace(0, len(values) - 1, min(len(values), LINE_POINTS)).round().astype(int)
    return np.asarray(values[chosen])


def _magnify(scene: Scene) -> float:
    """Round magnification that suits the largest deviation and the path."""
    feet = np.concatenate([line.foot for line in scene.lines])
    size = float(np.linalg.norm(np.ptp(feet, axis=0)))
    return magnification(_errors(scene), size, size)


def _errors(scene: Scene) -> tuple[float, float]:
    """The 95th percentile of all deviations, and the largest [mm]."""
    gaps = np.concatenate([np.linalg.norm(line.gap, axis=1) for line in scene.lines])
    return quantiles(gaps, (0.95,))[0], float(gaps.max())


def _scale(scene: Scene, rapid: NDArray[np.bool_], fastest: float) -> str:
    """What the colours mean."""
    text = (
        f'<span class="ramp" style="background:linear-gradient(90deg,{",".join(SPEED)})"></span>'
        f" 0 to {figure(fastest)} mm/s"
    )
    if rapid.any():
        fastest = quantiles(scene.speed[rapid], (0.99,))[0]
        text += f'; <span class="rapid"></span> rapids, up to {figure(fastest)} mm/s'
    return text


def _html(speed: float, factor: float, deviates: bool, colours: str) -> str:
    speeds = "".join(
        f'<option value="{s:g}"{" selected" if s == speed else ""}>&times; {s:g}</option>'
        for s in SPEEDS
    )
    looks = "".join(f'<option value="{k}">{v}</option>' for k, v in LOOKS.items())
    slider = (
        '<label>Deviation <input type="range" data-view="magnify" min="0"'
        f' max="{MAGNIFY_MAX}" step="0.02" value="{np.log10(factor):.2f}"></label>'
        '<span class="number" data-view="factor"></span>'
        if deviates
        else ""
    )
    shown = '; deviation <span data-view="factor"></span>' if deviates else ""
    return (
        '<div class="machine" id="view">'
        '<canvas tabindex="0" role="img" aria-label="The machine in motion"></canvas>'
        '<div class="control"><button type="button" data-view="play" aria-label="play">▶</button>'
        '<input type="range" data-view="scrub" min="0" max="1000" step="0.5" value="1000"'
        ' aria-label="time"><span class="number" data-view="time"></span></div>'
        f'<div class="control"><label>Speed <select data-view="speed">{speeds}</select></label>'
        f'<label>View <select data-view="look">{looks}</select></label>'
        '<label><input type="checkbox" data-view="machine" checked> machine</label>'
        f'<label><input type="checkbox" data-view="solid" checked> solid</label>{slider}</div>'
        f'<p class="note">{colours}; squares of the floor: '
        f'<span data-view="grid"></span>{shown}. <span class="keys">{KEYS}</span></p></div>'
    )
