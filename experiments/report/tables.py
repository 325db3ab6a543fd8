"""Tables as files: CSV for programs, LaTeX (booktabs) for papers; and text with its escapes."""
import csv
import io

# Signs that pdfLaTeX's text fonts lack, and characters with a meaning in LaTeX.
LATEX = {"±": "$\\pm$", "×": "$\\times$", "≤": "$\\le$", "≥": "$\\ge$", "·": "$\\cdot$",
         "→": "$\\to$", "−": "$-$", "∞": "$\\infty$", "µ": "$\\mu$", "≈": "$\\approx$",
         "⁻": "$^{-}$", **{d: f"$^{i}$" for i, d in enumerate("⁰¹²³⁴⁵⁶⁷⁸⁹")},
         **{c: "\\" + c for c in "&%$#_{}"}, "~": "\\textasciitilde{}",
         "^": "\\textasciicircum{}", "\\": "\\textbackslash{}", "<": "$<$", ">": "$>$",
         "|": "$|$", "`": ""}
ROWS_OF_FLOAT = 40  # a float is at most one page


def latex_text(text):
    return "".join(LATEX.get(c, " " if c < " " else c) for c in text)


def csv_text(lines):
    out = io.StringIO()
    csv.writer(out).writerows(lines)  # RFC 4180
    return out.getvalue()


def table_csv(table):
    return csv_text([[name for name, _ in table.columns]] + table.rows)


def table_latex(table):
    """Floats with caption, label tab:NAME and the rules of booktabs, scaled if they are wider than the text."""
    def line(cells):
        return "    " + " & ".join(latex_text(cell) for cell in cells) + " \\\\\n"

    out, caption = "% \\usepackage{booktabs,graphicx}\n", latex_text(table.caption)
    for begin in range(0, max(len(table.rows), 1), ROWS_OF_FLOAT):
        title = f"{caption}.}}\n  \\label{{tab:{table.name}}}" if begin == 0 \
            else f"{caption}, continued.}}"
        out += ("\\begin{table}\n  \\centering\n  \\caption{" + title +
                "\n  \\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n"
                "  \\begin{tabular}{" + "".join(side for _, side in table.columns) +
                "}\n    \\toprule\n" + line(name for name, _ in table.columns) +
                "    \\midrule\n" +
                "".join(line(row) for row in table.rows[begin:begin + ROWS_OF_FLOAT]) +
                "    \\bottomrule\n  \\end{tabular}}\n\\end{table}\n")
    return out


def rows_csv(study):
    """Everything that the store holds of the study: the axes, all counts and times by their names, the times of the
    runs, the device, the run, why nothing was measured, and the method as figures name it."""
    rows = study.all_rows.drop(columns=["counts", "times"])
    rows = rows.assign(runs=[" ".join(map(repr, runs)) for runs in rows.runs],
                       **{name: rows[name].astype(object).replace(none, "") for name, none in (
                           ("resolution", 0), ("frame", -1), ("seed", 0))})
    return rows.convert_dtypes().to_csv(index=False, lineterminator="\r\n")
