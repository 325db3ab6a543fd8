"""Runs of any method with their records, checks and pictures."""

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import InputError, _arguments, _farcull

if TYPE_CHECKING:
    from ._scenes import Scene

def scene_of(given: Any) -> Any:
    from ._scenes import Scene

    if not isinstance(given, Scene):
        raise InputError("scene", f"{given!r} is no farcull.Scene", "make one of it")
    return given._scene


def _options(method: Any, options: Dict[str, Any]) -> Dict[str, str]:
    for name, value in options.items():
        if name not in _farcull.options:
            raise InputError(name, "is no option", "give one of " + ", ".join(_farcull.options))
        if _farcull.options[name]:
            _arguments.flag(name, value)
        elif isinstance(value, (bool, np.bool_)):
            raise InputError(name, f"{value!r} is no value of it", "give text or a number")
    return _arguments.texts(method=_arguments.text("method", method), **options)


class Record:
    """The answer of :meth:`Scene.run`, and how it was found."""

    __slots__ = ("_record", "_options", "scene", "method")

    pairs: NDArray[np.int64]  # (k, 2), as in Result: the pairs that collide among those that culling kept
    neighbour_pairs: NDArray[np.int64]  # as in Result
    kinds: Optional[NDArray[np.uint8]]  # as in Result; None without contacts=True
    neighbour_kinds: Optional[NDArray[np.uint8]]  # as in Result; None without contacts=True
    complete: bool  # False: the limit was reached, and more pairs may follow the last one
    candidates: int  # how many pairs culling left to the exact tests
    kept_triangles: NDArray[np.uint32]  # ascending; a view that cannot be written to
    bits: NDArray[np.uint8]
    """For a method that draws, per triangle: 1 fully visible in the first pass, 2 in the second, 3 culled. Empty for
    other methods. A view that cannot be written to."""
    views: List[Dict[str, Any]]  # name, width and height (px) of each view, and whether it was drawn
    promises: bool  # whether the method promises to miss nothing, and its device keeps the assumptions
    promises_reason: str
    accounting: Optional[Dict[str, Any]]  # how many pairs are in each class; None with verify=False

    def __init__(self, record: Any, scene: "Scene", method: str, options: Optional[Dict[str, Any]]) -> None:
        self._record = record
        self._options = options  # for the page of show(); None if the page would show other pairs
        self.scene = scene
        self.method = method

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._record, name)

    def missed(self) -> Optional[NDArray[np.int64]]:
        """Returns all pairs that collide and that culling removed, (k, 2); None with verify=False."""
        return self._record.missed()

    def certificate(self) -> str:
        """Returns evidence for every pair, as ``farcull run --certificate`` writes it; see :func:`check`.
        Raises InputError after a run with ``ignore`` or ``limit``."""
        return self._record.certificate()

    def json(self) -> Dict[str, Any]:
        """The record as ``farcull run --json`` writes it."""
        return json.loads(self._record.json())

    def __str__(self) -> str:
        return self._record.table()

    def __repr__(self) -> str:
        return f"<farcull.Record of {self.scene!r} by {self.method}: {_arguments.counted(len(self.pairs), 'pair')}>"


def run(
    scene: "Scene", method: str, /, *, verify: bool = True, threads: int = 0, contacts: bool = False,
    ignore: Optional[Any] = None, limit: Optional[int] = None, **options: Any,
) -> Record:
    made = _farcull.run(
        scene_of(scene), _options(method, options), _arguments.flag("verify", verify),
        _arguments.threads(threads), _arguments.flag("contacts", contacts),
        _arguments.ignored(ignore, scene._scene), _arguments.limit(limit),
    )
    usual = ignore is None and limit is None and not options.get("clearance")
    return Record(made, scene, method, {"method": method, **options} if usual else None)


