"""Shows what each contestant missed, reported wrongly, refused or crashed on, in a suite of labelled pairs, meshes, questions.

A labelled pair of triangles is a question with its own answer. Pairs of a mesh are parts of one answer about the mesh. So
counts of labelled pairs and counts of pairs of meshes are never added.
"""
import csv
import os

from frame import *  # noqa: F403: a chapter uses most of it
from pages import table_csv

# The counts in each part of a row's score. The order is that of SCORE in experiments/suite/ask.py.
SCORE = ["asked", "missed", "wrong", "own_asked", "own_missed", "own_wrong", "refused", "unanswered", "crashed", "hung",
         "no_memory", "not_asked", "twice", "answered", "differing", "timed", "zero", "not_zero", "negative", "off", "points",
         "points_off"]
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "libraries.csv"), encoding="utf-8") as known_file:
    # For each library: the called function, and what the documentation says. Methods of farcull have this in their rows.
    DOCUMENTED = {row["contestant"]: row for row in csv.DictReader(known_file)}
CARD = ["library", "means", "called", "says", "source", "use"]
KINDS = ["apart", "touch-vertex", "touch-edge", "touch-face", "crossing", "coplanar", "equal", "neighbours-meet",
         "neighbours-apart"]  # the labels of pairs: how the two triangles meet
QUESTIONS = ["distance", "self", "inside", "clash"]


# ---- rows and their sums

def with_families(rows):
    """Splits each row into a row for each of its families. A new row has the family's entries of `scores`, and their sums. The
    column `asks` is pairs, meshes or one of QUESTIONS; `family` is a name such as pairs/random."""
    out = []
    for row in rows.itertuples():
        families = {}
        for part in json.loads(text(row, "scores") or "[]"):
            if not isinstance(part, list) or len(part) != len(SCORE) + 6:
                raise Damaged(f"'{part}' is no score of this version of farcull")
            families.setdefault(part[0], []).append(dict(zip(["parameter", "kind", *SCORE, "worst", "ns", "reason"], part[1:])))
        for family, parts in families.items():
            known = DOCUMENTED.get(row.method, {})
            out.append({"method": row.method, "family": family, "asks": family.partition("/")[0], "parts": parts,
                        "promises": flag(row, "promises"), **{name: known.get(name) or text(row, name) for name in CARD},
                        **{name: sum(part[name] for part in parts) for name in SCORE},
                        "worst": max(part["worst"] for part in parts), "total_ms": sum(part["ns"] for part in parts) / 1e6})
    return pd.DataFrame(out, columns=["method", "family", "asks", "parts", "promises", *CARD, *SCORE, "worst", "total_ms"])


def totals(rows, *names):
    return sum(total(rows, name) for name in names)


def deaths(rows):
    """Returns the number of questions at which the process crashed, hung or ran out of memory."""
    return totals(rows, "crashed", "hung", "no_memory")


def without_answer(rows):
    return deaths(rows) + totals(rows, "refused", "unanswered", "not_asked")


def differing(rows):
    """Returns a text such as `78 of 646`: of 646 questions that were asked twice, 78 got two different answers."""
    otherwise = total(rows, "differing")
    return of_all(otherwise, total(rows, "twice")) if otherwise else "0"


def answers(rows, pairs, own):
    """Returns the number of missed pairs, a total, the number of false alarms, and a total. If `pairs` is true, both totals are
    the number of answers. For meshes, the totals are the numbers of colliding and of reported pairs, since pairs that are apart
    are not counted. own: counts only answers that the contestant's documentation promises."""
    asked, missed, false = (total(rows, name) for name in (
        ("own_asked", "own_missed", "own_wrong") if own else ("answered", "missed", "wrong")))
    return missed, asked, false, asked if pairs else asked - missed + false


# ---- tables

def per_million(count, of):
    """Returns the rate per million as a text; "0" if the count is 0, "-" if there are no cases."""
    return "-" if of == 0 else "0" if count == 0 else rounded(1e6 * count / of)


def overview(rows, pairs):
    start, counts = (
        "Pairs of triangles: missed (they meet, and it says apart) and false alarms (they are apart, and it says that "
        "they meet), per million of the pairs that were answered", ["asked"]) if pairs else (
        "Meshes: the colliding pairs of all meshes that were asked, and the pairs that were reported; missed per million of the "
        "colliding pairs of those meshes that were answered, false alarms per million of the reported pairs, since nobody counts "
        "the pairs of a mesh that are apart. Both rates are given", ["colliding", "reported"])
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
    parts = pd.DataFrame([{"contestant": row.method, **part} for row in rows.itertuples() for part in row.parts],
                         columns=["contestant", "kind", *SCORE])
    rates = {row.Index: per_million(row.missed + row.wrong, row.answered)
             for row in parts.groupby(["contestant", "kind"]).sum().itertuples()}
    return Table(
        "libraries-kinds",
        "Wrong answers (missed or false alarms) per million answers about pairs of each kind of contact, degenerate "
        "triangles among them; -: none was asked", columns(["contestant"], KINDS),
        [[name] + [rates.get((name, kind), "-") for kind in KINDS] for name in rows.method.unique()])


