#!/usr/bin/env bash
# Runs the study `libraries` and makes its report (docs/libraries.md). In this study, libraries of
# Debian and npm, textbook tests and farcull's own methods decide the pairs of a labelled suite.
# The script installs what is missing and builds the program and the contestants.
#   bash experiments/libraries.sh --quick [DIR]   the small suite. Two contestants run at the same
#                                                 time, so their times mean nothing
#   bash experiments/libraries.sh --keep [DIR]    the small suite. One contestant runs at a time. At
#                                                 the end the report is copied to docs/results
#   bash experiments/libraries.sh [DIR]           as --keep, with the full suite. It takes an hour
#                                                 and a half. A second run continues the first run
# With --quick and --keep, the large libraries VTK and Open3D are not installed.
# DIR is the folder for the store and the report. Default: build/libraries-COMMIT, with -quick or -keep appended. The exit status
# is that of the study: 1 if a farcull method with a guarantee missed a pair or gave no answer.
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
# Configures again, so that CMake finds libraries that were installed after the last configuration.
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
  # The two halves of the study run at the same time. Both halves read the suite. With set -m, each half
  # is a process group, so that the trap below can interrupt it.
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
# Prints the first table of results.md.
sed -n '/^| contestant/,/^$/p' "$out/report/results.md" | sed '/^$/q; /^|---/d; s/^| //; s/ |$//' |
  sed 's/ | /\t/g' | column -t -s $'\t'
if [[ $keep == no ]]; then echo "libraries: contestants were asked side by side, so their times are bounds"; fi
echo "libraries: all tables and figures are in $out/report/; $out/report/results.md begins with what was found"
exit "$status"
