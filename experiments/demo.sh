#!/usr/bin/env bash
# The main job in one command, on a machine with nothing but Debian and a checkout: installs what is
# missing, builds, fetches real meshes and culls two interpenetrating bunnies with FAR and with
# CULLIDE at five resolutions and with FAR pairs at its own, every culled pair checked by exact
# predicates. Then a picture of what CULLIDE misses beside what FAR finds, the small grids of all
# studies, and the report about them. Exit status: that of the comparison, else that of the first
# of these that failed; 2 where it did not come to that.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

farcull_setup
farcull_build farcull

scene=two-bunnies
status=0
bash experiments/meshes.sh || status=$?
case $status in
  0) echo "demo: scene two-bunnies, two copies of the Stanford bunny of 75408 triangles each" ;;
  3)
    scene=two-tori
    echo "demo: scene two-tori, which is generated, in place of two-bunnies"
    ;;
  *) exit 2 ;;
esac

mkdir -p build/demo
results=build/demo/compare.json
rm -f "$results" # an old record must not pass for this run's
echo "demo: far and cullide at resolutions 128 to 2048, far-pairs, exact; exact predicates count missed pairs"
status=0
build/farcull compare "$scene" --json "$results" || status=$?

if [[ -e $results ]]; then echo "demo: all numbers are in $results"; fi
if ((status)); then echo "demo: the comparison ended with status $status" >&2; fi

# step WHAT COMMAND...: what follows is made even where something before it failed.
step() {
  local failed=0
  echo "demo: $1"
  "${@:2}" || failed=$?
  if ((failed == 0)); then return; fi
  echo "demo: this ended with status $failed: ${*:2}" >&2
  if ((status == 0)); then status=$failed; fi
}

picture=build/demo/compare.png
# Rows of another commit do not stand beside this one's.
commit=$(build/farcull --version)
studies=build/demo/results-${commit##* }
rm -f "$picture"
step "the same as a picture: what is missed is red" build/farcull picture "$scene" \
  --compare cullide:128,cullide:1024,far:128 -o "$picture"
step "the small grids of all studies, some minutes; what an earlier demo of this commit has measured stays" \
  build/farcull experiment all --quick --resume --out "$studies"
step "the report about them" build/farcull report "$studies"

# Where everything lies.
echo "demo: in $farcull_root:"
for made in "$results" "$picture" "$studies"/report/index.html "$studies"/results.sqlite; do
  if [[ -e $made ]]; then echo "  $made"; fi
done
exit "$status"
