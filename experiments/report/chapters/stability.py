"""Missed pairs and kept triangles in families of scenes that go to an extreme, such as slivers or
offsets far from the origin."""
from frame import *  # noqa: F403: a chapter uses most of it

FAMILIES = {"slivers": ("slivers", "aspect"), "mixed": ("mixed sizes", "ratio of sizes"),
            "edge-on": ("edge-on to a view", "times narrower"), "overlap": ("overlaps", "overlap (px)"),
            "gap": ("gaps", "gap (px)"), "stack": ("stacked sheets", "distance (px)"),
            "offset": ("far from the origin", "offset (px)"), "scale": ("scaled", "scale")}
STRICT = {"CULLIDE, one round, all views, conservative": "CULLIDE, strict"}
CLOTH_SELF, CLOTH_APART = "cloth against itself and a sphere", "cloth on a sphere"
LEAST_CULLED = 30  # per cent of the triangles; a family in which less is culled tests little
WHY_LITTLE = {CLOTH_SELF: "nearly every triangle of a cloth touches neighbours, which are left to exact tests"}


def extreme_of(row):
    """Returns the family of a scene, the name of the number that goes to an extreme, and the number."""
    words = row.scene.split("@")[0].split(":")
    if words[0] == "contacts":
        return *FAMILIES.get(words[1], (words[1], "")), float(words[3])
    at = float(words[2]) if len(words) > 2 else NONE
    return CLOTH_APART if "@" in row.scene else CLOTH_SELF, "stiffness (N/m)", at


def tracks_of(rows):
    """Returns triples: a family of scenes with the name of its number; a method; the method's rows by the value of the number.
    Values are in the order of the grid, from harmless to extreme. A cloth has several rows, its frames, for one value."""
    if rows.empty:
        return []
    extremes = [extreme_of(row) for row in rows.itertuples()]
    rows = rows.assign(family=[e[:2] for e in extremes], at=[e[2] for e in extremes])
    return [(family, method, dict(by(track, "at")))
            for family, of in by(rows, "family") for method, track in by(of, "contestant")]


def families_of(tracks):
    out = {}
    for family, method, places in tracks:
        out.setdefault(family, []).append((method, places))
    return out.items()


def excess(rows):
    """Returns kept triangles / colliding triangles; NaN if the rows lack one of these counts."""
    colliding = total(rows, "colliding_triangles")
    return total(rows, "kept_triangles") / colliding if colliding and column(rows, "kept_triangles").notna().any() else NONE


def number_text(x):
    """Returns a text such as 1e12 or 1e-9, as in the names of scenes."""
    return f"{x:g}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")


def missed_share(rows):
    """Returns how many per cent of the colliding pairs were missed. If the rows count pairs whose contact varies, only these
    pairs are used."""
    varies = column(rows, "varying").notna().any()
    return share(*(total(rows, name) for name in (("missed_varying", "varying") if varies else ("missed", "colliding"))))


def label(series):
    """Puts the name of each series beside the first point that reaches half of the series' height. Series that stay at 0 get one
    text with all their names."""
    still = [s for s in series if not any(y > 0 for y in s.y)]
    for s in series:
        high = max((y for y in s.y if y == y), default=0)
        at = next((i for i, y in enumerate(s.y) if y >= high / 2), 0) if s not in still else len(s.x) // 2
        names = dict.fromkeys(of.name.split(" (")[0] for of in still) if s in still else [s.name]
        s.labels = [", ".join(names) if i == at and s not in still[1:] else "" for i in range(len(s.x))]
    return series


def figure_of(tracks):
    runs = counted(sum(len(rows) for *_, places in tracks for rows in places.values()), "point", "points")
    out = Figure("stability-missed", "Missed pairs in extreme scenes", "Colliding pairs that are not found, of all whose "
                 "contact varies with the number of the family; of the cloth of all. Each number goes from a harmless "
                 "value to its extreme, in steps that are drawn at even distances. Scenes in which no such pair collides "
                 f"have no share. n = {runs}, each of 1 run.", columns=3)
    for family, methods in families_of(tracks):
        series = [Series(method, list(places), [missed_share(rows) for rows in places.values()],
                         emphasis=method.startswith("FAR")) for method, places in methods if method != "exact"]
        if any(y == y for s in series for y in s.y):
            out.panels.append(Panel(family[0], Axis(family[1], even=True), Axis("missed pairs (%)", low=0, high=100),
                                    label(series)))
    return out


