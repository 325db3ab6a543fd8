"""Compares boxes, exact offsets and intervals: what they keep and draw, and how long they take."""
from frame import *  # noqa: F403: a chapter uses most of it

BOX, EXACT, INTERVALS = "FAR (OBB)", "FAR (exact)", "FAR pairs"
TIME = "median_ms"
# Figures: name, column of the rows, axis, title, caption.
FIGURES = [
    ("kept", "kept_triangles", "kept triangles", "Triangles that are left to exact tests",
     "No method can keep fewer than collide. FAR keeps a set, whose triangles may each meet another one than they "
     "collide with; FAR pairs keeps those that are in a candidate pair."),
    ("false-positives", "false_positives", "false positives / colliding", "Candidates that do not collide",
     "Pairs handed to exact tests that do not collide, over pairs that do."),
    ("fragments", "fragments", "fragments", "Fragments of one drawing of all triangles in every view",
     "Of FAR: pixel centres in which the fattened triangle is stored or asked. Of FAR pairs: entries in the lists of "
     "pixels, one for each triangle and pixel that it may touch, in the views that it looked with."),
    ("time", TIME, "time (ms)", "Time from triangles to pairs",
     "Medians of the runs with their intervals as bars, without contexts and shaders. FAR with exact offsets "
     "draws boxes first.")]


def figure_of(rows, name, of, label, title, caption):
    sample = sample_text(rows) if of == TIME else "n = " + counted(len(rows), "point", "points")
    return Figure("offsets-" + name, title, f"{caption} {sample}.", [
        Panel(scene, log("resolution (px)"), log(label, zero=True), [
            times_of(method, track, "resolution") if of == TIME else series_of(method, track, "resolution", of)
            for method, track in by(scene_rows[scene_rows.resolution > 0], "contestant")])
        for scene, scene_rows in by(rows, "scene")])


def table_of(rows):
    out = table_of_rows(
        "offsets", "Boxes, exact offsets and intervals; times are medians of the runs with their intervals. " +
        sample_text(rows), rows,
        {"scene": "=scene", "resolution (px)": lambda row: str(row.resolution), "method": "=contestant",
         "kept triangles": "kept_triangles", "candidates": "candidates", "false positives": "~false_positives",
         "fragments": "fragments", "time (ms)": estimate_cell})
    out.in_text = True
    return out


def beside(rows, a, b):
    """The rows of a and of b at the same scene and resolution, side by side."""
    at = ["scene", "resolution"]
    return rows[rows.contestant == a].merge(rows[rows.contestant == b].drop_duplicates(at), on=at, suffixes=("", "_b"))


def add_comparison(chapter, rows, a, b):
    pairs, words = beside(rows, a, b), []
    for name, label in (("kept_triangles", "kept triangles"), ("candidates", "candidates"), ("fragments", "fragments"),
                        (TIME, "time")):
        ratios = column(pairs, name) / column(pairs, name + "_b")
        scenes = ratios[np.isfinite(ratios)].groupby(pairs.scene).median()
        if scenes.empty:
            return
        words.append(f"{spread(scenes)} times the {label}")
    chapter.find(f"{a} against {b}, median over the resolutions of a scene, and of these the median over "
                 f"{counted(len(scenes), 'scene', 'scenes')} with the least and the largest: {', '.join(words)}.")


def add_order(chapter, rows):
    """Adds whether the exact offset, whose solid is inside the box, keeps more anywhere: it must not."""
    pairs = beside(rows, EXACT, BOX)
    ours, theirs = (column(pairs, "kept_triangles" + end).fillna(0) for end in ("", "_b"))
    for row in pairs[ours > theirs].itertuples():
        chapter.find_broken(f"{describe(row)} keeps {grouped(row.kept_triangles)} triangles where boxes keep "
                            f"{grouped(row.kept_triangles_b)}, and starts from what these leave.")
    if len(pairs) and not (ours > theirs).any():
        chapter.find("Exact offsets keep fewer triangles than boxes at "
                     f"{of_all((ours < theirs).sum(), len(pairs))} points, and more at none.")


def fill(chapter, study):
    rows = list(study.rows.itertuples())
    rows = study.rows.assign(false_positives=[false_positives(row) for row in rows], **{
        TIME: [e.value if (e := estimate(row)) else NONE for row in rows]})
    add_promises(chapter, study)
    add_order(chapter, rows)
    add_comparison(chapter, rows, EXACT, BOX)
    add_comparison(chapter, rows, INTERVALS, BOX)
    chapter.limits = [
        "Fragments of FAR are those of one drawing; a run draws what is left several times.",
        "FAR pairs compares pairs and chooses its directions, FAR culls sets along x, y and z: what differs is not the "
        "bound alone.",
        "FAR with exact offsets draws boxes first and exact offsets on what these leave; where boxes leave few "
        "triangles it draws no exact offset.",
        "On a software device times say nothing about graphics hardware; counts carry over."]
    add_gaps(chapter, study)
    if len(rows):
        chapter.figures, chapter.tables = [figure_of(rows, *figure) for figure in FIGURES], [table_of(rows)]
