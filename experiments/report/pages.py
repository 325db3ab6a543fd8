"""The report as one self-contained page of HTML, and as results.md: broken promises first, then a section for each
chapter. section() writes a chapter in both forms."""
import base64
import collections
import os
import re
import shlex
from dataclasses import dataclass, field

from draw import inline_svg
from estimates import counted, grouped, listed, of_all, sentence
from frame import Table, columns
from tables import html_prose, html_text, table_html

MARK = '<meta name="generator" content="farcull report">'  # marks an index.html of this program


@dataclass
class DrawnPicture:
    picture: object
    png: bytes = b""      # empty if there is none
    left_out: str = ""    # why it was left out

    @property
    def command(self):
        return shlex.join(["farcull", "picture", *self.picture.arguments])


@dataclass
class Drawn:
    """A chapter with everything that was made for it."""
    chapter: object
    study: object
    svgs: list = field(default_factory=list)
    pictures: list = field(default_factory=list)


@dataclass
class Page:
    store: str
    folder: str
    commit: str
    written: str
    runs: object  # rows of the table `runs`
    chapters: list = field(default_factory=list)


def printed(finding):
    return sentence(("BROKEN: " if finding[0] else "") + finding[1])


def broken(page):
    return [(d.chapter, f) for d in page.chapters for f in d.chapter.findings if f[0]]


def rows_of_runs(page):
    """The number of rows of each run."""
    return collections.Counter(run for drawn in page.chapters for run in drawn.study.all_rows.run)


def runs_table(page):
    rows = rows_of_runs(page)
    return Table("runs", "", columns(
        ["run", "started", "commit", "device", "driver", "CPU"], ["cores"], ["options"], ["rows"]), [
        [str(run.run), run.started, run.commit_id, run.gl_renderer,
         f"{run.gl_vendor}, {run.gl_version}" if run.gl_vendor or run.gl_version else "none", run.cpu, str(run.cores),
         "`" + run.options.replace("`", "\\u0060") + "`", grouped(rows[run.run])]
        for run in page.runs.itertuples() if run.run in rows])


# ---- the parts of a section in each form

class Html:
    @staticmethod
    def opening(number, chapter):
        return (f'<section id="{chapter.study}" class="study">\n<h2>{number}. {html_text(chapter.title)}</h2>\n<p '
                f'class="question">{html_prose(chapter.question)}</p>\n')

    @staticmethod
    def warning(text):
        return f'<p class="warning" role="note"><strong>Incomplete.</strong> {html_prose(text)}</p>\n'

    @staticmethod
    def items(title, sentences):
        items = "".join(f"<li>{html_prose(sentence(text))}</li>\n" for text in sentences)
        return f"<h3>{title}</h3>\n<ul>\n{items}</ul>\n" if items else ""

    @staticmethod
    def left_out(text):
        return f'<p class="note" role="note">{html_prose(text)}</p>\n'

    @staticmethod
    def picture(label, drawn, caption):
        name = drawn.picture.name
        return (f'<figure id="pic-{name}">\n<img src="data:image/png;base64,{base64.b64encode(drawn.png).decode()}" '
                f'alt="{html_text(drawn.picture.title)}">\n<figcaption><strong>{label}</strong> {html_prose(caption)} '
                f'<span class="files"><a href="pictures/{name}.png">PNG</a></span></figcaption>\n</figure>\n')

    @staticmethod
    def figure(label, figure, svg, caption):
        name = figure.name
        links = " ".join(f'<a href="figures/{name}.{kind}">{kind.upper()}</a>' for kind in ("svg", "pdf", "csv"))
        return (f'<figure id="fig-{name}">\n<div class="drawing{" narrow" if figure.narrow else ""}" role="img" '
                f'aria-label="{html_text(figure.title)}" tabindex="0">{inline_svg(svg, name + "-")}</div>\n<figcaption>'
                f'<strong>{html_text(label)}</strong> {html_prose(caption)} <span class="files">{links}</span>'
                '</figcaption>\n</figure>\n')

    @staticmethod
    def table(label, table):
        links = " ".join(f'<a href="tables/{table.name}.{kind}">{name}</a>' for kind, name in (
            ("csv", "CSV"), ("tex", "LaTeX")))
        return (f'<figure id="tab-{table.name}" class="table">\n<figcaption><strong>{label}</strong> '
                f'{html_prose(sentence(table.caption))} <span class="files">{links}</span></figcaption>\n<div class="cells" '
                f'tabindex="0" role="region" aria-label="{label}">\n{table_html(table)}</div>\n</figure>\n')

    @staticmethod
    def closing(again, rows):
        return f'<p class="again">{html_prose(again)} Every row: <a href="tables/{rows}">{rows}</a>.</p>\n</section>\n'


