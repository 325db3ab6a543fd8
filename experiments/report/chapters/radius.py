"""Shows how often the published radius misses pairs in scenes that were not constructed against it. Then shows, against
the radius, violated points of the lemmas and missed pairs of FAR, with the published radius beside the budget radius."""
from frame import *  # noqa: F403

CLOSE = 0.96  # the second panel shows factors from CLOSE to 2 - CLOSE
SURFACES = {"lemma-worst": "worst canvas", "fixed": "fixed-function depth"}


def with_axes(rows):
    """Returns the rows with more columns: `factor`, radius / budget radius (NaN if a row of the published radius lacks one
    of these numbers); `surface`, the canvas or depth with which the radius was tested."""
    at = ["scene", "method", "depth_mode", "resolution"]
    radius = rows.assign(px=column(rows, "radius_px"))
    budgets = radius[radius.radius == "budget"].drop_duplicates(at).set_index(at).px
    budget = column(rows, "budget_px").fillna(rows[at].join(budgets, on=at).px if len(budgets) else NONE)
    over = radius.px / budget
    return rows.assign(
        published=rows.radius == "published",
        factor=[over[i] if r == "published" else 1.0 if r in ("", "budget") else float(r) for i, r in rows.radius.items()],
        surface=[SURFACES.get(m) or SURFACES.get(d, "fragment depth") for m, d in zip(rows.method, rows.depth_mode)])


def shares(rows, by, part, whole):
    """Returns sum of `part` / sum of `whole`, in per cent, for each value of the columns `by`."""
    sums = rows.assign(part=column(rows, part), whole=column(rows, whole)).groupby(by)[["part", "whole"]].sum()
    return 100 * sums.part / sums.whole


# ---- the lemmas

def panel_of(title, label):
    """Returns an empty panel for a share in per cent against the factor."""
    return Panel(title, Axis("radius / budget radius", low=0, high=1.1), log(label, zero=True, high=100),
                 marks=[Mark(1, "budget radius")])


def lemma_figure(lemmas):
    panel = panel_of("all radii", "violated points (%)")
    for surface, rows in groups(lemmas, "surface"):
        each = shares(rows[~rows.published], ["factor", "generator"], "violations", "points")
        panel.series.append(line_of(surface, each.groupby(level=0).max(), emphasis=surface == "fragment depth"))
        if len(published := rows[rows.published]):
            each = shares(published, ["factor", "generator"], "violations", "points").droplevel(1)
            panel.series.append(line_of(f"{surface}, published radius", each, "points"))
    close = Panel("close to 1", Axis(panel.x.label, low=CLOSE, high=2 - CLOSE), panel.y,
                  [Series(**vars(s)) for s in panel.series], panel.marks)
    return Figure(
        "radius", "Points whose pixel lacks a sample or a bound, against the radius",
        f"Lemmas 1 and 2 at {grouped(total(lemmas, 'points'))} points of triangles that aim at trouble, drawn by "
        f"{lemmas.generator.nunique()} generators. A line is the largest share of any generator; of the published radius "
        "each generator is a point. On the worst canvas a pixel has a fragment only where every device that keeps the "
        "assumptions gives it one.", [panel, close])


def miss_figure(runs):
    out = Figure("radius-missed", "Missed pairs against the radius")
    for depth, of in groups(runs, "surface"):
        panel = panel_of(depth, "missed pairs (%)")
        panel.series = [line_of(scene, shares(rows, "factor", "missed", "colliding"))
                        for scene, rows in groups(of[~of.published], "scene")]
        if len(published := of[of.published]):
            panel.series.append(line_of("published radius, each scene", shares(
                published, ["factor", "scene"], "missed", "colliding").droplevel(1), "points"))
        out.panels.append(panel)
    colliding = [f"{count_cell(rows.iloc[-1], 'colliding')} in {scene}" for scene, rows in groups(runs, "scene")]
    out.caption = (f"FAR with oriented boxes: colliding pairs that culling loses, of {listed(colliding)}. "
                   f"n = {counted(len(runs), 'run', 'runs')}, one at each point.")
    return out


def lemma_table(lemmas):
    out = Table("radius", "Violated points at the published and at the budget radius, and the least factor on the budget "
                "from which on none is, of every generator; those that violate nothing at either radius are one row",
                columns(["depth", "generator"], ["points", "published", "budget", "least factor",
                                                 "published: farthest outside (px)"]))
    clean = {}  # per surface: points and least factors of generators without a violation
    for (surface, generator), rows in groups(lemmas, ["surface", "generator"]):
        published, others = rows[rows.published], rows[~rows.published]
        budget, bad = others[others.factor == 1], others.factor[column(others, "violations") > 0].max()
        safe = others.factor[~(others.factor <= bad)].min()
        far = column(published, "largest_px").fillna(math.inf).max()
        counts = [grouped(total(of, name)) if len(of) else "-" for of, name in (
            (budget, "points"), (published, "violations"), (budget, "violations"))]
        row = [surface, generator, *counts, f"{safe:.4g}" if safe == safe else "-",
               rounded(max(0.0, far)) if len(published) else "-"]
        if counts[1:] == ["0", "0"] and row[-1] == "0" and safe == safe:
            clean.setdefault(surface, []).append((total(budget, "points"), safe))
        else:
            out.rows.append(row)
    for surface, of in clean.items():
        least = sorted({f"{safe:.4g}" for _, safe in of}, key=float)
        out.rows.append([surface, f"{counted(len(of), 'other', 'others')}, all points of them", grouped(sum(n for n, _ in of)),
                         "0", "0", " to ".join(least[:1] + least[-1:][:len(least) - 1]), "0"])
    return out


