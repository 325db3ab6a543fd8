"""Missed pairs against resolution and against the candidates that are left, of FAR and every form of CULLIDE; and a
picture of CULLIDE beside FAR where CULLIDE misses something."""
from frame import *  # noqa: F403

OURS = ("FAR (OBB)", "FAR pairs")
SHOWN = ("", ", one round", ", one round, conservative", ", one round, all views, conservative")  # forms with lines
LEAST_PIXELS = 128  # a picture with fewer shows little more than misses
COUNTS = {"colliding pairs": "colliding", "missed pairs": "missed", "of them penetrating": "missed_penetrating",
          "colliding triangles": "colliding_triangles", "missed triangles": "missed_triangles",
          "kept triangles": "kept_triangles", "candidates": "candidates"}


def with_groups(rows):
    """Rows with their scene without its seed, their form without the size, and whether they have a size; `own` are
    those of the first seed of a group, which is the scene's own."""
    rows = rows.assign(group=rows.scene.map(scene_base), sized=rows.method.str.contains("@"),
                       form=[contestant(r._replace(method=r.method.split(" @")[0])) for r in rows.itertuples()])
    return rows.assign(own=rows.scene == rows.groupby("group").scene.transform("first"))


def family_of(method):
    """Whether it is `cullide`, `quick-cullide` or `s-cullide` in any form."""
    return "cullide" in method


def family(rows):
    return rows.method.map(family_of).astype(bool)


class Family:
    """The forms of CULLIDE (or S-CULLIDE, which tests objects against themselves, where FAR was not measured), at the
    scenes and resolutions that all of them have, by missed pairs and then by candidates. rival: FAR there, and what it
    leaves."""

    def __init__(self, rows, own):
        self.name, rival = ("S-CULLIDE", "FAR pairs") if own else ("CULLIDE", "FAR (OBB)")
        rows = rows[~rows.sized].drop_duplicates(["contestant", "scene", "resolution"])
        rows = rows.set_index(["scene", "resolution"], drop=False)
        of = rows[family(rows) & (rows.method.str.startswith("s-cullide") == own)]
        forms, rivals = dict(list(of.groupby("contestant"))), rows[rows.contestant == rival]
        common = sorted(set.intersection(*(set(f.index) for f in forms.values()))) if forms else []
        self.rival = rival if common and all(at in rivals.index for at in common) else ""
        self.rival_candidates = total(rivals.loc[common], "candidates") if self.rival else 0
        self.forms = {name: rows.loc[common] for name, rows in forms.items()}
        self.forms = dict(sorted(self.forms.items(), key=lambda form: (
            total(form[1], "missed"), total(form[1], "candidates"))))


def families(rows):
    return [f for f in (Family(rows, False), Family(rows, True)) if f.forms]


def value_or_spread(values):
    """The value if all are equal, else the median with the least and the most."""
    return rounded(values[0]) if len(set(values)) == 1 else spread(values)


def colliding_of(group):
    """A value for each seed."""
    return value_or_spread([number(next(rows.itertuples()), "colliding") for _, rows in by(group, "scene")])


# ---- figures

def add_lines(panel, group, seeds):
    """Missed pairs of each contestant: the median over the seeds at each resolution; for several seeds also the
    least and the most."""
    ends = Series("least and most of the seeds", style="points")
    for name, rows in by(group, "contestant"):
        line = Series(name, emphasis=name in OURS)
        for resolution, here in rows.groupby("resolution"):
            missed = list(column(here, "missed"))
            if len(missed) < seeds:  # the median would be over fewer scenes
                continue
            line.x.append(resolution)
            line.y.append(median(missed))
            if min(missed) != max(missed):
                ends.x += [resolution] * 2
                ends.y += [min(missed), max(missed)]
        if line.x:
            panel.series.append(line)
    if ends.x:
        panel.series.append(ends)


