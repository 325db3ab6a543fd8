"""Figures as files: NAME.svg, NAME.pdf and their numbers as NAME.csv, drawn by matplotlib.

matplotlib places panels, and keeps text from overlapping. This file has the rules for sizes, ticks and looks. Colours are
from Okabe and Ito (2008) and from Tol's "muted" scheme; readers with any colour vision can tell them apart. Dashes and
markers can be told apart in grey. A name that begins with a method has the method's colour in every figure.
"""
import html
import io
import math
import re
from dataclasses import dataclass

import matplotlib
matplotlib.use("Agg")
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
from matplotlib import font_manager, pyplot, textpath, ticker, transforms  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402

from estimates import grouped, sentence  # noqa: E402

# The printed figures fit the columns of a journal and have text of 8 pt. Equal data give equal files.
matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "text.parse_math": False, "axes.unicode_minus": True, "lines.solid_capstyle": "butt",
    **dict.fromkeys(("font.size", "axes.titlesize", "axes.labelsize", "xtick.labelsize", "ytick.labelsize"), 8),
    **dict.fromkeys(("axes.linewidth", "xtick.major.width", "ytick.major.width"), 0.6), "grid.linewidth": 0.5,
    **dict.fromkeys(("axes.edgecolor", "xtick.color", "ytick.color"), "#444444"), "grid.color": "#e4e4e4",
    **dict.fromkeys(("xtick.labelcolor", "ytick.labelcolor"), "#222222"), "axes.grid": True, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False,
    **{f"{axis}tick.{name}": value for axis in "xy" for name, value in (
        ("major.size", 2.5), ("minor.size", 1.2), ("major.pad", 2))},
    "svg.hashsalt": "farcull", "svg.fonttype": "none", "pdf.fonttype": 42})

DOUBLE, SINGLE = 504.0, 244.0  # widths in points: two columns of a journal (178 mm), one column (86 mm)
LINE = 11.0         # distance between lines of text, in points
DIGITS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
DASHES = ["-", (0, (5, 2.5)), (0, (1, 1.5)), (0, (5, 2, 1, 2)), (0, (8, 2))]
MARKERS = ["o", "s", "^", "v", "D", "o ", "s ", "^ ", "v ", "D "]  # a blank means a hollow marker
KNOWN = [  # (words, colour, dash, marker); the first entry whose words are in a name applies
    ("boxes", "#009e73", 0, "^"), ("farcull", "#009e73", 0, "o"), ("interval", "#009e73", 0, "^"),
    ("far exact", "#56b4e9", 0, "s"), ("exact offset", "#56b4e9", 0, "s"),
    ("far", "#0072b2", 0, "o"), ("obb union", "#0072b2", 0, "o"),
    ("quick cullide", "#e69f00", 1, "^ "), ("s cullide", "#cc79a7", 3, "D "),
    ("cullide", "#d55e00", 1, "o "), ("i collide", "#777777", 3, "s "),
    ("cgal", "#882255", 2, "v "), ("fcl", "#aa7744", 2, "D"), ("embree", "#999933", 2, "v"),
    ("fragment", "#0072b2", 0, "o"), ("fixed function", "#d55e00", 1, "s "), ("worst canvas", "#000000", 2, "^ "),
    ("exact", "#000000", 2, "+"), ("colliding", "#000000", 2, "+"), ("ode", "#661100", 2, "x")]
FREE = ["#332288", "#117733", "#cc6677", "#44aa99", "#aa4499", "#888800", "#661100", "#6699cc", "#555555", "#dd8800"]
ENDS = ("x_low", "x_high", "y_low", "y_high")


# ---- looks

