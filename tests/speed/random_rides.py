"""Random rides along smooth segments: what they take of their axes' limits, and which too much.

    PYTHONPATH=tests/helpers python tests/speed/random_rides.py --first 0 --count 1000 [-j 2]

Each seed is ridden without and with limited jerk. Exit status 1 if a ride takes more than 1e-6
above a limit, turns back, or does not rest at the end of its path.
"""

import argparse
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor

from speed_rides import at_rest_at_its_end, random_ride, shares

MOST = 1 + 1e-6
PART = 100  # seeds that a process gets at a time
TELL = 5000  # seeds between two words of how far it is

Told = tuple[dict[str, float], list[str]]


def look(seeds: range) -> Told:
    """Most of each limit over these seeds, and a line for each ride that is wrong."""
    most: dict[str, float] = {}
    wrong = []
    for seed in seeds:
        for smooth in (False, True):
            done, bounds, orders = random_ride(seed, smooth)
            taken = shares(done.steps, bounds, orders.dt)
            faults = [f"{name} {share:.9g}" for name, share in taken.items() if not share <= MOST]
            faults += [] if at_rest_at_its_end(done) else ["not at rest at the end"]
            if faults:
                wrong.append(f"seed {seed}, {'jerk' if smooth else 'no jerk'}: {', '.join(faults)}")
            for name, share in taken.items():
                most[name] = max(most.get(name, 0.0), share)
    return most, wrong


def parts(first: int, count: int) -> Iterator[range]:
    """The seeds in parts of PART."""
    for start in range(first, first + count, PART):
        yield range(start, min(start + PART, first + count))


def main() -> int:
    """Ride, and say what was found."""
    asked = argparse.ArgumentParser(description="Random rides along smooth segments")
    asked.add_argument("--first", type=int, default=0, help="first seed")
    asked.add_argument("--count", type=int, default=1000, help="how many seeds")
    asked.add_argument("-j", type=int, default=1, help="processes")
    given = asked.parse_args()
    most: dict[str, float] = {}
    done = bad = 0
    with ProcessPoolExecutor(given.j) as pool:
        for taken, wrong in pool.map(look, parts(given.first, given.count)):
            done += PART
            bad += len(wrong)
            if done % TELL == 0:
                print(f"{done} seeds, {bad} wrong", file=sys.stderr, flush=True)
            print(*wrong, sep="\n", end="\n" if wrong else "", flush=True)
            for name, share in taken.items():
                most[name] = max(most.get(name, 0.0), share)
    last = given.first + given.count - 1
    print(
        f"seeds {given.first} to {last}, {2 * given.count} rides, {bad} wrong; most of each limit:"
    )
    print(*(f"  {name} 1 {share - 1:+.3g}" for name, share in most.items()), sep="\n")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
