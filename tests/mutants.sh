#!/usr/bin/env bash
# Mutants: single changes to core/, offsets/ and verify/, each of which some test has to notice. Every
# one is built and run against the tests that concern it. docs/mutants.md says what it is for;
# docs/results/mutants.md holds the table, which this script writes.
#
#   bash tests/mutants.sh                    measures what has not been measured, then writes the table
#   bash tests/mutants.sh 'budget-*' NAME    measures these alone
#   bash tests/mutants.sh --list [PATTERN..] names them, with their files and tests
#   bash tests/mutants.sh --table            writes the table from what was measured
#   bash tests/mutants.sh --check            does the list still fit the sources? No more than a second
#   bash tests/mutants.sh --self-test        breaks each rule of the list and checks that --check says so
# Options:
#   --jobs N    so many copies of the sources, each built and tested by itself (default: 1)
#   --out DIR   where they are built, and what was measured is kept (default: build-mutants)
# Ctrl-C ends it at any time. The next call goes on behind the last mutant that was measured; a mutant
# is measured again if its block, its file or its tests have changed.
# Exit status: 0 every mutant was noticed, or its survival is explained; 1 one was not, or does not
# compile, or one whose survival is explained was noticed; 2 the campaign could not run.
#
# The list is tests/mutants/*.txt. A block is
#   === NAME: what changes, in a sentence
#   file: the file that changes; a block without this line has that of the block before
#   tests: a filter of googletest; each pattern of it begins with the name of a suite; without this
#     line it is that of the block before
#   program: the program of the tests, where it is not farcull_mutant_tests
#   explained: why no test can notice it, if none can
#   -a line of a text that stands in the file once
#   +a line of the text in its place; none to remove it
set -euo pipefail
export LC_ALL=C

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"

lists=(tests/mutants/*.txt)
page=docs/results/mutants.md
table_begin='<!-- The table begins: tests/mutants.sh writes it. -->'
table_end='<!-- The table ends. -->'
build_limit=900  # s
test_limit=300   # s of one run of a mutant's tests
most_memory=12   # GiB of address space of such a run
jobs=1
out=$farcull_root/build-mutants
mode=measure
patterns=()
while (($#)); do
  case $1 in
    --help | -h)
      sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    --list | --table | --check | --self-test) mode=${1#--} ;;
    --jobs) jobs=${2-} && shift ;;
    --out) out=${2-} && shift ;;
    -*)
      echo "mutants: no option $1; --help names them" >&2
      exit 2
      ;;
    *) patterns+=("$1") ;;
  esac
  shift
done
if [[ ! $jobs =~ ^[1-9][0-9]?$ || -z $out ]]; then
  echo "mutants: --jobs takes a number, --out a folder" >&2
  exit 2
fi
[[ $out == /* ]] || out=$PWD/$out
results=$out/results.tsv

# The blocks, and one of them (mode, name).
blocks() { awk -f tests/mutants/blocks.awk -v mode="$1" -v name="${2-}" "${lists[@]}"; }

# Is this mutant among those that were asked for?
wanted() {
  local pattern
  for pattern in "${patterns[@]-*}"; do
    # shellcheck disable=SC2053  # it is a pattern
    [[ $1 == $pattern ]] && return 0
  done
  return 1
}

# Tests as googletest names them, with the file that each stands in.
tests_there() {
  grep -rHoE '^(TEST|TEST_F|TEST_P|RC_GTEST_PROP|RC_GTEST_FIXTURE_PROP)\([A-Za-z0-9_]+, *[A-Za-z0-9_]+' \
    tests/core tests/offsets tests/verify tests/proofs --include='*.cpp' |
    sed -E 's/^([^:]*):[A-Z_]+\(([A-Za-z0-9_]+), */\1\t\2./'
}

# A line for each pattern of a filter that names no test. Tests of farcull_proofs are made as it runs.
check_filters() {
  {
    tests_there
    echo --
    blocks list
  } | awk -F '\t' '
    $0 == "--" { reading = 1; next }
    !reading { known[$2] = 1; next }
    $3 != "farcull_mutant_tests" { next }
    {
      n = split($4, filter, ":")
      for (i = 1; i <= n; i++) {
        pattern = filter[i]
        gsub(/[.]/, "[.]", pattern)
        gsub(/[*]/, ".*", pattern)
        hit = 0
        for (test in known) if (test ~ "^" pattern "$") { hit = 1; break }
        if (!hit) print $1 ": no test is called " filter[i]
      }
    }'
}

