"""How far the depths in a buffer are outside the bounds that they should keep, over the generators of the lemma
experiment."""
from frame import *  # noqa: F403

OURS = "fragment, budget radius"
BUFFERS = {"fixed24": "24 bits", "float32": "32-bit float"}
# With 16 bits, rounding moves a depth by at most this many steps of 2^-24 (experiments/lemma/lemma.cpp, rounding_of).
ROUNDING_16 = 0.5 + 1 + 2**24 / (2**16 - 1) + 1
COUNTS = ("points", "no_sample", "not_bounding", "rounded")


def with_axes(rows):
    """Returns the rows with columns for the source of the depth, the buffer, the generator and the depth of the scene."""
    words = [scene.split(":") for scene in rows.scene]
    return rows.assign(
        line=[("fixed-function, " if mode == "fixed" else "fragment, ") +
              (f"{radius} radius" if radius in ("budget", "published") else f"{radius} of the radius")
              for mode, radius in zip(rows.depth_mode, rows.radius)],
        bits=["16 bits" if m == "lemma-fixed16" else BUFFERS.get(f, f) for m, f in zip(rows.method, rows.depth_format)],
        generator=[w[1] for w in words], depth=[float(w[3]) for w in words])


def most(rows, name):
    """Returns the largest value of the column `name`; infinite if a row lacks a number there."""
    return max(0.0, column(rows, name).fillna(math.inf).max())


def drawn(rows):
    """Returns the value to draw. If all violations are pixels without a sample, there is no distance. Then no point is drawn,
    since a point at zero would hide the violations."""
    steps = most(rows, "largest_steps")
    return NONE if steps == 0 and total(rows, "no_sample") else steps


def figure_of(rows, rounding):
    out = Figure("precision", "How far depth buffers are outside the bounds they should give",
                 f"The largest violation over all generators, n = {grouped(total(rows, 'points'))} points of "
                 "triangles. At 0 no sample is outside. Up to the mark a monotone rounding explains it, which the "
                 "theorem allows. A point whose pixel has no sample has no distance; the table counts these.")
    for (bits, side), here in groups(rows, ["bits", "resolution"]):
        rounding = {**rounding, "16": ROUNDING_16}
        panel = Panel(f"{bits}, {side} px", log("depth of the scene (px)"), log("outside (depth steps)", zero=True),
                      marks=[Mark(rounding[bits[:2]], "rounding of the map", vertical=False)])
        for line, of in sorted(groups(here, "line"), key=lambda pair: pair[0] != OURS):
            depths = groups(of, "depth")
            panel.series.append(Series(line, [d for d, _ in depths], [drawn(cell) for _, cell in depths], emphasis=line == OURS))
        out.panels.append(panel)
    return out


def table_of(rows):
    return Table("precision", "Points over all generators, sides and depths: without a sample, not bounded, and "
                 "outside by no more than rounding; how far outside at most",
                 columns(["depth by", "buffer"], ["points", "no sample", "not bounded", "rounded", "most (steps)", "most (px)"]),
                 [[*key, *(grouped(total(of, name)) for name in COUNTS), rounded(most(of, "largest_steps")),
                   rounded(most(of, "largest_px"))] for key, of in groups(rows, ["line", "bits"])])


def add_violations(chapter, rows):
    """Adds each violation of fragment depth at the budget radius, except for rows that break a promise, reported already."""
    for row in rows[rows.line == OURS].itertuples():
        violations = number(row, "no_sample") + number(row, "not_bounding")
        if violations and not breaks(row):  # rows that break a guarantee have been reported already
            chapter.find_broken(
                f"fragment depth at the budget radius, {row.bits}, {row.resolution} px, scene {row.depth:g} px deep: "
                f"{of_all(violations, number(row, 'points'))} points of the generator \"{row.generator}\" have no "
                f"sample or are not bounded, by up to {rounded(value(row, 'largest_steps'))} steps.")


def add_deep_windows(chapter, rows):
    """Adds the violations in deep windows. In a deep window, a step of the depth buffer is longer than the chord of the ball
    at the corner of a pixel. So all depths of a contact become one number in the buffer."""
    ours = rows[rows.line == OURS]
    chord = 2 * np.sqrt(np.maximum(column(ours, "radius_px")**2 - 0.5, 0))
    step = column(ours, "step_px") * np.where(ours.bits == "16 bits", 256, 1)  # with 16 bits, a step is 2^-16 instead of 2^-24
    deep = ours[step > chord]
    if len(deep):
        lost = total(deep, "no_sample") + total(deep, "not_bounding")
        chapter.find(f"In {of_all(len(deep), len(ours))} runs of fragment depth at the budget radius a depth step, of up "
                     f"to {rounded(step.max())} px, is longer than the chord of the ball at the corner of a pixel, "
                     f"{rounded(chord.max())} px: {of_all(lost, total(deep, 'points'))} points are violated there.")


def fill(chapter, study):
    rows = with_axes(study.rows)
    add_promises(chapter, study)
    add_violations(chapter, rows)
    add_deep_windows(chapter, rows)
    if len(rows):
        chapter.figures, chapter.tables = [figure_of(rows, study.constants["depth_rounding"])], [table_of(rows)]
