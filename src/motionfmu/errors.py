"""The exceptions for everything a user can get wrong, or can miss."""


class InputError(ValueError):
    """Wrong input; the text is the message a user reads.

    The message says file, line and value where they exist, on one line. The console command
    prints it and ends with status 2.

    Parameters
    ----------
    text : str
        What cannot be printed, such as an end of line in a name, is shown by its escape.
    """

    def __init__(self, text: str) -> None:
        super().__init__("".join(c if c.isprintable() else repr(c)[1:-1] for c in text))


class NoNumber(InputError):
    """A run has no such number; the text is the reason.

    A check of it has failed; in a study its cell is empty.
    """