def faults_of(rows, asks):
    """Returns two counts of the answers that the documentation promises: the wrong answers, and all of these answers."""
    of = rows[rows.asks == asks]
    if asks in ("pairs", "meshes"):
        missed, asked, false, reported = answers(of, asks == "pairs", True)
        return missed + false, asked if asks == "pairs" else asked + false
    return totals(of, "missed", "wrong"), total(of, "answered")


def trust_table(rows):
    """Returns a row for each contestant; contestants that err least on pairs come first."""
    def cell(of, asks):
        of = of[of.asks == asks]
        (wrong, asked), silent = faults_of(of, asks), without_answer(of)
        return "" if of.empty else " + ".join(
            [of_all(wrong, asked) if asked else "no answer"] * bool(asked or not silent) +
            [f"{grouped(silent)} none"] * bool(silent))

    def rate(of):
        wrong, asked = faults_of(of, "pairs")
        return (not (of.library == "farcull").all(), wrong / asked if asked else 1)

    def ns(of):
        of = of[of.asks == "pairs"]
        timed = total(of, "timed")
        return rounded(1e6 * column(of, "total_ms").sum() / timed) if timed else ""

    asked = [asks for asks in ["pairs", "meshes", *QUESTIONS] if (rows.asks == asks).any()]
    return Table(
        "libraries-trust",
        "Whom to trust for what: wrong answers, of those of which the documentation promises the answer. Pairs: do two "
        "triangles meet? Meshes: which of their pairs meet (missed pairs and pairs that are apart are wrong)? Distance: how far "
        "are two triangles apart (an error of a millionth is wrong)? Self: does a mesh meet itself? Inside: is a point in a "
        "solid (points at a vertex count for farcull's methods alone)? Clash: do the insides of two solids meet? + none: so many "
        "got no answer. Empty: it has no function for that", columns(["contestant", "library"], asked + ["ns a pair"]),
        [[name, of.library.iloc[0], *(cell(of, asks) for asks in asked), ns(of)]
         for name, of in sorted(by(rows, "method"), key=lambda both: rate(both[1]))])


def uses_table(rows):
    return Table("libraries-use", "What each is made for, by its documentation where it is quoted",
                 columns(["contestants", "made for"], []),
                 [[", ".join(of.method), use] for use, of in by(rows.drop_duplicates("method"), "use")])


def questions_table(rows):
    """Returns a table of the errors of distances, with a column for each kind."""
    names = {name: name.replace(" ", "_") for name in ("zero", "not zero", "negative", "off", "points", "points off")}
    return Table(
        "libraries-distances",
        "Distances of two triangles: 0 though they are apart; above 0 though they meet; negative; with a relative error above "
        "a millionth; the largest relative error; the points that were given, and those that lie off their triangle or their "
        "distance by more than a millionth", columns(["contestant"], ["answered", *names, "largest error"]),
        [[name, grouped(total(of, "answered")), *(grouped(total(of, key)) for key in names.values()),
          rounded(column(of, "worst").max())] for name, of in by(rows, "method")])


def calls_table(rows):
    names = ["method", "library", "called", "says", "source", "use"]
    return Table(
        "libraries-calls",
        "How each was called, what its documentation says of exactness and of touching, where it says that, and where "
        "it is right to be used", columns(["contestant", "library", "called", "says", "source", "use"], []),
        rows.drop_duplicates("method")[names].values.tolist())


def families_table(rows):
    families = list(rows.family.unique())

    def cell(of):
        pairs = (of.asks == "pairs").any()
        asked, said = (total(of, "asked"), total(of, "answered")) if pairs else (10**6, 10**6)
        return "-" if of.empty or asked == 0 else " / ".join(
            [per_million(total(of, name), said) for name in ("missed", "wrong")] +
            [per_million(count, asked) for count in (total(of, "refused"), deaths(of))])

    return Table(
        "libraries-families",
        "Missed / false alarms per million answers and refused / deaths per million pairs that were asked, of each "
        "family, by closed triangles; of meshes the counts", columns(["contestant"] + families, []),
        [[contestant] + [cell(of[of.family == family]) for family in families] for contestant, of in by(rows, "method")])


# ---- figures

