#!/usr/bin/env bash
# Follows docs/extending.md: adds the method and the offset of its examples, and runs them. The option
# of its example changes a struct that half of the program holds, so its files are only compiled, and
# counted.
#   tests/experiments/method/extending_test.sh SOURCE BUILD
# Each code block of the page goes where the line above it says: "In the new file `FILE`:" or "In
# `FILE`, before "TEXT":". The files that change are compiled again, with the commands of the build,
# and linked before the libraries of the build. The twin leaves one block out: that must fail.
set -euo pipefail

if [[ $# -ne 2 || ! -f $2/compile_commands.json ]]; then
  echo "usage: extending_test.sh SOURCE_FOLDER BUILD_FOLDER" >&2
  exit 2
fi
source=$(realpath -- "$1")
build=$(realpath -- "$2")
page=$source/docs/extending.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "extending_test: $1" >&2
  exit 1
}

# blocks FOLDER: writes every block of the page as FOLDER/NUMBER.{code,file,before,section}; `before` is
# empty for a new file. A direction may stand on two lines of the page.
blocks() {
  mkdir -p "$1"
  awk -v folder="$1" '
    /^## / { section = substr($0, 4) }
    /^ *```cpp$/ {
      number++
      text = previous " " line
      if (!match(text, /In (the new file )?`[^`]*`(, before "[^"]*")?:$/)) {
        print "no place for the code block at line " NR > "/dev/stderr"
        exit 1
      }
      place = substr(text, RSTART, RLENGTH)
      file = place; sub(/^[^`]*`/, "", file); sub(/`.*/, "", file)
      before = ""
      if (place ~ /before "/) { before = place; sub(/.*before "/, "", before); sub(/":$/, "", before) }
      print file > (folder "/" number ".file")
      print before > (folder "/" number ".before")
      print section > (folder "/" number ".section")
      match($0, /^ */); indent = RLENGTH
      inside = 1
      next
    }
    inside && /^ *```$/ { inside = 0; next }
    inside { print substr($0, indent + 1) > (folder "/" number ".code"); next }
    NF { sub(/^ +/, ""); previous = line; line = $0 }
  ' "$page"
  ls "$1"/*.code >/dev/null 2>&1 || fail "docs/extending.md has no code block"
}

# place OVERLAY BLOCKS OPTION [LEFT_OUT]: the changed and new files in a folder of their own; those of
# the option's section where OPTION is yes, else those of the others.
place() {
  local n file before at option
  for ((n = 1; ; ++n)); do
    [[ -e $2/$n.code ]] || break
    option=no
    [[ $(<"$2/$n.section") == 'An option of a method' ]] && option=yes
    [[ $option == "$3" && ${4-} != "$n" ]] || continue
    file=$(<"$2/$n.file")
    before=$(<"$2/$n.before")
    mkdir -p "$1/$(dirname "$file")"
    if [[ -z $before ]]; then
      [[ ! -e $source/$file ]] || fail "$file is not new"
      cp "$2/$n.code" "$1/$file"
      continue
    fi
    [[ -e $1/$file ]] || cp "$source/$file" "$1/$file" || fail "there is no $file"
    at=$(grep -nF -- "// $before" "$1/$file" | cut -d: -f1) || fail "$file has no place \"$before\""
    [[ $at =~ ^[0-9]+$ ]] || fail "$file has more than one place \"$before\""
    sed -i "$((at - 1))r $2/$n.code" "$1/$file"
  done
}

# compile OVERLAY: objects of every .cpp of the overlay, with the options of a file beside it.
compile() {
  local overlay=$1 file like command
  while IFS= read -r file; do
    like=$source/$file
    [[ -e $like ]] || like=$(find "$source/$(dirname "$file")" -maxdepth 1 -name '*.cpp' | sort | sed -n 1p)
    command=$(sed -nE 's/^ *"command": "(.*)",?$/\1/p' "$build/compile_commands.json" |
      sed -E 's/\\"/"/g; s/\\\\/\\/g' | grep -F -- " -c $like" | sed -n 1p)
    [[ -n $command ]] || fail "no command compiles $like"
    # Neither the precompiled header, which holds headers that have changed, nor the compiler's cache.
    command=$(sed -E "s# -Winvalid-pch##; s# -include [^ ]*cmake_pch[^ ]*# -include $source/core/base/arithmetic.h#; s# -o .*##; s#^[^ ]*ccache ##" <<<"$command")
    command=${command/ -I/ -I$overlay -I}
    (cd "$build" && eval "$command -O0 -o '$overlay/${file//\//_}.o' -c '$overlay/$file'") || return 1
  done < <(cd "$overlay" && find . -name '*.cpp' | sed 's#^\./##' | sort)
}

blocks "$work/blocks"
place "$work/overlay" "$work/blocks" no
compile "$work/overlay" || fail "what docs/extending.md adds does not compile"

# The link of the program, with these objects before all others.
link=$(cd "$build" && ninja -t commands farcull 2>/dev/null | tail -n 1) || :
if [[ $link != *' -o farcull '* ]]; then
  link=$(cat "$build"/experiments/CMakeFiles/farcull.dir/link.txt 2>/dev/null) || {
    echo "extending_test: not run: neither Ninja nor make says how to link" >&2
    exit 77
  }
fi
link=${link#: && }
link=${link% && :}
link=$(sed -E "s# -o [^ ]*farcull # $work/overlay/*.o -o $work/farcull #" <<<"$link")
folder=$build
[[ -e $build/build.ninja ]] || folder=$build/experiments
(cd "$folder" && eval "$link") || fail "what docs/extending.md adds does not link"

farcull=$work/farcull
answer() { "$farcull" run "$@" --json - | grep -E '"(colliding_pairs|false_negatives|method|offset)"'; }
truth=$("$farcull" run two-spheres --method exact --json - | grep '"colliding_pairs"')
by_join=$(answer two-spheres --method join)
grep -q '"method": "join"' <<<"$by_join" || fail "no run by the new method: $by_join"
grep -qF -- "$truth" <<<"$by_join" || fail "the new method finds other pairs: $by_join"
grep -q '"false_negatives": 0,' <<<"$by_join" || fail "the new method misses pairs: $by_join"
grep -q 'boxes of all triangles' <<<"$("$farcull" plan two-spheres --method join)" ||
  fail "the plan of the new method lacks its stage"
wide=$(answer two-spheres --method far --offset wide --resolution 128)
grep -q '"offset": "wide"' <<<"$wide" || fail "no run with the new offset: $wide"
grep -qF -- "$truth" <<<"$wide" || fail "the new offset finds other pairs: $wide"
"$farcull" run two-spheres --method join --radius 1 2>"$work/refused" && fail "--radius is taken by a method without one"
grep -q -- '--radius' "$work/refused" || fail "the refusal does not name --radius"

# The twin: without the definition of the method nothing may link or compile.
for ((n = 1; ; ++n)); do
  [[ $(<"$work/blocks/$n.file") == experiments/method/join.cpp ]] && break
done
place "$work/twin" "$work/blocks" no "$n"
rm "$work"/overlay/experiments_method_join.cpp.o
if (cd "$folder" && eval "${link//$work\/farcull/$work\/twin_farcull}") >/dev/null 2>&1; then
  fail "the twin links without the new method's functions: this test cannot fail"
fi

# The option, on top of the method.
cp -r "$work/overlay" "$work/option"
place "$work/option" "$work/blocks" yes
mapfile -t files < <(cd "$work/blocks" && for n in *.section; do
  [[ $(<"$n") != 'An option of a method' ]] || cat "${n%.section}.file"
done | sort -u)
((${#files[@]} >= 3 && ${#files[@]} <= 4)) || fail "an option of a method touches ${#files[@]} files"
find "$work/option" -name '*.cpp' | while IFS= read -r file; do
  [[ " ${files[*]} " == *" ${file#"$work/option/"} "* ]] || rm "$file"
done
compile "$work/option" || fail "the option that docs/extending.md adds does not compile"
echo "extending_test: docs/extending.md adds a method and an offset that run"
