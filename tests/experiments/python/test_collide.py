"""Answers of collide, Collider, join and distances, and the arrays that they take."""

import inspect
import json
import math
import os
import pickle
import types

import farcull
import numpy as np
import pytest
from lab import asked, error_of, refused, same_pairs

V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [2, 1, 1], [9, 9, 9]], float)
F = np.array([[0, 1, 2], [3, 4, 5], [6, 6, 6]])
OBJECTS = [0, 1, 2]


@pytest.mark.parametrize("kind", ["i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8"])
def test_many_triangles_of_every_type_are_read_exactly(kind):
    # More rows than are converted at once, and some that are left over.
    rng = np.random.default_rng(20261124)
    most = min(np.iinfo(kind).max, 999)
    given = rng.integers(0, most + 1, (1000, 3)).astype(kind)
    for rows in (0, 1, 255, 256, 257, 1000):
        scene = farcull.Scene.from_arrays(np.zeros((1000, 3)), given[:rows])
        assert np.array_equal(scene.triangles, given[:rows])


# Around the blocks that the library reads at once, and those that are converted before it reads them.
@pytest.mark.parametrize("row", [0, 255, 256, 340, 341, 342, 511, 700, 999])
@pytest.mark.parametrize("value", [-1, 2**32, 2**32 + 1, 2**63 - 1, -(2**63), -(2**32)])
def test_an_index_that_does_not_fit_is_named_with_its_row(row, value):
    given = np.zeros((1000, 3), np.int64)
    given[row, row % 3] = value
    said = f"triangle {row} names vertex {value}"
    error = error_of(farcull.collide, V, given, self=True)
    assert error.where == "F" and error.reason == f"{said} of {len(V)}"
    for other in (np.asfortranarray(given), given.astype(np.uint64)):
        error = error_of(farcull.collide, V, other, self=True)
        wraps = value < 0 and other.dtype == np.uint64
        as_read = f"triangle {row} names vertex {value % 2**64}" if wraps else f"{said} of {len(V)}"
        assert error.where == "F" and error.reason == as_read


def test_arrays_that_fit_are_not_copied(monkeypatch):
    from farcull import _arguments

    indices = F.astype(np.uint32)
    assert _arguments.array("V", V) is V
    assert _arguments.array("F", indices) is indices
    assert _arguments.array("V", V.tolist()) is not V


def test_an_answer_outlives_its_collider_and_its_input():
    vertices = V.copy()
    collider = farcull.Collider()
    pairs = collider.find(vertices, F, OBJECTS).pairs
    vertices[:] = 0
    del collider
    assert pairs.tolist() == [[0, 1]]


def bad_arguments():
    nan, huge = V.copy(), V.copy()
    nan[4, 1] = math.nan
    huge[2, 2] = math.inf
    far = F.astype(np.uint64)
    far[1, 1] = 2**64 - 1
    values = dict(
        V=[nan, huge, V[:, :2], V.ravel(), V[0, 0], V[None], V.astype(complex), V.astype(np.longdouble),
           V.astype(object), V.astype(bool), V.astype(str), np.full((7, 3), 2**60), np.ma.masked_less(V, 0),
           [[0, 0, 0], [1]], None, []],
        F=[F - 1, F + 1, far, F.astype(float), F.astype(bool), F[:, :2], "triangles"],
        object_starts=[[1, 2], [0, 2, 1], [0, 0, 2], [0, 3], [0, 4], [0, -1], [0, 2**40], np.array([0, 2**63], np.uint64), [0.0, 1.0],
                 [[0, 1]], None, []],
        self=[[True], 1, "yes"],
        clearance=[-1, math.inf, math.nan, "0", 10**400],
        neighbours=[1],
        contacts=[1, "crossing"],
        ignore=[[(0, 3)], [(0, 1), (1, 1)], [(-1, 0)], [(0, 2**32)], [(0, 2**70)], [(0.0, 1.0)], [(0, 1, 2)],
                [(0, 1), (2,)], [("base", "hand")], "0:1", True],
        limit=[0, -1, 2**64, 1.0, True],
        poses=[[], np.eye(4), [np.eye(4)], [np.eye(4)] * 4, np.full((3, 4, 4), np.nan), [np.eye(4).T + 1] * 3,
               [np.eye(3)] * 3, np.stack([np.eye(4)] * 3).astype(np.longdouble), "poses"],
        threads=[-1, 1025, 2**70, 1.0])
    return [(name, value) for name, all_values in values.items() for value in all_values]


@pytest.mark.parametrize("name, value", bad_arguments())
def test_an_argument_that_is_wrong_is_named(name, value):
    error = error_of(farcull.collide, **{**dict(V=V, F=F, object_starts=OBJECTS), name: value})
    assert isinstance(error, farcull.InputError) and isinstance(error, ValueError)
    # An index beyond no vertices at all is the triangles' fault.
    assert error.where == name or (name == "V" and error.where == "F")


# Inputs that are not what they were meant to be, and what is said of each. The last ones are twins, which have an answer.
with open(os.path.join(os.environ["FARCULL_ROOT"], "tests/cases/misunderstood.json")) as file:
    CASES = json.load(file)


