#!/usr/bin/env bash
# The promise on real meshes. FAR with both offsets is compared with the method exact on the packaged scenes, at resolutions 64 to
# 2048. With fewer resolutions, copies of the scenes are compared as well: moved by 1e6 along the diagonal, scaled by 1e-6 and 1e6,
# and with a ground a thousand times larger. It prints a table for each scene and how many pairs are at risk (lost with 0.9 of the
# radius), keeps the records in build/reliability/, and fails if a pair is missed. It takes about half an hour on two cores without
# a GPU. `bash experiments/reliability.sh two-bunnies` runs one scene and its copies. Without a GPU the native canvas draws;
# DEVICE=software (or another --device) asks for GL.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
farcull_build farcull
bash experiments/meshes.sh

scenes=("$@")
if ((${#scenes[@]} == 0)); then
  scenes=(two-bunnies armadillo-elephant dragon-bunny near-copy bunnies-far-apart)
fi
mkdir -p build/reliability
failed=()
for scene in "${scenes[@]}"; do
  for copy in "" @far @tiny @huge @ground; do
    resolutions=128,1024
    if [[ -z $copy ]]; then resolutions=64,128,256,512,1024,2048; fi
    methods=far,exact
    if [[ -z $copy ]]; then methods=far,cullide,exact; fi
    build/farcull compare "$scene$copy" --methods "$methods" --offsets obb,exact --resolutions "$resolutions" \
      ${DEVICE:+--device "$DEVICE"} \
      --json "build/reliability/$scene$copy.json" || failed+=("$scene$copy")
    # Pairs at risk. Where there are none, "0 missed" does not show that the radius is large enough.
    risk=
    for offset in obb exact; do
      for resolution in ${resolutions//,/ }; do
        lost=$(build/farcull run "$scene$copy" --method far --offset $offset --resolution "$resolution" --radius 0.9 \
          ${DEVICE:+--device "$DEVICE"} --json - | sed -nE 's/^ *"false_negatives": ([0-9]+),?$/\1/p') || true
        risk+=" $offset $resolution px ${lost:-?},"
      done
    done
    echo "at risk at 0.9 of the radius:${risk%,}"
    echo
  done
done
if ((${#failed[@]})); then
  echo "reliability: pairs were missed, or a run failed: ${failed[*]}" >&2
  exit 1
fi
echo "reliability: no pair was missed; all records are in build/reliability/"
