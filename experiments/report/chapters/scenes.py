"""Lists all scenes of the studies: where they come from, and how large their triangles are in pixels."""
from frame import *  # noqa: F403: a chapter uses most of it

MESHES, SIMULATED, DRAWN, CONSTRUCTED = "scanned or modelled", "simulated", "drawn", "constructed"


def with_sources(rows, scenes):
    """Returns the rows with the columns source and seed. Drawn scenes have a seed: that of @seed, or the scene's own. scenes:
    the program's entry for each scene, by the name without numbers and suffixes."""
    def source_of(row):
        known = scenes.get(re.split("[:@]", row.scene)[0], {})
        if known.get("needs_meshes"):
            return MESHES, None
        if row.scene.startswith("cloth"):
            return SIMULATED, None
        given = re.search("@seed([^@]*)", row.scene)
        return (CONSTRUCTED, None) if known.get("seed") is None else (DRAWN, given[1] if given else known["seed"])

    found = [source_of(row) for row in rows.itertuples()]
    return rows.assign(source=[source for source, _ in found], drawn_with=[seed for _, seed in found])


def self_text(row):
    own, objects = number(row, "self_objects"), number(row, "objects")
    return "no" if own == 0 else "yes" if own == objects else f"{own} of {objects}"


def table_of(rows, at):
    return Table(
        "scenes", "All scenes of the studies. Self: whether objects are tested against themselves. Pairs that collide, without "
        f"neighbours inside an object. Then the pixels that the median triangle covers at {at} px: the area of its image in the "
        "views x, y and z; at twice the resolution it covers four times as many. The median is that of the triangles whose box "
        "meets another object's or whose object is tested against itself. Of a scene that moves, the frame that is named",
        columns(["scene", "source", "self"], ["frame", "objects", "triangles", "colliding", f"{at} px"]),
        [[row.scene, f"{DRAWN}, seed {row.drawn_with}" if row.source == DRAWN else row.source, self_text(row),
          str(row.frame) if row.frame >= 0 else "-"] + [count_cell(row, name) for name in ("objects", "triangles", "colliding")] +
         ["-" if (px := value(row, "pixels_half")) != px else rounded(px, 2) if px >= 1 else f"{px:.2g}"]
         for row in rows.itertuples()])


def fill(chapter, study):
    rows, at = with_sources(study.rows, study.constants["scenes"]), study.constants["scene_resolution"]
    if len(rows):
        sources = rows.source.value_counts()
        triangles, pixels = column(rows, "triangles"), column(rows, "pixels_half")
        chapter.find(
            f"The studies use {len(rows)} scenes: {sources.get(MESHES, 0)} of scanned or modelled meshes, "
            f"{sources.get(SIMULATED, 0)} of simulated cloth, {sources.get(DRAWN, 0)} drawn at random and "
            f"{sources.get(CONSTRUCTED, 0)} constructed. They have {grouped(triangles.min())} to {grouped(triangles.max())} "
            f"triangles. In {int((column(rows, 'self_objects') > 0).sum())} of them objects are tested against themselves.")
        chapter.find(f"At {at} px the median triangle covers less than a pixel in {int((pixels < 1).sum())} of "
                     f"{int(pixels.notna().sum())} scenes.")
        chapter.tables = [table_of(rows, at)]
