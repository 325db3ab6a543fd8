"""Scenes, runs of every method, checks and pictures, against the program's own answers."""

import csv
import io
import json

import farcull
import numpy as np
import pytest
from lab import asked, error_of, or_skip, refused, same_pairs

METHODS = ["far", "cullide", "quick-cullide", "i-collide", "boxes", "exact"]


def listed(record):
    """The pairs of a record as rows of the program's list."""
    starts = record.scene.object_starts
    pairs = np.concatenate([record.pairs, record.neighbour_pairs])
    pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
    owner = np.searchsorted(starts, pairs, side="right") - 1
    rows = np.stack([owner[:, 0], pairs[:, 0] - starts[owner[:, 0]]], 1)
    return np.hstack([rows, np.stack([owner[:, 1], pairs[:, 1] - starts[owner[:, 1]]], 1)])


def of_program(*arguments):
    rows = list(csv.reader(io.StringIO(asked("run", *arguments, "--no-verify", "--pairs", "-"))))[1:]
    return np.array([[int(cell) for cell in row[:4]] for row in rows], np.int64).reshape(-1, 4)


# Those of millions of triangles are for the program's own tests.
@pytest.mark.parametrize("name", [n for n in farcull.builtin_scenes() if n not in ("bunny-dragon", "breaking-dragon")])
def test_every_built_in_scene_answers_as_the_program(name):
    try:
        scene = farcull.Scene(name)
    except farcull.Error as error:
        assert "experiments/meshes.sh" in str(error), error
        pytest.skip(str(error))
    record = scene.run(verify=False)
    assert np.array_equal(listed(record), of_program(name))
    starts, selves = scene.object_starts, scene.self
    if len(starts) > 1 or any(selves):
        assert same_pairs(farcull.collide(scene.vertices, scene.triangles, starts, self=selves), record)


@pytest.mark.parametrize("method", METHODS)
def test_every_method_answers_as_the_program(method):
    options = {} if method in ("i-collide", "boxes", "exact") else {"resolution": 128, "device": "cpu"}
    words = [f"--{name}={value}" for name, value in options.items()]
    record = farcull.Scene("two-tori").run(method, **options)
    assert np.array_equal(listed(record), of_program("two-tori", "--method", method, *words))
    counted = record.accounting
    classes = ("pairs_kept", "certified_by_boxes", "neighbours", "certified_by_predicates")
    assert counted["pairs_total"] == sum(counted[c] for c in classes) + counted["false_negatives"]
    assert len(record.missed()) == counted["false_negatives"]
    assert record.json()["scene"]["triangles"] == 20000 and "two-tori" in str(record)


def test_what_cullide_misses_are_all_pairs_that_it_misses():
    scene = farcull.Scene("two-tori")
    truth = {tuple(pair) for pair in scene.run().pairs}
    record = scene.run("cullide", resolution=64, device="cpu")
    missed = {tuple(pair) for pair in record.missed()}
    assert len(missed) > 10  # more than a record names
    assert missed == truth - {tuple(pair) for pair in record.pairs}
    assert set(np.unique(record.bits)) <= {0, 1, 2, 3} and len(record.bits) == 20000
    assert len(record.views) and 64 <= max(view["width"] for view in record.views) < 80
    # Every triangle of a missed pair, or the other one of the pair, is culled.
    kept = set(record.kept_triangles.tolist())
    assert all(a not in kept or b not in kept for a, b in missed)
    assert not record.promises


def test_views_of_a_scene_are_read_only_and_keep_it():
    vertices = farcull.Scene("two-tori").vertices  # the scene itself is gone
    assert vertices.shape == (10000, 3) and np.isfinite(vertices).all()
    with pytest.raises(ValueError):
        vertices[0, 0] = 1
    with pytest.raises(ValueError):
        vertices.flags.writeable = True


def test_scenes_of_files(tmp_path):
    path, other = tmp_path / "one.off", tmp_path / "two.off"
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    other.write_text("OFF\n3 1 0\n0 0 -1\n0 0 1\n1 1 1\n3 0 1 2\n")
    scene = farcull.Scene(path, str(other))
    assert scene.names == ["one", "two"] and scene.run().pairs.tolist() == [[0, 1]]
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n")
    error = error_of(farcull.Scene, path)
    assert error.where == f"{path}:4" and error.remedy
    assert not isinstance(error, farcull.InputError)
    assert error_of(farcull.Scene, tmp_path / "none.off").remedy
    assert error_of(farcull.Scene, "no-such-scene").remedy


def test_vertices_that_nearly_coincide_are_welded_where_that_is_asked(tmp_path):
    V = np.array([[0, 0, 0], [1, 0, 0], [0, -1, 0], [0, 0, 1e-17], [1, 0, -1e-17], [0, 1, 0]])
    F = np.array([[0, 1, 2], [3, 4, 5]])
    for number in range(2):
        name = tmp_path / f"edge_{number}.obj"
        name.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in V.tolist()) + "f 1 2 3\nf 4 5 6\n")

    def met(scene):
        return len(scene.run(verify=False).neighbour_pairs) + len(scene.run(verify=False).pairs)

    pattern = tmp_path / "edge_%d.obj"
    assert met(farcull.Scene(name, self=True)) == 1  # the twin
    with pytest.warns(UserWarning, match="2 vertices merged"):
        joined = farcull.join((V, F), weld="1e-7*size")
        assert len(farcull.collide(*joined, self=True).pairs) == met(farcull.Scene(name, self=True, weld=1e-9)) == 0
    with pytest.warns(UserWarning, match="edge_1.*2 vertices merged"):
        frames = farcull.Frames(pattern, frames=2, self=True, weld=1e-9)
        assert [met(scene) for _, scene in frames] == [0, 0]
    for wrong in (-1, "size", True, [1]):
        assert refused(farcull.Scene, name, weld=wrong) == "weld"
        assert refused(farcull.join, (V, F), weld=wrong) == "weld"
    assert refused(farcull.Scene, "two-tori", weld=1) == "weld"
    # A name that begins like an option of the program is a name.
    assert "weld=1" in error_of(farcull.Scene, name, "--weld=1").where


