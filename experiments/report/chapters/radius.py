"""How often the published radius misses something in scenes that were not constructed for it; then violated points of
the lemmas and missed pairs of FAR against the radius, with the published radius beside the budget."""
from frame import *  # noqa: F403

CLOSE = 0.96  # the second panel shows CLOSE to 2 - CLOSE
SURFACES = {"lemma-worst": "worst canvas", "fixed": "fixed-function depth"}


def with_axes(rows):
    """Rows with the radius over the budget radius (NaN where a row of a published radius lacks one of the two), and
    with the canvas and the depth that a lemma was tested with."""
    over = column(rows, "radius_px") / column(rows, "budget_px")
    return rows.assign(
        published=rows.radius == "published",
        factor=[over[i] if r == "published" else 1.0 if r in ("", "budget") else float(r)
                for i, r in rows.radius.items()],
        surface=[SURFACES.get(m) or SURFACES.get(d, "fragment depth") for m, d in zip(rows.method, rows.depth_mode)])


def violated(rows):
    return share(total(rows, "violations"), total(rows, "points"))


def missed(rows):
    return share(total(rows, "missed"), total(rows, "colliding"))


def groups(rows, name):
    return list(rows.groupby(name)) if len(rows) else []


class Line:
    """The rows of a line by factor, and those of the published radius apart."""

    def __init__(self, rows):
        self.published = rows[rows.published]
        self.at = dict(groups(rows[~rows.published], "factor"))

    def series(self, name, of, style):
        return Series(name, list(self.at), [of(rows) for rows in self.at.values()], style)

    @property
    def published_factor(self):
        """The published radius over the budget, from the rows of FAR at both."""
        if self.published.empty or 1 not in self.at:
            return NONE
        one, other = (column(rows, "radius_px").iloc[-1] for rows in (self.published, self.at[1]))
        return one / other if other > 0 else NONE


def lines_of(rows, name):
    """For each surface, a Line for each value of the column."""
    return {surface: {key: Line(of) for key, of in groups(here, name)} for surface, here in groups(rows, "surface")}


# ---- the lemmas

def panel_of(title, label):
    """A share in per cent against the factor."""
    return Panel(title, Axis("radius / budget radius", low=0, high=1.1), log(label, zero=True, high=100),
                 marks=[Mark(1, "budget radius")])


def envelope_of(surface, lines):
    """The largest share of a generator at each factor."""
    most = {}
    for line in lines.values():
        for factor, rows in line.at.items():
            most[factor] = max(most.get(factor, 0.0), violated(rows))
    return Series(surface, sorted(most), [most[f] for f in sorted(most)], emphasis=surface == "fragment depth")


def published_series(name, lines, factor, of):
    known = [line for line in lines.values() if len(line.published)]
    return [Series(name, [factor(line) for line in known], [of(line.published) for line in known],
                   "points")] if known else []


def lemma_figure(generators, points):
    panel = panel_of("all radii", "violated points (%)")
    for surface, lines in generators.items():
        panel.series.append(envelope_of(surface, lines))
        panel.series += published_series(f"{surface}, published radius", lines,
                                         lambda line: line.published.factor.iloc[-1], violated)
    close = Panel("close to 1", Axis(panel.x.label, low=CLOSE, high=2 - CLOSE), panel.y,
                  [Series(**vars(s)) for s in panel.series], panel.marks)
    return Figure(
        "radius", "Points whose pixel lacks a sample or a bound, against the radius",
        f"Lemmas 1 and 2 at {grouped(points)} points of triangles that aim at trouble, drawn by "
        f"{max(len(lines) for lines in generators.values())} generators. A line is the largest share of any generator; of "
        "the published radius each generator is a point. On the worst canvas a pixel has a fragment only where every "
        "device that keeps the assumptions gives it one.", [panel, close])


def miss_figure(depths, runs):
    out, scenes = Figure("radius-missed", "Missed pairs against the radius"), []
    for depth, lines in depths.items():
        panel = panel_of(depth, "missed pairs (%)")
        panel.series = [line.series(name, missed, "lines_points") for name, line in lines.items()]
        panel.series += published_series("published radius, each scene", lines, lambda line: line.published_factor,
                                         missed)
        out.panels.append(panel)
        for scene, line in lines.items():
            rows = line.published if len(line.published) else next(iter(line.at.values()))
            scenes.append(f"{grouped(column(rows, 'colliding').fillna(0).iloc[-1])} in {scene}")
    out.caption = (f"FAR with oriented boxes: colliding pairs that culling loses, of {listed(dict.fromkeys(scenes))}. "
                   f"n = {counted(len(runs), 'run', 'runs')}, one at each point.")
    return out


def least_safe(line):
    """The least factor from which on no row of the line is violated."""
    out = "-"
    for factor, rows in reversed(line.at.items()):
        if total(rows, "violations"):
            break
        out = f"{factor:.4g}"
    return out


