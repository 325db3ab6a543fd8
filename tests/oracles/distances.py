"""Distances against exact fractions: ties, nearest, within, self, ignored, and which object is inside another."""
from fractions import Fraction

import farcull
import numpy as np

from . import exact, solids
from .lab import all_pairs, as_tuples, dropped, indexed, require, rows, starts_of

FAULTS = ["a dropped answer", "a later one of two nearest pairs", "a distance one unit too large", "inside called none"]


def random_objects(rng):
    """Triangles of small whole numbers as arrays (n, 3, 3), with many ties: copies, grids, solids of cubes."""
    out = []
    count = rng.randint(2, 6)
    far = rng.choice([0, 1, 3, 6])
    if far == 1 and rng.random() < 0.7:  # around all others
        out.append(solids.surface(rng, np.ones((1, 1, 1), bool), 10, [-5, -5, -5]))
        if rng.random() < 0.3:
            out[0] = rng.choice([out[0][:, [0, 2, 1]], out[0][1:], np.concatenate([out[0][:1, [0, 2, 1]], out[0][1:]])])
        count -= 1
    for _ in range(count):
        what = rng.random()
        if out and what < 0.3 and far != 1:
            object_ = rng.choice(out)
        elif what < 0.5:
            edge = rng.choice([1, 3])
            cells = np.ones((1, 1, 1), bool) if rng.random() < 0.7 else solids.random_cells(rng, 2)
            object_ = solids.surface(rng, cells, edge, [0, 0, 0])
            if rng.random() < 0.2:
                object_ = np.delete(object_, rng.randrange(len(object_)), 0)
            if rng.random() < 0.2:
                object_ = object_[:, [0, 2, 1]]
        else:
            object_ = np.array([[[rng.randint(-2, 2) for _ in range(3)] for _ in range(3)] for _ in range(rng.randint(1, 4))])
        out.append(object_ + [rng.randint(-far, far) for _ in range(3)])
    return out


def inside_of(objects, a, b, apart, rng):
    """"none", "a", "b" or "not closed", as docs/proximity.md says it of objects that are apart."""
    if not apart:
        return "unknown"
    words = set()
    for outer, inner, word in ((objects[b], objects[a], "a"), (objects[a], objects[b], "b")):
        if not ((inner.min((0, 1)) >= outer.min((0, 1))).all() and (inner.max((0, 1)) <= outer.max((0, 1))).all()):
            continue
        mesh, other = as_tuples(outer), as_tuples(inner)
        if not exact.is_closed(mesh):
            words.add("not closed")
            continue
        places = []
        for piece in exact.pieces(other):
            behind, front = exact.crossings(outer, other[piece[0]][0], rng)
            places.append(behind != front if exact.is_oriented(mesh) else (behind + front) % 2 == 1)
        if all(places):
            words.add(word)
    return next((word for word in ("a", "b", "not closed") if word in words), "none")


def expected_of(tuples, sizes, question):
    """{(triangle, triangle): squared distance}, the answers."""
    starts = starts_of(sizes)
    owner = np.repeat(np.arange(len(sizes)), sizes).tolist()
    selves = [question["self"]] * len(sizes)
    most = question["within"]
    ends = [[(min(x), max(x)) for x in zip(*t)] for t in tuples]
    squares, best = {}, {}
    for a, b in zip(*(x.tolist() for x in all_pairs(sizes, selves))):  # ascending, so of equal ones the first stays
        pair = owner[a], owner[b]
        if pair in question["ignore"] or (pair[0] == pair[1] and set(tuples[a]) & set(tuples[b])):
            continue
        gap = sum(max(0, low - h, l - high) ** 2 for (low, high), (l, h) in zip(ends[a], ends[b]))  # of the boxes
        if (most is not None and gap > most**2) or (question["kind"] != "all" and pair in best and gap >= best[pair][0]):
            continue
        s = exact.squared(tuples[a], tuples[b])
        if most is not None and s > most**2:
            continue
        squares[a, b] = s
        if pair not in best or s < best[pair][0]:
            best[pair] = s, a, b
    if question["kind"] == "all":
        return squares
    if question["kind"] == "nearest":
        wanted = set()
        for o in range(len(starts)):
            others = sorted((s, sum(pair) - o, pair) for pair, (s, _, _) in best.items() if o in pair)
            wanted.update(pair for _, _, pair in others[: question["k"]])
        best = {pair: best[pair] for pair in wanted}
    return {(a, b): s for s, a, b in best.values()}


