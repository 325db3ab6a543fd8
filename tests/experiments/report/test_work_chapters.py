"""The chapters of scenes, offsets, culling, efficiency and scaling, and the comparison of devices, on rows that were
made up. Most tests have a twin, in which the opposite is said."""
import pytest

from made_up import importlib, chapter_of, findings, row, run_counts, study_of, table
from chapters import devices
from frame import Chapter


@pytest.mark.parametrize("study", ["headline", "offsets", "culling", "efficiency", "scaling", "scenes", "proximity", "libraries",
                                   "model", "accuracy", "error-time", "radius", "precision", "stability", "cloth"])
def test_missing_rows_are_told(study):
    empty = chapter_of(study, [], declared=3)
    assert empty.figures == [] and empty.tables == []
    assert "Not finished: 0 of 3 points are measured." in empty.limits
    left = chapter_of(study, [row("s", "far", left_out="the device is too small")])
    assert "Left out at 1 of 1 points: the device is too small." in left.limits


def offset_rows(exact):
    return [row("s", "far", run_counts(0, True, kept_triangles=40, fragments=400), 2, resolution=64),
            row("s", "far", run_counts(0, True, kept_triangles=exact, fragments=300), 6, resolution=64, offset="exact")]


def test_a_smaller_offset_must_not_keep_more():
    good = chapter_of("offsets", offset_rows(30))
    assert "fewer triangles than boxes at 1 of 1 points" in findings(good) and "BROKEN" not in findings(good)
    assert "FAR (exact) against FAR (OBB)" in findings(good) and "3 times the time" in findings(good)
    assert [panel.y.label for panel in good.figures[0].panels] == list(importlib.import_module("chapters.offsets").MEASURES)
    assert findings(chapter_of("offsets", offset_rows(41))).startswith(
        "BROKEN: s, far, exact, 64 px keeps 41 triangles where boxes keep 40")


def kept(candidates, neighbours=0):
    """Ten pairs collide, two of them neighbours; of the candidates so many are neighbours."""
    both = 2 if neighbours else 0
    return {"colliding": 8 + both, "missed": 0, "candidates": candidates, "neighbour_candidates": neighbours,
            "neighbours": both, "promises": neighbours > 0}


def culling_rows(chosen):
    out = []
    for scene, hard in (("easy", False), ("hard", True)):
        out += [row(scene, "cgal-boxes", kept(8000 if hard else 80)), row(scene, "fcl-obb", kept(80 if hard else 16)),
                row(scene, "boxes", kept((chosen if hard else 79) + 100, 100))]
    return out


def test_culling_tells_a_join_of_boxes_from_culling():
    chapter = chapter_of("culling", culling_rows(800))
    said = findings(chapter)
    for part in ("on easy (79 of 80): there it is a fast join of boxes", "keeps fewer on hard (800 of 8,000)"):
        assert part in said
    assert "BROKEN" not in said
    assert table(chapter, "culling")[1] == ["hard", "8", "8,000", "1,000", "10", "100"]
    join = findings(chapter_of("culling", culling_rows(7990)))
    assert "on easy (79 of 80) and hard (7,990 of 8,000): there it is" in join and "keeps fewer" not in join


def scene_counts(**more):
    return {"triangles": 100, "objects": 2, "self_objects": 0, "colliding": 3, "neighbours": 0, "scene_hash": "ab",
            "pixels_tenth": 1, "pixels_half": 4.0, "pixels_ninety": 9.0, **more}


def test_scenes_tell_the_size_of_triangles_at_each_resolution():
    chapter = chapter_of("scenes", [
        row("two-spheres", "exact", scene_counts(triangles=10240, colliding=300)),
        row("cloth:450:1e4", "exact", scene_counts(triangles=610, self_objects=1, pixels_half=0.5), frame=40)])
    said = findings(chapter)
    assert "2 scenes: 0 of scanned or modelled meshes, 1 of simulated cloth, 0 drawn at random and 1 constr" in said
    assert "610 to 10,240 triangles. In 1 of them objects" in said
    assert "At 512 px the median triangle covers less than a pixel in 1 of 2" in said
    assert table(chapter, "scenes")[0] == ["two-spheres", "constructed", "no", "-", "2", "10,240", "300", "4"]
    assert table(chapter, "scenes")[1][2:4] == ["1 of 2", "40"]


@pytest.mark.parametrize("partial", [True, False])
def test_efficiency_sums_the_frames_that_all_have(partial):
    chapter = chapter_of("efficiency", [
        row("s", method, run_counts(3 if method == "cullide" else 0, queries=10 if method == "cullide" else 5,
                                    draws=100, object_triangles=60), 2.0 + 2 * frame, frame=frame)
        for frame in (0, 1) for method in ("i-collide", "far", "cullide", "quick-cullide")
        if not (partial and frame == 1 and method == "quick-cullide")])
    assert "Quick-CULLIDE asks 0.500 and draws 1 times as often" in findings(chapter)
    assert table(chapter, "efficiency-factors")[0] == ["s", "OBB", "2", "2 (2 to 2)", "1 (1 to 1)", "1 (1 to 1)"]
    assert "leaves 2 (s) to 2 (s) times fewer triangles than the objects" in findings(chapter)
    assert "CULLIDE 6 of 40" in findings(chapter) and "FAR (OBB) 0 of 40" in findings(chapter)


def test_scaling_says_what_is_missed():
    rows = [row("crowd:100", "cullide", run_counts(missed, objects=100), resolution=side)
            for side, missed in ((128, 4), (512, 1))]
    chapter = chapter_of("scaling", rows)
    assert "CULLIDE missed 5 of 40 (12 %, on 1 of 1 scene) colliding pairs over all sizes." in findings(chapter)
    assert "at 128 and 512 px" in chapter.figures[0].caption


def device_study(*rows):
    return study_of("accuracy", [
        row(scene, "far", {"colliding": 9, "missed": missed, "candidates": candidates, "promises": True}, ms,
            resolution=64) for scene, candidates, missed, ms in rows])


def test_devices_are_compared_point_by_point():
    first = device_study(("a", 20, 0, 2), ("b", 30, 0, 2), ("c", 7, 0, 2))
    chapter = Chapter("accuracy", "", "", "")
    devices.fill(chapter, first, "native", [])
    assert chapter.findings == [] and chapter.tables == []
    devices.fill(chapter, first, "native", [("llvmpipe", device_study(("a", 20, 0, 6), ("b", 33, 0, 8)))])
    assert findings(chapter) == "On llvmpipe counts differ from those on native at 1 of 2 points."
    assert table(chapter, "accuracy-devices") == [["llvmpipe", "FAR (OBB)", "2", "1", "0", "0", "50", "53", "3.50"]]
    # A promise that another device does not keep is as bad as one of the first.
    devices.fill(chapter, first, "native", [("liar", device_study(("a", 20, 1, 2)))])
    assert "BROKEN: On liar, FAR (OBB) did not keep its promise at a, far" in findings(chapter)
