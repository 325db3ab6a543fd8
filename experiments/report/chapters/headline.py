"""Makes the first page: one figure, one table and three sentences. They show how many pairs CULLIDE, FAR and methods that
draw nothing miss, and how long these methods take."""
from frame import *  # noqa: F403

PUBLISHED, STRICT = "CULLIDE as published", "CULLIDE, strict"
NAMES = {"CULLIDE, one round": PUBLISHED, "CULLIDE, one round, all views, conservative": STRICT, "Boxes": "boxes"}
RELIABLE = ("FAR (OBB)", "FAR (exact)", "boxes", "exact")


def all_runs(row):
    """Returns the times of all runs, in ms. Includes void rounds, in which other programs took the processors."""
    return [ms for of in row.times.get("rounds", ()) for ms in of["ms"]]


def ms_of(row):
    """Returns the median time in ms. Uses void rounds only if all rounds are void. NaN if there are no times."""
    runs = row.runs or all_runs(row)
    return median(runs) if runs else NONE


def figure_of(scenes, pixels):
    rows = [row for of in scenes.values() for row in of.values()]
    busy = any(not row.runs and all_runs(row) for row in rows)
    out = Figure("headline", "Missed pairs against run time", (
        f"Pairs that are missed, of all that collide, over the median time from triangles to pairs, at {pixels} px; n = "
        f"{counted(len(rows), 'point', 'points')}.") + (
        " Other programs used the processors meanwhile, so the times are to be measured again." if busy else ""), named=True)
    for scene, of in scenes.items():
        series = [Series(name, [ms_of(row)], [share(number(row, "missed"), row.colliding)], "points")
                  for name, row in of.items() if ms_of(row) > 0]
        out.panels += [Panel(scene, log("time (ms)"), Axis("missed pairs (%)", low=0, high=100), series)] * bool(series)
    return out


def table_of(scenes):
    names = dict.fromkeys(name for of in scenes.values() for name in of)
    return Table("headline", "Colliding pairs that are missed, and the median time", columns(
        ["method"], [word for scene in scenes for word in (f"{scene}: missed", "ms")]),
        [[name, *(cell for of in scenes.values() for cell in (
            (grouped(number(of[name], "missed")), rounded(ms_of(of[name]))) if name in of else "--"))] for name in names])


def on_scenes(scenes, text_of):
    """Returns a text such as `1 on two-bunnies and 0 on field`."""
    return listed(f"{text_of(of)} on {scene}" for scene, of in scenes.items())


def fill(chapter, study):
    add_broken(chapter, promising(study.rows))
    scenes = {scene: {NAMES.get(row.contestant, row.contestant): row for row in rows.itertuples()}
              for scene, rows in by(study.rows, "scene")}
    if not scenes:
        return
    chapter.figures, chapter.tables = [figure_of(scenes, study.rows.resolution.max())], [table_of(scenes)]
    scenes = {scene: of for scene, of in scenes.items() if {PUBLISHED, STRICT, *RELIABLE} <= {*of}}
    if not scenes:
        return
    lost = sum(number(of[name], "missed") for of in scenes.values() for name in RELIABLE)
    chapter.find(f"Of the pairs that collide, {PUBLISHED} misses " + on_scenes(scenes, lambda of: of_all(
        number(of[PUBLISHED], "missed"), of[PUBLISHED].colliding)) + ".")
    chapter.find("Its strict form misses " + on_scenes(scenes, lambda of: grouped(number(of[STRICT], "missed"))) +
                 f"; FAR, `boxes` and `exact` miss {grouped(lost) if lost else 'none'}.")
    times = [f"{words} takes {on_scenes(scenes, lambda of: rounded(ms_of(of[name]) / ms_of(of['exact']), 2))}"
             for words, name in (("`boxes`", "boxes"), ("FAR", RELIABLE[0]))]
    chapter.find(f"With 1 for the time of `exact`, {listed(times)}.")
