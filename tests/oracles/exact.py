"""Exact geometry of triangles whose corners are whole numbers: do two meet, how far are they apart, what have they in common, is
a point inside a mesh. Arrays hold 64-bit integers; each function says how large coordinates may be so that nothing overflows.
It shares no code with the product, and its two ways to distances, within() and squared(), are compared with each other."""
from fractions import Fraction
from itertools import product

import numpy as np

EDGES = ((0, 1), (1, 2), (2, 0))


def dot(u, v):
    return (u * v).sum(-1)


def cross(u, v):
    """np.cross() without its overhead."""
    a, b, c = u[..., 0], u[..., 1], u[..., 2]
    x, y, z = v[..., 0], v[..., 1], v[..., 2]
    return np.stack(np.broadcast_arrays(b * z - c * y, c * x - a * z, a * y - b * x), -1)


def boxes_overlap(p, q, gap=0):
    return ((p.min(1) <= q.max(1) + gap) & (q.min(1) <= p.max(1) + gap)).all(1)


def meet(p, q):
    """Whether triangles p[k] and q[k] have a common point; (n, 3, 3) each, |coordinate| <= 2^12.

    They have none exactly if a direction separates them strictly. One can be chosen perpendicular to a face of the difference
    p - q, or within the plane or line of p - q if it is flat: the candidates below contain all of these. A direction has at
    most degree 3 in differences (2^13), so a product with a difference is below 3 * 2 * 2 * 2^52 < 2^56."""
    out = boxes_overlap(p, q)
    left = np.flatnonzero(out)

    def separate(axes):
        """axes: (n, m, 3), directions for each pair that is left."""
        nonlocal left
        at = p[left, :1]
        a, b = axes @ (p[left] - at).swapaxes(1, 2), axes @ (q[left] - at).swapaxes(1, 2)
        apart = ((a.max(2) < b.min(2)) | (b.max(2) < a.min(2))).any(1)
        out[left[apart]] = False
        left = left[~apart]

    def edges():
        return tuple(x[left][:, [1, 2, 0]] - x[left] for x in (p, q))

    def mixed(u, v):
        """All cross products of a vector of u and one of v, which are (n, i, 3) and (n, j, 3)."""
        return cross(u[:, :, None], v[:, None]).reshape(len(u), u.shape[1] * v.shape[1], 3)

    e, f = edges()
    separate(np.stack([cross(e[:, 0], e[:, 1]), cross(f[:, 0], f[:, 1])], 1))
    separate(mixed(*edges()))
    e, f = edges()
    both = np.concatenate([e, f], 1)
    normals = np.concatenate([np.stack([cross(e[:, 0], e[:, 1]), cross(f[:, 0], f[:, 1])], 1), mixed(e, f)], 1)
    separate(np.concatenate([mixed(normals, both), both], 1))
    e, f = edges()
    both = np.concatenate([e, f], 1)
    w = q[left, :1] - p[left, :1]
    separate(np.concatenate([cross(cross(both, w), both), w], 1))
    return out


def within(p, q, square, unit):
    """Whether p[k] and q[k] are at most sqrt(square / unit) apart. |coordinate| <= 2^6, square < 2^28, unit <= 2^12: the largest
    product is unit * (3 * 2^22)^2 < 2^60."""
    out = meet(p, q)
    k = np.flatnonzero(~out)
    if not len(k):
        return out
    p, q = p[k], q[k]
    found = np.zeros(len(k), bool)

    def at_most(valid, above, below):
        found[(valid & (unit * above <= square * below)).reshape(len(k), -1).any(1)] = True

    for s, t in ((p, q), (q, p)):
        v, a, b = s[:, :, None], t[:, None], t[:, None][:, :, [1, 2, 0]]  # a corner of s, and an edge of t
        e, w = b - a, v - a
        along, length = dot(w, e), dot(e, e)
        at_most(True, dot(w, w), 1)
        at_most((along > 0) & (along < length), dot(cross(w, e), cross(w, e)), length)
        n = cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])[:, None]
        sides = dot(n[:, :, None], cross(e, w))
        at_most((sides >= 0).all(2) & n.any(2), dot(n, s - t[:, :1]) ** 2, dot(n, n))
    a, c = p[:, :, None], q[:, None]
    e, f, w = p[:, [1, 2, 0]][:, :, None] - a, q[:, [1, 2, 0]][:, None] - c, c - a
    n = cross(e, f)
    s, t, size = dot(cross(w, f), n), dot(cross(w, e), n), dot(n, n)
    at_most((size > 0) & (s >= 0) & (s <= size) & (t >= 0) & (t <= size), dot(w, n) ** 2, size)
    out[k[found]] = True
    return out


