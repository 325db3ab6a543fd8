"""Pairs of triangles that collide."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import Error, InputError, _arguments, _farcull

KINDS: Tuple[str, ...] = _farcull.kinds
"""How two triangles A and B meet: the first that is true.

- "apart": no point in common, and within the clearance;
- "equal": the same set of points;
- "touch-vertex": one point in common, which is a corner of A or of B;
- "touch-edge": one point in common, which is on an edge of A and on an edge of B;
- "coplanar": in one plane, and more than one point in common;
- "crossing": a point in common that is on no edge of A and on no edge of B;
- "touch-face": a segment in common that is on an edge of A or of B.
"""


@dataclass(frozen=True)
class Report:
    """Tells which stages ran, and their reasons and times, for people and logs."""

    candidates_ms: float  # wall clock time from the input to the candidates
    exact_ms: float  # wall clock time of the exact tests
    candidates: int  # number of candidates, without pairs of ignored objects
    decided: int  # number of candidates that exact tests decided before the limit was reached
    neighbours: int  # number of decided candidates that are neighbours, colliding or not
    contacts_ms: float  # wall clock time to find the kinds of contact
    passed_over: int  # number of vertices that are not finite and belong to no triangle
    callers_arithmetic: str  # text about unusual rounding or flushing modes of the calling thread; else empty
    stages: List[Dict[str, Any]]


@dataclass(frozen=True, eq=False)
class Result:
    """The pairs that collide. Triangles are numbered from 0 in the order of the input."""

    pairs: NDArray[np.int64]
    """(k, 2): rows sorted, in each the lower number first. Pairs of different objects, and pairs of an object that is
    tested against itself unless they are neighbours."""
    objects: NDArray[Any]
    """(k, 2): the objects of each of ``pairs``, as numbers from 0 or as labels."""
    neighbour_pairs: NDArray[np.int64]
    """Pairs of neighbours, in the same form: triangles of one object that share a vertex position, and that meet in
    more than the shared positions and the edge between them."""
    kinds: Optional[NDArray[np.uint8]]
    """(k,): how each of ``pairs`` meets, as its place in :data:`KINDS`; None unless asked for."""
    neighbour_kinds: Optional[NDArray[np.uint8]]
    """The same for ``neighbour_pairs``."""
    segments: Optional[NDArray[np.float64]]
    """(k, 2, 3): the ends of the segment that each of ``pairs`` has in common, each coordinate rounded once. A common
    point is given twice; NaN stands for no point and for a polygon. None unless asked for."""
    neighbour_segments: Optional[NDArray[np.float64]]
    """The same for ``neighbour_pairs``."""
    complete: bool
    """False: the limit was reached, and more pairs may follow the last one. No pair before it is missing."""
    report: Report
    # Arguments of collide() that show() needs: vertices, grouped triangles, self. None if show() cannot show these pairs.
    _input: Optional[Tuple[Any, Any, Any]] = field(default=None, repr=False)
    _neighbour_objects: Optional[NDArray[Any]] = field(default=None, repr=False)  # None if no objects were given

    def to_pandas(self) -> Any:
        """Returns a DataFrame with a row for each pair, sorted. Columns: ``a``, ``b`` and ``neighbours``; if objects
        were given, ``object_a`` and ``object_b``; with kinds, ``contact``; with segments, ``x0`` to ``z1``, the ends
        of the segment."""
        pairs = np.concatenate([self.pairs, self.neighbour_pairs])
        order = np.lexsort((pairs[:, 1], pairs[:, 0]))
        columns: Dict[str, Any] = {"a": pairs[order, 0], "b": pairs[order, 1], "neighbours": order >= len(self.pairs)}
        if self._neighbour_objects is not None:
            objects = np.concatenate([self.objects, self._neighbour_objects])[order]
            columns.update(object_a=objects[:, 0], object_b=objects[:, 1])
        if self.kinds is not None and self.neighbour_kinds is not None:
            codes = np.concatenate([self.kinds, self.neighbour_kinds])
            columns["contact"] = np.array(KINDS)[codes[order]]
        if self.segments is not None and self.neighbour_segments is not None:
            segments = np.concatenate([self.segments, self.neighbour_segments])
            columns.update(ends(segments[order], "0", "1"))
        return pandas().DataFrame(columns)

    def __getstate__(self) -> Dict[str, Any]:
        """Returns the state for pickle, without the arrays of the call."""
        return {**self.__dict__, "_input": None}

    def __repr__(self) -> str:
        more = "" if self.complete else ", and there may be more"
        pairs = _arguments.counted(len(self.pairs), "pair")
        return f"<farcull.Result: {pairs}, {len(self.neighbour_pairs)} of neighbours{more}>"


def ends(points: NDArray[np.float64], *names: str) -> Dict[str, NDArray[np.float64]]:
    """Returns a column for each coordinate of two points in each row (k, 2, 3)."""
    return {x + name: points[:, e, i] for e, name in enumerate(names) for i, x in enumerate("xyz")}


def pandas() -> Any:
    """Returns the module pandas. Raises Error if it is not installed."""
    try:
        import pandas
    except ImportError:
        raise Error("pandas", "is not installed", "install it, or use the arrays") from None
    return pandas


class Collider:
    """Finds colliding pairs repeatedly, for example in the frames of an animation. Answers are those of :func:`collide`.

    A collider keeps its memory from call to call. If the triangles and objects stay the same, it keeps its results
    about triangles that did not move. One thread at a time may use a collider. Options are those of :func:`collide`,
    by name; ``ignore`` takes only numbers of objects. Raises InputError naming the option that is wrong.
    """

    # The first parameter is positional only, so that an option can have the name `self`.
    def __init__(
        collider, /, *, self: Union[bool, Sequence[bool]] = False, clearance: float = 0.0,
        neighbours: bool = True, threads: int = 0, contacts: bool = False,
        segments: bool = False, ignore: Optional[ArrayLike] = None, limit: Optional[int] = None,
    ) -> None:
        all_objects, each = _arguments.selves(self)
        question = {
            "all_objects": all_objects,
            "self_objects": each,
            "clearance": _arguments.number("clearance", clearance),
            "neighbours": _arguments.flag("neighbours", neighbours),
            "threads": _arguments.threads(threads),
            # Value of the enumeration Contacts in C++. 0: nothing. 1: kinds. 2: kinds and segments.
            "contacts": max(_arguments.flag("contacts", contacts), 2 * _arguments.flag("segments", segments)),
            "ignore": _arguments.ignored(ignore),
            "limit": _arguments.limit(limit),
        }
        collider._grouped: Any = None  # triangles of the previous call; None if that call failed
        collider._needs_numbers = len(question["ignore"]) > 0 or question["limit"] > 0
        collider._collider = _farcull.Collider(question)

    def find(
        self, V: Optional[ArrayLike] = None, F: Optional[ArrayLike] = None,
        object_starts: Optional[ArrayLike] = None, labels: Optional[ArrayLike] = None, poses: Optional[ArrayLike] = None,
    ) -> Result:
        """Returns the pairs that collide. V, F, object_starts, labels and poses are the parameters of :func:`collide`.

        ``find(poses=...)`` alone moves the arrays of the previous call, unless that call raised an exception.
        Raises InputError for wrong arrays, if there is nothing to test, and if ``ignore`` names an object that does
        not exist. Raises MemoryError. After an exception and after Ctrl-C the collider can be used again.
        """
        before, self._grouped = self._grouped, None
        grouped, given = _arguments.arrays(V, F, object_starts, labels, poses, before)
        if labels is not None and self._needs_numbers:
            raise InputError("labels", "have no meaning with the ignored numbers or the limit of a Collider",
                             "sort the triangles by label and give object_starts, or call farcull.collide")
        return self._find(grouped, given)

    def _find(
        self, grouped: _arguments.Grouped, given: _arguments.Arrays, shown: Optional[Tuple[Any, Any, Any]] = None,
    ) -> Result:
        found = _arguments.ask(self, self._collider, grouped, given)
        for of in ("", "neighbour_"):
            names = [of + "pairs", of + "kinds", of + "segments"]
            found.update(zip(names, grouped.pairs(*(found[name] for name in names))))
        found["objects"] = grouped.objects(found["pairs"])
        if len(grouped.starts):
            found["_neighbour_objects"] = grouped.objects(found["neighbour_pairs"])
        return Result(**{**found, "report": Report(**found["report"])}, _input=shown)


def collide(
    V: ArrayLike, F: ArrayLike, object_starts: Optional[ArrayLike] = None,
    self: Union[bool, Sequence[bool]] = False, clearance: float = 0.0, neighbours: bool = True,
    threads: int = 0, contacts: bool = False, ignore: Optional[ArrayLike] = None, limit: Optional[int] = None,
    labels: Optional[ArrayLike] = None, segments: bool = False, poses: Optional[ArrayLike] = None,
) -> Result:
    """Returns all pairs of triangles that collide: of different objects, and of objects tested against themselves.
    For many frames, keep a :class:`Collider`.

    Parameters
    ----------
    V: (n, 3), the vertices; finite if a triangle uses them.
    F: (m, 3), the triangles, as indices of vertices from 0.
    object_starts: the number of the first triangle of each object: 0, then rising. None: all triangles are one
        object, which has to be tested against itself.
    self: True: every object is tested against itself as well; or one truth value for each object.
    clearance: pairs at this distance or less collide too. World units, finite, 0 or more.
    neighbours: False: neighbours are counted, not decided.
    threads: up to 1024; 0: one for each core.
    contacts: True: also give for each pair how the two triangles meet (:data:`KINDS`).
    ignore: (k, 2) pairs of different objects that are not tested against each other, by their numbers from 0; with
        ``labels`` by their labels.
    limit: at most this many pairs are found, the first in sorted order; neighbours count. 1 or more; None: all pairs.
        Not with ``labels``.
    labels: in place of object_starts: the object of each triangle, (m,) whole numbers or texts in any order. The
        objects are numbered by their labels in ascending order.
    segments: True: as ``contacts``, and also give the points that the two triangles have in common.
    poses: a matrix (4, 4) or (3, 4) for each object, which moves its vertices; no two objects may then share a
        vertex. The products and sums of a coordinate are rounded, from left to right. The answer is exact for the
        rounded points.

    Returns a :class:`Result`, which refers to the arrays for :func:`show`. Raises InputError for wrong arguments,
    and if there is nothing to test. Raises MemoryError.
    """
    grouped, given = _arguments.arrays(V, F, object_starts, labels, poses)
    if limit is not None and labels is not None:
        raise InputError("limit", "has no meaning with labels: rows are found in the order of the labels",
                         "sort the triangles by label and give object_starts")
    all_objects, each = _arguments.selves(self)
    selves = each or all_objects
    collider = Collider(
        self=selves, clearance=clearance, neighbours=neighbours, threads=threads,
        contacts=contacts, segments=segments, ignore=grouped.ignored(ignore), limit=limit,
    )
    usual = clearance == 0 and ignore is None and limit is None and poses is None
    return collider._find(grouped, given, (given[0], grouped, selves) if usual else None)


def join(*meshes: Any, weld: Union[None, float, str] = None) -> Tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Returns V, F and object_starts, the arguments of :func:`collide`, for meshes.

    A mesh is a pair (V, F), an object with ``vertices`` and ``faces`` (trimesh), or an object with ``points`` and
    ``cells`` (meshio). The cells must be triangles; lines and vertices are skipped, since they are no surface.
    ``weld`` merges vertices of a mesh that nearly coincide, as :class:`Scene` does. Raises InputError for
    anything else, and for a mesh without triangles.
    """
    tolerance = _arguments.weld(weld)
    if not meshes:
        raise InputError("meshes", "are none", "give (V, F) of each")
    vertices, triangles = [], []
    starts: List[int] = []
    first_vertex = first_triangle = 0
    for mesh in meshes:
        V, F = _arguments.mesh(mesh)
        if not F.size:
            raise InputError("meshes", f"mesh {len(starts)} has no triangles", "leave it out")
        if not (0 <= F.min() and F.max() < len(V)):
            raise InputError("F", "names a vertex that the mesh does not have", "correct the index")
        if tolerance:
            F = _farcull.weld(V, F, tolerance)
        vertices.append(V)
        triangles.append(F.astype(np.int64) + first_vertex)
        starts.append(first_triangle)
        first_vertex += len(V)
        first_triangle += len(F)
    return np.concatenate(vertices), np.concatenate(triangles), np.array(starts, np.int64)
