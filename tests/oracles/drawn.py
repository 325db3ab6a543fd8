"""FAR with both offsets, and boxes, through the program: slivers, strays, origins far away, and denormal coordinates."""
import numpy as np

from . import exact
from .lab import HERE, all_pairs, call, dropped, read_json, read_table, require, rows, soup, starts_of, write_off
from .oriented import slivers

FAULTS = ["a dropped pair", "a tenth of the radius"]
METHODS = [["boxes"], ["far", "--offset", "obb"], ["far", "--offset", "exact"]]
WIDE = 1 << 9  # |coordinate| before the scene is moved


def random_corners(rng, count):
    """Slivers, or small triangles of which some have one corner far away, or pairs of layers one unit apart."""
    shape = rng.choice(["slivers", "strays", "layers"])
    if shape == "slivers":
        return shape, slivers(rng, count)
    reach = rng.choice([4, 12, 40])
    middle = np.array([[[rng.randint(-reach, reach) for _ in range(3)]] for _ in range(count)])
    corners = middle + [[[rng.randint(-6, 6) for _ in range(3)] for _ in range(3)] for _ in range(count)]
    if shape == "layers":
        corners[:, :, 2] = [[rng.randint(0, 1)] * 3 for _ in range(count)]
    else:
        for _ in range(rng.randint(1, 4)):
            corners[rng.randrange(count), rng.randrange(3)] = [rng.randint(-WIDE, WIDE) for _ in range(3)]
    return shape, corners


def scene(rng, spoil):
    sizes = [rng.randint(3, 40), rng.randint(3, 40)]
    shape, corners = random_corners(rng, sum(sizes))
    images, power, place = corners, 0, rng.choice(["near", "near", "far away", "denormal", "scaled"])
    if place == "far away":
        images = corners + [rng.choice([-1, 1]) * rng.randint(0, 1 << rng.choice([20, 35, 52])) for _ in range(3)]
    elif place != "near":
        power = -1074 if place == "denormal" else rng.randint(-300, 300)
    V, F = soup(images)
    V = np.ldexp(V, power)
    files = [write_off(f"{HERE}d{k}.off", V[3 * start : 3 * (start + size)], F[:size])
             for k, (start, size) in enumerate(zip(starts_of(sizes), sizes))]
    a, b = all_pairs(sizes)
    expected = rows(np.stack([a, b], 1)[exact.meet(corners[a], corners[b])])
    words = ["--resolution", rng.choice([16, 64, 256]), "--device", "native", "--broad-phase", rng.choice(["objects", "triangles"])]
    facts = {f"scenes of {shape}": 1, f"scenes {place}": 1, "pairs": len(expected)}

    def ask(method, *more):
        status, out, err = call("run", *files, "--method", *method, *more, *(words if method[0] == "far" else ()), "--no-verify",
                                "--pairs", HERE + "pairs.csv", "--json", HERE + "r.json")
        require(status == 0, "the exit status", status, out, err, shape, place)
        return sorted((int(row["triangle_a"]), int(row["triangle_b"]) + sizes[0]) for row in read_table(HERE + "pairs.csv"))

    for method in METHODS:
        found = spoil("a dropped pair", ask(method), dropped)
        record = read_json(HERE + "r.json")
        require(record["promises"], "no promise", record["promise_reason"])
        facts[f"scenes drawn by {' '.join(method)}"] = record["resolution"] is not None

        def smaller(right, method=method):
            lost = ask(method, "--radius", 0.1) if method[0] == "far" else right
            return lost if lost != right else None

        found = spoil("a tenth of the radius", found, smaller)
        require(found == expected, f"{method}, {words}, {shape}, {place}", set(found) ^ set(expected))
    if rng.random() < 0.1:
        facts["scenes tried at 0.9 of the radius"] = 1
        facts["pairs at risk in them"] = len(expected) - len(ask(METHODS[rng.choice([1, 2])], "--radius", 0.9))
    return facts
