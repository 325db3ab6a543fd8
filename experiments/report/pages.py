"""The report as one self-contained page of HTML, as results.md and as report.tex: broken promises
first, then a section for each chapter."""
import base64
import collections
import os
import re
import shlex
from dataclasses import dataclass, field

from draw import inline_svg
from estimates import counted, grouped, listed, sentence
from frame import Table, columns
from tables import html_prose, html_text, latex_text, table_html

MARK = '<meta name="generator" content="farcull report">'  # marks an index.html of this program
PREAMBLE = r"""\documentclass[a4paper]{article}
\usepackage{graphicx}
\usepackage[margin=25mm]{geometry}
\IfFileExists{booktabs.sty}{\usepackage{booktabs}}{%
  \let\toprule\hline \let\midrule\hline \let\bottomrule\hline}
% Tables and figures of a section stay in it, however many they are.
\setcounter{topnumber}{9}\setcounter{bottomnumber}{9}\setcounter{totalnumber}{18}
\sloppy
"""


@dataclass
class DrawnPicture:
    picture: object
    png: bytes = b""      # empty if there is none
    page: bool = False    # whether it has a page, pages/NAME.html
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


def grid_text(study):
    return f"{'quick' if study.quick else 'full'} grid, seed {study.seed}"


def points_text(study):
    return counted(len(study.points), "point", "points")


def caption_of(figure, chapter):
    """The caption with the command that measures what is shown."""
    return f"{sentence(figure.caption)} Measured by `{chapter.command}`."


def driver_text(run):
    if not run.gl_vendor and not run.gl_version:
        return "none"
    return f"{run.gl_vendor}, {run.gl_version}"


def rows_of_runs(page):
    """For each run, the number of its rows in each study."""
    out = collections.defaultdict(collections.Counter)
    for drawn in page.chapters:
        for run in drawn.study.all_rows.run:
            out[run][drawn.study.name] += 1
    return out


def runs_table(page):
    rows = rows_of_runs(page)
    return Table("runs", "", columns(
        ["run", "started", "commit", "device", "driver", "CPU"], ["cores"], ["options"], ["rows"]), [
        [str(run.run), run.started, run.commit_id, run.gl_renderer, driver_text(run), run.cpu, str(run.cores),
         "`" + run.options.replace("`", "\\u0060") + "`", grouped(sum(rows[run.run].values()))]
        for run in page.runs.itertuples() if run.run in rows])


# ---- HTML

def html_items(sentences):
    return "".join(f"<li>{html_prose(sentence(text))}</li>\n" for text in sentences)


def linked_items(pairs):
    """Items that lead to the section of a chapter."""
    return "".join(f'<li><a href="#{chapter.study}">{html_text(chapter.title)}</a>: '
                   f'{html_prose(text)}</li>\n' for chapter, text in pairs)


