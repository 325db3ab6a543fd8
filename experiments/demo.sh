#!/usr/bin/env bash
# Demonstrates farcull in one command, on a machine with only Debian and a checkout.
# 1. Installs missing packages, and builds the program without tests. Downloads real meshes at the same time.
# 2. Compares the methods far, cullide, boxes and exact on two bunnies that interpenetrate, and
#    prints a table. Exact predicates check every pair that a method culled.
# 3. Draws a picture of what CULLIDE misses and FAR finds, measures the small grids of all studies,
#    and makes the report.
# Exit status: that of the first command that failed, from the comparison on; 2 if the comparison did not start.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

farcull_setup
bash experiments/meshes.sh &
fetching=$!
farcull_build farcull

scene=two-bunnies
status=0
wait "$fetching" || status=$?
case $status in
  0) echo "demo: scene two-bunnies, two copies of the Stanford bunny of 75408 triangles each" ;;
  3)
    scene=two-tori
    echo "demo: the meshes are missing; scene two-tori, two generated tori, replaces two-bunnies"
    ;;
  *) exit 2 ;;
esac

mkdir -p build/demo
results=build/demo/compare.json
rm -f "$results" # an old record must not look like a new one
echo "demo: each row is a run of a method; the column missed counts the colliding pairs that it lost"
status=0
build/farcull compare "$scene" --json "$results" || status=$?
echo "demo: FAR again, with boxes of triangles before drawing; that is not published"
build/farcull compare "$scene" --methods far --resolutions 512 --broad-phase triangles |
  sed -n '/^method/p; /^far/p' || status=$?

if [[ -e $results ]]; then echo "demo: all numbers are in $results"; fi
if ((status)); then echo "demo: the comparison ended with status $status" >&2; fi

# step TEXT COMMAND...: prints the text and runs the command. A step runs even if an earlier one failed.
step() {
  local failed=0
  echo "demo: $1"
  "${@:2}" || failed=$?
  if ((failed == 0)); then return; fi
  echo "demo: this command ended with status $failed: ${*:2}" >&2
  if ((status == 0)); then status=$failed; fi
}

picture=build/demo/compare.png
# Each commit has its own store, since a store refuses rows of another commit.
commit=$(build/farcull --version)
studies=build/demo/results-${commit##* }
rm -f "$picture"
step "a picture of the same scene; missed triangles are red" build/farcull picture "$scene" \
  --compare cullide:128,cullide:1024,far:128 -o "$picture"
step "the small grids of all studies, some minutes; points that an earlier demo measured are kept" \
  build/farcull experiment all --quick --resume --out "$studies"
step "the report about the studies" build/farcull report "$studies"

echo "demo: these files were made in $farcull_root:"
for made in "$results" "$picture" "$studies"/report/index.html "$studies"/results.sqlite; do
  if [[ -e $made ]]; then echo "  $made"; fi
done
exit "$status"
