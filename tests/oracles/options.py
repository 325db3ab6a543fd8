"""Options of run, verify, clash, distance, check and compare in combinations, and small scenes in files. An answer has to be that
of the oracle for just these options, and the record has to name them; a refusal has to name one of them."""
import itertools

import numpy as np

from . import distances, exact
from .lab import (BOXES, BOXES_OPTION, HERE, all_pairs, as_tuples, call, dropped, indexed, read_json, read_table, require, starts_of,
                  write, write_off)

FAULTS = ["a dropped row", "an option that the record does not name", "another exit status"]
NAMES = ["o0", "o1", "p2"]
PAIRS_OF_OBJECTS = ["o0:o1", "o*:p2", "o1:p2,p2:o0", "*:o1"]
METHODS = [BOXES, "far", "cullide", "quick-cullide", "s-cullide", "i-collide", "exact"]
WORDS = {
    "--method": METHODS, "--self": [], "--clearance": ["1", "2", "0"], "--ignore": PAIRS_OF_OBJECTS, "--only": PAIRS_OF_OBJECTS,
    "--ignore-file": [HERE + "ignored"], "--limit": ["1", "3", "1000"], "--full": [], "--faces": [], "--names": [],
    "--contacts": [], "--segments": [], "--kinds": ["crossing", "touch-vertex,coplanar,equal,apart"], "--verbose": [],
    "--certificate": [HERE + "c.json"], "--resolution": ["32", "auto"], "--radius": ["budget", "published", "2"],
    "--offset": ["obb", "exact"], "--depth": ["fragment", "fixed"], "--depth-format": ["32f", "24"],
    "--query": ["flags", "occlusion"], BOXES_OPTION: ["objects", "triangles"], "--clusters": ["4", "8,2", "none"],
    "--views": ["x", "z,-z", "1:1:0.5"], "--rounds": ["1", "2"], "--clear": ["any", "all"], "--level": ["objects", "triangles"],
    "--conservative": [], "--device": ["native", "cpu"]}
DRAWING = set(list(WORDS)[list(WORDS).index("--resolution") :])
ABOUT_OBJECTS = {key: WORDS[key] for key in ("--self", "--clearance", "--ignore")}
COMMANDS = {
    "run": {**WORDS, "--no-verify": []}, "verify": WORDS, "check": ABOUT_OBJECTS,
    "clash": {"--clearance": ["1", "2", "0"], "--ignore": PAIRS_OF_OBJECTS, "--ignore-file": [HERE + "ignored"],
              "--fail-on": ["none", "touch", "near,clash"], "--unit": ["mm"]},
    "distance": {"--pairs": ["objects", "nearest", "all"], "--k": ["1", "2"], "--within": ["0", "1", "2"], "--self": [],
                 "--ignore": PAIRS_OF_OBJECTS, "--inside": ["yes", "no"], "--threads": ["1", "2"], "--verify": []},
    "compare": {"--methods": [f"{BOXES},exact", "far,cullide", "i-collide,s-cullide"], "--resolutions": ["32", "16,64"],
                "--offsets": ["obb,exact"], "--repeat": ["2"], "--self": [], "--clearance": ["1"],
                BOXES_OPTION: ["objects", "triangles"],
                "--views": ["x", "z,-z"], "--rounds": ["1"], "--clear": ["all"], "--level": ["objects"], "--conservative": [],
                "--device": ["native"]}}
WEIGHTS = {"run": 8, "verify": 2, "check": 2, "clash": 3, "distance": 4, "compare": 2}
seen = set()  # pairs of options with their values