class HtmlPage:
    def __init__(self, page):
        self.page, self.figures, self.tables = page, 0, 0

    def text(self):
        style = os.path.join(os.path.dirname(os.path.abspath(__file__)), "page.css")
        with open(style, encoding="utf-8") as file:
            css = file.read()
        commit = self.page.commit[:12] or "of no commit"
        # A browser looks for an icon beside a page without its own.
        return (
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f'{MARK}\n<title>Reliable collision culling: results</title>\n'
            f'<link rel="icon" href="data:,">\n<style>\n{css}</style>\n</head>\n<body>\n<main>\n'
            '<header>\n<h1>Reliable collision culling: results</h1>\n'
            f'<p class="by">farcull {html_text(commit)}, written {html_text(self.page.written)}'
            f'</p>\n</header>\n{self.summary()}{self.contents()}'
            + "".join(self.section(i + 1, d) for i, d in enumerate(self.page.chapters))
            + self.machine() + "</main>\n</body>\n</html>\n")

    def machines(self):
        """The devices and CPUs of the runs, each once, in order."""
        runs = self.page.runs[self.page.runs.run.isin(list(rows_of_runs(self.page)))]
        return list(dict.fromkeys(f"{run.gl_renderer} on {run.cpu} ({run.cores} cores)" for run in runs.itertuples()))

    def summary(self):
        drawn = self.page.chapters
        rows = sum(len(d.study.all_rows) for d in drawn)
        points = sum(len(d.study.points) for d in drawn)
        missing = [d.study.name for d in drawn if not d.study.complete]
        out = ""
        if missing:
            what = "the study that shows" if len(missing) == 1 else "the studies that show"
            out += (f'<p class="warning" role="note"><strong>Incomplete.</strong> {grouped(rows)} of {grouped(points)} '
                    f'points have a row; {what} what is missing: {html_text(listed(missing))}. What follows is of the '
                    f'rows that are there. ' '<code>farcull experiment NAME --resume</code> measures the others.</p>\n')
        out += '<section id="summary">\n<h2>Summary</h2>\n'
        # The claim of the rows, or none.
        claim = ("FAR culls with graphics hardware and never misses a pair that collides; CULLIDE, "
                 "from which it comes, can.")
        if broken(self.page):
            claim = "FAR and CULLIDE cull with graphics hardware."
            items = linked_items((c, printed(f)) for c, f in broken(self.page))
            out += ('<p class="warning" role="note"><strong>Broken.</strong> What must never '
                    f'happen has happened:</p>\n<ul class="broken">\n{items}</ul>\n')
        grids = {d.study.quick for d in drawn}
        kind = ("quick grids and full ones" if len(grids) > 1 else "of quick grids, which are made for a first look" if
                True in grids else "of full grids")
        out += (f"<p>{claim} This page reports {counted(len(drawn), 'study', 'studies')} on "
                f"{html_text(listed(self.machines()))}: {counted(rows, 'row', 'rows')}, {kind}. All its numbers come "
                f"from <code>{html_text(self.page.store)}</code>. Counts are " "the same, bit for bit, on the same "
                "device and CPU features; times are of this machine.</p>\n")
        firsts = [(d.chapter, next((f for f in d.chapter.findings if not f[0]), None)) for d in drawn]
        items = linked_items((c, printed(f)) for c, f in firsts if f)
        return out + (f'<ul class="findings">\n{items}</ul>\n' if items else "") + "</section>\n"

    def contents(self):
        items = "".join(f'<li><a href="#{d.study.name}">{html_text(d.chapter.title)}</a></li>\n'
                        for d in self.page.chapters)
        return ('<nav aria-label="Contents">\n<h2>Contents</h2>\n<ol>\n' + items +
                '<li><a href="#machine">Where it was measured</a></li>\n</ol>\n</nav>\n')

    def section(self, number, drawn):
        chapter, study = drawn.chapter, drawn.study
        out = (f'<section id="{chapter.study}" class="study">\n<h2>{number}. {html_text(chapter.title)}</h2>\n<p '
               f'class="question">{html_prose(chapter.question)}</p>\n')
        if not study.complete:
            out += ('<p class="warning" role="note"><strong>Incomplete.</strong> '
                    f'{grouped(len(study.all_rows))} of {grouped(len(study.points))} points have '
                    'a row; findings, figures and tables are of these.</p>\n')
        if chapter.findings:
            out += ("<h3>What it shows</h3>\n<ul>\n" + html_items(printed(f) for f in chapter.findings) + "</ul>\n")
        out += "".join(self.picture(p) for p in drawn.pictures)
        out += "".join(self.figure(f, svg, chapter) for f, svg in zip(chapter.figures, drawn.svgs))
        out += "".join(self.table(t) for t in chapter.tables)
        if chapter.limits:
            out += ("<h3>What it does not show</h3>\n<ul>\n" + html_items(chapter.limits) + "</ul>\n")
        return out + (f'<p class="again">Measured by <code>{html_text(chapter.command)}</code>: {grid_text(study)}, '
                      f'{grouped(len(study.all_rows))} of {points_text(study)}. Every row: <a '
                      f'href="tables/{study.name}-rows.csv">{study.name}-rows.csv</a>.</p>\n</section>\n')

    def figure(self, figure, svg, chapter):
        self.figures += 1
        name = figure.name
        links = " ".join(f'<a href="figures/{name}.{kind}">{kind.upper()}</a>' for kind in ("svg", "pdf", "csv"))
        return (f'<figure id="fig-{name}">\n<div class="drawing{" narrow" if figure.narrow else ""}" role="img" '
                f'aria-label="{html_text(figure.title)}" '
                f'tabindex="0">{inline_svg(svg, name + "-")}</div>\n<figcaption><strong>Figure {self.figures}. '
                f'{html_text(sentence(figure.title))}</strong> {html_prose(caption_of(figure, chapter))} <span '
                f'class="files">{links}</span>' '</figcaption>\n</figure>\n')

    def picture(self, drawn):
        name, command = drawn.picture.name, html_text(drawn.command)
        if not drawn.png:
            return (f'<p class="note" role="note">A picture (<code>{command}</code>) is left out: '
                    f'{html_text(sentence(drawn.left_out))}</p>\n')
        self.figures += 1
        look = f' <a href="pages/{name}.html">look around in it</a>' if drawn.page else ""
        return (f'<figure id="pic-{name}">\n<img src="data:image/png;base64,{base64.b64encode(drawn.png).decode()}" '
                f'alt="{html_text(drawn.picture.caption)}">\n<figcaption><strong>Figure {self.figures}.</strong> '
                f'{html_prose(sentence(drawn.picture.caption))} <span class="files"><code>{command}</code> <a '
                f'href="pictures/{name}.png">PNG</a>{look}</span></figcaption>\n</figure>\n')

    def table(self, table):
        name = table.name
        if not table.in_text:
            return (f'<p class="longer">{html_prose(table.caption)} ({counted(len(table.rows), "row", "rows")}): <a '
                    f'href="tables/{name}.csv">{name}.csv</a>.</p>\n')
        self.tables += 1
        return (f'<figure id="tab-{name}" class="table">\n<figcaption><strong>Table {self.tables}.</strong> '
                f'{html_prose(sentence(table.caption))} <span class="files"><a href="tables/{name}.csv">CSV</a> <a '
                f'href="tables/{name}.tex">LaTeX</a></span></figcaption>\n<div class="cells" tabindex="0" '
                f'role="region" aria-label="Table {self.tables}">\n{table_html(table)}</div>\n</figure>\n')

    def machine(self):
        runs, rows, devices = self.page.runs, rows_of_runs(self.page), collections.Counter()
        for drawn in self.page.chapters:
            devices.update(drawn.study.rows.device)
        features = "".join(f"<p class=\"features\">Run {run.run}: {html_text(run.cpu_features) or 'unknown'}</p>\n"
                           for run in runs[runs.run.isin(list(rows))].itertuples())
        out = ('<section id="machine">\n<h2>Where it was measured</h2>\n<div class="cells" tabindex="0" role="region" '
               f'aria-label="Runs">\n{table_html(runs_table(self.page))}</div>\n<details>\n<summary>CPU '
               f'features</summary>\n{features}</details>\n')
        if devices:
            answered = listed(f"{name or 'none'} ({counted(n, 'row', 'rows')})" for name, n in sorted(devices.items()))
            out += f"<p>What answered: {html_text(answered)}.</p>\n"
        return out + (f"<p>This page was made by <code>farcull report</code> from {html_text(self.page.store)}; "
                      "figures with their numbers, tables as CSV and LaTeX lie beside it in <code>figures/</code> "
                      "and <code>tables/</code>. The page itself needs none of them.</p>\n</section>\n")


