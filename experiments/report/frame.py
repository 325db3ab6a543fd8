"""The parts of a chapter of the report, and functions on the rows of its study.

How to write a chapter. The file chapters/NAME.py (dashes become underscores) is the chapter of the study NAME, and has one
function `fill(chapter, study)`, which returns nothing. The fill() of frame.py calls this function with two arguments:

- `chapter` is a Chapter with title, question and command. Add sentences by `chapter.find(text)` and
  `chapter.find_broken(text)` (broken promises, which the report puts first), and Figure, Table, Picture and files to their
  lists. In text, put `backticks` around commands.
- `study.rows` is a pandas DataFrame of the measured rows, in the order of the grid. `study.all_rows` also has rows of
  points that were not measured; their column `left_out` says why. `study.points` is the whole grid. The columns are
    - each axis of the point: scene, method, offset, radius, depth_format, depth_mode, views (texts, "" where they do not
      apply), resolution (0: none), frame (-1: none), seed (0: none);
    - each count, by its name, or NAME_count if an axis has that name; NaN if the row has none;
    - each time, as NAME_ms ("total_ms"); `runs`, a tuple of the times of the runs, perhaps empty; and `rounds`, a tuple of
      such tuples, one for each round; the tuple of a void round is empty;
    - `contestant`: the method as figures and tables name it ("FAR (OBB)").
- Read columns that a store may lack by `column(rows, name)`, `total(rows, name)`, `value(row, name)`; a row is one of
  `rows.itertuples()`, with columns as attributes.
- Format numbers with estimates.py (all of its names are here too), never by hand.

farcull_report_fixture DIR (tests) makes a store with rows of every study to try a chapter with. chapters/devices.py is no
chapter: its `fill(chapter, study, device, others)` adds the results of further devices to any chapter; `others`: pairs of
a device's name and its Study.

chapters/offsets.py is a short example. A figure should have at most six series a panel; its `n` states the size of its
sample, and its caption and title say what it shows. Zeros on a logarithmic axis need Axis(..., zero=True), and are then drawn
at zero.
"""
import importlib
import json
import math
import re
import shlex
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

from estimates import *  # noqa: F401,F403: chapters take numbers from here
from estimates import (FEWEST_FOR_INTERVAL, NONE, Estimate, counted, estimate_text, exponent_of, exponent_text, grouped,
                       listed, median_estimate, of_all, rounded, share)


class Damaged(ValueError):
    """Raised if a chapter cannot read a text of a row."""


@dataclass
class Series:
    """Points of one line or cloud. x and y have the same length. NaN makes a gap."""
    name: str
    x: list = field(default_factory=list)
    y: list = field(default_factory=list)
    style: str = "lines_points"  # or "lines", "points"
    emphasis: bool = False       # drawn with thick lines: a method of farcull, or the subject of the figure
    x_low: list = field(default_factory=list)  # lower ends of intervals along x; one per point, or none
    x_high: list = field(default_factory=list)
    y_low: list = field(default_factory=list)
    y_high: list = field(default_factory=list)
    labels: list = field(default_factory=list)  # texts beside the points, which replace a key; one per point, or none


@dataclass
class Mark:
    """A line across the panel, such as the budget radius, with its name."""
    at: float
    name: str
    vertical: bool = True


@dataclass
class Axis:
    """A logarithmic axis that shows zeros has a linear, shaded part from 0 to 1. If values are below 1, this part ends at a
    power of ten below all values."""
    label: str = ""  # with the unit, such as "time (ms)"
    log: bool = False
    zero: bool = False
    low: float = None  # lower end of the axis; None: computed from the values
    high: float = None
    even: bool = False  # true: ticks are only at the values of the series, equally spaced


def log(label, zero=False, low=None, high=None):
    return Axis(label, True, zero, low, high)


@dataclass
class Panel:
    title: str
    x: Axis = field(default_factory=Axis)
    y: Axis = field(default_factory=Axis)
    series: list = field(default_factory=list)
    marks: list = field(default_factory=list)
    strip: list = field(default_factory=list)  # Series objects without y values; each is drawn as a row below the panel


