"""Random arguments: an answer that is right, or an exception that names what is wrong, never a crash.

FARCULL_FUZZ_CALLS: how many calls (default 2,000); FARCULL_SEED: where they begin.
"""

import math
import os
import random
import warnings

import farcull
import numpy as np
import pytest

CALLS = int(os.environ.get("FARCULL_FUZZ_CALLS", "2000"))
SEED = int(os.environ.get("FARCULL_SEED", "20261124"))

TYPES = "f2 f4 f8 g i1 i2 i4 i8 u1 u2 u4 u8 >f4 >f8 >i8 >u4 ? c16 S3 U2 O M8[s] m8[s] V5".split()
VALUES = [0, 1, 2, 3, -1, 0.5, 1e308, -1e-308, math.nan, math.inf, 2**31, 2**32, 2**63, 2**64 - 1]
SHAPES = [(0,), (3,), (0, 3), (3, 0), (1, 3), (2, 3), (4, 3), (7, 3), (2, 2), (2, 4), (2, 3, 3), ()]
JUNK = [None, True, False, -1, 0, 1, 2, 1025, 2**70, 0.0, -0.5, 1e-9, math.nan, math.inf, "", "cpu"]
JUNK += ["gl?", "objects", "all", "nearest", "parity", b"x", [], [True], [False, True], {}, object(), 1j]


def random_array(rng):
    shape = rng.choice(SHAPES)
    kind = np.dtype(rng.choice(TYPES))
    size = math.prod(shape)
    with np.errstate(all="ignore"):
        try:
            flat = np.array([rng.choice(VALUES) for _ in range(size)], object).astype(kind)
        except (ValueError, TypeError, OverflowError):
            flat = np.frombuffer(rng.randbytes(size * kind.itemsize), "u1")
            flat = flat.copy().view(kind) if kind.kind != "O" else np.full(size, None)
    out = flat.reshape(shape)
    return rng.choice([lambda a: a, laid_out, np.asfortranarray, read_only])(out)


def laid_out(array):
    """The same shape with other strides: backwards, with gaps, or one number for all."""
    if array.ndim != 2 or not array.size:
        return array
    wide = np.zeros((3 * array.shape[0], 2 * array.shape[1] + 1), array.dtype)
    wide[::3, 1::2] = array
    return random.choice([wide[::3, 1::2], array[::-1, ::-1], np.broadcast_to(array[:1], array.shape)])


def read_only(array):
    array = array.copy()
    array.flags.writeable = False
    return array


def good_vertices(rng):
    return np.array([[rng.randint(-3, 3) for _ in range(3)] for _ in range(rng.randint(3, 12))], "f8")


def good_triangles(rng, vertices):
    count = rng.randint(2, 8)
    return np.array([[rng.randrange(vertices) for _ in range(3)] for _ in range(count)]).reshape(-1, 3)


def one_call(rng):
    """Most of the arguments are good, so that each check is reached."""
    vertices = good_vertices(rng)
    triangles = good_triangles(rng, len(vertices)).astype(rng.choice(["i4", "i8", "u4", "u8"]))
    objects = [0, rng.randint(1, len(triangles) - 1)]
    arguments = {"V": vertices, "F": triangles, "object_starts": objects}
    for name in ("V", "F", "object_starts"):
        if rng.random() < 0.25:
            arguments[name] = rng.choice([random_array, lambda r: r.choice(JUNK)])(rng)
    call = rng.choice([farcull.collide, farcull.collide, farcull.distances])
    options = {
        farcull.collide: ("self", "clearance", "neighbours", "threads", "contacts", "ignore", "limit", "poses"),
        farcull.distances: ("self", "kind", "k", "within", "inside", "threads", "ignore", "poses", "exact"),
    }[call]
    for name in options:
        if rng.random() < 0.12:
            arguments[name] = rng.choice(JUNK)
    arguments.setdefault("threads", 1)
    return call, arguments


@pytest.fixture(autouse=True)
def quiet():
    """Numbers that do not fit their type are meant."""
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def rows(pairs):
    return [tuple(pair) for pair in np.asarray(pairs).reshape(-1, 2).tolist()]


def require_right(call, arguments, answer):
    """The answer is that of the same numbers as packed doubles and indices. Pairs that collide are those at the
    distance 0 where nothing else is asked, which other code finds. Whether the second was asked."""
    V = np.array(arguments["V"], np.float64).reshape(-1, 3)
    F = np.array(arguments["F"]).reshape(-1, 3).astype(np.int64)
    again = call(**{**arguments, "V": V, "F": F})
    if call is farcull.distances:
        assert list(answer) == list(again)
        return False
    pairs = rows(answer.pairs)
    assert pairs == rows(again.pairs)
    assert rows(answer.neighbour_pairs) == rows(again.neighbour_pairs)
    if arguments.keys() != {"V", "F", "object_starts", "threads"}:
        return False
    at_0 = farcull.distances(V, F, arguments["object_starts"], kind="all", within=0, threads=1, inside=False)
    assert sorted(d.triangles for d in at_0) == pairs
    return True


def test_random_calls_answer_or_say_what_is_wrong():
    rng = random.Random(SEED)
    random.seed(SEED)
    print(f"seed {SEED}")
    answered = refused = compared = 0
    wheres, missing = set(), set("V F object_starts self clearance threads kind contacts poses ignore limit".split())
    number = 0
    # Until each outcome and each name of an argument was there, or a bound.
    while number < CALLS or number < 20 * CALLS and (min(answered, refused, compared) <= CALLS // 10 or missing - wheres):
        number += 1
        call, arguments = one_call(rng)
        try:
            answer = call(**arguments)
        except farcull.InputError as error:
            assert error.where and error.reason and error.remedy, repr(error)
            wheres.add(error.where)
            refused += 1
        except MemoryError:  # a view of no memory that claims to be large
            refused += 1
        except BaseException:
            print(f"call {number}: {call.__name__}({arguments})")
            raise
        else:
            answered += 1
            compared += require_right(call, arguments, answer)
    print(f"of {number} calls {answered} answered, {refused} refused, {compared} compared with distances")
    # Else the calls would show nothing.
    assert min(answered, refused, compared) > CALLS // 10, (answered, refused, compared)
    assert not missing - wheres
