"""How far the depths in a buffer are outside the bounds that they should keep, over the generators of the lemma
experiment."""
from frame import *  # noqa: F403

OURS = "fragment, budget radius"
BUFFERS = {"fixed24": "24 bits", "float32": "32-bit float"}
# How far rounding takes a depth, in steps of 2^-24, for 16 bits (experiments/lemma/lemma.cpp, rounding_of).
ROUNDING_16 = 0.5 + 1 + 2**24 / (2**16 - 1) + 1
COUNTS = ("points", "no_sample", "not_bounding", "rounded")


def with_axes(rows):
    """Rows with the source of their depth, the buffer, the generator and the depth of the scene."""
    words = [scene.split(":") for scene in rows.scene]
    return rows.assign(
        line=[("fixed-function, " if mode == "fixed" else "fragment, ") +
              (f"{radius} radius" if radius in ("budget", "published") else f"{radius} of the radius")
              for mode, radius in zip(rows.depth_mode, rows.radius)],
        bits=["16 bits" if m == "lemma-fixed16" else BUFFERS.get(f, f) for m, f in zip(rows.method, rows.depth_format)],
        generator=[w[1] for w in words], depth=[float(w[3]) for w in words])


def grouped_by(rows, names):
    """Pairs of the values of columns, ascending, and their rows."""
    return list(rows.groupby(names)) if len(rows) else []


def most(rows, name):
    """The largest distance; infinite if that of a row is not a number."""
    return max(0.0, column(rows, name).fillna(math.inf).max())


def drawn(rows):
    """The value to draw. If only pixels without a sample are violated, there is no distance, and so no point of a line:
    the line of zeros would hide the violations."""
    steps = most(rows, "largest_steps")
    return NONE if steps == 0 and total(rows, "no_sample") else steps


def not_drawn(rows):
    """Sentences of the caption about violations that no line shows."""
    samples, endless, gaps = [], [], False
    for (line, bits), part in grouped_by(rows, ["line", "bits"]):
        sides = grouped_by(part, ["resolution", "depth"])
        lacking = sorted({depth for (_, depth), cell in sides if total(cell, "no_sample")})
        beyond = sorted({depth for (_, depth), cell in sides if math.isinf(most(cell, "largest_steps"))})
        gaps = gaps or any(math.isnan(drawn(cell)) for _, cell in sides)
        at = [f"(depth {listed(rounded(d) for d in depths)} px)" for depths in (lacking, beyond)]
        if lacking:
            samples.append(f"{line}, {bits} {of_rows(part, 'no_sample', 'points')} {at[0]}")
        if beyond:
            endless.append(f"{line}, {bits} {at[1]}")
    out = ""
    if samples:
        out += f" Points whose pixel has no sample have no distance and are in no line: {listed(samples)}."
        out += " Where there are no others the line has a gap." if gaps else ""
    if endless:
        out += f" Farther outside than a number says, and in no line: {listed(endless)}."
    return out


def figure_of(rows, rounding):
    out = Figure("precision", "How far depth buffers are outside the bounds they should give",
                 f"The largest violation over all generators, n = {grouped(total(rows, 'points'))} points of "
                 "triangles. At 0 no sample is outside. Up to the mark a monotone rounding explains it, which the "
                 "theorem allows." + not_drawn(rows))
    for (bits, side), here in grouped_by(rows, ["bits", "resolution"]):
        rounding = {**rounding, "16": ROUNDING_16}
        panel = Panel(f"{bits}, {side} px", log("depth of the scene (px)"), log("outside (depth steps)", zero=True),
                      marks=[Mark(rounding[bits[:2]], "rounding of the map", vertical=False)])
        for line, of in grouped_by(here, "line"):
            depths = grouped_by(of, "depth")
            panel.series.append(Series(line, [d for d, _ in depths], [drawn(cell) for _, cell in depths],
                                       emphasis=line == OURS))
        out.panels.append(panel)
    return out


def sums(rows):
    return [grouped(total(rows, name)) for name in COUNTS] + [
        rounded(most(rows, "largest_steps")), rounded(most(rows, "largest_px"))]


