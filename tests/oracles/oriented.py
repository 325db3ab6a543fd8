"""Oriented boxes, with a clearance and at any scale. Two bundles of slivers along one line, turned obliquely, so that the boxes
along the axes of nearly all triangles overlap."""
import farcull
import numpy as np

from . import exact
from .lab import all_pairs, as_tuples, dropped, indexed, require, rotation, rows, soup, starts_of

FAULTS = ["a dropped pair", "a pair too many"]
LONG, WIDE = 32, 6


def slivers(rng, count):
    """Triangles that reach over most of the first axis; |coordinate| <= 40."""
    out = []
    width = rng.choice([0, 1, 2, 2])
    for _ in range(count):
        y, z = rng.randint(-WIDE, WIDE), rng.randint(-WIDE, WIDE)
        x = [-LONG + rng.randint(0, 8), LONG - rng.randint(0, 8), rng.randint(-LONG, LONG)]
        out.append([[at, y + rng.randint(-width, width), z + rng.randint(-width, width)] for at in x])
    return np.array(out)


def scene(rng, spoil):
    """Corners are small whole numbers in the oracle. The product gets their images under a linear map, which keeps what meets;
    a scaled rotation keeps what is near as well."""
    sizes = [rng.randint(34, 44), rng.randint(34, 44)]
    selves = [False] * 2
    if rng.random() < 0.2:
        sizes = [rng.randint(68, 80)]
        selves = [True]
    elif rng.random() < 0.1:
        sizes.append(rng.randint(1, 20))
        selves.append(False)
    corners = slivers(rng, sum(sizes))
    clearance = 0.0
    while True:
        matrix, scale = rotation(rng)
        if 3 * abs(matrix[:, 0]).min() >= abs(matrix[:, 0]).max():  # oblique
            break
    square = 0
    if rng.random() < 0.5:
        # sqrt(square) / scale in units of the corners: often exactly a distance of two of them.
        clearance = float(rng.choice([scale, 2 * scale, rng.randint(1, 3 * scale), rng.randint(1, 300)]))
        square = int(clearance) ** 2
    elif rng.random() < 0.5:
        while True:
            matrix = np.array([[rng.randint(-1 << 12, 1 << 12) for _ in range(3)] for _ in range(3)])
            if round(np.linalg.det(matrix)):
                break
    images = corners @ matrix.T
    if not clearance and rng.random() < 0.3:  # far from the origin; sums are exact
        images = images + [rng.randint(-1 << 30, 1 << 30) for _ in range(3)]
    # Oriented boxes are there for sizes between 2^-60 and 2^60, and others decide beyond.
    power = rng.choice([0, 0, 0, rng.randint(-60, -31), rng.randint(31, 45), rng.randint(-80, 80), rng.choice([-990, 990])])
    if clearance and abs(power) > 900 and rng.random() < 0.8:  # exact tests take long there
        power = 0
    V, F = rng.choice([soup, indexed])(images)
    V = np.ldexp(V, power)
    a, b = all_pairs(sizes, selves)
    near = exact.within(corners[a], corners[b], square, scale**2) if clearance else exact.meet(corners[a], corners[b])
    neighbours = np.zeros(len(a), bool)
    if selves[0]:  # neighbours share a position
        neighbours = (corners[a][:, :, None] == corners[b][:, None]).all(3).any((1, 2))
    expected = rows(np.stack([a, b], 1)[near & ~neighbours])
    found = farcull.collide(V, F, starts_of(sizes), self=selves, clearance=float(np.ldexp(clearance, power)), threads=1)
    pairs = spoil("a dropped pair", rows(found.pairs), dropped)
    missing = [pair for pair in zip(a[~near].tolist(), b[~near].tolist())]
    pairs = spoil("a pair too many", pairs, lambda all_: sorted([*all_, missing[0]]) if missing and len(sizes) > 1 else None)
    require(pairs == expected, f"sizes {sizes}, clearance {clearance}, power {power}", set(pairs) ^ set(expected),
            found.report.stages)
    shared = [(i, j, *as_tuples(corners[[i, j]])) for i, j in zip(a[neighbours].tolist(), b[neighbours].tolist())]
    require(rows(found.neighbour_pairs) == [(i, j) for i, j, p, q in shared if exact.meet_as_neighbours(p, q, exact.common(p, q))],
            "neighbours", found.neighbour_pairs, corners[a[neighbours]], corners[b[neighbours]])
    oriented = any("oriented" in str(stage.get("reason", "")) and stage["ran"] for stage in found.report.stages)
    return {"by oriented boxes": oriented, "of them with a clearance": oriented and clearance > 0,
            "pairs": len(pairs), "pairs of neighbours": len(shared),
            "of them at scales beyond 1e+-9": oriented and abs(power) > 30, "at 1e+-300": abs(power) > 900}