@pytest.mark.parametrize("name", CASES)
def test_what_is_misunderstood_is_an_error_with_a_remedy(name):
    case = CASES[name]
    vertices, triangles = (np.array(case[key]).reshape(-1, 3) for key in ("vertices", "triangles"))
    triangles = triangles.astype(int)
    arguments = dict(V=vertices, F=triangles, object_starts=case["object_starts"], self=case["self"])

    def run_as_scene(**given):
        return farcull.Scene.from_arrays(**given).run()

    for call in (farcull.collide, farcull.distances, run_as_scene):
        if "where" not in case:
            call(**arguments)
            continue
        error = error_of(call, **arguments)
        if call is run_as_scene and error.where == "scene":
            assert "nothing to test" in error.reason
        else:
            assert error.where == case["where"] and case["reason"] in error.reason


def test_a_remedy_fits_the_call():
    quads, mixed = np.array([[0, 1, 2, 3]]), "may be swapped"
    for call in (farcull.collide, farcull.distances):
        assert error_of(call, None, F).remedy == error_of(call, V, None).remedy == "give V and F"
        assert error_of(call, V, F[:0], poses=[np.eye(4)]).remedy == "give some"
        assert error_of(call, V, quads).remedy == "give an array of shape (m, 3); triangulate polygons"
        assert error_of(call, V[:, :2], F).remedy == "give an array of shape (n, 3)"
        assert mixed in error_of(call, F, V).remedy and mixed not in error_of(call, V, F.astype(bool)).remedy
        assert "label" in error_of(call, V, F, [0, 0, 2]).remedy
        assert error_of(call, V, F, [0, 1, 3]).remedy.endswith("below the number of triangles")
    for again in (farcull.Collider(), farcull.DistanceFinder()):
        assert "poses alone" in error_of(again.find, poses=[np.eye(4)]).remedy


def test_labels_group_triangles_in_any_order():
    scene = farcull.Scene("two-tori")
    V, F, starts = scene.vertices, scene.triangles, scene.object_starts
    count = len(F)
    expected = farcull.collide(V, F, starts, contacts=True)
    assert len(expected.pairs) == 282 and expected.objects.tolist() == [[0, 1]] * 282
    labels = np.repeat([3, 7], [starts[1], count - starts[1]])
    order = np.random.default_rng(20261127).permutation(count)
    place = np.argsort(order)  # where the triangle k is now
    wanted = np.sort(place[expected.pairs], axis=1)
    wanted = wanted[np.lexsort((wanted[:, 1], wanted[:, 0]))].tolist()
    for names in (labels, labels.astype(str)):
        assert same_pairs(farcull.collide(V, F, labels=names), expected)
        mixed = farcull.collide(V, F[order], labels=names[order], contacts=True)
        assert mixed.pairs.tolist() == wanted
        assert np.array_equal(mixed.objects, names[order][mixed.pairs]) and mixed.objects.dtype == names.dtype
        assert not np.array_equal(mixed.objects, names[mixed.pairs])  # the twin: of triangles as they were
        assert sorted(mixed.kinds) == sorted(expected.kinds)
        (answer,) = farcull.distances(V, F[order], labels=names[order])
        assert answer.objects == tuple(np.unique(names).tolist()) and list(sorted(answer.triangles)) in wanted
        ignore = [tuple(np.unique(names))]
        assert error_of(farcull.collide, V, F[order], labels=names[order], ignore=ignore).where == "ignore"
    # Labels beyond 2^53 are not rounded, whatever the type of the rows.
    large = np.array([2**60, 2**60 + 1, 2**61, 2**61 + 1], np.uint64)
    four = np.concatenate([F[:1]] * 4)
    for rows in [(2**60 + 1, 2**61 + 1)], np.array([(2**60 + 1, 2**61 + 1)]), large[[[1, 3]]]:
        assert [1, 3] not in farcull.collide(V, four, labels=large, ignore=rows).pairs.tolist()
        assert [0, 2] in farcull.collide(V, four, labels=large, ignore=rows).pairs.tolist()
    masked = np.ma.array([[3, 7], [3, 7]], mask=[[0, 0], [1, 1]])
    assert error_of(farcull.collide, V, F, labels=labels, ignore=masked).where == "ignore"
    assert error_of(farcull.collide, V, F, starts, clearance=2**53 + 1).where == "clearance"
    far = np.array([[[1, 0, 0, 2**53 + 1], [0, 1, 0, 0], [0, 0, 1, 0]]] * 2)
    assert error_of(farcull.collide, V, F, starts, poses=far).where == "poses"
    for wrong in (labels[1:], labels.astype(float), [labels], [[0], 1], None, np.ma.array(labels)):
        assert error_of(farcull.collide, V, F, labels=wrong).where in ("labels", "object_starts")
    assert error_of(farcull.collide, V, F, starts, labels=labels).where == "labels"
    alone = error_of(farcull.collide, V, F, labels=["a"] * count)  # the twin, without labels, names object_starts
    assert (alone.where, error_of(farcull.collide, V, F).where) == ("labels", "object_starts") and "labels" in alone.remedy
    assert error_of(farcull.distances, V, F, labels=["a"] * count).where == "labels"
    assert error_of(farcull.collide, V, F, labels=labels, limit=3).where == "limit"
    for wrong in ([(3, 8)], [("3", "7")], [(3.0, "7")]):
        assert error_of(farcull.collide, V, F, labels=labels, ignore=wrong).where == "ignore"
    assert error_of(farcull.collide, V, F, labels=labels.astype(str), ignore=[(3, 7)]).where == "ignore"


