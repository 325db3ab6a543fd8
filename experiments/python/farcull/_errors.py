"""The exceptions of the package."""

import errno


class Error(Exception):
    """What farcull raises where it has no answer.

    Attributes: ``where``, the parameter, file or step of a device; ``reason``, what is wrong there;
    ``remedy``, what to do next.
    """

    def __init__(self, where: str, reason: str, remedy: str) -> None:
        super().__init__(where, reason, remedy)
        self.where = where
        self.reason = reason
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.where}: {self.reason}; {self.remedy}"


class InputError(Error, ValueError):
    """An argument is wrong; ``where`` names it."""


class MissingFileError(Error, FileNotFoundError):
    """A file does not exist; ``where`` and ``filename`` name it."""

    def __init__(self, where: str, reason: str, remedy: str) -> None:
        Error.__init__(self, where, reason, remedy)
        self.errno, self.strerror, self.filename = errno.ENOENT, reason, where
