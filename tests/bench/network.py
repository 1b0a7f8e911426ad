"""What a short line of a drawing costs from the file to the job, and a card that plays it."""

import time

import numpy as np
from card_links import flash_with
from medians import Medians

from motionfmu.cards.config import read
from motionfmu.cards.plan import plan
from motionfmu.cards.sim import VirtualNetCard
from motionfmu.drawings import plt

SEGMENTS = 100_000
CARDS = 100
SECONDS = 2.0  # of a card's motion
AXIS = """
pulses_per_mm = 800
minimum = -1000
maximum = 1000
speed_max = 200
acceleration_max = 1000
jerk_max = 50000
"""


def drawing() -> bytes:
    """A closed curve again and again, rounded to the plotter's units: 0.05 mm a line."""
    t = 2.0 * np.pi * np.arange(SEGMENTS + 1) / 6000
    r = 320.0 * (np.exp(np.cos(t)) - 2.0 * np.cos(4.0 * t) + np.sin(t / 12.0) ** 5)
    points = np.round(np.stack([r * np.cos(t), r * np.sin(t)], axis=1)).astype(int).tolist()
    return b"IN;SP1;PU%d,%d;PD" % tuple(points[0]) + b",".join(b"%d,%d" % (x, y) for x, y in points)


class Network:
    """Processor time of each [s]: a segment parsed, one planned, a simulated second of the card."""

    def __init__(self) -> None:
        self.text = drawing()
        axes = "".join(f'[[axes]]\nname = "{name}"{AXIS}' for name in "XY")
        self.config = read(axes, "card.toml")
        self.rounds = Medians()

    def __call__(self) -> None:
        start = time.process_time()
        read = plt.parse(self.text, "lines.plt")
        parsed = time.process_time()
        job = plan(read, self.config).job
        planned = time.process_time()
        self.rounds.add("parse", (parsed - start) / SEGMENTS)
        self.rounds.add("plan", (planned - parsed) / SEGMENTS)
        actions, deaf = [1] + [0] * 15, [0] * 16
        card = VirtualNetCard(1, flash=flash_with(job), in_action=actions, in_debounce_us=deaf)
        card.set_inputs(1)
        card.run(500_000_000)
        begin, at = time.process_time(), card.now
        for k in range(1, round(SECONDS * 100) + 1):
            card.run(at + 10_000_000 * k)
        self.rounds.add("card", (time.process_time() - begin) / SECONDS)
        assert card.state.name == "RUNNING" and card.pulses[0]

    def table(self) -> None:
        """Cost of a segment, and of a card."""
        print(f"\n{'one line of a drawing':28}{'ns':>10}{'million/s':>11}")
        for name, key in (("parsed", "parse"), ("planned", "plan")):
            cost = self.rounds[key]
            print(f"{name:28}{cost * 1e9:10.0f}{1e-6 / cost:11.2f}")
        print(f"{'network card, ns a ms':28}{self.rounds['card'] * 1e6:10.0f}")
