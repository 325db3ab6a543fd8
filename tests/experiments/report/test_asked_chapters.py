"""The chapters of proximity and libraries on rows that were made up."""
import csv
import importlib
import io
import json

import pytest

from made_up import chapter_of, figure, findings, row, table

libraries_chapter = importlib.import_module("chapters.libraries")


def sets(missed=0, each=4, promises=True, missed_pairs=0, objects=50):
    """Of 50 objects that have a nearest neighbour; `each` triangles in the set of an object."""
    return {"with_nearest": 50, "missed": missed, "nearest_pairs": 60, "missed_pairs": missed_pairs,
            "set_objects": 100, "set_triangles": 50 * each, "objects": objects, "promises": promises}


def asked(wrong, error, promises=False):
    return {"asked": 40, "wrong": wrong, "largest_relative": error, "objects": 50, "promises": promises,
            "library": "made-up 1.0"}


def proximity_rows(missed=0, missed_pairs=0, wrong=0):
    out = []
    for scene in ("clusters:64@seed1", "clusters:64@seed2", "field"):
        out += [row(scene, "boxes", sets(each=40)), row(scene, "trees", sets())]
        for cells in (64, 128):
            lost = 0 if scene == "field" else 640 // cells
            out += [row(scene, "voronoi", sets(lost, 30, False), resolution=cells),
                    row(scene, "voronoi-reliable", sets(missed, 10, True, missed_pairs), resolution=cells)]
    for frame, each in ((0, 2), (1, 4)):
        out += [row("crowd:30", method, sets(each=triangles), frame=frame)
                for method, triangles in (("boxes", 20), ("trees", each))]
    out += [row(f"crowd:{n}", "trees", sets(objects=n), n) for n in (10, 100, 1000)]
    return out + [row("field", "farcull nearest", asked(wrong, 0, True)),
                  row("field", "peer nearest", asked(3, 0.25), 5)]


def test_proximity_says_what_is_lost_and_by_whom():
    chapter = chapter_of("proximity", proximity_rows())
    said = findings(chapter)
    assert "BROKEN" not in said
    for part in ("Voronoi (reliable), boxes of objects and trees of boxes lost 0 of 950 ",
                 "Of the distances of farcull 0 of 40 ",
                 "Voronoi (published), lost of all objects: 20 of 150 at 64 cells and 10 of 150 at 128 cells."):
        assert part in said
    # Seeds of a scene are one panel, with the share of all their objects; of `field` nothing is lost.
    lost = figure(chapter, "proximity-lost")
    assert [panel.title for panel in lost.panels] == ["clusters:64"]
    assert lost.panels[0].series[0].y == [20, 10] and lost.panels[0].series[0].y_low == []
    assert "n: clusters:64 (100 objects, 2 seeds)" in lost.caption
    assert table(chapter, "proximity-lost")[0] == ["clusters:64", "Voronoi (published)", "100", "20", "10"]
    assert len(table(chapter, "proximity-lost")) == 4


@pytest.mark.parametrize("broken, said", [
    ((2, 0, 0), "BROKEN: clusters:64@seed1, voronoi-reliable, 64 cells: 2 of 50 objects lose"),
    ((0, 1, 0), "BROKEN: clusters:64@seed1, voronoi-reliable, 64 cells: 0 of 50 objects lose their nearest neighbour, "
                "and 1 of 60 nearest pairs"),
    ((0, 0, 3), "BROKEN: field, farcull nearest: 3 of 40 distances")])
def test_proximity_begins_with_the_promise_that_was_not_kept(broken, said):
    text = findings(chapter_of("proximity", proximity_rows(*broken)))
    assert text.startswith(said) and " lost 0 of " not in text and "farcull 0 of " not in text


def counts_of(family, kind, card, counts, parameter="0"):
    """Counts of one part."""
    part = [family, parameter, kind, *(counts.get(name, 0) for name in libraries_chapter.SCORE), 0, 1e6, ""]
    return {"promises": False, "library": "x 1", "means": "closed", "scores": json.dumps([part]), **card}


def of_pairs(ours=False, missed=0, card=(), parameter="0", family="pairs/random", **more):
    """Of 1,000 crossing pairs it refuses 500 and answers 500."""
    return counts_of(family, "crossing", {"promises": ours, "library": "farcull" if ours else "x 1", **dict(card)}, {
        "asked": 1000, "answered": 500, "timed": 500, "missed": missed, "own_asked": 500, "own_missed": missed,
        "refused": 0 if ours else 500, **more}, parameter)


def of_mesh(ours=False, **more):
    """Of 100 colliding pairs it misses 10, and it reports 30 that are apart. Its documentation speaks of 50 of the
    colliding pairs, 5 of the missed and 20 of those apart."""
    bad = {"missed": 10, "wrong": 30, "own_missed": 5, "own_wrong": 20}
    return counts_of("meshes/some", "mesh", {"promises": ours, "library": "farcull" if ours else "x 1", "means": "crossing"},
                     {"asked": 100, "answered": 100, "own_asked": 50, **({} if ours else bad), **more})


def libraries(*asked_of):
    """asked_of: pairs of a contestant and its counts."""
    return chapter_of("libraries", [row(f"small/{at}", name, counts, 1.0) for at, (name, counts) in enumerate(asked_of)])


def cells(chapter, name):
    """The cells of the first row of a file by column, the last of equal names."""
    return dict(zip(*list(csv.reader(io.StringIO(chapter.files[f"tables/{name}.csv"])))[:2]))


