"""`farcull report` as a whole: from stores with made-up rows of all studies (farcull_report_fixture) to a folder that
LaTeX and people read. FARCULL_PROGRAM, FARCULL_REPORT_FIXTURE: the two programs."""
import hashlib
import itertools
import os
import re
import resource
import shutil
import signal
import sqlite3
import subprocess
import time

import pytest

from made_up import CONSTANTS, importlib  # first, since it finds the modules of the report
import draw
from draw import legible
from frame import Chapter, fill
from store import Store

PROGRAM, FIXTURE = os.environ["FARCULL_PROGRAM"], os.environ["FARCULL_REPORT_FIXTURE"]
# In place of Python: the same program with another draw.files_of(figure).
PATCHED = """#!/bin/sh
exec /usr/bin/python3 -B -c '
import os, runpy, sys, time
sys.path.insert(0, sys.argv[2])
import draw
real = draw.files_of
def files_of(figure):
    {body}
draw.files_of, sys.argv = files_of, sys.argv[2:]
runpy.run_path(sys.argv[0], run_name="__main__")' "$@"
"""
NOTHING_DRAWN = 'return {"svg": "<svg></svg>"}'


def made(folder, part=""):
    subprocess.run([FIXTURE, folder, *([part] if part else [])], check=True)
    return folder


def small(folder):
    """A store of one study, which is reported soon."""
    made(folder)
    database = sqlite3.connect(folder / "results.sqlite")
    for name in ("rows", "points", "studies"):
        database.execute(f"DELETE FROM {name} WHERE study != 'cloth'")
    database.commit()
    return folder


def report(folder, *more, **environment):
    done = subprocess.run([PROGRAM, "report", "--no-pictures", folder, *more], capture_output=True, text=True,
                          env={**os.environ, **environment})
    done.stderr = re.sub(r"\n {9}(?=\S)", " ", done.stderr)  # a message on one line again
    return done


def patched(folder, body):
    path = folder / "python"
    path.write_text(PATCHED.format(body=body))
    path.chmod(0o755)
    return str(path)


def sum_of(folder):
    return {p.name: hashlib.md5(p.read_bytes()).hexdigest() for p in folder.rglob("*") if p.is_file()}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = made(tmp_path_factory.mktemp("whole") / "results")
    done = report(folder)
    assert (done.returncode, done.stderr) == (0, "") and done.stdout.endswith("/report/index.html\n")
    return folder / "report"


@pytest.fixture(scope="module")
def one(tmp_path_factory):
    folder = small(tmp_path_factory.mktemp("one") / "results")
    assert report(folder).returncode == 0
    return folder


def overlapping(figure):
    """What is wrong with the texts of a figure: pairs that overlap, those that leave it, those below 8 pt."""
    canvas = draw.Drawer(figure).canvas
    canvas.canvas.draw()
    texts = [(text, text.get_window_extent()) for text in canvas.findobj(draw.matplotlib.text.Text)
             if text.get_visible() and text.get_text().strip() and text.get_window_extent().width > 0]
    texts = list({(t.get_text(), tuple(b.bounds)): (t, b) for t, b in texts}.values())
    out = [f"{a.get_text()} | {b.get_text()}" for (a, box), (b, other) in itertools.combinations(texts, 2)
           if min(box.x1, other.x1) - max(box.x0, other.x0) > 1 and min(box.y1, other.y1) - max(box.y0, other.y0) > 1.5]
    out += [f"outside: {t.get_text()}" for t, b in texts if b.x0 < -1 or b.x1 > canvas.bbox.x1 + 1 or
            b.y0 < -1 or b.y1 > canvas.bbox.y1 + 1]
    out += [f"small: {t.get_text()}" for t, _ in texts if t.get_fontsize() < 8]
    draw.pyplot.close(canvas)
    return out


