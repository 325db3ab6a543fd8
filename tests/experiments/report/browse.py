# One headless browser for a script, which asks it line by line; each answer ends with a line "END".
#   probe WIDTH FILE    opens the page in a window WIDTH px wide; the answer is what the page says of itself in its
#                       element "probe-results", and a line "console: ..." for each thing that it must not do
#   pdf FILE PDF        prints the page on paper of its own size
#   shot WIDTH FILE PNG
# A line "FAILED: ..." where the browser does not do it.
import base64
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "picture"))
from browser import Browser  # noqa: E402

SECONDS = 120  # a busy machine takes its time
# The page before stays until the next one is there.
LOADED = "window.before === undefined && document.readyState === 'complete' && location.protocol === 'file:'"


def opened(b, path, width):
    b.size(width, 900)
    b.run("window.before = 1")
    b.problems = []
    b.ask("Page.navigate", url="file://" + path)
    b.wait(LOADED, SECONDS)


def answer(b, words):
    if words[0] == "probe":
        opened(b, words[2], int(words[1]))
        b.wait("document.getElementById('probe-results') !== null", 10)
        said = b.run("document.getElementById('probe-results').textContent").split("\n")
        return [line for line in said if line not in ("", "END")] + [
            "console: " + problem.replace("\n", " ") for problem in b.problems]
    if words[0] == "pdf":
        opened(b, words[1], 1280)
        out = b.ask("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"]
        with open(words[2], "wb") as file:
            file.write(base64.b64decode(out))
        return []
    if words[0] == "shot":
        opened(b, words[2], int(words[1]))
        b.size(int(words[1]), 12000)
        with open(words[3], "wb") as file:
            file.write(b.screenshot())
        return []
    return [f"FAILED: no such question: {words[0]}"]


def main():
    # No host has an address.
    with Browser("--host-resolver-rules=MAP * ~NOTFOUND", "--allow-file-access-from-files") as b:
        for line in sys.stdin:
            try:
                said = answer(b, line.rstrip("\n").split(" "))
            except (RuntimeError, TimeoutError, OSError) as error:
                said = [f"FAILED: {error}".replace("\n", " ")]
            print("\n".join(said + ["END"]), flush=True)


main()
