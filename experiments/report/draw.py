"""Figures as files: NAME.svg, NAME.pdf and their numbers as NAME.csv, drawn by matplotlib.

This file places panels, labels and the key, in points from the top left corner, so that nothing
overlaps and the same numbers give the same file. Colours are those of Okabe and Ito (2008) and of
Tol's "muted" scheme, which differ for any colour vision; dashes and markers differ in grey too. A
name that begins with a method has the method's colour in every figure.
"""
import csv
import html
import io
import math
import os
import re
from dataclasses import dataclass, field

import matplotlib
matplotlib.use("Agg")
from matplotlib import font_manager, pyplot, textpath  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.patches import Rectangle  # noqa: E402

from estimates import listed, sentence  # noqa: E402
from scales import Scale, scale_of, tick_label  # noqa: E402

pyplot.style.use(os.path.join(os.path.dirname(os.path.abspath(__file__)), "journal.mplstyle"))

DOUBLE, SINGLE = 504.0, 244.0  # widths of two columns of a journal and of one, 178 and 86 mm
LINE = 11.0   # distance of lines of text
ROW = 10.5    # height of a row of the strip
FAMILIES = "'DejaVu Sans', Helvetica, Arial, sans-serif"
NOTE = "Shaded: the axis is linear, from 0 to the end of the shade. Beyond, it is logarithmic."

SOLID, DASHES = "-", ["-", (0, (5, 2.5)), (0, (1, 1.5)), (0, (5, 2, 1, 2)), (0, (8, 2))]
MARKERS = ["o", "s", "^", "v", "D", "o ", "s ", "^ ", "v ", "D "]  # a blank marks a hollow one
KNOWN = [  # the first entry whose words are in a name applies
    ("far pairs", "#009e73", 0, "^"), ("interval", "#009e73", 0, "^"),
    ("far exact", "#56b4e9", 0, "s"), ("exact offset", "#56b4e9", 0, "s"),
    ("far", "#0072b2", 0, "o"), ("obb union", "#0072b2", 0, "o"),
    ("quick cullide", "#e69f00", 1, "^ "), ("s cullide", "#cc79a7", 3, "D "),
    ("cullide", "#d55e00", 1, "o "), ("i collide", "#777777", 3, "s "),
    ("cgal", "#882255", 2, "v "), ("fcl", "#aa7744", 2, "D"), ("embree", "#999933", 2, "v"),
    ("exact", "#000000", 2, "+"), ("colliding", "#000000", 2, "+"), ("ode", "#661100", 2, "x")]
FREE = ["#332288", "#117733", "#cc6677", "#44aa99", "#aa4499", "#888800", "#661100", "#6699cc", "#555555", "#dd8800"]


@dataclass
class Look:
    colour: str
    dash: object
    marker: str
    width: float = 1.0
    size: float = 3.2

    def line(self):
        return {"color": self.colour, "linestyle": self.dash, "linewidth": self.width}

    def points(self):
        hollow = self.marker.endswith(" ") or self.marker in "+x"
        return {"color": self.colour, "linestyle": "none", "marker": self.marker.strip(), "markersize": self.size,
                "markeredgewidth": 0.8, "markerfacecolor": "none" if hollow else self.colour}


def series_names(figure):
    return list(dict.fromkeys(s.name for panel in figure.panels for s in panel.series + panel.strip))


def mark_names(figure):
    return list(dict.fromkeys(m.name for panel in figure.panels for m in panel.marks if m.name))