def missed_figure(rows, name, title, shows):
    """rows: those that are wanted, with `all_colliding` of all seeds."""
    out, of, runs, several = Figure(name, title), [], 0, False
    for group, here in by(rows, "group"):
        seeds = int(here.seeds.iloc[0])
        panel = Panel(group + (f" ({seeds} seeds)" if seeds > 1 else ""), log("resolution (px)"),
                      log("missed pairs", zero=True))
        wanted = here[~here.sized & (here.resolution > 0) & here.wanted]
        add_lines(panel, wanted, seeds)
        if panel.series:
            runs, several = runs + len(wanted), several or seeds > 1
            of.append(f"{group} {colliding_of(here)}")
            out.panels.append(panel)
    out.caption = f"{shows} n = {counted(runs, 'run', 'runs')}. Colliding pairs: {'; '.join(of)}."
    if several:
        out.caption += (" Where a scene was drawn with several seeds, lines are medians over the seeds and points the "
                        "least and the most; what was measured with one seed alone is in the table.")
    return out


def form_group(row):
    """The series of a run in the figure of all forms; "" for radii that promise nothing."""
    if not family_of(row.method):
        ours = {"far": "FAR, boxes and exact offsets", "far-pairs": "FAR pairs"}
        return "" if row.radius == "published" else ours.get(row.method, "")
    forms = {", one round": "as published", ", one round, conservative": "conservative", SHOWN[-1]: "strict"}
    return "CULLIDE, " + forms.get(row.contestant.partition("CULLIDE")[2], "other forms")


def kept_figure(own):
    """Misses against the candidates left; each point is a run."""
    out = Figure("accuracy-kept", "What every form misses, against the candidates that it leaves",
                 "Each point is a run at one resolution; below and to the left is better. The mark is what boxes alone "
                 "leave (exact), which miss nothing and cull nothing. No form is left out: the strict form "
                 "is conservative, and all views have to clear a triangle; others are those until nothing changes, "
                 "in both directions of each axis, where all views have to clear, with objects alone, and "
                 "Quick-CULLIDE. "
                 "On one object, CULLIDE is S-CULLIDE. Scenes that are drawn at random have their own seed.")
    rows = own[~own.sized & (column(own, "colliding") > 0) & (column(own, "candidates") > 0)]
    rows = rows.assign(series=[form_group(row) for row in rows.itertuples()])
    for group, here in by(rows, "group"):
        boxes = [row.candidates / row.colliding for row in here[here.method == "exact"].itertuples()]
        here = here[here.series != ""]
        out.panels.append(Panel(
            group, log("candidates / colliding pairs", zero=True), log("missed pairs (%)", zero=True, high=100),
            [series_of(name, of, lambda row: row.candidates / row.colliding,
                       lambda row: share(number(row, "missed"), row.colliding), style="points")
             for name, of in sorted(by(here, "series"))], [Mark(at, "boxes alone (exact)") for at in boxes]))
    out.caption += f" n = {counted((rows.series != '').sum(), 'run', 'runs')}."
    return out


def size_figure(own):
    """Misses by the size of triangles, over all scenes that have the size."""
    out, runs = Figure(
        "accuracy-size", "Missed pairs against the size of triangles",
        "The resolution is chosen so that a triangle that can take part covers 1, 4 or 16 pixels, on average over the "
        "triangles and the axes. Scenes that are drawn at random have their own seed. Other forms are in the table."), 0
    for group, here in by(own[own.sized & own.form.isin([OURS[0], *(f"CULLIDE{form}" for form in SHOWN)])], "group"):
        forms = list(here.groupby("form"))
        if max(len(rows) for _, rows in forms) == 1:
            out.caption += f" Not drawn, since one size alone fits: {group}."
            continue
        runs += len(here)
        out.panels.append(Panel(group, log("mean pixels of a triangle"), log("missed pairs", zero=True), [
            series_of(name, rows, "mean_pixels", "missed", emphasis=name == OURS[0]) for name, rows in forms]))
    out.caption += f" n = {counted(runs, 'run', 'runs')}."
    return out


