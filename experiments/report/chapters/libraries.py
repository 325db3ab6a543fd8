"""Pairs that each contestant missed, reported wrongly, refused or crashed at, on a suite of labelled pairs and meshes.

Counts of pairs of triangles and of pairs of meshes are never added: the first are questions, each with its answer, the
second are the parts of one answer about a mesh.
"""
from dataclasses import dataclass

from frame import *  # noqa: F403: a chapter uses most of it
from tables import table_csv

# The counts of a score, in the order of peers/score.cpp.
SCORE = ["asked", "answered", "missed", "wrong", "own_asked", "own_missed", "own_wrong", "refused", "unanswered",
         "crashed", "hung", "no_memory", "not_asked", "twice", "differing"]
FAULTS = {"missed": "missed", "false": "wrong", "death": "death"}  # each fault: the end of the name of its columns
KINDS = ["apart", "touch-vertex", "touch-edge", "touch-face", "crossing", "coplanar", "equal", "neighbours-meet",
         "neighbours-apart"]  # how the triangles of a labelled pair meet


# ---- rows and their sums

def with_families(rows):
    """The rows with the columns family (`pairs/random` for `small/pairs/random`) and pairs (False: of meshes), and the
    columns of text without gaps."""
    return rows.assign(family=[scene.partition("/")[2] for scene in rows.scene], pairs=rows.scene.str.match(
        "[^/]*/pairs/"), **{
        name: [text(row, name) for row in rows.itertuples()]
        for name in ("library", "means", "call", "says", "source", "use", "scores")})


def totals(rows, *names):
    return sum(total(rows, name) for name in names)


def deaths(rows):
    """Questions at which the process crashed, hung or ran out of memory."""
    return totals(rows, "crashed", "hung", "no_memory")


def without_answer(rows):
    return deaths(rows) + totals(rows, "refused", "unanswered", "not_asked")


def differing(rows):
    """`78 of 646`: questions answered differently the second time, of those asked twice."""
    otherwise = total(rows, "differing")
    return of_all(otherwise, total(rows, "twice")) if otherwise else "0"


def answers(rows, pairs, own):
    """Missed pairs and false alarms among the answers, each with the number that it is a part of: for pairs all
    answers; for meshes the colliding and the reported pairs, since nobody knows how many pairs are apart. own: only
    where the contestant's documentation promises the answer."""
    asked, missed, false = (total(rows, name) for name in (
        ("own_asked", "own_missed", "own_wrong") if own else ("answered", "missed", "wrong")))
    return missed, asked, false, asked if pairs else asked - missed + false


def rates_of_kinds(rows):
    """Wrong answers per million by contestant and kind, from the scores of the rows."""
    out = []
    for row in rows.itertuples():
        for score in row.scores.split(";") if row.scores else []:
            words = score.partition("|")[0].split()
            if "|" not in score or len(words) != len(SCORE) + 3:
                raise Damaged(f"'{score}' is no score of this version of farcull")
            out.append([row.method, words[1], *map(int, words[2:-1])])
    counts = pd.DataFrame(out, columns=["contestant", "kind", *SCORE]).astype({name: int for name in SCORE})
    sums = counts.groupby(["contestant", "kind"]).sum()
    return {row.Index: per_million(row.missed + row.wrong, row.answered) for row in sums.itertuples()}


# ---- tables

def per_million(count, of):
    """A rate; "0" is none at all."""
    return "-" if of == 0 else "0" if count == 0 else rounded(1e6 * count / of)


def overview(rows, pairs):
    start, counts = (
        "Pairs of triangles: missed (they meet, and it says apart) and false alarms (they are apart, and it says that "
        "they meet), per million of the pairs that were answered", ["asked"]) if pairs else (
        "Meshes: the colliding pairs of all meshes that were asked, and the pairs that were reported; missed per "
        "million of the colliding pairs of those meshes that were answered, false alarms per million of the reported "
        "pairs, since nobody counts the pairs of a mesh that are apart. Both rates are "
        "given", ["colliding", "reported"])
    out = Table(
        "libraries" if pairs else "libraries-meshes",
        f"{start}, first by what the documentation of each promises, then by closed triangles. "
        f"Counts{'' if pairs else ' of meshes'}: refused; without an answer, or not asked after too many deaths; "
        "crashed, a hang or a lack of memory among them; answered otherwise the second time",
        columns(["contestant", "library", "measured as"],
                counts + ["missed, own", "false, own", "missed", "false", "refused", "unanswered", "deaths", "differs",
                          "ns a pair" if pairs else "ms in all"]))
    for contestant, of in by(rows, "method"):
        ms, timed = column(of, "total_ms").sum(), total(of, "timed")
        both = [answers(of, pairs, own) for own in (True, False)]
        out.rows.append(
            [contestant, of.library.iloc[0], of.means.iloc[0], grouped(total(of, "asked"))] +
            ([] if pairs else [grouped(both[1][3])]) +
            [per_million(*rate) for measure in both for rate in (measure[:2], measure[2:])] +
            [grouped(total(of, "refused")), grouped(totals(of, "unanswered", "not_asked")), grouped(deaths(of)),
             differing(of), rounded(ms) if not pairs else rounded(1e6 * ms / timed) if timed else "-"])
    return out


