"""A Collider and a DistanceFinder that are asked again and again: some vertices move, all move, or none; poses, also alone; other
triangles, objects, labels; and calls that raise an exception in between. Each answer is compared with exact ones."""
import farcull
import numpy as np

from . import distances, exact
from .lab import all_pairs, as_tuples, dropped, require, rotation, rows, soup, starts_of

FAULTS = ["the answer of the frame before", "a dropped pair", "a dropped answer"]
FAILED, ANSWERED, LABELS = range(3)  # of the call before


class Frame:
    """The triangles as they were given, and as a pose moved them."""

    def __init__(self, rng, sizes, spread):
        self.sizes, triangles = sizes, []
        for size in sizes:
            at = np.array([rng.randint(-spread, spread) for _ in range(3)])
            small = rng.choice([2, 6])
            triangles += [[at + [rng.randint(-small, small) for _ in range(3)] for _ in range(3)] for _ in range(size)]
        self.given = self.moved = np.array(triangles)

    def step(self, rng):
        given = self.given.copy()
        for k in rng.sample(range(len(given)), rng.choice([1, 1, len(given) // 4, len(given)])):
            given[k, rng.randint(0, 2)] = [rng.randint(-6, 6) for _ in range(3)]
        if rng.random() < 0.2:  # an object moves as a whole
            starts = starts_of(self.sizes)
            o = rng.randrange(len(starts))
            given[starts[o] : starts[o] + self.sizes[o]] = (given[starts[o] : starts[o] + self.sizes[o]] + 1) % 7
        self.given = self.moved = given

    def pose(self, rng):
        """Poses of whole numbers, so that no product is rounded."""
        poses, self.moved = [], self.given.copy()
        starts = starts_of(self.sizes)
        for start, size in zip(starts, self.sizes):
            matrix = rotation(rng, 1)[0] if rng.random() < 0.5 else np.eye(3, dtype=int)
            shift = np.array([rng.randint(-4, 4) for _ in range(3)])
            poses.append(np.concatenate([matrix, shift[:, None]], 1))
            self.moved[start : start + size] = self.given[start : start + size] @ matrix.T + shift
        return np.array(poses, float)


def refused(rng, asked, frame, selves):
    """Calls that are wrong in one way. The exception is the answer."""
    V, F = soup(frame.given)
    starts = starts_of(frame.sizes)
    bad = V.copy()
    bad[rng.randrange(len(bad))] = np.nan
    beyond = F.copy()
    beyond[rng.randrange(len(F)), 0] = len(V)
    wrong = rng.choice([
        lambda: asked.find(bad, F, starts), lambda: asked.find(V, beyond, starts), lambda: asked.find(V, F, [*starts, len(F) + 1]),
        lambda: asked.find(V, F, starts, poses=np.zeros((len(starts) + 1, 3, 4))),
        lambda: asked.find(V, F, None if not selves else [3, 2]),
        lambda: asked.find(V, F, starts, poses=np.full((len(starts), 3, 4), np.inf)),
        lambda: asked.find("V", F, starts), lambda: asked.find(V, F, starts, poses=np.eye(3))])
    try:
        wrong()
    except farcull.InputError:
        return
    require(False, "a call that is wrong was answered")


def scene(rng, spoil):
    far = rng.random() < 0.3  # distances, which take more time
    sizes = [rng.randint(1, 4) if far else rng.choice([1, 5, rng.randint(17, 40)]) for _ in range(rng.randint(2, 4))]
    selves = not far and rng.random() < 0.3
    pairs_of_objects = [(i, j) for i in range(len(sizes)) for j in range(i + 1, len(sizes))]
    ignore = {rng.choice(pairs_of_objects)} if len(sizes) > 2 and rng.random() < 0.3 else set()
    clearance = 0 if far or rng.random() < 0.6 else rng.randint(1, 3)
    limit = rng.randint(1, 40) if not far and not selves and rng.random() < 0.15 else None
    question = {"kind": rng.choice(["objects", "nearest"]) if not ignore else "objects", "k": 1, "within": None, "self": False,
                "ignore": ignore}
    if far:
        asked = farcull.DistanceFinder(kind=question["kind"], ignore=sorted(ignore) or None, threads=1, inside=False)
    else:
        asked = farcull.Collider(self=selves, clearance=float(clearance), ignore=sorted(ignore) or None, limit=limit, threads=1)
    frame = Frame(rng, sizes, rng.choice([2, 6, 12]))
    before, known, facts = None, FAILED, {"frames": 0, "exceptions": 0, "of poses alone": 0, "pairs": 0}
    for _ in range(5):
        what = rng.random()
        if what < 0.12:
            refused(rng, asked, frame, selves)
            known = FAILED
            facts["exceptions"] += 1
            continue
        labels, order = None, np.arange(len(frame.given))
        alone = what < 0.35 and known == ANSWERED
        if alone:
            arguments = {"poses": frame.pose(rng)}
            facts["of poses alone"] += 1
        else:
            if what < 0.45:
                sizes = [rng.randint(1, 4) if far else rng.randint(1, 30) for _ in frame.sizes]
                frame = Frame(rng, sizes, rng.choice([2, 6, 12]))
            elif what < 0.9:
                frame.step(rng)
            order = np.arange(len(frame.given))
            if not ignore and limit is None and rng.random() < 0.2:
                labels = np.repeat(np.arange(len(frame.sizes)) * 3 - 2, frame.sizes)
                rng.shuffle(order)
            V, F = soup(frame.given)
            F = F[order]
            poses = frame.pose(rng) if labels is None and rng.random() < 0.3 else None
            if poses is None:
                frame.moved = frame.given
            arguments = {"V": V, "F": F, "poses": poses}
            arguments.update({"labels": labels[order]} if labels is not None else {"object_starts": starts_of(frame.sizes)})
        if known == FAILED and rng.random() < 0.5:
            try:
                asked.find(poses=np.tile(np.eye(4), (len(frame.sizes), 1, 1)))
                require(False, "poses alone moved the arrays of a call that raised an exception")
            except farcull.InputError:
                pass
        found = asked.find(**arguments)
        facts["frames"] += 1
        known = ANSWERED if labels is None else LABELS
        answer = rows(found.triangles if far else found.pairs)
        names = np.argsort(order)  # of a triangle here: its place in the call
        if far:
            # Triangles of an object count in the order of the call, which decides ties.
            owner = np.repeat(np.arange(len(frame.sizes)), frame.sizes)
            sorted_ = np.lexsort((names, owner))
            expected = distances.expected_of(as_tuples(frame.moved[sorted_]), frame.sizes, question)
            places = names[sorted_].tolist()
            answer = spoil("a dropped answer", answer, dropped)
            require(sorted(answer) == sorted((places[x], places[y]) for x, y in expected), "nearest pairs", answer, expected, arguments)
        else:
            answer = spoil("a dropped pair", answer, dropped)
            expected = meeting(frame, selves, ignore, clearance, names)
            if limit is not None:
                require(found.complete or len(answer) == limit, "not complete", limit)
                require(len(expected) <= limit or not found.complete, "complete", limit)
                expected = expected[:limit]
            answer = spoil("the answer of the frame before", answer,
                           lambda now, before=before: before if before is not None and before != expected else None)
            require(answer == expected, f"pairs; what {what}", set(answer) ^ set(expected), arguments)
        facts["pairs"] += len(answer)
        before = answer
    return facts


def meeting(frame, selves, ignore, clearance, names):
    a, b = all_pairs(frame.sizes, [selves] * len(frame.sizes))
    p, q = frame.moved[a], frame.moved[b]
    owner = np.repeat(np.arange(len(frame.sizes)), frame.sizes)
    near = exact.within(p, q, clearance**2, 1) if clearance else exact.meet(p, q)
    near &= (owner[a] != owner[b]) | ~(p[:, :, None] == q[:, None]).all(3).any((1, 2))
    for i, j in ignore:
        near &= (owner[a] != i) | (owner[b] != j)
    return sorted((min(x), max(x)) for x in zip(names[a[near]].tolist(), names[b[near]].tolist()))
