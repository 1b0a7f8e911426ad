"""A program of the MCC library on the virtual card.

examples/virtual_card/virtual_card.c does the same.
"""

import sys
from pathlib import Path

from motionfmu.virtual.mcc import CCW, LOOP, MccError, VirtualCard


def run(card: VirtualCard) -> None:
    """Run and print ten times a second until all rests."""
    stopped = False
    while not stopped:
        r = card.run(0.1)
        x, y, z = r.table[:3]
        print(
            f"{r.time:6.1f} s  X {x:9.4f}  Y {y:9.4f}  Z {z:9.4f} mm"
            f"  F {r.path_feed:6.2f} mm/s  stock {r.stock[0]}"
        )
        stopped = r.stopped
    x, y, z = r.pulses[:3]
    print(f"pulses {x} {y} {z}, interrupts {r.interrupts}, underflows {r.underflows[0]}")


def main() -> None:
    """Lines and a circle by calls, then a part program if named."""
    card = VirtualCard(output_mode=[LOOP, 0, 0, 0, 0, 0], p_gain=[200, 60, 60, 60, 60, 60])
    mcc = card.mcc

    mcc.set_abs()
    mcc.set_fspd(25.0)
    mcc.set_acc_type("S")
    mcc.enable_quit()
    mcc.line([20, 10, 0, 0, 0, 0])
    mcc.circle_xy([20, 15], CCW)
    mcc.ptp([0, 0, 0, 0, 0, 0])
    try:
        mcc.set_fspd(0.0)
    except MccError as error:
        print(f"a feed of 0 is refused: {error.code}")
    run(card)

    if len(sys.argv) > 1:
        mcc.task_start(Path(sys.argv[1]).read_text())
        run(card)


if __name__ == "__main__":
    main()
