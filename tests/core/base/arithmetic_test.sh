#!/usr/bin/env bash
# What the build demands of the compiler's arithmetic (core/base/arithmetic.h, CMakeLists.txt).
# 1. Every file of the product, as it is built, is refused with -ffast-math or another option that
#    breaks the proofs, and accepted without.
# 2. Where rounding to float matters the vectorizer of straight-line code is off, with GCC; it is
#    shown that this is needed (GCC 12) and enough.
#   tests/core/base/arithmetic_test.sh SOURCE BUILD
set -uo pipefail

if [[ $# -ne 2 || ! -f $2/compile_commands.json ]]; then
  echo "usage: arithmetic_test.sh SOURCE_FOLDER BUILD_FOLDER" >&2
  exit 2
fi
source=$(realpath -- "$1")
build=$(realpath -- "$2")
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

failed=0
fail() {
  echo "FAILED $1"
  ((failed += 1))
}

# FILE<tab>COMMAND, the command without what it writes. FILE may be a batch of files with one command (farcull_batches).
sed -nE 's/^ *"command": "(.*)",?$/\1/p' "$build/compile_commands.json" |
  sed -E 's/\\"/"/g; s/\\\\/\\/g' |
  sed -nE "s#^(.*) -o [^ ]+ -c (($source|$build)/(core|offsets|verify|experiments)/[^ ]+)\$#\2\t\1#p" \
    >"$work/commands"
if [[ ! -s $work/commands ]]; then
  echo "no commands found in $build/compile_commands.json"
  exit 1
fi

# preprocesses FILE COMMAND OPTION...: whether the compiler accepts the file with these.
preprocesses() {
  eval "$2 ${*:3} -E -Wfatal-errors -o /dev/null $1" 2>"$work/message"
}

gcc=yes
IFS=$'\t' read -r filter like_filter < <(grep "^$source/verify/filter.cpp" "$work/commands")
eval "$like_filter -dM -E -x c++ /dev/null -o -" >"$work/macros"
if grep -q __clang__ "$work/macros"; then gcc=; fi

refused=(-ffast-math -Ofast -ffinite-math-only -funsafe-math-optimizations)
# Options of the processors on which operations can be rounded to another type than their own.
[[ $gcc && $(uname -m) == x86_64 ]] && refused+=(-mfpmath=387)

files=0
while IFS=$'\t' read -r file command; do
  ((files += 1))
  option=${refused[files % ${#refused[@]}]}
  if preprocesses "$file" "$command" "$option"; then
    fail "$file: is accepted with $option"
  elif ! grep -q 'error: .*farcull: ' "$work/message"; then
    fail "$file, $option: the message does not say why: $(head -n 1 "$work/message")"
  fi
done <"$work/commands"

# One file of the checker with each of them, and with none.
preprocesses "$filter" "$like_filter" || fail "$filter: is refused as it is: $(head -n 1 "$work/message")"
for option in "${refused[@]}"; do
  ! preprocesses "$filter" "$like_filter" "$option" || fail "$filter: is accepted with $option"
done

# narrowing OPTION...: what tests/core/base/narrowing.cpp prints when compiled like verify/filter.cpp
# with these options besides.
# Without what is precompiled: GCC would take the options from there.
narrowing() {
  local command
  command=$(sed -E 's# -Winvalid-pch##; s# -include [^ ]*cmake_pch[^ ]*##' <<<"$like_filter")
  eval "$command $* -o $work/narrowing $source/tests/core/base/narrowing.cpp" && "$work/narrowing"
}

kept=-fno-tree-slp-vectorize
if [[ ! $gcc ]]; then
  echo "this compiler is not GCC: $kept is not needed"
else
  # Elsewhere floats are only drawn.
  without=$(grep -E "^$source/((core|offsets|verify)/|experiments/peers/embree)" "$work/commands" |
    grep -v -- " $kept" | cut -f 1)
  [[ -z $without ]] || fail "compiled without $kept: $without"
fi
for level in -O1 -O2 -O3 '-O3 -march=native'; do
  answer=$(narrowing "$level")
  [[ $answer == 'straight 0 loop 0' ]] || fail "narrowing at $level: $answer"
done
# Twin: with that vectorizer.
answer=$(narrowing -O3 -ftree-slp-vectorize)
case $answer in
  'straight 2 loop 0') echo "this compiler loses the rounding with -ftree-slp-vectorize" ;;
  'straight 0 loop 0')
    if [[ $gcc ]] && grep -q '__GNUC__ 12$' "$work/macros"; then
      fail "narrowing with -ftree-slp-vectorize: GCC 12 is known to lose the rounding"
    fi
    echo "this compiler keeps the rounding with -ftree-slp-vectorize as well"
    ;;
  *) fail "narrowing with -ftree-slp-vectorize: $answer" ;;
esac

if ((failed)); then exit 1; fi
echo "arithmetic: $files files refuse other arithmetic"