def test_text_of_figures_is_legible(whole, monkeypatch):
    """Every figure of every study; text in a drawing of 170 mm has 8 pt."""
    store, seen = Store(whole.parent), []
    for name in store.names:
        chapter = Chapter(name, "", "", "")
        fill(chapter, store.study(name, CONSTANTS))
        for figure in chapter.figures:
            legible(figure)
            assert overlapping(figure) == [], figure.name
            assert max(len(panel.series) for panel in figure.panels) <= 6 and " n" in figure.caption, figure.name
            seen.append(figure)
    assert len(seen) == len(list((whole / "figures").glob("*.svg"))) > 15
    figure = max(seen, key=lambda f: len(draw.names_of(f)))
    # The twins: lines that are too near, and letters that are too small.
    monkeypatch.setitem(draw.matplotlib.rcParams, "font.size", 8)
    monkeypatch.setattr(draw.pyplot, "figure", lambda figsize, layout, real=draw.pyplot.figure: real(
        figsize=[side / 2 for side in figsize], layout=layout))
    assert any(" | " in wrong for wrong in overlapping(figure))
    monkeypatch.undo()
    monkeypatch.setitem(draw.matplotlib.rcParams, "font.size", 6)
    assert any(wrong.startswith("small") for wrong in overlapping(figure))


def test_files(whole, one):
    for kind in ("svg", "pdf", "csv"):
        assert all(p.stat().st_size for p in (whole / "figures").glob("*." + kind))
        assert len(list((whole / "figures").glob("*." + kind))) == len(list((whole / "figures").glob("*.svg")))
    for name in ("results.md", "tables/libraries-families.csv", "tables/accuracy-rows.csv", "tables/accuracy-forms.tex"):
        assert (whole / name).exists(), name
    page = (whole / "index.html").read_text()
    assert "<script" not in page and not re.search(r"""(src|href)=["'][a-z]+://(?!www.w3.org)""", page)
    for to in set(re.findall(' href="([^"#:]+)"', page)):
        assert (whole / to).exists(), "a link leads to a file that is there"
    ids = re.findall(' id="([^"]*)"', page)
    assert len(ids) == len(set(ids)) and len(re.findall("<figure ", page)) >= len(list((whole / "figures").glob("*.svg")))
    before = sum_of(one / "report" / "figures")
    assert report(one).returncode == 0 and sum_of(one / "report" / "figures") == before, "files do not differ by the day"


def test_the_first_page_and_the_length_of_the_report(whole):
    text = (whole / "results.md").read_text()
    front, *chapters = text.split("\n## ")
    assert front.index("figures/headline.svg") < front.index("| CULLIDE as published") < front.index("\n- Of the pairs")
    assert front.index("\n- Of the pairs") < front.index("All of this page is made") and "headline" not in chapters[0]
    # The studies of `all`, without campaigns.
    campaigns = ("8. A stiff", "11. What other", "12. Potential", "13. A model")
    assert len(front.split()) + sum(len(of.split()) for of in chapters if not of.startswith(campaigns)) <= 7000
    assert sum(of.startswith(campaigns) for of in chapters) == 4 and len(text.split()) > 7000, "the twin: with them it is longer"


def test_an_incomplete_store_is_told(tmp_path):
    folder = made(tmp_path / "r", "some")
    done = report(folder, FARCULL_PYTHON=patched(tmp_path, NOTHING_DRAWN))
    assert done.returncode == 0 and "points have a row" in done.stdout
    assert "<li>Incomplete: " in (folder / "report/index.html").read_text()


@pytest.mark.parametrize("part, studies", [
    ("broken", ["accuracy", "error-time", "radius", "offsets", "precision", "culling", "stability", "cloth", "efficiency",
                "scaling"]), ("unconverged", ["cloth"])])
def test_a_broken_promise_is_the_first_that_is_said(tmp_path, whole, part, studies):
    folder = made(tmp_path / "r", part)
    done = report(folder, FARCULL_PYTHON=patched(tmp_path, NOTHING_DRAWN))
    assert done.returncode == 1
    page, first = (folder / "report/index.html").read_text(), (folder / "report/results.md").read_text()
    for study in studies:
        assert f"a promise is broken: {study}: " in done.stderr
    assert all("BROKEN:" in text.split("All of this page")[0] for text in (page, first))
    assert "BROKEN:" not in (whole / "index.html").read_text(), "the twin"


@pytest.mark.parametrize("part, said", [("shard", "farcull merge"), ("foreign", "unheard-of"), (None, "no folder of results"),
                                        ("empty", "no results.sqlite")])
