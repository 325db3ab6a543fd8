#!/usr/bin/env bash
# The paper as a PDF: experiments/paper.sh makes it, all numbered statements and figures are in it, and
# nothing stands off the page. Then papers that must not pass.
# Status 77: not run, for want of pandoc or LaTeX (Debian: pandoc texlive-latex-base
# texlive-latex-recommended lmodern librsvg2-bin) or of the tools that read the PDF (poppler-utils).
# Dollars in single quotes are those of sed.
# shellcheck disable=SC2016
set -euo pipefail

root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
# shellcheck source-path=SCRIPTDIR source=script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/script_lab.sh" paper pandoc pdflatex rsvg-convert pdfinfo pdftotext kpsewhich
if ! kpsewhich lmodern.sty >/dev/null; then
  echo "paper: NOT RUN: lmodern.sty is missing (experiments/setup.sh installs it)"
  exit 77
fi

# paper OF TO: the paper of the checkout OF as TO/paper.pdf; what is said in TO/said.
paper() {
  mkdir -p "$2"
  bash "$1/experiments/paper.sh" --out "$2/paper.pdf" >"$2/said" 2>&1
}
# off_page LOG: what stands more than 20 pt beyond the margin.
off_page() { sed -nE 's/^Overfull \\hbox \(([0-9.]+)pt.*/\1/p' "$1" | awk '$1 > 20'; }
# labels FILE...: the numbered statements of a text, each once.
labels() { grep -hoE '(Definition|Lemma|Theorem|Corollary) [0-9]+ \(' "$@" | sort -u; }

if ! paper "$root" "$work/good"; then
  cat "$work/good/said"
  exit 1
fi
pdftotext -layout "$work/good/paper.pdf" "$work/text"
pages=$(pdfinfo "$work/good/paper.pdf" | awk '/^Pages:/ { print $2 }')
((pages >= 20)) || fail "the PDF has $pages pages"
missing=$(comm -23 <(labels "$root/docs/reliability.md" "$root/docs/budget.md") <(tr '\n' ' ' <"$work/text" | tr -s ' ' | labels))
[[ -z $missing ]] || fail "not in the PDF: $missing"
for words in 'proxy' 'around c' 'entry' 'After the first pass' 'falling: miss'; do
  grep -q "$words" "$work/text" || fail "no figure has the words '$words'"
done
grep -qE $'^\f?References' "$work/text" || fail "it has no references"
if grep -q '?)\|(@' "$work/text"; then fail "a citation has no entry"; fi
[[ -z $(off_page "$work/good/paper.log") ]] || fail "off the page: $(off_page "$work/good/paper.log" | tr '\n' ' ')"
for figure in "$work"/good/figures/*.svg; do
  cmp -s "$figure" "$root/docs/figures/$(basename "$figure")" || fail "docs/figures/$(basename "$figure") is not what paper_figures.py draws"
done

grep -q 'least miss: 0.00138 px' "$work/good/figures/paper-published.svg" || fail "figure 5 has another least miss"

bash "$root/experiments/paper.sh" --short --out "$work/short.pdf" >/dev/null || fail "the short paper is not made"
[[ $(pdfinfo "$work/short.pdf" | awk '/^Pages:/ { print $2 }') == 2 ]] || fail "the short paper has not two pages"

bad=$work/bad
mkdir "$bad"
(cd "$root" && cp -r --parents docs/reliability.md docs/budget.md docs/references.bib experiments/paper* tests/cases "$bad")
# broken WHAT FILE SED: with FILE changed by SED there is no PDF.
broken() {
  cp "$bad/$2" "$work/kept"
  sed -i "$3" "$bad/$2"
  cmp -s "$bad/$2" "$work/kept" && fail "$1: $2 was not changed, so the case shows nothing"
  if paper "$bad" "$work/out"; then fail "$1: a PDF is made"; fi
  cp "$work/kept" "$bad/$2"
}
broken "a citation without an entry" docs/reliability.md 's/@far2004/@far1904/'
((failures == 0)) || exit 1
echo "paper: $pages pages, $(labels "$root/docs/reliability.md" "$root/docs/budget.md" | wc -l) numbered statements"