def markdown_prose(text):
    """Escapes signs of Markdown, except in code; a bar is escaped in code too, where it also ends a cell."""
    parts = re.split("(`[^`]*`)", re.sub(r"[\n\r]", " ", text))
    return "".join(part.replace("|", "\\|") if part[:1] == "`" and len(part) > 1
                   else re.sub(r"([\\*_<>|\[\]#`])", r"\\\1", part) for part in parts)


def bullets(sentences):
    items = "".join(f"- {markdown_prose(sentence(text))}\n" for text in sentences)
    return items + "\n" if items else ""


def markdown_table(table):
    def line(cells):
        return "| " + " | ".join(markdown_prose(cell) for cell in cells) + " |\n"

    sides = "".join("---:|" if side == "r" else "---|" for _, side in table.columns)
    return line(name for name, _ in table.columns) + f"|{sides}\n" + "".join(map(line, table.rows)) + "\n"


class Markdown:
    @staticmethod
    def opening(number, chapter):
        return f"## {number}. {markdown_prose(chapter.title)}\n\n{markdown_prose(chapter.question)}\n\n"

    @staticmethod
    def warning(text):
        return bullets(["Incomplete: " + text])

    @staticmethod
    def items(title, sentences):
        return f"{title}:\n\n{bullets(sentences)}" if sentences else ""

    @staticmethod
    def left_out(text):
        return markdown_prose(text) + "\n\n"

    @staticmethod
    def picture(label, drawn, caption):
        alt, name = markdown_prose(drawn.picture.title), drawn.picture.name
        return f"![{alt}](pictures/{name}.png)\n\n**{label}** {markdown_prose(caption)}\n\n"

    @staticmethod
    def figure(label, figure, _, caption):
        return (f"![{markdown_prose(figure.title)}](figures/{figure.name}.svg)\n\n**{markdown_prose(label)}** "
                f"{markdown_prose(caption)}\n\n")

    @staticmethod
    def table(label, table):
        return f"**{label}** {markdown_prose(sentence(table.caption))}\n\n{markdown_table(table)}"

    @staticmethod
    def closing(again, _):
        return markdown_prose(again) + "\n\n"


def section(form, number, drawn, count):
    """A chapter. count: how many figures and tables the page has so far."""
    def label(kind, title=""):
        count[kind] += 1
        return f"{kind} {count[kind]}.{title and ' ' + sentence(title)}"

    chapter, study = drawn.chapter, drawn.study
    out = form.opening(number, chapter)
    if not study.complete:
        out += form.warning(f"{of_all(len(study.all_rows), len(study.points))} points have a row; findings, figures and "
                            "tables are of these.")
    out += form.items("What it shows", [printed(finding) for finding in chapter.findings])
    for p in drawn.pictures:
        caption = f"{sentence(p.picture.caption)} Drawn by `{p.command}`."
        out += (form.picture(label("Figure", p.picture.title), p, caption) if p.png else
                form.left_out(sentence(f"A picture (`{p.command}`) is left out: {p.left_out}")))
    for f, svg in zip(chapter.figures, drawn.svgs):
        out += form.figure(label("Figure", f.title), f, svg, f"{sentence(f.caption)} Measured by `{chapter.command}`.")
    for t in chapter.tables:
        out += form.table(label("Table"), t)
    out += form.items("What it does not show", chapter.limits)
    return out + form.closing(
        f"Measured by `{chapter.command}` ({'quick' if study.quick else 'full'} grid, seed {study.seed}, "
        f"{of_all(len(study.all_rows), len(study.points))} points), drawn by `farcull report`.", study.name + "-rows.csv")


# ---- the pages

def linked_items(kind, pairs):
    """A list of sentences that lead to the section of their chapter."""
    items = "".join(f'<li><a href="#{chapter.study}">{html_text(chapter.title)}</a>: '
                    f'{html_prose(printed(finding))}</li>\n' for chapter, finding in pairs)
    return f'<ul class="{kind}">\n{items}</ul>\n' if items else ""


