"""The compiled module. It is no interface for users: the package around it is."""

from typing import Any, List, Mapping, Optional, Sequence, Tuple, TypedDict

from numpy import bool_, float64, int64, uint8, uint32
from numpy.typing import NDArray

kinds: Tuple[str, ...]
features: Tuple[str, ...]
inside: Tuple[str, ...]
options: Mapping[str, bool]

def require_main_interpreter() -> None: ...

class Question(TypedDict):
    """What a collider is asked. For annotations alone: the module has no such name."""

    all_objects: bool
    self_objects: Sequence[bool]
    clearance: float
    neighbours: bool
    threads: int
    contacts: int
    ignore: Sequence[Sequence[int]]
    limit: int

class Collider:
    def __init__(
        self, question: Question, *, device: str, views: str, resolution: int
    ) -> None: ...
    def find(
        self, vertices: NDArray[Any], triangles: NDArray[Any], starts: NDArray[int64],
        poses: NDArray[float64],
    ) -> dict[str, Any]: ...

class DistanceFinder:
    def __init__(
        self,
        kind: str,
        k: int,
        within: Optional[float],
        all_objects: bool,
        self_objects: Sequence[bool],
        inside: bool,
        ignore: Sequence[Sequence[int]],
        threads: int,
    ) -> None: ...
    def find(
        self, vertices: NDArray[Any], triangles: NDArray[Any], starts: NDArray[int64],
        poses: NDArray[float64],
    ) -> dict[str, Any]: ...

class Scene:
    name: str
    vertices: NDArray[float64]
    triangles: NDArray[uint32]
    object_starts: NDArray[int64]
    ignored: NDArray[int64]
    names: List[str]
    self: List[bool]
    def pairs_named(self, first: str, second: str, what: str) -> List[List[int]]: ...

def scene_of_arrays(
    vertices: NDArray[Any],
    triangles: NDArray[Any],
    starts: NDArray[int64],
    poses: NDArray[float64],
    name: str,
    names: Sequence[str],
    all_objects: bool,
    self_objects: Sequence[bool],
) -> Scene: ...
def scene_of_names(names: Sequence[str], weld: str, all_objects: bool) -> Scene: ...
def weld(vertices: NDArray[Any], triangles: NDArray[Any], tolerance: str) -> NDArray[uint32]: ...
def builtin_scenes() -> List[str]: ...
def take_reading_notes() -> List[str]: ...

class Frames:
    first: int
    last: int
    def __init__(
        self, names: Sequence[str], weld: str, frames: str, all_objects: bool
    ) -> None: ...
    def at(self, frame: int) -> Scene: ...

class Record:
    pairs: NDArray[int64]
    neighbour_pairs: NDArray[int64]
    kinds: Optional[NDArray[uint8]]
    neighbour_kinds: Optional[NDArray[uint8]]
    complete: bool
    bits: NDArray[uint8]
    kept_triangles: NDArray[uint32]
    candidates: int
    views: List[dict[str, Any]]
    promises: bool
    promises_reason: str
    accounting: Optional[dict[str, Any]]
    def missed(self) -> Optional[NDArray[int64]]: ...
    def json(self) -> str: ...
    def table(self) -> str: ...
    def certificate(self) -> str: ...

def run(
    scene: Scene,
    given: Mapping[str, str],
    verify: bool,
    threads: int,
    contacts: bool,
    ignore: Sequence[Sequence[int]],
    limit: int,
) -> Record: ...
def check(
    scene: Scene,
    certificate: Optional[str],
    pairs: Optional[NDArray[Any]],
    clearance: Optional[float],
) -> dict[str, Any]: ...
def picture(
    scene: Scene,
    panels: Sequence[Mapping[str, str]],
    view: str,
    up: str,
    zoom: bool,
    width: int,
    height: int,
    device: str,
    threads: int,
    page: bool,
) -> Tuple[NDArray[uint8], List[dict[str, Any]], str]: ...

class Clash:
    def json(self) -> str: ...
    def table(self) -> str: ...
    def page(self) -> str: ...

def clash(
    scene: Scene, clearance: float, ignore: Sequence[Sequence[int]], threads: int
) -> Clash: ...