def figures_of(rows):
    seeds, shown = rows.groupby("group").scene.transform("nunique"), [f"CULLIDE{form}" for form in SHOWN[1:]]
    drawn = rows.assign(contestant=rows.contestant.str.replace("^S-CULLIDE", "CULLIDE", regex=True))
    own = rows[rows.own]
    figures = [
        missed_figure(drawn.assign(seeds=seeds, wanted=drawn.contestant.isin([*OURS, *shown])), "accuracy",
                      "Missed colliding pairs against resolution",
                      "FAR, and CULLIDE as published and in the two forms that miss less. All other forms are in the "
                      "next figure. On one object, CULLIDE is S-CULLIDE."), kept_figure(own), size_figure(own)]
    return [figure for figure in figures if figure.panels]


# ---- tables

def short_table(rows):
    plain = rows[~rows.sized]
    pixels = resolutions(rows)
    out = Table("accuracy", "Missed pairs by resolution in px. Of scenes that are drawn with several seeds the median, "
                "with the least and the most", columns(["scene", "method"], ["colliding", *map(str, pixels)]))
    for group, here in by(rows, "group"):
        colliding, seeds = colliding_of(here), here.scene.nunique()
        for name, of in by(plain[plain.group == group], "contestant"):
            out.rows.append([group, name, colliding])
            for resolution in pixels:
                missed = list(column(of[of.resolution == resolution], "missed"))
                # A value measured with one of several seeds is no median.
                one = len(missed) == 1 < seeds
                out.rows[-1].append((value_or_spread(missed) if missed else "-") + (" (own seed)" if one else ""))
    return out


def forms_table(rows):
    """The forms of CULLIDE where all of them were measured."""
    out = Table("accuracy-forms", "Forms of CULLIDE and S-CULLIDE that cull triangles, at the scenes and resolutions "
                "that all of a family have: missed pairs, and candidates that are left",
                columns(["form"], ["runs", "missed pairs", "penetrating", "candidates"]))
    for of in families(rows):
        for name, runs in of.forms.items():
            out.rows.append([name, grouped(len(runs)), missed_of(runs),
                             grouped(total(runs, "missed_penetrating")), grouped(total(runs, "candidates"))])
        if of.rival:
            out.rows.append([of.rival + ", there", grouped(len(runs)), "-", "-", grouped(of.rival_candidates)])
    return out


def long_table(rows):
    return table_of_rows("accuracy-all", "All points", rows, {
        "scene": "=scene", "method": "=contestant", "resolution": resolution_cell("auto"),
        "resolution by size": "~resolution_count", "mean pixels of a triangle": "~mean_pixels",
        "radius px": "~radius_px", **COUNTS})


# ---- findings

def add_forms(chapter, rows):
    """Adds what each form of a family misses and leaves."""
    for of in families(rows):
        said = [f"{name} {missed_of(runs)}, leaving "
                f"{grouped(total(runs, 'candidates'))} candidates" for name, runs in of.forms.items()]
        rival = f"; {of.rival} leaves {grouped(of.rival_candidates)} there" if of.rival else ""
        runs = next(iter(of.forms.values()))
        if len(said) > 1:
            chapter.find(f"Missed by the forms of {of.name}, in {counted(len(runs), 'run', 'runs')} each: "
                         f"{'; '.join(said)}{rival}.")


def add_courses(chapter, rows, forms):
    """Adds how the misses of a method that promises nothing change from the fewest pixels to the most."""
    for group, here in by(rows[rows.own & (rows.resolution > 0)], "group"):
        for form in forms:
            of = here[here.contestant == form].sort_values("resolution", kind="stable")
            if of.resolution.nunique() < 2:
                continue
            first = next(of.itertuples())
            last = next(of[of.resolution == of.resolution.max()].itertuples())
            before, after = number(first, "missed"), number(last, "missed")
            more = (", so more pixels made it worse" if after > before else
                    ", so more pixels did not help" if after == before > 0 else "")
            chapter.find(f"{form} on {first.scene}: {of_all(before, number(first, 'colliding'))} colliding pairs are "
                         f"missed at {first.resolution} px and {grouped(after)} at {last.resolution} px{more}.")


