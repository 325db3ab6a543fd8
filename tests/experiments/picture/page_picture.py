# A screenshot of a page of `farcull picture --html`. docs/pictures/page.png was made so:
#   farcull picture two-bunnies --compare cullide,far --html bunnies.html
#   python3 tests/experiments/picture/page_picture.py bunnies.html docs/pictures/page.png \
#     '#method=cullide&px=512'
# WIDTHxHEIGHT and light or dark may follow. Needs Chromium. A triangle that is missed is chosen
# where the address names none.
import os
import sys

from browser import Browser


def main():
    page, picture, address = sys.argv[1:4]
    width, height = (int(x) for x in (sys.argv[4] if len(sys.argv) > 4 else "1280x760").split("x"))
    theme = sys.argv[5] if len(sys.argv) > 5 else "light"
    with Browser(width=width, height=height) as b:
        b.media(prefers_color_scheme=theme)
        b.open("file://" + os.path.abspath(page) + address)
        b.wait("document.documentElement && document.documentElement.dataset.ready !== undefined", 60)
        if "triangle=" not in address:
            b.run("document.getElementById('canvas').focus()")
            b.key("n")
            b.key("0")
        b.run("new Promise((done) => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)), 300))")
        b.run("document.activeElement.blur()")
        with open(picture, "wb") as file:
            file.write(b.screenshot())
        if b.problems:
            sys.exit(f"the page has problems: {b.problems}")


main()