def scene(rng, spoil):
    command = rng.choices(list(WEIGHTS), WEIGHTS.values())[0]
    table = COMMANDS[command]
    given = {name: rng.choice(table[name]) if table[name] else None
             for name in rng.sample(list(table), min(len(table), rng.choice([0, 1, 2, 2, 2, 3, 4, 5])))}
    if command in ("run", "verify") and given.keys() & DRAWING and rng.random() < 0.7:
        given.setdefault("--method", rng.choice(METHODS))
    if command == "distance" and given.get("--pairs") == "all" and rng.random() < 0.8:
        given.setdefault("--within", "2")
    sizes = [rng.randint(1, 5) for _ in range(3)]
    most = rng.choice([2, 4, 7])
    corners = np.array([[[rng.randint(0, most) for _ in range(3)] for _ in range(3)] for _ in range(sum(sizes))])
    if command == "distance":
        corners += np.repeat([0, rng.choice([0, 9]), rng.choice([0, 9, 20])], sizes)[:, None, None]
    V, F = indexed(corners)
    files = [write_off(HERE + name + ".off", V, F[start : start + size])
             for name, start, size in zip(NAMES, starts_of(sizes), sizes)]
    write(HERE + "ignored", "# a comment\no0:p2\n")
    words = [word for name, value in given.items() for word in (name, value) if word is not None]
    facts = {f"calls of {command}": 1}
    for pair in itertools.combinations(sorted((command, *item) for item in given.items()), 2):
        facts["new pairs of options"] = facts.get("new pairs of options", 0) + (pair not in seen)
        seen.add(pair)
    question = Question(command, corners, sizes, given)
    status, out, err, more = globals()["ask_" + command.replace("verify", "run")](rng, files, words, question, spoil)
    status = spoil("another exit status", status, lambda s: 1 - s if s in (0, 1) else None)
    say = " ".join([command, *words]), status, out[-600:], err, sizes, question.tuples
    require(status in (0, 1, 2) and "\x1b" not in err, "a crash", *say)
    if status == 2:
        lines = [line for line in err.splitlines() if line.startswith("farcull: ")]
        require(len(lines) == 1 and ";" in lines[0], "no one refusal with a remedy", *say)
        require(any(name.strip("-").rstrip("s") in err for name in given) or "SCENE" in err, "a refusal that names no option", *say)
        facts[f"refusals of {command}"] = 1
        return facts
    more(status, say)
    facts["answers checked"] = 1
    return facts


def objects_of(text):
    """The pairs of numbers of objects that words such as o*:p2 name."""
    out = set()
    for word in text.split(","):
        p, q = word.split(":")
        sides = [[k for k, name in enumerate(NAMES) if name == w or w == "*" or (w == "o*" and name[0] == "o")] for w in (p, q)]
        out |= {(min(i, j), max(i, j)) for i in sides[0] for j in sides[1] if i != j}
    return out


class Question:
    """What the options ask, and the exact answer."""

    def __init__(self, command, corners, sizes, given):
        self.command, self.tuples, self.sizes, self.given = command, as_tuples(corners), sizes, given
        self.owner = np.repeat(np.arange(len(sizes)), sizes).tolist()
        self.self = "--self" in given
        self.clearance = int(given.get("--clearance", 0))
        self.ignored = objects_of(given["--ignore"]) if "--ignore" in given else set()
        if "--ignore-file" in given:
            self.ignored |= {(0, 2)}
        if "--only" in given:
            self.ignored |= {(0, 1), (0, 2), (1, 2)} - objects_of(given["--only"])

    def colliding(self):
        """[(a, b, whether neighbours, kind)], sorted."""
        out = []
        for a, b in zip(*(x.tolist() for x in all_pairs(self.sizes, [self.self] * 3))):
            p, q, objects = self.tuples[a], self.tuples[b], (self.owner[a], self.owner[b])
            if objects in self.ignored:
                continue
            points = exact.common(p, q)
            neighbours = objects[0] == objects[1] and bool(set(p) & set(q))
            if neighbours:
                collide = exact.meet_as_neighbours(p, q, points)
            else:
                collide = bool(points) or (self.clearance > 0 and exact.squared(p, q) <= self.clearance**2)
            if collide:
                out.append((a, b, neighbours, exact.kind(p, q, points)))
        return out

    def row(self, pair):
        starts = starts_of(self.sizes)
        return tuple(x for t in pair[:2] for x in (self.owner[t], t - starts[self.owner[t]]))


KEYS = {"--method": "method", "--resolution": "resolution", "--radius": None, "--offset": "offset", "--depth": "depth",
        "--depth-format": "depth_format", BOXES_OPTION: "broad_phase", "--rounds": "rounds", "--clear": "clear", "--level": "level",
        "--clearance": "clearance", "--limit": "limit"}


