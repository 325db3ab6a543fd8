"""Answers as arrays and tables, against the program's own; pages; and the meshes and arrays that people hold."""

import csv
import io
import json
import pathlib
import pickle
import sys
import types

import farcull
import numpy as np
import pytest
from lab import ALL, asked, error_of, or_skip, refused, same_pairs
from test_contacts import OBJECTS, Program, tangled


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """Objects that lie apart by some, so that distances are of all kinds."""
    V, F = tangled(20261127)
    V = V[F].reshape(-1, 3) + np.repeat([0, 3.25, 0.5, 9], 120)[:, None]
    F = np.arange(len(V)).reshape(-1, 3)
    return V, F, Program(tmp_path_factory.mktemp("apart"), V, F)


def as_objects(found):
    """The columns as the objects of before, one row after the other."""
    return [
        farcull.Distance(
            tuple(found.objects[k].tolist()), tuple(found.triangles[k].tolist()), float(found.distance[k]),
            found.squared[k], tuple(tuple(p) for p in found.points[k].tolist()),
            tuple(tuple(w) for w in found.weights[k].tolist()), tuple(found.normals[k].tolist()),
            tuple(farcull.FEATURES[f] for f in found.features[k]), farcull.INSIDE[found.inside[k]])
        for k in range(len(found.distance))]


def known(found):
    """What the program says of distances too."""
    return [(d.objects, d.triangles, d.distance, d.squared, d.points, d.features, d.inside) for d in found]


def of_program(program, *words):
    """The distances that the program answers, as known() has them."""
    record = json.loads(asked("distance", *program.files, "--json", "-", *words))
    return [(
        (d["a"], d["b"]), tuple(OBJECTS[o] + t for o, t in zip((d["a"], d["b"]), d["triangles"])), d["distance"],
        d["squared"], tuple(map(tuple, d["witness"])), tuple(d["features"]), d["inside"] or "unknown")
        for d in record["pairs"]]


def require_contacts(V, F, found):
    """Weights are those of the points, and the normal leads from one to the other."""
    assert (found.weights >= 0).all() and np.allclose(found.weights.sum(2), 1, rtol=0, atol=1e-15)
    corners = V[F[found.triangles]]
    assert np.allclose(np.einsum("kti,ktix->ktx", found.weights, corners), found.points, rtol=0, atol=1e-13)
    apart = found.distance > 0
    reach = found.points[:, 1] - found.points[:, 0]
    assert np.allclose(found.normals * found.distance[:, None], reach, rtol=0, atol=1e-12) and not found.normals[~apart].any()
    assert np.allclose(np.linalg.norm(found.normals[apart], axis=1), 1, rtol=0, atol=1e-15)
    # Where points lie, by the weights that are not 0.
    names = np.array(farcull.FEATURES)[found.features]
    assert np.array_equal((found.weights > 0).sum(2) == 1, np.char.startswith(names, "vertex"))


QUESTIONS = [dict(kind="objects"), dict(kind="objects", self=True), dict(kind="nearest", k=2), dict(kind="all", within=0.75)]


@pytest.mark.parametrize("question", QUESTIONS)
def test_arrays_of_distances_are_the_objects_of_the_program(scene, question):
    V, F, program = scene
    words = ["--pairs", question["kind"]] + ["--self"] * ("self" in question)
    words += [f"--{name}={question[name]}" for name in ("k", "within") if name in question]
    found = farcull.distances(V, F, OBJECTS, exact=True, **question)
    truth = of_program(program, *words)
    assert as_objects(found) == list(found) and known(found) == truth and len(found) == len(truth) > 2
    assert found.objects.dtype == found.triangles.dtype == np.int64
    require_contacts(V, F, found)
    # Without exact=True all but the texts: with "all" in doubles.
    quick = farcull.distances(V, F, OBJECTS, **question)
    require_contacts(V, F, quick)
    assert np.array_equal(quick.triangles, found.triangles) and np.array_equal(quick.objects, found.objects)
    assert np.array_equal(quick.inside, found.inside) and all(text is None for text in quick.squared)
    assert np.allclose(quick.distance, found.distance, rtol=2**-32, atol=0)
    assert np.allclose(quick.normals, found.normals, rtol=0, atol=2**-15)
    assert question["kind"] == "all" or known(quick) == [d[:3] + (None,) + d[4:] for d in truth]
    # Twin: two columns exchanged in one row are noticed.
    found.triangles[1] = found.triangles[1, ::-1].copy()
    assert known(found) != truth
    with pytest.raises(AssertionError):
        require_contacts(V, F, found[:2])


