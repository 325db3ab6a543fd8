"""Errors against time with a row for each method that is never wrong, the Pareto front of each scene, and CULLIDE in
the time that FAR takes."""
from collections import Counter

from frame import *  # noqa: F403

OURS = ("FAR (OBB)", "Boxes")
STRICT = "one round, all views, conservative"  # drawn as "CULLIDE (strict)"
OWN_TESTS = "FCL and ODE, their own tests"
MOST_SCENES = 8  # the first figure shows at most this many scenes


@dataclass
class Entry:
    """A contestant at a resolution, on a scene with one or several seeds. times: ms of each run; with several seeds the
    median of each seed. Counts are sums over all seeds. An error is a colliding pair that the answer lacks, or a pair in
    the answer that does not collide."""
    row: object  # the row of the first seed
    name: str
    times: tuple
    missed: int
    wrong: int
    colliding: int
    candidates: int
    rounds: tuple = ()  # the times by round; empty: there is one round

    def __post_init__(self):
        self.rounds = self.rounds or (self.times,)
        self.median = median_estimate(self.times, self.rounds)
        self.ms, self.error, self.pixels = self.median.value, self.missed + self.wrong, self.row.resolution

    @property
    def words(self):
        return self.name + (f" at {self.pixels} px" if self.pixels > 0 else "")


@dataclass
class Group:
    """A scene, with the measurements of all of its seeds."""
    name: str
    seeds: int
    entries: list
    kind: str = ""

    @property
    def title(self):
        words = f"{self.seeds} seeds" if self.seeds > 1 else self.kind
        return self.name + (f" ({words})" if words else "")

    def front(self):
        """Returns the Pareto front, fastest first. An entry is in the front if every faster entry has more errors. Of equal
        entries, only the first is included."""
        out = []
        for entry in sorted(self.entries, key=lambda e: (e.ms, e.error)):
            if not out or entry.error < out[-1].error:
                out.append(entry)
        return out

    def yardstick(self):
        """Returns the entry of `exact`, the reference for times: boxes and exact tests, without culling."""
        return next((e for e in self.entries if e.row.method == "exact"), None)


def entry_of(rows):
    first = next(rows.itertuples())
    one = len(rows) == 1 and first.runs
    return Entry(first, first.contestant, first.runs if one else tuple(rows.total_ms),
                 *(total(rows, name) for name in ("missed", "wrong", "colliding", "candidates")), first.rounds if one else ())


def groups_of(rows, scenes):
    out = []
    for name, here in by(rows.assign(group=rows.scene.map(scene_base)), "group"):
        seeds = here.scene.nunique()
        timed = here[column(here, "total_ms").notna()]
        known = scenes.get(name.split(":")[0], {})  # the program's description of the scene
        kind = "scan" if known.get("needs_meshes") else "smooth" if known and "seed" not in known else ""
        parts = by(timed, ["contestant", "resolution"])
        out.append(Group(name, seeds, [entry_of(of) for _, of in parts if len(of) == seeds], kind))
    return out


def sample_of(groups):
    """Returns sample_text() with the number of seeds of drawn scenes."""
    rows = [entry.row for group in groups for entry in group.entries]
    runs = pd.DataFrame({"runs": [row.runs for row in rows], "rounds": [row.rounds for row in rows]})
    seeds = sorted({group.seeds for group in groups if group.seeds > 1})
    return sample_text(runs) + (f"; of drawn scenes {listed(map(str, seeds))} seeds" if seeds else "")


# ---- figures

def cloud(name, points):
    """Returns a Series. points: triples of an Estimate of the time, the value y, and the resolution. A line connects the
    points with a resolution; other points are not connected."""
    out = Series(name, style="lines_points" if sum(pixels > 0 for *_, pixels in points) > 1 else "points", emphasis=name in OURS)
    for time, y, pixels in points:
        ends = (time.low, time.high) if time.n > 1 else (NONE, NONE)
        values = [(time.value, y, *ends)]
        if pixels <= 0:
            values = [(NONE,) * 4] * bool(out.x) + values + [(NONE,) * 4]
        for value_of in values:
            for along, v in zip((out.x, out.y, out.x_low, out.x_high), value_of):
                along.append(v)
    return out


