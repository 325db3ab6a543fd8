#!/usr/bin/env bash
# The house rules of the architecture page, as a test: which room may include which, who may use
# epoxy and CGAL, who may start threads, and what lies at the top of the repository.
#   tests/house_test.sh [ROOT]       checks ROOT (default: this repository); status 1 and one line
#                                    per violation where a rule is broken
#   tests/house_test.sh --self-test  breaks every rule in a temporary tree; each must be caught
set -euo pipefail

self=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)/${BASH_SOURCE[0]##*/}
# Where git runs this as a hook, it would look at the hook's repository, whatever the folder.
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE

rooms=(core offsets verify experiments tests)
top=(CMakeLists.txt README.md docs "${rooms[@]}")

# The room that a path from the root belongs to; core has several. A file of core/view may be split
# into view_*.
room_of() {
  case $1 in
    core/error.*) echo error ;;
    core/scene[._]* | core/view[._]*) echo ground ;; # level 0
    # Level 0 as well: geometry and plain tools that know of scenes and views alone.
    core/box_join[._]*) echo join ;;
    core/clip[._]* | core/floating_point[._]* | core/parallel[._]* | core/raster[._]* | core/stopwatch[._]*) echo ground ;;
    core/cull[._]* | core/fatten[._]* | core/sweep_prune[._]*) echo culling ;;
    core/budget[._]*) echo budget ;; # level 1, as the next two
    core/plan[._]*) echo plan ;;
    core/canvas[._]*) echo canvas ;;
    core/gl_*) echo gl ;;
    */*) echo "${1%%/*}" ;;
  esac
}

# rule_broken FILE INCLUDED: prints the rule that FILE breaks by this include, nothing where it
# breaks none.
rule_broken() {
  local from to
  from=$(room_of "$1")
  to=$(room_of "$2")

  case $2 in
    epoxy/* | EGL/* | GL/* | GLES*/* | KHR/*)
      # The tests of faults put functions of their own in the place of GL's.
      [[ $from == gl || $1 == tests/faults/* ]] || echo "only core/gl_* uses EGL and GL"
      return
      ;;
    CGAL/* | gmp.h | gmpxx.h | mpfr.h)
      # What farcull is measured against is CGAL as well.
      [[ $from == verify || $from == tests || $1 == experiments/peer_cgal* ]] ||
        echo "only verify and tests use CGAL and GMP, and experiments/peer_cgal"
      return
      ;;
    core/* | offsets/* | verify/* | experiments/* | tests/*) ;; # ours: judged below
    *) return ;;
  esac

  case $from:$to in
    tests:*) ;; # anything
    *:tests) echo "nothing but tests includes tests" ;;
    error:error | ground:error | ground:ground | join:error | join:ground | join:join) ;;
    error:*) echo "core/error includes nothing of ours" ;;
    ground:* | join:*) echo "level 0 includes nothing of ours but core/error and level 0" ;;
    budget:error | budget:ground | budget:budget) ;;
    plan:error | plan:ground | plan:join | plan:plan) ;;
    canvas:error | canvas:ground | canvas:canvas) ;;
    budget:* | plan:* | canvas:*)
      echo "level 1 includes nothing of ours but level 0 and core/error"
      ;;
    core:offsets | core:verify | core:experiments | gl:offsets | gl:verify | gl:experiments | \
      culling:offsets | culling:verify | culling:experiments)
      echo "core does not know offsets, verify, experiments"
      ;;
    offsets:gl | offsets:verify | offsets:experiments)
      echo "offsets does not know core/gl_*, verify, experiments"
      ;;
    # The checker shares no construction code with what it checks.
    verify:offsets) echo "verify never includes offsets" ;;
    verify:join | verify:culling | verify:plan) echo "verify never uses the code that culled" ;;
    verify:gl | verify:budget | verify:experiments)
      echo "verify does not know core/gl_*, core/budget, experiments"
      ;;
  esac
}

# Prints "FILE:LINE:INCLUDED" for every #include, either kind of quotes, in C++ and in shaders
# (which C++ includes).
includes() {
  local folder
  local -a there=()
  for folder in "${rooms[@]}"; do
    if [[ -d $folder ]]; then there+=("$folder"); fi
  done
  ((${#there[@]})) || return 0
  { grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]' "${there[@]}" --include='*.h' \
    --include='*.cpp' --include='*.glsl' --include='*.vert' --include='*.frag' --include='*.comp' ||
    true; } |
    sed -E 's/^([^:]*:[0-9]+:)[^<"]*[<"]([^>"]*).*/\1\2/'
}