@dataclass
class Figure:
    name: str  # name of the figure's files; [a-z0-9-]
    title: str
    caption: str = ""
    panels: list = field(default_factory=list)
    columns: int = 0      # number of columns of panels, up to 4; 0: draw.py chooses
    narrow: bool = False  # true: the figure is as wide as one of two columns of a journal
    named: bool = False   # true: each series is one point, labelled with its name; no key


@dataclass
class Table:
    """columns: pairs of a name and "l" (text) or "r" (number), as columns() makes them."""
    name: str
    caption: str
    columns: list
    rows: list = field(default_factory=list)  # each row is a list of texts


@dataclass
class Picture:
    """arguments: words of `farcull picture`, without -o."""
    name: str
    title: str
    caption: str
    arguments: list


@dataclass
class Chapter:
    study: str
    title: str
    question: str
    command: str  # the command that measures the study again
    findings: list = field(default_factory=list)  # pairs (broken, sentence); broken: a guarantee was broken
    limits: list = field(default_factory=list)    # sentences about what was not measured
    figures: list = field(default_factory=list)
    tables: list = field(default_factory=list)
    pictures: list = field(default_factory=list)
    files: dict = field(default_factory=dict)     # additional files of the report: name -> text

    def find(self, text):
        self.findings.append((False, text))

    def find_broken(self, text):
        self.findings.append((True, text))


@dataclass
class Study:
    """The rows of one study. The beginning of this file describes them."""
    name: str
    quick: bool
    seed: int
    points: pd.DataFrame
    all_rows: pd.DataFrame
    constants: dict = field(default_factory=dict)  # constants of the program, by name
    folder: str = ""  # folder of the store

    @property
    def rows(self):
        return self.all_rows[self.all_rows.left_out == ""]

    @property
    def complete(self):
        return len(self.all_rows) == len(self.points) and bool(self.all_rows.whole.all())


# ---- names of points

METHODS = {"boxes": "Boxes", "cullide": "CULLIDE", "quick-cullide": "Quick-CULLIDE",
           "s-cullide": "S-CULLIDE", "i-collide": "I-COLLIDE"}
BOTH_DIRECTIONS = "x,-x,y,-y,z,-z"


def method_label(point):
    """Returns the name of a method with its form, such as `FAR (OBB)` or `CULLIDE, one round, all views`."""
    method, _, form = point.method.partition(" ")
    out = METHODS.get(method, method)
    if method == "far":
        out = "FAR (exact)" if point.offset == "exact" else "FAR (OBB)"
    elif method.startswith("far-snapped-"):
        out = f"FAR (OBB), {method[len('far-snapped-'):]} subpixel bits"
    words = form.split()
    if "--rounds" in words:
        rounds = words[words.index("--rounds") + 1]
        out += ", one round" if rounds == "1" else f", {rounds} rounds"
    for option, label in (("--clear all", ", all views"), ("--level objects", ", objects alone"),
                          ("--conservative", ", conservative")):
        out += label if option in form else ""
    if "@" in form:
        out += f", {form.split('@')[1].split('px')[0]} px a triangle"
    return out


def contestant(point):
    """Returns method_label(). Adds the radius if it is not the budget, and a note if views have both directions."""
    out = method_label(point)
    if point.radius not in ("", "budget"):
        published = point.radius == "published"
        out += ", published radius" if published else ", radius " + point.radius
    return out + (", both directions" if point.views == BOTH_DIRECTIONS else "")


def describe(point):
    """Returns a point in words, such as `two-bunnies, cullide, 512 px`."""
    cells = "cells" if point.method.startswith("voronoi") else "px"
    return ", ".join(word for word in (point.scene, point.method, point.offset, "radius " + point.radius if point.radius
                                       not in ("", "budget") else "", "24-bit depth" if point.depth_format == "fixed24"
                                       else "", "fixed-function depth" if point.depth_mode == "fixed" else "",
                                       f"{point.resolution} {cells}" if point.resolution > 0 else "", "views " +
                                       point.views if point.views else "", f"frame {point.frame}" if point.frame >= 0
                                       else "", f"seed {point.seed}" if point.seed > 0 else "") if word)


