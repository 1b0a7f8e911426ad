"""Joint trajectories as ROS has them: joints over time, in YAML or CSV."""

import csv
import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed

Array = NDArray[np.float64]
YAML, CSV = (".yaml", ".yml"), ".csv"
ENDINGS = (CSV, *YAML)
TIME = "time_from_start"
VELOCITY = ".velocity"  # behind the name of a joint, in CSV
_INSIDE = ("joint_trajectory", "trajectory")  # of a goal or of what MoveIt plans
_SECONDS = (("secs", "nsecs"), ("sec", "nanosec"))  # of ROS 1 and 2


@dataclass(frozen=True)
class JointTrajectory:
    """Joints [rad] at times [s]."""

    joints: list[str]
    time: Array
    position: Array  # a row a point
    velocity: Array | None  # [rad/s]
    lines: list[int]  # of the file, from 1


def read_trajectory(file: Path) -> JointTrajectory:
    """A joint trajectory of a file; what is wrong in it is told with line and value."""
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as why:
        raise InputError(f"{file}: cannot be read: {why}") from None
    found = _of_yaml(file, text) if file.suffix.lower() in YAML else _of_csv(file, text)
    if not len(found.time):
        raise InputError(f"{file}: no points")
    for k in range(len(found.time)):
        before = found.time[k - 1] if k else -math.inf
        if not found.time[k] >= 0.0 or found.time[k] <= before:
            told = "0 or more" if not k else f"more than {before:g}, that of the point before"
            _refuse(file, found.lines[k], f"{TIME} = {found.time[k]:g}: {told} wanted")
    return found


def _refuse(file: Path, line: int, told: str) -> None:
    raise InputError(f"{file}: line {line}: {told}")


def _number(file: Path, line: int, name: str, given: str) -> float:
    try:
        value = float(given)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        _refuse(file, line, f"{name} = {given!r}: a number wanted")
    return value


# CCN 18: a row of ways in which a header is wrong.
def _columns(file: Path, line: int, head: list[str]) -> tuple[list[str], list[str]]:
    """Joints of a header, and the columns of their velocities; none if it has none."""
    if head[0] != TIME:
        _refuse(file, line, f"{head[0]!r}: {TIME} [s] wanted first, then the joints [rad]")
    for name in head:
        if head.count(name) > 1 or not name:
            _refuse(file, line, f"{name!r}: a name for each column wanted, each once")
    joints = [name for name in head[1:] if not name.endswith(VELOCITY)]
    rates = [name + VELOCITY for name in joints]
    given = [name for name in head[1:] if name.endswith(VELOCITY)]
    if strange := [name for name in given if name not in rates]:
        _refuse(file, line, f"{strange[0]!r}: no such joint")
    left = [name for name in rates if name not in given]
    if given and left:
        _refuse(file, line, f"{left[0]!r} is missing: velocities of all joints or of none")
    return joints, rates if given else []


def _of_csv(file: Path, text: str) -> JointTrajectory:
    rows = csv.reader(io.StringIO(text), skipinitialspace=True)
    table = [(rows.line_num, [cell.strip() for cell in row]) for row in rows if any(row)]
    if not table:
        raise InputError(f"{file}: no header: {TIME} and the names of the joints wanted")
    line, head = table[0]
    joints, rates = _columns(file, line, head)
    values = []
    for line, row in table[1:]:
        if len(row) != len(head):
            _refuse(file, line, f"{len(row)} values, not {len(head)} as the header has")
        values.append([_number(file, line, head[i], cell) for i, cell in enumerate(row)])
    all_values = np.array(values, dtype=float).reshape(len(values), len(head))

    def columns(names: Sequence[str]) -> Array:
        return all_values[:, [head.index(name) for name in names]]

    return JointTrajectory(
        joints,
        all_values[:, 0],
        columns(joints),
        columns(rates) if rates else None,
        [line for line, _ in table[1:]],
    )