check() {
  local violations
  violations=$(
    blocks check || true
    check_filters
  )
  if [[ -n $violations ]]; then
    printf '%s\n' "$violations"
    return 1
  fi
  echo "mutants: $(blocks list | wc -l) blocks fit the sources"
}

# What the result of a mutant rests on: its block, its file, and the files that hold its tests.
key_of() { # name file tests
  local suites
  suites=$(tr ':' '\n' <<<"$3" | sed -E 's/[.].*//; s/[*]//g' | sort -u)
  {
    blocks block "$1"
    cat "$2"
    awk -F '\t' -v suites="$suites" '
      BEGIN { n = split(suites, names, "\n"); for (i = 1; i <= n; i++) is[names[i]] = 1 }
      { suite = $2; sub(/[.].*/, "", suite); if (suite in is && !seen[$1]++) print $1 }' "$out/tests.tsv" |
      xargs -r cat
  } | sha256sum | cut -d ' ' -f 1
}

# The result of this key; nothing if there is none.
measured() { awk -F '\t' -v key="$1" '$1 == key { last = $0 } END { if (last != "") print last }' "$results"; }

# name, file, change, explained, result, seconds; by tabs.
verdicts() {
  local name file program tests change explained line
  while IFS=$'\x1f' read -r name file program tests change explained; do
    line=$(measured "$(key_of "$name" "$file" "$tests")")
    printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$name" "$file" "$change" "$explained" \
      "$(cut -f 3 <<<"${line:-$'\t\tnot measured'}")" "$(cut -f 4 <<<"${line:-$'\t\t\t-'}")"
  done < <(blocks list | tr '\t' $'\x1f')
}

write_table() {
  if ! grep -qxF -- "$table_begin" "$page" || ! grep -qxF -- "$table_end" "$page"; then
    echo "mutants: $page has lost the marks of its table" >&2
    return 2
  fi
  verdicts >"$out/verdicts.tsv"
  awk -F '\t' -v begin="$table_begin" -v end="$table_end" -v page="$page" -f tests/mutants/table.awk \
    "$out/verdicts.tsv" >"$out/page.md"
  cmp -s "$out/page.md" "$page" || cp "$out/page.md" "$page"
}

# Brings a copy up to date. Files that are the same keep their time, so that they are not built again.
sync_tree() {
  local tree=$1 file
  mkdir -p "$tree"
  git ls-files -z --cached --others --exclude-standard | tr '\0' '\n' | sort >"$tree.files.new"
  if [[ -e $tree.files ]]; then
    comm -23 "$tree.files" "$tree.files.new" | while IFS= read -r file; do rm -f "$tree/$file"; done
  fi
  while IFS= read -r file; do
    [[ -f $file ]] || continue
    cmp -s "$file" "$tree/$file" && continue
    mkdir -p "$tree/$(dirname -- "$file")"
    cp "$file" "$tree/$file"
  done <"$tree.files.new"
  mv "$tree.files.new" "$tree.files"
}

configure_tree() {
  local tree
  local -a how=()
  tree=$(CDPATH='' cd -P -- "$1" && pwd)
  if [[ ! -e $tree/build/CMakeCache.txt ]]; then
    if command -v ninja >/dev/null; then how+=(-G Ninja); fi
    if command -v ccache >/dev/null; then how+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  fi
  if ! cmake -S "$tree" -B "$tree/build" "${how[@]}" -DCMAKE_BUILD_TYPE=Release -DFARCULL_TESTS=ON \
    -DFARCULL_MUTANTS=ON >"$1.log" 2>&1; then
    tail -n 20 "$1.log" >&2
    return 2
  fi
}

build_tree() { # tree program
  timeout "$build_limit" cmake --build "$1/build" --target "$2" --parallel "$compilers" >"$1.log" 2>&1
}

