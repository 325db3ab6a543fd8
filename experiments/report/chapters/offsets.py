"""Boxes, exact offsets and intervals beside each other: what they keep, draw and take."""
from frame import *  # noqa: F403: a chapter uses most of it

BOX, EXACT, INTERVALS = "FAR (OBB)", "FAR (exact)", "FAR pairs"
# Figures by name: title, axis, count (None: the time), caption.
FIGURES = {
    "kept": (
        "Triangles that are left to exact tests", "kept triangles", "kept_triangles",
        "No method can keep fewer than collide. FAR keeps a set, whose triangles may each meet "
        "another one than they collide with; FAR pairs keeps those that are in a candidate pair."),
    "false-positives": (
        "Candidates that do not collide", "false positives / colliding", "false_positives",
        "Pairs handed to exact tests that do not collide, over pairs that do."),
    "fragments": (
        "Fragments of one drawing of all triangles in every view", "fragments", "fragments",
        "Of FAR: pixel centres in which the fattened triangle is stored or asked. Of FAR pairs: "
        "entries in the lists of pixels, one for each triangle and pixel that it may touch, in "
        "the views that it looked with."),
    "time": (
        "Time from triangles to pairs", "time (ms)", None,
        "Medians of the runs with their 95 % intervals as bars, without contexts and shaders. FAR "
        "with exact offsets draws boxes first."),
}


def figures_of(rows):
    out = []
    for name, (title, label, count, caption) in FIGURES.items():
        sample = sample_text(rows) if count is None else \
            "n = " + counted(len(rows), "point", "points")
        figure = Figure("offsets-" + name, title, f"{caption} {sample}.")
        for scene, of in by(rows, "scene"):
            figure.panels.append(Panel(scene, log("resolution (px)"), log(label, zero=True), [
                times_of(method, track, "resolution") if count is None else
                series_of(method, track, "resolution", count)
                for method, track in by(of[of.resolution > 0], "contestant")]))
        out.append(figure)
    return out


def table_of(rows):
    out = table_of_rows(
        "offsets",
        "Boxes, exact offsets and intervals; times are medians of the runs with their 95 % "
        "intervals. " + sample_text(rows), rows,
        {"scene": "=scene", "resolution (px)": lambda row: str(row.resolution),
         "method": "=contestant", "kept triangles": "kept_triangles", "candidates": "candidates",
         "false positives": "~false_positives", "fragments": "fragments",
         "time (ms)": estimate_cell})
    out.in_text = True
    return out


def beside(rows, a, b):
    """The rows of a and of b at the same scene and resolution, side by side."""
    at = ["scene", "resolution"]
    return rows[rows.contestant == a].merge(rows[rows.contestant == b].drop_duplicates(at), on=at,
                                            suffixes=("", "_b"))


def add_comparison(chapter, rows, a, b):
    pairs, words = beside(rows, a, b), []
    for name, label in (("kept_triangles", "kept triangles"), ("candidates", "candidates"),
                        ("fragments", "fragments"), ("median_ms", "time")):
        ratios = column(pairs, name) / column(pairs, name + "_b")
        ratios = tuple(ratios[np.isfinite(ratios)])
        if not ratios:
            return
        e = median_estimate(ratios)
        words.append(f"{rounded(e.value)} times ({rounded(e.low)} to {rounded(e.high)}, "
                     f"n = {e.n}) the {label}")
    chapter.find(f"{a} against {b}, median over scenes and resolutions with the 95 % interval that "
                 f"it would have were these independent: {', '.join(words)}.")


def add_order(chapter, rows):
    """A smaller solid inside the other one must not keep more."""
    pairs = beside(rows, EXACT, BOX)
    ours, theirs = (column(pairs, "kept_triangles" + end).fillna(0) for end in ("", "_b"))
    for row in pairs[ours > theirs].itertuples():
        chapter.find_broken(
            f"{describe(row)} keeps {grouped(row.kept_triangles)} triangles where boxes keep "
            f"{grouped(row.kept_triangles_b)}, and starts from what these leave.")
    if len(pairs) and not (ours > theirs).any():
        chapter.find("Exact offsets keep fewer triangles than boxes at "
                     f"{of_all((ours < theirs).sum(), len(pairs))} points, and more at none.")


def fill(chapter, study):
    rows = study.rows
    rows = rows.assign(
        false_positives=[false_positives(row) for row in rows.itertuples()],
        median_ms=[e.value if (e := estimate(row)) else NONE for row in rows.itertuples()])
    add_promises(chapter, study)
    add_order(chapter, rows)
    add_comparison(chapter, rows, EXACT, BOX)
    add_comparison(chapter, rows, INTERVALS, BOX)
    chapter.limits = [
        "Fragments of FAR are those of one drawing; a run draws what is left several times.",
        "FAR pairs compares pairs and chooses its directions, FAR culls sets along x, y and z: "
        "what differs is not the bound alone.",
        "FAR with exact offsets draws boxes first and exact offsets on what these leave; where "
        "boxes leave few triangles it draws no exact offset.",
        "On a software device times say nothing about graphics hardware; counts carry over."]
    add_gaps(chapter, study)
    if len(rows):
        chapter.figures, chapter.tables = figures_of(rows), [table_of(rows)]
