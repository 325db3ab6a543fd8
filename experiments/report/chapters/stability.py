"""Missed pairs and kept triangles in families of scenes that go to an extreme, such as slivers or
offsets far from the origin."""
from frame import *  # noqa: F403: a chapter uses most of it


def extreme_of(row):
    """The family of a scene, the quantity that it takes to an extreme, and its value."""
    scene = row.scene
    for mark, family, axis in (("@offset-", "far from the origin", "offset (units)"), ("@scale-", "scaled", "scale")):
        if mark in scene:
            return family, axis, float(scene.split(mark)[1])
    words = scene.split("@")[0].split(":")
    at = float(words[2]) if len(words) > 2 else NONE
    if words[0] == "gap":
        return ("gaps", "gap (ulps)", at) if at > 0 else ("overlaps", "overlap (ulps)", abs(at))
    if words[0] == "cloth":
        apart = "@" in scene
        return ("cloth on a sphere" if apart else "cloth against itself and a sphere", "stiffness (N/m)", at)
    names = {"slivers": ("slivers", "aspect"), "stack": ("stacked sheets", "distance (widths)"),
             "mixed": ("mixed sizes", "ratio of sizes")}
    return *names.get(words[0], (words[0], "")), at


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


def short_table(tracks):
    out = Table("stability", "Pairs in all scenes of a family together: colliding ones, those of them that a method "
                "missed, those that it would miss with 0.9 of its radius (at risk: where there are none, the scenes do "
                "not show that the radius is large enough), and those that a library reported though they do not "
                "collide. Then how many triangles culling kept for each one that collides, in the first scene of the "
                "family and in its last: \"2.14 at 10\" are 2.14 triangles where what the family changes is 10",
                columns(["family", "method"], ["scenes", "colliding", "missed", "at risk", "wrong", "kept, first scene",
                                               "kept, last scene"]))
    for family, method, places in tracks:
        if method == "exact":
            continue
        rows = pd.concat(list(places.values()))
        asked = column(rows, "at_risk").notna().any()
        ends = [(at, rounded(excess(places[at]))) for at in (min(places), max(places))]
        out.rows.append(
            [", ".join(word for word in family if word), method, grouped(len(rows))] +
            [grouped(total(rows, "colliding")), grouped(total(rows, "missed")),
             grouped(total(rows, "at_risk")) if asked else "-", grouped(total(rows, "wrong"))] +
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
    add_failures(chapter, tracks, names)
    for method in names:
        add_degradation(chapter, tracks, method)
    chapter.limits = ["FAR and CULLIDE are measured between objects: of the cloth they see it against the sphere, FAR "
                      "pairs and S-CULLIDE also against itself.", "The cloth here is small, and looked at in a few "
                      "frames. The study cloth (farcull experiment cloth, hours) goes through 500 frames of 20,000 "
                      "triangles.", "FCL leaves neighbours in one object out, so these are no misses of its; of the "
                      "others they count.", "Where an input is already beyond what a library's type can hold, its "
                      "misses are those of the rounding to it: FCL is asked in float, as it is mostly used.",
                      f"Where {study.constants['few_triangles']} triangles or fewer are left FAR stops culling, "
                      "since testing them is cheaper: what it keeps in small scenes says little."]
    add_gaps(chapter, study)
    if tracks:
        chapter.figures = figures_of(tracks)
        chapter.tables = [short_table(tracks), all_table(tracks)]