def summary_html(page):
    studies = [d.study for d in page.chapters]
    rows, points = (sum(len(getattr(study, of)) for study in studies) for of in ("all_rows", "points"))
    missing, out = [study.name for study in studies if not study.complete], ""
    if missing:
        out += Html.warning(f"{of_all(rows, points)} points have a row; rows are missing in {listed(missing)}. What follows "
                            "is of the rows that are there. `farcull experiment NAME --resume` measures the others.")
    out += '<section id="summary">\n<h2>Summary</h2>\n'
    # The claim of the rows, or none.
    claim = ("FAR culls with graphics hardware and never misses a pair that collides; CULLIDE, "
             "from which it comes, can.")
    if broken(page):
        claim = "FAR and CULLIDE cull with graphics hardware."
        out += ('<p class="warning" role="note"><strong>Broken.</strong> What must never happen has happened:</p>\n' +
                linked_items("broken", broken(page)))
    grids = {study.quick for study in studies}
    kind = ("quick grids and full ones" if len(grids) > 1 else "of quick grids, which are made for a first look" if
            True in grids else "of full grids")
    runs = page.runs[page.runs.run.isin(list(rows_of_runs(page)))]
    machines = dict.fromkeys(f"{run.gl_renderer} on {run.cpu} ({run.cores} cores)" for run in runs.itertuples())
    firsts = [(d.chapter, next((f for f in d.chapter.findings if not f[0]), None)) for d in page.chapters]
    return (f"{out}<p>{claim} This page reports {counted(len(studies), 'study', 'studies')} on "
            f"{html_text(listed(machines))}: {counted(rows, 'row', 'rows')}, {kind}. All its numbers come from "
            f"<code>{html_text(page.store)}</code>. Counts are the same, bit for bit, on the same device and CPU features; "
            f"times are of this machine.</p>\n{linked_items('findings', [pair for pair in firsts if pair[1]])}</section>\n")


def page_html(page):
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "page.css"), encoding="utf-8") as file:
        css = file.read()
    count = collections.Counter()
    contents = "".join(f'<li><a href="#{d.study.name}">{html_text(d.chapter.title)}</a></li>\n' for d in page.chapters)
    # A browser looks for an icon beside a page without its own.
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'{MARK}\n<title>Reliable collision culling: results</title>\n'
        f'<link rel="icon" href="data:,">\n<style>\n{css}</style>\n</head>\n<body>\n<main>\n'
        '<header>\n<h1>Reliable collision culling: results</h1>\n'
        f'<p class="by">farcull {html_text(page.commit[:12] or "of no commit")}, written {html_text(page.written)}</p>\n'
        f'</header>\n{summary_html(page)}<nav aria-label="Contents">\n<h2>Contents</h2>\n<ol>\n{contents}'
        '<li><a href="#machine">Where it was measured</a></li>\n</ol>\n</nav>\n'
        + "".join(section(Html, i + 1, drawn, count) for i, drawn in enumerate(page.chapters)) +
        '<section id="machine">\n<h2>Where it was measured</h2>\n<div class="cells" tabindex="0" role="region" '
        f'aria-label="Runs">\n{table_html(runs_table(page))}</div>\n<p>This page was made by <code>farcull report</code> '
        f'from {html_text(page.store)}; figures with their numbers, tables as CSV and LaTeX lie beside it in '
        '<code>figures/</code> and <code>tables/</code>. The page itself needs none of them.</p>\n</section>\n'
        '</main>\n</body>\n</html>\n')


def page_markdown(page):
    out, count = "# Results\n\n", collections.Counter()
    if broken(page):
        out += ("**Broken.** What must never happen has happened:\n\n" +
                bullets(f"{chapter.title}: {printed(finding)}" for chapter, finding in broken(page)))
    out += (f"All of this page is made from the store of results by `farcull report {shlex.quote(page.folder)}`, figures, "
            "tables and sentences: no number was typed. A single study is measured again by the command that "
            "stands below it. Counts are the same, bit for bit, on the same device and CPU "
            "features; times are of the machine that stands [at the end](#where-it-was-measured).\n\n")
    out += "".join(section(Markdown, i + 1, drawn, count) for i, drawn in enumerate(page.chapters))
    return out + "## Where it was measured\n\n" + markdown_table(runs_table(page)).rstrip("\n") + "\n"
