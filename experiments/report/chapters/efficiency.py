"""Compares, frame by frame, how many triangles FAR and I-COLLIDE leave to exact tests. Also compares the work of
Quick-CULLIDE with the work of CULLIDE."""
from frame import *  # noqa: F403: a chapter uses most of it

METHODS = ["FAR (OBB)", "FAR (exact)", "CULLIDE", "Quick-CULLIDE", "Boxes", "I-COLLIDE"]
OBB, EXACT, PLAIN, QUICK, PAIRS, BOXES = METHODS
NAMES = ["object_triangles", "kept_triangles", "colliding_triangles", "candidates", "queries", "draws", "there"]


def frames_of(rows):
    """Returns a line for each frame of a scene, with columns (name, method). NaN means that a value is missing. The column
    (there, method) is 1 if the method has a row for the frame."""
    rows = rows.assign(there=1.0)
    rows = rows.assign(**{name: column(rows, name) for name in NAMES})
    wide = rows.groupby(["frame", "contestant"])[NAMES].last().unstack()
    return wide.reindex(columns=pd.MultiIndex.from_product([NAMES, METHODS]))


def measured(frames, method):
    return frames.there[method].any()


def factors(frames, method, name, what="kept_triangles"):
    """Returns a ratio for each frame in which the method keeps something: the count `name` of I-COLLIDE divided
    by the count `what` of the method."""
    kept = frames[what][method]
    return tuple((frames[name][BOXES] / kept)[kept > 0].dropna())


def figure_of(scenes):
    counts = sorted({len(frames) for frames in scenes.values()})
    n = (f"n = {'' if len(counts) == 1 else f'{counts[0]} to '}{counted(counts[-1], 'frame', 'frames')} of each scene, "
         "each run once.")
    axis = Axis("frame", low=0, high=max(1, *(int(frames.index.max()) for frames in scenes.values())))
    return Figure(
        "efficiency", "Triangles that are left to exact tests, frame by frame",
        "I-COLLIDE as published ends with the objects whose boxes meet (all their triangles), ours goes on to boxes of "
        f"triangles. FAR is drawn with both offsets. No method can leave fewer than the triangles that collide. {n}",
        [Panel(scene, axis, log("triangles", zero=True), [
            line_of("I-COLLIDE, objects", frames.object_triangles[BOXES]),
            line_of("I-COLLIDE, triangles", frames.kept_triangles[BOXES])] + [
                line_of(method, frames.kept_triangles[method], emphasis=method != PAIRS)
                for method in (OBB, EXACT, PAIRS) if measured(frames, method)] + [
                    line_of("colliding triangles", frames.colliding_triangles[BOXES], style="lines")])
         for scene, frames in scenes.items()])


def table_of(scenes):
    return Table(
        "efficiency-factors",
        "How many times more I-COLLIDE leaves than FAR: triangles of the objects whose boxes meet, triangles whose boxes "
        "meet, and pairs of them; median of the frames in which FAR keeps something, with the least and the largest",
        columns(["scene", "offset"], ["frames", "objects", "triangles", "pairs"]),
        [[scene, offset, grouped(len(objects)), spread(objects), spread(factors(frames, method, "kept_triangles")),
          spread(factors(frames, method, "candidates", "candidates"))]
         for scene, frames in scenes.items() for method, offset in ((OBB, "OBB"), (EXACT, "exact"))
         if measured(frames, method) for objects in [factors(frames, method, "object_triangles")]])


def add_factors(chapter, scenes):
    def range_of(method, name):
        """Returns the median factors of the scenes, ascending, and a text with the first and the last."""
        of = sorted((median(values), scene) for scene, frames in scenes.items() if (values := factors(frames, method, name)))
        return of, " to ".join(f"{rounded(factor)} ({scene})" for factor, scene in (of[:1] + of[-1:]))

    for method, offset in ((OBB, "boxes"), (EXACT, "exact offsets")):
        (objects, of_objects), (triangles, of_triangles) = (
            range_of(method, name) for name in ("object_triangles", "kept_triangles"))
        if objects and triangles:
            chapter.find(f"FAR with {offset} leaves {of_objects} times fewer triangles than the objects of I-COLLIDE "
                         f"have, by medians over the frames; against boxes of triangles the factor is {of_triangles}, "
                         f"above 1 in {sum(factor > 1 for factor, _ in triangles)} of {len(triangles)} scenes.")


def add_missed(chapter, rows):
    known = rows[column(rows, "missed").notna() & column(rows, "colliding").notna()]
    parts = [f"{method} {of_all(total(of, 'missed'), total(of, 'colliding'))}"
             for method in (OBB, EXACT, PAIRS, BOXES, PLAIN, QUICK) if len(of := known[known.contestant == method])]
    if parts:
        chapter.find(f"Colliding pairs missed, over all frames (a pair counts once in each frame): {listed(parts)}.")


def add_quick(chapter, scenes):
    work = pd.concat([pd.DataFrame()] + [frames[["queries", "draws"]] for frames in scenes.values()])
    work = work.reindex(columns=[(what, method) for what in ("queries", "draws") for method in (QUICK, PLAIN)])
    quick, plain, quick_draws, plain_draws = work.dropna().sum()
    if plain > 0 and plain_draws > 0:
        chapter.find(f"Over all frames Quick-CULLIDE asks {rounded(quick / plain)} and draws "
                     f"{rounded(quick_draws / plain_draws)} times as often as CULLIDE.")


def fill(chapter, study):
    scenes = {scene: frames_of(of) for scene, of in by(study.rows, "scene")}
    add_promises(chapter, study)
    add_factors(chapter, scenes)
    add_missed(chapter, study.rows)
    add_quick(chapter, scenes)
    if scenes:
        chapter.figures, chapter.tables = [figure_of(scenes)], [table_of(scenes)]
