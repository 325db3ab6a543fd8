"""The chapters of accuracy, errors against time, the radius, precision, extreme scenes and the cloth, of rows that were
made up: what is missed is told, and a promise that was not kept comes first."""
import pytest

from made_up import chapter_of, figure, findings, row, run_counts as counts, table


def far(scene="s", missed=0, promises=True, ms=2.0, more=(), **axes):
    return row(scene, "far", counts(missed, promises, **dict(more)), ms, depth_mode="fragment",
               **{"resolution": 64, **axes})


def lemma(no_sample=0, not_bounding=0, radius="budget", mode="fragment", px=0.0, at=0.71, method="lemma",
          generator="needles", more=(), **axes):
    return row(f"lemma:{generator}:100:256", method, {
        "points": 100, "violations": no_sample + not_bounding, "no_sample": no_sample, "not_bounding": not_bounding,
        "rounded": 0, "largest_px": px, "largest_steps": px * 1000, "step_px": 0.001, "radius_px": at,
        "budget_px": 0.71, **dict(more)}, offset="obb", radius=radius, depth_mode=mode, seed=1, **axes)


def series(chapter, figure_name, name, panel=0):
    found = figure(chapter, figure_name)
    return next((s for s in found.panels[panel].series + found.panels[panel].strip if s.name == name), None)


PROMISING = {"accuracy": far(), "error-time": far(), "radius": far("degenerate"), "precision": lemma(
    more={"promises": True}, depth_format="float32", resolution=508), "stability": far("contacts:slivers:24:1e2"),
    "cloth": row("cloth:200:1e2", "boxes", counts(0, True, total=1.0, slack=0.0, converged=True, iterations=3),
                 frame=0)}


@pytest.mark.parametrize("study", PROMISING)
@pytest.mark.parametrize("failed", [0, 1, None])
def test_promises_come_first(study, failed):
    point, known, times, _ = PROMISING[study]
    of_points = point["method"] == "lemma"
    broken = {"violations" if of_points else "missed": failed, "no_sample" if of_points else "_": failed}
    chapter = chapter_of(study, [(point, {k: v for k, v in {**known, **broken}.items() if v is not None}, times, "")])
    said = findings(chapter)
    # Without a bound: neither pairs of a scene nor points of a triangle are independent.
    kept = ("violated at 0 of 100 points in 1 run; a smaller radius was not tried." if of_points
            else "missed 0 of 20 colliding pairs in 1 run on 1 scene in which views decided; how many pairs were at risk "
            "was not counted.")
    assert said.startswith("BROKEN:") == (failed == 1) and said.count("BROKEN") == (failed == 1), "a row is said once"
    assert (kept in said) == (failed == 0)
    assert ("One row of methods that promise does not say" in said) == (failed is None)


# A sentence about misses says what decided, and how many pairs could have been missed.
def said_of_misses(far_more=(), *others):
    return findings(chapter_of("accuracy", [
        far(more=far_more), row("s", "boxes", counts(0, True, views_used=0)), *others]))


def test_what_decided_stands_beside_what_was_not_missed():
    said = said_of_misses({"at_risk": 4, "at_risk_bare": 9})
    assert ("missed 0 of 20 colliding pairs in 1 run on 1 scene in which views decided; at risk there: 4 "
            "pairs with 0.9 of the radius and 9 pairs without a ball.") in said
    # The twins: a join of boxes tests no radius, and says so; and nothing at risk is said.
    assert ("Boxes missed 0 of 20 colliding pairs in 1 run on 1 scene in which boxes alone decided; no "
            "view was drawn, so these tested no radius, pixel or depth.") in said
    assert "no pair was at risk, so this says nothing about the radius" in said_of_misses(
        {"at_risk": 0, "at_risk_bare": 0})
    assert "at risk there: 7 pairs without a ball." in said_of_misses((), row("s", "cullide", counts(7), resolution=64))
    assert "was not counted" in said_of_misses((), row("s", "cullide", counts(7), resolution=128)), "other pixels"
    assert "test that a ball is needed, not how large it has to be" in said_of_misses({"at_risk": 0, "at_risk_bare": 3})