def test_the_table_of_distances_is_that_of_the_program(scene):
    pytest.importorskip("pandas")
    V, F, program = scene
    table = farcull.distances(V, F, OBJECTS, self=True, exact=True).to_pandas()
    more = table.columns[-9:]
    assert list(more) == ["weight_a0", "weight_a1", "weight_a2", "weight_b0", "weight_b1", "weight_b2", "normal_x", "normal_y", "normal_z"]
    table = table.drop(columns=more)
    rows = list(csv.reader(io.StringIO(asked("distance", *program.files, "--self", "--csv", "-"))))
    assert list(table.columns) == rows[0]
    table["triangle_a"] -= 40 * table["object_a"]
    table["triangle_b"] -= 40 * table["object_b"]
    theirs = [[cell or "unknown" for cell in row] for row in rows[1:]]
    numbers = [k for k, name in enumerate(rows[0]) if table[name].dtype.kind in "if"]
    assert len(table) == len(theirs) == 10
    for ours, row in zip(table.to_numpy().tolist(), theirs):
        assert [x if k in numbers else str(x) for k, x in enumerate(ours)] == [
            float(x) if k in numbers else x for k, x in enumerate(row)]


def test_distances_are_a_sequence(scene):
    V, F, _ = scene
    found = farcull.distances(V, F, OBJECTS)
    rows = list(found)
    assert found[-1] == rows[-1] == found[np.int64(len(rows) - 1)] and list(found[1:3]) == rows[1:3]
    assert list(found[found.distance > 1]) == [row for row in rows if row.distance > 1] != rows
    assert found.index(rows[2]) == 2 and rows[2] in found and repr(found) == "<farcull.Distances: 6 answers>"
    assert repr(found[:1]) == "<farcull.Distances: 1 answer>"
    with pytest.raises(IndexError):
        found[6]
    none = farcull.distances(V, F, OBJECTS, kind="all", within=0)[:0]
    assert list(none) == [] and none.points.shape == (0, 2, 3) and none.squared.shape == (0,)
    assert list(pickle.loads(pickle.dumps(found))) == rows


def test_objects_that_are_ignored_have_no_distance(scene):
    V, F, program = scene
    truth = of_program(program, "--ignore", "o0:o2,o3:o1")
    for ignore in ([(0, 2), (3, 1)], [(2, 0), (1, 3), (0, 2)]):
        found = known(farcull.distances(V, F, OBJECTS, ignore=ignore, exact=True))
        assert found == truth == known(farcull.DistanceFinder(ignore=ignore, exact=True).find(V, F, OBJECTS))
    labels = np.repeat([7, 5, 3, 9], 40)  # the objects 2, 1, 0 and 3
    labelled = farcull.distances(V, F, labels=labels, ignore=[(7, 3), (5, 9)], exact=True)
    assert sorted(d.squared for d in labelled) == sorted(d[3] for d in truth)
    # Twin: other objects, and none.
    assert known(farcull.distances(V, F, OBJECTS, ignore=[(0, 1), (3, 1)], exact=True)) != truth
    assert len(truth) == 4 and len(farcull.distances(V, F, OBJECTS)) == 6
    assert refused(farcull.distances, V, F, OBJECTS, ignore=[("o0", "o1")]) == "ignore"
    assert refused(farcull.DistanceFinder(ignore=[(0, 2)]).find, V, F, labels=labels) == "labels"


