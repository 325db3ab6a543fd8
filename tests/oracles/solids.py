"""Solids of cubes: sets of cells of a grid, whose insides, overlaps and penetration depths follow from the cells alone."""
import numpy as np

SIDES = [(axis, sign) for axis in range(3) for sign in (-1, 1)]


def random_cells(rng, size):
    """Cells of a (size)^3 grid, as a boolean array: blocks, ells, shells around a cavity, also with something in it."""
    cells = np.zeros((size,) * 3, bool)

    def block(value, low, high):
        lo = [rng.randint(low, high) for _ in range(3)]
        hi = [rng.randint(k, high) for k in lo]
        cells[tuple(slice(l, h + 1) for l, h in zip(lo, hi))] = value

    what = rng.random()
    if what < 0.35 and size >= 3:
        cells[:] = True
        block(False, 1, size - 2)
        if rng.random() < 0.3 and size >= 5:
            cells[1:-1, 1:-1, 1:-1] = False
            cells[size // 2, size // 2, size // 2] = rng.random() < 0.5
    else:
        for _ in range(rng.randint(1, 3)):
            block(True, 0, size - 1)
        if what > 0.8:
            block(False, 0, size - 1)
    if not cells.any():
        cells[0, 0, 0] = True
    return cells


def surface(rng, cells, edge, offset):
    """The boundary as an array (n, 3, 3) of triangles that face outward. edge: of a cell; offset: of the grid's corner."""
    out = []
    padded = np.pad(cells, 1)
    for axis, sign in SIDES:
        bare = cells & ~np.roll(padded, -sign, axis)[1:-1, 1:-1, 1:-1]
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for cell in np.argwhere(bare):
            quad = np.tile(cell, (4, 1))
            quad[:, axis] += sign > 0
            quad[1:3, u] += 1
            quad[2:, v] += 1
            if sign < 0:
                quad = quad[::-1]
            k = rng.randint(0, 3)
            quad = np.roll(quad, k, 0)
            out += [quad[[0, 1, 2]], quad[[0, 2, 3]]]
    return np.array(out) * edge + offset


def differences(a, b, offset):
    """Which cells of b, at this offset, are where from cells of a: a boolean array, and what its corner stands for."""
    out = np.zeros(np.add(a.shape, b.shape) - 1, bool)
    mirrored = a[::-1, ::-1, ::-1]
    for cell in np.argwhere(b):
        out[tuple(slice(k, k + n) for k, n in zip(cell, a.shape))] |= mirrored
    return out, np.array(offset) - a.shape + 1


def overlap(a, b, offset):
    at, low = differences(a, b, offset)
    return bool((low <= 0).all() and (-low < at.shape).all() and at[tuple(-low)])


def squared_gap(a, b, offset):
    """The square of the distance of two solids that do not overlap."""
    at, low = differences(a, b, offset)
    return int((np.maximum(np.abs(np.argwhere(at) + low) - 1, 0) ** 2).sum(1).min())


def squared_depth(a, b, offset):
    """The square of the shortest translation of a after which no cell of it overlaps one of b. Each cell of a and each of b
    forbid the open cube of edge 2 around their difference. The rest of the space is made of corners, and open edges, faces and
    cells of the grid. At twice the coordinates even numbers are corners, and odd ones lie between two. The rest is closed, so
    the nearest point of a closed cell that is left belongs to it as well."""
    at, low = differences(a, b, offset)
    forbidden = np.zeros(2 * np.array(at.shape) + 1, bool)
    for i in range(3):
        for j in range(3):
            for k in range(3):
                forbidden[tuple(slice(o, o + 2 * n, 2) for o, n in zip((i, j, k), at.shape))] |= at
    free = np.abs(np.argwhere(~forbidden) + 2 * low - 1) // 2
    beyond = np.concatenate([1 - low, low + at.shape])  # along an axis, behind all cubes
    return int(min((free**2).sum(1).min(initial=1 << 40), (beyond**2).min()))