def kinds_table(rows):
    rates = rates_of_kinds(rows)
    return Table(
        "libraries-kinds",
        "Wrong answers (missed or false alarms) per million answers about pairs of each kind of contact, degenerate "
        "triangles among them; -: none was asked", columns(["contestant"], KINDS),
        [[name] + [rates.get((name, kind), "-") for kind in KINDS] for name in rows.method.unique()])


def calls_table(rows):
    names = ["method", "library", "call", "says", "source", "use"]
    return Table(
        "libraries-calls",
        "How each was called, what its documentation says of exactness and of touching, where it says that, and where "
        "it is right to be used", columns(["contestant", "library", "called", "says", "source", "use"], []),
        rows.drop_duplicates("method")[names].values.tolist())


def families_table(rows):
    rows = rows.assign(family=rows.family.str.replace(r"^(meshes/.*)-\d+$", r"\1", regex=True))
    families = list(rows.family.unique())

    def cell(of):
        pairs = of.pairs.any()
        asked, said = (total(of, "asked"), total(of, "answered")) if pairs else (10**6, 10**6)
        return "-" if of.empty or asked == 0 else " / ".join(
            [per_million(total(of, name), said) for name in ("missed", "wrong")] +
            [per_million(count, asked) for count in (total(of, "refused"), deaths(of))])

    return Table(
        "libraries-families",
        "Missed / false alarms per million answers and refused / deaths per million pairs that were asked, of each "
        "family, by closed triangles; of meshes the counts", columns(["contestant"] + families, []),
        [[contestant] + [cell(of[of.family == family]) for family in families]
         for contestant, of in by(rows, "method")])


# ---- figures

def time_figure(rows):
    """A row for each contestant, first those that err least by what their own documentation promises."""
    out, points = Figure(
        "libraries-time", "Wrong answers where the documentation promises the answer, and the time of a question",
        "Each row is a contestant, with the fewest wrong answers first; (ours) marks the methods of farcull, of which "
        "those of CULLIDE are as published and promise nothing. Missed: the triangles meet, and it says apart; false "
        "alarms: the other way round. Both are per million answers to questions of which its documentation promises the "
        "answer; what was refused or crashed is no answer, and stands in the table. Time: the mean of a question about "
        "two triangles, as the contestant's own process measured it. It includes what the call needs, such as the "
        "making of a mesh of one triangle, so that what is made for meshes "
        f"looks slow. n = {grouped(total(rows, 'asked'))} questions to {rows.method.nunique()} contestants."), []
    for name, of in by(rows, "method"):
        ms, timed, (missed, asked, wrong, _) = column(of, "total_ms").sum(), total(of, "timed"), answers(of, True, True)
        if asked and timed:
            points.append((name + " (ours)" * (of.library.iloc[0] == "farcull"), 1e6 * missed / asked,
                           1e6 * wrong / asked, 1e3 * ms / timed))
    points.sort(key=lambda point: (point[1] + point[2], point[3]))
    out.panels = [Panel(title, axis, strip=[Series(point[0], [point[at + 1]], style="points") for point in points])
                  for at, (title, axis) in enumerate((
                      ("missed", log("per million answers", zero=True)),
                      ("false alarms", log("per million answers", zero=True)),
                      ("time of a question", log("µs"))))] * bool(points)
    return out


# ---- findings

def add_ours(chapter, rows):
    """Adds each method of farcull that promises. A wrong answer breaks the promise, and so does no answer."""
    for name, of in by(promising(rows), "method"):
        pairs, meshes = of[of.pairs], of[~of.pairs]
        missed, asked, wrong, _ = answers(pairs, True, False)
        lost, colliding, false, reported = answers(meshes, False, False)
        answered = sum(without_answer(meshes[meshes.index == at]) == 0 for at in meshes.index)
        many, silent = counted(answered, "mesh", "meshes"), without_answer(of)
        for bad, what in ((missed, f"of {grouped(asked)} pairs missed"),
                          (wrong, f"of {grouped(asked)} pairs reported wrongly"),
                          (lost, f"of the {grouped(colliding)} colliding pairs of {many} missed"),
                          (false, f"of the {grouped(reported)} pairs reported of {many} are apart")):
            if bad:
                chapter.find_broken(f"{name}: {grouped(bad)} {what}, and it promises none.")
        if silent:
            chapter.find_broken(f"{name} has no answer to {counted(silent, 'question', 'questions')}.")
        if asked + colliding and not missed + wrong + lost + false + silent:
            what = [f"of {counted(asked, 'pair', 'pairs')}"] * bool(asked) + [
                f"of the {counted(colliding, 'colliding pair', 'colliding pairs')} of {many}"] * bool(colliding)
            chapter.find(f"{name} missed none and reported none wrongly {', and '.join(what)}.")