@dataclass(frozen=True, eq=False)
class Check:
    """The answer of :func:`check`."""

    verdict: str  # "proved", "refuted" or "not proved"
    reason: str  # empty if proved
    pair: Optional[Tuple[int, int]]  # the pair that the reason is about, if it is about one pair
    decided: bool  # whether all pairs were decided; False for a certificate of another scene
    pairs: NDArray[np.int64]  # (k, 2): the pairs that meet, found by the checker; with neighbours
    culled_meeting: int  # how many pairs the certificate calls culled although they meet
    unattested: List[str]  # claims that no check can prove
    text: str  # as ``farcull check`` prints it

    @property
    def proved(self) -> bool:
        return self.verdict == "proved"

    def __str__(self) -> str:
        return self.text


def check(
    scene: "Scene", certificate: Optional[str] = None, pairs: Optional[ArrayLike] = None, clearance: Optional[float] = None,
) -> Check:
    """Proves or refutes a certificate, a list of pairs, or both, with integer arithmetic only.

    - ``certificate``: the text of :meth:`Record.certificate`.
    - ``pairs``: (k, 2) triangles, in any order, claimed to be all pairs that meet, neighbours included.
    - ``clearance``: the clearance of the list; default: that of the certificate, or 0 without a certificate.

    Raises InputError if neither certificate nor pairs are given, or if the scene lacks a triangle of the pairs.
    Raises Error for a malformed certificate.
    """
    if certificate is None and pairs is None:
        raise InputError("certificate", "is not given, nor are pairs", "give one of them, or both")
    if certificate is not None:
        certificate = _arguments.text("certificate", certificate)
    distance = _arguments.optional_number("clearance", clearance)
    if distance is not None and not 0 <= distance < np.inf:
        raise InputError("clearance", "is no distance", "give a finite number, 0 or more")
    listed = None
    if pairs is not None:
        listed = _arguments.read("pairs", pairs, "give rows of two numbers of triangles")
        if listed.size == 0:
            listed = np.empty((0, 2), np.int64)
        if listed.dtype.kind not in "iu" or listed.ndim != 2 or listed.shape[1] != 2:
            raise InputError("pairs", "are no rows of two whole numbers", "give an array (k, 2)")
    return Check(**_farcull.check(scene_of(scene), certificate, listed, distance))


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture of the answers of methods, a panel for each."""

    pixels: NDArray[np.uint8]  # (height, width, 4): red, green, blue, opacity; rows from the top
    panels: List[Dict[str, Any]]  # title, headline and counts of each panel
    html: str  # the page; empty unless ``page`` was True


def picture(
    scene: "Scene", methods: Sequence[Union[str, Dict[str, Any]]] = ("boxes",), *,
    view: str = "", up: str = "", zoom: bool = False,
    width: int = 900, height: int = 760, device: str = "", threads: int = 0, page: bool = False,
) -> Picture:
    """Draws triangles: those that collide, those that a method missed, and those that a method kept but that do not collide.

    - ``methods``: one for each panel: a name, or the options of :meth:`Scene.run` with ``method`` among them.
    - ``view``, ``up``: the direction to look along, as in "x" or "1:1:-0.5", and the upward direction.
    - ``zoom``: True: only the triangles that collide.
    - ``width``, ``height``: px of a panel.
    - ``page``: True: also make the page of ``farcull picture --html``; :func:`show` opens such a page.

    Needs OpenGL; Mesa's software device will do. Raises InputError and Error.
    """
    if isinstance(methods, (str, dict)):
        methods = [methods]
    asked = [dict(one) if isinstance(one, dict) else {"method": one} for one in methods]
    panels = [_options(options.pop("method", "boxes"), options) for options in asked]
    pixels, shown, html = _farcull.picture(
        scene_of(scene), panels, _arguments.text("view", view), _arguments.text("up", up), _arguments.flag("zoom", zoom),
        _arguments.integer("width", width, 1, 10**6),
        _arguments.integer("height", height, 1, 10**6), _arguments.text("device", device),
        _arguments.threads(threads), _arguments.flag("page", page),
    )
    return Picture(pixels, shown, html)