@dataclass
class Look:
    colour: str
    dash: object
    marker: str
    width: float = 1.0
    size: float = 3.2

    def of(self, style):
        """Returns the arguments that matplotlib needs for a line with this look. style: Series.style."""
        hollow = self.marker.endswith(" ") or self.marker in "+x"
        return {"color": self.colour, "linestyle": "none" if style == "points" else self.dash, "linewidth": self.width,
                "marker": self.marker.strip() if "points" in style else "", "markersize": self.size,
                "markeredgewidth": 0.8, "markerfacecolor": "none" if hollow else self.colour}


def names_of(figure):
    return list(dict.fromkeys(s.name for panel in figure.panels for s in panel.series + panel.strip))


def looks_of(figure):
    """Returns a Look for each name. Names of one method differ in dashes and markers. Emphasised lines are thick. Each further
    emphasised line is thinner, so that lines with the same values all stay visible."""
    out, times, unknown, thick = {}, {}, 0, 0
    emphasised = {s.name for panel in figure.panels for s in panel.series if s.emphasis}
    for name in names_of(figure):
        words = " " + re.sub(r"[^a-z0-9]+", " ", name.split(" = ")[0].lower()) + " "
        if known := next((k for k in KNOWN if f" {k[0]} " in words), None):
            n = times[known] = times.get(known, -1) + 1
            at = MARKERS.index(known[3]) if known[3] in MARKERS and n else 0
            look = Look(known[1], DASHES[(known[2] + n) % len(DASHES)], MARKERS[(at + n) % len(MARKERS)] if n else known[3])
        else:
            look = Look(*(of[(unknown + skip) % len(of)] for of, skip in (
                (FREE, 0), (DASHES, unknown // len(FREE)), (MARKERS, unknown // len(MARKERS)))))
            unknown += 1
        if name in emphasised:
            look.width, look.size = 2.4 - 0.6 * min(thick, 2), 4.8 - 0.8 * min(thick, 2)
            thick += 1
        out[name] = look
    return out


def mark_look(figure, name):
    names = list(dict.fromkeys(m.name for panel in figure.panels for m in panel.marks))
    dashes = [(0, (3, 2)), (0, (1, 1.5)), (0, (6, 2)), (0, (4, 1.5, 1, 1.5))]
    return {"color": "#444444", "linewidth": 0.9, "linestyle": dashes[names.index(name) % len(dashes)], "zorder": 1.5}


def text_width(text):
    font = font_manager.FontProperties(family="DejaVu Sans", size=8)
    return textpath.text_to_path.get_text_width_height_descent(text, font, False)[0]


# ---- axes

def power_label(exponent):
    return "10" + str(exponent).translate(DIGITS)


def tick_label(value):
    """Returns a short text for a number: 12,346 for 12345.678, no zeros at the end, 10⁷ for long numbers."""
    size = abs(value)
    if size != 0 and (size >= 1e7 or size < 1e-4):
        exponent = math.floor(math.log10(size) + 1e-9)
        mantissa = round(value / 10.0 ** exponent, 3)
        return power_label(exponent) if mantissa == 1 else f"{mantissa:g}·{power_label(exponent)}"
    return f"{value:,.0f}" if size >= 1000 else f"{value:.6g}"


def finite(values):
    return [float(v) for v in values if v is not None and math.isfinite(v)]


def log_ticks(values, low, high, most):
    """Returns at most `most` ticks. Tries these places in turn, and takes the first that gives two ticks: the values, if they
    are powers of two; powers of ten; powers of ten times 1, 2 and 5; even distances."""
    distinct = sorted(set(values))
    if 3 <= len(distinct) <= 10 and all(v > 0 and math.frexp(v)[0] == 0.5 for v in distinct):
        return distinct[::-(-len(distinct) // most)]
    first, last = math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9)
    for factors in ((1,), (1, 2, 5)):
        ticks = [m * 10.0 ** e for e in range(first - 1, last + 1) for m in factors]
        ticks = [at for at in ticks if low * (1 - 1e-9) <= at <= high * (1 + 1e-9)]
        if len(ticks) >= 2:
            return ticks[::-(-len(ticks) // most)]
    return ticks if high > 5 * low else [at for at in ticker.MaxNLocator(min(most, 3)).tick_values(low, high) if at > 0]


def scale_axis(ax, side, spec, values, room):
    """Scales an axis for the values. If a logarithmic axis shows zeros, its part from 0 to 1 is linear and shaded; if values
    are below 1, this part ends at the power of ten below the least value. room: length of the axis in points."""
    values = finite(values)
    axis, line, span = (ax.xaxis, ax.axvline, ax.axvspan) if side == "x" else (ax.yaxis, ax.axhline, ax.axhspan)
    scaled, limits = (ax.set_xscale, ax.set_xlim) if side == "x" else (ax.set_yscale, ax.set_ylim)
    most = max(2, int(room / (32 if side == "x" else 18)))
    if spec.even:
        ticks = list(dict.fromkeys(values)) or [0.0]
        known = sorted([min(ticks) - 1, *ticks, 2 * abs(max(ticks)) + 1])
        places = np.arange(float(len(known)))
        scaled("function", functions=(lambda v: np.interp(v, known, places), lambda at: np.interp(at, places, known)))
        low, high = np.interp([0.7, len(ticks) + 0.3], places, known)
    elif not spec.log:
        least, highest = (min(values), max(values)) if values else (0.0, 1.0)
        least = spec.low if spec.low is not None else 0.0 if 0 < least < highest / 2 else least
        highest = highest if spec.high is None else spec.high
        air = 0.03 * max(highest - least, 0)
        low, high = transforms.nonsingular(least - air * (spec.low is None and least != 0), highest + air * (
            spec.high is None), 0.5, 1e-300)
        ticks = ticker.MaxNLocator(min(most, 6), steps=[1, 2, 5, 10]).tick_values(low, high)
    else:
        positive = [v for v in values if v > 0] or [1.0]
        highest = max(spec.high or max(positive), min(positive))
        least = spec.low or max(min(positive), highest * 1e-200)  # matplotlib cannot draw more decades
        air = 10 ** min(0.3, 0.03 * max(math.log10(highest) - math.log10(least), 0.08))
        low, high = least / (1 if spec.low else air), highest * (1 if spec.high else air)
        low, high = (low / 2, high * 2) if high < 1.3 * low else (low, high)
        if spec.zero and any(v <= 0 for v in values):
            end = 1.0 if least >= 1 else 10.0 ** math.floor(math.log10(least) + 1e-9)
            low, high = -0.4 * end, max(high, 1.5 * end)
            scaled("symlog", linthresh=end, linscale=max(0.3, 0.15 * (math.log10(high) - math.log10(end))))
            ticks = [0.0] + log_ticks([], end, high, most)
            span(low, end, color="#f1f1ee", zorder=0)
            line(0, color="#999999", linewidth=0.6, linestyle=(0, (1, 2)), zorder=0.6)
        else:
            scaled("log")
            ticks = log_ticks(values, low, high, most)
    limits(*((high, low) if spec.even and ticks[0] > ticks[-1] else (low, high)))
    ticks = [at for at in ticks if low <= at <= high] or [least, highest]
    powers = spec.log and any(at >= 1e5 or 0 < at < 1e-3 for at in ticks)
    labels = [power_label(round(math.log10(at))) if (powers or spec.even and not 0.01 <= at < 1000) and at > 0 and abs(math.log10(at) % 1 - 0.5) > 0.4999
              else tick_label(at) for at in ticks]
    keep = 1
    while side == "x" and sum(text_width(label) + 8 for label in labels[::keep]) > room and keep < len(ticks):
        keep += 1
    axis.set_ticks(ticks[::keep], labels[::keep])
    axis.set_minor_locator(ticker.NullLocator())


def values_along(panel, side):
    out = [m.at for m in panel.marks if m.vertical == (side == "x")]
    return out + [at for s in panel.series + (panel.strip if side == "x" else [])
                  for name in (side, side + "_low", side + "_high") for at in getattr(s, name)]


# ---- drawing

def columns_for(figure):
    panels = len(figure.panels)
    if figure.named:
        return 1
    if 0 < figure.columns <= 4 and panels % figure.columns == 0:
        return figure.columns
    if panels in (1, 2, 4):
        return min(panels, 2)
    fits = all(text_width(p.title) < DOUBLE / 3 - 20 for p in figure.panels)
    return 3 if fits and same_rows(figure) else 2


def same_rows(figure):
    """Returns true if the strips of all panels have the same rows. The names of the rows are then drawn once."""
    return len({tuple(s.name for s in p.strip) for p in figure.panels}) == 1


class Drawer:
    """Draws a figure on `canvas`, a figure of matplotlib."""

    def __init__(self, figure):
        self.figure, self.looks, panels = figure, looks_of(figure), figure.panels
        columns = columns_for(figure)
        labelled = any(s.labels for panel in panels for s in panel.series)
        self.key = [] if figure.named or labelled else self.handles()
        widest = max([0] + [text_width(line.get_label()) for line in self.key])
        single = len(panels) == 1 and not panels[0].strip
        figure.narrow = figure.named or single and widest + 34 < SINGLE - 8 and not labelled
        self.width = SINGLE if figure.narrow else DOUBLE
        self.high = 118.0 if figure.named else 190.0 if single and not figure.narrow else (0, 150.0, 150.0, 105.0, 80.0)[columns]
        if len(panels) > 2 * columns:
            self.high = min(self.high, 105.0) - 20 * bool(panels[0].strip)
        self.wide = self.width / columns - 60
        rows = [panels[at:at + columns] for at in range(0, len(panels), columns)]
        strips = [max(len(p.strip) for p in row) for row in rows]
        heights = [part for row, n in zip(rows, strips) for part in (
            (self.high + 4 * LINE) * any(p.series or not p.strip for p in row) + 0.01, LINE * n + 0.01)]
        key_columns = max(1, min(len(self.key), int(self.width / (widest + 42)))) if self.key else 1
        key_high = LINE * 1.2 * -(-len(self.key) // key_columns) + 6 if self.key else 0
        height = sum(heights) + key_high + 8 + 4 * LINE * (heights[0] < 1)
        self.canvas = pyplot.figure(figsize=(self.width / 72, height / 72), layout="constrained")
        self.canvas.get_layout_engine().set(rect=(0, key_high / height, 1, 1 - key_high / height), w_pad=4 / 72,
                                            h_pad=2 / 72, hspace=0, wspace=0)
        grid = self.canvas.add_gridspec(len(heights), columns, height_ratios=heights)
        for at, panel in enumerate(panels):
            row, column = divmod(at, columns)
            # A label is shown only once if the panel below (x axis) or on the left (y axis) has the same label.
            below, left = (panels[i] if 0 <= i < len(panels) else None for i in (at + columns, at - 1))
            self.panel(panel, [grid[2 * row + part, column] for part in (0, 1)], strips[row], (
                below is None or below.x.label != panel.x.label, column == 0 or left.y.label != panel.y.label), column == 0)
        if self.key:
            self.canvas.legend(handles=self.key, loc="lower center", ncol=key_columns, frameon=False, handlelength=2.5,
                               columnspacing=1.5, labelspacing=0.3, borderpad=0.2)
        self.canvas.draw_without_rendering()
        self.canvas.set_layout_engine("none")  # keeps the same layout for each kind of file
        for ax in self.canvas.axes:  # rounds, since the last digits of the layout differ between runs
            ax.set_position([round(at, 5) for at in ax.get_position(original=True).bounds])
        for ax, panel in zip(self.canvas.axes if labelled else [], panels):
            self.label(ax, panel)

    def label(self, ax, panel):
        """Writes the labels beside their points: the first label of each series, then all other labels, the longest first. Each
        label is put where it covers least. A label that covers anything or is partly outside the axes is left out, except for the
        first label of a series."""
        scale = 72 / self.canvas.dpi
        inside = [at * scale for at in ax.bbox.extents]
        points = [(s.name, text, at, *(ax.transData.transform(at) * scale)) for s in panel.series
                  for *at, text in zip(s.x, s.y, s.labels or [""] * len(s.x)) if len(finite(at)) == 2]
        taken = [(x - 3, y - 3, x + 3, y + 3) for *_, x, y in points]
        for s in panel.series:  # labels must not cover intervals and lines; a line is a row of squares
            for low, high, y in zip(s.x_low, s.x_high, s.y):
                (left, at), (right, _) = (ax.transData.transform((x, y)) * scale for x in (low, high))
                taken.append((left, at - 2, right, at + 2))
            ends = [ax.transData.transform(at) * scale for at in zip(s.x, s.y) if len(finite(at)) == 2]
            for begin, end in zip(ends, ends[1:]) if s.style != "points" else ():
                taken += [(x - 2, y - 2, x + 2, y + 2) for x, y in np.linspace(begin, end, 2 + int(np.hypot(*(end - begin)) / 4))]

        def covered(box):
            def both(a, b):
                return max(0.0, min(a[2], b[2]) - max(a[0], b[0])) * max(0.0, min(a[3], b[3]) - max(a[1], b[1]))
            outside = (box[2] - box[0]) * (box[3] - box[1]) - both(box, inside)
            return sum(both(box, other) for other in taken) + 10 * outside

        first = {next(filter(None, s.labels), "") for s in panel.series}
        for name, text, at, x, y in sorted(points, key=lambda point: (point[1] not in first, -len(point[1]))):
            wide = text_width(text)
            places = [(x + dx, y + dy) for far in (5, 12, 20, 30, 42) for dx, dy in (
                (-wide / 2, far), (-wide / 2, -far - 6), (far, -3), (-far - wide, -3), (far, far), (-far - wide, far),
                (far, -far - 6), (-far - wide, -far - 6))]
            low, base = min(places, key=lambda at: covered((at[0], at[1] - 2, at[0] + wide, at[1] + 7)))
            box = (low, base - 2, low + wide, base + 7)
            if text and (text in first or not covered(box)):
                taken.append(box)
                ax.annotate(text, at, (low - x, base - y), "data", "offset points", color=self.looks[name].colour,
                            fontsize=8, annotation_clip=False, in_layout=False)

    def handles(self):
        """Returns the lines of the key: a line for each series, then a line for each mark."""
        styles = {s.name: s.style for panel in self.figure.panels for s in reversed(panel.series)}
        out = [Line2D([], [], label=name, **self.looks[name].of(styles[name])) for name in self.looks if name in styles]
        marks = dict.fromkeys(m.name for panel in self.figure.panels for m in panel.marks if m.name)
        return out + [Line2D([], [], label=name, **mark_look(self.figure, name)) for name in marks]

    def panel(self, panel, cells, strip, labelled, first):
        if panel.strip and not panel.series:
            ax = self.strip(None, panel, cells[1], strip, first or not same_rows(self.figure))
            ax.set_title(panel.title, loc="left", color="black", pad=4)
            ax.set_xlabel(panel.x.label)
            return
        ax = self.canvas.add_subplot(cells[0])
        ax.set_title(panel.title, loc="left", color="black", pad=4)
        for side, room in (("x", self.wide), ("y", self.high)):
            scale_axis(ax, side, getattr(panel, side), values_along(panel, side), room)
        ax.set_ylabel(panel.y.label if labelled[1] else "")
        for mark in panel.marks:
            if math.isfinite(mark.at) and (mark.at > 0 or not (panel.x if mark.vertical else panel.y).log):
                (ax.axvline if mark.vertical else ax.axhline)(mark.at, **mark_look(self.figure, mark.name))
        # Draws the emphasised, thick series first. Thinner series with the same values stay visible on top.
        drawn = [self.series(ax, panel, s) for s in sorted(panel.series, key=lambda s: not s.emphasis)]
        if not any(drawn) and not panel.strip:
            ax.text(0.5, 0.5, "no valid measurement", transform=ax.transAxes, ha="center", va="center", color="#666666")
        if self.figure.named:
            self.names(ax, panel)
        lowest = self.strip(ax, panel, cells[1], strip, first or not same_rows(self.figure)) if panel.strip else ax
        lowest.set_xlabel(panel.x.label if labelled[0] else "")

    def names(self, ax, panel):
        """Writes the name of each point beside the point. Names of points near 0 are written below 0. Each such name is lower
        than the name to its left, so that no leader line crosses a name. The x axis starts so far left that all names fit."""
        points = sorted((s.x[0], s.y[0], s.name) for s in panel.series)
        near, last, (low, high) = [p for p in points if p[1] < 10], 0, map(math.log, ax.get_xlim())
        heights = []
        for x, _, name in points:
            part = (text_width(name) + 8) / self.wide
            low = min(low, (math.log(x) - part * high) / (1 - part))
        ax.set_xlim(math.exp(low), math.exp(high))
        below = 100 * (len(near) + 0.5) * LINE / (self.high - (len(near) + 0.5) * LINE)
        ax.set_ylim(-below, 104)
        ax.axhline(0, color="#999999", linewidth=0.6, zorder=0.6)
        for x, y, name in points:
            down, look = 3, {"color": self.looks[name].colour, "linewidth": 0.6, "arrowstyle": "-", "shrinkA": 0}
            if y < 10:
                last += LINE
                down = last + y / 100 * self.high
                ax.annotate("", (x, y), (0, -down + 3), textcoords="offset points", arrowprops=look)
            else:
                while any(abs(y / 100 * self.high - down - height) < LINE for height in heights):
                    down -= LINE
                heights.append(y / 100 * self.high - down)
            ax.annotate(name, (x, y), (-5, -down), textcoords="offset points", ha="right", color=look["color"])

    def bars(self, ax, look, along, across, low, high, side):
        ends = [[max(0.0, b - a) if a == a and b == b else math.nan for a, b in zip(*pair)]
                for pair in ((low, along), (along, high))]
        if any(e == e for e in ends[0]):
            at = (along, across) if side == "x" else (across, along)
            ax.errorbar(*at, **{side + "err": ends}, fmt="none", ecolor=look.colour, elinewidth=0.8, capsize=1.5, capthick=0.8)

    def series(self, ax, panel, s):
        """Draws a series. Returns False if no point can be drawn."""
        look, clean = self.looks[s.name], lambda values, log: [
            v if v is not None and math.isfinite(v) and (v > 0 or not log) else math.nan for v in values]
        logs = [ax.get_xscale() == "log", ax.get_yscale() == "log"]
        x, y = (clean(values, log) for values, log in zip((s.x, s.y), logs))
        if not any(a == a and b == b for a, b in zip(x, y)):
            return False
        if s.x_low:
            self.bars(ax, look, x, y, clean(s.x_low, logs[0]), clean(s.x_high, logs[0]), "x")
        if s.y_low:
            self.bars(ax, look, y, x, clean(s.y_low, logs[1]), clean(s.y_high, logs[1]), "y")
        ax.plot(x, y, in_layout=False, clip_on=panel.x.low is not None or panel.x.high is not None, **look.of(s.style))
        return True

    def strip(self, above, panel, cell, rows, labelled):
        """Draws a row for each series below the panel, over the same x."""
        ax = self.canvas.add_subplot(cell, sharex=above)
        if above is None:
            scale_axis(ax, "x", panel.x, values_along(panel, "x"), self.wide)
        else:
            above.tick_params(axis="x", labelbottom=False)
        ax.set_ylim(rows - 0.4, -0.6)
        ax.set_yticks(range(len(panel.strip)), [s.name if labelled else "" for s in panel.strip])
        ax.tick_params(axis="y", length=0)
        for i, s in enumerate(panel.strip):
            ax.axhline(i, color="#e4e4e4", linewidth=0.5, zorder=0.5)
            if s.x_low:
                self.bars(ax, self.looks[s.name], s.x, [i] * len(s.x), s.x_low, s.x_high, "x")
            ax.plot(s.x, [i] * len(s.x), **self.looks[s.name].of("points"), clip_on=False, in_layout=False)
        return ax


def numbers_of(figure):
    """Returns the CSV of a figure: the drawn values, not rounded."""
    rows = []
    for panel in figure.panels:
        for s in panel.series + panel.strip:
            values = {name: list(getattr(s, name)) for name in ("x", "y", *ENDS)}
            rows += [{"panel": panel.title, "series": s.name, **{
                name: float(of[i]) if i < len(of) and of[i] is not None else math.nan for name, of in values.items()}}
                for i in range(len(s.x))]
    return pd.DataFrame(rows, columns=["panel", "series", "x", "y", *ENDS]).to_csv(index=False, lineterminator="\r\n")


def files_of(figure):
    """Returns the files of a figure by kind: svg and csv (texts), pdf (bytes). The SVG has the title and the caption for
    readers who cannot see the figure."""
    canvas, svg, pdf = Drawer(figure).canvas, io.StringIO(), io.BytesIO()
    canvas.savefig(pdf, format="pdf", metadata={"CreationDate": None, "Title": figure.title})
    canvas.savefig(svg, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(canvas)
    words = f"<title>{html.escape(figure.title)}</title>\n<desc>{html.escape(figure.caption)}</desc>"
    out = re.sub(r"(<svg [^>]*>)", lambda m: m.group(1) + "\n " + words, svg.getvalue(), 1)
    return {"svg": out.replace("'DejaVu Sans'", "'DejaVu Sans', Helvetica, Arial, sans-serif"), "pdf": pdf.getvalue(),
            "csv": numbers_of(figure)}


def inline_svg(svg, prefix):
    """Returns an SVG for a page with several SVGs: its ids get a `prefix`."""
    return re.sub(r'( id="|href="#|url\(#)', lambda m: m.group(1) + prefix, svg[svg.index("<svg"):])


# ---- preparing a figure and its caption

LONGEST_NAME = 85  # number of characters that fit into the key
SHADED = "The shaded part of an axis is linear, from 0 on; beyond, the axis is logarithmic."


def merge_series(figure):
    """Merges series that agree in every panel. The merged series has the names of all of them."""
    def values_of(name):
        return repr([[(s.style, [list(map(float, getattr(s, of))) for of in ("x", "y", *ENDS)]) for s in panel.series
                      if s.name == name] for panel in figure.panels])

    groups = {}
    for name in dict.fromkeys(s.name for panel in figure.panels for s in panel.series):
        groups.setdefault(values_of(name), []).append(name)
    emphasised = {s.name for panel in figure.panels for s in panel.series if s.emphasis}
    for group in groups.values():
        if len(group) == 1:
            continue
        # The first name determines the colour. Names of emphasised series and of FAR come first.
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


def legible(figure):
    merge_series(figure)
    if not re.search(r"\bn( =|:)", figure.caption):
        points = sum(len(finite(s.y)) for panel in figure.panels for s in panel.series)
        figure.caption = f"{sentence(figure.caption)} n = {grouped(points)} drawn points."
    if any(getattr(panel, side).log and getattr(panel, side).zero and 0 in values_along(panel, side)
           for panel in figure.panels for side in "xy"):
        figure.caption = f"{sentence(figure.caption)} {SHADED}"
