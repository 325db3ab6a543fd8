#!/usr/bin/env bash
# The LaTeX of the report: report.tex, with every table and figure, is compiled from a store with
# made-up rows. Then tables that are broken in one way each, which must not compile.
#   latex_test.sh FARCULL FIXTURE
# Status 77: not run, for want of pdflatex (Debian: texlive-latex-base) or of the tools beside it.
# Rows of a table end with two backslashes.
# shellcheck disable=SC1003
set -euo pipefail

farcull=$1
fixture=$2
# shellcheck source-path=SCRIPTDIR source=../script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../script_lab.sh" report.latex pdflatex pdfinfo gnuplot

# compile FOLDER [TIMES]: report.tex there; what pdflatex says is in FOLDER/said. The second time the
# references are known; widths and errors are those of the first.
compile() {
  local time
  for ((time = 0; time < ${2:-1}; ++time)); do
    (cd "$1" && timeout 120 pdflatex -interaction=nonstopmode -halt-on-error -no-shell-escape \
      -file-line-error report.tex >said 2>&1 </dev/null) || return 1
  done
}

"$fixture" "$work/results"
"$farcull" report --no-pictures "$work/results" >/dev/null
report=$work/results/report
tables=("$report"/tables/*.tex)
figures=("$report"/figures/*.pdf)
((${#tables[@]} >= 8 && ${#figures[@]} >= 8)) || fail "only ${#tables[@]} tables, ${#figures[@]} figures"

if ! compile "$report" 2; then
  fail "report.tex does not compile: $(grep -m3 -E '^[^ ]+:[0-9]+: |^!' "$report/said" | tr '\n' ' ')"
else
  pages=$(pdfinfo "$report/report.pdf" | awk '/^Pages:/ { print $2 }')
  ((pages >= 8)) || fail "the PDF has $pages pages"
  if grep -qE 'undefined references|Missing character' "$report/report.log"; then
    fail "references or characters are missing: $(grep -m3 -E 'undefined|Missing character' "$report/report.log")"
  fi
fi

# off_page LOG: what stands more than 20 pt beyond the margin, or is longer than a page.
off_page() { grep -E 'Float too large' "$1" || sed -nE 's/^Overfull \\hbox \(([0-9.]+)pt.*/\1/p' "$1" | awk '$1 > 20'; }
[[ -z $(off_page "$report/report.log") ]] || fail "off the page: $(off_page "$report/report.log" | tr '\n' ' ')"
# The twin: tables that are not scaled to the width of the text.
cp -r "$report" "$work/wide"
sed -i 's/\\ifdim.*\\fi}{!}/\\width}{!}/' "$work"/wide/tables/*.tex
compile "$work/wide" || fail "tables at their own width do not compile"
[[ -n $(off_page "$work/wide/report.log") ]] || fail "no table is wider than the text, so the check of widths shows nothing"

# Those that the report links as CSV alone as well.
mkdir "$work/all"
{
  printf '%s\n' '\documentclass{article}\usepackage{graphicx}' \
    '\IfFileExists{booktabs.sty}{\usepackage{booktabs}}{\let\toprule\hline\let\midrule\hline\let\bottomrule\hline}' \
    '\begin{document}'
  printf '\\input{%s}\\clearpage\n' "${tables[@]}"
  printf '%s\n' '\end{document}'
} >"$work/all/report.tex"
compile "$work/all" || fail "a table does not compile: $(grep -m1 -E ':[0-9]+: ' "$work/all/said")"

# ---- tables that must not compile ----

# caught WHAT SED PATTERN: a table of the report, changed by SED, is told of by name.
caught() {
  local broken=$work/broken
  rm -rf "$broken"
  mkdir "$broken"
  cp -r "$report/figures" "$report/tables" "$report/report.tex" "$broken"
  sed -i "$2" "$broken/tables/offsets.tex"
  if cmp -s "$report/tables/offsets.tex" "$broken/tables/offsets.tex"; then
    fail "$1: the table was not changed, so the case shows nothing"
  elif compile "$broken"; then
    fail "$1 compiles"
  elif ! grep -qE "offsets.tex:[0-9]+: .*$3" "$broken/said"; then
    fail "$1 is told of otherwise: $(grep -m1 -E ':[0-9]+: |^!' "$broken/said")"
  fi
}
caught "an underscore that is not escaped" '/midrule/a needles_60 \\\\' 'Missing \$'
caught "an ampersand that is not escaped" '/midrule/a a & b & c & d & e & f & g & h & i \\\\' 'Extra alignment tab'
caught "a command that is none" '/midrule/a x \\nothingofthisname \\\\' 'Undefined control sequence'
# The twins of the twins: the same words, escaped.
good=$work/good
mkdir "$good"
cp -r "$report/figures" "$report/tables" "$report/report.tex" "$good"
sed -i '/midrule/a needles\\_60 \\\& more \\\\' "$good/tables/offsets.tex"
compile "$good" || fail "an escaped underscore and ampersand do not compile: $(grep -m1 -E ':[0-9]+: ' "$good/said")"

((failures == 0)) || exit 1
echo "report.latex: ${#tables[@]} tables and ${#figures[@]} figures in a PDF of $pages pages"