def moved(V, F, starts, poses):
    """The vertices after each object was moved, by the operations that the documentation states."""
    out = V.copy()
    for first, end, pose in zip(starts, [*starts[1:], len(F)], poses):
        x, y, z = V[F[first:end]].reshape(-1, 3).T
        rows = [((r[0] * x + r[1] * y) + r[2] * z) + r[3] for r in pose[:3]]
        out[F[first:end].reshape(-1)] = np.stack(rows, axis=1)
    return out


def random_poses(rng, count):
    out = np.stack([np.eye(4)] * count)
    for pose in out:
        pose[:3, :3] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        pose[:3, 3] = rng.normal(size=3) / 4
    return out


def test_poses_move_objects_frame_after_frame():
    scene = farcull.Scene("two-spheres")
    V, F, starts = np.array(scene.vertices), np.array(scene.triangles), scene.object_starts
    rng = np.random.default_rng(20261128)
    collider, finder = farcull.Collider(contacts=True), farcull.DistanceFinder()
    sizes = set()
    for frame in range(6):
        poses = random_poses(rng, 2)
        arrays = (V, F, starts) if frame % 3 == 0 else ()  # poses alone move those of the frame before
        expected = moved(V, F, starts, poses)
        found, truth = collider.find(*arrays, poses=poses[:, :3]), farcull.collide(expected, F, starts, contacts=True)
        assert same_pairs(found, truth) and np.array_equal(found.kinds, truth.kinds)
        assert list(finder.find(*arrays, poses=list(poses))) == list(farcull.distances(expected, F, starts))
        for call in (farcull.collide, farcull.distances):
            assert len(call(V, F, starts, poses=poses)) if call is farcull.distances else same_pairs(call(V, F, starts, poses=poses), truth)
        sizes.add(len(truth.pairs))
        # Twin: the inverse rotations give another answer where objects meet.
        other = poses.copy()
        other[:, :3, :3] = poses[:, :3, :3].transpose(0, 2, 1)
        assert list(farcull.distances(V, F, starts, poses=other)) != list(farcull.distances(V, F, starts, poses=poses))
    assert len(sizes) > 3


def test_segments_are_those_of_the_program(scene):
    V, F = tangled(20261128)
    program = Program(scene[2].folder / "..", V, F)
    rows = list(csv.DictReader(asked("run", *program.files, "--self", "--no-verify", "--pairs", "-", "--segments").splitlines()))
    found = farcull.collide(V, F, OBJECTS, self=True, segments=True)
    ours = {tuple(pair): (farcull.KINDS[kind], ends) for pairs, kinds, segments in (
        (found.pairs, found.kinds, found.segments),
        (found.neighbour_pairs, found.neighbour_kinds, found.neighbour_segments))
        for pair, kind, ends in zip(pairs.tolist(), kinds, segments)}
    assert len(ours) == len(rows) > 500
    wrong = 0
    for row in rows:
        pair = tuple(OBJECTS[int(row[f"object_{x}"])] + int(row[f"triangle_{x}"]) for x in "ab")
        kind, ends = ours[pair]
        theirs = [float(row[c] or "nan") for c in ("x0", "y0", "z0", "x1", "y1", "z1")]
        assert kind == row["contact"] and np.array_equal(ends.ravel(), theirs, equal_nan=True)
        wrong += not np.array_equal(ends[::-1].ravel(), theirs, equal_nan=True)
    assert wrong > 100  # twin: ends exchanged are noticed
    assert np.isnan(found.segments).any() and np.isfinite(found.segments).any()
    kinds = farcull.collide(V, F, OBJECTS, **ALL)
    assert kinds.segments is None and np.array_equal(kinds.kinds, found.kinds)


