#!/usr/bin/env bash
# Runs the study "cloth" and makes its report: 500 frames of a cloth of 20,000 triangles at each of four stiffnesses, every
# frame accounted for pair by pair by far-pairs, and every tenth by far. It takes hours on one core.
# It can be ended at any time. Call it again to go on: every frame that was simulated is a file in build/cloth/states, and every
# frame that was accounted for is a row in build/cloth/COMMIT/results.sqlite. A new commit accounts for all frames anew, from
# the same states. When it has all frames, the report is copied to docs/results/cloth.md.
#   bash experiments/cloth.sh [OPTIONS OF farcull experiment cloth]      --quick: 200 triangles, 12 frames, seconds
# Exit status: 0; 1 if a method that promises missed a pair; 2 if the measurements did not complete.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
farcull_build farcull

export FARCULL_CLOTH=${FARCULL_CLOTH:-$farcull_root/build/cloth/states}
commit=$(build/farcull --version)
out=build/cloth/${commit##* }
status=0
build/farcull experiment cloth --out "$out" --resume "$@" || status=$?
if ((status > 1)); then exit "$status"; fi
build/farcull report "$out"
# When all frames of the full size are there.
if ((status == 0)) && [[ " $* " != *" --quick "* ]]; then
  farcull_keep_report cloth "Results of the study cloth" "$out/report"
fi
exit "$status"