def farthest(rows):
    return max(0.0, column(rows, "largest_px").fillna(math.inf).max())


def lemma_table(lines):
    out = Table("radius", "Violated points at the published and at the budget radius, and the least factor on the budget "
                "from which on none is, of every generator",
                columns(["depth", "generator"], ["points", "published", "budget", "least factor",
                                                 "published: farthest outside (px)"]))
    for surface, generators in lines.items():
        for generator, line in generators.items():
            budget = line.at.get(1)
            count = (lambda rows, n: "-" if rows is None or rows.empty else grouped(total(rows, n)))
            out.rows.append([surface, generator, count(budget, "points"), count(line.published, "violations"),
                             count(budget, "violations"), least_safe(line),
                             rounded(farthest(line.published)) if len(line.published) else "-"])
    return out


def add_lemmas(chapter, lemmas):
    """Adds violations of the lemmas at the budget radius and beyond. With fragment depth the lemmas are proved, so a
    violation breaks a promise even if its row promises nothing. Rows for which breaks() holds are reported already."""
    safe, broken = lemmas[~lemmas.published & (lemmas.factor >= 1)], False
    for row in safe[safe.depth_mode != "fixed"].itertuples():
        violations = number(row, "violations")
        broken = broken or violations > 0
        if violations and not breaks(row):
            chapter.find_broken(f"at {row.factor:g} of the budget radius, {row.surface}, "
                                f"{of_all(violations, number(row, 'points'))} points of the generator "
                                f"\"{row.generator}\" are violated; the lemmas say none.")
    for surface, rows in groups(safe, "surface"):
        promised = surface != "fixed-function depth"
        if not (promised and broken and total(rows, "violations")):
            chapter.find(f"At the budget radius and beyond, {surface}: {of_rows(rows, 'violations', 'points')} points "
                         f"are violated{'' if promised else ' (it promises nothing)'}.")


def add_published(chapter, generators):
    for surface, lines in generators.items():
        known = [line.published for line in lines.values() if len(line.published)]
        if known:
            rows = pd.concat(known)
            low, high = (f"{end(rows.factor):.4f}" for end in (min, max))
            chapter.find(f"The published radius, {low if low == high else low + ' to ' + high} of the budget, {surface}: "
                         f"{of_rows(rows, 'violations', 'points')} points are violated, "
                         f"{grouped(total(rows, 'no_sample'))} of them without a sample.")


# ---- placements

def with_placements(rows):
    """Rows with their placements: the scene of the patches, the contact, the side in px, and the subpixel bits to which
    corners are snapped (0: not snapped)."""
    words = [re.fullmatch(r"(.*)@(\w+):([^:]*):.*", scene).groups() for scene in rows.scene]
    return rows.assign(patches=[w[0] for w in words], contact=[w[1] for w in words], side=[float(w[2]) for w in words],
                       bits=[int(m.removeprefix("far-snapped-")) if m.startswith("far-snapped-") else 0
                             for m in rows.method])


def bits_text(bits):
    return f"{bits} subpixel bits" if bits > 0 else "corners not snapped"


def rate_of_rows(rows):
    return rate_text(total(rows, "missed_placements"), total(rows, "colliding_placements"))


def add_headline(chapter, runs, placements):
    """Adds how often the published radius misses something in scenes that were not constructed for it, and that it
    fails end to end only in those that were. Comes first, since the rest is about constructed points."""
    published = runs[runs.published & (runs.depth_mode == "fragment")]
    constructed = published[published.scene == "pixel-corners"]
    natural = published[published.scene != "pixel-corners"]
    if len(natural):
        of, lost = of_rows(constructed, "missed", "colliding"), total(natural, "missed")
        rest = ("" if constructed.empty else
                f"; its failure end to end rests on the constructed pixel-corners, where it missed {of}"
                if lost == 0 and total(constructed, "missed") else
                f"; on the constructed pixel-corners it missed {of} here{not_snapped(constructed)}")
        chapter.find("On scenes that were not constructed against it, the published radius missed "
                     f"{missed_of(natural)} colliding pairs in "
                     f"{counted(len(natural), 'run', 'runs')} with fragment depth{rest}.")
        # A radius that misses nothing where no smaller one misses anything says nothing.
        smaller = runs[(runs.factor == 0.9) & (runs.depth_mode == "fragment")]
        bare = runs[(runs.factor == 0) & (runs.depth_mode == "fragment")]
        if len(smaller) and len(bare):
            chapter.find(f"Pairs at risk in these scenes, views and pixels: {of_rows(smaller, 'missed', 'colliding')} are "
                         f"missed with 0.9 of the budget radius, and {grouped(total(bare, 'missed'))} without a ball.")
    for bits, rows in groups(placements[placements.published], "bits"):
        longest = rounded(column(rows, "largest_miss_px").max())
        more = f"; the longest intersection that it missed is {longest} px long" if total(rows, "missed") else ""
        chapter.find(f"Of patches placed into each other at random, {bits_text(bits)}, the published radius missed "
                     f"something in {rate_of_rows(rows)} placements{more}.")
    # Gives a rate of 0 a meaning: the misses of smaller radii in the same placements.
    words = [f"at {factor:.4g} of the budget in {of_rows(rows, 'missed_placements', 'colliding_placements')}"
             for factor, rows in groups(placements[~placements.published & (placements.factor < 1)], "factor")]
    if words:
        chapter.find(f"Smaller radii miss something in such placements: {listed(words)}.")


