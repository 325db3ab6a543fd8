"""Frame by frame: the triangles that FAR and I-COLLIDE leave to exact tests, and the work of
Quick-CULLIDE beside that of CULLIDE."""
from frame import *  # noqa: F403: a chapter uses most of it

OBB, EXACT, PAIRS = "FAR (OBB)", "FAR (exact)", "FAR pairs"
BOXES, PLAIN, QUICK = "I-COLLIDE", "CULLIDE", "Quick-CULLIDE"
METHODS = [OBB, EXACT, PLAIN, QUICK, PAIRS, BOXES]


def over_frames(rows, name):
    """A count or time of one scene: a line for each frame, a column for each method."""
    rows = rows.assign(of=column(rows, name))
    return rows.pivot_table(index="frame", columns="contestant", values="of", aggfunc="last",
                            dropna=False).reindex(columns=METHODS).sort_index()


def factors(rows, method, name, what="kept_triangles"):
    """For each frame in which the method keeps something, count `name` of I-COLLIDE over count
    `what` of the method; a tuple."""
    boxes, kept = over_frames(rows, name)[BOXES], over_frames(rows, what)[method]
    return tuple((boxes / kept)[kept > 0].dropna())


def common_frames(rows, methods):
    """The frames of which each of these methods has a row; those without any row do not count."""
    there = rows[rows.contestant.isin(methods)]
    lists = [set(of.frame) for _, of in there.groupby("contestant")]
    return set(rows.frame).intersection(*lists)


def line(name, values, **look):
    return Series(name, list(values.index), list(values), **look)


def frames_text(scenes):
    counts = sorted({of.frame.nunique() for _, of in scenes})
    least = "" if len(counts) == 1 else f"{counts[0]} to "
    return f"n = {least}{counted(counts[-1], 'frame', 'frames')} of each scene, each run once"


def frames_axis(scenes):
    return Axis("frame", low=0, high=max(1, *(int(of.frame.max()) for _, of in scenes)))


def kept_figure(scenes):
    out = Figure(
        "efficiency", "Triangles that are left to exact tests, frame by frame",
        "I-COLLIDE as published ends with the objects whose boxes meet (all their triangles), ours "
        "goes on to boxes of triangles. FAR is drawn with both offsets. No method can leave fewer "
        f"than the triangles that collide. {frames_text(scenes)}.")
    for scene, of in scenes:
        kept = over_frames(of, "kept_triangles")
        series = [line("I-COLLIDE, objects", over_frames(of, "object_triangles")[BOXES]),
                  line("I-COLLIDE, triangles", kept[BOXES])]
        series += [line(method, kept[method], emphasis=method != PAIRS)
                   for method in (OBB, EXACT, PAIRS) if method in set(of.contestant)]
        series.append(line("colliding triangles", over_frames(of, "colliding_triangles")[BOXES],
                           style="lines"))
        out.panels.append(Panel(scene, frames_axis(scenes), log("triangles", zero=True), series))
    return out


def quick_figure(scenes):
    out = Figure(
        "efficiency-quick",
        "What Quick-CULLIDE asks and draws over what CULLIDE does, frame by frame",
        "Each runs until a round changes nothing. Below 1 Quick-CULLIDE does less. Both miss "
        f"pairs, so they do not have the same answer. {frames_text(scenes)}.")
    for what in ("queries", "draws"):
        panel = Panel(what, frames_axis(scenes), Axis("Quick-CULLIDE / CULLIDE", low=0),
                      marks=[Mark(1, "as many", vertical=False)])
        for scene, of in scenes:
            if QUICK in set(of.contestant):
                work = over_frames(of, what)
                panel.series.append(line(scene, (work[QUICK] / work[PLAIN]).where(work[PLAIN] > 0)))
        out.panels.append(panel)
    return out


def median_text(values):
    values = tuple(values)
    return estimate_text(median_estimate(values)) if values else "-"


def factor_table(scenes):
    return Table(
        "efficiency-factors",
        "How many times more I-COLLIDE leaves than FAR: triangles of the objects whose boxes meet, "
        "triangles whose boxes meet, and pairs of them; median of the frames in which FAR keeps "
        "something, with the 95 % interval that it would have were the frames independent",
        columns(["scene", "offset"], ["frames", "objects", "triangles", "pairs"]),
        [[scene, offset, grouped(len(factors(of, method, "object_triangles"))),
          median_text(factors(of, method, "object_triangles")),
          median_text(factors(of, method, "kept_triangles")),
          median_text(factors(of, method, "candidates", "candidates"))]
         for scene, of in scenes for method, offset in ((OBB, "OBB"), (EXACT, "exact"))
         if method in set(of.contestant)])


