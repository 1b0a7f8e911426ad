"""Canned cycles: one block of G73 or G81 .. G89 as rapids, feeds, dwells and switches."""

from collections.abc import Callable

from second.frames import end_from, machine, origin, plane_axes, program
from second.moves import straight
from second.parameters import Wrong
from second.state import State, Step
from second.words import Words

STEP_BACK_MM, STEP_BACK_INCH = 0.254, 0.010 * 25.4  # [mm] of G73 and G83
PECKED, DWELLING = (730, 830), (820, 840, 740, 860, 880, 890)
FIXED = 3  # overrides of feed and spindle


class Cycle:
    """One block of a cycle, in the coordinates of the program."""

    def __init__(self, s: State, w: Words, outputs: Callable[[State], None]) -> None:
        self.line = w
        self.s, self.words, self.outputs = s, w.use("xyzrqplijk"), outputs
        self.at, self.begin = program(s, s.point), program(s, origin(s, w))
        self.deep = s.plane
        self.r = self.bottom = self.clear = 0.0

    def go(self, rapid: bool, level: float | None = None) -> None:
        """Move to `at`, or along the tool to a level."""
        if level is not None:
            self.at[self.deep] = level
        straight(self.s, machine(self.s, self.at), rapid)

    def dwell(self) -> None:
        """P seconds at rest."""
        if seconds := self.s.sticky.get("p", 0.0):
            step = Step("dwell", self.s.line, tuple(self.s.point), tuple(self.s.point))
            step.dwell = seconds
            self.s.steps.append(step)

    def spindle(self, turning: int, overrides: int) -> None:
        self.s.turning, self.s.overrides = turning, overrides
        self.outputs(self.s)

    def levels(self) -> None:
        """R, bottom and clear level of this block."""
        s, old = self.s, self.at[self.deep]
        unit = s.unit
        names = "xyz"[self.deep]
        for letter in (names, "r", "q", "p", "i", "j", "k"):
            if letter in self.words:
                ms = letter == "p" and s.options.fanuc and "p" in self.line.whole_numbers
                size = (1e-3 if ms else 1.0) if letter == "p" else unit
                s.sticky[letter] = self.words[letter] * size
        if "r" not in s.sticky or names not in s.sticky:
            raise Wrong("cycle without R or depth")
        if s.motion in PECKED and s.sticky.get("q", 0.0) <= 0.0:
            raise Wrong("cycle without Q")
        if s.old_level is None:
            s.old_level = old
        # A way down to R begins at the level from which the series set out, for all of its holes.
        self.r = s.sticky["r"] + (s.old_level if s.incremental else 0.0)
        self.bottom = s.sticky[names] + (self.r if s.incremental else 0.0)
        if self.bottom > self.r:
            raise Wrong("R below the bottom")
        if s.motion == 870 and not {"i", "j", "k"} <= s.sticky.keys():
            raise Wrong("G87 without I, J, K")
        self.clear = max(self.r, s.old_level) if s.old_plane else self.r

    def run(self) -> None:
        """All repeats."""
        s = self.s
        times = self.words.get("l", 1.0)
        if abs(times - round(times)) > 1e-4 or times < 0.9:
            raise Wrong("L")
        self.levels()
        if self.at[self.deep] < self.r:
            self.go(True, self.r)
        axes = plane_axes(self.deep)
        for i in axes:
            self.at[i] = self.begin[i]
        for _ in range(round(times)):
            hole = end_from(s, self.line, self.at)
            for i in axes:
                self.at[i] = hole[i]
            self.go(True)
            self.go(True, self.r)
            self.hole()
            self.go(True, self.clear)

    def hole(self) -> None:
        """From R to the bottom and back, as the cycle says."""
        s, code = self.s, self.s.motion
        turning, overrides = s.turning, s.overrides
        if code == 870:
            self.back()
            return
        if code in PECKED:
            self.pecks(code == 830)
            if s.options.fanuc:
                self.dwell()
            return
        if code in (860, 880) and s.rpm == 0.0:
            raise Wrong("cycle with a spindle at rest")
        if code in (840, 740) and s.rpm * (1 if code == 840 else -1) <= 0.0:
            raise Wrong("spindle the other way round")
        if code in (840, 740) and overrides & FIXED != FIXED:
            self.spindle(turning, overrides | FIXED)
        self.go(False, self.bottom)
        if code in (840, 740):
            self.spindle(-turning, overrides | FIXED)
        if code in DWELLING:
            self.dwell()
        if code == 850:
            self.go(False, self.r)
        if code in (890, 840, 740):
            self.go(False, self.clear)
        if code in (840, 740):
            self.spindle(turning, overrides)
        if code in (860, 880):
            self.spindle(0, overrides)
            if code == 880:
                place = tuple(s.point)
                s.steps.append(Step("stop", s.line, place, place))
            self.go(True, self.clear)
            self.spindle(turning, overrides)

    def back(self) -> None:
        """G87: through the hole with a spindle at rest, aside of its middle, and up from below."""
        s, (a, b) = self.s, plane_axes(self.deep)
        turning = s.turning
        if s.rpm == 0.0:
            raise Wrong("cycle with a spindle at rest")
        ways = [s.sticky["ijk"[i]] for i in range(3)]
        top = ways[self.deep] + (self.bottom if s.incremental else 0.0)
        if top < self.bottom:
            raise Wrong("K below the bottom")
        middle = self.at[a], self.at[b]
        aside = middle[0] + ways[a], middle[1] + ways[b]
        for into in (True, False):
            self.at[a], self.at[b] = aside
            self.go(True)
            if into:
                self.spindle(0, s.overrides)
            self.go(True, self.bottom if into else self.clear)
            self.at[a], self.at[b] = middle
            self.go(True)
            self.spindle(turning, s.overrides)
            if into:
                self.go(False, top)
                self.go(False, self.bottom)
                self.spindle(0, s.overrides)

    def pecks(self, out: bool) -> None:
        """Down in steps of Q, out of the hole or a little back after each."""
        q, depth = self.s.sticky["q"], self.r
        back = STEP_BACK_INCH if self.s.inch else STEP_BACK_MM
        while depth - q > self.bottom + 1e-9:  # an even depth has no empty last step
            depth -= q
            self.go(False, depth)
            if out:
                self.go(True, self.r)
                self.go(True, depth + back)
            else:
                self.go(True, depth + back)
        self.go(False, self.bottom)