def test_stores_that_are_refused(tmp_path, part, said):
    folder = tmp_path / "r"
    if part == "empty":
        folder.mkdir()
    elif part:
        made(folder, part)
    done = report(folder)
    assert done.returncode == 2 and said in done.stderr and done.stderr.count("\n") == 1
    assert not list(tmp_path.rglob("report*"))


def test_a_report_appears_whole_or_not_at_all(one, tmp_path):
    before = sum_of(one / "report")
    nothing = tmp_path / "bare"
    nothing.write_text('#!/bin/sh\nexec /usr/bin/python3 -S "$@"\n')
    nothing.chmod(0o755)
    for environment, said in (({"FARCULL_PYTHON": "/nonexistent"}, "cannot be run: .*python3-matplotlib python3-pandas"),
                              ({"FARCULL_PYTHON": str(nothing)}, "is not there for .*python3-matplotlib python3-pandas")):
        done = report(one, **environment)
        assert done.returncode == 2 and re.search("farcull: .*" + said, done.stderr)
    # A disk that takes no more: no file may have more than 4 kB.
    full = subprocess.run([PROGRAM, "report", "--no-pictures", one], capture_output=True, text=True, preexec_fn=lambda: (
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN), resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))))
    assert full.returncode == 2 and "cannot be written: File too large; make room" in full.stderr
    assert sum_of(one / "report") == before and not list(one.glob(".report-*"))
    mine = small(tmp_path / "mine")
    (mine / "report").mkdir()
    (mine / "report/notes.txt").write_text("mine")
    done = report(mine)
    assert done.returncode == 2 and "no report of this program" in done.stderr
    assert (mine / "report/notes.txt").read_text() == "mine"


def started(folder, python, *wait_for):
    """A report that is being drawn."""
    process = subprocess.Popen([PROGRAM, "report", "--no-pictures", folder], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL, env={**os.environ, "FARCULL_PYTHON": python})
    for _ in range(600):
        if all(path.exists() for path in wait_for):
            return process
        time.sleep(0.1)
    raise TimeoutError


def test_reports_that_are_ended(one, tmp_path):
    drawing = tmp_path / "drawing"
    body = f'open("{drawing}", "w")\n    time.sleep(60)'
    python, before = patched(tmp_path, body), sum_of(one / "report")
    process = started(one, python, drawing)
    process.send_signal(signal.SIGTERM)
    assert process.wait() == -signal.SIGTERM
    assert sum_of(one / "report") == before and not list(one.glob(".report-*"))
    # Killed: the next report takes that away.
    drawing.unlink()
    process = started(one, python, drawing)
    process.kill()
    process.wait()
    assert report(one).returncode == 0 and not list(one.glob(".report-*"))


TABLES = r"""\documentclass[a4paper]{article}
\usepackage{booktabs,graphicx}\usepackage[margin=25mm]{geometry}\setcounter{totalnumber}{18}
\begin{document}
%s\end{document}
"""


def compiled(folder):
    """None, or what pdflatex says first about all tables."""
    (folder / "report.tex").write_text(TABLES % "".join(
        f"{{\\footnotesize\\input{{tables/{path.name}}}}}\\clearpage\n" for path in sorted((folder / "tables").glob("*.tex"))))
    done = subprocess.run(["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape",
                           "-file-line-error", "report.tex"], cwd=folder, capture_output=True, text=True, errors="replace")
    return None if done.returncode == 0 else re.search(r"^(\S+:\d+: |!).*", done.stdout, re.M).group(0)


def off_page(folder):
    log = (folder / "report.log").read_text(errors="replace")
    return re.findall("Float too large|Missing character", log) + [
        w for w in re.findall(r"Overfull \\hbox \(([0-9.]+)pt", log) if float(w) > 20]


@pytest.mark.skipif(not shutil.which("pdflatex"), reason="no pdflatex (Debian: texlive-latex-base)")
def test_latex_compiles(whole, tmp_path):
    shutil.copytree(whole, tmp_path / "tex")
    folder = tmp_path / "tex"
    assert compiled(folder) is None and off_page(folder) == []
    for path in (folder / "tables").glob("*.tex"):  # the twin: tables that are not scaled to the width of the text
        path.write_text(re.sub(r"\\ifdim.*\\fi}{!}", r"\\width}{!}", path.read_text()))
    assert compiled(folder) is None and off_page(folder)