def test_bad_names_are_refused():
    for names in ((), ("",), (3,), (None,), ("two\0tori",), (b"two-tori",), ("\ud800",), (["a"],)):
        assert isinstance(error_of(farcull.Scene, *names), farcull.InputError)
    assert error_of(farcull.Scene, "two-tori", self="no").where == "self"


def test_scenes_of_arrays_have_names():
    arrays = dict(V=np.eye(3), F=[[0, 1, 2], [0, 0, 0]], object_starts=[0, 1])
    assert farcull.Scene.from_arrays(**arrays).names == ["0", "1"]
    assert farcull.Scene.from_arrays(**arrays, names=["a", "b"]).names == ["a", "b"]
    for names in (["a"], "ab", [1, 2]):
        assert error_of(farcull.Scene.from_arrays, **arrays, names=names).where == "names"


BAD_OPTIONS = [
    dict(method="magic"), dict(method=3), dict(resolution="wide"), dict(resolution=True), dict(views="x"),  # not of boxes
    dict(depth_format=16, method="far"), dict(clusters=[1], method="far"), dict(conservative="yes"), dict(threads=-1),
    dict(verify="no"), dict(colour="red"), dict(self=True)]


@pytest.mark.parametrize("options", BAD_OPTIONS)
def test_a_bad_option_is_named_as_python_names_it(options):
    scene = farcull.Scene.from_arrays(np.eye(3), [[0, 1, 2], [0, 1, 2]], [0, 1])
    error = error_of(scene.run, **options)
    assert error.where == next(iter(options)) and isinstance(error, farcull.InputError)
    assert "--" not in str(error)


def test_certificates_are_those_of_the_program(tmp_path):
    scene = farcull.Scene("two-tori")
    record = scene.run(verify=False)
    path = tmp_path / "c.json"
    asked("run", "two-tori", "--no-verify", "--certificate", path)
    ours, theirs = json.loads(record.certificate()), json.loads(path.read_text())
    assert ours["evidence"] == theirs["evidence"] and ours["claims"] == theirs["claims"]
    checked = farcull.check(scene, record.certificate())
    assert checked.proved and checked.decided and np.array_equal(checked.pairs, record.pairs)
    # One that is not true is not proved.
    claims = dict(ours["claims"], meeting=ours["claims"]["meeting"] + 1)
    assert not farcull.check(scene, json.dumps(dict(ours, claims=claims))).proved
    other = farcull.check(farcull.Scene("two-spheres"), record.certificate())
    assert other.verdict == "not proved" and not other.decided
    assert error_of(farcull.check, scene, "{}").where == "certificate"


def test_lists_are_proved_or_refuted():
    scene = farcull.Scene("two-tori")
    pairs = scene.run(verify=False).pairs
    assert farcull.check(scene, pairs=pairs).proved
    assert farcull.check(scene, pairs=pairs[::-1, ::-1]).proved  # in any order
    for wrong in (pairs[1:], np.vstack([pairs, [[0, 10001]]]), []):
        refuted = farcull.check(scene, pairs=wrong)
        assert refuted.verdict == "refuted" and refuted.pair is not None
    near = scene.run(verify=False, clearance=0.01).pairs
    assert len(near) > len(pairs) and farcull.check(scene, pairs=near, clearance=0.01).proved
    for change in (dict(pairs=None), dict(pairs=[[0, -1]]), dict(pairs=[[0, 20000]]), dict(pairs=[[0, 2**63 - 1]]),
                   dict(pairs=[0, 1]), dict(pairs=[[0.0, 1.0]]), dict(pairs=pairs, clearance=-1), dict(certificate=3)):
        refused(farcull.check, scene, **change)


def test_frames():
    frames = farcull.Frames("two-spheres", frames=(3, 5))
    assert len(frames) == 3
    seen = {frame: scene.vertices for frame, scene in frames}
    assert list(seen) == [3, 4, 5] and not np.array_equal(seen[3], seen[4])
    assert np.array_equal(frames.at(3).vertices, seen[3])  # each scene is its own
    assert error_of(frames.at, 6).where == "frame"
    for given in (0, -1, (2, 1), (1, 2, 3), "9", 2.0, None):
        assert error_of(farcull.Frames, "two-spheres", frames=given).where == "frames"
    assert error_of(farcull.Frames, "gap", frames=2).remedy


def test_pictures():
    scene = farcull.Scene("two-tori")
    drawn = or_skip(farcull.picture, scene, ["cullide", {"method": "far", "resolution": 64}], width=96, height=80)
    assert drawn.pixels.dtype == np.uint8 and drawn.pixels.ndim == 3
    assert drawn.pixels.shape[1] > 2 * 96 and len(np.unique(drawn.pixels.reshape(-1, 4), axis=0)) > 9
    assert [panel["colliding"] for panel in drawn.panels] == [282, 282]
    assert drawn.panels[1]["missed"] == 0
    for options in (dict(width=1), dict(view="q"), dict(methods=["magic"]), dict(methods=[])):
        error_of(farcull.picture, scene, **options)