# ---- one pair, in integers of any size ----

def sub(u, v):
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]


def scalar(u, v):
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def vector(u, v):
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


def squared(p, q):
    """The square of the distance of two triangles, a Fraction."""
    best = (1, 0)

    def add(above, below):
        nonlocal best
        if above * best[1] < best[0] * below or best[1] == 0:
            best = above, below

    for s, t in ((p, q), (q, p)):
        edges = [(t[i], sub(t[j], t[i])) for i, j in EDGES]
        n = vector(edges[0][1], edges[1][1])
        flat = n == (0, 0, 0)
        heights = []
        for v in s:
            inside = not flat
            for a, e in edges:
                w = sub(v, a)
                along, length = scalar(w, e), scalar(e, e)
                if along <= 0:
                    add(scalar(w, w), 1)
                elif along < length:
                    c = vector(w, e)
                    add(scalar(c, c), length)
                inside = inside and scalar(n, vector(e, w)) >= 0
            heights.append(scalar(n, sub(v, t[0])))
            if inside:
                add(heights[-1] ** 2, scalar(n, n))
        for i, j in EDGES:  # an edge of s through the face of t
            if heights[i] * heights[j] < 0:
                d = sub(s[j], s[i])
                turns = [scalar(d, vector(sub(a, s[i]), e)) for a, e in edges]
                if min(turns) >= 0 or max(turns) <= 0:
                    return Fraction(0)
    for (i, j), (k, l) in product(EDGES, EDGES):
        e, f, w = sub(p[j], p[i]), sub(q[l], q[k]), sub(q[k], p[i])
        n = vector(e, f)
        size = scalar(n, n)
        if size and 0 <= scalar(vector(w, f), n) <= size and 0 <= scalar(vector(w, e), n) <= size:
            add(scalar(w, n) ** 2, size)
    return Fraction(*best)


def hull_of(t):
    """The corners of a triangle, without those that the others contain: 3, 2 or 1."""
    if vector(sub(t[1], t[0]), sub(t[2], t[0])) != (0, 0, 0):
        return list(t)
    ends = [min(t), max(t)]
    return ends if ends[0] != ends[1] else ends[:1]


def bounds_of(corners):
    """(normal, point, whether equal): the hull is where normal . (x - point) >= 0, or is 0 where equal is true."""
    if len(corners) == 3:
        n = vector(sub(corners[1], corners[0]), sub(corners[2], corners[0]))
        return [(n, corners[0], True)] + [(vector(n, sub(corners[j], corners[i])), corners[i], False) for i, j in EDGES]
    units = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    if len(corners) == 1:
        return [(u, corners[0], True) for u in units]
    d = sub(corners[1], corners[0])
    return [(vector(d, u), corners[0], True) for u in units] + [(d, corners[0], False), (sub((0, 0, 0), d), corners[1], False)]


def common(p, q):
    """The corners of what two triangles have in common, in turn; each a triple of Fractions. Empty: nothing."""
    points = [tuple(map(Fraction, c)) for c in hull_of(p)]
    for n, at, equal in bounds_of(hull_of(q)):
        for side in (1, -1) if equal else (1,):
            values = [side * scalar(n, sub(x, at)) for x in points]
            cut = []
            for k, x in enumerate(points):
                y, vx, vy = points[k - 1], values[k], values[k - 1]
                if vx * vy < 0:
                    cut.append(tuple(b + (a - b) * vy / (vy - vx) for a, b in zip(x, y)))
                if vx >= 0:
                    cut.append(x)
            points = [x for k, x in enumerate(cut) if x not in cut[:k]]
    if len(points) > 2:
        a, b = min(points), max(points)
        if all(vector(sub(x, a), sub(b, a)) == (0, 0, 0) for x in points):
            points = [a, b]
    return points


def contains(corners, x):
    """Whether the hull of 1 to 3 corners as of hull_of() contains the point."""
    values = [(scalar(n, sub(x, at)), equal) for n, at, equal in bounds_of(corners)]
    return all(v == 0 if equal else v >= 0 for v, equal in values)


