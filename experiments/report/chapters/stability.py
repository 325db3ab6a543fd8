"""Missed pairs and kept triangles in families of scenes that go to an extreme, such as slivers or
offsets far from the origin."""
from frame import *  # noqa: F403: a chapter uses most of it


FAMILIES = {"slivers": ("slivers", "aspect"), "stack": ("stacked sheets", "distance (lengths)"),
            "mixed": ("mixed sizes", "ratio of sizes"), "offset": ("far from the origin", "offset (px)"),
            "scale": ("scaled", "scale")}
CLOTH_SELF, CLOTH_APART = "cloth against itself and a sphere", "cloth on a sphere"
LEAST_CULLED = 30  # per cent of the triangles; a family with less tests little
WHY_LITTLE = {CLOTH_SELF: "nearly every triangle of a cloth touches neighbours, which are left to exact tests"}


def extreme_of(row):
    """The family of a scene, the quantity that it takes to an extreme, and its value."""
    words = row.scene.split("@")[0].split(":")
    if words[0] == "contacts":
        at = float(words[3])
        if words[1] == "gap":
            return ("gaps", "gap (ulps)", at) if at > 0 else ("overlaps", "overlap (ulps)", abs(at))
        return *FAMILIES.get(words[1], (words[1], "")), at
    at = float(words[2]) if len(words) > 2 else NONE
    return CLOTH_APART if "@" in row.scene else CLOTH_SELF, "stiffness (N/m)", at


def tracks_of(rows):
    """Triples of a family with its axis, a method, and its rows by place: a cloth has several
    frames at one place. Families and methods in the order of the grid, places ascending."""
    if rows.empty:
        return []
    extremes = [extreme_of(row) for row in rows.itertuples()]
    rows = rows.assign(family=[e[:2] for e in extremes], at=[e[2] for e in extremes])
    return [(family, method, dict(list(track.groupby("at"))))
            for family, of in by(rows, "family") for method, track in by(of, "contestant")]


def families_of(tracks):
    out = {}
    for family, method, places in tracks:
        out.setdefault(family, []).append((method, places))
    return out.items()


def keeps(rows):
    """Whether the rows say which triangles the method keeps."""
    return bool((column(rows, "kept_triangles").notna() & (rows.method != "exact")).any())


def excess(rows):
    """Kept over colliding triangles; NaN if one of both is missing."""
    colliding = total(rows, "colliding_triangles")
    return total(rows, "kept_triangles") / colliding if keeps(rows) and colliding else NONE


def number_text(x):
    """1e12 and 1e-9, as in the names of scenes."""
    return f"{x:g}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")


def panel_of(family, methods, label):
    zero = any(0 in places for _, places in methods)
    return Panel(family[0], log(family[1], zero), log(label, zero=True, high=100))


def figures_of(tracks):
    runs = counted(sum(len(rows) for *_, places in tracks for rows in places.values()), "point", "points")
    missed = Figure("stability-missed", "Missed pairs in extreme scenes", "Colliding pairs that are not found, of all "
                    "there are. Scenes in which nothing collides " f"have no share. n = {runs}, each of 1 run.")
    kept = Figure("stability-kept", "What culling keeps in extreme scenes", "Triangles that are kept, of all; below, "
                  "those that collide: a method that misses nothing " f"cannot be below that line. n = {runs}, each of "
                  f"1 run.")
    for family, methods in families_of(tracks):
        panel = panel_of(family, methods, "missed pairs (%)")
        for method, places in methods:
            if method != "exact":
                panel.series.append(Series(method, list(places), [share(total(r, "missed"), total(r, "colliding")) for r
                                                                  in places.values()],
                                           emphasis=method.startswith("FAR")))
        if any(total(r, "colliding") for m, p in methods if m != "exact" for r in p.values()):
            missed.panels.append(panel)
        panel = panel_of(family, methods, "kept triangles (%)")
        floor = None
        for method, places in methods:
            places = {at: rows for at, rows in places.items() if keeps(rows)}
            if not places:
                continue
            of = [total(rows, "triangles") for rows in places.values()]
            ys = {name: [share(total(r, name), n) for r, n in zip(places.values(), of)]
                  for name in ("kept_triangles", "colliding_triangles")}
            panel.series.append(Series(method, list(places), ys["kept_triangles"], emphasis=method.startswith("FAR")))
            floor = floor or Series("colliding", list(places), ys["colliding_triangles"], "lines")
        if floor:
            panel.series.append(floor)
            kept.panels.append(panel)
    return [missed, kept]


