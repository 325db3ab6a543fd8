"""Searches for cliffs: scenes on which a query takes far more time or memory than it should.

It deforms scenes at random, measures them, and deforms the worst finds further. The questions are ratios:

    pairs     time of boxes, divided by that of exact; limit 3
    memory    the same of the peak of memory; limit 2
    distance  time of the distances of objects, divided by its median over the scenes without deformations; limit 10
    far       time of far, divided by that of exact; no limit, and not among "all"

    cmake --build build --target farcull_python -j 2
    export PYTHONPATH=build/python
    /usr/bin/python3 experiments/cliffs.py                                       # all questions, five minutes
    /usr/bin/python3 experiments/cliffs.py --question memory --seconds 60 --seed 7
    /usr/bin/python3 experiments/cliffs.py --triangles 100000 --keep cliffs      # meshes and recipes of the finds
    /usr/bin/python3 experiments/cliffs.py --again cliffs/finds.json --seconds 60    # measures these once more

The search uses scenes of at most 20,000 triangles; then the worst finds are made again with at most --triangles.
A recipe makes a find: the name of a scene and a list of deformations, each with the seed of its random numbers.
Each measurement has a process of its own, with one thread, which is stopped if it takes 20 times as long as exact.
It counts processor time, so that other load changes little. Only the median of three measurements makes a find.
exact gets 1 ms and 1 MiB more, which every query takes.

Exit status: 1 if a find at full size is above its limit; 2 if methods disagree about the colliding pairs.
"""

import argparse
import ctypes
import hashlib
import json
import os
import pickle
import resource
import signal
import sys
import time
from pathlib import Path
from statistics import median

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # a process that has threads must not be forked
import farcull
import numpy as np

LIMITS = {"pairs": 3, "memory": 2, "distance": 10, "far": None}
# Built-in scenes; of those that take a number: triangles for each, the least and the greatest number.
STARTS = {
    **{name: (1, 5000, 10**7) for name in ("field", "crumpled", "spheres", "cad-cut", "funnel")},
    **{"needles": (2.6, 8, 10**6), "slivers": (2, 1, 10**5), "mixed": (10, 1, 10**4), "stack": (128, 2, 1000)},
    **{"shells": (700, 4, 10**4), "crowd": (23, 2, 10**6), "cylinders": (200, 2, 10**5), "torii": (6, 72, 10**6)},
    **{"tree-leaves": (220, 1, 10**5), "cloth": (2, 8, 10**5)},
    **{name: (0, 0, 0) for name in ("two-bunnies", "near-copy", "armadillo-elephant", "armadillo", "random-soup")},
    **{name: (0, 0, 0) for name in ("bunnies-far-apart", "needles-layers", "needles-crossed")},
}
SOUPS = ("cube", "sheet", "line", "sphere", "clusters")
STEPS = 8  # of a recipe at most
KEPT = 8  # finds of a question that are deformed further, and made at full size
TOO_LONG = 20  # times as long as exact
MOST_MEMORY = 6 << 30  # bytes


# ---- Scenes: (vertices, triangles, first triangles of objects, whether objects collide with themselves) ----


def soup(rng, count, place):
    """Random triangles at a kind of place; their sizes differ by decades, and they may be stretched."""
    at = rng.normal(size=(count, 3)) if place == "sphere" else rng.random((count, 3))
    if place == "sheet":
        at[:, 2] = 0.1 * np.sin(5 * at[:, 0])
    elif place == "line":
        at[:, 1:] = 0
    elif place == "sphere":
        at /= np.linalg.norm(at, axis=1)[:, None]
    elif place == "clusters":
        at = at[rng.integers(rng.integers(2, 100), size=count)] + 0.01 * rng.normal(size=(count, 3))
    size = count ** (-1 / 3) * 10 ** (rng.uniform(-1, 0.5) - rng.uniform(0, rng.choice([0, 2, 6]), count))
    corners = rng.normal(size=(count, 3, 3)) * size[:, None, None]
    along = rng.normal(size=(count if rng.random() < 0.5 else 1, 1, 3))
    corners += along * corners[:, :, :1] * 10 ** rng.uniform(-1, 3)
    if rng.random() < 0.5:  # neighbours in space follow each other
        order = np.lexsort(np.floor(at * count ** (1 / 3)).T)
        at, corners = at[order], corners[order]
    objects = int(rng.choice([1, 2, 2, 5, 50, 1000, count]))
    starts = np.linspace(0, count, objects, endpoint=False).astype(np.int64)
    return (at[:, None] + corners).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3), starts, objects == 1