def geometric_mean(values):
    """Returns the geometric mean as an Estimate, with the 95 % interval of Student's t in logarithms."""
    logs = np.log(values)
    reach = student_t95(len(logs) - 1) * logs.std(ddof=1) / math.sqrt(len(logs)) if len(logs) > 2 else 0
    return Estimate(*(math.exp(logs.mean() + part) for part in (0, -reach, reach)), len(logs) if reach else 1)


def summary_of(groups):
    """Returns the points of each method that was measured on every scene of FAR, and the names of the scenes. A point has the
    geometric mean, over the scenes, of time / time of `exact`; the share of errors; and the resolution."""
    groups = [g for g in groups if g.yardstick() and any(e.name == OURS[0] for e in g.entries)]
    found, out = [{(e.name, e.pixels): e for e in group.entries} for group in groups], {}
    for key in (key for key in (found[0] if len(found) > 1 else ()) if all(key in of for of in found)):
        entries = [of[key] for of in found]
        ratio = geometric_mean([e.ms / group.yardstick().ms for e, group in zip(entries, groups)])
        out.setdefault(key[0], []).append(
            (ratio, share(sum(e.error for e in entries), sum(e.colliding for e in entries)), key[1]))
    return out, [group.name for group in groups]


def error_panels(titles, labels, all_points):
    """Returns a panel for each scene. In a panel, methods with an error are drawn as points. Methods without an error are
    rows of the panel's strip. All strips have the same rows. all_points: for each panel, the points of each method."""
    shown = sorted({pixels for points in all_points for of in points.values() for *_, pixels in of if pixels > 0})[::2]
    panels, strips = [], []
    for title, label, points in zip(titles, labels, all_points):
        above, rows = {}, {}
        for name, of in points.items():
            wrong = any(y > 0 for _, y, _ in of)
            name = name.removeprefix("S-").replace(", " + STRICT, " (strict)")
            for point in of:
                at = OWN_TESTS if wrong and name[:3] in ("fcl", "ode") else name
                if not wrong and name == "FAR (OBB)" and point[2] > 0:
                    if point[2] not in shown:
                        continue  # other resolutions are only in the table
                    at = f"{name}, {point[2]} px"
                (above if wrong else rows).setdefault(at, []).append(point)
        panels.append(Panel(title, log(label), log("errors (%)", zero=True), [cloud(*of) for of in above.items()]))
        strips.append(rows)
    fastest = {name: min(time.value for strip in strips for time, *_ in strip.get(name, ()))
               for strip in strips for name in strip}
    names = sorted(fastest, key=lambda name: (not name.startswith("FAR"), name.split(",")[0] if name.startswith(
        "FAR") else "", len(name) if name.startswith("FAR") else 0, fastest[name]))
    for panel, strip in zip(panels, strips):
        panel.strip = [cloud(name, strip.get(name, [])) for name in names]
    return panels


def figure_of(groups):
    shown, sample = groups[:MOST_SCENES], sample_of(groups)
    points = []
    for group in shown:
        points.append({})
        for e in group.entries:
            points[-1].setdefault(e.name, []).append((e.median, share(e.error, e.colliding), e.pixels))
    titles, labels = [group.title for group in shown], ["time (ms)"] * len(shown)
    summary, scenes = summary_of(shown)
    if summary:
        points, titles = points + [summary], titles + [f"all {len(scenes)} scenes"]
        labels.append("time / that of exact")
    error = Figure(
        "error-time", "Methods that are wrong (points), and those that never are (rows), by run time",
        "Points: pairs that are missed plus pairs that are reported and do not collide, of all that collide, over the "
        "median time from triangles to pairs, with its interval as a bar. Lines follow the resolution. Rows, on "
        "the same time axis: the methods that made no error in this scene, FAR (OBB) at every second resolution; "
        "the others are in the CSV of all rows. CULLIDE (strict): one round, conservative rasterization, all views have to "
        "clear a triangle. On one object, CULLIDE is S-CULLIDE. Of scenes that are drawn with several "
        "seeds, the sum of the errors and the median of the times.", error_panels(titles, labels, points))
    if summary:
        error.caption += (
            f" Last panel: geometric means of the times over {listed(scenes)}, each divided by that of `exact` (boxes "
            "and exact tests) on the same scene, with the 95 % interval over the scenes (Student's t of the "
            "logarithms), and all errors together, of what was measured on each.")
    error.caption += f" {sample}."
    return error


