"""The parts of a report: numbers, axes, figures, tables and pages."""
import itertools
import math
import xml.dom.minidom

import numpy as np
import pandas as pd
import pytest

from made_up import study_of  # first, since it finds the modules of the report
import draw
import estimates
import pages
from frame import Axis, Chapter, Figure, Mark, Panel, Series, Table, log

E = math.e


def test_exponents():
    x = [2.0, 8.0, 32.0, 128.0]
    fit = estimates.exponent_of(x, [3 * v * math.sqrt(v) for v in x])
    assert (round(fit.value, 12), round(fit.error, 12), fit.points, fit.first, fit.last) == (1.5, 0, 4, 2, 128)
    # log y = 0, 1, 0 over log x = 0, 1, 2: residuals -1/3, 2/3, -1/3; t of one degree of freedom is 12.706.
    fit = estimates.exponent_of([1, E, E * E], [1, E, 1])
    assert fit.error == pytest.approx(math.sqrt(1 / 3)) and fit.high == pytest.approx(12.706 * math.sqrt(1 / 3), 1e-4)
    text = [estimates.exponent_text(estimates.Exponent(0.8, 0, 0.6, 1, 0, 0, n)) for n in (6, 5)]
    assert text == ["0.80 (0.60 to 1.00)", "0.80 (no interval of 5 points)"]
    for few in (([1, 2], [1, 2]), ([1, 2, 0], [1, 2, 3]), ([2, 2, 2], [1, 2, 3])):
        assert estimates.exponent_of(*few) is None


# Known values: 1 - 0.05^(1/100) and tables of Clopper and Pearson's interval.
def test_intervals():
    rate = estimates.rate_of(5, 100)
    assert estimates.rate_of(0, 100).high == pytest.approx(0.029513, abs=1e-6) and estimates.rate_of(0, 100).low == 0
    assert (rate.low, rate.high) == pytest.approx((0.016432, 0.112835), abs=1e-6)
    assert estimates.rate_of(7, 7).high == 1 and estimates.rate_text(0, 0) == "0 of 0"
    median = estimates.median_estimate((5.0, 1.0, 3.0))
    assert (median.value, median.low, median.high, median.n) == (3, 1, 5, 3)
    assert estimates.student_t95(4) == pytest.approx(2.776445, abs=1e-6)


