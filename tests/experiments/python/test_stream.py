"""Streams of pairs: they are the pairs of a collider, in order, and memory does not grow with them."""
import os
import subprocess
import sys

import farcull
import numpy as np
import pytest
from lab import ALL, FOLDER, refused


def crossed(n):
    """Two objects of n long triangles each, in planes x = k and y = k: each meets all of the other object."""
    k = np.arange(n, dtype=float)
    low, high, lower, upper = np.full(n, -1.0), np.full(n, n + 1.0), np.full(n, -0.5), np.full(n, 0.5)
    ends = [(low, lower), (high, lower), (low, upper)]
    first = np.stack([np.stack([k, along, z], 1) for along, z in ends], 1)
    second = np.stack([np.stack([along, k, z], 1) for along, z in ends], 1)
    return np.concatenate([first, second]).reshape(-1, 3), np.arange(6 * n).reshape(-1, 3), [0, n]


def tangled():
    rng = np.random.default_rng(3)
    V = rng.uniform(-1, 1, (120, 3)).round(1)
    return V, rng.integers(0, 120, (160, 3)), [0, 40, 80, 120]


def parts_of(stream):
    parts = list(stream)
    assert all(len(p.pairs) == len(p.neighbours) > 0 for p in parts)
    empty = np.empty((0, 2), np.int64)
    return parts, np.concatenate([empty] + [p.pairs for p in parts])


@pytest.mark.parametrize("options", [
    {}, dict(self=True), dict(self=[True, False, True, False]), dict(self=True, neighbours=False),
    dict(ALL, clearance=0.05), dict(ALL, ignore=[(0, 1), (3, 2)]), dict(ALL, limit=77), dict(ALL, threads=3)])
def test_pairs_are_those_of_a_collider_in_order(options):
    V, F, objects = tangled()
    whole = farcull.collide(V, F, objects, **options)
    stream = farcull.stream(V, F, objects, **options)
    parts, pairs = parts_of(stream)
    order = np.lexsort((pairs[:, 1], pairs[:, 0]))
    assert (order == np.arange(len(pairs))).all()
    is_neighbour = np.concatenate([p.neighbours for p in parts])
    assert (pairs[~is_neighbour] == whole.pairs).all() and (pairs[is_neighbour] == whole.neighbour_pairs).all()
    assert len(pairs) > 50 and stream.complete == whole.complete
    if options.get("contacts"):
        kinds = np.concatenate([p.kinds for p in parts])
        assert (kinds[~is_neighbour] == whole.kinds).all() and (kinds[is_neighbour] == whole.neighbour_kinds).all()
    else:
        assert all(p.kinds is None for p in parts)
    assert list(stream) == []  # the end remains the end


def test_nothing_is_an_end_and_errors_are_those_of_collide():
    V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [9, 9, 9], [8, 9, 9], [9, 8, 9]])
    nothing = farcull.stream(V, [[0, 1, 2], [3, 4, 5]], [0, 1])
    assert list(nothing) == [] and nothing.complete and nothing.decided == 0
    for where, arguments in (("object_starts", (V, [[0, 1, 2]])), ("F", (V, [[0, 1, 6], [3, 4, 5]], [0, 1])),
                             ("V", (V * np.nan, [[0, 1, 2], [3, 4, 5]], [0, 1]))):
        assert refused(farcull.stream, *arguments) == where
    assert refused(farcull.stream, V, [[0, 1, 2], [3, 4, 5]], [0, 1], ignore=[(0, 2)]) == "ignore"


def test_the_arrays_may_change_while_pairs_come():
    V, F, objects = crossed(500)
    stream = farcull.stream(V, F, objects)
    first = next(stream)
    V[:] = 0
    F[:] = 0
    assert len(first.pairs) + sum(len(p.pairs) for p in stream) == 500 * 500


MEASURED = """
import resource, sys
import numpy as np, farcull
sys.path.insert(0, {folder!r})
from test_stream import crossed
V, F, objects = crossed({n})
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024  # MiB
farcull.collide(V[:6], F[:2], self=True)  # libraries and threads are there
sum(len(p.pairs) for p in farcull.stream(*crossed(300)))
before, count = peak(), 0
if {whole}:
    count = len(farcull.collide(V, F, objects).pairs)
else:
    count = sum(len(p.pairs) for p in farcull.stream(V, F, objects))
assert count == {n} ** 2, count
print(peak() - before)
"""


def growth(n, whole):
    code = MEASURED.format(folder=FOLDER, n=n, whole=whole)
    return float(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)


def test_memory_does_not_grow_with_the_pairs():
    # 1,440,000 pairs of 2,400 triangles: 22 MiB as an array alone.
    streamed, whole = growth(1200, False), growth(1200, True)
    print(f"memory of 1,440,000 pairs: {streamed:.1f} MiB streamed, {whole:.1f} MiB at once")
    # Of a part: 2^16 candidates as 8 bytes, found as 40, and as arrays of 18; twice, since a vector grows by
    # doubling; and what each thread adds: 12 MiB at most. The twin has 22 at least.
    assert streamed < 12
    assert whole > 22  # twin: who keeps all pairs is seen


def test_a_stream_that_was_interrupted_gives_no_more():
    code = """
import signal, farcull, sys
sys.path.insert(0, {folder!r})
from test_stream import crossed
V, F, objects = crossed(3000)
def stop(*_):
    raise KeyboardInterrupt
signal.signal(signal.SIGALRM, stop)
stream = farcull.stream(V, F, objects, contacts=True)
for attempt in range(2000):
    signal.setitimer(signal.ITIMER_REAL, 0.02)
    try:
        for part in stream:
            pass
        sys.exit("never interrupted within a part: the case shows nothing")
    except KeyboardInterrupt:
        pass
    except farcull.Error as error:
        signal.setitimer(signal.ITIMER_REAL, 0)
        assert error.where == "stream" and "an earlier call" in error.reason, error
        print("refused")
        break
""".format(folder=FOLDER)
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert said.stdout == "refused\n", said


def test_a_forked_process_is_refused():
    stream = farcull.stream(*crossed(300))
    next(stream)
    child = os.fork()
    if child == 0:
        try:
            next(stream)
        except farcull.Error as error:
            os._exit(7 if "another process" in error.reason else 1)
        os._exit(2)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