class _YamlPlace:
    """A place in a YAML text, whose parts are looked for with their lines."""

    def __init__(self, file: Path, node: Any) -> None:
        self.file, self.node = file, node

    @property
    def line(self) -> int:
        return int(self.node.start_mark.line) + 1

    def parts(self) -> "dict[str, _YamlPlace]":
        if self.node.id != "mapping":
            _refuse(self.file, self.line, "names with values wanted")
        return {str(k.value): _YamlPlace(self.file, v) for k, v in self.node.value}

    def get(self, name: str) -> "_YamlPlace":
        parts = self.parts()
        if name not in parts:
            _refuse(self.file, self.line, f"{name} is missing")
        return parts[name]

    def items(self, name: str) -> "Iterator[_YamlPlace]":
        if self.node.id != "sequence":
            _refuse(self.file, self.line, f"{name}: a list wanted")
        return (_YamlPlace(self.file, part) for part in self.node.value)

    def number(self, name: str) -> float:
        if self.node.id != "scalar":
            _refuse(self.file, self.line, f"{name}: a number wanted")
        return _number(self.file, self.line, name, str(self.node.value))

    def numbers(self, name: str, count: int) -> list[float]:
        found = [part.number(name) for part in self.items(name)]
        if len(found) != count:
            _refuse(
                self.file, self.line, f"{name}: {len(found)} values, not {count} as joint_names"
            )
        return found

    def seconds(self) -> float:
        if self.node.id == "scalar":
            return self.number(TIME)
        parts = self.parts()
        for whole, rest in _SECONDS:
            if whole in parts:
                more = parts[rest].number(rest) if rest in parts else 0.0
                return parts[whole].number(whole) + 1e-9 * more
        _refuse(self.file, self.line, f"{TIME}: secs and nsecs, sec and nanosec or a number wanted")
        raise AssertionError


# CCN 22: what a text, a message and its points may be, one after another.
def _of_yaml(file: Path, text: str) -> JointTrajectory:
    needed("ros")
    import yaml

    try:
        texts = [t for t in yaml.compose_all(text, Loader=yaml.SafeLoader) if t is not None]
    except yaml.YAMLError as why:
        mark = getattr(why, "problem_mark", None)
        told = getattr(why, "problem", None) or str(why)
        _refuse(file, mark.line + 1 if mark else 1, f"no YAML: {told}")
    if not texts:
        raise InputError(f"{file}: empty")
    if len(texts) > 1 and texts[1].id == "mapping":
        _refuse(file, texts[1].start_mark.line + 1, "a second message: one trajectory wanted")
    top = _YamlPlace(file, texts[0])
    while inside := next((name for name in _INSIDE if name in top.parts()), None):
        top = top.get(inside)
    names = top.get("joint_names")
    joints = [str(part.node.value) for part in names.items("joint_names")]
    points = list(top.get("points").items("points"))
    position, velocity = [], []
    for point in points:
        parts = point.parts()
        position.append(point.get("positions").numbers("positions", len(joints)))
        rates = parts.get("velocities")
        if rates is not None and any(True for _ in rates.items("velocities")):
            velocity.append(rates.numbers("velocities", len(joints)))
    if velocity and len(velocity) != len(points):
        _refuse(file, top.line, "velocities of all points or of none wanted")
    return JointTrajectory(
        joints,
        np.array([point.get(TIME).seconds() for point in points], dtype=float),
        np.array(position, dtype=float).reshape(len(points), len(joints)),
        np.array(velocity, dtype=float) if velocity else None,
        [point.line for point in points],
    )


def thinned(time: Array, position: Array, tolerance: float) -> NDArray[np.int64]:
    """Indices of points between which straight lines over time leave no point by more."""
    keep = np.zeros(len(time), dtype=bool)
    keep[[0, -1]] = True
    parts = [(0, len(time) - 1)]
    while parts:
        a, b = parts.pop()
        if b - a < 2:
            continue
        share = ((time[a + 1 : b] - time[a]) / (time[b] - time[a]))[:, np.newaxis]
        off = np.abs(position[a + 1 : b] - (position[a] + share * (position[b] - position[a]))).max(
            axis=1
        )
        k = int(off.argmax())
        if off[k] > tolerance:
            keep[a + 1 + k] = True
            parts += [(a, a + 1 + k), (a + 1 + k, b)]
    return np.flatnonzero(keep)


def trajectory_text(joints: Sequence[str], time: Array, position: Array) -> str:
    """A joint trajectory as CSV, in s and rad."""
    rows = [",".join((TIME, *joints))]
    for t, q in zip(time, position, strict=True):
        rows.append(",".join((f"{t:.9g}", *(f"{x:.9f}" for x in q))))
    return "\n".join(rows) + "\n"
