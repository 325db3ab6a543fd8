# Drives the page of `farcull picture --compare cullide,far,exact` of two tori in a browser.
#   page_test.py PAGE SAID PAIRS KINDS PAIRS_OF_KINDS FLAT
# SAID: what the command printed; PAIRS: all pairs with their kinds of contact as CSV; KINDS: the page of a triangle with a pair of each kind; FLAT: the flat picture of cullide at 256 px
import csv
import os
import re
import sys
import time
from collections import Counter

from browser import Browser, Pixels

MISSED, FOUND, PAPER = (220, 0, 90), (0, 128, 116), (255, 255, 255)
READY = "location.protocol === 'file:' && document.documentElement && document.documentElement.dataset.ready !== undefined"
# A headless browser draws its first frame in 2 s on two idle cores; a busy machine takes longer.
SECONDS = 60
START = "\nstart().catch("
failures = []
in_twin = False  # what fails there has to


def check(good, what):
    if not good:
        failures.append(what)
        if not in_twin:
            print("FAILED:", what, file=sys.stderr)


def url(path):
    return "file://" + os.path.abspath(path)


def shown(b, path):
    b.open(url(path))
    b.wait(READY, SECONDS)


# The answer that the state asks for is shown, and one more frame was drawn. "done" after 30 s either way: what is
# seen then is no answer, and fails.
DRAWN = """new Promise((done) => {
  const end = performance.now() + 30000;
  const is_shown = () => answer && answer.step === currentStep();
  const look = () => is_shown() || performance.now() > end
    ? requestAnimationFrame(() => requestAnimationFrame(() => done(1))) : setTimeout(look, 5);
  look();
})"""


def drawn(b):
    """After the next frame, and once no answer is being loaded."""
    b.run(DRAWN)


def place_of_canvas(b):
    return b.run("(() => { const r = document.getElementById('canvas').getBoundingClientRect();"
                 "return [r.left, r.top, r.width, r.height]; })()")


def missed_pixels(b):
    left, top, width, height = place_of_canvas(b)
    drawn(b)
    # Its middle: the colour is in the legend as well.
    return Pixels(b.screenshot((left, top + 0.2 * height, width, 0.6 * height))).count(MISSED)


def is_lit(pixel, colour):
    """Whether a pixel is `colour` times one factor of the light, 0.42 to 1.08. Each channel is rounded to a whole
    number, twice where collisions shine through (once more by 1): so each factor lies in an interval."""
    lo, hi = 0.42, 1.08
    for value, full in zip(pixel, colour):
        if full == 0:
            if value > 1:
                return False
        else:
            lo, hi = max(lo, (value - 1.5) / full), min(hi, (value + 1.5) / full)
    return lo <= hi


def set_value(b, name, value, event="input"):
    b.run(f"(() => {{ const e = document.getElementById('{name}'); e.value = {value!r};"
          f"e.dispatchEvent(new Event('{event}', {{ bubbles: true }})); }})()")


def check_steps(b, said):
    """Method and resolution by their controls: headline and legend are what the command printed."""
    seen = []
    for method, steps in (("cullide", 3), ("far", 3), ("exact", 1)):
        set_value(b, "method", method, "change")
        drawn(b)
        lost = []
        for step in range(steps):
            if steps > 1:
                set_value(b, "resolution", step)
            b.wait(f"document.getElementById('headline').textContent.startsWith('{method}')")
            drawn(b)
            seen.append(b.text("headline"))
            count = int(re.search(r"missed ([\d,]+) of", seen[-1])[1].replace(",", ""))
            here = missed_pixels(b)
            check((here > 0) == (count > 0), f"{seen[-1]}: {here} pixels of the colour of misses")
            lost.append(count)
            legend = b.text("legend")
            check(("missed:" in legend) == (count > 0), f"the legend says {legend}")
        if method == "cullide":
            check(lost[0] > lost[-1] > 0, f"cullide loses {lost}: the case shows nothing")
        else:
            check(set(lost) == {0}, f"{method} loses {lost}")
    check(seen == [line for line in said if " missed " in line], f"headlines are {seen}")


def partners(path):
    """Of each triangle (object, triangle) in the CSV of --pairs all partners, each with the kind of contact."""
    out = {}
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            a = (int(row["object_a"]), int(row["triangle_a"]))
            b = (int(row["object_b"]), int(row["triangle_b"]))
            out.setdefault(a, {})[b] = row["contact"]
            out.setdefault(b, {})[a] = row["contact"]
    return out