# Runs tests; their output goes to TREE.out.
run_tests() { # tree program filter [options...]
  local tree=$1 program=$2 filter=$3
  shift 3
  (
    ulimit -v $((most_memory * 1024 * 1024))
    ulimit -c 0
    cd "$tree/build/tests"
    exec timeout "$test_limit" "./$program" --gtest_brief=0 --gtest_color=no --gtest_filter="$filter" "$@"
  ) >"$tree.out" 2>&1
}

# What a run with this exit status says, from TREE.out.
result_of() { # tree status
  local failed running
  failed=$(sed -nE 's/^\[  FAILED  \] ([A-Za-z0-9_\/.]+).*/\1/p' "$1.out" | head -n 1)
  running=$(sed -nE 's/^\[ RUN      \] ([A-Za-z0-9_\/.]+).*/\1/p' "$1.out" | tail -n 1)
  if (($2 == 0)); then
    if grep -qE '^\[  PASSED  \] [1-9]' "$1.out"; then echo SURVIVED; else echo "no test ran"; fi
  elif (($2 == 124)); then
    echo "noticed: time limit in ${running:-no test}"
  elif [[ -n $failed ]]; then
    echo "noticed by $failed"
  else
    echo "noticed: ${running:-the start} ended the program"
  fi
}

# Builds and tests one mutant in a copy, records the result, and puts the file back.
measure_one() { # tree name file program tests key
  local tree=$1 name=$2 file=$3 program=$4 tests=$5 key=$6 started=$SECONDS status=0 result
  blocks apply "$name" >"$tree.mutated" || return 2
  cp "$tree.mutated" "$tree/$file"
  if build_tree "$tree" "$program"; then
    run_tests "$tree" "$program" "$tests" --gtest_fail_fast || status=$?
    result=$(result_of "$tree" "$status")
  elif grep -q 'error:' "$tree.log"; then
    result="does not compile"
  else
    tail -n 5 "$tree.log" >&2
    echo "mutants: $name: the build was ended (all output: $tree.log)" >&2
    cp "$file" "$tree/$file"
    return 2
  fi
  cp "$file" "$tree/$file"
  printf '%s\t%s\t%s\t%s\n' "$key" "$name" "$result" $((SECONDS - started)) >>"$results"
  printf 'mutants: %s: %s (%s s)\n' "$name" "$result" $((SECONDS - started))
}

# All tests that the mutants to be measured need, unchanged: they have to pass.
base_line() { # tree todo
  local tree=$1 program filter key
  cut -f 3 "$2" | sort -u | while IFS= read -r program; do
    filter=$(awk -F '\t' -v program="$program" '$3 == program { print $4 }' "$2" | tr ':' '\n' | sort -u | paste -sd:)
    key=$({
      echo "$program $filter"
      sed "s|^|$tree/|" "$tree.files" | grep -E '/(core|offsets|verify|tests|experiments|CMakeLists.txt)' | xargs sha256sum
    } | sha256sum | cut -d ' ' -f 1)
    [[ -z $(measured "$key") ]] || continue
    echo "mutants: the base line of $program"
    if ! build_tree "$tree" "$program"; then
      tail -n 20 "$tree.log" >&2
      echo "mutants: the unchanged sources do not build" >&2
      return 2
    fi
    if ! test_limit=3600 run_tests "$tree" "$program" "$filter"; then
      grep -E 'FAILED' "$tree.out" >&2 || tail -n 5 "$tree.out" >&2
      echo "mutants: the tests fail without a mutant (all output: $tree.out)" >&2
      return 2
    fi
    printf '%s\t%s\t%s\t-\n' "$key" "the base line of $program" passed >>"$results"
  done
}

# Every jobs-th mutant of the list, in a copy of its own.
work() { # worker todo
  local tree=$out/tree-$1 line=0 name file program tests key
  while IFS=$'\t' read -r name file program tests key; do
    ((line++ % jobs == $1 - 1)) || continue
    measure_one "$tree" "$name" "$file" "$program" "$tests" "$key" || return
  done <"$2"
}

