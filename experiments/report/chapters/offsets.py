"""Compares oriented boxes and exact offsets: what they keep and draw, and how long they take."""
from frame import *  # noqa: F403: a chapter uses most of it

BOX, EXACT = "FAR (OBB)", "FAR (exact)"
TIME = "median_ms"
MEASURES = {"kept triangles": "kept_triangles", "false pos. / colliding": "false_positives", "fragments": "fragments",
            "time (ms)": TIME}
CAPTION = (
    "Kept triangles: no method can keep fewer than collide; FAR keeps a set, whose triangles may each meet another one than they "
    "collide with. False positives: pairs handed to exact tests that do not collide, over pairs that do. Fragments: pixel "
    "centres in which the fattened triangle is stored or asked in one drawing of all triangles in every view. Times: from "
    "triangles to pairs, with their intervals as bars, without contexts and shaders; FAR with exact offsets draws boxes first.")


def figure_of(rows):
    scenes = by(rows[rows.resolution > 0], "scene")
    return Figure("offsets", "Triangles and candidates that are left, fragments, and time, by resolution",
                  f"{CAPTION} {sample_text(rows)}.", [
                      Panel(scene if at == 0 else "", log("resolution (px)"), log(label, zero=True), [
                          times_of(method, track, "resolution", emphasis=method == BOX) if of == TIME else
                          series_of(method, track, "resolution", of, emphasis=method == BOX)
                          for method, track in by(here, "contestant")])
                      for at, (label, of) in enumerate(MEASURES.items()) for scene, here in scenes], columns=len(scenes))


def table_of(rows):
    return table_of_rows(
        "offsets", "Boxes and exact offsets; times are medians of the runs with their intervals", rows,
        {"scene": "=scene", "resolution (px)": lambda row: str(row.resolution), "method": "=contestant",
         "kept triangles": "kept_triangles", "candidates": "candidates", "false positives": "~false_positives",
         "fragments": "fragments", "time (ms)": estimate_cell})


def beside(rows, a, b):
    """Returns the rows of contestant a, each joined with the row of contestant b at the same scene and resolution."""
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
    """Adds findings: where the exact offset keeps more than the box. This must not happen: its solid is inside the box."""
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
    if len(rows):
        chapter.figures, chapter.tables = [figure_of(rows)], [table_of(rows)]
