#!/usr/bin/env bash
# Draws the figures of the paper (docs/figures/paper-*.svg), and makes the PDF of the paper (build/paper.pdf). The text
# of the paper is docs/reliability.md and docs/budget.md.
#   bash experiments/paper.sh [--out FILE.pdf]
#   bash experiments/paper.sh --short [--out FILE.pdf]    makes build/paper-short.pdf of docs/paper.md, two pages
#     --out      the name of the PDF. The figures are then drawn beside the PDF, and nothing is installed
# Needs matplotlib, pandoc, texlive-latex-base, texlive-latex-recommended, lmodern and librsvg2-bin. Without --out, the
# script installs these packages. If a package is missing, the script only draws the figures and exits with status 77.
set -euo pipefail

root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
out='' short=''
while (($#)); do
  case $1 in
    --short) short=yes && shift && continue ;;
    --out) out=$(realpath -m "$2") ;;
    *)
      echo "paper: unknown argument '$1'" >&2
      exit 2
      ;;
  esac
  shift 2
done
if [[ $short ]]; then
  work=$(mktemp -d)
  # shellcheck disable=SC2064  # the folder's name as it is now
  trap "rm -rf '$work'" EXIT
  rsvg-convert -f pdf -o "$work/headline.pdf" "$root/docs/results/figures/headline.svg"
  sed "s#(results/figures/headline.svg)#($work/headline.pdf){height=88mm}#" "$root/docs/paper.md" |
    pandoc --citeproc --bibliography "$root/docs/references.bib" -V papersize=a4 -V geometry:margin=22mm -V fontsize=10pt \
      --output "${out:-$root/build/paper-short.pdf}"
  echo "paper: ${out:-$root/build/paper-short.pdf}"
  exit 0
fi
if [[ -z $out ]]; then
  # shellcheck source-path=SCRIPTDIR source=setup.sh
  source "$root/experiments/setup.sh"
  cd "$root"
  farcull_packages+=(pandoc texlive-latex-base texlive-latex-recommended lmodern librsvg2-bin)
  farcull_setup
fi

folder=$root/docs/figures
if [[ -n $out ]]; then
  folder=$(dirname "$out")/figures
  mkdir -p "$folder"
fi
/usr/bin/python3 "$root/experiments/paper_figures.py" "$root/tests/cases/published-far-loses-this-pair.obj" "$folder"
for tool in pandoc pdflatex rsvg-convert; do
  if ! command -v "$tool" >/dev/null; then
    echo "paper: NOT RUN: $tool is missing (Debian: pandoc texlive-latex-base texlive-latex-recommended lmodern librsvg2-bin)"
    exit 77
  fi
done
# pandoc's template needs the fonts of lmodern. texlive-base only recommends this package.
if ! kpsewhich lmodern.sty >/dev/null; then
  echo "paper: NOT RUN: lmodern.sty is missing (Debian: lmodern)"
  exit 77
fi

export SOURCE_DATE_EPOCH=0 FORCE_SOURCE_DATE=1 # makes the PDF reproducible
work=$(mktemp -d)
# shellcheck disable=SC2064  # the folder's name as it is now
trap "rm -rf '$work'" EXIT
mkdir "$work/figures"
for figure in "$folder"/paper-*.svg; do
  rsvg-convert -f pdf -o "$work/figures/$(basename "${figure%.svg}").pdf" "$figure"
done
cd "$work"
# Joins the two pages into one text. paper.lua replaces the titles of the pages.
for page in reliability budget; do
  sed 's/(figures\/\(paper-[a-z-]*\)\.svg)/(figures\/\1.pdf){width=70%}/' "$root/docs/$page.md"
  echo
done >paper.md
printf '# References\n\n' >>paper.md
printf '%s\n' '\makeatletter\def\verbatim@font{\ttfamily\footnotesize}\makeatother' >preamble.tex
pandoc paper.md --fail-if-warnings --from markdown-implicit_figures-superscript-subscript-tex_math_dollars-raw_tex-example_lists-fancy_lists+lists_without_preceding_blankline \
  --lua-filter "$root/experiments/paper.lua" --citeproc --bibliography "$root/docs/references.bib" \
  --metadata title="Reliable collision culling with rasterizers" --metadata link-citations=false \
  -V papersize=a4 -V geometry:margin=25mm -V fontsize=10pt --include-in-header preamble.tex --standalone --to latex --output paper.tex
for _ in 1 2; do
  pdflatex -interaction=nonstopmode -halt-on-error -no-shell-escape paper.tex >said 2>&1 </dev/null || {
    grep -m5 -E '^!|^l\.[0-9]+' said >&2
    exit 1
  }
done
if grep -E 'Missing character' paper.log >&2; then exit 1; fi
pdf=${out:-$root/build/paper.pdf}
mv paper.pdf "$pdf"
cp paper.log "${pdf%.pdf}.log"
echo "paper: $pdf"