# Prints "FILE:LINE:TEXT" wherever the product starts a thread but in core/parallel.h.
thread_starts() {
  grep -rnE 'std::(jthread|async|thread)([^:_[:alnum:]]|$)|pthread_create' \
    core offsets verify experiments --include='*.h' --include='*.cpp' |
    grep -v '^core/parallel\.h:' || true
}

# The names at the top, without dot files: those that git has or would add, or all but build folders
# where git is absent.
names_at_top() {
  local files name
  if [[ -e .git ]] && files=$(git ls-files --cached --others --exclude-standard 2>/dev/null); then
    cut -d/ -f1 <<<"$files" | sort -u | while IFS= read -r name; do
      # A file that was removed, the removal not yet committed, is still listed.
      if [[ -e $name ]]; then printf '%s\n' "$name"; fi
    done
  else
    find . -mindepth 1 -maxdepth 1 ! -name 'build*' -printf '%f\n' | sort
  fi | grep -v '^\.' || true
}

check() {
  local file line included beside rule name names
  local -i violations=0 seen=0
  cd "$1"
  while IFS=: read -r file line included; do
    seen+=1
    # An include relative to its own folder is the file it means, however it is spelled.
    beside=${file%/*}/$included
    if [[ -f $beside ]]; then included=$(realpath -s --relative-to=. "$beside"); fi
    rule=$(rule_broken "$file" "$included")
    if [[ -n $rule ]]; then
      printf '%s:%s: includes %s: %s\n' "$file" "$line" "$included" "$rule"
      violations+=1
    fi
  done < <(includes)
  if ((seen == 0)); then
    echo "no #include found under $1: this is not the repository, or the test reads it wrongly"
    violations+=1
  fi

  while IFS=: read -r file line _; do
    printf '%s:%s: starts a thread: only core/parallel.h does, for the arithmetic of each\n' \
      "$file" "$line"
    violations+=1
  done < <(thread_starts)

  names=$(names_at_top)
  for name in "${top[@]}"; do
    if ! grep -qxF -- "$name" <<<"$names"; then
      echo "$name: missing at the top level"
      violations+=1
    fi
  done
  while IFS= read -r name; do
    if [[ -n $name && " ${top[*]} " != *" $name "* ]]; then
      echo "$name: the top level holds nothing but ${top[*]}"
      violations+=1
    fi
  done <<<"$names"
  if ((violations)); then return 1; fi
  echo "house: $seen includes in order"
}

# ---- self-test: a small tree that obeys every rule, then one violation at a time ----

# put FILE INCLUDE: a file with one include, which is spelled with its quotes or brackets.
put() {
  mkdir -p "$(dirname "$1")"
  printf '// a file of the self-test\n#include %s\n' "$2" >"$1"
}

# Runs the check on the tree as a fresh process: "pass", or "caught" where it fails and its output
# names $1 and says $2.
verdict() {
  local output status=0
  output=$(bash "$self" . 2>&1) || status=$?
  if ((status == 0)); then
    echo pass
  elif ((status == 1)) && [[ $(grep -c . <<<"$output") == 1 && $output == "$1:"*"$2"* ]]; then
    echo caught
  else
    echo "status $status: $output"
  fi
}

failures=0
# expect WHAT VERDICT FOUND
expect() {
  if [[ $3 == "$2" ]]; then return; fi
  echo "self-test: $1: expected $2, got: $3"
  failures=$((failures + 1))
}

# breaks FILE INCLUDE RULE: the check must fail with FILE in place, for this reason and no other.
breaks() {
  put "$1" "$2"
  expect "$1 includes $2" caught "$(verdict "$1" "$3")"
  rm "$1"
}

# keeps FILE INCLUDE: what is allowed must stay allowed.
keeps() {
  put "$1" "$2"
  expect "$1 includes $2" pass "$(verdict "$1" '')"
  rm "$1"
}

self_test() {
  local tree name
  tree=$(mktemp -d)
  # shellcheck disable=SC2064  # the folder's name as it is now
  trap "rm -rf '$tree'" EXIT
  cd "$tree"
  echo top >CMakeLists.txt
  echo top >README.md
  mkdir docs build
  echo page >docs/index.md
  echo junk >build/junk
  for name in error scene view budget plan canvas cull gl_canvas; do
    put "core/$name.h" '<vector>'
  done
  put offsets/obb.glsl '"core/shim.h"'
  put verify/exact.h '<CGAL/Kernel.h>'
  put experiments/scenes.cpp '"offsets/obb.h"'
  put tests/all_test.cpp '"verify/exact.h"'
  expect "the tree that obeys" pass "$(verdict '' '')"

  local ground='level 0 includes' first='level 1 includes' core='core does not know'
  breaks core/error.cpp '"core/scene.h"' 'core/error includes nothing'
  breaks core/scene.cpp '"core/plan.h"' "$ground"
  breaks core/view.cpp '"core/cull.h"' "$ground"
  breaks core/scene_read.cpp '"offsets/obb.h"' "$ground"
  breaks core/view.cpp '"verify/exact.h"' "$ground"
  breaks core/scene.cpp '"experiments/cli.h"' "$ground"
  breaks core/budget.cpp '"core/plan.h"' "$first"
  breaks core/plan.cpp '"core/canvas.h"' "$first"
  breaks core/canvas.cpp '"core/gl_canvas.h"' "$first"
  breaks core/budget.cpp '"offsets/obb.glsl"' "$first"
  breaks core/cull.cpp '"offsets/obb.h"' "$core"
  breaks core/pairs.cpp '"verify/exact.h"' "$core"
  breaks core/cull.cpp '"experiments/cli.h"' "$core"
  breaks core/gl_egl.cpp '"offsets/obb.h"' "$core"
  breaks core/gl_egl.cpp '"verify/exact.h"' "$core"
  breaks core/gl_egl.cpp '"experiments/cli.h"' "$core"
  breaks offsets/obb.cpp '"core/gl_canvas.h"' 'offsets does not know'
  breaks offsets/obb.cpp '"verify/exact.h"' 'offsets does not know'
  breaks offsets/exact.glsl '"experiments/cli.h"' 'offsets does not know'
  breaks verify/accounting.cpp '"offsets/obb.glsl"' 'verify never includes offsets'
  breaks verify/canvas.cpp '"core/gl_canvas.h"' 'verify does not know'
  breaks verify/canvas.cpp '"core/budget.h"' 'verify does not know'
  breaks verify/accounting.cpp '"core/box_join.h"' 'verify never uses the code that culled'
  breaks verify/accounting.cpp '"core/cull.h"' 'verify never uses the code that culled'
  breaks verify/accounting.cpp '"core/sweep_prune.h"' 'verify never uses the code that culled'
  breaks verify/accounting.cpp '"core/plan.h"' 'verify never uses the code that culled'
  breaks core/box_join.cpp '"core/plan.h"' "$ground"
  breaks core/clip.cpp '"core/canvas.h"' "$ground"
  breaks verify/canvas.cpp '"experiments/cli.h"' 'verify does not know'
  for name in core/error core/scene core/plan core/cull core/gl_egl \
    offsets/obb verify/exact experiments/main; do
    breaks "$name.cpp" '"tests/cases.h"' 'nothing but tests includes tests'
  done
  for name in core/scene core/canvas core/cull \
    offsets/obb verify/canvas experiments/main tests/gl_test; do
    breaks "$name.cpp" '<epoxy/gl.h>' 'only core/gl_*'
  done
  for name in core/scene core/pairs core/gl_egl offsets/obb experiments/main experiments/peer_fcl; do
    breaks "$name.cpp" '<CGAL/box_intersection_d.h>' 'only verify and tests'
    breaks "$name.cpp" '<gmpxx.h>' 'only verify and tests'
  done

  # The same by other spellings and in other files.
  breaks verify/canvas.cpp '"../offsets/obb.glsl"' 'verify never includes offsets'
  breaks core/view.cpp '"cull.h"' "$ground"
  breaks verify/canvas.h '<offsets/obb.h>' 'verify never includes offsets'
  breaks verify/deep/canvas.h '"offsets/obb.h"' 'verify never includes offsets'
  breaks core/shaders/cull.frag '"offsets/obb.glsl"' "$core"
  printf '  #  include\t"offsets/obb.h" // why\r\n' >verify/odd.h
  expect "an include with odd spaces" caught "$(verdict verify/odd.h 'verify never')"
  rm verify/odd.h

  for name in 'std::jthread t(work);' 'auto f = std::async(work);' 'std::vector<std::thread> t;' \
    'pthread_create(&t, nullptr, work, nullptr);'; do
    printf '#include <vector>\n%s\n' "$name" >verify/threads.cpp
    expect "$name" caught "$(verdict verify/threads.cpp 'starts a thread')"
  done
  printf '#include <thread>\nunsigned n = std::thread::hardware_concurrency();\n' >verify/threads.cpp
  expect "the number of cores" pass "$(verdict '' '')"
  rm verify/threads.cpp
  put core/parallel.h '<thread>'
  echo 'std::jthread t(work);' >>core/parallel.h
  expect "core/parallel starts threads" pass "$(verdict '' '')"
  rm core/parallel.h

  keeps core/scene.cpp '"core/error.h"'
  keeps core/view.cpp '"core/scene.h"'
  keeps core/plan.cpp '"core/plan.h"'
  keeps core/canvas.cpp '"core/view.h"'
  keeps core/gl_egl.cpp '<epoxy/egl.h>'
  keeps tests/faults/lost_call_test.cpp '<epoxy/gl.h>'
  keeps core/gl_egl.cpp '"core/canvas.h"'
  keeps core/gl_egl.cpp '"generated/commit.h"'
  keeps offsets/obb.cpp '"offsets/obb.glsl"'
  keeps offsets/obb.cpp '"core/budget.h"'
  keeps verify/canvas.cpp '"core/canvas.h"'
  keeps verify/exact.cpp '<gmpxx.h>'
  keeps experiments/run.cpp '"core/gl_canvas.h"'
  keeps tests/obb_test.cpp '"offsets/obb.glsl"'
  keeps tests/exact_test.cpp '<CGAL/Kernel.h>'
  keeps experiments/peer_cgal.cpp '<CGAL/Kernel.h>'

  # The top level, as a plain folder and as a git checkout.
  at_top
  if command -v git >/dev/null; then
    printf '/build*/\n' >.gitignore
    git -c init.defaultBranch=main init -q .
    expect "the tree that obeys, in git" pass "$(verdict '' '')"
    at_top
  fi

  rm -rf core offsets verify experiments tests .git
  mkdir "${rooms[@]}"
  expect "a tree without a file" caught "$(verdict 'no #include found under .' '')"
  if ((failures)); then return 1; fi
  echo "house: every rule is caught when it is broken"
}

# What the top level must refuse.
at_top() {
  local name
  echo note >notes.txt
  expect "a file too many" caught "$(verdict notes.txt 'the top level holds nothing but')"
  rm notes.txt
  mkdir extra
  echo note >extra/note
  expect "a folder too many" caught "$(verdict extra 'the top level holds nothing but')"
  rm -r extra
  for name in CMakeLists.txt README.md docs; do
    mv "$name" build/
    expect "$name gone" caught "$(verdict "$name" 'missing at the top level')"
    mv "build/$name" .
  done
}

case ${1-} in
  --self-test) self_test ;;
  *) check "${1:-"$(dirname -- "$self")/.."}" ;;
esac
