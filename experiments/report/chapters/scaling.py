"""Time against five measures of size, with fitted exponents."""
from frame import *  # noqa: F403: a chapter uses most of it

METHODS = ["FAR (OBB)", "Boxes", "CULLIDE", "I-COLLIDE", "exact"]
CROWD, DENSE = "crowd:[^:]*", "crowd:[^:]*:[^:]*"  # regular expressions for names of scenes
# For each plot: title, label of the x axis, regular expression of its scenes, column with the size.
PLOTS = {"objects": ("objects: crowd:N", "objects", CROWD, "objects"),
         "triangles": ("triangles: torii:N", "triangles", "torii:.*", "triangles"),
         "resolution": ("resolution: two-spheres", "resolution (px)", "two-spheres", "resolution"),
         "density": ("density: crowd", "objects per unit of volume", DENSE, "density"),
         "colliding pairs": ("colliding pairs: crowd", "colliding pairs", DENSE, "colliding")}


def rows_of(rows, plot):
    """Returns the rows of a plot, sorted by the size in the column `at`. The plot over the resolution leaves out methods
    without a resolution."""
    _, _, scenes, size = PLOTS[plot]
    rows = rows[rows.scene.str.fullmatch(scenes)]
    if size == "density":
        rows = rows.assign(density=[float(scene.split(":")[-1]) for scene in rows.scene])
    rows = rows.assign(at=column(rows, size))
    return rows[rows["at"] > 0 if size == "resolution" else rows["at"].notna()].sort_values("at", kind="stable")


def caption_of(rows, drawn):
    sides = sorted({side for plot in PLOTS if plot != "resolution" for side in resolutions(rows_of(rows, plot))})
    drawing = (f"Methods that draw are measured at {listed(map(str, sides))} px but for the plot of resolution, and "
               "not at the largest sizes. ") if sides else ""
    return (f"{sample_text(drawn)}. Bars are the intervals. Both axes are logarithmic, so that a power of x is a straight line. "
            f"{drawing}Density and colliding pairs are two views of the same rows: the same objects in ever smaller boxes.")


def fill(chapter, study):
    rows, drawn = study.rows, []
    add_promises(chapter, study)
    for method in sorted(set(rows[column(rows, "missed") > 0].contestant)):
        chapter.find(f"{method} missed {missed_of(rows[rows.contestant == method])} colliding pairs over all sizes.")
    figure = Figure("scaling", "Time against objects, triangles, resolution, density and colliding pairs")
    exponents = exponents_table("scaling-exponents", "the measure x")
    for plot, (title, axis, *_) in PLOTS.items():
        of = rows_of(rows[column(rows, "total_ms").notna()], plot)
        methods = {name: (name.startswith("FAR"), here) for name in METHODS if len(here := of[of.contestant == name])}
        drawn += [here for _, here in methods.values()]
        figure.panels += [times_panel(title, axis, "at", methods, exponents, plot)] * bool(methods)
    if said := [f"{row[-1]} over {row[0]}" for row in exponents.rows if row[1] == "Boxes"]:
        chapter.find(f"Exponents of the time of boxes, with 95 % intervals: {listed(said)}.")
    if drawn:
        figure.caption = caption_of(rows, pd.concat(drawn).drop_duplicates("position"))
        chapter.figures, chapter.tables = [figure], [exponents]
