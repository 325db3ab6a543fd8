"""Checks of arguments, before the compiled module gets them."""

import math
import numbers
import operator
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import InputError


def read(name: str, given: Any, remedy: str) -> np.ndarray:
    """Returns the argument as a numpy array. An argument without ``__array__`` is read through DLPack."""
    if isinstance(given, np.ma.MaskedArray):
        raise InputError(name, "are a masked array", "give an array without a mask")
    if isinstance(given, np.ndarray):
        return np.asarray(given)
    try:
        device = getattr(given, "__dlpack_device__", None)
        if device is not None and device()[0] not in (1, 3):  # DLPack device types: 1 is CPU, 3 is CUDA host memory
            raise InputError(name, "are in the memory of another device", "copy them to the CPU first")
        if device is not None and not hasattr(given, "__array__"):
            return np.from_dlpack(given)
        return np.asarray(given)
    except (MemoryError, InputError):
        raise
    except Exception as error:  # methods of the argument may raise any exception
        raise InputError(name, f"cannot be read as an array ({error})", remedy) from error


def array(name: str, given: Any) -> np.ndarray:
    """Returns vertices ("V") as contiguous doubles, and triangles ("F") as contiguous int64 or uint32. An array that
    has this form is not copied. An empty list becomes (0, 3)."""
    if hasattr(given, "faces") or hasattr(given, "cells"):
        raise InputError(name, "is a mesh", "give V, F and object_starts of farcull.join(mesh, ...)")
    out = read(name, given, "give rows of three numbers")
    indices = name == "F"
    if out.shape == (0,) and out.dtype == np.float64:  # an empty list
        out = np.empty((0, 3), np.int64 if indices else np.float64)
    kind, size = out.dtype.kind, out.dtype.itemsize
    if size > 8 or kind not in ("iu" if indices else "iuf"):
        remedy = "give whole numbers, as in numpy.int64" if indices else "give doubles"
        if indices and kind == "f":
            remedy += "; V and F may be swapped"
        raise InputError(name, f"are of type {out.dtype}", remedy)
    if out.ndim != 2 or out.shape[1] != 3:
        remedy = "give an array of shape (m, 3); triangulate polygons" if indices else "give an array of shape (n, 3)"
        raise InputError(name, "have no three columns", remedy)
    if indices:
        if kind == "u" and size == 8 and out.size and int(out.max()) >= 2**63:  # numpy would round such integers to doubles
            row = int(np.argmax((out >= np.uint64(2**63)).any(axis=1)))
            reason = f"triangle {row} names vertex {out[row].max()}"
            raise InputError(name, reason, "give indices from 0 to the number of vertices - 1")
        return np.require(out, np.uint32 if kind == "u" and size == 4 else np.int64, ["C", "A"])
    _refuse_rounding(name, out)
    return np.require(out, np.float64, ["C", "A"])


def _refuse_rounding(name: str, given: np.ndarray) -> None:
    if given.dtype.kind in "iu" and given.size and max(-int(given.min()), int(given.max())) > 2**53:
        raise InputError(name, "hold what a double may not hold exactly", "give doubles")


def mesh(given: Any) -> Tuple[np.ndarray, np.ndarray]:
    """Returns vertices and triangles of a mesh, which is a pair of arrays or an object with such arrays."""
    remedy = "give (V, F), or an object with vertices and faces, or with points and cells"
    if isinstance(given, (tuple, list)) and len(given) == 2:
        V, F = given
    elif hasattr(given, "vertices") and hasattr(given, "faces"):  # for example a mesh of trimesh
        V, F = given.vertices, given.faces
    elif hasattr(given, "points") and hasattr(given, "cells"):  # for example a mesh of meshio
        try:
            blocks = [(block.type, block.data) for block in given.cells]
        except AttributeError:
            raise InputError("meshes", "have cells without type and data", remedy) from None
        # Ignores lines and vertices, which are not surfaces. Refuses other cells, whose collisions would be missed.
        others = {kind for kind, _ in blocks} - {"triangle", "line", "vertex"}
        if others:
            remedy = "give triangles alone, as in (mesh.points, mesh.cells_dict['triangle'])"
            raise InputError("meshes", "have cells of the type " + ", ".join(sorted(others)), remedy)
        V = given.points
        found = [array("F", data) for kind, data in blocks if kind == "triangle"]
        F = np.concatenate(found) if found else []
    else:
        raise InputError("meshes", f"hold a {type(given).__name__}", remedy)
    return array("V", V), array("F", F)


