"""Draws the figures of the paper (docs/reliability.md), docs/figures/paper-*.svg.
   paper_figures.py CASE FOLDER     CASE: tests/cases/published-far-loses-this-pair.obj
Lengths are in pixels. Each figure is computed from the definitions of the paper. The same version of matplotlib gives
the same files."""
import html
import io
import re
import sys
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402  (after use)
from matplotlib.patches import Circle  # noqa: E402

matplotlib.rcParams.update({"font.family": "DejaVu Sans", "font.size": 11, "svg.hashsalt": "farcull", "svg.fonttype": "none",
                            "text.parse_math": False})
RED, BLUE, GREEN, GREY, DARK = "#bb3300", "#0077aa", "#228833", "#bbbbbb", "#223344"
PIXEL = {"facecolor": "#ffee99", "edgecolor": "#aa8800", "linewidth": 1.5}
# Radii of the budget (docs/budget.md, "snap" and "double") in px, for devices with 4 and with 8 subpixel bits. OpenGL requires
# at least 4. WANDER: largest distance in px that a corner of a proxy can move on the device with 4 bits.
RADIUS_4_BITS, RADIUS_8_BITS, WANDER = 0.7969, 0.71402, 0.0884
PUBLISHED = np.sqrt(0.5)  # the published radius, without its small term for depth, which a figure cannot show
REACHING = np.array([[0.05, 0.03], [-2.6, -0.5], [-1.2, -1.9]])  # a triangle with its first corner in the pixel [0, 1] x [0, 1]


def rectangle(points, radius):
    """Returns the corners of the rectangle around the points, with a margin of `radius`. Its sides are parallel or perpendicular
    to the line through the two points that are farthest apart."""
    along = max((q - p for p in points for q in points), key=lambda d: d @ d)
    axes = np.array([along, [-along[1], along[0]]]) / np.hypot(*along)
    low, high = (points @ axes.T).min(0) - radius, (points @ axes.T).max(0) + radius
    return np.array([low, [high[0], low[1]], high, [low[0], high[1]]]) @ axes


def deepest(corners, point):
    """Returns the least distance of a point from the lines through the sides of a convex polygon; negative outside."""
    side = np.roll(corners, -1, 0) - corners
    turn = np.sign(side[0, 0] * side[1, 1] - side[0, 1] * side[1, 0])
    away = point - corners
    return (turn * (side[:, 0] * away[:, 1] - side[:, 1] * away[:, 0]) / np.hypot(*side.T)).min()


def sheet(width, height, panels):
    """Returns a sheet of width x height points, and Axes for each panel (left, top, width, height, x0, y0, x1, y1)."""
    figure = pyplot.figure(figsize=(width / 72, height / 72))
    axes = []
    for left, top, wide, high, x0, y0, x1, y1 in panels:
        panel = figure.add_axes([left / width, 1 - (top + high) / height, wide / width, high / height])
        panel.set(xlim=(x0, x1), ylim=(y0, y1))
        panel.axis("off")
        axes.append(panel)
    return figure, axes


def pixels(panel):
    (x0, x1), (y0, y1) = panel.get_xlim(), panel.get_ylim()
    for k in range(int(np.ceil(x0)), int(x1) + 1):
        panel.axvline(k, color="#cccccc", linewidth=0.8)
    for k in range(int(np.ceil(y0)), int(y1) + 1):
        panel.axhline(k, color="#cccccc", linewidth=0.8)
    centres = [(i + 0.5, j + 0.5) for i in range(int(x0) - 1, int(x1) + 1) for j in range(int(y0) - 1, int(y1) + 1)]
    panel.plot(*zip(*[(x, y) for x, y in centres if x0 < x < x1 and y0 < y < y1]), ".", color="#999999", markersize=4)


def polygon(panel, corners, **style):
    panel.add_patch(pyplot.Polygon(corners, **{"facecolor": "none", "linewidth": 1.5, **style}))


