"""Compares the same points of a study on several devices. The comparison is added to any chapter."""
from frame import *  # noqa: F403: a chapter uses most of it
from store import AXES


def compared(first, other):
    """Returns the rows of the points that both devices have measured. Columns of the first device end in `_first`."""
    out = other.rows.merge(first.rows, on=AXES, suffixes=("", "_first"))
    return out.assign(differs=[row.counts != row.counts_first for row in out.itertuples()],
                      ratio=column(out, "total_ms") / column(out, "total_ms_first"))


def lost(rows, end):
    """Returns the number of missed pairs and of violations of the lemmas."""
    lemma = rows.method.str.startswith("lemma")
    return total(rows[~lemma], "missed" + end) + total(rows[lemma], "violations" + end)


def fill(chapter, study, device, others):
    """Adds a table that compares each method on `device` and on each of the other devices, and a finding for each other
    device. others: pairs of a device's name and its Study; if there are none, adds nothing."""
    table = Table(
        chapter.study + "-devices",
        f"The same points on other devices than {device}: points that both have measured, those of them at which any "
        f"count differs, missed pairs (of the lemmas: violations) and candidates on {device} and on the other, and the "
        "median of the ratios of their times",
        columns(["device", "method"], ["points", "differ", "missed, first", "missed, other", "candidates, first",
                                       "candidates, other", "time, other/first"]))
    for name, other in others:
        for row in filter(breaks, other.rows.itertuples()):
            chapter.find_broken(f"On {name}, {row.contestant} did not keep its promise at {describe(row)}.")
        rows = compared(study, other)
        for method, of in by(rows, "contestant"):
            ratios = of.ratio[(of.ratio > 0) & np.isfinite(of.ratio)]
            counts = [len(of), of.differs.sum(), lost(of, "_first"), lost(of, ""), total(of, "candidates_first"),
                      total(of, "candidates")]
            table.rows.append([name, method, *map(grouped, counts), rounded(median(ratios)) if len(ratios) else "-"])
        if len(rows):
            chapter.find(f"On {name} counts differ from those on {device} at {of_all(rows.differs.sum(), len(rows))} points.")
    chapter.tables += [table] * bool(table.rows)
