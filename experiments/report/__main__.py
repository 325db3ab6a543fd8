"""`python3 report DIR CONTEXT [--no-pictures] [--device DEVICE]`: writes DIR/report. `farcull report` starts it, after
it has checked the store in DIR. CONTEXT is JSON: the program, its commit, the studies and constants.

The folder DIR/report replaces an earlier report, and is complete or missing. A folder of that name which is no report is
left alone. Exit status: 0 done; 1 a promise is broken, and the report says so; 2 no report was made, and a line says why.
"""
import argparse
import datetime
import fcntl
import json
import logging
import os
import pathlib
import shutil
import signal
import subprocess
import sys

# Counts of a row. A method with a guarantee breaks the guarantee if one of these counts in its rows is above 0.
BROKEN = ("missed", "missed_pairs", "wrong", "violations", "refused", "unanswered", "not_asked", "crashed", "hung", "no_memory")
FIRST, LAST = ["headline", "error-time", "accuracy"], ["scenes"]  # first and last chapters; the rest are in the order of studies


class Refusal(Exception):
    """An error: its place, what is wrong there, and what the user can do next."""

    def __init__(self, where, reason, remedy):
        super().__init__(f"{where}: {reason}; {remedy}")
        self.where, self.reason = where, reason


class Interrupted(BaseException):
    """Raised by a signal that ends the program."""


try:
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # hides matplotlib's messages about cache folders
    import pandas as pd
    import draw
    import frame
    import pages
    from chapters import devices
    from draw import legible
    from estimates import counted
    from frame import Chapter, Damaged, command_of, describe, promising, value
    from store import Store, other_devices
except ImportError as error:
    print(f"farcull: {error.name}: is not there for {sys.executable}; install it (Debian: python3-matplotlib "
          "python3-pandas), or run experiments/setup.sh", file=sys.stderr)
    sys.exit(2)


# ---- the folder of the report

def check_place(place):
    """Raises Refusal if the place holds anything but an earlier report or an empty folder."""
    if not os.path.lexists(place):
        return
    try:
        known = pages.MARK in (place / "index.html").read_text(encoding="utf-8", errors="replace")
    except OSError:
        known = place.is_dir() and not any(place.iterdir())
    if not known or place.is_symlink():
        raise Refusal(place, "is there and no report of this program", "move it away")


class Unfinished:
    """The folder .report-unfinished, in which a report is made. publish() puts the folder in place; an unpublished folder is
    removed at the end. A lock keeps other processes from making a report of the same results, so folders that a killed process
    left can be removed."""

    def __init__(self, results):
        self.place, self.path, self.old = (results / name for name in ("report", ".report-unfinished", ".report-old"))
        self.lock = os.open(results, os.O_RDONLY | os.O_CLOEXEC | os.O_DIRECTORY)  # the lock is released when the process ends

    def __enter__(self):
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise Refusal(self.place, "is made by another process", "wait for its end") from error
        try:
            self.__exit__()
            for name in ("figures", "tables"):
                (self.path / name).mkdir(parents=True)
        except OSError as error:
            raise Refusal(self.place, f"cannot be made: {error.strerror}",
                          "use a folder with room that you may write to") from error
        return self

    def publish(self):
        try:
            if self.place.exists():
                self.place.rename(self.old)
            self.path.rename(self.place)
        except OSError as error:
            raise Refusal(self.place, f"cannot be put in place: {error.strerror}", "see who may write to the folder") from error

    def __exit__(self, *_):
        if self.old.exists() and not self.place.exists():  # true if a process was killed between the two steps of publish()
            self.old.rename(self.place)
        for path in (self.path, self.old):
            shutil.rmtree(path, ignore_errors=True)


# ---- contents of the report

