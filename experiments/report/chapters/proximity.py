"""Sizes of potential neighbour sets, what a grid loses of them, both over frames, time against the
number of objects, and errors of distances.

A row is either of the sets that a method leaves, or of the distances that a contestant answers. At
rest (frame -1) the sets of a scene differ by seed and resolution, in motion by frame.
"""
from frame import *  # noqa: F403: a chapter uses most of it

BOXES, TREES = "boxes of objects", "trees of boxes"
PUBLISHED, RELIABLE = "Voronoi (published)", "Voronoi (reliable)"
NARROW = "Voronoi (not widened)"
NAMES = {"boxes": BOXES, "trees": TREES, "voronoi": PUBLISHED, "voronoi-reliable": RELIABLE,
         "voronoi-reliable --widening 0": NARROW}
CELLS = "cells along the scene"


def with_names(rows):
    """The rows with the columns name (of the method), base (the scene without its seed), sets
    (else distances), and counts (whether the row is of the plot over the number of objects)."""
    return rows.assign(
        name=[NAMES.get(method, method.split(" ")[0]) for method in rows.method],
        base=[scene_base(scene) for scene in rows.scene],
        sets=~rows.method.str.contains(" (?:nearest|objects)$"),
        counts=(rows.frame < 0) & rows.scene.str.fullmatch("crowd:[0-9]*"))


def scene_sums(rows, at):
    """Sums over the seeds of a scene: triples of a scene, its number of seeds and a frame, by name
    and `at` (resolution or frame), of the objects that have a nearest neighbour, those that lose
    all of theirs (missed), and the objects and triangles in the sets."""
    rows = rows.assign(objects=column(rows, "with_nearest"), **{
        name: column(rows, name) for name in ("missed", "set_objects", "set_triangles")})
    out = []
    for base, of in by(rows, "base"):
        sums = of.groupby(["name", at])[["objects", "missed", "set_objects", "set_triangles"]].sum()
        for what in ("objects", "triangles"):
            sums[what + "_each"] = (sums["set_" + what] / sums.objects).fillna(0)
        out.append((base, of.scene.nunique(), sums))
    return out


def track(sums, name):
    """The rows of one method, by resolution or frame."""
    return sums.loc[name] if name in sums.index.get_level_values(0) else sums.iloc[:0]


def value_at(sums, name, at, what):
    return sums.at[(name, at), what] if (name, at) in sums.index else NONE


def times_fewer(sums, name, at, at_boxes):
    """How many times more triangles the boxes leave than the method; NaN where one is not there."""
    kept = value_at(sums, name, at, "set_triangles")
    return value_at(sums, BOXES, at_boxes, "set_triangles") / kept if kept else NONE


def objects_text(scenes):
    """How many objects each panel rests on."""
    return "n: " + listed(
        f"{base} ({counted(sums.objects.max(), 'object', 'objects')}"
        f"{f', {seeds} seeds' if seeds > 1 else ''})" for base, seeds, sums in scenes)


# ---- promises

def broken_text(row):
    """How a row that promises did not keep it; "": it did."""
    if not row.sets:
        wrong = of_all(number(row, "wrong"), number(row, "asked"))
        return f"{wrong} distances are not the nearest double" if number(row, "wrong") else ""
    missed, pairs = number(row, "missed"), number(row, "missed_pairs")
    return "" if missed == 0 and pairs == 0 else (
        f"{of_all(missed, number(row, 'with_nearest'))} objects lose their nearest neighbour, and "
        f"{of_all(pairs, number(row, 'nearest_pairs'))} nearest pairs of triangles")


def add_kept_promises(chapter, rows):
    rows = promising(rows)
    known = column(rows, "missed").where(rows.sets, column(rows, "wrong")).notna()
    silent, broken = int((~known).sum()), False
    for row in rows[known].itertuples():
        if said := broken_text(row):
            broken = True
            chapter.find_broken(f"{describe(row)}: {said}, which it promises not to do.")
    if silent:
        chapter.find(f"{'One row' if silent == 1 else grouped(silent) + ' rows'} of methods that "
                     f"promise {'does' if silent == 1 else 'do'} not say what they lost.")
    sets, distances = rows[known & rows.sets], rows[known & ~rows.sets]
    if len(sets) and not broken:
        chapter.find(
            f"{listed(sorted(set(sets.name)))} lost {rate_text(0, total(sets, 'with_nearest'))} "
            f"nearest neighbours of objects, and {rate_text(0, total(sets, 'nearest_pairs'))} "
            f"nearest pairs of triangles, in {counted(len(sets), 'run', 'runs')}. An object counts "
            "once in each run; the bounds take all of them as independent.")
    if len(distances) and not broken:
        chapter.find(f"Of the distances of farcull {rate_text(0, total(distances, 'asked'))} were "
                     "not the nearest double.")


