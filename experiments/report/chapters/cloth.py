"""The simulation of the cloth in each frame at each stiffness, and which pairs were found and missed."""
from frame import *  # noqa: F403


def courses_of(study):
    """Returns for each stiffness: the rows of boxes by frame, the rows of FAR, and the number of frames in the grid."""
    def stiffness_of(scene):
        return (scene.split(":") + ["", ""])[2]

    stiffness = study.rows.scene.map(stiffness_of)
    wanted = study.points[study.points.method == "boxes"].scene.map(stiffness_of).value_counts()
    out = {}
    for name, rows in study.rows.sort_values("frame", kind="stable").groupby(stiffness):
        pairs = rows[rows.method != "far"]
        if len(pairs):
            out[name] = pairs, rows[rows.method == "far"], int(wanted.get(name, 0))
    return out


def gains(pairs):
    """Returns the gain of energy of each frame whose previous frame has a row, in joules: the rise of the total energy, less
    the work of the forces that the step left unbalanced."""
    rise = column(pairs, "total").diff() - column(pairs, "slack")
    return list(rise[pairs.frame.diff() == 1])


def over_frames(name, rows, count, style="lines", emphasis=False):
    return Series(name, list(rows.frame), list(column(rows, count)), style, emphasis)


def figure_of(courses):
    out = Figure("cloth", "Energy of the cloth, work of its solver, and pairs of triangles, frame by frame",
                 "Energy: kinetic energy and all potentials, where 0 is a cloth at rest at the height of the middle of "
                 "the sphere. Then, for each stiffness, the pairs that collide, neighbours among them, and the "
                 "candidates that culling leaves to exact predicates. Most candidates are neighbours, which both "
                 "methods hand to the predicates: a triangle of the grid shares a vertex with twelve others. n = "
                 f"{counted(len(courses), 'simulation', 'simulations')}, one of each stiffness.")
    for title, label, count, low in (("total energy", "J", "total", None), ("work of a step", "factorizations", "iterations", 0)):
        out.panels.append(Panel(title, Axis("frame"), Axis(label, low=low), [
            over_frames(f"{name} N/m", pairs, count) for name, (pairs, _, _) in courses.items()]))
    for name, (pairs, far, _) in courses.items():
        out.panels.append(Panel(f"{name} N/m", Axis("frame"), log("pairs", zero=True), [
            over_frames("Boxes", pairs, "candidates", emphasis=True),
            over_frames("FAR (OBB)", far, "candidates", "points"),
            over_frames("colliding", pairs, "colliding")]))
    return out


def table_of(courses):
    out = Table("cloth", "Each stiffness: frames that were simulated and accounted for, steps that did not converge, "
                "factorizations of a step, the largest force that a step left unbalanced, the total energy of the "
                "first frame and of the last, frames in which triangles collide, the most pairs in one, all pairs that "
                "were accounted for, and those that FAR loses with 0.9 of its radius and without a ball",
                columns(["stiffness (N/m)"], ["frames", "of", "failed", "median", "p95", "most", "residual (N)",
                                              "first (J)", "last (J)", "frames that collide", "most pairs",
                                              "accounted", "missed", "at risk, 0.9", "at risk, no ball"]))
    for name, (pairs, far, wanted) in courses.items():
        iterations, energy = column(pairs, "iterations"), column(pairs, "total")
        colliding = column(pairs, "colliding").fillna(0)
        out.rows.append([
            name, grouped(len(pairs)), grouped(wanted), grouped(len(pairs) - len(where_true(pairs, "converged"))),
            rounded(median(iterations)), rounded(np.quantile(iterations, 0.95, method="inverted_cdf")), rounded(iterations.max()),
            f"{column(pairs, 'residual').fillna(0).max():.2g}", rounded(energy.iloc[0]), rounded(energy.iloc[-1]),
            grouped((colliding > 0).sum()), rounded(colliding.max(), 6),
            *(grouped(total(pairs, count) + total(far, count)) for count in ("accounted", "missed")),
            *("-" if column(far, count).isna().all() else grouped(total(far, count)) for count in ("at_risk", "at_risk_bare"))])
    return out


def add_energy(chapter, name, pairs):
    rises = gains(pairs)
    bad = [gain for gain in rises if not gain <= 0]
    if bad:
        chapter.find_broken(f"At {name} N/m the total energy grew by more than the unbalanced forces can do in "
                            f"{len(bad)} of {grouped(len(rises))} steps, by up to {max(rises):.3g} J.")
    elif rises:
        chapter.find(f"At {name} N/m the total energy never grew by more than the work of the forces that a step left "
                     f"unbalanced ({grouped(len(rises))} steps).")


def culled_pairs(rows):
    """Returns the per cent of the pairs with overlapping boxes that were culled. Neighbours are not counted, since no method
    culls them. The accounting proved that each culled pair is apart."""
    removed = total(rows, "by_predicates")
    left = total(rows, "candidates") - total(rows, "neighbour_candidates")
    return share(removed, removed + left)


def add_power(chapter, rows, name, pairs, far):
    """Adds a finding: the share that each method culled at one stiffness, and the pairs at risk in the frames of FAR."""
    words = []
    for method, of in (("FAR", far), ("Boxes", pairs)):
        if column(of, "views_used").sum() > 0:
            _, views = culled_shares(of)
            words.append(f"{method} took away {rounded(culled_pairs(of), 2)} % of the pairs of overlapping boxes that are "
                         f"no neighbours, and {rounded(views, 2)} % of the triangles")
    if words:
        at = listed(f"{px} px" for px in resolutions(pd.concat([pairs, far])))
        chapter.find(f"At {name} N/m, in views of {at}: {'; '.join(words)}. In the frames of FAR, {risk_text(rows, far)}, "
                     f"of {grouped(total(far, 'colliding'))} that collide.")


def add_agreement(chapter, courses):
    """Adds a finding: whether FAR and boxes found equally many pairs in their common frames. The numbers must be equal."""
    both = differ = 0
    for pairs, far, _ in courses.values():
        for row in far.itertuples():
            other = next(pairs[pairs.frame == row.frame].itertuples(), None)
            both += other is not None
            differ += other is not None and (number(row, "colliding") != number(other, "colliding") or
                                             value(row, "total") != value(other, "total"))
    if differ:
        chapter.find_broken("FAR and boxes found different numbers of pairs, or saw different cloths, in "
                            f"{differ} of {both} frames.")
    elif both:
        chapter.find("FAR and boxes found the same number of colliding pairs in each of the "
                     f"{grouped(both)} frames that both looked at.")


def fill(chapter, study):
    courses = courses_of(study)
    add_promises(chapter, study)
    for name, (pairs, far, _) in courses.items():
        add_power(chapter, study.rows, name, pairs, far)
        if failed := len(pairs) - len(where_true(pairs, "converged")):
            chapter.find_broken(f"At {name} N/m {failed} of {grouped(len(pairs))} steps did not converge.")
        add_energy(chapter, name, pairs)
    add_agreement(chapter, courses)
    for name, (pairs, _, wanted) in courses.items():
        if len(pairs) != wanted:
            chapter.find(f"At {name} N/m {grouped(len(pairs))} of {wanted} frames have been run.")
    if courses:
        chapter.figures, chapter.tables = [figure_of(courses)], [table_of(courses)]
