#!/usr/bin/env bash
# The promise on real meshes. FAR with both offsets is compared with the method exact on the packaged scenes, at resolutions 64 to
# 2048. With fewer resolutions, copies of the scenes are compared as well: moved by 1e6 along the diagonal, scaled by 1e-6 and 1e6,
# and with a ground a thousand times larger. It prints a table for each scene, keeps the records in build/reliability/, and fails if
# a pair is missed. It takes about 20 minutes on two cores without a GPU. `bash experiments/reliability.sh two-bunnies` runs one
# scene and its copies. Without a GPU the native canvas draws; DEVICE=software (or another --device) asks for GL.
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
    echo
  done
done
if ((${#failed[@]})); then
  echo "reliability: pairs were missed, or a run failed: ${failed[*]}" >&2
  exit 1
fi
echo "reliability: no pair was missed; all records are in build/reliability/"