def scene_base(scene):
    """Returns the name of a scene without its seed: `field` for `field@seed101`."""
    return scene.split("@seed")[0]


NOT_SNAPPED = ("the native canvas, which drew this, does not snap corners of triangles to a grid; devices of OpenGL do, "
               "for example Mesa's to 8 bits of a pixel")


def not_snapped(rows):
    """Returns NOT_SNAPPED in brackets if the native canvas drew all rows; otherwise ""."""
    return f" ({NOT_SNAPPED})" if len(rows) and "device" in rows and (rows.device == "native").all() else ""


# ---- values of rows

def value(row, name):
    """Returns a number of a row; NaN if the row has no such number."""
    out = getattr(row, name, NONE)
    number = isinstance(out, (int, float)) or hasattr(out, "dtype")
    return out if number and not isinstance(out, bool) else NONE


def flag(row, name):
    """Returns true if the row's value in the column `name` is True."""
    return getattr(row, name, False) is True


def text(row, name):
    """Returns the value of a row in the column `name` if the value is a string; else ""."""
    out = getattr(row, name, "")
    return out if isinstance(out, str) else ""


def number(row, name):
    """Returns a count as an integer; 0 if the row has no such count."""
    out = value(row, name)
    return 0 if out != out else int(out)


def column(rows, name):
    """Returns a column of numbers; NaN for rows without such a number."""
    if name not in rows:
        return pd.Series(NONE, rows.index, float)
    return pd.to_numeric(rows[name], errors="coerce")


def total(rows, name):
    """Returns the sum of a count over rows, an integer. Rows without the count add 0."""
    return sum(int(x) for x in column(rows, name).dropna())


def where_true(rows, name):
    """Returns the rows where the count of this name is true."""
    return rows[rows[name].map(lambda x: x is True)] if name in rows else rows.iloc[:0]


def promising(rows):
    """Returns the rows of methods that promise to miss nothing."""
    return where_true(rows, "promises")


def by(rows, name, sort=False):
    """Returns pairs: a value of the column and the rows with this value, in the order of first occurrence. name: a column, or
    a list of columns."""
    return list(rows.groupby(name, sort=sort)) if len(rows) else []


def groups(rows, name):
    """Returns the pairs of by(), sorted by the values."""
    return by(rows, name, True)


def resolutions(rows):
    """Returns all resolutions above 0, ascending."""
    return sorted(int(r) for r in set(rows.resolution) if r > 0)


def estimate(row):
    """Returns the median time of the row's runs, in ms, with its interval. One run has no interval. None if the row has no
    time."""
    if row.runs:
        return median_estimate(row.runs, row.rounds)
    one = value(row, "total_ms")
    return None if one != one else Estimate(one, one, one, 1)


def false_positives(row):
    """Returns the ratio of candidates that do not collide to colliding pairs; NaN if no pair collides."""
    colliding = value(row, "colliding")
    if not colliding > 0:
        return NONE
    return (value(row, "candidates") - (colliding - number(row, "missed"))) / colliding


def of_rows(rows, part, whole):
    """Returns the sums of two counts over the rows as a text such as `4 of 3,857`."""
    return of_all(total(rows, part), total(rows, whole))


def missed_of(rows):
    """Returns a text such as `4 of 3,857 (0.10 %, on 2 of 9 scenes)`. The share has no interval, since the pairs of a scene are
    not independent, and the scenes were chosen by hand."""
    missed, colliding = total(rows, "missed"), total(rows, "colliding")
    scenes = rows.scene.map(scene_base)
    hit = scenes[column(rows, "missed") > 0].nunique()
    more = f"{rounded(share(missed, colliding), 2)} %, " if missed else ""
    return f"{of_all(missed, colliding)} ({more}on {hit} of {counted(scenes.nunique(), 'scene', 'scenes')})"