@pytest.mark.parametrize("far_misses", [0, 1])
def test_accuracy_shows_cullide_falling_and_far_at_zero(far_misses):
    chapter = chapter_of("accuracy", [
        row("s", "cullide --rounds 1", counts(20), resolution=64), far(missed=far_misses),
        row("s", "cullide --rounds 1", counts(3), resolution=4096), far(resolution=4096)])
    said = findings(chapter)
    assert said.startswith("BROKEN: s, far, obb, 64 px misses 1 of 20") == (far_misses == 1)
    assert ("FAR (OBB) missed 0 of 40 colliding pairs in 2 runs on 1 scene in which" in said) == (far_misses == 0)
    assert figure(chapter, "accuracy").panels[0].y.zero
    assert series(chapter, "accuracy", "CULLIDE, one round").y == [20, 3]
    assert series(chapter, "accuracy", "FAR (OBB)").y == [far_misses, 0]


def test_accuracy_says_what_drawing_takes_away_beyond_boxes():
    rows = [row("s", form, counts(n, candidates=left), resolution=64) for form, n, left in (
        ("cullide --rounds 1", 20, 10), ("cullide --rounds 1 --clear all --conservative", 1, 49))]
    far_row = far(more={"candidates": 45})
    boxes = row("s", "exact", counts(0, candidates=50))
    chapter = chapter_of("accuracy", [*rows, far_row, boxes])
    assert table(chapter, "accuracy-forms")[-1] == ["boxes of triangles alone, there", "1", "0 of 20", "0", "50"]
    assert ("Boxes of triangles alone leave 50 candidates there; drawing takes away 2 % of them with CULLIDE, one round, all "
            "views, conservative and 10 % of them with FAR (OBB).") in findings(chapter)
    # The twin: where boxes alone were not measured, nothing is said of them.
    assert "alone" not in findings(chapter_of("accuracy", [*rows, far_row]))


def timed_rows(exact_ms=9, runs=(None, None), left_out=""):
    return [row("s", "fcl-float", counts(2, wrong=3), 1, left_out), row("s", "boxes", counts(0, True), 4,
                                                                        runs=runs[0]),
            row("s", "exact", counts(0), exact_ms, runs=runs[1]), row("s", "cullide", counts(8), 2, resolution=64)]


def test_error_time_has_the_front_of_what_nothing_beats():
    chapter = chapter_of("error-time", timed_rows())
    assert [r[1] for r in table(chapter, "error-time-front")] == ["fcl-float", "Boxes"]
    said = findings(chapter)
    assert "fcl-float misses 2 of 20 colliding pairs and reports 3" in said
    assert "Fastest without an error: Boxes on 1 of 1 scenes." in said
    panel = figure(chapter, "error-time").panels[0]
    assert {s.name: [y for y in s.y if y == y] for s in panel.series} == {
        "FCL and ODE, their own tests": [25], "CULLIDE": [40]}
    assert [s.name for s in panel.strip] == ["Boxes", "exact"], "those that were never wrong"
    # Rows are the same in each panel, empty where the method was wrong; FAR has a row for each resolution.
    rows = [row(scene, method, counts(n), ms, resolution=px) for scene, n in (("s", 0), ("u", 4)) for method, ms, px in (
        ("exact", 8, 0), ("cullide", 2, 64))] + [far(ms=4), far("u", ms=1), far("u", ms=2, resolution=128)]
    panels = figure(chapter_of("error-time", rows), "error-time").panels
    names = ["FAR (OBB), 64 px", "CULLIDE", "exact"]
    assert [[s.name for s in p.strip] for p in panels] == [names] * 3
    assert [len(s.x) for s in panels[1].strip] == [1, 0, 0] and [s.name for s in panels[1].series] == ["exact", "CULLIDE"]
    # The last panel has geometric means: FAR takes 4 of 8 ms, and 1 of 8.
    assert panels[2].title == "all 2 scenes" and panels[2].strip[0].x == [pytest.approx(0.25)]
    # The twin: the front follows the rows, whoever they favour.
    chapter = chapter_of("error-time", timed_rows(0.5))
    assert [r[1] for r in table(chapter, "error-time-front")] == ["exact"]
    chapter = chapter_of("error-time", timed_rows(left_out="built without FCL"))
    assert series(chapter, "error-time", "fcl-float") is None