# ---- Markdown

def markdown_prose(text):
    """Escapes signs of Markdown, except in code; a bar is escaped in code too, where it also ends a cell."""
    parts = re.split("(`[^`]*`)", re.sub(r"[\n\r]", " ", text))
    return "".join(part.replace("|", "\\|") if part[:1] == "`" and len(part) > 1
                   else re.sub(r"([\\*_<>|\[\]#`])", r"\\\1", part) for part in parts)


def markdown_code(text):
    line = re.sub(r"[\n\r]", " ", text)
    longest = max((len(run) for run in re.findall("`+", line)), default=0)
    fence, blank = "`" * (longest + 1), " " if longest else ""
    return fence + blank + line + blank + fence


def bullets(sentences):
    items = "".join(f"- {markdown_prose(sentence(text))}\n" for text in sentences)
    return items + "\n" if items else ""


def markdown_row(cells):
    return "| " + " | ".join(markdown_prose(cell) for cell in cells) + " |\n"


def markdown_table(table):
    sides = "".join("---:|" if side == "r" else "---|" for _, side in table.columns)
    return (markdown_row(name for name, _ in table.columns) + "|" + sides + "\n" +
            "".join(markdown_row(row) for row in table.rows) + "\n")


def markdown_chapter(number, drawn, count):
    chapter, study = drawn.chapter, drawn.study
    out = f"## {number}. {markdown_prose(chapter.title)}\n\n{markdown_prose(chapter.question)}\n\n"
    if not study.complete:
        out += bullets([f"Incomplete: {grouped(len(study.all_rows))} of "
                        f"{grouped(len(study.points))} points have a row"])
    out += bullets(printed(f) for f in chapter.findings)
    for p in drawn.pictures:
        if not p.png:
            out += (f"A picture ({markdown_code(p.command)}) is left out: {markdown_prose(sentence(p.left_out))}\n\n")
            continue
        count["figure"] += 1
        caption = markdown_prose(sentence(p.picture.caption))
        out += (f"![{caption}](pictures/{p.picture.name}.png)\n\n**Figure {count['figure']}.** "
                f"{caption} {markdown_code(p.command)}\n\n")
    for f in chapter.figures:
        count["figure"] += 1
        out += (f"![{markdown_prose(f.title)}](figures/{f.name}.svg)\n\n**Figure {count['figure']}. "
                f"{markdown_prose(sentence(f.title))}** {markdown_prose(caption_of(f, chapter))}\n\n")
    for t in chapter.tables:
        if t.in_text:
            count["table"] += 1
            out += (f"**Table {count['table']}.** {markdown_prose(sentence(t.caption))}\n\n" + markdown_table(t))
    if chapter.limits:
        out += "What it does not show:\n\n" + bullets(chapter.limits)
    return out + (f"Again: {markdown_code(chapter.command)} ({grid_text(study)}, "
                  f"{points_text(study)}), then `farcull report`.\n\n")


