"""Numbers of a report: medians, intervals and exponents, and their formats.

The rules are those of measure/harness.h, so that a report and `farcull bench` give the same
intervals for the same runs.
"""
import functools
import math
from dataclasses import dataclass

import numpy as np

NONE = math.nan  # a gap in a line
RESAMPLES = 10000
FEWEST_FOR_INTERVAL = 6  # points; with fewer, t is large and the interval says little


@dataclass
class Estimate:
    """A value from n measurements with its 95 % interval."""
    value: float = 0
    low: float = 0
    high: float = 0
    n: int = 0


@functools.lru_cache(maxsize=None)
def random_words(count):
    """The upper 32 bits of the first numbers of std::mt19937_64 with seed 1."""
    mask, upper, lower = (1 << 64) - 1, np.uint64(0xFFFFFFFF80000000), np.uint64(0x7FFFFFFF)
    words = [1]
    for i in range(1, 312):
        words.append((6364136223846793005 * (words[-1] ^ (words[-1] >> 62)) + i) & mask)
    state, blocks = np.array(words, dtype=np.uint64), []
    matrix = np.uint64(0xB5026F5AA96619E9)
    for _ in range(-(-count // 312)):
        for i, j in ((0, 156), (156, 311), (311, 312)):  # each part needs the one before
            x = (state[i:j] & upper) | (np.roll(state, -1)[i:j] & lower)
            state[i:j] = (np.roll(state, -156)[i:j] ^ (x >> np.uint64(1)) ^
                          np.where(x & np.uint64(1), matrix, np.uint64(0)))
        x = state.copy()
        x ^= (x >> np.uint64(29)) & np.uint64(0x5555555555555555)
        x ^= (x << np.uint64(17)) & np.uint64(0x71D67FFFEDA60000)
        x ^= (x << np.uint64(37)) & np.uint64(0xFFF7EEE000000000)
        blocks.append((x ^ (x >> np.uint64(43))) >> np.uint64(32))
    return np.concatenate(blocks)[:count]


def resampled_medians(*samples):
    """RESAMPLES medians of each sample, each of a draw with replacement; the samples take turns."""
    size = sum(len(sample) for sample in samples)
    words = random_words(RESAMPLES * size).reshape(RESAMPLES, size)
    out, at = [], 0
    for sample in samples:
        n = len(sample)
        picks = (words[:, at:at + n] * np.uint64(n)) >> np.uint64(32)
        out.append(np.median(np.sort(np.asarray(sample, float))[picks.astype(np.intp)], axis=1))
        at += n
    return out


def with_interval(value, n, resampled):
    ordered, cut = np.sort(resampled), RESAMPLES // 40  # 2.5 %
    return Estimate(value, float(ordered[cut]), float(ordered[-1 - cut]), n)


@functools.lru_cache(maxsize=None)
def median_estimate(values):
    """The median of a tuple with the percentile interval of the bootstrap."""
    return with_interval(median(values), len(values), resampled_medians(values)[0])


def coverage(n):
    """The probability that the 95 % interval of the median of n independent runs contains the true median, n odd. Its
    ends are runs of some rank from below and from above; each run is below the true median with probability 1/2."""
    rank = math.ceil(median_estimate(tuple(range(n))).low)
    return 1 - 2 * sum(math.comb(n, below) for below in range(rank + 1)) / 2**n


def ratio_estimate(over, under):
    """The median of `over` divided by that of `under`, both resampled; n: the size of the smaller sample."""
    one, other = resampled_medians(over, under)
    return with_interval(median(over) / median(under), min(len(over), len(under)), one / other)


def median(values):
    return float(np.median(np.asarray(values, float)))


def beta_share(a, b, x):
    """The regularized incomplete beta function I_x(a, b), by its continued fraction (Lentz)."""
    if x <= 0 or x >= 1:
        return float(x >= 1)
    if x > (a + 1) / (a + b + 2):
        return 1 - beta_share(b, a, 1 - x)
    front = math.exp(math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x)) / a
    c, d = 1.0, 1 / (1 - (a + b) * x / (a + 1))
    total = d
    for m in range(1, 10000):
        for top in (m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                    -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))):
            c, d = 1 + top / c, 1 / (1 + top * d)
            total *= c * d
        if abs(c * d - 1) < 1e-15:
            break
    return front * total


def solved(rising, target, low, high):
    """The point where a rising function reaches the target, by bisection."""
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < target else (low, middle)
    return (low + high) / 2


@functools.lru_cache(maxsize=None)
def rate_of(hits, of):
    """A rate with its 95 % interval by Clopper and Pearson; without a hit, the upper bound at 95 %."""
    if hits == 0:
        return Estimate(0, 0, 1 - 0.05 ** (1 / of), of)
    low = solved(lambda p: beta_share(hits, of - hits + 1, p), 0.025, 0, 1)
    high = 1 if hits == of else solved(lambda p: beta_share(hits + 1, of - hits, p), 0.975, 0, 1)
    return Estimate(hits / of, low, high, of)


