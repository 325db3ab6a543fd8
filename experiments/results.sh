#!/usr/bin/env bash
# Makes docs/results/studies.md and all its figures: installs what is missing, builds, measures every study
# (or continues where an earlier call ended), makes the report, and copies page, figures and pictures
# into docs/results. About twenty minutes on two cores without a GPU; the page was measured on such a
# machine.
#   bash experiments/results.sh [OPTIONS OF farcull experiment all]
# Exit status: 0; 1 if a method that promises missed a pair; 2 if the measurements did not complete.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

farcull_setup
farcull_build farcull
bash experiments/meshes.sh || echo "results: points on packaged meshes will be left out"

# Each commit has a store of its own, since a store refuses rows of another commit.
commit=$(build/farcull --version)
out=build/results-${commit##* }
status=0
build/farcull experiment all --out "$out" --resume "$@" || status=$?
if ((status > 1)); then exit "$status"; fi
build/farcull report "$out"
farcull_keep_report studies "Results of the studies" "$out/report"
exit "$status"