def sample_text(rows):
    """Returns the size of the sample, such as `n = 24 points, each the median of 9 runs in 3 rounds`."""
    runs = sorted({max(len(r), 1) for r in rows.runs}) if len(rows) else []
    out = "n = " + counted(len(rows), "point", "points")
    if not runs:
        return out
    if runs[-1] == 1:
        return out + ", each of 1 run"
    several = str(runs[0]) if len(runs) == 1 else f"{runs[0]} to {runs[-1]}"
    rounds = max(len(of) for of in rows.rounds) if "rounds" in rows else 1
    return f"{out}, each the median of {several} runs" + (f" in {rounds} rounds" if rounds > 1 else "")


# ---- series and tables of rows

def series_of(name, rows, x, y, **look):
    """Returns a Series with a point for each row. x and y: functions of a row, or names of columns."""
    along = [(lambda row, n=f: value(row, n)) if isinstance(f, str) else f for f in (x, y)]
    return Series(name, *([of(row) for row in rows.itertuples()] for of in along), **look)


def line_of(name, values, style="lines_points", **look):
    """Returns a Series of a pandas Series, whose index is x."""
    return Series(name, list(values.index), list(values), style, **look)


def times_of(name, rows, x, **look):
    """Returns series_of() with y as the time from triangles to pairs, in ms, with the interval of each time."""
    none = Estimate(NONE, NONE, NONE, 0)
    times = [estimate(row) or none for row in rows.itertuples()]
    low, high = ([getattr(time, end) if time.n > 1 else NONE for time in times] for end in ("low", "high"))
    return series_of(name, rows, x, lambda row: (estimate(row) or none).value, y_low=low, y_high=high, **look)


def columns(texts, numbers, more_texts=(), more_numbers=()):
    """Returns columns for a Table, in this order: texts, numbers, more_texts, more_numbers."""
    sides = ((texts, "l"), (numbers, "r"), (more_texts, "l"), (more_numbers, "r"))
    return [(name, side) for names, side in sides for name in names]


def count_cell(row, name):
    """Returns a count as a text; `-` if the row has no such count."""
    out = value(row, name)
    return "-" if out != out else grouped(out)


def table_of_rows(name, caption, rows, cells):
    """Returns a table with a line for each row. cells: for each column, a function of the row; or `NAME` of a count, to group
    its digits; or `~NAME`, to round it; or `=NAME` for a text."""
    def filled(row, cell):
        if callable(cell):
            return cell(row)
        if cell[0] == "~":
            return rounded(value(row, cell[1:]))
        return getattr(row, cell[1:]) if cell[0] == "=" else count_cell(row, cell)

    sides = ["l" if isinstance(cell, str) and cell[0] == "=" else "r" for cell in cells.values()]
    return Table(name, caption, list(zip(cells, sides)), [[filled(row, cell) for cell in cells.values()] for row in
                                                          rows.itertuples()])


def estimate_cell(row):
    """Returns the time of a row with its interval, as a cell for table_of_rows()."""
    return estimate_text(estimate(row))


def exponents_table(name, x):
    return Table(
        name, f"Exponent b of time = a x^b over {x}, by least squares in logarithms over the whole range, with its 95 % "
        f"interval (Student's t of the residuals; not given for fewer than {FEWEST_FOR_INTERVAL} points)",
        columns(["x", "method"], ["from", "to", "points", "exponent"]))


def times_panel(title, axis, x, methods, exponents, plot):
    """Returns a panel of times over the column x. methods: for each name, whether the line is emphasised, and the rows. Adds a
    row for each method to the table `exponents`."""
    out = Panel(title, log(axis, zero=True), log("time (ms)"))
    for name, (emphasis, rows) in methods.items():
        out.series.append(times_of(name, rows, x, emphasis=emphasis))
        if e := exponent_of(out.series[-1].x, out.series[-1].y):
            exponents.rows.append([plot, name, rounded(e.first), rounded(e.last), grouped(e.points), exponent_text(e)])
    return out


# ---- findings that every chapter has

def is_lemma(row):
    """Returns true if the row's promise is about violated points; false if it is about missed pairs."""
    return row.method.startswith("lemma")


