"""`python3 floors.py BUILD PAGE [SCENE...]`: boxes, stage by stage, beside the least that the machine must do.

BUILD holds farcull and farcull_kernels_bench; PAGE is written as Markdown. `bash experiments/results.sh profile` starts
it. A floor is a number of items, which the run itself counts, times the time of a kernel for one item. The kernels run
on the same machine, on data of the same scene.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

SCENES = "two-bunnies armadillo-elephant crumpled spheres field:1000000 funnel needles-crossed cad-cut".split()
DISTANCES = {"crowd": "nearest", "bunnies-far-apart": "objects", "field:100000": "nearest"}
THREADS = (1, 2)
PEERS = "embree-low,embree-medium,cgal-object-pairs,fcl-obb,bullet-gimpact"  # as in stages.py
REPEAT, LIMIT = 7, 1  # runs; seconds of a cold run from which a peer is not asked again
WIDE = 16  # triangles of a block
# Stages of boxes, the part of a peer's time that stands beside each, and the kernels of the stage's floor.
STAGES = {
    "boxes": ("build_ms", {"read_triangles": "read every triangle", "box_triangles": "boxes of triangles",
                           "order_blocks": "order of blocks", "compare_apart": "pairs of blocks"}),
    "blocks": ("candidates_ms", {"compare_block_pairs": "box tests"}),
    "exact": ("exact_ms", {"filter_candidates": "filter"})}


def called(*words):
    out = subprocess.run(words, capture_output=True, text=True)
    if out.returncode:
        sys.exit(f"floors: {' '.join(words)}: {out.stderr.strip()}")
    return out.stdout


def kernels(build, scenes, names):
    """The least nanoseconds that an item took, by kernel and scene; kernels without items are left out."""
    out = {}
    said = called(f"{build}/farcull_kernels_bench", *scenes, f"--benchmark_filter=^({'|'.join(names)})(/|$)",
                  "--benchmark_min_time=0.05", "--benchmark_repetitions=3", "--benchmark_format=json")
    for one in json.loads(said)["benchmarks"]:
        if one["run_type"] == "iteration" and not one.get("error_occurred"):
            kernel, *of = one["name"].split("/")[:2]
            key = (kernel, *of) if of and of[0] in scenes else (kernel,)
            out[key] = min(out.get(key, 1e300), 1e9 / one["items_per_second"])
    return out


def bench(build, scene, threads, *words):
    said = called(f"{build}/farcull", "bench", scene, "--threads", str(threads), "--repeat", str(REPEAT),
                  "--limit", str(LIMIT), "--json", "-", *words)
    record = json.loads(said)
    rows = {row["name"]: row for row in record["rows"]}
    ours = next(row for row in record["rows"] if not row["peer"])
    return ours, rows.get(record["fastest_peer"])


def counts(build, scene, candidates):
    """The number of items of each kernel."""
    record = json.loads(called(f"{build}/farcull", "run", scene, "--method", "boxes",
                               "--no-verify", "--json", "-"))
    ran = {stage["name"]: stage for stage in record["stages"] if stage["ran"]}
    triangles, pairs = 0, 0
    if "blocks" in ran:
        triangles = ran["blocks"]["in"]
        pairs = int(re.search(r"overlap: ([\d,]+)", ran["blocks"]["reason"])[1].replace(",", ""))
    return {"read_triangles": record["scene"]["triangles"], "box_triangles": triangles, "order_blocks": triangles // WIDE,
            "compare_apart": pairs // WIDE, "compare_block_pairs": pairs, "filter_candidates": candidates}


def number(ms):
    return f"{ms:.3g}" if ms < 100 else f"{ms:.0f}"


def ratio(a, b):
    return f"{a / b:.{1 if a < 100 * b else 0}f}" if b else "-"


def profile(build, scene, each):
    """The table of a scene, and its rows in the table of all scenes."""
    print(f"profile: {scene}", file=sys.stderr)
    measured = [bench(build, scene, threads, "--methods", "boxes", "--peers", PEERS)
                for threads in THREADS]
    items = counts(build, scene, measured[0][0]["candidate_pairs"])
    titles = [f"floor, {threads} | ours | ours / floor | {peer['name']}"
              for threads, (_, peer) in zip(THREADS, measured)]
    lines = [f"### {scene}", "", f"| work | items | ns each | {' | '.join(titles)} |", "|---|" + "---:|" * 10]
    whole = 0.0
    for stage, (part, parts) in STAGES.items():
        floor = 0.0
        for kernel, title in parts.items():
            ns = each.get((kernel, scene), each.get((kernel,), 0.0))
            ms = items[kernel] * ns / 1e6
            floor += ms
            cells = " | ".join(f"{number(ms / threads)} | | |" for threads in THREADS)
            lines.append(f"| {title} | {items[kernel]:,} | {ns:.1f} | {cells} |")
        whole += floor
        cells = " | ".join(f"{number(floor / threads)} | {number(ours[part])} | {ratio(ours[part], floor / threads)} | "
                           f"{number(peer[part])}" for threads, (ours, peer) in zip(THREADS, measured))
        lines.append(f"| **{stage}** | | | {cells} |")
    totals = [(whole / threads, ours["total_ms"]["median"], peer["total_ms"]["median"], peer["name"])
              for threads, (ours, peer) in zip(THREADS, measured)]
    cells = " | ".join(f"{number(floor)} | {number(ours)} | {ratio(ours, floor)} | {number(peer)}"
                       for floor, ours, peer, _ in totals)
    lines += [f"| **all** | | | {cells} |", ""]
    return lines, summary(scene, totals)


def summary(title, totals):
    cells = " | ".join(f"{number(floor)} | {number(ours)} | {ratio(ours, floor)} | {name}, {number(peer)} | {ours / peer:.2f}"
                       for floor, ours, peer, name in totals)
    return f"| {title} | {cells} |"


def distance(build, scene, each):
    print(f"profile: distances of {scene}", file=sys.stderr)
    totals = []
    for threads in THREADS:
        ours, peer = bench(build, scene, threads, "--distances", DISTANCES[scene])
        floor = counts(build, scene, 0)["read_triangles"] * each[("read_triangles", scene)] / 1e6 / threads
        totals.append((floor, ours["total_ms"]["median"], peer["total_ms"]["median"], peer["name"]))
    return summary(f"{scene}, {DISTANCES[scene]}", totals)


def main():
    build, page, *scenes = sys.argv[1:]
    scenes = scenes or SCENES
    each = kernels(build, scenes, [kernel for _, parts in STAGES.values() for kernel in parts])
    tables, rows = zip(*(profile(build, scene, each) for scene in scenes))
    each |= kernels(build, DISTANCES, ["read_triangles"])
    distances = [distance(build, scene, each) for scene in DISTANCES]
    version = called(f"{build}/farcull", "--version").strip()
    heads = [f"floor, {threads} | ours | ours / floor | fastest peer | ours / peer" for threads in THREADS]
    head = [f"| scene | {' | '.join(heads)} |", "|---|" + "---:|---:|---:|---|---:|" * len(THREADS)]
    lines = [
        "# `boxes` beside the least that the machine must do", "",
        "Made again by `bash experiments/results.sh profile`, which writes this page.", "",
        f"- **Device:** {os.cpu_count()} cores, no GPU.",
        f"- **Commit:** {version}.",
        f"- **Load:** {os.getloadavg()[0]:.1f} at the end; medians of {REPEAT} runs in turn in one process for each scene "
        "and number of threads.", "",
        "All times are in ms; a number behind *floor* is the number of threads. A *floor* is the number of items that the run "
        "itself counts, times the time of one kernel for one item, divided by the threads. Kernels run in one thread on "
        "a part of the scene, again and again, so that it stays in the caches and the processor foresees the branches; only "
        "reading goes through the whole scene. The least of three times counts. *Fastest peer* is the fastest of "
        f"{PEERS.replace(',', ', ')}, with the same exact tests of its own candidates. A peer whose first run takes more than a "
        "second is not asked again ([bench](../bench.md)).", "",
        *head, *rows, "",
        "## Distances", "",
        "The floor is to read every triangle once. The peers are those of `farcull bench --distances`; the fastest one "
        "measures in doubles.", "", *head, *distances, "",
        "## Which items are counted, and why fewer do not suffice", "",
        "Each floor holds for this way to find pairs: blocks of 16 triangles whose boxes are compared, then their triangles' "
        "boxes, then a filter. Another way has other items. Blocks of another size, better boxes or kept data of an earlier "
        "frame change the numbers, and a faster kernel changes the time of an item.", "",
        "| work | item | why each item is needed |", "|---|---|---|",
        "| read every triangle | a triangle of the scene | a triangle that nobody reads may collide |",
        "| boxes of triangles | a triangle in a block whose box overlaps that of another block | box tests compare these boxes |",
        "| order of blocks | such a block | a tree needs blocks in an order. A file may have that order, and then nothing is sorted; "
        "if a file has none, all triangles are sorted, which takes longer |",
        "| pairs of blocks | a test of one box with sixteen | a test finds at most 16 pairs; the nodes above are not counted |",
        "| box tests | a pair of blocks whose boxes (also oriented ones, where the scene has them) overlap | one of its pairs "
        "of triangles may collide |",
        "| filter | a candidate: two triangles whose boxes overlap | one test decides no other pair |", "",
        "## Stages", "",
        "Beside the stages *boxes*, *blocks* and *exact* stand the parts *build*, *find* and *exact* of the peer. For objects whose "
        "file is in no order, ours makes the boxes of triangles in the stage *boxes*, for others in *blocks*. The floor always "
        "counts them in *boxes*.", "",
        *(line for table in tables for line in table)]
    pathlib.Path(page).write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


main()