def test_void_rounds_are_left_out_and_counted():
    def chapter(void):
        rows = timed_rows()
        rows[1] = row("s", "boxes", counts(0, True), 4, runs=(4, 5, 6, 99, 98, 97, 5, 5, 5), void=void)
        return chapter_of("error-time", rows)

    clean, loud = chapter([1]), chapter([])
    said = "1 round of 1 of 1 timed points are void and left out"
    assert any(said in limit for limit in clean.limits) and not any("void" in limit for limit in loud.limits)
    assert [series(of, "error-time", "Boxes").x_high[0] for of in (clean, loud)] == [6, 99]


def headline_rows(lost=0, void=()):
    ways = [row("s", "cullide --rounds 1", counts(8), resolution=64, runs=[2] * 3, void=void),
            row("s", "cullide --rounds 1 --clear all --conservative", counts(1), resolution=64, runs=[3] * 3, void=void),
            far(missed=lost, ms=4), far(ms=6, offset="exact")]
    return ways + [row("s", method, counts(0, True), resolution=0, runs=[ms] * 3) for method, ms in (("boxes", 1), ("exact", 2))]


def test_headline_says_what_was_measured():
    chapter = chapter_of("headline", headline_rows())
    assert len(chapter.findings) == 3 and not any("(" in text for _, text in chapter.findings)
    assert table(chapter, "headline")[0] == ["CULLIDE as published", "8", "2"]
    assert "misses 8 of 20 on s." in findings(chapter) and "`boxes` takes 0.50 on s" in findings(chapter)
    assert "miss none" in findings(chapter) and "measured again" not in chapter.figures[0].caption
    # The twins: FAR loses a pair; and no time of CULLIDE is valid.
    assert "BROKEN" in findings(chapter_of("headline", headline_rows(2))) and "miss 2." in findings(
        chapter_of("headline", headline_rows(2)))
    assert "measured again" in chapter_of("headline", headline_rows(void=(0, 1, 2))).figures[0].caption


def radius_rows(at_budget=0):
    return [lemma(60, radius="0.5", at=0.355), lemma(at_budget), lemma(radius="1.1", at=0.781),
            lemma(25, 3, "published", px=7.5, at=0.7071), lemma(0, 4, mode="fixed", px=2),
            far("degenerate", 7, False, radius="0.5", more={"radius_px": 0.355}), far("degenerate"),
            far("degenerate", 3, False, radius="published", more={"radius_px": 0.7071})]


def test_radius_says_where_the_published_one_fails_and_that_the_budget_does_not():
    chapter = chapter_of("radius", radius_rows())
    said = findings(chapter)
    assert "BROKEN" not in said
    for part in ("At the budget radius and beyond, fragment depth: 0 of 200",
                 "The published radius, 0.9959 of the budget, fragment depth: 28 of 100 points are violated, 25 of them "
                 "without a sample.", "fixed-function depth: 4 of 100 points are violated (it promises nothing)"):
        assert part in said
    panel = figure(chapter, "radius").panels[0]
    assert [m.at for m in panel.marks] == [1] and panel.y.zero
    lines = {s.name: (s.x, s.y) for s in panel.series}
    assert lines["fragment depth"] == ([0.5, 1, 1.1], [60, 0, 0])
    assert lines["fragment depth, published radius"] == ([pytest.approx(0.7071 / 0.71)], [28])
    assert table(chapter, "radius")[0] == ["fixed-function depth", "needles", "100", "-", "4", "-", "-"]
    assert table(chapter, "radius")[1] == ["fragment depth", "needles", "100", "28", "0", "1", "7.50"]
    assert series(chapter, "radius-missed", "degenerate").y == [35, 0]
    holds = chapter_of("radius", [lemma(radius="published", at=0.7071)])
    assert "0 of 100 points are violated" in findings(holds)


@pytest.mark.parametrize("rows, said", [
    (radius_rows(2), "at 1 of the budget radius, fragment depth, 2 of 100 points of the generator \"needles\""),
    ([lemma(1, radius="1.1", at=0.8, method="lemma-worst")], "at 1.1 of the budget radius, worst canvas"),
    ([far("a-b@crossing:1:1000", 1)], "a-b@crossing")])
def test_radius_shouts_a_violation_at_the_budget(rows, said):
    found = findings(chapter_of("radius", rows))
    assert found.startswith("BROKEN: " + said) and "beyond, fragment depth" not in found


def precise(*args, form="float32", **more):
    return lemma(*args, generator="almost flat", depth_format=form, resolution=508, **more)