# ---- what is lost

def lost_series(sums, name):
    of = track(sums, name)
    of = of[of.objects > 0]
    rates = [rate_of(int(min(row.missed, row.objects)), int(row.objects))
             for row in of.itertuples()]
    return Series(name, list(of.index), [100 * r.value for r in rates], emphasis=name == RELIABLE,
                  y_low=[100 * r.low for r in rates], y_high=[100 * r.high for r in rates])


def lost_figure(scenes):
    scenes = [scene for scene in scenes if scene[2].missed.sum() > 0]
    out = Figure(
        "proximity-lost", "Objects that lose their nearest neighbour, against the resolution",
        "An object is lost if none of its nearest neighbours is in its set. Bars are 95 % "
        "intervals of the share, were the objects independent. clusters:R has clusters whose sides "
        "are 1/R of that of the scene. Not widened: the reliable form without the half diagonal of "
        "a cell that its proof asks for. Scenes of which nothing is lost are in the table. "
        f"{objects_text(scenes)}.")
    for base, _, sums in scenes:
        series = [lost_series(sums, name) for name in (PUBLISHED, RELIABLE, NARROW)]
        panel = Panel(base, log(CELLS), Axis("lost (% of objects)", low=0),
                      [one for one in series if one.x])
        out.panels += [panel] * bool(panel.series)
    return out


def grid_sizes(scenes):
    """Every number of cells along the scene, ascending."""
    return sorted({at for *_, sums in scenes for _, at in sums.index if at > 0})


def lost_table(scenes):
    sizes = grid_sizes(scenes)
    out = Table(
        "proximity-lost",
        "Objects that lose their nearest neighbour, at each resolution in cells along the scene; "
        '"-" where the diagram was left out or not asked for',
        columns(["scene", "method"], ["objects"] + [str(cells) for cells in sizes]))
    for base, _, sums in scenes:
        for name in (PUBLISHED, RELIABLE, NARROW):
            if len(of := track(sums, name)):
                missed = of.missed.reindex(sizes)
                out.rows.append([base, name, grouped(of.objects.iloc[0])] +
                                ["-" if count != count else grouped(count) for count in missed])
    return out


def add_lost(chapter, scenes):
    if not scenes:
        return
    everything = pd.concat([sums for *_, sums in scenes]).groupby(level=[0, 1]).sum()
    for name in (PUBLISHED, NARROW):
        of = track(everything, name)
        parts = [f"{of_all(row.missed, row.objects)} at {row.Index} cells"
                 for row in of[of.objects > 0].itertuples()]
        if parts:
            chapter.find(f"{name}, lost of all objects: {listed(parts)}.")


# ---- sizes

def size_figure(scenes, name, title, axis, what):
    out = Figure(
        name, title,
        "Mean over the objects that have a nearest neighbour. The published form and boxes take "
        "objects with all their triangles, or all those near enough; trees and the reliable form "
        "take triangles. The published form may be below what holds all nearest neighbours. "
        f"{objects_text(scenes)}.")
    for base, _, sums in scenes:
        panel = Panel(base, log(CELLS), log(axis, zero=True))
        for method in (PUBLISHED, RELIABLE):
            if len(of := track(sums, method)):
                panel.series.append(Series(method, list(of.index), list(of[what]),
                                           emphasis=method == RELIABLE))
        if not panel.series:
            continue
        for method in (BOXES, TREES):  # without cells: the same at each resolution
            level = value_at(sums, method, 0, what)
            x = panel.series[0].x
            if level == level:
                panel.series.append(Series(method, x, [level] * len(x), "lines"))
        out.panels.append(panel)
    return out


def median_text(values):
    values = tuple(values)
    return estimate_text(median_estimate(values)) if values else "-"


