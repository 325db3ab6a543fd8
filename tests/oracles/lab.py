"""What the oracles share: how a fault is planted, small scenes of whole numbers, and the names of methods and options."""
import csv
import json
import os
import re
import subprocess
import tempfile

import numpy as np

PROGRAM = os.environ.get("FARCULL_PROGRAM", "build/farcull")
BOXES = "boxes"  # the method that the oracles are about
BOXES_OPTION = "--broad-phase"  # which boxes are compared before drawing
FOLDER = tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None)
HERE = FOLDER.name + "/"


class Wrong(Exception):
    """The product and the oracle differ."""


def require(good, what, *values):
    if not good:
        raise Wrong(what + "".join(f"\n    {str(value)[:1500]}" for value in values))


class Spoiler:
    """Plants one fault into the answers of the product, so that a line shows that it would see it."""

    def __init__(self, fault=""):
        self.fault = fault
        self.planted = False

    def __call__(self, fault, answer, damage):
        """damage(answer): another answer, or None where there is nothing to damage."""
        if self.fault != fault or self.planted:
            return answer
        damaged = damage(answer)
        self.planted = damaged is not None
        return damaged if self.planted else answer


def dropped(rows):
    return rows[1:] if len(rows) else None


def rotation(rng, most=3):
    """An integer matrix m and a whole number s with m m^T = s^2: a rotation, scaled by s <= 4 most^2."""
    while True:
        a, b, c, d = (rng.randint(-most, most) for _ in range(4))
        s = a * a + b * b + c * c + d * d
        if s:
            return np.array([[a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
                             [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
                             [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d]]), s


def soup(triangles):
    """Vertices and indices of (n, 3, 3) triangles that share no vertex."""
    return np.asarray(triangles, float).reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def indexed(triangles):
    """The same with a vertex for each position."""
    V, F = np.unique(np.asarray(triangles).reshape(-1, 3), axis=0, return_inverse=True)
    return V.astype(float), F.reshape(-1, 3)


def as_tuples(triangles):
    return [tuple(map(tuple, t)) for t in np.asarray(triangles).tolist()]


def starts_of(sizes):
    return [0, *np.cumsum(sizes)[:-1].tolist()]


def all_pairs(sizes, selves=()):
    """Numbers of triangles: two columns, all pairs of different objects, and of one that is tested against itself."""
    owner = np.repeat(np.arange(len(sizes)), sizes)
    a, b = np.triu_indices(len(owner), 1)
    keep = owner[a] != owner[b]
    if len(selves):
        keep |= np.asarray(selves)[owner[a]]
    return a[keep], b[keep]


def rows(pairs):
    return list(map(tuple, np.asarray(pairs).reshape(-1, 2).tolist()))


def off(V, F):
    text = [f"OFF\n{len(V)} {len(F)} 0"]
    text += [" ".join(map(repr, v)) for v in np.asarray(V, float).tolist()]
    text += ["3 %d %d %d" % tuple(f) for f in np.asarray(F).tolist()]
    return "\n".join(text) + "\n"


def write_off(path, V, F):
    return write(path, off(V, F))


def write(path, data):
    with open(path, "wb") as file:
        file.write(data if isinstance(data, bytes) else data.encode())
    return path


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def read_table(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def call(*words, timeout=60, program=None, before=(), **options):
    """The program's status (negative: a signal), stdout and stderr, of which each message is one line again."""
    done = subprocess.run([*before, program or PROGRAM, *map(str, words)], capture_output=True, timeout=timeout, check=False,
                          stdin=options.pop("stdin", subprocess.DEVNULL), **options)
    return done.returncode, done.stdout.decode(errors="replace"), re.sub(r"\n {9}(?=\S)", " ", done.stderr.decode(errors="replace"))
