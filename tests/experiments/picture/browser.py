# A headless Chromium that a test drives: one tab, over the pipe of its DevTools protocol. Software WebGL
# (SwiftShader).
import base64
import io
import json
import os
import select
import subprocess
import tempfile
import time


class Browser:
    """Use as a context. `problems` grows by what a page must not do: exceptions, lines on the
    console, requests to anything but files and data."""

    def __init__(self, *flags, width=800, height=600):
        self.problems, self.next, self.waiting, self.events = [], 0, {}, []
        self.folder = tempfile.TemporaryDirectory()
        to_it, self.write_end = os.pipe()
        self.read_end, from_it = os.pipe()

        def take_pipes():
            # Copies first: the ends may be 3 or 4 themselves.
            a, b = os.dup(to_it), os.dup(from_it)
            os.dup2(a, 3)
            os.dup2(b, 4)

        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--remote-debugging-pipe", "--use-gl=angle",
             "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage",
             "--no-first-run", "--hide-scrollbars", "--disable-background-networking",
             "--user-data-dir=" + self.folder.name, *flags, "about:blank"],
            close_fds=False, preexec_fn=take_pipes, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(to_it)
        os.close(from_it)
        self.rest, self.session = b"", None
        targets = self.ask("Target.getTargets")["targetInfos"]
        page = next(t for t in targets if t["type"] == "page")
        self.session = self.ask("Target.attachToTarget", targetId=page["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.ask(domain + ".enable")
        self.size(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.session = None
            self.ask("Browser.close")
        except (RuntimeError, OSError, TimeoutError):
            pass
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.write_end)
        os.close(self.read_end)
        self.folder.cleanup()

    def ask(self, method, **params):
        """The result of a command. Raises RuntimeError where the browser refuses."""
        self.next += 1
        number = self.next
        message = {"id": number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.write_end, data):]
        end = time.monotonic() + 120
        while True:
            answer = self.receive(end)
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def receive(self, end):
        while b"\0" not in self.rest:
            if not select.select([self.read_end], [], [], max(0, end - time.monotonic()))[0]:
                raise TimeoutError("the browser does not answer")
            more = os.read(self.read_end, 1 << 20)
            if not more:
                raise RuntimeError("the browser has ended")
            self.rest += more
        text, self.rest = self.rest.split(b"\0", 1)
        message = json.loads(text)
        self.note(message.get("method"), message.get("params", {}))
        return message

    def note(self, method, params):
        if method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.problems.append("exception: " + str(details.get("exception", {}).get("description", details["text"])))
        if method == "Runtime.consoleAPICalled":
            self.problems.append("console: " + " ".join(str(a.get("value", "")) for a in params["args"]))
        if method == "Log.entryAdded":
            self.problems.append("log: " + params["entry"]["text"])
        if method == "Network.requestWillBeSent":
            url = params["request"]["url"]
            if not url.startswith(("file:", "data:", "blob:", "about:")):
                self.problems.append("request: " + url)

    def run(self, script):
        """The value of an expression in the page, promises awaited. Raises RuntimeError where it throws."""
        out = self.ask("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in out:
            raise RuntimeError(str(out["exceptionDetails"]))
        return out["result"].get("value")

    def text(self, name):
        return self.run(f"document.getElementById('{name}').textContent")

    def wait(self, condition, seconds=30):
        """Until the expression is true in the page."""
        end = time.monotonic() + seconds
        while not self.run(condition):
            if time.monotonic() > end:
                raise TimeoutError(f"never became true: {condition}; {self.problems}")
            time.sleep(0.03)

    def open(self, url):
        self.ask("Page.navigate", url="about:blank")
        self.ask("Page.navigate", url=url)

    def size(self, width, height):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                 mobile=False)

    def media(self, media="", **features):
        self.ask("Emulation.setEmulatedMedia", media=media,
                 features=[{"name": n.replace("_", "-"), "value": v} for n, v in features.items()])

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def key(self, key, text=None, shift=False):
        names = {"key": key, "modifiers": 8 if shift else 0}
        self.ask("Input.dispatchKeyEvent", type="keyDown",
                 **({"text": key} if len(key) == 1 else {}), **names)
        self.ask("Input.dispatchKeyEvent", type="keyUp", **names)

    def screenshot(self, box=None):
        """The bytes of a PNG of what the window shows; of a box (left, top, width, height) of it, CSS px."""
        clip = {"optimizeForSpeed": True}
        if box:
            clip["clip"] = dict(zip(("x", "y", "width", "height"), box), scale=1)
        return base64.b64decode(self.ask("Page.captureScreenshot", format="png", **clip)["data"])


class Pixels:
    """The pixels of a PNG of 8 bits a channel, RGB or RGBA."""

    def __init__(self, png):
        import matplotlib.image  # here, since a browser alone does without
        self.rows = (255 * matplotlib.image.imread(io.BytesIO(png))[:, :, :3]).round().astype(int)

    def as_rows(self):
        """The colours, row by row."""
        return [list(map(tuple, row)) for row in self.rows.tolist()]

    def count(self, colour):
        """How many pixels have exactly this colour."""
        return int((self.rows == colour).all(axis=2).sum())