def ask_run(rng, files, words, question, spoil):
    given, command = question.given, question.command
    status, out, err = call(command, *files, *words, "--pairs", HERE + "pairs.csv", "--json", HERE + "r.json")

    def check(status, say):
        record = read_json(HERE + "r.json")
        table = read_table(HERE + "pairs.csv")
        record = spoil("an option that the record does not name", record,
                       lambda r: {**r, "method": "none"} if "--method" in given else None)
        for option, key in KEYS.items():
            if option in given and key:
                value = record[key]
                same = float(value) == float(given[option]) if isinstance(value, (int, float)) else str(value) == given[option]
                require(same, f"the record says {key}: {value}", *say)
        require(record["full"] == ("--full" in given), "full", *say)
        require(record["conservative"] in (None, "--conservative" in given), "conservative", *say)
        pairs = question.colliding()
        limited = pairs[: int(given["--limit"])] if "--limit" in given else pairs
        kinds = given["--kinds"].split(",") if "--kinds" in given else None
        rows = [tuple(int(row[c]) for c in ("object_a", "triangle_a", "object_b", "triangle_b")) for row in table]
        counted = record["verification"] and "--limit" not in given and kinds is None  # so that a row that is missing shows
        rows = spoil("a dropped row", rows, lambda r: dropped(r) if record["promises"] or counted else None)
        wanted = {question.row(p): p for p in limited if kinds is None or p[3] in kinds}
        whole = True  # does the list have every pair that the options ask for?
        if record["promises"]:
            require(rows == list(wanted), "the list", rows, list(wanted), *say)
            require(record["verification"] is None or record["verification"]["false_negatives"] == 0, "missed", *say)
        else:
            all_ = {question.row(p): p for p in pairs if kinds is None or p[3] in kinds}
            require(set(rows) <= set(all_), "the list has wrong pairs", rows, *say)
            wanted = {row: all_[row] for row in rows}
            whole = len(rows) == len(all_)
            if counted:
                require(record["verification"]["false_negatives"] == len(all_) - len(rows), "missed", record["verification"], *say)
        require((record["verification"] is None) == ("--no-verify" in given), "verification", *say)
        columns = set(table[0]) if table else set()
        contact = any(o in given for o in ("--contacts", "--segments", "--kinds"))
        for column, there in (("face_a", "--faces" in given), ("name_a", "--names" in given), ("contact", contact),
                              ("x0", "--segments" in given), ("neighbours", question.self)):
            require(not table or (column in columns) == there, f"the column {column}", *say)
        for row, p in zip(table, wanted.values()):
            require("contact" not in row or row["contact"] == p[3], "contact", row, p, *say)
            require("name_a" not in row or row["name_a"] == NAMES[question.owner[p[0]]], "name", row, *say)
            require("neighbours" not in row or row["neighbours"] == str(int(p[2])), "neighbours", row, *say)
        missed = bool(record["verification"] and record["verification"]["false_negatives"])
        require(status == int(missed and (command == "verify" or record["promises"])), "the exit status", *say)
        if "--certificate" in given:
            more = [w for o in ("--self",) if o in given for w in (o,)]
            code, said, _ = call("check", HERE + "c.json", *files, *more)
            require((code == 0) == (whole and len(rows) == len(wanted) and not missed), "the check of the certificate", code, said, *say)

    return status, out, err, check


def ask_check(rng, files, words, question, spoil):
    """A list that is right, or lacks a row, or has one twice."""
    pairs = question.colliding()
    lines = [",".join(map(str, question.row(p))) + (f",{int(p[2])}" if question.self else "") for p in pairs]
    right = True
    if lines and rng.random() < 0.5:
        right = False
        k = rng.randrange(len(lines))
        lines[k : k + 1] = rng.choice([[], [lines[k]] * 2])
    elif rng.random() < 0.5:
        rng.shuffle(lines)
    head = "object_a,triangle_a,object_b,triangle_b" + (",neighbours" if question.self else "")
    write(HERE + "list.csv", "\n".join([head, *lines]) + "\n")
    status, out, err = call("check", *files, *words, "--pairs", HERE + "list.csv")

    def check(status, say):
        require(status == (0 if right else 1) and out.startswith("proved") == right, f"a list that is right: {right}", lines, *say)

    return status, out, err, check