def random_question(rng, objects):
    kind = rng.choice(["objects", "nearest", "all"])
    ignore = set()
    if kind != "nearest" and rng.random() < 0.3:
        ignore = {tuple(sorted(rng.sample(range(objects), 2))) for _ in range(rng.randint(1, 2))}
    if len(ignore) == objects * (objects - 1) // 2:
        ignore = set()
    within = rng.choice([0, 1, 2, 3, Fraction(5, 2)]) if kind == "all" or rng.random() < 0.3 else None
    return {"kind": kind, "k": rng.randint(1, 3) if kind == "nearest" else 1, "within": within,
            "self": kind != "nearest" and rng.random() < 0.3, "ignore": ignore}


def check(found, tuples, sizes, question, power, spoil):
    """found: Distances of triangles times 2^power."""
    expected = expected_of(tuples, sizes, question)
    unit = Fraction(2) ** power
    answers = spoil("a dropped answer", list(found), dropped)
    pairs = rows([d.triangles for d in answers])
    pairs = spoil("a later one of two nearest pairs", pairs, lambda all_: later(all_, tuples, sizes, expected, question))
    require(sorted(pairs) == sorted(expected), "pairs", question, set(pairs) ^ set(expected), sizes, tuples)
    for d in answers:
        square = expected[d.triangles] * unit**2
        distance = spoil("a distance one unit too large", d.distance, lambda x: float(np.nextafter(x, np.inf)))
        require(Fraction(d.squared) == square and exact.is_rounded_root(distance, square), f"square {square}", question, d)
        p, q = d.points
        gap = sum((Fraction(x) - Fraction(y)) ** 2 for x, y in zip(p, q)) / unit**2
        rounding = 1e-12 + float(max(abs(Fraction(x)) for x in p + q) / unit) * 2.0**-50
        require(abs(float(gap) ** 0.5 - float(square / unit**2) ** 0.5) < rounding, "the points are not so far apart", d)
        for t, point, feature in zip(d.triangles, d.points, d.features):
            if feature.startswith("vertex"):
                corner = tuples[t][int(feature.split()[1])]
                require(tuple(Fraction(x) for x in point) == tuple(x * unit for x in corner), "not that corner", d)
    return answers


def later(pairs, tuples, sizes, expected, question):
    """The answers with one in place of which a later pair of triangles of the same objects is as near."""
    if question["kind"] == "all":
        return None
    starts = starts_of(sizes)
    for k, (a, b) in enumerate(pairs):
        o = np.searchsorted(starts, b, "right") - 1
        for c in range(b + 1, starts[o] + sizes[o]):
            if exact.squared(tuples[a], tuples[c]) == expected[a, b]:
                return [*pairs[:k], (a, c), *pairs[k + 1 :]]
    return None


def scene(rng, spoil):
    objects = random_objects(rng)
    sizes = [len(o) for o in objects]
    triangles = np.concatenate(objects)
    question = random_question(rng, len(objects))
    power = rng.choice([0, 0, rng.randint(-300, 300), -1000, 500])
    V, F = indexed(triangles)
    V = np.ldexp(V + (0 if power else rng.choice([0, 1 << 40])), power)
    unit = Fraction(2) ** power
    inside = rng.choice([True, False]) if question["kind"] != "all" else True
    found = farcull.distances(V, F, starts_of(sizes), kind=question["kind"], k=question["k"], self=question["self"], inside=inside, exact=True,
                              within=None if question["within"] is None else float(question["within"] * unit),
                              ignore=sorted(question["ignore"]) or None, threads=1)
    tuples = as_tuples(triangles)
    answers = check(found, tuples if V.max() < 1 << 30 or power else as_tuples(triangles + (1 << 40)), sizes, question, power, spoil)
    facts = {f"answers of {question['kind']}": len(answers), "answers of 0": sum(d.distance == 0 for d in answers)}
    for d in answers if inside and question["kind"] != "all" else ():
        a, b = d.objects
        said = spoil("inside called none", d.inside, lambda word: "none" if word in "ab" else None)
        right = inside_of(objects, a, b, d.squared != "0/1", rng) if a != b else said
        require(said == right, f"inside is {right}", d, sizes, tuples)
        facts["inside: " + right] = facts.get("inside: " + right, 0) + 1
    return facts