def test_rates_of_libraries_are_of_what_was_answered():
    chapter = libraries(("theirs", of_pairs(missed=5)))
    assert cells(chapter, "libraries")["missed"] == "10,000"  # 5 of 500, and not of 1,000
    assert cells(chapter, "libraries")["refused"] == "500"
    assert cells(chapter, "libraries-kinds")["crossing"] == "10,000"
    assert cells(chapter, "libraries-kinds")["apart"] == "-"
    assert "BROKEN" not in findings(chapter)
    assert "1 of 1 libraries and tests gave wrong answers where their documentation promises the answer: " \
        "theirs (5 of 500)." in findings(chapter)
    with pytest.raises(ValueError, match="is no score"):
        libraries(("theirs", {"scores": '[["pairs/random", 0, "crossing", 1]]'}))


@pytest.mark.parametrize("more, broken", [
    ({}, False), ({"missed": 1}, True), ({"refused": 1}, True), ({"unanswered": 1}, True), ({"crashed": 1}, True),
    ({"hung": 1}, True), ({"no_memory": 1}, True)])
def test_a_miss_or_a_silence_of_ours_is_broken(more, broken):
    said = findings(libraries(("far", of_pairs(True, **more))))
    assert said.startswith("BROKEN: far") == broken
    assert ("far missed none and reported none wrongly of 500 pairs." in said) == (not broken)


def test_false_alarms_of_meshes_are_a_part_of_what_was_reported():
    chapter = libraries(("theirs", of_mesh()))
    assert {name: cells(chapter, "libraries-meshes")[name] for name in (
        "colliding", "reported", "missed", "false", "missed, own", "false, own")} == {
            "colliding": "100", "reported": "120",       # 100 - 10 + 30
            "missed": "100,000", "false": "250,000",     # 30 of 120, and not of 100
            "missed, own": "100,000", "false, own": "307,692"}  # 5 of 50, 20 of 65
    # 5 missed and 20 false, of 50 that collide and 20 that do not.
    assert "theirs (25 of 70)" in findings(chapter)
    assert "theirs (1,005 of 1,050)" in findings(libraries(("theirs", of_mesh(own_wrong=1000))))
    # Without one colliding pair of which it promises the answer, it may still err.
    assert "theirs (20 of 20)" in findings(libraries(("theirs", of_mesh(own_asked=0, own_missed=0))))


def test_pairs_and_pairs_of_meshes_are_not_added():
    ours = [("far", of_pairs(True)), ("far", of_mesh(True)), ("far", of_mesh(True))]
    said = findings(libraries(*ours))
    assert "far missed none and reported none wrongly of 500 pairs and of the 200 colliding pairs of 2 meshes." in said
    assert "700" not in said
    broken = findings(libraries(*ours, ("far", of_mesh(True, missed=3, wrong=4))))
    assert "BROKEN: far: 3 of the 300 colliding pairs of 3 meshes missed, and it promises none." in broken
    assert "BROKEN: far: 4 of the 301 pairs reported of 3 meshes are apart" in broken and "missed none" not in broken


def test_contestants_are_sorted_into_those_that_err_or_do_not():
    said = findings(libraries(
        ("good", of_pairs()), ("bad", of_pairs(missed=5)), ("worse", of_pairs(missed=9, differing=3, twice=34)),
        ("dead", of_pairs(crashed=1, hung=1)), ("cullide", of_pairs(card={"library": "farcull"}, missed=7))))
    for part in ("no answer was wrong of good and dead.",
                 "2 of 4 libraries and tests gave wrong", "most often worse (9 of 500), least often bad (5 of 500);"):
        assert part in said
    assert "more than one version" not in said
    assert "The rows of theirs are of more than one version: x 1 and x 2." in findings(
        libraries(("theirs", of_pairs()), ("theirs", of_pairs(card={"library": "x 2"}))))


def test_the_table_says_whom_to_trust_for_what():
    chapter = chapter_of("libraries", [
        row("small/pair", "theirs", of_pairs(missed=5), 1.0), row("small/pair", "boxes", of_pairs(True), 1.0),
        row("small/distance", "theirs", counts_of("distance/random", "distance", {}, {
            "asked": 9, "answered": 7, "wrong": 2, "refused": 2, "zero": 2}), 1.0)])
    found = next(table for table in chapter.tables if table.name == "libraries-trust")
    assert [name for name, _ in found.columns] == ["contestant", "library", "pairs", "distance", "ns a pair"]
    assert [line[:4] for line in found.rows] == [["boxes", "farcull", "0 of 500", ""],
                                                 ["theirs", "x 1", "5 of 500 + 500 none", "2 of 7 + 2 none"]]
    assert cells(chapter, "libraries-distances")["zero"] == "2"


def test_a_wrong_distance_of_ours_is_broken():
    wrong = counts_of("distance/random", "distance", {"promises": True, "library": "farcull"}, {"asked": 9, "answered": 9, "wrong": 1})
    said = findings(libraries(("exact", wrong)))
    assert said.startswith("BROKEN: exact: 1 of 9 other questions answered wrongly")


def test_libraries_are_rows_from_the_best_to_the_worst():
    """Ours are marked, and wrong answers count only where the documentation promises the answer."""
    chapter = libraries(("boxes", of_pairs(True)), ("a", of_pairs(missed=3, card={"library": "FCL 1"})),
                        ("b", of_pairs(missed=400, own_missed=2, card={"library": "CGAL 1"})))
    rows = [[(s.name, s.x[0]) for s in panel.strip] for panel in figure(chapter, "libraries-time").panels]
    assert rows[0] == [("boxes (ours)", 0), ("b", 4000), ("a", 6000)]
    assert [name for name, _ in rows[2]] == ["boxes (ours)", "b", "a"]