class Grouped:
    """Triangles grouped into objects, by the first triangle of each object, or by a label for each triangle."""

    def __init__(self, F: Any, object_starts: Any, labels: Any) -> None:
        self.triangles = array("F", F)
        self.labels: Optional[np.ndarray] = None  # one label per object; None without labels
        self.order: Optional[np.ndarray] = None  # the caller's index of each triangle; None: not reordered
        if labels is None:
            self.starts = _starts(object_starts)
            return
        if object_starts is not None:
            raise InputError("labels", "are given beside object_starts", "give one of the two")
        each = read("labels", labels, "give one for each triangle")
        if each.ndim != 1 or len(each) != len(self.triangles) or each.dtype.kind not in "iubUS":
            reason = f"have the shape {each.shape} and the type {each.dtype} for {len(self.triangles)} triangles"
            raise InputError("labels", reason, "give one whole number or text for each triangle")
        order = np.argsort(each, kind="stable")
        self.labels, first = np.unique(each[order], return_index=True)
        self.starts = np.ascontiguousarray(first, np.int64)
        if len(order) and (order != np.arange(len(order))).any():
            self.order, self.triangles = order, self.triangles[order]

    def pairs(self, pairs: np.ndarray, *others: Any) -> Tuple[Any, ...]:
        """Returns the pairs in the caller's numbers, with sorted rows. The rows of ``others`` (arrays or None) are put
        into the same order."""
        if self.order is None:
            return (pairs, *others)
        named = np.sort(self.order[pairs], axis=1).reshape(-1, 2)
        by = np.lexsort((named[:, 1], named[:, 0]))
        return (named[by], *(None if other is None else other[by] for other in others))

    def objects(self, pairs: np.ndarray) -> np.ndarray:
        """Returns the object of each triangle, as a label if there are labels. ``pairs``: triangles in the caller's numbers."""
        if self.order is not None:
            place = np.empty(len(self.order), np.int64)
            place[self.order] = np.arange(len(self.order))
            pairs = place[pairs]
        out = np.maximum(np.searchsorted(self.starts, pairs, side="right") - 1, 0)
        return out if self.labels is None else self.labels[out]

    def ignored(self, given: Any) -> Any:
        """Returns pairs of objects as pairs of numbers. If there are labels, ``given`` names objects by labels."""
        if self.labels is None or given is None:
            return given
        remedy = "give labels, as in [(3, 7)]"
        rows = read("ignore", given, remedy)
        if rows.size == 0:
            return None
        # Compares labels as Python values, since numpy compares signed with unsigned integers as rounded doubles.
        places = {label: place for place, label in enumerate(self.labels.tolist())}
        try:
            if rows.ndim != 2 or rows.shape[1] != 2 or rows.dtype.kind not in "iubUS":
                raise KeyError
            return [[places[a], places[b]] for a, b in rows.tolist()]
        except KeyError:
            raise InputError("ignore", "are no rows of two labels that triangles have", remedy) from None


def poses(given: Any) -> np.ndarray:
    """Returns matrices as (k, 3, 4) doubles. None means no poses."""
    if given is None:
        return np.empty((0, 3, 4))
    remedy = "give a matrix of 4 x 4 numbers for each object, whose last row is 0, 0, 0, 1"
    out = read("poses", given, remedy)
    if out.shape[1:] not in ((3, 4), (4, 4)) or not np.can_cast(out.dtype, np.float64):
        raise InputError("poses", f"have the shape {out.shape} and the type {out.dtype}", remedy)
    _refuse_rounding("poses", out)
    if not len(out):
        raise InputError("poses", "are none", "give one for each object, or leave them out")
    if out.shape[1] == 4 and not (out[:, 3] == (0, 0, 0, 1)).all():
        raise InputError("poses", "have a last row that is not 0, 0, 0, 1", remedy)
    return np.ascontiguousarray(out[:, :3], np.float64)


