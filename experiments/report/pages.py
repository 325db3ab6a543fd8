"""Makes the files of the report: results.md, which has broken promises first and then a section for each chapter; a page of
HTML with the same contents, in one file; tables as CSV for programs and as LaTeX (booktabs) for papers."""
import base64
import collections
import csv
import html
import io
import re
import shlex
from dataclasses import dataclass, field

from draw import inline_svg
from estimates import grouped, of_all, sentence
from frame import Table, columns

FRONT = "headline"  # the study that is shown on the first page
MOST_ROWS = 16  # a table with more rows is written only to a file
MARK = '<meta name="generator" content="farcull report">'  # marks an index.html that this program made


@dataclass
class DrawnPicture:
    picture: object
    png: bytes = b""    # empty if the picture was left out
    left_out: str = ""  # why it was left out

    @property
    def command(self):
        return shlex.join(["farcull", "picture", *self.picture.arguments])


@dataclass
class Drawn:
    """A chapter with the files that were made for it."""
    chapter: object
    study: object
    svgs: list = field(default_factory=list)
    pictures: list = field(default_factory=list)


@dataclass
class Page:
    folder: str
    commit: str
    written: str
    runs: object  # rows of the table `runs`
    chapters: list = field(default_factory=list)


def printed(finding):
    return sentence(("BROKEN: " if finding[0] else "") + finding[1])


def broken(page):
    return [(d.chapter, f) for d in page.chapters for f in d.chapter.findings if f[0]]


def runs_table(page):
    rows = collections.Counter(run for drawn in page.chapters for run in drawn.study.all_rows.run)
    return Table("runs", "", columns(
        ["run", "started", "commit", "device", "driver", "CPU"], ["cores"], ["options"], ["rows"]), [
        [str(run.run), run.started, run.commit_id, run.gl_renderer,
         f"{run.gl_vendor}, {run.gl_version}" if run.gl_vendor or run.gl_version else "none", run.cpu, str(run.cores),
         "`" + run.options.replace("`", "\\u0060") + "`", grouped(rows[run.run])]
        for run in page.runs.itertuples() if run.run in rows])


# ---- Markdown

def markdown_prose(text):
    """Escapes Markdown's special characters outside code. Escapes bars everywhere, since a bar in code ends a cell of a table."""
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


def section(number, drawn, count):
    """Returns a chapter as Markdown. count: how many figures and tables the page has so far."""
    def label(kind, title=""):
        count[kind] += 1
        return f"**{markdown_prose(f'{kind} {count[kind]}.{title and chr(32) + sentence(title)}')}**"

    def items(title, sentences):
        return f"{title}:\n\n{bullets(sentences)}" if sentences else ""

    chapter, study = drawn.chapter, drawn.study
    out = f"## {number}. {markdown_prose(chapter.title)}\n\n{markdown_prose(chapter.question)}\n\n"
    points = f"{of_all(len(study.all_rows), len(study.points))} points"
    if not study.complete:
        out += bullets([f"Incomplete: {points} have a row; findings, figures and tables are of these."])
    out += items("What it shows", [printed(finding) for finding in chapter.findings])
    for p in drawn.pictures:
        picture = p.picture
        out += (f"![{markdown_prose(picture.title)}](pictures/{picture.name}.png)\n\n{label('Figure', picture.title)} " +
                markdown_prose(f"{sentence(picture.caption)} Drawn by `{p.command}`.") if p.png else
                markdown_prose(sentence(f"A picture (`{p.command}`) is left out: {p.left_out}"))) + "\n\n"
    for f in chapter.figures:
        out += (f"![{markdown_prose(f.title)}](figures/{f.name}.svg)\n\n{label('Figure', f.title)} " +
                markdown_prose(f"{sentence(f.caption)} Measured by `{chapter.command}`.") + "\n\n")
    for t in chapter.tables:
        out += f"{label('Table')} {markdown_prose(sentence(t.caption))}\n\n" + (
            markdown_table(t) if len(t.rows) <= MOST_ROWS else f"[{len(t.rows)} rows](tables/{t.name}.csv)\n\n")
    out += items("Not measured", chapter.limits)
    return out + markdown_prose(
        f"Measured by `{chapter.command}` ({'quick' if study.quick else 'full'} grid, seed {study.seed}, {points}), drawn by "
        "`farcull report`.") + "\n\n"