def dot(panel, at, **style):
    panel.plot(*at, "o", **{"color": "black", "markersize": 5, **style})


OPEN = {"markerfacecolor": "white", "markersize": 7}


def words(panel, at, text, right=0, up=0, **style):
    panel.annotate(text, at, (right, up), textcoords="offset points", **{"annotation_clip": False, **style})


def reaching_sheet():
    figure, [panel] = sheet(720, 500, [(10, 10, 700, 480, -4.6, -3.2, 2.4, 1.6)])
    polygon(panel, [(0, 0), (1, 0), (1, 1), (0, 1)], **PIXEL)
    pixels(panel)
    return figure, panel


def ball():
    figure, panel = reaching_sheet()
    r, q, c = RADIUS_4_BITS, REACHING[0], np.array([0.5, 0.5])
    polygon(panel, REACHING, facecolor="#99aabb", edgecolor="#99aabb", linewidth=2 * r * 100, joinstyle="round", alpha=0.35)
    polygon(panel, REACHING, facecolor="#99aabb", edgecolor=DARK)
    polygon(panel, rectangle(REACHING, r), edgecolor=RED)
    panel.add_patch(Circle(q, r, fill=False, linestyle="--"))
    panel.plot(*zip(q, c), color="black", linewidth=1.2)
    dot(panel, q)
    dot(panel, c, **OPEN)
    words(panel, q, "Q", -4, -16, ha="right")
    words(panel, c, "c", 9, -4)
    words(panel, (1, 0), "X", -14, 8)
    words(panel, (-1.35, -0.8), "triangle", ha="center")
    words(panel, (-3.2, -2.2), "proxy", ha="right", color=RED)
    words(panel, (-4.5, 1.3), f"|Q - c| = {np.hypot(*(q - c)):.4f} px")
    words(panel, (-4.5, 1.3), f"dashed: ball of radius r = {r:.4f} px", up=-18)
    return figure


def winding(corners, point):
    """Returns how often the polygon winds around a point. Precondition: the point is on no side."""
    angles = np.arctan2(*(corners - point).T[::-1])
    turns = (np.diff(np.append(angles, angles[0])) + np.pi) % (2 * np.pi) - np.pi
    return round(abs(turns.sum()) / (2 * np.pi))


def coverage():
    figure, panel = reaching_sheet()
    exact, c = rectangle(REACHING, RADIUS_4_BITS), np.array([0.5, 0.5])
    inward = np.roll(exact, 2, 0) - exact  # each corner moves towards the opposite corner
    moved = exact + WANDER * inward / np.hypot(*inward.T)[:, None]
    for corner in exact:
        panel.add_patch(Circle(corner, WANDER, facecolor="#ffddbb"))
    polygon(panel, exact, edgecolor=RED, linestyle="--", linewidth=1.2)
    polygon(panel, moved, edgecolor=RED)
    panel.plot(*zip(moved[0], moved[2]), color=RED, linestyle=":", linewidth=1.2)
    for x in np.arange(-4.5, 2):
        for y in np.arange(-2.5, 2):
            around = winding(moved, (x, y))
            words(panel, (x, y), around, 5, 4, **({"weight": "bold"} if around else {"color": "#888888"}))
    dot(panel, c, **OPEN)
    words(panel, c, "c", -7, -14, ha="right")
    halves = winding(moved[:3], c), winding(moved[[0, 2, 3]], c)
    words(panel, (-4.4, 1.3), f"around c: {winding(moved, c)} = {halves[0]} + {halves[1]}")
    words(panel, (-4.4, 1.3), f"wander w = {WANDER:.4f} px", up=-18)
    words(panel, (-1.7, 1.3), "dashed: as computed", color=RED)
    words(panel, (-1.7, 1.3), "solid: as moved", up=-18, color=RED)
    return figure