def efficiency_table(rest, moving):
    finest = max(grid_sizes(rest), default=0)
    out = Table(
        "proximity-efficiency",
        "Culling efficiency: how many times more triangles the boxes of objects leave in the sets. "
        f"Of scenes at rest the diagrams have {finest} cells along the scene; of scenes that move, "
        "the median over the frames with the 95 % interval that it would have were the frames "
        "independent",
        columns(["scene"], ["frames", "triangles per object, boxes", TREES, RELIABLE, PUBLISHED]))
    for base, _, sums in rest:
        out.rows.append([base, "-", rounded(value_at(sums, BOXES, 0, "triangles_each"))] + [
            rounded(times_fewer(sums, name, at, 0))
            for name, at in ((TREES, 0), (RELIABLE, finest), (PUBLISHED, finest))])
    for base, _, sums in moving:
        frames = sorted(set(sums.index.get_level_values(1)))
        factors = {name: [times_fewer(sums, name, frame, frame) for frame in frames]
                   for name in (TREES, RELIABLE, PUBLISHED)}
        out.rows.append(
            [base, grouped(len(frames)), median_text(track(sums, BOXES).triangles_each)] +
            [median_text(x for x in of if x > 0) for of in factors.values()])
    return out


def add_size(chapter, rest):
    factors = sorted((factor, base) for base, _, sums in rest
                     if (factor := times_fewer(sums, TREES, 0, 0)) > 0)
    if factors:
        (least, where_least), (most, where_most) = factors[0], factors[-1]
        chapter.find(f"Boxes of objects leave {rounded(least)} ({where_least}) to {rounded(most)} "
                     f"({where_most}) times more triangles per object than trees of boxes do.")


def frames_figure(scenes):
    out = Figure(
        "proximity-frames", "Triangles per set, frame by frame",
        "Mean over the objects that have a nearest neighbour in that frame; each frame is searched "
        f"anew. {objects_text(scenes)}.")
    for base, _, sums in scenes:
        lines = [(name, track(sums, name)) for name in (BOXES, PUBLISHED, RELIABLE, TREES)]
        out.panels.append(Panel(base, Axis("frame"), log("triangles per object", zero=True), [
            Series(name, list(of.index), list(of.triangles_each), emphasis=name == RELIABLE)
            for name, of in lines if len(of)]))
    return out


# ---- times

def count_figure(chapter, rows, exponents):
    drawn = []
    out = Figure("proximity-objects", "Time against the number of objects")
    for sets, title, what in ((True, "sets: crowd:N", "sets"),
                              (False, "distances to the nearest: crowd:N", "distances")):
        panel, said = Panel(title, log("objects", zero=True), log("time (ms)")), []
        for name, of in by(rows[rows.counts & (rows.sets == sets)], "name"):
            of = of.assign(objects=column(of, "objects")).sort_values("objects", kind="stable")
            series = times_of(name, of, "objects", emphasis=name in (TREES, "farcull"))
            panel.series.append(series)
            drawn.append(of)
            if e := exponent_of(series.x, series.y):
                exponents.rows.append([what, name, rounded(e.first), rounded(e.last),
                                       grouped(e.points), exponent_text(e)])
                said.append(f"{name} {exponent_text(e)}")
        if said:
            chapter.find(f"Exponent of time over objects, of {what}, with its 95 % interval: "
                         f"{listed(said)}.")
        out.panels += [panel] * bool(panel.series)
    if drawn:
        out.caption = (f"{sample_text(pd.concat(drawn))}, on one thread, with its 95 % interval as "
                       "a bar. Objects stand at the same density. Distances are from the triangles "
                       "to the distance of each object from its nearest one, trees included.")
    return out


# ---- distances

def error_figure(rows):
    drawn = rows.drop_duplicates(["scene", "contestant"])
    out = Figure(
        "proximity-error", "Errors of distances against time",
        "The largest error of a distance over the exact distance, of those where neither is 0; "
        f"those that are wrong in another way are in the table. {sample_text(drawn)} on one "
        "thread, from the triangles to the distances, with its 95 % interval as a bar.")
    for scene, of in by(drawn, "scene"):
        panel = Panel(scene, log("time (ms)"), log("largest relative error", zero=True))
        for row in of.itertuples():
            series = times_of(row.name, of[of.position == row.position], "largest_relative")
            panel.series.append(Series(row.name, series.y, series.x, "points",
                                       row.name == "farcull", series.y_low, series.y_high))
        out.panels.append(panel)
    return out


