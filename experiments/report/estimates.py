"""Numbers of a report: medians, intervals and exponents, and their formats.

docs/experiments.md, "Statistics", says which interval is used where, and when no interval is given.
"""
import functools
import math
from dataclasses import dataclass

import numpy as np

NONE = math.nan  # no value: a figure's line has a gap here
FEWEST_FOR_INTERVAL = 6  # points; with fewer, Student's t is large and the interval is of little use


@dataclass
class Estimate:
    """A value from n measurements with its interval."""
    value: float = 0
    low: float = 0
    high: float = 0
    n: int = 0


def holds_again(n, cut):
    """Returns the probability that the median of n new runs lies between two of n old runs: the (cut + 1)-th fastest and the
    (cut + 1)-th slowest. Every order of the 2 n runs is equally likely. The median is the `middle`-th fastest new run. The
    median lies below these two old runs if at most `cut` old runs are faster than the median."""
    middle = -(-n // 2)
    below = sum(math.comb(middle - 1 + i, i) * math.comb(2 * n - middle - i, n - i) for i in range(cut + 1))
    return 1 - 2 * below / math.comb(2 * n, n)


@functools.lru_cache(maxsize=None)
def cut_of(n):
    """Returns how many runs the interval of a median leaves out at each end: the largest number for which the median
    of n new runs lies in the interval with at least 95 % probability; 0 if there is no such number."""
    return max((cut for cut in range(n // 2) if holds_again(n, cut) >= 0.95), default=0)


def median_estimate(values, rounds=()):
    """Returns the median with its interval (cut_of()), which is widened to contain the median of each round."""
    ordered, cut = sorted(values), cut_of(len(values))
    ends = [ordered[cut], ordered[-1 - cut]] + [median(of) for of in rounds if of]
    return Estimate(median(values), float(min(ends)), float(max(ends)), len(values))


def ratio_estimate(over, under):
    """Returns the median of the ratios over / under, with its interval; None without ratios. A ratio is of two runs in the same
    turn of a round. A slowdown of the machine in that turn affects both runs, so their ratio hardly changes."""
    rounds = [tuple(a / b for a, b in zip(*both)) for both in zip(over, under)]
    ratios = [ratio for of in rounds for ratio in of]
    return median_estimate(ratios, rounds) if ratios else None


def median(values):
    return float(np.median(np.asarray(values, float)))


def beta_share(a, b, x):
    """Returns the regularized incomplete beta function I_x(a, b), by its continued fraction (Lentz)."""
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
    """Returns the point between low and high where a rising function has the value `target`, by bisection."""
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < target else (low, middle)
    return (low + high) / 2


@functools.lru_cache(maxsize=None)
def rate_of(hits, of):
    """Returns a rate with its 95 % interval by Clopper and Pearson. If there are no hits, `high` is the 95 % upper bound."""
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
    """Returns the Exponent; None if fewer than three pairs (x, y) are positive, or if all x are equal."""
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
    """Returns a text such as `0.77 (0.58 to 0.96)` or `0.77 (no interval of 4 points)`."""
    if e.points < FEWEST_FOR_INTERVAL:
        return f"{e.value:.2f} (no interval of {e.points} points)"
    return f"{e.value:.2f} ({e.low:.2f} to {e.high:.2f})"


def rounded(value, digits=3):
    """Returns a text with `digits` significant digits; whole numbers in full: 0.0123, 1.50, 12,346."""
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
    """Returns 1,234,567 for 1234567."""
    return f"{int(n):,}"


def counted(n, one, many):
    """Returns a text such as `1 pair` or `1,234 pairs`."""
    return f"{grouped(n)} {one if n == 1 else many}"


def listed(words):
    """Returns a text such as `a, b and c`."""
    words = list(words)
    return " and ".join([", ".join(words[:-1])] * (len(words) > 1) + words[-1:])


def sentence(text):
    """Returns the text, with a full stop unless the text ends a sentence already."""
    return text if not text or text[-1] in ".?!" else text + "."


def of_all(part, whole):
    """Returns a text such as `4 of 3,857`."""
    return f"{grouped(part)} of {grouped(whole)}"


def share(part, whole):
    """Returns part / whole in per cent; NONE if `whole` is 0."""
    return 100 * part / whole if whole else NONE


def rate_text(hits, of):
    """Returns a text such as `0 of 114,014 (95 % bound: at most 2.6e-5)`; with hits, the share and its interval follow.
    Precondition: the cases were drawn independently. This is true of random placements, but not of pairs, objects or frames."""
    if of == 0:
        return of_all(hits, of)
    rate = rate_of(int(hits), int(of))
    if hits == 0:
        return f"{of_all(hits, of)} (95 % bound: at most {rounded(rate.high, 2)})"
    return (f"{of_all(hits, of)} ({rounded(rate.value, 2)}, 95 % interval {rounded(rate.low, 2)} to {rounded(rate.high, 2)})")


def spread(values, unit=""):
    """Returns a text such as `2 (1 to 3)`: the median, the least and the largest value. One value: the value; none: `-`."""
    if len(values) < 2:
        return "".join(rounded(value) + unit for value in values) or "-"
    return f"{rounded(median(values))}{unit} ({rounded(min(values))} to {rounded(max(values))})"


def estimate_text(e, digits=3):
    """Returns a text such as `3.88 (3.70 to 4.10)`; for one run, only the value; for no run, `-`."""
    if e is None or e.n == 0:
        return "-"
    if e.n == 1:
        return rounded(e.value, digits)
    return f"{rounded(e.value, digits)} ({rounded(e.low, digits)} to {rounded(e.high, digits)})"
