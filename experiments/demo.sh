#!/usr/bin/env bash
# The main job in one command, on a machine with nothing but Debian and a checkout: installs what is
# missing, builds, fetches real meshes and culls two interpenetrating bunnies with FAR and with
# CULLIDE at five resolutions and with FAR pairs at its own, every culled pair checked by exact
# predicates. Exit status: that of the comparison; 2 where it did not come to that.
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
exit "$status"