def add_sizes(chapter, rows):
    """Adds the misses of each form at resolutions chosen by the size of triangles."""
    sized = rows[rows.sized]
    for size, here in sized.groupby([float(m.split("@")[1].split("px")[0]) for m in sized.method]):
        words = [f"{name} misses {of_rows(of, 'missed', 'colliding')}" for name, of in here.groupby("form")
                 if name in ("CULLIDE, one round", "FAR (OBB)", "CULLIDE, one round, conservative")]
        if words:
            chapter.find(f"Where a triangle covers {rounded(size)} {'pixel' if size == 1 else 'pixels'} on average: "
                         f"{'; '.join(words)}. The forms of CULLIDE draw the same pixels without a ball.")


def add_sums(chapter, rows):
    """Adds the sums over all rows of methods that promise nothing and are no form of CULLIDE."""
    others = rows[~rows.index.isin(promising(rows).index) & ~family(rows) & (rows.method != "exact")]
    for name, runs in others.groupby("contestant"):
        chapter.find(f"{name} promises nothing, and missed {missed_of(runs)} colliding pairs in "
                     f"{counted(len(runs), 'run', 'runs')} here"
                     f"{not_snapped(runs) if 'published radius' in name else ''}.")


def pictures_of(rows):
    """CULLIDE beside FAR on a scene, at a resolution where both were measured and CULLIDE missed something. Meshes
    are easier to see than slivers."""
    clear = rows[rows.resolution >= LEAST_PIXELS]
    fars = clear[(clear.method == "far") & (clear.offset == "obb") & (clear.radius == "budget")]
    best = None
    for row in clear[(clear.method == "cullide") & (column(clear, "missed") > 0)].itertuples():
        rank = 0 if row.scene.startswith("two-bunnies") else 1
        far = next(fars[(fars.scene == row.scene) & (fars.resolution == row.resolution)].itertuples(), None)
        better = best is None or rank < best[0] or (row.scene == best[1].scene and
                                                    row.resolution < best[1].resolution)
        best = (rank, row, far) if better and far else best
    if best is None:
        return []
    _, row, far = best
    return [Picture(
        "accuracy-compare",
        f"CULLIDE and FAR on {row.scene} at {row.resolution} px. Missed pairs are drawn in the colour that nothing "
        "else has. What collides and was found is coloured, what was kept and does not collide is faint.",
        [row.scene, "--compare", f"cullide:{row.resolution},far:{row.resolution}", "--size", "900x760"],
        [(name, value(r, "missed"), value(r, "colliding")) for name, r in (("CULLIDE", row), ("FAR", far))])]


def fill(chapter, study):
    rows = with_groups(study.rows)
    add_promises(chapter, study)
    add_forms(chapter, rows)
    add_courses(chapter, rows, [prefix + form for prefix in ("CULLIDE", "S-CULLIDE") for form in SHOWN[1:3]])
    add_sizes(chapter, rows)
    add_sums(chapter, rows)
    chapter.limits = [
        "Scenes are few and still, so that no miss is no proof; the proof is in docs/reliability.md.",
        "Pairs of one scene do not collide independently of each other, and scenes were chosen by hand, so that shares "
        "have no intervals.",
        "FAR is measured between objects; against themselves objects are tested by S-CULLIDE and FAR pairs alone.",
        "How much CULLIDE misses depends on how a device samples: other devices give other counts.",
        "The published radius may miss nothing in these scenes and pairs in others (see the study of the radius)."]
    add_gaps(chapter, study)
    if len(rows):
        chapter.figures = figures_of(rows)
        chapter.tables = [forms_table(rows), short_table(rows), long_table(rows)]
        chapter.pictures = pictures_of(rows)