def held(n, cut):
    """holds_again() by counting: each way to mix the runs of two measurements, in the order of time."""
    kept = []
    for firsts in itertools.combinations(range(2 * n), n):
        others = [at for at in range(2 * n) if at not in firsts]
        kept.append(firsts[cut] < others[-(-n // 2) - 1] and others[n // 2] < firsts[n - 1 - cut])
    return sum(kept) / len(kept)


def test_the_interval_of_a_median_holds_what_it_says():
    for n, cut in ((1, 0), (3, 0), (5, 0), (5, 1), (7, 0), (7, 1), (9, 0), (9, 1)):
        assert estimates.holds_again(n, cut) == pytest.approx(held(n, cut))
    for n in (4, 6):  # the median is the mean of two, so that no less is held
        assert held(n, 0) - 0.02 < estimates.holds_again(n, 0) <= held(n, 0)
    assert [estimates.cut_of(n) for n in (3, 5, 9, 15, 27)] == [0, 0, 0, 1, 6]
    # The twin: a run less at each end no longer holds the median of another nine with 95 %.
    assert held(9, 0) >= 0.95 > held(9, 1)


@pytest.mark.parametrize("value, text", [(12345.6, "12,346"), (0.01234, "0.0123"), (0, "0"), (10, "10"), (-1.5, "-1.50"),
                                         (1234567, "1,234,567"), (math.nan, "-"), (1e-5, "1e-05"), (0.9996, "1.000")])
def test_numbers_are_rounded_for_people(value, text):
    assert estimates.rounded(value) == text


def scaled(spec, values, room=200):
    """The axes of a plot whose y axis is scaled for the values, and the ticks of that axis."""
    ax = draw.pyplot.figure().add_subplot()
    draw.scale_axis(ax, "y", spec, values, room)
    ticks = list(ax.yaxis.get_majorticklocs())
    draw.pyplot.close()
    return ax, ticks


@pytest.mark.parametrize("axis", [Axis(), log("")])
def test_an_axis_holds_every_value_of_any_size(axis):
    for exponent in range(-300, 300, 31):
        for m in (1.0, 1.9999999, 2.0, 4.2, 9.999999):
            value = m * 10.0 ** exponent
            ax, ticks = scaled(axis, [value, value * 3, math.nan], 60)
            assert ax.get_ylim()[0] < ax.get_ylim()[1] and ax.get_ylim()[0] <= value <= 3 * value <= ax.get_ylim()[1]
            assert 0 < len(ticks) <= 10


@pytest.mark.parametrize("values", [[1, 2, 1e6, 1e12], [2, 0.5, 3e-14, 0]])
def test_values_at_even_distances_keep_their_order(values):
    ax, ticks = scaled(Axis(even=True), values + values)
    places = [ax.transData.transform((0, v))[1] for v in values]
    assert ticks == values and np.allclose(np.diff(places), places[1] - places[0]) and places[0] < places[1]


def test_zeros_are_drawn_at_zero():
    shown = [Series(name, [1, 2], [0, last]) for name, last in (("CULLIDE", 0.5), ("Quick-CULLIDE", 0), ("FAR (OBB)", 0))]
    drawer = draw.Drawer(Figure("f", "t", "c", [Panel(title, y=log("missed", zero=True), series=shown) for title in "ab"]))
    ax = drawer.canvas.axes[0]
    # By name, how far each drawn line is from zero on the paper, in points.
    distances = {name: {float(abs((ax.transData.transform((1, y)) - ax.transData.transform((1, 0)))[1]).round(6))
                        for line in ax.lines if line.get_color() == look.colour
                        for y in line.get_ydata()} for name, look in drawer.looks.items()}
    assert distances["FAR (OBB)"] == distances["Quick-CULLIDE"] == {0}
    assert len(distances["CULLIDE"]) == 2, "the twin: what is not zero is not there"


def test_figures_are_drawn_whatever_they_hold():
    figure = Figure("trap", "it's a \"trap\" & <b> \\ `date` $(date) 100 %", "`x` @macro $x_1$", [])
    none = [math.nan] * 3
    for kind in (Axis("%g 'x'"), log("%g 'x'", zero=True)):
        for y in ([1, math.nan, 3], [0, 0, 0], none, [5, 5, 5], [1e-300, 1, 1e300], [-1, 0, math.inf]):
            series = [Series("s'" + style, [0, 1, 2], y, style, style == "lines", y_low=none if style == "points" else y,
                             y_high=none if style == "points" else [7, 1e9, math.nan]) for style in (
                                 "lines_points", "lines", "points")]
            figure.panels.append(Panel("%s a_b^{c} $q$ @x", log("x", zero=True), kind, series,
                                       [Mark(1, "it's"), Mark(0, "%d", False)], strip=[Series("row", [1, 2])]))
    figure.panels += [Panel("")]
    files = draw.files_of(figure)
    texts = [node.firstChild.data for node in xml.dom.minidom.parseString(files["svg"]).getElementsByTagName("title")]
    assert figure.title in texts and files["pdf"].startswith(b"%PDF") and files["csv"].count("\n") > 50


def test_text_is_no_markup():
    assert pages.html_text("<b>&\"'\n\x01") == "&lt;b&gt;&amp;&quot;&#39;\n "
    for text, html in (("run `a<b` `", "run <code>a&lt;b</code> `"), ("a_b*c|`d|e`[x](y)", "a_b*c|<code>d|e</code>[x](y)")):
        assert pages.html_prose(pages.markdown_prose(text)) == html
    assert pages.latex_text("50 % of a_b & 10⁻³ ± 1") == "50 \\% of a\\_b \\& 10$^{-}$$^3$ $\\pm$ 1"
    assert pages.markdown_prose("a_b `c_d|` `") == "a\\_b `c_d\\|` \\`"
    svg = '<?xml version="1.0"?>\n<svg><g id="a"><use xlink:href="#p" clip="url(#q)"/></g></svg>'
    assert draw.inline_svg(svg, "x-") == '<svg><g id="x-a"><use xlink:href="#x-p" clip="url(#x-q)"/></g></svg>'


def test_cells_stay_cells():
    table = Table("t", "c", [("a,b", "l"), ("n", "r")], [["say \"so\"", "1,234"]])
    assert pages.table_csv(table) == "\"a,b\",n\r\n\"say \"\"so\"\"\",\"1,234\"\r\n"
    table.rows.append(["b|`c|d`\\\\", "2"])
    html = pages.block_html(pages.markdown_table(table).strip(), {})
    assert "<td class=\"r\">1,234</td>" in html and "<td>b|<code>c|d</code>\\\\</td><td class=\"r\">2</td>" in html
    assert "\\begin{tabular}{lr}" in pages.table_latex(table)


def page_with(*said):
    chapter = Chapter("accuracy", "Accuracy", "?", "command", list(said))
    runs = pd.DataFrame({name: [] for name in ("run", "gl_renderer", "cpu", "cores")})
    return pages.Page("my results", "commit", "now", runs, [pages.Drawn(chapter, study_of("accuracy", []))])


def test_what_is_broken_comes_first():
    broken, good = page_with((True, "first"), (True, "second"), (False, "fine")), page_with((False, "fine"))
    html, markdown = pages.page_html(broken), pages.page_markdown(broken)
    for text in (html, markdown):
        assert text.index("BROKEN: first") < text.index("BROKEN: second") < text.index("All of this page") < text.index("fine")
    assert "`farcull report 'my results'`" in markdown
    assert "Broken." not in pages.page_html(good)


def crossed(canvas, x, y):
    """The texts in the plot that the line through these points crosses, and those that leave the frame."""
    ax, out = canvas.axes[0], []
    path = ax.transData.transform(list(zip(x, y)))
    for text in ax.texts:
        box = text.get_window_extent(canvas.canvas.get_renderer())
        along = [end for begin, end in zip(path, path[1:]) for end in begin + (end - begin) * np.linspace(0, 1, 500)[:, None]]
        inside = ax.bbox.x0 <= box.x0 and box.x1 <= ax.bbox.x1 and ax.bbox.y0 <= box.y0 and box.y1 <= ax.bbox.y1
        out += [text.get_text()] * (not inside or any(box.contains(*at) for at in along))
    return out


def test_labels_beside_lines():
    x, y = [100, 260, 760, 2200, 6500], [480, 250, 140, 67, 31]
    line = Series("cullide", x, y, labels=["cullide 128 px", "256 px", "512 px", "1024 px", "2048 px"])
    figure = Figure("f", "F", "c", [Panel("p", log("ms"), log("missed", zero=True), [line, Series("boxes", [1], [0], labels=["boxes"])])])
    assert crossed(draw.Drawer(figure).canvas, x, y) == []
    line.style = "points"  # the twin: places are chosen as if there were no line
    assert crossed(draw.Drawer(figure).canvas, x, y)


# Labels stand in place of a key: beside their points, apart from each other, and inside the figure.
def test_labels_at_points():
    near = Series("far", [1, 1.1, 1.2], [0, 0, 0], labels=["far 128 px", "256 px", "512 px"])
    figure = Figure("f", "F", "c", [Panel("p", log("ms"), log("missed", zero=True), [near, Series("exact", [30], [9], labels=["exact"])])])
    drawer = draw.Drawer(figure)
    texts = drawer.canvas.axes[0].texts
    assert not drawer.canvas.legends and [t.get_text() for t in texts] == ["far 128 px", "exact", "256 px", "512 px"]
    boxes = [t.get_window_extent() for t in texts]
    assert not any(a.overlaps(b) for a, b in itertools.combinations(boxes, 2))
    assert all(0 <= b.x0 and b.x1 <= drawer.canvas.bbox.x1 and 0 <= b.y0 for b in boxes)
    near.x, near.y, near.labels = [1] * 30, [0] * 30, ["far 8 px", *["256 px"] * 29]
    texts = draw.Drawer(figure).canvas.axes[0].texts  # on one point there is no room for all of them
    assert 3 < len(texts) < 30 and {"far 8 px", "exact"} < {t.get_text() for t in texts}
    assert not any(a.overlaps(b) for a, b in itertools.combinations([t.get_window_extent() for t in texts], 2))
    near.labels = []
    figure.panels[0].series.pop()
    assert draw.Drawer(figure).canvas.legends  # the twin: without labels there is a key
