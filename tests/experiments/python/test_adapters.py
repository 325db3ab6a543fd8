"""The adapters of docs/example/python: a CollisionManager against plain calls, and a broad phase against all boxes."""

import itertools
import os
import sys
import types

import farcull
import numpy as np

sys.path.insert(0, os.path.join(os.environ["FARCULL_ROOT"], "docs", "example", "python"))
import broad_phase
from broad_phase import BroadPhase
from collision_manager import CollisionManager

# The collision manager: corners and poses are whole numbers, so that placing them is exact.
TURNS = [np.array(p) for p in ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], [[0, 0, 1], [1, 0, 0], [0, 1, 0]])]


def pose(rng):
    out = np.eye(4)
    out[:3, :3] = TURNS[rng.integers(len(TURNS))]
    out[:3, 3] = rng.integers(-3, 4, 3)
    return out


def mesh(rng):
    V = rng.integers(-2, 3, (8, 3))
    return types.SimpleNamespace(vertices=V, faces=np.array([rng.choice(8, 3, replace=False) for _ in range(2)]))


def corners(mesh, pose):
    """(faces, 3 corners, 3) placed, as lists of whole numbers."""
    return (mesh.vertices @ pose[:3, :3].T + pose[:3, 3]).astype(int)[mesh.faces].tolist()


def apart(triangles):
    return np.array(triangles, float).reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def brute(first, second):
    """The triangles that meet, and the least distance, of two placed meshes, each triangle with corners of its own."""
    scene = farcull.join(apart(first), apart(second))
    (nearest,) = farcull.distances(*scene)
    return [(int(a), int(b) - len(first)) for a, b in farcull.collide(*scene).pairs], nearest.distance


def filled(manager, rng, names):
    """Puts meshes into the manager; returns their corners by name."""
    out = {}
    for name in names:
        one, first, last = mesh(rng), pose(rng), pose(rng)
        manager.add_object(name, one, first)
        manager.set_transform(name, last)
        out[name] = corners(one, last)
    return out


def differences(manager_type, rounds):
    """How many answers of managers are not those of brute force; and how many met, and did not."""
    rng = np.random.default_rng(20261127)
    wrong, met = 0, [0, 0]
    for _ in range(rounds):
        one, other = manager_type(), manager_type()
        ours, theirs = filled(one, rng, ["a", "b", "c"]), filled(other, rng, ["x", "y"])
        one.add_object("gone", mesh(rng))
        one.remove_object("gone")
        inside = {pair: brute(ours[pair[0]], ours[pair[1]]) for pair in itertools.combinations("abc", 2)}
        across = {pair: brute(ours[pair[0]], theirs[pair[1]]) for pair in itertools.product("abc", "xy")}
        for truth, collisions, least in (
            (inside, one.in_collision_internal, one.min_distance_internal),
            (across, lambda *a: one.in_collision_other(other, *a), lambda *a: one.min_distance_other(other, *a))):
            expected = {pair for pair, (pairs, _) in truth.items() if pairs}
            said, names, data = collisions(True, True)
            contacts = sorted((p, (d.index(p[0]), d.index(p[1]))) for d in data for p in [tuple(sorted(d.names))])
            wrong += said != bool(expected) or names != expected or said != collisions()
            wrong += contacts != sorted((p, pair) for p, (pairs, _) in truth.items() for pair in pairs)
            met[bool(expected)] += 1
            distance, names, data = least(True, True)
            nearest = min(d for _, d in truth.values())
            wrong += abs(distance - nearest) > 1e-9 or truth[names][1] > nearest + 1e-9
            gap = np.linalg.norm(data.point(names[0]) - data.point(names[1]))
            wrong += data.names != set(names) or abs(gap - data.distance) > 1e-9 or distance != least()
    return wrong, met


def test_the_manager_answers_as_brute_force():
    wrong, met = differences(CollisionManager, 6)
    assert wrong == 0 and min(met) > 1, (wrong, met)

    class Stale(CollisionManager):
        """Twin: keeps the first pose."""

        def set_transform(self, name, transform):
            if (self._meshes[name][2] == np.eye(4)).all():
                super().set_transform(name, transform)

    assert differences(Stale, 1)[0] > 0


