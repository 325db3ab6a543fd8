#!/usr/bin/env bash
# Checks the paper (docs/reliability.md, then docs/budget.md) and what refers to it: numbers of
# definitions, lemmas, theorems and corollaries; sections of pages that are named in quotes; names of
# tests; citations; symbols.
#   tests/docs_test.sh [ROOT]      checks ROOT (default: this repository). It prints one line for
#                                  each violation, and then exits with status 1.
#   tests/docs_test.sh --self-test breaks each rule in a copy and checks that this is reported
# Backticks and dollars in single quotes are those of Markdown and awk.
# shellcheck disable=SC2016
set -euo pipefail

self=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)/${BASH_SOURCE[0]##*/}
root=$(dirname -- "$self")/..
parts=(docs/reliability.md docs/budget.md)

# Each file as one line: its name, a tab, its text. Line ends and comment marks become spaces, so that
# a reference may go on in the next line.
as_lines() {
  awk '
    FNR == 1 && NR > 1 { print file "\t" text; text = "" }
    { file = FILENAME; line = $0; sub(/^[ \t]*(\/\/\/?|#)?[ \t]*/, "", line); text = text " " line }
    END { if (NR) print file "\t" text }' "$@"
}

# Files that may refer to the paper.
referring() {
  find core offsets verify tests experiments README.md docs -type f \
    \( -name '*.h' -o -name '*.cpp' -o -name '*.inl' -o -name '*.glsl' -o -name '*.md' -o -name '*.sh' -o -name '*.txt' \
    -o -name '*.obj' \) ! -path 'tests/fuzz/*' ! -path tests/docs_test.sh 2>/dev/null | LC_ALL=C sort
}

referring_lines() {
  local -a files
  mapfile -t files < <(referring)
  as_lines "${files[@]}"
}

# The labels of the paper, in its order: "lemma 3".
labels() { sed -nE 's/^\*\*(Definition|Lemma|Theorem|Corollary) ([0-9]+) \(.*/\L\1\E \2/p' "${parts[@]}"; }

# Labels are numbered 1, 2, 3, ... for each kind, over both parts.
check_labels() {
  labels | awk '{ if ($2 != ++next_of[$1]) print "the paper: " $1 " " $2 " stands where " $1 " " next_of[$1] " should" }
    END { if (!next_of["lemma"] || !next_of["theorem"]) print "the paper: it has no lemmas, or the test reads it wrongly" }'
}

# Every "lemma 3", "lemmas 1 and 2", "theorems 5 to 8" names labels of the paper.
check_references() {
  {
    labels
    echo "--"
    referring_lines
  } | awk -F '\t' '
    $0 == "--" { reading = 1; next }
    !reading { known[$0] = 1; next }
    {
      rest = $2
      pattern = "(^|[^A-Za-z0-9_])([Ll]emma|[Tt]heorem|[Cc]orollary|[Dd]efinition|[Ll]emmas|[Tt]heorems|[Cc]orollaries|[Dd]efinitions) [0-9]+(( to |, | and )[0-9]+)*([^0-9.a-z]|[.]([^0-9]|$)|$)"
      while (match(rest, pattern)) {
        said = substr(rest, RSTART, RLENGTH)
        before = substr(rest, 1, RSTART)
        rest = substr(rest, RSTART + RLENGTH - 1)
        if (before ~ /Higham, ?$/) continue
        sub(/^[^A-Za-z]+/, "", said)
        kind = tolower(said); sub(/ .*/, "", kind); sub(/ies$/, "y", kind); sub(/s$/, "", kind)
        n = split(said, words, /[^0-9]+/)
        for (i = 1; i <= n; i++)
          if (words[i] != "" && !((kind " " words[i]) in known))
            print $1 ": names " kind " " words[i] ", which the paper does not have"
      }
    }'
}

# Sections named in quotes after the page, as in budget.md, "double", are headings of that page.
check_sections() {
  {
    awk 'FNR == 1 { page = FILENAME; sub(/.*\//, "", page) } sub(/^#+ +/, "") { print page "\t" $0 }' docs/*.md docs/results/*.md
    echo "--"
    referring_lines
  } | awk -F '\t' '
    $0 == "--" { reading = 1; next }
    !reading { heading[$1, $2] = 1; page[$1] = 1; next }
    {
      rest = $2
      while (match(rest, /[a-z_]+[.]md[)]?, "[^"]+"(,? and "[^"]+")?/)) {
        said = substr(rest, RSTART, RLENGTH)
        rest = substr(rest, RSTART + RLENGTH)
        name = said; sub(/[.]md.*/, ".md", name)
        if (!(name in page)) continue
        n = split(said, quoted, "\"")
        for (i = 2; i <= n; i += 2)
          if (!((name, quoted[i]) in heading)) print $1 ": names the section \"" quoted[i] "\", which " name " does not have"
      }
    }'
}

# Every `Suite.Name` of the paper is a test; * stands for any text.
check_tests() {
  {
    grep -rhoE '(TEST|TEST_F|TEST_P|RC_GTEST_PROP)\([A-Za-z0-9_]+, *[A-Za-z0-9_]+' tests |
      sed -E 's/.*\(([A-Za-z0-9_]+), *([A-Za-z0-9_]+)/\1.\2/'
    echo "--"
    grep -noE '`[A-Z][A-Za-z0-9]+\.[A-Z*][A-Za-z0-9*]*`' "${parts[@]}" | tr -d '`'
  } | awk '
    $0 == "--" { reading = 1; next }
    !reading { tests[$0] = 1; next }
    {
      name = $0; sub(/.*:/, "", name)
      if (name in tests) next
      pattern = name; sub(/[.]/, "[.]", pattern); gsub(/[*]/, "[A-Za-z0-9_]*", pattern)
      if (name ~ /[*]/) for (test in tests) if (test ~ "^" pattern "$") next
      print $0 ": no such test"
    }'
}

# Citations are keys of docs/references.bib.
check_citations() {
  {
    sed -nE 's/^@[a-z]+\{([a-z0-9]+),.*/\1/p' docs/references.bib
    echo "--"
    grep -noE '\[@[^]]*\]' "${parts[@]}"
  } | awk '
    $0 == "--" { reading = 1; next }
    !reading { if ($0 in keys) print "docs/references.bib: two entries " $0; keys[$0] = 1; next }
    {
      rest = $0
      while (match(rest, /@[a-z0-9]+/)) {
        key = substr(rest, RSTART + 1, RLENGTH - 1)
        rest = substr(rest, RSTART + RLENGTH)
        if (!(key in keys)) print $0 ": docs/references.bib has no " key
      }
    }'
}

# Each symbol stands once in the table of notation.
check_symbols() {
  awk -F ' *[|] *' '
    /^## Notation/ { inside = 1 }
    /^## / && !/Notation/ { inside = 0 }
    inside && /^[|]/ && $2 != "symbol" && $2 !~ /^-+$/ {
      n = split($2, symbols, /, /)
      for (i = 1; i <= n; i++) if (defined[symbols[i]]++) print "docs/reliability.md: the symbol " symbols[i] " is defined twice"
      rows++
    }
    END { if (rows < 20) print "docs/reliability.md: the table of notation has " rows + 0 " rows, or the test reads it wrongly" }
  ' docs/reliability.md
}

# Each lemma, theorem and corollary says what it assumes, has tests and twins, and a proof that ends.
check_proofs() {
  local part
  for part in "${parts[@]}"; do
    awk -v part="$part" '
      function finish() {
        if (label == "") return
        if (text !~ /[*]Assumes[:* ]/) print part ": " label " does not say what it assumes"
        if (text !~ /[*]Tests[:* ]/) print part ": " label " names no tests"
        if (text !~ /[*][Tt]wins[:*]/) print part ": " label " names no twins"
        if (text !~ /[*]Proof[.][*]/) print part ": " label " has no proof"
        if (gsub(/∎/, "", text) != 1) print part ": the proof of " label " does not end once"
        label = ""
      }
      /^[*][*](Lemma|Theorem|Corollary) [0-9]+ / { finish(); label = $1 " " $2; gsub(/[*]/, "", label); text = "" }
      /^##/ { finish() }
      { text = text " " $0 }
      END { finish() }' "$part"
  done
}

# Every page is linked from the map of pages, docs/README.md, or from that of results.
check_map() {
  local page
  for page in docs/*.md docs/results/*.md; do
    if [[ $page == docs/README.md ]]; then continue; fi
    grep -qF "](${page#docs/})" docs/README.md || grep -qF "](${page#docs/results/})" docs/results/README.md ||
      echo "$page: docs/README.md and docs/results/README.md do not link to it"
  done
}

check() {
  local violations
  cd "$1"
  violations=$(check_labels; check_references; check_sections; check_tests; check_citations; check_symbols; check_proofs; check_map)
  if [[ -n $violations ]]; then
    printf '%s\n' "$violations"
    return 1
  fi
  echo "docs: $(labels | wc -l) numbered statements, and what refers to them"
}

# ---- self-test ----

failures=0
# caught CASE FILE SED PATTERN: with FILE changed by SED the check fails, in a line like PATTERN.
caught() {
  local said status=0
  cp "$2" kept
  sed -i -E "$3" "$2"
  if cmp -s "$2" kept; then
    echo "self-test: $1: $2 was not changed, so the case shows nothing"
    failures=$((failures + 1))
  fi
  said=$(bash "$self" . 2>&1) || status=$?
  if ((status != 1)) || ! grep -qE "$4" <<<"$said"; then
    echo "self-test: $1: status $status: $said"
    failures=$((failures + 1))
  fi
  mv kept "$2"
}

self_test() {
  local tree
  tree=$(mktemp -d)
  # shellcheck disable=SC2064  # the folder's name as it is now
  trap "rm -rf '$tree'" EXIT
  (cd "$root" && cp -r --parents README.md docs core offsets verify tests experiments "$tree")
  cd "$tree"
  bash "$self" . >/dev/null || { echo "self-test: the tree itself fails" && failures=1; }
  local one=docs/reliability.md two=docs/budget.md
  caught "a number left out" $two 's/^\*\*Lemma 17 /**Lemma 77 /' 'lemma 77 stands where'
  caught "a number used twice" $one 's/^\*\*Theorem 3 /**Theorem 2 /' 'theorem 2 stands where'
  caught "a lemma that is none, in a page" docs/extending.md 's/lemmas 1$/lemmas 91/' 'extending.md: names lemma 91'
  caught "a theorem that is none, in a source" core/cull/cull.h 's/theorem 2/theorem 92/' 'cull.h: names theorem 92'
  caught "a section that is gone" $two 's/^### One normal|^#### One normal/#### One value/' 'names the section "One normal"'
  caught "a section in the next line" $one 's/^### Boxes of runs/### Runs/' 'names the section "Boxes of runs"'
  caught "a test that is none" $one 's/`Cull.ALostStoreMisses`/`Cull.ALostStore`/' 'Cull.ALostStore: no such test'
  caught "a pattern without a test" $one 's/`PairsEdges.\*`/`PairsCorners.*`/' 'PairsCorners.\*: no such test'
  caught "a citation without an entry" $two 's/@higham2002/@higham1996/' 'has no higham1996'
  caught "a symbol with two meanings" $one 's/^\| K \| a clearance/| M | a clearance/' 'symbol M is defined twice'
  caught "a proof without an end" $two '0,/ ∎$/s/ ∎$//' 'does not end once'
  caught "a lemma without a twin" $one 's/^\*Twins:\* `CullideLemma/`CullideLemma/; s/\*Twins:\* `CullideLemma.L1IsFalse/`CullideLemma.L1IsFalse/' 'names no twins'
  caught "a page that no map names" docs/README.md 's/\(tiles\.md\)/(proofs.md)/' 'docs/tiles.md: docs/README.md'
  caught "a result that no map names" docs/results/README.md 's/\(motion\.md\)/(native.md)/' 'motion.md: docs/README.md'
  caught "a lemma without assumptions" $two 's/\*Assumes:\* lemmas 16 and 17\.//' 'does not say what it assumes'
  if ((failures)); then return 1; fi
  echo "docs: every rule is caught when it is broken"
}

case ${1-} in
  --self-test) self_test ;;
  *) check "${1:-$root}" ;;
esac
