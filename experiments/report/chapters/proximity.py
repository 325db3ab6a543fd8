"""Shows potential neighbour sets: their sizes, the neighbours that a grid loses, both numbers over frames, and time against
the number of objects. Then shows errors of distances.

A row of the study is about the sets that a method computes, or about the distances that a contestant returns. If objects
rest (frame -1), the rows of a scene differ in seed and resolution. If objects move, the rows differ in the frame.
"""
from frame import *  # noqa: F403: a chapter uses most of it

BOXES, TREES, PUBLISHED, RELIABLE = "boxes of objects", "trees of boxes", "Voronoi (published)", "Voronoi (reliable)"
NARROW = "Voronoi (not widened)"
NAMES = {"boxes": BOXES, "trees": TREES, "voronoi": PUBLISHED, "voronoi-reliable": RELIABLE,
         "voronoi-reliable --widening 0": NARROW}
DIAGRAMS = [PUBLISHED, RELIABLE, NARROW]
CELLS = "cells along the scene"
SUMS = ["with_nearest", "missed", "set_triangles"]


def with_names(rows):
    """Returns the rows with more columns: name, of the method; base, the scene without its seed; sets, true if the row is
    about sets, false for distances; counts, true if the row belongs to the plot over the number of objects."""
    return rows.assign(
        name=[NAMES.get(method, method.split(" ")[0]) for method in rows.method],
        base=[scene_base(scene) for scene in rows.scene], sets=~rows.method.str.contains(" (?:nearest|objects)$"),
        counts=(rows.frame < 0) & rows.scene.str.fullmatch("crowd:[0-9]*"),
        library=[text(row, "library") for row in rows.itertuples()])


class SetScene:
    """The rows of a scene, summed over its seeds, by method and by `at` (resolution or frame). `missed` counts objects that
    lost their nearest neighbour."""

    def __init__(self, base, rows, at):
        rows = rows.assign(**{name: column(rows, name) for name in SUMS})
        self.base, self.seeds, self.sums = base, rows.scene.nunique(), rows.groupby(["name", at])[SUMS].sum()
        self.sums["triangles_each"] = (self.sums.set_triangles / self.sums.with_nearest).fillna(0)

    def of(self, method):
        return self.sums.loc[method] if method in self.sums.index else self.sums.iloc[:0]

    def value(self, method, at, what):
        return self.sums.at[(method, at), what] if (method, at) in self.sums.index else NONE

    def factor(self, method, at, at_boxes):
        """Returns triangles that boxes leave / triangles that the method leaves; NaN if a count is missing."""
        kept = self.value(method, at, "set_triangles")
        return self.value(BOXES, at_boxes, "set_triangles") / kept if kept else NONE

    def series(self, method, what, **look):
        return line_of(method, self.of(method)[what], emphasis=method == RELIABLE, **look)


def scenes_of(rows, at):
    return [SetScene(base, of, at) for base, of in by(rows, "base")]


def objects_text(scenes):
    """Returns a text with the number of objects in each panel."""
    return "n: " + listed(
        f"{scene.base} ({counted(scene.sums.with_nearest.max(), 'object', 'objects')}"
        f"{f', {scene.seeds} seeds' if scene.seeds > 1 else ''})" for scene in scenes)


# ---- promises

def broken_text(row):
    """Returns how a row broke its promise; "" if the row kept it."""
    wrong, missed, pairs = (number(row, name) for name in ("wrong", "missed", "missed_pairs"))
    if not row.sets:
        return f"{of_all(wrong, number(row, 'asked'))} distances are not the nearest double" if wrong else ""
    return "" if missed == 0 and pairs == 0 else (
        f"{of_all(missed, number(row, 'with_nearest'))} objects lose their nearest neighbour, and "
        f"{of_all(pairs, number(row, 'nearest_pairs'))} nearest pairs of triangles")


