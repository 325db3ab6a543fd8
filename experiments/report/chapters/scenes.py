"""All scenes of the studies: where they come from, and how large their triangles are in pixels."""
import re

from frame import *  # noqa: F403: a chapter uses most of it

RESOLUTIONS = (64, 128, 256, 512, 1024, 2048, 4096)  # px
MESHES, SIMULATED, DRAWN, CONSTRUCTED = "scanned or modelled", "simulated", "drawn", "constructed"


def builtin(study, scene):
    """The program's entry for the scene, by its name without numbers and suffixes."""
    return study.constants["scenes"].get(re.split("[:@]", scene)[0], {})


def source_of(study, scene):
    known = builtin(study, scene)
    if known.get("needs_meshes"):
        return MESHES
    if scene.startswith("cloth"):
        return SIMULATED
    return CONSTRUCTED if known.get("seed") is None else DRAWN


def source_text(study, scene):
    """The source of the scene; for a randomly drawn one with its seed, from @seed or its own."""
    given = re.search("@seed([^@]*)", scene)
    seed = given[1] if given else builtin(study, scene).get("seed")
    source = source_of(study, scene)
    return f"{DRAWN}, seed {seed}" if source == DRAWN else source


def pixels_text(row, rank, resolution, at):
    """Pixels that the triangle of this rank covers at `resolution`, computed from the resolution `at`."""
    there = value(row, rank) * (resolution / at) ** 2
    return "-" if there != there else rounded(there, 2) if there >= 1 else f"{there:.2g}"


def self_text(row):
    own, objects = number(row, "self_objects"), number(row, "objects")
    return "no" if own == 0 else "yes" if own == objects else f"{own} of {objects}"


def tables_of(study, at):
    starts, counts = [], []
    for row in study.rows.itertuples():
        starts.append([row.scene, source_text(study, row.scene)])
        counts.append([str(row.frame) if row.frame >= 0 else "-"] +
                      [count_cell(row, name) for name in ("objects", "triangles", "colliding")])
    rows, numbers = list(study.rows.itertuples()), ["frame", "objects", "triangles", "colliding"]
    return [
        Table("scenes",
              "All scenes of the studies. Self: whether objects are tested against themselves. Pairs that collide, "
              "without neighbours inside an object. Then the pixels that the median triangle covers at each "
              "resolution: the area of its image in the views x, y and z. The median is that of the triangles whose "
              "box meets another object's or whose object is tested against itself. Of a scene that moves, the frame "
              "that is named",
              columns(["scene", "source", "self"], numbers + [f"{resolution} px" for resolution in RESOLUTIONS]),
              [start + [self_text(row)] + count + [pixels_text(row, "pixels_half", side, at) for side in RESOLUTIONS]
               for row, start, count in zip(rows, starts, counts)]),
        Table("scenes-all",
              "All scenes, the studies that use them, colliding neighbours, and the pixels that the smallest tenth, "
              f"half and nine tenths of the triangles cover at most at {at} px",
              columns(["scene", "source", "description", "studies", "self"],
                      numbers + ["neighbours", "tenth", "half", "nine tenths"], ["scene hash"]),
              [start + [builtin(study, row.scene).get("description", "-"),
                        " ".join(study.constants["users"].get(row.scene, [])), self_text(row)] +
               count + [count_cell(row, "neighbours")] +
               [pixels_text(row, rank, at, at) for rank in ("pixels_tenth", "pixels_half", "pixels_ninety")] +
               [text(row, "scene_hash") or "-"] for row, start, count in zip(rows, starts, counts)], in_text=False)]


def fill(chapter, study):
    rows, at = study.rows, study.constants["scene_resolution"]
    if len(rows):
        sources = rows.scene.map(lambda scene: source_of(study, scene)).value_counts()
        triangles, pixels = column(rows, "triangles"), column(rows, "pixels_half")
        chapter.find(
            f"The studies use {len(rows)} scenes: {sources.get(MESHES, 0)} of scanned or modelled meshes, "
            f"{sources.get(SIMULATED, 0)} of simulated cloth, {sources.get(DRAWN, 0)} drawn at random and "
            f"{sources.get(CONSTRUCTED, 0)} constructed. They have {grouped(triangles.min())} to "
            f"{grouped(triangles.max())} triangles. In {int((column(rows, 'self_objects') > 0).sum())} of them objects "
            "are tested against themselves.")
        chapter.find(f"At {at} px the median triangle covers less than a pixel in {int((pixels < 1).sum())} of "
                     f"{int(pixels.notna().sum())} scenes.")
        chapter.tables = tables_of(study, at)
    chapter.limits = [
        "The generated scenes are ours. The meshes are a few that many papers use, scanned or modelled at one "
        "resolution each.",
        "A window is as large as the place where objects can meet. A method that divides a scene into several windows "
        "has smaller pixels there."]
    add_gaps(chapter, study)
