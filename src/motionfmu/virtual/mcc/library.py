"""Return codes of the MCC library's calls, and the error of a refused call."""

AXES = 6

# Return codes of the library: name and meaning.
CODES = {
    -1: ("INITIAL_MOTION", "init_motion has not been called"),
    -2: ("COMMAND_BUFFER_FULL", "the command ring is full: let the task run"),
    -3: ("COMMAND_NOTACCEPTED", "not accepted now: a part program runs, or axes are moved by hand"),
    -4: ("COMMAND_NOTFINISHED", "allowed at standstill only"),
    -5: ("PARAMETER", "a value is out of range, or the axis is not used"),
    -6: ("GROUP_PARAMETER", "no such group"),
    -7: ("FEED_RATE", "the feed is out of range or drives an axis above its safe speed"),
    -9: ("VOLTAGE_COMMAND_CHANNEL", "the DAC is the voltage command of an axis"),
    -10: ("HOME_COMMAND_NOTCALLED", "no search of the origin has been started"),
    -11: ("HOLD_ILLEGAL", "nothing moves that could be held"),
    -12: ("CONTI_ILLEGAL", "nothing is held"),
    -13: ("ABORT_ILLEGAL", "nothing moves that could be dropped"),
    -14: ("RUN_TIME", "a run-time error waits for clear_error, or its cause lasts"),
    -15: ("ABORT_NOT_FINISH", "an abort is still ramping to rest"),
    -16: ("GROUP_RAN_OUT", "there are no more groups"),
}


class MccError(RuntimeError):
    """A call the library has refused; it has changed nothing.

    Attributes
    ----------
    call : str
        Name of the function.
    code : int
        Its return code, below 0; a key of ``CODES``.
    """

    def __init__(self, call: str, code: int) -> None:
        name, meaning = CODES.get(code, ("", "unknown code"))
        super().__init__(f"{call} returns {code} {name}: {meaning}")
        self.call, self.code = call, code
