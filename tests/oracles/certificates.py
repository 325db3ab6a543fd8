"""Certificates of runs: each byte of evidence is checked here as docs/certificate.md defines it. Forged ones, which farcull must
not prove. Some scenes also in tiles, by the program. That the checker proved in Coq gives the same verdicts as farcull is tested
by tests/verify/certificate/verified_test.py."""
import base64
import hashlib
import json
import shutil

import farcull
import numpy as np

from . import exact
from .lab import HERE, all_pairs, as_tuples, call, dropped, indexed, require, rows, starts_of, write_off

FAULTS = ["a dropped pair of the list", "a byte of a pair that meets", "a verdict about a forged certificate", "a tile left out"]
MEETS, NEIGHBOURS, KEPT = 38, 39, 64


def directions(p, q):
    e, f = ([exact.sub(t[(i + 1) % 3], t[i]) for i in range(3)] for t in (p, q))
    w = [exact.sub(b, a) for a in p for b in q]
    out = [exact.vector(e[0], e[1]), exact.vector(f[0], f[1])] + [exact.vector(x, y) for x in e for y in f]
    for pick in (lambda i, j: e[i], lambda i, j: f[j]):
        for i in range(3):
            for j in range(3):
                x, v = pick(i, j), w[3 * i + j]
                out.append(tuple(a * exact.scalar(x, x) - b * exact.scalar(v, x) for a, b in zip(v, x)))
    return out + w


def is_evidence(d, p, q, clearance):
    a, b = [exact.scalar(d, x) for x in p], [exact.scalar(d, x) for x in q]
    gap = max(min(b) - max(a), min(a) - max(b))
    return gap > 0 and gap * gap > clearance**2 * exact.scalar(d, d)


def list_of(found, sizes, selves):
    """The text of the list; found: {pair: whether neighbours}."""
    starts = starts_of(sizes)
    lines = ["object_a,triangle_a,object_b,triangle_b" + (",neighbours" if any(selves) else "")]
    for pair in sorted(found):
        objects = [int(np.searchsorted(starts, t, "right")) - 1 for t in pair]
        line = ",".join(f"{o},{t - starts[o]}" for o, t in zip(objects, pair))
        lines.append(line + (f",{int(found[pair])}" if any(selves) else ""))
    return "".join(line + "\n" for line in lines)


def forged(rng, certificate, evidence):
    """(certificate, verdicts that are right) for changes that make it false."""
    def made(change, new):
        other = json.loads(json.dumps(certificate))
        other["evidence"] = base64.b64encode(bytes(new)).decode()
        change(other["claims"], other)
        return json.dumps(other)

    def other_hash(_, all_):
        all_["list_sha256"] = hashlib.sha256(b"another list").hexdigest()

    out = [(made(other_hash, evidence), ["not proved"]),
           (made(lambda c, _: c.update(meeting=c["meeting"] + 1), evidence), ["not proved"])]
    places = list(range(len(evidence)))
    rng.shuffle(places)
    for k in places[:4]:
        byte, new = evidence[k], bytearray(evidence)
        if byte & 63 == MEETS:
            new[k] = byte ^ KEPT  # called culled, and the counts say so
            out.append((made(lambda c, _: c.update(kept=c["kept"] - 1, culled=c["culled"] + 1), new), ["refuted"]))
        elif byte & 63 != NEIGHBOURS:
            new[k] = byte & KEPT | MEETS
            out.append((made(lambda c, _: c.update(separated=c["separated"] - 1, meeting=c["meeting"] + 1), new), ["refuted"]))
    if evidence:
        out.append((made(lambda c, _: None, evidence[:-1]), ["not proved"]))
    return out[:5]