def looks_of(figure):
    """A Look for each name. Later names of one method have other dashes and markers. Emphasised lines are thick, and
    each is thinner than those below it, so that lines with the same values all stay visible."""
    out, times, unknown, thick = {}, {}, 0, 0
    emphasised = {s.name for panel in figure.panels for s in panel.series if s.emphasis}
    for name in series_names(figure):
        words = " " + re.sub(r"[^a-z0-9]+", " ", name.split(" = ")[0].lower()) + " "
        known = next((k for k in KNOWN if f" {k[0]} " in words), None)
        if known:
            n = times[known] = times.get(known, -1) + 1
            at = MARKERS.index(known[3]) if known[3] in MARKERS and n else 0
            look = Look(known[1], DASHES[(known[2] + n) % len(DASHES)],
                        MARKERS[(at + n) % len(MARKERS)] if n else known[3])
        else:
            look = Look(FREE[unknown % len(FREE)], DASHES[(unknown + unknown // len(FREE)) % len(DASHES)],
                        MARKERS[(unknown + unknown // len(MARKERS)) % len(MARKERS)])
            unknown += 1
        if name in emphasised:
            look.width, look.size = 2.4 - 0.6 * min(thick, 2), 4.8 - 0.8 * min(thick, 2)
            thick += 1
        out[name] = look
    return out


def text_width(text, size=8):
    font = font_manager.FontProperties(family="DejaVu Sans", size=size)
    return textpath.text_to_path.get_text_width_height_descent(text, font, False)[0]


# ---- layout

@dataclass
class Placed:
    """A placed panel: left, right, top, bottom of the plot, in points from the top left."""
    panel: object
    x: Scale = None
    y: Scale = None
    labels: list = field(default_factory=lambda: [True, True])  # whether the labels of x and y are drawn
    room: float = 10.0  # left of the axis for ticks, names of the strip and the label
    box: tuple = ()

    @property
    def strip(self):
        return ROW * len(self.panel.strip) + (4 if self.panel.strip else 0)


def columns_for(figure):
    panels = len(figure.panels)
    if panels == 1 or panels == 2 or (panels == 4):
        return min(panels, 2)
    fits = all(text_width(p.title) < DOUBLE / 3 - 12 for p in figure.panels)
    return 3 if fits and not any(p.strip for p in figure.panels) else 2


def values_along(panel, side):
    out = [m.at for m in panel.marks if m.vertical == (side == "x")]
    for s in panel.series + (panel.strip if side == "x" else []):
        for name in (side, side + "_low", side + "_high"):
            out += list(getattr(s, name))
    return out


def fit_drawing(placed):
    """Gives x and y the same scale, and leaves a tenth of the longer side free."""
    left, right, top, bottom = placed.box
    ranges = []
    for side in "xy":
        values = [v for v in values_along(placed.panel, side) if math.isfinite(v)] or [0.0]
        ranges.append((min(values), max(values)))
    size = max(abs(v) for ends in ranges for v in ends)
    unit = max(1.1 * max((ranges[0][1] - ranges[0][0]) / (right - left),
                         (ranges[1][1] - ranges[1][0]) / (bottom - top)),
               1e-9 * size if size > 0 else 1)
    for side, ends, room in (("x", ranges[0], right - left), ("y", ranges[1], bottom - top)):
        middle = ends[0] + (ends[1] - ends[0]) / 2
        setattr(placed, side, Scale(False, middle - unit * room / 2, middle + unit * room / 2))


def wrapped(label, room):
    """The label, in two lines if it is longer than the axis."""
    if text_width(label) <= room or " " not in label:
        return label
    at = min((m.start() for m in re.finditer(" ", label)), key=lambda i: abs(i - len(label) / 2))
    return label[:at] + "\n" + label[at + 1:]


class Layout:
    def __init__(self, figure):
        self.figure, self.looks = figure, looks_of(figure)
        self.columns = columns_for(figure)
        self.key = [n for n in series_names(figure) if any(s.name == n for p in figure.panels for s in p.series)]
        self.key += mark_names(figure)
        single = len(figure.panels) == 1 and not figure.panels[0].strip
        narrow = single and all(text_width(n) + 34 < SINGLE - 8 for n in self.key)
        self.width = SINGLE if narrow else DOUBLE
        figure.narrow = narrow
        self.high = 190.0 if single and not narrow else (0, 150.0, 150.0, 105.0)[self.columns]
        self.direct = self.width == DOUBLE and single and self.can_label()
        self.placed = [Placed(panel) for panel in figure.panels]
        lefts = self.scale_panels()
        right = 12.0 + (max(text_width(n) for n in self.key) if self.direct else 0)
        wide = (self.width - sum(lefts) - right * self.columns) / self.columns
        top = self.place_panels(lefts, right, wide)
        self.place_key(top)

    def can_label(self):
        """Whether the names are drawn at the ends of their lines instead of in a key."""
        panel = self.figure.panels[0]
        return (not panel.drawing and not panel.marks and 0 < len(self.key) <= 6 and
                all(s.style in ("lines", "lines_points") and len(s.x) > 1 for s in panel.series)
                and max(text_width(n) for n in self.key) < 0.35 * self.width)

    def scale_panels(self):
        """Sets the scales of all panels; returns the room left of each column. Labels that all panels
        share are drawn only at the first panel of a row and the last of a column."""
        panels, lefts = self.figure.panels, [0.0] * self.columns
        one_x, one_y = (len({getattr(p, side).label for p in panels}) == 1 for side in "xy")
        wide = self.width / self.columns - 50
        for i, placed in enumerate(self.placed):
            panel, column = placed.panel, i % self.columns
            if not panel.drawing:
                placed.x = scale_of(panel.x, values_along(panel, "x"), lambda ticks: sum(
                    text_width(label) + 7 for _, label in ticks if label) <= wide)
                placed.y = scale_of(panel.y, values_along(panel, "y"), lambda ticks: sum(
                    1.5 * LINE for _, label in ticks if label) <= self.high)
                last = i + self.columns >= len(panels)
                placed.labels = [not one_x or last, not one_y or column == 0]
                label = wrapped(panel.y.label, self.high) if placed.labels[1] else ""
                names = [text_width(t) for _, t in placed.y.ticks]
                placed.room = max([0.0] + names) + 7 + LINE * (label.count("\n") + bool(label))
                placed.room = max([placed.room] + [text_width(s.name) + 7 for s in panel.strip])
            lefts[column] = max(lefts[column], placed.room + 2)
        return lefts

    def place_panels(self, lefts, right, wide):
        top, titled = 4.0, any(p.title for p in self.figure.panels)
        for row in range(0, len(self.placed), self.columns):
            here = self.placed[row:row + self.columns]
            top += LINE + 3 if titled else 2
            x = 0.0
            for column, placed in enumerate(here):
                x += lefts[column]
                placed.box = (x, x + wide, top, top + self.high)
                if placed.panel.drawing:
                    fit_drawing(placed)
                x += wide + right
            plots = any(not p.panel.drawing for p in here)
            labelled = any(p.labels[0] and p.panel.x.label for p in here)
            top += self.high + max(p.strip for p in here)
            top += LINE + 8 + (LINE if labelled else 0) if plots else 8
        return top

    def place_key(self, top):
        self.note_top = None
        names = [] if self.direct else self.key
        self.entries = []
        if names:
            entry = 34 + max(text_width(n) for n in names)
            columns = max(1, min(len(names), int((self.width - 8) / entry)))
            lines = -(-len(names) // columns)
            columns = -(-len(names) // lines)  # as even as possible
            start = max(4.0, (self.width - columns * entry + 10) / 2)
            self.entries = [(n, start + i % columns * entry,
                             top + LINE * (i // columns + 0.5)) for i, n in enumerate(names)]
            top += LINE * lines + 4
        if any(p.x and (p.x.linear_to or p.y.linear_to) for p in self.placed):
            self.note = NOTE if text_width(NOTE) < self.width - 8 else wrapped(NOTE, 0)
            self.note_top = top
            top += LINE * (1 + self.note.count("\n")) + 2
        self.height = math.ceil(top)


# ---- drawing

class Drawer:
    def __init__(self, figure):
        self.layout = Layout(figure)
        width, height = self.layout.width, self.layout.height
        self.canvas = pyplot.figure(figsize=(width / 72, height / 72))
        for placed in self.layout.placed:
            self.panel(placed)
        self.key()

    def x(self, points):
        return points / self.layout.width

    def y(self, points):
        return 1 - points / self.layout.height

    def text(self, x, y, text, **how):
        how = {"ha": "left", "va": "center", "color": "#222222", **how}
        return self.canvas.text(self.x(x), self.y(y), text, **how)

    def axes(self, left, right, top, bottom):
        return self.canvas.add_axes([self.x(left), self.y(bottom), self.x(right) - self.x(left),
                                     self.y(top) - self.y(bottom)])

    def panel(self, placed):
        panel, left, top = placed.panel, placed.box[0], placed.box[2]
        ax = self.axes(*placed.box)
        if panel.title:
            self.text(left, top - LINE / 2 - 2, panel.title, color="#000000")
        self.ticks(ax, placed)
        if panel.drawing:
            for side in ax.spines.values():
                side.set(visible=True, color="#dddddd")
            ax.grid(False)
        else:
            self.shade(ax, placed)
            self.labels(placed)
        for mark in panel.marks:
            at = (placed.x if mark.vertical else placed.y).place(mark.at)
            if not math.isnan(at):
                (ax.axvline if mark.vertical else ax.axhline)(at, **self.mark_look(mark.name))
        # Emphasised series first: they are thick, so a series with the same values stays visible above.
        drawn = [self.series(ax, placed, s)
                 for s in sorted(panel.series, key=lambda s: not s.emphasis)]
        if not any(drawn) and not panel.strip:
            ax.text(0.5, 0.5, "nothing was measured", transform=ax.transAxes, ha="center", va="center", color="#666666")
        if panel.strip:
            self.strip(placed)
        if self.layout.direct:
            self.direct(ax, placed)

    def ticks(self, ax, placed):
        for scale, axis, limits in ((placed.x, ax.xaxis, ax.set_xlim), (placed.y, ax.yaxis, ax.set_ylim)):
            limits(*scale.ends)
            major = [(scale.place(at), label) for at, label in scale.ticks if label]
            axis.set_ticks([at for at, _ in major], [label for _, label in major])
            axis.set_ticks([scale.place(at) for at, label in scale.ticks if not label], minor=True)
        if placed.panel.strip:
            ax.tick_params(axis="x", which="both", labelbottom=False)

    def labels(self, placed):
        panel, (left, right, top, bottom) = placed.panel, placed.box
        if placed.labels[0]:
            self.text((left + right) / 2, bottom + placed.strip + 1.5 * LINE + 4, panel.x.label, ha="center")
        if placed.labels[1]:
            label = wrapped(panel.y.label, bottom - top)
            ticks = max([0.0] + [text_width(t) for _, t in placed.y.ticks])
            self.text(left - ticks - 7 - LINE * (label.count("\n") + 1) / 2, (top + bottom) / 2,
                      label, ha="center", rotation=90, linespacing=1.1)

    def shade(self, ax, placed):
        """Shades the linear part of an axis that shows zeros, with a line at 0."""
        for scale, span, line in ((placed.x, ax.axvspan, ax.axvline), (placed.y, ax.axhspan, ax.axhline)):
            if scale.linear_to:
                span(scale.ends[0], scale.place(scale.linear_to), color="#f1f1ee", zorder=0)
                line(scale.place(0), color="#999999", linewidth=0.6, linestyle=(0, (1, 2)), zorder=0.6)

    def mark_look(self, name):
        dashes = [(0, (3, 2)), (0, (1, 1.5)), (0, (6, 2)), (0, (4, 1.5, 1, 1.5))]
        at = mark_names(self.layout.figure).index(name) if name else 0
        return {"color": "#444444", "linewidth": 0.9, "linestyle": dashes[at % len(dashes)], "zorder": 1.5}

    def bars(self, ax, look, x, y, low, high, horizontal):
        along = x if horizontal else y
        ends = [[max(0.0, a - l) if l == l and a == a else math.nan for a, l in zip(along, low)],
                [max(0.0, h - a) if h == h and a == a else math.nan for a, h in zip(along, high)]]
        if any(e == e for e in ends[0]):
            ax.errorbar(x, y, **{"xerr" if horizontal else "yerr": ends}, fmt="none",
                        ecolor=look.colour, elinewidth=0.8, capsize=1.5, capthick=0.8)

    def series(self, ax, placed, s):
        """Draws a series; False if none of its points has a place."""
        look = self.layout.looks[s.name]
        x, y = [placed.x.place(v) for v in s.x], [placed.y.place(v) for v in s.y]
        if not any(a == a and b == b for a, b in zip(x, y)):
            return False
        clip = {"clip_on": placed.panel.x.low is not None or placed.panel.x.high is not None}
        if s.style == "area":
            ax.fill(x, y, color=look.colour, alpha=0.25, linewidth=0)
            ax.plot(x, y, **look.line())
            return True
        if s.x_low:
            self.bars(ax, look, x, y, *([placed.x.place(v) for v in ends] for ends in (s.x_low, s.x_high)), True)
        if s.y_low:
            self.bars(ax, look, x, y, *([placed.y.place(v) for v in ends] for ends in (s.y_low, s.y_high)), False)
        if s.style in ("lines", "lines_points"):
            ax.plot(x, y, **look.line(), **clip)
        if s.style in ("points", "lines_points"):
            ax.plot(x, y, **look.points(), **clip)
        return True

    def strip(self, placed):
        """Draws a row for each series below the panel, over the same x."""
        left, right, _, bottom = placed.box
        rows = placed.panel.strip
        ax = self.axes(left, right, bottom + 4, bottom + placed.strip)
        self.ticks(ax, Placed(type(placed.panel)("", placed.panel.x), placed.x, placed.y))
        ax.set_facecolor("none")
        ax.set_ylim(len(rows) - 0.5, -0.5)
        ax.set_yticks(range(len(rows)), [s.name for s in rows])
        ax.set_yticks([], minor=True)
        ax.tick_params(axis="y", length=0)
        for i, s in enumerate(rows):
            look, x = self.layout.looks[s.name], [placed.x.place(v) for v in s.x]
            if s.x_low:
                self.bars(ax, look, x, [i] * len(x), [placed.x.place(v) for v in s.x_low],
                          [placed.x.place(v) for v in s.x_high], True)
            ax.plot(x, [i] * len(x), **look.points(), clip_on=False)

    def direct(self, ax, placed):
        """Draws the name of each series beside its last point, and moves names apart that would overlap."""
        left, right, top, bottom = placed.box
        low, high = placed.y.ends
        ends = []
        for s in placed.panel.series:
            known = [y for y in (placed.y.place(v) for v in s.y) if y == y]
            if known:
                ends.append([bottom - (known[-1] - low) / (high - low) * (bottom - top), s.name])
        ends.sort()
        for i in range(1, len(ends)):
            ends[i][0] = max(ends[i][0], ends[i - 1][0] + LINE - 1)
        over = ends[-1][0] - bottom if ends else 0
        for end in reversed(ends):  # moves names up again if the last ones left the panel
            end[0] = min(end[0], bottom if over > 0 else end[0])
            bottom = min(bottom, end[0] - LINE + 1) if over > 0 else bottom
        for y, name in ends:
            self.text(right + 5, y, name, color=self.layout.looks[name].colour)

    def key(self):
        figure, styles = self.layout.figure, {}
        for panel in figure.panels:
            for s in panel.series:
                styles.setdefault(s.name, s.style)
        for name, x, y in self.layout.entries:
            self.text(x + 24, y, name)
            ends = [self.x(x), self.x(x + 20)], [self.y(y)] * 2
            if name not in styles:
                self.add(Line2D(*ends, **self.mark_look(name)))
                continue
            look, style = self.layout.looks[name], styles[name]
            if style == "area":
                self.add(Rectangle((ends[0][0], self.y(y + 3)), ends[0][1] - ends[0][0], self.y(y - 3) - self.y(y + 3),
                                   color=look.colour, alpha=0.25, linewidth=0))
            if style != "points":
                self.add(Line2D(*ends, **look.line()))
            if style in ("points", "lines_points"):
                self.add(Line2D([self.x(x + 10)], [self.y(y)], **look.points()))
        if self.layout.note_top is not None:
            self.text(self.layout.width / 2, self.layout.note_top + LINE * (1 + self.layout.note.count("\n")) / 2,
                      self.layout.note, ha="center", color="#555555", linespacing=1.1)

    def add(self, line):
        line.set_transform(self.canvas.transFigure)
        self.canvas.add_artist(line)


def numbers_of(figure):
    """The CSV of a figure: the drawn values, as they were measured."""
    out = io.StringIO()
    writer = csv.writer(out)
    ends = ("x_low", "x_high", "y_low", "y_high")
    writer.writerow(["panel", "series", "x", "y", *ends])

    def cell(values, i):
        known = i < len(values) and values[i] is not None and values[i] == values[i]
        return repr(float(values[i])) if known else ""

    for panel in figure.panels:
        for s in panel.series + panel.strip:
            for i in range(len(s.x)):
                writer.writerow([panel.title, s.name] + [cell(getattr(s, name), i) for name in ("x", "y", *ends)])
    return out.getvalue()


def files_of(figure):
    """The files of a figure by their kinds: svg and csv (texts), pdf (bytes). The SVG carries title and caption for
    readers who cannot see it."""
    canvas, svg, pdf = Drawer(figure).canvas, io.StringIO(), io.BytesIO()
    canvas.savefig(pdf, format="pdf", metadata={"CreationDate": None, "Title": figure.title})
    canvas.savefig(svg, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(canvas)
    words = f"<title>{html.escape(figure.title)}</title>\n<desc>{html.escape(figure.caption)}</desc>"
    out = re.sub(r"(<svg [^>]*>)", lambda m: m.group(1) + "\n " + words, svg.getvalue(), 1)
    return {"svg": out.replace("'DejaVu Sans'", FAMILIES), "pdf": pdf.getvalue(), "csv": numbers_of(figure)}


def inline_svg(svg, prefix):
    """An SVG for a page with others: its ids get a `prefix`."""
    out = svg[svg.index("<svg"):]
    return re.sub(r'( id="|href="#|url\(#)', lambda m: m.group(1) + prefix, out)


# ---- which parts of a figure to draw

LONGEST_NAME = 85  # characters that fit into the key


def same(a, b):
    return len(a) == len(b) and all(x == y or (x != x and y != y) for x, y in zip(a, b))


def agree(figure, one, other):
    for panel in figure.panels:
        a, b = ([s for s in panel.series if s.name == name] for name in (one, other))
        if len(a) != len(b) or any(
                x.style != y.style or not all(same(getattr(x, f), getattr(y, f)) for f in (
                    "x", "y", "x_low", "x_high", "y_low", "y_high")) for x, y in zip(a, b)):
            return False
    return True


def merge_series(figure):
    """Merges series that agree in every panel into one, whose name lists all of them."""
    groups = []
    for name in dict.fromkeys(s.name for panel in figure.panels for s in panel.series):
        group = next((g for g in groups if agree(figure, g[0], name)), None)
        if group:
            group.append(name)
        else:
            groups.append([name])
    emphasised = {s.name for panel in figure.panels for s in panel.series if s.emphasis}
    for group in groups:
        if len(group) == 1:
            continue
        # The first name gives the colour: the subject of the figure, or ours.
        group.sort(key=lambda n: not (n in emphasised or n.startswith("FAR")))
        name = " = ".join(group)
        if len(name) > LONGEST_NAME:
            few = f"{group[0]} and {len(group) - 1} others"
            figure.caption = f"{sentence(figure.caption)} {few}: {name}."
            name = few
        for panel in figure.panels:
            thick = any(s.name in group and s.emphasis for s in panel.series)
            panel.series = [s for s in panel.series if s.name not in group[1:]]
            for series in panel.series:
                if series.name == group[0]:
                    series.name, series.emphasis = name, thick


def drop_panels(figure):
    """Replaces panels without a difference by a sentence of the caption."""
    kept, constant, empty = [], {}, []
    for panel in figure.panels:
        values = [y for s in panel.series for y in s.y if math.isfinite(y)]
        if panel.drawing or panel.strip or any(y != values[0] for y in values):
            kept.append(panel)
        elif values:
            constant.setdefault(tick_label(values[0]), []).append(panel.title)
        else:
            empty.append(panel.title)
    if not kept:
        return
    figure.panels, figure.caption = kept, sentence(figure.caption)
    for value, titles in constant.items():
        figure.caption += f" Not drawn, since every value is {value}: {listed(titles)}."
    if empty:
        figure.caption += f" Not drawn, since there is no value: {listed(empty)}."


def legible(figure):
    drop_panels(figure)
    merge_series(figure)