@functools.lru_cache(maxsize=None)
def student_t95(degrees):
    return solved(lambda t: 1 - beta_share(degrees / 2, 0.5, degrees / (degrees + t * t)) / 2, 0.975, 0, 1000)


@dataclass
class Exponent:
    """The exponent b of y = a x^b by least squares in logarithms."""
    value: float
    error: float  # standard error, from the residuals
    low: float    # 95 % interval by Student's t
    high: float
    first: float  # the range of x
    last: float
    points: int


def exponent_of(x, y):
    """The Exponent; None if fewer than three pairs are positive, or all x are equal."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    good = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)
    x, u, v = x[good], np.log(x[good]), np.log(y[good])
    if len(u) < 3 or u.min() == u.max():
        return None
    around = u - u.mean()
    value = float(around @ (v - v.mean()) / (around @ around))
    residuals = v - v.mean() - value * around
    error = math.sqrt(residuals @ residuals / (len(u) - 2) / (around @ around))
    reach = student_t95(len(u) - 2) * error
    return Exponent(value, error, value - reach, value + reach, x.min(), x.max(), len(u))


def exponent_text(e):
    """`0.77 (0.58 to 0.96)`, or `0.77 (no interval of 4 points)`."""
    if e.points < FEWEST_FOR_INTERVAL:
        return f"{e.value:.2f} (no interval of {e.points} points)"
    return f"{e.value:.2f} ({e.low:.2f} to {e.high:.2f})"


def rounded(value, digits=3):
    """Three significant digits, whole numbers in full, thousands grouped: 0.0123, 1.50, 12,346."""
    if value is None or not math.isfinite(value):
        return "-"
    size, sign = abs(value), "-" if value < 0 else ""
    if size == 0:
        return "0"
    if size >= 1e9 or size < 1e-4:
        return f"{value:.{digits}g}"
    if size == math.floor(size):
        return f"{sign}{size:,.0f}"
    return f"{sign}{size:,.{max(0, digits - math.floor(math.log10(size)) - 1)}f}"


def grouped(n):
    """1234567 as 1,234,567."""
    return f"{int(n):,}"


def counted(n, one, many):
    """`1 pair`, `1,234 pairs`."""
    return f"{grouped(n)} {one if n == 1 else many}"


def listed(words):
    """`a, b and c`."""
    words = list(words)
    return " and ".join([", ".join(words[:-1])] * (len(words) > 1) + words[-1:])


def sentence(text):
    """The text, with a full stop unless it ends a sentence already."""
    return text if not text or text[-1] in ".?!" else text + "."


def of_all(part, whole):
    """`4 of 3,857`."""
    return f"{grouped(part)} of {grouped(whole)}"


def share(part, whole):
    """Per cent; NONE if `whole` is 0."""
    return 100 * part / whole if whole else NONE


def rate_text(hits, of):
    """`0 of 114,014 (95 % bound: at most 2.6e-5)`, or with the share and its interval."""
    if of == 0:
        return of_all(hits, of)
    rate = rate_of(int(hits), int(of))
    if hits == 0:
        return f"{of_all(hits, of)} (95 % bound: at most {rounded(rate.high, 2)})"
    return (f"{of_all(hits, of)} ({rounded(rate.value, 2)}, 95 % interval {rounded(rate.low, 2)} "
            f"to {rounded(rate.high, 2)})")


def at_most(n):
    """The upper bound of a rate after n cases without a hit: 3/n (Hanley and Lippman-Hand, 1983)."""
    return "at most " + rounded(min(1.0, 3 / n), 2)


def with_bound(part, whole):
    """`4 of 3,857`, or `0 of 3,857 (a rate of at most 0.00078)`."""
    return of_all(part, whole) + (f" (a rate of {at_most(whole)})" if part == 0 and whole else "")


def spread(values, unit=""):
    """`2 (1 to 3)`: the median with the least and the largest; `-` for no values."""
    if len(values) == 0:
        return "-"
    return f"{rounded(median(values))}{unit} ({rounded(min(values))} to {rounded(max(values))})"


def estimate_text(e, digits=3):
    """`3.88 (3.70 to 4.10)`; for one run only its value; `-` for none."""
    if e is None or e.n == 0:
        return "-"
    if e.n == 1:
        return rounded(e.value, digits)
    return f"{rounded(e.value, digits)} ({rounded(e.low, digits)} to {rounded(e.high, digits)})"


def median_text(values):
    """The median of values with its interval; `-` for none."""
    return estimate_text(median_estimate(tuple(values))) if len(values) else "-"