def quick_table(scenes):
    out = Table(
        "efficiency-quick",
        "Quick-CULLIDE against CULLIDE, summed over the frames that all of them have: queries and "
        "draws as a part of CULLIDE's, and the colliding pairs that each misses; a pair counts "
        "once in each frame",
        columns(["scene"], ["frames", "queries", "draws", "colliding", "CULLIDE misses",
                            "Quick-CULLIDE misses", "FAR misses"]))
    for scene, of in scenes:
        if QUICK not in set(of.contestant):
            continue
        over = common_frames(of, [QUICK, PLAIN, BOXES, OBB, EXACT])
        sums = {name: over_frames(of[of.frame.isin(over)], name).sum(min_count=1)
                for name in ("queries", "draws", "colliding", "missed")}
        counts = [sums["colliding"][BOXES], sums["missed"][PLAIN], sums["missed"][QUICK],
                  sums["missed"][[OBB, EXACT]].sum(min_count=1)]
        out.rows.append(
            [scene, grouped(len(over))] +
            [rounded(sums[what][QUICK] / sums[what][PLAIN]) for what in ("queries", "draws")] +
            ["-" if count != count else grouped(count) for count in counts])
    return out


def time_table(scenes):
    out = Table(
        "efficiency-times",
        "Time in ms from moved vertices to exact pairs: median of the frames that all methods of "
        "the scene have, with the 95 % interval that it would have were the frames independent, "
        "each run once", columns(["scene"], ["triangles", "frames"] + METHODS))
    for scene, of in scenes:
        over = common_frames(of, METHODS)
        triangles = over_frames(of, "triangles")[BOXES].iloc[0]
        times = over_frames(of, "total_ms")
        times = times[times.index.isin(over)]
        out.rows.append([scene, "-" if triangles != triangles else grouped(triangles),
                         grouped(len(over))] +
                        [median_text(times[method].dropna()) for method in METHODS])
    return out


def add_factors(chapter, scenes):
    for method, offset in ((OBB, "boxes"), (EXACT, "exact offsets")):
        objects, triangles = (
            sorted((median(values), scene) for scene, of in scenes
                   if (values := factors(of, method, name)))
            for name in ("object_triangles", "kept_triangles"))
        if not objects or not triangles:
            continue
        (least, at_least), (most, at_most_) = objects[0], objects[-1]
        (low, at_low), (high, at_high) = triangles[0], triangles[-1]
        chapter.find(
            f"FAR with {offset} leaves {rounded(least)} ({at_least}) to {rounded(most)} "
            f"({at_most_}) times fewer triangles than the objects of I-COLLIDE have, by medians "
            f"over the frames; against boxes of triangles the factor is {rounded(low)} ({at_low}) "
            f"to {rounded(high)} ({at_high}), above 1 in {sum(f > 1 for f, _ in triangles)} of "
            f"{len(triangles)} scenes.")


def add_missed(chapter, rows):
    known = rows[column(rows, "missed").notna() & column(rows, "colliding").notna()]
    parts = [f"{method} {with_bound(total(of, 'missed'), total(of, 'colliding'))}"
             for method in (OBB, EXACT, PAIRS, BOXES, PLAIN, QUICK)
             if len(of := known[known.contestant == method])]
    if parts:
        chapter.find("Colliding pairs missed, over all frames (a pair counts once in each frame; "
                     "the bounds are 3/N, at 95 % were all N independent): "
                     f"{listed(parts)}.")


def add_quick(chapter, scenes):
    work = [pd.concat([over_frames(of, what)[method].rename(what + method)
                       for what in ("queries", "draws") for method in (QUICK, PLAIN)],
                      axis=1).dropna() for _, of in scenes]
    sums = pd.concat(work).sum() if work else pd.Series(dtype=float)
    if sums.get("queries" + PLAIN, 0) > 0 and sums["draws" + PLAIN] > 0:
        asks, draws = (rounded(sums[what + QUICK] / sums[what + PLAIN])
                       for what in ("queries", "draws"))
        chapter.find(f"Over all frames Quick-CULLIDE asks {asks} and draws {draws} times as often "
                     "as CULLIDE.")


def fill(chapter, study):
    scenes = by(study.rows, "scene")
    add_promises(chapter, study)
    add_factors(chapter, scenes)
    add_missed(chapter, study.rows)
    add_quick(chapter, scenes)
    chapter.limits = [
        "Scenes are far smaller than in the papers, so that a software device can draw them; "
        "`farcull experiment family` takes any size.",
        "Factors depend on resolution: at a lower one FAR fattens more and keeps more.",
        "FAR and CULLIDE are measured between objects; scenes with objects that are tested "
        "against themselves are measured by I-COLLIDE and FAR pairs alone.",
        "Boxes of triangles are our addition to I-COLLIDE; as published it ends with objects.",
        "On a software device the times of methods that draw say nothing about graphics hardware; "
        "queries and draws carry over."]
    add_gaps(chapter, study)
    if scenes:
        chapter.figures = [kept_figure(scenes), quick_figure(scenes)]
        chapter.tables = [factor_table(scenes), quick_table(scenes), time_table(scenes)]
