"""How much processor time a call from Python takes beyond the same call in C++, on one thread.

    cmake --build build --target farcull farcull_python farcull_python_overhead -j 2
    PYTHONPATH=build/python /usr/bin/python3 experiments/python_overhead.py build/farcull_python_overhead

A second argument is the scene (default two-bunnies), a third the number of rounds. In each round every kind of call
is made once, in a random order, so that other load on the machine meets all of them. It prints the median of C++ and,
for each type of index, the median and the quartiles over the rounds of the time divided by that of C++ in the same
round. The triangles that move are those around one triangle.
"""

import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import farcull
import numpy as np

TYPES = ("uint32", "int64", "int32")
CALLS = {
    "collide": "collide", "Collider.find, all moves": "find", "Collider.find, 1 % of the triangles move": "find",
    "Collider.find, nothing moves": "find",
}


def second_frame(title, V, F):
    """The vertices of every second call."""
    if title.endswith("nothing moves"):
        return V
    if title.endswith("all moves") or title == "collide":
        return V * 1.0001
    squares = ((V[F].mean(axis=1) - V[F[len(F) // 3]].mean(axis=0)) ** 2).sum(axis=1)
    moving = np.unique(F[np.argpartition(squares, len(F) // 100)[: max(len(F) // 100, 1)]])
    out = V.copy()
    out[moving] += np.random.default_rng(1).normal(size=(len(moving), 3)) * 1e-4 * np.ptp(V, axis=0).max()
    return out


def main():
    program, scene = sys.argv[1], farcull.Scene(sys.argv[2] if len(sys.argv) > 2 else "two-bunnies")
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 200
    F = {name: scene.triangles.astype(name) for name in TYPES}
    print(f"{scene.name}: {len(scene.triangles)} triangles, {rounds} rounds")
    for title, call in CALLS.items():
        V = [scene.vertices.copy(), second_frame(title, scene.vertices, scene.triangles)]
        with tempfile.TemporaryDirectory() as folder:
            for k in (0, 1):
                V[k].tofile(Path(folder, f"V{k}"))
            scene.triangles.tofile(Path(folder, "F"))
            scene.object_starts.astype(np.uint32).tofile(Path(folder, "S"))
            child = subprocess.Popen(
                [program, folder], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
            )
            colliders = {name: farcull.Collider(threads=1) for name in TYPES}

            def in_python(name, which):
                begun = time.process_time()
                if call == "find":
                    result = colliders[name].find(V[which], F[name], scene.object_starts)
                else:
                    result = farcull.collide(V[which], F[name], scene.object_starts, threads=1)
                return 1e3 * (time.process_time() - begun), len(result.pairs)

            def in_cpp(which):
                child.stdin.write(f"{call} {which}\n")
                child.stdin.flush()
                ms, pairs = child.stdout.readline().split()
                return float(ms), int(pairs)

            times = {name: [] for name in ("C++", *TYPES)}
            for number in range(-5, rounds):  # the first ones warm up
                which = number % 2
                order = list(times)
                random.shuffle(order)
                found = {name: in_cpp(which) if name == "C++" else in_python(name, which) for name in order}
                assert len({pairs for _, pairs in found.values()}) == 1, found
                if number >= 0:
                    for name, (ms, _) in found.items():
                        times[name].append(ms)
            child.stdin.close()
            child.wait()
        base = np.array(times["C++"])
        alone = base if title == "collide" else alone
        print(f"{title}: C++ {np.median(base):.2f} ms, {np.median(base) / np.median(alone):.2f} of collide")
        for name in TYPES:
            low, middle, high = np.percentile((np.array(times[name]) / base - 1) * 100, [25, 50, 75])
            print(f"  {name:7s} {middle:+5.1f} %  (quartiles {low:+.1f} % to {high:+.1f} %)")


main()