def risks_of(rows, track):
    """The pairs at risk of the rows of a track, with 0.9 of the radius and without a ball; NaN: not counted."""
    known = [at_risk(rows, row) for row in track.itertuples()]
    return [NONE if all(x != x for x in values) else sum(x for x in values if x == x) for values in zip(*known)]


def short_table(rows, tracks):
    out = Table("stability", "Pairs in all scenes of a family together: colliding ones, and those that a method missed. "
                "At risk: pairs that are lost in the same scene, views and pixels with 0.9 of the radius of FAR, and "
                "without a ball. Where there are none, 0 missed does not show that the radius is large enough. Wrong: "
                "pairs that a library reported though they do not collide. Then the triangles that boxes and views "
                "took away, of all, and how many culling kept for each one that collides, in the first scene of the "
                "family and in its last: \"2.14 at 10\" are 2.14 triangles where what the family changes is 10",
                columns(["family", "method"], ["scenes", "colliding", "missed", "at risk, 0.9", "at risk, no ball",
                                               "wrong", "by boxes (%)", "by views (%)", "kept, first scene",
                                               "kept, last scene"]))
    for family, method, places in tracks:
        if method == "exact":
            continue
        track = pd.concat(list(places.values()))
        drawn = column(track, "views_used").notna().any()
        ends = [(at, rounded(excess(places[at]))) for at in (min(places), max(places))]
        out.rows.append(
            [", ".join(word for word in family if word), method, grouped(len(track))] +
            [grouped(total(track, "colliding")), grouped(total(track, "missed"))] +
            ["-" if x != x else grouped(x) for x in risks_of(rows, track)] + [grouped(total(track, "wrong"))] +
            [rounded(x) if drawn else "-" for x in culled_shares(track)] +
            [kept if kept == "-" else f"{kept} at {number_text(at)}" for at, kept in ends])
    return out


def all_table(tracks):
    out = Table("stability-all", "Every place; of cloth the sum of its frames, and the widest radius",
                columns(["family"], ["at"], ["method"], ["colliding", "missed", "wrong", "candidates", "kept triangles",
                                                         "triangles", "kept/colliding", "radius (px)", "radius (units)",
                                                         "time (ms)"]), in_text=False)
    for family, method, places in tracks:
        for at, rows in places.items():
            radius = column(rows, "radius_px").fillna(0).max()
            units = radius * column(rows, "pixel_size").fillna(0).max()
            out.rows.append(
                [family[0], number_text(at), method] +
                [grouped(total(rows, name)) for name in ("colliding", "missed", "wrong",
                                                         "candidates")] +
                [grouped(total(rows, "kept_triangles")) if keeps(rows) else "-",
                 grouped(total(rows, "triangles")), rounded(excess(rows)),
                 rounded(radius) if radius > 0 else "-", rounded(units) if radius > 0 else "-",
                 rounded(column(rows, "total_ms").sum())])
    return out


def worst_place(family, places, of, in_words):
    """`slivers (aspect 1000: 4 of 20)`: the first place with the largest positive value, as a list
    of one; an empty list where no value is positive."""
    values = {at: of(rows) for at, rows in places.items()}
    values = {at: x for at, x in values.items() if x > 0}
    if not values:
        return []
    at = max(values, key=values.get)
    return [f"{family[0]} ({family[1]} {number_text(at)}: {in_words(places[at])})"]


def add_failures(chapter, tracks, promising_names):
    """Adds where a method that promises nothing misses, and what a library reports wrongly."""
    misses, wrongs = {}, {}
    for family, method, places in tracks:
        if method in promising_names:
            continue
        misses.setdefault(method, []).extend(worst_place(
            family, places, lambda r: share(total(r, "missed"), total(r, "colliding")),
            lambda r: of_rows(r, "missed", "colliding")))
        wrongs.setdefault(method, []).extend(worst_place(
            family, places, lambda r: total(r, "wrong"), lambda r: grouped(total(r, "wrong"))))
    for method, found in misses.items():
        if found:
            chapter.find(f"{method} missed pairs, at worst: {listed(found)}.")
        elif method != "exact":
            chapter.find(f"{method} missed nothing here, and promises nothing.")
        if wrongs[method]:
            chapter.find(f"{method} reported pairs that do not collide, at worst: {listed(wrongs[method])}.")


