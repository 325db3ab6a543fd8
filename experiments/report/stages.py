"""`python3 stages.py PROGRAM PAGE FIGURE [SCENE...]`: what each stage of FAR takes away and what it costs.

FAR runs with --broad-phase objects and triangles, in turn with the default method and the method exact, every run
in a process of its own. PAGE is written as Markdown, FIGURE as SVG. `bash experiments/results.sh stages` starts it.
"""
import datetime
import json
import math
import os
import pathlib
import random
import statistics
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
import draw as look  # noqa: E402, F401: importing it sets the look of figures
from matplotlib import pyplot  # noqa: E402

ROUNDS, SIDE = 5, 256  # runs of each form; side of a view in px
SCENES = ("two-bunnies dragon-bunny armadillo-elephant bunny-dragon breaking-dragon tree-leaves field:100000 spheres two-spheres "
          "two-tori torii cylinders crowd needles needles-crossed needles-layers stack mannequin-devil+self cad-cut").split()
DEFAULT = "boxes"
FORMS = ["objects", "triangles", DEFAULT, "exact"]  # broad phases of far, then methods
# Scenes whose exact tests take longer than drawing. On these scenes, other viewing directions are tried as well.
LOOKED_AT = "needles-crossed needles-layers cad-cut mannequin-devil+self".split()
DIRECTIONS, SIDES = 20, (64, 1024)
# One of these libraries is the fastest on every scene of docs/results/bench.md.
PEERS = "embree-low,embree-medium,cgal-object-pairs,fcl-obb,bullet-gimpact"
PARTS = {"boxes": "#e69f00", "views": "#0072b2", "pairs": "#56b4e9", "exact tests": "#009e73"}


def part_of(stage):
    """Returns the part that a stage belongs to. The part "views" is fattening, drawing and opening the canvas."""
    name = stage["name"].split()[0]
    if name in ("boxes", "blocks", "patches"):
        return "boxes"
    return {"join": "pairs", "exact": "exact tests"}.get(name, "views")


def record_of(program, command, scene, *words):
    """Runs a command of the program on a scene. Returns the JSON that the command writes."""
    name, *flags = scene.split("+")
    out = subprocess.run([program, command, name, *words, *(f"--{flag}" for flag in flags), "--json", "-"],
                         capture_output=True, text=True)
    if out.returncode not in (0, 1):
        sys.exit(f"stages: {scene}, {' '.join(words)}: {out.stderr.strip()}")
    return json.loads(out.stdout)


def drawn(form, side, *words):
    return ("--method", "far", "--broad-phase", form, "--device", "native", "--resolution", str(side), "--no-verify", *words)


def run(program, scene, form):
    """Returns ms of each part, the triangles that boxes and each view of round 1 left, the pairs tested, and the pairs found."""
    words = ("--method", form, "--no-verify") if form in (DEFAULT, "exact") else drawn(form, SIDE)
    record = record_of(program, "run", scene, *words)
    ms, left = dict.fromkeys(PARTS, 0.0), {}
    for stage in record["stages"]:
        if not stage["ran"]:
            continue
        ms[part_of(stage)] += stage["ms"]
        if stage["unit"] == "triangles" and part_of(stage) in ("boxes", "views"):
            words = stage["name"].split()
            if words[0] in ("boxes", "patches"):
                left["boxes"] = stage["out"]
            elif words[-1] == "1":  # a name such as "cull triangles x, round 1"
                left[words[-3]] = stage["out"]
    return {"ms": ms, "left": left, "triangles": record["scene"]["triangles"], "tested": record["candidate_pairs"],
            "found": record["all_colliding_pairs"]}


def measure(program, scenes):
    out = {}
    for scene in scenes:
        print(f"stages: {scene}", file=sys.stderr)
        runs = {form: [] for form in FORMS}
        for _ in range(ROUNDS):
            for form in FORMS:
                runs[form].append(run(program, scene, form))
        found = {one["found"] for of in runs.values() for one in of}
        if len(found) != 1:
            sys.exit(f"stages: {scene}: the forms find different pairs: {sorted(found)}")
        base = statistics.median(sum(one["ms"].values()) for one in runs["exact"])
        out[scene] = {form: of[0] | {"share": {part: statistics.median(one["ms"][part] for one in of) / base
                                               for part in PARTS},
                                     "total": [sum(one["ms"].values()) / base for one in of]}
                      for form, of in runs.items()}
    return out


def draw(results, path):
    figure, axes = pyplot.subplots(figsize=(7, 0.55 * len(results) + 0.6), layout="constrained")
    most = 2.0
    labels, places = [], []
    for k, (scene, forms) in enumerate(results.items()):
        for j, form in enumerate(FORMS):
            y, x = k * 5 + j, 0.0
            for part, colour in PARTS.items():
                width = forms[form]["share"][part]
                axes.barh(y, width, left=x, height=0.85, color=colour, label=part if k == j == 0 else None)
                x += width
            labels.append(f"{scene}  {form}" if j == 0 else form)
            places.append(y)
            if x > most:
                axes.text(most, y, f" {x:.1f}", va="center", ha="left", clip_on=False, fontsize=6)
    axes.set_yticks(places, labels, fontsize=6)
    axes.set_xlim(0, most)
    axes.invert_yaxis()
    axes.set_xlabel("time over that of the method exact")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 1.0), ncols=4, frameon=False)
    axes.axvline(1, color="black", linewidth=0.5)
    figure.savefig(path, metadata={"Date": None})


