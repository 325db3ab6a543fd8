"""Plots the missed pairs of FAR and of every form of CULLIDE, against the resolution and against the number of candidates.
Adds a picture that shows CULLIDE beside FAR in a scene where CULLIDE misses pairs."""
from frame import *  # noqa: F403

OURS = ("FAR (OBB)", "Boxes")
SHOWN = (", one round", ", one round, conservative", ", one round, all views, conservative")  # forms that are drawn as lines
SIZED = ("FAR (OBB)", *(f"CULLIDE{form}" for form in SHOWN))  # reported for each size of triangles
LEAST_PIXELS = 128  # a picture with fewer pixels shows little besides the misses


def with_groups(rows):
    """Returns the rows with more columns: `group`, the scene without its seed; `form`, the contestant without a size;
    `sized`, whether the row has a size; `own`, whether the row is of the first seed of its group."""
    rows = rows.assign(group=rows.scene.map(scene_base), sized=rows.method.str.contains("@"),
                       form=[without_size(row) for row in rows.itertuples()])
    return rows.assign(own=rows.scene == rows.groupby("group").scene.transform("first"))


def colliding_of(group):
    """Returns the number of colliding pairs of a scene; for several seeds the median with the least and the most."""
    values = [number(next(rows.itertuples()), "colliding") for _, rows in by(group, "scene")]
    return rounded(values[0]) if len(set(values)) == 1 else spread(values)


# ---- figures

def lines_of(group, seeds):
    """Returns the missed pairs of each contestant by resolution: the median over the seeds, the least and the most."""
    out = []
    for name, rows in by(group, "contestant"):
        missed = rows.assign(missed=column(rows, "missed")).groupby("resolution").missed.agg(["median", "min", "max", "count"])
        missed = missed[missed["count"] == seeds]  # else the median would be over fewer scenes
        ends = ([], []) if seeds == 1 else (list(missed["min"]), list(missed["max"]))
        out += [Series(name, list(missed.index), list(missed["median"]), emphasis=name in OURS, y_low=ends[0],
                       y_high=ends[1])] * bool(len(missed))
    return out


def missed_figure(rows):
    out, of, runs = Figure("accuracy", "Missed colliding pairs against resolution"), [], 0
    rows = rows.assign(contestant=rows.contestant.str.replace("^S-CULLIDE", "CULLIDE", regex=True))
    shown = rows.contestant.isin([*OURS, *(f"CULLIDE{form}" for form in SHOWN)])
    for group, here in by(rows, "group"):
        seeds, wanted = here.scene.nunique(), here[~here.sized & (here.resolution > 0) & shown[here.index]]
        if series := lines_of(wanted, seeds):
            runs += len(wanted)
            of.append(f"{group} {colliding_of(here)}")
            out.panels.append(Panel(group + (f" ({seeds} seeds)" if seeds > 1 else ""), log("resolution (px)"),
                                    log("missed pairs", zero=True), series))
    out.caption = ("FAR, and CULLIDE as published and in the two forms that miss less. All other forms are in the next "
                   f"figure. On one object, CULLIDE is S-CULLIDE. n = {counted(runs, 'run', 'runs')}. Colliding pairs: "
                   f"{'; '.join(of)}. Where a scene was drawn with several seeds, lines are medians over the seeds, and "
                   "bars go from the least to the most.")
    return out


def form_group(row):
    """Returns the name of a run's series in the figure of all forms; "" for the published radius."""
    if "cullide" not in row.method:
        ours = {"far": "FAR, boxes and exact offsets", "boxes": "Boxes"}
        return "" if row.radius == "published" else ours.get(row.method, "")
    return "CULLIDE, " + dict(zip(SHOWN, ("as published", "conservative", "strict"))).get(
        row.contestant.partition("CULLIDE")[2], "other forms")


def kept_figure(rows):
    """Draws misses against the candidates that are left. Each point is a run."""
    out = Figure("accuracy-kept", "What every form misses, against the candidates that it leaves",
                 "Each point is a run at one resolution; below and to the left is better. The mark is what boxes alone "
                 "leave (exact), which miss nothing and cull nothing. No form is left out: the strict form "
                 "is conservative, and all views have to clear a triangle; others are those until nothing changes, "
                 "in both directions of each axis, where all views have to clear, with objects alone, and "
                 "Quick-CULLIDE. On one object, CULLIDE is S-CULLIDE. Scenes that are drawn at random have their own seed.")
    rows = rows[rows.own & ~rows.sized & (column(rows, "colliding") > 0) & (column(rows, "candidates") > 0)]
    rows = rows.assign(series=[form_group(row) for row in rows.itertuples()])
    for group, here in by(rows, "group"):
        boxes = [row.candidates / row.colliding for row in here[here.method == "exact"].itertuples()]
        out.panels.append(Panel(
            group, log("candidates / colliding pairs", zero=True), log("missed pairs (%)", zero=True, high=100),
            [series_of(name, of, lambda row: row.candidates / row.colliding,
                       lambda row: share(number(row, "missed"), row.colliding), style="points")
             for name, of in sorted(by(here[here.series != ""], "series"))], [Mark(at, "boxes alone (exact)") for at in boxes]))
    out.caption += f" n = {counted((rows.series != '').sum(), 'run', 'runs')}."
    return out


# ---- tables and findings