def risks_of(rows, track):
    """Returns how many pairs of a track are at risk with 0.9 of the radius, and how many without a ball; NaN: not known."""
    known = [at_risk(rows, row) for row in track.itertuples()]
    return [NONE if all(x != x for x in values) else sum(x for x in values if x == x) for values in zip(*known)]


def table_of(rows, tracks):
    out = Table("stability", "Pairs in all scenes of a family together: colliding ones, and those that a method missed. "
                "At risk: pairs that are lost in the same scene, views and pixels with 0.9 of the radius of FAR, and "
                "without a ball. Where there are none, 0 missed does not show that the radius is large enough. Wrong: "
                "pairs that a library reported though they do not collide. Then the triangles that boxes and views "
                "took away, of all, and how many culling kept for each one that collides, in the first scene of the "
                "family and in its last: \"2.14 at 10\" are 2.14 triangles where what the family changes is 10",
                columns(["family", "method"], ["scenes", "colliding", "missed", "at risk, 0.9", "at risk, no ball",
                                               "wrong", "by boxes (%)", "by views (%)", "kept, first scene", "kept, last scene"]))
    for family, method, places in tracks:
        if method == "exact":
            continue
        track = pd.concat(list(places.values()))
        drawn = column(track, "views_used").notna().any()
        ends = [(at, rounded(excess(places[at]))) for at in (list(places)[0], list(places)[-1])]
        out.rows.append(
            [", ".join(word for word in family if word), method, grouped(len(track))] +
            [grouped(total(track, "colliding")), grouped(total(track, "missed"))] +
            ["-" if x != x else grouped(x) for x in risks_of(rows, track)] + [grouped(total(track, "wrong"))] +
            [rounded(x) if drawn else "-" for x in culled_shares(track)] +
            [kept if kept == "-" else f"{kept} at {number_text(at)}" for at, kept in ends])
    return out


def add_failures(chapter, rows):
    """Adds findings: how many pairs are missed or wrongly reported by methods without a promise."""
    for method, of in by(rows[~rows.index.isin(promising(rows).index) & (rows.method != "exact")], "contestant"):
        wrong = total(of, "wrong")
        more = f", and reported {counted(wrong, 'pair', 'pairs')} that do not collide" if wrong else ""
        chapter.find(f"{method} promises nothing, and missed {missed_of(of)} colliding pairs{more}.")


def add_rises(chapter, tracks):
    """Adds findings: from which value of a family on each method misses contacts that vary."""
    for family, methods in families_of(tracks):
        words = []
        for method, places in methods if family in FAMILIES.values() else []:
            if failed := {at: missed for at, rows in places.items() if (missed := missed_share(rows)) > 0}:
                words.append(f"{method} from {number_text(next(iter(failed)))} on, up to {rounded(max(failed.values()))} %")
        if words:
            chapter.find(f"{', '.join(family)}: contacts that vary are missed by {'; '.join(words)}.")


def add_power(chapter, rows, tracks, names):
    """Adds a finding in each case where 0 missed pairs prove little: a method that guarantees to miss none culled too few
    triangles, or no pair was at risk (lost with a smaller ball)."""
    for family, methods in families_of(tracks):
        little, safe = [], []
        for method, places in methods:
            of = [sum(culled_shares(r)) for r in places.values() if column(r, "views_used").notna().any()]
            if method in names and of:
                little += [method] * (max(of) < LEAST_CULLED)
                safe += [method] * (method.startswith("FAR (") and not risks_of(rows, pd.concat(list(places.values())))[0] > 0)
        if little:
            why = WHY_LITTLE.get(family[0])
            chapter.find(f"{family[0]}: {listed(little)} cannot cull {LEAST_CULLED} % of the triangles here"
                         f"{', since ' + why if why else ''}; 0 missed says little there.")
        if safe:
            chapter.find(f"{family[0]}: no pair is lost with 0.9 of the radius by {listed(safe)}, so these scenes do not "
                         "test that the radius is large enough; only pairs lost without a ball are tested.")


def fill(chapter, study):
    rows = study.rows.assign(contestant=study.rows.contestant.replace(STRICT))
    tracks = tracks_of(rows)
    add_promises(chapter, study)
    add_rises(chapter, tracks)
    add_power(chapter, rows, tracks, set(promising(rows).contestant))
    add_failures(chapter, rows)
    if tracks:
        chapter.figures, chapter.tables = [figure_of(tracks)], [table_of(rows, tracks)]
