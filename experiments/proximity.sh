#!/usr/bin/env bash
# Runs the study "proximity" and makes its report: potential neighbour sets, what a grid loses of them, and the distances of
# libraries (docs/experiments.md, section "proximity"). It takes minutes on one core, and can be ended at any time: call it again to
# go on. The store is build/proximity/COMMIT/results.sqlite. When it has all points, the report is copied to docs/results/proximity.md.
#   bash experiments/proximity.sh [OPTIONS OF farcull experiment proximity]      --quick: few and small scenes, nothing is copied
# Exit status: 0; 1 if a method that promises lost a neighbour or a distance was not exact; 2 if the measurements did not complete.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
farcull_build farcull

commit=$(build/farcull --version)
out=build/proximity/${commit##* }
if [[ " $* " == *" --quick "* ]]; then out+=-quick; fi
status=0
build/farcull experiment proximity --out "$out" --resume "$@" || status=$?
if ((status > 1)); then exit "$status"; fi
build/farcull report "$out"
if ((status == 0)) && [[ $out != *-quick ]]; then
  farcull_keep_report proximity "Results of the study proximity" "$out/report"
fi
exit "$status"