def scene(rng, spoil):
    sizes = [rng.randint(1, 7) for _ in range(rng.randint(1, 3))]
    selves = [len(sizes) == 1 and sizes[0] > 1 or rng.random() < 0.3 for _ in sizes]
    if len(sizes) == 1 and sizes[0] == 1:
        sizes = [2]
        selves = [True]
    most = rng.choice([1, 2, 4, 9])
    corners = np.array([[[rng.randint(0, most) for _ in range(3)] for _ in range(3)] for _ in range(sum(sizes))])
    clearance = rng.choice([0, 0, 1, 2])
    tuples = as_tuples(corners)
    V, F = indexed(corners)
    made = farcull.Scene.from_arrays(V, F, starts_of(sizes), self=selves, name="oracle")
    text = made.run(clearance=clearance or None, threads=1).certificate()
    certificate = json.loads(text)
    evidence = base64.b64decode(certificate["evidence"])

    owner = np.repeat(np.arange(len(sizes)), sizes).tolist()
    a, b = all_pairs(sizes, selves)
    near = exact.boxes_overlap(corners[a], corners[b], clearance)
    pairs = list(zip(a[near].tolist(), b[near].tolist()))
    require(len(evidence) == len(pairs), "another number of bytes", len(evidence), len(pairs))
    spoiled = spoil("a byte of a pair that meets", evidence,
                    lambda e: e.replace(bytes([KEPT | MEETS]), bytes([KEPT]), 1) if bytes([KEPT | MEETS]) in e else None)
    found, counts = {}, {"separated": 0, "neighbours": 0, "meeting": 0}
    for (s, t), byte in zip(pairs, spoiled):
        p, q = tuples[s], tuples[t]
        neighbours = owner[s] == owner[t] and bool(set(p) & set(q))
        if neighbours:
            meet = exact.meet_as_neighbours(p, q, exact.common(p, q))
        else:
            meet = exact.squared(p, q) <= clearance**2
        number = byte & 63
        kind = "meeting" if meet else "neighbours" if neighbours else "separated"
        counts[kind] += 1
        right = number == MEETS if meet else number == NEIGHBOURS if neighbours else \
            number < MEETS and is_evidence(directions(p, q)[number], p, q, clearance)
        require(byte < 128 and right, f"the byte {byte} of a pair that is {kind}", p, q, clearance)
        if meet:
            found[s, t] = neighbours
    claims = certificate["claims"]
    require({**claims, **counts, "box_pairs": len(pairs)} == claims, "counts", claims, counts)
    listed = list_of(found, sizes, selves)
    require(hashlib.sha256(listed.encode()).hexdigest() == certificate["list_sha256"], "the hash of the list", found)

    # The list, one without a row, and one with a wrong row.
    check = farcull.check(made, text, pairs=np.array(sorted(found), int).reshape(-1, 2))
    require(check.proved, "not proved", check.verdict, check.reason)
    answer = spoil("a dropped pair of the list", rows(check.pairs), dropped)
    require(answer == sorted(found), "pairs of the check", answer, found)
    apart = set(zip(a.tolist(), b.tolist())) - set(found)
    wrong = sorted(found)[1:] if found and rng.random() < 0.5 else sorted(apart)[:1] + sorted(found)
    if wrong != sorted(found):
        verdict = farcull.check(made, pairs=np.array(wrong, int).reshape(-1, 2), clearance=float(clearance)).verdict
        require(verdict != "proved", "a wrong list is proved", wrong, found)
    facts = {"pairs of boxes": len(pairs), "pairs": len(found), "forged": 0}
    for forgery, right in [(text, ["proved"]), *forged(rng, certificate, evidence)]:
        verdict = farcull.check(made, forgery).verdict
        verdict = spoil("a verdict about a forged certificate", verdict, lambda v: None if v == "proved" else "proved")
        require(verdict in right, f"the verdict is {verdict}, not {right}", forgery)
        facts["forged"] += right != ["proved"]
    if rng.random() < 0.02 or spoil.fault == "a tile left out":
        facts["scenes in tiles"] = 1
        in_tiles(rng, spoil, V, F, sizes, selves, clearance, listed)
    return facts


def in_tiles(rng, spoil, V, F, sizes, selves, clearance, listed):
    """The program: certificates and lists of all tiles, their merged list, and the checks of both."""
    if len(set(selves)) > 1:
        return
    files = [write_off(f"{HERE}part{k}.off", V, F[start : start + size])
             for k, (start, size) in enumerate(zip(starts_of(sizes), sizes))]
    options = ["--self"] if selves[0] else []
    tiles = rng.randint(2, 4)
    more = ["--clearance", clearance] if clearance else []
    for k in range(1, tiles + 1):
        status, out, err = call("run", *files, *options, *more, "--tiles", f"{k}/{tiles}", "--json", f"{HERE}r{k}.json",
                                "--pairs", f"{HERE}p{k}.csv", "--certificate", f"{HERE}t{k}.json")
        require(status == 0, "a tile", status, out, err)
    merged = HERE + "merged.csv"
    status, out, err = call("merge", *(f"{HERE}r{k}.json" for k in range(1, tiles + 1)), "-o", merged)
    require(status == 0, "merge", out, err)
    with open(merged, encoding="ascii") as file:
        require(file.read() == listed, "the merged list", listed)
    if spoil.fault == "a tile left out":  # its list is that of the tile before
        spoil("a tile left out", None, lambda _: True)
        shutil.copy(HERE + "t1.json", HERE + "t2.json")
    status, out, err = call("check", f"{HERE}t%d.json", *files, *options, "--tiles", tiles, "--pairs", merged)
    require(status == 0 and out.startswith("proved"), "check of tiles", status, out, err)