measure() {
  local name file program tests change explained key worker status=0 todo=$out/todo.tsv
  farcull_setup
  compilers=$(farcull_jobs)
  compilers=$((compilers > jobs ? compilers / jobs : 1))
  : >"$todo"
  while IFS=$'\x1f' read -r name file program tests change explained; do
    wanted "$name" || [[ $name == control-* ]] || continue
    key=$(key_of "$name" "$file" "$tests")
    [[ -z $(measured "$key") ]] || continue
    printf '%s\t%s\t%s\t%s\t%s\n' "$name" "$file" "$program" "$tests" "$key" >>"$todo"
  done < <(blocks list | tr '\t' $'\x1f')
  echo "mutants: $(wc -l <"$todo") to be measured"
  [[ -s $todo ]] || return 0
  for ((worker = 1; worker <= jobs; ++worker)); do
    sync_tree "$out/tree-$worker"
    configure_tree "$out/tree-$worker" || return 2
  done
  base_line "$out/tree-1" "$todo" || return 2
  local -a workers=()
  for ((worker = 1; worker <= jobs; ++worker)); do
    work "$worker" "$todo" &
    workers+=($!)
  done
  for worker in "${workers[@]}"; do wait "$worker" || status=$?; done
  return "$status"
}

# The lines of the verdicts that are no success.
judge() {
  awk -F '\t' '
    $1 ~ /^control-/ { if ($5 != "SURVIVED") print "mutants: " $1 " should have survived: " $5; next }
    $5 == "not measured" { next }
    $5 ~ /^noticed/ { if ($4 != "") print "mutants: " $1 " is explained as one that survives, and was " $5; next }
    $5 == "SURVIVED" && $4 != "" { next }
    { print "mutants: " $1 ": " $5 " (" $2 ")" }' "$out/verdicts.tsv"
}

# refused CASE SED PATTERN: with the list changed by SED, --check fails in a line like PATTERN.
refused() {
  local said status=0
  cp tests/mutants/control.txt "$scratch/kept"
  sed -i -E "$2" tests/mutants/control.txt
  if cmp -s tests/mutants/control.txt "$scratch/kept"; then said="the case changes nothing" status=9; else
    said=$(check 2>&1) || status=$?
  fi
  cp "$scratch/kept" tests/mutants/control.txt
  if ((status != 1)) || ! grep -qE -- "$3" <<<"$said"; then
    printf 'self-test: %s: status %s, said: %s\n' "$1" "$status" "$said"
    failures=$((failures + 1))
  fi
}

self_test() {
  local failures=0 scratch
  scratch=$(mktemp -d)
  # shellcheck disable=SC2064  # now
  trap "rm -rf '$scratch'" EXIT
  mkdir "$scratch/copy"
  cp -r --parents core offsets verify tests/core tests/offsets tests/verify tests/proofs tests/mutants "$scratch/copy"
  cd "$scratch/copy"
  lists=(tests/mutants/control.txt)
  check >/dev/null || failures=1
  refused "no such text" 's/^-\}  .*farcull$/-no such text/' 'control-comment: the old text is not in'
  refused "a text twice" 's/^-\}  .*farcull$/-double/' 'stands more than once'
  refused "no such file" 's/budget\.cpp/nowhere.cpp/' 'nowhere.cpp is missing'
  refused "another folder" 's/^file: .*/file: experiments\/command\/main.cpp/' 'is not in core'
  refused "no such test" 's/Budget\.\*/Budget.Nowhere/' 'no test is called Budget.Nowhere'
  refused "no tests" 's/^tests: .*//' 'names no tests'
  refused "no sentence" 's/^(=== [a-z-]+): .*/\1: nothing/' 'is no sentence'
  refused "no change" 's/, as before$//' 'it changes nothing'
  refused "two of a name" 's/^# (.*)$/=== control-comment/' 'a second block of this name'
  refused "a line in no block" 's/^# /lost /' 'stands in no block'
  if ((failures)); then return 1; fi
  echo "mutants: --check refuses every fault of the list"
}

case $mode in
  check) check ;;
  self-test) self_test ;;
  list)
    blocks list | while IFS=$'\t' read -r name file program tests _; do
      if wanted "$name"; then printf '%-36s %-40s %s %s\n' "$name" "$file" "$program" "$tests"; fi
    done
    ;;
  *)
    check >&2 || exit 2
    mkdir -p "$out"
    touch "$results"
    tests_there >"$out/tests.tsv"
    if [[ $mode == measure ]]; then measure || exit 2; fi
    write_table || exit 2
    failed=$(judge)
    if [[ -n $failed ]]; then
      printf '%s\n' "$failed"
      exit 1
    fi
    ;;
esac