def swept(V0, V1, radius):
    return np.minimum(V0, V1) - radius, np.maximum(V0, V1) + radius


def brute_force(V0, V1, edges, faces, radius, first, second):
    """The candidates of ipc-toolkit's brute force, by comparing all boxes."""
    lo, hi = swept(V0, V1, radius)
    indices = {"vertex": np.arange(len(lo))[:, None], "edge": edges, "face": faces}
    a, b = indices[first], indices[second]
    meet = (lo[a].min(1)[:, None] <= hi[b].max(1)[None]) & (lo[b].min(1)[None] <= hi[a].max(1)[:, None])
    shared = (a[:, None, :, None] == b[None, :, None, :]).any(axis=(2, 3))
    pairs = np.argwhere(meet.all(axis=2) & ~shared)
    return {tuple(pair) for pair in pairs.tolist() if (first, second) != ("edge", "edge") or pair[0] < pair[1]}


KINDS = [("edge", "vertex"), ("edge", "edge"), ("face", "vertex"), ("edge", "face")]


def cases():
    """Cloths that move, at many scales; and points on a grid, where boxes touch and share corners."""
    rng = np.random.default_rng(20261127)
    for n, scale, step, radius in ((4, 1, 0.3, 0), (5, 1e-6, 0.5, 1e-8), (4, 1e8, 0.1, 1e6), (5, 1, 0, 0.05), (3, 1e-200, 0.3, 0)):
        points = np.array([[x, y, rng.normal()] for x in range(n) for y in range(n)]) * scale
        squares = [(k, k + 1, k + n, k + n + 1) for k in range(n * n - n) if k % n < n - 1]
        faces = np.array([t for a, b, c, d in squares for t in ((a, b, c), (b, d, c))])
        yield points, points + step * scale * rng.normal(size=points.shape), faces, radius
    for radius in (0, 0.5):
        grid = rng.integers(0, 3, (2, 12, 3)).astype(float)
        yield grid[0], grid[1], np.array([rng.choice(12, 3, replace=False) for _ in range(9)]), radius


def missed_and_more():
    """How many candidates of brute force the broad phase lacks; and how many of all it has in vain."""
    missed = more = right = 0
    for V0, V1, faces, radius in cases():
        edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
        broad = BroadPhase()
        broad.build(V0, V1, edges, faces, radius)
        for first, second in KINDS:
            found = getattr(broad, f"detect_{first}_{second}_candidates")()
            assert found.dtype.kind == "i" and found.shape[1:] == (2,)
            ours, truth = set(map(tuple, found.tolist())), brute_force(V0, V1, edges, faces, radius, first, second)
            assert len(ours) == len(found)
            missed, more, right = missed + len(truth - ours), more + len(ours - truth), right + len(truth)
    return missed, more, right


def test_the_broad_phase_has_all_candidates_of_brute_force(monkeypatch):
    missed, more, right = missed_and_more()
    # Boxes are grown by a rounding, so that a few more may touch.
    assert missed == 0 and more < right / 50 and right > 1000, (missed, more, right)
    # Twins: diagonals that are looked for nearer by, boxes that are not swept, neighbours of one object.
    build, collide = BroadPhase.build, farcull.collide

    def as_one_object(V, F, starts, **options):
        a, b = collide(V, F, self=True, **options).pairs.T
        return types.SimpleNamespace(pairs=np.stack([a, b], 1)[(a < starts[1]) & (b >= starts[1])])

    for owner, name, wrong in ((broad_phase, "reach", lambda boxes: 0.0), (farcull, "collide", as_one_object),
                               (BroadPhase, "build", lambda broad, V0, V1, *more: build(broad, V0, V0, *more))):
        with monkeypatch.context() as twin:
            twin.setattr(owner, name, wrong)
            assert missed_and_more()[0] > 0, name
