# Drives the page of `farcull clash --html` in a browser.
#   clash_page_test.py PAGE NEAR
# PAGE: of three parts, first and second clash, third lies in the first. NEAR: of two parts that are near.
import os
import sys

from browser import Browser

failures = []


def check(good, what):
    if not good:
        failures.append(what)
        print("FAILED:", what, file=sys.stderr)


def shown(b, address, page=1):
    b.open("file://" + os.path.abspath(sys.argv[page]) + address)
    b.wait("document.documentElement && document.documentElement.dataset.ready !== undefined", 60)


for size in ((1280, 760), (400, 760)):
    with Browser(width=size[0], height=size[1]) as b:
        b.media(prefers_reduced_motion="reduce")
        shown(b, "#")
        rows = b.run("[...document.querySelectorAll('#rows button')].map((row) => row.textContent)")
        check(len(rows) == 2 and "clash" in rows[0] and "contained" in rows[1], f"rows {rows}")
        check(b.text("headline") == "3 of 3 pairs of parts examined; 1 clash, 1 contained", "the headline")
        check("the other parts" in b.text("legend"), "the legend has both colours")
        zoom = b.run("farcull.view.camera.zoom")
        b.run("document.querySelectorAll('#rows button')[0].click()")
        check(b.run("farcull.state.row") == 0 and b.run("farcull.view.camera.zoom") > zoom, "a click flies there")
        check("the surfaces cross" in b.text("legend"), "the legend names the curve")
        check(b.run("farcull.view.scene.children.some((o) => o.isLineSegments && o.renderOrder === 9)"), "the curve is drawn")
        seen = "[0, 1, 2].map((o) => farcull.view.places.image.data[4 * o + 3] > 0.1)"
        before = b.run(seen)
        b.run("document.getElementById('through').click()")
        check(sum(b.run(seen)) == sum(before) + 1, f"one of the two is seen through: {before}, {b.run(seen)}")
        b.run("document.getElementById('through').click()")
        b.run("document.getElementById('canvas').focus()")
        b.key("n")
        check(b.run("farcull.state.row") == 1 and "cross" not in b.text("legend"), "n shows the next pair")
        ghosts = b.run(seen)
        check(ghosts == [True, True, False], f"the part inside is seen: {ghosts}")
        check(b.run("farcull.view.camera.zoom * farcull.view.boxes[0].getSize(new THREE.Vector3()).length()") < 2, "the part around it stays in sight")
        b.run("(() => { const s = document.getElementById('search'); s.value = 'clash'; s.dispatchEvent(new Event('input')); })()")
        check(b.run("document.querySelectorAll('#rows button').length") == 1, "the search")
        check(b.run("document.documentElement.scrollWidth <= innerWidth"), f"nothing is wider than the window at {size}")
        check(not b.problems, f"problems {b.problems}")
        shown(b, "#row=1")
        check(b.run("farcull.state.row") == 1, "the address chooses a pair")
        shown(b, "#row=7")
        check(b.run("farcull.state.row") == -1, "an address of no pair")
        shown(b, "#row=0", 2)
        check("nearest points" in b.text("legend"), "the legend names the line between near parts")
        check(b.run("farcull.view.scene.children.some((o) => o.isLineSegments && o.renderOrder === 9)"), "the line is drawn")
print(f"clash_page_test.py: {len(failures)} failed")
sys.exit(bool(failures))
