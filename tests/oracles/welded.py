"""--weld and --ignore of clash: parts in files, whose vertices are merged here by the rule of the documentation, and names with
stars. The answer has to be that about the merged parts, in which the pairs that meet are counted exactly."""
import re

import farcull
import numpy as np

from . import exact, solids
from .lab import HERE, all_pairs, as_tuples, require, soup, starts_of, write_off

FAULTS = ["a vertex that is not merged", "a row that is not ignored", "a pair of triangles not counted"]
NAMES = ["base", "link1", "link2", "link-long", "hand", "a", "ab", "b+", "x y"]


def weld(V, F, square):
    """Each vertex becomes the nearest earlier one that is kept, of equally near ones the first, if its squared distance is at
    most this; vertices that no triangle uses are left out."""
    kept, to = [], {}
    for v in sorted(set(F.ravel().tolist())):
        near = min(((sum((x - y) ** 2 for x, y in zip(V[v], V[w])), w) for w in kept), default=None)
        if near and near[0] <= square:
            to[v] = near[1]
        else:
            kept.append(v)
            to[v] = v
    return np.array([[to[v] for v in t] for t in F.tolist()])


def random_part(rng):
    """Whole numbers, up to 2^9; corners of cubes are given once for each face, a little apart."""
    if rng.random() < 0.6:
        triangles = solids.surface(rng, solids.random_cells(rng, rng.randint(1, 2)), 16, [rng.randint(-2, 2) * 16] * 3)
        triangles = triangles + [16 * rng.randint(-2, 2) for _ in range(3)]
        spread = rng.choice([0, 1, 2, 5])
    else:
        triangles = np.array([[[rng.randint(-40, 40) for _ in range(3)] for _ in range(3)] for _ in range(rng.randint(1, 8))])
        spread = 0
    V, F = soup(triangles)
    V = V.astype(int) + [[rng.randint(-spread, spread) for _ in range(3)] for _ in V]
    order = list(range(len(F)))
    rng.shuffle(order)
    return V, F[order]


def matches(pattern, name):
    return re.fullmatch(".*".join(map(re.escape, pattern.split("*"))), name, re.DOTALL) is not None


def scene(rng, spoil):
    count = rng.choice([2, 3, 4, 4])
    names = rng.sample(NAMES, count)
    parts = [random_part(rng) for _ in names]
    tolerance = rng.choice([0, 1, 2, 3, 5, 12, 40])
    if rng.random() < 0.5:  # the square of a tolerance between two whole squares
        tolerance += 0.5
    files = [write_off(HERE + name + ".off", V, F) for name, (V, F) in zip(names, parts)]
    merged = [(V, weld(V.tolist(), F, tolerance**2)) for V, F in parts]
    words = [*names, *names, "link*", "*a*", "*", "b+*"]
    patterns = [[rng.choice(words) for _ in range(2)] for _ in range(rng.choice([0, 1, 1, 2]))]
    ignored, unknown = set(), False
    for p, q in patterns:
        pairs = {(min(i, j), max(i, j)) for i in range(count) for j in range(count)
                 if i != j and matches(p, names[i]) and matches(q, names[j])}
        unknown |= not pairs
        ignored |= pairs
    try:
        loaded = farcull.Scene(*files, weld=tolerance)
        answer = farcull.clash(loaded, ignore=patterns or None, threads=1).json()
    except farcull.InputError as error:
        require(unknown, f"refused: {error}", names, patterns)
        return {"refused": 1}
    require(not unknown, "names that no part has", names, patterns)

    # The vertices of triangles, as the file was read and as they are merged here.
    sizes = [len(F) for _, F in merged]
    triangles = np.concatenate([V[F] for V, F in merged])
    read = np.asarray(loaded.vertices)[np.asarray(loaded.triangles)]
    was = np.concatenate([V[F] for V, F in parts])
    read = spoil("a vertex that is not merged", read, lambda x: was if (was != triangles).any() else None)
    require((read == triangles).all(), f"merged otherwise at {tolerance}", read[(read != triangles).any((1, 2))][:1],
            triangles[(read != triangles).any((1, 2))][:1])
    direct = farcull.clash(farcull.Scene.from_arrays(*soup(triangles), starts_of(sizes), names=names),
                           ignore=sorted(ignored) or None, threads=1).json()
    require(direct["pairs"] == answer["pairs"], "rows of files and of arrays", direct["pairs"], answer["pairs"])

    a, b = all_pairs(sizes)
    owner = np.repeat(np.arange(count), sizes)
    meeting = exact.meet(triangles[a], triangles[b])
    counts = {}
    for i, j in zip(owner[a[meeting]].tolist(), owner[b[meeting]].tolist()):
        counts[i, j] = counts.get((i, j), 0) + 1
    rows = answer["pairs"]
    rows = spoil("a row that is not ignored", rows,
                 lambda r: [{**r[0], "ignored": True}, *r[1:]] if r and not r[0]["ignored"] else None)
    rows = spoil("a pair of triangles not counted", rows,
                 lambda r: [{**r[0], "triangle_pairs": r[0]["triangle_pairs"] - 1}, *r[1:]] if r else None)
    say = names, patterns, rows
    listed = {(r["object_a"], r["object_b"]): r for r in rows}
    require(len(listed) == len(rows), "a pair has two rows", *say)
    require(all(counts.get(pair, 0) == r["triangle_pairs"] for pair, r in listed.items()), "pairs that meet", counts, *say)
    require(set(counts) <= set(listed), "a pair that meets has no row", counts, *say)
    require(all(r["ignored"] == (pair in ignored) for pair, r in listed.items()), "ignored", ignored, *say)
    ignores = [r["ignored"] for r in rows]
    require(ignores == sorted(ignores), "ignored rows are not the last", *say)
    require(answer["asked"] == answer["examined"] == count * (count - 1) // 2 - len(ignored), "asked", answer)
    require(answer["ignored"] == len(ignored) and answer["ignored_meet"] == sum(ignores), "ignored", answer)
    serious = [r for r in rows if not r["ignored"] and r["verdict"] in ("clash", "contained", "unknown")]
    require(answer["clean"] == (not serious and answer["asked"] > 0), "clean", answer)
    for verdict, number in answer["verdicts"].items():
        found = sum(r["verdict"] == verdict and not r["ignored"] for r in rows)
        require(number == found or verdict == "clear" and number == answer["asked"] - sum(not i for i in ignores), "verdicts", answer)
    return {"vertices merged": int((was != triangles).any(2).sum()), "rows": len(rows), "ignored rows": sum(ignores),
            "triangles that became flat": sum(len(set(t)) < 3 for t in as_tuples(triangles))}