def table(results):
    rows = ["| scene | form | triangles | boxes leave | view 1 | 2 | pairs tested | boxes | views | pairs | tests | "
            "all (least - most) |", "|" + "---|" * 12]
    for scene, forms in results.items():
        for form in FORMS[:-1]:
            one = forms[form]
            views = [f"{out:,}" for name, out in one["left"].items() if name != "boxes"][:2]
            boxes = f"{one['left']['boxes']:,}" if "boxes" in one["left"] else "-"
            shares = " | ".join(f"{one['share'][part]:.2f}" for part in PARTS)
            total = sorted(one["total"])
            rows.append(f"| {scene.replace('+', ' --')} | {form} | {one['triangles']:,} | {boxes} | "
                        f"{' | '.join(views + ['-'] * (2 - len(views)))} | {one['tested']:,} | {shares} | "
                        f"**{statistics.median(total):.2f}** ({total[0]:.2f} - {total[-1]:.2f}) |")
    return rows


def slower(results):
    """Returns a paragraph: on how many scenes boxes are faster than FAR, and on how many FAR is slower than exact."""
    totals = [{form: statistics.median(one["total"]) for form, one in forms.items()} for forms in results.values()]
    fastest = sum(of[DEFAULT] <= min(of["objects"], of["triangles"]) for of in totals)
    published, with_boxes = (sum(of[form] > 1 for of in totals) for form in ("objects", "triangles"))
    return (f"**On a CPU, boxes find all pairs in less time than drawing.** `{DEFAULT}` took less time than FAR in either form "
            f"on {fastest} of {len(totals)} scenes. FAR with boxes of objects took longer than `exact`, which culls nothing, on "
            f"{published} of {len(totals)} scenes, and with `--broad-phase triangles` on {with_boxes}. FAR is here to be "
            "measured, compared, and drawn on GPUs.")


def looked_along(program, scene):
    """Returns a row about the view that leaves fewest pairs with `--broad-phase triangles`, of axes and random directions."""
    numbers = random.Random(1)
    directions = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    while len(directions) < DIRECTIONS:
        at = [numbers.gauss(0, 1) for _ in range(3)]
        directions.append([x / math.hypot(*at) for x in at])
    found = []
    for direction in directions:
        for side in SIDES:
            view = ":".join(f"{x:.6g}" for x in direction)
            record = record_of(program, "run", scene, *drawn("triangles", side, "--views", view, "--rounds", "1", "--limit", "1"))
            found.append((record["candidate_pairs"], record["pcs"]["triangles"], side, view))
    pairs, triangles, side, view = min(found)
    before = record_of(program, "run", scene, "--method", "exact", "--no-verify")
    best = "-" if pairs == before["candidate_pairs"] else f"{view} at {side} px"
    return (f"| {scene.replace('+', ' --')} | {before['scene']['triangles']:,} | {before['candidate_pairs']:,} | {triangles:,} | "
            f"{pairs:,} | {best} |")


def beside_peers(program, scene):
    """Returns a row: the time of FAR / the time of the fastest library that `bench` measures."""
    record = record_of(program, "bench", scene, "--methods", "far", "--peers", PEERS, "--device", "cpu", "--repeat", "9",
                       "--limit", "5")
    (far,) = (row for row in record["rows"] if row["name"] == "far")
    return f"| {scene.replace('+', ' --')} | {record['fastest_peer']} | {far['ratio_to_fastest_peer']:.2f} |"


def main():
    program, page, picture, *scenes = sys.argv[1:]
    results = measure(program, scenes or SCENES)
    draw(results, picture)
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    cpu = pathlib.Path("/proc/cpuinfo").read_text("utf-8").partition("model name")[2].partition(": ")[2].partition("\n")[0]
    lines = [
        "# What each stage of FAR takes away and costs", "",
        "Made again by `bash experiments/results.sh stages`, which writes this page.", "",
        f"- **Device:** {os.cpu_count()} cores ({cpu}), no GPU; the native canvas at {SIDE} px, offset `obb` and what follows it.",
        f"- **Commit:** {version}, {datetime.date.today()}.",
        f"- **Load:** {os.getloadavg()[0]:.1f} at the end; medians of {ROUNDS} runs in turn, each in a process of its own.", "",
        slower(results), "",
        "Times are shares of the time of `exact` (boxes and exact tests) on the same scene. *Boxes*: comparing boxes of "
        "objects, blocks and triangles. *Views*: fattening, drawing, asking. *Pairs*: the join of what is left, or taking "
        "what drawing cleared from the list. *Tests*: exact predicates. The forms `objects`, in which FAR begins as published, and "
        f"`triangles` are those of `--broad-phase`; `{DEFAULT}` is the method, which does not draw. A view's column says how "
        f"many triangles are left after it in round 1. Compare *tests* of `{DEFAULT}` with *views* of `triangles`: even a "
        "culling that removed every pair for nothing could save no more than these tests.", "",
        f"![Stages](figures/{pathlib.Path(picture).name})", "", *table(results), "",
        "## Directions", "",
        f"What one view of the form `triangles` leaves at best, of {DIRECTIONS} directions (the axes, others at random) at "
        f"{' and '.join(map(str, SIDES))} px, on the scenes whose exact tests take longest. *Pairs* are those whose boxes "
        "overlap. A triangle is culled only if it lies in front of everything in all of its pixels.", "",
        "| scene | triangles | pairs | triangles left | pairs left | best view |", "|" + "---|" * 6,
        *(looked_along(program, scene) for scene in LOOKED_AT if scene in results), "",
        "## Beside other libraries", "",
        f"Time of FAR, exact tests included, over that of the fastest of {PEERS.replace(',', ', ')}; medians of 9 in turn in one "
        "process, with all cores.", "", "| scene | fastest library | FAR over it |", "|---|---|---|",
        *(beside_peers(program, scene) for scene in results), ""]
    pathlib.Path(page).write_text("\n".join(lines), encoding="utf-8")


main()
