#!/usr/bin/env bash
# docs/results.md and its figures, all of them, in one command: installs what is missing, builds,
# measures every study (or goes on where an earlier call ended), reports, and puts page, figures and
# pictures into docs/. About half an hour on two cores without a GPU; the figures in docs/ are of
# such a machine.
#   bash experiments/results.sh [OPTIONS OF farcull experiment all]
# Exit status: 0; 1 where a method that promises missed a pair; 2 where it did not come to that.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

farcull_setup
farcull_build farcull
bash experiments/meshes.sh || echo "results: points on packaged meshes will be left out"

out=build/results
status=0
build/farcull experiment all --out "$out" --resume "$@" || status=$?
if ((status > 1)); then exit "$status"; fi
build/farcull report "$out"
for kind in figures pictures; do
  mkdir -p "docs/$kind"
  rm -f "docs/$kind"/*.svg "docs/$kind"/*.png
done
cp "$out"/report/results.md docs/results.md
cp "$out"/report/figures/*.svg docs/figures/
if [[ -d $out/report/pictures ]]; then cp "$out"/report/pictures/*.png docs/pictures/; fi
echo "results: docs/results.md, from $out/results.sqlite"
exit "$status"
