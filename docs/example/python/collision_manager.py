"""The methods of trimesh.collision.CollisionManager, answered by farcull: exactly, and without FCL.

Meshes are surfaces, as there: one that lies wholly inside another does not meet it. A mesh is whatever
farcull.join takes, such as a trimesh.Trimesh. Poses are applied in doubles; the answer is exact for the
corners that this gives.
"""

import farcull
import numpy as np

EXTERNAL = "__external"  # the name of a mesh that is in no manager


class ContactData:
    """Two triangles that meet: ``names`` of their objects, and the ``point`` in the middle of the segment
    that they have in common; NaN where they have an area in common."""

    def __init__(self, names, faces, segment):
        self.names = set(names)
        self.point = segment.mean(axis=0)
        self._faces = dict(zip(names, faces))

    def index(self, name):
        """The triangle in the mesh of this name."""
        return self._faces[name]


class DistanceData:
    """The nearest triangles and points of two objects."""

    def __init__(self, names, faces, points, distance):
        self.names = set(names)
        self.distance = distance
        self._faces = dict(zip(names, faces))
        self._points = dict(zip(names, points))

    def index(self, name):
        return self._faces[name]

    def point(self, name):
        return self._points[name]


class CollisionManager:
    def __init__(self):
        self._meshes = {}  # by name: vertices, triangles, pose
        self._collider = farcull.Collider(segments=True)
        self._finder = farcull.DistanceFinder(kind="nearest", inside=False)

    def add_object(self, name, mesh, transform=None):
        V, F, _ = farcull.join(mesh)
        self._meshes[name] = V, F, np.eye(4)
        if transform is not None:
            self.set_transform(name, transform)

    def remove_object(self, name):
        if name not in self._meshes:
            raise ValueError(f"{name} not in collision manager!")
        del self._meshes[name]

    def set_transform(self, name, transform):
        if name not in self._meshes:
            raise ValueError(f"{name} not in collision manager!")
        self._meshes[name] = *self._meshes[name][:2], np.asarray(transform, float)

    def in_collision_internal(self, return_names=False, return_data=False):
        """Whether two objects meet; the pairs of their names; a ContactData for each two triangles."""
        return self._collisions(_Scene(self), return_names, return_data)

    def in_collision_other(self, other_manager, return_names=False, return_data=False):
        """The same between the objects of two managers; first the name in this one."""
        return self._collisions(_Scene(self, other_manager), return_names, return_data)

    def in_collision_single(self, mesh, transform=None, return_names=False, return_data=False):
        """The same between the objects and a mesh; the names of the objects that it meets."""
        scene = _Scene(self, _single(mesh, transform))
        met, names, data = self._collisions(scene, True, True)
        return _wanted(met, return_names and {a for a, _ in names}, return_data and data)

    def min_distance_internal(self, return_names=False, return_data=False):
        """The least distance of two objects, exact and rounded once; their names; a DistanceData."""
        return self._least(_Scene(self), return_names, return_data)

    def min_distance_other(self, other_manager, return_names=False, return_data=False):
        return self._least(_Scene(self, other_manager), return_names, return_data)

    def min_distance_single(self, mesh, transform=None, return_name=False, return_data=False):
        least, names, data = self._least(_Scene(self, _single(mesh, transform)), True, True)
        return _wanted(least, return_name and names[0], return_data and data)

    def _collisions(self, scene, return_names, return_data):
        names, data = set(), []
        if len(scene.objects) > 1:
            found = self._collider.find(scene.V, scene.F, scene.objects)
            pairs = [scene.named(pair) for pair in found.pairs]
            names = {named for named, _ in pairs}
            if return_data:
                data = [ContactData(*pair, segment) for pair, segment in zip(pairs, found.segments)]
        return _wanted(len(names) > 0, return_names and names, return_data and data)

    def _least(self, scene, return_names, return_data):
        if len(scene.objects) < 2:
            raise ValueError("there are no two objects")
        found = self._finder.find(scene.V, scene.F, scene.objects)
        nearest = int(np.argmin(found.distance))
        names, faces = scene.named(found.triangles[nearest])
        least = float(found.distance[nearest])
        data = DistanceData(names, faces, found.points[nearest], least)
        return _wanted(least, return_names and names, return_data and data)


class _Scene:
    """The objects of a manager; or all those of two managers, as two objects of farcull, so that only
    pairs between the managers are found."""

    def __init__(self, *managers):
        meshes = [sorted(manager._meshes.items()) for manager in managers]
        self._names = [name for one in meshes for name, _ in one]
        placed = [(V @ pose[:3, :3].T + pose[:3, 3], F) for one in meshes for _, (V, F, pose) in one]
        self.objects = self._starts = ()
        if placed:
            self.V, self.F, self._starts = farcull.join(*placed)
            self.objects = self._starts
        if len(meshes) == 2:
            self.objects = sorted({*self._starts[:1], *self._starts[len(meshes[0]):][:1]})

    def named(self, triangles):
        """The names of the objects of two triangles, and the triangles in their meshes."""
        owners = np.searchsorted(self._starts, triangles, "right") - 1
        faces = tuple((triangles - self._starts[owners]).tolist())
        return tuple(self._names[owner] for owner in owners), faces


def _single(mesh, transform):
    out = CollisionManager()
    out.add_object(EXTERNAL, mesh, transform)
    return out


def _wanted(answer, *more):
    """The answer alone, or with what was asked for besides."""
    asked = [one for one in more if one is not False]
    return (answer, *asked) if asked else answer