def on_edge(corners, x):
    return len(corners) < 3 or any(contains([corners[i], corners[j]], x) for i, j in EDGES)


def kind(p, q, points):
    """How they meet, by the words of docs/record.md; points: of common()."""
    a, b = hull_of(p), hull_of(q)
    if not points:
        return "apart"
    if sorted(a) == sorted(b):
        return "equal"
    if len(points) == 1 and (points[0] in a or points[0] in b):
        return "touch-vertex"
    if len(points) == 1 and on_edge(a, points[0]) and on_edge(b, points[0]):
        return "touch-edge"
    all_corners = a + b
    normal = next((n for n in (vector(sub(y, a[0]), sub(z, a[0])) for y in all_corners for z in all_corners) if any(n)), None)
    if len(points) > 1 and (normal is None or all(scalar(normal, sub(x, a[0])) == 0 for x in all_corners)):
        return "coplanar"
    # An edge has all of a segment, or at most one end of it. So the middle decides about all points between the ends.
    middle = tuple(sum(x) / len(points) for x in zip(*points))
    return "touch-face" if len(points) > 1 and (on_edge(a, middle) or on_edge(b, middle)) else "crossing"


def meet_as_neighbours(p, q, points):
    """Whether two triangles with equal corners have more in common than these and the segments between them."""
    shared = sorted(set(p) & set(q))
    if len(shared) == 3 and len(hull_of(shared)) == 3:
        return True
    return any(not contains(hull_of((shared * 3)[:3] if len(shared) < 3 else shared), x) for x in points)


def edge_counts(mesh):
    """Per edge, by positions, how often triangles pass it in either direction; (n, 3, 3) triangles as tuples."""
    counts = {}
    for t in mesh:
        if len(set(t)) < 3:
            continue
        for i, j in EDGES:
            key = (t[i], t[j]) if t[i] < t[j] else (t[j], t[i])
            counts.setdefault(key, [0, 0])[t[i] > t[j]] += 1
    return counts.values()


def is_closed(mesh):
    return all((a + b) % 2 == 0 for a, b in edge_counts(mesh))


def is_oriented(mesh):
    return all(a == b for a, b in edge_counts(mesh))


def crossings(triangles, point, rng):
    """How often a ray from a point off the mesh passes its triangles from behind, and from the front; an array (n, 3, 3) with
    |coordinate| <= 2^14: a determinant with a direction below 2^10 is less than 6 * 2^10 * 2^30."""
    a, b, c = (triangles - np.array(point)).swapaxes(0, 1)
    height = dot(a, cross(b, c))
    seen = height != 0  # else the triangle is degenerate, or only a ray in its plane passes it
    normals = cross(b - a, c - a)[~seen]
    a, b, c, height = a[seen], b[seen], c[seen], height[seen]
    while True:
        ray = np.array([rng.randint(-1000, 1000) for _ in range(3)])
        turns = np.stack([cross(x, y) @ ray for x, y in ((a, b), (b, c), (c, a))], 1)
        if (turns != 0).all() and (normals @ ray != 0)[normals.any(1)].all():
            break
    ahead = np.sign(height) == np.sign(turns.sum(1))
    return int(((turns > 0).all(1) & ahead).sum()), int(((turns < 0).all(1) & ahead).sum())


def pieces(mesh):
    """The triangles that hang together by positions of corners, as lists of their numbers."""
    root = {}

    def find(x):
        while root.setdefault(x, x) != x:
            root[x] = x = root[root[x]]
        return x

    for t in mesh:
        for x in t[1:]:
            root[find(x)] = find(t[0])
    out = {}
    for k, t in enumerate(mesh):
        out.setdefault(find(t[0]), []).append(k)
    return list(out.values())


def is_rounded_root(root, square):
    """Whether a double is the root of a Fraction, rounded to nearest, of two as near to the even one."""
    if square == 0 or root == 0:
        return root == square
    most = Fraction(2) ** 1024 - Fraction(2) ** 970  # from here on a number is rounded to infinity
    if root == np.inf:
        return square >= most**2
    below, at, above = (Fraction(x) for x in (np.nextafter(root, 0), root, min(np.nextafter(root, np.inf), np.finfo(float).max)))
    low, high = (below + at) / 2, (at + above) / 2 if above > at else most
    even = int(np.float64(root).view(np.int64)) % 2 == 0
    return low**2 <= square <= high**2 if even else low**2 < square < high**2