def failures(row):
    """Returns the count that the promise of the row is about; NaN if the row has no such count."""
    return value(row, "violations" if is_lemma(row) else "missed")


def breaks(row):
    """Returns true if the row broke a promise."""
    return row.left_out == "" and flag(row, "promises") and failures(row) > 0


def add_broken(chapter, rows):
    """Adds a finding for each row that broke a promise."""
    for row in rows.itertuples():
        if breaks(row):
            part = of_all(failures(row), number(row, "points" if is_lemma(row) else "colliding"))
            chapter.find_broken(describe(row) + (
                f": {part} points are violated, and the lemmas promise none." if is_lemma(row)
                else f" misses {part} colliding pairs, and promises to miss none."))


def add_promises(chapter, study):
    """Adds a finding for each row that broke a promise. If no row broke a promise, adds how many pairs and points were tested.
    Adds how many rows have a promise but no count of misses."""
    rows = promising(study.rows)
    lost = pd.Series([failures(row) for row in rows.itertuples()], rows.index, float)
    silent, known = int(lost.isna().sum()), rows[lost.notna()]
    lemma = known.method.str.startswith("lemma")
    add_broken(chapter, known)
    pairs, points = known[~lemma], known[lemma]
    if len(pairs) and not (lost[pairs.index] > 0).any():
        add_kept(chapter, study.rows, pairs)
    if len(points) and not (lost[points.index] > 0).any():
        smaller = study.rows[study.rows.method.str.startswith("lemma") & (study.rows.radius == "0.9") &
                             (study.rows.depth_mode != "fixed")]
        chapter.find(f"The lemmas are violated at {of_all(0, total(points, 'points'))} points "
                     f"in {counted(len(points), 'run', 'runs')}; " + (
                         f"with 0.9 of the radius at {of_rows(smaller, 'violations', 'points')}." if len(smaller) else
                         "a smaller radius was not tried."))
    if silent:
        chapter.find(f"{'One row' if silent == 1 else grouped(silent) + ' rows'} of methods that "
                     f"promise {'does' if silent == 1 else 'do'} not say what they missed.")


# ---- devices that computed the rows, and pairs that could have been missed

def same_pixels(rows, row):
    """Returns the rows with the same scene, frame, resolution and views as `row`."""
    views = ("", "x,y,z") if row.views in ("", "x,y,z") else (row.views,)
    return rows[(rows.scene == row.scene) & (rows.frame == row.frame) & (rows.resolution == row.resolution) &
                rows.views.isin(views)]


def at_risk(rows, row):
    """Returns how many pairs FAR loses with 0.9 of the radius, and how many with radius 0 (no ball), in the scene, views and
    pixels of the row. NaN: not known. If FAR was not run with radius 0, the second number is how many pairs CULLIDE lost."""
    if row.method != "far":
        return NONE, NONE
    here = same_pixels(rows, row)
    fars = here[here.method == "far"]
    own = fars[(fars.offset == row.offset) & (fars.depth_mode == row.depth_mode)]
    bare = [column(own[own.radius.isin(["", "budget"])], "at_risk_bare"), column(own[own.radius == "0"], "missed"),
            column(here[here.method == "cullide"], "missed")]
    smaller = [column(own[own.radius.isin(["", "budget"])], "at_risk"), column(own[own.radius == "0.9"], "missed")]
    return tuple(next((value for values in known for value in values if value == value), NONE) for known in (smaller, bare))


def risk_text(rows, pairs):
    """Returns a text such as `at risk there: 9 pairs with 0.9 of the radius and 12 without a ball`."""
    if not len(pairs):
        return ""
    words = []
    for values, radius in zip(zip(*(at_risk(rows, row) for row in pairs.itertuples())), (
            "with 0.9 of the radius", "without a ball")):
        if known := [value for value in values if value == value]:
            part = "" if len(known) == len(values) else f" (counted in {of_all(len(known), len(values))} runs)"
            words.append((sum(known), f"{counted(sum(known), 'pair', 'pairs')} {radius}{part}"))
    if not words:
        return "how many pairs were at risk was not counted"
    if not any(count for count, _ in words):
        return "no pair was at risk, so this says nothing about the radius"
    small = len(words) == 2 and words[0][0] == 0
    return f"at risk there: {listed(text for _, text in words)}" + (
        ", so these scenes test that a ball is needed, not how large it has to be" if small else "")