def front_markdown(page):
    """Returns the beginning of the page: broken promises; then the figure, table and sentences of the study "headline"."""
    out = "# Results\n\n"
    if broken(page):
        out += ("**Broken.** What must never happen has happened:\n\n" +
                bullets(f"{chapter.title}: {printed(finding)}" for chapter, finding in broken(page)))
    for chapter in [drawn.chapter for drawn in page.chapters if drawn.chapter.study == FRONT]:
        out += "".join(f"![{markdown_prose(f.title)}](figures/{f.name}.svg)\n\n" for f in chapter.figures)
        out += "".join(map(markdown_table, chapter.tables)) + bullets(printed(finding) for finding in chapter.findings)
        out += "".join(f"{markdown_prose(f.caption)} Measured by `{chapter.command}`.\n\n" for f in chapter.figures)
    return out


def rest_markdown(page):
    """Returns the remaining page: a chapter for each other study, and where the studies were measured."""
    count = collections.Counter()
    out = (f"All of this page is made from the store of results by `farcull report {shlex.quote(page.folder)}`: no number "
           "was typed. Counts are the same, bit for bit, on the same device and CPU features; times are of the machine "
           "[at the end](#where-it-was-measured). What each study cannot show, and what its intervals hold, is in "
           "docs/experiments.md.\n\n")
    chapters = [drawn for drawn in page.chapters if drawn.chapter.study != FRONT]
    out += "".join(section(i + 1, drawn, count) for i, drawn in enumerate(chapters))
    return out + "## Where it was measured\n\n" + markdown_table(runs_table(page)).rstrip("\n") + "\n"


def page_markdown(page):
    return front_markdown(page) + rest_markdown(page)


# ---- HTML

STYLE = """:root { color-scheme: light dark; }
body { max-width: 48rem; margin: 0 auto; padding: 3rem 1.25rem; line-height: 1.5; font-family: Georgia, "Liberation Serif", serif; }
h1, h2, .cells, nav { font-family: Helvetica, Arial, "DejaVu Sans", sans-serif; }
h2 { margin-top: 3rem; border-top: 1px solid #999; padding-top: 1rem; }
code { font-size: .84em; overflow-wrap: anywhere; }
figure, .cells { margin: 2rem 0 .6rem; overflow-x: auto; }
svg { display: block; width: 100%; min-width: 42rem; height: auto; background: #fff; }
.narrow svg { width: 50%; min-width: 20.4rem; margin: 0 auto; }
img { display: block; max-width: 100%; margin: 0 auto; }
table { border-collapse: collapse; font-size: .84rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .28rem .9rem .28rem 0; vertical-align: top; }
thead th { border-bottom: 1px solid; vertical-align: bottom; }
.r { text-align: right; }
@media print { body { padding: 0; font-size: 10pt; } svg { min-width: 0; } figure, tr { break-inside: avoid; } }
"""
INLINE = re.compile(r"\\(.)|`([^`]+)`|\*\*((?:\\.|[^\\*])+)\*\*|\[((?:\\.|[^\\\]])*)\]\(([^)]*)\)|([^\\`*\[]+|.)", re.DOTALL)


def html_text(text):
    return html.escape(re.sub(r"[\x00-\x09\x0b-\x1f\x7f]", " ", text)).replace("&#x27;", "&#39;")


def html_prose(text):
    """Converts a line of Markdown to HTML. Handles only the Markdown that this file writes."""
    def of(match):
        escaped, code, strong, words, to, plain = match.groups()
        return (f"<code>{html_text(code.replace(chr(92) + '|', '|'))}</code>" if code else
                f"<strong>{html_prose(strong)}</strong>" if strong else
                f'<a href="{html_text(to)}">{html_prose(words)}</a>' if to else html_text(escaped or plain or ""))
    return INLINE.sub(of, text)


def block_html(block, images):
    """Converts a block of Markdown to HTML. images: the HTML for the path of each image."""
    lines = block.split("\n")
    if heading := re.match("(#+) (.*)", block):
        name = re.sub("[^a-z0-9]+", "-", re.sub(r"^\d+\. ", "", heading[2]).lower()).strip("-")
        return f'<h{len(heading[1])} id="{name}">{html_prose(heading[2])}</h{len(heading[1])}>\n'
    if image := re.fullmatch(r"!\[(.*)\]\((.*)\)", block):
        title = html_text(re.sub(r"\\(.)", r"\1", image[1]))
        return f'<figure role="img" aria-label="{title}">\n{images[image[2]]}</figure>\n'
    if block.startswith("- "):
        return "<ul>\n" + "".join(f"<li>{html_prose(line[2:])}</li>\n" for line in lines) + "</ul>\n"
    if block.startswith("| "):
        head, sides, *rows = [re.split(r"(?<!\\)\|", line)[1:-1] for line in lines]
        sides = [' class="r"' if side.endswith(":") else "" for side in sides]
        def row(cells, kind):
            return "<tr>" + "".join(f"<{kind}{side}>{html_prose(cell.strip())}</{kind}>" for cell, side in zip(cells, sides)) + "</tr>\n"
        return (f'<div class="cells" tabindex="0">\n<table>\n<thead>{row(head, "th")}</thead>\n<tbody>\n' +
                "".join(row(cells, "td") for cells in rows) + "</tbody>\n</table>\n</div>\n")
    return f"<p>{html_prose(' '.join(lines))}</p>\n"


