"""A Grbl session: bytes in, bytes out, and what it asks of the machine in between.

It does no I/O and knows no clock: `receive` takes bytes, `observe` a look at the machine, `sent`
gives what is to be sent. Lines go to the library ahead of its motion and are answered in their
order, each once: when the library has read it, or, if Grbl waits there, when its motion has ended.
"""

import re
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace

from motionfmu.live.grbl import grbl_block, grbl_codes, grbl_report, line_input
from motionfmu.live.grbl.grbl_block import GrblBlock, GrblState, read_block, refuse
from motionfmu.live.grbl.grbl_codes import GrblAlarm, GrblError, GrblRefusal
from motionfmu.live.grbl.grbl_faults import alarm_of, error_of, fault_text
from motionfmu.live.grbl.grbl_machine import RESTS, MachineOrders, MachineView
from motionfmu.live.grbl.grbl_overrides import GrblOverrides
from motionfmu.live.grbl.grbl_report import GrblFacts, StatusReport
from motionfmu.live.grbl.grbl_settings import TOLERANCE, GrblSettings
from motionfmu.live.grbl.line_input import ROOM, LineInput

DOOR, JOG_CANCEL, SPINDLE_STOP, FLOOD, MIST = 0x84, 0x85, 0x9E, 0xA0, 0xA1
SETTLED = 0.02  # [s] of simulated time in which the library has seen what it was told
CLEARED = 1.0  # [s] in which an error goes that can go
# Lines that come while the machine rests are held back until the sender pauses, or so many are
# there, as Grbl fills its planner before it begins: so the first ones are planned with the others.
# What fills the library's own planner of 256 commands is read under a hold, before anything moves.
PAUSE = 0.02  # [s] of simulated time
PLAN_LINES, PLAN_BYTES = 700, 12000
TEXT = 1000  # [byte] of lines that are given at once; a text variable has 1023
EXACT_STOP = "G61"
_NUMBER = re.compile(r"N[+-]?[0-9.]+")


@dataclass
class _Fence:
    """An order, and when it was first seen to have been carried out."""

    count: int
    clears: bool = True  # an error that is there then, too
    seen: float | None = None

    def age(self, view: MachineView) -> float:
        """Simulated seconds since then; -1 before."""
        if self.seen is None and view.orders >= self.count:
            self.seen = view.time
        return -1.0 if self.seen is None else view.time - self.seen


@dataclass
class _LinesRead:
    """Lines that the library reads under a hold: the number of the last one, and what it has read.

    It is full when it reads no further.
    """

    until: int
    lines: int = -1
    since: float = 0.0

    def ended(self, view: MachineView) -> bool:
        """Whether all are read, or as many as there is room for."""
        if view.lines > self.lines:
            self.lines, self.since = view.lines, view.time
        return view.lines >= self.until or view.time >= self.since + SETTLED


@dataclass
class _SentLine:
    """A line that has not been answered.

    `number` is its number among the lines given to the library, 0 if the answer is known.
    """

    size: int
    number: int = 0
    answer: str = ""
    block: GrblBlock | None = None
    state: GrblState | None = None  # before it

    @property
    def waits(self) -> bool:
        """Whether Grbl answers only when its motion has ended."""
        b = self.block
        return b is not None and not b.jog and (b.probes or b.dwells or b.flow is not None)

    @property
    def bars(self) -> bool:
        """Whether no line behind it may be looked at before it is answered."""
        b = self.block
        return b is not None and (b.probes or b.flow is not None)