def add_kept_promises(chapter, all_rows):
    rows = promising(all_rows)
    known = column(rows, "missed").where(rows.sets, column(rows, "wrong")).notna()
    broken = [(row, said) for row in rows[known].itertuples() if (said := broken_text(row))]
    for row, said in broken:
        chapter.find_broken(f"{describe(row)}: {said}, which it promises not to do.")
    if silent := int((~known).sum()):
        chapter.find(f"{'One row' if silent == 1 else grouped(silent) + ' rows'} of methods that promise "
                     f"{'does' if silent == 1 else 'do'} not say what they lost.")
    sets, distances = rows[known & rows.sets], rows[known & ~rows.sets]
    if len(sets) and not broken:
        chapter.find(f"{listed(sorted(set(sets.name)))} lost {of_all(0, total(sets, 'with_nearest'))} nearest "
                     f"neighbours of objects, and {of_all(0, total(sets, 'nearest_pairs'))} nearest pairs of "
                     f"triangles, in {counted(len(sets), 'run', 'runs')}. An object counts once in each run.")
        words = [f"{grouped(total(of, 'missed'))} of {grouped(total(of, 'with_nearest'))} in {name}" for name, of in
                 by(all_rows[all_rows.name.isin([PUBLISHED, NARROW])], "name")]
        if words:
            chapter.find(f"At risk of a diagram, since they are lost on the same scenes: {listed(words)}. Boxes and trees "
                         "have no cells that could lose a neighbour.")
    if len(distances) and not broken:
        chapter.find(f"Of the distances of farcull {of_all(0, total(distances, 'asked'))} were not the nearest double.")


# ---- sets: neighbours that are missed, and sizes

def lost_figure(scenes):
    def lost_series(scene, method):
        of = scene.of(method)
        of = of[of.with_nearest > 0]
        return line_of(method, 100 * of.missed / of.with_nearest, emphasis=method == RELIABLE)

    scenes = [scene for scene in scenes if scene.sums.missed.sum() > 0 and any(map(len, map(scene.of, DIAGRAMS)))]
    return Figure(
        "proximity-lost", "Objects that lose their nearest neighbour, against the resolution",
        "An object is lost if none of its nearest neighbours is in its set. clusters:R has clusters whose sides are 1/R of "
        "that of the scene. Not widened: the reliable form without the half diagonal of a cell that its proof asks for. "
        f"Scenes of which nothing is lost are in the table. {objects_text(scenes)}.",
        [Panel(scene.base, log(CELLS), Axis("lost (% of objects)", low=0), [
            series for method in DIAGRAMS if (series := lost_series(scene, method)).x]) for scene in scenes])


def lost_table(scenes, sizes):
    return Table(
        "proximity-lost",
        "Objects that lose their nearest neighbour, at each resolution in cells along the scene; \"-\" where the diagram "
        "was left out or not asked for", columns(["scene", "method"], ["objects"] + [str(cells) for cells in sizes]),
        [[scene.base, method, grouped(of.with_nearest.iloc[0])] +
         ["-" if count != count else grouped(count) for count in of.missed.reindex(sizes)]
         for scene in scenes for method in DIAGRAMS if len(of := scene.of(method))])


def size_figure(scenes):
    out = Figure(
        "proximity-triangles", "Triangles per set against the resolution",
        "Mean over the objects that have a nearest neighbour. The published form and boxes take objects with all their "
        "triangles, or all those near enough; trees and the reliable form take triangles. The published form may be "
        f"below what holds all nearest neighbours. {objects_text(scenes)}.")
    for scene in scenes:
        series = [scene.series(method, "triangles_each") for method in (PUBLISHED, RELIABLE) if len(scene.of(method))]
        if series:  # boxes and trees use no cells, so their counts do not depend on the resolution
            x, levels = series[0].x, [(method, scene.value(method, 0, "triangles_each")) for method in (BOXES, TREES)]
            series += [Series(method, x, [y] * len(x), "lines") for method, y in levels if y == y]
            out.panels.append(Panel(scene.base, log(CELLS), log("triangles per object", zero=True), series))
    return out


def efficiency_table(rest, moving, finest):
    out = Table(
        "proximity-efficiency",
        "Culling efficiency: how many times more triangles the boxes of objects leave in the sets. Of scenes at rest "
        f"the diagrams have {finest} cells along the scene; of scenes that move, the median over the frames with the "
        "least and the largest", columns(["scene"], ["frames", "triangles per object, boxes", TREES, RELIABLE, PUBLISHED]))
    for scene in rest:
        out.rows.append([scene.base, "-", rounded(scene.value(BOXES, 0, "triangles_each"))] + [
            rounded(scene.factor(*at, 0)) for at in ((TREES, 0), (RELIABLE, finest), (PUBLISHED, finest))])
    for scene in moving:
        frames = scene.sums.index.unique(1)
        factors = [[scene.factor(method, frame, frame) for frame in frames] for method in (TREES, RELIABLE, PUBLISHED)]
        out.rows.append([scene.base, grouped(len(frames)), spread(scene.of(BOXES).triangles_each)] +
                        [spread([x for x in of if x > 0]) for of in factors])
    return out


