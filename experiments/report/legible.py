"""What of a figure is worth drawing: series that agree become one, and panels without a difference a sentence."""
import math

from estimates import listed, sentence
from scales import tick_label

LONGEST_NAME = 85  # characters that the key has room for


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
    """Series that agree in every panel are drawn once, under a name that tells all of them."""
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
        # The first gives the colour: what the figure is about, or ours.
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
    """Panels without a difference become a sentence of the caption."""
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