def owners(scene):
    return np.searchsorted(scene[2], np.arange(len(scene[1])), "right") - 1


def regroup(scene, order, owner):
    """The scene with its triangles in this order, grouped by owner."""
    order = order[np.argsort(owner[order], kind="stable")]
    _, starts = np.unique(owner[order], return_index=True)
    return scene[0], scene[1][order], starts.astype(np.int64), scene[3] or len(starts) == 1


def part(scene, count):
    """About `count` triangles: the first ones of each object, or the first objects if these are small."""
    V, F, starts, own = scene
    sizes = np.diff(np.append(starts, len(F)))
    most = np.repeat(np.maximum(1, sizes * count / len(F)), sizes)
    place = np.arange(len(F))
    chosen = np.flatnonzero(place < count if len(F) < 32 * len(starts) else place - np.repeat(starts, sizes) < most)
    V, F, starts, own = regroup(scene, chosen, owners(scene))
    used, F = np.unique(F, return_inverse=True)
    return V[used], F.reshape(-1, 3), starts, own


def built_in(name, count):
    """The triangles of a built-in scene."""
    each, least, most = STARTS[name]
    if each:
        name += f":{min(max(int(count / each), least), most)}"
    scene = farcull.Scene(name)
    return scene.vertices, scene.triangles.astype(np.int64), scene.object_starts, len(scene.object_starts) == 1


# ---- Deformations: functions of the scene and random numbers ----


def extent(V):
    """Without strays."""
    low, high = np.percentile(V, [2, 98], axis=0)
    return np.maximum(high - low, 1e-30)


def power(rng, low, high):
    return 10 ** rng.uniform(low, high)


def turn(rng):
    return np.linalg.qr(rng.normal(size=(3, 3)))[0]


def with_vertices(scene, V):
    return (np.clip(np.nan_to_num(V), -1e100, 1e100), *scene[1:])


def one_axis(change):
    """A deformation of one coordinate, which may depend on another one."""

    def deform(scene, rng):
        V, (i, j) = scene[0].copy(), rng.permutation(3)[:2]
        V[:, i] = change(V[:, i], V[:, j], rng)
        return with_vertices(scene, V)

    return deform


def all_axes(change):
    return lambda scene, rng: with_vertices(scene, change(scene[0].copy(), rng))


def bend(V, rng):
    middle, size = np.median(V, axis=0), extent(V)
    return middle + size * np.sign(V - middle) * np.abs((V - middle) / size) ** power(rng, -0.7, 0.7)


def snap(V, rng):
    step = extent(V).max() / rng.choice([3, 10, 100, 1000])
    return np.round(V / step) * step


def strays(V, rng):
    for _ in range(rng.choice([1, 1, 2, 10, 100])):
        V[rng.integers(len(V))] += rng.normal(size=3) * extent(V) * power(rng, 0, 8)
    return V


def some_triangles(change):
    """A deformation of some triangles, evenly or of one piece, which get corners of their own."""

    def deform(scene, rng):
        V, F, starts, own = scene
        many, F = max(1, int(len(F) * power(rng, -4, 0))), F.copy()
        piece = (np.arange(many) + rng.integers(len(F))) % len(F)
        chosen = piece if rng.random() < 0.5 else np.unique(rng.integers(len(F), size=many))
        corners = change(V[F[chosen]], V, rng).reshape(-1, 3)
        F[chosen] = len(V) + np.arange(len(corners)).reshape(-1, 3)
        return with_vertices((V, F, starts, own), np.concatenate([V, corners]))

    return deform


def grow(T, V, rng):
    middle = T.mean(1, keepdims=True)
    return middle + (T - middle) * power(rng, 0, 4)