def tables_of(rows):
    short = Table("precision", "Points over all generators, sides and depths: without a sample, not bounded, and "
                  "outside by no more than rounding; how far outside at most",
                  columns(["depth by", "buffer"], ["points", "no sample", "not bounded", "rounded", "most (steps)",
                                                   "most (px)"]),
                  [[*key, *sums(of)] for key, of in grouped_by(rows, ["line", "bits"])])
    cells = Table("precision-depths", "Points over all generators, at every side and depth: without a sample, not "
                  "bounded, and outside by no more than rounding",
                  columns(["depth by", "buffer"], ["side (px)", "depth (px)", "step (px)", "points", "no sample",
                                                   "not bounded", "rounded", "most (steps)", "most (px)"]),
                  [[line, bits, grouped(side), grouped(depth), rounded(column(of, "step_px").iloc[-1]), *sums(of)]
                   for (line, bits, side, depth), of in grouped_by(rows, ["line", "bits", "resolution", "depth"])],
                  in_text=False)
    return [short, cells, table_of_rows("precision-all", "All points", rows, {
        "generator": "=generator", "depth (px)": lambda row: grouped(row.depth), "depth by": "=line",
        "buffer": "=bits", "side (px)": lambda row: str(row.resolution), "points": "points",
        "no sample": "no_sample", "not bounded": "not_bounding", "rounded": "rounded",
        "most (steps)": "~largest_steps", "most (px)": "~largest_px"})]


def add_violations(chapter, rows):
    """Adds each violation of fragment depth at the budget radius; returns whether there is one."""
    broken = False
    for row in rows[rows.line == OURS].itertuples():
        violations = number(row, "no_sample") + number(row, "not_bounding")
        broken = broken or violations > 0
        if violations and not breaks(row):  # else reported already
            chapter.find_broken(
                f"fragment depth at the budget radius, {row.bits}, {row.resolution} px, scene {row.depth:g} px deep: "
                f"{of_all(violations, number(row, 'points'))} points of the generator \"{row.generator}\" have no "
                f"sample or are not bounded, by up to {rounded(value(row, 'largest_steps'))} steps.")
    return broken


def add_deep_windows(chapter, rows):
    """Adds what holds where a step of the buffer is longer than the chord of the ball at the corner of a pixel: there
    the depths of a whole contact are one number in the buffer."""
    ours = rows[rows.line == OURS]
    chord = 2 * np.sqrt(np.maximum(column(ours, "radius_px")**2 - 0.5, 0))
    step = column(ours, "step_px") * np.where(ours.bits == "16 bits", 256, 1)  # a step of 2^-16, not of 2^-24
    deep = ours[step > chord]
    if len(deep):
        lost = total(deep, "no_sample") + total(deep, "not_bounding")
        chapter.find(f"In {of_all(len(deep), len(ours))} runs of fragment depth at the budget radius a depth step, of up "
                     f"to {rounded(step.max())} px, is longer than the chord of the ball at the corner of a pixel, "
                     f"{rounded(chord.max())} px: {of_all(lost, total(deep, 'points'))} points are violated there.")


def add_findings(chapter, rows):
    broken = add_violations(chapter, rows)
    for (line, bits), of in grouped_by(rows, ["line", "bits"]):
        if broken and line == OURS:
            continue
        points, no_sample, not_bounding, after = (total(of, name) for name in COUNTS)
        steps = rounded(most(of, "largest_steps"))
        if no_sample + not_bounding == 0:
            words = (f"all {grouped(points)} points have samples that bound them" +
                     (f", {grouped(after)} of them after rounding of up to {steps} steps." if after
                      else ", none even by rounding outside."))
        else:
            worst = of.generator.iloc[int(np.argmax(column(of, "largest_steps").fillna(math.inf)))]
            words = f"{of_all(no_sample, points)} points have no sample, {grouped(not_bounding)} are not bounded"
            words += (f", the worst by {steps} steps, {rounded(most(of, 'largest_px'))} px ({worst})."
                      if not_bounding else ".")
        chapter.find(f"{line}, {bits}: {words}")


def fill(chapter, study):
    rows = with_axes(study.rows)
    add_promises(chapter, study)
    add_findings(chapter, rows)
    add_deep_windows(chapter, rows)
    chapter.limits = [
        "A violation is decided on what the buffer holds against the exact depth of the point under the exact depth "
        "map. What a monotone rounding explains is counted apart, because asked and stored depths are rounded alike.",
        "The buffer of 16 bits is that of the native canvas, whose depths are rounded to multiples of 1 / (2^16 - 1) "
        "after drawing; no run of a whole scene has it.",
        "Fixed-function depth promises nothing: that its surface bounds every point here at the budget radius is this "
        "device's interpolation, for which GL gives no bound.",
        "The published radius grows with the depth step, so in deep scenes it is larger than the budget's."]
    add_gaps(chapter, study)
    if len(rows):
        chapter.figures = [figure_of(rows, study.constants["depth_rounding"])]
        chapter.tables = tables_of(rows)