def test_the_table_of_pairs(monkeypatch):
    V, F = tangled(3)
    result = farcull.collide(V, F, OBJECTS, self=True, segments=True)
    again = pickle.loads(pickle.dumps(result))
    assert np.array_equal(again.pairs, result.pairs) and again._input is None
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "pandas", None)
        for answer in (result, farcull.distances(V, F, OBJECTS), farcull.clash(farcull.Scene("two-tori"))):
            assert error_of(answer.to_pandas).where == "pandas"
    pytest.importorskip("pandas")
    table = result.to_pandas()
    assert list(table.columns) == ["a", "b", "neighbours", "object_a", "object_b", "contact", "x0", "y0", "z0", "x1", "y1", "z1"]
    assert table[["a", "b"]].to_numpy().tolist() == sorted([*result.pairs.tolist(), *result.neighbour_pairs.tolist()])
    of_neighbours = table[table.neighbours]
    assert np.array_equal(of_neighbours[["a", "b"]].to_numpy(), result.neighbour_pairs)
    assert of_neighbours.contact.tolist() == np.array(farcull.KINDS)[result.neighbour_kinds].tolist()
    assert np.array_equal(of_neighbours[["x1", "y1", "z1"]].to_numpy(), result.neighbour_segments[:, 1], equal_nan=True)
    ends = table[["a", "b"]].to_numpy()
    assert np.array_equal(table[["object_a", "object_b"]].to_numpy(), np.searchsorted(OBJECTS, ends, side="right") - 1)
    labels = np.repeat(["p", "q"], [40, len(F) - 40])[::-1]  # q comes first
    named = farcull.collide(V, F, labels=labels, self=True).to_pandas()
    assert named.neighbours.any() and not named.neighbours.all()
    assert np.array_equal(named[["object_a", "object_b"]].to_numpy(), labels[named[["a", "b"]].to_numpy()])
    assert list(farcull.collide(V, F, self=True).to_pandas().columns) == ["a", "b", "neighbours"]  # the twin: no objects


def without_times(record):
    return {key: value for key, value in record.items() if key not in ("stages", "time_ms", "commit")}


def test_clashes_are_those_of_the_program(scene, tmp_path):
    files = scene[2].files
    read = farcull.Scene(*files, self=True)
    for words, options in (([], {}), (["--clearance", "2"], dict(clearance=2)), (["--tolerance", "2"], dict(tolerance=2)),
                           (["--tolerance", "0.25*size"], dict(tolerance="0.25*size")),
                           (["--ignore", "o0:o2"], dict(ignore=[("o0", "o2")])), (["--ignore", "o0:o2"], dict(ignore=[(2, 0)]))):
        theirs = json.loads(asked("clash", *files, *words, "--json", "-"))
        ours = farcull.clash(read, **options)
        assert without_times(ours.json()) == without_times(theirs) and ours.rows == theirs["pairs"]
        assert ours.clean == theirs["clean"] and ours.rows
        assert str(ours).splitlines()[1] in asked("clash", *files, *words)
    # Twin: another question has another answer.
    assert without_times(farcull.clash(read, clearance=2).json()) != without_times(theirs)
    for wrong in (dict(clearance=-1), dict(tolerance=-1), dict(tolerance="1e-9*sizes"), dict(tolerance=""), dict(tolerance=None),
                  dict(clearance="1"), dict(ignore=[(0, 9)]), dict(threads=-1), dict(scene=None)):
        assert refused(farcull.clash, **{"scene": read, **wrong}) in wrong
    assert error_of(farcull.clash, farcull.Scene(files[0])).where == "scene"
    page = tmp_path / "clash.html"
    assert farcull.show(ours, page, browse=False) == str(page)
    assert '"verdict":"clash"' in page.read_text()
    pytest.importorskip("pandas")
    table = ours.to_pandas()
    assert table.verdict.tolist() == [row["verdict"] for row in ours.rows]
    assert table["kinds.crossing"].fillna(0).tolist() == [row["kinds"].get("crossing", 0) for row in ours.rows]