def page_markdown(page):
    out = "# Results\n\n"
    if broken(page):
        out += ("**Broken.** What must never happen has happened:\n\n" +
                bullets(f"{c.title}: {printed(f)}" for c, f in broken(page)))
    command = markdown_code("farcull report " + shlex.quote(page.folder))
    out += (f"All of this page is made from the store of results by {command}, figures, tables and "
            "sentences: no number was typed. A single study is measured again by the command that "
            "stands below it. Counts are the same, bit for bit, on the same device and CPU "
            "features; times are of the machine [at the end](#where-it-was-measured).\n\n")
    count = collections.Counter()
    for i, drawn in enumerate(page.chapters):
        out += markdown_chapter(i + 1, drawn, count)
    return out + "## Where it was measured\n\n" + markdown_table(runs_table(page)).rstrip("\n") + "\n"


# ---- LaTeX

def latex_items(sentences):
    items = "".join(f"  \\item {latex_text(sentence(text))}\n" for text in sentences)
    return f"\\begin{{itemize}}\n{items}\\end{{itemize}}\n" if items else ""


def page_latex(page):
    out = PREAMBLE + ("\\title{Reliable collision culling: results}\n"
                      f"\\author{{farcull {latex_text(page.commit)}}}\n"
                      f"\\date{{{latex_text(page.written)}}}\n\\begin{{document}}\n\\maketitle\n")
    for drawn in page.chapters:
        chapter = drawn.chapter
        out += (f"\n\\section{{{latex_text(chapter.title)}}}\n{latex_text(chapter.question)}\n" +
                latex_items(printed(f) for f in chapter.findings))
        for f in chapter.figures:
            out += ("\\begin{figure}[htbp]\n  \\centering\n  \\includegraphics["
                    f"width={'0.5' if f.narrow else ''}\\linewidth,height=0.8\\textheight,"
                    f"keepaspectratio]{{figures/{f.name}.pdf}}\n  \\caption{{"
                    f"{latex_text(sentence(f.title))} {latex_text(caption_of(f, chapter))}}}\n"
                    f"  \\label{{fig:{f.name}}}\n\\end{{figure}}\n")
        out += "".join(f"{{\\footnotesize\\input{{tables/{t.name}.tex}}}}\n" for t in chapter.tables if t.in_text)
        if chapter.limits:
            out += "\\paragraph{What it does not show.}\n" + latex_items(chapter.limits)
        out += f"Measured by {latex_text(chapter.command)}.\n\\clearpage\n"
    return out + "\\end{document}\n"