def page_html(page):
    images = {}
    for drawn in page.chapters:
        for figure, svg in zip(drawn.chapter.figures, drawn.svgs):
            links = " ".join(f'<a href="figures/{figure.name}.{kind}">{kind.upper()}</a>' for kind in ("svg", "pdf", "csv"))
            images[f"figures/{figure.name}.svg"] = (
                f'<div class="{"narrow" if figure.narrow else "wide"}">{inline_svg(svg, figure.name + "-")}</div>\n{links}')
        for p in drawn.pictures:
            images[f"pictures/{p.picture.name}.png"] = (
                f'<img src="data:image/png;base64,{base64.b64encode(p.png).decode()}" alt="">')
    front, body = ("".join(block_html(block, images) for block in part.strip("\n").split("\n\n"))
                   for part in (front_markdown(page), rest_markdown(page)))
    contents = "".join(f'<li><a href="#{name}">{title}</a></li>\n' for name, title in re.findall('<h2 id="(.*?)">(.*?)</h2>', body))
    return (  # The page has an empty icon, since a browser would otherwise request an icon file.
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n{MARK}\n<title>Results of farcull</title>\n'
        f'<link rel="icon" href="data:,">\n<style>\n{STYLE}</style>\n</head>\n<body>\n{front}'
        f'<p>farcull {html_text(page.commit[:12] or "of no commit")}, written {html_text(page.written)}. Figures, tables as CSV and '
        f'LaTeX, and all rows lie beside this page in figures/ and tables/.</p>\n<nav>\n<ul>\n{contents}</ul>\n</nav>\n{body}'
        '</body>\n</html>\n')


# ---- tables

# LaTeX text for characters that pdfLaTeX's text fonts lack, and for characters with a meaning in LaTeX.
LATEX = {"±": "$\\pm$", "×": "$\\times$", "≤": "$\\le$", "≥": "$\\ge$", "·": "$\\cdot$",
         "→": "$\\to$", "−": "$-$", "∞": "$\\infty$", "µ": "$\\mu$", "≈": "$\\approx$",
         "⁻": "$^{-}$", **{d: f"$^{i}$" for i, d in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")},
         **{c: "\\" + c for c in "&%$#_{}"}, "~": "\\textasciitilde{}",
         "^": "\\textasciicircum{}", "\\": "\\textbackslash{}", "<": "$<$", ">": "$>$",
         "|": "$|$", "`": ""}
ROWS_OF_FLOAT = 40  # number of rows of one LaTeX float, so that the float fits on a page


def latex_text(text):
    return "".join(LATEX.get(c, " " if c < " " else c) for c in text)


def table_csv(table):
    out = io.StringIO()
    csv.writer(out).writerows([[name for name, _ in table.columns]] + table.rows)  # CSV as in RFC 4180
    return out.getvalue()


def table_latex(table):
    """Returns LaTeX: floats with caption, label tab:NAME and the rules of booktabs. Wide tables are scaled to the text."""
    def line(cells):
        return "    " + " & ".join(latex_text(cell) for cell in cells) + " \\\\\n"

    out, caption = "% \\usepackage{booktabs,graphicx}\n", latex_text(table.caption)
    for begin in range(0, max(len(table.rows), 1), ROWS_OF_FLOAT):
        title = f"{caption}.}}\n  \\label{{tab:{table.name}}}" if begin == 0 else f"{caption}, continued.}}"
        out += ("\\begin{table}\n  \\centering\n  \\caption{" + title +
                "\n  \\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n"
                "  \\begin{tabular}{" + "".join(side for _, side in table.columns) +
                "}\n    \\toprule\n" + line(name for name, _ in table.columns) + "    \\midrule\n" +
                "".join(line(row) for row in table.rows[begin:begin + ROWS_OF_FLOAT]) +
                "    \\bottomrule\n  \\end{tabular}}\n\\end{table}\n")
    return out


def rows_csv(study):
    """Returns a CSV of all rows of the study in the store, with the method as figures name it."""
    rows = study.all_rows.drop(columns=["counts", "times"])
    rows = rows.assign(runs=[" ".join(map(repr, runs)) for runs in rows.runs],
                       **{name: rows[name].astype(object).replace(none, "") for name, none in (
                           ("resolution", 0), ("frame", -1), ("seed", 0))})
    return rows.convert_dtypes().to_csv(index=False, lineterminator="\r\n")