def distances(points, triangle):
    """Returns the distances of points from a triangle."""
    edges = np.roll(triangle, -1, 0) - triangle
    out = np.full(len(points), np.inf)
    for corner, edge in zip(triangle, edges):
        t = np.clip((points - corner) @ edge / (edge @ edge), 0, 1)[:, None]
        out = np.minimum(out, np.linalg.norm(points - corner - t * edge, axis=1))
    normal = np.cross(edges[0], edges[1])
    inside = np.all([(points - corner) @ np.cross(normal, edge) >= 0 for corner, edge in zip(triangle, edges)], 0)
    return np.where(inside, abs((points - triangle[0]) @ normal) / np.linalg.norm(normal), out)


def entry_exit():
    triangle, r, row = np.array([[-3.2, 0.1, -1.2], [2.2, 0.9, 1.6], [-0.6, 0.35, 0.9]]), RADIUS_4_BITS, 0.5
    figure, [panel] = sheet(720, 490, [(10, 10, 700, 466, -5, -3.2, 4, 2.8)])
    for x in range(-5, 5):
        panel.axvline(x, color="#cccccc", linewidth=0.8)
    x, z = np.meshgrid(np.linspace(-5, 4, 451), np.linspace(-3.2, 2.8, 301))
    points = np.stack([x.ravel(), np.full(x.size, row), z.ravel()], 1)
    round_ = distances(points, triangle).reshape(x.shape)
    # The axes of the oriented box: the longest edge, the normal, and the direction perpendicular to both.
    along = triangle[1] - triangle[0]
    axes = np.array([along, np.cross(along, triangle[2] - triangle[0])])
    axes = np.vstack([axes, np.cross(*axes)])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    low, high = (triangle @ axes.T).min(0), (triangle @ axes.T).max(0)
    box = np.maximum(low - points @ axes.T, points @ axes.T - high).max(1).reshape(x.shape)
    panel.contour(x, z, box, [r], colors=BLUE, linestyles="--", linewidths=1.2)
    panel.contourf(x, z, round_, [0, r], colors="#99aabb", alpha=0.4)
    panel.contour(x, z, round_, [r], colors=DARK, linewidths=1.2)
    depths = np.linspace(-3.2, 2.8, 60001)
    for centre in np.arange(-4.5, 4):
        sight = np.stack([np.full_like(depths, centre), np.full_like(depths, row), depths], 1)
        inside = depths[distances(sight, triangle) <= r]
        if not inside.size:
            continue
        panel.plot([centre, centre], inside[[0, -1]], "o-", color=RED, linewidth=3, markersize=5)
        if centre == 0.5:
            entry, exit_ = inside[[0, -1]]
    polygon(panel, triangle[:, [0, 2]], edgecolor=DARK)  # the outline of the whole triangle, seen along y
    q = np.array([0.2, 0.62, 0.18]) @ triangle  # a point of the triangle in the pixel with centre x = 0.5
    dot(panel, q[[0, 2]])
    words(panel, q[[0, 2]], "Q", 6, -16)
    words(panel, (0.5, entry), "entry", 6, -16, color=RED)
    words(panel, (0.5, exit_), "exit", -6, 6, color=RED, ha="right")
    words(panel, (-4.9, 2.5), "depth grows upward; thin lines: borders of pixels")
    words(panel, (3.9, -2.75), "filled: triangle and ball; dashed: oriented box", ha="right")
    words(panel, (3.9, -3.1), f"{entry:.3f} <= Q.z = {q[2]:.3f} <= {exit_:.3f}", ha="right")
    return figure


# Three objects of four segments, seen along y. Each segment lists x and depth of both ends. Two pairs of segments cross.
SCENE = np.array([[(1, 4, 7, 5), (10, 9, 16, 4), (19, 4, 25, 5), (28, 4, 35, 3)],
                  [(1, 8, 7, 9), (10, 4, 16, 9), (19, 12, 25, 8), (28, 15, 35, 16)],
                  [(1, 13, 7, 12), (10, 13, 16, 12), (19, 8, 25, 12), (28, 9, 35, 8)]], float)