def add_sets(chapter, rest, sizes):
    for method in (PUBLISHED, NARROW) if rest else ():
        sums = pd.concat([scene.of(method) for scene in rest]).groupby(level=-1).sum()
        parts = [f"{of_all(sums.missed[cells], sums.with_nearest[cells])} at {cells} cells" for cells in sizes
                 if cells in sums.index and sums.with_nearest[cells] > 0]
        if parts:
            chapter.find(f"{method}, lost of all objects: {listed(parts)}.")
    factors = sorted((factor, scene.base) for scene in rest if (factor := scene.factor(TREES, 0, 0)) > 0)
    if factors:
        ends = " to ".join(f"{rounded(factor)} ({base})" for factor, base in factors[:1] + factors[-1:])
        chapter.find(f"Boxes of objects leave {ends} times more triangles per object than trees of boxes do.")


# ---- times and distances

def count_figure(rows, exponents):
    drawn, out = [], Figure("proximity-objects", "Time against the number of objects")
    for what, title, part in (("sets", "sets: crowd:N", rows[rows.sets]),
                              ("distances", "distances to the nearest: crowd:N", rows[~rows.sets])):
        part = part[part.counts].assign(number=column(part, "objects")).sort_values("number", kind="stable")
        methods = {name: (name in (TREES, "farcull"), of) for name, of in part.groupby("name")}
        drawn += [of for _, of in methods.values()]
        out.panels += [times_panel(title, "objects", "number", methods, exponents, what)] * bool(methods)
    if drawn:
        out.caption = (f"On one thread: {sample_text(pd.concat(drawn))}. Bars are the intervals. Objects stand at the "
                       "same density. Distances are from the triangles to the distance of each object "
                       "from its nearest one, trees included.")
    return out


def error_figure(rows):
    drawn = rows.drop_duplicates(["scene", "contestant"])
    out = Figure(
        "proximity-error", "Errors of distances against time",
        "The largest error of a distance over the exact distance, of those where neither is 0; those that are wrong in "
        "another way are in the table. Times go from the triangles to the distances, on one thread: "
        f"{sample_text(drawn)}. Bars are the intervals.")
    for scene, of in by(drawn, "scene"):
        panel = Panel(scene, log("time (ms)"), log("largest relative error", zero=True))
        for name, row in by(of, "name"):
            time = times_of(name, row, "largest_relative")
            panel.series.append(Series(name, time.y, time.x, "points", name == "farcull", time.y_low, time.y_high))
        out.panels.append(panel)
    return out


def distance_table(rows):
    return table_of_rows(
        "proximity-distances",
        "Distances asked for, those that are not the nearest double, and of these: lacking, 0 where objects are apart "
        "or the reverse, of another object that is not as near; the largest relative error of the others; time in ms "
        "as the median with its interval", pd.concat([rows[:0]] + [of for _, of in by(rows, "scene")]),
        {"scene": "=scene", "contestant": "=name", "asked": "asked", "off": "wrong", "lacking": "lacking",
         "other 0": "other_zero", "other object": "other_object",
         "largest error": lambda row: rounded(value(row, "largest_relative"), 2), "time (ms)": estimate_cell,
         "library": "=library"})


def fill(chapter, study):
    rows = with_names(study.rows)
    sets, apart = rows[rows.sets], rows[~rows.sets & ~rows.counts]
    rest = scenes_of(sets[(sets.frame < 0) & ~sets.counts], "resolution")
    moving = scenes_of(sets[sets.frame >= 0], "frame")
    sizes = sorted({cells for scene in rest for _, cells in scene.sums.index if cells > 0})
    add_kept_promises(chapter, rows)
    add_sets(chapter, rest, sizes)
    exponents = exponents_table("proximity-exponents", "the number of objects")
    chapter.figures = [lost_figure(rest), size_figure(rest), count_figure(rows, exponents), error_figure(apart)]
    chapter.tables = [lost_table(rest, sizes), efficiency_table(rest, moving, max(sizes, default=0)), exponents,
                      distance_table(apart)]