#: Vertices, triangles, starts and poses, as the compiled module takes them.
Arrays = Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def arrays(
    V: Any, F: Any, object_starts: Any, labels: Any, moves: Any, before: Union[Grouped, None, bool] = False
) -> Tuple[Grouped, Arrays]:
    """Returns the input of a call. ``before``: the grouped triangles of the previous call, which poses alone
    move; None: there was no such call; False: this call does not accept poses alone."""
    matrices = poses(moves)
    alone = V is None and F is None and object_starts is None and labels is None
    if alone and isinstance(before, Grouped) and len(matrices):
        return before, (np.empty((0, 3)), np.empty((0, 3), np.int64), np.empty(0, np.int64), matrices)
    more = "" if before is False else "; poses alone move those of the call before, if it had an answer"
    for name, given in (("V", V), ("F", F)):
        if given is None:
            raise InputError(name, "is not given", "give V and F" + more)
    grouped = Grouped(F, object_starts, labels)
    if matrices.size and not grouped.triangles.size:
        raise InputError("F", "has no triangles", "give some" + more)
    return grouped, (array("V", V), grouped.triangles, grouped.starts, matrices)


def ask(owner: Any, compiled: Any, grouped: Grouped, given: Arrays) -> Dict[str, Any]:
    """Returns the answer of the compiled collider or finder of ``owner``. Sets ``owner._grouped`` to ``grouped``,
    unless a signal handler called the owner meanwhile, since the handler's call is then the latest."""
    turn = object()
    if not given[1].size and given[3].size and owner._grouped is not None:
        raise InputError("poses", "would move the arrays of a call in between", "give V and F")
    owner._grouped = turn  # set first, since a signal handler may run during find()
    try:
        found = compiled.find(*given)
    except InputError as error:
        if grouped.labels is None or error.where != "object_starts":
            raise
        remedy = "give labels of two objects or more, or test the object against itself with self"
        raise InputError("labels", error.reason, remedy) from None
    if owner._grouped is turn:
        owner._grouped = grouped
    return found


def _starts(given: Any) -> np.ndarray:
    """Returns the first triangle of each object. None means one object. The library checks the numbers."""
    if given is None:
        return np.zeros(0, np.int64)
    out = read("object_starts", given, "give whole numbers")
    if out.ndim != 1 or (out.dtype.kind not in "iu" and out.size):
        remedy = "give the number of the first triangle of each object"
        raise InputError("object_starts", "must be a one-dimensional array of whole numbers", remedy)
    if out.dtype == np.uint64 and out.size and int(out.max()) >= 2**63:
        raise InputError("object_starts", f"hold {out.max()}", "give numbers of triangles")
    return np.ascontiguousarray(out, dtype=np.int64)


def number(name: str, given: Any) -> float:
    if isinstance(given, (bool, np.bool_)) or not isinstance(given, numbers.Real):
        raise InputError(name, f"{given!r} is no number", "give a number")
    try:
        out = float(given)
    except OverflowError:
        out = math.inf
    if math.isnan(out):
        raise InputError(name, "is no number", "give a number")
    if isinstance(given, numbers.Integral) and math.isfinite(out) and int(out) != int(given):
        raise InputError(name, f"is {given}, which is no double", f"give {out!r}, or another double")
    return out


def integer(name: str, given: Any, low: int, high: int) -> int:
    try:
        if isinstance(given, (bool, np.bool_)):
            raise TypeError
        out = operator.index(given)
    except TypeError:
        raise InputError(name, f"{given!r} is no whole number", "give a whole number") from None
    if not low <= out <= high:
        raise InputError(name, f"is {out}", f"give a whole number from {low} to {high}")
    return out


def flag(name: str, given: Any) -> bool:
    if not isinstance(given, (bool, np.bool_)):
        raise InputError(name, f"{given!r} is neither True nor False", "give one of them")
    return bool(given)