def test_what_the_package_shows_of_itself():
    result = farcull.collide(V, F, OBJECTS)
    assert repr(result) == "<farcull.Result: 1 pair, 0 of neighbours>" and len(result.pairs) == 1
    assert {name for name in dir(farcull) if name[0] != "_"} == set(farcull.__all__)
    assert asked("--version").startswith(f"farcull {farcull.__version__}, ")
    for call in (farcull.collide, farcull.distances, farcull.Collider.find, farcull.clash, farcull.show):
        for name in inspect.signature(call).parameters:
            assert name == "self" or name in call.__doc__, (call, name)
    with pytest.raises(FileNotFoundError) as caught:
        farcull.Scene("/no/such/file.obj")
    assert isinstance(caught.value, farcull.Error) and caught.value.filename == "/no/such/file.obj"
    scene = farcull.Scene.from_arrays(V, F, OBJECTS, self=[True, False, False], names=["a", "b", "c"])
    again = pickle.loads(pickle.dumps(scene))
    assert again.names == scene.names and again.self == scene.self
    assert np.array_equal(again.vertices, V) and again.object_starts.tolist() == OBJECTS


def test_what_only_claims_to_be_an_array_is_refused():
    class Liar:
        __array_interface__ = {"shape": (10, 3), "typestr": "<f8", "version": 3, "data": "nowhere"}

    class Thrower:
        def __array__(self, *_):
            raise RuntimeError("no")

    mesh = types.SimpleNamespace(vertices=V, faces=F)
    for call in (farcull.collide, farcull.distances):
        assert "farcull.join" in error_of(call, mesh, mesh).remedy
    for given in (Liar(), Thrower(), object(), {1, 2}, b"bytes"):
        assert error_of(farcull.collide, given, F, OBJECTS).where == "V"
        assert error_of(farcull.collide, V, given, OBJECTS).where == "F"


def test_the_compiled_module_refuses_what_the_package_would_not_give_it():
    from farcull import _farcull

    question = dict(threads=0, all_objects=False, self_objects=[], clearance=0.0, neighbours=True, contacts=0,
                    ignore=[], limit=0)
    collider = _farcull.Collider(question)
    starts = np.zeros(1, np.int64)
    for vertices, triangles in ((V.astype(object), F), (V, F.astype(object)), (V.astype(">f8"), F), (V[:, :1], F),
                                (V, F.ravel()), (np.zeros((0, 3), "V8"), F)):
        error_of(collider.find, vertices, triangles, starts, np.empty((0, 3, 4)))
    assert refused(collider.find, V, F, np.array(OBJECTS), np.zeros((3, 4, 4))) == "poses"
    with pytest.raises(TypeError):
        collider.find(None, None)


def test_join_makes_one_scene_of_several_meshes():
    vertices, triangles, objects = farcull.join((V[:3], [[0, 1, 2]]), (V[3:], [[0, 1, 2], [3, 3, 3]]))
    assert objects.tolist() == [0, 1]
    assert farcull.collide(vertices, triangles, objects).pairs.tolist() == [[0, 1]]
    assert error_of(farcull.join).where == "meshes"
    assert error_of(farcull.join, (V, F), V).where == "meshes"
    assert error_of(farcull.join, (V[:2], F)).where == "F"
    assert error_of(farcull.join, (V.astype(object), F)).where == "V"


def test_distances():
    apart = V + 0
    apart[3:6, 2] += 1.5
    first, second, third = farcull.distances(apart, F, OBJECTS, exact=True)
    assert first.objects == (0, 1) and first.distance == 0.5 and first.squared == "1/4"
    assert first.points == ((1.0, 1.0, 0.0), (1.0, 1.0, 0.5))
    assert second.objects == (0, 2) and third.objects == (1, 2)
    for change in (dict(kind="far"), dict(k=0), dict(k=-1), dict(within=-1), dict(within=math.nan), dict(kind="all"),
                   dict(self=True, kind="nearest"), dict(inside="no"), dict(exact=1), dict(threads=-1), dict(object_starts=None),
                   dict(V=V * math.nan)):
        arguments = {**dict(V=apart, F=F, object_starts=OBJECTS), **change}
        where = error_of(farcull.distances, **arguments).where
        named = next(iter(change))
        assert where == {"kind": "within"}.get(named, named) or where == named
    error = error_of(farcull.distances, np.zeros((1, 3)), np.zeros((4600, 3), int), [0, 2300], kind="all", within=0)
    assert error.where == "within" and "more than 4194304 pairs of triangles" in error.reason
    assert error.remedy.endswith("as collisions with clearance")