def named(words):
    """(object, triangle) of "triangle 1,234 of object 0, first"."""
    found = re.search(r"[Tt]riangle ([\d,]+) of object (\d+)", words)
    return (int(found[2]), int(found[1].replace(",", ""))) if found else None


def check_click(b, pairs, times=3):
    """A click chooses what is seen, and lists its pairs. Misses are in front of all else, so at 32 px each can be
    clicked where it is."""
    set_value(b, "method", "cullide", "change")
    drawn(b)
    set_value(b, "resolution", 0)
    drawn(b)
    b.run("document.getElementById('canvas').focus()")
    tried = 0
    for _ in range(times):
        b.key("n")
        drawn(b)
        triangle = b.run("farcull.state.triangle")
        b.run("farcull.view.camera.zoom = 40, farcull.view.zoom(1)")
        wanted = named(b.text("chosen"))
        b.key("Escape")
        drawn(b)
        check("Click a triangle" in b.text("chosen"), "Escape chooses no triangle")
        left, top, *_ = place_of_canvas(b)
        x, y = b.run(f"farcull.view.project({triangle})")
        check(b.run(f"farcull.view.pick({x}, {y})") >= 0, "nothing is where a missed triangle is")
        b.click(left + x, top + y)
        drawn(b)
        chosen = b.text("chosen")
        got = named(chosen)
        check(got is not None, f"the click says {chosen}")
        if got is None:
            continue
        listed = b.run("[...document.querySelectorAll('#chosen button')].map((e) => e.textContent)")
        check(listed_pairs(b) == pairs.get(got), f"{got} has the pairs {listed}")
        check(any(line.endswith("missed") for line in listed), f"a missed triangle without a miss: {listed}")
        tried += got == wanted
        # A button chooses the partner.
        other = named(listed[0])
        b.run("document.querySelector('#chosen button').click()")
        drawn(b)
        check(named(b.text("chosen")) == other, f"the button of {other} chooses {b.text('chosen')}")
        b.run(f"farcull.state.triangle = {triangle}")
    check(tried > 0, "no click found the triangle that was aimed at")
    b.key("Escape")
    b.key("0")


def listed_pairs(b):
    """The partners of the chosen triangle that the page lists, each with the kind of contact."""
    lines = b.run("[...document.querySelectorAll('#chosen button')].map((e) => e.textContent)")
    return {named(line): re.search(r": ([a-z-]+), (?:missed|found)$", line)[1] for line in lines}


def check_kinds(b, page, pairs):
    """Triangle 0 meets others in each kind of contact that there is without a clearance."""
    shown(b, page)
    b.run("choose(0)")
    drawn(b)
    listed = listed_pairs(b)
    check(listed == pairs[0, 0], f"kinds are {listed}")
    check(len(set(listed.values())) == 6, f"the case lacks kinds: {listed}")


def classes_of(rows, known={}):
    """Of each pixel of rows of colours what is seen there: paper, a colour of the legend or of an object, lit, or what
    is mixed of two."""
    colours = {"found": FOUND, "first": (176, 190, 210), "second": (218, 214, 206)}
    for colour in set().union(*rows) - known.keys():
        known[colour] = ("paper" if colour == PAPER else "missed" if colour == MISSED else
                         next((name for name, full in colours.items() if is_lit(colour, full)), "mixed"))
    return [[known[colour] for colour in row] for row in rows]


def shares_of(rows):
    """Of each class that is seen: its share of the pixels that are not paper, and that of its pixels at an edge, which
    is where a neighbour is of another class."""
    seen, edges, classes = {}, {}, classes_of(rows)
    for above, row in zip([classes[0]] + classes, classes):
        for left, up, here in zip([row[0]] + row, above, row):
            seen[here] = seen.get(here, 0) + 1
            for other in (left, up):
                if other != here:
                    edges[here] = edges.get(here, 0) + 1
                    edges[other] = edges.get(other, 0) + 1
    coloured = sum(seen.values()) - seen.get("paper", 0)
    return {name: (count / coloured, edges.get(name, 0) / coloured) for name, count in seen.items() if name != "paper"}


