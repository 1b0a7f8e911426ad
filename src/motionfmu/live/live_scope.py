"""The oscilloscope of a live machine: channels at every step, a trigger, records in files."""

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.live.file_record import FileRecord, RecordHead
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.sample_ring import SampleRing
from motionfmu.live.scope_trigger import ScopeTrigger, TriggeredRecording, TriggerSetting

KEPT = 8  # triggered recordings that can be had again
FILES = 4  # records that are written at a time


class LiveScope:
    """Makes a machine's steps and looks at its channels."""

    def __init__(
        self, machine: LiveMachine, triggered: Callable[[TriggeredRecording], None]
    ) -> None:
        self._machine, self._triggered = machine, triggered
        self.ring = machine.ring(())
        self._trigger: ScopeTrigger | None = None
        self._ending: list[ScopeTrigger] = []  # recordings that had begun before something changed
        self._files: list[tuple[FileRecord, SampleRing]] = []
        self.recordings: deque[TriggeredRecording] = deque(maxlen=KEPT)

    def fill(self, count: int) -> None:
        """Make steps; look at the trigger, pass on what is recorded."""
        rings: dict[int, SampleRing] = {id(self.ring): self.ring}
        rings |= {id(t.ring): t.ring for t in self._ending}
        rings |= {id(ring): ring for _, ring in self._files}
        try:
            self._machine.fill(list(rings.values()), count)
        finally:
            self._look()

    def _look(self) -> None:
        while self._trigger is not None and (found := self._trigger.look()) is not None:
            self._tell(found)
            if self._trigger.setting.mode == "single":
                self._trigger = None
        for trigger in list(self._ending):
            if (found := trigger.look()) is not None:
                self._ending.remove(trigger)
                self._tell(found)
        for record, ring in self._files:
            record.write(ring)
        self._files = [(r, ring) for r, ring in self._files if not r.complete]

    def _tell(self, found: TriggeredRecording) -> None:
        self.recordings.append(found)
        self._triggered(found)

    def channels(self, names: Sequence[str]) -> None:
        """Look at other channels from now on; what has begun goes on with the old ones."""
        names = list(dict.fromkeys(names))
        if tuple(names) == self.ring.channels:
            return
        ring = self._machine.ring(names)
        self._disarm()
        self.ring = ring

    def trigger(self, setting: TriggerSetting | None) -> None:
        """Wait for something else, or for nothing."""
        made = None if setting is None else ScopeTrigger(setting, self.ring)
        self._disarm()
        self._trigger = made

    def _disarm(self) -> None:
        if self._trigger is not None and self._trigger.state == "recording":
            self._ending.append(self._trigger)
        self._trigger = None

    def back(self) -> None:
        """The machine has gone back; a recording that has begun ends there."""
        rings = {id(r): r for r in (self.ring, *(t.ring for t in self._ending))}
        rings |= {id(ring): ring for _, ring in self._files}
        for trigger in filter(None, (*self._ending, self._trigger)):
            if (found := trigger.last()) is not None:
                self._tell(found)
        for ring in rings.values():
            ring.cut(self._machine.steps)
        for record, _ in self._files:
            record.cut(self._machine.steps)
        self._ending.clear()
        if self._trigger is not None:
            self._trigger.back()

    def record(self, file: Path, begin: int | None, end: int | None) -> int:
        """Write the channels into a file from a step on; the first that is there."""
        if not self.ring.channels:
            raise InputError(f"{file}: the scope has no channels: choose them first")
        if len(self._files) >= FILES:
            raise InputError(f"{file}: {FILES} records are written at a time")
        ring, units = self.ring, self._machine.unit
        first = ring.end if begin is None else max(begin, ring.begin)
        if first > ring.end or (end is not None and end <= first):
            raise InputError(
                f"{file}: steps {first} to {end}: there are {ring.begin} to {ring.end}"
            )
        head = RecordHead(ring.channels, [units(c) for c in ring.channels], self._machine.step_ns)
        record = FileRecord(file, head, first, end)
        self._files.append((record, ring))
        self._look()
        return first

    def end_records(self) -> list[FileRecord]:
        """End the records in files, which are whole soon."""
        ended = [record for record, _ in self._files]
        for record in ended:
            record.end()
        self._files.clear()
        return ended

    def state(self) -> Mapping[str, Any]:
        """What it does: trigger and records."""
        trigger = self._trigger.state if self._trigger else "off"
        trigger = "recording" if self._ending and trigger == "off" else trigger
        writing = [{"file": r.name, "rows": r.rows} for r, _ in self._files]
        return {"trigger": trigger, "recording": writing}

    def seen(self) -> dict[str, dict[str, float]]:
        """Least and largest value of each channel over what is in the ring."""
        _, rows = self.ring.since(self.ring.begin)
        if not len(rows):
            return {}
        low, high = np.min(rows, axis=0), np.max(rows, axis=0)
        pairs = zip(self.ring.channels, low, high, strict=True)
        return {name: {"low": float(a), "high": float(b)} for name, a, b in pairs}
