#!/usr/bin/env bash
# Asks the libraries that Debian and npm have, textbook tests and farcull's own methods about a
# labelled suite, and makes the report (docs/libraries.md). It installs what is missing, builds the
# program and the contestants, runs the study and prints where the tables are.
#   bash experiments/libraries.sh --quick [DIR]   the small suite; two contestants are asked at a time, so
#                                                 their times say nothing. VTK and Open3D, which are
#                                                 large, take part only if they are installed
#   bash experiments/libraries.sh --keep [DIR]    the small suite, one contestant after the other. When all
#                                                 is measured, the report is copied to docs/results
#   bash experiments/libraries.sh [DIR]           the same with the full suite, an hour and a half; a second
#                                                 run goes on
# DIR (default build/libraries-COMMIT, with -quick at its end for the small suite) gets the store
# and the report. Exit status: that of the study, 1 if a method of farcull that promises missed a
# pair or had no answer.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

quick=() keep=yes
if [[ ${1-} == --quick || ${1-} == --keep ]]; then
  quick=(--quick)
  if [[ $1 == --quick ]]; then keep=no; fi
  shift
fi
farcull_packages+=(libccd-dev libgts-dev)
if ! command -v npm >/dev/null; then farcull_packages+=(nodejs npm); fi
if ((${#quick[@]} == 0)); then farcull_packages+=(libvtk9-dev libopen3d-dev); fi
farcull_setup
# CMake finds libraries that were installed since the last time only if it looks again.
[[ ! -e build/CMakeCache.txt ]] || cmake build >/dev/null
farcull_build farcull farcull_contestants

# If npm cannot install these packages, the report says that their contestants are missing.
mkdir -p build/contestants
npm_packages=(three@0.187.0 three-mesh-bvh@0.9.17 @dimforge/rapier3d-compat@0.21.0 cannon-es@0.20.0
  manifold-3d@3.5.4 jolt-physics@1.1.0)
(cd build/contestants && npm install --no-audit --no-fund "${npm_packages[@]}") ||
  echo "libraries: npm did not install its packages, which are left out" >&2

# Each commit has a store of its own, since a store refuses rows of another commit.
commit=$(build/farcull --version)
name=${quick:+-quick}
if ((${#quick[@]})) && [[ $keep == yes ]]; then name=-keep; fi
out=${1:-build/libraries-${commit##* }$name}
status=0
ask() { build/farcull experiment libraries "${quick[@]}" --resume --out "$out" "$@"; }
if [[ $keep == yes && -e $out/results-1-of-2.sqlite ]]; then
  echo "libraries: $out is of --quick, whose times are not to be kept; name another folder" >&2
  exit 2
elif [[ $keep == yes || -e $out/results.sqlite ]]; then
  ask || status=$?
else
  # Two halves run side by side, and both need the suite. Each is a group of processes (set -m), since a
  # background job of a script does not get an interrupt otherwise.
  [[ -e $out/suite/suite.txt ]] || build/farcull suite "$out/suite"
  running=()
  set -m
  for half in 1/2 2/2; do
    ask --shard "$half" &
    running+=($!)
  done
  trap 'kill -INT -- "${running[@]/#/-}"; wait; exit 130' INT TERM
  for process in "${running[@]}"; do wait "$process" || status=$?; done
  trap - INT TERM
  set +m
  build/farcull merge "$out" || exit $((status ? status : 2))
fi
build/farcull report "$out" || status=$?
if [[ $keep == yes && $status == 0 ]]; then
  farcull_keep_report libraries "Results of the study libraries" "$out/report" "libraries.sh${quick:+ --keep}"
  cp "$out"/report/tables/libraries{,-meshes,-kinds,-distances,-calls,-families}.csv docs/results/
fi
echo
# The first table of the page.
sed -n '/^| contestant/,/^$/p' "$out/report/results.md" | sed '/^$/q; /^|---/d; s/^| //; s/ |$//' |
  sed 's/ | /\t/g' | column -t -s $'\t'
if [[ $keep == no ]]; then echo "libraries: contestants were asked side by side, so their times are bounds"; fi
echo "libraries: all tables and figures are in $out/report/; $out/report/results.md begins with what was found"
exit "$status"