def distance_table(rows):
    rows = rows.assign(library=[text(row, "library") for row in rows.itertuples()])
    out = table_of_rows(
        "proximity-distances",
        "Distances asked for, those that are not the nearest double, and of these: lacking, 0 "
        "where objects are apart or the reverse, of another object that is not as near; the "
        "largest relative error of the others; time in ms as the median with its 95 % interval",
        pd.concat([of for _, of in by(rows, "scene")]) if len(rows) else rows,
        {"scene": "=scene", "contestant": "=name", "asked": "asked", "off": "wrong",
         "lacking": "lacking", "other 0": "other_zero", "other object": "other_object",
         "largest error": lambda row: rounded(value(row, "largest_relative"), 2),
         "time (ms)": estimate_cell, "library": "=library"})
    out.in_text = True
    return out


def add_distances(chapter, rows):
    rows = rows.drop(index=promising(rows).index)
    for name, of in rows.groupby("name"):
        largest = column(of, "largest_relative").fillna(0)
        chapter.find(f"{name}: {of_rows(of, 'wrong', 'asked')} distances are not the nearest "
                     f"double; the largest relative error is {rounded(largest.max(), 2)} "
                     f"({of.scene[largest.idxmax()]}).")


def sets_table(rows):
    return table_of_rows(
        "proximity-sets",
        "Every row of sets: sizes over the objects that have a nearest neighbour, and times on one "
        "thread", rows,
        {"scene": "=scene", "method": "=name", "cells": resolution_cell("-"),
         "frame": lambda row: "-" if row.frame < 0 else str(row.frame), "objects": "with_nearest",
         "lost": "missed", "nearest pairs": "nearest_pairs", "pairs lost": "missed_pairs",
         "pairs of objects": "object_pairs", "pairs of triangles": "triangle_pairs",
         "objects, median": "median_objects", "objects, most": "most_objects",
         "triangles, median": "median_triangles", "triangles, most": "most_triangles",
         "time (ms)": estimate_cell})


def fill(chapter, study):
    rows = with_names(study.rows)
    sets, distances = rows[rows.sets], rows[~rows.sets]
    rest = scene_sums(sets[(sets.frame < 0) & ~sets.counts], "resolution")
    moving = scene_sums(sets[sets.frame >= 0], "frame")
    apart = distances[~distances.counts]
    add_kept_promises(chapter, rows)
    add_lost(chapter, rest)
    add_size(chapter, rest)
    add_distances(chapter, distances)
    chapter.limits = [
        "The code of the published diagram is not known: its form here is the one that "
        "docs/voronoi.md defines. It runs on one thread of the CPU, so that its times say nothing "
        "about graphics hardware.",
        "Objects of one scene are not independent, so that intervals of shares are the best that "
        "so many objects allow.",
        "Boxes of objects are those along the axes; other hulls would leave fewer triangles.",
        "Most of the time of a library is that of building its trees, which a program that asks "
        "again would build once."]
    if (apart.name == "embree-points").any():
        chapter.limits.append(
            "Embree has no query for the distance of two meshes. embree-points asks it from every "
            "vertex of each object for the nearest point of the other one. That bounds the "
            "distance from above, but for the rounding to floats: it is too large where the "
            "nearest points lie inside two edges, and above 0 where objects cross. So its time is "
            "no time of the same question.")
    add_gaps(chapter, study)
    exponents = Table(
        "proximity-exponents",
        "Exponent b of time = a x^b over the number of objects x, by least squares in logarithms, "
        "with its 95 % interval (Student's t of the residuals; not given for fewer than "
        f"{FEWEST_FOR_INTERVAL} points)",
        columns(["of", "method"], ["from", "to", "points", "exponent"]))
    figures = [
        lost_figure(rest),
        size_figure(rest, "proximity-triangles", "Triangles per set against the resolution",
                    "triangles per object", "triangles_each"),
        size_figure(rest, "proximity-set-objects", "Objects per set against the resolution",
                    "objects per object", "objects_each"),
        frames_figure(moving), count_figure(chapter, rows, exponents), error_figure(apart)]
    tables = [lost_table(rest), efficiency_table(rest, moving), exponents, distance_table(apart),
              sets_table(sets)]
    chapter.figures = [figure for figure in figures if figure.panels]
    chapter.tables = [table for table in tables if table.rows]
