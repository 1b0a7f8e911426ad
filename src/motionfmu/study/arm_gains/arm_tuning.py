"""Tune the drives of an arm: search, margins in the worst poses, runs of the program."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np

from motionfmu.analysis.linear import Margins, margins
from motionfmu.analysis.linear.stability import closed_poles, moving
from motionfmu.arm_machines.machine_arm import CONTROLLER
from motionfmu.base.errors import InputError
from motionfmu.run import Scenario
from motionfmu.scenarios.values import later
from motionfmu.study.arm_gains.arm_follow import HIDING, ArmFollow, RestWay, followed, signals
from motionfmu.study.arm_gains.arm_poses import Array, ranges, spread
from motionfmu.study.arm_gains.arm_search import (
    ArmSearch,
    FoundGains,
    PeakLimits,
    PoseResponses,
)
from motionfmu.study.arm_gains.joint_loops import JOINTS, JointLoops, arm_names
from motionfmu.study.tune.problem import Problem, problem

# What the search leaves out of a problem, for it has no meaning for an arm.
ARM_KEYS = {"velocity", "axes", "limits", "poses", "feed_forward"}
ARM_LIMITS = {"margins", "swing"}
# Shares of the command speed, and times of its filter [s], that are tried on the program: the speed
# of single pulses, unfiltered, is torque up to the limit.
FORWARD, FILTER = (0.0, 0.5, 0.7, 0.8, 0.9, 1.0), (0.0, 2e-3)
FED = ("feed_forward", "feed_forward_time")
# A trial is no worse than the best if its deviation is larger by less than this share.
SAME = 0.01
# A peak counts as kept if it is over its limit by less than this share: it is read on a grid.
ROUNDING = 2e-3


@dataclass(frozen=True)
class JointGains:
    """A joint with gains, in the pose that is worst for it.

    Attributes
    ----------
    joint : int
        From 1.
    pose : ndarray, shape (6,)
        [deg]
    margins : Margins
        Of its loop there, those of the others closed.
    sensitivity, swing : float
        Largest |1/(1 + L)| and |link/command| of it in any pose.
    """

    joint: int
    pose: Array
    margins: Margins
    sensitivity: float
    swing: float


@dataclass(frozen=True)
class ArmVerdict:
    """Whether gains keep the limits in all poses, and where least.

    Attributes
    ----------
    joints : tuple of JointGains
    unstable : int
        Poses in which the six closed loops are unstable.
    over : float
        The largest peak over its limit.
    """

    joints: tuple[JointGains, ...]
    unstable: int
    over: float

    @property
    def kept(self) -> bool:
        """Whether all poses are stable and within the limits."""
        return self.unstable == 0 and self.over <= 1.0 + ROUNDING


@dataclass
class ArmTuned:
    """Gains of an arm, and what they are worth before and after.

    Attributes
    ----------
    loops : JointLoops
    limits : PeakLimits
    ends : ndarray, shape (2, 6)
        Between which poses lie [deg].
    found : FoundGains
    inertia : ndarray, shape (2, 6)
        Least and largest that each motor moves [kg.m2].
    before, after : ArmVerdict
    runs : tuple of ArmFollow
        Of the program with the present gains and those found; empty without a program.
    forward : dict
        RMS deviation of the tool [mm], and largest share of a torque limit, by the share of the
        speed fed forward and the time of its filter [s]; of an alarm nothing.
    share : tuple or None
        That share and time as found.
    seconds : float
    """

    loops: JointLoops
    limits: PeakLimits
    ends: Array
    found: FoundGains
    inertia: Array
    before: ArmVerdict
    after: ArmVerdict
    runs: tuple[ArmFollow, ...] = ()
    forward: Mapping[tuple[float, float], tuple[float, float]] = field(default_factory=dict)
    share: tuple[float, float] | None = None
    seconds: float = 0.0

    @property
    def settings(self) -> dict[str, Any]:
        """The gains as a scenario takes them."""
        values: dict[str, Any] = self.loops.settings(self.found.gains)
        if self.share is not None:
            for name, value in zip(FED, self.share, strict=True):
                values[f"{self.loops.drives}.{name}"] = value
        return values

    @cached_property
    def slowest(self) -> int:
        """The joint that bears the least position gain, from 1."""
        return int(self.found.own.argmin()) + 1

    def toml(self) -> str:
        """The gains as a file for ``--set``.

        Returns
        -------
        str
        """
        lines = [f"# Gains of {self.loops.scenario.name} by motionfmu tune, for all poses."]
        lines += [f'"{name}" = {value}' for name, value in self.settings.items()]
        return "\n".join(lines) + "\n"

    def numbers(self) -> dict[str, Any]:
        """Every figure for JSON.

        Returns
        -------
        dict
        """
        sides = {"before": self.before, "after": self.after}
        follow = dict(zip(("before", "after"), self.runs, strict=False))
        return {
            "scenario": self.loops.scenario.name,
            "gains": self.settings,
            "present": self.loops.settings(self.loops.present),
            "limits": {"sensitivity": self.limits.sensitivity, "swing": self.limits.swing},
            "poses": {"looked_at": len(self.found.arm), "of_search": len(self.found.active)},
            "slowest_joint": self.slowest,
            "own_position_gain": self.found.own.tolist(),
            "inertia": {"low": self.inertia[0].tolist(), "high": self.inertia[1].tolist()},
            "verdict": {n: _verdict(v) for n, v in sides.items()},
            "runs": {n: _run(f) for n, f in follow.items()},
            "feed_forward": [[*k, *v] for k, v in self.forward.items()],
            "seconds": self.seconds,
        }


def _verdict(verdict: ArmVerdict) -> dict[str, Any]:
    joints = []
    for j in verdict.joints:
        m = j.margins
        row: dict[str, Any] = {"joint": j.joint, "worst_pose": j.pose.tolist()}
        row |= {"sensitivity": j.sensitivity, "swing": j.swing, "stable": m.stable}
        row |= {"gain_margin": _finite(m.gain), "phase_margin": _finite(m.phase)}
        joints.append(row | {"bandwidth_hz": m.bandwidth / (2.0 * np.pi)})
    return {"kept": verdict.kept, "unstable_poses": verdict.unstable, "joints": joints}


def _finite(x: float) -> float | None:
    return float(x) if np.isfinite(x) else None


def _run(follow: ArmFollow) -> dict[str, Any]:
    return {
        "deviation_rms_mm": follow.rms,
        "deviation_max_mm": follow.max,
        "behind_deg": follow.lag.tolist(),
        "torque_share": follow.torque.tolist(),
        "alarm": follow.alarm,
    }


def is_arm(scenario: Scenario) -> bool:
    """Whether a scenario has an arm with drives and controller.

    Parameters
    ----------
    scenario : Scenario

    Returns
    -------
    bool
    """
    return arm_names(scenario) is not None


def verdict(
    search: ArmSearch, arm: PoseResponses, gains: Array, ends: Array
) -> tuple[ArmVerdict, PoseResponses, Array]:
    """Judge gains in all poses and in those where each joint is worst.

    Parameters
    ----------
    search : ArmSearch
    arm : PoseResponses
        Poses to begin with.
    gains : (3, 6) ndarray
    ends : (2, 6) ndarray
        Between which the worst poses are looked for [deg].

    Returns
    -------
    ArmVerdict
    PoseResponses
        The poses that were looked at.
    ndarray
        Their peaks, (2, n, 6).
    """
    loops = search.loops
    arm, peaks, worst = search.worst(arm, gains, ends)
    joints = []
    for j, where in zip(JOINTS, worst, strict=True):
        pose = arm.poses[where]
        told = margins(loops.at(pose, j, gains).loop(f"{loops.drives}.phase"))
        joints.append(JointGains(j, pose, told, *peaks[:, :, j - 1].max(axis=1).tolist()))
    unstable = sum(not _stable(loops, pose, gains) for pose in arm.poses)
    over = float(search.limits.over(peaks).max())
    return ArmVerdict(tuple(joints), unstable, over), arm, peaks


def _stable(loops: JointLoops, pose: Array, gains: Array) -> bool:
    """Whether the six closed loops are, by their poles."""
    poles = closed_poles(loops.at(pose, 1, gains).loop(f"{loops.drives}.phase"))
    return bool(np.abs(moving(poles)).max(initial=0.0) < 1.0)


def tune_arm(
    scenario: Scenario,
    options: Problem | Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
    program: bool = True,
    progress: Callable[[str, float], None] = lambda what, share: None,
) -> ArmTuned:
    """Find gains of an arm's drives that keep limits in all poses.

    Parameters
    ----------
    scenario : Scenario
    options : Problem or mapping, optional
        As in a tune.toml: ``axes``, ``poses``, ``limits.margins.sensitivity``, ``limits.swing``.
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.
    program : bool
        Whether it has a program, by which the feed-forward is found and gains are compared.
    progress : callable
        Called with what is done and the share of it.

    Returns
    -------
    ArmTuned

    Raises
    ------
    InputError
        An option has no meaning for an arm, or no gains keep the limits.
    """
    begun = time.perf_counter()
    asked = options if isinstance(options, Problem) else problem(options or {})
    _check(asked)
    loops = JointLoops(scenario, dict(set or {}))
    ends = ranges(*_ranges(loops))
    bound = asked.limits.margins.sensitivity
    limits = PeakLimits(np.inf if bound is None else bound, asked.limits.swing)
    search = ArmSearch(loops, limits, "axes" not in asked.model_fields_set or asked.axes == "equal")
    progress("poses", 0.0)
    arm = loops.responses(spread(ends, asked.poses))
    found = search.found(arm, ends, lambda share: progress("gains", share))
    gains = np.array([[float(f"{x:.4g}") for x in row] for row in found.gains])
    after, arm, peaks = verdict(search, found.arm, gains, ends)
    found = FoundGains(gains, found.own, arm, peaks, found.active)
    before = verdict(search, arm, loops.present, ends)[0]
    spans = np.array([arm.inertia.min(axis=0), arm.inertia.max(axis=0)])
    tuned = ArmTuned(loops, limits, ends, found, spans, before, after)
    if not after.kept:
        raise InputError(
            f"{scenario.document.file}: no gains keep |1/(1 + L)| <= {limits.sensitivity:g} and"
            f" |link/command| <= {limits.swing:g} in all poses within a twentieth and 20 times the"
            f" present ones: the best found have {after.over:.3g} times as much"
        )
    if program:
        _run_program(tuned, dict(set or {}), progress)
    tuned.seconds = time.perf_counter() - begun
    return tuned


def _check(asked: Problem) -> None:
    """Refuse options that an arm does not have."""
    stated = asked.model_fields_set - ARM_KEYS
    stated |= {f"limits.{n}" for n in asked.limits.model_fields_set - ARM_LIMITS}
    own = asked.limits.margins.model_fields_set - {"sensitivity"}
    if "margins" in asked.limits.model_fields_set:
        stated |= {f"limits.margins.{n}" for n in own}
    if stated:
        raise InputError(
            f"{', '.join(sorted(stated))}: not for the drives of an arm; there are axes, poses,"
            " limits.margins.sensitivity, limits.swing"
        )


def _ranges(loops: JointLoops) -> tuple[Array, Array]:
    """Lowest and highest joint angles [deg]."""
    soft = loops.names[CONTROLLER]
    own = [loops.axes[k].values(soft) for k in JOINTS]
    low, high = (np.array([v[n] for v in own], dtype=float) for n in ("joint_low", "joint_high"))
    return low, high


def _run_program(
    tuned: ArmTuned, given: dict[str, Any], progress: Callable[[str, float], None]
) -> None:
    """Run the program before and after, and find the share of the speed fed forward by runs."""
    loops = tuned.loops
    scenario = loops.scenario.changed(record=signals(loops))
    given = later(given, {f"{loops.arm}.{n}": 0.0 for n in HIDING})
    base = scenario.run(set=given)
    way = RestWay(loops, given, base)
    found = later(given, loops.settings(tuned.found.gains))
    tried: dict[tuple[float, float], ArmFollow] = {}
    pairs = list(product(FORWARD, FILTER))
    for k, pair in enumerate(pairs):
        progress("feed-forward", k / len(pairs))
        fed = {f"{loops.drives}.{n}": v for n, v in zip(FED, pair, strict=True)}
        run = followed(loops, way, scenario.run(set={**found, **fed}))
        if not run.alarm:
            tried[pair] = run
    tuned.forward = {pair: (f.rms, float(f.torque.max())) for pair, f in tried.items()}
    sound = {pair: f for pair, f in tried.items() if f.torque.max() < 1.0} or tried
    if not sound:
        return
    least = min(f.rms for f in sound.values())
    tuned.share = min(pair for pair, f in sound.items() if f.rms <= (1.0 + SAME) * least)
    tuned.runs = (followed(loops, way, base), sound[tuned.share])
