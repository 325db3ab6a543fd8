"""Time against five measures of size, with fitted exponents."""
from frame import *  # noqa: F403: a chapter uses most of it

METHODS = ["FAR (OBB)", "FAR pairs", "CULLIDE", "I-COLLIDE", "exact"]
CROWD, DENSE = "crowd:[^:]*", "crowd:[^:]*:[^:]*"  # patterns of scenes
# Each plot by the name of its size: title, axis, its scenes, the column of the size.
PLOTS = {"objects": ("objects: crowd:N", "objects", CROWD, "objects"),
         "triangles": ("triangles: torii:N", "triangles", "torii:.*", "triangles"),
         "resolution": ("resolution: two-spheres", "resolution (px)", "two-spheres", "resolution"),
         "density": ("density: crowd", "objects per unit of volume", DENSE, "density"),
         "colliding pairs": ("colliding pairs: crowd", "colliding pairs", DENSE, "colliding")}


def rows_of(rows, plot):
    """The rows of a plot, ascending in its size, the column `at`. Methods without a resolution are not in its plot."""
    _, _, scenes, size = PLOTS[plot]
    rows = rows[rows.scene.str.fullmatch(scenes)]
    if size == "density":
        rows = rows.assign(density=[float(scene.split(":")[-1]) for scene in rows.scene])
    rows = rows.assign(at=column(rows, size))
    return rows[rows["at"] > 0 if size == "resolution" else rows["at"].notna()].sort_values("at", kind="stable")


def miss_table(chapter, rows):
    """Missed and colliding pairs by method, over all rows; a method that misses is a finding."""
    out = Table(
        "scaling-missed",
        "Missed pairs of all that collide, over all sizes and resolutions: a pair counts once in each run",
        columns(["method"], ["points", "colliding", "missed", "share (%)"]))
    for method, of in rows[column(rows, "missed").notna()].groupby("contestant"):
        missed, colliding = total(of, "missed"), total(of, "colliding")
        out.rows.append([method, grouped(len(of)), grouped(colliding), grouped(missed),
                         rounded(share(missed, colliding))])
        if missed or method == "CULLIDE":
            chapter.find(f"{method} missed {of_all(missed, colliding)} colliding pairs over all sizes.")
    return out


def caption_of(rows, drawn):
    sides = sorted({side for plot in PLOTS if plot != "resolution" for side in resolutions(rows_of(rows, plot))})
    drawing = (f"Methods that draw are measured at {listed(map(str, sides))} px but for the plot of resolution, and "
               "not at the largest sizes. ") if sides else ""
    return (f"{sample_text(drawn)}. Bars are the intervals. Both axes are logarithmic, so that a power of x "
            f"is a straight line. {drawing}Density and colliding pairs are two views of the same rows: the same "
            "objects in ever smaller boxes.")


def fill(chapter, study):
    rows, drawn = study.rows, []
    add_promises(chapter, study)
    misses = miss_table(chapter, rows)
    figure = Figure("scaling", "Time against objects, triangles, resolution, density and colliding pairs")
    exponents = Table(
        "scaling-exponents",
        "Exponent b of time = a x^b, by least squares in logarithms over the whole range, with its 95 % interval "
        f"(Student's t of the residuals; not given for fewer than {FEWEST_FOR_INTERVAL} points)",
        columns(["x", "method"], ["from", "to", "points", "exponent"]))
    times = Table("scaling-times", "Time from triangles to exact pairs: median of the runs, with its interval",
                  columns(["x", "method"], ["value", "runs", "time (ms)"]), in_text=False)
    for plot, (title, axis, *_) in PLOTS.items():
        of, said = rows_of(rows[column(rows, "total_ms").notna()], plot), []
        panel = Panel(title, log(axis, zero=True), log("time (ms)"))
        for method in (method for method in METHODS if (of.contestant == method).any()):
            drawn.append(of[of.contestant == method])
            series = times_of(method, drawn[-1], "at", emphasis=method.startswith("FAR"))
            panel.series.append(series)
            times.rows += [[plot, method, rounded(row.at, 6), grouped(e.n), estimate_text(e, 4)]
                           for row in drawn[-1].itertuples() for e in [estimate(row)]]
            if e := exponent_of(series.x, series.y):
                said.append(f"{method} {exponent_text(e)}")
                exponents.rows.append([plot, method, rounded(e.first), rounded(e.last), grouped(e.points),
                                       exponent_text(e)])
        if said:
            chapter.find(f"Exponent of time over {plot}, with its 95 % interval: {listed(said)}.")
        figure.panels += [panel] * bool(panel.series)
    chapter.limits = [
        "A fitted exponent holds for its range alone: constant parts flatten small sizes, caches and the growing "
        "number of rounds steepen large ones. The interval is of the straight line through the medians, not of another "
        "machine.",
        "More objects in `crowd:N` stand at the same density, more triangles in `torii:N` are of the same six objects, "
        "so that what collides grows with both.",
        "I-COLLIDE sorts anew in each run here; from frame to frame it would mend what it has sorted.",
        "Fragment work runs on the CPU where the device is software: there, resolution costs what graphics hardware "
        "does side by side."]
    add_gaps(chapter, study)
    if drawn:
        figure.caption = caption_of(rows, pd.concat(drawn).drop_duplicates("position"))
        chapter.figures, chapter.tables = [figure], [exponents, times]
    chapter.tables += [misses] * bool(misses.rows)