def time_figure(rows):
    """Draws a row for each contestant. Contestants that err least by their own documentation come first."""
    out, points = Figure(
        "libraries-time", "Wrong answers where the documentation promises the answer, and the time of a question",
        "Each row is a contestant, with the fewest wrong answers first; (ours) marks the methods of farcull. "
        "Missed: the triangles meet, and it says apart; false alarms: the other way round. Both are per million answers to "
        "questions of which its documentation promises the answer; what was refused or crashed is no answer, and stands in the table. Time: the mean of a question about "
        "two triangles, as the contestant's own process measured it. It includes what the call needs, such as the "
        f"making of a mesh of one triangle, so that what is made for meshes looks slow. n = {grouped(total(rows, 'asked'))} questions to {rows.method.nunique()} contestants."), []
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
    """Adds findings about the methods of farcull. A wrong or missing answer breaks the promise of a method that has one."""
    kept, pairs, colliding, meshes, questions = [], [], [], [], 0
    for name, of in by(promising(rows), "method"):
        silent = without_answer(of)
        of_pairs, of_meshes = of[of.asks == "pairs"], of[of.asks == "meshes"]
        of_questions = of[~of.asks.isin(["pairs", "meshes"])]
        missed, asked, wrong, _ = answers(of_pairs, True, False)
        lost, known, false, reported = answers(of_meshes, False, False)
        many = counted(sum(map(len, of_meshes.parts)), "mesh", "meshes")
        off = totals(of_questions, "missed", "wrong")
        for bad, what in ((missed, f"of {grouped(asked)} pairs missed"),
                          (wrong, f"of {grouped(asked)} pairs reported wrongly"),
                          (lost, f"of the {grouped(known)} colliding pairs of {many} missed"),
                          (false, f"of the {grouped(reported)} pairs reported of {many} are apart"),
                          (off, f"of {grouped(total(of_questions, 'answered'))} other questions answered wrongly")):
            if bad:
                chapter.find_broken(f"{name}: {grouped(bad)} {what}, and it promises none.")
        if silent:
            chapter.find_broken(f"{name} has no answer to {counted(silent, 'question', 'questions')}.")
        if not missed + wrong + lost + false + off + silent:
            kept.append(name)
            pairs, colliding, meshes = pairs + [asked], colliding + [known], meshes + [sum(map(len, of_meshes.parts))]
            questions += total(of_questions, "answered")
    if any(pairs) or any(colliding) or questions:
        def most(counts, one, many):
            return ("up to " if min(counts) < max(counts) else "") + counted(max(counts), one, many)
        what = [f"of {most(pairs, 'pair', 'pairs')}"] * any(pairs) + [
            f"of the {most(colliding, 'colliding pair', 'colliding pairs')} of {most(meshes, 'mesh', 'meshes')}"] * any(
                colliding) + [f"of {counted(questions, 'other question', 'other questions')}"] * bool(questions)
        chapter.find(f"{listed(kept)} missed none and reported none wrongly {listed(what)}.")
    ours = rows[rows.library == "farcull"]
    for name, of in by(ours.drop(promising(ours).index), "method"):
        missed, asked, _, _ = answers(of[of.asks == "pairs"], True, False)
        lost, known, _, _ = answers(of[of.asks == "meshes"], False, False)
        chapter.find(f"{name}, a control that promises nothing, missed {grouped(missed)} of {counted(asked, 'pair', 'pairs')} and "
                     f"{grouped(lost)} of {counted(known, 'colliding pair', 'colliding pairs')} of meshes.")


def add_others(chapter, rows, asks):
    """Adds findings: the libraries and tests that are right by their own documentation; those that err most and least."""
    right, wrong, what = [], [], "pairs of triangles" if asks == "pairs" else asks
    for name, of in by(rows[(rows.library != "farcull") & (rows.asks == asks)], "method"):
        bad, asked = faults_of(of, asks)
        if bad:
            wrong.append((bad / asked, f"{name} ({of_all(bad, asked)})"))
        elif asked:
            right.append(name)
    parts = [f"no answer was wrong of {listed(right)}"] * bool(right)
    if wrong:
        which = f"most often {max(wrong)[1]}, least often {min(wrong)[1]}" if len(wrong) > 1 else wrong[0][1]
        parts.insert(0, f"{of_all(len(wrong), len(wrong) + len(right))} libraries and tests gave wrong answers where their "
                     f"documentation promises the answer: {which}")
    if parts:
        chapter.find(f"Of {what}, {'; '.join(parts)}.")


def fill(chapter, study):
    rows = with_families(study.rows)
    if rows.empty:
        return
    pairs, meshes, distances = (rows[rows.asks == asks] for asks in ("pairs", "meshes", "distance"))
    add_ours(chapter, rows)
    for name, of in by(rows, "method"):  # an old store may have rows of two versions of a library
        if of.library.nunique() > 1:
            chapter.find(f"The rows of {name} are of more than one version: {listed(of.library.unique())}.")
    for asks in ("pairs", "meshes"):
        add_others(chapter, rows, asks)
    chapter.tables += [trust_table(rows), uses_table(rows)]
    files = [calls_table(rows), families_table(rows[rows.asks.isin(["pairs", "meshes"])])]
    if len(pairs):
        files += [overview(pairs, True), kinds_table(pairs)]
        chapter.figures = [time_figure(pairs)]
    if len(meshes):
        files.append(overview(meshes, False))
    if len(distances):
        files.append(questions_table(distances))
    for table in files:  # these tables are too wide for the page
        chapter.files[f"tables/{table.name}.csv"] = table_csv(table)
