"""Verdicts of clash about solids of cubes, as they are, or with surfaces that are turned, doubled or open; and bounds of the
penetration depth against its closed form."""
from fractions import Fraction

import farcull
import numpy as np

from . import exact, solids
from .lab import all_pairs, as_tuples, indexed, require, rotation, soup

FAULTS = ["contained called clear", "clash called touch", "a lower bound of the depth too large", "a depth too small",
          "a pair of triangles not counted"]
PLAIN = "plain"
MODIFIED = ["turned", "a piece turned", "doubled", "doubled both ways", "open", "one triangle turned", "two shells"]


def modified(rng, triangles, how):
    turned = triangles[:, [0, 2, 1]]
    k = rng.randrange(len(triangles))
    if how == "a piece turned":
        k = rng.choice(exact.pieces(as_tuples(triangles)))
    if how in ("a piece turned", "one triangle turned"):
        out = triangles.copy()
        out[k] = turned[k]
        return out
    return {"turned": turned, "open": np.delete(triangles, k, 0), "doubled": np.concatenate([triangles, triangles]),
            "doubled both ways": np.concatenate([triangles, turned])}.get(how, triangles)


class Part:
    def __init__(self, rng, size, edge, offset):
        self.how = PLAIN if rng.random() < 0.5 else rng.choice(MODIFIED)
        cells = solids.random_cells(rng, size)
        self.offset = np.array(offset)
        surface = solids.surface(rng, cells, edge, self.offset)
        if self.how == "two shells":  # which overlap, touch, or lie apart or in one another
            other = solids.random_cells(rng, size)
            surface = np.concatenate([surface, solids.surface(rng, other, edge, self.offset)])
            cells = cells | other
        self.cells = cells.repeat(edge, 0).repeat(edge, 1).repeat(edge, 2)  # of edge 1
        self.triangles = modified(rng, surface, self.how)
        self.mesh = as_tuples(self.triangles)

    def places(self, inner, rng):
        """Of each piece of the other part: inside as docs/proximity.md defines it; inside in some sense; whether it would be if
        an open surface had an inside; whether that cannot be excluded by boxes."""
        closed, oriented = exact.is_closed(self.mesh), exact.is_oriented(self.mesh)
        low, high = self.images.min((0, 1)), self.images.max((0, 1))
        for piece in exact.pieces(inner.mesh):
            points = inner.images[piece].reshape(-1, 3)
            in_box = ((points >= low) & (points <= high)).all(1)
            behind, front = exact.crossings(self.triangles, inner.mesh[piece[0]][0], rng) if in_box.any() else (0, 0)
            wound, odd = oriented and behind != front, (behind + front) % 2 == 1
            perhaps = wound or odd if closed else in_box.all()
            yield closed and (wound if oriented else odd), perhaps, in_box.any()


def expected_apart(a, b, rng):
    """The verdicts that are right for parts whose surfaces do not meet, and which part may be the inner one."""
    right, inner = set(), set()
    certain = possible = False
    for number, (outer, other) in enumerate(((b, a), (a, b))):
        for inside, perhaps, in_box in outer.places(other, rng):
            if inside:
                right.add("contained")
            if outer.how != PLAIN and in_box:
                right.add("unknown")
            if in_box:
                inner.add(number)
            certain |= inside and outer.how == PLAIN
            possible |= perhaps
    if certain:
        return {"contained"}, inner
    return right if possible else {"apart", *right} - {"contained"}, inner