def test_answers_are_shown_in_the_browser(tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    scene = farcull.Scene("two-tori")
    V, F = scene.vertices.copy(), scene.triangles
    result = farcull.collide(V, F, scene.object_starts)
    path = or_skip(farcull.show, result)
    assert opened == ["file://" + path] and path.endswith(".html")
    assert "282 colliding pairs" in pathlib.Path(path).read_text("utf-8")
    record = scene.run("cullide", resolution=64, device="cpu")
    page = tmp_path / "record.html"
    farcull.show(record, page, browse=False)
    missed = len(record.missed())
    assert f'"missedPairs":{missed}' in page.read_text() and missed > 0 and len(opened) == 1
    assert '"command":"farcull picture two-tori --method cullide' in page.read_text()
    # A page that would show other pairs than the answer is an error.
    V[0] += 1e-9
    V[F[result.pairs[0, 0], 0]] += 100
    assert "changed" in error_of(farcull.show, result, page).reason
    for unusual in (scene.run(limit=3, verify=False), scene.run(clearance=1e-6, verify=False), farcull.collide(V, F, [0, 7], clearance=1e-6),
                    farcull.Collider().find(V, F, [0, 7]), pickle.loads(pickle.dumps(result)), 3, None):
        assert refused(farcull.show, unusual, page) == "what"


def test_meshes_of_other_packages_are_joined():
    V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0]], float)
    W = np.array([[1, 1, -1], [1, 1, 1], [2, 1, 1], [5, 5, 5]], float)
    Held = types.SimpleNamespace
    line, triangle = Held(type="line", data=np.array([[0, 1]])), Held(type="triangle", data=np.array([[0, 1, 2]]))
    trimesh, meshio = Held(vertices=V, faces=[[0, 1, 2]]), Held(points=W, cells=[line, triangle, triangle])
    expected = farcull.join((V, [[0, 1, 2]]), (W, [[0, 1, 2], [0, 1, 2]]))
    for ours, right in zip(farcull.join(trimesh, meshio), expected):
        assert np.array_equal(ours, right)
    assert farcull.collide(*farcull.join(trimesh, meshio)).pairs.tolist() == [[0, 1], [0, 2]]
    # Cells that are passed over could collide, so they are refused.
    quad = Held(type="quad", data=np.array([[0, 1, 2, 3]]))
    error = error_of(farcull.join, trimesh, Held(points=W, cells=[triangle, quad]))
    assert error.where == "meshes" and "quad" in error.reason
    for wrong in (Held(points=W, cells=[line]), Held(points=W, cells=np.array([3, 0, 1, 2])), Held(vertices=V), Held(points=W, cells=[]),
                  Held(vertices=None, faces=None), farcull.Scene("two-tori"), "mesh.obj", V, 3):
        assert refused(farcull.join, trimesh, wrong) in ("meshes", "V", "F")
    # numpy would round whole numbers beside doubles.
    assert refused(farcull.join, trimesh, (np.array([[0, 0, 0], [1, 0, 0], [0, 2**53 + 1, 0]]), [[0, 1, 2]])) == "V"
    assert refused(farcull.join, Held(points=W[:, :2], cells=[triangle])) == "V"


class Tensor:
    """An array that offers nothing but DLPack; device: 1 for the CPU, 2 for CUDA."""

    def __init__(self, array, device=1):
        self._array, self._device = array, device

    def __dlpack__(self, *, stream=None):
        return self._array.__dlpack__()

    def __dlpack_device__(self):
        return self._device, 0


def test_arrays_come_through_dlpack():
    V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [2, 1, 1]], np.float32)
    F = np.array([[0, 1, 2], [3, 4, 5]], np.int32)
    starts, labels, ignore = np.array([0, 1]), np.array([1, 0]), np.array([[0, 1]])
    assert farcull.collide(Tensor(V), Tensor(F), Tensor(starts)).pairs.tolist() == [[0, 1]]
    assert farcull.collide(Tensor(V), Tensor(F), labels=Tensor(labels)).pairs.tolist() == [[0, 1]]
    three = np.concatenate([F, F[1:]])
    for labels in None, [7, 8, 9]:
        rows = Tensor(ignore if labels is None else ignore + 7)
        some = farcull.collide(V, three, None if labels else [0, 1, 2], labels=labels, ignore=rows)
        assert some.pairs.tolist() == [[0, 2], [1, 2]]
    assert "device" in error_of(farcull.collide, Tensor(V, 2), F, starts).reason
    assert refused(farcull.collide, Tensor(V, 2), F, starts) == "V"
    assert refused(farcull.collide, V, Tensor(F, 2), starts) == "F"
    assert refused(farcull.collide, V, F, Tensor(starts, 2)) == "object_starts"
