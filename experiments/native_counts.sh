#!/usr/bin/env bash
# Measures the quick grids of all studies on the native canvas and compares hashes of every count with
# tests/experiments/studies/native_counts.txt, bit for bit. Installs what is missing and builds.
#   bash experiments/native_counts.sh                           compares
#   bash experiments/native_counts.sh --renew                   makes the file anew
#   bash experiments/native_counts.sh --rows [--study NAME]     prints the counts, a row for each point: diff with
#                                                               those of another commit shows what changed
# More options: tests/experiments/studies/native_counts_main.cpp
# Exit status: 0; 1 counts differ; 2 they could not be measured.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

what=check
if [[ ${1-} == --renew || ${1-} == --rows ]]; then
  what=${1#--}
  shift
fi
{
  farcull_setup
  farcull_build farcull_native_counts
  # The grids have points on packaged meshes.
  bash experiments/meshes.sh || exit 2
} >&2
build/tests/farcull_native_counts "$what" tests/experiments/studies/native_counts.txt "$@"