NO_BIT, F, L, BOTH = range(4)
LOOKS = [(RED, "no bit"), (BLUE, "F: meets nothing earlier"), (GREEN, "L: meets nothing later"), (GREY, "F and L: culled")]


def intervals(segment, columns, radius):
    """Returns entry and exit of the fattened segment, a rectangle, at each column's centre. NaN: no entry."""
    corners = rectangle(segment.reshape(2, 2), radius)
    out = np.full((columns, 2), np.nan)
    for i in range(columns):
        at = []
        for p, q in zip(corners, np.roll(corners, -1, 0)):
            if (p[0] <= i + 0.5) != (q[0] <= i + 0.5):
                at.append(p[1] + (i + 0.5 - p[0]) / (q[0] - p[0]) * (q[1] - p[1]))
        if at:
            out[i] = min(at), max(at)
    return out


def run_passes():
    """Returns the bits of all triangles after each pass. Ends when a round of two passes changes nothing."""
    boxes = [(np.minimum(o[:, 1], o[:, 3]).min(), np.maximum(o[:, 1], o[:, 3]).max()) for o in SCENE]
    bits = np.zeros((3, 4), int)
    for o in range(3):  # a segment is not drawn if it overlaps no other object's box in depth
        for t, s in enumerate(SCENE[o]):
            if all(max(s[1], s[3]) < low or min(s[1], s[3]) > high for k, (low, high) in enumerate(boxes) if k != o):
                bits[o, t] = BOTH
    drawn = [[intervals(s, 36, RADIUS_8_BITS) for s in o] for o in SCENE]
    states = []
    while len(states) < 4 or (states[-1] != states[-3]).any():
        for order, bit in ((range(3), F), (range(2, -1, -1), L)):
            nearest = np.full(36, np.inf)
            for o in order:
                live = [t for t in range(4) if bits[o, t] != BOTH]
                for t in live:
                    if not (drawn[o][t][:, 1] >= nearest).any():  # in every column, the exit is in front of the stored depth
                        bits[o, t] |= bit
                for t in (t for t in live if bits[o, t] != BOTH):
                    nearest = np.fmin(nearest, drawn[o][t][:, 0])
            states.append(bits.copy())
    return states


def passes():
    states = run_passes()
    figure, panels = sheet(720, 830, [(10, 10 + 255 * k, 700, 240, 0, 18, 37, 1) for k in range(3)] +
                           [(10, 770, 700, 50, 0, 0, 700, 50)])
    headings = ["After the first pass: A, B, C", "After the second pass: C, B, A", f"At the end, after {len(states)} passes"]
    for panel, heading, bits in zip(panels, headings, (states[0], states[1], states[-1])):
        words(panel, (0, 1), heading, 4, -10)
        for name, object_, of in zip("ABC", SCENE, bits):
            for (x0, z0, x1, z1), bit in zip(object_, of):
                panel.plot([x0, x1], [z0, z1], color=LOOKS[bit][0], linewidth=3)
                words(panel, (x0, z0), name, -5, -4, ha="right", color=LOOKS[bit][0])
    for i, (colour, meaning) in enumerate(LOOKS):
        x, y = 30 + 340 * (i % 2), 34 if i < 2 else 12
        panels[3].plot([x - 24, x], [y, y], color=colour, linewidth=3)
        words(panels[3], (x, y), meaning, 8, -4)
    return figure


