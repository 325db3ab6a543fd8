"""Kinds of contact and ignored objects, against the program's own answers."""
import csv
import json

import farcull
import numpy as np
import pytest
from lab import ALL, asked, refused

OBJECTS = [0, 40, 80, 120]


def tangled(seed):
    """Four objects of triangles between the points of a grid: many touch, are neighbours, lie in one
    plane, or are degenerate."""
    print("seed", seed)
    grid = np.stack(np.meshgrid(range(4), range(4), range(4)), -1).reshape(-1, 3).astype(float)
    return grid, np.random.default_rng(seed).integers(0, len(grid), (160, 3))


class Program:
    """The scene of `tangled` as mesh files, and what the program says of it."""

    def __init__(self, folder, V, F):
        self.folder = folder
        points = "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in V.tolist())
        for o, first in enumerate(OBJECTS):
            faces = "".join(f"3 {a} {b} {c}\n" for a, b, c in F[first : first + 40].tolist())
            (folder / f"o{o}.off").write_text(f"OFF\n{len(V)} 40 0\n{points}{faces}")
        self.files = sorted(folder.glob("*.off"))

    def rows(self, *words):
        """(a, b, whether neighbours, kind) of each pair in the program's order; and its record."""
        pairs = self.folder / "pairs.csv"
        out = asked("run", *self.files, "--self", "--contacts", "--pairs", pairs, "--json", "-", "--no-verify", *words)
        rows = []
        for row in csv.DictReader(pairs.read_text().splitlines()):
            a, b = (OBJECTS[int(row[f"object_{x}"])] + int(row[f"triangle_{x}"]) for x in "ab")
            rows.append((a, b, row["neighbours"] == "1", row["contact"]))
        return rows, json.loads(out)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    V, F = tangled(20261124)
    return V, F, Program(tmp_path_factory.mktemp("tangled"), V, F)


def rows_of(result, names=None):
    """The answer as the program's rows."""
    out = []
    for pairs, kinds, neighbours in ((result.pairs, result.kinds, False),
                                     (result.neighbour_pairs, result.neighbour_kinds, True)):
        assert kinds.dtype == np.uint8 and kinds.shape == (len(pairs),)
        named = np.array(names or farcull.KINDS)[kinds].tolist()
        out += [(a, b, neighbours, kind) for (a, b), kind in zip(pairs.tolist(), named)]
    return sorted(out)


def test_kinds_are_those_of_the_program(scene):
    V, F, program = scene
    seen = set()
    for clearance in (0, 0.5):
        truth, _ = program.rows("--clearance", str(clearance))
        result = farcull.collide(V, F, OBJECTS, clearance=clearance, **ALL)
        assert rows_of(result) == truth and result.complete
        seen |= {kind for *_, kind in truth}
        assert min(len(result.pairs), len(result.neighbour_pairs)) > 100
        # Twins: two names exchanged, and one kind changed, are noticed.
        wrong = list(farcull.KINDS)
        wrong[2], wrong[3] = wrong[3], wrong[2]
        assert rows_of(result, wrong) != truth
        result.neighbour_kinds[50] = (result.neighbour_kinds[50] + 1) % 7
        assert rows_of(result) != truth
    assert seen == set(farcull.KINDS) and len(farcull.KINDS) == 7


def test_ignored_objects_are_those_of_the_program(scene):
    V, F, program = scene
    whole, _ = program.rows()
    for pairs in ([(0, 2), (3, 1)], [(1, 0), (0, 1)], [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]):
        truth, record = program.rows("--ignore", ",".join(f"o{a}:o{b}" for a, b in pairs))
        result = farcull.collide(V, F, OBJECTS, ignore=np.array(pairs), **ALL)
        assert rows_of(result) == truth
        assert result.report.candidates == record["candidate_pairs"]
        assert len(truth) < len(whole)
        # Twin: other objects, and none.
        assert rows_of(farcull.collide(V, F, OBJECTS, ignore=[(1, 2)], **ALL)) != truth
        for nothing in (None, [], np.empty((0, 2), int)):
            assert rows_of(farcull.collide(V, F, OBJECTS, ignore=nothing, **ALL)) == whole


def test_runs_of_scenes_answer_the_same(scene):
    V, F, program = scene
    read = farcull.Scene(*program.files, self=True)
    starts = read.object_starts.tolist()
    assert starts == OBJECTS and read.names == ["o0", "o1", "o2", "o3"]
    for method in ("boxes", "exact"):
        record = read.run(method, contacts=True)
        whole, _ = program.rows()
        assert rows_of(record) == whole and record.complete
        for pairs in ([(0, 2), (3, 1)], [("o0", "o2"), ("o3", "o1")]):
            truth, _ = program.rows("--ignore", "o0:o2,o3:o1")
            record = read.run(method, contacts=True, ignore=pairs)
            assert rows_of(record) == truth != whole
            counted = record.accounting
            assert counted["ignored"] == 2 * 40 * 40 and counted["false_negatives"] == 0
            ms, total = counted.pop("ms"), counted.pop("pairs_total")
            assert ms > 0 and sum(counted.values()) == total and len(record.missed()) == 0
        limited = read.run(method, contacts=True, limit=50, verify=False)
        assert rows_of(limited) == whole[:50] and not limited.complete
        assert read.run(method, verify=False).kinds is None
        for partial in (record, limited):
            assert refused(partial.certificate) == "certificate"