def add_others(chapter, rows, pairs):
    """Adds which libraries and tests are right by their own documentation; of the others those that err most and least."""
    right, wrong, what = [], [], "pairs of triangles" if pairs else "meshes"
    for name, of in by(rows[rows.library != "farcull"], "method"):
        missed, asked, false, reported = answers(of, pairs, True)
        words = of_all(missed + false, asked) if pairs else \
            f"{of_all(missed, asked)} missed, {of_all(false, reported)} false"
        if missed + false:
            wrong.append(((missed + false) / (asked if pairs else asked + false), f"{name} ({words})"))
        elif asked:
            right.append(name)
    if right:
        chapter.find(f"Of {what}, these gave no wrong answer by their own documentation: {listed(right)}.")
    if wrong:
        which = f"most often {max(wrong)[1]}, least often {min(wrong)[1]}" if len(wrong) > 1 else wrong[0][1]
        chapter.find(f"Of {what}, {of_all(len(wrong), len(wrong) + len(right))} libraries and tests gave wrong answers "
                     f"where their documentation promises the answer: {which}.")


# ---- the smallest pair of each kind of fault of each library, as a table and in the format of the suite

def decimal(x):
    """The shortest decimal text of a double, with an exponent where that is shorter; no -0."""
    return min(np.format_float_positional(x + 0.0, trim="-"),
               np.format_float_scientific(x + 0.0, trim="-", exp_digits=2), key=len)


@dataclass
class Example:
    contestant: str
    fault: str
    family: str
    line: str  # as a suite has it: number, parameter, shared corners, kind, 18 coordinates

    def __post_init__(self):
        """Reads the line: corners has six points, those of the first triangle first; words has them in decimal."""
        words = self.line.split()
        try:
            self.kind, self.corners = words[3], np.array([float.fromhex(word) for word in words[4:]]).reshape(6, 3)
            good = self.kind in KINDS + ["?"] and np.isfinite(self.corners).all()
        except (ValueError, IndexError, OverflowError):
            good = False
        if not good:
            raise Damaged(f"the example of {self.contestant} is no pair: {self.line}")
        self.words = " ".join("(" + ", ".join(map(decimal, corner)) + ")" for corner in self.corners)


def examples_of(rows):
    """For each contestant and fault the example whose corners take the fewest characters."""
    found = [Example(contestant, fault, row.family, line) for contestant, of in by(rows, "method")
             for fault, end in FAULTS.items() for row in of.itertuples() if (line := text(row, "example_" + end))]
    best = {}
    for example in sorted(found, key=lambda example: len(example.words)):
        best.setdefault((example.contestant, example.fault), example)
    return [best[key] for key in dict.fromkeys((one.contestant, one.fault) for one in found)]


def add_examples(chapter, rows):
    """rows: those about pairs of triangles, of contestants that are not ours. Adds nothing where they hold no example.
    Raises ValueError where an example is no pair."""
    examples = examples_of(rows)
    if not examples:
        return
    chapter.tables.append(Table(
        "libraries-examples",
        "The smallest pair of each kind of fault, of pairs of which the documentation promises the answer: how its "
        "triangles meet, the corners of the first, then those of the second",
        columns(["contestant", "fault", "family", "kind", "coordinates"], []),
        [[one.contestant, one.fault, one.family, one.kind, one.words] for one in examples]))
    chapter.files["libraries-examples.txt"] = (
        "farcull-pairs 1 libraries-examples\n# Pairs at which libraries err, minimized: whose fault, which, and the "
        "family that the pair was made from.\n" + "".join(
            f"# {one.contestant} {one.fault} {one.family}\n{number} {one.line.split(' ', 1)[1]}\n"
            for number, one in enumerate(examples)))


def fill(chapter, study):
    rows = with_families(study.rows)
    pairs, meshes = rows[rows.pairs], rows[~rows.pairs]
    add_ours(chapter, rows)
    for name, of in by(rows, "method"):  # a store of an earlier farcull may hold two versions
        if of.library.nunique() > 1:
            chapter.find(f"The rows of {name} are of more than one version: {listed(of.library.unique())}.")
    add_others(chapter, pairs, True)
    add_others(chapter, meshes, False)
    chapter.limits = [
        "The families are made to be hard. A rate here is no rate on the scenes of a user: the table says which "
        "questions a contestant gets wrong, not how often they come.",
        "Where the documentation of a library does not say whether touching counts, it is measured first by the pairs "
        "that cross or are apart. Where it does not take degenerate triangles, they are left out of that measure."]
    add_gaps(chapter, study)
    if len(pairs):
        chapter.tables = [overview(pairs, True), kinds_table(pairs)]
        add_examples(chapter, pairs[pairs.library != "farcull"])
        chapter.figures = [figure for figure in [time_figure(pairs)] if figure.panels]
    chapter.tables += [overview(meshes, False)] * bool(len(meshes))
    if len(rows):
        chapter.tables.append(calls_table(rows))
        chapter.files["tables/libraries-families.csv"] = table_csv(families_table(rows))
