"""How many candidates boxes, oriented boxes and FAR pairs leave for each pair that collides.

Neighbours, triangles of an object that share a vertex, are in no count here: libraries leave them out.
"""
from frame import *  # noqa: F403: a chapter uses most of it

BOXES, ORIENTED, CHOSEN = "boxes", "oriented boxes (FCL)", "FAR pairs, own choice"
ONE_VIEW, THREE_VIEWS = "FAR pairs, 1 view", "FAR pairs, 3 views"
WAYS = [BOXES, ORIENTED, CHOSEN, ONE_VIEW, THREE_VIEWS]
MOST_BOXES = 90  # per cent of the pairs of boxes; a method that keeps as many is little more than a join


def way_of(row):
    views = (THREE_VIEWS if "," in row.views else ONE_VIEW) if row.views else CHOSEN
    return {"cgal-boxes": BOXES, "fcl-obb": ORIENTED}.get(row.method, views)


def with_ways(rows):
    """The rows with the columns way, left and pairs (both without neighbours), and left_each."""
    left, neighbours, pairs, both = (column(rows, name).fillna(0) for name in (
        "candidates", "neighbour_candidates", "colliding", "neighbours"))
    rows = rows.assign(way=[way_of(row) for row in rows.itertuples()], left=left - neighbours, pairs=pairs - both)
    return rows.assign(left_each=(rows.left / rows.pairs).where(rows.pairs > 0))


def best_rows(rows):
    """For each scene and way the row with the fewest candidates, among equal rows that of the least resolution."""
    best = rows.sort_values(["left", "resolution"]).drop_duplicates(["scene", "way"])
    return {scene: {row.way: row for row in best[best.scene == scene].itertuples()} for scene in rows.scene.unique()}


def figure_of(rows):
    sides = resolutions(rows)
    out = Figure(
        "culling", "Candidates for each pair that collides",
        f"Pairs that are left to exact predicates, over the pairs that collide, on {rows.scene.nunique()} scenes; "
        "neighbours are in neither. 1 is the least there can be. Boxes, oriented boxes and what FAR pairs chooses by "
        "itself have no resolution, so they are level lines; where it leaves what boxes leave, its line lies on "
        "theirs. One run at each point.")
    for scene, of in by(rows, "scene"):
        panel = Panel(scene, log("resolution (px)"), log("candidates / colliding"))
        for way in WAYS:
            track = of[of.way == way].sort_values("resolution")
            level = track[track.resolution == 0].left_each
            x, y = (sides, [level.iloc[-1]] * len(sides)) if len(level) else (track.resolution, track.left_each)
            if len(x):  # emphasises boxes too: the line of FAR pairs often covers theirs
                panel.series.append(Series(way, list(x), list(y), "lines" if len(level) else "lines_points",
                                           way in (BOXES, THREE_VIEWS)))
        out.panels.append(panel)
    return out


def table_of(best):
    out = Table(
        "culling",
        "Pairs that collide, pairs whose boxes overlap, and candidates for each pair that collides: of boxes, of FCL's "
        "oriented boxes, and of FAR pairs by its own choice, in the view z and in the views x, y, z, each at the "
        "resolution that leaves the fewest",
        columns(["scene"], ["colliding", "boxes overlap", "boxes", "oriented", "FAR pairs", "1 view", "at px",
                            "3 views", "at px"]))
    for scene, ways in best.items():
        some = ways.get(CHOSEN) or ways.get(BOXES)
        if some is None:
            continue
        cells = [scene, grouped(some.pairs), grouped(ways[BOXES].left) if BOXES in ways else "-"]
        for way in WAYS:
            cells.append(rounded(ways[way].left_each) if way in ways else "-")
            if way in (ONE_VIEW, THREE_VIEWS):
                cells.append(str(ways[way].resolution) if way in ways else "-")
        out.rows.append(cells)
    return out


def add_choice(chapter, best):
    """Adds the scenes where FAR pairs, by its own choice, keeps nearly what boxes keep, and those with less."""
    join, less = [], []
    for scene, ways in best.items():
        if BOXES in ways and CHOSEN in ways:
            of, kept = ways[BOXES].left, ways[CHOSEN].left
            (join if share(kept, of) >= MOST_BOXES else less).append(f"{scene} ({of_all(kept, of)})")
    if join:
        chapter.find(f"By its own choice FAR pairs keeps at least {MOST_BOXES} % of the pairs of triangles whose boxes "
                     f"overlap on {listed(join)}: there it is a fast join of boxes.")
    if less:
        chapter.find(f"By its own choice FAR pairs keeps fewer on {listed(less)}.")


def add_views(chapter, rows, best):
    """Adds how many candidates views leave if they are requested."""
    better = [ways[THREE_VIEWS].left < ways[ORIENTED].left for ways in best.values()
              if ORIENTED in ways and THREE_VIEWS in ways]
    if better:
        chapter.find("Three views at the best resolution leave fewer candidates than FCL's oriented boxes on "
                     f"{sum(better)} of {len(better)} scenes.")
    views = rows[rows.way == THREE_VIEWS].sort_values("resolution").groupby("scene").left
    if worse := int((views.last() > views.min()).sum()):
        chapter.find(f"More pixels do not always leave fewer: on {worse} of {len(best)} scenes three views leave more "
                     "at the largest resolution than at a smaller one.")


def fill(chapter, study):
    rows = with_ways(study.rows)
    best = best_rows(rows)
    add_promises(chapter, study)
    add_choice(chapter, best)
    add_views(chapter, rows, best)
    chapter.limits = [
        "Fewer candidates are not less time: where boxes leave few pairs for each that collides, exact predicates on "
        "all of them take less time than a view.",
        "FCL refuses degenerate triangles. Libraries leave out neighbours that share an index, FAR pairs those that "
        "share a position: where a mesh has a vertex twice, the libraries' candidates hold a few more.",
        "Inside an object FAR pairs leaves neighbours to the predicates as well. They are not counted here."]
    add_gaps(chapter, study)
    if len(rows):
        chapter.figures, chapter.tables = [figure_of(rows)], [table_of(best)]
