"""The console command, also as ``python -m motionfmu``; it stands here as nothing is loaded yet."""

import gc
import os
import signal

# Until the commands are loaded Ctrl-C is told by a handler: an exception would end in a traceback
# wherever the import is. A signal that is ignored, as in the background, stays so.
_OURS = signal.getsignal(signal.SIGINT) is signal.default_int_handler


def _stop(number: int, frame: object) -> None:
    os.write(2, b"motionfmu: stopped\n")
    os._exit(128 + number)


if _OURS:
    signal.signal(signal.SIGINT, _stop)

# Threads for matrices as small as those here cost a command a tenth of a second and gain nothing.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# To look for garbage among what imports leave costs a start 2 % of its instructions and finds none.
gc.set_threshold(100_000)


def main() -> None:
    """Entry point: what is half done is taken away on Ctrl-C from here on."""
    from motionfmu import cli

    cli.main(_interruptible)


def _interruptible() -> None:
    if _OURS:
        signal.signal(signal.SIGINT, signal.default_int_handler)


if __name__ == "__main__":
    main()
