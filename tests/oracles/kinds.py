"""Kinds of contact, the ends of what two triangles have in common, and neighbours, against exact fractions."""
from fractions import Fraction

import farcull
import numpy as np

from . import exact
from .lab import all_pairs, as_tuples, dropped, indexed, require, rows, soup, starts_of

FAULTS = ["a dropped pair", "a dropped pair of neighbours", "another kind", "an end that is rounded twice", "not a neighbour"]


def random_triangles(rng):
    """Few positions, so that triangles touch, share corners, lie in common planes, or are segments and points."""
    most = rng.choice([1, 1, 2, 2, 3, 5])
    flat = rng.random() < 0.2
    pool = [[rng.randint(0, most), rng.randint(0, most), 0 if flat else rng.randint(0, most)] for _ in range(rng.randint(4, 9))]
    out = []
    for _ in range(rng.randint(2, 9)):
        out.append([rng.choice(pool) if rng.random() < 0.7 else [rng.randint(0, most) for _ in range(3)] for _ in range(3)])
    return np.array(out)


def scene(rng, spoil):
    corners = random_triangles(rng)
    if rng.random() < 0.4:  # a map that keeps what is in common, in larger numbers
        corners = corners @ np.array([[rng.randint(-99, 99) for _ in range(3)] for _ in range(3)]) + rng.randint(-1 << 20, 1 << 20)
    power = rng.choice([0, 0, rng.randint(-200, 200), -1030, 990])
    count = len(corners)
    cuts = sorted(rng.sample(range(1, count), rng.randint(0, min(2, count - 1))))
    sizes = np.diff([0, *cuts, count]).tolist()
    selves = [rng.random() < 0.7 or not cuts for _ in sizes]
    V, F = rng.choice([soup, indexed])(corners)
    V = np.ldexp(V, power)
    clearance = 0.0 if power or rng.random() < 0.7 else float(rng.randint(1, 3))
    segments = rng.random() < 0.7
    found = farcull.collide(V, F, starts_of(sizes), self=selves, contacts=True, segments=segments, clearance=clearance, threads=1)

    tuples = as_tuples(corners)
    owner = np.repeat(np.arange(len(sizes)), sizes).tolist()
    expected = {False: [], True: []}
    for a, b in zip(*(x.tolist() for x in all_pairs(sizes, selves))):
        p, q = tuples[a], tuples[b]
        points = exact.common(p, q)
        neighbours = owner[a] == owner[b] and bool(set(p) & set(q))
        if neighbours:
            collide = exact.meet_as_neighbours(p, q, points)
        else:
            collide = bool(points) or (clearance > 0 and exact.squared(p, q) <= clearance**2)
        if collide:
            expected[neighbours].append((a, b, exact.kind(p, q, points), points))
    facts = {}
    for neighbours, fault, pairs, kinds, ends in (
            (False, "a dropped pair", found.pairs, found.kinds, found.segments),
            (True, "a dropped pair of neighbours", found.neighbour_pairs, found.neighbour_kinds, found.neighbour_segments)):
        wanted = expected[neighbours]
        pairs = spoil(fault, rows(pairs), dropped)
        if not neighbours:
            more = rows(found.neighbour_pairs)
            pairs = spoil("not a neighbour", pairs, lambda rows_, more=more: sorted(rows_ + more[:1]) if more else None)
        require(pairs == [w[:2] for w in wanted], f"pairs, neighbours {neighbours}", pairs, wanted, tuples, sizes, selves)
        names = [farcull.KINDS[k] for k in kinds]
        names = spoil("another kind", names, lambda n: [farcull.KINDS[farcull.KINDS.index(n[0]) - 1], *n[1:]] if n else None)
        require(names == [w[2] for w in wanted], "kinds", names, [(tuples[w[0]], tuples[w[1]], w[2]) for w in wanted])
        for name in names:
            facts[name] = facts.get(name, 0) + 1
        if not segments:
            require(ends is None, "segments that nobody asked for")
            continue
        for (a, b, _, points), given in zip(wanted, ends.tolist()):
            given = spoil("an end that is rounded twice", given, 
                          lambda g: None if np.isnan(g[0][0]) else [[np.nextafter(g[0][0], np.inf), *g[0][1:]], g[1]])
            if len(points) in (1, 2):
                right = [[float(x * Fraction(2) ** power) for x in p] for p in (min(points), max(points))]
                require(given == right, "ends", given, right, tuples[a], tuples[b])
            else:
                require(np.isnan(given).all(), "ends of a polygon or nothing", given, tuples[a], tuples[b])
        facts["pairs of neighbours" if neighbours else "pairs"] = len(pairs)
    return facts
