"""The exceptions for everything a user can get wrong, or can miss."""


class InputError(ValueError):
    """Wrong input; the text is the message a user reads.

    The message says file, line and value where they exist. The console command prints it and
    ends with status 2.
    """


class NoNumber(InputError):
    """A run has no such number; the text is the reason.

    A check of it has failed; in a study its cell is empty.
    """
