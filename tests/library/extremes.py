"""Every public call of the Python bindings with numbers at the ends of what there is.

    python tests/library/extremes.py card|mcc|robot|arm [EVERY]

of which every n-th is made. Each may return or raise an error of the bindings, within a second of
processor time: what takes longer ends this process. A call that is refused must leave the object as
it was, so that a plain move still runs to its end; behind one that returns it has numbers to read.
"""

import contextlib
import inspect
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from itertools import islice
from typing import Any

import numpy as np

from motionfmu.base.binding import Struct
from motionfmu.virtual import mcc, robot

SECONDS = 1.0
REFUSALS = (ValueError, TypeError, mcc.MccError, mcc.CardError, robot.RobotError)
NUMBERS: tuple[Any, ...] = (
    *(float("nan"), float("inf"), -float("inf"), 1e308, -1e308, 5e-324, -5e-324, -0.0),
    *(2**31 - 1, -(2**31), 2**31, 2**63, -(2**63), 10**400, -(10**400)),
    *(np.float32("nan"), np.float64("inf"), np.int64(2**62), np.uint64(2**64 - 1)),
    *(None, True, 1j, "1", b"1", [], [[]], {}, object()),
)
EVERY = int(sys.argv[2]) if len(sys.argv) > 2 else 1
# A clock that is a minute away is no wrong one.
CLOCKS = tuple(x for x in NUMBERS if not (isinstance(x, int | np.integer) and 0 < x < 2**32))

# A good argument by its name, or by the call's and its name.
SIX, TWO, THREE = [0.5] * 6, [0.3, 0.2], [0.1, 0.1, 0.1]
POSE = [600.0, 0.0, 800.0, 180.0, 0.0, 180.0]
GOOD: dict[str, Any] = {
    **dict.fromkeys(("x", "y", "z", "u", "v", "w", "distance", "mm", "ratio", "counts"), 0.5),
    **dict.fromkeys(("via", "end", "centre"), TWO),
    **dict.fromkeys(("target", "origin", "joints", "near", "tool"), SIX),
    **dict.fromkeys(("direction", "axis", "system", "count", "number", "axes", "home"), 1),
    **dict.fromkeys(("pulses", "interval"), 100),
    **dict.fromkeys(("percent", "ms", "feed"), 50.0),
    **dict.fromkeys(("on", "pressed"), True),
    **{"uvw": THREE, "encoder": 7, "clock": 400, "seconds": 1e-3, "limit": 0.05, "step": 1e-4},
    **{"kind": "T", "kinds": "T" * 6, "program": "G1 X1 F600\nM2\n", "folder": None, "merge": 0.1},
    **{"volts": 1.0, "share": 0.5, "frame": 0, "speed": 0.1, "way": 1.0, "zone": 1.0},
    **{"points": "", "language": "gcode", "job": "", "names": ("time",), "name": "home"},
    **{"matrix": np.eye(4), "rows": ([1, 2],), "plane": "xy"},
    **dict.fromkeys(("order", "values"), [1] * 6),
    "numbers": (1, 2),
    **{"set_P_gain.values": [60] * 6, "set_check_OT.on": [0] * 6, "set_inpos_tol.mm": SIX},
    **{"set_ptp_asyn_acc_step.ms": [50.0] * 6, "set_ptp_asyn_dec_step.ms": [50.0] * 6},
    **{"set_dda.ms": 1.0, "set_switches.axes": (1,), "jog.direction": [0.0, 0.0, 1.0, 0, 0, 0]},
    **{"move_line.target": POSE, "move_circle.target": POSE, "move_circle.via": [600.0, 50, 800]},
    **{"move_pose.target": POSE, "pose_of.matrix": np.eye(4), "matrix_of.pose": POSE},
    **{"inverse.near": None, "override.share": 0.5},
}
TEXTS = ("kind", "kinds", "program", "folder", "points", "language", "job", "name", "names")
MOVES = ("feed", "spin", "share", "zone", "branch", "singular")