def add_lemmas(chapter, lemmas):
    """Adds violations of the lemmas at the budget radius and above, and at the published radius. With fragment depth the lemmas
    are proved, so each violation is reported as broken, even if the row has no promise. Rows for which breaks() is true are not
    reported again, since add_promises() reports them."""
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
    for surface, rows in groups(lemmas[lemmas.published], "surface"):
        low, high = (f"{end(rows.factor):.4f}" for end in (min, max))
        chapter.find(f"The published radius, {low if low == high else low + ' to ' + high} of the budget, {surface}: "
                     f"{of_rows(rows, 'violations', 'points')} points are violated, "
                     f"{grouped(total(rows, 'no_sample'))} of them without a sample.")


# ---- placements

def with_placements(rows):
    """Returns the rows with more columns: patches, the scene that they come from; contact; side, in px; bits, the subpixel
    bits to which corners are snapped (0: not snapped)."""
    words = [re.fullmatch(r"(.*)@(\w+):([^:]*):.*", scene).groups() for scene in rows.scene]
    return rows.assign(patches=[w[0] for w in words], contact=[w[1] for w in words], side=[float(w[2]) for w in words],
                       bits=[int(m.removeprefix("far-snapped-")) if m.startswith("far-snapped-") else 0
                             for m in rows.method])


def bits_text(bits):
    return f"{bits} subpixel bits" if bits > 0 else "corners not snapped"


def rate_of_rows(rows):
    return rate_text(total(rows, "missed_placements"), total(rows, "colliding_placements"))


def add_headline(chapter, runs, placements):
    """Adds a finding: how often the published radius misses pairs in scenes that were not constructed against it, and how often
    in constructed scenes. This finding comes first, since all others are about constructed points."""
    published = runs[runs.published & (runs.depth_mode == "fragment")]
    constructed = published[published.scene == "pixel-corners"]
    natural = published[published.scene != "pixel-corners"]
    if len(natural):
        of, lost = of_rows(constructed, "missed", "colliding"), total(natural, "missed")
        rest = ("" if constructed.empty else
                f"; its failure end to end rests on the constructed pixel-corners, where it missed {of}"
                if lost == 0 and total(constructed, "missed") else
                f"; on the constructed pixel-corners it missed {of} here{not_snapped(constructed)}")
        chapter.find(f"On scenes that were not constructed against it, the published radius missed {missed_of(natural)} "
                     f"colliding pairs in {counted(len(natural), 'run', 'runs')} with fragment depth{rest}.")
        # If smaller radii miss no pair either, these scenes do not show that the radius is needed.
        smaller = runs[(runs.factor == 0.9) & (runs.depth_mode == "fragment")]
        bare = runs[(runs.factor == 0) & (runs.depth_mode == "fragment")]
        if len(smaller) and len(bare):
            chapter.find(f"Pairs at risk in these scenes, views and pixels: {of_rows(smaller, 'missed', 'colliding')} are "
                         f"missed with 0.9 of the budget radius, and {grouped(total(bare, 'missed'))} without a ball.")
    said = []
    for bits, rows in groups(placements[placements.published], "bits"):
        longest = rounded(column(rows, "largest_miss_px").max())
        more = f", the longest of them {longest} px long," if total(rows, "missed") else ""
        said.append(f"{rate_of_rows(rows)}{more} with {bits_text(bits)}")
    if said:
        chapter.find(f"Of patches placed into each other at random, the published radius missed something in {listed(said)}.")
    # Smaller radii should miss pairs in the same placements. Otherwise a rate of 0 shows nothing.
    words = [f"at {factor:.4g} of the budget in {of_rows(rows, 'missed_placements', 'colliding_placements')}"
             for factor, rows in groups(placements[~placements.published & (placements.factor < 1)], "factor")]
    if words:
        chapter.find(f"Smaller radii miss something in such placements: {listed(words)}.")


