"""Which objects clash, and pages that show answers in a browser."""

from __future__ import annotations

import json
import os
import pathlib
import tempfile
import webbrowser
from typing import Any, Dict, List, Optional, Union

import numpy as np

from . import Error, InputError, _arguments, _farcull
from ._collide import Result, pandas
from ._runs import Record, picture, scene_of
from ._scenes import Scene


class Clash:
    """The answer of :func:`clash`: which objects of a scene clash, as ``farcull clash`` reports."""

    __slots__ = ("_clash", "_json", "scene")

    def __init__(self, clash: Any, scene: Scene) -> None:
        self._clash = clash
        self._json: Dict[str, Any] = json.loads(clash.json())
        self.scene = scene

    @property
    def rows(self) -> List[Dict[str, Any]]:
        """The pairs of objects that are not clear, the most serious first, with the keys of docs/clash.md:
        ``object_a``, ``object_b``, ``name_a``, ``name_b``, ``verdict`` and others."""
        return self._json["pairs"]

    @property
    def clean(self) -> bool:
        """True if every pair was examined, and no pair is a clash, contained or unknown."""
        return self._json["clean"]

    def json(self) -> Dict[str, Any]:
        """The record as ``farcull clash --json`` writes it."""
        return self._json

    def to_pandas(self) -> Any:
        """A DataFrame of ``rows``, with a column such as ``depth.least`` for each key of an entry."""
        return pandas().json_normalize(self.rows)

    def __str__(self) -> str:
        return self._clash.table()

    def __repr__(self) -> str:
        return f"<farcull.Clash of {self.scene!r}: {_arguments.counted(len(self.rows), 'pair')} of objects>"


def clash(
    scene: Scene, clearance: float = 0.0, ignore: Optional[Any] = None, threads: int = 0, *, depth: bool = False,
    tolerance: Union[float, str] = 0.0,
) -> Clash:
    """Finds which objects of a scene clash, touch, are near, or lie inside another object.

    Parameters
    ----------
    scene: a :class:`Scene` of two objects or more.
    clearance: objects at this distance or less are near. World units, finite, 0 or more.
    ignore: pairs of objects that may clash, as in :meth:`Scene.run`; they are listed apart.
    threads: up to 1024; 0: one for each core.
    depth: True: also give bounds of the depth of each overlap. Takes long if objects have many triangles.
    tolerance: an overlap counts as a touch if its depth is proved to be at most the tolerance. A gap of at most the
        tolerance is a touch as well. World units, finite, 0 or more; or relative to the diagonal of the scene's box, as
        in "1e-9*size".

    Returns a :class:`Clash`. Raises InputError naming the argument that is wrong, and Error.
    """
    given = scene_of(scene)
    made = _farcull.clash(
        given, _arguments.number("clearance", clearance), _arguments.weld(tolerance, "tolerance"),
        _arguments.ignored(ignore, given), _arguments.flag("depth", depth), _arguments.threads(threads),
    )
    return Clash(made, scene)


def show(
    what: Union[Scene, Record, Result, Clash], path: Union[None, str, os.PathLike[str]] = None, *, browse: bool = True,
) -> str:
    """Writes a page on which the answer can be turned and explored, and opens it in the browser.

    - ``what``: the answer. For a :class:`Clash` the page shows the objects of each pair, and where they cross. For a
      :class:`Scene`, a :class:`Result` of :func:`collide` or a :class:`Record` the page shows the triangles that
      collide. For a Record the page also marks triangles that the method missed.
    - ``path``: the file to write; None: a new temporary file, which is not deleted.
    - ``browse``: False: the page is written, but not opened.

    Returns the path. Pages other than that of a Clash need OpenGL; Mesa's software device is enough. Raises InputError if
    no page can show the answer, and Error.
    """
    html = _html(what)
    if path is None:
        handle, path = tempfile.mkstemp(prefix="farcull-", suffix=".html")
        os.close(handle)
    page = pathlib.Path(path).absolute()
    page.write_text(html, encoding="utf-8")
    if browse:
        webbrowser.open(page.as_uri())
    return str(page)


def _html(what: Any) -> str:
    if isinstance(what, Clash):
        return what._clash.page()
    if isinstance(what, Scene):
        return picture(what, page=True).html
    remedy = "show the scene, as in farcull.show(farcull.Scene.from_arrays(V, F, object_starts))"
    unusual = "has no page, since it was asked with a clearance, poses, ignored objects or a limit"
    if isinstance(what, Record):
        if what._options is None:
            raise InputError("what", unusual, "show its scene")
        return picture(what.scene, [what._options], page=True).html
    if not isinstance(what, Result):
        raise InputError("what", f"{what!r} has no page", "give a Scene, Record, Result or Clash")
    if what._input is None:
        raise InputError("what", unusual + ", or comes from a Collider or a pickle", remedy)
    V, grouped, selves = what._input
    scene = Scene.from_arrays(V, grouped.triangles, grouped.starts, self=selves)
    if not np.array_equal(grouped.pairs(scene.run(verify=False).pairs)[0], what.pairs):
        raise Error("what", "its arrays have changed since", "call farcull.collide again")
    return picture(scene, page=True).html