def check_flat(b, page, flat):
    """The page shows what the flat picture of the same view shows, at another size. A pixel that is at no edge stands
    for its whole area, in both pictures. So the share of a class differs by no more than its edges do."""
    shown(b, page)
    set_value(b, "method", "cullide", "change")
    drawn(b)
    set_value(b, "resolution", 1)
    drawn(b)
    b.run("document.getElementById('legend').style.visibility = 'hidden'")
    left, top, width, height = place_of_canvas(b)
    # Without the ring of the focus.
    here = shares_of(Pixels(b.screenshot((left + 3, top + 3, width - 6, height - 6))).as_rows())
    rows = flat.as_rows()
    # A line of the frame is of one colour that is not the paper's, but for the margins.
    most = [Counter(row).most_common(1)[0] for row in rows]
    frame = [y for y, (colour, count) in enumerate(most) if colour != PAPER and count > 0.8 * len(rows[y])]
    check(len(frame) == 2, f"the flat picture has {len(frame)} lines of a frame")
    inside = [x for x, colour in enumerate(rows[frame[0]]) if colour != PAPER]
    there = shares_of([row[inside[0] + 1:inside[-1]] for row in rows[frame[0] + 1:frame[1]]])
    check({"missed", "first", "second"} <= there.keys(), f"the flat picture shows {there}")
    for name in there.keys() | here.keys():
        (a, edges_a), (c, edges_c) = there.get(name, (0, 0)), here.get(name, (0, 0))
        check(abs(a - c) <= edges_a + edges_c,
              f"{name} is {c:.4f} of the page, and {a:.4f} of the flat picture; edges are {edges_c:.4f} and {edges_a:.4f}")


def spoiled(page, old, new):
    with open(page, encoding="utf-8") as file:
        whole = file.read()
    assert whole.count(old) >= 1, old
    with open("spoiled.html", "w", encoding="utf-8") as file:
        file.write(whole.replace(old, new, 1))
    return "spoiled.html"


def check_twins(b, page, pairs, kinds, flat):
    """Faults that the checks have to catch: each must leave a problem or a failure."""
    def caught(what, old, new, act, page=page):
        global failures, in_twin
        kept, failures, b.problems, in_twin = failures, [], [], True
        try:
            act(spoiled(page, old, new))
        except (RuntimeError, TimeoutError) as error:
            failures.append(str(error))
        found, failures, b.problems, in_twin = failures + b.problems, kept, [], False
        print(f"picture.page: {what}: {found[:1]}", flush=True)
        check(found, f"{what} is not caught")

    def looks(path):
        b.open(url(path))
        b.wait(READY, 10)
        drawn(b)

    def damaged(path):
        b.open(url(path))
        b.wait("document.getElementById('trouble') && !document.getElementById('trouble').hidden")
        check("cannot be shown" not in b.text("trouble"), "the reader is told of damaged data")

    def click(path):
        shown(b, path)
        check_click(b, pairs, 1)

    small = kinds[0]
    caught("a line on the console", START, "\nconsole.log('made up');start().catch(", looks, small)
    caught("an exception", START, "\nsetTimeout(() => nothing_of_this_name());start().catch(", looks, small)
    caught("a block that is damaged", 'id="block-0">', 'id="block-0">AAAA', damaged, small)
    caught("misses in another colour", "if (part == 2) colour = missed;", "if (part == 2) colour = found;",
           lambda path: check_flat(b, path, flat))
    caught("no misses beside the flat picture", "place.w > 0.5 ?", "place.w > 0.5 || part == 2 ?",
           lambda path: check_flat(b, path, flat))
    caught("kinds of contact by other names", '"coplanar","crossing"', '"crossing","coplanar"',
           lambda path: check_kinds(b, path, kinds[1]), kinds[0])
    caught("a click beside", "int id = number + 1;", "int id = number + 2;", click)


def main():
    page, said, pairs = sys.argv[1], open(sys.argv[2], encoding="utf-8").read().splitlines(), partners(sys.argv[3])
    with Browser() as b:
        shown(b, page)
        print("picture.page: first frame after", b.run("document.documentElement.dataset.ready"), "ms")
        begun = time.monotonic()
        for act in (lambda: check_steps(b, said), lambda: check_click(b, pairs)):
            act()
            print(f"picture.page: {time.monotonic() - begun:.1f} s", flush=True)
        check(not b.problems, f"the page has problems: {b.problems}")
        with open(sys.argv[6], "rb") as file:
            flat = Pixels(file.read())
        check_flat(b, page, flat)
        kinds = (sys.argv[4], partners(sys.argv[5]))
        check_kinds(b, *kinds)
        check_twins(b, page, pairs, kinds, flat)
    with Browser("--disable-3d-apis") as b:
        shown(b, page)
        check(b.run("getComputedStyle(document.getElementById('flat')).display") == "block" and
              "stands in" in b.text("trouble"), "without WebGL the flat picture does not stand in")
        set_value(b, "method", "far", "change")
        b.wait("document.getElementById('headline').textContent.startsWith('far')")
    if failures:
        sys.exit(1)
    print("picture.page: passed")


main()