def placement_figure(placements):
    """Draws the rate of placements with a miss against the radius, with its interval, for each size of triangles. Shows
    placements with one number of subpixel bits: the most frequent number."""
    bits = max(groups(placements, "bits"), key=lambda of: total(of[1], "placements"))[0]
    rows = placements[(placements.bits == bits) & np.isfinite(placements.factor)]
    panel = panel_of("", "placements with a miss (%)")
    panel.x.low = 0.45
    for side, here in groups(rows[column(rows, "colliding_placements") > 0], "side"):
        rates = {factor: rate_of(total(of, "missed_placements"), total(of, "colliding_placements"))
                 for factor, of in groups(here, "factor")}
        values, low, high = zip(*((100 * rate.value, 100 * rate.low, 100 * rate.high) for rate in rates.values()))
        panel.series += [Series(f"sides of {side:.4g} px", list(rates), list(values), y_low=list(low),
                                y_high=list(high))] * (len(rates) > 1)
    return Figure(
        "radius-placements", "How often FAR misses something in random placements, by radius",
        "FAR with oriented boxes and fragment depth in three views, on placements of two patches of triangles, each decided "
        "by exact predicates: of those in which a pair collides, those in which one is missed, with the 95 % interval of "
        f"Clopper and Pearson (where none is missed, up to its upper bound). {bits_text(bits).capitalize()}. The published "
        f"radius is the last point below 1. n = {counted(total(rows, 'placements'), 'placement', 'placements')}; what was "
        "measured with other bits and resolutions is in the table.", [panel] if panel.series else [])


def placement_table(placements):
    out = Table("radius-placements", "Random placements in which FAR misses a colliding pair, of those in which one collides, of "
                "both kinds of patches and of contacts together. In brackets the rate with its 95 % interval, or the 95 % bound",
                columns(["radius"], ["side (px)", "subpixel bits", "resolution", "placements", "with a miss", "missed pairs",
                                     "largest miss (px)"]))
    for (radius, bits, resolution, side), rows in groups(placements, ["radius", "bits", "resolution", "side"]):
        out.rows.append([
            radius, rounded(side), str(bits) if bits else "not snapped", str(resolution), grouped(total(rows, "placements")),
            rate_of_rows(rows).replace(", 95 % interval ", "; ").replace("95 % bound: ", ""),
            of_rows(rows, "missed", "colliding"),
            rounded(column(rows, "largest_miss_px").max()) if total(rows, "missed") else "-"])
    return out


# ---- pairs

def add_pairs(chapter, pairs):
    """Adds estimated rates of misses for pairs that were drawn from strata. A rate is the probability of the stratum times the
    share of placements with a miss. The probability is a sum over three views, so a placement in the strata of two views counts
    twice. The estimate is therefore too large by a factor of at most 1 + 2 corner_px."""
    out = Table("radius-pairs", "Estimated rate of placements of two single triangles in which FAR misses them: the "
                "probability of the stratum from which they are drawn, times the share with a miss, with its 95 % interval, or "
                "the 95 % bound. Misses of smaller radii are in other placements too",
                columns(["radius", "snapped to (bits)"], ["side (px)", "stratum, times as wide", "its probability", "with a miss",
                                                          "rate", "interval", "one in"]))
    said = []
    for (radius, bits, side, contact), rows in groups(pairs, ["radius", "bits", "side", "contact"]):
        px, cosine = (column(rows, name).max() for name in ("corner_px", "corner_cosine"))
        inside = 1 if contact == "pair0" else 6 * px ** 2 * (4 * math.acos(cosine) / math.pi) ** 2
        missed, colliding = total(rows, "missed_placements"), total(rows, "colliding_placements")
        rate = rate_of(missed, colliding)
        value, low, high = (rounded(inside * x, 2) for x in (rate.value, rate.low, rate.high))
        times = f"{1 / (inside * (rate.value or rate.high)):.2g}"
        out.rows.append([
            radius, str(bits) if bits else "not snapped" if rows.device.iloc[0] == "native" else rows.device.iloc[0],
            rounded(side), contact[4:] if inside < 1 else "all", rounded(inside, 2), of_all(missed, colliding), value,
            f"{low} to {high}" if missed else f"at most {high}", times if missed else f"over {times}"])
        if radius == "published" and bits > 3 and contact == "pair1" and side == 2.0 ** -bits and missed:
            said.append(f"one in {times} with {bits_text(bits)}")
    if said:
        chapter.find("Of single triangles whose sides are a subpixel long, placed into each other at random, the published "
                     f"radius misses an estimated {listed(said)}.")
    chapter.tables.append(out)


def fill(chapter, study):
    rows = with_axes(study.rows)
    lemma = rows.method.str.startswith("lemma")
    placed = ~lemma & rows.scene.str.contains("@crossing:|@grazing:")
    paired = ~lemma & rows.scene.str.contains("@pair[0-9]:")
    lemmas, placements, pairs = rows[lemma], with_placements(rows[placed]), with_placements(rows[paired])
    runs = rows[~lemma & ~placed & ~paired]
    lemmas = lemmas.assign(generator=[scene.split(":")[1] for scene in lemmas.scene])
    add_headline(chapter, runs, placements)
    add_promises(chapter, study)
    add_lemmas(chapter, lemmas)
    if len(lemmas):
        chapter.figures.append(lemma_figure(lemmas))
        chapter.tables.append(lemma_table(lemmas))
    if len(runs):
        chapter.figures.append(miss_figure(runs))
    if len(placements):
        chapter.figures.append(placement_figure(placements))
        chapter.tables.append(placement_table(placements))
    if len(pairs):
        add_pairs(chapter, pairs)
