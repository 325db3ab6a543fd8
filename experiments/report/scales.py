"""The ends and ticks of axes. They are not left to the plotter, so that zeros have a place on
logarithmic axes and labels fit.

Ticks are at 1, 2 or 5 times powers of ten, or at the values if these are powers of two.
"""
import math
from dataclasses import dataclass, field

DIGITS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass
class Scale:
    log: bool = False
    low: float = 0.0   # low < high; on a logarithmic axis also 0 < low
    high: float = 1.0
    zero: float = 0.0  # where zeros are drawn on a logarithmic axis; 0: nowhere
    linear_to: float = 0.0  # with zeros: the axis is linear from 0 to this value
    ticks: list = field(default_factory=list)  # pairs of value and label ("": a minor tick)

    def place(self, value):
        """The position on the plotter's axis, which is linear; NaN if the value has none."""
        if value is None or not math.isfinite(value):
            return math.nan
        if not self.log:
            return value
        if value > 0 and value >= self.linear_to:
            return math.log10(value)
        if self.linear_to == 0:
            return math.nan
        part = max(value, 0.0) / self.linear_to
        return math.log10(self.zero) + part * math.log10(self.linear_to / self.zero)

    @property
    def ends(self):
        return (math.log10(self.low), math.log10(self.high)) if self.log else (self.low, self.high)


def power_label(exponent):
    return "10" + str(exponent).translate(DIGITS)


def tick_label(value):
    """12345.678 as 12,346: few digits, no zeros at the end; 10⁵ if it would be long."""
    size = abs(value)
    if size != 0 and (size >= 1e7 or size < 1e-4):
        exponent = math.floor(math.log10(size) + 1e-9)
        mantissa = round(value / 10.0 ** exponent, 3)
        return power_label(exponent) if mantissa == 1 else f"{mantissa:g}·{power_label(exponent)}"
    return f"{value:,.0f}" if size >= 1000 else f"{value:.6g}"


def round_down(x):
    """The largest of 1, 2 and 5 times a power of ten that is at most x."""
    base = 10.0 ** math.floor(math.log10(x))
    if base > x:  # a power of ten that rounding left above x
        return base / 2
    return next(m * base for m in (5, 2, 1) if m * base <= x or m == 1)


def round_up(x):
    """The least of 1, 2 and 5 times a power of ten that is at least x."""
    base = 10.0 ** math.floor(math.log10(round_down(x)) + 1e-9)
    return next((m * base for m in (1, 2, 5, 10, 20) if m * base >= x), 50 * base)


def thinned(ticks, fits):
    """Removes labels, every second one first, until the others fit."""
    while not fits(ticks):
        labelled = [i for i, (_, label) in enumerate(ticks) if label]
        if len(labelled) <= 2:
            break
        for i in labelled[1::2]:
            ticks[i] = (ticks[i][0], "")
    return ticks


def ticks_at_powers_of_two(values):
    """Ticks at the values, such as resolutions, if these are few powers of two; else none."""
    distinct = sorted(set(values))
    if not 3 <= len(distinct) <= 10 or any(v <= 0 or math.frexp(v)[0] != 0.5 for v in distinct):
        return []
    return [(v, tick_label(v)) for v in distinct]


def even_ticks(low, high, step):
    first = math.ceil(low / step - 1e-9)
    places = [(first + i) * step for i in range(13)]
    places = [0.0 if abs(at) < 1e-9 * step else at for at in places if at <= high + 1e-9 * step]
    return [(at, tick_label(at)) for at in places]


def log_ticks(scale, lowest):
    if scale.high < 5 * lowest:  # powers of ten are of no use if there is hardly one
        return even_ticks(lowest, scale.high, round_up((scale.high - lowest) / 4))
    first = math.ceil(math.log10(lowest) - 1e-9)
    last = math.floor(math.log10(scale.high) + 1e-9)
    decades, plain = math.log10(scale.high / lowest), first >= -3 and last <= 3
    out = []
    for exponent in range(first - 1, last + 1):
        for m in range(1, 10):
            at = m * 10.0 ** exponent
            if at < lowest * (1 - 1e-9) or at > scale.high * (1 + 1e-9):
                continue
            if m == 1:
                out.append((at, tick_label(at) if plain else power_label(exponent)))
            elif decades < 1.7 and m in (2, 5):
                out.append((at, tick_label(at)))
            elif decades < 6:
                out.append((at, ""))
    return out


def log_scale(axis, values, fits):
    positive = [v for v in values if v > 0]
    least, most = (min(positive), max(positive)) if positive else (1.0, 1.0)
    least = axis.low if axis.low else least
    most = max(axis.high, least) if axis.high else most
    scale = Scale(True, least if axis.low else round_down(least), most if axis.high else round_up(most))
    if scale.high <= scale.low:
        scale.low, scale.high = round_down(scale.low / 2), round_up(scale.high * 2)
    scale.low, scale.high = min(scale.low, least), max(scale.high, most)
    lowest, zero = scale.low, []
    if axis.zero and len(positive) < len(values):
        # Zeros: linear from 0 to 1, or, for values below 1, to the power of ten below the least.
        lowest = 1.0 if least >= 1 else 10.0 ** math.floor(math.log10(least) + 1e-9)
        band = max(0.3, 0.13 * math.log10(scale.high / lowest))
        band = min(band, (math.log10(lowest) + 305) / 1.5)  # stays within the range of doubles
        scale.zero, scale.linear_to = lowest * 10 ** -band, lowest
        scale.low = lowest * 10 ** (-1.5 * band)
        zero = [(0.0, "0")]
    at = [] if scale.zero else ticks_at_powers_of_two(values)
    if at:
        at = [t for t in at if scale.low <= t[0] <= scale.high]
        air = (scale.high / scale.low) ** 0.03  # space beside the first and the last point
        scale.low = scale.low if axis.low else at[0][0] / air
        scale.high = scale.high if axis.high else at[-1][0] * air
    scale.ticks = thinned(at or zero + log_ticks(scale, lowest), fits)
    return scale


def linear_scale(axis, values, fits):
    least, most = (min(values), max(values)) if values else (0.0, 1.0)
    if 0 < least < 0.5 * most:  # begins at 0 unless that squeezes the data
        least = 0.0
    least = least if axis.low is None else axis.low
    most = most if axis.high is None else axis.high
    if most <= least:
        around = abs(least) * 0.5 or 1.0
        least -= around if axis.low is None and least != 0 else 0
        most = least + 2 * around
    step = max(round_up((most - least) / 5), 5e-324)
    # One tick gives no scale: between two fixed ends there may hardly be a multiple.
    while None not in (axis.low, axis.high) and len(even_ticks(least, most, step)) < 3:
        finer = round_down(0.9 * step)
        if not finer > (most - least) / 20:
            break
        step = finer
    low = least if axis.low is not None else math.floor(least / step + 1e-9) * step
    high = most if axis.high is not None else math.ceil(most / step - 1e-9) * step
    # Rounding must not leave a value outside the axis.
    low, high = min(low, least), max(high, most)
    return Scale(False, low, high, ticks=thinned(even_ticks(low, high, step), fits))


def scale_of(axis, values, fits):
    """values: all values drawn along the axis; fits(ticks): whether the labels have room."""
    values = [float(v) for v in values if v is not None and math.isfinite(v)]
    return (log_scale if axis.log else linear_scale)(axis, values, fits)