class Reporter:
    def __init__(self, arguments, context, store):
        self.arguments, self.context, self.store = arguments, context, store
        self.broken, self.counts = [], dict.fromkeys(("figure", "table", "picture"), 0)
        self.others, self.notes = other_devices(arguments.folder, store)
        now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
        self.page = pages.Page(arguments.folder, context["commit"], now, store.runs)
        self.terminal = sys.stderr.isatty() and os.environ.get("TERM", "dumb") != "dumb"

    def say(self, what=""):
        if self.terminal:
            print(f"\r\033[K{what}", end="", file=sys.stderr, flush=True)

    def fill(self, study):
        """Makes the chapter of a study, with its broken promises first."""
        known = next((known for known in self.context["studies"] if known["name"] == study.name), None)
        if known is None:
            raise Refusal("report", f"'{study.name}' is no study that this program reports", "use the farcull that measured it")
        chapter = Chapter(study.name, known["title"], known["question"], command_of(study, self.store.runs))
        frame.fill(chapter, study)
        others = [(other.device, other.study(study.name, study.constants)) for other in self.others if study.name in other.names]
        devices.fill(chapter, study, self.store.device, others)
        chapter.findings.sort(key=lambda finding: not finding[0])
        before = len(self.broken)
        for where, of in [("", study)] + [(f" on {device}", of) for device, of in others]:
            self.broken += [f"{study.name}{where}: {describe(row)}" for row in promising(of.rows).itertuples()
                            if any(value(row, name) > 0 for name in BROKEN)]
        # A chapter may find a broken guarantee although each row is right, for example if energy grew.
        if len(self.broken) == before:
            self.broken += [f"{study.name}: {text}" for broken, text in chapter.findings if broken]
        if not study.complete:
            self.notes.append(f"{study.name}: {len(study.all_rows)} of {len(study.points)} points have a row")
        self.page.chapters.append(pages.Drawn(chapter, study))

    def draw(self, drawn, root):
        chapter = drawn.chapter
        for figure in chapter.figures:
            self.say("drawing " + figure.name)
            legible(figure)
            files = draw.files_of(figure)
            for kind, content in files.items():
                write(root / "figures" / f"{figure.name}.{kind}", content)
            drawn.svgs.append(files["svg"])
        for table in chapter.tables:
            write(root / "tables" / (table.name + ".csv"), pages.table_csv(table))
            write(root / "tables" / (table.name + ".tex"), pages.table_latex(table))
        write(root / "tables" / (chapter.study + "-rows.csv"), pages.rows_csv(drawn.study))
        for name, text in chapter.files.items():
            write(root / name, text)
        drawn.pictures = [self.picture(picture, root) for picture in chapter.pictures]
        self.counts["figure"] += len(chapter.figures)
        self.counts["table"] += len(chapter.tables)

    def picture(self, picture, root):
        """Makes a picture. Adds the promises that the picture's run broke."""
        self.say("picture " + picture.name)
        out, path = pages.DrawnPicture(picture), root / "pictures" / (picture.name + ".png")
        try:
            if self.arguments.no_pictures:
                raise Refusal("--no-pictures", "was given", "leave it out")
            path.parent.mkdir(exist_ok=True)
            self.broken += [f"in the picture {picture.name}, {line}" for line in self.run_picture(picture, path)]
            out.png = path.read_bytes()
            self.counts["picture"] += 1
        except Refusal as error:
            out.left_out = f"{error.where} {error.reason}"
            self.notes.append(f"picture {picture.name} is left out: {out.left_out}")
        return out

    def run_picture(self, picture, path):
        """Runs `farcull picture`. Returns the lines that it printed about broken promises."""
        device = ["--device", self.arguments.device] if self.arguments.device is not None else []
        done = subprocess.run([self.context["program"], "picture", *picture.arguments, *device, "-o", path],
                              capture_output=True, stdin=subprocess.DEVNULL, text=True, errors="replace")
        lines = [line.removeprefix("farcull: ") for line in done.stderr.splitlines()]
        if done.returncode not in (0, 1):
            where, _, reason = (lines or ["farcull picture: failed"])[-1].partition(": ")
            raise Refusal(where, reason.split("; ")[0], "")
        return lines if done.returncode == 1 else []

    def tell(self):
        counts = [counted(len(self.page.chapters), "study", "studies"),
                  *(counted(n, one, one + "s") for one, n in self.counts.items())]
        print("".join(note + "\n" for note in self.notes) + ", ".join(counts) +
              f"\n{self.arguments.folder}/report/index.html", flush=True)
        for broken in self.broken:
            line = f"farcull: a promise is broken: {broken}"
            colour = self.terminal and not os.environ.get("NO_COLOR")
            print(f"\033[1;31m{line}\033[0m" if colour else line, file=sys.stderr)
        return 1 if self.broken else 0


def write(path, content):
    """Writes a file; the content is a text or bytes."""
    try:
        path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8", "surrogateescape"))
    except OSError as error:
        raise Refusal(path, f"cannot be written: {error.strerror}", "make room on the disk") from error


# ---- the command

def report(arguments):
    context = json.loads(arguments.context)
    store = Store(arguments.folder)
    order = [*FIRST, *(known["name"] for known in context["studies"])]
    names = sorted(store.names, key=lambda name: (name in LAST, order.index(name) if name in order else len(order)))
    studies = [store.study(name, context["constants"]) for name in names]
    if not any(len(study.all_rows) for study in studies):
        raise Refusal(store.path, "holds no row yet", "measure first, as in farcull experiment all --quick")
    results = pathlib.Path(arguments.folder)
    check_place(results / "report")
    with Unfinished(results) as unfinished:
        reporter = Reporter(arguments, context, store)
        for study in studies:
            reporter.fill(study)
        for drawn in reporter.page.chapters:
            reporter.draw(drawn, unfinished.path)
        write(unfinished.path / "index.html", pages.page_html(reporter.page))
        write(unfinished.path / "results.md", pages.page_markdown(reporter.page))
        reporter.say()
        unfinished.publish()
    return reporter.tell()


def main():
    def interrupt(number, _):
        raise Interrupted(number)

    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("context")
    parser.add_argument("--no-pictures", action="store_true")
    parser.add_argument("--device")
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, interrupt)
    sys.stdout.reconfigure(encoding="utf-8", errors="surrogateescape")
    sys.stderr.reconfigure(encoding="utf-8", errors="surrogateescape")
    try:
        return report(parser.parse_args())
    except Interrupted as ended:
        signal.signal(ended.args[0], signal.SIG_DFL)
        os.kill(os.getpid(), ended.args[0])
    except Refusal as error:
        print(f"farcull: {error}", file=sys.stderr)
    except Damaged as error:
        print(f"farcull: {sys.argv[1]}/results.sqlite: is damaged: {error}; use the farcull that measured it", file=sys.stderr)
    except OSError as error:
        print(f"farcull: {error.filename or 'the report'}: cannot be written: {error.strerror}; make room on the disk",
              file=sys.stderr)
    except pd.errors.DatabaseError as error:
        print(f"farcull: {sys.argv[1]}/results.sqlite: {error.__cause__}; wait for its end, or name another folder",
              file=sys.stderr)
    return 2


sys.exit(main())