@pytest.mark.parametrize("at_budget", [0, 3])
def test_precision_tells_rounding_from_violations(at_budget):
    chapter = chapter_of("precision", [
        precise(0, at_budget, px=0.5 if at_budget else 0.0004, more={"rounded": 5}),
        precise(10, 20, "published", "fixed", px=7.25, at=0.7071), precise(mode="fixed", form="fixed24")])
    said = findings(chapter)
    assert said.startswith("BROKEN: fragment depth at the budget radius, 32-bit") == (at_budget > 0)
    cells = {(r[0], r[1]): r[2:] for r in table(chapter, "precision")}
    assert cells["fragment, budget radius", "32-bit float"][:4] == ["100", "0", str(at_budget), "5"]
    assert cells["fixed-function, published radius", "32-bit float"] == ["100", "10", "20", "0", "7,250", "7.25"]
    assert [m.at for p in figure(chapter, "precision").panels for m in p.marks] == [3.5, 1.5]


def cells(value, method="cullide", lost=0, varying=10, family="overlap", **more):
    return row(f"contacts:{family}:24:{value}", method, {
        "colliding": 20, "missed": 10 + lost, "varying": varying, "missed_varying": lost, "promises": False}, **more)


def test_stability_draws_the_share_of_contacts_that_vary_from_the_harmless_value_to_the_extreme():
    strict = "cullide --rounds 1 --clear all --conservative"
    chapter = chapter_of("stability", [cells("1e0"), cells("1e0", strict), cells("1e-2", lost=5), cells("1e-2", strict),
                                       cells("0", lost=10), cells("0", strict, lost=3),
                                       cells("1e0", varying=0, family="gap"), cells("1e0", family="slivers")])
    drawn = figure(chapter, "stability-missed").panels
    assert [p.title for p in drawn] == ["overlaps", "slivers"], "of gaps nothing collides"
    assert (series(chapter, "stability-missed", "CULLIDE").x, series(chapter, "stability-missed", "CULLIDE").y) == (
        [1, 0.01, 0], [0, 50, 100])
    assert [s.labels for s in drawn[0].series] == [["", "CULLIDE", ""], ["", "", "CULLIDE, strict"]]
    assert ("overlaps, overlap (px): contacts that vary are missed by CULLIDE from 0.01 on, up to 100 %; CULLIDE, "
            "strict from 0 on, up to 30 %.") in findings(chapter)
    assert "slivers, aspect" not in findings(chapter), "the twin: none is missed"


def cloth_rows(last, far_colliding=5):
    def frame(scene, method, number, total, **more):
        return row(scene, method, {"colliding": 5, "missed": 0, "candidates": 9, "accounted": 100, "promises": True,
                                   "total": total, "slack": 0.125, "residual": 1e-6, "iterations": 3,
                                   "converged": True, **more}, frame=number)

    out = [frame("cloth:200:1e8", "boxes", 2, **{"total": 0.625, **last})]
    for scene in ("cloth:200:1e2", "cloth:200:1e8"):
        out += [frame(scene, "boxes", 0, 1), frame(scene, "far", 0, 1, colliding=far_colliding),
                frame(scene, "boxes", 1, 0.5)]
    return out


def test_cloth_says_that_the_energy_is_bounded_and_what_is_not_run():
    said = findings(chapter_of("cloth", cloth_rows({}), declared=8))
    for part in ("At 1e2 N/m the total energy never grew by more", "left unbalanced (2 steps)",
                 "the same number of colliding pairs in each of the 2 frames"):
        assert part in said
    assert "BROKEN" not in said and "At 1e8 N/m 3 of 3" not in said


@pytest.mark.parametrize("last, far_colliding, said", [
    ({"total": 0.6259765625}, 5, "At 1e8 N/m the total energy grew by more than the unbalanced forces can do in 1 of 2 "
                                 "steps, by up to 0.000977 J"),  # 2^-10 J more than the slack
    ({"total": None}, 5, "At 1e8 N/m the total energy grew"), ({"missed": 1}, 5, "cloth:200:1e8, boxes"),
    ({"converged": False}, 5, "At 1e8 N/m 1 of 3 steps did not converge"),
    ({}, 4, "FAR and boxes found different")])
def test_cloth_shouts_what_is_not_as_it_has_to_be(last, far_colliding, said):
    assert "BROKEN: " + said in findings(chapter_of("cloth", cloth_rows(last, far_colliding)))
