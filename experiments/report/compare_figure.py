"""`farcull compare ... --figure FILE.svg` becomes `python3 compare_figure.py FILE.svg STATUS`, with the rows of `--csv` on
standard input. Draws missed pairs against time. The exit status is STATUS, or 2 if no figure can be made."""
import logging
import os
import sys

try:
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # hides matplotlib's messages about cache folders
    import pandas as pd
    import draw
    from frame import Figure, Panel, Series, log
except ImportError as missing:
    print(f"farcull: --figure: {missing}; install python3-matplotlib and python3-pandas, or write --csv", file=sys.stderr)
    sys.exit(2)


def named(row, rows):
    """Returns the name of a row without its resolution. The name has the offset or the radius if rows differ in it. A radius
    replaces the name of the method, so that each radius has its own colour (draw.py)."""
    offset, radius = (getattr(row, of) if rows[of][rows[of] != ""].nunique() > 1 else "" for of in ("offset", "radius"))
    return " ".join(part for part in ("" if radius else row.method, row.form, offset and f"{offset} offset",
                                       radius and f"radius {radius}") if part)


def figure_of(rows):
    rows = rows.assign(series=[named(row, rows) for row in rows.itertuples()])
    series = []
    for name, of in rows.groupby("series", sort=False):
        # The label of the first point of a line includes the name of the line.
        px = [f"{at} px" if at else "" for at in of.resolution]
        labels = [f"{name} {px[0]}".strip(), *px[1:]]
        series.append(Series(name, list(of.ms), list(of.missed), emphasis=of.iloc[0].method == "far", x_low=list(of.least_ms),
                             x_high=list(of.most_ms), labels=labels))
    first = rows.iloc[0]
    colliding, risk = first.colliding + first.neighbours + first.missed, rows.at_risk.max()
    at_risk = "" if risk != risk else f"; at risk, since far loses them with 0.9 of its radius: at most {risk:,.0f}"
    return Figure("error-time", f"{first.scene}: missed pairs against time", (
        f"{colliding:,.0f} pairs collide. Below and to the left is better. Time is that of culling and exact tests; bars go "
        f"from the least to the most of {first.runs} runs."), [
            Panel(f"{first.scene}: {colliding:,.0f} pairs collide{at_risk}", log("cull + exact (ms)"), log("missed pairs", zero=True),
                  series)])


def main(path, status):
    rows = pd.read_csv(sys.stdin, dtype={"resolution": "Int64"}, keep_default_na=False, na_values={"missed": [""], "at_risk": [""], "resolution": [""]})
    rows["resolution"] = rows.resolution.fillna(0).astype(int)
    svg = draw.files_of(figure_of(rows))["svg"]
    half = f"{path}.part-{os.getpid()}"
    try:
        with open(half, "w", encoding="utf-8") as file:
            file.write(svg)
        os.replace(half, path)
    except OSError as error:
        print(f"farcull: {path}: cannot be written: {error.strerror}; make room on the disk", file=sys.stderr)
        return 2
    return int(status)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
