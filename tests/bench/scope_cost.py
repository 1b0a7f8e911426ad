"""What the scope of a live machine costs: a step with 16 channels over a plain one."""

import time
from collections.abc import Callable

from medians import Medians

from motionfmu.live import LiveMachine
from motionfmu.live.live_scope import LiveScope
from motionfmu.live.scope_trigger import TriggerSetting

STEPS = 20_000
TURN = 10  # steps that a loop makes between two looks at what is asked
CHANNELS = [
    *(f"machine.table_position[{k}]" for k in (1, 2)),
    *(f"mcc.position[{k}]" for k in (1, 2)),
    *(f"drives.torque[{k}]" for k in (1, 2)),
    *(f"drives.speed[{k}]" for k in (1, 2)),
    *(f"card.err_count[{k}]" for k in (1, 2)),
    *(f"card.dac[{k}]" for k in (1, 2)),
    *("mcc.path_feed", "mcc.line", "mcc.status", "mcc.done"),
]


class ScopeCost:
    """Times of a step [s]: as the C program makes it, in turns, with the scope."""

    def __init__(self) -> None:
        self._machine = LiveMachine("circle")
        self._scopes = [LiveScope(self._machine, lambda found: None) for _ in range(2)]
        self.step = Medians()

    def __call__(self) -> None:
        """Time the three one behind the other."""
        self.step.add("whole", self._timed(lambda: self._machine.step(STEPS)))
        for name, scope in zip(("plain", "traced"), self._scopes, strict=True):
            if name == "traced":
                scope.channels([])
                scope.channels(CHANNELS)
                scope.trigger(TriggerSetting("mcc.path_feed", "rise", 1e6))

            def turns(scope: LiveScope = scope) -> None:
                for _ in range(STEPS // TURN):
                    scope.fill(TURN)

            self.step.add(name, self._timed(turns))

    def _timed(self, run: Callable[[], None]) -> float:
        begin = time.process_time()
        run()
        return (time.process_time() - begin) / STEPS
