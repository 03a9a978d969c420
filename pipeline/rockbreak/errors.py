"""The one error type of the Python side, and the exit codes (the same as those of the executables)."""

BAD_INPUT = 2
NUMERICAL_FAILURE = 3
IO_FAILURE = 4


class RockbreakError(Exception):
    """An error whose message tells the user where it is, what was found and what was expected. `reason`: the same for a
    reader who has not seen what a child said before."""

    def __init__(self, code, message, reason=None):
        super().__init__(message)
        self.code = code
        self.reason = reason or message


class Interrupted(Exception):
    """A signal asked the driver to end; the exit code is 128 + the signal's number."""

    def __init__(self, signum):
        super().__init__(f"signal {signum}")
        self.reason = str(self)
        self.signum = signum
        self.code = 128 + signum


def cannot(what, path, error):
    """What the system said of a file, as an error that names the file."""
    return RockbreakError(IO_FAILURE, f"{path}: cannot {what}: {error.strerror or error}")