def sliver(T, V, rng):
    """To far vertices, or to one."""
    T[:, 2] = V[rng.integers(len(V), size=len(T) if rng.random() < 0.5 else 1)]
    return T


def collapse(T, V, rng):
    T[:, 1:] = T[:, :1] if rng.random() < 0.5 else T[:, [0, 2]]
    return T


def sort(scene, rng):
    along = scene[0][scene[1]].mean(1)[:, rng.integers(3)]
    return regroup(scene, np.argsort(along, kind="stable"), owners(scene))


def split(scene, rng):
    count = len(scene[1])
    objects, place = min(int(power(rng, 0.3, 5)), count), np.arange(count) / count
    owner = (place, rng.random(count), place**8)[rng.integers(3)]
    return regroup(scene, np.arange(count), np.floor(objects * owner))


def scale_object(scene, rng):
    inside = np.zeros(len(scene[0]), bool)
    inside[scene[1][owners(scene) == rng.integers(len(scene[2]))]] = True
    middle = scene[0][inside].mean(0)
    return with_vertices(
        scene, np.where(inside[:, None], middle + (scene[0] - middle) * power(rng, -4, 4), scene[0])
    )


def copies(scene, rng):
    """Of a part: each smaller by a factor, which may be 1, turned, and moved; by 0, they lie in each other."""
    many = int(rng.choice([2, 2, 3, 10, 100, 1000]))
    V, F, starts, own = part(scene, max(1, len(scene[1]) // many))
    many = max(2, min(many, len(scene[1]) // len(F)))
    middle, factor, turned = V.mean(0), rng.choice([1, 1, 0.5, 0.99, 1 - 1e-9, 1 / many]), rng.random() < 0.3
    offset = extent(V) * rng.choice([0, 1e-9, 1e-3, 0.1, 1, 3, 100])
    out = [(V - middle) * max(factor**k, 1e-12) for k in range(many)]
    out = [middle + (v @ turn(rng) if turned else v) + offset * rng.normal(size=3) for v in out]
    F = np.concatenate([F + k * len(V) for k in range(many)])
    starts = np.concatenate([starts + k * (len(F) // many) for k in range(many)])
    return with_vertices((None, F, starts, own), np.concatenate(out))


DEFORMATIONS = {
    "stretch": one_axis(lambda x, y, rng: x * 10.0 ** rng.integers(-4, 5)),
    "shear": one_axis(lambda x, y, rng: x + y * power(rng, -1, 3)),
    "flatten": one_axis(lambda x, y, rng: x.mean() + x * rng.choice([0, 1e-12, 1e-6, 1e-3])),
    "turn": all_axes(lambda V, rng: V @ turn(rng)),
    "noise": all_axes(lambda V, rng: V + rng.normal(size=V.shape) * extent(V).max() * power(rng, -6, -0.5)),
    "bend": all_axes(bend),
    "snap": all_axes(snap),
    "strays": all_axes(strays),
    "grow": some_triangles(grow),
    "huge": some_triangles(lambda T, V, rng: T[:, :1] + rng.normal(size=T.shape) * extent(V) * power(rng, -1, 3)),
    "sliver": some_triangles(sliver),
    "collapse": some_triangles(collapse),
    "sort": sort,
    "shuffle": lambda scene, rng: regroup(scene, rng.permutation(len(scene[1])), owners(scene)),
    "merge": lambda scene, rng: regroup(scene, np.arange(len(scene[1])), owners(scene) % rng.choice([1, 1, 2, 3])),
    "split": split,
    "self": lambda scene, rng: (*scene[:3], not scene[3] or len(scene[2]) == 1),
    "scale-object": scale_object,
    "copies": copies,
}


# ---- Recipes: {"start": name, "seed": of a soup, "steps": [[deformation, seed], ...]} ----


def make(recipe, count, started={}):
    key = recipe["start"], count, recipe["seed"] if recipe["start"] in SOUPS else 0
    if recipe["start"] in SOUPS:
        scene = soup(np.random.default_rng(recipe["seed"]), count, recipe["start"])
    else:  # in a process of its own, since it may start threads
        if key not in started:
            state, whole, *_ = in_process(lambda: built_in(recipe["start"], count), 60)
            if state != "done":
                raise RuntimeError(f"the scene {recipe['start']} could not be made: {state}")
            started[key] = part(whole, count)
        scene = started[key]
    with np.errstate(all="ignore"):
        for step, seed in recipe["steps"]:
            scene = DEFORMATIONS[step](scene, np.random.default_rng(seed))
    return scene


def started(name, seed):
    return {"start": name, "seed": int(seed), "steps": []}


def any_start(rng):
    return started(str(rng.choice(SOUPS if rng.random() < 0.4 else list(STARTS))), rng.integers(2**31))


def mutated(recipe, rng):
    steps, kind = list(recipe["steps"]), rng.integers(6)
    step, at = [str(rng.choice(list(DEFORMATIONS))), int(rng.integers(2**31))], int(rng.integers(len(steps) + 1))
    if kind == 0:
        return {**any_start(rng), "steps": steps}
    if kind == 1:  # one step fewer
        del steps[at : at + 1]
    elif kind == 2 and at < len(steps):  # with other random numbers
        steps[at] = [steps[at][0], step[1]]
    else:
        steps.insert(at, step)
    return {**recipe, "steps": steps[-STEPS:]}


def words(recipe):
    return " > ".join([recipe["start"], *(step for step, _ in recipe["steps"])])


# ---- Measurements ----


def in_process(work, seconds):
    """(state, answer of work(), ms of processor time, peak of MiB) of a process of its own; state: "done", "late",
    or why it died."""
    sys.stdout.flush()
    out, into = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
            signal.setitimer(signal.ITIMER_PROF, seconds)  # ends this process after so much processor time
            try:
                answer = "done", work()
            except Exception as error:
                answer = f"{type(error).__name__}: {error}", None
            with os.fdopen(into, "wb") as pipe:
                pickle.dump(answer, pipe)
        finally:
            os._exit(0)
    os.close(into)
    with os.fdopen(out, "rb") as pipe:
        data = pipe.read()
    _, status, usage = os.wait4(child, 0)
    late = os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGPROF
    answer = pickle.loads(data) if data and not status else ("late" if late else "killed", None)
    return *answer, 1e3 * (usage.ru_utime + usage.ru_stime), usage.ru_maxrss / 1024


def status_mib(field):
    return next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith(field)) / 1024


def run(scene, method):
    """Time, memory above the scene, the colliding pairs, and the stages."""
    made = farcull.Scene.from_arrays(*scene[:3], self=bool(scene[3]))
    ctypes.CDLL(None).malloc_trim(0)
    Path("/proc/self/clear_refs").write_text("5")  # sets the peak to what is resident now
    before, cpu, wall = status_mib("VmRSS"), time.process_time(), time.perf_counter()
    record = made.run(method, verify=False, threads=1, **({"device": "cpu"} if method == "far" else {}))
    share = (time.process_time() - cpu) / (time.perf_counter() - wall)  # of the core that this process had
    mib, told = status_mib("VmHWM") - before, record.json()
    pairs = np.concatenate([record.pairs, record.neighbour_pairs])
    digest = hashlib.sha256(pairs[np.lexsort(pairs.T)].tobytes()).hexdigest()
    stages = [[s["name"], s["ms"], s["reason"]] for s in told["stages"] if s["ran"] or s["name"] == "views"]
    ms = told["time_ms"]["total"] * share
    return {"ms": ms, "mib": mib, "colliding": len(pairs), "digest": digest, "stages": stages}


def distances(scene, kind):
    begun = time.process_time()
    farcull.distances(*scene[:3], kind=kind, threads=1)
    return {"ms": 1e3 * (time.process_time() - begun)}


def kind_of_distances(scene):
    """Of every two objects, or of each and the nearest one if there are so many that answers take the time."""
    return None if len(scene[2]) < 2 else "objects" if len(scene[2]) <= 64 else "nearest"


def cause_of(answer):
    """The stages that decided."""
    return "; ".join(
        f"{name}: {reason.split(':')[0].split(';')[0]}" if name == "views" else name
        for name, _, reason in answer["stages"]
        if name not in ("boxes", "exact", "setup", "choose")
    )


class Measure:
    """Ratios of scenes of at most `count` triangles, of which exact may take so many seconds."""

    def __init__(self, asked, count, seconds, keep):
        self.count, self.seconds, self.keep, self.usual = count, seconds, keep, {}
        times = {"objects": [], "nearest": []}
        for name in (*STARTS, *SOUPS) if "distance" in asked else ():
            scene = make(started(name, 1), count)
            if kind := kind_of_distances(scene):
                times[kind].append(in_process(lambda: distances(scene, kind), min(seconds, 3))[2])
        if "distance" in asked:
            self.usual = {kind: median(some) for kind, some in times.items()}
            print("Medians of times of distances:", *(f"{kind} {ms:.1f} ms" for kind, ms in self.usual.items()))

    def ratios(self, recipe, asked):
        """{question: find}; a question that cannot be asked of the scene, or whose base takes too long, lacks."""
        scene, out = make(recipe, self.count), {}
        common = {"recipe": recipe, "triangles": len(scene[1]), "objects": len(scene[2]), "self": bool(scene[3])}

        def add(question, took, base, cause, stages=()):
            find = {"question": question, "ratio": took / base, "took": took, "base": base, "cause": cause}
            out[question] = {**find, "stages": list(stages), **common}

        if "distance" in asked and (kind := kind_of_distances(scene)):
            limit = max(0.5, 3e-3 * TOO_LONG * self.usual[kind])
            state, _, ms, _ = in_process(lambda: distances(scene, kind), min(limit, 5 * self.seconds))
            add("distance", ms, self.usual[kind], kind if state == "done" else f"{kind}: {state}")
        methods = {"boxes": {"pairs", "memory"} & set(asked), "far": {"far"} & set(asked)}
        if not any(methods.values()):
            return out
        _, exact, _, peak_of_exact = in_process(lambda: run(scene, "exact"), self.seconds)
        for method, questions in methods.items() if exact else ():
            limit = max(0.5, min(TOO_LONG * (exact["ms"] + 1) / 1e3, 5 * self.seconds))
            if not questions:
                continue
            state, answer, ms, peak = in_process(lambda: run(scene, method), limit)
            if answer and answer["digest"] != exact["digest"]:
                folder = Path(self.keep or ".", "wrong")
                write_scene(scene, folder, common)
                print(f"wrong: {method} finds {answer['colliding']:,} pairs, exact {exact['colliding']:,}; {folder}")
                sys.exit(2)
            if not answer:  # stopped: both processes held the same scene, so their peaks may be compared
                answer = {"ms": ms, "mib": exact["mib"] + peak - peak_of_exact, "stages": []}
            for question in questions:
                unit = "mib" if question == "memory" else "ms"
                cause = cause_of(answer) if answer["stages"] else state
                add(question, answer[unit], exact[unit] + 1, cause, answer["stages"])
        return out

    def confirmed(self, find):
        """The median of three measurements."""
        more = [self.ratios(find["recipe"], [find["question"]]).get(find["question"]) for _ in range(2)]
        finds = sorted([find, *filter(None, more)], key=lambda found: found["ratio"])
        return finds[(len(finds) - 1) // 2]


# ---- The search ----


def search(measure, asked, rng, end):
    """The worst finds of each question, the worst first, at most one of each start and cause."""
    worst, tried = {question: {} for question in asked}, 0

    def ranked(question):
        return sorted(worst[question].values(), key=lambda find: -find["ratio"])[:KEPT]

    def known(recipe, find):  # the ratio that a find has to exceed; less than 0.5 is not worth deforming
        return worst[find["question"]].get((recipe["start"], find["cause"]), {"ratio": 0.5})["ratio"]

    first = rng.permutation([*STARTS, *SOUPS]).tolist()
    while time.monotonic() < end:
        parents = ranked(str(rng.choice(asked)))
        if first and rng.random() < 0.3:
            recipe = started(first.pop(), 1)
        elif parents and rng.random() < 0.75:
            recipe = mutated(parents[rng.integers(len(parents))]["recipe"], rng)
        else:
            recipe = any_start(rng)
            for _ in range(rng.integers(1, 5)):
                recipe = mutated(recipe, rng)
        tried += 1
        for question, find in measure.ratios(recipe, asked).items():
            best = max([0, *(other["ratio"] for other in worst[question].values())])
            if find["ratio"] > known(recipe, find):
                find = measure.confirmed(find)
            if find["ratio"] > known(recipe, find):
                worst[question][recipe["start"], find["cause"]] = find
                if find["ratio"] > best:
                    print(f"{tried:5d}  {question:8s} {find['ratio']:7.2f}  {words(recipe)}  [{find['cause']}]")
    print(f"{tried} scenes of at most {measure.count:,} triangles")
    return [ranked(question) for question in asked]


def at_full_size(measure, worst, end):
    """The finds made again: one of each question, and the others while there is time."""
    out = []
    for find in [found[k] for k in range(KEPT) for found in worst if k < len(found)]:
        if time.monotonic() > end and any(other["question"] == find["question"] for other in out):
            continue
        question, limit = find["question"], LIMITS[find["question"]] or 1
        again = measure.ratios(find["recipe"], [question]).get(question)
        if again and again["ratio"] > 0.8 * limit:
            again = measure.confirmed(again)
        if again:
            out.append({**again, "small": find["ratio"]})
    return sorted(out, key=lambda find: (list(LIMITS).index(find["question"]), -find["ratio"]))


def is_cliff(find):
    return bool(LIMITS[find["question"]]) and find["ratio"] > LIMITS[find["question"]]


def write_scene(scene, folder, find):
    """One mesh with a group for each object, the scene file, and how it was made."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "mesh.obj", "w") as file:
        np.savetxt(file, scene[0], "v %.17g %.17g %.17g")
        for number, triangles in enumerate(np.split(scene[1] + 1, scene[2][1:])):
            file.write(f"g {number}\n")
            np.savetxt(file, triangles, "f %d %d %d")
    mesh = {"mesh": "mesh.obj", "split": "groups", "self": bool(scene[3])}
    (folder / "scene.json").write_text(json.dumps({"name": folder.name, "objects": [mesh]}) + "\n")
    (folder / "find.json").write_text(json.dumps(find, indent=1) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=300, help="in all; two thirds search; default 300")
    parser.add_argument("--seed", type=int, default=1, help="of the search; default 1")
    parser.add_argument("--triangles", type=int, default=200_000, help="of the final scenes; default 200000")
    parser.add_argument("--question", choices=[*LIMITS, "all"], default="all")
    parser.add_argument("--keep", metavar="FOLDER", help="write meshes and recipes of the finds")
    parser.add_argument("--again", metavar="FILE", help="no search: measure the finds that --keep wrote here")
    given = parser.parse_args()
    asked = [q for q, limit in LIMITS.items() if given.question == q or (given.question == "all" and limit)]
    begun = time.monotonic()
    if given.again:
        worst = [[f for f in json.loads(Path(given.again).read_text()) if f["question"] == q] for q in asked]
    else:
        small = Measure(asked, min(20_000, given.triangles), 0.6, given.keep)
        worst = search(small, asked, np.random.default_rng(given.seed), begun + given.seconds * 2 / 3)
    finds = at_full_size(Measure(asked, given.triangles, 20, given.keep), worst, begun + given.seconds)
    print("question   ratio  limit   small  ms or MiB       base  objects  scene > deformations  [cause]")
    for number, find in enumerate(finds):
        print(
            f"{find['question']:8s} {find['ratio']:7.2f}  {LIMITS[find['question']] or '-':>5} {find['small']:7.2f} "
            f"{find['took']:10.1f} {find['base']:10.1f}  {find['objects']:7d}  {words(find['recipe'])}  "
            f"[{find['cause']}]{'  above the limit' if is_cliff(find) else ''}"
        )
        if given.keep:
            folder = Path(given.keep, f"{number:02d}-{find['question']}")
            write_scene(make(find["recipe"], given.triangles), folder, find)
    if given.keep:
        Path(given.keep).mkdir(parents=True, exist_ok=True)
        Path(given.keep, "finds.json").write_text(json.dumps(finds, indent=1) + "\n")
    return int(any(map(is_cliff, finds)))


if __name__ == "__main__":
    sys.exit(main())