def forms_table(chapter, rows):
    """Returns a table of the forms of CULLIDE, then of S-CULLIDE (which tests objects against themselves), at the scenes
    and resolutions that all forms have. Sorted by missed pairs, then by candidates. Adds which form misses least."""
    out = Table("accuracy-forms", "Forms of CULLIDE and S-CULLIDE, at the scenes and resolutions that all of a family have: "
                "missed pairs, and candidates that are left", columns(["form"], ["runs", "missed pairs", "penetrating",
                                                                                 "candidates"]))
    rows = rows[~rows.sized].drop_duplicates(["contestant", "scene", "resolution"])
    rows = rows.set_index(["scene", "resolution"], drop=False)
    for start, rival in (("cullide|quick-cullide", "FAR (OBB)"), ("s-cullide", "Boxes")):
        forms = dict(list(rows[rows.method.str.match(start)].groupby("contestant")))
        common = sorted(set.intersection(*(set(form.index) for form in forms.values()))) if forms else []
        forms = [(name, form.loc[common]) for name, form in forms.items()]
        forms.sort(key=lambda form: (total(form[1], "missed"), total(form[1], "candidates")))
        far = rows[rows.contestant == rival]
        exact = rows[rows.method == "exact"].drop_duplicates("scene")
        boxes = dict(zip(exact.scene, column(exact, "candidates")))
        of_boxes = sum(boxes.get(scene, NONE) for scene, _ in common)  # rows of `exact` have no resolution
        count = counted(len(forms), "form", "forms")
        if common and all(at in far.index for at in common):
            forms.append((rival + ", there", far.loc[common]))
        said = [f"{name}: {missed_of(runs)} missed, {grouped(total(runs, 'candidates'))} candidates left"
                for at, (name, runs) in enumerate(forms) if at == 0 or name.endswith((", one round", ", there"))]
        if common:
            chapter.find(f"The best of {count} of {start.split('|')[0].upper()}, the form as published, and FAR, at the same "
                         f"scenes and resolutions: {'; '.join(said)}.")
        if of_boxes > 0:
            taken = [f"{rounded(share(of_boxes - total(runs, 'candidates'), of_boxes), 2)} % of them with "
                     f"{name.removesuffix(', there')}" for name, runs in forms if name in (forms[0][0], "FAR (OBB), there")]
            chapter.find(f"Boxes of triangles alone leave {grouped(of_boxes)} candidates there; drawing takes away "
                         f"{listed(taken)}.")
        out.rows += [[name, grouped(len(runs)), missed_of(runs), grouped(total(runs, "missed_penetrating")),
                      grouped(total(runs, "candidates"))] for name, runs in forms]
        if of_boxes > 0:
            out.rows.append(["boxes of triangles alone, there", grouped(len(common)),
                             of_all(0, total(forms[0][1], "colliding")), "0", grouped(of_boxes)])
    return out


def add_sizes(chapter, rows):
    """Adds the misses of each form at resolutions chosen by the size of triangles."""
    sized = rows[rows.sized & rows.form.isin(SIZED)]
    for size, here in sized.groupby([float(m.split("@")[1].split("px")[0]) for m in sized.method]):
        words = [f"{name} misses {of_rows(of, 'missed', 'colliding')}" for name, of in here.groupby("form")]
        chapter.find(f"Where a triangle covers {rounded(size)} {'pixel' if size == 1 else 'pixels'} on average: "
                     f"{'; '.join(words)}.")


def add_sums(chapter, rows):
    """Adds the sums over all rows of methods that promise nothing and are no form of CULLIDE."""
    others = rows[~rows.index.isin(promising(rows).index) & ~rows.method.str.contains("cullide") & (rows.method != "exact")]
    for name, runs in others.groupby("contestant"):
        chapter.find(f"{name} promises nothing, and missed {missed_of(runs)} colliding pairs in "
                     f"{counted(len(runs), 'run', 'runs')} here{not_snapped(runs) if 'published radius' in name else ''}.")


def pictures_of(rows):
    """Returns a picture that compares CULLIDE and FAR on a scene, at the least resolution where CULLIDE missed a pair and FAR was
    measured. Prefers meshes, which are easier to see than slivers."""
    clear = rows.assign(missed=column(rows, "missed"))[rows.resolution >= LEAST_PIXELS]
    fars = clear[(clear.method == "far") & (clear.offset == "obb") & (clear.radius == "budget")]
    both = clear[(clear.method == "cullide") & (clear.missed > 0)].merge(
        fars[["scene", "resolution", "missed"]], on=["scene", "resolution"], suffixes=("", "_far"))
    both = both.assign(rank=~both.scene.str.startswith("two-bunnies")).sort_values(["rank", "resolution"], kind="stable")
    return [Picture(
        "accuracy-compare", "What CULLIDE misses, and FAR beside it",
        f"Both on {row.scene} at {row.resolution} px, where CULLIDE misses {of_all(row.missed, row.colliding)} colliding "
        f"pairs and FAR {grouped(row.missed_far)}. This is the form that misses most; the table names the others. Missed "
        "pairs are red. What collides and was found is coloured, what was kept and does not collide is faint.",
        [row.scene, "--compare", f"cullide:{row.resolution},far:{row.resolution}", "--size", "900x760"])
        for row in both.head(1).itertuples()]


def fill(chapter, study):
    rows = with_groups(study.rows)
    add_promises(chapter, study)
    forms = forms_table(chapter, rows)
    add_sizes(chapter, rows)
    add_sums(chapter, rows)
    if len(rows):
        chapter.figures, chapter.tables = [missed_figure(rows), kept_figure(rows)], [forms]
        chapter.pictures = pictures_of(rows)