def text(name: str, given: Any) -> str:
    if not isinstance(given, str):
        raise InputError(name, f"{given!r} is no text", "give a string")
    return encoded(name, given)


def encoded(name: str, given: str) -> str:
    """Returns the text. Raises InputError if UTF-8 cannot hold the text."""
    try:
        given.encode()
    except UnicodeEncodeError:
        raise InputError(name, "holds what is no character", "give text") from None
    return given


def choice(name: str, given: Any, choices: Sequence[str]) -> str:
    if not isinstance(given, str) or given not in choices:
        raise InputError(name, f"{given!r} is no choice", "give " + " or ".join(choices))
    return given


def selves(given: Any) -> Tuple[bool, List[bool]]:
    """Returns whether all objects are tested against themselves, and a list: a truth value for each object, or empty."""
    if isinstance(given, (bool, np.bool_)):
        return bool(given), []
    try:
        each = list(given)
    except TypeError:
        raise InputError("self", f"{given!r} is no truth value", "give True, False, or one for each object") from None
    return False, [flag("self", value) for value in each]


def ignored(given: Any, scene: Any = None) -> List[List[int]]:
    """Returns pairs of different objects. ``given`` has rows of two numbers; with a compiled ``scene``, rows of two
    patterns of names are accepted as well. Without a scene, the library checks that the numbers exist."""
    if given is None:
        return []
    remedy = "give rows of two numbers of objects, as in [(0, 1), (0, 2)]"
    rows = read("ignore", given, remedy)
    if rows.size == 0:
        return []
    if scene is not None and rows.dtype.kind == "U" and rows.ndim == 2 and rows.shape[1] == 2:
        return [pair for k, (a, b) in enumerate(rows.tolist())
                for pair in scene.pairs_named(encoded("ignore", a), encoded("ignore", b), f"row {k}")]
    if rows.ndim != 2 or rows.shape[1] != 2 or rows.dtype.kind not in "iu":
        raise InputError("ignore", "are no rows of two whole numbers", remedy)
    out = rows.tolist()
    objects = 2**32 if scene is None else len(scene.names)
    for k, (a, b) in enumerate(out):
        if not (0 <= min(a, b) and max(a, b) < objects):
            raise InputError("ignore", f"row {k} names objects {a} and {b}", remedy)
        if a == b:
            remedy = "give two different objects; self says which are tested against themselves"
            raise InputError("ignore", f"row {k} names object {a} twice", remedy)
    return out


def limit(given: Any) -> int:
    """Returns the limit for the library, where 0 means all pairs."""
    return 0 if given is None else integer("limit", given, 1, 2**64 - 1)


def weld(given: Any, name: str = "weld") -> str:
    """Returns a tolerance as a text for the library; an empty text for None."""
    if given is None:
        return ""
    text = _text_of(name, given)
    if not text:
        raise InputError(name, "is empty", "give a length, or one as in '1e-7*size'")
    return text


def texts(**options: Any) -> Dict[str, str]:
    """Returns options as texts. True becomes an empty text. None and False are left out."""
    out = {}
    for name, value in options.items():
        if value is None or value is False:
            continue
        if value is True:
            value = ""
        elif isinstance(value, (list, tuple)):
            if not value:
                raise InputError(name, "is empty", "give a value, or leave it out")
            value = ",".join(_text_of(name, part) for part in value)
        out[name] = _text_of(name, value)
    return out


def _text_of(name: str, value: Any) -> str:
    if isinstance(value, str):
        if "\0" in value:
            raise InputError(name, "holds a zero byte", "give text")
        return encoded(name, value)
    if isinstance(value, numbers.Integral) and not isinstance(value, bool):
        return str(int(value))
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return repr(float(value))
    raise InputError(name, f"{value!r} is no value of it", "give text or a number")


def counted(count: int, noun: str) -> str:
    """Returns a text such as "1 pair" or "2 pairs"."""
    return f"{count} {noun}" + ("" if count == 1 else "s")


def threads(given: Any) -> int:
    return integer("threads", given, 0, 1024)


def optional_number(name: str, given: Any) -> Optional[float]:
    return None if given is None else number(name, given)
