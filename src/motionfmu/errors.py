"""The one exception for everything a user can get wrong."""


class InputError(ValueError):
    """Wrong input; the text is the message a user reads.

    The message says file, line and value where they exist. The console command prints it and
    ends with status 2.
    """