def usual(rows, name):
    """The value that most placements have; of equally common ones the least."""
    times = {key: total(of, "placements") for key, of in groups(rows, name)}
    return max(times, key=times.get)


def placement_figure(placements):
    """The rate of placements with a miss against the radius, by the size of triangles, with its interval. Corners are
    snapped to as many bits as in most placements."""
    bits = usual(placements, "bits")
    rows = placements[(placements.bits == bits) & np.isfinite(placements.factor)]
    panel = panel_of("", "placements with a miss (%)")
    panel.x.low = 0.45
    for side, here in groups(rows, "side"):
        series = Series(f"sides of {side:.4g} px")
        for factor, of in groups(here, "factor"):
            if total(of, "colliding_placements"):
                rate = rate_of(total(of, "missed_placements"), total(of, "colliding_placements"))
                series.x.append(factor)
                for ends, part in ((series.y, rate.value), (series.y_low, rate.low), (series.y_high, rate.high)):
                    ends.append(100 * part)
        panel.series += [series] * (len(series.x) > 1)
    return Figure(
        "radius-placements", "How often FAR misses something in random placements, by radius",
        "FAR with oriented boxes and fragment depth in three views, on placements of two patches of triangles, each "
        "decided "
        "by exact predicates: of those in which a pair collides, those in which one is missed, with the 95 % "
        "interval of "
        f"Clopper and Pearson (where none is missed, up to its upper bound). {bits_text(bits).capitalize()}. The "
        "published "
        "radius is the last point below 1. n = "
        f"{counted(total(rows, 'placements'), 'placement', 'placements')}; what was measured at the published "
        "radius with "
        "other bits and resolutions is in the table.", [panel] if panel.series else [])


def placement_table(placements):
    out = Table("radius-placements", "Random placements in which FAR misses a colliding pair, of those in which one "
                "collides, of both kinds of patches and of contacts together",
                columns(["radius"], ["side (px)", "subpixel bits", "resolution", "placements", "with a miss", "missed pairs",
                                     "largest miss (px)"]))
    for (radius, bits, resolution, side), rows in groups(placements, ["radius", "bits", "resolution", "side"]):
        out.rows.append([
            radius, rounded(side), str(bits) if bits else "not snapped", str(resolution), grouped(total(rows, "placements")),
            rate_of_rows(rows), of_rows(rows, "missed", "colliding"),
            rounded(column(rows, "largest_miss_px").max()) if total(rows, "missed") else "-"])
    return out


def fill(chapter, study):
    rows = with_axes(study.rows)
    lemma = rows.method.str.startswith("lemma")
    placed = ~lemma & rows.scene.str.contains("@crossing:|@grazing:")
    lemmas, placements, runs = rows[lemma], with_placements(rows[placed]), rows[~lemma & ~placed]
    lemmas = lemmas.assign(generator=[scene.split(":")[1] for scene in lemmas.scene])
    generators, misses = lines_of(lemmas, "generator"), lines_of(runs, "scene")
    add_headline(chapter, runs, placements)
    add_promises(chapter, study)
    add_lemmas(chapter, lemmas)
    add_published(chapter, generators)
    chapter.limits = [
        "The points are drawn to find violations, so a share of violated points is no probability in a scene.",
        "Placements are of patches of eight triangles alone, which meet by construction. A rate over them is no rate "
        "over the pairs of a scene, where other triangles keep many of them.",
        "Devices that snap are stood in for: the native canvas draws proxies whose corners are rounded to the nearest "
        "subpixel. A2 allows a device twice that error.",
        "Below the budget a radius that violates nothing here is not thereby safe: another device may use the slack "
        "that this one leaves.",
        "Fixed-function depth is read from the depth buffer, and what rounding of the depth map explains is no "
        "violation (core/canvas/canvas.h, depth_rounding); fragment depth is what the shader computes, and must bound "
        "exactly."]
    add_gaps(chapter, study)
    if len(lemmas):
        chapter.figures.append(lemma_figure(generators, total(lemmas, "points")))
        chapter.tables.append(lemma_table(generators))
    if len(runs):
        chapter.figures.append(miss_figure(misses, runs))
    if len(placements):
        chapter.figures += [figure for figure in [placement_figure(placements)] if figure.panels]
        chapter.tables.append(placement_table(placements))