def extremes(name: str, good: Any) -> Iterator[Any]:
    """What an argument is given: extreme numbers, alone and within, and too few or too many."""
    yield from CLOCKS if name == "clock" else NUMBERS
    if not isinstance(good, list | tuple | np.ndarray):
        yield from ([1.0] * n for n in (1, 5, 6, 7))
        return
    for number in NUMBERS:
        many: Any = np.array(good, object)
        yield [number] * len(good)
        many.flat[-1] = number
        yield many.tolist()
        if isinstance(number, float | np.floating):
            yield np.array(many, float)
    flat = [1.0] * 300
    yield from (flat[:n] for n in range(8))
    yield from (flat, [good], [good, good], np.ones((2, 0, 6)), np.ones((0, 6)), "111111")


def calls(thing: Any, more: dict[str, tuple[str, ...]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Each public call of an object with one argument that is extreme, the others good."""
    for name in sorted(n for n in dir(thing) if not n.startswith("_")):
        call = getattr(thing, name)
        if not callable(call) or isinstance(call, type):
            continue
        parameters = inspect.signature(call).parameters.values()
        good = {
            p.name: GOOD.get(f"{name}.{p.name}", GOOD.get(p.name, p.default))
            for p in parameters
            if p.kind is not p.VAR_KEYWORD
        }
        unknown = [n for n, v in good.items() if v is inspect.Parameter.empty]
        assert not unknown, f"{name}: GOOD has no {unknown}"
        yield name, good
        for argument in good:
            for extreme in extremes(argument, good[argument]):
                yield name, {**good, argument: extreme}
        for argument in more.get(name, ()):
            for extreme in extremes(argument, [1.0] * 6):
                yield name, {**good, argument: extreme}


def make(call: Callable[..., Any], given: dict[str, Any]) -> None:
    """Call it; a parameter of several values gets them one by one, if they are several."""
    several = [
        p.name
        for p in inspect.signature(call).parameters.values()
        if p.kind is p.VAR_POSITIONAL and p.name in given
    ]
    before = [n for n in given if several and list(given).index(n) < list(given).index(several[0])]
    if not several:
        call(**given)
        return
    value = given[several[0]]
    rest = {n: v for n, v in given.items() if n not in (*before, several[0])}
    call(
        *(given[n] for n in before),
        *(value if isinstance(value, list | tuple) else [value]),
        **rest,
    )


class Watch:
    """Makes calls, each within its time, and says which one it was that went wrong."""

    def __init__(self) -> None:
        self.count = self.refused = 0
        self.wrong: list[str] = []
        signal.signal(signal.SIGPROF, signal.SIG_DFL)  # ends the process wherever it is
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", "[0-9]+ underruns of the card")  # what it tells of a run

    def call(self, what: str, function: Callable[[], Any]) -> bool | None:
        """Whether it returned; a refusal is none, and what is neither is kept, then None."""
        what = what[:200].encode("ascii", "backslashreplace").decode()
        print(what, flush=True)
        self.count += 1
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        try:
            function()
        except REFUSALS as told:
            self.refused += 1
            if not str(told):
                self.wrong.append(f"{what}: refused without a word")
            return False
        except Exception as error:
            self.wrong.append(f"{what}: {type(error).__name__} {error}")
            return None
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)
        return True

    def end(self) -> None:
        """Tell it, and fail if anything was wrong."""
        print(f"{self.count} calls, {self.refused} refused, {len(self.wrong)} wrong")
        sys.exit("\n".join(self.wrong[:100])) if self.wrong else None


def finite(reading: Any) -> None:
    """All numbers of a reading are numbers."""
    for name, value in vars(reading).items():
        known = isinstance(value, str) or np.isfinite(value).all()
        assert known, f"reading {name} = {value}"


def walk(
    new: Callable[[], Any],
    part: Callable[[Any], Any],
    works: Callable[[Any], None],
    after: Callable[[Any], None],
    more: dict[str, tuple[str, ...]],
) -> None:
    """All calls of a part of an object that `new` makes."""
    watch, thing = Watch(), new()
    works(thing)
    for name, given in islice(calls(part(thing), more), 0, None, EVERY):
        what = f"{name}({', '.join(f'{n}={v!r}' for n, v in given.items())})"
        done = watch.call(what, lambda n=name, g=given, o=thing: make(getattr(part(o), n), g))
        if done is not False:
            if watch.call(f"{what}, then", lambda o=thing: after(o)) is False:
                watch.wrong.append(f"{what}: behind it the object does not go on")
            thing = new()
        elif not watch.call(f"{what}, then a move", lambda o=thing: works(o)):
            watch.wrong.append(f"{what}: behind it there is no plain move")
            thing = new()
    watch.end()


def settings(make_one: Callable[..., Any], names: Any, works: Callable[[Any], None]) -> None:
    """An object with one setting that is extreme: it is refused, or there and can be read."""
    watch = Watch()
    for name in names:
        for extreme in islice(extremes(name, [1.0] * 6), 0, None, EVERY):
            made: list[Any] = []
            if watch.call(
                f"{name} = {extreme!r}",
                lambda n=name, x=extreme, m=made: m.append(make_one(**{n: x})),
            ):
                if watch.call(f"{name} = {extreme!r}, then", lambda m=made: works(m[0])) is False:
                    watch.wrong.append(f"{name} = {extreme!r}: taken, and nothing goes on")
    watch.end()


def card_works(card: mcc.VirtualCard) -> None:
    """A plain move runs to its end, to the pulse."""
    before = card.read()
    card.mcc.set_inc()
    card.mcc.line([0.2, -0.1, 0.0, 0.0, 0.0, 0.0])
    reading = card.run_until_stop(5.0)
    moved = reading.pulses - before.pulses
    assert reading.stopped and moved[:3].tolist() == [200, -100, 0], moved


def card_goes_on(card: mcc.VirtualCard) -> None:
    """It runs on, whatever it was told, and what it shows are numbers."""
    card.run(2e-3)
    finite(card.read())
    with contextlib.suppress(mcc.MccError):  # nothing moves
        card.mcc.motion_abort()
    card.run(2e-3)
    finite(card.read())


def mcc_works(plan: mcc.Mcc) -> None:
    """A plain move is planned to the pulse."""
    plan.set_inc()
    plan.line([0.2, -0.1, 0.0, 0.0, 0.0, 0.0])
    assert plan.take(2000).sum(axis=0)[:3].tolist() == [200, -100, 0]


def mcc_goes_on(plan: mcc.Mcc) -> None:
    """It plans on."""
    plan.take(5)
    try:
        assert np.isfinite(plan.get_cpos()).all()
    except mcc.MccError as told:
        assert told.code == -1  # behind close_motion


def robot_works(arm: robot.VirtualRobot) -> None:
    """A plain move of the joints runs to its end."""
    for angle in (1.0, 0.0):
        arm.move_joints([angle, 0.0, 0.0, 0.0, 90.0, 0.0], share=1.0)
        reading = arm.run_until_stop(5.0)
        assert reading.rests and abs(reading.joint[0] - angle) < 1e-2, reading


def robot_goes_on(arm: robot.VirtualRobot) -> None:
    """It runs on, and what it shows are numbers."""
    arm.run(2e-3)
    finite(arm.read())


def main(which: str) -> None:
    """Walk one of the bindings."""
    if which == "card":
        none: dict[str, tuple[str, ...]] = {}
        walk(mcc.VirtualCard, lambda c: c, card_works, card_goes_on, none)
        settings(mcc.VirtualCard, mcc.defaults(), card_goes_on)
    elif which == "mcc":
        more = {"update_param": tuple(Struct("param")), "init_motion": tuple(mcc.defaults())}
        walk(mcc.Mcc, lambda m: m, mcc_works, mcc_goes_on, more)
        walk(mcc.VirtualCard, lambda c: c.mcc, card_works, card_goes_on, more)
    elif which == "robot":
        more = dict.fromkeys(("move_line", "move_circle", "move_pose"), MOVES)
        walk(robot.VirtualRobot, lambda r: r, robot_works, robot_goes_on, more)
        settings(robot.VirtualRobot, robot.defaults(), robot_goes_on)
    else:
        walk(robot.Kinematics, lambda k: k, lambda k: k.forward(SIX), lambda k: k.forward(SIX), {})
        settings(robot.Kinematics, robot.defaults(), lambda k: k.forward(SIX))
        watch = Watch()
        for function in (robot.pose_of, robot.matrix_of):
            (name,) = inspect.signature(function).parameters
            for extreme in extremes(name, GOOD[f"{function.__name__}.{name}"]):
                watch.call(f"{function.__name__}({extreme!r})", lambda f=function, x=extreme: f(x))
        watch.end()


if __name__ == "__main__":
    main(sys.argv[1])
