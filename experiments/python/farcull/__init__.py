"""farcull: collision culling that never misses.

Arrays to colliding pairs in three lines::

    import farcull
    result = farcull.collide(V, F, object_starts=[0, 12])  # two objects; the second begins at triangle 12
    print(result.pairs)

``V`` is an array of shape (n, 3), the vertices, in any type of number that a double holds exactly.
``F`` is an array of shape (m, 3), the triangles, as indices of vertices in any type of whole number.
Triangles are closed sets, so touching counts. A degenerate triangle counts as a segment or a point.
Arrays are only read. Each call runs without the lock of the interpreter; Ctrl-C ends the call. A call
that fails raises :class:`InputError` or :class:`Error` with ``where``, ``reason`` and
``remedy``; :class:`MissingFileError`, which is a FileNotFoundError too; or MemoryError.
"""

import errno as _errno
import os

# Makes Mesa's llvmpipe draw without threads, since its threads may damage the memory of this process. Mesa
# reads the variable when a display is opened. A value that the caller has set stays, and reports state the value.
os.environ.setdefault("LP_NUM_THREADS", "0")


class Error(Exception):
    """The exception of a call that fails. Attributes: ``where``, the parameter, file or step of a device;
    ``reason``, what is wrong there; ``remedy``, what to do next."""

    def __init__(self, where: str, reason: str, remedy: str) -> None:
        super().__init__(where, reason, remedy)
        self.where = where
        self.reason = reason
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.where}: {self.reason}; {self.remedy}"


class InputError(Error, ValueError):
    """An argument is wrong; ``where`` names the argument."""


class MissingFileError(Error, FileNotFoundError):
    """A file does not exist; ``where`` and ``filename`` name the file."""

    def __init__(self, where: str, reason: str, remedy: str) -> None:
        Error.__init__(self, where, reason, remedy)
        self.errno, self.strerror, self.filename = _errno.ENOENT, reason, where


try:
    from . import _farcull
except ImportError as error:  # pip cannot install system libraries
    raise ImportError(
        f"{error}. farcull needs libraries of the system (Debian: fonts-dejavu-core libcairo2 libepoxy0 libfmt9 libglib2.0-0 "
        "libgmp10 libharfbuzz0b libhwy1 libpango-1.0-0 libpangocairo-1.0-0 libsqlite3-0 zlib1g)"
    ) from error

_farcull.require_main_interpreter()  # called before numpy is imported, since numpy needs the main interpreter, too

from ._clash import Clash, clash, show
from ._collide import KINDS, Collider, Report, Result, collide, join
from ._distances import FEATURES, INSIDE, Distance, DistanceFinder, Distances, distances
from ._runs import Check, Picture, Record, check, picture
from ._scenes import Frames, Scene, builtin_scenes

__version__ = "0.1"

__all__ = [
    "Check", "Clash", "Collider", "Distance", "DistanceFinder", "Distances", "Error", "FEATURES", "Frames",
    "INSIDE", "InputError", "KINDS", "MissingFileError", "Picture", "Record", "Report",
    "Result", "Scene", "builtin_scenes", "check", "clash", "collide", "distances", "join",
    "picture", "show",
]

del os, _farcull