class GrblController:
    """A session."""

    def __init__(self, settings: GrblSettings, orders: MachineOrders) -> None:
        self.settings, self.orders = settings, orders
        self.state = GrblState()
        self.input = LineInput()
        self.overrides = GrblOverrides()
        self.report = StatusReport(settings)
        self.view = MachineView()
        self.startup = ["", ""]
        self.info = ""
        self._out: list[str] = []
        self._asked: deque[_SentLine] = deque()
        self._kept_line: tuple[str, int] | None = None  # it waits for those before it
        self._given = self._moves = 0  # lines given; number of the last one that moves
        self._plan: list[str] = []  # lines that are held back
        self._reads: _LinesRead | None = None  # the library reads them under a hold
        self._early: set[int] = set()  # numbers of lines that were answered before they were read
        self._heard, self._fresh = 0.0, False  # time of the latest bytes
        self._names: dict[int, int] = {}  # N of a line by its number
        self._probed = grbl_report.probe_line(grbl_block.ORIGIN, False, False)
        self._asked_status = False
        self.alarm = False
        self._critical = self._check = self._asleep = False
        self._hold = ""  # "hold", "door"
        self._jogging = self._foreign = False  # the library has other modes than lines have set
        self._homing: _Fence | None = None
        self._fence: _Fence | None = None
        self._later: list[str] = []  # lines for the library behind the fence
        self._restarts = False  # what was behind the fence ends with a greeting
        self._stopped = False  # the spindle, by hand
        self._flipped = self._switched = 0  # coolant by hand; number of a later line that says it
        self._first = True
        self._barred = ""  # who else has the machine in hand

    # -- what the transport calls ---------------------------------------------------------------

    def connect(self) -> None:
        """Begin anew for somebody who has opened the port."""
        if self._barred:
            self._restart_barred()
            return
        self._restart(self.settings.homes and not self.view.homed if self._first else self.alarm)
        self._first = False

    def disconnect(self) -> None:
        """Nobody is there: a jog ends, all else goes on."""
        self.input.clear()
        if self._jogging:
            self._cancel_jog()

    def bar(self, who: str) -> None:
        """Somebody else has the machine in hand; or nobody, by an empty name.

        What has been answered is done, a jog ends; further lines are refused.
        """
        if who == self._barred:
            return
        if who:
            self._message(f"{who} has the machine in hand")
            if self._jogging:
                self._cancel_jog()
            self._send_plan()
        else:
            if self._first:
                self._first, self.alarm = False, self.settings.homes and not self.view.homed
            self._foreign = True
            self._raise_fence(clears=False)
        self._barred = who

    def receive(self, data: bytes) -> None:
        """Take bytes."""
        for byte, at_once in line_input.split(data):
            if at_once:
                self._real_time(byte)
                continue
            self._fresh = True
            self.input.put(byte, ROOM - self._taken())
            if byte in b"\r\n":
                self._pull()

    def observe(self, view: MachineView) -> None:
        """Take a look at the machine, and go on."""
        self.view = view
        if self._fresh:
            self._heard, self._fresh = view.time, False
        self._pass_fence()
        if self._fence is None:
            self._notice()
            self._answer()
            self._pull()
            self._begin()
            self._go_on()
        if self._asked_status and not self._critical:
            self._asked_status = False
            self._out.append(self.report.text(self._facts()))

    def sent(self) -> bytes:
        """What is to be sent, once."""
        text, self._out = "".join(self._out), []
        return text.encode("ascii", "replace")

    @property
    def eager(self) -> bool:
        """Whether it wants to look at the machine as soon as can be."""
        asked = self._asked or self._asked_status or self._kept_line
        return bool(asked or self._fence or self._plan or self._reads or self._homing)

    def _tell(self, text: str) -> None:
        self._out.append(text)

    def _message(self, text: str) -> None:
        self._out.append(f"[MSG:{text}]\r\n")

    def _taken(self) -> int:
        """Bytes of lines that would still be in the buffer of a Grbl that reads one at a time."""
        sizes = [a.size for a in self._asked] + ([self._kept_line[1]] if self._kept_line else [])
        return sum(sizes[1:]) + (self.input.begun if sizes else 0)

    # -- state ----------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a line that moves has not ended."""
        return self.view.done < self._moves

    @property
    def waits(self) -> bool:
        """Whether the library has stopped at M0."""
        return self.view.status == RESTS and not (self._hold or self._reads)

    @property
    def name(self) -> str:
        """The state's name without its number."""
        fixed = (
            (self._asleep, "Sleep"),
            (self._homing, "Home"),
            (self.alarm or self._critical, "Alarm"),
            (self._check, "Check"),
            (self._hold == "door", "Door"),
            (self._hold == "hold" or self.waits, "Hold"),
            (self._jogging, "Jog"),
            (self.busy, "Run"),
        )
        return next((name for holds, name in fixed if holds), "Idle")

    @property
    def rests(self) -> bool:
        """Whether a hold has come to rest."""
        view = self.view
        return view.status == RESTS or not self.busy or view.lines == view.done

    def _state_text(self) -> str:
        name = self.name
        if name == "Hold":
            return "Hold:0" if self.rests else "Hold:1"
        if name == "Door":
            return "Door:0" if self.rests else "Door:2"
        return name

    def _facts(self) -> GrblFacts:
        view = self.view
        return GrblFacts(
            state=self._state_text(),
            position=view.position,
            offset=view.offset,
            feed=view.feed,
            speed=view.speed,
            overrides=self.overrides.all,
            coolant=view.coolant,
            blocks=max(0, grbl_report.BLOCKS - (self._given - view.done)),
            room=ROOM - self.input.held - self._taken(),
            pins=view.pins,
            line=self._names.get(view.done + 1, 0) if self.busy else 0,
        )

    # -- real-time bytes ------------------------------------------------------------------------

    def _real_time(self, byte: int) -> None:
        if byte == line_input.RESET and self._barred:
            self._restart_barred()
        elif byte == line_input.RESET:
            self._reset()
        elif self._critical:
            return
        elif byte == line_input.STATUS:
            self._asked_status = True
        elif self._barred:
            return
        elif byte in _KEYS:
            _KEYS[byte](self)
        elif self.overrides.byte(byte):
            self._set_overrides()

    def _set_overrides(self) -> None:
        feed, rapid, spindle = self.overrides.all
        self.orders.set("override", feed / 100)
        self.orders.set("rapid_override", rapid / 100)
        self.orders.set("spindle_override", spindle / 100)

    def _feed_hold(self) -> None:
        if self.name == "Jog":
            self._cancel_jog()
        elif self.name in ("Idle", "Run"):
            self._hold = "hold"
            self.orders.set("hold", True)

    def _cycle_start(self) -> None:
        if self._fence is not None:
            return
        if self.waits:
            front = self._asked[0] if self._asked else None
            if front is not None and front.block is not None and front.block.flow == 0:
                front.answer = "ok"
            self.orders.press("cycle_start")
        elif self._hold and self.rests:
            if self._stopped and self._hold == "hold":
                self._message(grbl_codes.SPINDLE)
            if self._stopped:
                self._by_hand(False, self._flipped)
            self._hold = ""
            self.orders.set("hold", self._reads is not None)

    def _by_hand(self, stopped: bool, flipped: int) -> None:
        """Stop the spindle or not; coolant other than the program has it: 1 mist, 2 flood."""
        self._stopped = stopped
        self.orders.set("spindle_stop", stopped)
        self.orders.set("coolant_flip", flipped)

    def _door(self) -> None:
        self._message(grbl_codes.DOOR)
        if self._homing:
            self._raise(GrblAlarm.HOMING_DOOR)
            self._restart(True)
        elif self.name in ("Idle", "Run", "Hold", "Jog"):
            if self.name == "Jog":
                self._cancel_jog()
            self._hold = "door"
            self.orders.set("hold", True)
            self._by_hand(True, self._flipped ^ self.view.coolant)

    def _jog_key(self) -> None:
        if self.name == "Jog":
            self._cancel_jog()

    def _cancel_jog(self) -> None:
        """Ramp to rest; jogs that are given already are answered and forgotten."""
        for asked in self._asked:
            if asked.block is not None and not asked.answer:
                asked.answer = "ok"
        self._answer()
        self.orders.press("abort")
        self._jogging, self._foreign = False, True
        self._raise_fence()

    def _stop_spindle(self) -> None:
        if self._hold == "hold" and self.rests:
            if self._stopped:
                self._message(grbl_codes.SPINDLE)
            self._by_hand(not self._stopped, self._flipped)

    def _flip(self, bit: int) -> None:
        if self.name in ("Idle", "Run", "Hold", "Jog"):
            self._flipped, self._switched = self._flipped ^ bit, 0
            self._by_hand(self._stopped, self._flipped)

    # -- reset ----------------------------------------------------------------------------------

    def _reset(self) -> None:
        moving = bool(self._homing) or (self.busy and not (self._hold and self.rests))
        if self._homing:
            self._raise(GrblAlarm.HOMING_RESET)
        elif moving and not self._critical:
            self._raise(GrblAlarm.ABORTED)
        self._restart(moving or self.alarm or self._critical or self._asleep)

    def _restart(self, locked: bool) -> None:
        """Drop everything; when the machine rests, greet."""
        held = self._hold or self._reads
        self.input.clear()
        self._asked.clear()
        self._plan.clear()
        self._reads = None
        self._kept_line = None
        self._asked_status = self._critical = self._asleep = self._check = False
        self._homing, self._jogging = None, False
        self.alarm = locked
        self.overrides.reset()
        self._set_overrides()
        self._flipped = 0
        self._by_hand(False, 0)
        self.orders.press("abort")
        if held:
            self.orders.set("hold", False)
        self._hold = ""
        self._restarts = True
        self._raise_fence()

    def _restart_barred(self) -> None:
        """Drop what has not been given to the machine, whose orders are another's; greet."""
        self.input.clear()
        self._asked.clear()
        self._kept_line = None
        self._asked_status = False
        self.report.renew()
        self._tell(grbl_codes.GREETING)
        self._message(f"{self._barred} has the machine in hand")

    def _raise_fence(self, clears: bool = True) -> None:
        """Look at nothing before the library has seen what it was told and rests."""
        self._fence = _Fence(self.orders.count, clears)

    def _pass_fence(self) -> None:
        if self._fence is None:
            return
        view, new = self.view, self._fence.seen is None
        age = self._fence.age(view)
        if age < 0:
            return
        if new and view.error and self._fence.clears:
            self.orders.press("clear_error")
        settled = age >= SETTLED and view.feed == 0 and view.lines == view.done
        if not settled or (view.error and self._fence.clears and age < CLEARED):
            return
        self._fence = None
        self._given = self._moves = view.lines
        self._switched = 0
        self._names.clear()
        self._early.clear()
        self.state = replace(self.state, position=view.position)
        if self._restarts:
            self._restarts = False
            self._greet()
        else:
            self._restore()

    def _greet(self) -> None:
        self.state = grbl_block.restarted(self.state)
        self.report.renew()
        self._foreign = True
        self._restore()
        for line in ("G49", "G92.1", *self._later):
            self._give(line)
        self._later.clear()
        self._tell(grbl_codes.GREETING)
        self.alarm = self.alarm or bool(self.view.error)
        if self.alarm:
            self._message(grbl_codes.LOCK)
        else:
            self._start_up()

    def _start_up(self) -> None:
        """Do the lines that are kept for the start."""
        for text in filter(None, self.startup):
            try:
                self._go(text, read_block(text, self.state))
                answer = "ok"
            except GrblRefusal as refusal:
                answer = str(int(refusal.error))
            self._tell(f">{text}:{_reply(answer)}")

    # -- what the machine does ------------------------------------------------------------------

    def _raise(self, alarm: GrblAlarm, critical: bool = False) -> None:
        self._tell(f"ALARM:{int(alarm)}\r\n")
        self.alarm, self._critical = True, critical
        if critical:
            self._message(grbl_codes.CRITICAL)

    def _notice(self) -> None:
        """Errors, the end of homing, of a jog."""
        view = self.view
        if self._homing:
            self._see_homing()
        elif view.error and not self.alarm:
            alarm = alarm_of(view.error)
            if alarm in (GrblAlarm.PROBE_BEFORE, GrblAlarm.PROBE_MISSED):
                self._probe_failed(alarm)
            else:
                self._raise(alarm, critical=True)
        if self._jogging and not self.busy and not self._asked:
            self._jogging = False
            self._restore()
        if self._flipped and 0 < self._switched <= view.done:
            self._flipped = 0
            self._by_hand(self._stopped, 0)
        if view.refused in self._early:
            self._early.discard(view.refused)
            self._refuse_late()
        if not (self.busy or self._asked) and view.lines == view.done >= self._given:
            self.state = replace(self.state, position=view.position)
            self._given = view.lines
            self._early.clear()

    def _refuse_late(self) -> None:
        """A line that was answered is not driven: nothing behind it may be."""
        self._message(fault_text(self.view.fault))
        self.orders.set("hold", True)
        alarm = GrblAlarm.SOFT_LIMIT if error_of(self.view.fault) is None else GrblAlarm.ABORTED
        self._hold = self._hold or "hold"
        self._raise(alarm, critical=True)

    def _see_homing(self) -> None:
        view = self.view
        if self._homing is None or self._homing.age(view) < SETTLED:
            return
        if view.error:
            self._homing = None
            self._raise(alarm_of(view.error))
            self._ready()
            self._restart(True)
        elif view.homed:
            self._homing, self.alarm = None, False
            self.state = replace(self.state, position=view.position)
            self._ready()
            self._start_up()

    def _ready(self) -> None:
        """Answer the command that has waited."""
        if self._asked:
            self._asked[0].answer = "ok"
            self._answer()

    def _probe_failed(self, alarm: GrblAlarm) -> None:
        self._raise(alarm)
        if alarm == GrblAlarm.PROBE_MISSED:
            self._tell(self._probed_line(False))
        self._ready()
        self.orders.press("clear_error")
        self._raise_fence()

    def _probed_line(self, found: bool) -> str:
        place = self.view.probed if found else self.view.position
        self._probed = grbl_report.probe_line(place, found, self.settings.inches)
        return self._probed

    def _answer(self) -> None:
        """Answer lines from the first on, as far as their answers are known."""
        while self._asked and self._known(self._asked[0]):
            asked = self._asked.popleft()
            self._tell(_reply(asked.answer))
            self._names.pop(asked.number - grbl_report.BLOCKS, None)

    def _known(self, asked: _SentLine) -> bool:
        view = self.view
        if asked.answer:
            return True
        if not asked.number or view.lines < asked.number:
            return False
        if view.refused == asked.number and view.fault:
            self._refused(asked)
            return bool(asked.answer)
        if asked.waits and (view.done < asked.number or asked.block.flow == 0):  # type: ignore[union-attr]
            return False
        self._ended(asked)
        asked.answer = "ok"
        return True

    def _refused(self, asked: _SentLine) -> None:
        """The library does not take a line; those behind it were read as if it had."""
        error = error_of(self.view.fault)
        if error is None:
            self._refuse_late()
            return
        asked.answer = str(int(error))
        self._foreign = True

    def _ended(self, asked: _SentLine) -> None:
        block = asked.block
        assert block is not None
        if block.probes:
            self.state = replace(self.state, position=self.view.position)
            self._tell(self._probed_line(self.view.found))
        if block.flow in (2, 30):
            self.overrides.reset()
            self._set_overrides()
            self._foreign = True
            self._restore()
            self._message(grbl_codes.END)

    # -- lines ----------------------------------------------------------------------------------

    def _blocked(self) -> bool:
        """Whether no line may be looked at now."""
        if self._fence is not None or self._critical or self._asleep or self._homing:
            return True
        return bool(self._hold) or any(a.bars for a in self._asked)

    def _pull(self) -> None:
        while not self._blocked():
            got = self._kept_line or self.input.line()
            if got is None:
                return
            self._kept_line = None
            text, size = got
            if text is not None and self._must_wait(text):
                self._kept_line = (text, size)
                self._send_plan()
                return
            self._line(text, size)

    def _must_wait(self, text: str) -> bool:
        """Commands of Grbl's own are done when all lines before them have been read.

        Lines that do not move are no reason to call it busy: they are waited for.
        """
        if not text.startswith("$"):
            return False
        if self._asked and not self._jogging:
            return True
        quiet = self.view.done >= self._given
        return text not in ("$G", "$X") and not (self.busy or quiet)

    def _line(self, text: str | None, size: int) -> None:
        asked = _SentLine(size)
        self._asked.append(asked)
        try:
            if text is None:
                raise GrblRefusal(GrblError.OVERFLOW)
            refuse(GrblError.LOCKED, bool(self._barred and text) and text not in _TOLD)
            if text.startswith("$"):
                self._command(text, asked)
            elif text:
                self._code(text, asked)
            else:
                asked.answer = "ok"
        except GrblRefusal as refusal:
            asked.answer = str(int(refusal.error))
        self._answer()

    def _code(self, text: str, asked: _SentLine) -> None:
        refuse(GrblError.LOCKED, self.alarm or self._jogging)
        block = read_block(text, self.state)
        asked.block = block
        if not self._check:
            quiet = self.view.done >= self._given
            self._go(text, block, held=bool(self._plan) or quiet)
            asked.number = self._given
            if self._plan and not asked.waits:
                asked.answer = "ok"
                self._early.add(asked.number)
                self._begin()
            else:
                self._send_plan()
            return
        self.state = grbl_block.after(block, self.state)
        asked.answer = "ok"
        if block.flow in (2, 30):
            self._message(grbl_codes.END)

    def _begin(self) -> None:
        """Give what is held back, if there is enough, or nothing more comes."""
        enough = len(self._plan) >= PLAN_LINES or sum(map(len, self._plan)) >= PLAN_BYTES
        paused = not self._fresh and self.view.time >= self._heard + PAUSE
        if self._plan and not self._hold and (enough or paused):
            self._send_plan()

    def _go_on(self) -> None:
        """Let the axes move when the lines that were held back have been read."""
        if self._reads is not None and self._reads.ended(self.view):
            self._reads = None
            self.orders.set("hold", bool(self._hold))

    def _send_plan(self) -> None:
        lines, self._plan = self._plan, []
        if sum(map(len, lines)) + len(lines) > TEXT and not self._hold:
            self._reads = _LinesRead(self._given)
            self.orders.set("hold", True)
        while lines:
            size, count = 0, 0
            while count < len(lines) and size + len(lines[count]) < TEXT:
                size += len(lines[count]) + 1
                count += 1
            self.orders.mdi("\n".join(lines[:count]))
            lines = lines[count:]

    def _go(self, text: str, block: GrblBlock, held: bool = False) -> None:
        """Give the library a line, with what Grbl takes for granted; or hold it back."""
        self._restore()
        line = _NUMBER.sub("", text)
        if block.command == "motion" and "motion" not in block.groups:
            line = f"G{block.modes.motion}{line}"
        if block.action == 100 and "P" not in block.words:
            line += "P0"
        self._give(line, held)
        self.state = grbl_block.after(block, self.state)
        if (block.command == "motion" and block.axes) or block.action in (280, 300):
            self._moves = self._given
        if "coolant" in block.groups:
            self._switched = self._given
        if block.words.get("N"):
            self._names[self._given] = int(block.words["N"])

    def _give(self, line: str, held: bool = False) -> None:
        self._given += 1
        if held:
            self._plan.append(line)
        else:
            self._send_plan()
            self.orders.mdi(line)

    def _restore(self) -> None:
        """Give the library the modes that the lines have set, if it has others."""
        if not self._foreign:
            return
        self._foreign = False
        m = self.state.modes
        feed = f"F{m.feed / m.unit:.6f}" if m.feed and m.feed_mode == 94 else ""
        self._give(f"G{m.plane}G{m.units}G{m.distance}G{m.feed_mode}G{m.system}{feed}")

    # -- commands of Grbl's own -----------------------------------------------------------------

    def _command(self, text: str, asked: _SentLine) -> None:
        asked.answer = "ok"
        key = text[1:2]
        if key == "":
            self._tell(grbl_codes.HELP)
        elif key == "J":
            self._jog(text, asked)
        elif key in _ANY_STATE:
            refuse(GrblError.STATEMENT, len(text) > 2)
            _ANY_STATE[key](self)
        else:
            refuse(GrblError.NOT_IDLE, self.name not in ("Idle", "Alarm"))
            _AT_REST.get(key, GrblController._change_setting)(self, text)

    def _jog(self, text: str, asked: _SentLine) -> None:
        refuse(GrblError.NOT_IDLE, self.name not in ("Idle", "Jog"))
        refuse(GrblError.STATEMENT, text[2:3] != "=")
        block = read_block(text, self.state)
        refuse(GrblError.TRAVEL, self.settings.beyond(block.target))
        words = "".join(f"{grbl_block.AXES[a]}{block.target[a]:.6f}" for a in block.axes)
        self._give(f"G53G1G90G21G94{words}F{block.modes.feed:.6f}")
        self.state = grbl_block.after(block, self.state)
        asked.answer, asked.block, asked.number = "", block, self._given
        self._moves, self._jogging, self._foreign = self._given, True, True

    def _show_settings(self) -> None:
        refuse(GrblError.NOT_IDLE, self.name in ("Run", "Hold"))
        self._out += self.settings.lines()

    def _show_modes(self) -> None:
        self._tell(grbl_report.modes_line(self.state.modes, self.settings.inches))

    def _switch_check(self) -> None:
        if self._check:
            self._message(grbl_codes.DISABLED)
            self._tell(_reply("ok"))
            self._restart(False)
            return
        refuse(GrblError.NOT_IDLE, self.name != "Idle")
        self._check = True
        self._message(grbl_codes.ENABLED)

    def _unlock(self) -> None:
        if self.alarm:
            self.alarm = False
            self._message(grbl_codes.UNLOCKED)

    def _show_offsets(self, text: str) -> None:
        refuse(GrblError.STATEMENT, len(text) > 2)
        lines = grbl_report.offset_lines(self.state, self._probed, self.settings.inches)
        self._out += lines

    def _home(self, text: str) -> None:
        refuse(GrblError.NO_HOMING, not self.settings.homes)
        refuse(GrblError.STATEMENT, len(text) > 2)
        self._asked[-1].answer = ""
        self.orders.press("go_home")
        self._homing = _Fence(self.orders.count)

    def _sleep(self, text: str) -> None:
        refuse(GrblError.STATEMENT, text != "$SLP")
        self._asleep = True
        self._by_hand(True, self._flipped ^ self.view.coolant)
        self._answer()
        self._message(grbl_codes.SLEEPING)

    def _build(self, text: str) -> None:
        if text == "$I":
            self._tell(f"[VER:{grbl_codes.VERSION}.{grbl_codes.BUILD}:{self.info}]\r\n")
            self._tell(f"[OPT:VNM,{grbl_report.BLOCKS},{ROOM}]\r\n")
            return
        refuse(GrblError.STATEMENT, text[2] != "=")
        self.info = text[3:]

    def _restore_defaults(self, text: str) -> None:
        what = text[5:6]
        good = text[:5] == "$RST=" and len(text) == 6 and what in "$#*"
        refuse(GrblError.STATEMENT, not good)
        if what in "$*":
            self.settings.restore()
            self._later.append(EXACT_STOP)
        if what in "#*":
            self.state = GrblState(self.state.modes, self.state.position)
            self._later += [f"G10L2P{k + 1}X0Y0Z0" for k in range(grbl_block.SYSTEMS)]
            self._later += ["#5161=0#5162=0#5163=0", "#5181=0#5182=0#5183=0"]
        if what == "*":
            self.startup, self.info = ["", ""], ""
        self._message(grbl_codes.RESTORING)
        self._tell(_reply("ok"))
        self._restart(self.alarm)

    def _start_lines(self, text: str) -> None:
        if text == "$N":
            self._out += (f"$N{k}={line}\r\n" for k, line in enumerate(self.startup))
            return
        refuse(GrblError.NOT_IDLE, self.name != "Idle")
        which, at = grbl_block.number(text, 2)
        refuse(GrblError.STATEMENT, text[at : at + 1] != "=" or int(which) not in (0, 1))
        line = text[at + 1 :]
        if line:
            self._go(line, read_block(line, self.state))
        self.startup[int(which)] = line

    def _change_setting(self, text: str) -> None:
        which, at = grbl_block.number(text, 1)
        refuse(GrblError.STATEMENT, text[at : at + 1] != "=")
        value, at = grbl_block.number(text, at + 1)
        refuse(GrblError.STATEMENT, at != len(text) or which > 255)
        error = self.settings.change(which, value)
        if error:
            raise GrblRefusal(error)
        if int(which) == TOLERANCE:
            self._give(f"G64P{value / self.state.modes.unit:.6f}" if value else EXACT_STOP)
        self.report.renew()


def _reply(answer: str) -> str:
    return "ok\r\n" if answer == "ok" else f"error:{answer}\r\n"


_TOLD = frozenset(("$", "$$", "$G", "$#", "$I", "$N"))  # commands that only tell something
_ANY_STATE: dict[str, Callable[[GrblController], None]] = {
    "$": GrblController._show_settings,
    "G": GrblController._show_modes,
    "C": GrblController._switch_check,
    "X": GrblController._unlock,
}
_AT_REST: dict[str, Callable[[GrblController, str], None]] = {
    "#": GrblController._show_offsets,
    "H": GrblController._home,
    "S": GrblController._sleep,
    "I": GrblController._build,
    "R": GrblController._restore_defaults,
    "N": GrblController._start_lines,
}
_KEYS: dict[int, Callable[[GrblController], None]] = {
    line_input.HOLD: GrblController._feed_hold,
    line_input.START: GrblController._cycle_start,
    DOOR: GrblController._door,
    JOG_CANCEL: GrblController._jog_key,
    SPINDLE_STOP: GrblController._stop_spindle,
    FLOOD: lambda self: self._flip(2),
    MIST: lambda self: self._flip(1),
}