def scene(rng, spoil):
    coarse = rng.randint(3, 4)
    a = Part(rng, coarse, 3, [0, 0, 0])
    edge = rng.choice([1, 1, 2])
    size = rng.choice([1, 1, 2, 3])
    within = rng.random() < 0.7
    b = Part(rng, size, edge, [rng.randint(1, 3 * coarse - 2) if within else rng.randint(-7, 3 * coarse + 1) for _ in range(3)])
    if rng.random() < 0.5:
        a, b = b, a
    matrix, scale = rotation(rng)
    power = rng.choice([0, rng.randint(-30, 30)])
    clearance = float(rng.choice([0, 0, scale, rng.randint(1, 8 * scale)]))
    for part in (a, b):
        part.images = part.triangles @ matrix.T + 100
    arrays = [rng.choice([indexed, soup])(part.images) for part in (a, b)]
    V, F, starts = farcull.join(*arrays)
    made = farcull.Scene.from_arrays(np.ldexp(V, power), F, starts)
    answer = farcull.clash(made, clearance=float(np.ldexp(clearance, power)), depth=True, threads=1).json()
    require(answer["asked"] == answer["examined"] == 1 and len(answer["pairs"]) <= 1, "not one row", answer)
    row = (answer["pairs"] or [{"verdict": "clear"}])[0]
    row = spoil("contained called clear", row, lambda r: {"verdict": "clear"} if r["verdict"] == "contained" else None)
    verdict = row["verdict"]
    say = [(a.how, b.how), row]

    offset = b.offset - a.offset
    one, other = all_pairs([len(a.mesh), len(b.mesh)])
    meeting = int(exact.meet(a.triangles[one], b.triangles[other - len(a.mesh)]).sum())
    counted = spoil("a pair of triangles not counted", answer["triangle_pairs"], lambda n: n - 1 if n else None)
    require(counted == meeting, f"pairs that meet: {meeting}", counted, *say)
    overlap = solids.overlap(a.cells, b.cells, offset)
    plain = a.how == b.how == PLAIN
    facts = {verdict: 1, f"{verdict} of plain parts": plain}
    if overlap:
        verdict = spoil("clash called touch", verdict, lambda v: "touch" if v == "clash" else None)
        require(verdict in ("clash", "contained", "unknown"), "they overlap", *say)
    if meeting:
        require(verdict in ("clash", "touch"), "they meet", *say)
        require(not plain or overlap or verdict == "touch" or not row["proved"], "they touch", *say)
        facts["touch not proved"] = plain and not overlap and verdict == "clash"
    else:
        right, inner = expected_apart(a, b, rng)
        require(not plain or ("contained" in right) == overlap, "the oracle contradicts itself", right, overlap)
        apart = verdict in ("near", "clear")
        require(("apart" if apart else verdict) in right, f"right are {right}", *say)
        require(apart or row["inner"] in inner, "another part is inside", inner, *say)
        if plain and apart:
            gap = Fraction(solids.squared_gap(a.cells, b.cells, offset) * scale**2) * Fraction(4) ** power
            near = gap <= Fraction(float(np.ldexp(clearance, power))) ** 2 and clearance > 0
            require((verdict == "near") == near, f"the gap is {gap}", *say)
            require(not near or Fraction(row["squared"]) == gap, f"the gap is {gap}", *say)
    if plain and overlap and row.get("depth"):
        facts.update(check_depth(a, b, row["depth"], scale, power, spoil, say))
    return facts


def check_depth(a, b, depth, scale, power, spoil, say):
    size = Fraction(scale) * Fraction(2) ** power
    true = solids.squared_depth(a.cells, b.cells, b.offset - a.offset) * size**2
    least = spoil("a lower bound of the depth too large", depth["least"], lambda x: float(true) ** 0.5 * (1 + 1e-9))
    most = spoil("a depth too small", depth["most"], lambda x: float(true) ** 0.5 * (1 - 1e-9))
    require(0 <= Fraction(least) ** 2 <= true <= Fraction(most) ** 2, f"the squared depth is {float(true)}", least, most, *say)
    way = [Fraction(x) for x in depth["translation_of_a"]]
    require(exact.scalar(way, way) <= Fraction(most) ** 2, "the translation is longer than the depth", *say)
    return {"depths": 1, "depths with a lower bound above 0": least > 0}
