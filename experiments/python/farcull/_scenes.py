"""Scenes from arrays, from files or built in, and scenes that move."""

from __future__ import annotations

import os
import warnings
from typing import Any, Iterator, List, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import InputError, _arguments, _farcull


def _names(names: Tuple[Any, ...]) -> List[str]:
    if not names:
        raise InputError("scene", "none is named", "name mesh files or a built-in scene")
    out = []
    for name in names:
        try:
            path = os.fspath(name)
        except TypeError:
            raise InputError("scene", f"{name!r} is no name", "name files or a scene") from None
        if not isinstance(path, str) or not path or "\0" in path:
            raise InputError("scene", f"{name!r} is no name", "name files or a scene")
        out.append(_arguments.encoded("scene", path))
    return out


def _warn() -> None:
    """Warns the package's caller about parts of files that readers passed over."""
    for note in _farcull.take_reading_notes():
        warnings.warn(note, stacklevel=3)


class Scene:
    """A scene that never changes: triangles, grouped into objects.

    ``Scene("two-bunnies")`` is a built-in scene; ``Scene("a.obj", "b.ply")`` are mesh files, each an object;
    ``Scene("scene.json")`` is a scene file; :meth:`from_arrays` takes arrays. With ``self=True`` every object is tested
    against itself as well. ``weld`` merges vertices of a mesh at this distance or less: in units of the mesh, or
    relative to the diagonal of its box, as in "1e-7*size". Warns if parts of a file are passed over. Raises Error for
    files that cannot be read.
    """

    __slots__ = ("_scene",)

    name: str
    vertices: NDArray[np.float64]  # (n, 3); a view that cannot be written to
    triangles: NDArray[np.uint32]  # (m, 3) indices of vertices; a view that cannot be written to
    object_starts: NDArray[np.int64]  # the number of the first triangle of each object
    ignored: NDArray[np.int64]  # (k, 2) pairs of objects that the scene file ignores
    names: List[str]  # names of the objects
    self: List[bool]  # which objects are tested against themselves

    def __init__(
        scene, /, *names: Union[str, os.PathLike[str]], self: bool = False, weld: Union[None, float, str] = None,
    ) -> None:
        scene._scene = _farcull.scene_of_names(_names(names), _arguments.weld(weld), _arguments.flag("self", self))
        _warn()

    @classmethod
    def _of(cls, made: Any) -> Scene:
        out = cls.__new__(cls)
        out._scene = made
        return out

    @staticmethod
    def from_arrays(
        V: ArrayLike, F: ArrayLike, object_starts: Optional[ArrayLike] = None,
        self: Union[bool, Sequence[bool]] = False, name: str = "arrays", names: Optional[Sequence[str]] = None,
    ) -> Scene:
        """Returns a scene with copies of the arrays. ``names``: names of the objects; default "0", "1" and so on.
        Raises InputError as :func:`collide` does."""
        _, given = _arguments.arrays(V, F, object_starts, None, None)
        all_objects, each = _arguments.selves(self)
        if isinstance(names, str):
            raise InputError("names", "are one text", "give a list of texts")
        return Scene._of(_farcull.scene_of_arrays(
            *given, _arguments.text("name", name), [_arguments.text("names", one) for one in names or []], all_objects, each))

    def __getattr__(scene, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(scene._scene, name)

    def run(scene, /, method: str = "boxes", **options: Any) -> Record:
        """Culls the scene, tests the candidates, and accounts for every pair.

        Options by name, as of ``farcull run``: ``resolution``, ``radius``, ``offset``, ``depth``, ``depth_format``,
        ``query``, ``broad_phase``, ``clusters``, ``views``, ``rounds``, ``clear``, ``level``, ``conservative``,
        ``device``, ``clearance``, ``full``; and ``verify`` (default True: account for every pair) and ``threads``.
        ``contacts``, ``ignore`` and ``limit`` are those of :func:`collide`; ``ignore`` takes names as well, as in
        [("link*", "hand")]: every two different objects with such names, where * stands for any characters. Pairs that
        the scene file ignores are ignored too. Raises InputError naming the option that is wrong, and Error for a
        fault of the device.
        """
        from ._runs import run

        return run(scene, method, **options)

    def __reduce__(self) -> Any:
        """Returns the arrays and names for pickle, exactly."""
        if len(self.ignored):
            raise InputError("scene", "ignores objects, which a pickle does not hold", "pass its file")
        return _of_arrays, (
            np.array(self.vertices), np.array(self.triangles), self.object_starts, self.self, self.name, self.names,
        )

    def __repr__(self) -> str:
        return (f"<farcull.Scene {self.name!r}: {_arguments.counted(len(self.names), 'object')}, "
                f"{_arguments.counted(len(self.triangles), 'triangle')}>")


def _of_arrays(V: Any, F: Any, starts: Any, self: Any, name: str, names: Any) -> Scene:
    return Scene.from_arrays(V, F, starts, self=self, name=name, names=names)


class Frames:
    """A scene that moves: ``for frame, scene in farcull.Frames("cloth", frames=60): ...``.

    ``names``: a built-in scene that moves, or mesh files with %d or %04d in their names. ``frames``: a number N for 0
    to N - 1, or (first, last). ``self``, ``weld``: as for :class:`Scene`. Raises Error if nothing moves, and for a
    frame that cannot be read.
    """

    def __init__(
        collection, /, *names: Union[str, os.PathLike[str]], frames: Union[int, Tuple[int, int]],
        self: bool = False, weld: Union[None, float, str] = None,
    ) -> None:
        most = 10**9
        if isinstance(frames, (tuple, list)):
            if len(frames) != 2:
                raise InputError("frames", "are no pair", "give a number, or (first, last)")
            first, last = (_arguments.integer("frames", f, 0, most) for f in frames)
            asked = f"{first}:{last}"
        else:
            asked = str(_arguments.integer("frames", frames, 1, most))
        collection._frames = _farcull.Frames(_names(names), _arguments.weld(weld), asked, _arguments.flag("self", self))
        _warn()

    def __len__(self) -> int:
        return self._frames.last - self._frames.first + 1

    def at(self, frame: int) -> Scene:
        """Returns the scene at a frame. A simulation first computes the frames before it."""
        scene = Scene._of(self._frames.at(_arguments.integer("frame", frame, 0, 2**31 - 1)))
        _warn()
        return scene

    def __iter__(self) -> Iterator[Tuple[int, Scene]]:
        for frame in range(self._frames.first, self._frames.last + 1):
            yield frame, self.at(frame)


def builtin_scenes() -> List[str]:
    """Returns the names of the built-in scenes. Most names take a size, as in "crowd:3000"."""
    return _farcull.builtin_scenes()


from ._runs import Record  # noqa: E402  (the annotation of Scene.run)