def add_power(chapter, rows, tracks, names):
    """Adds for each family what methods that promise culled, and which pairs they could have missed; and where too
    little was culled or at risk for 0 missed to say anything."""
    for family, methods in families_of(tracks):
        shares, risks, little, safe = [], "", [], []
        for method, places in methods:
            of = [sum(culled_shares(r)) for r in places.values() if column(r, "views_used").notna().any()]
            if method not in names or not of:
                continue
            low, high = rounded(min(of), 2), rounded(max(of), 2)
            shares.append(f"{method} {low if low == high else low + ' to ' + high} %")
            little += [method] * (max(of) < LEAST_CULLED)
            if method.startswith("FAR ("):
                track = pd.concat(list(places.values()))
                risk, bare = risks_of(rows, track)
                safe += [method] * (not risk > 0)
                risks = risks or (f"; at risk of {grouped(total(track, 'colliding'))} that collide: "
                                  f"{grouped(risk)} with 0.9 of the radius and {grouped(bare)} without a ball"
                                  if risk == risk and bare == bare else "; pairs at risk were not counted")
        if shares:
            chapter.find(f"{family[0]}: of all triangles culling took away: {listed(shares)}{risks}.")
        if little:
            why = WHY_LITTLE.get(family[0])
            chapter.find(f"{family[0]}: {listed(little)} cannot cull {LEAST_CULLED} % of the triangles here"
                         f"{', since ' + why if why else ''}; 0 missed says little there.")
        if safe:
            chapter.find(f"{family[0]}: no pair is lost with 0.9 of the radius by {listed(safe)}, so these scenes do not "
                         "test that the radius is large enough; only pairs lost without a ball are tested.")


def add_degradation(chapter, tracks, method):
    """Adds how much more than the colliding triangles a method keeps, over the places of each family."""
    parts = []
    for family, name, places in tracks:
        values = {at: excess(rows) for at, rows in places.items()}
        values = {at: x for at, x in values.items() if x == x}
        if name != method or not values:
            continue
        low, high = min(values, key=values.get), max(values, key=values.get)
        least, most = rounded(values[low]), rounded(values[high])
        parts.append(f"{family[0]} {least}" if least == most else f"{family[0]} {least} (at {number_text(low)}) to "
                     f"{most} (at {number_text(high)})")
    if parts:
        chapter.find(f"{method} keeps for each triangle that collides: {listed(parts)}.")


def fill(chapter, study):
    tracks = tracks_of(study.rows)
    names = list(dict.fromkeys(promising(study.rows).contestant))
    add_promises(chapter, study)
    add_power(chapter, study.rows, tracks, names)
    add_failures(chapter, tracks, names)
    for method in names:
        add_degradation(chapter, tracks, method)
    chapter.limits = [
        "Contacts are made to be lost: each lies at the corner of a pixel, in a cell of its own. Every other cell holds "
        "two triangles that only a view can tell apart, so that about half of the triangles can be culled. The "
        "shares are those of this layout.",
        "In gaps nothing collides but small triangles at two corners of the scene: this family shows what is kept of pairs "
        "that nearly meet, and what is reported wrongly.",
        "FAR pairs has no ball that could be smaller; beside it stand the pairs that sampling alone loses in the same "
        "views and pixels.",
        "CULLIDE is measured between objects, so it sees the cloth against the sphere; S-CULLIDE, FAR and FAR pairs also "
        "see it against itself.",
        "The cloth here is small, and looked at in a few frames. The study cloth (farcull experiment cloth, hours) goes "
        "through 500 frames of 20,000 triangles.",
        "FCL leaves neighbours in one object out, so these are no misses of its; of the others they count.",
        "Where an input is already beyond what a library's type can hold, its misses are those of the rounding to it: "
        "FCL is asked in float, as it is mostly used.",
        f"Where {study.constants['few_triangles']} triangles or fewer are left FAR stops culling, since testing them is "
        "cheaper."]
    add_gaps(chapter, study)
    if tracks:
        chapter.figures = figures_of(tracks)
        chapter.tables = [short_table(study.rows, tracks), all_table(tracks)]