# ---- tables

def front_table(groups):
    out = Table("error-time-front", "The Pareto fronts: nothing is as fast with as few errors. Times are medians "
                "of the ratios of runs in the same turn, with their intervals",
                columns(["scene", "method"], ["ms", "time over that of exact", "missed", "wrong", "colliding"]))
    for group in groups:
        peer = group.yardstick()
        out.rows += [[group.name, e.words, rounded(e.ms), estimate_text(peer and ratio_estimate(e.rounds, peer.rounds)),
                      grouped(e.missed), grouped(e.wrong), grouped(e.colliding)] for e in group.front()]
    return out


def equal_times(group):
    """Returns for FAR at each resolution the run of CULLIDE with the fewest errors among the runs that took no longer than
    FAR; None if there is no such run. CULLIDE may have any form and resolution."""
    rivals = [e for e in group.entries if "cullide" in e.row.method]
    return [(far, min((e for e in rivals if e.ms <= far.ms), key=lambda e: e.error, default=None))
            for far in group.entries if far.name == "FAR (OBB)"]


def equal_table(groups):
    out = Table("error-time-equal", "CULLIDE in the time that FAR takes: of all its forms and resolutions whose median "
                "time is no longer, the one with the fewest errors. Candidates are what each leaves to exact tests: a "
                "form that leaves as many as boxes alone has culled nothing",
                columns(["scene"], ["FAR (OBB) at (px)", "ms", "its candidates"], ["CULLIDE within it"],
                        ["its ms", "its candidates", "missed by CULLIDE"]))
    for group in groups:
        for far, best in equal_times(group):
            out.rows.append([group.name, str(far.pixels), rounded(far.ms), grouped(far.candidates)] + (
                [best.words, rounded(best.ms), grouped(best.candidates), of_all(best.missed, best.colliding)] if best
                else ["none is as fast", "-", "-", "-"]))
    return out


# ---- findings

def add_equal_times(chapter, groups):
    """Adds a finding: the number of cases in which the best CULLIDE that takes no longer than FAR misses pairs."""
    cases = [best for group in groups for _, best in equal_times(group)]
    if not cases:
        return
    missing, slower = sum(b is not None and b.missed > 0 for b in cases), sum(b is None for b in cases)
    chapter.find("In the time that FAR (OBB) takes, the best CULLIDE (of all forms and resolutions that were measured) "
                 f"misses pairs in {of_all(missing, len(cases))} cases of scene and resolution of FAR" +
                 (f", and no CULLIDE is as fast in {grouped(slower)}." if slower else "."))


def add_fastest(chapter, groups):
    """Adds a finding: the fastest methods without an error, on the scenes that have valid times."""
    timed = [group for group in groups if group.entries]
    if not timed:
        chapter.find("No time is valid, so no method is the fastest.")
        return
    right = [min((e for e in group.entries if e.error == 0), key=lambda e: e.ms, default=None) for group in timed]
    times = Counter(entry.name if entry else "no method" for entry in right).most_common()
    chapter.find(f"Fastest without an error: {listed(f'{name} on {of_all(n, len(timed))} scenes' for name, n in times)}.")


def fill(chapter, study):
    rows = study.rows
    groups = groups_of(rows, study.constants["scenes"])
    add_promises(chapter, study)
    add_equal_times(chapter, groups)
    if groups:
        add_fastest(chapter, groups)
    for name in ("fcl-float", "fcl-double", "ode-trimesh"):  # libraries that have their own test of triangles
        if len(of := rows[rows.method == name]):
            chapter.find(f"{name} misses {of_rows(of, 'missed', 'colliding')} colliding pairs and reports "
                         f"{grouped(total(of, 'wrong'))} that do not collide, in {grouped(len(of))} scenes.")
    if groups:
        chapter.figures, chapter.tables = [figure_of(groups)], [front_table(groups), equal_table(groups)]