def published(case):
    corners = np.array([line.split()[1:3] for line in Path(case).read_text().splitlines() if line.startswith("v ")], float)
    if len(corners) != 6:
        raise SystemExit(f"paper_figures: {case} is not the case of two triangles")
    snapped = lambda points: np.rint(points * 256) / 256  # snapped as on a device with 8 subpixel bits
    pair = [(name, colour, points, snapped(rectangle(points, PUBLISHED)))
            for name, colour, points in zip(("rising", "falling"), (BLUE, RED), (corners[:3], corners[3:]))]
    reach = 0.012
    figure, [top, left, right] = sheet(840, 450, [
        (10, 0, 820, 40, 0, 0, 820, 40), (10, 40, 400, 400, -2.3, -2.3, 2.3, 2.3),
        (430, 40, 400, 400, -0.5 - reach, 0.5 - reach, -0.5 + reach, 0.5 + reach)])
    words(top, (0, 14), f"radius {PUBLISHED:.5f} px: the boxes as drawn")
    words(top, (420, 14), "0.024 px around the upper left centre")
    pixels(left)
    for _, colour, points, box in pair:
        polygon(left, box, edgecolor=colour, linewidth=0.7)
        polygon(left, box, facecolor=colour, alpha=0.15)
        left.plot(*points[:2].T, color=colour, linewidth=2)
    misses = []
    for c in [(x, y) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]:
        dot(left, c, **OPEN)
        for k, (name, colour, _, box) in enumerate(pair):
            deep = deepest(box, np.array(c))
            misses += [-deep] if deep < 0 else []
            words(left, c, f"{name}: {'hit' if deep >= 0 else 'miss'}", 12 if c[0] > 0 else -12,
                  (20 if c[1] > 0 else -18) - 15 * k, ha="left" if c[0] > 0 else "right", color=colour, fontsize=10,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})
    words(left, (0, -2.3), f"least miss: {min(misses, default=0):.5f} px", up=6, ha="center", fontsize=10)
    for box, colour, width, down, text in (
            (pair[0][3], BLUE, 3, 10, "the same, snapped to 2^-8 px: c is outside"),
            (rectangle(corners[:3], PUBLISHED), "black", 1.2, 28, "published radius, as computed: c is inside"),
            (snapped(rectangle(corners[:3], RADIUS_8_BITS)), GREEN, 2, 46, "rising, radius of the budget, snapped")):
        polygon(right, box, edgecolor=colour, linewidth=width)
        words(right, (-0.5 + reach, 0.5 - reach), text, -6, down, ha="right", color=colour, fontsize=10)
    dot(right, (-0.5, 0.5), **OPEN)
    words(right, (-0.5, 0.5), "c", -9, 9, ha="right")
    return figure


def main(case, folder):
    for name, title, text, figure in (
            ("ball", "The ball and the pixel", "A triangle reaches into a pixel but not to its centre. Fattened by the "
             "radius of the budget it contains the centre.", ball()),
            ("coverage", "Coverage by winding", "Each corner of the proxy moves by at most the wander. The moved "
             "quadrilateral still winds once around the centre c. Its two triangles share that number.", coverage()),
            ("entry-exit", "Entry and exit", "Along the line of sight through each pixel centre of a row, the part "
             "inside the fattened triangle.", entry_exit()),
            ("passes", "The two passes", "Triangles of three objects A, B and C from the side. The first pass goes from "
             "A to C, the second from C to A. What crosses never gets both bits.", passes()),
            ("published", "Why the published radius fails", "Two triangles that pierce each other, seen edge-on, and the "
             "boxes that are drawn for them. After snapping, each box misses two of the four centres around the corner "
             "where they meet, and no centre is in both.", published(case))):
        svg = io.StringIO()
        figure.savefig(svg, format="svg", metadata={"Date": None, "Creator": None})
        for_readers = f"<title>{html.escape(title)}</title>\n<desc>{html.escape(text)}</desc>"
        out = svg.getvalue().replace(" \n", " ")  # keeps each path on one line
        out = re.sub(r"(<svg [^>]*>)", lambda m: m.group(1) + "\n " + for_readers, out, count=1)
        Path(folder, f"paper-{name}.svg").write_text(out.replace("'DejaVu Sans'", "'DejaVu Sans', Helvetica, Arial, sans-serif"))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit("usage: paper_figures.py CASE FOLDER")
    main(*sys.argv[1:])