def ask_clash(rng, files, words, question, spoil):
    status, out, err = call("clash", *files, *words, "--json", HERE + "r.json", "--csv", HERE + "pairs.csv")

    def check(status, say):
        record = read_json(HERE + "r.json")
        table = read_table(HERE + "pairs.csv")
        rows = spoil("a dropped row", record["pairs"], dropped)
        found = {(r["object_a"], r["object_b"]): r for r in rows}
        keys = "object_a", "object_b", "verdict", "triangle_pairs"
        require([[str(r[key]) for key in keys] for r in record["pairs"]] == [[r[key] for key in keys] for r in table],
                "CSV and JSON", *say)
        starts = starts_of(question.sizes)
        for pair in ((0, 1), (0, 2), (1, 2)):
            blocks = [range(starts[o], starts[o] + question.sizes[o]) for o in pair]
            squares = [exact.squared(question.tuples[a], question.tuples[b]) for a in blocks[0] for b in blocks[1]]
            row = found.get(pair, {"verdict": "clear", "triangle_pairs": 0, "ignored": pair in question.ignored})
            require(row["triangle_pairs"] == squares.count(0) and row["ignored"] == (pair in question.ignored), "a row", row, *say)
            near = min(squares) <= question.clearance**2 and question.clearance > 0 and pair not in question.ignored
            allowed = ("clash", "touch") if squares.count(0) else ("contained", "unknown", "near" if near else "clear")
            require(row["verdict"] in allowed, f"allowed are {allowed}", row, *say)
        fail_on = question.given.get("--fail-on", "clash,contained,unknown").split(",")
        fails = any(r["verdict"] in fail_on and not r["ignored"] for r in record["pairs"])
        require(status == int(fails), "the exit status", *say)
        require(record["unit"] == question.given.get("--unit", record["unit"]), "the unit", *say)

    return status, out, err, check


def ask_distance(rng, files, words, question, spoil):
    status, out, err = call("distance", *files, *words, "--json", HERE + "r.json", "--csv", HERE + "pairs.csv")

    def check(status, say):
        given = question.given
        record = read_json(HERE + "r.json")
        table = read_table(HERE + "pairs.csv")
        rows = spoil("a dropped row", record["pairs"], dropped)
        starts = starts_of(question.sizes)
        found = sorted((starts[r["a"]] + r["triangles"][0], starts[r["b"]] + r["triangles"][1], r["squared"]) for r in rows)
        kind = given.get("--pairs", "objects")
        expected = distances.expected_of(question.tuples, question.sizes, {
            "kind": kind, "k": int(given.get("--k", 1)), "within": int(given["--within"]) if "--within" in given else None,
            "self": question.self, "ignore": question.ignored})
        wanted = sorted((a, b, f"{s.numerator}/{s.denominator}") for (a, b), s in expected.items())
        require(found == wanted and len(table) == len(record["pairs"]), "answers", found, wanted, *say)
        if "--inside" in given:
            by = {"yes": "winding number", "no": None}[given["--inside"]]
            require(record["inside_by"] == by, "inside", record["inside_by"], *say)
        require((record["verification"] is not None) == ("--verify" in given) and status == 0, "verification", *say)

    return status, out, err, check


def ask_compare(rng, files, words, question, spoil):
    drawless = "--clearance" in question.given and "--methods" not in question.given
    status, out, err = call("compare", *files, *words, "--json", HERE + "r.json",
                            *([] if drawless or "--resolutions" in question.given else ["--resolutions", "32"]))

    def check(status, say):
        record = read_json(HERE + "r.json")
        runs = record if isinstance(record, list) else record.get("runs") or record.get("rows") or record.get("records")
        require(runs, "no rows", list(record), *say)
        runs = spoil("a dropped row", runs, lambda r: [{**r[0], "all_colliding_pairs": -1}, *r[1:]] if r[0]["promises"] else None)
        count = len(question.colliding())
        for run in runs:
            say_ = run["method"], run["all_colliding_pairs"], count, *say
            require(run["all_colliding_pairs"] + run["verification"]["false_negatives"] == count, "pairs", *say_)
            require(not run["promises"] or run["all_colliding_pairs"] == count, "missed", *say_)
        require(status == 0, "the exit status", *say)

    return status, out, err, check
