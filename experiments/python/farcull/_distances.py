"""How far objects are apart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Iterator, Literal, Optional, Sequence, Tuple, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import InputError, _arguments, _farcull
from ._collide import ends, pandas

Kind = Literal["objects", "nearest", "all"]

FEATURES: Tuple[str, ...] = _farcull.features
"""Where on its triangle a nearest point lies; edge i goes from corner i to the next."""

INSIDE: Tuple[str, ...] = _farcull.inside
"""Which of two objects lies inside the other: "none"; "a" or "b"; "not closed" if one may be inside the other, which
is not closed; "unknown" if they meet, or if it was not asked for."""


@dataclass(frozen=True)
class Distance:
    """The distance of two objects; with kind="all" the distance of two triangles."""

    objects: Tuple[Any, Any]  # 0-based numbers, or labels
    triangles: Tuple[int, int]  # the first of the nearest pairs; numbered as in Result.pairs
    distance: float  # rounded to nearest; infinity if above the largest double
    squared: Optional[str]  # exact "numerator/denominator" in lowest terms; None without exact=True
    points: Tuple[Tuple[float, float, float], Tuple[float, float, float]]  # nearest points
    weights: Tuple[Tuple[float, float, float], Tuple[float, float, float]]  # barycentric coordinates of the points
    normal: Tuple[float, float, float]  # unit vector from the first point to the second; zeros if the triangles meet
    features: Tuple[str, str]  # features on which the points lie: two of FEATURES
    inside: str  # one of INSIDE


@dataclass(frozen=True, eq=False, repr=False)
class Distances(Sequence[Distance]):
    """Distances, as arrays with a row for each, and as a sequence of :class:`Distance`: ``found[3]`` is a Distance,
    and ``found[found.distance < 1]`` are the Distances below 1."""

    objects: NDArray[Any]  # (k, 2) 0-based numbers, or labels
    triangles: NDArray[np.int64]  # (k, 2) the first of the nearest pairs
    distance: NDArray[np.float64]  # (k,) rounded to nearest; infinity if above the largest double
    squared: NDArray[np.object_]  # (k,) exact texts "numerator/denominator" in lowest terms; None without exact=True
    points: NDArray[np.float64]  # (k, 2, 3) nearest points, each coordinate rounded
    weights: NDArray[np.float64]  # (k, 2, 3) barycentric coordinates of the points
    normals: NDArray[np.float64]  # (k, 3) unit vector from the first point to the second; zeros if the triangles meet
    features: NDArray[np.uint8]  # (k, 2) features on which the points lie, as indices into FEATURES
    inside: NDArray[np.uint8]  # (k,) indices into INSIDE

    def __len__(self) -> int:
        return len(self.distance)

    def __iter__(self) -> Iterator[Distance]:
        for objects, triangles, distance, squared, (p, q), (v, w), normal, (f, g), inside in zip(
            *(column.tolist() for column in vars(self).values())
        ):
            yield Distance(
                tuple(objects), tuple(triangles), distance, squared, (tuple(p), tuple(q)),
                (tuple(v), tuple(w)), tuple(normal), (FEATURES[f], FEATURES[g]), INSIDE[inside],
            )

    @overload
    def __getitem__(self, rows: int) -> Distance: ...
    @overload
    def __getitem__(self, rows: Union[slice, NDArray[Any]]) -> Distances: ...
    def __getitem__(self, rows: Any) -> Any:
        if isinstance(rows, (int, np.integer)):
            row = range(len(self))[rows]
            return next(iter(self[row : row + 1]))
        return Distances(**{name: column[rows] for name, column in vars(self).items()})

    def to_pandas(self) -> Any:
        """A DataFrame with the columns that ``farcull distance --csv`` writes, and then the weights and the
        normal."""
        columns: Dict[str, Any] = {}
        for e, end in enumerate("ab"):
            columns["object_" + end] = self.objects[:, e]
            columns["triangle_" + end] = self.triangles[:, e]
        columns.update(distance=self.distance, squared=self.squared, **ends(self.points, "_a", "_b"))
        for e, end in enumerate("ab"):
            columns["feature_" + end] = np.array(FEATURES)[self.features[:, e]]
        columns["inside"] = np.array(INSIDE)[self.inside]
        for e, end in enumerate("ab"):
            columns.update({f"weight_{end}{i}": self.weights[:, e, i] for i in range(3)})
        columns.update({f"normal_{x}": self.normals[:, i] for i, x in enumerate("xyz")})
        return pandas().DataFrame(columns)

    def __repr__(self) -> str:
        return f"<farcull.Distances: {_arguments.counted(len(self), 'answer')}>"


class DistanceFinder:
    """Finds distances repeatedly, for example in the frames of an animation. Answers are those of :func:`distances`.

    The nearest triangles of one call are the first guess of the next call. This saves time if little moved, but the
    next call may use any other scene. A finder takes the options of :func:`distances` by name. One thread at a
    time may use a finder.
    """

    # The first parameter is positional only, so that an option can have the name `self`.
    def __init__(
        finder, /, *, kind: Kind = "objects", k: int = 1, within: Optional[float] = None,
        self: Union[bool, Sequence[bool]] = False, inside: bool = True,
        threads: int = 0, ignore: Optional[ArrayLike] = None, exact: bool = False,
    ) -> None:
        all_objects, each = _arguments.selves(self)
        limit = _arguments.optional_number("within", within)
        if limit is not None and limit < 0:
            raise InputError("within", f"is {limit}", "give a distance, 0 or more, or None")
        which = _arguments.choice("kind", kind, ("objects", "nearest", "all"))
        wanted = _arguments.integer("k", k, 1, 2**32 - 1)
        if which == "nearest" and (all_objects or any(each)):
            raise InputError("self", "has no meaning with kind nearest", "leave it out, or give another kind")
        if which != "nearest" and wanted != 1:
            raise InputError("k", f"has no meaning with kind {which}", "leave it out, or give kind='nearest'")
        pairs = _arguments.ignored(ignore)
        finder._grouped: Any = None  # triangles of the previous call; None if that call failed
        finder._ignores = len(pairs) > 0
        finder._finder = _farcull.DistanceFinder(
            which, wanted, limit, all_objects, each, _arguments.flag("inside", inside), pairs,
            _arguments.threads(threads), _arguments.flag("exact", exact),
        )

    def find(
        self, V: Optional[ArrayLike] = None, F: Optional[ArrayLike] = None,
        object_starts: Optional[ArrayLike] = None, labels: Optional[ArrayLike] = None, poses: Optional[ArrayLike] = None,
    ) -> Distances:
        """Returns the distances. The parameters are those of :func:`distances`. Poses alone move the arrays of the
        previous call. The finder can be used again after an error, and after Ctrl-C."""
        before, self._grouped = self._grouped, None
        if labels is not None and self._ignores:
            raise InputError("labels", "have no meaning with the ignored numbers of a DistanceFinder",
                             "sort the triangles by label and give object_starts, or call farcull.distances")
        return self._find(*_arguments.arrays(V, F, object_starts, labels, poses, before))

    def _find(self, grouped: _arguments.Grouped, given: _arguments.Arrays) -> Distances:
        found = _arguments.ask(self, self._finder, grouped, given)
        found["squared"] = np.array(found["squared"] or [None] * len(found["distance"]), dtype=object)
        if grouped.order is not None:
            found["triangles"] = grouped.order[found["triangles"]]
        if grouped.labels is not None:
            found["objects"] = grouped.labels[found["objects"]]
        return Distances(**found)


def distances(
    V: ArrayLike, F: ArrayLike, object_starts: Optional[ArrayLike] = None, kind: Kind = "objects",
    k: int = 1, within: Optional[float] = None, self: Union[bool, Sequence[bool]] = False, inside: bool = True, threads: int = 0,
    labels: Optional[ArrayLike] = None, ignore: Optional[ArrayLike] = None,
    poses: Optional[ArrayLike] = None, exact: bool = False,
) -> Distances:
    """Returns the distances of objects and their nearest points. For many frames, keep a :class:`DistanceFinder`.

    Parameters
    ----------
    V, F, object_starts, labels, poses: as in :func:`collide`. With ``labels`` the objects of an answer are labels.
    kind: "objects": of every two objects; "nearest": of each object and its ``k`` nearest others; "all": every pair
        of triangles at the distance ``within`` or less.
    k: how many nearest objects to find, 1 or more; only with "nearest".
    within: larger distances are left out. World units, 0 or more; None: no limit. "all" needs a limit.
    self: True: each object is measured against itself as well, without neighbours (triangles that share a vertex
        position); or one truth value for each object. Not with "nearest".
    inside: True: find out by winding numbers if an object lies inside another.
    threads: up to 1024; 0: one for each core.
    ignore: pairs of different objects that get no answer, as in :func:`collide`; not with "nearest".
    exact: True: also give ``squared``. With "all", each number is then the exact value, rounded once; this takes about
        ten times as long. False, with "all": the pairs are exact. A distance is 0 only if the triangles meet, and has a
        relative error of at most 2^-32. The error of a normal is at most 2^-15. A point is off its triangle by at most
        2^-45 of the pair's extent. If several points are almost equally near, True and False may give different points.

    Returns :class:`Distances`, sorted by objects, then by triangles; with ``labels`` in the order of the labels.
    Raises InputError for a wrong argument, and if there is nothing to measure. Raises MemoryError.
    """
    grouped, given = _arguments.arrays(V, F, object_starts, labels, poses)
    finder = DistanceFinder(
        kind=kind, k=k, within=within, self=self, inside=inside, threads=threads, ignore=grouped.ignored(ignore), exact=exact,
    )
    return finder._find(grouped, given)