def culled_shares(rows):
    """Returns how many per cent of all triangles boxes culled, and how many per cent views culled. If an object is tested against
    itself, FAR keeps some triangles without any view, for pairs in one patch. Such triangles count as left by boxes."""
    triangles, kept = total(rows, "triangles"), total(rows, "kept_triangles")
    left = int(np.fmax(column(rows, "left_by_boxes"), column(rows, "kept_triangles")).sum())
    return share(triangles - left, triangles), share(left - kept, triangles)


def without_size(row):
    """Returns the contestant's name without " @SIZE". SIZE, a size of triangles, only determined the resolution."""
    return contestant(row._replace(method=row.method.split(" @")[0]))


def add_kept(chapter, rows, pairs):
    """Adds findings that the rows missed nothing. One is about rows in which views decided; these could have lost the pairs at
    risk. Another is about rows in which boxes alone decided; these could not have lost a pair."""
    used = column(pairs, "views_used")
    for runs, words in ((pairs[used > 0], " in which views decided"), (pairs[used == 0], " in which boxes alone decided"),
                        (pairs[used.isna()], "")):
        if not len(runs):
            continue
        names = [without_size(row) for row in runs.itertuples()]
        drawn = not (column(runs, "views_used") == 0).all()
        chapter.find(f"{listed(dict.fromkeys(names))} missed {of_all(0, total(runs, 'colliding'))} colliding pairs "
                     f"in {counted(len(runs), 'run', 'runs')} on "
                     f"{counted(runs.scene.map(scene_base).nunique(), 'scene', 'scenes')}{words}; " + (
                         risk_text(rows, runs) if drawn else
                         "no view was drawn, so these tested no radius, pixel or depth") + ".")


def fill(chapter, study):
    """Fills the chapter with the fill() of the chapter's file. Leaves out figures without panels and tables without rows."""
    importlib.import_module("chapters." + study.name.replace("-", "_")).fill(chapter, study)
    chapter.figures = [figure for figure in chapter.figures if figure.panels]
    chapter.tables = [table for table in chapter.tables if table.rows]
    add_gaps(chapter, study)


def add_gaps(chapter, study):
    """Adds the reasons why points and times were left out, and the number of points without a row, to chapter.limits."""
    reasons = study.all_rows.left_out[study.all_rows.left_out != ""]
    for reason, count in sorted(reasons.value_counts().items()):
        chapter.limits.append(f"Left out at {of_all(count, len(study.points))} points: {reason}.")
    rows = study.rows
    if void := rows.void.sum():
        chapter.limits.append(
            f"{counted(void, 'round', 'rounds')} of {of_all((rows.void > 0).sum(), (rows.rounds.map(len) > 0).sum())} "
            "timed points are void and left out, since other programs took the processors meanwhile.")
    if untimed := rows.untimed.sum():
        chapter.limits.append(f"{counted(untimed, 'point', 'points')} have no times: they were measured with `--no-times`.")
    if not study.complete:
        chapter.limits.append(f"Not finished: {of_all(study.all_rows.whole.sum(), len(study.points))} points are measured.")


def command_of(study, runs):
    """Returns the command `farcull experiment NAME` with the options of the last run that measured the rows."""
    words = ["farcull", "experiment", study.name] + ["--quick"] * study.quick
    words += ["--seed", str(study.seed)] if study.seed != 1 else []
    last = study.all_rows.run.max() if len(study.all_rows) else 0
    for options in runs.options[runs.run == last]:
        try:
            options = json.loads(options)
        except ValueError:
            options = {}
        for name in ("suite", "contestants", "device"):
            if isinstance(options, dict) and isinstance(options.get(name), str) and options[name]:
                words += ["--" + name, shlex.quote(options[name])]
    return " ".join(words)
