"""Shows the number of candidates per colliding pair, for boxes of triangles, oriented boxes and the method boxes.

Neighbours (triangles of an object that share a vertex) are not counted here, since libraries leave them out.
"""
from frame import *  # noqa: F403: a chapter uses most of it

BOXES, ORIENTED, OURS = "boxes of triangles", "oriented boxes (FCL)", "Boxes"
WAYS = [BOXES, ORIENTED, OURS]
MOST_BOXES = 90  # per cent of the pairs of boxes; a method that keeps this many culls little


def with_ways(rows):
    """Returns the rows with more columns: way; left and pairs, which do not count neighbours; left_each."""
    left, neighbours, pairs, both = (column(rows, name).fillna(0) for name in (
        "candidates", "neighbour_candidates", "colliding", "neighbours"))
    way = [{"cgal-boxes": BOXES, "fcl-obb": ORIENTED}.get(row.method, OURS) for row in rows.itertuples()]
    rows = rows.assign(way=way, left=left - neighbours, pairs=pairs - both)
    return rows.assign(left_each=(rows.left / rows.pairs).where(rows.pairs > 0))


def table_of(scenes):
    out = Table(
        "culling", "Pairs that collide, pairs whose boxes overlap, and candidates for each pair that collides: of boxes of "
        "triangles, of FCL's oriented boxes, and of the method boxes",
        columns(["scene"], ["colliding", "boxes overlap", "boxes of triangles", "oriented", "Boxes"]))
    for scene, ways in scenes.items():
        if some := ways.get(OURS) or ways.get(BOXES):
            out.rows.append([scene, grouped(some.pairs), grouped(ways[BOXES].left) if BOXES in ways else "-"] +
                            [rounded(ways[way].left_each) if way in ways else "-" for way in WAYS])
    return out


def add_join(chapter, scenes):
    """Adds the scenes where the method boxes keeps nearly all candidates of boxes of triangles, and the other scenes."""
    join, less = [], []
    for scene, ways in scenes.items():
        if BOXES in ways and OURS in ways:
            of, kept = ways[BOXES].left, ways[OURS].left
            (join if share(kept, of) >= MOST_BOXES else less).append(f"{scene} ({of_all(kept, of)})")
    if join:
        chapter.find(f"The method boxes keeps at least {MOST_BOXES} % of the pairs of triangles whose boxes overlap on "
                     f"{listed(join)}: there it is a fast join of boxes.")
    if less:
        chapter.find(f"By oriented boxes of blocks it keeps fewer on {listed(less)}.")


def fill(chapter, study):
    rows = with_ways(study.rows)
    scenes = {scene: {row.way: row for row in of.itertuples()} for scene, of in by(rows, "scene")}
    add_promises(chapter, study)
    add_join(chapter, scenes)
    if len(rows):
        chapter.tables = [table_of(scenes)]
