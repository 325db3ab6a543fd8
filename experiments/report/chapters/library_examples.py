"""The smallest pair of each kind of fault of each library, for libraries.py: as a table, as pictures, and as a file in
the format of the suite."""
from dataclasses import dataclass

from frame import *  # noqa: F403: a chapter uses most of it

FAULTS = {"missed": "missed", "false": "wrong", "death": "death"}  # and the ends of their columns
TITLES = {"missed": "Missed: pairs that meet and that a library calls apart",
          "false": "False alarms: pairs apart that a library calls meeting"}
CAPTION = (
    "The pairs of the table of examples, one for each contestant: the first triangle is filled, the second has dashed "
    "edges. Each pair is moved and stretched along x, y and z until its box is a cube, which changes nothing about "
    "whether triangles meet, and is seen from where both triangles are broad. So every panel has a scale of its own, "
    "and says nothing of lengths and angles: the table has the coordinates. A triangle that is equal to the other, or "
    "much smaller, cannot be seen, nor can differences in the last place.")
KINDS = ["apart", "touch-vertex", "touch-edge", "touch-face", "crossing", "coplanar", "equal", "neighbours-meet",
         "neighbours-apart"]  # how the triangles of a labelled pair meet


def decimal(x):
    """The shortest decimal text of a double, with an exponent where that is shorter; no -0."""
    return min(np.format_float_positional(x + 0.0, trim="-"),
               np.format_float_scientific(x + 0.0, trim="-", exp_digits=2), key=len)


@dataclass
class Example:
    contestant: str
    fault: str
    family: str
    line: str  # as a suite has it: number, parameter, shared corners, kind, 18 coordinates

    def __post_init__(self):
        """Reads the line: corners has six points, those of the first triangle first; words has them in decimal."""
        words = self.line.split()
        try:
            self.kind, self.corners = words[3], np.array([float.fromhex(word) for word in words[4:]]).reshape(6, 3)
            good = self.kind in KINDS + ["?"] and np.isfinite(self.corners).all()
        except (ValueError, IndexError, OverflowError):
            good = False
        if not good:
            raise Damaged(f"the example of {self.contestant} is no pair: {self.line}")
        self.words = " ".join("(" + ", ".join(map(decimal, corner)) + ")" for corner in self.corners)


def examples_of(rows):
    """For each contestant and fault the example whose corners take the fewest characters."""
    found = [Example(contestant, fault, row.family, line) for contestant, of in by(rows, "method")
             for fault, end in FAULTS.items() for row in of.itertuples() if (line := text(row, "example_" + end))]
    best = {}
    for example in sorted(found, key=lambda example: len(example.words)):
        best.setdefault((example.contestant, example.fault), example)
    return [best[key] for key in dict.fromkeys((one.contestant, one.fault) for one in found)]


def in_unit_cube(corners):
    """Moved and stretched along each axis until the box of the corners is the unit cube. Halves, since the difference
    of two doubles may be infinite."""
    half = corners / 2
    low, size = half.min(axis=0), half.max(axis=0) - half.min(axis=0)
    return np.where(size > 0, (half - low) / np.where(size > 0, size, 1), 0)


def seen_along(direction, corners):
    """The corners in the plane across a direction."""
    along = np.array(direction) / np.linalg.norm(direction)
    right = np.cross([0, 0, 1] if abs(along[2]) < 0.9 else [0, 1, 0], along)
    right /= np.linalg.norm(right)
    return np.column_stack([corners @ right, corners @ np.cross(along, right)])


def clearness(seen):
    """Large where both triangles are seen from their broad sides; a degenerate one has its length."""
    def size(a, b, c):
        (ux, uy), (vx, vy) = b - a, c - a
        return abs(ux * vy - uy * vx) / 2 + 0.1 * max(np.linalg.norm(edge) for edge in (b - a, c - b, a - c))
    return min(size(*seen[:3]), size(*seen[3:]))


def panel_of(example):
    """Both triangles from that of 16 directions from which they are seen best."""
    corners = in_unit_cube(example.corners)
    seen = max((seen_along((x, y, z), corners) for x in (-1, -0.3, 0.3, 1) for y in (0.4, 1) for z in (0.3, 0.8)),
               key=clearness)
    return Panel(example.contestant, drawing=True, series=[
        Series(name, list(seen[at, 0]), list(seen[at, 1]), style) for name, at, style in (
            ("first triangle", [0, 1, 2, 0], "area"), ("second triangle", [3, 4, 5, 3], "lines"))])


def add_examples(chapter, rows):
    """rows: those about pairs of triangles, of contestants that are not ours. Adds nothing where they hold no example.
    Raises ValueError where an example is no pair."""
    examples = examples_of(rows)
    if not examples:
        return
    chapter.tables.append(Table(
        "libraries-examples",
        "The smallest pair of each kind of fault, of pairs of which the documentation promises the answer: how its "
        "triangles meet, the corners of the first, then those of the second",
        columns(["contestant", "fault", "family", "kind", "coordinates"], []),
        [[one.contestant, one.fault, one.family, one.kind, one.words] for one in examples]))
    chapter.files["libraries-examples.txt"] = (
        "farcull-pairs 1 libraries-examples\n# Pairs at which libraries err, minimized: whose fault, which, and the "
        "family that the pair was made from.\n" + "".join(
            f"# {one.contestant} {one.fault} {one.family}\n{number} {one.line.split(' ', 1)[1]}\n"
            for number, one in enumerate(examples)))
    figures = [Figure("libraries-examples-" + fault, title, CAPTION, [
        panel_of(one) for one in examples if one.fault == fault]) for fault, title in TITLES.items()]
    chapter.figures += [figure for figure in figures if figure.panels]
